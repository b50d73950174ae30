//! Symbols in LaTeX: what they are made of, how tightly they bind, and how wide they are.

/// What a token of a symbol is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A letter, digit, command with its arguments, or group.
    Base,
    /// `\sin` and the like.
    Function,
    /// Text in parentheses, with them.
    Parentheses,
    /// What stands after `_`.
    Subscript,
    /// What stands after `^`.
    Superscript,
    /// `+`, `-` or `=`.
    Sign,
    /// `/`.
    Slash,
}

/// A token and its text; scripts are without their braces.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Token {
    kind: Kind,
    text: String,
}

/// What a symbol is as a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// One letter, with or without a subscript; also `g(h)`.
    Atom,
    /// A letter with a superscript that is a label, such as `C_L^{\alpha}`.
    Labelled,
    /// A whole power.
    Power,
    /// A sine or cosine.
    Function,
    /// Several letters beside each other.
    Product,
    /// What stands before and after a slash.
    Quotient(String, String),
    /// Anything with a sign in it.
    Sum,
}

impl Shape {
    /// Whether the symbol is a formula rather than a name.
    pub(super) fn is_formula(&self) -> bool {
        !matches!(self, Self::Atom | Self::Labelled)
    }
}

/// Commands that take the next token as their argument.
const ACCENTS: [&str; 12] = [
    "bar",
    "dot",
    "ddot",
    "hat",
    "tilde",
    "vec",
    "mathrm",
    "mathbf",
    "text",
    "operatorname",
    "overline",
    "boldsymbol",
];
const FUNCTIONS: [&str; 5] = ["sin", "cos", "exp", "ln", "tan"];
/// Commands and characters that only set distances.
const SPACES: [&str; 8] = ["left", "right", ",", ";", "!", ":", " ", "quad"];

/// The tokens of a symbol.
fn tokens(latex: &str) -> Vec<Token> {
    let characters: Vec<char> = latex.chars().collect();
    let mut found: Vec<Token> = Vec::new();
    let mut at = 0;
    while at < characters.len() {
        let start = at;
        let kind = match characters[at] {
            ' ' => {
                at += 1;
                continue;
            }
            '_' | '^' => {
                let kind = if characters[at] == '_' {
                    Kind::Subscript
                } else {
                    Kind::Superscript
                };
                at += 1;
                let text = argument(&characters, &mut at);
                found.push(Token { kind, text });
                continue;
            }
            '+' | '-' | '=' => Kind::Sign,
            '/' => Kind::Slash,
            '(' => Kind::Parentheses,
            '|' => {
                // An evaluation bar belongs to what stands before it.
                at += 1;
                if let Some(last) = found.last_mut() {
                    last.text.push('|');
                }
                continue;
            }
            '\\' => {
                let name = command(&characters, at);
                if SPACES.contains(&name.as_str()) {
                    at += 1 + name.chars().count();
                    continue;
                }
                if FUNCTIONS.contains(&name.as_str()) {
                    Kind::Function
                } else {
                    Kind::Base
                }
            }
            _ => Kind::Base,
        };
        skip(&characters, &mut at);
        let text = characters[start..at].iter().collect::<String>();
        found.push(Token {
            kind,
            text: text.trim().to_owned(),
        });
    }
    found
}

/// Name of the command whose backslash stands at a place; one character where it is not a letter.
fn command(characters: &[char], at: usize) -> String {
    let rest = &characters[at + 1..];
    let letters = rest.iter().take_while(|c| c.is_ascii_alphabetic()).count();
    rest.iter().take(letters.max(1)).collect()
}

/// Moves past one token with its arguments.
fn skip(characters: &[char], at: &mut usize) {
    match characters.get(*at) {
        Some('{') => skip_enclosed(characters, at, '{', '}'),
        Some('(') => skip_enclosed(characters, at, '(', ')'),
        Some('\\') => {
            let name = command(characters, *at);
            *at += 1 + name.chars().count();
            let arguments = match name.as_str() {
                "frac" | "tfrac" => 2,
                "sqrt" => 1,
                name if ACCENTS.contains(&name) => 1,
                _ => 0,
            };
            for _ in 0..arguments {
                skip_spaces(characters, at);
                skip(characters, at);
            }
        }
        Some(_) => *at += 1,
        None => {}
    }
}

