//! Formulas in one line of LaTeX.

use super::symbol::{self, Shape};
use super::tree::{Product, Tex};
use crate::call::Call;

/// How tightly LaTeX text binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    /// Whole, but a further exponent needs parentheses.
    Raised,
    Atom,
}

/// LaTeX text and what its surroundings must know of it.
pub(super) struct Text {
    pub(super) latex: String,
    binding: Binding,
    /// Nesting of parentheses in it.
    depth: usize,
    pub(super) width: f64,
    /// Ends in the argument of a function, to which a following letter would seem to belong.
    open: bool,
}

impl Text {
    fn atom(latex: String, width: f64) -> Self {
        Self {
            latex,
            binding: Binding::Atom,
            depth: 0,
            width,
            open: false,
        }
    }

    fn enclosed(self) -> Self {
        let (open, close) = brackets(self.depth);
        Self {
            latex: format!("\\left{open} {} \\right{close}", self.latex),
            binding: Binding::Atom,
            depth: self.depth + 1,
            width: self.width + 2.0,
            open: false,
        }
    }

    fn at_least(self, binding: Binding) -> Self {
        if self.binding < binding {
            self.enclosed()
        } else {
            self
        }
    }
}

/// The LaTeX of a formula in one line.
pub(super) fn signed(tex: &Tex) -> String {
    let (negative, text) = magnitude(tex);
    if negative {
        format!("-{}", text.latex)
    } else {
        text.latex
    }
}

/// Whether a formula is negative, and its text without the sign.
pub(super) fn magnitude(tex: &Tex) -> (bool, Text) {
    match tex {
        Tex::Number(value) | Tex::Value(value) => {
            let latex = number(*value);
            let width = symbol::width(&latex);
            (*value < 0.0, Text::atom(latex, width))
        }
        Tex::Product(product) => (product.negative, product_text(product)),
        other => (false, text(other)),
    }
}

/// The text of a formula.
pub(super) fn text(tex: &Tex) -> Text {
    match tex {
        Tex::Symbol(latex) => symbol_text(latex),
        Tex::Sum(addends) => sum_text(addends),
        Tex::Call(call, arguments) => call_text(*call, arguments),
        Tex::Number(_) | Tex::Value(_) | Tex::Product(_) => {
            let (negative, mut text) = magnitude(tex);
            if negative {
                text.latex.insert(0, '-');
                text.binding = Binding::Sum;
            }
            text
        }
    }
}

fn symbol_text(latex: &str) -> Text {
    let shape = symbol::shape(latex);
    let binding = match shape {
        Shape::Sum => Binding::Sum,
        Shape::Product | Shape::Quotient(..) => Binding::Product,
        Shape::Power | Shape::Labelled | Shape::Function => Binding::Raised,
        Shape::Atom => Binding::Atom,
    };
    let fraction = latex.starts_with("\\frac");
    Text {
        latex: latex.to_owned(),
        binding: if fraction { Binding::Raised } else { binding },
        depth: usize::from(latex.contains('(')),
        width: symbol::width(latex),
        open: latex.contains("\\sin") || latex.contains("\\cos"),
    }
}

/// Nesting of parentheses in a sum.
pub(super) fn sum_depth(addends: &[Tex]) -> usize {
    sum_text(addends).depth
}

/// Brackets around text in which parentheses are nested so deep.
pub(super) fn brackets(depth: usize) -> (&'static str, &'static str) {
    [("(", ")"), ("[", "]"), ("\\{", "\\}")][depth % 3]
}

fn sum_text(addends: &[Tex]) -> Text {
    let mut all = Text {
        latex: String::new(),
        binding: Binding::Sum,
        depth: 0,
        width: 0.0,
        open: true,
    };
    for (position, addend) in addends.iter().enumerate() {
        let (negative, text) = magnitude(addend);
        let sign = match (position, negative) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        };
        all.latex += sign;
        all.latex += &text.latex;
        all.depth = all.depth.max(text.depth);
        all.width += text.width + 2.0;
    }
    all
}

/// Longer exponents stand in parentheses.
const SHORT_EXPONENT: f64 = 12.0;

/// The command of a function.
fn command(call: Call) -> String {
    match call {
        Call::Asin => "\\arcsin".to_owned(),
        Call::Atan => "\\arctan".to_owned(),
        Call::Atan2 => "\\operatorname{atan2}".to_owned(),
        _ => format!("\\{}", call.name()),
    }
}

