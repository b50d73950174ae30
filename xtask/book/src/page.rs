//! One page of the book: Markdown in, HTML out.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use pulldown_cmark::{
    CodeBlockKind, CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html,
};

use super::math::{Formulas, escaped};

/// A page.
pub(super) struct Page {
    /// Path of the Markdown, relative to the project.
    pub(super) source: PathBuf,
    /// Path of the HTML, relative to the book.
    pub(super) target: PathBuf,
    /// First heading, as HTML text.
    pub(super) title: String,
    pub(super) html: String,
    /// Fragments by which the page's headings can be linked to.
    pub(super) headings: BTreeSet<String>,
    /// Files of the project that the page shows or links to, besides pages.
    pub(super) files: Vec<PathBuf>,
    /// Pages and fragments that it links to.
    pub(super) anchors: Vec<(PathBuf, String)>,
}

/// Reads a page; links to the pages of `known` become links between their HTML.
pub(super) fn read(
    root: &Path,
    source: &Path,
    known: &BTreeSet<PathBuf>,
    formulas: &Formulas,
) -> Result<Page, String> {
    let text = fs::read_to_string(root.join(source))
        .map_err(|error| format!("error: cannot read {}: {error}", source.display()))?;
    let mut page = Page {
        source: source.to_owned(),
        target: target(source),
        title: String::new(),
        html: String::new(),
        headings: BTreeSet::new(),
        files: Vec::new(),
        anchors: Vec::new(),
    };
    let options = Options::ENABLE_TABLES
        | Options::ENABLE_FOOTNOTES
        | Options::ENABLE_MATH
        | Options::ENABLE_STRIKETHROUGH;
    let events = converted(&text, options, formulas)
        .map_err(|problem| format!("error: {}: {problem}", source.display()))?;
    let events = headed(events, &mut page);
    let events: Vec<Event<'_>> = events
        .into_iter()
        .map(|event| linked(event, &mut page, known))
        .collect();
    html::push_html(&mut page.html, events.into_iter());
    Ok(page)
}

/// Where the HTML of a page stands.
fn target(source: &Path) -> PathBuf {
    if source.file_name().is_some_and(|name| name == "README.md") {
        source.with_file_name("index.html")
    } else {
        source.with_extension("html")
    }
}

/// The events of a text with its formulas converted, and its tables in boxes that scroll.
fn converted<'a>(
    text: &'a str,
    options: Options,
    formulas: &Formulas,
) -> Result<Vec<Event<'a>>, String> {
    let mut events = Vec::new();
    let mut formula: Option<String> = None;
    for event in Parser::new_ext(text, options) {
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(ref info))) if &**info == "math" => {
                formula = Some(String::new());
            }
            Event::Text(ref line) if formula.is_some() => {
                if let Some(formula) = &mut formula {
                    *formula += line;
                }
            }
            Event::End(TagEnd::CodeBlock) if formula.is_some() => {
                let latex = formula.take().unwrap_or_default();
                events.push(Event::Html(formulas.display(&latex)?.into()));
            }
            Event::DisplayMath(latex) => {
                events.push(Event::InlineHtml(formulas.display(&latex)?.into()))
            }
            Event::InlineMath(latex) => {
                events.push(Event::InlineHtml(formulas.inline(&latex)?.into()))
            }
            Event::Start(Tag::Table(_)) => {
                events.push(Event::Html("<div class=\"table\">\n".into()));
                events.push(event);
            }
            Event::End(TagEnd::Table) => {
                events.push(event);
                events.push(Event::Html("</div>\n".into()));
            }
            // Nothing in a page is markup of its own: what looks like it is text, and comments are not shown.
            Event::Html(raw) | Event::InlineHtml(raw) => {
                if !is_comment(&raw) {
                    events.push(Event::Text(raw));
                }
            }
            other => events.push(other),
        }
    }
    Ok(events)
}

fn is_comment(html: &str) -> bool {
    html.starts_with("<!--") && html.trim_end().ends_with("-->")
}

