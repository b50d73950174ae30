//! The section on Table 3 and Fig. 6.

use ahv_cli::failure::Failure;
use ahv_core::Provenance;
use ahv_models::{com, dcom};
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError, Shape};

use super::page::{Cell, Picture, Row, Section, Table};
use super::{Findings, drawn, sentences, trims};
use crate::commands::number::significant;
use crate::reproduce::pairing::{Kind, NOTHING, Pair, SLOW, pairs, size};
use crate::reproduce::printed::{self, Root, TABLE_3};
use crate::reproduce::vehicle::{Roots, Vehicle};

/// What Fig. 6 shows about the origin, in rad/s: the slow modes, and the slowest roots.
const NEAR: [(f64, &str); 2] = [(SLOW, "slow modes"), (0.0015, "next to the origin")];
/// Files of the comparisons with Table 3.
const FILES: [(&str, &str); 4] = [
    ("fpm", "table3_fpm.csv"),
    ("com", "table3_com.csv"),
    ("dcom", "table3_dcom.csv"),
    ("sdcom", "table3_sdcom.csv"),
];
/// Sets of parameters that are set beside Table 3.
const SETS: [&str; 3] = ["section5.1", "section5.3", "quoted"];

/// A root as text; of a pair both.
fn text([re, im]: Root) -> String {
    let nothing = NOTHING * (1.0 + re.hypot(im));
    let re = if re.abs() < nothing { 0.0 } else { re };
    if im.abs() < nothing {
        significant(re)
    } else {
        format!("{} ± {}i", significant(re), significant(im))
    }
}

/// The vehicle of Table 3 by model and set: flat Earth, no canard.
fn find<'a>(vehicles: &'a [Vehicle], model: &str, set: &str) -> Option<&'a Vehicle> {
    vehicles.iter().find(|vehicle| {
        let condition = &vehicle.condition;
        condition.model == model
            && condition.set == set
            && condition.earth == "flat"
            && condition.canard != Some("slaved")
    })
}

fn roots<'a>(vehicles: &'a [Vehicle], model: &str, set: &str) -> Option<&'a Roots> {
    find(vehicles, model, set)?.roots.as_ref()
}

fn column(model: &str) -> Option<&'static printed::Roots> {
    TABLE_3.iter().find(|roots| roots.model == model)
}

