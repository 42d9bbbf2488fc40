//! The fonts of a report: those of the window, which come with the program.

use krilla::text::Font;
use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};

use crate::report::write::pdf::PdfError;

/// What stands for a letter that no font has.
pub(super) const REPLACEMENT: char = '\u{FFFD}';

/// A font with what the layout needs of it.
struct Face {
    font: Font,
    data: skrifa::FontRef<'static>,
    units_per_em: f32,
}

/// The fonts, the preferred one first.
pub(super) struct Fonts {
    faces: Vec<Face>,
}

/// A letter as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Letter {
    /// Number of its font.
    pub face: usize,
    /// Number of its glyph.
    pub glyph: u32,
    /// Width over the size of the font.
    pub advance: f32,
}

impl Fonts {
    /// The fonts of the program.
    pub fn load() -> Result<Self, PdfError> {
        let all = [
            ("Ubuntu Light", epaint_default_fonts::UBUNTU_LIGHT),
            ("Hack", epaint_default_fonts::HACK_REGULAR),
        ];
        let faces = all.into_iter().map(|(name, bytes)| {
            let data = skrifa::FontRef::new(bytes).ok();
            let font = Font::new(bytes.to_vec().into(), 0);
            let (data, font) = data.zip(font).ok_or(PdfError::Font { name })?;
            let units_per_em = font.units_per_em();
            Ok(Face { font, data, units_per_em })
        });
        Ok(Self { faces: faces.collect::<Result<_, PdfError>>()? })
    }

    /// A font by its number.
    pub fn font(&self, face: usize) -> Option<&Font> {
        self.faces.get(face).map(|face| &face.font)
    }

    /// The first font that has a letter, and its glyph there; of a letter that none has, what stands
    /// for it.
    pub fn letter(&self, letter: char) -> Letter {
        let found = self.find(letter).or_else(|| self.find(REPLACEMENT)).or_else(|| self.find('?'));
        found.unwrap_or(Letter { face: 0, glyph: 0, advance: 0.5 })
    }

    /// Width of a text over the size of the font.
    pub fn width(&self, text: &str) -> f32 {
        text.chars().map(|c| self.letter(c).advance).sum()
    }

    fn find(&self, letter: char) -> Option<Letter> {
        self.faces.iter().enumerate().find_map(|(idx, face)| {
            let glyph = face.data.charmap().map(letter).filter(|glyph| glyph.to_u32() != 0)?;
            let metrics = face.data.glyph_metrics(Size::unscaled(), LocationRef::default());
            let advance = metrics.advance_width(glyph)? / face.units_per_em;
            Some(Letter { face: idx, glyph: glyph.to_u32(), advance })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_of_both_languages_is_there() {
        let fonts = Fonts::load().unwrap();
        let letters = "ΔτμσχαβψωΩθφδÄÖÜäöüß²³±≤≥°·×−–—…“”„’‘«»é½→←↑↓∞≈µ§₀₁²½‰€√∑_[]{}|\\";
        for letter in letters.chars().chain(' '..='~') {
            assert!(fonts.find(letter).is_some(), "{letter:?} is in no font");
        }
        assert!(fonts.width("mm") > fonts.width("ii"));
    }
}
