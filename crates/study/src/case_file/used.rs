//! The files that a case uses, and whether they are still what they were.

use std::collections::HashSet;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::inputs::data_files::{files_of_data, folder_of_data};
use crate::case_file::paths::absolute_paths;
use crate::case_file::{CaseError, CaseFile, Variant};
use crate::{EvidenceChoice, InputKind, Request};
use impactlab_core::data::parts_beside;
use impactlab_core::data::write::FileDigest;
use impactlab_core::numerics::sha256_hex;
use impactlab_core::site::Site;

/// Why a file is missing that the case has no content of.
const NOT_THERE: &str = "it was not there when the case was saved either";

/// Files and folders below a folder that are looked at to find out where it leads.
const MAX_ENTRIES: usize = 500_000;

/// A file or a folder that a case uses, by its content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UsedFile {
    /// The file or folder.
    pub path: PathBuf,
    /// Size of the file, or of all files that are read in the folder, bytes.
    pub bytes: u64,
    /// SHA-256 of the content of a file, hexadecimal; of a folder, or of the table of cases in it, of a list of
    /// the files that are read there with their names and digests.
    pub sha256: String,
}

/// What has become of something that a case uses since it was saved.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Change {
    /// A file or folder is not there, or cannot be read.
    Missing {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        why: String,
    },
    /// A file or folder holds something else.
    Changed {
        /// The file or folder.
        path: PathBuf,
    },
    /// The case itself was edited without the program.
    Case {
        /// Its file.
        path: PathBuf,
    },
    /// A network of the same name is another one.
    Model {
        /// Which network it is.
        network: String,
        /// What questions call it.
        name: String,
    },
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { path, why } => write!(f, "{}: is missing ({why})", path.display()),
            Self::Changed { path } => {
                write!(f, "{}: has changed since the case was saved", path.display())
            }
            Self::Case { path } => {
                write!(f, "{}: has been edited since the program saved it", path.display())
            }
            Self::Model { network, name } => write!(
                f,
                "the {network} network {name:?} is another one than when the case was saved"
            ),
        }
    }
}

impl UsedFile {
    /// Reads a file, or every file of the data in a folder, to its end.
    ///
    /// # Errors
    /// The error of the operating system.
    pub fn read(path: &Path) -> io::Result<Self> {
        let Some(folder) = folder_of_data(path) else {
            let FileDigest { bytes, sha256, .. } = FileDigest::from_file("", path)?;
            return Ok(Self { path: path.to_owned(), bytes, sha256 });
        };
        let (mut list, mut bytes) = (String::new(), 0);
        for (name, file) in named_below(folder, files_of_data(path)) {
            let file = FileDigest::from_file(name.as_str(), &file)?;
            list.push_str(&format!("{}  {name}\n", file.sha256));
            bytes += file.bytes;
        }
        Ok(Self { path: path.to_owned(), bytes, sha256: sha256_hex([list.as_bytes()]) })
    }
}

/// Files below a folder by what they are called from there, with `/` between the parts, in the order of these
/// names.
pub(super) fn named_below(folder: &Path, files: Vec<PathBuf>) -> Vec<(String, PathBuf)> {
    let named = |file: PathBuf| {
        let below = file.strip_prefix(folder).unwrap_or(&file);
        let parts: Vec<_> = below.iter().map(|part| part.to_string_lossy()).collect();
        (parts.join("/"), file)
    };
    let mut named: Vec<_> = files.into_iter().map(named).collect();
    named.sort();
    named
}

/// Every link in a folder and the folders in it, none left out but what is behind a link; `None` if there is
/// too much in it to look at.
pub(super) fn links_in(folder: &Path) -> Option<Vec<PathBuf>> {
    let (mut links, mut open, mut n) = (Vec::new(), vec![folder.to_owned()], 0);
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            n += 1;
            match entry.file_type() {
                _ if n > MAX_ENTRIES => return None,
                Ok(kind) if kind.is_symlink() => links.push(entry.path()),
                Ok(kind) if kind.is_dir() => open.push(entry.path()),
                _ => {}
            }
        }
    }
    Some(links)
}

/// The evidence that a question rests on.
fn evidence_of(question: &Request) -> Option<&EvidenceChoice> {
    match question {
        Request::Reconstruct(request) => Some(&request.evidence),
        _ => None,
    }
}

