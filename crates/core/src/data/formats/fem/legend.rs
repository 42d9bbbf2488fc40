//! The legend of a text file: which number belongs to which title.
//!
//! ```text
//! {BEGIN LEGEND}
//!  Entity #        Title
//!         3     bumper to door
//! {END LEGEND}
//! ```
//!
//! Older files have `legend` and `end of legend`.

use std::collections::BTreeMap;

/// Characters of a title that are kept.
const SHOWN_CHARS: usize = 40;

/// Titles by number.
#[derive(Debug, Default)]
pub(super) struct Legend {
    is_open: bool,
    titles: BTreeMap<i64, String>,
}

impl Legend {
    /// Takes a line if it belongs to a legend.
    ///
    /// - returns whether it does.
    pub(super) fn takes(&mut self, line: &str) -> bool {
        let line = line.trim();
        let is = |text: &str| line.eq_ignore_ascii_case(text);
        match self.is_open {
            false => {
                self.is_open = is("{BEGIN LEGEND}") || is("legend");
                self.is_open
            }
            true => {
                self.is_open = !(is("{END LEGEND}") || is("end of legend"));
                if let Some((number, title)) = line.split_once(char::is_whitespace)
                    && let Ok(number) = number.parse()
                {
                    self.titles.insert(number, plain_title(title));
                }
                true
            }
        }
    }

    /// The title of a number; empty if it has none.
    pub(super) fn title(&self, number: i64) -> String {
        self.titles.get(&number).cloned().unwrap_or_default()
    }
}

/// A title as a part of a map can hold it, without the signs that divide one.
pub(super) fn plain_title(title: &str) -> String {
    let is_plain = |c: char| !c.is_control() && !matches!(c, ',' | '=' | '+' | '"');
    let plain: String = title.chars().map(|c| if is_plain(c) { c } else { ' ' }).collect();
    let words: Vec<&str> = plain.split_whitespace().collect();
    words.join(" ").chars().take(SHOWN_CHARS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_of_legend_are_read() {
        for [begin, end] in [["{BEGIN LEGEND}", "{END LEGEND}"], [" legend", " end of legend"]] {
            let mut legend = Legend::default();
            assert!(!legend.takes("title of the run"));
            for line in
                [begin, " Entity #        Title", "        3     bumper, left \t to door", end]
            {
                assert!(legend.takes(line), "{line}");
            }
            assert!(!legend.takes(" master 3"));
            assert_eq!(
                (legend.title(3), legend.title(4)),
                ("bumper left to door".into(), "".into())
            );
        }
    }
}
