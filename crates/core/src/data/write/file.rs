//! One file, written whole or not at all.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::data::DataError;
use crate::data::write::WriteError;
use crate::data::write::temporary::{sweep, temporary_file};

/// Number of symbolic links that are followed one after the other, as the kernel does.
const MAX_LINKS: usize = 40;

/// What happens to a file that exists already.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Existing {
    /// It stays, and the write is an error.
    #[default]
    Refuse,
    /// It is replaced.
    Replace,
}

/// Writes a file through a temporary file in the same folder, which replaces `path` in one step at
/// the end. If anything fails, or if the process is killed, `path` remains as it was.
///
/// A new file has the permissions that the umask leaves; a file that is replaced keeps its own. If
/// `path` is a symbolic link, the file that it leads to is replaced and the link stays. Content,
/// name and folder are on the disk when the function returns. The temporary file is named
/// `.NAME.impactlab-XXXXXX.tmp`; those that killed writes of the same file have left are removed.
///
/// - `existing`: what happens to a file that exists already;
/// - `write`: writes the content.
///
/// # Errors
/// [`WriteError`] within [`DataError::Write`], as for [`check_target`]; and with the error of the
/// operating system or of `write`.
pub fn write_atomically(
    path: &Path,
    existing: Existing,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), DataError> {
    let target = Target::find(path, existing)?;
    sweep(&target.folder, &target.path);
    let mut file = target.temporary_file()?;
    let mut buffered = BufWriter::new(file.as_file_mut());
    write(&mut buffered).and_then(|()| buffered.flush()).map_err(target.to_error())?;
    drop(buffered);
    target.put(file, existing)?;
    Ok(())
}

/// Writes a file whose content is there as a whole, as [`write_atomically`] does.
///
/// - `existing`: what happens to a file that exists already.
///
/// # Errors
/// As for [`write_atomically`].
pub fn write_bytes(path: &Path, existing: Existing, bytes: &[u8]) -> Result<(), DataError> {
    write_atomically(path, existing, |out| out.write_all(bytes))
}

/// Returns an error where [`write_atomically`] could not write, so that it can be told before the
/// work whose result is to be written. Nothing is changed.
///
/// # Errors
/// [`WriteError`] within [`DataError::Write`]: the file exists and must not be replaced, is
/// read-only, or is a folder, a device or the like; the folder is missing or cannot be written to.
pub fn check_target(path: &Path, existing: Existing) -> Result<(), DataError> {
    let target = Target::find(path, existing)?;
    target.temporary_file()?;
    Ok(())
}

/// Returns an error if the name of a file does not end as its content has it, since whoever opens it goes by
/// its name.
///
/// # Errors
/// [`WriteError::Ending`] within [`DataError::Write`].
pub fn check_ending(path: &Path, ending: &'static str) -> Result<(), DataError> {
    match path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending)) {
        true => Ok(()),
        false => Err(WriteError::Ending { path: path.to_owned(), ending }.into()),
    }
}

/// Where a file goes.
pub(super) struct Target {
    /// The path behind all symbolic links.
    pub(super) path: PathBuf,
    folder: PathBuf,
    /// The file that is replaced, if there is one.
    replaced: Option<Metadata>,
}

impl Target {
    /// Follows symbolic links and looks at what is there.
    pub(super) fn find(given: &Path, existing: Existing) -> Result<Self, WriteError> {
        let path = resolved(given)?;
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        let names_folder = path.to_string_lossy().ends_with(std::path::is_separator);
        if path.file_name().is_none() || names_folder {
            return Err(WriteError::NotAFile { path: given.to_owned(), kind: "folder" });
        }
        let replaced = match fs::symlink_metadata(&path) {
            Ok(metadata) => Some(metadata),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(WriteError::io(given)(error)),
        };
        if let Some(metadata) = &replaced {
            check_replaceable(&path, metadata, existing)?;
        } else if !folder.is_dir() {
            return Err(WriteError::NoFolder { path: given.to_owned(), folder });
        }
        Ok(Self { path, folder, replaced })
    }

    /// Whether there is no file yet.
    pub(super) fn is_new(&self) -> bool {
        self.replaced.is_none()
    }

    /// An error of the operating system with this file.
    fn to_error(&self) -> impl FnOnce(io::Error) -> WriteError {
        WriteError::io(&self.path)
    }

    /// Makes the file that will become this one.
    fn temporary_file(&self) -> Result<NamedTempFile, WriteError> {
        temporary_file(&self.folder, &self.path, self.is_new()).map_err(self.to_error())
    }

