//! Where the values of the candidates' functions lie, and the memory that these want.

use serde_json::Value;

use crate::kernel::{Layout, Work};
use crate::subject::Subject;

/// The whole numbers of a list.
pub(crate) fn numbers(value: &Value) -> Vec<usize> {
    let numbers = value.as_array().into_iter().flatten();
    numbers
        .filter_map(Value::as_u64)
        .map(|it| it as usize)
        .collect()
}

/// The working memory that CasADi says a function of its C needs.
pub(crate) fn work(said: &Value) -> Result<Work, String> {
    let &[arguments, results, integers, reals] = &numbers(said)[..] else {
        return Err("error: CasADi's peer.json lacks a function".to_owned());
    };
    Ok(Work {
        arguments,
        results,
        integers,
        reals,
    })
}

/// The outputs of the product: Jacobians have the entries that are not 0 by structure.
pub(crate) fn own_layout(subject: &Subject) -> Layout {
    let dense = |(rows, columns): &(usize, usize)| (0..rows * columns).collect();
    let mut outputs: Layout = subject.shapes.iter().map(dense).collect();
    for (output, pattern) in outputs.iter_mut().skip(1).zip(subject.patterns) {
        let [_, columns] = pattern.shape;
        *output = pattern.at.iter().map(|[i, j]| i * columns + j).collect();
    }
    outputs
}

/// Where the outputs of the product stand within all outputs.
pub(crate) fn of_product(subject: &Subject) -> Layout {
    shifted(own_layout(subject), subject)
}

/// Positions within each output become positions within all outputs, one after the other.
pub(crate) fn shifted(layout: Layout, subject: &Subject) -> Layout {
    let mut start = 0;
    let outputs = layout.into_iter().zip(subject.shapes);
    let shift = |(positions, (rows, columns)): (Vec<usize>, &(usize, usize))| {
        let all = positions.into_iter().map(|it| start + it).collect();
        start += rows * columns;
        all
    };
    outputs.map(shift).collect()
}
