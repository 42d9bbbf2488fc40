//! The parts of a report as plain data.

use serde::Serialize;

use crate::figure::Figure;
use crate::report::{Language, Paper};
use crate::scene::SceneStill;
use impactlab_core::units::UnitSystem;

/// A report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportDocument {
    /// Its title.
    pub title: String,
    /// What the case is called.
    pub case: String,
    /// The date of the report, as its language writes it.
    pub date: String,
    /// The same, `YYYY-MM-DD`.
    pub date_iso: String,
    /// The same as year, month and day.
    #[serde(skip)]
    pub(super) day: (u16, u8, u8),
    /// Language of the report.
    pub language: Language,
    /// Units of its numbers.
    pub units: UnitSystem,
    /// Size of its pages.
    pub paper: Paper,
    /// Version of the program.
    pub program: String,
    /// What it says, in its order.
    pub sections: Vec<Section>,
}

/// What a section is about. Every report has each once, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, strum::VariantArray)]
#[serde(rename_all = "snake_case")]
pub enum SectionKind {
    /// The answer in two pages, for those who decide; the other sections are its annex.
    Opinion,
    /// What was asked, and what came out.
    Answers,
    /// Scenes, and curves.
    Pictures,
    /// What was given, measured, estimated by rule and assumed.
    Inputs,
    /// What was found, and how well it is explained.
    Evidence,
    /// How it was computed, with sources.
    Method,
    /// Where the answers hold, and what restricts them.
    Validity,
    /// What the models were compared with, and how far they were off.
    Validation,
    /// What the answers depend on.
    Sensitivity,
    /// Versions, seeds, digests of files and networks.
    Provenance,
    /// What was done and when.
    Log,
}

impl SectionKind {
    /// All of them in their order.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;
}

/// A section.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Section {
    /// What it is about.
    pub kind: SectionKind,
    /// Its heading.
    pub title: String,
    /// What it says.
    pub blocks: Vec<Block>,
}

/// A part of a section.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Block {
    /// A heading below that of the section.
    Heading {
        /// 2 or 3.
        level: u8,
        /// The heading.
        text: String,
    },
    /// A paragraph.
    Paragraph {
        /// Its text.
        text: String,
    },
    /// Something that must not be overlooked.
    Notice {
        /// What it says.
        text: String,
    },
    /// Items below each other.
    List {
        /// The items.
        items: Vec<String>,
    },
    /// A table.
    Table(Table),
    /// A picture.
    Picture(Box<Picture>),
}

/// A table. Every row has as many cells as there are columns.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Column {
    /// Its title.
    pub title: String,
    /// Whether it is set to the right, as numbers are.
    pub is_numeric: bool,
}

/// A picture, which is drawn where the document is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Picture {
    /// Its number in the report.
    pub number: usize,
    /// What it shows, for everyone.
    pub caption: String,
    /// What it shows, for those who cannot see it.
    pub alt: String,
    /// What is drawn.
    #[serde(skip)]
    pub content: PictureContent,
}

/// What a picture is drawn from.
#[derive(Debug, Clone, PartialEq)]
pub enum PictureContent {
    /// Curves over axes.
    Figure(Box<Figure>),
    /// Cars on the ground at a moment.
    Scene(SceneStill),
}

/// Where an input comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum InputClass {
    /// The question says it.
    Given,
    /// It was measured, and has a standard deviation or a file.
    Measured,
    /// A rule gives it from other values.
    Estimated,
    /// The program assumed it: nobody said it.
    Assumed,
}

impl PictureContent {
    /// Whether it is drawn as curves over axes.
    pub fn is_plot(&self) -> bool {
        matches!(self, Self::Figure(_))
    }

    /// Whether two of its kind stand beside each other on a page: plots, cars that are seen from near,
    /// and a motion beside its forecast. Another scene from above has the width of the page.
    pub fn is_half_wide(&self) -> bool {
        match self {
            Self::Figure(_) => true,
            Self::Scene(still) => still.is_half_wide,
        }
    }
}

impl Block {
    /// A heading below that of the section.
    pub(super) fn heading(level: u8, text: impl Into<String>) -> Self {
        Self::Heading { level, text: text.into() }
    }

    /// A paragraph.
    pub(super) fn paragraph(text: impl Into<String>) -> Self {
        Self::Paragraph { text: text.into() }
    }

    /// Something that must not be overlooked.
    pub(super) fn notice(text: impl Into<String>) -> Self {
        Self::Notice { text: text.into() }
    }
}

impl Table {
    /// A table of text.
    pub(super) fn new<const N: usize>(
        caption: impl Into<String>,
        columns: [&str; N],
        rows: Vec<[String; N]>,
    ) -> Self {
        let column = |title: &str| Column { title: title.to_owned(), is_numeric: false };
        Self {
            caption: caption.into(),
            columns: columns.into_iter().map(column).collect(),
            rows: rows.into_iter().map(Vec::from).collect(),
        }
    }

    /// The same with columns that are set to the right.
    #[must_use]
    pub(super) fn numeric(mut self, columns: &[usize]) -> Self {
        for (idx, column) in self.columns.iter_mut().enumerate() {
            column.is_numeric |= columns.contains(&idx);
        }
        self
    }
}

impl ReportDocument {
    /// A section.
    pub fn section(&self, kind: SectionKind) -> Option<&Section> {
        self.sections.iter().find(|section| section.kind == kind)
    }

    /// The pictures in their order.
    pub fn pictures(&self) -> impl Iterator<Item = &Picture> {
        let blocks = self.sections.iter().flat_map(|section| &section.blocks);
        blocks.filter_map(|block| match block {
            Block::Picture(picture) => Some(picture.as_ref()),
            _ => None,
        })
    }
}
