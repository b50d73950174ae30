//! The commands of the guide's pages, run as a reader runs them: one page after the other, in one shell, over one build.
//!
//! A block of `text` after a block of `sh` is what the commands print: each of its lines must be in their output, but `...`, which
//! stands for lines that are left out.

use std::fs;
use std::path::Path;

use crate::shell;

/// Lists the pages in their order.
const SUMMARY: &str = "docs/SUMMARY.md";
/// How the summary links to a page whose commands are run.
const PAGES: &str = "(guide/";
/// Where the repository of the guide is made, beside a link to this one.
const PLACE: &str = "tests/own-vehicle/made/guide";
/// The folder of this repository, as the page calls it.
const AHV: &str = "ahv";
/// What a reader builds for speed is built here as tests are, which is sooner done.
const PRELUDE: &str = r#"set -eu
cargo() {
    local word words=()
    for word in "$@"; do
        [ "$word" = --release ] || words+=("$word")
    done
    command cargo "${words[@]}"
}
"#;
const LEFT_OUT: &str = "...";

/// Commands, and what they print.
#[derive(Debug, Default, PartialEq, Eq)]
struct Block<'a> {
    /// The line of the page on which they start.
    line: usize,
    commands: Vec<&'a str>,
    printed: Vec<&'a str>,
}

/// Runs the pages.
pub(crate) fn run() -> Result<(), String> {
    let problem = |error: std::io::Error| format!("error: {PLACE}: {error}");
    let read = |page: &str| {
        let text = fs::read_to_string(shell::root().join(page));
        text.map_err(|error| format!("error: cannot read {page}: {error}"))
    };
    let names = pages(&read(SUMMARY)?);
    let texts = names.iter().map(|page| read(page));
    let texts = texts.collect::<Result<Vec<String>, String>>()?;
    let blocks: Vec<(&String, Block<'_>)> = (names.iter().zip(&texts))
        .flat_map(|(page, text)| blocks(text).into_iter().map(move |block| (page, block)))
        .collect();
    let place = shell::root().join(PLACE);
    if place.exists() {
        fs::remove_dir_all(&place).map_err(problem)?;
    }
    fs::create_dir_all(&place).map_err(problem)?;
    link(shell::root(), &place.join(AHV)).map_err(problem)?;

    let mut script = PRELUDE.to_owned();
    for (number, (_, block)) in blocks.iter().enumerate() {
        let commands = block.commands.join("\n");
        let out = place.join(number.to_string());
        script += &format!("{{\n{commands}\n}} > '{}'\n", out.display());
    }
    let mut bash = shell::program("bash");
    bash.args(["-c", &script]).current_dir(&place);
    // Settings of the user's own git would change what it prints.
    bash.envs([("GIT_CONFIG_GLOBAL", "/dev/null"), ("GIT_PAGER", "cat")]);
    shell::run(bash.env("CARGO_TARGET_DIR", shell::target()))?;

    for (number, (page, block)) in blocks.iter().enumerate() {
        let output = fs::read_to_string(place.join(number.to_string())).map_err(problem)?;
        if let Some(missing) = missing(block, &output) {
            let line = block.line;
            return Err(format!(
                "error: the commands of {page}:{line} do not print\n{missing}\nbut\n{output}"
            ));
        }
    }
    println!("{} pages, {} blocks of commands", names.len(), blocks.len());
    Ok(())
}

/// The pages of the guide that a summary lists.
fn pages(summary: &str) -> Vec<String> {
    let links = summary.lines().filter_map(|line| line.split_once(PAGES));
    let paths = links.filter_map(|(_, rest)| rest.split_once(')'));
    paths
        .map(|(name, _)| format!("docs/guide/{name}"))
        .collect()
}

/// The blocks of commands of a page.
fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut blocks: Vec<Block<'_>> = Vec::new();
    let mut fence = None;
    for (number, line) in (1..).zip(page.lines()) {
        match (fence, line.strip_prefix("```")) {
            (Some(_), Some(_)) => fence = None,
            (None, Some(language)) => {
                fence = Some(language);
                if language == "sh" {
                    let line = number + 1;
                    blocks.push(Block {
                        line,
                        ..Block::default()
                    });
                }
            }
            (Some("sh"), None) => blocks
                .last_mut()
                .into_iter()
                .for_each(|it| it.commands.push(line)),
            (Some("text"), None) => blocks
                .last_mut()
                .into_iter()
                .for_each(|it| it.printed.push(line)),
            _ => {}
        }
    }
    blocks
}

/// The first line that the commands do not print; white space counts only as such.
fn missing<'a>(block: &Block<'a>, output: &str) -> Option<&'a str> {
    let words = |line: &str| {
        line.split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let found: Vec<_> = output.lines().map(words).collect();
    let mut lines = block.printed.iter().filter(|line| line.trim() != LEFT_OUT);
    lines.find(|line| !found.contains(&words(line))).copied()
}

#[cfg(unix)]
fn link(to: &Path, at: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(to, at)
}

#[cfg(windows)]
fn link(to: &Path, at: &Path) -> std::io::Result<()> {
    std::os::windows::fs::symlink_dir(to, at)
}

#[cfg(test)]
mod tests {
    use super::{Block, blocks, missing, pages};

    const PAGE: &str =
        "a\n```sh\nls\n```\n\n```text\nx  1\n...\n```\n```toml\ny\n```\n```sh\npwd\n```\n";

    #[test]
    fn what_is_printed_belongs_to_the_commands_before() {
        let first = Block {
            line: 3,
            commands: vec!["ls"],
            printed: vec!["x  1", "..."],
        };
        let second = Block {
            line: 14,
            commands: vec!["pwd"],
            printed: vec![],
        };
        assert_eq!(blocks(PAGE), [first, second]);
    }

    #[test]
    fn the_summary_orders_the_pages() {
        let summary = "# Guide\n\n- [B](guide/b.md)\n- [A](guide/a.md)\n- [C](c.md)\n";
        assert_eq!(pages(summary), ["docs/guide/b.md", "docs/guide/a.md"]);
    }

    #[test]
    fn a_line_that_is_not_printed_is_named() {
        let first = &blocks(PAGE)[0];
        assert_eq!(missing(first, "w\nx 1\n"), None);
        assert_eq!(missing(first, "x 2\n"), Some("x  1"));
    }
}
