//! Stochastic backstepping with command filters, designed on the strict-feedback form (27) of SDCOM.
//!
//! The derivation stands in `docs/closed-loop.md`, with the equation numbers (C1) … that are quoted here.

use ahv_core::{Bounds, ColouredNoise, Vector};
use ahv_models::sdcom::{self, Input, Model, Parameters, STATE_BOUNDS, State};

use crate::track::{Controller, PERIOD, Reference};

/// A loop of the design: one equation of (27).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// Decay c of the error, in 1/s.
    pub decay: f64,
    /// Scale r of the error in the Lyapunov function, in the unit of the state.
    pub scale: f64,
}

/// Numbers of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    /// Velocity, by φ.
    pub velocity: Loop,
    /// Altitude, by γ.
    pub altitude: Loop,
    /// Flight path, by α.
    pub gamma: Loop,
    /// Angle of attack, by Q.
    pub alpha: Loop,
    /// Pitch rate, by δe.
    pub pitch_rate: Loop,
    /// Double poles of the command filters of γ, α and Q, in rad/s.
    pub filters: [f64; 3],
    /// Bandwidth of the observers of Δf_V, Δf_γ and Δf_Q, in 1/s.
    pub observers: [f64; 3],
    /// Bandwidth of the elevator deflection that the flight path's loop sees, in rad/s.
    pub elevator: f64,
}

/// The design that `ahv track` flies. `docs/closed-loop.md` has its numbers, beside the errors that were measured with it.
pub const DESIGN: Design = Design {
    velocity: Loop {
        decay: 0.4,
        scale: 0.3,
    },
    altitude: Loop {
        decay: 0.12,
        scale: 25.0,
    },
    gamma: Loop {
        decay: 0.35,
        scale: 4e-4,
    },
    alpha: Loop {
        decay: 2.0,
        scale: 1e-3,
    },
    pitch_rate: Loop {
        decay: 6.0,
        scale: 2e-3,
    },
    filters: [3.0, 3.0, 20.0],
    observers: [0.5, 0.5, 2.0],
    elevator: 0.3,
};

/// What the controller remembers: the filters of γ, α and Q with their rates, the slow elevator, the observed V, γ and Q.
pub type Memory = [f64; 10];

/// The controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Backstepping {
    design: Design,
    model: Model<f64>,
    /// Stationary covariance of χ, in ft·slug.
    coloured: [[f64; 3]; 3],
}

/// Equation of (27) at one state: what the loop needs to know of it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Equation {
    /// f: the rate that the virtual control does not make.
    f: f64,
    /// g: what one unit of the virtual control adds.
    g: f64,
    /// Decay of the error with what (C9) adds for the noise, in 1/s.
    decay: f64,
}

/// The loops' equations, V h γ α Q.
type Equations = [Equation; 5];

impl Backstepping {
    /// The controller of `design` for an SDCOM with these parameters.
    pub fn new(design: Design, parameters: &Parameters<f64>) -> Self {
        let model = Model::new(parameters);
        // The rows of χ in G depend on parameters alone.
        let (x, u) = (State::splat(0.0), Input::splat(0.0));
        let g = sdcom::diffusion(&x, &u, &model.prepared);
        let rows = [g.chi_1, g.chi_2, g.chi_3].map(|row| row.to_array());
        let decay = ["chi_1", "chi_2", "chi_3"].map(|name| {
            let index = <State<f64> as Vector<f64>>::index_of(name);
            index
                .and_then(|index| model.decay(index))
                .unwrap_or(f64::INFINITY)
        });
        let covariance = |i: usize, j: usize| {
            let intensity: f64 = rows[i].iter().zip(rows[j]).map(|(a, b)| a * b).sum();
            intensity / (decay[i] + decay[j])
        };
        let coloured = std::array::from_fn(|i| std::array::from_fn(|j| covariance(i, j)));
        Self {
            design,
            model,
            coloured,
        }
    }

