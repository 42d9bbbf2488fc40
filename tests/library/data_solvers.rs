//! Results of finite-element solvers as their programs write them: one collision in every format.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use impactlab_core::data::{
    Channel, ColumnMap, DataError, Existing, FileKind, Loaded, Table, parts_beside, read_any_series,
};
use impactlab_core::uncertainty::{Caveat, CaveatSubject};
use impactlab_study::case_file::{CaseFile, Variant, pack, unpack};
use impactlab_study::{Drive, Event, Library, MotionSource, Question, SeriesFile, SimulateRequest};
use tempfile::TempDir;

/// Instants of a collision, ms, and the force on the slave side along x, kN: units of kg, mm and ms.
pub(crate) const TIME_MS: [f64; 5] = [0.0, 20.0, 40.0, 60.0, 80.0];
pub(crate) const FORCE_KN: [f64; 5] = [0.0, 150.0, 90.0, 0.0, 0.0];

pub(crate) const DECK: &str = "deck=kg-mm-ms";

pub(crate) fn map(text: &str) -> ColumnMap {
    text.parse().unwrap()
}

pub(crate) fn read(path: &Path, text: &str) -> Loaded {
    read_any_series(path, Some(&map(text))).unwrap()
}

pub(crate) fn fx(loaded: &Loaded) -> Vec<f64> {
    loaded.series.require(Channel::Fx).unwrap().to_vec()
}

fn notes(loaded: &Loaded) -> String {
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    notes.join("\n")
}

pub(crate) fn doubts(loaded: &Loaded) -> String {
    let doubts = loaded.notes.iter().filter(|note| note.is_doubt());
    doubts.map(|note| note.to_string() + "\n").collect()
}

pub(crate) fn assert_close(values: &[f64], expected: &[f64]) {
    assert_eq!(values.len(), expected.len(), "{values:?}");
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-6 * expected.abs().max(1.0), "{values:?}");
    }
}

pub(crate) fn file(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    path
}

/// A number as C writes it with `%E`.
pub(crate) fn e(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa}E{sign}{:02}", exponent.abs())
}

/// Contact 3 with the collision, and contact 8 with a tenth of it.
///
/// - `reaction`: the force on the master side over that on the slave side.
fn rcforc(reaction: f64) -> String {
    let mut text = " a run\n                         ls-dyna (version R12)     date 01/01/2026\n\
        {BEGIN LEGEND}\n Entity #        Title\n        3     bumper to door|\n{END LEGEND}\n\n"
        .to_owned();
    for (time, force) in TIME_MS.iter().zip(FORCE_KN) {
        for (id, share) in [(3, 1.0), (8, 0.1)] {
            for (side, sign) in [("master", reaction), ("slave ", 1.0)] {
                let [time, x, y, zero] =
                    [*time, share * sign * force, share * sign * force / 3.0, 0.0]
                        .map(|value| format!("{:>12}", e(value, 5)));
                text +=
                    &format!("  {side}{id:11} time{time}  x {x}  y {y}  z {zero} mass {zero}\n");
            }
        }
    }
    text
}

#[test]
fn the_units_of_a_model_are_asked_for_and_proposed() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "rcforc", rcforc(-1.0));
    let error = read_any_series(&path, None).unwrap_err();
    assert!(error.needs_mapping(), "{error}");
    assert_eq!(error.answer().map(ToString::to_string).as_deref(), Some(DECK), "{error}");
    let text = error.to_string();
    assert!(text.contains("the units of the model are not in the file"), "{text}");
    assert!(text.contains("duration 80.00 is 0.08000 s"), "{text}");
    // Units of the columns say it, too.
    let by_column = read(&path, "time=1:ms,fx=2:kN,fy=3:kN");
    assert_close(&fx(&by_column), &fx(&read(&path, DECK)));
    let error =
        read_any_series(&file(&folder, "f.csv", "t,fx,fy\n0,1,1\n1,1,1\n"), Some(&map(DECK)));
    assert!(matches!(error.unwrap_err(), DataError::Contradiction { .. }));
}

