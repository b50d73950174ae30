//! What a table asks a fit for: quantities, their monomials, their variables.

use ahv_core::{EntryKind, Fit, FitVariable, Table};
use ahv_fit::{Constraint, Monomial};
use ahv_table::{Family, Text, Unit, degrees, in_radians, powers, si_name};

use crate::failure::Failure;
use crate::names;

/// The fitted quantities of a table. Monomials are numbered across all of them.
pub(super) struct Plan {
    pub(super) family: Family,
    /// Variables of all quantities, units in the system of the table.
    pub(super) variables: Vec<Named>,
    pub(super) quantities: Vec<Quantity>,
    pub(super) monomials: Vec<Monomial>,
}

/// A variable or a quantity with its unit.
pub(super) struct Named {
    pub(super) name: &'static str,
    pub(super) unit: String,
    /// Its entry of the validity box.
    pub(super) interval: Option<&'static str>,
}

/// A quantity that is a sum of monomials.
pub(super) struct Quantity {
    pub(super) fit: &'static Fit,
    pub(super) unit: String,
    pub(super) terms: Vec<Term>,
    /// Keys that a table must have.
    required: Vec<&'static str>,
}

/// A coefficient.
#[derive(Clone)]
pub(super) struct Term {
    /// Its key as the table writes it.
    pub(super) key: String,
    /// Its unit as the table writes it.
    pub(super) unit: String,
    /// Number of its monomial.
    pub(super) column: usize,
}

impl Term {
    /// What turns a coefficient in radians into one of the table's unit.
    pub(super) fn factor(&self) -> f64 {
        1.0 / in_radians(1.0, degrees(&self.unit).unwrap_or(0))
    }
}

impl Plan {
    /// That of a table without fault.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if the table's models have no curve fits.
    pub(super) fn new(text: &Text, family: Family) -> Result<Self, Failure> {
        let listed = ahv_review::models(text);
        let si = text.item(&["table", "units"]).and_then(|it| it.as_str()) == Some("si");
        let unit = |unit: &str| match si && family.table.unit_system != "si" {
            true => si_name(unit),
            false => unit.to_owned(),
        };
        let fits = family.table.fits.iter();
        let fits: Vec<&Fit> = fits.filter(|fit| Table::has(fit.models, &listed)).collect();
        if fits.is_empty() {
            let message = "the models of this table have no quantity that is a sum of monomials";
            return Err(Failure::Request(message.to_owned()));
        }
        let mut variables: Vec<Named> = Vec::new();
        let all: Vec<&FitVariable> = fits.iter().flat_map(|it| it.variables).collect();
        for it in all {
            if !variables.iter().any(|known| known.name == it.name) {
                variables.push(Named {
                    name: it.name,
                    unit: unit(it.unit),
                    interval: it.interval,
                });
            }
        }
        let mut plan = Self {
            family,
            variables,
            quantities: Vec::new(),
            monomials: Vec::new(),
        };
        for fit in fits {
            let entries = text.item(&[fit.section]).and_then(|it| it.as_table_like());
            let entries = entries.into_iter().flat_map(|it| it.iter());
            let terms = entries.map(|(key, item)| {
                let written = item.get("unit").and_then(|it| it.as_str());
                Term {
                    key: key.to_owned(),
                    unit: written.unwrap_or("1").to_owned(),
                    column: plan.column(key),
                }
            });
            let terms = terms.collect();
            let required = family.table.entries.iter().filter(|entry| {
                entry.section == fit.section && entry.kind == EntryKind::RequiredCoefficient
            });
            plan.quantities.push(Quantity {
                fit,
                unit: unit(fit.unit),
                terms,
                required: required.map(|it| it.key).collect(),
            });
        }
        Ok(plan)
    }

    /// The number of the monomial of a key.
    fn column(&mut self, key: &str) -> usize {
        let powers = powers(key).unwrap_or_default();
        let exponent = |it: &Named| powers.get(it.name).copied().unwrap_or(0);
        let monomial: Monomial = self.variables.iter().map(exponent).collect();
        let known = self.monomials.iter().position(|it| *it == monomial);
        known.unwrap_or_else(|| {
            self.monomials.push(monomial);
            self.monomials.len() - 1
        })
    }

