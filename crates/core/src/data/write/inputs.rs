//! Files that something is computed from, which its result never replaces.

use std::fs;
use std::path::{Path, PathBuf};

use crate::data::DataError;
use crate::data::write::WriteError;

/// Returns an error if a file that is to be written is one of those that its content is computed from,
/// by whatever path or link either of them is named. That holds also where files may be replaced:
/// the record, survey or case that an answer rests on cannot be had back from the answer.
///
/// # Errors
/// [`WriteError::IsInput`] within [`DataError::Write`].
pub fn check_inputs(target: &Path, inputs: &[PathBuf]) -> Result<(), DataError> {
    // Of a file that is not there, none of the many inputs is looked at.
    let Some(identity) = identity(target) else { return Ok(()) };
    match inputs.iter().find(|input| self::identity(input).as_ref() == Some(&identity)) {
        None => Ok(()),
        Some(input) => {
            let (path, input) = (target.to_owned(), input.clone());
            Err(WriteError::IsInput { path, input }.into())
        }
    }
}

/// What a file is known by, whatever path leads to it; `None` if there is none.
#[cfg(unix)]
fn identity(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<PathBuf> {
    fs::canonicalize(path).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_is_known_by_every_path_and_link() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("below")).unwrap();
        for name in ["force.csv", "other.csv"] {
            fs::write(at(name), "mine").unwrap();
        }
        let inputs = [at("not there.csv"), at("force.csv")];
        let mut paths = vec![at("force.csv"), at("below/../force.csv")];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(at("force.csv"), at("link.csv")).unwrap();
            paths.push(at("link.csv"));
        }
        for path in paths {
            let error = check_inputs(&path, &inputs).unwrap_err().to_string();
            assert!(error.contains("force.csv) of what is to be written"), "{error}");
        }
        for path in [at("other.csv"), at("not there.csv"), at("new.csv")] {
            assert!(check_inputs(&path, &inputs).is_ok(), "{}", path.display());
        }
    }
}
