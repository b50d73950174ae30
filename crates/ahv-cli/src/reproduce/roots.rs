//! The section on Table 3 and Fig. 6.

use ahv_analysis::reproduce::printed::{self, Root, TABLE_3};
use ahv_analysis::reproduce::vehicle::{Roots, Vehicle};
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError, Shape};

use super::page::{Cell, Picture, Section, Table, number};
use super::{Findings, drawn};
use crate::failure::Failure;

/// Roots below this frequency, in rad/s, are those of the slow modes.
const SLOW: f64 = 0.1;
/// Two roots may correspond if they are not farther apart than this share of the larger.
const NEAR: f64 = 0.6;
/// Files of the comparisons with Table 3.
const FILES: [(&str, &str); 3] = [
    ("com", "table3_com.csv"),
    ("dcom", "table3_dcom.csv"),
    ("sdcom", "table3_sdcom.csv"),
];
/// Sets of parameters that are set beside Table 3.
const SETS: [&str; 2] = ["section5.1", "section5.3"];

fn size([re, im]: Root) -> f64 {
    re.hypot(im)
}

/// What QR and QZ leave of a part that is 0.
fn nothing(root: Root) -> f64 {
    1e-7 * (1.0 + size(root))
}

/// A root as text; of a pair both.
fn text(root: Root) -> String {
    let [re, im] = root;
    let re = if re.abs() < nothing(root) { 0.0 } else { re };
    if im.abs() < nothing(root) {
        number(re)
    } else {
        format!("{} ± {}i", number(re), number(im))
    }
}

/// Roots of which one in a pair is left out.
fn upper(roots: &[Root]) -> Vec<Root> {
    roots
        .iter()
        .copied()
        .filter(|root| root[1] >= 0.0)
        .collect()
}

/// Each printed root with the one of ours that corresponds, and those of ours that are left; nearest first.
fn matched(printed: &[Root], ours: &[Root]) -> (Vec<Option<Root>>, Vec<Root>) {
    let mut partners = vec![None; printed.len()];
    let mut left = upper(ours);
    loop {
        let distance = |a: Root, b: Root| size([a[0] - b[0], a[1] - b[1]]);
        let pairs = printed
            .iter()
            .enumerate()
            .filter(|&(index, _)| partners[index].is_none());
        let pairs = pairs.flat_map(|(index, &root)| {
            left.iter()
                .enumerate()
                .map(move |(other, &ours)| (index, root, other, ours))
        });
        let nearest = pairs
            .map(|(index, root, other, ours)| {
                (
                    distance(root, ours),
                    size(root).max(size(ours)),
                    index,
                    other,
                )
            })
            .filter(|&(distance, size, ..)| distance <= NEAR * size || size < SLOW)
            .min_by(|a, b| (a.0 / a.1.max(SLOW)).total_cmp(&(b.0 / b.1.max(SLOW))));
        let Some((_, _, index, other)) = nearest else {
            return (partners, left);
        };
        partners[index] = Some(left.remove(other));
    }
}

/// The vehicle of Table 3 by model and set: flat Earth, no canard.
fn find<'a>(vehicles: &'a [Vehicle], model: &str, set: &str) -> Option<&'a Roots> {
    let mut found = vehicles.iter().filter(|vehicle| {
        let condition = &vehicle.condition;
        condition.model == model
            && condition.set == set
            && condition.earth == "flat"
            && condition.canard != Some("slaved")
    });
    found.next()?.roots.as_ref()
}

/// Rows of one kind of roots, poles or zeros, of all sets beside the printed ones.
fn rows(kind: &str, printed: &[Root], ours: &[Vec<Root>]) -> Vec<Vec<Cell>> {
    let matches: Vec<_> = ours.iter().map(|ours| matched(printed, ours)).collect();
    let pair = |root: Option<Root>, printed: Option<Root>| match (root, printed) {
        (Some(root), Some(printed)) => {
            let difference = [root[0] - printed[0], root[1] - printed[1]];
            let sign = if difference[1] < 0.0 { "" } else { "+" };
            let both = format!("{}{sign}{}i", number(difference[0]), number(difference[1]));
            let real = root[1].abs() < nothing(root) && printed[1] == 0.0;
            [
                Cell::Number(text(root)),
                Cell::Number(if real { number(difference[0]) } else { both }),
            ]
        }
        (Some(root), None) => [Cell::Number(text(root)), Cell::words("")],
        _ => [Cell::words("none"), Cell::words("")],
    };
    let mut rows = Vec::new();
    for (index, &root) in printed.iter().enumerate() {
        let mut row = vec![Cell::words(kind), Cell::Number(text(root))];
        row.extend(
            matches
                .iter()
                .flat_map(|(partners, _)| pair(partners[index], Some(root))),
        );
        rows.push(row);
    }
    let longest = matches
        .iter()
        .map(|(_, left)| left.len())
        .max()
        .unwrap_or(0);
    for index in 0..longest {
        let mut row = vec![Cell::words(kind), Cell::words("none")];
        for (_, left) in &matches {
            let blank = || [Cell::words(""), Cell::words("")];
            row.extend(
                left.get(index)
                    .map_or_else(blank, |&root| pair(Some(root), None)),
            );
        }
        rows.push(row);
    }
    rows
}

