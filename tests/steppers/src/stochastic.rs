//! Schemes for stochastic models, and the sources of their noise.

use ahv_core::{
    AdditiveNoise, ColouredNoise, DifferentiableNoise, ItoCorrected, NoInline, NoiseClass, Real,
    StochasticModel, Vector,
};
use ahv_integrate::{
    AdditiveChannels, BrownianPath, Checked, CommutativeChannels, ItoDri1, ItoEulerMaruyama,
    ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting, KeyedNormals, LinearTransition, NormalLanes,
    NormalSource, NormalStream, RandNormals, Rk4, SdeScheme, StratonovichHeun, WeakIncrements,
    WienerIntegrals, WienerSource, bisect,
};
use ahv_models::flexible_mode;
use core::array::from_fn;
use core::hint::black_box;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::{Place, Visitor, step_size};

/// Level of a [`BrownianPath`] whose steps are taken.
const LEVEL: u32 = 10;

/// Every scheme that any noise admits, and those that ask for more on the channels that have it. `N` channels.
pub(crate) fn all<M, const N: usize>(at: &Place<M>, visitor: &mut dyn Visitor<M::Scalar>)
where
    M: DifferentiableNoise<Scalar: PartialEq>,
{
    let (m, u, dt) = (&at.model, &at.u, step_size());
    let (seed, member) = black_box((1, 2));
    let mut wiener = WienerSource::<N>::new(seed, member);
    at.visit(visitor, "ItoEulerMaruyama", "WienerSource", |x, step| {
        let dw = wiener.increments(step, dt);
        ItoEulerMaruyama::new(dt).step(m, x, u, &dw).is_ok()
    });
    at.visit(visitor, "StratonovichHeun", "bisect", |x, step| {
        let dw = wiener.increments(step / 2, 2.0 * dt);
        let (first, second) = bisect(dw, 2.0 * dt, wiener.increments(step + 1, 1.0));
        let half = if step.is_multiple_of(2) {
            first
        } else {
            second
        };
        StratonovichHeun::new(dt).step(m, x, u, &half).is_ok()
    });
    let mut keyed = KeyedNormals { seed, member };
    let root = M::Scalar::from_f64(dt).sqrt();
    at.visit(visitor, "ItoHeun", "KeyedNormals", |x, step| {
        let dw =
            M::Noise::from_fn(|channel| root * M::Scalar::from_f64(keyed.normal(step, channel)));
        ItoHeun::new(dt).step(m, x, u, &dw).is_ok()
    });
    at.visit(visitor, "ItoDri1", "NormalStream", |x, step| {
        let weak = WeakIncrements::from_normals(dt, |index| {
            NormalStream::new(seed, member, index as u64).normal(step)
        });
        ItoDri1::new(dt).step(m, x, u, &weak).is_ok()
    });
    let others = black_box([3, member, 4]);
    let mut lanes: [_; N] =
        from_fn(|channel| NormalLanes::<f64, 3>::new(seed, others, channel as u64));
    let mut narrow: [_; N] =
        from_fn(|channel| NormalLanes::<f32, 3>::new(seed, others, channel as u64));
    at.visit(visitor, "ItoEulerMaruyama", "NormalLanes", |x, step| {
        let dw = M::Noise::from_fn(|channel| {
            let (Some(lanes), Some(narrow)) = (lanes.get_mut(channel), narrow.get_mut(channel))
            else {
                return M::Scalar::ZERO;
            };
            let ([_, wide, _], [_, single, _]) = (lanes.normal(step).0, narrow.normal(step).0);
            root * M::Scalar::from_f64(wide + f64::from(single))
        });
        ItoEulerMaruyama::new(dt).step(m, x, u, &dw).is_ok()
    });
    at.visit(visitor, "ItoDri1", "from_signs", |x, step| {
        let sign = |number: u64| 1.0 - 2.0 * (number % 2) as f64;
        let weak = WeakIncrements::from_signs(
            dt,
            |channel| sign(step + channel as u64),
            |channel| sign(step / 2 + channel as u64),
        );
        ItoDri1::new(dt).step(m, x, u, &weak).is_ok()
    });
    milstein(at, visitor);
    sra1(at, visitor);
    by_normals::<M, ItoEulerMaruyama>(at, "ItoEulerMaruyama", visitor);
    by_normals::<M, ItoHeun>(at, "ItoHeun", visitor);
    by_normals::<M, StratonovichHeun>(at, "StratonovichHeun", visitor);
    by_normals::<M, ItoDri1>(at, "ItoDri1", visitor);
    by_normals::<M, Checked<ItoMilstein>>(at, "Checked<ItoMilstein>", visitor);
    by_normals::<M, Checked<ItoSra1>>(at, "Checked<ItoSra1>", visitor);
}