#[test]
fn the_contact_of_the_largest_impulse_is_read_and_its_side_is_said() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "rcforc", rcforc(-1.0));
    let loaded = read(&path, DECK);
    assert_eq!(loaded.kind, FileKind::Force);
    assert_close(&fx(&loaded), &FORCE_KN.map(|force| 1e3 * force));
    assert_close(loaded.series.time_s(), &TIME_MS.map(|time| 1e-3 * time));
    let said = doubts(&loaded);
    assert!(said.contains("contact 3 slave is read, which has the largest impulse of 4"), "{said}");
    assert!(said.contains("map sheet=contact 3 master is the force on the other side"), "{said}");
    assert!(
        notes(&loaded).contains("both sides of the contact agree to 0 %"),
        "{}",
        notes(&loaded)
    );
    // What was said is not asked again.
    let other = read(&path, &format!("{DECK},sheet=contact 3 master"));
    assert_close(&fx(&other), &FORCE_KN.map(|force| -1e3 * force));
    assert_eq!(doubts(&other), "");
    let sum = read(&path, &format!("{DECK},sheet=contact 3 slave + contact 8 slave"));
    assert_close(&fx(&sum), &FORCE_KN.map(|force| 1.1e3 * force));
    let error =
        read_any_series(&path, Some(&map("sheet=contact 4 slave"))).unwrap_err().to_string();
    assert!(error.contains("contact 3 slave: bumper to door"), "{error}");
    // The other side is no reaction.
    let lame = read(&file(&folder, "lame", rcforc(-0.8)), &format!("{DECK},sheet=1"));
    assert!(doubts(&lame).contains("both sides of the contact differ by 20"), "{}", doubts(&lame));
}

#[test]
fn a_choice_is_kept_for_the_same_model_only() {
    let folder = TempDir::new().unwrap();
    let digest = |name: &str, text: String| {
        let path = file(&folder, name, text);
        Table::read_as(&path, &map(DECK).settings).unwrap().fingerprint()
    };
    let first = digest("a", rcforc(-1.0));
    assert_eq!(first, digest("b", rcforc(-0.9)));
    assert_ne!(first, digest("c", rcforc(-1.0).replace("bumper", "fender")));
}

/// Nodes 101 and 102, 2.5 m apart, on a car that turns at 0.5 rad/s around the first, which drives at 10 m/s.
fn nodout() -> String {
    let mut text = " a run\n".to_owned();
    for (state, time_ms) in TIME_MS.into_iter().enumerate() {
        let heading = 0.2 + 0.5e-3 * time_ms;
        let heading_line =
            " nodal point  x-disp     y-disp      z-disp      x-vel       y-vel       z-vel";
        text += &format!(
            "\n n o d a l   p r i n t   o u t   f o r   t i m e  s t e p{state:8}{:30}( at time{:>14} )\n\n\
             {heading_line}\n",
            "",
            e(time_ms, 7)
        );
        for (node, arm) in [(101, 0.0), (102, 2500.0)] {
            let (sin, cos) = f64::sin_cos(heading);
            let [vx, vy] = [10.0 - 0.5e-3 * arm * sin, 0.5e-3 * arm * cos];
            let [x, y] = [10.0 * time_ms + arm * cos, 30.0 + arm * sin];
            let numbers = [0.0, 0.0, 0.0, vx, vy, 0.0, 0.0, 0.0, 0.0, x, y, 0.0];
            let cells = numbers.map(|number| format!("{:>12}", e(number, 4)));
            text += &format!("{node:9} {}\n", cells.concat());
        }
        text += "\n nodal point  x-rot      y-rot       z-rot\n      101 1.0 2.0 3.0\n";
    }
    text
}

#[test]
fn two_nodes_give_a_motion_with_its_heading() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "nodout", nodout());
    let plain = read(&path, DECK);
    assert_eq!(plain.kind, FileKind::Trajectory);
    assert!(plain.series.get(Channel::Yaw).is_none());
    assert!(doubts(&plain).contains("node 101 is read, the first of 2"), "{}", doubts(&plain));
    let loaded = read(&path, &format!("{DECK},sheet=node 101 to node 102"));
    let column = |channel| loaded.series.require(channel).unwrap().to_vec();
    // The numbers of the file have five digits.
    for (at, time_ms) in TIME_MS.into_iter().enumerate() {
        let heading = 0.2 + 0.5e-3 * time_ms;
        assert!((column(Channel::X)[at] - 0.01 * time_ms).abs() < 1e-4);
        assert!((column(Channel::Yaw)[at] - heading).abs() < 1e-3);
        assert!((column(Channel::YawRate)[at] - 0.5).abs() < 1e-3);
        assert!((column(Channel::Vx)[at] - 10.0 * heading.cos()).abs() < 1e-2);
        assert!((column(Channel::Vy)[at] + 10.0 * heading.sin()).abs() < 1e-2);
    }
    let missing = nodout().replacen("      101 ", "      103 ", 3);
    let error = read_any_series(&file(&folder, "bad", missing), Some(&map(DECK))).unwrap_err();
    assert!(error.to_string().contains("bad:"), "{error}");
}

