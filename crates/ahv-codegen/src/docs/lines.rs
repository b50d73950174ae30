//! Equations as lines of a display, broken before addends.

use super::tree::{Product, Tex};
use super::typeset::{brackets, magnitude, signed, sum_depth, text};

/// Lines longer than this are broken.
const WIDEST_LINE: f64 = 62.0;

/// `left = right` as lines of a display, broken before addends.
pub(super) fn equation(left: &str, right: &Tex, tag: &str) -> Vec<String> {
    let mut lines: Vec<Vec<String>> = Vec::new();
    let mut room = 0.0;
    for (latex, width) in pieces(right) {
        match lines.last_mut() {
            Some(line) if width <= room => {
                line.push(latex);
                room -= width;
            }
            _ => {
                lines.push(vec![latex]);
                room = WIDEST_LINE - width;
            }
        }
    }
    displayed(left, &lines, tag)
}

/// `left = right` with each addend on a line of text of its own, so that a number is one line of a diff.
pub(super) fn listed(left: &str, right: &Tex, tag: &str) -> Vec<String> {
    let Tex::Sum(addends) = right else {
        return displayed(left, &[vec![signed(right)]], tag);
    };
    let lines: Vec<Vec<String>> = signed_addends(addends)
        .chunks(4)
        .map(|chunk| chunk.iter().map(|(latex, _)| latex.clone()).collect())
        .collect();
    displayed(left, &lines, tag)
}

fn displayed(left: &str, lines: &[Vec<String>], tag: &str) -> Vec<String> {
    let tag = if tag.is_empty() {
        String::new()
    } else {
        format!(" \\tag{{{tag}}}")
    };
    let mut text = Vec::new();
    if let [line] = lines {
        text.push(format!("{left} = {}", line[0]));
        text.extend(line[1..].iter().map(|piece| format!("  {piece}")));
        if let Some(last) = text.last_mut() {
            *last += &tag;
        }
        return text;
    }
    text.push("\\begin{aligned}".to_owned());
    for (position, line) in lines.iter().enumerate() {
        let start = if position == 0 {
            format!("{left} ={{}}& ")
        } else {
            "&\\quad{} ".to_owned()
        };
        text.push(format!("{start}{}", line[0]));
        text.extend(line[1..].iter().map(|piece| format!("  {piece}")));
        if position + 1 < lines.len()
            && let Some(last) = text.last_mut()
        {
            *last += " \\\\";
        }
    }
    text.push(format!("\\end{{aligned}}{tag}"));
    text
}

fn signed_addends(addends: &[Tex]) -> Vec<(String, f64)> {
    addends
        .iter()
        .enumerate()
        .map(|(position, addend)| {
            let (negative, text) = magnitude(addend);
            let sign = sign(position == 0, negative);
            (format!("{sign}{}", text.latex), text.width + 2.0)
        })
        .collect()
}

fn sign(first: bool, negative: bool) -> &'static str {
    match (first, negative) {
        (true, false) => "",
        (true, true) => "-",
        (false, false) => "+ ",
        (false, true) => "- ",
    }
}

/// Pieces of a formula between which a line may break, with their widths.
fn pieces(tex: &Tex) -> Vec<(String, f64)> {
    let (negative, whole) = magnitude(tex);
    if whole.width <= WIDEST_LINE {
        return vec![(signed(tex), whole.width)];
    }
    match tex {
        Tex::Sum(addends) => addend_pieces(addends),
        Tex::Product(product) => broken_product(product)
            .map(|mut inner| {
                if let Some((first, _)) = inner.first_mut() {
                    first.insert_str(0, sign(true, negative));
                }
                inner
            })
            .unwrap_or_else(|| vec![(signed(tex), whole.width)]),
        _ => vec![(signed(tex), whole.width)],
    }
}

fn addend_pieces(addends: &[Tex]) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    for (position, addend) in addends.iter().enumerate() {
        let (negative, _) = magnitude(addend);
        let mut inner = pieces(&unsigned(addend));
        if let Some((first, width)) = inner.first_mut() {
            first.insert_str(0, sign(position == 0, negative));
            *width += 2.0;
        }
        all.append(&mut inner);
    }
    all
}

fn unsigned(tex: &Tex) -> Tex {
    match tex {
        Tex::Number(value) => Tex::Number(value.abs()),
        Tex::Value(value) => Tex::Value(value.abs()),
        Tex::Product(product) => Tex::Product(Product {
            negative: false,
            ..product.clone()
        }),
        other => other.clone(),
    }
}

/// A product with one long sum: the rest of it, an open bracket, the sum's pieces, the closing bracket.
fn broken_product(product: &Product) -> Option<Vec<(String, f64)>> {
    let is_sum = |factor: &(Tex, i32)| matches!(factor, (Tex::Sum(_), 1));
    let position = product.factors.iter().position(is_sum)?;
    if product
        .factors
        .iter()
        .filter(|factor| is_sum(factor))
        .count()
        > 1
    {
        return None;
    }
    let mut rest = product.clone();
    let (Tex::Sum(addends), _) = rest.factors.remove(position) else {
        return None;
    };
    rest.negative = false;
    let (open, close) = brackets(sum_depth(&addends));
    let before = text(&rest.finish());
    let mut inner = addend_pieces(&addends);
    if let Some((first, width)) = inner.first_mut() {
        let prefix = if before.latex == "1" {
            String::new()
        } else {
            format!("{} ", before.latex)
        };
        first.insert_str(0, &format!("{prefix}\\Bigl{open} "));
        *width += before.width + 1.0;
    }
    if let Some((last, _)) = inner.last_mut() {
        *last += &format!(" \\Bigr{close}");
    }
    Some(inner)
}
