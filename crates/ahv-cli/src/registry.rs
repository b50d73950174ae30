//! The models that this program knows: those of the package that it was built over.

use std::sync::OnceLock;

use ahv_core::{
    GeneratedModel, ModelList, ModelVisitor, ParameterSetOf, Table, TrimProblem, Vector,
};

use ahv_table::Family;

use crate::ModelCommand;
use crate::failure::Failure;
use crate::names;

/// A model, behind what is the same for all.
pub(crate) struct Registered {
    /// Its name.
    pub(crate) name: &'static str,
    /// What it is.
    pub(crate) title: &'static str,
    /// Its table.
    pub(crate) table: &'static Table,
    /// Its table, for the check of another.
    pub(crate) family: Family,
    /// What a steady state of it is.
    pub(crate) trim: TrimProblem,
    /// Whether noise drives it.
    pub(crate) has_noise: bool,
    /// Unit and SI unit of a state.
    units: fn(&str) -> Option<[&'static str; 2]>,
    /// Names of the choices that change anything in it.
    pub(crate) choices: fn() -> Vec<&'static str>,
    /// Runs a command with it.
    pub(crate) run: fn(&ModelCommand) -> Result<(), Failure>,
}

impl Registered {
    fn new<M: GeneratedModel>() -> Self {
        Self {
            name: M::NAME,
            title: M::TITLE,
            table: M::TABLE,
            family: Family::of::<M>(),
            trim: M::TRIM,
            has_noise: <M::Noise as Vector<f64>>::LEN > 0,
            units: |name| {
                let index = <M::State as Vector<f64>>::index_of(name)?;
                let unit = <M::State as Vector<f64>>::UNITS.get(index)?;
                Some([*unit, *<M::State as Vector<f64>>::SI_UNITS.get(index)?])
            },
            choices: heeded::<M>,
            run: ModelCommand::run::<M>,
        }
    }

    /// Unit and SI unit of a state.
    pub(crate) fn units(&self, state: &str) -> [&'static str; 2] {
        (self.units)(state).unwrap_or(["1", "1"])
    }
}

/// Names of the choices that change anything in this model: DCOM has no coloured noise to reduce a mode to.
pub(crate) fn heeded<M: GeneratedModel>() -> Vec<&'static str> {
    let Some(ParameterSetOf::<M> { parameters, .. }) = M::SETS.first() else {
        return Vec::new();
    };
    let model = M::with_parameters(parameters);
    let changes =
        |option: &ahv_core::ChoiceOption| M::with_parameters(&option.apply(*parameters)) != model;
    let heeded = M::TABLE.choices.iter();
    let heeded = heeded.filter(|choice| choice.options.iter().any(changes));
    heeded.map(|choice| choice.name).collect()
}

static REGISTRY: OnceLock<Vec<Registered>> = OnceLock::new();

struct Collector(Vec<Registered>);

impl ModelVisitor for Collector {
    fn visit<M: GeneratedModel>(&mut self) {
        self.0.push(Registered::new::<M>());
    }
}

/// Makes the models of `L` those that this program knows; the first call of a process decides.
pub(crate) fn register<L: ModelList>() {
    REGISTRY.get_or_init(|| {
        let mut collector = Collector(Vec::new());
        L::visit(&mut collector);
        collector.0
    });
}

/// The models that this program knows.
pub(crate) fn models() -> &'static [Registered] {
    REGISTRY.get().map_or(&[], Vec::as_slice)
}

/// What to say of a model without noise where noise is needed.
pub(crate) fn without_noise<M: GeneratedModel>() -> String {
    let noisy = models().iter().filter(|model| model.has_noise);
    let noisy: Vec<_> = noisy.map(|model| model.name).collect();
    match noisy.as_slice() {
        [] => format!("{} has no noise", M::NAME),
        [one] => format!("{} has no noise; {one} has", M::NAME),
        _ => format!("{} has no noise; {} have", M::NAME, names::list(&noisy)),
    }
}
