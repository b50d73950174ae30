//! `ahv reproduce`: section 5 of the paper, computed again, as a page.

mod differences;
mod figures;
mod page;
mod random;
mod roots;
mod sentences;
mod trims;

use std::path::PathBuf;

use ahv_cli::failure::{Failure, complain, print};
use ahv_cli::output;
use ahv_cli::progress::{Progress, Work};
use ahv_plot::PlotError;
use clap::Args;
use serde::Serialize;

use crate::reproduce::differences::{Difference, differences};
use crate::reproduce::{Random, Size, vehicle};
use page::Page;
use sentences::{Finding, Sentence};

/// The page.
const PAGE: &str = "index.html";
/// All numbers behind it.
const NUMBERS: &str = "results.json";

/// Computes section 5 of the paper again: tables 1 to 3 and figures 2 to 6, beside what is printed.
///
/// Writes index.html, which needs nothing else to be read, and its parts as SVG, CSV and JSON.
/// Equal seeds give equal files on any number of threads.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Folder for the page and its parts
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Seed of the noise
    #[arg(long, default_value_t = Size::PAPER.seed)]
    seed: u64,
}

/// What agrees with the paper, and what does not.
#[derive(Default)]
struct Findings {
    agrees: Vec<Sentence>,
    cannot: Vec<Sentence>,
}

impl Findings {
    /// Adds a finding to the list it belongs to.
    fn push(&mut self, finding: Finding) {
        let list = if finding.agrees {
            &mut self.agrees
        } else {
            &mut self.cannot
        };
        list.push(finding.sentence);
    }
}

/// All numbers behind the page.
#[derive(Serialize)]
struct Numbers<'a> {
    random: &'a Random,
    vehicles: &'a [vehicle::Vehicle],
    differences: &'a [Difference],
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] if a file cannot be written, [`Failure::Numeric`] if a computation fails. Files that are there stay
/// whole: each is replaced when it is complete, the page last.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    output::folder(&arguments.out)?;
    let size = Size {
        seed: arguments.seed,
        ..Size::PAPER
    };
    let progress = Progress::start(Work {
        command: "reproduce",
        unit: "steps",
        total: Some(size.work()),
    });
    let random = crate::reproduce::random(&size, |done| progress.reach(done))
        .map_err(|error| Failure::Numeric(error.to_string()))?;
    drop(progress);
    let vehicles = vehicle::vehicles();
    let differences = differences();
    let page = page(&random, &vehicles, &differences)?;
    let numbers = Numbers {
        random: &random,
        vehicles: &vehicles,
        differences: &differences,
    };
    write(arguments, &page, &numbers)
}

fn page(
    random: &Random,
    vehicles: &[vehicle::Vehicle],
    differences: &[Difference],
) -> Result<Page, Failure> {
    let mut findings = Findings::default();
    let sections = vec![
        random::table1(random, &mut findings)?,
        random::snapshot(&random.snapshot, &mut findings)?,
        random::forced(&random.forced, &mut findings)?,
        random::reductions(random, &mut findings)?,
        trims::section(vehicles, &mut findings),
        roots::section(vehicles, &mut findings)?,
        differences::section(differences, &mut findings),
    ];
    Ok(Page {
        subject: sentences::subject(&random.size),
        agrees: findings.agrees,
        cannot: findings.cannot,
        sections,
    })
}

fn write(arguments: &Arguments, page: &Page, numbers: &Numbers<'_>) -> Result<(), Failure> {
    let html = page.html()?;
    let place = |file: &str| arguments.out.join(file);
    // Numbers first, pictures and the page that holds them last.
    for table in page.sections.iter().flat_map(|section| &section.tables) {
        output::write(&place(table.file), table.csv()?)?;
    }
    output::write(&place(NUMBERS), output::json(numbers)?)?;
    for picture in page.sections.iter().flat_map(|section| &section.pictures) {
        output::write(&place(picture.file), &picture.svg)?;
    }
    output::write(&place(PAGE), html)?;
    let list = |title: &str, items: &[Sentence]| {
        let items: Vec<String> = items.iter().map(|item| format!("  {item}\n")).collect();
        format!("{title}:\n{}", items.concat())
    };
    print(&format!(
        "{}{}written to {}",
        list("agrees", &page.agrees),
        list("does not, or cannot", &page.cannot),
        place(PAGE).display()
    ))
}

/// A picture for the page. One that cannot be drawn is a warning, and a text that says why stands in its place.
fn drawn(file: &str, svg: Result<String, PlotError>) -> Result<String, Failure> {
    Ok(svg.unwrap_or_else(|why| {
        complain(&format!("warning: {file} is not drawn: {why}"));
        let why = why.to_string();
        let why = why
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;");
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800\" height=\"40\">\
             <text x=\"8\" y=\"26\">not drawn: {why}</text></svg>"
        )
    }))
}

#[cfg(test)]
mod tests {
    use ahv_cli::output;

    use super::{Numbers, page};
    use crate::reproduce::differences::differences;
    use crate::reproduce::{Size, random, vehicle};

    /// The page of a small computation.
    #[test]
    fn the_page_needs_nothing_else() {
        let size = Size {
            repeats: 3,
            most_repeats: 6,
            runs: 30,
            snapshot_runs: 60,
            forced_runs: 3,
            steps: 60,
            dt: 0.05,
            seed: 5,
        };
        let random = random(&size, |_| ()).expect("computed");
        let vehicles = vehicle::vehicles();
        let differences = differences();
        let page = page(&random, &vehicles, &differences).expect("a page");
        let html = page.html().expect("text");
        for fetch in [
            "src=",
            "<script",
            "<link",
            "@import",
            "url(",
            "href=\"http",
            "href=\"//",
        ] {
            assert!(!html.contains(fetch), "{fetch}");
        }
        for part in [
            "Summary",
            "Table 1",
            "Fig. 2",
            "Fig. 5",
            "Three reductions",
            "Table 2",
            "Table 3",
            "Fig. 6",
            "As printed and exact",
        ] {
            assert!(html.contains(part), "{part}");
        }
        assert!(!html.contains("NaN") && !html.contains(">inf"));
        // 0.016 and 11.4635 are printed; the count of SDCOM's poles is ours.
        for number in [">0.01600<", ">11.46<", "SDCOM of (27) has 8 states"] {
            assert!(html.contains(number), "{number}");
        }
        assert!(!page.agrees.is_empty() && !page.cannot.is_empty());
        for table in page.sections.iter().flat_map(|section| &section.tables) {
            let csv = table.csv().expect("text");
            let mut reader = csv::Reader::from_reader(csv.as_slice());
            assert_eq!(
                reader.records().filter_map(Result::ok).count(),
                table.rows.len(),
                "{}",
                table.file
            );
        }
        let numbers = Numbers {
            random: &random,
            vehicles: &vehicles,
            differences: &differences,
        };
        assert!(
            !output::json(&numbers)
                .expect("JSON")
                .contains("null,\n          null")
        );
    }
}
