//! What the import dialog offers for separators, signs within numbers, units and clocks, and what is left of a
//! file that was cancelled.

use egui_kittest::kittest::Queryable;
use impactlab::app::Command;

use crate::harness::{apply, is_idle, open, state, step_until};
use crate::import::{choose, map, settle, write};
use crate::pictures::save;

/// Forces with three decimals or with thousands: nothing in the file says which.
const OPEN: &str = "Zeit [ms];Fx [N];Fy [N]\n0;1.860;0\n1;2.500;0\n2;1.250;0\n";

#[test]
fn a_number_that_may_be_two_is_asked_back_and_the_answer_read_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, name) = write(folder.path(), "f.csv", OPEN);
    let mut harness = open(&[&name]);
    settle(&mut harness);
    assert_eq!(map(&harness), "time=1:ms,fx=2:N,fy=3:N");
    harness.get_by_label("Decimal points");
    save(&mut harness, "import-open-number.png");
    harness.get_by_label("Points between thousands").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), "thousands=point,time=1:ms,fx=2:N,fy=3:N");
    harness.get_by_label("2.500 kN at 1.000 ms");
    // The same by the list, which keeps what was chosen for the columns.
    choose(&mut harness, ("Thousands", 0), "as found");
    choose(&mut harness, ("Decimal sign", 0), "point");
    settle(&mut harness);
    assert_eq!(map(&harness), "decimal=point,time=1:ms,fx=2:N,fy=3:N");
    harness.get_by_label("2.500 N at 1.000 ms");
    choose(&mut harness, ("Decimal sign", 0), "comma");
    settle(&mut harness);
    harness.get_by_label("Open with these columns").click();
    step_until(&mut harness, "the force", |state| {
        state.session.sources.iter().any(|source| source.path == path) && is_idle(state)
    });
    // Another file with this header is read alike.
    let again = OPEN.replace("1.860", "3.860");
    let (second, _) = write(folder.path(), "g.csv", &again);
    apply(&mut harness, Command::Open(vec![second]));
    step_until(&mut harness, "the second force", |state| {
        state.session.sources.len() == 2 && is_idle(state)
    });
    let content = &state(&harness).session.sources[1].content;
    let impactlab::app::Content::File(file) = content else { panic!("a file") };
    let fx = file.loaded.series.get(impactlab_core::data::Channel::Fx).expect("a force");
    assert_eq!(fx, [3860.0, 2500.0, 1250.0]);
}

#[test]
fn a_separator_is_chosen_and_all_units_become_si_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, name) = write(folder.path(), "f.csv", "Time;Fx;Fy\n0;0;0\n1;7;2\n2;0;0\n");
    let mut harness = open(&[&name]);
    settle(&mut harness);
    harness.get_by_label("All SI").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), "time=1:s,fx=2:N,fy=3:N");
    choose(&mut harness, ("Separator", 0), "comma");
    settle(&mut harness);
    // One column, whose name has the word time in it.
    assert_eq!(map(&harness), "separator=comma,time=1");
    choose(&mut harness, ("Separator", 0), "semicolon");
    harness.run_steps(2);
    settle(&mut harness);
    harness.get_by_label("All SI").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), "separator=semicolon,time=1:s,fx=2:N,fy=3:N");
}

/// Its nanoseconds were taken for seconds.
#[test]
fn all_si_leaves_a_stamp_in_nanoseconds_what_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let row = |i: u64| format!("{},{},0,0\n", 1_700_000_000_000_000_000 + i * 10_000_000, i);
    let rows: String = (0..20).map(row).collect();
    let (_, name) = write(folder.path(), "log.csv", &format!("time,x,y,yaw\n{rows}"));
    let mut harness = open(&[&name]);
    settle(&mut harness);
    harness.get_by_label("All SI").click();
    harness.run_steps(2);
    settle(&mut harness);
    let found = map(&harness);
    assert!(found.contains("time=1:ns") && found.contains("x=2:m,y=3:m"), "{found}");
}

/// Such a log opened without a word, and nothing that begins at 0 could use it.
#[test]
fn a_clock_since_1970_is_set_to_zero_by_a_click() {
    let folder = tempfile::tempdir().expect("a folder");
    let row = |i: u32| format!("{},{},0\n", 1_700_000_000.0 + f64::from(i) * 0.5, 5 * i);
    let rows: String = (0..20).map(row).collect();
    let (_, name) = write(folder.path(), "log.csv", &format!("time [s],x [m],y [m]\n{rows}"));
    let mut harness = open(&[&name]);
    settle(&mut harness);
    let says = "the record begins at 1700000000 s, on a clock that counts since 1970";
    harness.get_by_label_contains(says);
    harness.get_by_label("First row at 0").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), "shift=-1700000000:s,time=1:s,x=2:m,y=3:m");
    assert!(harness.query_by_label_contains(says).is_none());
}

#[test]
fn a_force_that_pulls_at_its_contact_point_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    // The assumed contact is on the right side, and the force points to the right.
    let text = "Time [s],Fx [kN],Fy\n0,0,0\n0.05,0,-60\n0.1,0,0\n";
    let (_, name) = write(folder.path(), "f.csv", text);
    let mut harness = open(&[&name]);
    settle(&mut harness);
    choose(&mut harness, ("3: Fy", 1), "kN");
    settle(&mut harness);
    let says = "the force pulls at the contact point";
    // It wraps at the edge of the dialog, which a long text made as wide as the window.
    let edge = harness.get_by_label_contains(says).rect().right();
    assert!(edge < 0.9 * harness.ctx.content_rect().right(), "{edge}");
    save(&mut harness, "import-pulling.png");
    // The file has the force on the other vehicle.
    harness.get_all_by_label("\u{2212}").nth(1).expect("the sign of F_y").click();
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(map(&harness), "time=1:s,fx=2:kN,fy=-3:kN");
    assert!(harness.query_by_label_contains(says).is_none());
}

#[test]
fn a_cancelled_import_leaves_nothing_behind() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, name) = write(folder.path(), "f.csv", OPEN);
    let mut harness = open(&[&name]);
    settle(&mut harness);
    let project = state(&harness).project.clone();
    harness.get_by_label("Points between thousands").click();
    harness.run_steps(2);
    settle(&mut harness);
    choose(&mut harness, ("Struck vehicle", 0), "FEA target (2000 kg)");
    harness.get_by_label("Cancel").click();
    harness.run_steps(4);
    let now = state(&harness);
    assert!(now.session.dialogs.import().is_none() && now.session.sources.is_empty());
    assert_eq!(now.project, project);
    assert_eq!(now.view.column_maps, Default::default(), "nothing is remembered");
    assert!(now.session.said_of_files.is_empty());
    let told = now.session.messages.iter().any(|message| message.text.contains("f.csv"));
    assert!(!told, "{:?}", now.session.messages.last().map(|message| &message.text));
    assert!(now.contents(&now.chain()).iter().all(|entry| !entry.label.contains("f.csv")));
    // What was chosen half is not there when it is opened again.
    apply(&mut harness, Command::Open(vec![folder.path().join("f.csv")]));
    settle(&mut harness);
    assert_eq!(map(&harness), "time=1:ms,fx=2:N,fy=3:N");
}
