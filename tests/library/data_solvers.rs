//! Results of finite-element solvers as their programs write them: one collision in every format.

use std::fs;

use impactlab_core::data::{
    Channel, DataError, Existing, FileKind, Table, parts_beside, read_any_series,
};
use impactlab_study::case_file::{CaseFile, Variant, pack, unpack};
use impactlab_study::{Drive, MotionSource, SeriesFile, SimulateRequest};
use tempfile::TempDir;

use crate::solver_files::{
    DECK, FORCE_KN, TIME_MS, assert_close, binout, doubts, e, file, fx, map, notes, rcforc, read,
};

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