/// Poles and zeros of Table 3 beside ours.
fn paired(printed: &printed::Roots, ours: &Roots) -> [(&'static str, Vec<Pair>); 2] {
    let of_place = |roots: &[Root]| -> Vec<(Root, Kind)> {
        let roots = roots.iter();
        roots.map(|&root| (root, Kind::of_place(root))).collect()
    };
    let known = |roots: &[Root], kinds: &[Kind]| -> Vec<(Root, Kind)> {
        roots.iter().copied().zip(kinds.iter().copied()).collect()
    };
    [
        (
            "pole",
            pairs(
                &of_place(printed.poles),
                &known(&ours.poles, &ours.pole_kinds),
            ),
        ),
        (
            "zero",
            pairs(
                &of_place(printed.zeros),
                &known(&ours.zeros, &ours.zero_kinds),
            ),
        ),
    ]
}

/// A row: the two roots, the parts of their difference, its size, and that over the printed root.
fn row(set: &str, root: &str, pair: &Pair) -> Row {
    let one = |root: Option<Root>| {
        root.map_or_else(
            || Cell::words("no counterpart"),
            |root| Cell::Number(text(root)),
        )
    };
    let mut cells = vec![
        Cell::words(set),
        Cell::words(root),
        Cell::words(pair.kind.name()),
        one(pair.printed),
        one(pair.ours),
    ];
    if let (Some(printed), Some(ours)) = (pair.printed, pair.ours) {
        let nothing = NOTHING * (1.0 + size(ours));
        let part = |place: usize| {
            let difference = ours[place] - printed[place];
            if difference.abs() < nothing {
                0.0
            } else {
                difference
            }
        };
        let difference = [part(0), part(1)];
        cells.extend([difference[0], difference[1], size(difference)].map(Cell::number));
        cells.push(if size(printed) > 0.0 {
            Cell::Number(format!("{:.1} %", 100.0 * size(difference) / size(printed)))
        } else {
            Cell::words("")
        });
    } else {
        cells.extend([(); 4].map(|()| Cell::words("")));
    }
    Row::from(cells)
}

/// Table 3 and Fig. 6.
///
/// # Errors
///
/// [`Failure::Numeric`] if the picture cannot be drawn.
pub(super) fn section(vehicles: &[Vehicle], findings: &mut Findings) -> Result<Section, Failure> {
    let mut tables = Vec::new();
    for (model, file) in FILES {
        let Some(printed) = column(model) else {
            continue;
        };
        let mut rows = Vec::new();
        let mut counts = Vec::new();
        for set in SETS {
            let Some(ours) = roots(vehicles, model, set) else {
                continue;
            };
            let (mut found, mut of) = (0, 0);
            for (root, pairs) in paired(printed, ours) {
                of += pairs.iter().filter(|it| it.printed.is_some()).count();
                let both = |it: &&Pair| it.printed.is_some() && it.ours.is_some();
                found += pairs.iter().filter(both).count();
                rows.extend(pairs.iter().map(|pair| row(set, root, pair)));
            }
            findings.push(sentences::counterparts(model, set, found, of));
            counts.push(format!(
                "{set}: {} poles and {} finite zeros",
                ours.poles.len(),
                ours.zeros.len()
            ));
        }
        tables.push(Table {
            file,
            caption: format!(
                "{} beside Table 3, in rad/s. {}",
                model.to_uppercase(),
                counts.join("; ")
            ),
            head: vec![
                "set",
                "root",
                "kind",
                "printed",
                "ours",
                "difference, real",
                "imaginary",
                "size",
                "of the printed",
            ],
            rows,
        });
    }
    facts(vehicles, findings);
    Ok(Section {
        id: "table3",
        title: "Table 3 and Fig. 6",
        paragraphs: vec![sentences::pairing()],
        tables,
        pictures: vec![Picture {
            file: "fig6.svg",
            caption: format!(
                "Fig. 6: poles and zeros of y = [V, γ], u = [δe, φ]; flat Earth, no canard. Left: all. Middle: within {} rad/s of the \
                 origin. Right: within {} rad/s.",
                NEAR[0].0, NEAR[1].0
            ),
            svg: drawn("fig6.svg", map(vehicles))?,
        }],
    })
}

/// What explains the differences.
fn facts(vehicles: &[Vehicle], findings: &mut Findings) {
    let count = |roots: &[Root]| -> usize {
        let sizes = roots.iter().map(|root| if root[1] > 0.0 { 2 } else { 1 });
        sizes.sum()
    };
    let flexible = |roots: &[Root]| -> Vec<Root> {
        let roots = roots.iter().copied();
        roots
            .filter(|&root| Kind::of_place(root) == Kind::Flexible)
            .collect()
    };
    if let Some(printed) = column("dcom") {
        let dampings = flexible(printed.poles);
        let dampings = dampings.iter().map(|&root| -root[0] / size(root));
        let p = &dcom::NOMINAL;
        findings.push(sentences::dampings(
            range(dampings),
            range([p.zeta_1, p.zeta_2, p.zeta_3].into_iter()),
        ));
        for set in SETS {
            let (Some(vehicle), Some(ours)) =
                (find(vehicles, "dcom", set), roots(vehicles, "dcom", set))
            else {
                continue;
            };
            let ours = ours.poles.iter().zip(&ours.pole_kinds);
            let ours = ours.filter(|&(_, &kind)| kind == Kind::Rigid);
            let [ours, printed] = [
                short_period(ours.map(|(&root, _)| root)),
                short_period(printed.poles.iter().copied()),
            ];
            if let Some(trim) = &vehicle.trim {
                let distance = trims::distance(trim);
                findings.push(sentences::short_period(set, ours, printed, distance));
            }
        }
        if let Some(off) = roots(vehicles, "dcom", SETS[1]).map(|ours| real_parts(printed, ours)) {
            let of = &dcom::SECTION5_3_PROVENANCE;
            findings.push(sentences::modal_data(
                SETS[1],
                doubtful(&[
                    of.omega_1, of.omega_2, of.omega_3, of.zeta_1, of.zeta_2, of.zeta_3,
                ]),
                off,
            ));
            findings.push(sentences::mass(SETS[1], of.m, of.i_yy));
        }
    }
    if let Some(printed) = column("com") {
        let p = &com::NOMINAL;
        let omegas = [p.omega_1, p.omega_2];
        let coupled = flexible(printed.poles);
        let coupled = omegas
            .iter()
            .all(|omega| coupled.iter().any(|root| root[1] == *omega));
        let of = &com::PROVENANCE;
        let origin = doubtful(&[of.omega_1, of.omega_2]);
        findings.push(sentences::clamped(origin, &omegas, coupled));
    }
    if let (Some(ours), Some(printed)) = (roots(vehicles, "sdcom", SETS[0]), column("sdcom")) {
        let noise = ours.pole_kinds.iter().filter(|&&kind| kind == Kind::Noise);
        findings.push(sentences::sdcom(
            ours.poles.len(),
            noise.count(),
            count(printed.poles),
            flexible(printed.poles).len(),
        ));
    }
}

/// Least and greatest of numbers.
fn range(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| {
        [low.min(it), high.max(it)]
    })
}

