//! Recognises files that are not read, by their first bytes or lines, so that the user learns what
//! they are and what to do instead of being told of a control character or a number of fields.

use std::path::Path;

use crate::data::DataError;

/// Number of lines that are examined for the marks of a solver's output.
const EXAMINED_LINES: usize = 60;

/// What to do with a program that measures or simulates.
const EXPORT: &str = "export the channels over time as CSV";
const EXPORT_FORCE: &str = "export the force over time as CSV (time, x, y)";
const AS_NUMBERS: &str = "a motion has to be given as numbers, as CSV";
const IN_SITE: &str = "name it in a site file as the ground of a scene, [dxf] file = \"…\"";
const AS_WORKBOOK: &str = "save the sheet as .xlsx or as CSV";

/// What is said of a text of LS-DYNA that no reader knows.
const OF_LS_DYNA: &str = "a text of LS-DYNA that is not read, or one without numbers";

/// The first bytes of formats that are not read: the bytes, what they are, and what to do.
const MAGIC: [(&[u8], &str, &str); 26] = [
    (b"MATLAB 7.3", "a MATLAB file", "save the signals with writetable as CSV"),
    (b"MATLAB 5.0", "a MATLAB file", "save the signals with writetable as CSV"),
    (b"\x89HDF\r\n\x1a\n", "an HDF5 file", EXPORT),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an old Office document (.xls)", AS_WORKBOOK),
    (b"%PDF", "a PDF document", "take the table from the program that made it, as CSV"),
    (b"\x89PNG", "a picture (PNG)", "a curve has to be given as numbers, as CSV"),
    (b"\xff\xd8\xff", "a picture (JPEG)", "a curve has to be given as numbers, as CSV"),
    (b"GIF8", "a picture (GIF)", "a curve has to be given as numbers, as CSV"),
    (b"II*\0", "a picture (TIFF)", "a curve has to be given as numbers, as CSV"),
    (b"MM\0*", "a picture (TIFF)", "a curve has to be given as numbers, as CSV"),
    (b"RIFF", "a film, sound or picture (RIFF)", "a curve has to be given as numbers, as CSV"),
    (b"\x1f\x8b", "a compressed file (gzip)", "unpack it"),
    (b"BZh", "a compressed file (bzip2)", "unpack it"),
    (b"\xfd7zXZ\0", "a compressed file (xz)", "unpack it"),
    (b"\x28\xb5\x2f\xfd", "a compressed file (zstd)", "unpack it"),
    (b"7z\xbc\xaf\x27\x1c", "an archive (7z)", "unpack it and open the files in it"),
    (b"Rar!", "an archive (RAR)", "unpack it and open the files in it"),
    (b"SQLite format 3\0", "an SQLite database", EXPORT),
    (b"PAR1", "a Parquet file", EXPORT),
    (b"ARROW1", "an Arrow file", EXPORT),
    (b"\x93NUMPY", "a NumPy file", "save it with numpy.savetxt as CSV"),
    (b"LOGG", "a bus log of Vector (BLF)", EXPORT),
    (b"\x7fELF", "a program", "is it the right file?"),
    (b"glTF", "a scene of bodies (glTF)", AS_NUMBERS),
    (b"AutoCAD Binary DXF", "a drawing (DXF)", IN_SITE),
    (b"{\\rtf", "a text document (RTF)", "save the table as CSV"),
];

/// Beginnings of the first line of text formats that are not read.
const FIRST_LINES: [(&str, &str, &str); 6] = [
    ("<svg", "a picture (SVG)", "a curve has to be given as numbers, as CSV"),
    ("<?xml", "an XML file", EXPORT),
    ("<html", "a web page", "save the table as CSV"),
    ("<!doctype", "a web page", "save the table as CSV"),
    ("*keyword", "an LS-DYNA input deck", "run it, and export its results as CSV"),
    ("{", "a JSON file", EXPORT),
];

