//! Filling templates in.

use askama::Template;

use crate::EmitError;

/// Fills a template in.
///
/// # Errors
/// [`EmitError::Template`] where a value of the template cannot be printed.
pub(crate) fn render(template: &impl Template) -> Result<String, EmitError> {
    template
        .render()
        .map_err(|error| EmitError::Template(error.to_string()))
}

#[cfg(test)]
mod tests {
    use std::fmt;

    use super::*;

    struct Unprintable;

    impl fmt::Display for Unprintable {
        fn fmt(&self, _: &mut fmt::Formatter<'_>) -> fmt::Result {
            Err(fmt::Error)
        }
    }

    #[derive(Template)]
    #[template(source = "value {{ value }}", ext = "txt")]
    struct Failing {
        value: Unprintable,
    }

    #[test]
    fn a_template_that_fails_is_an_error_and_no_empty_file() {
        let outcome = render(&Failing { value: Unprintable });
        assert!(matches!(outcome, Err(EmitError::Template(_))));
    }
}
