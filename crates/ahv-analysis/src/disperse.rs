//! Trims and roots of vehicles whose parameters are drawn within their uncertainty.
//!
//! [`Draws`] says how; [`disperse`] draws, trims and linearises each member and pairs its poles and zeros with the nominal
//! ones; [`slopes`] tells the same spread to first order, and which parameters it comes from.

mod draws;
mod matching;
mod quantity;
mod slopes;
mod solution;
mod spread;

use std::convert::Infallible;
use std::sync::atomic::Ordering;

use ahv_core::GeneratedModel;

use crate::ordered::Control;
use crate::ordered::in_order;
use crate::trim::SteadyState;

pub use draws::{Distribution, DrawError, Draws, Group};
pub use matching::assignment;
pub use quantity::{Kind, Part, Quantity};
pub use slopes::{Contribution, Slopes, slopes};
pub use solution::{Solution, SolutionError, solve};
pub use spread::Spread;

use quantity::Ordered;

/// The vehicle about which is drawn, with the numbers that are followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Nominal {
    /// Where it flies.
    pub flight: SteadyState,
    /// The vehicle in trim.
    pub solution: Solution,
    /// What is followed.
    pub quantities: Vec<Quantity>,
}

/// The vehicle with these `parameters` in `flight`, and what is followed of it.
///
/// # Errors
///
/// [`SolutionError`].
pub fn nominal<M: GeneratedModel>(
    parameters: &M::ParametersOf<f64>,
    flight: SteadyState,
) -> Result<Nominal, SolutionError> {
    let solution = solve::<M>(parameters, &flight)?;
    let quantities = quantity::quantities(&solution, M::TRIM.shown);
    Ok(Nominal {
        flight,
        solution,
        quantities,
    })
}

impl Nominal {
    /// The quantities of the nominal vehicle.
    pub fn values(&self) -> Vec<f64> {
        let values = self.values_of(&self.solution).into_iter();
        values.map(Option::unwrap_or_default).collect()
    }

    /// The quantities of another vehicle. Poles correspond by mode, zeros such that the sum of the distances to the
    /// nominal ones is least; `None` where it has more or fewer of them.
    pub fn values_of(&self, solution: &Solution) -> Vec<Option<f64>> {
        let ordered = Ordered::new(&self.solution, solution);
        let value = |quantity: &Quantity| quantity.value(&ordered);
        self.quantities.iter().map(value).collect()
    }
}

/// A vehicle that was drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Its number, by which its parameters can be drawn again.
    pub number: u64,
    /// The vehicle in trim, or why there is none.
    pub solution: Result<Solution, SolutionError>,
    /// The values of the quantities; `None` where it has no such root, or no trim.
    pub values: Vec<Option<f64>>,
}

/// Vehicles 0 to `members` − 1 of `draws`, each in the flight of `nominal`; fewer if `control` stops the work.
///
/// A member does not depend on the others, nor on the number of threads.
pub fn disperse<M>(draws: &Draws, nominal: &Nominal, members: u64, control: &Control) -> Vec<Member>
where
    M: GeneratedModel,
{
    let member = |number| {
        if control.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let solution = solve::<M>(&draws.member(number), &nominal.flight);
        let values = match &solution {
            Ok(solution) => nominal.values_of(solution),
            Err(_) => vec![None; nominal.quantities.len()],
        };
        control.done.fetch_add(1, Ordering::Relaxed);
        Ok::<_, Infallible>(Some(Member {
            number,
            solution,
            values,
        }))
    };
    in_order(0..members, member).unwrap_or_else(|never| match never {})
}

/// The spread of each quantity over `members`; `None` where fewer than two have it.
pub fn spreads(members: &[Member], quantities: usize) -> Vec<Option<Spread>> {
    let of = |index: usize| {
        let values = members
            .iter()
            .filter_map(|member| *member.values.get(index)?);
        Spread::of(&values.collect::<Vec<_>>())
    };
    (0..quantities).map(of).collect()
}
