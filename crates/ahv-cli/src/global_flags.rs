//! How the program speaks: with or without colours, with or without what is not a result.

use std::ffi::OsString;

use clap::{Args, ColorChoice, ValueEnum as _};

use crate::failure;

const COLOR: &str = "--color";

/// Flags of every command.
#[derive(Args)]
pub(crate) struct Console {
    /// Colour messages; `auto` does so on a terminal, unless the variable NO_COLOR is set
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t = ColorChoice::Auto, hide_possible_values = true, help_heading = "Output")]
    color: ColorChoice,

    /// Print results and errors only: no notes, no warnings, no progress
    #[arg(long, global = true, help_heading = "Output")]
    pub(crate) quiet: bool,
}

impl Console {
    /// Lets the rest of the process speak like that.
    pub(crate) fn apply(&self) {
        let forced = match self.color {
            ColorChoice::Auto => None,
            ColorChoice::Always => Some(true),
            ColorChoice::Never => Some(false),
        };
        if let Some(colours) = forced {
            console::set_colors_enabled(colours);
            console::set_colors_enabled_stderr(colours);
        }
        failure::set_quiet(self.quiet);
        #[cfg(feature = "generate")]
        ahv_generate::set_quiet(self.quiet);
    }
}

/// The colours that a command line asks for, also where the rest of it is wrong: then that is printed with them.
pub(crate) fn color(line: &[OsString]) -> ColorChoice {
    let words = line.iter().filter_map(|word| word.to_str());
    let words: Vec<&str> = words.take_while(|word| *word != "--").collect();
    let joined = words
        .iter()
        .find_map(|word| word.strip_prefix(COLOR)?.strip_prefix('='));
    let apart = words.iter().position(|word| *word == COLOR);
    let value = joined.or_else(|| words.get(apart? + 1).copied());
    value
        .and_then(|value| ColorChoice::from_str(value, false).ok())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use clap::ColorChoice;

    use super::color;

    #[test]
    fn the_colours_are_found_in_any_line() {
        let of = |line: &str| color(&line.split(' ').map(Into::into).collect::<Vec<_>>());
        assert_eq!(of("ahv trim --color never --nonsense"), ColorChoice::Never);
        assert_eq!(of("ahv --color=always trim"), ColorChoice::Always);
        for auto in [
            "ahv trim",
            "ahv --color",
            "ahv -- --color never",
            "ahv --color x",
        ] {
            assert_eq!(of(auto), ColorChoice::Auto, "{auto}");
        }
    }
}
