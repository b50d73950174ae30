//! What stands in a file of functions.

use crate::body::Statement;
use crate::shape::{PatternText, Shape, Zeros};

/// A pattern or a function.
pub(crate) enum Item {
    Pattern(PatternText),
    Function(FunctionText),
}

/// A function as the template takes it.
pub(crate) struct FunctionText {
    pub(crate) name: String,
    pub(crate) docs: Vec<String>,
    pub(crate) arguments: Vec<String>,
    pub(crate) result: String,
    /// What the dense form takes from the compressed one.
    pub(crate) source: Option<String>,
    pub(crate) statements: Vec<Statement>,
    pub(crate) zeros: Zeros,
    pub(crate) outputs: Vec<(String, String)>,
}

impl FunctionText {
    /// Whether a blank line sets the result off from what it is made of.
    pub(crate) fn sets_result_off(&self) -> bool {
        matches!(self.statements.last(), Some(Statement::Let { .. }))
    }
}

/// The function from the compressed to the dense form, where a literal says it.
pub(crate) fn scatter(shape: &Shape<'_>) -> Option<FunctionText> {
    let (name, alias) = (shape.scatter()?, shape.alias()?);
    let count = shape.entries();
    let values: Vec<String> = (0..count).map(|k| format!("values[{k}]")).collect();
    let mut zeros = Zeros::new();
    let dense = shape.dense(&values, &mut zeros);
    Some(FunctionText {
        name,
        docs: vec![format!(
            "The [`{alias}`] whose structurally non-zero entries are `values`, in the order of the pattern."
        )],
        arguments: vec![format!("values: &[R; {count}]")],
        result: shape.result(),
        source: None,
        statements: Vec::new(),
        zeros,
        outputs: vec![(String::new(), dense)],
    })
}
