//! Checks the layers of `src/`: a module refers only to modules of lower layers.
//!
//! The test searches for `crate::name` and `crate::{name, …}` outside comments. Links in comments
//! may refer to higher layers.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The layers from low to high. Modules of one layer do not refer to each other.
const LAYERS: &[&[&str]] = &[
    &["bibliography", "units", "error_chain"],
    &["ranges", "numerics", "jobs"],
    &["data"],
    &["vehicle"],
    &["collision", "site"],
    &["nn", "uncertainty", "compare"],
    &["learning"],
    &["force", "response"],
    &["reconstruct"],
    &["shipped"],
    &["analysis"],
    &["study"],
    &["case_file"],
    &["scene", "figure"],
    &["report", "exchange"],
    &["render"],
    &["cli", "app"],
];

/// Pairs of modules of one layer in which the first may refer to the second.
///
/// - The command line opens the window: `impactlab app`.
const NEIGHBOURS_THAT_MAY: &[(&str, &str)] = &[("cli", "app")];

/// A reference to a module that is not allowed.
#[derive(Debug, PartialEq)]
struct Violation {
    line: usize,
    names: String,
}

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&module))
}

fn may_name(module: &str, other: &str) -> bool {
    let lower = layer(other) < layer(module);
    // A name that is no module is an item of the crate root, such as a macro.
    layer(other).is_none()
        || lower
        || module == other
        || NEIGHBOURS_THAT_MAY.contains(&(module, other))
}

/// Returns the text without comments; lines keep their numbers. A `//` in a string is treated as a
/// comment, which hides no `use`.
fn code(text: &str) -> String {
    let code_of = |line: &str| line.split("//").next().unwrap_or_default().to_owned() + "\n";
    text.lines().map(code_of).collect()
}

/// Returns the names that directly follow `crate::`, with their line numbers.
fn names_below_the_root(code: &str) -> Vec<(usize, String)> {
    const ROOT: &str = "crate::";
    let is_start = |at: usize| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_');
    let mut names = Vec::new();
    for (at, _) in code.match_indices(ROOT).filter(|&(at, _)| is_start(at)) {
        let rest = &code[at + ROOT.len()..];
        let line = code[..at].matches('\n').count() + 1;
        let found = match rest.strip_prefix('{') {
            Some(group) => names_in_group(group),
            None => vec![identifier(rest)],
        };
        names.extend(found.into_iter().map(|name| (line, name.to_owned())));
    }
    names
}

/// Returns the first names of the paths in a group, up to its closing brace.
fn names_in_group(group: &str) -> Vec<&str> {
    let (mut depth, mut start, mut names) = (0, 0, Vec::new());
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            ',' | '}' if depth == 0 => {
                names.push(identifier(&group[start..at]));
                start = at + 1;
            }
            _ => {}
        }
        if c == '}' {
            depth -= 1;
        }
        if depth < 0 {
            break;
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

fn identifier(text: &str) -> &str {
    let text = text.trim_start();
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    &text[..end]
}

fn violations(module: &str, text: &str) -> Vec<Violation> {
    let names = names_below_the_root(&code(text)).into_iter();
    names
        .filter(|(_, name)| !may_name(module, name))
        .map(|(line, names)| Violation { line, names })
        .collect()
}

/// Returns the Rust files of a folder and of the folders in it.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder of sources");
    entries
        .map(|entry| entry.expect("an entry of a folder").path())
        .flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect()
}

/// Returns the module of a file below `src`: its folder, or the name of the file.
fn module_of(file: &Path, src: &Path) -> String {
    let path = file.strip_prefix(src).expect("a file below src").with_extension("");
    let first = path.components().next().expect("a name").as_os_str();
    first.to_string_lossy().into_owned()
}

#[test]
fn modules_name_only_lower_layers() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut found, mut modules) = (Vec::new(), BTreeSet::new());
    for file in rust_files(&src) {
        let module = module_of(&file, &src);
        if module == "lib" || module == "main" {
            continue;
        }
        assert!(layer(&module).is_some(), "{module} is in no layer; add it to LAYERS");
        let text = fs::read_to_string(&file).unwrap();
        for Violation { line, names } in violations(&module, &text) {
            found.push(format!("{}:{line}: {module} names {names}", file.display()));
        }
        modules.insert(module);
    }
    assert!(found.is_empty(), "named against the layers:\n{}", found.join("\n"));
    let listed: BTreeSet<String> = LAYERS.concat().into_iter().map(str::to_owned).collect();
    assert_eq!(modules, listed, "LAYERS lists other modules than src/ has");
}

#[test]
fn the_scanner_finds_what_goes_up() {
    let text = "\
//! Doc links may point up: [`App`](crate::app::App).
use crate::units::Quantity;
use crate::{
    app::{App, Command},
    data::{Channel, Dataset},
    figure,
};
// crate::render
fn draw(_: &crate::render::Canvas) { mycrate::app() }
macro_rules! own { () => { $crate::cli::run() } }
";
    let found = violations("data", text);
    let violation = |line, names: &str| Violation { line, names: names.to_owned() };
    let expected = [(3, "app"), (3, "figure"), (9, "render"), (10, "cli")];
    assert_eq!(found, expected.map(|(line, names)| violation(line, names)));
}

#[test]
fn neighbours_are_named_only_where_allowed() {
    let opens_the_window = "crate::app::run(args.paths, renderer)?;";
    assert_eq!(violations("cli", opens_the_window), []);
    assert_eq!(violations("numerics", "use crate::jobs::Job;").len(), 1);
    assert_eq!(violations("app", "use crate::cli::run;").len(), 1);
    assert_eq!(violations("app", "use crate::app::State;"), []);
}
