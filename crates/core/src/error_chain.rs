//! An error with its causes, for a person.

use std::error::Error;

/// Longest message of one error in a chain. The parsers of TOML and JSON repeat keys and values of
/// the file in whole, however long they are.
const MAX_MESSAGE_BYTES: usize = 1000;

/// The error and its causes in one line: `what: why: why …`.
pub fn error_chain(error: &dyn Error) -> String {
    let mut text = one_line(&error.to_string());
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&one_line(&error.to_string()));
        cause = error.source();
    }
    text
}

fn one_line(text: &str) -> String {
    let mut line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.len() > MAX_MESSAGE_BYTES {
        line.truncate(line.floor_char_boundary(MAX_MESSAGE_BYTES));
        line.push('…');
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, thiserror::Error)]
    #[error("file a\nb cannot be used")]
    struct Outer(#[source] std::fmt::Error);

    #[test]
    fn every_cause_stands_once_in_one_line() {
        let text = error_chain(&Outer(std::fmt::Error));
        assert_eq!(text, format!("file a b cannot be used: {}", std::fmt::Error));
    }

    #[test]
    fn a_parser_that_repeats_a_long_key_is_cut_short() {
        #[derive(Debug, thiserror::Error)]
        #[error("unknown field {0}")]
        struct Unknown(String);
        let line = error_chain(&Unknown("é".repeat(50_000)));
        assert!(line.starts_with("unknown field éé") && line.ends_with("é…"), "{line:.40}");
        assert!(line.len() <= MAX_MESSAGE_BYTES + '…'.len_utf8(), "{} bytes", line.len());
    }
}