pub(crate) fn record(command: u8, body: &[u8]) -> Vec<u8> {
    let length = 9 + body.len() as u64;
    [&length.to_le_bytes()[..], &[command], body].concat()
}

fn array(name: &str, kind: u8, values: &[u8]) -> Vec<u8> {
    record(3, &[&[kind, name.len() as u8][..], name.as_bytes(), values].concat())
}

pub(crate) fn floats(name: &str, values: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect();
    array(name, 9, &bytes)
}

pub(crate) fn ids(values: &[i32]) -> Vec<u8> {
    array("ids", 3, &values.iter().flat_map(|id| id.to_le_bytes()).collect::<Vec<u8>>())
}

pub(crate) const LSDA: [u8; 8] = [8, 8, 8, 1, 1, 1, 0, 0];

/// The forces of some states, by their indices.
pub(crate) fn binout_forces(states: &[usize]) -> Vec<u8> {
    let mut bytes = [
        LSDA.to_vec(),
        record(2, b"/rcforc/metadata"),
        ids(&[3, 3]),
        array("side", 3, &[0, 0, 0, 0, 1, 0, 0, 0]),
    ]
    .concat();
    for state in states {
        bytes.extend(record(2, format!("../d{:06}", state + 1).as_bytes()));
        bytes.extend(floats("time", &[TIME_MS[*state]]));
        for (name, share) in [("x_force", 1.0), ("y_force", 0.0), ("z_force", 0.0)] {
            let force = share * FORCE_KN[*state];
            bytes.extend(floats(name, &[force, -force]));
        }
    }
    bytes
}

/// The momenta of two cars of 1000 kg.
///
/// - `share`: what of the impulse the first one gains;
/// - `starts_m_s`: their speeds at the start.
fn binout_momenta(share: f64, starts_m_s: [f64; 2]) -> Vec<u8> {
    let [first_m_s, second_m_s] = starts_m_s;
    let mut bytes = [LSDA.to_vec(), record(2, b"/matsum/metadata"), ids(&[1, 2])].concat();
    let mut gained = 0.0;
    for (state, time_ms) in TIME_MS.into_iter().enumerate() {
        let before = state.checked_sub(1).map_or(0.0, |before| FORCE_KN[before]);
        gained += share * 10.0 * (FORCE_KN[state] + before);
        bytes.extend(record(2, format!("../d{:06}", state + 1).as_bytes()));
        bytes.extend(floats("time", &[time_ms]));
        let momenta = [1000.0 * first_m_s + gained, 1000.0 * second_m_s - gained];
        bytes.extend(floats("x_momentum", &momenta));
        bytes.extend(floats("y_momentum", &[0.0, 0.0]));
        bytes.extend(floats("x_rbvelocity", &momenta.map(|momentum| momentum / 1000.0)));
        bytes.extend(floats("y_rbvelocity", &[0.0, 0.0]));
    }
    bytes
}

/// A binout in three parts, of which the second repeats a state of the first.
fn binout(folder: &TempDir, share: f64) -> PathBuf {
    file(folder, "binout0000%001", binout_forces(&[2, 3, 4]));
    file(folder, "binout0001", binout_momenta(share, [0.0, 9.0]));
    file(folder, "binout0000", binout_forces(&[0, 1, 2]))
}

