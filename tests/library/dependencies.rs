//! The crates that the program is made of: what their licences ask for, and which compiler they
//! need.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;
use spdx::{Expression, Licensee, ParseMode};

/// Licences in the order in which one is chosen where a crate offers several.
const PREFERRED: &[&str] =
    &["MIT", "Zlib", "ISC", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "Unicode-3.0", "Apache-2.0"];

/// Licences whose texts lie beside the fonts.
const OF_FONTS: &[&str] = &["OFL-1.1", "Ubuntu-font-1.0"];

/// The crate that holds the fonts of the window.
const FONTS: &str = "epaint_default_fonts";

const INTRODUCTION: &str = "\
Notices of third parties

impactlab itself is licensed under MIT OR Apache-2.0. It contains the Rust standard library
(MIT OR Apache-2.0, Copyright The Rust Project contributors), and the crates and fonts that are listed
here. Each crate stands with the licence under which it is used and its notices of copyright; the
text of each licence follows once, below the list. The list is that of a program for Linux.
";

/// What `cargo metadata` says of the packages and how they depend on each other.
#[derive(Deserialize)]
struct Metadata {
    workspace_members: Vec<String>,
    packages: Vec<Package>,
    resolve: Resolve,
}

#[derive(Deserialize)]
struct Package {
    id: String,
    name: String,
    version: String,
    license: Option<String>,
    authors: Vec<String>,
    manifest_path: PathBuf,
    rust_version: Option<String>,
    targets: Vec<Target>,
}

#[derive(Deserialize)]
struct Target {
    kind: Vec<String>,
}

#[derive(Deserialize)]
struct Resolve {
    root: String,
    nodes: Vec<Node>,
}

#[derive(Deserialize)]
struct Node {
    id: String,
    deps: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    pkg: String,
    dep_kinds: Vec<DependencyKind>,
}

#[derive(Deserialize)]
struct DependencyKind {
    /// `None` for a crate that is linked in, else `build` or `dev`.
    kind: Option<String>,
}

