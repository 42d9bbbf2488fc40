//! Runs the commands in the transcripts of README.md and `docs/guide/` and checks that they print
//! what the documents show.
//!
//! A transcript is a block of the language `console`. A line that begins with `$ impactlab` is a
//! command; a `\` at its end continues it on the next line. The lines up to the next command are
//! what it prints, first to the standard output, then to the standard error. The commands of one
//! document run one after the other in a folder of their own, in which `datasets`, `assets` and
//! `docs` are those of the repository.
//!
//! - A line `…` stands for any number of lines, and `…` within a line for the rest of that line. It
//!   marks what is left out or differs between runs.
//! - Several blanks count as one. A number with a decimal point may differ by 2 in its last digit
//!   or by 0.2 %, because processors with other vector instructions round differently.
//! - A PNG that a command writes must have the size of the picture of its name in
//!   `docs/guide/pictures`.
//!
//! `UPDATE_GUIDE=1 cargo test --release --test cli guide` replaces the output in the documents by
//! what the commands print, without omissions, wherever the two differ.

#![expect(clippy::unwrap_used, reason = "a helper of a test may fail it like the test itself")]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::program::program;

/// Text that stands for parts that are left out or may differ.
const ANYTHING: &str = "…";

/// A command in a document, with the output that the document shows.
#[derive(Debug, PartialEq)]
struct Transcript {
    /// Number of the line of the command, from 1.
    line: usize,
    /// Number of lines over which the command extends.
    n_lines: usize,
    args: Vec<String>,
    printed: Vec<String>,
}

/// Part of a line: a number or another character.
#[derive(Debug, PartialEq)]
enum Token {
    Number { value: f64, n_decimals: usize },
    Other(char),
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Splits a command line into words. Blanks in double quotes do not separate words.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut word, mut is_quoted) = (Vec::new(), String::new(), false);
    for c in command.chars() {
        match c {
            '"' => is_quoted = !is_quoted,
            c if c.is_whitespace() && !is_quoted => words.push(std::mem::take(&mut word)),
            c => word.push(c),
        }
    }
    words.push(word);
    words.retain(|word| !word.is_empty());
    words
}

fn transcripts(text: &str) -> Vec<Transcript> {
    let mut found: Vec<Transcript> = Vec::new();
    let (mut is_console, mut is_continued) = (false, false);
    for (idx, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            is_console = line.trim() == "```console";
            continue;
        }
        if !is_console {
            continue;
        }
        let part = line.trim_end_matches('\\');
        let command = line.strip_prefix("$ ").map(|_| &part[2..]);
        match (command, found.last_mut()) {
            (Some(command), _) => {
                let mut args = words(command);
                assert_eq!(args.remove(0), "impactlab", "line {}: {line}", idx + 1);
                let (line, printed) = (idx + 1, Vec::new());
                found.push(Transcript { line, n_lines: 1, args, printed });
            }
            (None, Some(last)) if is_continued => {
                last.args.extend(words(part));
                last.n_lines += 1;
            }
            (None, Some(last)) => last.printed.push(line.to_owned()),
            (None, None) => panic!("line {}: output without a command: {line}", idx + 1),
        }
        is_continued = (command.is_some() || is_continued) && line.ends_with('\\');
    }
    found
}

fn tokens(line: &str) -> Vec<Token> {
    let chars: Vec<char> = line.split_whitespace().collect::<Vec<_>>().join(" ").chars().collect();
    let (mut tokens, mut at) = (Vec::new(), 0);
    while let Some(&c) = chars.get(at) {
        let n_digits =
            |from: usize| chars[from..].iter().take_while(|c| c.is_ascii_digit()).count();
        let n_whole = n_digits(at);
        if n_whole == 0 {
            tokens.push(Token::Other(c));
            at += 1;
            continue;
        }
        let is_decimal = chars.get(at + n_whole) == Some(&'.');
        let n_decimals = if is_decimal { n_digits(at + n_whole + 1) } else { 0 };
        let end = at + n_whole + if n_decimals > 0 { 1 + n_decimals } else { 0 };
        let value = chars[at..end].iter().collect::<String>().parse().unwrap();
        tokens.push(Token::Number { value, n_decimals });
        at = end;
    }
    tokens
}

fn is_same(expected: &Token, got: &Token) -> bool {
    match (expected, got) {
        (Token::Number { value: a, n_decimals: n }, Token::Number { value: b, n_decimals: m }) => {
            let tolerance = match n {
                0 => 0.0,
                n => (2.1 * 0.1_f64.powi(i32::try_from(*n).unwrap())).max(2e-3 * a.abs()),
            };
            n == m && (a - b).abs() <= tolerance
        }
        _ => expected == got,
    }
}

fn line_matches(expected: &str, got: &str) -> bool {
    let (expected, is_open) = match expected.split_once(ANYTHING) {
        Some((before, _)) => (before, true),
        None => (expected, false),
    };
    let (expected, got) = (tokens(expected.trim_end()), tokens(got));
    (expected.len() == got.len() || is_open && expected.len() <= got.len())
        && expected.iter().zip(&got).all(|(expected, got)| is_same(expected, got))
}

