//! The commands of the tutorial, run as a reader runs them, one block after the other in one shell.
//!
//! A block of `text` after a block of `sh` is what the commands print: each of its lines must be in their output, but `...`, which
//! stands for lines that are left out.

use std::fs;
use std::path::Path;

use crate::shell;

const PAGE: &str = "docs/tutorial.md";
/// Where the repository of the tutorial is made, beside a link to this one.
const PLACE: &str = "tests/own-vehicle/made/tutorial";
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

/// Runs the page.
pub(crate) fn run() -> Result<(), String> {
    let problem = |error: std::io::Error| format!("error: {PLACE}: {error}");
    let page = fs::read_to_string(shell::root().join(PAGE))
        .map_err(|error| format!("error: cannot read {PAGE}: {error}"))?;
    let blocks = blocks(&page);
    let place = shell::root().join(PLACE);
    if place.exists() {
        fs::remove_dir_all(&place).map_err(problem)?;
    }
    fs::create_dir_all(&place).map_err(problem)?;
    link(shell::root(), &place.join(AHV)).map_err(problem)?;

    let mut script = PRELUDE.to_owned();
    for (number, block) in blocks.iter().enumerate() {
        let commands = block.commands.join("\n");
        let out = place.join(number.to_string());
        script += &format!("{{\n{commands}\n}} > '{}'\n", out.display());
    }
    let mut bash = shell::program("bash");
    bash.args(["-c", &script]).current_dir(&place);
    // Settings of the user's own git would change what it prints.
    bash.envs([("GIT_CONFIG_GLOBAL", "/dev/null"), ("GIT_PAGER", "cat")]);
    shell::run(bash.env("CARGO_TARGET_DIR", shell::target()))?;

    for (number, block) in blocks.iter().enumerate() {
        let output = fs::read_to_string(place.join(number.to_string())).map_err(problem)?;
        if let Some(missing) = missing(block, &output) {
            let line = block.line;
            return Err(format!(
                "error: the commands of {PAGE}:{line} do not print\n{missing}\nbut\n{output}"
            ));
        }
    }
    println!("{PAGE}: {} blocks of commands", blocks.len());
    Ok(())
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
    use super::{Block, blocks, missing};

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
    fn a_line_that_is_not_printed_is_named() {
        let first = &blocks(PAGE)[0];
        assert_eq!(missing(first, "w\nx 1\n"), None);
        assert_eq!(missing(first, "x 2\n"), Some("x  1"));
    }
}