/// Orthophoto, world file and drawing of a site, the other parts of a file of results of which this is the
/// first, and the curves of a crash test; none for any other file.
pub(super) fn files_of_site(path: &Path) -> Vec<PathBuf> {
    if InputKind::from_path(path).is_ground() {
        return Site::files_named_by(path);
    }
    let mut parts = parts_beside(path);
    match parts.first().is_some_and(|first| first == path) {
        true => parts.split_off(1),
        false => Vec::new(),
    }
}

/// A path as it is read: what was written into the file of a case by hand may begin at the working folder.
fn as_read(path: PathBuf) -> PathBuf {
    std::path::absolute(&path).unwrap_or(path)
}

impl CaseFile {
    /// The files and folders that questions and views name, with those that a site names and the other parts of
    /// a file of results. One that is not there counts if it was there when the case was saved.
    pub fn used_paths(&self) -> Vec<PathBuf> {
        let known: HashSet<&Path> = self.files.iter().map(|file| file.path.as_path()).collect();
        let mut paths: Vec<PathBuf> = self.named_paths().into_iter().map(as_read).collect();
        let of_sites: Vec<PathBuf> = paths.iter().flat_map(|path| files_of_site(path)).collect();
        let parts: Vec<PathBuf> = paths.iter().flat_map(|path| parts_beside(path)).collect();
        paths.extend(of_sites);
        paths.extend(parts);
        paths.retain(|path| {
            path.is_absolute()
                && path.parent().is_some()
                && (known.contains(path.as_path()) || path.exists())
        });
        paths.sort();
        paths.dedup();
        paths
    }

    /// The files and folders that stand in the questions, also those that are not asked, and in how the
    /// window draws them. Nothing is read.
    pub(super) fn named_paths(&self) -> Vec<PathBuf> {
        let in_variant = |variant: &Variant| {
            let questions = variant.questions.iter().chain(&variant.unasked);
            let named = questions.flat_map(Request::named_paths).collect::<Vec<_>>();
            named.into_iter().chain(absolute_paths(&variant.view))
        };
        self.variants.iter().flat_map(in_variant).collect()
    }

    /// The case with what some of its variants ask and nothing else: no other variant, nothing that is filled in
    /// and not asked, nothing of how the window draws it, and of its files those that these questions rest
    /// on. Without one of the variants, its log does not say how any came about, which names others.
    ///
    /// - `variants`: their names; all of them if there is none.
    ///
    /// # Errors
    /// [`CaseError::NoVariant`].
    pub fn asked(&self, variants: &[String]) -> Result<Self, CaseError> {
        if let Some(name) = variants.iter().find(|name| self.variant(name).is_none()) {
            return Err(self.no_variant(name));
        }
        let mut asked = self.clone();
        asked.variants.retain(|of| variants.is_empty() || variants.contains(&of.name));
        if asked.variants.len() < self.variants.len() {
            asked.log.retain(|entry| !entry.is_of_variant());
        }
        for variant in &mut asked.variants {
            variant.unasked.clear();
            variant.view = serde_json::Value::Null;
            variant.forms = serde_json::Value::Null;
        }
        let used: HashSet<PathBuf> = asked.used_paths().into_iter().collect();
        asked.files.retain(|file| used.contains(&file.path));
        Ok(asked)
    }

    /// Every absolute path that stands in the case, whether it is read, written or neither.
    pub(super) fn said_paths(&self) -> HashSet<PathBuf> {
        let in_variant = |variant: &Variant| {
            let questions = variant.questions.iter().chain(&variant.unasked);
            let written = questions.filter_map(Request::written_path).map(Path::to_owned);
            let written: Vec<PathBuf> = written.collect();
            [written, absolute_paths(&variant.forms)].concat()
        };
        let of_variants = self.variants.iter().flat_map(in_variant);
        let of_models = self.models.iter().map(|model| PathBuf::from(&model.name));
        let said = self.named_paths().into_iter().chain(of_variants).chain(of_models);
        said.filter(|path| path.is_absolute()).collect()
    }