#[test]
fn a_binout_in_three_parts_is_one_force_that_its_momenta_confirm() {
    let folder = TempDir::new().unwrap();
    let path = binout(&folder, 1.0);
    let names = ["binout0000", "binout0000%001", "binout0001"];
    let expected = names.map(|name| folder.path().join(name));
    assert_eq!(parts_beside(&path), expected);
    let loaded = read(&path, &format!("{DECK},sheet=contact 3 slave"));
    assert_close(&fx(&loaded), &FORCE_KN.map(|force| 1e3 * force));
    let text = notes(&loaded);
    assert!(text.contains("read from 3 files"), "{text}");
    assert!(text.contains("the parts that begin with (0, 0) m/s changes by the impulse"), "{text}");
    assert!(doubts(&loaded).contains("1 states were written again"), "{}", doubts(&loaded));
    let other = read(&path, &format!("{DECK},sheet=contact 3 master"));
    assert!(notes(&other).contains("begin with (9.000, 0) m/s changes"), "{}", notes(&other));
    for part in &expected[1..] {
        assert_eq!(read(part, &format!("{DECK},sheet=1")).series, loaded.series);
    }
    // Another contact or the road acts on both cars.
    let lost = read(&binout(&folder, 0.7), &format!("{DECK},sheet=1"));
    assert!(doubts(&lost).contains("differs by 30.00 %"), "{}", doubts(&lost));
    fs::rename(&expected[1], folder.path().join("binout0000%002")).unwrap();
    let error = read_any_series(&path, Some(&map(DECK))).unwrap_err().to_string();
    assert!(error.contains("binout0000%002: the part before it is not in the folder"), "{error}");
}

/// The speed at the start of a car under the force of a map, m/s, and what is said of it, or the error.
fn speed_of(path: &Path, text: &str) -> Result<(f64, String), String> {
    let file = SeriesFile { map: Some(map(text)), ..SeriesFile::new(path.to_owned()) };
    let request = SimulateRequest {
        vehicle_draws: Some(0),
        duration_s: 1.0,
        ..SimulateRequest::new(MotionSource::Drive(Drive { force: Some(file), ..Drive::default() }))
    };
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let answer = request.answer(&Library::default(), &mut go_on);
    let answer = answer.map_err(|error| impactlab_core::error_chain(&error))?.complete().unwrap();
    let of_speed = |caveat: &&Caveat| caveat.subject == Some(CaveatSubject::Speed);
    let said: Vec<String> =
        answer.report.caveats.iter().filter(of_speed).map(ToString::to_string).collect();
    let series = &answer.analysis.simulation.unwrap().series;
    Ok((series.require(Channel::Vx).unwrap()[0], said.join("; ")))
}

#[test]
fn the_car_of_a_binout_drives_as_its_parts_begin() {
    let folder = TempDir::new().unwrap();
    let path = binout(&folder, 1.0);
    let begins = |text: &str| {
        let start = read(&path, text).model_start.unwrap();
        (start.of_force_m_s, start.all_m_s.len())
    };
    let [slave, master] = ["slave", "master"].map(|side| format!("{DECK},sheet=contact 3 {side}"));
    assert_eq!(begins(&slave), (Some([0.0, 0.0]), 2));
    let (of_master, _) = begins(&master);
    assert!((of_master.unwrap()[0] - 9.0).abs() < 1e-5, "{of_master:?}");
    let (speed_m_s, said) = speed_of(&path, &master).unwrap();
    assert!((speed_m_s - 9.0).abs() < 1e-5, "{speed_m_s} m/s");
    assert!(said.contains("in binout0000") && said.contains("by their momenta"), "{said}");
    assert_eq!(speed_of(&path, &slave).unwrap().0, 0.0, "it stands, and does not drive 72 km/h");
    // The other car under this force is not the one of which the momenta speak.
    let turned = format!("{slave},fx=-2,fy=-3");
    assert_eq!(read(&path, &turned).model_start, None);
    let (speed_m_s, said) = speed_of(&path, &turned).unwrap();
    assert!(speed_m_s == 20.0 && said.contains("is not known"), "{said}");
    // Momenta that do not go with the force leave open which car it is.
    let lost = binout(&folder, 0.7);
    assert_eq!(read(&lost, &slave).model_start.unwrap().of_force_m_s, None);
    let (_, said) = speed_of(&lost, &slave).unwrap();
    assert!(said.contains("which parts of the model"), "{said}");
}

/// A car of a model all of which stood at the start drove 72 km/h.
#[test]
fn parts_that_begin_alike_say_how_the_car_begins() {
    let folder = TempDir::new().unwrap();
    let path = binout(&folder, 1.0);
    for begins_m_s in [0.0, 9.0] {
        file(&folder, "binout0001", binout_momenta(1.0, [begins_m_s; 2]));
        let (speed_m_s, said) = speed_of(&path, &format!("{DECK},sheet=contact 3 slave")).unwrap();
        assert!((speed_m_s - begins_m_s).abs() < 1e-5, "{speed_m_s} m/s");
        assert!(said.contains("all parts begin with it"), "{said}");
    }
    // A part whose velocity is no number may be the car.
    file(&folder, "binout0001", binout_momenta(1.0, [0.0, f64::NAN]));
    let (speed_m_s, said) = speed_of(&path, &format!("{DECK},sheet=contact 3 master")).unwrap();
    assert!(speed_m_s == 20.0 && said.contains("which parts of the model"), "{said}");
}

