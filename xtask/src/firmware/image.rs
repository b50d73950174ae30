//! What an ELF file says of a program.

use std::fs;
use std::path::Path;

use object::elf::{SHF_ALLOC, SHT_NOBITS};
use object::read::elf::{ElfFile32, SectionHeader as _};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _};

/// The runtime's addition of two doubles.
const SOFT_ADDITION: &str = "__aeabi_dadd";

/// What is of interest in a program.
#[derive(Debug)]
pub(super) struct Image {
    /// Bytes of vector table, code, constants and initial values.
    pub(super) flash: u64,
    /// Whether it contains the addition of doubles by software.
    pub(super) soft_doubles: bool,
}

/// Reads a program.
pub(super) fn read(path: &Path) -> Result<Image, String> {
    let problem = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = fs::read(path).map_err(|error| problem(&error))?;
    let file = ElfFile32::<object::Endianness>::parse(&*bytes).map_err(|error| problem(&error))?;
    let loaded = file.sections().filter(|section| {
        let header = section.elf_section_header();
        let flags = header.sh_flags(file.endian());
        flags.contains(SHF_ALLOC) && header.sh_type(file.endian()) != SHT_NOBITS
    });
    Ok(Image {
        flash: loaded.map(|section| section.size()).sum(),
        soft_doubles: file
            .symbols()
            .any(|symbol| symbol.name() == Ok(SOFT_ADDITION)),
    })
}
