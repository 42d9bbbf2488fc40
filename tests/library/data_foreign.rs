//! Files that are recognised and not read: they are refused by their names, with what to do.

use impactlab_core::data::read_any_series;

use crate::data_import::{archive, file};

/// Reads a file of what is recognised and not read, and looks for what is said of it.
fn check_named(name: &str, content: &[u8], message: &str) {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = file(folder.path(), name, content);
    let error = read_any_series(&path, None).expect_err("it is not read").to_string();
    assert!(error.starts_with(&format!("{}: ", path.display())), "{error}");
    assert!(error.contains(message), "{name}: {error}");
    assert!(!error.contains("the header has") && !error.contains("is not text"), "{error}");
}

#[test]
fn files_of_solvers_that_are_not_read_are_said_by_their_names() {
    for (name, content, message) in [
        (
            "nodfor",
            &b" n o d a l   f o r c e   g r o u p    o u t p u t\n"[..],
            "is an LS-DYNA nodfor file; export the force over time as CSV",
        ),
        (
            "rwforc",
            b" a run\n                         ls-dyna smp.1 s           date 09/24/2019\n\n\n    time       \
              wall#   normal-force    x-force        y-force        z-force\n 0.00000E+00       1   0.000000E+00   \
              0.000000E+00   0.000000E+00   0.000000E+00\n",
            "is an LS-DYNA rwforc file; export the force over time as CSV",
        ),
        (
            "glstat",
            b" a run\n                         ls-dyna smp.1 s            date 01/02/2013\n\n\n dt of cycle       1 is \
              controlled by solid         843750 of part         1\n\n time...........................   \
              0.00000E+00\n",
            "is an LS-DYNA glstat file; export the channels over time as CSV",
        ),
        (
            "curvout",
            b" a run\n                         ls-dyna (version 970)     date 09/24/2019\n\n",
            "is a text of LS-DYNA that is not read, or one without numbers; export the channels",
        ),
        (
            "runT01",
            b"runT01 FORMAT\nZZZZZEOR    1I   72C\n 3040\nrunT01 FORMAT\n",
            "is a time history of Radioss as text; have it written in binary",
        ),
        ("in.k", b"*KEYWORD\n*TITLE\nrun\n", "is an LS-DYNA input deck; run it"),
        ("d3plot", b"a run\0\0", "is LS-DYNA results (d3plot); export"),
    ] {
        check_named(name, content, message);
    }
}

#[test]
fn what_is_recognised_but_not_read_is_said_by_its_name() {
    for (name, content, message) in [
        (
            "a.mat",
            &b"MATLAB 5.0 MAT-file, Platform: GLNXA64\0\0"[..],
            "is a MATLAB file; save the signals",
        ),
        ("a.h5", b"\x89HDF\r\n\x1a\n\0\0", "is an HDF5 file; export"),
        ("a.pdf", b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n", "is a PDF document; take the table"),
        ("a.png", b"\x89PNG\r\n\x1a\n\0\0", "is a picture (PNG); a curve has to be given"),
        ("a.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF", "is a picture (JPEG); a curve"),
        (
            "a.xls",
            b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0\0",
            "is an old Office document (.xls); save the sheet as .xlsx",
        ),
        ("a.gz", b"\x1f\x8b\x08\0rest", "is a compressed file (gzip); unpack it"),
        (
            "a.html",
            b"<!DOCTYPE html>\n<html><body>1</body></html>\n",
            "is a web page; save the table as CSV",
        ),
        ("a.json", b"{\"time\": [0, 1]}\n", "is a JSON file; export"),
        ("a.zip", &archive(&[("data.csv", "t,fx,fy\n")]), "is an archive (zip); unpack it"),
        (
            "a.ods",
            &archive(&[
                ("mimetype", "application/vnd.oasis.opendocument.spreadsheet"),
                ("content.xml", "<x/>"),
            ]),
            "is an OpenDocument file (.ods); save the sheet as .xlsx",
        ),
        (
            "a.xlsb",
            &archive(&[("xl/workbook.bin", "")]),
            "is a binary workbook (.xlsb); save it as .xlsx",
        ),
        (
            "a.docx",
            &archive(&[("word/document.xml", "<x/>")]),
            "is a text document (.docx); save the table",
        ),
        ("b.xlsx", &archive(&[("xl/workbook.xml", "<workbook")]), "the workbook cannot be read"),
    ] {
        check_named(name, content, message);
    }
}
