//! Lays out statements, heads of functions and lists within the width of a line.

/// Addends of a sum, separated by `|`: one a line where they do not stand on one.
pub(super) const ADDENDS: &str = "__addends!";

/// Lines stay below this width, comments included.
pub(super) const WIDTH: usize = 120;
/// The width of a statement that a unit follows: where it breaks depends on no unit.
const WIDTH_BEFORE_UNIT: usize = 100;

/// Whether a line begins a list of imports.
pub(super) fn is_import(code: &str) -> bool {
    code.starts_with("use ") || code.starts_with("pub use ")
}

fn is_head(code: &str) -> bool {
    code.starts_with("fn ") || code.starts_with("pub fn ")
}

/// Whether a line begins a statement that names or sets a value.
fn is_statement(code: &str) -> bool {
    let is_place = |c: char| c.is_alphanumeric() || "_.(), ".contains(c);
    let left = code.strip_suffix(" =");
    let left = left.or_else(|| code.split_once(" = ").map(|(left, _)| left));
    let sets = left.is_some_and(|left| left.chars().all(is_place));
    code.starts_with("let ") || code.starts_with(ADDENDS) || sets
}

/// Whether a line begins an item of a list: a call, or a struct.
fn is_item(code: &str) -> bool {
    let is_path = |text: &str| {
        let parts = text.split("::");
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        parts.fold(!text.is_empty(), |all, part| {
            all && !part.is_empty() && part.chars().all(is_name)
        })
    };
    let of_field = |text: &str| {
        text.split_once(": ")
            .is_some_and(|(a, b)| is_path(a) && is_path(b))
    };
    code.strip_suffix('(').is_some_and(is_path)
        || code
            .strip_suffix(" {")
            .is_some_and(|text| text == "Self" || of_field(text))
}

/// The number of the first lines that may be joined, as the formatter broke them.
pub(super) fn length(lines: &[&str]) -> usize {
    let until = |ends: &dyn Fn(&str) -> bool| {
        let end = lines.iter().position(|line| ends(line.trim_start()));
        end.map_or(1, |end| end + 1)
    };
    let first = lines.first().copied().unwrap_or_default();
    let code = first.trim_start();
    let indent = first.len() - code.len();
    if is_import(code) {
        until(&|code| code.ends_with(';'))
    } else if is_head(code) {
        until(&|code| code.ends_with(['{', ';']))
    } else if is_statement(code) {
        let is_tail = code.starts_with(ADDENDS);
        let length = until(&|code| code.ends_with(['{', ';']) || is_tail && code.ends_with(')'));
        // A block has lines of its own.
        let is_block = lines[length - 1].ends_with('{');
        if is_block { 1 } else { length }
    } else if is_item(code) {
        let end = lines.iter().position(|line| {
            line.len() > indent && line[indent..].starts_with([')', '}']) && line.trim().len() < 3
        });
        end.map_or(1, |end| end + 1)
    } else if code.ends_with(')')
        && lines
            .get(1)
            .is_some_and(|line| line.trim().starts_with('.'))
    {
        2
    } else {
        1
    }
}

/// The text of lines that may be joined, with a comment; none where what does not fit has lines of its own.
pub(super) fn laid_out(lines: &[&str], comment: &str) -> Option<String> {
    let first = lines.first()?;
    let indent = &first[..first.len() - first.trim_start().len()];
    let code = joined(lines);
    let most = if comment.is_empty() {
        WIDTH
    } else {
        WIDTH_BEFORE_UNIT
    };
    let text = if let Some((start, addends)) = code.split_once(ADDENDS) {
        sum(indent, start, addends, most)
    } else if width(indent) + width(&code) <= most {
        format!("{indent}{code}")
    } else {
        let broken = if is_head(&code) {
            list(indent, &code, '(')
        } else if is_import(&code) {
            list(indent, &code, '{')
        } else if is_statement(&code) {
            filled(indent, &code, &["+", "-"], most)
                .or_else(|| filled(indent, &code, &["+", "-", "*", "/"], most))
        } else {
            return None;
        };
        broken.unwrap_or_else(|| lines.join("\n"))
    };
    if comment.is_empty() {
        return Some(text + "\n");
    }
    let last = text.lines().next_back().map_or(0, width);
    Some(if last + width(comment) + " // ".len() <= WIDTH {
        format!("{text} // {comment}\n")
    } else {
        format!("{indent}// {comment}\n{text}\n")
    })
}

