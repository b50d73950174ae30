//! Schemes by their trait: the bits of their own steps, and refusals at set-up.
#![forbid(unsafe_code)]

use ahv_core::{StochasticModel, Vector};
use ahv_integrate::{
    Admits, Checked, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting,
    NoiseError, NormalStream, SdeScheme, Sense, StratonovichHeun, WeakIncrements, WienerIntegrals,
    WienerSource,
};
use ahv_models::{flexible_mode, sdcom};

type Sdcom = sdcom::Model<f64>;
type Mode = flexible_mode::Model<f64>;
type Splitting = ItoStrangSplitting<f64, 3>;

const SEED: u64 = 3;
const DT: f64 = 0.01;
const STEPS: u64 = 20;
const CHANNELS: usize = sdcom::Noise::<()>::LEN;

const START: sdcom::State<f64> = sdcom::State {
    velocity: 7702.0808,
    altitude: 85_000.0,
    gamma: 0.01,
    alpha: 0.0262,
    pitch_rate: 0.01,
    chi_1: 0.1,
    chi_2: 0.1,
    chi_3: 0.1,
};
const INPUT: sdcom::Input<f64> = sdcom::Input {
    phi: 0.2821,
    delta_e: 0.2286,
    delta_c: 0.0,
};

fn sdcom_model() -> Sdcom {
    Sdcom::new(&sdcom::NOMINAL)
}

fn normal(step: u64, index: usize) -> f64 {
    NormalStream::new(SEED, 0, index as u64).normal(step)
}

/// The end of a flight by the trait.
fn fly<M: StochasticModel<Scalar = f64>, S: SdeScheme<M>>(
    model: &M,
    start: M::State,
    u: &M::Input,
) -> Result<M::State, NoiseError> {
    let scheme = S::set_up(model, &start, u, DT)?;
    let mut x = start;
    for step in 0..STEPS {
        scheme
            .step_from_normals(model, &mut x, u, |index| normal(step, index))
            .expect("finite");
    }
    Ok(x)
}

/// The same by the scheme's own step, with the increments of a `WienerSource`.
fn alone(
    mut step: impl FnMut(&Sdcom, &mut sdcom::State<f64>, &sdcom::Noise<f64>, u64),
) -> sdcom::State<f64> {
    let (model, mut x) = (sdcom_model(), START);
    let mut wiener = WienerSource::<CHANNELS>::new(SEED, 0);
    for number in 0..STEPS {
        step(&model, &mut x, &wiener.increments(number, DT), number);
    }
    x
}

#[test]
fn a_step_from_normal_numbers_has_the_bits_of_the_scheme() {
    let model = sdcom_model();
    let euler = alone(|m, x, dw, _| {
        ItoEulerMaruyama::new(DT)
            .step(m, x, &INPUT, dw)
            .expect("finite");
    });
    assert_eq!(fly::<_, ItoEulerMaruyama>(&model, START, &INPUT), Ok(euler));
    let heun = alone(|m, x, dw, _| ItoHeun::new(DT).step(m, x, &INPUT, dw).expect("finite"));
    assert_eq!(fly::<_, ItoHeun>(&model, START, &INPUT), Ok(heun));
    let heun = alone(|m, x, dw, _| {
        StratonovichHeun::new(DT)
            .step(m, x, &INPUT, dw)
            .expect("finite");
    });
    assert_eq!(fly::<_, StratonovichHeun>(&model, START, &INPUT), Ok(heun));
    let dri1 = alone(|m, x, _, step| {
        let weak = WeakIncrements::from_normals(DT, |index| normal(step, index));
        ItoDri1::new(DT).step(m, x, &INPUT, &weak).expect("finite");
    });
    assert_eq!(fly::<_, ItoDri1>(&model, START, &INPUT), Ok(dri1));
    let split = Splitting::new(&model, &START, &INPUT, DT).expect("three coloured states");
    let splitting = alone(|m, x, dw, step| {
        let halves =
            [0, 3].map(|half| [0, 1, 2].map(|state| normal(step, CHANNELS + half + state)));
        split.step_heun(m, x, &INPUT, dw, &halves).expect("finite");
    });
    assert_eq!(fly::<_, Splitting>(&model, START, &INPUT), Ok(splitting));
}