/// The momenta of two cars of 1000 kg, as text.
///
/// - `title`: that of the run;
/// - `share`: what of the impulse of contact 3 the first one gains;
/// - `starts_m_s`: their speeds at the start.
fn matsum(title: &str, share: f64, starts_m_s: [f64; 2]) -> String {
    let mut text = format!(" {title}\n{{BEGIN LEGEND}}\n Entity #        Title\n{{END LEGEND}}\n");
    let mut gained = 0.0;
    for (state, time_ms) in TIME_MS.into_iter().enumerate() {
        let before = state.checked_sub(1).map_or(0.0, |before| FORCE_KN[before]);
        gained += share * 10.0 * (FORCE_KN[state] + before);
        text += &format!("\n\n time ={:>13}\n", e(time_ms, 4));
        for (id, sign) in [(1, 1.0), (2, -1.0)] {
            let x = 1000.0 * starts_m_s[id - 1] + sign * gained;
            let y = sign * gained / 3.0;
            let [x, y, vx, vy, zero] =
                [x, y, x / 1e3, y / 1e3, 0.0].map(|value| format!("{:>13}", e(value, 4)));
            text += &format!(
                " mat.#={id:5}             inten={zero}     kinen={zero}\n \
                 x-mom={x}     y-mom={y}     z-mom={zero}\n \
                 x-rbv={vx}     y-rbv={vy}     z-rbv={zero}\n{:25}hgeng={zero}\n\n\n",
                ""
            );
        }
    }
    text
}

/// An ASCII `rcforc` drove its car at 72 km/h, whatever the `matsum` beside it said.
#[test]
fn the_car_of_an_rcforc_drives_as_the_parts_of_its_matsum_begin() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "rcforc", rcforc(-1.0));
    let [slave, master] = ["slave", "master"].map(|side| format!("{DECK},sheet=contact 3 {side}"));
    assert_eq!(parts_beside(&path), Vec::<PathBuf>::new());
    assert!(speed_of(&path, &master).unwrap().1.contains("is not known"));
    let momenta = file(&folder, "matsum", matsum("a run", 1.0, [0.0, 9.0]));
    assert_eq!(parts_beside(&path), [path.clone(), momenta.clone()]);
    let loaded = read(&path, &slave);
    let text = notes(&loaded);
    assert!(text.contains("momenta of the parts: matsum beside it"), "{text}");
    assert!(text.contains("the parts that begin with (0, 0) m/s changes by the impulse"), "{text}");
    assert_eq!(doubts(&loaded), "");
    assert_eq!(speed_of(&path, &slave).unwrap().0, 0.0, "it stands, and does not drive 72 km/h");
    let (speed_m_s, said) = speed_of(&path, &master).unwrap();
    assert!((speed_m_s - 9.0).abs() < 1e-5 && said.contains("by their momenta"), "{said}");
    // Another contact or the road acts, too.
    file(&folder, "matsum", matsum("a run", 0.7, [0.0, 9.0]));
    assert!(doubts(&read(&path, &slave)).contains("differs by 30.00 %"));
    // What cannot be used is named.
    let damaged = matsum("a run", 1.0, [0.0, 9.0]).replacen(" x-rbv=", " x-rbv=nan", 1);
    for (text, expected) in [
        (matsum("a run before", 1.0, [0.0, 9.0]), "is of another run, \"a run before\""),
        (damaged, "matsum:10: "),
        ("nothing\n".to_owned(), "has no states with momenta"),
    ] {
        file(&folder, "matsum", text);
        let said = doubts(&read(&path, &slave));
        assert!(said.contains(expected), "{said}");
        assert!(speed_of(&path, &master).unwrap().1.contains("is not known"));
    }
    file(&folder, "matsum", matsum("a run", 1.0, [0.0, 9.0]));
    let error = read_any_series(&momenta, None).unwrap_err().to_string();
    assert!(error.contains("an LS-DYNA matsum file; open the rcforc beside it"), "{error}");
}