/// A function of several arguments, or one with signs of its own around them.
fn several_text(call: Call, arguments: &[Tex]) -> Text {
    let inner: Vec<Text> = arguments.iter().map(signed_text).collect();
    let latex: Vec<&str> = inner.iter().map(|it| it.latex.as_str()).collect();
    let (latex, binding) = match (call, latex.as_slice()) {
        (Call::Abs, [a]) => (format!("\\left| {a} \\right|"), Binding::Atom),
        (Call::Powr, [_, exponent]) => {
            let base = text(&arguments[0]).at_least(Binding::Atom);
            (format!("{}^{{{exponent}}}", base.latex), Binding::Raised)
        }
        (Call::Select, [a, bound, below, otherwise]) => {
            let first = format!("{below} & {a} < {bound}");
            let second = format!("{otherwise} & \\text{{else}}");
            let latex = format!("\\begin{{cases}} {first} \\\\ {second} \\end{{cases}}");
            (latex, Binding::Product)
        }
        (_, all) => {
            let inside = all.join(",\\, ");
            let latex = format!("{}\\left( {inside} \\right)", command(call));
            (latex, Binding::Raised)
        }
    };
    Text {
        latex,
        binding,
        depth: 1 + inner.iter().map(|it| it.depth).max().unwrap_or(0),
        width: 3.0 + inner.iter().map(|it| it.width).sum::<f64>(),
        open: false,
    }
}

/// The text of a formula with its sign.
fn signed_text(tex: &Tex) -> Text {
    let (_, text) = magnitude(tex);
    Text {
        latex: signed(tex),
        ..text
    }
}

fn call_text(call: Call, arguments: &[Tex]) -> Text {
    let [argument] = arguments else {
        return several_text(call, arguments);
    };
    if call == Call::Abs {
        return several_text(call, arguments);
    }
    let inner = text(argument);
    if call == Call::Sqrt {
        return Text {
            latex: format!("\\sqrt{{{}}}", inner.latex),
            binding: Binding::Raised,
            open: false,
            ..inner
        };
    }
    if call == Call::Exp && inner.width <= SHORT_EXPONENT && !inner.latex.contains("\\frac") {
        let width = 1.0 + 0.7 * inner.width;
        let latex = format!("e^{{{}}}", inner.latex);
        return Text {
            latex,
            binding: Binding::Raised,
            width,
            open: true,
            ..inner
        };
    }
    let command = command(call);
    if inner.binding == Binding::Atom && call != Call::Exp {
        let width = inner.width + 2.0;
        let latex = format!("{command} {}", inner.latex);
        return Text {
            latex,
            binding: Binding::Raised,
            width,
            open: true,
            ..inner
        };
    }
    let inner = inner.enclosed();
    let width = inner.width + 3.0;
    Text {
        latex: format!("{command}{}", inner.latex),
        binding: Binding::Raised,
        width,
        ..inner
    }
}

fn power_text(base: &Tex, exponent: i32) -> Text {
    if exponent == 1 {
        return text(base);
    }
    let script = if exponent < 10 {
        exponent.to_string()
    } else {
        format!("{{{exponent}}}")
    };
    let function = match base {
        Tex::Call(call @ (Call::Sin | Call::Cos), _) => Some(command(*call)),
        Tex::Symbol(latex) if symbol::shape(latex) == Shape::Function => ["\\sin", "\\cos"]
            .iter()
            .find(|f| latex.starts_with(**f))
            .map(|f| (*f).to_owned()),
        _ => None,
    };
    let mut text = text(base);
    if let Some(function) = function {
        text.latex = text
            .latex
            .replacen(&function, &format!("{function}^{script}"), 1);
        return text;
    }
    let text = text.at_least(Binding::Atom);
    Text {
        latex: format!("{}^{script}", text.latex),
        binding: Binding::Raised,
        width: text.width + 0.7,
        ..text
    }
}

/// Sums longer than this stand beside a fraction, not in it.
const WIDEST_NUMERATOR: f64 = 30.0;

/// The parts of a product as they are written: numbers and plain factors of numerator and denominator, and sums.
struct Arrangement {
    above: Vec<Text>,
    below: Vec<Text>,
    /// Sums in brackets, and fractions, which stand behind.
    behind: Vec<Text>,
}