    /// κ of (C10) at (x, u), in 1/s: in the mean the Lyapunov function decays at 4κ while it exceeds its bound.
    pub fn margin(&self, x: &State<f64>, u: &Input<f64>) -> f64 {
        let loops = self.loops();
        let [_, h, gamma, alpha, _] = self.equations(x, u, u);
        let [velocity, altitude, path, incidence, pitch] = loops;
        let into = [
            h.g * path.scale / altitude.scale,
            gamma.g * incidence.scale / path.scale,
            alpha.g * pitch.scale / incidence.scale,
        ];
        let margins = [
            velocity.decay,
            altitude.decay - 0.75 * into[0],
            path.decay - 0.75 * into[1] - 0.25 * into[0],
            incidence.decay - 0.75 * into[2] - 0.25 * into[1],
            pitch.decay - 0.25 * into[2],
        ];
        margins.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// c + n of the loops V, h, γ, α, Q at (x, u), in 1/s: the decays of (C9).
    pub fn decays(&self, x: &State<f64>, u: &Input<f64>) -> [f64; 5] {
        self.equations(x, u, u).map(|equation| equation.decay)
    }

    fn loops(&self) -> [Loop; 5] {
        let design = &self.design;
        [
            design.velocity,
            design.altitude,
            design.gamma,
            design.alpha,
            design.pitch_rate,
        ]
    }

    /// The equations at (x, u), those of γ and α with the elevator of `slow`.
    fn equations(&self, x: &State<f64>, u: &Input<f64>, slow: &Input<f64>) -> Equations {
        let p = &self.model.prepared;
        let [velocity, altitude, gamma, alpha, pitch_rate] = self.loops();
        let [l_v, l_gamma, l_q] = self.design.observers;
        let noise = [
            sdcom::H_V(x, u, p) * p.w_alpha,
            x.velocity * p.w_gamma,
            sdcom::H_gamma(x, u, p) * p.w_alpha,
            (sdcom::H_alpha(x, u, p) * p.w_alpha).hypot(p.w_q),
            sdcom::H_Q(x, u, p) * p.w_alpha,
        ];
        let coloured = |h: [f64; 3]| self.coloured_variance(h);
        // The error of an observer of bandwidth l has the variance l |G|²/2.
        let disturbance = [
            coloured(sdcom::h_V(x, u, p)) + 0.5 * l_v * noise[0] * noise[0],
            0.0,
            coloured(sdcom::h_gamma(x, u, p)) + 0.5 * l_gamma * noise[2] * noise[2],
            coloured(sdcom::h_alpha(x, u, p)) + 0.5 * l_gamma * noise[2] * noise[2],
            coloured(sdcom::h_Q(x, u, p)) + 0.5 * l_q * noise[4] * noise[4],
        ];
        let equation = |index: usize, design: Loop, f: f64, g: f64| Equation {
            f,
            g,
            decay: design.decay + design.for_noise(noise[index], disturbance[index].sqrt()),
        };
        [
            equation(0, velocity, sdcom::f_V(x, u, p), sdcom::g_V(x, u, p)),
            equation(1, altitude, 0.0, x.velocity),
            equation(
                2,
                gamma,
                sdcom::f_gamma(x, slow, p),
                sdcom::g_gamma(x, slow, p),
            ),
            equation(
                3,
                alpha,
                sdcom::f_alpha(x, slow, p),
                sdcom::g_alpha(x, slow, p),
            ),
            equation(4, pitch_rate, sdcom::f_Q(x, u, p), sdcom::g_Q(x, u, p)),
        ]
    }

    /// Variance of h χ.
    fn coloured_variance(&self, h: [f64; 3]) -> f64 {
        let row = |row: &[f64; 3]| row.iter().zip(h).map(|(c, h)| c * h).sum::<f64>();
        self.coloured.iter().zip(h).map(|(c, h)| h * row(c)).sum()
    }
}

impl Loop {
    /// What (C9) adds to the decay for white noise of intensity `white` and a disturbance of standard deviation
    /// `disturbance`, in 1/s.
    fn for_noise(&self, white: f64, disturbance: f64) -> f64 {
        let relative = white * white / (self.scale * self.scale);
        0.75 * (relative * relative / self.decay + disturbance / self.scale)
    }
}

impl Controller for Backstepping {
    type Memory = Memory;

    fn start(&self, x: &State<f64>, u: &Input<f64>) -> Memory {
        let State {
            velocity,
            gamma,
            alpha,
            pitch_rate,
            ..
        } = *x;
        [
            gamma, 0.0, alpha, 0.0, pitch_rate, 0.0, u.delta_e, velocity, gamma, pitch_rate,
        ]
    }