#[test]
fn a_car_of_a_model_that_does_not_drive_along_x_is_refused() {
    let folder = TempDir::new().unwrap();
    let path = binout(&folder, 1.0);
    // The second car drives against x, and the first one is pushed that way.
    for name in ["binout0000", "binout0000%001", "binout0001"] {
        let path = folder.path().join(name);
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, turned_around(&bytes)).unwrap();
    }
    let master = format!("{DECK},sheet=contact 3 master");
    let error = speed_of(&path, &master).unwrap_err();
    assert!(error.contains("(-9.00, ") && error.contains("fx=-2,fy=-3"), "{error}");
}

/// A binout with the signs of all forces, momenta and velocities turned.
fn turned_around(bytes: &[u8]) -> Vec<u8> {
    let mut turned = bytes.to_vec();
    for name in ["x_force", "x_momentum", "x_rbvelocity"] {
        let found = |at: &usize| bytes[*at..].starts_with(name.as_bytes());
        for at in (0..bytes.len()).filter(found) {
            for value in 0..2 {
                // Numbers of four bytes, the lowest first: the sign is in the last one.
                turned[at + name.len() + 4 * value + 3] ^= 0x80;
            }
        }
    }
    turned
}

#[test]
fn a_case_takes_all_parts_of_a_binout_with_it() {
    let folder = TempDir::new().unwrap();
    let path = binout(&folder, 1.0);
    // The case names another part than the first.
    let mut force = SeriesFile::new(folder.path().join("binout0000%001"));
    force.map = Some(map(&format!("{DECK},sheet=contact 3 slave")));
    let drive = Drive { speed_m_s: Some(20.0), force: Some(force), ..Drive::default() };
    let simulate = SimulateRequest::new(MotionSource::Drive(drive));
    let variant = Variant {
        name: "crash".to_owned(),
        questions: vec![simulate.into()],
        ..Variant::default()
    };
    let mut case = CaseFile::new("Crash", variant);
    case.record_files();
    assert_eq!(case.files.len(), 3);
    let package = folder.path().join("crash.zip");
    let packed = pack(&case, &package, Existing::Refuse).unwrap();
    assert_eq!(packed.len(), 3, "{packed:?}");
    let unpacked =
        CaseFile::load(&unpack(&package, &folder.path().join("there")).unwrap()).unwrap();
    let moved = unpacked.used_paths();
    assert_eq!(moved.len(), 3, "{moved:?}");
    let map = format!("{DECK},sheet=contact 3 slave");
    assert_eq!(read(&moved[0], &map).series, read(&path, &map).series);
}

fn fortran(payload: &[u8]) -> Vec<u8> {
    let length = (payload.len() as i32).to_be_bytes();
    [&length[..], payload, &length].concat()
}

fn integers(values: &[i32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_be_bytes()).collect()
}

fn titled(before: &[i32], title: &str, after: &[i32]) -> Vec<u8> {
    fortran(&[integers(before), format!("{title:100}").into_bytes(), integers(after)].concat())
}

fn state(values: &[f64]) -> Vec<u8> {
    fortran(&values.iter().flat_map(|value| (*value as f32).to_be_bytes()).collect::<Vec<u8>>())
}

/// Contact 3, whose force rises to 300 kN and falls along straight lines, as impulse; spring 8 of the same
/// force; a node.
fn t01() -> Vec<u8> {
    let mut bytes = [
        fortran(&[integers(&[4021]), vec![b' '; 80]].concat()),
        fortran(&[b' '; 80]),
        fortran(&integers(&[2])),
        fortran(&integers(&[100])),
        state(&[1.0, 1e-3, 1e-3]),
        fortran(&integers(&[0, 0, 0, 0, 3, 0])),
        titled(&[1, 101, 0, 1, 6], "contacts", &[]),
        titled(&[3], "bumper to door", &[]),
        fortran(&integers(&[1, 2, 3, 4, 5, 6])),
        titled(&[2, 6, 0, 1, 3], "springs", &[]),
        titled(&[8], "strut", &[]),
        fortran(&integers(&[2, 3, 4])),
        titled(&[3, 0, 0, 1, 4], "nodes", &[]),
        titled(&[101], "CG", &[]),
        fortran(&integers(&[4, 5, 16, 17])),
    ]
    .concat();
    for step in 0..=100 {
        let (time, force, impulse) = ramp(step);
        bytes.extend(state(&[time]));
        // Two thirds act along the normal, one third is friction.
        bytes.extend(state(&[impulse * 2.0 / 3.0, 0.0, 0.0, impulse / 3.0, 0.0, 0.0]));
        bytes.extend(state(&[force, 0.0, 0.0]));
        bytes.extend(state(&[10.0, 0.0, 10.0 * time, 0.0]));
    }
    bytes
}

