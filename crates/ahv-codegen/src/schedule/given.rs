//! What a body may refer to besides its arguments: prepared values, and stages.

use std::collections::HashMap;

use super::tree::{Body, Source, StageKind};
use crate::graph::{Id, Kind};

/// A stage of a model.
pub(crate) struct Stage {
    pub(crate) kind: &'static StageKind,
    pub(crate) fields: Vec<Field>,
    /// What fills the fields, one part after the other.
    pub(crate) parts: Vec<Body>,
    /// Names that only say whose part a value is, each with the reason.
    pub(crate) numbered: Vec<(String, String)>,
    pub(super) names: HashMap<Id, String>,
}

/// A field of a stage.
pub(crate) struct Field {
    pub(crate) name: String,
    /// What it is, as a sentence; `None` where its formula says it.
    pub(crate) about: Option<String>,
}

/// What a body may refer to besides its arguments.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    /// Names of prepared values; `None` in `prepare` itself.
    pub(crate) prepared: Option<&'a HashMap<Id, String>>,
    pub(crate) stages: &'a [Stage],
}

impl Given<'_> {
    /// Nothing is given but arguments.
    pub(crate) const NOTHING: Self = Self {
        prepared: None,
        stages: &[],
    };

    /// Where a value is given, and its name there.
    pub(super) fn find(&self, id: Id) -> Option<(Source, &str)> {
        if let Some(name) = self.prepared.and_then(|it| it.get(&id)) {
            return Some((Source::Argument(Kind::Parameter), name));
        }
        let mut stages = self.stages.iter();
        stages.find_map(|stage| Some((Source::Stage(stage.kind), &**stage.names.get(&id)?)))
    }

    /// What given values are called in names.
    pub(super) fn names(&self) -> HashMap<Id, String> {
        let prepared = self.prepared.into_iter().flatten();
        let stages = self.stages.iter().flat_map(|stage| &stage.names);
        let names = prepared.chain(stages);
        names.map(|(id, name)| (*id, name.clone())).collect()
    }
}

impl Stage {
    /// Whether any part refers to a component that stands there.
    pub(crate) fn uses(&self, source: Source) -> bool {
        self.parts.iter().any(|part| part.uses(source))
    }
}
