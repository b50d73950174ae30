//! The text of a table for a message: its lines, with those cut that nobody could read.

use std::fmt::Debug;
use std::ops::Range;

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

/// Longest line that is shown whole, in bytes.
const WIDEST: usize = 200;
/// What is shown of a longer one before the place of the fault, in bytes.
const BEFORE: usize = 60;
const CUT: &str = "...";

/// A text whose long lines are cut, with the place of a fault in it. It tells the column that the place has in the whole line.
#[derive(Debug)]
pub(crate) struct Excerpt {
    file: String,
    text: String,
    /// Where the fault is, in bytes of `text`.
    pub(crate) span: Range<usize>,
    /// Number of the line, from 0, whose start is cut off, and by how many bytes.
    shifted: (usize, usize),
}

impl Excerpt {
    /// Of `whole`, with the fault at `span`.
    pub(crate) fn new(file: &str, whole: &str, span: Range<usize>) -> Self {
        let (mut text, mut at) = (String::new(), [0; 2]);
        let (mut line_start, mut shifted) = (0, (0, 0));
        for (number, line) in whole.split_inclusive('\n').enumerate() {
            let (end, ended) = (line.trim_end_matches(['\r', '\n']), line_start + line.len());
            // The last line holds what stands at the end of the text.
            let holds = |place: usize| {
                (line_start..ended).contains(&place) || (place == whole.len() && ended == place)
            };
            let fault = holds(span.start).then(|| span.start - line_start);
            let kept = kept(end, fault.unwrap_or(0));
            let cut = if kept.start > 0 { CUT } else { "" };
            if kept.start > 0 {
                shifted = (number, kept.start - cut.len());
            }
            for (at, place) in at.iter_mut().zip([span.start, span.end]) {
                if holds(place) {
                    let inside = (place - line_start).clamp(kept.start, kept.end);
                    *at = text.len() + cut.len() + inside - kept.start;
                }
            }
            text.push_str(cut);
            text.push_str(&end[kept.clone()]);
            text.push_str(if kept.end < end.len() { CUT } else { "" });
            text.push_str(&line[end.len()..]);
            line_start = ended;
        }
        Self {
            file: file.to_owned(),
            text,
            span: at[0]..at[1],
            shifted,
        }
    }
}

/// The part of a line that is shown about a place in it.
fn kept(line: &str, place: usize) -> Range<usize> {
    if line.len() <= WIDEST {
        return 0..line.len();
    }
    let boundary = |at: usize| (at..=line.len()).find(|&at| line.is_char_boundary(at));
    let start = place.saturating_sub(BEFORE).min(line.len() - WIDEST);
    let start = boundary(start).unwrap_or(0);
    start..boundary(start + WIDEST).unwrap_or(line.len())
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let contents = self.text.read_span(span, before, after)?;
        let (line, cut) = self.shifted;
        let column = contents.column();
        // A context begins with a line: its column is 0, of whatever line.
        let shift = if contents.line() == line && column > 0 {
            cut
        } else {
            0
        };
        Ok(Box::new(MietteSpanContents::new_named(
            self.file.clone(),
            contents.data(),
            *contents.span(),
            contents.line(),
            column + shift,
            contents.line_count(),
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::{Excerpt, WIDEST};

    #[test]
    fn a_long_line_is_cut_about_the_place() {
        let long = format!(
            "[a]\nkey = \"{}é\" fault {}\nlast\n",
            "x".repeat(1000),
            "y".repeat(10_000)
        );
        let start = long.find("fault").expect("there");
        let excerpt = Excerpt::new("a.toml", &long, start..start + 5);
        assert_eq!(&excerpt.text[excerpt.span.clone()], "fault");
        assert!(excerpt.text.lines().all(|line| line.len() <= WIDEST + 8));
        assert_eq!(excerpt.text.lines().count(), 3);
        assert!(excerpt.text.starts_with("[a]\n...x") && excerpt.text.ends_with("y...\nlast\n"));
    }

    #[test]
    fn what_is_short_stays_as_it_is() {
        let text = "[a]\r\nkey = 1\nlast";
        for span in [0..3, 5..8, text.len()..text.len(), 5..text.len()] {
            let excerpt = Excerpt::new("a.toml", text, span.clone());
            assert_eq!((excerpt.text.as_str(), excerpt.span), (text, span));
        }
        assert_eq!(Excerpt::new("a.toml", "", 0..0).span, 0..0);
    }
}