fn metadata() -> Metadata {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--locked", "--format-version", "1"])
        .args(["--filter-platform", "x86_64-unknown-linux-gnu"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo can be run");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("cargo metadata prints its own format")
}

impl Metadata {
    /// The crates whose code is part of the program, by name and version.
    fn linked(&self) -> Vec<&Package> {
        let packages: BTreeMap<&str, &Package> =
            self.packages.iter().map(|package| (package.id.as_str(), package)).collect();
        let nodes: BTreeMap<&str, &Node> =
            self.resolve.nodes.iter().map(|node| (node.id.as_str(), node)).collect();
        let (mut seen, mut open) = (BTreeSet::new(), vec![self.resolve.root.as_str()]);
        while let Some(id) = open.pop() {
            let runs_in_compiler = packages[id].is_macro();
            if runs_in_compiler || !seen.insert(id) {
                continue;
            }
            let linked = |dependency: &&Dependency| {
                dependency.dep_kinds.iter().any(|dependency| dependency.kind.is_none())
            };
            let dependencies = nodes[id].deps.iter().filter(linked);
            open.extend(dependencies.map(|dependency| dependency.pkg.as_str()));
        }
        let mut linked: Vec<&Package> = seen.into_iter().map(|id| packages[id]).collect();
        // Not the crates of this workspace, whose licence is that of the program.
        linked.retain(|package| !self.workspace_members.contains(&package.id));
        linked.sort_by_key(|package| (&package.name, &package.version));
        linked
    }
}

impl Package {
    fn is_macro(&self) -> bool {
        self.targets.iter().any(|target| target.kind.iter().any(|kind| kind == "proc-macro"))
    }

    fn folder(&self) -> &Path {
        self.manifest_path.parent().expect("a manifest lies in a folder")
    }

    /// The licences that apply, of those that it offers.
    fn licences(&self) -> Vec<String> {
        let offered = self.license.as_deref().expect("a licence; `cargo deny` checks it");
        let offered = Expression::parse_mode(offered, ParseMode::LAX).expect("a known licence");
        let known = PREFERRED
            .iter()
            .chain(OF_FONTS)
            .map(|id| Licensee::parse(id).expect("a known licence"));
        let known: Vec<Licensee> = known.collect();
        let needed = offered.minimized_requirements(&known);
        let needed = needed.unwrap_or_else(|error| panic!("{}: {error}", self.name));
        needed.iter().map(ToString::to_string).collect()
    }

    /// The lines of its files, and of the sources of others that it compiles, that name who has the
    /// copyright, else its authors.
    fn copyrights(&self) -> Vec<String> {
        let starts = ["license", "licence", "copying", "copyright", "notice"];
        let own = fs::read_dir(self.folder()).expect("the sources of a crate that was built");
        let others = fs::read_dir(self.folder().join("upstream")).into_iter().flatten();
        let mut files: Vec<PathBuf> = own
            .chain(others)
            .map(|entry| entry.expect("a file of the crate").path())
            .filter(|path| {
                let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
                path.is_file() && starts.iter().any(|start| name.starts_with(start))
            })
            .collect();
        files.sort();
        let mut lines = Vec::new();
        for file in files {
            let text = fs::read(&file).expect("the file of a licence can be read");
            for line in String::from_utf8_lossy(&text).lines() {
                let line = line.trim_matches(|c: char| c.is_whitespace() || "*/#".contains(c));
                let template =
                    ["[yyyy]", "{yyyy}", "<year>", "icense", "notice", "owner", "holder"];
                let names = line.starts_with("Copyright ") || line.starts_with('©');
                let is_known = lines.iter().any(|known| known == line);
                if names && !is_known && !template.iter().any(|part| line.contains(part)) {
                    lines.push(line.to_owned());
                }
            }
        }
        if lines.is_empty() && !self.authors.is_empty() {
            lines.push(format!("by {}", self.authors.join(", ")));
        }
        lines
    }
}

/// The notices of everything that is linked in.
fn notices() -> String {
    let metadata = metadata();
    let mut text = format!("{INTRODUCTION}\n== Crates ==\n\n");
    let mut texts = BTreeSet::new();
    let mut fonts = None;
    for package in metadata.linked() {
        let licences = package.licences();
        let (name, version) = (&package.name, &package.version);
        writeln!(text, "{name} {version}: {}", licences.join(" and ")).expect("room");
        for line in package.copyrights() {
            writeln!(text, "    {line}").expect("room");
        }
        texts.extend(licences);
        fonts = fonts.or_else(|| (package.name == FONTS).then(|| package.folder().join("fonts")));
    }
    for licence in texts.iter().filter(|licence| !OF_FONTS.contains(&licence.as_str())) {
        let id = spdx::license_id(licence).expect("a known licence");
        writeln!(text, "\n== {} ==\n\n{}", id.full_name, id.text().trim()).expect("room");
    }
    add_fonts(&mut text, &fonts.expect("the crate of the fonts is linked in"));
    text
}

/// The names of the fonts, and every text that lies beside them.
fn add_fonts(text: &mut String, folder: &Path) {
    let mut files: Vec<PathBuf> = fs::read_dir(folder)
        .expect("the folder of the fonts")
        .map(|entry| entry.expect("a file beside the fonts").path())
        .collect();
    files.sort();
    let ends = |path: &&PathBuf, end: &str| path.extension().is_some_and(|found| found == end);
    let name = |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let fonts: Vec<String> = files.iter().filter(|path| ends(path, "ttf")).map(name).collect();
    writeln!(text, "\n== Fonts of the window ==\n\n{}", fonts.join("\n")).expect("room");
    for file in files.iter().filter(|path| ends(path, "txt")) {
        let licence = fs::read_to_string(file).expect("the licence of a font");
        writeln!(text, "\n== Fonts: {} ==\n\n{}", name(file), licence.trim()).expect("room");
    }
}

#[test]
fn the_notices_name_every_crate_and_font_of_the_program() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/licences.txt");
    let expected = notices();
    if std::env::var_os("UPDATE_LICENCES").is_some() {
        fs::write(&path, &expected).expect("the notices can be written");
    }
    let stored = fs::read_to_string(&path).unwrap_or_default();
    let differs =
        expected.lines().zip(stored.lines()).find(|(expected, stored)| expected != stored);
    assert!(
        stored == expected,
        "{} is out of date, first at {differs:?}; \
         UPDATE_LICENCES=1 ./test --test library dependencies writes it",
        path.display()
    );
    for part in ["Ubuntu-Light.ttf", "SIL OPEN FONT LICENSE Version 1.1", "UBUNTU FONT LICENCE"] {
        assert!(stored.contains(part), "{part}");
    }
}

/// Major, minor and patch of a version of the compiler.
fn numbers(version: &str) -> Vec<u64> {
    let number = |part: &str| part.parse().unwrap_or_else(|_| panic!("version {version:?}"));
    version.split('.').map(number).chain([0, 0]).take(3).collect()
}

#[test]
fn no_crate_needs_a_newer_compiler_than_the_package_says() {
    let metadata = metadata();
    let ours = numbers(env!("CARGO_PKG_RUST_VERSION"));
    let is_newer = |package: &&Package| {
        package.rust_version.as_deref().is_some_and(|version| numbers(version) > ours)
    };
    let newer: Vec<String> = metadata
        .packages
        .iter()
        .filter(is_newer)
        .map(|package| format!("{} {}: {:?}", package.name, package.version, package.rust_version))
        .collect();
    assert!(newer.is_empty(), "rust-version is {}, but {newer:?}", env!("CARGO_PKG_RUST_VERSION"));
}
