//! A report as Markdown.

use std::collections::BTreeMap;

use base64::prelude::{BASE64_STANDARD, Engine};
use png::EncodingError;
use rayon::prelude::*;

use crate::report::language::words_of;
use crate::report::write::indexed_png::indexed_png;
use crate::report::write::pictures::{Drawing, Drawn, Medium, drawn_pictures};
use crate::report::{Block, PdfError, Picture, ReportDocument, Table};

/// Characters that mean something in Markdown or in HTML.
const MARKUP: [char; 14] = ['\\', '`', '*', '_', '{', '}', '[', ']', '<', '>', '#', '|', '~', '&'];

impl ReportDocument {
    /// The document as Markdown with pipe tables. Names cannot bring markup in. Pictures are told.
    pub fn to_markdown(&self) -> String {
        self.text(&BTreeMap::new())
    }

    /// The same with its pictures in it, as PNG behind the text: one file holds all of the report.
    ///
    /// # Errors
    /// [`PdfError::Picture`] if a picture cannot be drawn.
    pub fn to_markdown_with_pictures(&self, drawing: &Drawing<'_>) -> Result<String, PdfError> {
        let pictures = drawn_pictures(self, Some(drawing), Medium::Screen)?;
        let pixels = pictures.into_par_iter().filter_map(|(number, drawn)| match drawn {
            Drawn::Pixels(pixels) => Some((number, pixels)),
            Drawn::Vectors(_) => None,
        });
        let encoded = pixels.map(|(number, pixels)| {
            let failed =
                |error: EncodingError| PdfError::Picture { number, why: error.to_string() };
            let png = indexed_png(&pixels).map_err(failed)?;
            Ok((number, BASE64_STANDARD.encode(png)))
        });
        Ok(self.text(&encoded.collect::<Result<_, PdfError>>()?))
    }

    /// - `pictures`: PNG files in base 64 by the numbers of the pictures.
    fn text(&self, pictures: &BTreeMap<usize, String>) -> String {
        let mut text = format!("# {}\n", escaped(&self.title));
        let elsewhere = words_of(self.language).picture_elsewhere;
        for section in &self.sections {
            text.push_str(&format!("\n## {}\n", escaped(&section.title)));
            for block in &section.blocks {
                text.push('\n');
                match block {
                    Block::Picture(picture) if pictures.contains_key(&picture.number) => {
                        push_drawn(&mut text, picture);
                    }
                    block => push_block(&mut text, block, elsewhere),
                }
            }
        }
        for (number, png) in pictures {
            text.push_str(&format!("\n[figure-{number}]: data:image/png;base64,{png}\n"));
        }
        text
    }
}

fn push_block(text: &mut String, block: &Block, elsewhere: &str) {
    match block {
        Block::Heading { level, text: heading } => {
            let marks = "#".repeat(usize::from(*level).clamp(2, 3) + 1);
            text.push_str(&format!("{marks} {}\n", escaped(heading)));
        }
        Block::Paragraph { text: paragraph } => text.push_str(&format!("{}\n", line(paragraph))),
        Block::Notice { text: notice } => text.push_str(&format!("> **{}**\n", escaped(notice))),
        Block::List { items } => {
            for item in items {
                text.push_str(&format!("- {}\n", escaped(item)));
            }
        }
        Block::Table(table) => push_table(text, table),
        Block::Picture(picture) => push_picture(text, picture, elsewhere),
    }
}

fn push_table(text: &mut String, table: &Table) {
    text.push_str(&format!("{}\n\n", line(&table.caption)));
    let row = |cells: &mut dyn Iterator<Item = String>| {
        let cells: Vec<String> = cells.map(|cell| format!(" {} |", escaped(&cell))).collect();
        format!("|{}\n", cells.concat())
    };
    text.push_str(&row(&mut table.columns.iter().map(|column| column.title.clone())));
    let rules =
        table.columns.iter().map(|column| if column.is_numeric { " ---: |" } else { " --- |" });
    text.push_str(&format!("|{}\n", rules.collect::<String>()));
    for cells in &table.rows {
        text.push_str(&row(&mut cells.iter().cloned()));
    }
}

fn push_picture(text: &mut String, picture: &Picture, elsewhere: &str) {
    text.push_str(&format!("{}\n\n{} {elsewhere}\n", line(&picture.caption), line(&picture.alt)));
}

/// A picture that stands behind the text.
fn push_drawn(text: &mut String, picture: &Picture) {
    let Picture { number, caption, alt, .. } = picture;
    text.push_str(&format!("![{}][figure-{number}]\n\n{}\n", escaped(alt), line(caption)));
}

/// A line of its own: what would make it a list, a number of one, or a rule is escaped too.
fn line(text: &str) -> String {
    let text = escaped(text);
    let marker = text.trim_start_matches(|c: char| c.is_ascii_digit());
    let is_number = marker.len() < text.len() && marker.starts_with(['.', ')']);
    if is_number {
        let (digits, rest) = text.split_at(text.len() - marker.len());
        return format!("{digits}\\{rest}");
    }
    if text.starts_with(['-', '+', '=']) { format!("\\{text}") } else { text }
}

/// A text in which no character means more than itself, on one line.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_control() {
            escaped.push(' ');
            continue;
        }
        if MARKUP.contains(&c) {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_bring_no_markup_in() {
        let hostile = "a|b\n# c <script> [x](y) `z` \\ *w*";
        let text = escaped(hostile);
        assert!(!text.contains('\n'));
        for c in MARKUP {
            for (at, _) in text.match_indices(c).filter(|_| c != '\\') {
                assert_eq!(text.as_bytes()[at - 1], b'\\', "{c} in {text}");
            }
        }
        assert_eq!(line("- no list"), "\\- no list");
        assert_eq!(line("12. no list"), "12\\. no list");
    }
}