    /// The key of a monomial as tables write it.
    pub(super) fn key(&self, column: usize) -> String {
        let powers = self.variables.iter().zip(&self.monomials[column]);
        let factor = |(it, exponent): (&Named, &u32)| match exponent {
            0 => None,
            1 => Some(it.name.to_owned()),
            more => Some(format!("{}^{more}", it.name)),
        };
        let factors: Vec<String> = powers.filter_map(factor).collect();
        match factors.is_empty() {
            true => "1".to_owned(),
            false => factors.join("*"),
        }
    }

    /// The variables that a quantity depends on: those of its terms, or of all monomials that it may have.
    pub(super) fn used(&self, quantity: &Quantity, all: bool) -> Vec<usize> {
        let used = |&index: &usize| {
            let name = self.variables[index].name;
            let mut terms = quantity.terms.iter();
            let known = quantity.fit.variables.iter().any(|it| it.name == name);
            all && known || terms.any(|it| self.monomials[it.column][index] > 0)
        };
        (0..self.variables.len()).filter(used).collect()
    }

    /// The monomials up to a degree that a quantity may have, numbered.
    pub(super) fn candidates(&mut self, quantity: usize, degree: u32) -> Vec<usize> {
        let fit = self.quantities[quantity].fit;
        let mut found: Vec<Monomial> = vec![vec![0; self.variables.len()]];
        for (index, variable) in self.variables.iter().enumerate() {
            if !fit.variables.iter().any(|it| it.name == variable.name) {
                continue;
            }
            let grown = found.iter().flat_map(|monomial| {
                let left = degree - monomial.iter().sum::<u32>();
                (0..=left).map(move |exponent| {
                    let mut monomial = monomial.clone();
                    monomial[index] = exponent;
                    monomial
                })
            });
            found = grown.collect();
        }
        let affine = |monomial: &Monomial| {
            let powers = self.variables.iter().zip(monomial);
            let affine = powers.filter(|(it, _)| fit.affine.contains(&it.name));
            affine.map(|(_, exponent)| exponent).sum::<u32>() <= 1
        };
        found.retain(affine);
        let number = |monomial: Monomial| {
            let known = self.monomials.iter().position(|it| *it == monomial);
            known.unwrap_or_else(|| {
                self.monomials.push(monomial);
                self.monomials.len() - 1
            })
        };
        found.into_iter().map(number).collect()
    }

    /// The coefficient of a monomial that a table does not have yet.
    pub(super) fn term(&self, quantity: &Quantity, column: usize) -> Term {
        let powers = self.variables.iter().zip(&self.monomials[column]);
        let unit = powers.fold(quantity.unit.clone(), |unit, (it, &exponent)| {
            over(&unit, &it.unit, exponent)
        });
        Term {
            key: self.key(column),
            unit,
            column,
        }
    }

    /// Reads constraints such as `C_L.alpha=4.6`, `C_D.alpha^2>=0`, `C_L.delta_c=0.6*C_L.delta_e`, for each quantity.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] that says what is wrong and what would be right.
    pub(super) fn constraints(&self, texts: &[String]) -> Result<Vec<Vec<Constraint>>, Failure> {
        let mut found = vec![Vec::new(); self.quantities.len()];
        for text in texts {
            let failed = |why: String| {
                Failure::Request(format!("--constrain: `{}`: {why}", names::printable(text)))
            };
            let (quantity, constraint) = self.constraint(text).map_err(failed)?;
            let same: &mut Vec<Constraint> = &mut found[quantity];
            same.push(constraint);
        }
        Ok(found)
    }

