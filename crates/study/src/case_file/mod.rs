//! The case: what an analyst works on, in one text file `NAME.impactlab`.
//!
//! A case holds variants, each with the questions that are asked of it, the files that these name with
//! their content by SHA-256, the trained networks that answered, notes, and a log of what was done and
//! when. The file is JSON in a stable order, so that two versions of it can be compared line by line.
//!
//! - Paths of files in the file are relative to its folder and begin with `./` or `../`; in memory they
//!   are absolute. A case and its files can be moved together.
//! - [`CaseFile::changes`] says which files are missing or hold something else than when the case was
//!   saved.
//! - [`CaseOnDisk`] says whether the file itself is as the program has written it.
//! - [`CaseFile::reach`] says what it does beyond reading files in its own folder, before anything is asked.
//! - [`CaseFile::ask`] answers every question of every variant, as the commands of the questions do.
//! - [`pack`] and [`unpack`] make one zip of a case and all its files, and a folder of that again.
//! - A variant is its questions, which the window edits. What several of them have in common, such as the
//!   scenario, stands once in the file; in memory each question is whole.

mod error;

mod paths;

mod used;

mod reach;

mod store;

mod on_disk;

mod common;

mod portable;

mod package;

mod run;

use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::Request;

pub use error::CaseError;
pub use on_disk::CaseOnDisk;
pub use package::{PackedFile, file_stem, pack, unpack};
pub use paths::{begin_paths_at, end_paths_at, replace_strings};
pub use reach::Reach;
pub use run::{AnswerListener, AnsweredQuestion, CaseReport, VariantReport};
pub use store::CASE_ENDING;
pub(crate) use store::FORMAT;
pub use used::{Change, UsedFile};

/// A case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CaseFile {
    /// What kind of file it is; checked before anything else is read.
    format: String,
    /// Version of the schema.
    version: u32,
    /// Version of the program that saved it.
    program: String,
    /// What the case is called.
    pub name: String,
    /// What the analyst wrote about it.
    #[serde(default)]
    pub notes: String,
    /// Who gives the opinion, and who asked for it.
    #[serde(default, skip_serializing_if = "Expert::is_empty")]
    pub expert: Expert,
    /// Name of the variant that the window shows.
    pub shown: String,
    /// The variants, each with a name of its own.
    pub variants: Vec<Variant>,
    /// The files that the variants name, as they were when the case was saved.
    #[serde(default)]
    pub files: Vec<UsedFile>,
    /// The trained networks that answered when the case was saved.
    #[serde(default)]
    pub models: Vec<UsedModel>,
    /// What was done and when.
    #[serde(default)]
    pub log: Vec<LogEntry>,
    /// SHA-256 of all else in the file, by which an edit without the program is known. It is written with
    /// the text of the file and belongs to that alone.
    #[serde(default, skip_serializing)]
    #[schemars(with = "Option<String>")]
    seal: IgnoredAny,
}

/// Who gives the opinion, and who asked for it; what was not said is none.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Expert {
    /// Name of the expert.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Training and appointment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub qualifications: Option<String>,
    /// Who instructed the expert, when, and to find out what.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instruction: Option<String>,
}

impl Expert {
    /// Whether nothing was said.
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// One way in which it may have happened.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(try_from = "common::VariantText")]
#[schemars(into = "common::VariantText")]
pub struct Variant {
    /// What it is called.
    pub name: String,
    /// What the analyst wrote about it.
    pub notes: String,
    /// What is asked of it.
    pub questions: Vec<Request>,
    /// Questions that are filled in and not asked, such as those about a scenario while a recorded case is
    /// looked at.
    pub unasked: Vec<Request>,
    /// How the window draws it; nothing else reads that.
    pub view: serde_json::Value,
    /// How the forms of the window were filled in beside the questions, in files of version 1. The window
    /// takes from them what no question says, and writes none.
    pub forms: serde_json::Value,
}

/// A trained network by the content of its file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UsedModel {
    /// Which network it is: `force` or `response`.
    pub network: String,
    /// What questions call it.
    pub name: String,
    /// SHA-256 of its file.
    pub sha256: String,
}

/// What was done and when.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LogEntry {
    /// The time of day in UTC, RFC 3339.
    pub time: String,
    /// What was done.
    pub event: String,
}

impl LogEntry {
    /// Whether it says how a variant came about or where it went, which names others.
    fn is_of_variant(&self) -> bool {
        self.event.starts_with("variant \"")
    }
}

impl CaseFile {
    /// A case with one variant.
    pub fn new(name: impl Into<String>, variant: Variant) -> Self {
        Self {
            format: store::FORMAT.to_owned(),
            version: store::VERSION,
            program: impactlab_core::program::version().to_owned(),
            name: name.into(),
            notes: String::new(),
            expert: Expert::default(),
            shown: variant.name.clone(),
            variants: vec![variant],
            files: Vec::new(),
            models: Vec::new(),
            log: Vec::new(),
            seal: IgnoredAny,
        }
    }

    /// Version of the program that saved it.
    pub fn program(&self) -> &str {
        &self.program
    }

    /// Writes down that something was done just now.
    pub fn note(&mut self, event: impl Into<String>) {
        let now = humantime::format_rfc3339_seconds(std::time::SystemTime::now());
        self.log.push(LogEntry { time: now.to_string(), event: event.into() });
    }

    /// A variant by its name.
    pub fn variant(&self, name: &str) -> Option<&Variant> {
        self.variants.iter().find(|variant| variant.name == name)
    }

    /// The same, to be changed.
    pub fn variant_mut(&mut self, name: &str) -> Option<&mut Variant> {
        self.variants.iter_mut().find(|variant| variant.name == name)
    }

    /// The first name `NAME`, `NAME 2`, `NAME 3`, … that no variant has.
    pub fn free_name(&self, name: &str) -> String {
        let numbered = (2..).map(|n| format!("{name} {n}"));
        let mut names = std::iter::once(name.to_owned()).chain(numbered);
        names.find(|name| self.variant(name).is_none()).unwrap_or_default()
    }
}
