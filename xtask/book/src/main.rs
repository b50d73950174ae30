//! `cargo xtask book`: the project's documentation as pages that a browser shows from disk, without a network.
//!
//! A program of its own: who generates or tests does not build what reads Markdown and formulas.
#![forbid(unsafe_code)]

mod math;
mod page;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;

use math::Formulas;
use page::{Page, read};

/// The folder of the guide and the reference, whose summary orders them as mdBook has it.
const DOCS: &str = "docs";
const SUMMARY: &str = "SUMMARY.md";
/// The folder of the generated documentation.
const GENERATED: &str = "generated/docs";
/// Pages of the project's root.
const ROOT_PAGES: [&str; 2] = ["README.md", "CHANGELOG.md"];
const LAYOUT: &str = include_str!("layout.html");
const STYLE: &str = include_str!("style.css");

/// Pages under one heading of the contents.
struct Part {
    title: String,
    pages: Vec<Page>,
}

/// Make pages for a browser of the project's documentation
#[derive(Parser)]
struct Args {
    /// Folder of the project
    root: PathBuf,
    /// Folder for the pages, which is emptied
    out: PathBuf,
}

fn main() -> ExitCode {
    let Args { root, out } = Args::parse();
    match build(&root, &out) {
        Ok(count) => {
            println!("{count} pages: {}", out.join("index.html").display());
            ExitCode::SUCCESS
        }
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}

/// Turns the Markdown under `root` into pages under `out`; the number of pages.
fn build(root: &Path, out: &Path) -> Result<usize, String> {
    let formulas = Formulas::new()?;
    let parts = parts(root, &formulas)?;
    let pages: Vec<&Page> = parts.iter().flat_map(|part| &part.pages).collect();
    check_links(root, &pages)?;
    if out.exists() {
        fs::remove_dir_all(out).map_err(problem("empty", out))?;
    }
    for (position, page) in pages.iter().enumerate() {
        let before = position.checked_sub(1).map(|before| pages[before]);
        let after = pages.get(position + 1).copied();
        write(
            &out.join(&page.target),
            &laid_out(&parts, page, before, after),
        )?;
    }
    let files: BTreeSet<&PathBuf> = pages.iter().flat_map(|page| &page.files).collect();
    for file in files {
        let to = out.join(file);
        make_parent(&to)?;
        let from = root.join(file);
        fs::copy(&from, &to).map_err(problem("copy", &from))?;
    }
    Ok(pages.len())
}

/// The pages of the book, read and converted.
fn parts(root: &Path, formulas: &Formulas) -> Result<Vec<Part>, String> {
    let project = ROOT_PAGES.iter().map(PathBuf::from);
    let project = project.filter(|page| root.join(page).exists()).collect();
    let mut sources = vec![("Project".to_owned(), project)];
    sources.extend(summarized(root)?);
    let generated = markdown(root, GENERATED)?;
    if !generated.is_empty() {
        sources.push(("Models".to_owned(), generated));
    }
    let known: BTreeSet<PathBuf> = sources
        .iter()
        .flat_map(|(_, pages): &(String, Vec<PathBuf>)| pages.iter().cloned())
        .collect();
    let mut parts = Vec::new();
    for (title, paths) in sources {
        let pages: Result<Vec<Page>, String> = paths
            .iter()
            .map(|path| read(root, path, &known, formulas))
            .collect();
        parts.push(Part {
            title,
            pages: pages?,
        });
    }
    Ok(parts)
}

/// The parts that the summary lists: `# Title`, then `- [Page](path)`. Every page of the folder must be there.
fn summarized(root: &Path) -> Result<Vec<(String, Vec<PathBuf>)>, String> {
    let place = root.join(DOCS).join(SUMMARY);
    if !place.exists() {
        return Ok(Vec::new());
    }
    let summary = fs::read_to_string(&place).map_err(problem("read", &place))?;
    let mut parts: Vec<(String, Vec<PathBuf>)> = Vec::new();
    for line in summary.lines() {
        if let Some(title) = line.strip_prefix("# ") {
            parts.push((title.to_owned(), Vec::new()));
        } else if let Some((_, link)) = line.split_once("](") {
            let path = link.trim_end_matches(')');
            let part = parts
                .last_mut()
                .ok_or("error: docs/SUMMARY.md begins without a heading")?;
            part.1.push(Path::new(DOCS).join(path));
        }
    }
    let mut listed = parts.iter().flat_map(|(_, pages)| pages);
    for page in markdown(root, DOCS)? {
        if !page.ends_with(SUMMARY) && !listed.clone().any(|it| *it == page) {
            return Err(format!(
                "error: docs/SUMMARY.md does not list {}",
                page.display()
            ));
        }
    }
    if let Some(missing) = listed.find(|page| !root.join(page).is_file()) {
        return Err(format!(
            "error: docs/SUMMARY.md lists {}, which is not a file",
            missing.display()
        ));
    }
    parts.retain(|(_, pages)| !pages.is_empty());
    Ok(parts)
}

/// The Markdown files of a folder: its README, then the others in the order in which that names them.
fn markdown(root: &Path, folder: &str) -> Result<Vec<PathBuf>, String> {
    let place = root.join(folder);
    let Ok(entries) = fs::read_dir(&place) else {
        return Ok(Vec::new());
    };
    let mut names = Vec::new();
    for entry in entries {
        let name = entry.map_err(problem("read", &place))?.file_name();
        if let Some(name) = name.to_str().filter(|name| name.ends_with(".md")) {
            names.push(name.to_owned());
        }
    }
    let index = fs::read_to_string(place.join("README.md"))
        .or_else(|_| fs::read_to_string(root.join("README.md")))
        .unwrap_or_default();
    names.sort();
    names.sort_by_key(|name| {
        let place = index
            .find(&format!("({name}"))
            .or_else(|| index.find(&format!("/{name}")));
        (name != "README.md", place.unwrap_or(usize::MAX))
    });
    Ok(names
        .into_iter()
        .map(|name| Path::new(folder).join(name))
        .collect())
}

/// Every link to a place in the project leads somewhere.
fn check_links(root: &Path, pages: &[&Page]) -> Result<(), String> {
    for page in pages {
        for file in &page.files {
            if !root.join(file).is_file() {
                return Err(format!(
                    "error: {} links to {}, which is not a file",
                    page.source.display(),
                    file.display()
                ));
            }
        }
        for (target, fragment) in &page.anchors {
            let found = pages.iter().find(|other| other.source == *target);
            if !found.is_some_and(|other| other.headings.contains(fragment)) {
                return Err(format!(
                    "error: {} links to #{fragment} of {}, which has no such heading",
                    page.source.display(),
                    target.display()
                ));
            }
        }
    }
    Ok(())
}

/// A page with contents beside it and its neighbours below.
fn laid_out(parts: &[Part], page: &Page, before: Option<&Page>, after: Option<&Page>) -> String {
    let link = |to: &Page, class: &str, text: &str| {
        let href = page::relative(&page.target, &to.target);
        format!("<a{class} href=\"{href}\">{text}</a>")
    };
    let mut contents = String::new();
    for part in parts {
        contents += &format!("<h2>{}</h2>\n<ul>\n", part.title);
        for other in &part.pages {
            let here = if other.source == page.source {
                " class=\"here\""
            } else {
                ""
            };
            contents += &format!("<li>{}</li>\n", link(other, here, short(&other.title)));
        }
        contents += "</ul>\n";
    }
    let before = before.map(|to| link(to, " class=\"before\"", &format!("← {}", to.title)));
    let after = after.map(|to| link(to, " class=\"after\"", &format!("{} →", to.title)));
    LAYOUT
        .replace("{title}", &page.title)
        .replace("{style}", STYLE)
        .replace("{contents}", &contents)
        .replace(
            "{neighbours}",
            &(before.unwrap_or_default() + &after.unwrap_or_default()),
        )
        // Last: a page may hold anything.
        .replace("{page}", &page.html)
}

/// A title for the contents: what stands before its colon.
fn short(title: &str) -> &str {
    title.split_once(": ").map_or(title, |(name, _)| name)
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    make_parent(path)?;
    fs::write(path, text).map_err(problem("write", path))
}

fn make_parent(path: &Path) -> Result<(), String> {
    let parent = path.parent().unwrap_or(path);
    fs::create_dir_all(parent).map_err(problem("make", parent))
}

fn problem(act: &str, path: &Path) -> impl FnOnce(std::io::Error) -> String {
    move |error| format!("error: cannot {act} {}: {error}", path.display())
}

#[cfg(test)]
mod tests;