/// Gives every heading a fragment, and the page its title.
fn headed<'a>(events: Vec<Event<'a>>, page: &mut Page) -> Vec<Event<'a>> {
    let mut done = Vec::with_capacity(events.len());
    let mut events = events.into_iter();
    while let Some(event) = events.next() {
        let Event::Start(Tag::Heading {
            level,
            classes,
            attrs,
            ..
        }) = event
        else {
            done.push(event);
            continue;
        };
        let inside: Vec<Event<'a>> = events
            .by_ref()
            .take_while(|event| !matches!(event, Event::End(TagEnd::Heading(_))))
            .collect();
        let text = plain(&inside);
        if level == HeadingLevel::H1 && page.title.is_empty() {
            page.title = escaped(&text);
        }
        let id = fragment(&text, &page.headings);
        page.headings.insert(id.clone());
        done.push(Event::Start(Tag::Heading {
            level,
            id: Some(CowStr::from(id)),
            classes,
            attrs,
        }));
        done.extend(inside);
        done.push(Event::End(TagEnd::Heading(level)));
    }
    done
}

fn plain(events: &[Event<'_>]) -> String {
    let text = |event: &Event<'_>| match event {
        Event::Text(text) | Event::Code(text) => text.to_string(),
        _ => String::new(),
    };
    events.iter().map(text).collect()
}

/// The fragment of a heading, as GitHub makes it.
fn fragment(text: &str, taken: &BTreeSet<String>) -> String {
    let kept = text.to_lowercase();
    let kept: String = kept
        .chars()
        .filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect();
    let mut unique = kept.clone();
    let mut count = 0;
    while taken.contains(&unique) {
        count += 1;
        unique = format!("{kept}-{count}");
    }
    unique
}

/// An event with its link led to where it leads in the book.
fn linked<'a>(event: Event<'a>, page: &mut Page, known: &BTreeSet<PathBuf>) -> Event<'a> {
    match event {
        Event::Start(Tag::Link {
            link_type,
            dest_url,
            title,
            id,
        }) => {
            let dest_url = led(&dest_url, page, known).map_or(dest_url, CowStr::from);
            Event::Start(Tag::Link {
                link_type,
                dest_url,
                title,
                id,
            })
        }
        Event::Start(Tag::Image {
            link_type,
            dest_url,
            title,
            id,
        }) => {
            let dest_url = led(&dest_url, page, known).map_or(dest_url, CowStr::from);
            Event::Start(Tag::Image {
                link_type,
                dest_url,
                title,
                id,
            })
        }
        other => other,
    }
}

/// Where a link leads in the book, and a note of what the book must hold for it; `None` for one out of the project.
fn led(link: &str, page: &mut Page, known: &BTreeSet<PathBuf>) -> Option<String> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (path, fragment) = link
        .split_once('#')
        .map_or((link, None), |(path, f)| (path, Some(f)));
    let aim = if path.is_empty() {
        page.source.clone()
    } else {
        joined(&page.source, path)
    };
    if !known.contains(&aim) {
        page.files.push(aim);
        return None;
    }
    if let Some(fragment) = fragment {
        page.anchors.push((aim.clone(), fragment.to_owned()));
    }
    let fragment = fragment.map_or(String::new(), |fragment| format!("#{fragment}"));
    Some(relative(&page.target, &target(&aim)) + &fragment)
}

/// A path that stands in a page, relative to the project.
fn joined(page: &Path, path: &str) -> PathBuf {
    let mut whole = page.parent().map(Path::to_owned).unwrap_or_default();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => {
                whole.pop();
            }
            Component::Normal(part) => whole.push(part),
            _ => {}
        }
    }
    whole
}

/// A link from one page to another.
pub(super) fn relative(from: &Path, to: &Path) -> String {
    let folder: Vec<_> = from
        .parent()
        .into_iter()
        .flat_map(Path::components)
        .collect();
    let parts: Vec<_> = to.components().collect();
    let shared = folder
        .iter()
        .zip(&parts)
        .take_while(|(a, b)| a == b)
        .count();
    let mut steps: Vec<String> = vec!["..".to_owned(); folder.len() - shared];
    steps.extend(
        parts[shared..]
            .iter()
            .map(|part| part.as_os_str().to_string_lossy().into_owned()),
    );
    steps.join("/")
}
