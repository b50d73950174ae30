//! Names for values that the derivation did not name, told from what they are.

use crate::dag::{Call, Dag, Id, Kind, Node};
use crate::ir;

/// Longer names are not read; such a value is numbered under the quantity that it belongs to.
const LONGEST: usize = 40;

/// A name that describes a node, or `None` where it would be too long.
pub(crate) fn describe(dag: &Dag, model: &ir::Model, id: Id) -> Option<String> {
    let name = spell(dag, model, id)?;
    (dag.name(id).is_some() || name.len() <= LONGEST).then_some(name)
}

fn spell(dag: &Dag, model: &ir::Model, id: Id) -> Option<String> {
    if let Some(position) = dag.name(id) {
        return Some(model.quantities[position].name.clone());
    }
    match dag.node(id) {
        Node::Number(_) => None,
        Node::Leaf(Kind::Noise, name) => Some(format!("d{name}")),
        Node::Leaf(_, name) => Some(name.clone()),
        Node::Power(base, exponent) => {
            let base = spell(dag, model, *base)?;
            Some(match exponent {
                -1 => format!("inv_{base}"),
                k if *k < 0 => format!("inv_{base}_{}", -k),
                k => format!("{base}_{k}"),
            })
        }
        Node::Call(call, argument) => {
            let argument = spell(dag, model, *argument)?;
            let function = match call {
                Call::Sin => "sin",
                Call::Cos => "cos",
                Call::Exp => "exp",
                Call::Sqrt => "sqrt",
            };
            Some(format!("{function}_{argument}"))
        }
        Node::Product(coefficient, factors) => spell_product(dag, model, *coefficient, factors),
        Node::Sum(terms) => {
            let mut text = String::new();
            for (position, &(coefficient, id)) in terms.iter().enumerate() {
                let joint = if coefficient < 0.0 {
                    "_minus_"
                } else {
                    "_plus_"
                };
                if position > 0 || coefficient < 0.0 {
                    text += joint.trim_start_matches(if position == 0 { "_" } else { "" });
                }
                if coefficient.abs() != 1.0 {
                    text += &format!("{}_", number_word(coefficient.abs())?);
                }
                text += &if dag.is_one(id) {
                    "one".to_owned()
                } else {
                    spell(dag, model, id)?
                };
            }
            Some(text)
        }
    }
}

fn spell_product(dag: &Dag, model: &ir::Model, coefficient: f64, factors: &[Id]) -> Option<String> {
    let (mut above, mut below) = (Vec::new(), Vec::new());
    if coefficient < 0.0 {
        above.push("minus".to_owned());
    }
    if coefficient.abs() != 1.0 {
        above.push(number_word(coefficient.abs())?);
    }
    for &factor in factors {
        match dag.node(factor) {
            Node::Power(base, -1) if dag.name(factor).is_none() => {
                below.push(spell(dag, model, *base)?)
            }
            _ => above.push(spell(dag, model, factor)?),
        }
    }
    let above = above.join("_");
    Some(match (above.is_empty(), below.is_empty()) {
        (_, true) => above,
        (true, false) => format!("inv_{}", below.join("_")),
        (false, false) => format!("{above}_over_{}", below.join("_")),
    })
}

fn number_word(value: f64) -> Option<String> {
    Some(
        match value {
            0.5 => "half",
            2.0 => "two",
            3.0 => "three",
            4.0 => "four",
            5.0 => "five",
            6.0 => "six",
            _ => return None,
        }
        .to_owned(),
    )
}
