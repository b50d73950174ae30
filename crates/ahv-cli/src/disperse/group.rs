//! Parameters and groups of them, as a person types them.

use ahv_analysis::disperse::Group;

use crate::failure::Failure;
use crate::names;

/// Indices of the parameters called `texts`, or whose names begin with one of them and an underscore.
///
/// # Errors
///
/// [`Failure::Request`] for a name that is neither, with the one that was perhaps meant; `option` is where it was given.
pub(super) fn parameters(
    option: &str,
    texts: &[String],
    names: &[&str],
) -> Result<Vec<usize>, Failure> {
    let mut found = Vec::new();
    for text in texts {
        let name = text.trim().to_lowercase();
        let begins = |own: &str| {
            own.strip_prefix(&name)
                .is_some_and(|rest| rest.starts_with('_'))
        };
        let indices: Vec<usize> = match names.iter().position(|own| *own == name) {
            Some(index) => vec![index],
            None => (0..)
                .zip(names)
                .filter_map(|(index, own)| begins(own).then_some(index))
                .collect(),
        };
        if indices.is_empty() {
            let problem = names::unknown("parameter", &name, names);
            return Err(Failure::Request(format!("{option}: {problem}")));
        }
        found.extend(indices);
    }
    Ok(found)
}

/// Groups of the form `NAME=PARAMETERS:CORRELATION`, the correlation 1 if it is not given.
///
/// # Errors
///
/// [`Failure::Request`] that says what is wrong.
pub(super) fn parse(texts: &[String], names: &[&str]) -> Result<Vec<Group>, Failure> {
    texts.iter().map(|text| parse_one(text, names)).collect()
}

fn parse_one(text: &str, names: &[&str]) -> Result<Group, Failure> {
    let problem = |why: &str| Failure::Request(format!("--group: `{text}` {why}"));
    let (name, rest) = text
        .split_once('=')
        .ok_or_else(|| problem("is not of the form NAME=PARAMETERS:CORRELATION"))?;
    let (list, correlation) = match rest.split_once(':') {
        Some((list, correlation)) => (
            list,
            correlation
                .trim()
                .parse()
                .map_err(|_| problem("ends in a correlation that is no number"))?,
        ),
        None => (rest, 1.0),
    };
    let list: Vec<String> = list.split(',').map(str::to_owned).collect();
    Ok(Group {
        name: name.trim().to_owned(),
        parameters: parameters("--group", &list, names)?,
        correlation,
    })
}
