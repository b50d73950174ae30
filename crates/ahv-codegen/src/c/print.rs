//! Prints expressions and statements as C99.

use crate::graph::{Call, Kind};
use crate::schedule::tree::{Binding, Expr, Operation, Sign, Source, Statement};

/// A sum of this many addends is written one a line, so that a new one is one line of a diff.
const LISTED: usize = 3;
/// Lines of code stay below this width.
const WIDTH: usize = 118;
const INDENT: &str = "    ";

/// Prints what stands in a function.
#[derive(Clone, Copy)]
pub(super) struct Printer {
    /// The stages that the function holds itself; the others are behind pointers.
    pub(super) holds_stages: bool,
}

impl Printer {
    /// A component of an argument.
    pub(super) fn component(self, source: Source, name: &str) -> String {
        match source {
            Source::Argument(Kind::State) => format!("x->{name}"),
            Source::Argument(Kind::Input) => format!("u->{name}"),
            Source::Argument(Kind::Noise) => format!("dw->{name}"),
            Source::Argument(Kind::Parameter) => format!("p->{name}"),
            Source::Argument(Kind::Argument) => name.to_owned(),
            Source::Stage(stage) if self.holds_stages => format!("{}.{name}", stage.argument),
            Source::Stage(stage) => format!("{}->{name}", stage.argument),
        }
    }

    /// An expression.
    pub(super) fn expression(self, expr: &Expr) -> String {
        match expr {
            Expr::Number(value) => format!("{value:?}"),
            Expr::Component(source, name) => self.component(*source, name),
            Expr::Name(name) => name.clone(),
            Expr::Negative(part) => format!("-{}", self.enclosed(part, Binding::Atom)),
            Expr::Sum(addends) => self.addends(addends).join(" "),
            Expr::Product(factors) => self.product(factors),
            Expr::Reciprocal(part) => format!("1.0 / {}", self.enclosed(part, Binding::Atom)),
            Expr::Call(call, part) => format!("{}({})", function(*call), self.expression(part)),
        }
    }

    fn product(self, factors: &[(Operation, Expr)]) -> String {
        let mut text = String::new();
        for (position, (operation, factor)) in factors.iter().enumerate() {
            text += match (position, operation) {
                (0, _) => "",
                (_, Operation::Times) => " * ",
                (_, Operation::Over) => " / ",
            };
            text += &match factor {
                Expr::Negative(_) => self.expression(factor),
                Expr::Number(_) if position == 0 => self.expression(factor),
                _ => self.enclosed(factor, Binding::Atom),
            };
        }
        text
    }

    /// An expression in parentheses where its place asks for more than it binds; a reciprocal is a quotient here.
    fn enclosed(self, expr: &Expr, least: Binding) -> String {
        let text = self.expression(expr);
        let binding = match expr {
            Expr::Reciprocal(_) => Binding::Product,
            Expr::Number(value) if *value < 0.0 => Binding::Product,
            _ => expr.binding(),
        };
        if binding < least {
            format!("({text})")
        } else {
            text
        }
    }

    fn addends(self, addends: &[(Sign, Expr)]) -> Vec<String> {
        let addend = |(position, (sign, expr)): (usize, &(Sign, Expr))| {
            let sign = match (position, sign) {
                (0, Sign::Plus) => "",
                (0, Sign::Minus) => "-",
                (_, Sign::Plus) => "+ ",
                (_, Sign::Minus) => "- ",
            };
            format!("{sign}{}", self.enclosed(expr, Binding::Product))
        };
        addends.iter().enumerate().map(addend).collect()
    }

    /// The lines of a statement, indented.
    pub(super) fn statement(self, statement: &Statement) -> Vec<String> {
        match statement {
            Statement::Section(heading) => {
                vec![String::new(), format!("{INDENT}{}", comment(heading))]
            }
            Statement::Let { name, value, unit } => {
                self.assignment(&format!("const double {name}"), value, unit)
            }
            Statement::Set {
                source,
                field,
                value,
                unit,
            } => self.assignment(&self.component(*source, field), value, unit),
            Statement::SinCos { sin, cos, angle } => {
                let mut lines = Vec::new();
                for value in [sin, cos] {
                    if let Expr::Name(name) = value {
                        lines.push(format!("{INDENT}double {name};"));
                    }
                }
                let (sin, cos) = (self.expression(sin), self.expression(cos));
                let angle = self.expression(angle);
                lines.extend(broken(&format!("ahv_sin_cos({angle}, &{sin}, &{cos});")));
                lines
            }
        }
    }

    /// The lines of an assignment; long sums have an addend a line.
    pub(super) fn assignment(self, target: &str, value: &Expr, unit: &str) -> Vec<String> {
        let mut lines = match value {
            Expr::Sum(addends) if addends.len() >= LISTED => {
                let addends = self.addends(addends).join(&format!("\n{INDENT}{INDENT}"));
                let text = format!("{INDENT}{target} = {addends};");
                text.lines().map(str::to_owned).collect()
            }
            value => broken(&format!("{target} = {};", self.expression(value))),
        };
        // A pure number has no unit to tell.
        if !matches!(unit, "" | "1")
            && let Some(last) = lines.last_mut()
        {
            let unit = comment(unit);
            if last.chars().count() + 1 + unit.chars().count() <= WIDTH {
                *last += &format!(" {unit}");
            }
        }
        lines
    }
}

fn function(call: Call) -> &'static str {
    match call {
        Call::Sin => "ahv_sin",
        Call::Cos => "ahv_cos",
        Call::Exp => "ahv_exp",
        Call::Sqrt => "ahv_sqrt",
    }
}

/// A comment in one line.
pub(super) fn comment(text: &str) -> String {
    format!("/* {} */", harmless(text))
}

/// A text that neither ends a comment nor begins one.
fn harmless(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *")
}

/// A comment of several lines.
pub(super) fn comments(lines: &[String], indent: &str) -> String {
    let lines: Vec<String> = lines.iter().map(|line| harmless(line)).collect();
    let text = lines.join(&format!("\n{indent} * "));
    let text: Vec<&str> = text.lines().map(str::trim_end).collect();
    format!("{indent}/* {} */", text.join("\n"))
}

/// A statement in lines that are not too long, indented.
pub(super) fn broken(statement: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = INDENT.to_owned();
    for word in statement.split(' ') {
        let is_first = line.trim().is_empty();
        if !is_first && line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(std::mem::replace(&mut line, INDENT.repeat(2) + word));
            continue;
        }
        if !is_first {
            line.push(' ');
        }
        line += word;
    }
    lines.push(line);
    lines
}
