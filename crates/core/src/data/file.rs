//! Opens files and folders for reading. Only regular files are read: a named pipe would block for
//! ever, and a device may never end. Nothing is read beyond a stated size.

use std::fs::{File, Metadata, OpenOptions};
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::data::DataError;
use crate::data::budget::MAX_CASES;

/// Opens a regular file, or a link to one, and returns it with its size in bytes. Opening never
/// blocks.
///
/// # Errors
/// [`DataError`] if there is no such file, if it is a folder, a pipe, a socket or a device, or if
/// it cannot be opened; [`DataError::TooLarge`] if it has more than `limit` bytes.
pub fn open_file(path: &Path, limit: u64) -> Result<(File, u64), DataError> {
    let to_error = |source| DataError::io(path, source);
    // Opening a device may act on it, so that a path is looked at before it is opened. What was
    // opened is looked at again, because the path may lead elsewhere by then.
    check_kind(path, &std::fs::metadata(path).map_err(to_error)?)?;
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK);
    let file = options.open(path).map_err(to_error)?;
    let metadata = file.metadata().map_err(to_error)?;
    check_kind(path, &metadata)?;
    match metadata.len() {
        bytes if bytes > limit => Err(too_large(path, bytes, limit)),
        bytes => Ok((file, bytes)),
    }
}

/// Reads a regular file whole.
///
/// # Errors
/// The same as for [`open_file`], also if the file grows beyond `limit` bytes while it is read.
pub fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, DataError> {
    let (file, bytes) = open_file(path, limit)?;
    let mut content = Vec::with_capacity(usize::try_from(bytes).unwrap_or(0));
    file.take(limit + 1).read_to_end(&mut content).map_err(|source| DataError::io(path, source))?;
    match content.len() as u64 {
        bytes if bytes > limit => Err(too_large(path, bytes, limit)),
        _ => Ok(content),
    }
}

/// Reads a regular file of UTF-8 whole.
///
/// # Errors
/// The same as for [`read_bytes`], and [`DataError::Io`] if the file is not UTF-8.
pub fn read_utf8(path: &Path, limit: u64) -> Result<String, DataError> {
    String::from_utf8(read_bytes(path, limit)?).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let why = format!("it is not UTF-8 text from byte {} on", valid + 1);
        let source = std::io::Error::new(std::io::ErrorKind::InvalidData, why);
        DataError::Io { path: path.to_owned(), source }
    })
}

/// A text without the byte order mark with which some editors begin a file: JSON and numbers have none.
pub fn without_byte_order_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// The paths of all entries of a folder, in no particular order.
///
/// # Errors
/// [`DataError`] if the folder cannot be listed, and [`DataError::TooManyEntries`] if it has more
/// than [`MAX_CASES`] entries.
pub fn list_folder(path: &Path) -> Result<Vec<PathBuf>, DataError> {
    let to_error = |source| DataError::io(path, source);
    let mut entries = Vec::new();
    for entry in std::fs::read_dir(path).map_err(to_error)? {
        if entries.len() == MAX_CASES {
            return Err(DataError::TooManyEntries { path: path.to_owned(), limit: MAX_CASES });
        }
        entries.push(entry.map_err(to_error)?.path());
    }
    Ok(entries)
}

fn check_kind(path: &Path, metadata: &Metadata) -> Result<(), DataError> {
    let path = || path.to_owned();
    if metadata.is_dir() {
        return Err(DataError::IsDirectory { path: path() });
    }
    match metadata.is_file() {
        true => Ok(()),
        false => Err(DataError::NotRegular { path: path(), kind: kind_name(metadata) }),
    }
}

#[cfg(unix)]
fn kind_name(metadata: &Metadata) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    let kind = metadata.file_type();
    match () {
        () if kind.is_fifo() => "a pipe",
        () if kind.is_socket() => "a socket",
        () => "a device",
    }
}

#[cfg(not(unix))]
fn kind_name(_: &Metadata) -> &'static str {
    "a device"
}

fn too_large(path: &Path, bytes: u64, limit: u64) -> DataError {
    DataError::TooLarge { path: path.to_owned(), bytes, limit }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked_before_a_file_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f");
        std::fs::write(&path, "four").unwrap();
        assert_eq!(read_utf8(&path, 4).unwrap(), "four");
        let error = read_bytes(&path, 3).unwrap_err();
        assert!(matches!(error, DataError::TooLarge { bytes: 4, limit: 3, .. }), "{error}");
        // A sparse file of a terabyte takes no room on the disk; reading it would.
        std::fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
        let error = read_bytes(&path, 1 << 20).unwrap_err();
        assert!(matches!(error, DataError::TooLarge { bytes: 0x100_0000_0000, .. }), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn only_regular_files_are_read_and_links_to_them() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("file"), "text").unwrap();
        symlink(path("file"), path("link")).unwrap();
        assert_eq!(read_utf8(&path("link"), 100).unwrap(), "text");
        let made = std::process::Command::new("mkfifo").arg(path("pipe")).status().unwrap();
        assert!(made.success());
        let _socket = std::os::unix::net::UnixListener::bind(path("socket")).unwrap();
        symlink(path("pipe"), path("link to pipe")).unwrap();
        symlink(path("loop"), path("loop")).unwrap();
        let refused = |path: PathBuf| read_bytes(&path, 100).unwrap_err().to_string();
        for (name, kind) in [("pipe", "a pipe"), ("link to pipe", "a pipe"), ("socket", "a socket")]
        {
            let error = refused(path(name));
            assert!(error.ends_with(&format!("{name}: is {kind}, expected a file")), "{error}");
        }
        assert!(refused("/dev/zero".into()).ends_with("zero: is a device, expected a file"));
        assert!(refused(path("loop")).ends_with("loop: cannot be read or written"));
        assert!(refused(folder.path().to_owned()).ends_with("is a folder, expected a file"));
    }
}
