//! A single flight without noise, with steps as long as a tolerance allows.

use ahv_core::{GeneratedModel, NoInline};
use ahv_integrate::{
    Adaptive, Constant, Crossing, DormandPrince54, DormandPrince853, Ending, Event, Failure,
    Method, Problem, Progress, Rodas4, Tsit5,
};

use super::{DeterministicScheme, StepperError, values, vector};

/// Steps of a flight, refused ones included, beyond which it is taken for one that chatters at a boundary.
const MOST_STEPS: u32 = 10_000_000;

/// A passage of a boundary of the drift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Name of the boundary.
    pub boundary: &'static str,
    /// Time in s.
    pub time: f64,
}

/// Takes a flight with this held input to this time, in s, and tells of the passages on its way; where it fails, the flight stands
/// at the last good time.
pub type Fly = Box<
    dyn FnMut(&mut Progress<Vec<f64>>, &[f64], f64, &mut dyn FnMut(Passage)) -> Result<(), Failure>,
>;

/// The steps of `scheme` under control of their error: that of each state is at most `tolerance` of its value and of the width of its
/// validity box, in the root mean square over the states. Where the drift goes over to another formula the flight is
/// stopped and goes on from there, so that no step holds a kink.
///
/// # Errors
///
/// [`StepperError::NoErrorEstimate`]
pub(super) fn fly<M: GeneratedModel>(
    scheme: DeterministicScheme,
    model: M,
    tolerance: f64,
) -> Result<Fly, StepperError> {
    Ok(match scheme {
        DeterministicScheme::DormandPrince54 => by(DormandPrince54, model, tolerance),
        DeterministicScheme::Tsit5 => by(Tsit5, model, tolerance),
        DeterministicScheme::DormandPrince853 => by(DormandPrince853, model, tolerance),
        DeterministicScheme::Rodas4 => by(Rodas4, model, tolerance),
        DeterministicScheme::Euler
        | DeterministicScheme::Heun
        | DeterministicScheme::Rk4
        | DeterministicScheme::Exponential => {
            return Err(StepperError::NoErrorEstimate {
                scheme: scheme.name(),
            });
        }
    })
}

fn by<M: GeneratedModel, S: Method<NoInline<M>> + Copy + 'static>(
    method: S,
    model: M,
    tolerance: f64,
) -> Fly {
    let model = NoInline(model);
    let absolute = M::map_state(&M::STATE_BOUNDS, |bounds| {
        tolerance * (bounds.max - bounds.min)
    });
    let solver = Adaptive::new(method, tolerance, absolute);
    Box::new(move |flight, u, end, passed| {
        let input: M::Input = vector(u);
        let boundaries: Vec<Boundary<'_, M>> = M::BOUNDARIES
            .iter()
            .enumerate()
            .map(|(index, &name)| Boundary {
                name,
                index,
                model: &model.0,
                input: &input,
            })
            .collect();
        let events: Vec<&dyn Event<NoInline<M>>> = boundaries
            .iter()
            .map(|it| it as &dyn Event<NoInline<M>>)
            .collect();
        let held = Constant(input);
        let problem = Problem::new(&model, &held).events(&events);
        let mut progress = Progress {
            time: flight.time,
            state: vector(&flight.state),
            step: flight.step,
            accepted: flight.accepted,
            refused: flight.refused,
        };
        let outcome = loop {
            let taken = progress.accepted.saturating_add(progress.refused);
            let solver = solver.most_steps(MOST_STEPS.saturating_sub(taken));
            match solver.run(&problem, &mut progress, end, &mut ()) {
                Ok(Ending::Event(at)) => passed(Passage {
                    boundary: at.name,
                    time: at.time,
                }),
                Ok(Ending::Time) => break Ok(()),
                Err(failure) => break Err(failure),
            }
        };
        *flight = Progress {
            time: progress.time,
            state: values(&progress.state),
            step: progress.step,
            accepted: progress.accepted,
            refused: progress.refused,
        };
        outcome
    })
}

/// A boundary of the drift as an event.
struct Boundary<'a, M: GeneratedModel> {
    name: &'static str,
    index: usize,
    model: &'a M,
    input: &'a M::Input,
}

impl<M: GeneratedModel> Event<NoInline<M>> for Boundary<'_, M> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn value(&self, _: f64, x: &M::State) -> f64 {
        self.model.boundary(self.index, x, self.input)
    }

    fn crossing(&self) -> Crossing {
        Crossing::Either
    }
}
