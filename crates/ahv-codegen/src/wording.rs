//! How files are worded, in whichever language: what a function computes, texts of users, lines of comments.

use crate::ir::{self, described};

/// What a function computes, from which equation, in which unit.
pub(crate) fn summary(function: &ir::Function) -> Vec<String> {
    let unit = function.outputs.iter().find_map(|o| o.unit.as_deref());
    let unit = match unit {
        Some(unit) if function.outputs.len() == 1 => format!(" Unit: {unit}."),
        _ => String::new(),
    };
    let equation = match function.equation.as_str() {
        "" => String::new(),
        equation => format!(", eq. {equation}"),
    };
    wrapped(&format!("{}{equation}.{unit}", function.doc))
}

/// A text of a user in one line: what cannot be seen, or turns the direction of what follows, as its code.
pub(crate) fn visible(text: &str) -> String {
    let hidden = |c: char| {
        c.is_control()
            || matches!(c, '\u{ad}' | '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}')
            || matches!(c, '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
    };
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\t' => line.push(' '),
            c if hidden(c) => line.extend(c.escape_unicode()),
            c => line.push(c),
        }
    }
    line
}

/// A text in lines of a comment's width.
pub(crate) fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 106;
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].chars().count() + 1 + word.chars().count() > WIDTH
        {
            lines.push(word.to_owned());
        } else {
            if !lines[last].is_empty() {
                lines[last].push(' ');
            }
            lines[last] += word;
        }
    }
    lines
}

/// What a parameter is and its unit, as a sentence.
pub(crate) fn parameter_doc(document: &ir::Document, name: &str) -> String {
    let parameter = document.parameters.iter().find(|p| p.name == name);
    parameter.map_or_else(String::new, |p| described(&p.doc, &p.unit))
}
