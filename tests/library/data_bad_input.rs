//! Bad files: each is refused with a message that names the place and the remedy, and none causes a
//! panic.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs::{self, File};
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::{
    ColumnMap, DataError, Dataset, DatasetKind, ReadSettings, open, propose_columns,
    read_any_series, read_force_file, read_steer_file, read_trajectory_file,
};
use proptest::prelude::*;
use tempfile::TempDir;

/// Returns the message of an error without the path of the temporary folder.
fn message(folder: &Path, error: &DataError) -> String {
    let folder = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
    error.to_string().replace(&folder, "").replace('\\', "/")
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Returns the message with which a force file of this content is refused.
fn refused(content: impl AsRef<[u8]>) -> String {
    let folder = folder();
    let path = folder.path().join("f.csv");
    fs::write(&path, content).unwrap();
    message(folder.path(), &read_force_file(&path, None).unwrap_err())
}

fn utf16(text: &str) -> Vec<u8> {
    let units = std::iter::once(0xfeff).chain(text.encode_utf16());
    units.flat_map(u16::to_le_bytes).collect()
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of files and messages")]
fn bad_force_files_are_refused_with_their_place() {
    let bad_utf16 = utf16("t [s];Fx [kN];Fy [kN]\r\n0;1;1\r\n0,1;zwölf;1\r\n");
    let cases: &[(&[u8], &str)] = &[
        (
            b"time_s,fx_n\n0,1\n1,2\n",
            r#"f.csv:1: no column for time, fx and fy (or fx_body and fy_body); found "time_s", "fx_n"; say which it is, e.g. --map fy=COLUMN, or in the mapping dialog"#,
        ),
        (
            b"fx_n,fy_n\n0,1\n1,2\n",
            r#"f.csv:1: no column for time, fx and fy (or fx_body and fy_body); found "fx_n", "fy_n"; say which it is, e.g. --map time=COLUMN, or in the mapping dialog"#,
        ),
        (
            b"time_s,fx_n,fy_n\n0,1,1\n0.1,n/a,1\n",
            r#"f.csv:3:2: "fx_n" is "n/a", expected a finite number in N"#,
        ),
        (
            b"time_s,Fx [kN],Fy [kN]\n0,1,1\n0.1,NaN,1\n",
            r#"f.csv:3:2: "Fx [kN]" is "NaN", expected a finite number in kN"#,
        ),
        (
            b"time_s,fx_n,fy_n\n0,1,1\n0.1,1,inf\n",
            r#"f.csv:3:3: "fy_n" is "inf", expected a finite number in N"#,
        ),
        (
            b"time_s,fx_n,fy_n\n0,1,1\n0.1,,1\n",
            r#"f.csv:3:2: "fx_n" is "", expected a finite number in N"#,
        ),
        (
            b"time_s,fx_n,fy_n\nx,y,z\n0.1,1,1\n",
            r#"f.csv:2:1: "time_s" is "x", expected a finite number in s; if this is a second line of the header, remove it"#,
        ),
        (
            b"# one\n\ntime_s,fx_n,fy_n\n\n0.2,1,1\n# two\n\n0.1,1,1\n",
            "f.csv:8:1: time is 0.1 s after 0.2 s in the row before, expected a later time; sort the rows and remove doubles, or let a clock go on that begins again there",
        ),
        (
            b"fx_n,fy_n,time_s\n1,1,0\n1,1,0.1\n1,1,0.1\n",
            "f.csv:4:3: time is 0.1 s after 0.1 s in the row before, expected a later time; sort the rows and remove doubles",
        ),
        (
            b"time_s,fx_n,fy_n\n0,1,1\n0.1,1\n0.2,1,1\n",
            "f.csv:3: has 2 fields, the header has 3; complete the row or remove it",
        ),
        (
            b"time_s,fx_n,fy_n\n0,1\n0.1,1\n",
            "f.csv:2: has 2 fields, the header has 3; complete the row or remove it",
        ),
        (
            b"time_s,fx_n,fy_n\n0,1,1,1\n0.1,1,1,1\n",
            "f.csv:2: has 4 fields, the header has 3; complete the row or remove it",
        ),
        (b"", "f.csv: is empty, expected a header line and rows of numbers"),
        (b"\n\n# nothing\n", "f.csv: is empty, expected a header line and rows of numbers"),
        (
            b"time_s,fx_n,fy_n\n",
            "f.csv:1: rows of numbers below the header: 0, expected at least 2",
        ),
        (
            b"time_s,fx_n,fy_n\n0,1,1\n",
            "f.csv:1: rows of numbers below the header: 1, expected at least 2",
        ),
        (
            b"0,1,1\n0.1,1,1\n",
            "f.csv:1: no header line names the columns; say which is which, e.g. --map time=1:ms,fx=2:kN,fy=3:kN, or in the mapping dialog",
        ),
        (
            b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR",
            "f.csv: is a picture (PNG); a curve has to be given as numbers, as CSV",
        ),
        (b"unknown\x07\0\0", "f.csv: is not text (byte 0x07 at offset 7); export it as CSV"),
        (
            b"time_s,fx_n,fy_n\n0,1,1\n0.1,1e9,1\n",
            r#"f.csv:3:2: "fx_n" is 1e9 N, expected -2e7 to 2e7 N (heavy trucks against rigid barriers reach a few MN); check the unit of the column"#,
        ),
        (
            b"time_s,Fx [kN],fy_n\n0,1,1\n0.1,50000,1\n",
            r#"f.csv:3:2: "Fx [kN]" is 5e7 N, expected -2e7 to 2e7 N (heavy trucks against rigid barriers reach a few MN); check the unit of the column"#,
        ),
        (
            b"time_s,Fx [m],Fy [m]\n0,1,1\n0.1,1,1\n",
            r#"f.csv:1:2: "Fx [m]" is in "m", expected a unit of force (N, kN, MN, lbf, kip, daN, kgf, tf, US tonf); correct the header or map the column with its unit, e.g. --map fx=2:N"#,
        ),
        (
            b"time [fortnight],fx_n,fy_n\n0,1,1\n0.1,1,1\n",
            r#"f.csv:1:1: "time [fortnight]" is in "fortnight", expected a unit of time (s, ms, \u{b5}s, ns, min, h); correct the header or map the column with its unit, e.g. --map time=1:s"#,
        ),
        (
            b"t;fx;fy\ns;kN;kg\n0;1;1\n1;1;1\n",
            r#"f.csv:1:3: "fy" is in "kg", expected a unit of force (N, kN, MN, lbf, kip, daN, kgf, tf, US tonf); correct the header or map the column with its unit, e.g. --map fy=3:N"#,
        ),
        (
            b"time_s,fx_n,fy_n,Fx [kN]\n0,1,1,1\n1,1,1,1\n",
            r#"f.csv:1:4: "Fx [kN]" and "fx_n" in column 2 both look like fx; choose one, e.g. --map fx=2, or in the mapping dialog"#,
        ),
        (&bad_utf16, "f.csv:3:2: \"Fx [kN]\" is \"zw\u{f6}lf\", expected a finite number in kN"),
        (
            b"Zeit [s];Kraft X [kN];Kraft Y [kN]\n0;1;1\n0,1;zw\xf6lf;1\n",
            "f.csv:3:2: \"Kraft X [kN]\" is \"zw\u{f6}lf\", expected a finite number in kN",
        ),
    ];
    for (content, expected) in cases {
        let expected = expected.replace(r"\u{b5}", "µ");
        let content_text = String::from_utf8_lossy(content);
        assert_eq!(refused(content), expected, "{content_text}");
    }
}

#[test]
fn other_kinds_of_file_say_what_they_need() {
    let folder = folder();
    let path = folder.path().join("f.csv");
    fs::write(&path, "time_s,x_m,steering\n0,1,2\n1,2,3\n").unwrap();
    let refused = |error| message(folder.path(), &error);
    assert_eq!(
        refused(read_trajectory_file(&path, None).unwrap_err()),
        r#"f.csv:1: no column for time, x and y; found "time_s", "x_m", "steering"; say which it is, e.g. --map y=COLUMN, or in the mapping dialog"#
    );
    assert_eq!(
        refused(read_steer_file(&path, None).unwrap_err()),
        r#"f.csv:1: no column for time and steer (or steer_fl and steer_fr, or steering_wheel); found "time_s", "x_m", "steering"; say which it is, e.g. --map steer=COLUMN, or in the mapping dialog"#
    );
    let map: ColumnMap = "y=Y position".parse().unwrap();
    assert_eq!(
        refused(read_trajectory_file(&path, Some(&map)).unwrap_err()),
        r#"f.csv:1: the mapping takes y from column Y position, which is not in the file; found "time_s", "x_m", "steering""#
    );
}

#[test]
fn what_is_no_file_is_refused() {
    let folder = folder();
    let here = folder.path();
    let refused = |path: &Path| message(here, &read_any_series(path, None).unwrap_err());
    fs::create_dir(here.join("d.csv")).unwrap();
    assert_eq!(refused(&here.join("d.csv")), "d.csv: is a folder, expected a file");
    assert_eq!(refused(&here.join("none.csv")), "none.csv: does not exist; check the name");
    let mut go_on = |_| ControlFlow::Continue(());
    let error = open(&here.join("d.csv"), &mut go_on).unwrap_err();
    assert_eq!(
        message(here, &error),
        "d.csv: is neither a data set (a folder with cases.csv and forces/ or trajectories/), nor \
         a folder of data sets, nor a force, trajectory or steer file"
    );
    let error = Dataset::load(&here.join("none"), &mut go_on).unwrap_err();
    assert_eq!(message(here, &error), "none: does not exist; check the name");
}

#[test]
fn huge_files_are_refused_at_once() {
    let folder = folder();
    let sparse = |name: &str, start: &str| {
        let path = folder.path().join(name);
        fs::write(&path, start).unwrap();
        File::options().write(true).open(&path).unwrap().set_len(2 << 30).unwrap();
        message(folder.path(), &read_any_series(&path, None).unwrap_err())
    };
    assert_eq!(
        sparse("zeros.csv", ""),
        "zeros.csv: is not text (byte 0x00 at offset 0); export it as CSV"
    );
    assert_eq!(
        sparse("long.csv", &"0.1,1,1\n".repeat(8192)),
        "long.csv: has 2147483648 bytes, at most 268435456 are read; split it or thin it out"
    );
}

/// Writes a data set of three valid force cases.
fn small_dataset() -> TempDir {
    let folder = folder();
    let header = "case,m_t_kg,m_b_kg,v_tx_m_s,v_ty_m_s,v_bx_m_s,v_by_m_s,theta_b_rad,contact_x_m,contact_y_m";
    let rows = ["a", "b", "c"].map(|case| format!("{case},2000,1500,10,0,12,1,0.2,-1.4,-0.9\n"));
    fs::write(folder.path().join("cases.csv"), format!("{header}\n{}", rows.concat())).unwrap();
    fs::create_dir(folder.path().join("forces")).unwrap();
    for case in ["a", "b", "c"] {
        let content = "time_s,fx_n,fy_n\n0,0,0\n0.1,5,9\n0.2,0,0\n";
        fs::write(folder.path().join("forces").join(format!("{case}.csv")), content).unwrap();
    }
    folder
}

/// Returns the names of the cases that were read, and the messages of the problems.
fn load(root: &Path) -> (Vec<String>, Vec<String>) {
    let dataset = Dataset::load(root, &mut |_| ControlFlow::Continue(())).unwrap();
    let dataset = dataset.complete().unwrap();
    let problems = dataset.problems.iter().map(|problem| message(root, problem));
    (dataset.cases.into_iter().map(|case| case.name).collect(), problems.collect())
}

fn edit(root: &Path, file: &str, edit: impl Fn(String) -> String) {
    let path = root.join(file);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(path, edit(text)).unwrap();
}

#[test]
fn bad_cases_do_not_stop_the_good_ones() {
    type Spoil = fn(&Path);
    let cases: &[(Spoil, &[&str], &[&str])] = &[
        (|_| {}, &["a", "b", "c"], &[]),
        (
            |root| edit(root, "forces/b.csv", |text| text.replace('5', "five")),
            &["a", "c"],
            &[r#"forces/b.csv:3:2: "fx_n" is "five", expected a finite number in N"#],
        ),
        (
            |root| edit(root, "cases.csv", |text| text.replace("b,2000", "a,2000")),
            &["a", "c"],
            &[
                r#"cases.csv:3:1: case "a" stands in line 2 already; rename or remove one"#,
                "forces/b.csv: has no row in cases.csv; add the row or remove the file",
            ],
        ),
        (
            |root| edit(root, "cases.csv", |text| text.replace("b,2000", "../b,2000")),
            &["a", "c"],
            &[
                r#"cases.csv:3:1: case "../b" cannot name a file; use letters, digits, blanks and -_.+()"#,
                "forces/b.csv: has no row in cases.csv; add the row or remove the file",
            ],
        ),
        (
            |root| fs::remove_file(root.join("forces/c.csv")).unwrap(),
            &["a", "b"],
            &[
                r#"cases.csv:4:1: case "c" has no file forces/c.csv; add the file or remove the row"#,
            ],
        ),
        (
            |root| edit(root, "cases.csv", |text| text.replace("b,2000,1500", "b,2000,heavy")),
            &["a", "c"],
            &[
                r#"cases.csv:3:3: "m_b_kg" is "heavy", expected 1 to 1e8 kg (mass in a collision; a fixed barrier is a very heavy body)"#,
            ],
        ),
        (
            |root| edit(root, "cases.csv", |text| text.replace("m_b_kg", "bullet_mass")),
            &["a", "b", "c"],
            &[
                r#"cases.csv:1: "m_b_kg" is missing; add it, without it the collision cannot be computed"#,
            ],
        ),
        (
            |root| edit(root, "cases.csv", |text| text.replace("b,2000", "b,")),
            &["a", "c"],
            &[
                r#"cases.csv:3:2: "m_t_kg" is blank, expected 1 to 1e8 kg (mass in a collision; a fixed barrier is a very heavy body)"#,
            ],
        ),
    ];
    for (i, (spoil, names, problems)) in cases.iter().enumerate() {
        let folder = small_dataset();
        spoil(folder.path());
        let (found_names, found_problems) = load(folder.path());
        assert_eq!(found_problems, *problems, "data set {i}");
        assert_eq!(found_names, *names, "data set {i}");
    }
}

#[test]
fn tables_of_cases_may_be_sparse_or_in_another_dialect() {
    let folder = small_dataset();
    for table in [
        "case\na\nb\nc\n",
        "case,side\na,left\nb,\nc,right\n",
        "case,side,hooked,\na,left,,\nb,,1,\nc,right,0,\n",
        "\u{feff}case;m_t_kg;remark\r\na;1500,5;\"one; two\"\r\nb;2000;\r\nc;2000;x\r\n",
    ] {
        fs::write(folder.path().join("cases.csv"), table).unwrap();
        let (names, problems) = load(folder.path());
        assert_eq!(names, ["a", "b", "c"], "{table:?}: {problems:?}");
    }
    let dataset = Dataset::load(folder.path(), &mut |_| ControlFlow::Continue(())).unwrap();
    let dataset = dataset.complete().unwrap();
    let attributes = &dataset.case("a").unwrap().attributes;
    assert_eq!(attributes.number("m_t_kg"), Some(1500.5));
    assert_eq!(attributes.text("remark"), Some("one; two"));
    let mass = DatasetKind::Force.columns().iter().find(|column| column.name == "m_b_kg").unwrap();
    let error = attributes.require(mass, "nothing moves").unwrap_err();
    assert_eq!(
        message(folder.path(), &error),
        r#"cases.csv:2: "m_b_kg" is missing; add it, without it nothing moves"#
    );
}

#[test]
fn files_of_cases_may_end_in_capitals_but_not_stand_there_twice() {
    let folder = small_dataset();
    let [small, capital] = ["csv", "CSV"].map(|end| folder.path().join(format!("forces/b.{end}")));
    fs::rename(&small, &capital).unwrap();
    let (names, problems) = load(folder.path());
    assert_eq!((names, problems), (vec!["a".into(), "b".into(), "c".into()], Vec::new()));
    fs::copy(&capital, &small).unwrap();
    let error = open(folder.path(), &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert_eq!(
        message(folder.path(), &error),
        "forces/b.CSV: is there beside forces/b.csv; keep the file that belongs to the case"
    );
}

#[test]
fn data_sets_without_a_table_are_refused() {
    let folder = small_dataset();
    let mut go_on = |_| ControlFlow::Continue(());
    edit(folder.path(), "cases.csv", |text| text.replace("case,", "name,"));
    let error = open(folder.path(), &mut go_on).unwrap_err();
    assert_eq!(
        message(folder.path(), &error),
        r#"cases.csv:1: "case" is missing; add it, without it no row can be matched to its file"#
    );
    fs::remove_file(folder.path().join("cases.csv")).unwrap();
    let error = open(folder.path(), &mut go_on).unwrap_err();
    assert_eq!(message(folder.path(), &error), "cases.csv: does not exist; check the name");
}

#[test]
fn loading_stops_when_asked_to() {
    let folder = small_dataset();
    let outcome = open(folder.path(), &mut |_| ControlFlow::Break(())).unwrap();
    assert!(outcome.complete().is_none());
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        read_all_ways(&bytes);
    }

    #[test]
    fn arbitrary_tables_never_panic(
        text in "(time|t \\[ms\\]|fx_kn|Fy|x_m|y|steer|case|,|;|\t| |\n|\"|#|%|°|-|1|2,5|0\\.1|1e9|nan|[a-z]){0,60}"
    ) {
        read_all_ways(text.as_bytes());
    }
}

fn read_all_ways(bytes: &[u8]) {
    let folder = small_dataset();
    let path = folder.path().join("cases.csv");
    fs::write(&path, bytes).unwrap();
    let map: ColumnMap = "time=1,fx=2:kN,fy=3".parse().unwrap();
    let _ = propose_columns(&path, &ReadSettings::default());
    let _ = read_force_file(&path, None);
    let _ = read_force_file(&path, Some(&map));
    let _ = read_any_series(&path, None);
    let _ = Dataset::load(folder.path(), &mut |_| ControlFlow::Continue(()));
}
