//! The table of the stochastic schemes' orders, measured.

use std::fmt::Write;

use ahv_integrate::{
    CommutativeChannels, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1,
    ItoStrangSplitting, StratonovichHeun, WienerIntegrals,
};

use super::strong::{self, Spiral, spiral_order, sra1_order};
use super::weak::{self, Driven, LINEAR, One, driven_order, weak_order};

/// Nominal order, and how it is measured.
pub(crate) type Order = (f64, fn() -> f64);

/// A scheme: strong order on commuting columns, or additive ones where it asks for them; weak order on columns of which
/// no two commute, or on what it asks for.
pub(crate) struct Scheme {
    name: &'static str,
    sense: &'static str,
    noise: &'static str,
    pub(crate) strong: Option<Order>,
    pub(crate) weak: Order,
}

fn schemes() -> [Scheme; 7] {
    [
        Scheme {
            name: "`ItoEulerMaruyama`",
            sense: "Itô",
            noise: "any",
            strong: Some((0.5, || {
                spiral_order(
                    |dt, x, dw| ItoEulerMaruyama::new(dt).step(&Spiral, x, &strong::NO_INPUT, dw),
                    1.0,
                )
            })),
            weak: (1.0, || {
                weak_order(
                    |dt, model, x, dw| {
                        ItoEulerMaruyama::new(dt).step(model, x, &weak::NO_INPUT, &dw.three_point)
                    },
                    &LINEAR,
                    &LINEAR,
                )
            }),
        },
        Scheme {
            name: "`StratonovichHeun`",
            sense: "Stratonovich",
            noise: "any",
            strong: Some((1.0, || {
                spiral_order(
                    |dt, x, dw| StratonovichHeun::new(dt).step(&Spiral, x, &strong::NO_INPUT, dw),
                    0.0,
                )
            })),
            weak: (1.0, || {
                weak_order(
                    |dt, model, x, dw| {
                        StratonovichHeun::new(dt).step(model, x, &weak::NO_INPUT, &dw.three_point)
                    },
                    &LINEAR,
                    &LINEAR.in_the_stratonovich_sense(),
                )
            }),
        },
        Scheme {
            name: "`ItoHeun`",
            sense: "Itô",
            noise: "any (`ItoCorrected`)",
            strong: Some((1.0, || {
                spiral_order(
                    |dt, x, dw| ItoHeun::new(dt).step(&Spiral, x, &strong::NO_INPUT, dw),
                    1.0,
                )
            })),
            weak: (1.0, || {
                weak_order(
                    |dt, model, x, dw| {
                        ItoHeun::new(dt).step(model, x, &weak::NO_INPUT, &dw.three_point)
                    },
                    &LINEAR,
                    &LINEAR,
                )
            }),
        },
        Scheme {
            name: "`ItoMilstein`",
            sense: "Itô",
            noise: "commutative (`CommutativeNoise`)",
            strong: Some((1.0, || {
                spiral_order(
                    |dt, x, dw| ItoMilstein::new(dt).step(&Spiral, x, &strong::NO_INPUT, dw),
                    1.0,
                )
            })),
            weak: (1.0, || {
                let one = LINEAR.of_one_column();
                weak_order(
                    |dt, model, x, dw| {
                        let model = CommutativeChannels::new(model, |name| name == "w_1")
                            .expect("one column commutes");
                        ItoMilstein::new(dt).step(&model, x, &weak::NO_INPUT, &dw.three_point)
                    },
                    &one,
                    &one,
                )
            }),
        },
        Scheme {
            name: "`ItoSra1`",
            sense: "both",
            noise: "additive (`AdditiveNoise`)",
            strong: Some((1.5, sra1_order)),
            weak: (2.0, || {
                driven_order(|dt, x, [z, v]| {
                    let w = WienerIntegrals::from_normals(dt, One { w: z }, One { w: v });
                    ItoSra1::new(dt).step(&Driven, x, &weak::NO_INPUT, &w)
                })
            }),
        },
        Scheme {
            name: "`ItoDri1`",
            sense: "Itô",
            noise: "any",
            strong: None,
            weak: (2.0, || {
                weak_order(
                    |dt, model, x, dw| ItoDri1::new(dt).step(model, x, &weak::NO_INPUT, dw),
                    &LINEAR,
                    &LINEAR,
                )
            }),
        },
        Scheme {
            name: "`ItoStrangSplitting` with `ItoHeun`",
            sense: "Itô",
            noise: "coloured (`ColouredNoise`)",
            strong: None,
            weak: (2.0, || {
                driven_order(|dt, x, [z, v]| {
                    ItoStrangSplitting::<f64, 1>::new(&Driven, x, &weak::NO_INPUT, dt)
                        .expect("the noise stands apart")
                        .step_heun(&Driven, x, &weak::NO_INPUT, &One { w: 0.0 }, &[[z], [v]])
                })
            }),
        },
    ]
}

/// Observed orders of one scheme.
pub(crate) struct Observed {
    pub(crate) scheme: Scheme,
    pub(crate) strong: Option<f64>,
    pub(crate) weak: f64,
}

/// Measures every scheme.
pub(crate) fn observed() -> Vec<Observed> {
    let measure = |scheme: Scheme| Observed {
        strong: scheme.strong.map(|(_, measure)| measure()),
        weak: scheme.weak.1(),
        scheme,
    };
    schemes().into_iter().map(measure).collect()
}

/// The table in Markdown.
pub(crate) fn table(rows: &[Observed]) -> String {
    let mut text = String::from(
        "| scheme | sense | noise | strong order | observed | weak order | observed |\n|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let scheme = &row.scheme;
        let strong = scheme.strong.zip(row.strong).map_or_else(
            || "none |".into(),
            |((nominal, _), observed)| format!("{nominal} | {observed:.2}"),
        );
        writeln!(
            text,
            "| {} | {} | {} | {strong} | {} | {:.2} |",
            scheme.name, scheme.sense, scheme.noise, scheme.weak.0, row.weak
        )
        .expect("a string takes all that is written");
    }
    text
}