/// A scheme by its trait, on models whose noise it admits.
fn by_normals<M, S>(at: &Place<M>, name: &'static str, visitor: &mut dyn Visitor<M::Scalar>)
where
    M: DifferentiableNoise,
    S: SdeScheme<M>,
{
    let (m, u) = (&at.model, &at.u);
    let (seed, member) = black_box((11, 12));
    let Ok(scheme) = S::set_up(m, &at.x, u, step_size()) else {
        return;
    };
    at.visit(visitor, name, "SdeScheme", |x, step| {
        let normal = |index: usize| NormalStream::new(seed, member, index as u64).normal(step);
        let used = (0..scheme.normals()).filter(|&index| scheme.uses(m, x, u, index));
        black_box(used.count());
        scheme.step_from_normals(m, x, u, normal).is_ok()
    });
}

/// On channels that commute.
fn milstein<M: DifferentiableNoise>(at: &Place<M>, visitor: &mut dyn Visitor<M::Scalar>) {
    let commutes = |name: &str| {
        let channel = <M::Noise as Vector<M::Scalar>>::index_of(name);
        black_box(channel.is_some_and(commutes_with_those_before::<M>))
    };
    let mut path = path();
    let dt = path.dt(LEVEL);
    let all = CommutativeChannels::new(&at.model, |_| black_box(true));
    let admitted = CommutativeChannels::new(&at.model, commutes);
    at.visit(
        visitor,
        "ItoMilstein<CommutativeChannels>",
        "BrownianPath",
        |x, step| {
            let (Ok(model), Some(integrals)) = (&admitted, path.integrals(LEVEL, step)) else {
                return false;
            };
            black_box(all.is_ok());
            ItoMilstein::new(dt)
                .step(model, x, &at.u, &integrals.dw)
                .is_ok()
        },
    );
    let Ok(model) = admitted else { return };
    at.visit(
        visitor,
        "ItoHeun<CommutativeChannels>",
        "BrownianPath",
        |x, step| {
            let integrals = path.integrals(LEVEL, step);
            integrals.is_some_and(|w| ItoHeun::new(dt).step(&model, x, &at.u, &w.dw).is_ok())
        },
    );
}

/// Whether a channel commutes with all before it of which the same holds.
fn commutes_with_those_before<M: StochasticModel>(channel: usize) -> bool {
    (0..channel).all(|earlier| {
        !commutes_with_those_before::<M>(earlier) || M::noise_commutes(earlier, channel)
    })
}

/// On the channels that are additive.
fn sra1<M: StochasticModel>(at: &Place<M>, visitor: &mut dyn Visitor<M::Scalar>) {
    let constant = |name: &str| {
        let channel = <M::Noise as Vector<M::Scalar>>::index_of(name);
        let class = channel.map(M::noise_class);
        black_box(class == Some(NoiseClass::Constant))
    };
    let mut path = path();
    let dt = path.dt(LEVEL);
    let all = AdditiveChannels::new(&at.model, |_| black_box(true));
    let admitted = AdditiveChannels::new(&at.model, constant);
    at.visit(
        visitor,
        "ItoSra1<AdditiveChannels>",
        "BrownianPath",
        |x, step| {
            let (Ok(model), Some(integrals)) = (&admitted, path.integrals(LEVEL, step)) else {
                return false;
            };
            black_box(all.is_ok());
            ItoSra1::new(dt).step(model, x, &at.u, &integrals).is_ok()
        },
    );
    let Ok(model) = admitted else { return };
    at.visit(
        visitor,
        "ItoHeun<AdditiveChannels>",
        "BrownianPath",
        |x, step| {
            let integrals = path.integrals(LEVEL, step);
            integrals.is_some_and(|w| ItoHeun::new(dt).step(&model, x, &at.u, &w.dw).is_ok())
        },
    );
}

fn path() -> BrownianPath<KeyedNormals> {
    let (seed, member) = black_box((3, 4));
    BrownianPath::new(KeyedNormals { seed, member }, black_box(1.0))
}

/// The splitting with `C` states of coloured noise, around a stochastic and a deterministic scheme. `N` channels.
pub(crate) fn splitting<M, const N: usize, const C: usize>(
    at: &Place<M>,
    visitor: &mut dyn Visitor<M::Scalar>,
) where
    M: ColouredNoise<Scalar: PartialEq> + ItoCorrected,
{
    let (m, u, dt) = (&at.model, &at.u, step_size());
    let (seed, member) = black_box((5, 6));
    let mut keyed = KeyedNormals { seed, member };
    let mut normals = |step| {
        [0, 1].map(|half| {
            from_fn(|state| M::Scalar::from_f64(keyed.normal(step, N + 2 * state + half)))
        })
    };
    let split = ItoStrangSplitting::<_, C>::new(m, &at.x, u, dt);
    let mut wiener = WienerSource::<N>::new(seed, member);
    at.visit(
        visitor,
        "ItoStrangSplitting<ItoHeun>",
        "KeyedNormals",
        |x, step| {
            split.as_ref().is_ok_and(|split| {
                let dw = wiener.increments(step, dt);
                split.step_heun(m, x, u, &dw, &normals(step)).is_ok()
            })
        },
    );
    let number = |index: usize| NormalStream::new(seed, member, index as u64);
    at.visit(visitor, "ItoStrangSplitting", "SdeScheme", |x, step| {
        split.as_ref().is_ok_and(|split| {
            let used =
                (0..SdeScheme::<M>::normals(split)).filter(|&index| split.uses(m, x, u, index));
            black_box(used.count());
            let normal = |index: usize| number(index).normal(step);
            split.step_from_normals(m, x, u, normal).is_ok()
        })
    });
    at.visit(
        visitor,
        "ItoStrangSplitting<Rk4>",
        "KeyedNormals",
        |x, step| {
            split.as_ref().is_ok_and(|split| {
                split
                    .step(m, x, &normals(step), |others, x, dt| {
                        Rk4::new(dt).step(others, x, u)
                    })
                    .is_ok()
            })
        },
    );
}

/// The exact transitions of a mode, of its reduction, and of both with their common noise.
pub(crate) fn transitions<R: Real>(
    at: &Place<NoInline<flexible_mode::Model<R>>>,
    visitor: &mut dyn Visitor<R>,
) {
    let dt = step_size();
    let number = |value: f64| R::from_f64(black_box(value));
    let mode = [19.7437, 0.7, 100.0].map(number);
    let coloured = [13.8, 0.25].map(number);
    let mut streams = [0, 1, 2].map(|channel| NormalStream::new(8, 9, channel));
    let mut normals = |step| {
        let [a, b, c] = &mut streams;
        [a, b, c].map(|stream| R::from_f64(stream.normal(step)))
    };
    let force = [R::ZERO, number(300.0), R::ZERO];
    let [omega, zeta, sigma] = mode;
    let [decay, diffusion] = coloured;
    let joint = LinearTransition::mode_and_coloured_noise(mode, coloured, dt);
    let alone = LinearTransition::mode(omega, zeta, sigma, dt);
    let reduced = LinearTransition::ornstein_uhlenbeck(decay, diffusion, dt);
    at.visit(visitor, "LinearTransition<3>", "NormalStream", |x, step| {
        joint.is_ok_and(|joint| {
            *x = joint.step(&x.to_array(), &force, &normals(step)).into();
            true
        })
    });
    at.visit(
        visitor,
        "LinearTransition<2>, <1>",
        "NormalStream",
        |x, step| {
            let (Ok(alone), Ok(reduced)) = (alone, reduced) else {
                return false;
            };
            let [first, second, third] = normals(step);
            let [eta, eta_dot, chi] = x.to_array();
            let [eta, eta_dot] = alone.step(&[eta, eta_dot], &[R::ZERO; 2], &[first, second]);
            let [chi] = reduced.step(&[chi], &[R::ZERO], &[third]);
            *x = [eta, eta_dot, chi].into();
            true
        },
    );
}

/// Schemes that take their noise from [`RandNormals`].
pub(crate) fn drawn<M>(at: &Place<M>, visitor: &mut dyn Visitor<M::Scalar>)
where
    M: AdditiveNoise + DifferentiableNoise,
{
    let (m, u, dt) = (&at.model, &at.u, step_size());
    let generator = || RandNormals::new(ChaCha8Rng::from_seed(black_box([10; 32])));
    let mut source = generator();
    at.visit(visitor, "ItoEulerMaruyama", "RandNormals", |x, _| {
        let dw = source.increments(dt);
        ItoEulerMaruyama::new(dt).step(m, x, u, &dw).is_ok()
    });
    let mut source = generator();
    at.visit(visitor, "ItoSra1", "RandNormals", |x, _| {
        let integrals: WienerIntegrals<M::Noise> = source.integrals(dt);
        let next = WienerIntegrals::from_normals(dt, source.normals(), source.normals());
        let (first, second) =
            integrals
                .then(next, dt)
                .bisect(2.0 * dt, source.normals(), source.normals());
        let stepper = ItoSra1::new(dt);
        stepper.step(m, x, u, &first).is_ok() && stepper.step(m, x, u, &second).is_ok()
    });
    let mut source = generator();
    at.visit(visitor, "ItoDri1", "RandNormals", |x, _| {
        let weak = source.weak_increments(dt);
        ItoDri1::new(dt).step(m, x, u, &weak).is_ok()
    });
}
