//! Fits of all quantities of a table.

use ahv_fit::{
    Constraint, Design, Estimate, FitError, Monomial, Move, Problem, Residuals, Samples, Step,
    search,
};

use super::plan::{Plan, Term};
use super::samples::Columns;
use crate::failure::Failure;

/// Steps of the search for each quantity.
const MOST_STEPS: usize = 20;

/// What is asked for beside the samples.
pub(super) struct Asked {
    pub(super) folds: usize,
    pub(super) constraints: Vec<Vec<Constraint>>,
    /// Highest degree of the monomials that are searched, if there is a search.
    pub(super) degree: Option<u32>,
    /// Whether what the search proposes is taken.
    pub(super) adopt: bool,
}

/// A fitted quantity.
pub(super) struct Fitted {
    /// Number of the plan's quantity.
    pub(super) quantity: usize,
    /// What it is a sum of.
    pub(super) terms: Vec<Term>,
    pub(super) estimate: Estimate,
    pub(super) residuals: Residuals,
    /// What the search proposes, and for each step the coefficient that it is about.
    pub(super) proposed: Vec<(Step, Term)>,
}

impl Fitted {
    /// Absolute uncertainty of coefficient `index`: its standard error if samples are noisy, else what the residual justifies.
    pub(super) fn uncertainty(&self, index: usize, drawn: bool) -> f64 {
        match drawn {
            true => self.estimate.reach[index],
            false => self.estimate.covariance[(index, index)].max(0.0).sqrt(),
        }
    }
}

/// Fits every quantity that there are samples of.
///
/// # Errors
///
/// [`Failure::Request`] that names the quantity and the monomials.
pub(super) fn fit(
    plan: &mut Plan,
    columns: &Columns,
    asked: &Asked,
) -> Result<Vec<Fitted>, Failure> {
    let candidates: Vec<Vec<usize>> = columns
        .quantities
        .iter()
        .map(|&it| {
            asked
                .degree
                .map_or(Vec::new(), |degree| plan.candidates(it, degree))
        })
        .collect();
    let samples = Samples {
        variables: &columns.variables,
        responses: &columns.responses,
        weights: columns.weights.as_deref(),
    };
    let design = Design::of(&samples, &plan.monomials, asked.folds)
        .map_err(|error| refused(plan, "", &[], &error))?;
    let fitted = columns.quantities.iter().zip(candidates).enumerate();
    let fitted = fitted.map(|(response, (&number, candidates))| {
        let quantity = &plan.quantities[number];
        let section = quantity.fit.section;
        let constraints = &asked.constraints[number];
        let mut terms = quantity.terms.clone();
        let proposed = match asked.degree {
            None => Vec::new(),
            Some(_) => {
                let mut kept = quantity.required();
                kept.extend(
                    constraints
                        .iter()
                        .flat_map(|it| it.coefficients())
                        .map(|it| terms[it].column),
                );
                let start: Vec<usize> = terms.iter().map(|it| it.column).collect();
                search(&design, response, &start, &candidates, &kept, MOST_STEPS)
            }
        };
        let named = proposed.into_iter().map(|step| {
            let (Move::Add(column) | Move::Drop(column)) = step.action;
            let known = quantity.terms.iter().find(|it| it.column == column);
            (
                step,
                known
                    .cloned()
                    .unwrap_or_else(|| plan.term(quantity, column)),
            )
        });
        let proposed: Vec<(Step, Term)> = named.collect();
        let mut constraints = constraints.clone();
        if asked.adopt {
            let before = terms.clone();
            for (step, term) in &proposed {
                match step.action {
                    Move::Add(_) => terms.push(term.clone()),
                    Move::Drop(column) => terms.retain(|it| it.column != column),
                }
            }
            let moved = |index: usize| {
                let column = before[index].column;
                // What is constrained is not dropped.
                terms
                    .iter()
                    .position(|it| it.column == column)
                    .unwrap_or(index)
            };
            constraints = constraints.iter().map(|it| it.renumbered(moved)).collect();
        }
        let used: Vec<usize> = terms.iter().map(|it| it.column).collect();
        let failed = |error: FitError| refused(plan, section, &terms, &error);
        let estimate = Problem::new(&design, response, &used)
            .solve(&constraints)
            .map_err(failed)?;
        let monomials: Vec<&Monomial> = used.iter().map(|&it| &plan.monomials[it]).collect();
        let residuals = Residuals::of(&samples, response, &monomials, &estimate.values);
        Ok(Fitted {
            quantity: number,
            terms,
            estimate,
            residuals,
            proposed,
        })
    });
    fitted.collect()
}

/// Why a quantity has no fit.
fn refused(plan: &Plan, section: &str, terms: &[Term], error: &FitError) -> Failure {
    let keys = |numbers: &[usize]| {
        let keys = numbers.iter().filter_map(|&it| terms.get(it));
        keys.map(|it| format!("`{}`", it.key))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let message = match error {
        FitError::RankDeficient(numbers) if numbers.len() == 1 => format!(
            "{section}: the samples do not determine {}: it is 0 in all of them; vary its variables, fix it with --constrain, or take it out",
            keys(numbers)
        ),
        FitError::RankDeficient(numbers) => format!(
            "{section}: the samples do not tell {} apart; vary their variables, fix one with --constrain, or take one out",
            keys(numbers)
        ),
        FitError::Contradiction(number) => format!(
            "--constrain: {section}: {} has two constraints",
            keys(&[*number])
        ),
        FitError::NotFinite { row, column } if *column < plan.monomials.len() => {
            format!(
                "sample {}: `{}` is too large for a number",
                row + 1,
                plan.key(*column)
            )
        }
        FitError::TooFew { .. } | FitError::NoSolution => format!("{section}: {error}"),
        other => other.to_string(),
    };
    Failure::Request(message)
}
