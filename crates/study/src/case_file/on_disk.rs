//! The file of a case itself: its digest, and whether it is as the program has written it.
//!
//! The last key of a file that the program writes is `seal`: the SHA-256 of all else in the file, as JSON
//! without white space and with its keys in alphabetical order. An edit of the file without the program
//! leaves a seal that does not fit. It is no signature: whoever means to can make another one.

use std::path::Path;

use serde_json::Value;

use crate::case_file::{CaseError, Change, UsedFile};
use impactlab_core::data::{MAX_RESULTS_BYTES, read_utf8, without_byte_order_mark};
use impactlab_core::numerics::sha256_hex;

/// Key of the seal.
const SEAL: &str = "seal";

/// The file of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseOnDisk {
    /// The file by its content.
    pub file: UsedFile,
    /// Whether its content is what the program has written; `None` if it has no seal, because somebody
    /// wrote it by hand or an earlier version did.
    pub is_as_saved: Option<bool>,
}

impl CaseOnDisk {
    /// Reads the file of a case.
    ///
    /// # Errors
    /// [`CaseError`] if it cannot be read.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let text = read_utf8(path, MAX_RESULTS_BYTES)?;
        Ok(Self::from_text(&text, path))
    }

    /// The file of a case with this text.
    pub fn from_text(text: &str, path: &Path) -> Self {
        let is_as_saved = split(text).and_then(|(seal, of_rest)| Some(seal? == of_rest));
        let (bytes, sha256) = (text.len() as u64, sha256_hex([text.as_bytes()]));
        Self { file: UsedFile { path: path.to_owned(), bytes, sha256 }, is_as_saved }
    }

    /// That the file was edited since the program saved it.
    pub fn change(&self) -> Option<Change> {
        let path = self.file.path.clone();
        (self.is_as_saved == Some(false)).then_some(Change::Case { path })
    }
}

/// The text of a case with its seal as the last key; as it is where it is no object.
///
/// - `text`: JSON in several lines, without a seal.
pub(super) fn sealed(text: &str) -> String {
    match (text.trim_end().strip_suffix("\n}"), split(text)) {
        (Some(open), Some((_, of_rest))) => format!("{open},\n  \"{SEAL}\": \"{of_rest}\"\n}}\n"),
        _ => text.to_owned(),
    }
}

/// The seal of a text, and the digest of all else; `None` where the text is no JSON object.
fn split(text: &str) -> Option<(Option<String>, String)> {
    let text = without_byte_order_mark(text);
    let Value::Object(mut all) = serde_json::from_str(text).ok()? else { return None };
    let seal = all.remove(SEAL).map(|seal| seal.as_str().unwrap_or_default().to_owned());
    Some((seal, sha256_hex([Value::Object(all).to_string().as_bytes()])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_file::{CaseFile, Variant};
    use impactlab_core::data::Existing;

    #[test]
    fn an_edit_of_a_saved_case_is_noticed_and_white_space_is_none() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.impactlab");
        let mut case =
            CaseFile::new("Crossing", Variant { name: "one".into(), ..Variant::default() });
        case.notes = "seen from the north".into();
        case.save(&path, Existing::Refuse).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let saved = CaseOnDisk::read(&path).unwrap();
        assert_eq!((saved.is_as_saved, saved.change()), (Some(true), None));
        assert_eq!(saved.file.sha256, sha256_hex([text.as_bytes()]));
        assert_eq!(saved.file.bytes, text.len() as u64);
        assert_eq!(CaseFile::load(&path).unwrap(), CaseFile::parse(&text, &path).unwrap());
        // Nothing has changed: the same text again, seal included.
        assert_eq!(CaseFile::load(&path).unwrap().to_text(&path).unwrap(), text);
        let state = |text: &str| CaseOnDisk::from_text(text, &path).is_as_saved;
        assert_eq!(state(&text.replace("\n  ", "\n      ")), Some(true));
        // An editor puts a byte order mark before it: no edit, but the digest is that of the bytes.
        let marked = format!("\u{feff}{text}");
        let on_disk = CaseOnDisk::from_text(&marked, &path);
        assert_eq!(on_disk.is_as_saved, Some(true));
        assert_eq!(on_disk.file.sha256, sha256_hex([marked.as_bytes()]));
        assert_eq!(CaseFile::parse(&marked, &path).unwrap(), CaseFile::load(&path).unwrap());
        let edited = text.replace("from the north", "from the south");
        assert_eq!(state(&edited), Some(false));
        let change = CaseOnDisk::from_text(&edited, &path).change().unwrap();
        assert!(
            change.to_string().ends_with("has been edited since the program saved it"),
            "{change}"
        );
        let by_hand: String =
            text.lines().filter(|line| !line.contains("\"seal\"")).collect::<Vec<_>>().join("\n");
        assert_eq!(state(&by_hand.replace("],\n}", "]\n}")), None);
    }
}
