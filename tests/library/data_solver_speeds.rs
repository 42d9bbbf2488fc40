//! With which velocity a car begins whose force comes from a finite-element model.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use impactlab_core::data::{Channel, parts_beside, read_any_series};
use impactlab_core::uncertainty::{Caveat, CaveatSubject};
use impactlab_study::{Drive, Event, Library, MotionSource, Question, SeriesFile, SimulateRequest};
use tempfile::TempDir;

use crate::solver_files::{
    DECK, FORCE_KN, TIME_MS, binout, binout_momenta, doubts, e, file, map, notes, rcforc, read,
};

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
