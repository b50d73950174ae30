//! Parameters drawn within their uncertainty.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use ahv_core::{Shown, Vector};
use ahv_integrate::NormalStream;

use crate::values::{values, vector};

/// Set in the seed, so that parameters have nothing to do with the noise of flights of the same seed.
const PARAMETER_SEED: u64 = 0x5851_F42D_4C95_7F2D;
/// Standard deviations that the uncertainty of a normal parameter stands for.
const SIGMAS: f64 = 3.0;

/// How a parameter lies within its uncertainty; its mean is the table's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Uniform between value·(1 − uncertainty) and value·(1 + uncertainty).
    Uniform,
    /// Normal; the uncertainty is three standard deviations, so that 0.27 % of the draws lie beyond it.
    Normal,
}

impl Distribution {
    /// Standard deviation of a draw, in units of the uncertainty.
    pub fn deviation(self) -> f64 {
        match self {
            Self::Uniform => 1.0 / 3.0_f64.sqrt(),
            Self::Normal => 1.0 / SIGMAS,
        }
    }

    /// The draw, in units of the uncertainty, that belongs to a standard normal number.
    fn of_normal(self, z: f64) -> f64 {
        match self {
            Self::Uniform => libm::erf(z * FRAC_1_SQRT_2),
            Self::Normal => z / SIGMAS,
        }
    }

    /// Correlation that normal numbers need for draws with this one.
    fn latent(self, correlation: f64) -> f64 {
        match self {
            // Exactly 1 for 1: 2 sin(π/6) is not.
            Self::Uniform => (correlation * PI / 6.0).sin() / (PI / 6.0).sin(),
            Self::Normal => correlation,
        }
    }
}

/// Parameters that move together.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Its name.
    pub name: String,
    /// Indices of its parameters.
    pub parameters: Vec<usize>,
    /// Correlation of every two of them, 0 to 1, as relative changes.
    pub correlation: f64,
}

/// Why parameters cannot be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DrawError {
    /// An uncertainty that is negative or not finite.
    #[error("the uncertainty of {name} is {}; it must be finite and not negative", Shown(*value))]
    Uncertainty {
        /// The parameter.
        name: &'static str,
        /// Its uncertainty.
        value: f64,
    },
    /// A correlation outside 0 to 1.
    #[error("the correlation of group {group} is {}; it must lie between 0 and 1", Shown(*value))]
    Correlation {
        /// The group.
        group: String,
        /// Its correlation.
        value: f64,
    },
    /// A parameter that two groups, or one group twice, lay claim to.
    #[error("{name} stands in a group a second time, in {group}")]
    Twice {
        /// The parameter.
        name: &'static str,
        /// The second group.
        group: String,
    },
    /// An index beyond the parameters.
    #[error("group {group} holds the parameter number {index}, which there is not")]
    Unknown {
        /// The group.
        group: String,
        /// The index.
        index: usize,
    },
    /// Nothing to draw.
    #[error(
        "there is nothing to draw: every parameter that may vary has an uncertainty of 0, or a value of 0"
    )]
    Nothing,
}

/// Parameters with what is drawn.
///
/// A member is a function of (seed, member, parameter) alone. Draws of a group are joined by a normal copula with one
/// common factor, whose correlation is chosen such that the draws have the one asked for (of uniform numbers 2 sin(πρ/6)).
#[derive(Clone, Debug, PartialEq)]
pub struct Draws {
    nominal: Vec<f64>,
    uncertainty: Vec<f64>,
    distribution: Distribution,
    groups: Vec<Group>,
    /// Group of each parameter that is in one.
    group_of: Vec<Option<usize>>,
    seed: u64,
}

impl Draws {
    /// Draws about `nominal` within `uncertainty`, relative: 0.4 stands for 40 %. What has an uncertainty or a value of 0 stays.
    ///
    /// # Errors
    ///
    /// [`DrawError`].
    pub fn new<P: Vector<f64>>(
        nominal: P,
        uncertainty: P,
        distribution: Distribution,
        groups: Vec<Group>,
        seed: u64,
    ) -> Result<Self, DrawError> {
        let (nominal, uncertainty) = (values(&nominal), values(&uncertainty));
        Self::of_values(P::NAMES, nominal, uncertainty, distribution, groups, seed)
    }

