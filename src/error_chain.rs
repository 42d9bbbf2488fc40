//! An error with its causes, for a person.

use std::error::Error;

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
    text.split_whitespace().collect::<Vec<_>>().join(" ")
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
}
