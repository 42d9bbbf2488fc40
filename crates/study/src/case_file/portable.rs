//! Names of files that every system can hold, for what is unpacked on another one.

use std::path::Path;

/// The longest name, bytes: file systems have 255, and an ending or the mark of a temporary file may be added.
const MAX_BYTES: usize = 200;

/// A name as every system can hold it: without the characters, the ends and the names that Windows refuses, and
/// not too long. A usual name stays as it is.
///
/// Source: Microsoft, “Naming Files, Paths, and Namespaces”.
pub(super) fn portable_name(name: &str) -> String {
    let is_refused = |c: char| c.is_control() || "<>:\"/\\|?*".contains(c);
    let plain: String = name.chars().map(|c| if is_refused(c) { '_' } else { c }).collect();
    let plain = plain.trim_end_matches(['.', ' ']);
    let stem = plain.split('.').next().unwrap_or_default();
    let named = match plain.is_empty() || is_device(stem) {
        true => format!("_{plain}"),
        false => plain.to_owned(),
    };
    if named.len() <= MAX_BYTES {
        return named;
    }
    let ending = Path::new(&named).extension().unwrap_or_default().to_string_lossy();
    let n_kept = MAX_BYTES.saturating_sub(ending.len() + 1);
    // An ending that leaves no room says nothing of what a file holds.
    if ending.is_empty() || n_kept == 0 {
        return cut(&named, MAX_BYTES).to_owned();
    }
    format!("{}.{ending}", cut(&named, n_kept))
}

/// The beginning of a name, which ends as Windows has it.
fn cut(name: &str, n_bytes: usize) -> &str {
    let (beginning, _) = name.split_at(name.floor_char_boundary(n_bytes));
    beginning.trim_end_matches(['.', ' '])
}

/// Whether Windows takes a name for that of a device, with whatever ending.
fn is_device(stem: &str) -> bool {
    let name = stem.trim_end().to_ascii_uppercase();
    let port = name.strip_prefix("COM").or_else(|| name.strip_prefix("LPT"));
    matches!(&*name, "CON" | "PRN" | "AUX" | "NUL")
        || port.is_some_and(|number| matches!(number.as_bytes(), [b'0'..=b'9']))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_can_be_held_by_every_system_and_a_usual_one_stays() {
        for usual in
            ["force.csv", "Fahrt 3, Kanal 2.csv", "Zoë.mf4", ".hidden", "console.csv", "COM10"]
        {
            assert_eq!(portable_name(usual), usual);
        }
        for (name, expected) in [
            ("run 12:30.csv", "run 12_30.csv"),
            ("C:\\Users\\ann\\run.csv", "C__Users_ann_run.csv"),
            ("a\tb?.csv", "a_b_.csv"),
            ("force. ", "force"),
            ("con.csv", "_con.csv"),
            ("LPT1", "_LPT1"),
            ("NUL.tar.gz", "_NUL.tar.gz"),
            ("...", "_"),
            ("", "_"),
        ] {
            assert_eq!(portable_name(name), expected, "{name:?}");
        }
    }

    #[test]
    fn a_long_name_keeps_its_ending() {
        let long = "ü".repeat(120);
        let name = portable_name(&format!("{long}.csv"));
        assert!(name.len() <= MAX_BYTES && name.ends_with("ü.csv"), "{name}");
        assert_eq!(portable_name(&long).len(), MAX_BYTES);
        let of_ending = portable_name(&format!("a.{long}"));
        assert!(of_ending.len() <= MAX_BYTES && of_ending.starts_with("a.ü"), "{of_ending}");
    }
}
