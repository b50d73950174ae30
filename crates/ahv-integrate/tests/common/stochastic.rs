//! The table of the stochastic schemes' orders, measured.

use std::fmt::Write;

use ahv_integrate::{
    CommutativeChannels, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1,
    ItoStrangSplitting, StepError, StratonovichHeun, WeakIncrements, WienerIntegrals,
};

use super::strong::{self, Area, Curved, Spiral, area_order, curved_order, spiral_order};
use super::weak::{
    self, ADDITIVE, Driven, LINEAR, Linear, MULTIPLICATIVE, One, Pair, Parabola, driven_order,
    parabola_order, weak_order,
};

/// Nominal order, and the observed one.
pub(crate) type Order = (f64, f64);

/// A scheme on one class of noise.
pub(crate) struct Observed {
    pub(crate) name: &'static str,
    sense: &'static str,
    noise: &'static str,
    pub(crate) strong: Option<Order>,
    pub(crate) weak: Order,
}

/// Steps of a scheme that needs ΔW alone.
struct Steps {
    curved: strong::IntegralStep,
    spiral: strong::Step,
    area: strong::IntegralStep,
    parabola: weak::ParabolaStep,
    linear: weak::Step,
}

macro_rules! steps {
    ($scheme:ident) => {
        Steps {
            curved: |dt, x, w| $scheme::new(dt).step(&Curved, x, &strong::NO_INPUT, &w.dw),
            spiral: |dt, x, dw| $scheme::new(dt).step(&Spiral, x, &strong::NO_INPUT, dw),
            area: |dt, x, w| $scheme::new(dt).step(&Area, x, &strong::NO_INPUT, &w.dw),
            parabola: |dt, x, [z, _]| {
                let dw = One { w: z * dt.sqrt() };
                $scheme::new(dt).step(&Parabola, x, &weak::NO_INPUT, &dw)
            },
            linear: |dt, model, x, w| {
                $scheme::new(dt).step(model, x, &weak::NO_INPUT, &w.three_point)
            },
        }
    };
}

/// The rows of a scheme: additive noise, columns that commute, any columns.
fn rows(
    name: &'static str,
    sense: &'static str,
    steps: &Steps,
    strong: [f64; 3],
    weak: [f64; 3],
) -> [Observed; 3] {
    let ito = sense == "Itô";
    let meant = |model: Linear| {
        if ito {
            model
        } else {
            model.in_the_stratonovich_sense()
        }
    };
    let one = LINEAR.of_one_column();
    let observed_strong = [
        curved_order(steps.curved),
        spiral_order(steps.spiral, if ito { 1.0 } else { 0.0 }),
        area_order(steps.area),
    ];
    let observed_weak = [
        parabola_order(steps.parabola),
        weak_order(steps.linear, &one, &meant(one)),
        weak_order(steps.linear, &LINEAR, &meant(LINEAR)),
    ];
    std::array::from_fn(|class| Observed {
        name,
        sense,
        noise: ["additive", "commutative", "any"][class],
        strong: Some((strong[class], observed_strong[class])),
        weak: (weak[class], observed_weak[class]),
    })
}

fn milstein() -> [Observed; 2] {
    let observed = |noise, strong, weak| Observed {
        name: "`ItoMilstein`",
        sense: "Itô",
        noise,
        strong: Some((1.0, strong)),
        weak: (1.0, weak),
    };
    let one = LINEAR.of_one_column();
    let one_column: weak::Step = |dt, model, x, w| {
        let model = CommutativeChannels::new(model, |name| name == "w_1").expect("one column");
        ItoMilstein::new(dt).step(&model, x, &weak::NO_INPUT, &w.three_point)
    };
    [
        observed(
            "additive",
            curved_order(|dt, x, w| {
                ItoMilstein::new(dt).step(&Curved, x, &strong::NO_INPUT, &w.dw)
            }),
            parabola_order(|dt, x, [z, _]| {
                let dw = One { w: z * dt.sqrt() };
                ItoMilstein::new(dt).step(&Parabola, x, &weak::NO_INPUT, &dw)
            }),
        ),
        observed(
            "commutative",
            spiral_order(
                |dt, x, dw| ItoMilstein::new(dt).step(&Spiral, x, &strong::NO_INPUT, dw),
                1.0,
            ),
            weak_order(one_column, &one, &one),
        ),
    ]
}

