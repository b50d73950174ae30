//! The models that this program knows: those of the package that it was built over.

use std::sync::OnceLock;

use ahv_analysis::erased::{self, AnyModel};
use ahv_core::ModelList;
use ahv_table::Family;

use crate::failure::Failure;
use crate::names;

static REGISTRY: OnceLock<Vec<Box<dyn AnyModel>>> = OnceLock::new();

/// Makes the models of `L` those that this program knows; the first call of a process decides.
pub(crate) fn register<L: ModelList>() {
    REGISTRY.get_or_init(erased::all::<L>);
}

/// The models that this program knows.
pub(crate) fn models() -> impl Iterator<Item = &'static dyn AnyModel> {
    REGISTRY.get().into_iter().flatten().map(|model| &**model)
}

/// The table of a model, for the check of another.
pub(crate) fn family(model: &dyn AnyModel) -> Family {
    let parameters = model.parameters();
    Family {
        table: model.table(),
        names: parameters.names,
        units: parameters.units,
        si_units: parameters.si_units,
    }
}

/// Names of the choices that change anything in this model: DCOM has no coloured noise to reduce a mode to.
pub(crate) fn heeded(model: &dyn AnyModel) -> Vec<&'static str> {
    let Some(set) = model.sets().into_iter().next() else {
        return Vec::new();
    };
    let heeded = model.table().choices.iter().filter(|choice| {
        let mut options = choice.options.iter();
        options.any(|option| {
            let mut changed = set.parameters.clone();
            option.apply_to(model.parameters().names, &mut changed);
            !model.is_same(&changed, &set.parameters)
        })
    });
    heeded.map(|choice| choice.name).collect()
}

/// Refuses a model without noise where noise is needed; `why` ends the sentence.
///
/// # Errors
///
/// [`Failure::Request`]
pub(crate) fn needs_noise(option: &str, model: &dyn AnyModel, why: &str) -> Result<(), Failure> {
    if model.channels() > 0 {
        return Ok(());
    }
    let noisy: Vec<_> = models()
        .filter(|model| model.channels() > 0)
        .map(AnyModel::name)
        .collect();
    let name = model.name();
    let others = match noisy.as_slice() {
        [] => format!("{name} has no noise"),
        [one] => format!("{name} has no noise; {one} has"),
        _ => format!("{name} has no noise; {} have", names::list(&noisy)),
    };
    Err(Failure::Request(format!("{option}: {others}{why}")))
}