    fn command(
        &self,
        memory: &mut Memory,
        reference: &Reference,
        x: &State<f64>,
        u: &Input<f64>,
    ) -> Input<f64> {
        let [
            gamma_c,
            gamma_rate_c,
            alpha_c,
            alpha_rate_c,
            pitch_rate_c,
            pitch_acceleration_c,
            elevator,
            observed @ ..,
        ] = *memory;
        let slow = Input {
            delta_e: elevator,
            ..*u
        };
        let [v, h, gamma, alpha, q] = self.equations(x, u, &slow);
        let p = &self.model.prepared;
        let rates = [
            v.f + v.g * u.phi,
            sdcom::f_gamma(x, u, p) + sdcom::g_gamma(x, u, p) * x.alpha,
            q.f + q.g * u.delta_e,
        ];
        let measured = [x.velocity, x.gamma, x.pitch_rate];
        // (C7)
        let unknown: [f64; 3] =
            std::array::from_fn(|i| self.design.observers[i] * (measured[i] - observed[i]));

        // (C2)-(C6)
        let climb_rate = reference.climb_rate - h.decay * (x.altitude - reference.altitude);
        let gamma_0 = within(
            (climb_rate / h.g).clamp(-1.0, 1.0).asin(),
            STATE_BOUNDS.gamma,
        );
        let alpha_0 = gamma_rate_c - gamma.decay * (x.gamma - gamma_c) - gamma.f - unknown[1];
        let alpha_0 = within(alpha_0 / gamma.g, STATE_BOUNDS.alpha);
        let pitch_rate_0 = alpha_rate_c - alpha.decay * (x.alpha - alpha_c) - alpha.f + unknown[1];
        let pitch_rate_0 = within(pitch_rate_0 / alpha.g, STATE_BOUNDS.pitch_rate);
        let pitch_acceleration =
            pitch_acceleration_c - q.decay * (x.pitch_rate - pitch_rate_c) - unknown[2];
        let acceleration =
            reference.acceleration - v.decay * (x.velocity - reference.velocity) - unknown[0];
        let command = Input {
            phi: (acceleration - v.f) / v.g,
            // Q̇ is affine in δe; its slope takes in the path through the generalized forces.
            delta_e: u.delta_e + (pitch_acceleration - rates[2]) / sdcom::g_Q_total(x, u, p),
            delta_c: 0.0,
        };

        let [of_gamma, of_alpha, of_pitch_rate] = self.design.filters;
        let [a, b] = filtered([gamma_c, gamma_rate_c], gamma_0, of_gamma);
        let [c, d] = filtered([alpha_c, alpha_rate_c], alpha_0, of_alpha);
        let [e, f] = filtered(
            [pitch_rate_c, pitch_acceleration_c],
            pitch_rate_0,
            of_pitch_rate,
        );
        let slower =
            elevator + (u.delta_e - elevator) * -libm::expm1(-self.design.elevator * PERIOD);
        let [k, l, m] = std::array::from_fn(|i| observed[i] + PERIOD * (rates[i] + unknown[i]));
        *memory = [a, b, c, d, e, f, slower, k, l, m];
        command
    }
}

/// Value and rate of a command filter of second order with the double pole −`bandwidth`, one period on, its input held:
/// exact.
fn filtered([value, rate]: [f64; 2], input: f64, bandwidth: f64) -> [f64; 2] {
    let (error, t) = (value - input, bandwidth * PERIOD);
    let decayed = libm::exp(-t);
    [
        input + (error * (1.0 + t) + rate * PERIOD) * decayed,
        (rate * (1.0 - t) - bandwidth * t * error) * decayed,
    ]
}

fn within(value: f64, bounds: Bounds) -> f64 {
    value.clamp(bounds.min, bounds.max)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Vector2};

    use super::{PERIOD, filtered};

    /// ÿ = −2b ẏ − b² (y − input) about the input: e^{At} = e^{−bt} (1 + (A + b) t), for A + b has the square 0.
    #[test]
    fn a_command_filter_takes_exact_steps() {
        for b in [0.3_f64, 3.0, 20.0, 200.0] {
            let (input, start) = (0.7, Vector2::new(0.2 - 0.7, -1.5));
            let shifted = Matrix2::new(b, 1.0, -b * b, -b);
            let error = (start + shifted * start * PERIOD) * (-b * PERIOD).exp();
            let [value, rate] = filtered([0.2, -1.5], input, b);
            assert!((value - (input + error[0])).abs() < 1e-12, "{b}");
            assert!((rate - error[1]).abs() < 1e-12 * b.max(1.0), "{b}");
        }
    }
}