fn lines_match(expected: &[String], got: &[String]) -> bool {
    match (expected.split_first(), got.split_first()) {
        (None, None) => true,
        (Some((first, rest)), _) if first.trim() == ANYTHING => {
            (0..=got.len()).any(|n_skipped| lines_match(rest, &got[n_skipped..]))
        }
        (Some((first, rest)), Some((line, others))) => {
            line_matches(first, line) && lines_match(rest, others)
        }
        _ => false,
    }
}

/// Returns the bytes of width and height in the header of a PNG file.
fn picture_size(path: &Path) -> Vec<u8> {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(bytes.starts_with(b"\x89PNG"), "{}", path.display());
    bytes[16..24].to_vec()
}

/// Runs the command and returns its output.
fn run(transcript: &Transcript, folder: &Path) -> Vec<String> {
    let mut command = program();
    command.current_dir(folder).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let output = command.args(&transcript.args).output().unwrap();
    let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    let pictures = transcript.args.iter().filter(|arg| arg.ends_with(".png"));
    for picture in pictures {
        let shipped = root().join("docs/guide/pictures").join(picture);
        assert_eq!(picture_size(&folder.join(picture)), picture_size(&shipped), "{picture}");
    }
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    while lines.last().is_some_and(String::is_empty) {
        lines.pop();
    }
    lines
}

fn check(document: &str) {
    let path = root().join(document);
    let text = fs::read_to_string(&path).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let folder = TempDir::new().unwrap();
    for name in ["datasets", "assets", "docs"] {
        symlink(root().join(name), folder.path().join(name)).unwrap();
    }
    let is_updating = std::env::var_os("UPDATE_GUIDE").is_some();
    let mut differences = Vec::new();
    for transcript in &transcripts(&text) {
        let got = run(transcript, folder.path());
        let mut expected = transcript.printed.clone();
        while expected.last().is_some_and(|line| line.trim().is_empty()) {
            expected.pop();
        }
        if !lines_match(&expected, &got) {
            let start = transcript.line - 1 + transcript.n_lines;
            differences.push((start..start + expected.len(), got));
        }
    }
    let message: Vec<String> = differences
        .iter()
        .map(|(at, got)| format!("{document}:{}: this is printed:\n{}", at.start, got.join("\n")))
        .collect();
    for (at, got) in differences.into_iter().rev() {
        lines.splice(at, got);
    }
    if is_updating && !message.is_empty() {
        fs::write(&path, lines.join("\n") + "\n").unwrap();
    }
    assert!(message.is_empty(), "{}", message.join("\n\n"));
}

#[test]
fn the_readme_says_what_is_printed() {
    check("README.md");
}

#[test]
fn the_guide_to_the_command_line_says_what_is_printed() {
    check("docs/guide/command-line.md");
}

#[test]
fn the_rest_of_the_guide_says_what_is_printed() {
    for entry in fs::read_dir(root().join("docs/guide")).unwrap() {
        let name = PathBuf::from(entry.unwrap().file_name());
        if name.extension().is_some_and(|end| end == "md") && name != Path::new("command-line.md") {
            check(Path::new("docs/guide").join(name).to_str().unwrap());
        }
    }
}

#[test]
fn the_readme_is_short_and_every_link_leads_to_a_file() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    assert!(readme.chars().count() <= 8000, "{} characters", readme.chars().count());
    let mut documents = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    let guide = fs::read_dir(root().join("docs/guide")).unwrap();
    documents.extend(guide.map(|entry| entry.unwrap().path()));
    for document in documents.iter().filter(|path| path.extension().is_some_and(|e| e == "md")) {
        let text = fs::read_to_string(document).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or_default();
            if !file.is_empty() && !link.contains("://") {
                let target = document.parent().unwrap().join(file);
                assert!(target.exists(), "{}: no {link}", document.display());
            }
        }
    }
}

#[test]
fn every_file_that_contributing_names_is_there() {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    let folders = ["src/", "tests/", "docs/", "assets/", "examples/", ".ci/"];
    let named = text.split('`').skip(1).step_by(2);
    let mut n_files = 0;
    for path in named.filter(|name| folders.iter().any(|folder| name.starts_with(folder))) {
        assert!(root().join(path).exists(), "no {path}");
        n_files += 1;
    }
    assert!(n_files > 10, "{n_files}");
}

#[test]
fn transcripts_are_found_and_compared() {
    let text = "\
text
```console
$ impactlab check \\
    \"a b\" --all
one  1.500
…
last 3 …
```
";
    let found = transcripts(text);
    let args = ["check", "a b", "--all"].map(str::to_owned).to_vec();
    let printed: Vec<String> = ["one  1.500", "…", "last 3 …"].map(str::to_owned).to_vec();
    assert_eq!(found, [Transcript { line: 3, n_lines: 2, args, printed: printed.clone() }]);
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    for same in ["one 1.501\nlast 3 x", "one 1.500\ntwo\nthree\nlast 3"] {
        assert!(lines_match(&printed, &lines(same)), "{same}");
    }
    for other in ["one 1.510\nlast 3", "one 1.50\nlast 3", "one 1.500\nlast 4", "one 1.500", ""] {
        assert!(!lines_match(&printed, &lines(other)), "{other}");
    }
}