    fn constraint(&self, text: &str) -> Result<(usize, Constraint), String> {
        let operators = [">=", "<=", "="];
        let split = operators
            .iter()
            .find_map(|it| Some((*it, text.split_once(it)?)));
        let (operator, (left, right)) = split.ok_or(
            "write SECTION.MONOMIAL=NUMBER, >=0, <=0, or =NUMBER*SECTION.MONOMIAL of the same section",
        )?;
        let (quantity, term) = self.coefficient(left)?;
        let number = right.trim().parse::<f64>().ok().filter(|it| it.is_finite());
        let coefficient = &self.quantities[quantity].terms[term];
        let constraint = match (operator, number) {
            (">=", Some(0.0)) => Constraint::NotNegative(term),
            ("<=", Some(0.0)) => Constraint::NotPositive(term),
            (">=" | "<=", _) => return Err("a sign constraint compares with 0".to_owned()),
            (_, Some(number)) => Constraint::Fixed(term, number / coefficient.factor()),
            (_, None) => {
                let factored = right
                    .split_once('*')
                    .and_then(|(factor, rest)| Some((factor.trim().parse::<f64>().ok()?, rest)));
                let (factor, rest) = factored.unwrap_or((1.0, right));
                let (other_quantity, other) = self.coefficient(rest)?;
                if other_quantity != quantity || other == term || !factor.is_finite() {
                    return Err("a coefficient is tied to another one of its section".to_owned());
                }
                let own = &self.quantities[quantity].terms;
                Constraint::Tied {
                    coefficient: term,
                    other,
                    factor: factor * own[other].factor() / own[term].factor(),
                }
            }
        };
        Ok((quantity, constraint))
    }

    fn coefficient(&self, text: &str) -> Result<(usize, usize), String> {
        let sections: Vec<&str> = self.quantities.iter().map(|it| it.fit.section).collect();
        let (section, key) = text
            .trim()
            .split_once('.')
            .ok_or("a coefficient is SECTION.MONOMIAL")?;
        let quantity = sections.iter().position(|it| *it == section.trim());
        let quantity =
            quantity.ok_or_else(|| names::unknown("section", section.trim(), &sections))?;
        let terms = &self.quantities[quantity].terms;
        let wanted = powers(key.trim());
        let found = terms
            .iter()
            .position(|it| wanted.is_some() && powers(&it.key) == wanted);
        let known: Vec<&str> = terms.iter().map(|it| it.key.as_str()).collect();
        let found = found.ok_or_else(|| names::unknown("monomial", key.trim(), &known))?;
        Ok((quantity, found))
    }
}

impl Quantity {
    /// The monomials that a table must have.
    pub(super) fn required(&self) -> Vec<usize> {
        let of = |key: &&str| self.terms.iter().find(|it| powers(&it.key) == powers(key));
        self.required
            .iter()
            .filter_map(of)
            .map(|it| it.column)
            .collect()
    }
}

/// A unit over the power of another.
fn over(unit: &str, other: &str, exponent: u32) -> String {
    if exponent == 0 || other == "1" {
        return unit.to_owned();
    }
    let simple = !other.contains(['*', '/', '^']);
    if simple && exponent > 1 {
        return format!("{unit}/{other}^{exponent}");
    }
    // Brackets hold names alone, so that what is divided by is turned over factor by factor.
    let depth = other.find('/').filter(|_| Unit::parse(other).is_some());
    let one = match depth {
        Some(at) => format!("/{}*{}", &other[..at], other[at + 1..].replace('/', "*")),
        None => format!("/{other}"),
    };
    format!("{unit}{}", one.repeat(exponent as usize))
}

#[cfg(test)]
mod tests {
    use super::over;

    #[test]
    fn a_coefficient_has_the_unit_of_its_quantity_over_its_monomial() {
        for (unit, other, exponent, wanted) in [
            ("1", "rad", 2, "1/rad^2"),
            ("lb/ft", "1", 3, "lb/ft"),
            ("lb/ft", "rad", 1, "lb/ft/rad"),
            ("1", "(ft*slug)^0.5", 1, "1/(ft*slug)^0.5"),
            ("1", "ft/s", 2, "1/ft*s/ft*s"),
        ] {
            assert_eq!(over(unit, other, exponent), wanted);
        }
    }
}
