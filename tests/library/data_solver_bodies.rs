//! Motions of rigid bodies as LS-DYNA writes them, as text and in a `binout`.

use std::f64::consts::{FRAC_PI_2, PI};

use impactlab_core::data::{Channel, FileKind, read_any_series};
use tempfile::TempDir;

use crate::solver_files::{
    DECK, FORCE_KN, LSDA, TIME_MS, assert_close, binout_forces, doubts, e, file, floats, fx, ids,
    map, read, record,
};

/// Names of the numbers of a rigid body in a `binout`.
const BODY: [&str; 17] = [
    "global_x",
    "global_y",
    "global_vx",
    "global_vy",
    "global_ax",
    "global_ay",
    "global_rvz",
    "global_rdz",
    "dircos_11",
    "dircos_12",
    "dircos_13",
    "dircos_21",
    "dircos_22",
    "dircos_23",
    "dircos_31",
    "dircos_32",
    "dircos_33",
];

/// A car that heads and drives against x at 10 m/s, brakes with 1 m/s² and turns at 0.5 rad/s.
///
/// - `rolled`: by what it has rolled at the end, rad.
fn body(time_ms: f64, rolled: f64) -> [f64; 17] {
    let turned = 0.5e-3 * time_ms;
    let ((sin, cos), (sr, cr)) = (turned.sin_cos(), (rolled * time_ms / 80.0).sin_cos());
    let x = 500.0 - 10.0 * time_ms + 0.5e-3 * time_ms * time_ms;
    let vx = -10.0 + 1e-3 * time_ms;
    let vectors = [cos, -sin * cr, sin * sr, sin, cos * cr, -cos * sr, 0.0, sr, cr];
    let motion = [x, 200.0, vx, 0.0, 1e-3, 0.0, 0.5e-3, turned];
    std::array::from_fn(|at| if at < 8 { motion[at] } else { vectors[at - 8] })
}

fn rbdout(rolled: f64) -> String {
    let mut text =
        " a run\n                         ls-dyna (version R12)     date 01/01/2026\n".to_owned();
    for (state, time_ms) in TIME_MS.into_iter().enumerate() {
        let numbers = body(time_ms, rolled).map(|number| format!("{:>12}", e(number, 4)));
        let [x, y, vx, vy, ax, ay, rate, turned, ..] = &numbers;
        let zero = format!("{:>12}", e(0.0, 4));
        text += &format!(
            "1\n\n  r i g i d   b o d y   m o t i o n   a t  cycle={state:8}    time={:>15}\n\n \
             rigid body{:8}\n   global             x           y           z          x-rot\n   \
             coordinates:  {x}{y}{zero}\n displacements:  {x}{y}{zero}{zero}{zero}{turned}\n    \
             velocities:  {vx}{vy}{zero}{zero}{zero}{rate}\n \
             accelerations:  {ax}{ay}{zero}{zero}{zero}{zero}\n\n\
             principal or user defined local coordinate direction vectors\n{:21}a           b           c\n",
            e(time_ms, 6),
            5,
            ""
        );
        for (row, vector) in numbers[8..].chunks(3).enumerate() {
            text += &format!("     row {}   {}\n", row + 1, vector.join("   "));
        }
        text += &format!(
            "\n output in principal or user defined local coordinate directions\n \
             displacements:  {zero}\n    velocities:  {zero}\n accelerations:  {zero}\n"
        );
    }
    text
}

/// The same in a `binout`.
///
/// - `ids`: of the body in each state.
fn binout_body(ids_of: [i32; 5]) -> Vec<u8> {
    let mut bytes = [LSDA.to_vec(), record(2, b"/rbdout/metadata")].concat();
    for (state, time_ms) in TIME_MS.into_iter().enumerate() {
        bytes.extend(record(2, format!("../d{:06}", state + 1).as_bytes()));
        bytes.extend(ids(&[ids_of[state]]));
        bytes.extend(floats("time", &[time_ms]));
        for (name, value) in BODY.into_iter().zip(body(time_ms, 0.0)) {
            bytes.extend(floats(name, &[value]));
        }
    }
    bytes
}

