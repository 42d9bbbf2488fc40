//! Files of measuring programs, spreadsheets and solvers: what is read of them, and by which name
//! what is not read is called.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use impactlab_core::data::{
    Channel, ColumnMap, DataError, Dataset, FlagKind, ForceHistory, Loaded, Note, Outcome, Table,
    VelocityFit, check_file, read_any_series, velocity_fit,
};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

pub(crate) fn file(folder: &Path, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path
}

fn read(content: impl AsRef<[u8]>, map: &str) -> Result<Loaded, DataError> {
    let folder = tempfile::tempdir().unwrap();
    let path = file(folder.path(), "f.csv", content);
    let map: ColumnMap = map.parse().unwrap();
    read_any_series(&path, (!map.to_string().is_empty()).then_some(&map))
}

fn peak_n(loaded: &Loaded) -> f64 {
    let force = ForceHistory::from_series(&loaded.series, loaded.force_sampling()).unwrap();
    force.peak().unwrap().0
}

#[test]
fn a_title_row_and_a_column_of_empty_remarks_do_not_hide_the_header() {
    let mut text = "Messung 17;;;\r\nZeit [ms];Fx [kN];Fy [kN];Bemerkung\r\n".to_owned();
    for (t_ms, fy) in [("0,0", "0,0"), ("0,1", "31,0"), ("0,2", "0,0")] {
        text += &format!("{t_ms};1,5;{fy};\r\n");
    }
    let loaded = read(text, "").unwrap();
    assert!((peak_n(&loaded) - 31_036.3).abs() < 0.1, "{}", peak_n(&loaded));
    assert_eq!(loaded.series.time_s().last(), Some(&0.000_2));
}