    /// What is filled in and used by no question that is asked, a sentence each: evidence, and files that
    /// questions name which are not asked. Nothing is read.
    pub fn unused(&self) -> Vec<String> {
        let asked = || self.variants.iter().flat_map(|variant| &variant.questions);
        let named: HashSet<PathBuf> = asked().flat_map(Request::named_paths).collect();
        let is_asked = |evidence: &EvidenceChoice| {
            asked().filter_map(evidence_of).any(|of_question| of_question == evidence)
        };
        let mut found = Vec::new();
        for variant in &self.variants {
            for question in &variant.unasked {
                let paths = question.named_paths().into_iter().filter(|path| !named.contains(path));
                let files = paths.map(|path| format!("the file {}", path.display()));
                let evidence = evidence_of(question).filter(|evidence| !is_asked(evidence));
                let inline = evidence.and_then(|evidence| match evidence {
                    EvidenceChoice::Inline(evidence) => Some(evidence.case.as_str()),
                    // It is one of the files.
                    EvidenceChoice::File(_) => None,
                });
                let inline = inline.map(|name| format!("the evidence {name:?}"));
                let said = |what: String| {
                    format!(
                        "variant {:?}: {what} is used by no question that is asked",
                        variant.name
                    )
                };
                // Questions of one collision name its files each.
                for sentence in inline.into_iter().chain(files).map(said) {
                    if !found.contains(&sentence) {
                        found.push(sentence);
                    }
                }
            }
        }
        found
    }

    /// Every file that an answer to the case rests on, with those within its data sets.
    pub fn input_files(&self) -> Vec<PathBuf> {
        let questions = self.variants.iter().flat_map(|variant| &variant.questions);
        let mut paths = self.used_paths();
        paths.extend(questions.flat_map(Request::files_read));
        paths.sort();
        paths.dedup();
        paths
    }

    /// Reads the content of every file that the variants name, by which changes will be known. A file
    /// that is missing keeps the content that it had.
    pub fn record_files(&mut self) {
        let read = |path: &PathBuf| {
            let before = || self.files.iter().find(|file| file.path == *path).cloned();
            UsedFile::read(path).ok().or_else(before)
        };
        self.files = self.used_paths().iter().filter_map(read).collect();
    }

    /// What has become of the files since the case was saved.
    pub fn changes(&self) -> Vec<Change> {
        let change = |file: &UsedFile| match UsedFile::read(&file.path) {
            Err(error) => Some(Change::Missing { path: file.path.clone(), why: error.to_string() }),
            Ok(now) if now != *file => Some(Change::Changed { path: file.path.clone() }),
            Ok(_) => None,
        };
        let is_known = |path: &PathBuf| self.files.iter().any(|file| file.path == *path);
        let missing = self.missing_inputs().into_iter().filter(|path| !is_known(path));
        let never_there = missing.map(|path| Change::Missing { path, why: NOT_THERE.to_owned() });
        self.files.iter().filter_map(change).chain(never_there).collect()
    }

    /// The files that questions name and that are not there, also those that never were.
    pub(super) fn missing_inputs(&self) -> Vec<PathBuf> {
        let questions = self.variants.iter().flat_map(|variant| &variant.questions);
        let named = |question: &Request| [question.named_paths(), question.input_files()].concat();
        let mut paths: Vec<PathBuf> = questions.flat_map(named).collect();
        paths.retain(|path| !path.exists());
        paths.sort();
        paths.dedup();
        paths
    }

    /// Refuses a case that JSON cannot hold: its files would be missing where they are listed.
    pub(super) fn check_writable(&self) -> Result<(), CaseError> {
        self.variants.iter().try_for_each(|variant| {
            serde_json::to_value(variant)
                .map(drop)
                .map_err(|source| CaseError::NotUnicode { variant: variant.name.clone(), source })
        })
    }

    /// Refuses a case in which two variants have the same name, or that shows none of them.
    pub(super) fn check_names(&self, path: &Path) -> Result<(), CaseError> {
        for (i, variant) in self.variants.iter().enumerate() {
            if self.variants[..i].iter().any(|other| other.name == variant.name) {
                let (path, name) = (path.to_owned(), variant.name.clone());
                return Err(CaseError::SameName { path, name });
            }
        }
        if self.variant(&self.shown).is_none() {
            return Err(self.no_variant(&self.shown));
        }
        Ok(())
    }

    /// The error of a variant that is not there.
    pub(super) fn no_variant(&self, name: &str) -> CaseError {
        let known = self.variants.iter().map(|variant| variant.name.clone()).collect();
        CaseError::NoVariant { name: name.to_owned(), known }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ImpactRequest, ReconstructRequest, ScenarioChoice};

    /// “Materials: no files but the case itself” stood in the report of a case whose site was read.
    #[test]
    fn a_file_that_is_read_from_the_working_folder_is_used() {
        let question =
            |path: &str| Request::from(ImpactRequest::new(ScenarioChoice::File(path.into())));
        let questions = ["Cargo.toml", "pit-right-rear"].map(question).into();
        let variant = Variant { name: "a".to_owned(), questions, ..Variant::default() };
        let used = CaseFile::new("case", variant).used_paths();
        assert_eq!(used, [std::path::absolute("Cargo.toml").unwrap()]);
    }

