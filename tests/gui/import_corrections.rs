//! What the import dialog offers where a file contradicts itself, and what it takes back.

use egui_kittest::kittest::Queryable;
use impactlab::app::State;

use crate::harness::{is_idle, open, state, step_until};
use crate::import::{choose, map, settle, write};
use crate::pictures::save;

/// A log of a bend to the left of 50 m at 15 m/s whose y axis points to the right.
fn mirrored_bend() -> String {
    let row = |i: i32| {
        let t = f64::from(i) * 0.02;
        let (sin, cos) = (0.3 * t).sin_cos();
        format!("{t},{},{},{}\n", 50.0 * sin, 50.0 * (cos - 1.0), (0.3 * t).to_degrees())
    };
    let rows: String = (0..200).map(row).collect();
    format!("t [s],x [m],y [m],yaw [deg]\n{rows}")
}

const CONTRADICTION: &str = "the path turns to one side where the yaw angle turns to the other";

#[test]
fn a_click_mirrors_an_axis_and_another_takes_it_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, name) = write(folder.path(), "bend.csv", &mirrored_bend());
    let mut harness = open(&[&name]);
    settle(&mut harness);
    let read = "time=1:s,x=2:m,y=3:m,yaw=4:deg";
    assert_eq!(map(&harness), read);
    harness.get_by_label_contains(CONTRADICTION);
    harness.get_by_label("Mirror yaw");
    for (dark, theme) in [(false, "light"), (true, "dark")] {
        harness.state_mut().state_mut().view.dark = dark;
        harness.run_steps(4);
        save(&mut harness, &format!("import-corrections-{theme}.png"));
    }
    harness.get_by_label("Mirror y").click();
    harness.run_steps(2);
    settle(&mut harness);
    let corrected = "time=1:s,x=2:m,y=-3:m,yaw=4:deg";
    assert_eq!(map(&harness), corrected);
    assert!(harness.query_by_label_contains(CONTRADICTION).is_none(), "it is gone");
    harness.get_by_label("Corrected; a click takes it back");
    save(&mut harness, "import-corrected.png");
    harness.get_by_label("Mirror y").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), read);
    harness.get_by_label_contains(CONTRADICTION);
    harness.get_by_label("Mirror yaw").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), "time=1:s,x=2:m,y=3:m,yaw=-4:deg");
    harness.get_by_label("Reset").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), read);
    harness.get_by_label("Mirror y").click();
    harness.run_steps(2);
    settle(&mut harness);
    harness.get_by_label("Open with these columns").click();
    step_until(&mut harness, "the path", |state: &State| {
        state.session.sources.iter().any(|source| source.path == path) && is_idle(state)
    });
    let content = &state(&harness).session.sources[0].content;
    let impactlab::app::Content::File(file) = content else { panic!("a file") };
    let y = file.loaded.series.get(impactlab_core::data::Channel::Y).expect("positions");
    assert!((y[199] - 50.0 * (1.0 - (0.3_f64 * 3.98).cos())).abs() < 1e-9, "{}", y[199]);
}

/// A refusal that asks for something has its answer as a button.
#[test]
fn a_record_that_ends_at_zero_is_shifted_by_a_click() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "Time [s],Steering Wheel Angle [deg]\n-5,0\n-4,-12\n-3,-75\n0,-100\n";
    let (_, name) = write(folder.path(), "edr.csv", text);
    let mut harness = open(&[&name]);
    settle(&mut harness);
    // The message that opened the dialog says the same.
    let says = "the record runs from -5 s to 0 s";
    assert!(harness.query_all_by_label_contains(says).next().is_some());
    harness.get_by_label("Shift the time by 5 s").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), "shift=5:s,time=1:s,steering_wheel=2:deg");
    harness.get_by_label("Steering, as it will be read");
    save(&mut harness, "import-shifted.png");
}

#[test]
fn latitude_and_longitude_and_a_quaternion_can_be_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let row = |i: i32| {
        let north = 52.0 + f64::from(i) * 1e-6;
        format!("{},{north},-1,{},0,0,{}\n", f64::from(i) * 0.01, 0.35_f64.cos(), 0.35_f64.sin())
    };
    let rows: String = (0..100).map(row).collect();
    let text = format!("t [s],Breite,L\u{e4}nge,a,b,c,d\n{rows}");
    let (_, name) = write(folder.path(), "gnss.csv", &text);
    let mut harness = open(&[&name]);
    settle(&mut harness);
    choose(&mut harness, ("2: Breite", 0), "Latitude, degrees to the north");
    harness.get_by_label("choose the column of the longitude");
    choose(&mut harness, ("3: L\u{e4}nge", 0), "Longitude, degrees to the east");
    for (column, entry) in [
        ("4: a", "Quaternion w, real part"),
        ("5: b", "Quaternion x"),
        ("6: c", "Quaternion y"),
        ("7: d", "Quaternion z"),
    ] {
        choose(&mut harness, (column, 0), entry);
    }
    settle(&mut harness);
    assert_eq!(map(&harness), "time=1:s,x=east(2 3),y=north(2 3),yaw=quaternion(4 5 6 7)");
    save(&mut harness, "import-places.png");
    // 99 steps of a millionth of a degree, 111.27 km each degree.
    harness.get_by_label("11.02 m");
}