fn joined(lines: &[&str]) -> String {
    let mut all = String::new();
    for code in lines.iter().map(|line| line.trim()) {
        let closes = code.starts_with([')', ']', '}']);
        if closes && all.ends_with(',') {
            all.pop();
        }
        let inside = all.is_empty() || all.ends_with(['(', '[']) || all.ends_with("::{");
        let is_struct = code.starts_with('}') && !code.starts_with("};");
        let is_call = code.starts_with('.') && !code.starts_with("..");
        if !(inside || is_call || closes && !is_struct) {
            all.push(' ');
        }
        all += code;
    }
    all
}

fn width(text: &str) -> usize {
    text.chars().count()
}

/// A sum on one line, or one addend a line: a new one is one line of a diff.
fn sum(indent: &str, start: &str, addends: &str, most: usize) -> String {
    let end = if addends.ends_with(';') { ";" } else { "" };
    let addends = addends.trim_end_matches(';').trim_start_matches("(\"");
    let addends = addends.trim_end_matches("\")");
    let one = format!("{indent}{start}{}{end}", addends.replace('|', " "));
    if width(&one) <= most {
        return one;
    }
    let listed = addends.replace('|', &format!("\n{indent}    "));
    let first = listed.lines().next().map_or(0, width);
    // A long name leaves no room for the first addend beside it.
    let start = if width(indent) + width(start) + first < most {
        start.to_owned()
    } else {
        format!("{}\n{indent}    ", start.trim_end())
    };
    format!("{indent}{start}{listed}{end}")
}

/// A list in brackets, as many items a line as fit.
fn list(indent: &str, code: &str, bracket: char) -> Option<String> {
    let (head, rest) = code.split_once(bracket)?;
    let mut depth = 1;
    let end = rest.find(|c| {
        depth += i32::from("([{".contains(c)) - i32::from(")]}".contains(c));
        depth == 0
    })?;
    let (items, end) = rest.split_at(end);
    let items: Vec<&str> = items.split(", ").map(str::trim).collect();
    let items = flowed(&format!("{indent}    "), &items);
    Some(format!("{indent}{head}{bracket}\n{items}\n{indent}{end}"))
}

/// Items with commas, as many a line as fit.
pub(super) fn flowed<T: AsRef<str>>(indent: &str, items: &[T]) -> String {
    let items = items.iter().map(|item| format!("{},", item.as_ref()));
    flow(indent, &items.collect::<Vec<_>>())
}

/// Items, as many a line as fit.
pub(super) fn flow(indent: &str, items: &[String]) -> String {
    let mut lines: Vec<String> = Vec::new();
    for item in items {
        match lines.last_mut() {
            Some(line) if width(line) + width(item) < WIDTH => *line += &format!(" {item}"),
            _ => lines.push(format!("{indent}{item}")),
        }
    }
    lines.join("\n")
}

/// A statement broken at operators outside of parentheses, as many operands a line as fit; none where one is too long.
fn filled(indent: &str, code: &str, operators: &[&str], most: usize) -> Option<String> {
    let mut operands = vec![String::new()];
    let mut depth = 0;
    for word in code.split(' ') {
        if depth == 0 && operators.contains(&word) {
            operands.push(String::new());
        }
        let operand = operands.last_mut()?;
        if !operand.is_empty() {
            operand.push(' ');
        }
        *operand += word;
        let count = |bracket: &[char]| i32::try_from(word.matches(bracket).count()).unwrap_or(0);
        depth += count(&['(', '[']) - count(&[')', ']']);
    }
    let mut lines: Vec<String> = Vec::new();
    for operand in operands {
        match lines.last_mut() {
            Some(line) if width(line) + width(&operand) < most => *line += &format!(" {operand}"),
            Some(_) => lines.push(format!("{indent}    {operand}")),
            None => lines.push(format!("{indent}{operand}")),
        }
    }
    let fits = |line: &String| width(line) <= most;
    (lines.len() > 1 && lines.iter().all(fits)).then(|| lines.join("\n"))
}
