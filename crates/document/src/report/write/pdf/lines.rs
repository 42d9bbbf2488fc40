//! Breaks text into lines of a width.

use crate::report::write::pdf::fonts::Fonts;

/// Letters after which a word that is too long is broken rather than elsewhere.
const SOFT_BREAKS: [char; 6] = ['/', '-', '_', ',', ';', '\\'];

/// Breaks a text into lines.
///
/// - `size_pt`: size of the font;
/// - `width_pt`: largest width of a line; a single letter may be wider.
pub(super) fn lines(text: &str, fonts: &Fonts, size_pt: f32, width_pt: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    let mut used_pt = 0.0;
    let space_pt = size_pt * fonts.width(" ");
    for word in text.split_whitespace() {
        for (idx, piece) in pieces(word, fonts, size_pt, width_pt).into_iter().enumerate() {
            let piece_pt = size_pt * fonts.width(&piece);
            let is_joined = idx == 0 && !line.is_empty();
            let gap_pt = if is_joined { space_pt } else { 0.0 };
            if !line.is_empty() && (idx > 0 || used_pt + gap_pt + piece_pt > width_pt) {
                lines.push(std::mem::take(&mut line));
                used_pt = 0.0;
            }
            if !line.is_empty() {
                line.push(' ');
                used_pt += space_pt;
            }
            line.push_str(&piece);
            used_pt += piece_pt;
        }
    }
    if !line.is_empty() || lines.is_empty() {
        lines.push(line);
    }
    lines
}

/// A word, cut where it is wider than a line.
fn pieces(word: &str, fonts: &Fonts, size_pt: f32, width_pt: f32) -> Vec<String> {
    if size_pt * fonts.width(word) <= width_pt {
        return vec![word.to_owned()];
    }
    let mut pieces = Vec::new();
    let mut piece = String::new();
    let mut used_pt = 0.0;
    for letter in word.chars() {
        let letter_pt = size_pt * fonts.letter(letter).advance;
        if !piece.is_empty() && used_pt + letter_pt > width_pt {
            // A break behind the last soft place leaves at least half of the line.
            let soft = piece.char_indices().rfind(|(_, c)| SOFT_BREAKS.contains(c));
            let at = soft.map(|(at, c)| at + c.len_utf8()).filter(|at| 2 * at > piece.len());
            let rest = piece.split_off(at.unwrap_or(piece.len()));
            pieces.push(std::mem::replace(&mut piece, rest));
            used_pt = size_pt * fonts.width(&piece);
        }
        piece.push(letter);
        used_pt += letter_pt;
    }
    pieces.push(piece);
    pieces
}

/// Width of the widest word of a text, points.
pub(super) fn widest_word_pt(text: &str, fonts: &Fonts, size_pt: f32) -> f32 {
    let widths = text.split_whitespace().map(|word| size_pt * fonts.width(word));
    widths.fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_is_wider_than_asked_and_no_letter_is_lost() {
        let fonts = Fonts::load().unwrap();
        let long = "x".repeat(500);
        for text in [
            "a few words that are broken somewhere in the middle",
            &long,
            "a/b/c/ddddddddddddddddddddd/e",
            "",
        ] {
            for width_pt in [20.0, 60.0, 400.0] {
                let lines = lines(text, &fonts, 9.0, width_pt);
                for line in &lines {
                    assert!(9.0 * fonts.width(line) <= width_pt + 0.01, "{line} in {width_pt}");
                }
                let joined: String = lines.concat().split_whitespace().collect();
                assert_eq!(joined, text.split_whitespace().collect::<String>());
            }
        }
    }
}
