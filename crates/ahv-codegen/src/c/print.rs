//! Prints expressions and statements as C99.

use crate::graph::Kind;
use crate::schedule::tree::{Binding, Expr, Operation, Sign, Source, Statement};
use crate::wording::visible;

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
            Source::Argument(Kind::Argument) | Source::Result => name.to_owned(),
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
            Expr::Call(call, arguments) => {
                let arguments = arguments.iter().map(|it| self.expression(it));
                let arguments: Vec<String> = arguments.collect();
                format!("ahv_{}({})", call.name(), arguments.join(", "))
            }
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
                let mut addends = self.addends(addends);
                addends[0] = format!("{target} = {}", addends[0]);
                if let Some(last) = addends.last_mut() {
                    last.push(';');
                }
                let depths = std::iter::once(1).chain(std::iter::repeat(2));
                let lines = addends.iter().zip(depths);
                lines.flat_map(|(it, depth)| folded(it, depth, 3)).collect()
            }
            value => broken(&format!("{target} = {};", self.expression(value))),
        };
        // A pure number has no unit to show.
        if matches!(unit, "" | "1") {
            return lines;
        }
        let unit = comment(unit);
        match lines.last_mut() {
            Some(last) if last.chars().count() + 1 + unit.chars().count() <= WIDTH => {
                *last += &format!(" {unit}");
            }
            _ => lines.insert(0, format!("{INDENT}{unit}")),
        }
        lines
    }
}

/// A comment in one line.
pub(super) fn comment(text: &str) -> String {
    format!("/* {} */", harmless(text))
}

/// A text that neither ends a comment nor begins one; in ASCII where it names Itô.
pub(super) fn harmless(text: &str) -> String {
    let text = visible(text).replace("*/", "* /").replace("/*", "/ *");
    // Two question marks may begin a trigraph, a backslash may join lines.
    let text = text.replace("??", "? ?").replace('\\', "/");
    text.replace('ô', "o")
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
    folded(statement, 1, 2)
}

/// A text in lines that are not too long: the first at one depth, the others at another.
fn folded(text: &str, first: usize, others: usize) -> Vec<String> {
    let chunks = chunks(text);
    let mut lines = Vec::new();
    let (mut rest, mut depth) = (chunks.as_slice(), first);
    while !rest.is_empty() {
        let room = WIDTH - INDENT.len() * depth;
        let mut width = 0;
        let ends = rest.iter().map(|(chunk, _)| {
            width += chunk.chars().count() + 1;
            width - 1
        });
        let ends: Vec<usize> = ends.collect();
        let fitting = ends.iter().take_while(|end| **end <= room).count().max(1);
        let mut taken = rest.len();
        if fitting < rest.len() {
            // Where the formula's parts are largest, but not so early that the line stays empty.
            let places = (1..=fitting).filter(|it| *it == fitting || ends[*it - 1] > room / 3);
            let best = places.min_by_key(|it| (rest[*it].1, fitting - it));
            taken = best.unwrap_or(fitting);
        }
        let words: Vec<&str> = rest[..taken].iter().map(|(it, _)| it.as_str()).collect();
        lines.push(INDENT.repeat(depth) + &words.join(" "));
        (rest, depth) = (&rest[taken..], others);
    }
    lines
}

/// The parts of a text between which a line may end, each with the rank of the place before it: the deeper in
/// parentheses, the higher, and higher before a factor than before an addend. An operator begins a part.
fn chunks(text: &str) -> Vec<(String, usize)> {
    let mut chunks: Vec<(String, usize)> = Vec::new();
    let (mut depth, mut operator) = (0_usize, None);
    for word in text.split(' ') {
        if matches!(word, "+" | "-" | "*" | "/") {
            operator = Some(word);
            continue;
        }
        let is_factor = matches!(operator, Some("*" | "/"));
        let rank = 2 * depth + usize::from(is_factor);
        match (operator.take(), chunks.last_mut()) {
            (Some(operator), _) => chunks.push((format!("{operator} {word}"), rank)),
            (None, Some((last, _))) if word == "=" => *last += " =",
            (None, _) => chunks.push((word.to_owned(), rank)),
        }
        depth = (depth + word.matches('(').count()).saturating_sub(word.matches(')').count());
    }
    chunks
}
