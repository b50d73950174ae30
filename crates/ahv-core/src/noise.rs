//! What kind of noise drives a model.

/// How a column of the diffusion depends on the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoiseClass {
    /// Not at all: additive noise.
    Constant,
    /// Each entry on the state of its own row alone.
    Diagonal,
    /// On any state.
    General,
}