#[test]
fn a_rigid_body_is_a_motion_once_its_heading_is_said() {
    let folder = TempDir::new().unwrap();
    let text = file(&folder, "rbdout", rbdout(0.0));
    let binary = file(&folder, "binout0000", binout_body([5; 5]));
    let error = read_any_series(&text, None).unwrap_err();
    assert_eq!(error.answer().map(ToString::to_string).as_deref(), Some(DECK), "{error}");
    for path in [&text, &binary] {
        let plain = read(path, DECK);
        assert_eq!(plain.kind, FileKind::Trajectory);
        assert!(plain.series.get(Channel::Yaw).is_none());
        let said = doubts(&plain);
        assert!(said.contains("body 5 is read, the first of 1, without a yaw angle"), "{said}");
        assert!(said.contains("map sheet=body 5 along x"), "{said}");
        let loaded = read(path, &format!("{DECK},sheet=body 5 along -x"));
        assert!(!doubts(&loaded).contains("which is not along"), "{}", doubts(&loaded));
        let column = |channel| loaded.series.require(channel).unwrap().to_vec();
        for (at, time_ms) in TIME_MS.into_iter().enumerate() {
            let (turned, speed) = (0.5e-3 * time_ms, 10.0 - 1e-3 * time_ms);
            let expected = [
                (Channel::X, 0.5 - 0.01 * time_ms + 0.5e-6 * time_ms * time_ms),
                (Channel::Y, 0.2),
                (Channel::Yaw, PI + turned),
                (Channel::YawRate, 0.5),
                (Channel::Vx, speed * turned.cos()),
                (Channel::Vy, -speed * turned.sin()),
                (Channel::Ax, -turned.cos()),
                (Channel::Ay, turned.sin()),
            ];
            for (channel, expected) in expected {
                let value = column(channel)[at];
                assert!((value - expected).abs() < 2e-3, "{channel:?} at {time_ms} ms: {value}");
            }
        }
        // In the list the body is followed by its four headings, the last of which is along -y.
        let across = read(path, &format!("{DECK},sheet=5"));
        assert!((across.series.require(Channel::Yaw).unwrap()[0] + FRAC_PI_2).abs() < 1e-4);
        let wrong = read(path, &format!("{DECK},sheet=body 5 along x"));
        let said = doubts(&wrong);
        assert!(said.contains("which is not along x"), "{said}");
    }
    let error = read_any_series(&text, Some(&map("sheet=body 6"))).unwrap_err().to_string();
    assert!(error.contains("body 5 along -y"), "{error}");
    let rolled =
        read(&file(&folder, "rolled", rbdout(0.5)), &format!("{DECK},sheet=body 5 along -x"));
    assert!(doubts(&rolled).contains("it rolls or pitches"), "{}", doubts(&rolled));
}

#[test]
fn bodies_that_are_rigid_for_a_while_do_not_take_the_forces_with_them() {
    let folder = TempDir::new().unwrap();
    let path = file(&folder, "binout0000", binout_forces(&[0, 1, 2, 3, 4]));
    file(&folder, "binout0001", binout_body([5, 5, 5, 6, 6]));
    let loaded = read(&path, &format!("{DECK},sheet=contact 3 slave"));
    assert_close(&fx(&loaded), &FORCE_KN.map(|force| 1e3 * force));
    let said = doubts(&loaded);
    assert!(said.contains("rigid bodies are left out: rbdout has other bodies"), "{said}");
    let alone = file(&folder, "bodies", binout_body([5, 5, 5, 6, 6]));
    let error = read_any_series(&alone, Some(&map(DECK))).unwrap_err().to_string();
    assert!(error.contains("nodout or rbdout") && error.contains("other bodies"), "{error}");
}
