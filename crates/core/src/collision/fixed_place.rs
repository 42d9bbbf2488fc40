//! Where a wall stands that a vehicle touches.

use crate::collision::{Footprint, Pose, Side};

/// Distance within which corners of a vehicle touch a wall together, m.
const TOGETHER_M: f64 = 1e-6;

/// Pose of a wall whose face touches the vehicle with the corner, or the side, that is nearest to it.
///
/// - `side`: side of the vehicle that faces the wall; `offset_m`: from the middle of that side to the
///   middle of the wall, along the wall, as of [`place_touching`](crate::collision::place_touching);
/// - `heading_rad`: direction along the wall in world axes, rad.
pub(super) fn place_wall(
    (struck, pose): (&Footprint, &Pose),
    (side, offset_m): (Side, f64),
    wall: &Footprint,
    heading_rad: f64,
) -> Pose {
    let (sin, cos) = heading_rad.sin_cos();
    let along = [cos, sin];
    let outward_rad = pose.yaw_rad + side.outward_angle_rad();
    let faces_left = cos * outward_rad.sin() - sin * outward_rad.cos() > 0.0;
    // From the wall to the vehicle.
    let normal = if faces_left { [sin, -cos] } else { [-sin, cos] };
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let corners_m = struck.corners_m(pose);
    let nearest_m = corners_m.iter().map(|corner| dot(*corner, normal)).fold(f64::MAX, f64::min);
    let is_touching = |corner: &&[f64; 2]| dot(**corner, normal) < nearest_m + TOGETHER_M;
    let touching: Vec<&[f64; 2]> = corners_m.iter().filter(is_touching).collect();
    let n = touching.len().max(1) as f64;
    let [x_m, y_m] = [0, 1].map(|axis| touching.iter().map(|it| it[axis]).sum::<f64>() / n);
    let side_rad = match side {
        Side::Front | Side::Rear => pose.yaw_rad + std::f64::consts::FRAC_PI_2,
        Side::Left | Side::Right => pose.yaw_rad,
    };
    let shift_m = offset_m * dot(along, [side_rad.cos(), side_rad.sin()]);
    let back_m = wall.width_m / 2.0;
    Pose {
        x_m: x_m - back_m * normal[0] + shift_m * along[0],
        y_m: y_m - back_m * normal[1] + shift_m * along[1],
        yaw_rad: heading_rad,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::collision::{ContactLocation, Scenario, Side};
    use crate::data::TomlError;

    const CAR: &str = "[target]\nmass_kg = 1500\nyaw_inertia_kg_m2 = 2500\nlength_m = 4.5\n\
                       width_m = 1.8\ncg_from_front_m = 2.2\nspeed_m_s = 14\n";
    const CONTACT: &str = "[contact]\nfrom = \"side\"\nside = \"front\"\n";

    fn read(object: &str, contact: &str) -> Result<Scenario, TomlError> {
        let text = format!("{CAR}[bullet]\n{object}\n{CONTACT}{contact}\n");
        Scenario::from_toml(&text, Path::new("s.toml"))
    }

    /// `Δv = −(1 + e) v` and `E = m v²/2 (1 − e²)`.
    #[test]
    fn a_wall_gives_back_the_restitution_and_takes_the_rest() {
        for e in [0.0, 0.1, 1.0] {
            let contact = format!("offset_m = 0\nrestitution = {e}");
            let solution = read("fixed = \"wall\"", &contact).unwrap().solve().unwrap();
            let [x, y] = solution.struck.delta_v_world_m_s;
            assert!((x + (1.0 + e) * 14.0).abs() < 1e-3 && y.abs() < 1e-6, "{e}: {x} {y}");
            let expected_j = 750.0 * 14.0 * 14.0 * (1.0 - e * e);
            assert!((solution.dissipated_energy_j - expected_j).abs() < 10.0, "{e}: {solution:?}");
            let [vx, vy] = solution.striking.velocity_world_m_s;
            assert!(vx.hypot(vy) < 1e-3, "the wall stands");
        }
    }

    #[test]
    fn a_car_meets_a_wall_at_an_angle_with_its_corner_and_a_pole_where_it_stands() {
        let wall =
            read("fixed = \"wall\"\nlength_m = 30\nheading_deg = 60", "offset_m = 0").unwrap();
        let geometry = wall.geometry().unwrap();
        let [x, y] = geometry.contact_point_world_m;
        assert!((x - 2.2).abs() < 2e-3 && (y + 0.9).abs() < 2e-3, "{x} {y}");
        let (sin, cos) = geometry.normal_angle_world_rad.sin_cos();
        let (expected_sin, expected_cos) = 150_f64.to_radians().sin_cos();
        assert!((sin - expected_sin).hypot(cos - expected_cos) < 1e-9, "{geometry:?}");
        let pole = read("fixed = \"pole\"\ndiameter_m = 0.4", "offset_m = 0.5").unwrap();
        let [x, y] = pole.geometry().unwrap().contact_point_world_m;
        assert!((x - 2.2).abs() < 2e-3 && (y - 0.5).abs() < 1e-9, "{x} {y}");
        let solution = pole.solve().unwrap();
        assert!(
            solution.struck.yaw_rate_rad_s > 0.5,
            "a push on the left turns the nose to the left"
        );
    }

    /// The car came to rest in other places by the heading of a pole, which has none: its outline is a square.
    #[test]
    fn a_pole_is_where_it_is_whatever_its_heading_and_that_of_the_road() {
        for side in Side::ALL {
            let mut scenario =
                read("fixed = \"pole\"\ndiameter_m = 0.4", "offset_m = 0.5").unwrap();
            scenario.contact.location = ContactLocation::Side { side, offset_m: 0.5 };
            let expected = scenario.geometry().unwrap();
            for heading_rad in [0.3, 0.8, 1.6, -2.0] {
                scenario.striking.heading_rad = heading_rad;
                assert_eq!(scenario.geometry().unwrap(), expected, "{side:?} {heading_rad}");
            }
            scenario.struck.heading_rad = 0.7;
            let turned = scenario.geometry().unwrap();
            let [x, y] = turned.struck.body_from_world(turned.contact_point_world_m);
            let [x0, y0] = expected.contact_point_world_m;
            assert!((x - x0).hypot(y - y0) < 1e-9, "{side:?}: {turned:?} {expected:?}");
        }
    }

    #[test]
    fn a_fixed_object_is_written_back_and_says_nothing_of_mass_or_speed() {
        for object in ["fixed = \"wall\"", "fixed = \"pole\"\ndiameter_ft = 1.5"] {
            let scenario = read(object, "offset_m = 0.1").unwrap();
            let text = scenario.to_toml();
            let back = Scenario::from_toml(&text, Path::new("s.toml")).unwrap();
            assert_eq!(back, scenario, "{text}");
            let json = serde_json::to_string(&scenario).unwrap();
            assert_eq!(serde_json::from_str::<Scenario>(&json).unwrap(), scenario, "{json}");
        }
        for (object, expected) in [
            ("fixed = \"wall\"\nmass_kg = 9000", "bullet.mass_kg is not known here"),
            ("fixed = \"pole\"", "bullet.diameter_m is missing"),
            ("fixed = \"pole\"\ndiameter_m = 0.4\nheading_deg = 45", "a pole is round"),
            ("fixed = \"tree\"", "expected \"wall\" or \"pole\""),
            ("fixed = \"wall\"\nvehicle = \"toyota-camry-2018\"", "say the same thing"),
        ] {
            let error = read(object, "offset_m = 0").unwrap_err().to_string();
            assert!(error.contains(expected), "{object}: {error}");
        }
    }
}
