//! The time of a step of every stepper with a fixed step, beside a step of CasADi's C.

use ahv_core::Vector;
use ahv_integrate::{
    AdditiveChannels, CommutativeChannels, DormandPrince54, DormandPrince853, Euler, Exponential,
    Fixed, Heun, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting,
    KeyedNormals, LinearTransition, NormalSource as _, Rk4, Rodas4, StratonovichHeun, Tsit5,
    WeakIncrements, WienerIntegrals,
};
use ahv_models::{dcom, sdcom, sdcom_gust};

use super::flights::{Flight, Flights};
use super::group::{COUNT, DT, Group, StepTime, values};
use super::library::Steps;
use super::own;

/// Noise for all steps, drawn before.
struct Tape<W> {
    integrals: Vec<WienerIntegrals<W>>,
    weak: Vec<WeakIncrements<W>>,
    normals: Vec<[[f64; 3]; 2]>,
}

impl<W: Vector<f64>> Tape<W> {
    fn draw() -> Self {
        let mut source = KeyedNormals { seed: 1, member: 0 };
        let mut tape = Self {
            integrals: Vec::new(),
            weak: Vec::new(),
            normals: Vec::new(),
        };
        // Numbers of a step from a place that the channels before have not reached.
        for step in 0..COUNT as u64 {
            let [first, second] =
                [0, W::LEN].map(|from| W::from_fn(|i| source.normal(step, from + i)));
            tape.integrals
                .push(WienerIntegrals::from_normals(DT, first, second));
            let from = 2 * W::LEN;
            tape.weak.push(WeakIncrements::from_normals(DT, |i| {
                source.normal(step, from + i)
            }));
            let from = 4 * W::LEN;
            let three = |half: usize| [0, 1, 2].map(|i| from + 3 * half + i);
            let normals = [three(0), three(1)];
            tape.normals
                .push(normals.map(|it| it.map(|channel| source.normal(step, channel))));
        }
        tape
    }

    fn increments(&self) -> Vec<Vec<f64>> {
        self.integrals.iter().map(|it| values(&it.dw)).collect()
    }
}

/// Times all steppers.
///
/// # Errors
/// A step that fails, or a scheme that does not end where CasADi's does.
pub(crate) fn measure(compiled: &Steps, rounds: u32) -> Result<Vec<StepTime>, String> {
    let flights = Flights::new();
    let [flight, _] = &flights.all;
    let mut times = on_dcom(compiled, flight)?.time(rounds)?;
    times.extend(on_sdcom(compiled, flight)?.time(rounds)?);
    let model = sdcom::Model::new(&flight.parameters);
    let tape = Tape::draw();
    let additive = |name: &str| name.starts_with("xi") || name == "w_q";
    let additive = AdditiveChannels::new(&model, additive).map_err(|it| format!("error: {it}"))?;
    let commutative = CommutativeChannels::new(&model, |name| name != "w_alpha");
    let commutative = commutative.map_err(|it| format!("error: {it}"))?;
    let mut group = stochastic(compiled, &model, &tape, flight)?;
    let (x, u) = (on_body(flight), sdcom::Input::from(flight.input.to_array()));
    group.add("`ItoMilstein`", "without w_alpha", x, |x, k| {
        ItoMilstein::new(DT).step(&commutative, x, &u, &tape.integrals[k].dw)
    });
    group.add("`ItoSra1`", "w_q and modes", x, |x, k| {
        ItoSra1::new(DT).step(&additive, x, &u, &tape.integrals[k])
    });
    times.extend(group.time(rounds)?);
    times.extend(on_sdcom_gust(compiled, flight)?.time(rounds)?);
    Ok(times)
}

/// Adds the deterministic steppers for any model.
macro_rules! deterministic {
    ($group:ident, $model:ident, $x:ident, $u:ident) => {
        $group.add("`Rk4`", "", $x, move |x, _| {
            Rk4::new(DT).step(&$model, x, &$u)
        });
        $group.add("`Euler`", "", $x, move |x, _| {
            Euler::new(DT).step(&$model, x, &$u)
        });
        $group.add("`Heun`", "", $x, move |x, _| {
            Heun::new(DT).step(&$model, x, &$u)
        });
        $group.add("`Fixed<Tsit5>`", "", $x, move |x, _| {
            Fixed::new(Tsit5, DT).step(&$model, x, &$u)
        });
        $group.add("`Fixed<DormandPrince54>`", "", $x, move |x, _| {
            Fixed::new(DormandPrince54, DT).step(&$model, x, &$u)
        });
        $group.add("`Fixed<DormandPrince853>`", "", $x, move |x, _| {
            Fixed::new(DormandPrince853, DT).step(&$model, x, &$u)
        });
        $group.add("`Fixed<Rodas4>`", "", $x, move |x, _| {
            Fixed::new(Rodas4, DT).step(&$model, x, &$u)
        });
    };
}

fn on_dcom<'s>(compiled: &Steps, flight: &Flight) -> Result<Group<'s>, String> {
    let model = dcom::Model::new(&flight.parameters);
    let (x, u) = (flight.start, flight.input);
    let mut group = Group::new("DCOM");
    let casadi = compiled.step("dcom_runge_kutta")?;
    group.add_casadi("CasADi RK4 in C", casadi, x.to_array(), flight, None);
    deterministic!(group, model, x, u);
    let exponential = Exponential::new(DT, own::modes(&flight.parameters)?);
    group.add("`Exponential`", "", x, move |x, _| {
        exponential.step(&model, x, &u)
    });
    Ok(group)
}

