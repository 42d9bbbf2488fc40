//! Files that are made to take long or to fill the memory, and files that are no files.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs::{self, File};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use impactlab_core::data::{
    Dataset, MAX_CASES, Opened, ReadSettings, open, propose_columns, read_force_file,
};
use tempfile::TempDir;

/// Longest time to refuse or to read a file of less than a megabyte, on a machine that is busy. Each
/// file here took a minute or more when the time grew with the square of its size.
const PATIENCE: Duration = Duration::from_secs(5);

fn write(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> std::path::PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    path
}

/// The result of reading a force file with this content: its remarks or the error, without the name
/// of the folder.
fn force_file(content: &str) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = write(&folder, "f.csv", content);
    let started = Instant::now();
    let loaded = read_force_file(&path, None);
    let _ = propose_columns(&path, &ReadSettings::default());
    let took = started.elapsed();
    assert!(took < PATIENCE, "{took:?} for {} bytes: {:.60}", content.len(), content);
    match loaded {
        Ok(loaded) => Ok(loaded.notes.iter().map(ToString::to_string).collect()),
        Err(error) => {
            let folder = format!("{}/", folder.path().display());
            Err(error.to_string().replace(&folder, ""))
        }
    }
}

const ROWS: &str = "0,1,2,3\n0.1,1,2,3\n0.2,1,2,3\n";

#[test]
fn the_time_to_understand_a_header_grows_with_its_length_only() {
    for part in ["_", "! ", "a b ", "[", "(]", "°", " in ", "\"", "fx "] {
        for n_bytes in [10_000, 40_000, 250_000, 400_000] {
            let long = part.repeat(n_bytes / part.len());
            let cells = |name: String| name.repeat(n_bytes / name.len());
            for header in [
                format!("t,fx,fy,fx{long}zz"),
                format!("t,fx,fy,{long}"),
                // As many cells as fit, each as long as a header that is understood.
                format!("t,fx,fy{}", cells(format!(",fx{:.60}zz", part.repeat(60)))),
                format!("t fx fy {}", cells(format!(" time{:.30}[furlong]", part.repeat(30)))),
            ] {
                let _ = force_file(&format!("{header}\n{ROWS}"));
            }
        }
    }
    let many: String = (0..4000).map(|i| format!(",c_{i}")).collect();
    let notes = force_file(&format!("t,fx,fy{many}\n{0}{0}", format!("0{}\n", ",1".repeat(4002))));
    assert_eq!(
        notes.unwrap_err(),
        "f.csv:3:1: time is 0 s after 0 s in the row before, expected a later time; sort the rows and remove doubles"
    );
}

#[test]
fn long_cells_lines_and_tables_are_refused_with_their_place() {
    let a = |n: usize| "a".repeat(n);
    let wide = ",1".repeat(4096);
    for (content, message) in [
        (
            format!("t,fx,fy,{}\n{ROWS}", a(65_536)),
            "f.csv:1:4: the cell has 65536 bytes, at most 4096 are read; shorten it",
        ),
        (
            format!("t,fx,fy,note\n{ROWS}0.3,1,2,{}\n", a(65_537)),
            "f.csv:5:4: the cell has 65537 bytes, at most 4096 are read; shorten it",
        ),
        (
            format!("t,fx,fy,note\n{ROWS}\n\n0.3,1,2,\"{}\"\n", "b\n".repeat(40_000)),
            "f.csv:7:4: the cell has 80000 bytes, at most 4096 are read; shorten it",
        ),
        (
            format!("t,fx,fy\n{}", a(1 << 21)),
            "f.csv:2: the line has 2097152 bytes, at most 262144 are read; is it the right file?",
        ),
        (
            format!("t{wide}\n0{wide}\n"),
            "f.csv:1: has 4097 columns, at most 4096 are read; remove some",
        ),
    ] {
        assert_eq!(force_file(&content).unwrap_err(), message);
    }
    // A header nearly as long as a line may be does not hide the rows below it.
    let wide = format!(",{}", a(1000)).repeat(250);
    let row = format!("0,1,1{}", ",1".repeat(250));
    let notes = force_file(&format!("t,fx,fy{wide}\n{row}\n"));
    assert!(notes.unwrap_err().starts_with("f.csv:1: rows of numbers below the header: 1,"));
    // The longest cell and the widest table that are read.
    let notes = force_file(&format!("t,fx,fy,note\n0,1,2,{}\n1,1,2,x\n", a(4096)));
    assert_eq!(notes.unwrap().last().unwrap(), "not recognised: note");
    let wide = ",1".repeat(4093);
    let notes = force_file(&format!("t,fx,fy{}\n0,1,1{wide}\n1,1,1{wide}\n", ",c".repeat(4093)));
    let notes = notes.unwrap();
    assert!(notes.last().unwrap().ends_with(", c and 3993 more"), "{notes:?}");
}

