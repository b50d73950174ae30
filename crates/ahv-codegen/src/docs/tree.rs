//! Formulas as trees: sums, products of powers, and how they simplify.

use crate::call::Call;

/// A formula.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tex {
    /// A constant of the model.
    Number(f64),
    /// A number of the table: never merged with another, so that a reader finds it.
    Value(f64),
    /// A symbol.
    Symbol(String),
    Sum(Vec<Tex>),
    Product(Product),
    /// A function of its arguments.
    Call(Call, Vec<Tex>),
}

/// A formula to a whole power.
pub(super) type Factor = (Tex, i32);

/// Neighbouring addends, and what all of them share.
type Run = (Vec<Factor>, Vec<Tex>);

/// Sign, numbers and powers of a product.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Product {
    pub(super) negative: bool,
    /// The constants of the model, multiplied.
    pub(super) coefficient: f64,
    /// Numbers of the table.
    pub(super) values: Vec<f64>,
    /// Factors with whole exponents other than 0.
    pub(super) factors: Vec<Factor>,
}

impl Product {
    pub(super) fn one() -> Self {
        Self {
            negative: false,
            coefficient: 1.0,
            values: Vec::new(),
            factors: Vec::new(),
        }
    }

    fn multiply(&mut self, tex: Tex, exponent: i32) {
        match tex {
            Tex::Number(value) => {
                self.negative ^= value < 0.0 && exponent % 2 != 0;
                let size = value.abs();
                for _ in 0..exponent.abs() {
                    if exponent > 0 {
                        self.coefficient *= size
                    } else {
                        self.coefficient /= size
                    }
                }
            }
            Tex::Value(value) if exponent == 1 => {
                self.negative ^= value < 0.0;
                self.values.push(value.abs());
            }
            Tex::Product(inner) if exponent == 1 || inner.values.is_empty() => {
                self.negative ^= inner.negative && exponent % 2 != 0;
                self.multiply(Tex::Number(inner.coefficient), exponent);
                self.values.extend(inner.values);
                for (factor, power) in inner.factors {
                    self.multiply(factor, power * exponent);
                }
            }
            Tex::Call(Call::Exp, arguments) if exponent != 1 => {
                let number = Tex::Number(f64::from(exponent));
                let argument = product([vec![number], arguments].concat());
                self.multiply(Tex::Call(Call::Exp, vec![argument]), 1);
            }
            Tex::Call(Call::Sqrt, arguments) if exponent % 2 == 0 => {
                self.multiply(product(arguments), exponent / 2);
            }
            other => match self.factors.iter_mut().find(|(factor, _)| *factor == other) {
                Some((_, power)) => {
                    *power += exponent;
                    self.factors.retain(|(_, power)| *power != 0);
                }
                None => self.factors.push((other, exponent)),
            },
        }
    }

    /// The product as simple as it is.
    pub(super) fn finish(mut self) -> Tex {
        if self.coefficient == 0.0 {
            return Tex::Number(0.0);
        }
        let alone = !self.negative && self.coefficient == 1.0;
        match (self.values.len(), self.factors.as_slice()) {
            (0, []) => Tex::Number(if self.negative {
                -self.coefficient
            } else {
                self.coefficient
            }),
            (1, []) if self.coefficient == 1.0 => Tex::Value(if self.negative {
                -self.values[0]
            } else {
                self.values[0]
            }),
            (0, [(_, 1)]) if alone => self.factors.swap_remove(0).0,
            _ => Tex::Product(self),
        }
    }
}

/// A product of many factors.
pub(super) fn product(parts: Vec<Tex>) -> Tex {
    let mut all = Product::one();
    for part in parts {
        all.multiply(part, 1);
    }
    all.finish()
}

/// A whole power.
pub(super) fn power(base: Tex, exponent: i32) -> Tex {
    let mut all = Product::one();
    if exponent != 0 {
        all.multiply(base, exponent);
    }
    all.finish()
}