/// `flexible_mode` has additive noise, and says so by its type: unchecked and checked are the same.
#[test]
fn schemes_for_some_noise_take_models_that_have_it() {
    let (model, start) = (
        Mode::new(&flexible_mode::NOMINAL),
        flexible_mode::State::splat(0.1),
    );
    let u = flexible_mode::Input { force: 1.0 };
    let milstein = fly::<_, ItoMilstein>(&model, start, &u).expect("admitted");
    assert_eq!(
        fly::<_, Checked<ItoMilstein>>(&model, start, &u),
        Ok(milstein)
    );
    assert_eq!(fly::<_, ItoEulerMaruyama>(&model, start, &u), Ok(milstein));
    let sra1 = fly::<_, ItoSra1>(&model, start, &u).expect("admitted");
    assert_eq!(fly::<_, Checked<ItoSra1>>(&model, start, &u), Ok(sra1));
    let mut x = start;
    for step in 0..STEPS {
        let numbers = [0, 1].map(|index| flexible_mode::Noise {
            xi: normal(step, index),
        });
        let integrals = WienerIntegrals::from_normals(DT, numbers[0], numbers[1]);
        ItoSra1::new(DT)
            .step(&model, &mut x, &u, &integrals)
            .expect("finite");
    }
    assert_eq!(x, sra1);
}

#[test]
fn noise_that_is_not_admitted_is_refused_at_set_up() {
    let refused = |model: &Sdcom| {
        [
            fly::<_, Checked<ItoMilstein>>(model, START, &INPUT).err(),
            fly::<_, Checked<ItoSra1>>(model, START, &INPUT).err(),
        ]
    };
    let class = Sdcom::noise_class(0);
    assert_eq!(
        refused(&sdcom_model()),
        [
            Some(NoiseError::NotCommuting {
                first: "w_gamma",
                second: "w_alpha"
            }),
            Some(NoiseError::NotAdditive {
                channel: "w_gamma",
                class
            }),
        ]
    );
    // Channels that are off ask for nothing.
    let off = sdcom::Parameters {
        w_alpha: 0.0,
        ..sdcom::NOMINAL
    };
    assert!(matches!(refused(&Sdcom::new(&off)), [None, Some(_)]));
    let off = sdcom::Parameters {
        w_gamma: 0.0,
        ..off
    };
    assert_eq!(refused(&Sdcom::new(&off)), [None, None]);
    let mode = Mode::new(&flexible_mode::NOMINAL);
    let (x, u) = (
        flexible_mode::State::splat(0.0),
        flexible_mode::Input { force: 0.0 },
    );
    assert_eq!(
        fly::<_, ItoStrangSplitting<f64, 1>>(&mode, x, &u),
        Err(NoiseError::SharedChannel {
            channel: "xi",
            state: "eta_dot"
        })
    );
}

#[test]
fn a_scheme_says_how_many_numbers_it_takes_and_which_it_uses() {
    fn numbers<S: SdeScheme<Sdcom>>() -> (usize, Vec<usize>) {
        let off = sdcom::Parameters {
            w_gamma: 0.0,
            w_alpha: 0.0,
            ..sdcom::NOMINAL
        };
        let model = Sdcom::new(&off);
        let scheme = S::set_up(&model, &START, &INPUT, DT).expect("admitted");
        let used = |index: &usize| scheme.uses(&model, &START, &INPUT, *index);
        (scheme.normals(), (0..20).filter(used).collect())
    }
    let first = |count| (count, (0..count).collect::<Vec<_>>());
    assert_eq!(numbers::<ItoEulerMaruyama>(), first(6));
    assert_eq!(numbers::<ItoHeun>(), first(6));
    assert_eq!(numbers::<StratonovichHeun>(), first(6));
    assert_eq!(numbers::<Checked<ItoMilstein>>(), first(6));
    assert_eq!(numbers::<Checked<ItoSra1>>(), first(12));
    assert_eq!(numbers::<ItoDri1>(), first(12));
    // Of the increments those of w_q alone, for w_gamma and w_alpha are off and the others drive coloured noise.
    let (count, used) = numbers::<Splitting>();
    assert_eq!((count, &used[..]), (12, &[2, 6, 7, 8, 9, 10, 11][..]));
}

#[test]
fn a_scheme_says_its_sense_and_its_noise() {
    fn says<S: SdeScheme<Sdcom>>() -> (Sense, Admits) {
        (S::SENSE, S::ADMITS)
    }
    assert_eq!(says::<ItoEulerMaruyama>(), (Sense::Ito, Admits::Any));
    assert_eq!(
        says::<StratonovichHeun>(),
        (Sense::Stratonovich, Admits::Any)
    );
    assert_eq!(
        says::<Checked<ItoMilstein>>(),
        (Sense::Ito, Admits::Commutative)
    );
    assert_eq!(says::<Checked<ItoSra1>>(), (Sense::Ito, Admits::Additive));
    assert_eq!(says::<Splitting>(), (Sense::Ito, Admits::Coloured));
}