#[test]
fn messages_quote_the_beginning_of_a_long_text_only() {
    let a = "a".repeat(4000);
    let error = force_file(&format!("t,fx,fy\n0,{a},2\n1,1,1\n")).unwrap_err();
    let expected = format!("f.csv:2:2: \"fx\" is \"{:.60}\"…, expected a finite number in N", a);
    assert_eq!(error, expected);
}

/// Writes a data set of the cases `a`, `b` and `c`, whose files are left to the test.
fn dataset() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let header = "case,m_t_kg,m_b_kg,v_tx_m_s,v_ty_m_s,v_bx_m_s,v_by_m_s,theta_b_rad,contact_x_m,contact_y_m";
    let rows = ["a", "b", "c"].map(|case| format!("{case},2000,1500,10,0,12,1,0.2,-1.4,-0.9\n"));
    write(&folder, "cases.csv", format!("{header}\n{}", rows.concat()));
    fs::create_dir(folder.path().join("forces")).unwrap();
    write(&folder, "forces/a.csv", "time_s,fx_n,fy_n\n0,0,0\n0.1,5,9\n0.2,0,0\n");
    folder
}

/// The names of the cases that were read and the problems, or the error, without the folder.
fn load(root: &Path) -> Result<(Vec<String>, Vec<String>), String> {
    let without = |text: String| text.replace(&format!("{}/", root.display()), "");
    let opened = open(root, &mut |_| ControlFlow::Continue(()));
    match opened.map_err(|error| without(error.to_string()))?.complete().unwrap() {
        Opened::Dataset(Dataset { cases, problems, .. }) => Ok((
            cases.into_iter().map(|case| case.name).collect(),
            problems.iter().map(|problem| without(problem.to_string())).collect(),
        )),
        other => panic!("{other:?}"),
    }
}

#[cfg(unix)]
fn pipe(path: &Path) {
    let made = std::process::Command::new("mkfifo").arg(path).status().unwrap();
    assert!(made.success(), "{}", path.display());
}

#[cfg(unix)]
#[test]
fn a_pipe_among_the_cases_blocks_nothing() {
    let folder = dataset();
    pipe(&folder.path().join("forces/b.csv"));
    fs::create_dir(folder.path().join("forces/c.csv")).unwrap();
    let (names, problems) = load(folder.path()).unwrap();
    assert_eq!(names, ["a"]);
    assert_eq!(
        problems,
        ["forces/b.csv: is a pipe, expected a file", "forces/c.csv: is a folder, expected a file"]
    );
    fs::remove_file(folder.path().join("cases.csv")).unwrap();
    pipe(&folder.path().join("cases.csv"));
    assert_eq!(load(folder.path()).unwrap_err(), "cases.csv: is a pipe, expected a file");
}

#[cfg(unix)]
#[test]
fn links_are_followed_to_files_and_loops_are_refused() {
    use std::os::unix::fs::symlink;
    let folder = dataset();
    let path = |name: &str| folder.path().join(name);
    symlink(path("forces/a.csv"), path("forces/b.csv")).unwrap();
    symlink(path("forces/c.csv"), path("forces/c.csv")).unwrap();
    symlink(folder.path(), path("forces/all")).unwrap();
    let (names, problems) = load(folder.path()).unwrap();
    assert_eq!(names, ["a", "b"]);
    assert_eq!(problems, ["forces/c.csv: cannot be read or written"]);
}

