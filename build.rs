//! Tells the program and the Python package which source they were compiled from, so that two builds of
//! the same version can be told apart where they answer.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use sha2::{Digest, Sha256};

/// What the program is compiled from, relative to the folder of the workspace.
const SOURCES: [&str; 5] = ["Cargo.toml", "Cargo.lock", "assets", "crates", "src"];

/// Number of characters of the digest that stand in a version: enough that no two builds share them.
const N_CHARACTERS: usize = 12;

fn main() -> io::Result<()> {
    let package = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    // The Python package lies in a folder below and is of the same source.
    let locked = package.ancestors().find(|folder| folder.join("Cargo.lock").is_file());
    let root = locked.unwrap_or(&package);
    let mut files = Vec::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed={}", root.join(source).display());
        add_files(&root.join(source), &mut files)?;
    }
    files.sort();
    let mut digest = Sha256::new();
    for file in &files {
        let name = file.strip_prefix(root).unwrap_or(file).to_string_lossy().replace('\\', "/");
        let content = fs::read(file)?;
        digest.update(format!("{name}\0{}\0", content.len()));
        digest.update(content);
    }
    let digits: String = digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    println!("cargo::rustc-env=IMPACTLAB_SOURCE={}", &digits[..N_CHARACTERS]);
    Ok(())
}

/// Adds a file, or all files of a folder. What is not there is left out: a packaged crate need not have
/// a lock file.
fn add_files(path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if path.is_file() {
        files.push(path.to_owned());
    } else if path.is_dir() {
        for entry in fs::read_dir(path)? {
            add_files(&entry?.path(), files)?;
        }
    }
    Ok(())
}
