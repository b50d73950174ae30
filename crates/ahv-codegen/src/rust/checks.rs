//! Names of tables that become names of the package: each must be valid and free.

use super::home;
use crate::ir::Document;
use crate::subject::Subject;
use crate::{EmitError, Table, Tree};

/// Types that stand beside those of choices.
const TYPES: [&str; 24] = [
    "Bounds",
    "Curvatures",
    "Diffusion",
    "Hessian",
    "Input",
    "InputJacobian",
    "Intermediates",
    "Model",
    "Noise",
    "NoiseClass",
    "NoiseDerivatives",
    "NoiseMatrix",
    "NoiseSlopes",
    "NoiseTerms",
    "Outputs",
    "ParameterJacobian",
    "Parameters",
    "Pattern",
    "Prepared",
    "Real",
    "Sensitivities",
    "Slopes",
    "State",
    "Validity",
];

/// The type of a choice must have a name of its own.
pub(crate) fn choices(table: &Table, document: &Document) -> Result<(), EmitError> {
    let mut choices = document.choices.iter();
    let taken = |name: &str| TYPES.contains(&name) || name == "StateJacobian" || name == "Vector";
    match choices.find(|choice| taken(&choice.type_name)) {
        Some(choice) => Err(EmitError::Mismatch(format!(
            "the type `{}` of the choice `{}` of {} has the name of a type that every model has; choose another name",
            choice.type_name, choice.name, table.file_name
        ))),
        None => Ok(()),
    }
}

/// Crates that every Rust program has.
const OWN_CRATES: [&str; 5] = ["alloc", "core", "proc_macro", "std", "test"];

/// The package's name must be one for a crate, and none of those that its manifest takes in.
pub(super) fn package(package: &str, cargo: &str) -> Result<(), EmitError> {
    let in_code = |name: &str| name.replace('-', "_");
    let name = in_code(package);
    let refused = |why: &str| {
        let message =
            format!("the package cannot be called `{package}`: {why}; choose another name");
        Err(EmitError::Mismatch(message))
    };
    if syn::parse_str::<syn::Ident>(&name).is_err() {
        return refused("Rust has a word of its own like that");
    }
    let document = cargo.parse::<toml_edit::DocumentMut>();
    let document = document.map_err(|error| EmitError::Manifest(error.to_string()))?;
    let dependencies = document
        .get("dependencies")
        .and_then(|it| it.as_table_like());
    let mut dependencies = dependencies.into_iter().flat_map(|it| it.iter());
    if dependencies.any(|(dependency, _)| in_code(dependency) == name) {
        return refused("it needs a package of that name itself");
    }
    if OWN_CRATES.contains(&name.as_str()) {
        return refused("Rust has a crate of that name");
    }
    Ok(())
}

/// A set is a constant beside those that the models have anyway, whichever they are: all are in the tree by now.
pub(super) fn sets(subject: &Subject<'_>, tree: &Tree) -> Result<(), EmitError> {
    let models = &subject.document.models;
    let own = |path: &str| {
        let mut modules = models.iter().map(|model| format!("src/{}/", model.name));
        modules.any(|module| path.starts_with(&module))
    };
    for set in subject.document.sets.iter().skip(1) {
        for constant in home::constants(&set.name) {
            let constants = [
                format!("\npub const {constant}:"),
                format!(", {constant}: "),
            ];
            let files = tree.iter().filter(|(path, _)| own(path));
            let defines = |text: &str| constants.iter().any(|it| text.contains(it));
            if files.filter(|(_, text)| defines(text)).count() > 1 {
                return Err(EmitError::Mismatch(format!(
                    "the set `{}` of {} would become the constant {constant}, which the models have already; choose another \
                     name",
                    set.name, subject.table.file_name
                )));
            }
        }
    }
    Ok(())
}
