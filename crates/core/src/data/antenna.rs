//! Positions of the antenna of a receiver, moved to the centre of gravity of the car.
//!
//! ```text
//! x_CG = x − (a_x cos ψ − a_y sin ψ)        y_CG = y − (a_x sin ψ + a_y cos ψ)
//! ```
//!
//! a is the place of the antenna from the CG in body axes, ψ the yaw angle of the file. Where a receiver gives
//! the course over ground instead, a sideslip β of the car leaves an error of some |a| β.

use std::collections::BTreeMap;

use crate::data::computed::{POSE_X, key};
use crate::data::{Channel, ColumnUse, Formula, Note, ReadSettings, TimeSeries};
use crate::ranges::{CONTACT_X, CONTACT_Y};

/// The place in `0.4 -0.3` or `0.4,-0.3`: ahead and to the left of the CG, m.
pub(super) fn place_m(text: &str) -> Option<[f64; 2]> {
    let numbers = text.split([' ', ',']).filter(|number| !number.is_empty());
    let numbers: Vec<f64> = numbers.map(|number| number.parse().ok()).collect::<Option<_>>()?;
    let &[x_m, y_m] = numbers.as_slice() else { return None };
    (CONTACT_X.contains(x_m) && CONTACT_Y.contains(y_m)).then_some([x_m, y_m])
}

/// The positions of the CG in a motion whose positions are those of an antenna; `None` without a yaw angle.
pub(super) fn of_cg(series: &TimeSeries, [ahead_m, left_m]: [f64; 2]) -> Option<[Vec<f64>; 2]> {
    let of = |channel| series.get(channel);
    let (x, y, yaw) = (of(Channel::X)?, of(Channel::Y)?, of(Channel::Yaw)?);
    let moved = x.iter().zip(y).zip(yaw).map(|((x, y), yaw_rad)| {
        let (sin, cos) = yaw_rad.sin_cos();
        (x - (ahead_m * cos - left_m * sin), y - (ahead_m * sin + left_m * cos))
    });
    let (x, y) = moved.unzip();
    Some([x, y])
}

/// Says that positions were moved.
pub(super) fn note([ahead_m, left_m]: [f64; 2]) -> Note {
    let text = format!(
        "positions are moved to the CG along the yaw angle, from an antenna {ahead_m} m ahead of it and \
         {left_m} m to the left; speeds stay those of the antenna, and where the file has the course over ground for the yaw \
         angle, a sideslip of the car is not taken out"
    );
    Note::Format { text }
}

/// Says that positions are those of an antenna or of the frame of a ROS message, whose place on the car nobody has said.
pub(super) fn open_note(
    columns: &BTreeMap<Channel, ColumnUse>,
    settings: &ReadSettings,
) -> Option<Note> {
    let x = columns.get(&Channel::X).filter(|_| settings.antenna_m.is_none())?;
    let whose = match x.formula {
        Some(Formula::East) => "the antenna",
        None if key(&x.name).ends_with(POSE_X) => {
            "the frame of the message (child_frame_id), on many cars the middle of the rear axle"
        }
        _ => return None,
    };
    let text = format!(
        "positions are those of {whose}: where it is not at the centre of gravity, the path and a turn of the car mix; say \
         where it is (antenna=x,y from the CG)"
    );
    Some(Note::Doubt { text })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{ColumnMap, read_any_series};

    #[test]
    fn a_turn_on_the_spot_of_the_cg_has_no_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("turn.csv");
        let [ahead_m, left_m] = [1.2, -0.4];
        let rows = (0..40).map(|i| {
            let (time_s, yaw_rad) = (f64::from(i) * 0.1, f64::from(i) * 0.05);
            let (sin, cos) = yaw_rad.sin_cos();
            let x_m = 5.0 + ahead_m * cos - left_m * sin;
            let y_m = 7.0 + ahead_m * sin + left_m * cos;
            format!("{time_s},{x_m},{y_m},{yaw_rad}\n")
        });
        let text = "time [s],x [m],y [m],yaw [rad]\n".to_owned() + &rows.collect::<String>();
        std::fs::write(&path, text).unwrap();
        for map in ["antenna=1.2,-0.4", "antenna=1.2 -0.4", "shift=0:s, antenna = 1.2 , -0.4"] {
            let map: ColumnMap = map.parse().unwrap();
            assert_eq!(map, map.to_string().parse().unwrap());
            let loaded = read_any_series(&path, Some(&map)).unwrap();
            for (channel, at_m) in [(Channel::X, 5.0), (Channel::Y, 7.0)] {
                let values = loaded.series.require(channel).unwrap();
                assert!(values.iter().all(|value| (value - at_m).abs() < 1e-9), "{values:?}");
            }
            let notes: Vec<String> = loaded.notes.iter().map(Note::to_string).collect();
            assert!(notes.iter().any(|note| note.contains("1.2 m ahead")), "{notes:?}");
        }
        for wrong in ["antenna=1", "antenna=1,2,3", "antenna=99,0", "antenna=a b"] {
            assert!(wrong.parse::<ColumnMap>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn positions_of_a_receiver_and_of_a_message_are_said_to_be_theirs() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.csv");
        let is_said = |header: &str, map: &str| {
            let text = format!("time [s],{header},yaw [rad]\n0,52,1,0\n1,52.0001,1,0\n");
            std::fs::write(&path, text).unwrap();
            let loaded = read_any_series(&path, Some(&map.parse().unwrap())).unwrap();
            loaded.notes.iter().any(|note| note.to_string().contains("antenna=x,y from the CG"))
        };
        assert!(is_said("latitude,longitude", "headings=yaw"));
        assert!(!is_said("latitude,longitude", "antenna=0.4,-0.3"));
        let pose = "odom.pose.pose.position.x,odom.pose.pose.position.y";
        let map = "x=odom.pose.pose.position.x:m,y=odom.pose.pose.position.y:m";
        assert!(is_said(pose, map) && !is_said(pose, &format!("{map},antenna=-1.4,0")));
        assert!(!is_said("x [m],y [m]", "headings=yaw"));
    }

    #[test]
    fn an_antenna_needs_a_yaw_angle() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("path.csv");
        std::fs::write(&path, "time [s],x [m],y [m]\n0,0,0\n1,5,0\n2,10,0\n").unwrap();
        let map: ColumnMap = "antenna=1,0".parse().unwrap();
        let error = read_any_series(&path, Some(&map)).unwrap_err().to_string();
        assert!(error.contains("no column for x, y and yaw"), "{error}");
    }
}