    /// A package had no file of a folder that a data set links to, and no change of such a file was noticed.
    #[cfg(unix)]
    #[test]
    fn a_folder_that_is_linked_to_goes_with_the_one_that_has_the_link() {
        use impactlab_core::data::Existing;
        use std::os::unix::fs::symlink;

        let folder = tempfile::tempdir().unwrap();
        let [set, far, zip, there] =
            ["set", "far", "a.zip", "there"].map(|name| folder.path().join(name));
        let files = [
            (set.join("cases.csv"), "case\n1\n"),
            (far.join("1.csv"), "t\n0\n"),
            (far.join("2.csv"), "of no row"),
        ];
        std::fs::create_dir(&set).unwrap();
        std::fs::create_dir(&far).unwrap();
        for (path, text) in files {
            std::fs::write(path, text).unwrap();
        }
        symlink(&far, set.join("forces")).unwrap();
        symlink(&set, set.join("round")).unwrap();
        symlink(&set, far.join("back")).unwrap();
        let before = UsedFile::read(&set).unwrap();
        let check = crate::CheckRequest { paths: vec![set.clone()], all: false, map: None };
        let questions = vec![Request::from(check)];
        let variant = Variant { name: "a".to_owned(), questions, ..Variant::default() };
        let case = CaseFile::new("case", variant);
        let packed = crate::case_file::pack(&case, &zip, Existing::Refuse).unwrap();
        let names: Vec<&str> = packed.iter().map(|file| file.name.as_str()).collect();
        assert_eq!(names, ["files/0/set/cases.csv", "files/0/set/forces/1.csv"]);
        let opened = CaseFile::load(&crate::case_file::unpack(&zip, &there).unwrap()).unwrap();
        assert!(opened.changes().is_empty(), "{:?}", opened.changes());
        std::fs::write(far.join("1.csv"), "t\n1\n").unwrap();
        assert_ne!(UsedFile::read(&set).unwrap(), before);
    }

    /// The report of one variant named the others in its log, also those that were removed.
    #[test]
    fn a_case_of_one_variant_says_nothing_of_the_others_in_its_log() {
        let variant = |name: &str| Variant { name: name.to_owned(), ..Variant::default() };
        let mut case = CaseFile::new("case", variant("too fast"));
        case.variants.push(variant("braked"));
        let events = [
            "opened",
            "variant \"braked\" copied from \"too fast\"",
            "variant \"drunk\" removed",
            "variant \"b\" renamed to \"braked\"",
            "saved",
        ];
        events.iter().for_each(|event| case.note(*event));
        let log = |variants: &[&str]| -> Vec<String> {
            let variants: Vec<String> = variants.iter().map(|&name| name.to_owned()).collect();
            let asked = case.asked(&variants).unwrap();
            asked.log.into_iter().map(|entry| entry.event).collect()
        };
        assert_eq!(log(&["braked"]), ["opened", "saved"]);
        assert_eq!(log(&["too fast", "braked"]), events);
        assert_eq!(log(&[]), events);
    }

    /// `check` said nothing of evidence that a case has and that no question uses.
    #[test]
    fn evidence_that_no_question_uses_is_said() {
        let evidence = |case: &str| {
            let mut evidence = crate::examples::spin();
            evidence.case = case.to_owned();
            Request::from(ReconstructRequest::new(EvidenceChoice::Inline(Box::new(evidence))))
        };
        let file =
            |path: &str| Request::from(ImpactRequest::new(ScenarioChoice::File(path.into())));
        let variant = |questions, unasked| Variant {
            name: "a".to_owned(),
            questions,
            unasked,
            ..Variant::default()
        };
        let asked = vec![evidence("one"), file("/x/a.toml")];
        let unused = |unasked| CaseFile::new("case", variant(asked.clone(), unasked)).unused();
        assert_eq!(unused(asked.clone()), [""; 0]);
        let said = unused(vec![evidence("two"), file("/x/b.toml"), file("/x/b.toml")]);
        let [of_evidence, of_file] = &said[..] else { panic!("{said:?}") };
        assert!(of_evidence.contains("the evidence \"two\" is used by no question"), "{said:?}");
        assert!(of_file.contains("b.toml is used by no question"), "{said:?}");
    }
}