fn on_sdcom<'s>(compiled: &Steps, flight: &Flight) -> Result<Group<'s>, String> {
    let model = sdcom::Model::new(&flight.parameters);
    let (x, u) = (on_body(flight), sdcom::Input::from(flight.input.to_array()));
    let mut group = Group::new("SDCOM, drift");
    let casadi = compiled.step("sdcom_runge_kutta")?;
    group.add_casadi("CasADi RK4 in C", casadi, x.to_array(), flight, None);
    deterministic!(group, model, x, u);
    Ok(group)
}

/// The start without its modes.
fn on_body(flight: &Flight) -> sdcom::State<f64> {
    sdcom::State {
        velocity: flight.start.velocity,
        altitude: flight.start.altitude,
        gamma: flight.start.gamma,
        alpha: flight.start.alpha,
        pitch_rate: flight.start.pitch_rate,
        ..sdcom::State::splat(0.0)
    }
}

/// The stochastic steppers for all noise of SDCOM.
fn stochastic<'s>(
    compiled: &Steps,
    model: &'s sdcom::Model<f64>,
    tape: &'s Tape<sdcom::Noise<f64>>,
    flight: &Flight,
) -> Result<Group<'s>, String> {
    let (x, u) = (on_body(flight), sdcom::Input::from(flight.input.to_array()));
    let mut group = Group::new("SDCOM");
    let casadi = compiled.step("sdcom_euler_maruyama")?;
    let noise = Some(tape.increments());
    group.add_casadi(
        "CasADi Euler–Maruyama in C",
        casadi,
        x.to_array(),
        flight,
        noise,
    );
    group.add("`ItoEulerMaruyama`", "", x, move |x, k| {
        ItoEulerMaruyama::new(DT).step(model, x, &u, &tape.integrals[k].dw)
    });
    group.add("`StratonovichHeun`", "", x, move |x, k| {
        StratonovichHeun::new(DT).step(model, x, &u, &tape.integrals[k].dw)
    });
    group.add("`ItoHeun`", "", x, move |x, k| {
        ItoHeun::new(DT).step(model, x, &u, &tape.integrals[k].dw)
    });
    group.add("`ItoDri1`", "", x, move |x, k| {
        ItoDri1::new(DT).step(model, x, &u, &tape.weak[k])
    });
    let splitting = ItoStrangSplitting::<f64, 3>::new(model, &x, &u, DT);
    let splitting = splitting.map_err(|it| format!("error: {it}"))?;
    group.add("`ItoStrangSplitting` with `ItoHeun`", "", x, move |x, k| {
        let dw = &tape.integrals[k].dw;
        splitting.step_heun(model, x, &u, dw, &tape.normals[k])
    });
    let p = &model.prepared;
    let rates = [p.chi_decay_1, p.chi_decay_2, p.chi_decay_3];
    let gains = [p.chi_diffusion_1, p.chi_diffusion_2, p.chi_diffusion_3];
    let diagonal =
        |of: [f64; 3]| [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { of[i] } else { 0.0 }));
    let transition = LinearTransition::new(
        diagonal(rates.map(|it| -it)),
        diagonal(gains.map(|it| it * it)),
        DT,
    );
    let transition = transition.map_err(|it| format!("error: {it}"))?;
    group.add_run("`LinearTransition`", "the three χ", move || {
        let start = [0.0; 3];
        let step = |x, normals: &[[f64; 3]; 2]| transition.step(&x, &[0.0; 3], &normals[0]);
        Ok(tape.normals.iter().fold(start, step).to_vec())
    });
    Ok(group)
}

fn on_sdcom_gust<'s>(compiled: &Steps, flight: &Flight) -> Result<Group<'s>, String> {
    let model = sdcom_gust::Model::new(&flight.parameters);
    let tape = Tape::<sdcom_gust::Noise<f64>>::draw();
    let u = sdcom_gust::Input::from(flight.input.to_array());
    let body = on_body(flight);
    let x = sdcom_gust::State {
        velocity: body.velocity,
        altitude: body.altitude,
        gamma: body.gamma,
        alpha: body.alpha,
        pitch_rate: body.pitch_rate,
        ..sdcom_gust::State::splat(0.0)
    };
    let mut group = Group::new("SDCOM with gust");
    let casadi = compiled.step("sdcom_gust_euler_maruyama")?;
    let noise = Some(tape.increments());
    group.add_casadi(
        "CasADi Euler–Maruyama in C",
        casadi,
        x.to_array(),
        flight,
        noise,
    );
    let integrals = tape.integrals.clone();
    group.add("`ItoEulerMaruyama`", "", x, move |x, k| {
        ItoEulerMaruyama::new(DT).step(&model, x, &u, &integrals[k].dw)
    });
    let integrals = tape.integrals.clone();
    group.add("`ItoMilstein`", "", x, move |x, k| {
        ItoMilstein::new(DT).step(&model, x, &u, &integrals[k].dw)
    });
    group.add("`ItoSra1`", "", x, move |x, k| {
        ItoSra1::new(DT).step(&model, x, &u, &tape.integrals[k])
    });
    Ok(group)
}
