//! What compilers take before anything runs.

use serde::Serialize;

use crate::candidates::{Candidate, PRODUCT, REFERENCE};
use crate::ensembles::Ensembles;
use crate::race::{Finish, NUMPY};
use crate::table::Table;

/// Seconds of a compiler.
#[derive(Serialize)]
pub(crate) struct Compilation {
    pub(crate) what: &'static str,
    pub(crate) candidate: &'static str,
    pub(crate) seconds: f64,
}

/// Those of all candidates; of just-in-time compilers until the first run is over.
pub(crate) fn all(
    candidates: &[Candidate],
    ensembles: &Ensembles,
    groups: &[(&'static str, &Vec<Finish>)],
) -> Vec<Compilation> {
    let kernel = |it: &Candidate| Compilation {
        what: "the timed functions",
        candidate: it.name,
        seconds: it.compiled + it.kernels.iter().map(|kernel| kernel.first()).sum::<f64>(),
    };
    let mut found: Vec<_> = candidates.iter().map(kernel).collect();
    found.push(Compilation {
        what: "Monte Carlo of SDCOM and section 5.1",
        candidate: "CasADi's step in C++",
        seconds: ensembles.compiled,
    });
    for (what, finishes) in groups {
        // NumPy compiles nothing.
        let compiled = |it: &&Finish| it.threads == 1 && it.first > 0.0 && it.candidate != NUMPY;
        let late = finishes.iter().filter(compiled);
        found.extend(late.map(|it| Compilation {
            what,
            candidate: it.candidate,
            seconds: it.first,
        }));
    }
    found
}

/// For people.
pub(crate) fn table(compilations: &[Compilation]) -> Table {
    let row = |it: &Compilation| {
        vec![
            it.what.to_owned(),
            it.candidate.to_owned(),
            format!("{:.2}", it.seconds),
        ]
    };
    Table {
        title: "Compilation".to_owned(),
        note: format!(
            "Once, one after the other, and not part of any time above. The timed functions are the three of the first table; \
             `{PRODUCT}` compiles the whole generated package, all functions of all models, beside them. {REFERENCE} and SymForce: gcc and \
             g++ on the generated source; wrenfold: rustc, with its dependencies compiled before; numba, JAX and diffrax: until \
             the first run on one thread is over, less the time of a run."
        ),
        columns: vec!["what", "candidate", "s"],
        rows: compilations.iter().map(row).collect(),
    }
}
