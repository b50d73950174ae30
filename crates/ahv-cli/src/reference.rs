//! `ahv completions` and `ahv man`: what clap knows of the commands, for shells and for `man`.

use std::io;
use std::path::{Path, PathBuf};

use clap_complete::Shell;
use clap_mangen::Man;

use crate::failure::{Failure, print};
use crate::output;

/// Prints a script that completes the words of a command line in a shell.
///
/// `ahv completions bash > ~/.local/share/bash-completion/completions/ahv` sets it up for bash.
#[derive(clap::Args)]
pub(crate) struct Completions {
    /// Shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Writes a manual page for each command.
///
/// `man -l DIR/ahv.1` shows the first.
#[derive(clap::Args)]
pub(crate) struct ManPages {
    /// Folder for the pages; made if it does not exist
    #[arg(value_name = "DIR")]
    dir: PathBuf,
}

impl Completions {
    pub(crate) fn run(&self, mut command: clap::Command) -> Result<(), Failure> {
        let name = command.get_name().to_owned();
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut command, name, &mut script);
        print(String::from_utf8_lossy(&script).trim_end())
    }
}

impl ManPages {
    pub(crate) fn run(&self, mut command: clap::Command) -> Result<(), Failure> {
        output::folder(&self.dir)?;
        command = command.disable_help_subcommand(true);
        command.build();
        write(&self.dir, &command)
    }
}

/// The page of a command and those of the commands below it: `ahv-table-lint.1`.
fn write(dir: &Path, command: &clap::Command) -> Result<(), Failure> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    let file = dir.join(format!("{name}.1"));
    let page =
        page(command).map_err(|error| output::cannot_write(&file, &output::plain(&error)))?;
    output::write(&file, page)?;
    command
        .get_subcommands()
        .try_for_each(|below| write(dir, below))
}

fn page(command: &clap::Command) -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page)?;
    Ok(page)
}
