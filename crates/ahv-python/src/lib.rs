//! The generated models and the commands as a module of Python, over whichever models it is given.
//!
//! A module over a package of models is one line; its crate is a `cdylib` of the module's name:
//!
//! ```
//! mod extension {
//!     ahv_python::module! {
//!         /// The models of a package.
//!         _models, ahv_models::Models, Vec::new(), &[]
//!     }
//! }
//! ```
//!
//! The module is for the package `ahv` of Python (`python/ahv`), which gives its numbers names and units. It holds functions
//! of whole arrays ([`Vehicle`](vehicle::Vehicle)), the commands in the words of their lines, and the linear algebra.
//!
//! No code here is unsafe by hand. The macros of PyO3 write entry points that Python calls, so that the crate cannot forbid
//! unsafe code as the others do.

mod commands;
mod failure;
mod linear;
mod rows;
mod vehicle;

use std::sync::OnceLock;

use ahv_cli::ExtraCommand;
use ahv_core::ModelList;
use pyo3::prelude::*;

#[doc(hidden)]
pub use pyo3;

/// Makes the commands that a module has beside the general ones.
pub type Extra = fn() -> Vec<ExtraCommand>;

/// Runs a program by its command line.
type Program = fn(Vec<String>) -> u8;

/// What a module was built over.
struct Built {
    extra: Extra,
    program: Program,
    documents: &'static [&'static str],
}

static BUILT: OnceLock<Built> = OnceLock::new();

/// What this module was built over.
fn built() -> &'static Built {
    BUILT.get_or_init(|| Built {
        extra: Vec::new,
        program: |_| 2,
        documents: &[],
    })
}

/// A module of Python: its name, the models of a package, what makes a list of further commands, and the texts of the
/// package's IR, from which the models are written down for other programs.
#[macro_export]
macro_rules! module {
    ($(#[$doc:meta])* $name:ident, $models:ty, $extra:expr, $documents:expr) => {
        use $crate::pyo3;

        $(#[$doc])*
        #[pyo3::pymodule]
        fn $name(module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
            $crate::fill::<$models>(module, || $extra, $documents)
        }
    };
}

/// Puts the models of `L`, and what is done with them, into a module.
///
/// # Errors
///
/// Those of Python.
pub fn fill<L: ModelList>(
    module: &Bound<'_, PyModule>,
    extra: Extra,
    texts: &'static [&'static str],
) -> PyResult<()> {
    ahv_cli::embedded::register::<L>();
    BUILT.get_or_init(|| Built {
        extra,
        program: |line| {
            let line = line.into_iter().map(Into::into);
            ahv_cli::run_line::<L>(line, &(built().extra)())
        },
        documents: texts,
    });
    module.add_class::<vehicle::Vehicle>()?;
    module.add_class::<commands::CampaignLock>()?;
    module.add_function(wrap_pyfunction!(vehicle::models, module)?)?;
    module.add_function(wrap_pyfunction!(commands::command, module)?)?;
    module.add_function(wrap_pyfunction!(commands::main, module)?)?;
    module.add_function(wrap_pyfunction!(documents, module)?)?;
    module.add_function(wrap_pyfunction!(linear::zeros, module)?)?;
    module.add_function(wrap_pyfunction!(linear::regulator, module)?)
}

/// Texts of the IR of the package, in JSON.
#[pyfunction]
fn documents() -> Vec<&'static str> {
    built().documents.to_vec()
}
