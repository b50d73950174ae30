//! Comparison of a flight on the microcontroller with that on the host, and the table of what it cost.

use std::fmt::Write as _;
use std::ops::Range;

/// What a firmware program says of its steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Costs {
    /// Instructions of a step, the mean of all.
    mean: u64,
    /// Instructions of the step with the most.
    worst: u64,
    /// Bytes of stack below the caller's frame, of the step with the most.
    stack: u64,
    /// Bytes of the flight: prepared model, state, noise.
    size: u64,
}

/// A line of the table.
pub(super) struct Row<'a> {
    pub(super) build: &'a str,
    pub(super) flight: &'a str,
    pub(super) costs: Costs,
    /// Bytes of the whole program.
    pub(super) flash: u64,
}

const HEAD: &str =
    "| build | flight | instructions a step, mean | worst | stack | model, state, noise | flash, KiB |
|---|---|---|---|---|---|---|
";

/// The table as docs/embedded.md has it; memory in bytes, flash in whole KiB, for the path of the checkout moves it by some
/// bytes: it is part of the names by which the linker orders functions.
pub(super) fn table(rows: &[Row<'_>]) -> String {
    let mut table = HEAD.to_owned();
    for row in rows {
        let Costs {
            mean,
            worst,
            stack,
            size,
        } = row.costs;
        let (build, flight, flash) = (row.build, row.flight, row.flash.div_ceil(1024));
        let _ = writeln!(
            table,
            "| {build} | `{flight}` | {mean} | {worst} | {stack} | {size} | {flash} |"
        );
    }
    table
}

/// Where a page has the table.
pub(super) fn documented(page: &str) -> Option<Range<usize>> {
    let start = page.find(HEAD)?;
    let lines = page[start..].split_inclusive('\n');
    let length: usize = lines
        .take_while(|line| line.starts_with('|'))
        .map(str::len)
        .sum();
    Some(start..start + length)
}

/// The costs that a firmware program has printed behind its states.
///
/// # Errors
///
/// Step and component of the first bits that differ, or what is missing.
pub(super) fn compare(host: &str, firmware: &str) -> Result<Costs, String> {
    let mut printed = firmware.lines();
    let names: Vec<&str> = host.lines().next().unwrap_or_default().split(' ').collect();
    for (step, expected) in host.lines().enumerate() {
        let Some(line) = printed.next() else {
            return Err(format!("step {step}: missing"));
        };
        if line != expected {
            return Err(difference(step, &names, expected, line));
        }
    }
    let mut cost = |name| {
        let line = printed.next().and_then(|line| line.strip_prefix(name));
        let number = line.and_then(|line| line.trim_start().parse().ok());
        number.ok_or_else(|| format!("printed no {name}"))
    };
    Ok(Costs {
        mean: cost("mean")?,
        worst: cost("worst")?,
        stack: cost("stack")?,
        size: cost("size")?,
    })
}

fn difference(step: usize, names: &[&str], expected: &str, line: &str) -> String {
    let mut words = names.iter().zip(expected.split(' ').zip(line.split(' ')));
    match words.find(|(_, (host, firmware))| host != firmware) {
        Some((name, (host, firmware))) => {
            format!("step {step}: {name} is {firmware}, on the host {host}")
        }
        None => format!("step {step}: `{line}`, on the host `{expected}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOST: &str = "dcom velocity alpha\n1 40be16 3f9ca0\n2 40be17 3f9ca1\n";
    const COSTS: &str = "mean 2003\nworst 2004\nstack 1184\nsize 1440\n";

    #[test]
    fn equal_bits_give_the_costs() {
        let costs = compare(HOST, &format!("{HOST}{COSTS}"));
        let expected = Costs {
            mean: 2003,
            worst: 2004,
            stack: 1184,
            size: 1440,
        };
        assert_eq!(costs, Ok(expected));
    }

    #[test]
    fn a_flipped_bit_is_named() {
        let flown = format!("{}{COSTS}", HOST.replace("3f9ca1", "3f9ca0"));
        let expected = "step 2: alpha is 3f9ca0, on the host 3f9ca1";
        assert_eq!(compare(HOST, &flown), Err(expected.into()));
    }

    #[test]
    fn what_is_missing_is_an_error() {
        let short = HOST.trim_end_matches("2 40be17 3f9ca1\n");
        assert_eq!(compare(HOST, short), Err("step 2: missing".into()));
        assert_eq!(compare(HOST, HOST), Err("printed no mean".into()));
        let cut = HOST.replace(" 3f9ca1", "");
        let problem = compare(HOST, &cut).expect_err("a difference");
        assert!(problem.starts_with("step 2"), "{problem}");
    }

    #[test]
    fn the_table_is_found_again() {
        let costs = compare(HOST, &format!("{HOST}{COSTS}")).expect("costs");
        let row = Row {
            build: "hardware f64",
            flight: "dcom",
            costs,
            flash: 23460,
        };
        let table = table(&[row]);
        assert!(table.ends_with("| hardware f64 | `dcom` | 2003 | 2004 | 1184 | 1440 | 23 |\n"));
        let page = format!("# Page\n\n{table}\nMore | text.\n");
        assert_eq!(documented(&page).map(|place| &page[place]), Some(&*table));
        assert_eq!(documented("# Page\n"), None);
    }
}