/// An archive with these parts.
pub(crate) fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for (name, content) in parts {
        archive.start_file(*name, options).unwrap();
        archive.write_all(content.as_bytes()).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// The part of a workbook that says where the list of its sheets is.
const LINKS: (&str, &str) = (
    "_rels/.rels",
    r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="rId1" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument" Target="xl/workbook.xml"/></Relationships>"#,
);

/// A workbook with sheets of these rows; a cell that is a number in Rust is a number there.
fn workbook(sheets: &[(&str, &[&[&str]])]) -> Vec<u8> {
    let mut list = String::new();
    let mut links = String::new();
    let mut parts = Vec::new();
    for (idx, (name, rows)) in sheets.iter().enumerate() {
        let number = idx + 1;
        list.push_str(&format!(r#"<sheet name="{name}" sheetId="{number}" r:id="rId{number}"/>"#));
        links.push_str(&format!(
            r#"<Relationship Id="rId{number}" Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet" Target="worksheets/sheet{number}.xml"/>"#
        ));
        let mut data = String::new();
        for (row, cells) in rows.iter().enumerate() {
            data.push_str(&format!(r#"<row r="{}">"#, row + 1));
            for (column, cell) in cells.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
                let place = format!("{}{}", char::from(b'A' + column as u8), row + 1);
                data.push_str(&match cell.parse::<f64>() {
                    Ok(number) => format!(r#"<c r="{place}"><v>{number}</v></c>"#),
                    Err(_) => format!(r#"<c r="{place}" t="inlineStr"><is><t>{cell}</t></is></c>"#),
                });
            }
            data.push_str("</row>");
        }
        let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
        let sheet =
            format!(r#"<worksheet xmlns="{main}"><sheetData>{data}</sheetData></worksheet>"#);
        parts.push((format!("xl/worksheets/sheet{number}.xml"), sheet));
    }
    let book = format!(
        r#"<workbook xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main" xmlns:r="http://schemas.openxmlformats.org/officeDocument/2006/relationships"><sheets>{list}</sheets></workbook>"#
    );
    let links = format!(
        r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">{links}</Relationships>"#
    );
    parts.push(("xl/workbook.xml".to_owned(), book));
    parts.push(("xl/_rels/workbook.xml.rels".to_owned(), links));
    let parts = parts.iter().map(|(name, content)| (name.as_str(), content.as_str()));
    let parts: Vec<(&str, &str)> = parts.chain([LINKS]).collect();
    archive(&parts)
}

/// A pulse of 60 kN as a German spreadsheet has it.
const ROWS: [&[&str]; 9] = [
    &["Anprallversuch 12", "", "", "", "Bemerkung: Kran"],
    &["Datum", "17.03.2026"],
    &[],
    &["Zeit", "Kraft X", "Kraft Y", "Status"],
    &["ms", "kN", "kN", ""],
    &["0", "0", "0", "ok"],
    &["50", "60", "-12.5", "ok"],
    &["100", "30", "0", "Ende"],
    &["150", "0", "0", ""],
];

#[test]
fn a_german_export_in_kn_has_the_right_newtons_as_text_and_as_workbook() {
    let folder = tempfile::tempdir().unwrap();
    let lines = ROWS.map(|cells| {
        let cells: Vec<String> = cells
            .iter()
            .map(|cell| match cell.parse::<f64>() {
                Ok(_) => cell.replace('.', ","),
                Err(_) => (*cell).to_owned(),
            })
            .collect();
        cells.join(";") + &";".repeat(5usize.saturating_sub(cells.len().max(1))) + "\r\n"
    });
    for path in [
        file(folder.path(), "a.csv", lines.concat()),
        file(folder.path(), "b.xlsx", workbook(&[("Messung", &ROWS)])),
        file(folder.path(), "c.xlsx", workbook(&[("leer", &[]), ("Messung", &ROWS)])),
    ] {
        let loaded = read_any_series(&path, None).unwrap();
        assert_eq!(loaded.series.time_s(), [0.0, 0.05, 0.1, 0.15], "{}", path.display());
        assert_eq!(loaded.series.get(Channel::Fx).unwrap(), [0.0, 60e3, 30e3, 0.0]);
        assert_eq!(loaded.series.get(Channel::Fy).unwrap(), [0.0, -12.5e3, 0.0, 0.0]);
        assert!(!loaded.notes.iter().any(Note::is_doubt), "{:?}", loaded.notes);
    }
}

#[test]
fn a_sheet_is_chosen_and_an_error_names_its_cell() {
    let folder = tempfile::tempdir().unwrap();
    let other: [&[&str]; 4] = [
        &["t [s]", "fx [N]", "fy [N]"],
        &["0", "0", "0"],
        &["0.1", "abc", "2"],
        &["0.2", "0", "0"],
    ];
    let path = file(folder.path(), "f.xlsx", workbook(&[("Messung", &ROWS), ("Blatt 2", &other)]));
    let read = |map: &str| read_any_series(&path, Some(&map.parse().unwrap()));
    let at = path.display();
    for map in ["sheet=2", "sheet=Blatt 2"] {
        assert_eq!(
            read(map).unwrap_err().to_string(),
            format!(
                r#"{at}, sheet "Blatt 2", cell B3: "fx [N]" is "abc", expected a finite number in N"#
            )
        );
    }
    assert_eq!(peak_n(&read("sheet=1").unwrap()), 60e3_f64.hypot(12.5e3));
    assert_eq!(
        read("sheet=3").unwrap_err().to_string(),
        format!(r#"{at}: there is no sheet "3"; found "Messung", "Blatt 2""#)
    );
    let text = file(folder.path(), "f.csv", "t,fx,fy\n0,1,2\n1,2,3\n");
    let error = read_any_series(&text, Some(&"sheet=2".parse().unwrap())).unwrap_err();
    assert!(error.to_string().contains(r#"there is no sheet "2""#), "{error}");
    // A table that asks for a map says so for the sheet, too.
    let vague: [&[&str]; 3] = [&["Zeit", "Kraft"], &["0", "1"], &["1", "2"]];
    let path = file(folder.path(), "g.xlsx", workbook(&[("S", &vague)]));
    let error = read_any_series(&path, None).unwrap_err();
    assert!(
        error.needs_mapping() && error.to_string().contains(r#"sheet "S", row 1: no column for"#),
        "{error}"
    );
}

#[test]
fn a_date_is_a_time_and_not_read_as_a_number() {
    let styles = r#"<styleSheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><cellXfs><xf numFmtId="0"/><xf numFmtId="21" applyNumberFormat="1"/></cellXfs></styleSheet>"#;
    let head = r#"<row r="1"><c r="A1" t="inlineStr"><is><t>t [s]</t></is></c><c r="B1" t="inlineStr"><is><t>fx [N]</t></is></c><c r="C1" t="inlineStr"><is><t>fy [N]</t></is></c></row>"#;
    // Quarters of a second, in days, and the force is a number or a date.
    let row = |number: u32, style: &str| {
        let days = 46_000.5 + f64::from(number) * 0.25 / 86_400.0;
        format!(
            r#"<row r="{number}"><c r="A{number}" s="1"><v>{days}</v></c><c r="B{number}"{style}><v>1</v></c><c r="C{number}"><v>1</v></c></row>"#
        )
    };
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let sheet = |style: &str| {
        let rows: String = (2..6).map(|number| row(number, style)).collect();
        format!(r#"<worksheet xmlns="{main}"><sheetData>{head}{rows}</sheetData></worksheet>"#)
    };
    let relations = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let book = format!(
        r#"<workbook xmlns="{main}" xmlns:r="{relations}"><sheets><sheet name="S" sheetId="1" r:id="rId1"/></sheets></workbook>"#
    );
    let links = format!(
        r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="rId1" Type="{relations}/worksheet" Target="worksheets/sheet1.xml"/><Relationship Id="rId2" Type="{relations}/styles" Target="styles.xml"/></Relationships>"#
    );
    let folder = tempfile::tempdir().unwrap();
    let read = |style: &str| {
        let text = sheet(style);
        let parts = [
            ("xl/worksheets/sheet1.xml", text.as_str()),
            ("xl/workbook.xml", &book),
            ("xl/_rels/workbook.xml.rels", &links),
            ("xl/styles.xml", styles),
            LINKS,
        ];
        let path = file(folder.path(), "f.xlsx", archive(&parts));
        read_any_series(&path, Some(&"header=1".parse().unwrap()))
    };
    let loaded = read("").unwrap();
    let time_s = loaded.series.time_s();
    for pair in time_s.windows(2) {
        assert!((pair[1] - pair[0] - 0.25).abs() < 1e-5, "{time_s:?}");
    }
    // A day is no newton.
    let error = read(r#" s="1""#).unwrap_err();
    assert!(error.to_string().contains("date or time of day"), "{error}");
    assert!(matches!(error, DataError::InSheet { .. }), "{error}");
}

#[test]
fn a_workbook_that_unpacks_to_too_much_is_refused_before_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let blank = " ".repeat(300 << 20);
    let parts = [("xl/workbook.xml", "<workbook/>"), ("xl/sharedStrings.xml", blank.as_str())];
    let bytes = archive(&parts);
    assert!(bytes.len() < 2 << 20, "{} bytes", bytes.len());
    let path = file(folder.path(), "f.xlsx", bytes);
    let error = read_any_series(&path, None).unwrap_err();
    assert!(matches!(error, DataError::TooLarge { .. }), "{error}");
}

/// A workbook of one sheet with these rows and, if there are any, shared texts.
fn raw_workbook(rows: &str, texts: &str) -> Vec<u8> {
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let relations = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let sheet = format!(r#"<worksheet xmlns="{main}"><sheetData>{rows}</sheetData></worksheet>"#);
    let book = format!(
        r#"<workbook xmlns="{main}" xmlns:r="{relations}"><sheets><sheet name="S" sheetId="1" r:id="rId1"/></sheets></workbook>"#
    );
    let links = format!(
        r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="rId1" Type="{relations}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>"#
    );
    archive(&[
        ("xl/worksheets/sheet1.xml", &sheet),
        ("xl/sharedStrings.xml", texts),
        ("xl/workbook.xml", &book),
        ("xl/_rels/workbook.xml.rels", &links),
        LINKS,
    ])
}

#[test]
fn what_a_workbook_says_of_its_size_takes_no_memory() {
    let cell = |place: &str| format!(r#"<c r="{place}"><v>1</v></c>"#);
    let row = |at: &str| format!(r#"<row r="{at}">{}</row>"#, cell(&format!("A{at}")));
    let texts = |count: &str| format!(r#"<sst uniqueCount="{count}"><si><t>t</t></si></sst>"#);
    let folder = tempfile::tempdir().unwrap();
    let message = |rows: &str, texts: &str| {
        let path = file(folder.path(), "f.xlsx", raw_workbook(rows, texts));
        read_any_series(&path, None).unwrap_err().to_string()
    };
    let (first, few) = (row("1"), texts("1"));
    for at in ["1048577", "4294967295", "4294967294"] {
        let error = message(&(first.clone() + &row(at)), &few);
        assert!(
            error.contains(&format!("has a row {at}, expected 1048576 at the most")),
            "{error}"
        );
    }
    for count in ["2000001", "4000000000", " +4000000000", "99999999999999999999999"] {
        let error = message(&first, &texts(count));
        assert!(error.contains("texts, expected 2000000 at the most"), "{count}: {error}");
    }
    // A number without meaning is read over, as other programs do.
    for count in ["", "many", "2000000"] {
        let error = message(&first, &texts(count));
        assert!(!error.contains("cannot be read"), "{count}: {error}");
    }
    let styles = format!("<styleSheet>{}</styleSheet>", "<xf/>".repeat(500_001));
    let parts = [("xl/workbook.xml", "<workbook/>"), ("xl/styles.xml", styles.as_str())];
    let path = file(folder.path(), "s.xlsx", archive(&parts));
    let error = read_any_series(&path, None).unwrap_err().to_string();
    assert!(error.contains("have more than 500000 elements"), "{error}");
    // Which of two numbers stands in a cell cannot be told.
    for rows in [row("2") + &row("1"), format!("<row r=\"1\">{0}{0}</row>", cell("A1"))] {
        let error = message(&rows, &few);
        assert!(error.contains("row 1 of sheet \"S\" has cells out of order"), "{error}");
    }
}

#[test]
fn headers_between_other_lines_are_found() {
    for (text, what) in [
        (
            "Versuch;12;;\nMasse;1500;kg;\nt [s];fx [N];fy [N];3\n0;1;2;5\n1;2;3;5\n",
            "one header cell is a number",
        ),
        (
            "t [s];fx [N];fy [N]\n0;1;2;ok\n1;2;3;Kontakt Ende\n",
            "text to the right of the last column",
        ),
        ("t [s];fx [N];fy [N];Kommentar\n0;1;2;ok\n1;2;3;\n", "a column of text"),
        (
            "t fx fy\ns N N\n0 1 2 first touch\n1 2 3\n2 3 4\n",
            "words to the right of the last column",
        ),
    ] {
        let loaded = read(text, "").unwrap();
        assert_eq!(loaded.series.get(Channel::Fy).unwrap()[..2], [2.0, 3.0], "{what}");
    }
    let notes = read("t [s];fx [N];fy [N]\n0;1;2;ok\n1;2;3\n", "").unwrap().notes;
    assert_eq!(notes, [Note::TextBeyond { n_rows: 1 }]);
    // A number to the right may belong to a column, so that it is refused.
    let error = read("t [s];fx [N];fy [N]\n0;1;2;7\n1;2;3;8\n0;1;2\n", "").unwrap_err();
    assert!(error.to_string().contains("fields, the header has"), "{error}");
    // Header and units where the user says.
    let text = "Kanal;fx;fy\nZeit;Kraft A;Kraft B\nms;kN;kN\n0;1;2\n1;2;3\n";
    let loaded = read(text, "header=2,units=3,time=1,fx=2,fy=3").unwrap();
    assert_eq!(loaded.series.get(Channel::Fy).unwrap(), [2000.0, 3000.0]);
    assert_eq!(loaded.series.time_s(), [0.0, 0.001]);
    let error = read(text, "header=9").unwrap_err().to_string();
    assert!(
        error.ends_with(
            "f.csv:9: nothing is found here, expected the header in one of the first lines"
        ),
        "{error}"
    );
}

#[test]
fn sums_signs_clock_and_axes_are_read_as_the_map_says() {
    let text = "t [ms];A [kN];B [kN];C [N]\n12;1;10;100\n13;2;20;200\n";
    let loaded = read(text, "time=1,fx=2+3-4,fy=-2,shift=-12:ms").unwrap();
    assert_eq!(loaded.series.get(Channel::Fx).unwrap(), [10_900.0, 21_800.0]);
    assert_eq!(loaded.series.get(Channel::Fy).unwrap(), [-1000.0, -2000.0]);
    assert!(loaded.series.time_s()[0].abs() < 1e-12);
    let loaded = read(text, "time=1,fx=2,fy=none").unwrap();
    assert_eq!(loaded.series.get(Channel::Fy).unwrap(), [0.0, 0.0]);
    let text = "t [s],x [m],y [m],yaw [deg],yaw rate [deg/s],vx [m/s],vy [m/s],roll [deg]\n0,1,2,90,9,3,4,5\n1,1,2,90,9,3,4,5\n";
    let loaded = read(text, "y_axis=right").unwrap();
    let first = |channel| loaded.series.get(channel).unwrap()[0];
    assert_eq!([first(Channel::X), first(Channel::Y), first(Channel::Vy)], [1.0, -2.0, -4.0]);
    assert!(
        first(Channel::Yaw) < 0.0 && first(Channel::YawRate) < 0.0 && first(Channel::Roll) > 0.0
    );
    let loaded = read(text, "velocities=world").unwrap();
    let first = |channel| loaded.series.get(channel).unwrap()[0];
    assert!((first(Channel::Vx) - 4.0).abs() < 1e-12 && (first(Channel::Vy) + 3.0).abs() < 1e-12);
    let error =
        read("t [s],x [m],y [m],vx [m/s],vy [m/s]\n0,1,2,3,4\n1,1,2,3,4\n", "velocities=world");
    assert!(
        error
            .unwrap_err()
            .to_string()
            .contains("no column for velocities in world axes: vx, vy and yaw")
    );
}

/// A transducer at its limit, a number that stands for none, and two pulses that are as they are.
#[test]
fn a_force_that_is_cut_off_and_a_lone_sample_are_said() {
    let kinds = |force_kn: &dyn Fn(f64) -> f64| {
        let row = |i: u32| format!("{i},{},0\n", force_kn(f64::from(i)));
        let rows: String = (0..=150).map(row).collect();
        let loaded = read(format!("t [ms],fx [kN],fy [kN]\n{rows}"), "").unwrap();
        check_file(&loaded).iter().map(|flag| flag.kind).collect::<Vec<_>>()
    };
    let pulse =
        |t: f64| if t < 100.0 { 60.0 * (t * std::f64::consts::PI / 100.0).sin() } else { 0.0 };
    assert_eq!(kinds(&pulse), []);
    assert_eq!(kinds(&|t| pulse(t).min(30.0)), [FlagKind::Saturated]);
    assert_eq!(kinds(&|t| if t == 130.0 { -9.999 } else { pulse(t) }), [FlagKind::Spike]);
    // A pulse in whole kN, and one that is constant.
    assert_eq!(kinds(&|t| pulse(t).round()), []);
    assert_eq!(kinds(&|t| if t > 20.0 && t < 90.0 { 40.0 } else { 0.0 }), []);
}

#[test]
fn a_60_n_crash_is_said_in_words() {
    let pulse = |unit: &str| {
        let rows = (0..=100).map(|i| {
            format!("{i},{},0\n", 60.0 * (f64::from(i) / 100.0 * std::f64::consts::PI).sin())
        });
        format!("t [ms],fx [{unit}],fy [{unit}]\n{}", rows.collect::<String>())
    };
    let flags = check_file(&read(pulse("N"), "").unwrap());
    assert_eq!(flags.iter().map(|flag| flag.kind).collect::<Vec<_>>(), [FlagKind::SmallForce]);
    assert_eq!(
        flags[0].to_string(),
        "peak force 60.00 N, less than cars have that touch at walking speed (1000 N); is the column in kN? (at 0.0500 s)"
    );
    assert!(check_file(&read(pulse("kN"), "").unwrap()).is_empty());
    // A file that begins when the force is at its peak: half of the impulse is missing.
    let text = pulse("kN");
    let cut: Vec<&str> =
        text.lines().enumerate().filter(|(i, _)| *i == 0 || *i > 50).map(|(_, row)| row).collect();
    let flags = check_file(&read(cut.join("\n"), "").unwrap());
    assert_eq!(flags.iter().map(|flag| flag.kind).collect::<Vec<_>>(), [FlagKind::BegunBefore]);
    assert_eq!(
        flags[0].to_string(),
        "the force is 100 % of the peak at the first row: what came before it is missing in the impulse"
    );
    // The right force over microseconds instead of milliseconds.
    let flags = check_file(&read(pulse("kN").replace("[ms]", "[µs]"), "").unwrap());
    assert_eq!(
        flags.iter().map(|flag| flag.kind).collect::<Vec<_>>(),
        [FlagKind::ImplausibleImpulse]
    );
    assert!(
        flags[0].to_string().contains("below the 100 N s of any collision of cars"),
        "{}",
        flags[0]
    );
}

#[test]
fn the_shipped_motions_fit_their_paths() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets");
    for name in ["trajectories-fea", "trajectories-pulse"] {
        let dataset = Dataset::load(&root.join(name), &mut |_| std::ops::ControlFlow::Continue(()));
        let Outcome::Complete(dataset) = dataset.unwrap() else { panic!("not cancelled") };
        assert!(!dataset.cases.is_empty());
        for case in &dataset.cases {
            let fit = velocity_fit(&case.series);
            let fits = matches!(fit, None | Some(VelocityFit::Body | VelocityFit::Both));
            assert!(fits, "{name} {}: {fit:?}", case.name);
        }
    }
}

#[test]
fn a_header_is_known_again_by_its_fingerprint() {
    let folder = tempfile::tempdir().unwrap();
    let fingerprint = |name: &str, content: &str| {
        Table::read(&file(folder.path(), name, content)).unwrap().fingerprint()
    };
    let first = fingerprint("a.csv", "Versuch 1\nZeit;Kraft\n0;1\n1;2\n");
    assert_eq!(first, fingerprint("b.csv", "Versuch 2\nZeit;Kraft\n0;7\n1;2\n2;2\n"));
    assert_ne!(first, fingerprint("c.csv", "Versuch 1\nKraft;Zeit\n0;1\n1;2\n"));
    assert_ne!(first, fingerprint("d.csv", "Versuch 1\nZeit;Kraft\nms;kN\n0;1\n1;2\n"));
}

/// F_x in kN beside F_y in N was taken without a word.
#[test]
fn components_in_different_units_are_doubted() {
    let folder = tempfile::tempdir().unwrap();
    let read = |header: &str| {
        let path = folder.path().join("f.csv");
        std::fs::write(&path, format!("{header}\n0,0,0\n0.1,40,2000\n0.2,0,0\n")).unwrap();
        impactlab_core::data::read_force_file(&path, None).unwrap()
    };
    let mixed = read("Time [s],Fx [kN],Fy [N]");
    let doubts: Vec<String> =
        mixed.notes.iter().filter(|note| note.is_doubt()).map(ToString::to_string).collect();
    let [message] = doubts.as_slice() else { panic!("{doubts:?}") };
    let expected = "column 2 \"Fx [kN]\" is read in kN and column 3 \"Fy [N]\" in N";
    assert!(message.starts_with(expected), "{message}");
    assert!(
        !read("Time [s],Fx [kN],Fy [kN]").notes.iter().any(impactlab_core::data::Note::is_doubt)
    );
}