/// The leftmost and the rightmost real root.
fn short_period(roots: impl Iterator<Item = Root>) -> [f64; 2] {
    let real = roots.filter(|&[re, im]| im.abs() < NOTHING * (1.0 + re.abs()));
    range(real.map(|[re, _]| re))
}

/// Greatest relative difference of the real parts of the flexible poles, by rising frequency.
fn real_parts(printed: &printed::Roots, ours: &Roots) -> f64 {
    let sorted = |mut roots: Vec<Root>| {
        roots.sort_by(|a, b| a[1].total_cmp(&b[1]));
        roots
    };
    let printed = printed.poles.iter().copied();
    let printed = sorted(
        printed
            .filter(|&root| Kind::of_place(root) == Kind::Flexible)
            .collect(),
    );
    let ours = ours.poles.iter().copied().zip(&ours.pole_kinds);
    let ours = ours.filter(|&(root, &kind)| kind == Kind::Flexible && root[1] > 0.0);
    let ours = sorted(ours.map(|(root, _)| root).collect());
    let off = printed
        .iter()
        .zip(&ours)
        .map(|(printed, ours)| (ours[0] / printed[0] - 1.0).abs());
    off.fold(0.0, f64::max)
}

/// The first of these that comes from Table 3, else the first.
fn doubtful(origins: &[Provenance]) -> Provenance {
    let circular = origins.iter().find(|it| it.source == "table-3");
    let assumed = Provenance::new("none", ahv_core::Status::Assumed, 0.0);
    circular.or(origins.first()).copied().unwrap_or(assumed)
}

/// Fig. 6: each model and set, beside the printed roots.
fn map(vehicles: &[Vehicle]) -> Result<String, PlotError> {
    let mut panels = Vec::new();
    for (model, set) in [
        ("fpm", SETS[2]),
        ("com", SETS[0]),
        ("dcom", SETS[0]),
        ("dcom", SETS[1]),
        ("sdcom", SETS[0]),
        ("sdcom", SETS[1]),
    ] {
        let (Some(ours), Some(printed)) = (roots(vehicles, model, set), column(model)) else {
            continue;
        };
        let both = |roots: &[Root]| -> Vec<(f64, f64)> {
            let pairs = roots.iter().flat_map(|&[re, im]| [(re, im), (re, -im)]);
            pairs.collect()
        };
        let layers = vec![
            Layer::new(
                "pole",
                Colour::Blue,
                Mark::Markers(Shape::Cross, both(&ours.poles)),
            ),
            Layer::new(
                "zero",
                Colour::Blue,
                Mark::Markers(Shape::Circle, both(&ours.zeros)),
            ),
            Layer::new(
                "pole, printed",
                Colour::Vermillion,
                Mark::Markers(Shape::Plus, both(printed.poles)),
            ),
            Layer::new(
                "zero, printed",
                Colour::Vermillion,
                Mark::Markers(Shape::Diamond, both(printed.zeros)),
            ),
        ];
        let all = Panel {
            title: format!("{}, {set}", model.to_uppercase()),
            x: Axis::linear("real part [rad/s]"),
            y: Axis::linear("imaginary part [rad/s]"),
            layers,
        };
        let near = NEAR.map(|(reach, words)| about_the_origin(&all, reach, words));
        panels.push(all);
        panels.extend(near);
    }
    Figure {
        panel_size: (360, 300),
        ..Figure::new("", 1 + NEAR.len(), panels)
    }
    .svg()
}

/// The panel within `reach` rad/s of the origin, in mrad/s.
fn about_the_origin(all: &Panel, reach: f64, words: &str) -> Panel {
    const MILLI: f64 = 1e3;
    let mut panel = all.clone();
    panel.title = format!("{}, {words}", panel.title);
    panel.x = Axis::linear("real part [mrad/s]").within(-MILLI * reach, MILLI * reach);
    panel.y = Axis::linear("imaginary part [mrad/s]").within(-MILLI * reach, MILLI * reach);
    for layer in &mut panel.layers {
        if let Mark::Markers(_, points) = &mut layer.mark {
            for (re, im) in points {
                (*re, *im) = (MILLI * *re, MILLI * *im);
            }
        }
    }
    panel
}