/// Table 3 and Fig. 6.
///
/// # Errors
///
/// [`Failure::Numeric`] if the picture cannot be drawn.
pub(super) fn section(vehicles: &[Vehicle], findings: &mut Findings) -> Result<Section, Failure> {
    let mut tables = Vec::new();
    for (model, file) in FILES {
        let Some(printed) = TABLE_3.iter().find(|roots| roots.model == model) else {
            continue;
        };
        let ours = SETS
            .iter()
            .filter_map(|&set| Some((set, find(vehicles, model, set)?)));
        let ours: Vec<(&'static str, &Roots)> = ours.collect();
        let list = |of: fn(&Roots) -> &Vec<Root>| {
            ours.iter()
                .map(|(_, ours)| of(ours).clone())
                .collect::<Vec<_>>()
        };
        let mut rows_of = rows("pole", printed.poles, &list(|roots| &roots.poles));
        rows_of.extend(rows("zero", printed.zeros, &list(|roots| &roots.zeros)));
        let counts: Vec<String> = ours
            .iter()
            .map(|(set, of)| {
                format!(
                    "{set}: {} poles and {} finite zeros",
                    of.poles.len(),
                    of.zeros.len()
                )
            })
            .collect();
        let mut head = vec!["root", "printed"];
        head.extend(ours.iter().flat_map(|(set, _)| [*set, "difference"]));
        tables.push(Table {
            file,
            caption: format!(
                "{} beside Table 3, in rad/s. {}",
                model.to_uppercase(),
                counts.join("; ")
            ),
            head,
            rows: rows_of,
        });
    }
    let paragraphs = tell(vehicles, findings);
    Ok(Section {
        id: "table3",
        title: "Table 3 and Fig. 6",
        paragraphs,
        tables,
        pictures: vec![Picture {
            file: "fig6.svg",
            caption: "Fig. 6: poles and zeros of y = [V, γ], u = [δe, φ]; flat Earth, no canard. Right: near the origin.".to_owned(),
            svg: drawn("fig6.svg", map(vehicles))?,
        }],
    })
}

/// Why roots differ, computed from them.
fn tell(vehicles: &[Vehicle], findings: &mut Findings) -> Vec<String> {
    let mut paragraphs = vec![
        "Poles and zeros of y = [V, γ], u = [δe, φ] at the trims above, on the flat Earth without canard. A printed root stands \
         beside the nearest of ours, if there is one nearer than 0.6 of its size. The FPM's column is not compared."
            .to_owned(),
    ];
    let column = |model: &str| TABLE_3.iter().find(|roots| roots.model == model);
    let flexible = |roots: &printed::Roots| -> Vec<f64> {
        let pairs = roots.poles.iter().filter(|root| root[1] > SLOW);
        pairs.map(|&root| -root[0] / size(root)).collect()
    };
    if let Some(dcom) = column("dcom") {
        let damping = flexible(dcom);
        let (low, high) = damping
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), &d| {
                (low.min(d), high.max(d))
            });
        findings.cannot.push(format!(
            "Table 3: its flexible poles have damping ratios of {low:.3} to {high:.3}, section 5.1 those of (36), 0.5 to 0.7: no \
             one set of modal data fits both."
        ));
        paragraphs.push(format!(
            "The flexible poles printed for the DCOM have damping ratios of {low:.3} to {high:.3}; (36) has 0.7, 0.6, 0.5. Section \
             5.3 rests on other modal data than section 5.1, which is why there are two sets of parameters here."
        ));
    }
    let real = |model: &str, set: &str| -> Option<(f64, f64)> {
        let roots = find(vehicles, model, set)?;
        let fast = roots
            .poles
            .iter()
            .filter(|root| root[1].abs() < 1e-7 && root[0].abs() > SLOW);
        let short = fast.map(|root| root[0]).filter(|re| re.abs() < 10.0);
        Some((short.clone().fold(0.0, f64::min), short.fold(0.0, f64::max)))
    };
    if let Some((stable, unstable)) = real("dcom", "section5.3") {
        findings.agrees.push(format!(
            "Table 3, DCOM: the short period of set section5.3 is {} and {}, printed -3.97 and 3.86; but that set trims far from \
             Table 2.",
            number(stable),
            number(unstable)
        ));
    }
    if let (Some(ours), Some(printed)) = (find(vehicles, "sdcom", "section5.1"), column("sdcom")) {
        let count = |roots: &[Root]| {
            roots
                .iter()
                .map(|root| if root[1] > 0.0 { 2 } else { 1 })
                .sum::<usize>()
        };
        let sentence = format!(
            "SDCOM of (27) has {} states and so {} poles, of which three are the real -ζω of the coloured noises. Table 3 prints {} \
             with three complex pairs, which cannot come from (27).",
            ours.poles.len(),
            ours.poles.len(),
            count(printed.poles)
        );
        findings.cannot.push(sentence.clone());
        paragraphs.push(format!(
            "{sentence} It has {} finite zeros, printed are {}.",
            ours.zeros.len(),
            count(printed.zeros)
        ));
    }
    paragraphs
}

/// Fig. 6: each model and set, beside the printed roots.
fn map(vehicles: &[Vehicle]) -> Result<String, PlotError> {
    let mut panels = Vec::new();
    for (model, set) in [
        ("com", SETS[0]),
        ("dcom", SETS[0]),
        ("dcom", SETS[1]),
        ("sdcom", SETS[0]),
        ("sdcom", SETS[1]),
    ] {
        let (Some(ours), Some(printed)) = (
            find(vehicles, model, set),
            TABLE_3.iter().find(|roots| roots.model == model),
        ) else {
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
        let mut near = all.clone();
        near.title.push_str(", near the origin");
        near.x = near.x.within(-SLOW, SLOW);
        near.y = near.y.within(-SLOW, SLOW);
        panels.extend([all, near]);
    }
    Figure::new("", 2, panels).svg()
}