#[test]
fn tables_of_cases_and_folders_have_a_largest_size() {
    let folder = dataset();
    write(&folder, "cases.csv", format!("case\n{}", "a\n".repeat(MAX_CASES + 1)));
    let error = load(folder.path()).unwrap_err();
    assert_eq!(error, "cases.csv: has 100001 cases, at most 100000 are read; split the data set");
    let row = ",".repeat(1000);
    write(&folder, "cases.csv", format!("case{row}x\n{}", format!("a{row}x\n").repeat(4000)));
    let error = load(folder.path()).unwrap_err();
    assert_eq!(error, "cases.csv: has 4004000 cells, at most 4000000 are read; split the data set");
    write(&folder, "cases.csv", format!("case,note\n{}", format!("a,{row}\n").repeat(20_000)));
    let error = load(folder.path()).unwrap_err();
    assert!(error.starts_with("cases.csv: has 20060010 bytes, at most 16777216"), "{error}");
    for i in 0..=MAX_CASES {
        File::create(folder.path().join(format!("forces/{i}"))).unwrap();
    }
    write(&folder, "cases.csv", "case\na\n");
    let error = load(folder.path()).unwrap_err();
    assert!(error.ends_with("forces: has more than 100000 entries; is it the right folder?"));
}

#[test]
fn the_files_of_a_data_set_have_a_largest_size_together() {
    let folder = dataset();
    // Text at the beginning, so that the size is all that is wrong; sparse, so that they take no
    // room on the disk.
    for case in ["b", "c"] {
        let path = write(&folder, &format!("forces/{case}.csv"), "0,1,1\n".repeat(20_000));
        File::options().write(true).open(path).unwrap().set_len(1 << 30).unwrap();
    }
    let error = load(folder.path()).unwrap_err();
    assert!(
        error.ends_with(
            "forces: has 2147483687 bytes, at most 1073741824 are read; split it or thin it out"
        ),
        "{error}"
    );
}

/// A motion whose last instant is 9 · 10⁵ s after its first, every 10 ms of which once were allocated.
#[test]
fn a_motion_or_a_log_of_ten_days_is_refused() {
    use impactlab_core::data::read_motion_log;
    use impactlab_core::vehicle::Preset;
    use impactlab_networks::response::{LogSettings, LoggedImpact, MotionLog, ResponseCase};
    let folder = tempfile::tempdir().unwrap();
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/trajectories-fea");
    let table = fs::read_to_string(shipped.join("cases.csv")).unwrap();
    write(&folder, "cases.csv", table.lines().take(2).collect::<Vec<_>>().join("\n"));
    fs::create_dir(folder.path().join("trajectories")).unwrap();
    let recorded = fs::read_to_string(shipped.join("trajectories/FE_c001.csv")).unwrap();
    // It stands still for that time: a speed would contradict the place.
    let header: Vec<&str> = recorded.lines().next().unwrap().split(',').collect();
    let last: Vec<&str> = recorded.lines().last().unwrap().split(',').collect();
    let at = |time_s: &str| {
        let cell = |(name, cell): (&&str, &&str)| match *name {
            "time_s" => time_s.to_owned(),
            "vx_m_s" | "vy_m_s" | "yaw_rate_rad_s" => "0".to_owned(),
            _ => (*cell).to_owned(),
        };
        header.iter().zip(&last).map(cell).collect::<Vec<String>>().join(",")
    };
    let end_s: f64 = last[0].parse().unwrap();
    let late = format!("{}\n{}\n", at(&(end_s + 0.01).to_string()), at("9e5"));
    let path = write(&folder, "trajectories/FE_c001.csv", recorded.clone() + &late);
    let opened = open(folder.path(), &mut |_| ControlFlow::Continue(())).unwrap();
    let Opened::Dataset(dataset) = opened.complete().unwrap() else { panic!("a data set") };
    assert_eq!(dataset.cases.len(), 1, "{:?}", dataset.problems);
    let vehicle = Preset::Reference.parameters();
    let (cases, problems) = ResponseCase::from_dataset(&dataset, &vehicle);
    assert!(cases.is_empty());
    let message = problems[0].to_string();
    assert_eq!(message, "case FE_c001: lasts 900000 s, expected 3600 s or less; check its time");
    let series = read_motion_log(&path, None).unwrap().series;
    let log = MotionLog { path, series };
    let settings = LogSettings { vehicle, has_impact: true, impact_s: None, duration_s: 4.0 };
    let error = LoggedImpact::from_log(&log, None, &settings).unwrap_err();
    let message = error.to_string();
    assert!(
        message.ends_with(
            "FE_c001.csv: lasts 900000 s, expected 3600 s or less; check its time or cut it"
        ),
        "{message}"
    );
}