/// A sum of many addends.
pub(super) fn sum(parts: Vec<Tex>) -> Tex {
    let mut addends = Vec::new();
    for part in parts {
        match part {
            Tex::Sum(inner) => inner.into_iter().for_each(|part| add(&mut addends, part)),
            Tex::Number(0.0) => {}
            other => add(&mut addends, other),
        }
    }
    let mut addends = gathered(addends);
    match addends.len() {
        0 => Tex::Number(0.0),
        1 => addends.swap_remove(0),
        _ => Tex::Sum(addends),
    }
}

/// Adds an addend; multiples of the same product become one.
fn add(addends: &mut Vec<Tex>, addend: Tex) {
    let (size, factors) = multiple(&addend);
    let same = addends
        .iter()
        .position(|known| !factors.is_empty() && multiple(known).1 == factors);
    let Some(position) = same else {
        addends.push(addend);
        return;
    };
    let coefficient = size + multiple(&addends[position]).0;
    if coefficient == 0.0 {
        addends.remove(position);
        return;
    }
    let mut all = Product::one();
    all.multiply(Tex::Number(coefficient), 1);
    for (factor, exponent) in factors {
        all.multiply(factor, exponent);
    }
    addends[position] = all.finish();
}

/// A formula as a number times factors; no factors where it holds numbers of the table.
fn multiple(tex: &Tex) -> (f64, Vec<Factor>) {
    match tex {
        Tex::Product(p) if p.values.is_empty() => {
            let sign = if p.negative { -1.0 } else { 1.0 };
            (sign * p.coefficient, p.factors.clone())
        }
        Tex::Symbol(_) | Tex::Call(..) => (1.0, vec![(tex.clone(), 1)]),
        _ => (1.0, Vec::new()),
    }
}

/// Takes out what neighbouring addends share, if that is a fraction, such as q S/(m V) of lift and thrust.
fn gathered(addends: Vec<Tex>) -> Vec<Tex> {
    let mut runs: Vec<Run> = Vec::new();
    for addend in addends {
        let own = match &addend {
            Tex::Product(product) => product.factors.clone(),
            _ => Vec::new(),
        };
        if let Some((shared, run)) = runs.last_mut() {
            let both = common(shared, &own);
            if both.len() > 1 && both.iter().any(|(_, exponent)| *exponent < 0) {
                *shared = both;
                run.push(addend);
                continue;
            }
        }
        runs.push((own, vec![addend]));
    }
    let taken_out = |(shared, mut run): Run| {
        if run.len() == 1 {
            return run.swap_remove(0);
        }
        let negative = run
            .iter()
            .all(|addend| matches!(addend, Tex::Product(p) if p.negative));
        let mut outside = Product {
            negative,
            ..Product::one()
        };
        let mut inside = Vec::new();
        for addend in run {
            let mut rest = Product {
                negative,
                ..Product::one()
            };
            rest.multiply(addend, 1);
            for (factor, exponent) in &shared {
                rest.multiply(factor.clone(), -exponent);
            }
            inside.push(rest.finish());
        }
        for (factor, exponent) in shared {
            outside.multiply(factor, exponent);
        }
        outside.multiply(Tex::Sum(inside), 1);
        outside.finish()
    };
    runs.into_iter().map(taken_out).collect()
}

/// The powers that two products share.
fn common(a: &[Factor], b: &[Factor]) -> Vec<Factor> {
    let shared = |(factor, exponent): &Factor| {
        let (_, other) = b.iter().find(|(known, _)| known == factor)?;
        let same_side = (*exponent > 0) == (*other > 0);
        let least = if exponent.abs() < other.abs() {
            exponent
        } else {
            other
        };
        same_side.then(|| (factor.clone(), *least))
    };
    a.iter().filter_map(shared).collect()
}

/// The formula with the other sign; the sign of a sum goes to its addends.
pub(super) fn negated(tex: Tex) -> Tex {
    match tex {
        Tex::Sum(addends) => Tex::Sum(addends.into_iter().map(negated).collect()),
        Tex::Number(value) => Tex::Number(-value),
        Tex::Value(value) => Tex::Value(-value),
        other => product(vec![Tex::Number(-1.0), other]),
    }
}
