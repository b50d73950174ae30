//! Reading files, and only files: a pipe would wait for a writer, a device has no end.

use std::path::{Path, PathBuf};
use std::{fs, io};

/// The bytes of a regular file, or of one that a link leads to.
pub(crate) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_file() {
        fs::read(path)
    } else if kind.is_dir() {
        Err(io::ErrorKind::IsADirectory.into())
    } else {
        Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "it is a pipe, a socket or a device, not a file",
        ))
    }
}

/// The outermost part of `relative`, below `folder`, that is a link.
pub(crate) fn link_in(folder: &Path, relative: &str) -> Option<PathBuf> {
    let mut path = folder.to_owned();
    relative.split('/').find_map(|part| {
        path.push(part);
        path.is_symlink().then(|| path.clone())
    })
}