    /// Gives the temporary file its permissions and its name.
    fn put(&self, file: NamedTempFile, existing: Existing) -> Result<(), WriteError> {
        self.keep_permissions(file.as_file()).map_err(self.to_error())?;
        file.as_file().sync_all().map_err(self.to_error())?;
        match existing {
            Existing::Replace => {
                drop(file.persist(&self.path).map_err(|e| self.to_error()(e.error))?)
            }
            Existing::Refuse => self.put_new(file)?,
        }
        sync_folder(&self.folder).map_err(self.to_error())
    }

    /// Gives the temporary file its name unless there is a file of this name by now.
    fn put_new(&self, file: NamedTempFile) -> Result<(), WriteError> {
        let Err(refused) = file.persist_noclobber(&self.path) else { return Ok(()) };
        if refused.error.kind() == io::ErrorKind::AlreadyExists {
            return Err(WriteError::Exists { path: self.path.clone() });
        }
        // Some file systems can only rename; that there was no such file was found a moment ago.
        refused.file.persist(&self.path).map_err(|error| self.to_error()(error.error))?;
        Ok(())
    }

    /// Moves a complete file, which is on the disk already and in the same file system, to its
    /// place. The folder is not synchronised yet.
    pub(super) fn take_over(&self, complete: &Path) -> Result<(), WriteError> {
        let file = File::open(complete).map_err(self.to_error())?;
        self.keep_permissions(&file).map_err(self.to_error())?;
        match fs::rename(complete, &self.path) {
            Err(error) if error.kind() == io::ErrorKind::CrossesDevices => self.copy(file),
            renamed => renamed.map_err(self.to_error()),
        }
    }

    /// Replaces the file at the end of a symbolic link into another file system.
    fn copy(&self, mut complete: File) -> Result<(), WriteError> {
        let mut file = self.temporary_file()?;
        io::copy(&mut complete, file.as_file_mut()).map_err(self.to_error())?;
        self.put(file, Existing::Replace)
    }

    /// Gives a file the permissions of the one that it replaces, and, where that is allowed, its
    /// owner.
    fn keep_permissions(&self, file: &File) -> io::Result<()> {
        let Some(replaced) = &self.replaced else { return Ok(()) };
        #[cfg(unix)]
        {
            use std::os::unix::fs::{MetadataExt, fchown};
            // Only the superuser may give a file away; another user's file becomes the writer's.
            let _ = fchown(file, Some(replaced.uid()), Some(replaced.gid()));
        }
        file.set_permissions(replaced.permissions())
    }
}

/// The path behind all symbolic links; what it names need not exist.
fn resolved(given: &Path) -> Result<PathBuf, WriteError> {
    let mut path = given.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(led_to) = fs::read_link(&path) else { return Ok(path) };
        path = match path.parent() {
            Some(folder) => folder.join(led_to),
            None => led_to,
        };
    }
    Err(WriteError::LinkLoop { path: given.to_owned() })
}

fn check_replaceable(
    path: &Path,
    metadata: &Metadata,
    existing: Existing,
) -> Result<(), WriteError> {
    let path = path.to_owned();
    if let Some(kind) = special_kind(metadata) {
        return Err(WriteError::NotAFile { path, kind });
    }
    if existing == Existing::Refuse {
        return Err(WriteError::Exists { path });
    }
    if metadata.permissions().readonly() {
        return Err(WriteError::ReadOnly { path });
    }
    // Changes nothing; says whether this user may write to it.
    match OpenOptions::new().write(true).open(&path) {
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => {
            Err(WriteError::ReadOnly { path })
        }
        Err(error) => Err(WriteError::io(&path)(error)),
        Ok(_) => Ok(()),
    }
}

/// What something is that is no regular file.
fn special_kind(metadata: &Metadata) -> Option<&'static str> {
    let kind = metadata.file_type();
    if kind.is_file() {
        return None;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return Some("named pipe");
        }
        if kind.is_socket() {
            return Some("socket");
        }
        if kind.is_block_device() || kind.is_char_device() {
            return Some("device");
        }
    }
    Some(if kind.is_dir() { "folder" } else { "special file" })
}

/// Brings the names in a folder to the disk, where the system can do that.
///
/// # Errors
/// Those of the operating system.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(not(unix)) {
        return Ok(());
    }
    // A folder that may be written to but not listed cannot be opened.
    let Ok(folder) = File::open(folder) else { return Ok(()) };
    match folder.sync_all() {
        Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
        synced => synced,
    }
}
