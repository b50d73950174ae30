//! What a change does to a model, for people and pull requests.

use super::super::effect::{Effect, Root};
use super::super::regulated::{Regulated, Side};
use super::super::whole_box::{Farthest, WholeBox};
use super::{Block, percent, rows_of};
use crate::show::{show, show_beside};

pub(super) fn blocks(blocks: &mut Vec<Block>, effect: &Effect) {
    let place = match effect.place.as_str() {
        "" => effect.model.to_owned(),
        place => format!("{} at {place}", effect.model),
    };
    blocks.push(Block::Heading(place));
    if let Some(missing) = &effect.missing {
        blocks.push(Block::Line(missing.clone()));
    }
    about_trim(blocks, effect);
    if let Some(regulated) = &effect.regulated {
        of_loops(blocks, effect.model, regulated);
    }
    if let Some(flights) = &effect.flights {
        let how = match flights.feedback {
            true => "with the old gains",
            false => "with held inputs",
        };
        let heading = format!(
            "{}: {} flights of {} s {how}, with noise and dispersed parameters",
            effect.model, flights.members, flights.seconds
        );
        blocks.push(Block::Heading(heading));
        let shown = |it: &ahv_analysis::statistics::Estimate| {
            let [value, low, high] = [it.value, it.low, it.high].map(|it| percent(Some(it)));
            format!("{value} [{low}, {high}]")
        };
        let row = [
            "leave the validity box".to_owned(),
            shown(&flights.old),
            shown(&flights.new),
        ];
        blocks.push(rows_of(&["", "old", "new"], [row.to_vec()].into_iter()));
    }
    over_box(blocks, effect);
}

fn about_trim(blocks: &mut Vec<Block>, effect: &Effect) {
    if !effect.trim.is_empty() {
        let rows = effect.trim.iter().map(|it| {
            let unit = it.unit;
            let change = show_beside(it.new - it.old, 0.0, unit);
            let [old, new] =
                [(it.old, it.new), (it.new, it.old)].map(|(a, b)| show_beside(a, b, unit));
            vec![it.name.to_owned(), old, new, change]
        });
        blocks.push(rows_of(&["trim", "old", "new", "change"], rows));
    }
    if !effect.poles.is_empty() {
        let rows = effect.poles.iter().map(|it| {
            let damping = format!("{:.4} to {:.4}", it.old.damping, it.new.damping);
            let mode = it.mode.unwrap_or("-").to_owned();
            vec![mode, root(it.old), root(it.new), damping]
        });
        blocks.push(rows_of(&["pole", "old", "new", "damping"], rows));
    }
    let [old, new] = [&effect.zeros.old, &effect.zeros.new];
    if !(old.is_empty() && new.is_empty()) {
        let rows = (0..old.len().max(new.len())).map(|index| {
            let cell = |roots: &[Root]| {
                roots
                    .get(index)
                    .map_or_else(|| "-".to_owned(), |it| root(*it))
            };
            vec![format!("{}", index + 1), cell(old), cell(new)]
        });
        blocks.push(rows_of(&["zero", "old", "new"], rows));
    }
    if !effect.slopes.is_empty() {
        let rows = effect.slopes.iter().map(|it| {
            let number = |value: f64| format!("{value:.6e} {}", it.unit);
            let relative = Some((it.new - it.old) / it.old.abs()).filter(|it| it.is_finite());
            let name = format!("{} by {}", it.output, it.state);
            vec![name, number(it.old), number(it.new), percent(relative)]
        });
        blocks.push(rows_of(&["slope", "old", "new", "change"], rows));
    }
}

fn of_loops(blocks: &mut Vec<Block>, model: &str, regulated: &Regulated) {
    blocks.push(Block::Heading(format!(
        "{model}: margins with the LQR gains of the old table"
    )));
    if let Some(missing) = &regulated.missing {
        blocks.push(Block::Line(missing.clone()));
        return;
    }
    let factor = |value: Option<f64>, without: &str| {
        value.map_or_else(|| without.to_owned(), |it| format!("{it:.4}"))
    };
    let gain = |it: &Side| {
        format!(
            "{} to {}",
            factor(it.least_gain, "0"),
            factor(it.most_gain, "any")
        )
    };
    let phase = |it: &Side| {
        it.phase
            .map_or_else(|| "any".to_owned(), |it| format!("{it:.2} deg"))
    };
    let rows = regulated.loops.iter().map(|it| {
        vec![
            it.input.clone(),
            gain(&it.old),
            gain(&it.new),
            phase(&it.old),
            phase(&it.new),
        ]
    });
    let head = ["loop at", "gain times, old", "new", "phase, old", "new"];
    blocks.push(rows_of(&head, rows));
}

fn over_box(blocks: &mut Vec<Block>, effect: &Effect) {
    let WholeBox {
        trims,
        outputs,
        points,
    } = &effect.whole_box;
    if let Some(trims) = trims {
        let [first, second] = trims.states;
        let heading = format!("{} over the validity box: trims", effect.model);
        blocks.push(Block::Heading(heading));
        let mut line = format!(
            "of {} flight conditions over {first} and {second} {} trim with the old table and {} with the new one",
            trims.points, trims.old, trims.new
        );
        if trims.gained + trims.lost > 0 {
            line += &format!(": {} gained, {} lost", trims.gained, trims.lost);
        }
        blocks.push(Block::Line(line));
        let unit = |name: &str| {
            effect
                .units
                .iter()
                .find(|it| it.0 == name)
                .map_or("1", |it| it.1)
        };
        let rows = trims.changes.iter().map(|it| {
            let mut row = farthest(it);
            let place = it.at.map(|[x, y]| {
                format!(
                    "{first} {}, {second} {}",
                    show(x, unit(first)),
                    show(y, unit(second))
                )
            });
            row.push(place.unwrap_or_default());
            row
        });
        if trims.changes.is_empty() {
            let none = "no quantity of a trim changes".to_owned();
            blocks.push(Block::Line(none));
        } else {
            let head = ["largest change", "old", "new", "change", "at"];
            blocks.push(rows_of(&head, rows));
        }
    }
    let heading = format!(
        "{} over the validity box: largest change of each output, at {points} points",
        effect.model
    );
    blocks.push(Block::Heading(heading));
    if outputs.is_empty() {
        blocks.push(Block::Line(
            "none changes at the same states and inputs".to_owned(),
        ));
        return;
    }
    let rows = outputs.iter().map(|it| {
        let mut row = farthest(it);
        row.push(percent(it.share));
        row
    });
    blocks.push(rows_of(
        &["output", "old", "new", "change", "of the largest"],
        rows,
    ));
}

fn farthest(it: &Farthest) -> Vec<String> {
    let unit = it.unit;
    let [old, new] = [(it.old, it.new), (it.new, it.old)].map(|(a, b)| show_beside(a, b, unit));
    let change = show_beside(it.new - it.old, 0.0, unit);
    vec![it.name.to_owned(), old, new, change]
}

fn root(root: Root) -> String {
    match root.im {
        0.0 => format!("{:.5} 1/s", root.re),
        im => format!("{:.5} ± {im:.5}i 1/s", root.re),
    }
}
