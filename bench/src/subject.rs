//! What is timed.

use ahv_core::{Pattern, Vector};
use ahv_models::{dcom, sdcom};

/// A model, for its vectors and its box of validity.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Model {
    /// Deterministic.
    Dcom,
    /// Stochastic.
    Sdcom,
}

impl Model {
    /// Module of the generated package.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Dcom => "dcom",
            Self::Sdcom => "sdcom",
        }
    }

    /// Names and nominal values of the parameters.
    pub(crate) fn parameters(self) -> (&'static [&'static str], Vec<f64>) {
        let names = <dcom::Parameters<f64> as Vector<f64>>::NAMES;
        let nominal = match self {
            Self::Dcom => dcom::NOMINAL.to_array(),
            Self::Sdcom => sdcom::NOMINAL.to_array(),
        };
        (names, nominal.to_vec())
    }
}

/// One call that every candidate offers under the same name.
pub(crate) struct Subject {
    /// Name of the symbol in the libraries.
    pub(crate) symbol: &'static str,
    /// For people.
    pub(crate) title: &'static str,
    pub(crate) model: Model,
    /// Generated functions that it takes.
    pub(crate) functions: &'static [&'static str],
    /// Rows and columns of each output.
    pub(crate) shapes: &'static [(usize, usize)],
    /// Where the entries of the outputs after the first stand that the product has; of those without pattern it has all.
    pub(crate) patterns: &'static [Pattern<2>],
}

impl Subject {
    /// Length of all outputs, dense.
    pub(crate) fn dense(&self) -> usize {
        self.shapes
            .iter()
            .map(|(rows, columns)| rows * columns)
            .sum()
    }
}

const DCOM: usize = <dcom::State<f64> as Vector<f64>>::LEN;
const SDCOM: usize = <sdcom::State<f64> as Vector<f64>>::LEN;
const INPUT: usize = <dcom::Input<f64> as Vector<f64>>::LEN;
const NOISE: usize = <sdcom::Noise<f64> as Vector<f64>>::LEN;

/// All subjects.
pub(crate) const SUBJECTS: [Subject; 3] = [
    Subject {
        symbol: "dcom_drift",
        title: "DCOM drift",
        model: Model::Dcom,
        functions: &["drift"],
        shapes: &[(DCOM, 1)],
        patterns: &[],
    },
    Subject {
        symbol: "dcom_drift_jacobians",
        title: "DCOM drift + Jacobians",
        model: Model::Dcom,
        functions: &["drift_and_jacobians"],
        shapes: &[(DCOM, 1), (DCOM, DCOM), (DCOM, INPUT)],
        patterns: &[dcom::STATE_JACOBIAN_PATTERN, dcom::INPUT_JACOBIAN_PATTERN],
    },
    Subject {
        symbol: "sdcom_drift_diffusion",
        title: "SDCOM drift + diffusion",
        model: Model::Sdcom,
        functions: &["drift_and_diffusion"],
        shapes: &[(SDCOM, 1), (SDCOM, NOISE)],
        patterns: &[],
    },
];