/// Time in ms, force in kN and its impulse: 0 to 300 kN within 40 ms and back within 40 ms more.
fn ramp(step: i32) -> (f64, f64, f64) {
    let time = f64::from(step);
    let up = time.min(40.0);
    let down = (time - 40.0).clamp(0.0, 40.0);
    (time, 7.5 * (up - down), 7.5 * (up * up / 2.0 + 40.0 * down - down * down / 2.0))
}

#[test]
fn impulses_of_radioss_are_differentiated_and_forces_of_springs_are_not() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "runT01", t01());
    let error = read_any_series(&path, None).unwrap_err();
    assert_eq!(error.answer().map(ToString::to_string).as_deref(), Some(DECK), "{error}");
    assert!(error.to_string().contains("the file has the factors of kg-mm-ms"), "{error}");
    let contact = read(&path, DECK);
    for (step, force) in fx(&contact).into_iter().enumerate() {
        let expected = 1e3 * ramp(step as i32).1;
        // Over two steps the corners of the curve are cut.
        assert!((force - expected).abs() < 4e3, "{step}: {force} and {expected}");
    }
    assert!(notes(&contact).contains("stored as impulses"), "{}", notes(&contact));
    assert!(doubts(&contact).contains("sheet=contact 3 reversed"), "{}", doubts(&contact));
    let reversed = read(&path, &format!("{DECK},sheet=contact 3 reversed"));
    assert_eq!(fx(&reversed).iter().map(|f| 0.0 - f).collect::<Vec<_>>(), fx(&contact));
    let spring = read(&path, &format!("{DECK},sheet=spring 8"));
    assert_close(&fx(&spring), &(0..=100).map(|step| 1e3 * ramp(step).1).collect::<Vec<_>>());
    assert_eq!(doubts(&spring), "");
    assert!(notes(&spring).contains("on which of its two sides"), "{}", notes(&spring));
    let node = read(&path, &format!("{DECK},sheet=node 101"));
    assert!((node.series.require(Channel::X).unwrap()[100] - 1.0).abs() < 1e-6);
}

#[test]
fn a_run_that_was_ended_leaves_out_its_last_state() {
    let folder = TempDir::new().unwrap();
    let bytes = t01();
    let cut =
        read(&file(&folder, "cutT01", &bytes[..bytes.len() - 10]), &format!("{DECK},sheet=1"));
    assert_eq!(cut.series.n_samples(), 100);
    assert!(doubts(&cut).contains("the last state is not complete"), "{}", doubts(&cut));
    let text = rcforc(-1.0);
    let cut = &text[..text.len() - 30];
    let cut = read(&file(&folder, "rcforc", cut), &format!("{DECK},sheet=1"));
    assert_eq!(cut.series.n_samples(), TIME_MS.len() - 1);
    assert!(doubts(&cut).contains("the last line has no end"), "{}", doubts(&cut));
}

#[test]
fn a_secforc_is_a_force() {
    let folder = TempDir::new().unwrap();
    let mut text =
        " line#1  section#     time         x-force     y-force     z-force    magnitude\n \
        line#2  resultant  moments        x-moment    y-moment    z-moment   magnitude\n \
        line#3  centroids                 x           y           z          area\n\n"
            .to_owned();
    for (time, force) in TIME_MS.iter().zip(FORCE_KN) {
        let cells = [*time, force, 0.0, 0.0, force].map(|value| format!("{:>12}", e(value, 4)));
        let rest = [0.0; 4].map(|value| format!("{:>12}", e(value, 4))).concat();
        text += &format!("{:>12}{}\n{:24}{rest}\n{:24}{rest}\n\n", 2, cells.concat(), "", "");
    }
    let loaded = read(&file(&folder, "secforc", text), &format!("{DECK},sheet=section 2"));
    assert_close(&fx(&loaded), &FORCE_KN.map(|force| 1e3 * force));
    assert!(notes(&loaded).contains("in the axes of the section"), "{}", notes(&loaded));
}
