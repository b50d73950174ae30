//! An overview as one page of HTML, which needs no network and no script.

use std::fmt::Write as _;

use crate::overview::{Group, Overview, Row};

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem;color:#222}\
table{border-collapse:collapse;width:100%;margin-bottom:1.5rem}\
th,td{text-align:left;padding:.15rem .6rem;border-bottom:1px solid #ddd;vertical-align:top}\
td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}\
td.b{width:14rem}div.b{background:#0072b2;height:.8rem}\
code{font-size:.95em}h2{font-size:1.1rem;margin:1.5rem 0 .3rem}\
tr.unverified td,tr.assumed td{color:#a34700}";

/// The page.
#[must_use]
pub fn page(overview: &Overview) -> String {
    let mut html = String::new();
    let title = escaped(&overview.name);
    let _ = write!(
        html,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p>Models: {}. Units: {}.</p>\n",
        escaped(&overview.models.join(", ")),
        escaped(&overview.units),
    );
    overview.groups.iter().for_each(|it| group(&mut html, it));
    html.push_str("<h2><code>[validity]</code></h2>\n<table>\n");
    for it in &overview.validity {
        let [name, min, max, unit] = [&it.name, &it.min, &it.max, &it.unit].map(|it| escaped(it));
        let _ = writeln!(
            html,
            "<tr><td><code>{name}</code></td><td>{min} to {max} {unit}</td></tr>"
        );
    }
    html.push_str("</table>\n<h2><code>[sources]</code></h2>\n<table>\n");
    for (key, text) in &overview.sources {
        let (key, text) = (escaped(key), escaped(text));
        let _ = writeln!(html, "<tr><td><code>{key}</code></td><td>{text}</td></tr>");
    }
    html.push_str(
        "</table>\n<p>The bar is the largest magnitude of the term over the validity box, as a share of the sum over all \
         terms of the quantity.</p>\n</body>\n</html>\n",
    );
    html
}

fn group(html: &mut String, group: &Group) {
    let (header, described) = (escaped(&group.header()), escaped(&group.described()));
    let last = if group.unit.is_some() {
        "<th>share</th><th></th>"
    } else {
        "<th>what it is</th>"
    };
    let _ = writeln!(
        html,
        "<h2><code>{header}</code> {described}</h2>\n<table>\n<tr><th>key</th><th>value</th><th>unit</th>\
         <th>uncertainty</th><th>status</th><th>source</th>{last}</tr>"
    );
    for row in &group.entries {
        self::row(html, row, group.unit.is_some());
    }
    html.push_str("</table>\n");
}

fn row(html: &mut String, row: &Row, is_term: bool) {
    let [key, value, unit, status, source, doc] = [
        &row.key,
        &row.value,
        &row.unit,
        &row.status,
        &row.source,
        &row.doc,
    ]
    .map(|it| escaped(it));
    let last = if is_term {
        let width = row.share.unwrap_or(0.0) * 100.0;
        let share = row.shown_share();
        format!(
            "<td class=\"n\">{share}</td><td class=\"b\"><div class=\"b\" style=\"width:{width:.2}%\"></div></td>"
        )
    } else {
        format!("<td>{doc}</td>")
    };
    let uncertainty = row.shown_uncertainty();
    let _ = writeln!(
        html,
        "<tr class=\"{status}\"><td><code>{key}</code></td><td class=\"n\">{value}</td><td>{unit}</td>\
         <td class=\"n\">{uncertainty}</td><td>{status}</td><td>{source}</td>{last}</tr>"
    );
}

/// A text that stands for itself in HTML, also between quotes.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            _ => safe.push(letter),
        }
    }
    safe
}