    /// The same for parameters of these names.
    ///
    /// # Errors
    ///
    /// [`DrawError`].
    pub fn of_values(
        names: &[&'static str],
        nominal: Vec<f64>,
        uncertainty: Vec<f64>,
        distribution: Distribution,
        groups: Vec<Group>,
        seed: u64,
    ) -> Result<Self, DrawError> {
        let mut named = names.iter().zip(&uncertainty);
        if let Some((&name, &value)) = named.find(|(_, u)| !(u.is_finite() && **u >= 0.0)) {
            return Err(DrawError::Uncertainty { name, value });
        }
        let mut group_of = vec![None; nominal.len()];
        for (index, group) in groups.iter().enumerate() {
            let name = || group.name.clone();
            if !(0.0..=1.0).contains(&group.correlation) {
                return Err(DrawError::Correlation {
                    group: name(),
                    value: group.correlation,
                });
            }
            for &parameter in &group.parameters {
                let place = group_of
                    .get_mut(parameter)
                    .ok_or_else(|| DrawError::Unknown {
                        group: name(),
                        index: parameter,
                    })?;
                if place.replace(index).is_some() {
                    return Err(DrawError::Twice {
                        name: names.get(parameter).copied().unwrap_or_default(),
                        group: name(),
                    });
                }
            }
        }
        let draws = Self {
            nominal,
            uncertainty,
            distribution,
            groups,
            group_of,
            seed,
        };
        if draws.varied().is_empty() {
            return Err(DrawError::Nothing);
        }
        Ok(draws)
    }

    /// The parameters about which is drawn.
    pub fn nominal(&self) -> &[f64] {
        &self.nominal
    }

    /// How parameters lie within their uncertainty.
    pub const fn distribution(&self) -> Distribution {
        self.distribution
    }

    /// Indices of the parameters that vary.
    pub fn varied(&self) -> Vec<usize> {
        let varies = |&index: &usize| self.deviation(index) != 0.0;
        (0..self.nominal.len()).filter(varies).collect()
    }

    /// A standard deviation of a parameter, in its own unit, with the parameter's sign; 0 out of range.
    pub fn deviation(&self, index: usize) -> f64 {
        let number = |values: &[f64]| values.get(index).copied().unwrap_or(0.0);
        let (value, uncertainty) = (number(&self.nominal), number(&self.uncertainty));
        value * uncertainty * self.distribution.deviation()
    }

    /// Correlation of the relative changes of two parameters.
    pub fn correlation(&self, first: usize, second: usize) -> f64 {
        if first == second {
            return 1.0;
        }
        let group = |index: usize| self.group_of.get(index).copied().flatten();
        match group(first).filter(|&index| group(second) == Some(index)) {
            Some(index) => self.groups.get(index).map_or(0.0, |it| it.correlation),
            None => 0.0,
        }
    }

    /// The parameters of member number `member`.
    pub fn member<P: Vector<f64>>(&self, member: u64) -> P {
        vector(&self.member_values(member))
    }

    /// The same, in order.
    pub fn member_values(&self, member: u64) -> Vec<f64> {
        let seed = self.seed ^ PARAMETER_SEED;
        let normal = |channel: usize| NormalStream::new(seed, member, channel as u64).normal(0);
        let common: Vec<f64> = (0..self.groups.len())
            .map(|group| normal(self.nominal.len() + group))
            .collect();
        let pairs = self.nominal.iter().zip(&self.uncertainty).enumerate();
        let drawn = pairs.map(|(index, (&value, &uncertainty))| {
            // What stays, stays to the last bit.
            if value == 0.0 || uncertainty == 0.0 {
                return value;
            }
            let own = normal(index);
            let group = self.group_of.get(index).copied().flatten();
            let joined = group.and_then(|group| {
                let correlation = self.groups.get(group)?.correlation;
                Some((common.get(group)?, self.distribution.latent(correlation)))
            });
            let z = match joined {
                Some((common, latent)) => {
                    latent.sqrt() * common + (1.0 - latent).max(0.0).sqrt() * own
                }
                None => own,
            };
            value * (1.0 + uncertainty * self.distribution.of_normal(z))
        });
        drawn.collect()
    }
}
