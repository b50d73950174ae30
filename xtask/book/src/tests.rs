//! The book of small projects.

use super::*;

fn project(files: &[(&str, &str)]) -> tempfile::TempDir {
    let root = tempfile::tempdir().expect("a folder");
    for (path, text) in files {
        write(&root.path().join(path), text).expect("a file");
    }
    root
}

fn page(out: &Path, path: &str) -> String {
    fs::read_to_string(out.join(path)).expect("a page")
}

#[test]
fn pages_are_linked_and_formulas_are_mathml() {
    let root = project(&[
        (
            "README.md",
            "# Project\n\nSee [the guide](docs/guide.md#the-end) and ![a picture](docs/images/p.svg).",
        ),
        (
            "docs/guide.md",
            "# Guide\n\n$\\bar q$ in a table:\n\n| a |\n|---|\n| $C_L^{\\alpha}$ |\n\n\
             ## The end\n\n[Back](../README.md), [models](../generated/docs/README.md)",
        ),
        (
            "docs/SUMMARY.md",
            "# Summary\n\n# Guide\n\n- [Guide](guide.md)\n",
        ),
        (
            "docs/images/p.svg",
            "<svg xmlns=\"http://www.w3.org/2000/svg\"/>",
        ),
        (
            "generated/docs/README.md",
            "# Models\n\n[second](b.md) [first](a.md)",
        ),
        (
            "generated/docs/a.md",
            "# a\n\n```math\n\\begin{aligned}\nx ={}& a\n  + b \\\\\n\
             &\\quad{} + \\frac{1}{2} \\Bigl\\{ c \\Bigr\\}\n\\end{aligned} \\tag{27}\n```\n",
        ),
        ("generated/docs/b.md", "# b\n"),
    ]);
    let out = root.path().join("book");
    assert_eq!(build(root.path(), &out), Ok(5));
    let index = page(&out, "index.html");
    assert!(
        index.contains("href=\"docs/guide.html#the-end\""),
        "{index}"
    );
    assert!(out.join("docs/images/p.svg").exists());
    let guide = page(&out, "docs/guide.html");
    assert!(guide.contains("<math"), "{guide}");
    assert!(
        guide.contains("href=\"../generated/docs/index.html\">models"),
        "{guide}"
    );
    let first = page(&out, "generated/docs/a.html");
    assert!(first.contains("<span class=\"tag\">(27)</span>"), "{first}");
    assert!(!first.contains("\\Bigl"), "{first}");
    // The index of the models says in which order they stand.
    assert!(first.contains("← b"), "{first}");
}

#[test]
fn a_formula_that_cannot_be_converted_is_an_error() {
    let root = project(&[("README.md", "# P\n\n```math\n\\nonsense{x}\n```\n")]);
    let problem = build(root.path(), &root.path().join("book")).expect_err("a fault");
    assert!(
        problem.contains("README.md") && problem.contains("\\nonsense{x}"),
        "{problem}"
    );
}

#[test]
fn links_that_lead_nowhere_are_errors() {
    for (link, said) in [("docs/none.md", "none.md"), ("#nowhere", "#nowhere")] {
        let root = project(&[("README.md", &format!("# P\n\n[link]({link})"))]);
        let problem = build(root.path(), &root.path().join("book")).expect_err("a fault");
        assert!(problem.contains(said), "{problem}");
    }
}

/// A text of a user that came through the generated pages, or none: no page gets markup from it.
#[test]
fn html_in_a_page_is_text() {
    let root = project(&[(
        "README.md",
        "<!-- Made by a program. -->\n# P\n\nA <b onclick=\"x()\">word</b>.\n\n<script>alert(1)</script>\n\n\
         | a |\n|---|\n| <img src=x onerror=y> |\n",
    )]);
    let out = root.path().join("book");
    assert_eq!(build(root.path(), &out), Ok(1));
    let index = page(&out, "index.html");
    for raw in ["<script", "<img", "<b ", "Made by"] {
        assert!(!index.contains(raw), "{raw} in {index}");
    }
    for text in ["&lt;script&gt;alert(1)", "&lt;img src=x", "&lt;b onclick"] {
        assert!(index.contains(text), "no {text} in {index}");
    }
}