fn arranged(product: &Product) -> Arrangement {
    let (mut above, mut below) = (Vec::new(), Vec::new());
    let (mut sums, mut fractions) = (Vec::new(), Vec::new());
    for (factor, exponent) in &product.factors {
        let text = power_text(factor, exponent.abs());
        match (*exponent > 0, text.binding == Binding::Sum) {
            (true, true) => sums.push(text),
            (true, false) if text.latex.starts_with("\\frac") => fractions.push(text),
            (true, false) => above.push(text),
            (false, _) => below.push(text),
        }
    }
    place_coefficient(product, &mut above, &mut below);
    if !product.values.is_empty() {
        above.insert(0, numbers(&product.values));
    }
    let short = sums.len() == 1 && above.is_empty() && sums[0].width <= WIDEST_NUMERATOR;
    if !below.is_empty() && short {
        above.append(&mut sums);
    }
    let behind = fractions
        .into_iter()
        .chain(sums.into_iter().map(Text::enclosed));
    Arrangement {
        above,
        below,
        behind: behind.collect(),
    }
}

/// Puts a constant where it reads best: whole numbers above, reciprocals of whole numbers below.
fn place_coefficient(product: &Product, above: &mut Vec<Text>, below: &mut Vec<Text>) {
    let coefficient = product.coefficient;
    let whole_below = 1.0 / coefficient;
    let is = |number: f64| (coefficient - number).abs() < 1e-15;
    if is(std::f64::consts::SQRT_2) {
        above.insert(0, Text::atom("\\sqrt{2}".to_owned(), 2.0));
    } else if is(std::f64::consts::FRAC_1_SQRT_2) {
        below.insert(0, Text::atom("\\sqrt{2}".to_owned(), 2.0));
    } else if coefficient < 1.0 && whole_below.fract() == 0.0 {
        if below.is_empty() && product.values.is_empty() {
            above.insert(
                0,
                Text::atom(format!("\\tfrac{{1}}{{{}}}", number(whole_below)), 1.0),
            );
        } else {
            below.insert(0, Text::atom(number(whole_below), 1.0));
        }
    } else if coefficient != 1.0 {
        above.insert(0, numbers(&[coefficient]));
    }
}

fn numbers(values: &[f64]) -> Text {
    let parts: Vec<String> = values.iter().map(|&value| number(value)).collect();
    let latex = parts.join(" \\cdot ");
    let width = latex.len() as f64;
    Text {
        latex: format!("{latex}\\,"),
        binding: Binding::Product,
        depth: 0,
        width,
        open: false,
    }
}

fn product_text(product: &Product) -> Text {
    let Arrangement {
        above,
        below,
        behind,
    } = arranged(product);
    if below.is_empty() {
        let (open, closed): (Vec<Text>, Vec<Text>) = above.into_iter().partition(|text| text.open);
        let mut text = beside(closed.into_iter().chain(behind).chain(open).collect());
        if text.latex.ends_with("\\,") {
            text.latex.truncate(text.latex.len() - 2);
        }
        return text;
    }
    let fraction = fraction(above, below);
    let mut parts = vec![fraction];
    parts.extend(behind);
    beside(parts)
}

fn fraction(above: Vec<Text>, below: Vec<Text>) -> Text {
    let above = beside(with_open_last(above));
    let below = beside(with_open_last(below));
    let above_latex = if above.latex.is_empty() {
        "1"
    } else {
        above.latex.trim_end_matches("\\,")
    };
    Text {
        latex: format!(
            "\\frac{{{above_latex}}}{{{}}}",
            below.latex.trim_end_matches("\\,")
        ),
        binding: Binding::Product,
        depth: above.depth.max(below.depth),
        width: above.width.max(below.width).max(1.0),
        open: false,
    }
}

fn with_open_last(parts: Vec<Text>) -> Vec<Text> {
    let (open, closed): (Vec<Text>, Vec<Text>) = parts.into_iter().partition(|text| text.open);
    closed.into_iter().chain(open).collect()
}

/// Factors beside each other; one alone keeps how it binds.
fn beside(mut parts: Vec<Text>) -> Text {
    if parts.len() == 1 {
        return parts.swap_remove(0);
    }
    let mut all = Text {
        latex: String::new(),
        binding: Binding::Product,
        depth: 0,
        width: 0.0,
        open: false,
    };
    for part in parts {
        let part = part.at_least(Binding::Product);
        if !all.latex.is_empty() {
            all.latex.push(' ');
        }
        all.latex += &part.latex;
        all.depth = all.depth.max(part.depth);
        all.width += part.width;
        all.open = part.open;
    }
    all
}

/// A number for a formula, in its shortest decimal form and without its sign.
pub(super) fn number(value: f64) -> String {
    let value = value.abs();
    if value == 0.0 || (1e-3..1e7).contains(&value) {
        return format!("{value}");
    }
    let text = format!("{value:e}");
    match text.split_once('e') {
        Some(("1", exponent)) => format!("10^{{{exponent}}}"),
        Some((digits, exponent)) => format!("{digits}\\cdot 10^{{{exponent}}}"),
        None => text,
    }
}