/// Refuses a binary format that is known and not read.
///
/// - `first`: the first bytes of the file.
///
/// # Errors
/// [`DataError::OtherFormat`] with what the file is.
pub(crate) fn refuse_known_binary(path: &Path, first: &[u8]) -> Result<(), DataError> {
    let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase());
    let is_named = |start: &str| name.as_ref().is_some_and(|name| name.starts_with(start));
    let is_binary = first.contains(&0);
    let known = MAGIC.into_iter().find(|(bytes, ..)| first.starts_with(bytes));
    let solver = match () {
        () if is_binary && is_named("d3plot") => Some("LS-DYNA results (d3plot)"),
        () => None,
    };
    let known = known.map(|(_, format, remedy)| (format, remedy));
    match known.or(solver.map(|format| (format, EXPORT))) {
        Some((format, remedy)) => Err(other(path, format, remedy)),
        None => Ok(()),
    }
}

/// Refuses a text format that is known and not read.
///
/// # Errors
/// [`DataError::OtherFormat`] with what the file is.
pub(crate) fn refuse_known_text(path: &Path, text: &str) -> Result<(), DataError> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let first = lines.clone().next().unwrap_or_default().to_lowercase();
    if is_gltf(text) {
        return Err(other(path, "a scene of bodies (glTF)", AS_NUMBERS));
    }
    if is_drawing(lines.clone()) {
        return Err(other(path, "a drawing (DXF)", IN_SITE));
    }
    let known = FIRST_LINES.into_iter().find(|(start, ..)| first.starts_with(start));
    if let Some((_, format, remedy)) = known {
        return Err(other(path, format, remedy));
    }
    let examined: Vec<&str> = lines.by_ref().take(EXAMINED_LINES).collect();
    let known = examined.iter().find_map(|line| solver_output(line));
    let unknown =
        || examined.iter().any(|line| is_of_ls_dyna(line)).then_some((OF_LS_DYNA, EXPORT));
    match known.or_else(unknown) {
        Some((format, remedy)) => Err(other(path, format, remedy)),
        None => Ok(()),
    }
}

/// Whether a text is a glTF file: JSON with the mandatory `asset` and its version.
pub fn is_gltf(text: &str) -> bool {
    let has = |word: &str| text.contains(word);
    let has_contents =
        ["\"scenes\"", "\"nodes\"", "\"meshes\"", "\"buffers\""].into_iter().any(has);
    text.trim_start().starts_with('{') && has("\"asset\"") && has("\"version\"") && has_contents
}

/// Whether lines that are not blank begin as those of a DXF file do: the group code 0 and a section.
fn is_drawing<'a>(mut lines: impl Iterator<Item = &'a str>) -> bool {
    let is_comment = |code: &str| code == "999";
    let mut next = lines.next();
    while next.is_some_and(is_comment) {
        lines.next();
        next = lines.next();
    }
    next == Some("0") && lines.next().is_some_and(|name| name.eq_ignore_ascii_case("section"))
}

/// The output of a solver to which a line belongs, and what to do with it.
fn solver_output(line: &str) -> Option<(&'static str, &'static str)> {
    let letters: String =
        line.chars().filter(|c| c.is_alphabetic()).flat_map(char::to_lowercase).collect();
    let titles = [
        ("nodalforcegroupoutput", "an LS-DYNA nodfor file", EXPORT_FORCE),
        ("timewallnormalforcexforce", "an LS-DYNA rwforc file", EXPORT_FORCE),
        ("dtofcycleiscontrolledby", "an LS-DYNA glstat file", EXPORT),
        ("zzzzzeor", "a time history of Radioss as text", "have it written in binary, as is usual"),
    ];
    // Titles may be written with blanks between the letters, and with a number among them.
    let title = titles.into_iter().find(|(title, ..)| letters.contains(title));
    title.map(|(_, format, remedy)| (format, remedy))
}

/// Whether a line is the one with version and date below the title of a run, in any text of LS-DYNA.
fn is_of_ls_dyna(line: &str) -> bool {
    let line = line.to_lowercase();
    line.starts_with("ls-dyna") && line.contains(" date ")
}

/// The error for a file that is recognised and not read.
pub(crate) fn other(path: &Path, format: &'static str, remedy: &'static str) -> DataError {
    DataError::OtherFormat { path: path.to_owned(), format, remedy }
}