fn sra1() -> Observed {
    let strong = curved_order(|dt, x, w| ItoSra1::new(dt).step(&Curved, x, &strong::NO_INPUT, w));
    let weak = parabola_order(|dt, x, [z, v]| {
        let w = WienerIntegrals::from_normals(dt, One { w: z }, One { w: v });
        ItoSra1::new(dt).step(&Parabola, x, &weak::NO_INPUT, &w)
    });
    Observed {
        name: "`ItoSra1`",
        sense: "both",
        noise: "additive",
        strong: Some((1.5, strong)),
        weak: (2.0, weak),
    }
}

fn dri1() -> [Observed; 2] {
    let observed = |noise, weak| Observed {
        name: "`ItoDri1`",
        sense: "Itô",
        noise,
        strong: None,
        weak: (2.0, weak),
    };
    let additive = parabola_order(|dt, x, [z, v]| {
        let root = dt.sqrt();
        let w = WeakIncrements {
            three_point: One { w: z * root },
            two_point: One { w: v * root },
        };
        ItoDri1::new(dt).step(&Parabola, x, &weak::NO_INPUT, &w)
    });
    let step: weak::Step = |dt, model, x, w| ItoDri1::new(dt).step(model, x, &weak::NO_INPUT, w);
    [
        observed("additive", additive),
        observed("any", weak_order(step, &LINEAR, &LINEAR)),
    ]
}

type Splitting = ItoStrangSplitting<f64, 1>;

fn splitting(dt: f64, model: &Driven, x: &Pair<f64>) -> Splitting {
    Splitting::new(model, x, &weak::NO_INPUT, dt).expect("the noise stands apart")
}

/// The rows of the splitting: white noise of the other states that is additive, and such that is not.
fn splittings() -> [Observed; 4] {
    let heun: weak::DrivenStep = |dt, model, x, w, [z, v]| {
        let splitting = splitting(dt, model, x);
        splitting.step_heun(model, x, &weak::NO_INPUT, &w.three_point, &[[z], [v]])
    };
    let dri1: weak::DrivenStep = |dt, model, x, w, [z, v]| -> Result<(), StepError<f64>> {
        splitting(dt, model, x).step(model, x, &[[z], [v]], |held, x, dt| {
            ItoDri1::new(dt).step(held, x, &weak::NO_INPUT, w)
        })
    };
    let observed = |name, noise, nominal, step, model| Observed {
        name,
        sense: "Itô",
        noise,
        strong: None,
        weak: (nominal, driven_order(step, model)),
    };
    let [additive, any] = ["coloured, the rest additive", "coloured, the rest any"];
    let [with_heun, with_dri1] = [
        "`ItoStrangSplitting` with `ItoHeun`",
        "`ItoStrangSplitting` with `ItoDri1`",
    ];
    [
        observed(with_heun, additive, 2.0, heun, &ADDITIVE),
        observed(with_heun, any, 1.0, heun, &MULTIPLICATIVE),
        observed(with_dri1, additive, 2.0, dri1, &ADDITIVE),
        observed(with_dri1, any, 2.0, dri1, &MULTIPLICATIVE),
    ]
}

/// Measures every scheme on every class of noise that it takes.
pub(crate) fn observed() -> Vec<Observed> {
    let euler = steps!(ItoEulerMaruyama);
    let stratonovich = steps!(StratonovichHeun);
    let ito = steps!(ItoHeun);
    let mut all = Vec::new();
    all.extend(rows(
        "`ItoEulerMaruyama`",
        "Itô",
        &euler,
        [1.0, 0.5, 0.5],
        [1.0; 3],
    ));
    let orders = ([1.0, 1.0, 0.5], [2.0, 1.0, 1.0]);
    all.extend(rows(
        "`StratonovichHeun`",
        "Stratonovich",
        &stratonovich,
        orders.0,
        orders.1,
    ));
    all.extend(rows("`ItoHeun`", "Itô", &ito, orders.0, orders.1));
    all.extend(milstein());
    all.push(sra1());
    all.extend(dri1());
    all.extend(splittings());
    all
}

/// The table in Markdown.
pub(crate) fn table(rows: &[Observed]) -> String {
    let mut text = String::from(
        "| scheme | sense | noise | strong order | observed | weak order | observed |\n|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let strong = row.strong.map_or_else(
            || "none |".into(),
            |(nominal, observed)| format!("{nominal} | {observed:.2}"),
        );
        let (nominal, weak) = row.weak;
        writeln!(
            text,
            "| {} | {} | {} | {strong} | {nominal} | {weak:.2} |",
            row.name, row.sense, row.noise
        )
        .expect("a string takes all that is written");
    }
    text
}