fn skip_spaces(characters: &[char], at: &mut usize) {
    while characters.get(*at) == Some(&' ') {
        *at += 1;
    }
}

fn skip_enclosed(characters: &[char], at: &mut usize, open: char, close: char) {
    let mut depth = 0;
    while let Some(&character) = characters.get(*at) {
        *at += 1;
        if character == open {
            depth += 1;
        } else if character == close {
            depth -= 1;
            if depth == 0 {
                return;
            }
        }
    }
}

/// The next token as an argument, without braces.
fn argument(characters: &[char], at: &mut usize) -> String {
    skip_spaces(characters, at);
    let start = *at;
    skip(characters, at);
    let text: String = characters[start..*at].iter().collect();
    let inner = text.strip_prefix('{').and_then(|t| t.strip_suffix('}'));
    inner.unwrap_or(&text).trim().to_owned()
}

/// What a symbol is as a formula.
pub(super) fn shape(latex: &str) -> Shape {
    let tokens = tokens(latex);
    if tokens.iter().any(|t| t.kind == Kind::Sign) {
        return Shape::Sum;
    }
    if tokens.iter().any(|t| t.kind == Kind::Slash) {
        let (above, below) = split_at_slash(latex);
        return Shape::Quotient(above, below);
    }
    let bases = tokens
        .iter()
        .filter(|t| matches!(t.kind, Kind::Base | Kind::Function))
        .count();
    let functions = tokens.iter().filter(|t| t.kind == Kind::Function).count();
    if bases - functions > 1 {
        return Shape::Product;
    }
    // Roots and exponentials are written as what they are.
    let exponential =
        tokens.len() == 2 && tokens[0].text == "e" && tokens[1].kind == Kind::Superscript;
    if exponential || tokens.iter().any(|t| t.text.starts_with("\\sqrt")) {
        return Shape::Power;
    }
    if functions > 0 {
        return Shape::Function;
    }
    let raised = tokens.iter().filter(|t| t.kind == Kind::Superscript);
    let numbers = raised
        .clone()
        .filter(|t| t.text.chars().all(|c| c.is_ascii_digit()))
        .count();
    match raised.count() {
        0 => Shape::Atom,
        _ if numbers > 0 => Shape::Power,
        _ => Shape::Labelled,
    }
}

/// The parts before and after the first slash outside braces and parentheses, without enclosing parentheses.
fn split_at_slash(latex: &str) -> (String, String) {
    let mut depth = 0;
    for (at, character) in latex.char_indices() {
        match character {
            '{' | '(' => depth += 1,
            '}' | ')' => depth -= 1,
            '/' if depth == 0 => {
                return (
                    bare(&latex[..at]).to_owned(),
                    bare(&latex[at + 1..]).to_owned(),
                );
            }
            _ => {}
        }
    }
    (latex.to_owned(), "1".to_owned())
}

fn bare(latex: &str) -> &str {
    let latex = latex.trim();
    let inner = latex.strip_prefix('(').and_then(|t| t.strip_suffix(')'));
    inner.filter(|t| !t.contains(['(', ')'])).unwrap_or(latex)
}

/// Width in characters, scripts smaller.
pub(super) fn width(latex: &str) -> f64 {
    let tokens = tokens(latex);
    tokens
        .iter()
        .map(|token| match token.kind {
            Kind::Function => 2.0,
            Kind::Subscript | Kind::Superscript => 0.7 * width(&token.text),
            Kind::Sign | Kind::Slash => 1.5,
            Kind::Parentheses => 1.0 + width(token.text.trim_matches(['(', ')'])),
            Kind::Base if token.text.starts_with("\\frac") => fraction_width(&token.text),
            Kind::Base if token.text.starts_with("\\sqrt{") => {
                1.0 + width(&token.text["\\sqrt".len()..])
            }
            Kind::Base if token.text.starts_with('{') => width(token.text.trim_matches(['{', '}'])),
            Kind::Base => 1.0,
        })
        .sum()
}

fn fraction_width(latex: &str) -> f64 {
    let characters: Vec<char> = latex.chars().collect();
    let mut at = "\\frac".len();
    let above = argument(&characters, &mut at);
    let below = argument(&characters, &mut at);
    width(&above).max(width(&below))
}
