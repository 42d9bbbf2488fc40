//! Breaks text into lines of a width.

use crate::report::write::pdf::fonts::Fonts;

/// Letters after which a word that is too long is broken rather than elsewhere.
const SOFT_BREAKS: [char; 6] = ['/', '-', '_', ',', ';', '\\'];

/// Symbols that stay on one line with the number in front of them.
const SYMBOLS: [&str; 27] = [
    "%", "m", "mm", "cm", "m²", "s", "ms", "km/h", "m/s", "deg", "deg/s", "°/s", "kN", "N", "kJ",
    "J", "kg", "rad", "ft", "ft²", "mph", "lb", "lbf", "lbf·s", "min", "kW", "V",
];

/// Whether a word is the symbol of a unit, whatever marks follow it.
pub(super) fn is_symbol(word: &str) -> bool {
    SYMBOLS.contains(&word.trim_end_matches([',', '.', ';', ':', ')']))
}

/// The words of a text. A number and its unit are one word.
pub(super) fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let is_behind_number = |last: &String| match last.rsplit_once(' ') {
            Some((_, symbol)) => is_symbol(symbol) && symbol.ends_with(char::is_alphanumeric),
            None => last.ends_with(|c: char| c.is_ascii_digit() || c == ')'),
        };
        match words.last_mut().filter(|last| is_symbol(word) && is_behind_number(last)) {
            Some(last) => {
                last.push(' ');
                last.push_str(word);
            }
            None => words.push(word.to_owned()),
        }
    }
    words
}

/// Breaks a text into lines.
///
/// - `size_pt`: size of the font;
/// - `width_pt`: largest width of a line; a single letter may be wider.
pub(super) fn lines(text: &str, fonts: &Fonts, size_pt: f32, width_pt: f32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    let mut used_pt = 0.0;
    let space_pt = size_pt * fonts.width(" ");
    // A number that is wider with its unit than a line stands without it.
    let parts = |word: String| match size_pt * fonts.width(&word) <= width_pt {
        true => vec![word],
        false => word.split(' ').map(str::to_owned).collect(),
    };
    for word in words(text).into_iter().flat_map(parts) {
        for (idx, piece) in pieces(&word, fonts, size_pt, width_pt).into_iter().enumerate() {
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

/// How many lines words take.
///
/// - `words_pt`: their widths, none of which is wider than a line;
/// - `space_pt`: width of a space.
pub(super) fn n_lines(words_pt: &[f32], space_pt: f32, width_pt: f32) -> usize {
    let (mut n, mut used_pt) = (1, 0.0);
    for (idx, word_pt) in words_pt.iter().enumerate() {
        let gap_pt = if used_pt > 0.0 { space_pt } else { 0.0 };
        if idx > 0 && used_pt + gap_pt + word_pt > width_pt {
            n += 1;
            used_pt = *word_pt;
        } else {
            used_pt += gap_pt + word_pt;
        }
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;

    /// “84.0” stood at the end of a line and “%” at the beginning of the next one.
    #[test]
    fn a_number_is_not_parted_from_its_unit() {
        let text = "probability 84.0 % of 7.942 kN s (5.27; 0.70) m, s m";
        let expected =
            ["probability", "84.0 %", "of", "7.942 kN s", "(5.27;", "0.70) m,", "s", "m"];
        assert_eq!(words(text), expected);
        let fonts = Fonts::load().unwrap();
        let width_pt = 9.0 * fonts.width("probability 84.0");
        let [first, second] = &lines("probability 84.0 %", &fonts, 9.0, width_pt)[..] else {
            panic!("two lines")
        };
        assert_eq!([&**first, &**second], ["probability", "84.0 %"]);
    }

    #[test]
    fn words_are_counted_as_they_are_broken() {
        let fonts = Fonts::load().unwrap();
        let text = "a few words of 12 m that are broken somewhere in the middle of a line";
        let words_pt: Vec<f32> = words(text).iter().map(|word| 9.0 * fonts.width(word)).collect();
        for width_pt in [70.0, 100.0, 140.0, 500.0] {
            let n = n_lines(&words_pt, 9.0 * fonts.width(" "), width_pt);
            assert_eq!(n, lines(text, &fonts, 9.0, width_pt).len(), "{width_pt}");
        }
    }

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
