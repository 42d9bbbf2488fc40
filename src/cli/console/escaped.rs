//! Characters that act on a terminal instead of being shown: names in files and names of files may
//! contain them. They are printed as JSON writes them, `\u001b`, so that JSON stays JSON with the
//! same meaning.

use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

/// A writer that escapes these characters in all text, except for line ends and tabs.
pub(in crate::cli) struct Escaped<W>(pub W);

impl<W: Write> Write for Escaped<W> {
    /// Text must not be cut within a character, which formatted output never does.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for chunk in bytes.utf8_chunks() {
            let text = escaped(chunk.valid(), |c| c != '\n' && c != '\t');
            self.0.write_all(text.as_bytes())?;
            self.0.write_all(chunk.invalid())?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// A text that stays within its line: line ends and tabs are escaped too.
pub(in crate::cli) fn within_line(text: &str) -> Cow<'_, str> {
    escaped(text, |_| true)
}

/// A path as it is printed, within a line.
pub(in crate::cli) fn shown_path(path: &Path) -> String {
    within_line(&path.to_string_lossy()).into_owned()
}

fn escaped(text: &str, also: impl Fn(char) -> bool) -> Cow<'_, str> {
    let is_hidden = |c: char| acts_on_terminal(c) && also(c);
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let write = |mut all: String, c: char| {
        if is_hidden(c) {
            all.push_str(&format!("\\u{:04x}", u32::from(c)));
        } else {
            all.push(c);
        }
        all
    };
    Cow::Owned(text.chars().fold(String::with_capacity(text.len()), write))
}

/// Whether a character moves the cursor, changes colours, ends the line or turns the direction of
/// writing: control characters (C0, C1, DEL), the marks, embeddings, overrides and isolates of
/// bidirectional text, and the separators of lines and paragraphs.
fn acts_on_terminal(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &str) -> String {
        let mut out = Escaped(Vec::new());
        write!(out, "{text}").unwrap();
        String::from_utf8(out.0).unwrap()
    }

    #[test]
    fn nothing_acts_on_the_terminal_and_text_stays_as_it_is() {
        for (text, shown) in [
            ("Fx [kN], θ = 3°\n\tµ — “a”", "Fx [kN], θ = 3°\n\tµ — “a”"),
            ("\x1b[2Jx", "\\u001b[2Jx"),
            ("a\u{202e}b\u{2069}", "a\\u202eb\\u2069"),
            ("\u{9b}31m\x7f\r", "\\u009b31m\\u007f\\u000d"),
        ] {
            assert_eq!(printed(text), shown);
        }
        assert_eq!(within_line("a\nb\tc"), "a\\u000ab\\u0009c");
        let value = serde_json::json!({ "name": "\u{202e}\x1b\u{9b}" });
        let text = printed(&serde_json::to_string_pretty(&value).unwrap());
        assert!(text.is_ascii(), "{text:?}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), value);
    }
}
