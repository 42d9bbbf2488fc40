//! What one draw of a PIT comes to.
//!
//! The lane is along the heading of the struck car at the start; its turn counts from there, positive to
//! the left. Where something does not apply it is NaN.

use std::f64::consts::PI;

use impactlab_core::collision::Pose;
use impactlab_core::numerics::{is_half_turn, is_quarter_turn, wrap_angle_rad};
use impactlab_networks::pair::Course;
use impactlab_networks::response::STEP_S;
use impactlab_study::analysis::PairRow;

/// Angles between the headings at which a car stands across another one, rad: 60° to 120°.
const ACROSS_RAD: [f64; 2] = [PI / 3.0, 2.0 * PI / 3.0];

/// Lengths of the struck car within which it stands in front of the nose of the striking one.
const ACROSS_LENGTHS: f64 = 1.5;

/// A number of a draw of a PIT.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    strum::VariantArray,
    strum::IntoStaticStr,
    strum::EnumString,
    serde::Serialize,
    serde::Deserialize,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Greatest change of the heading of the struck car, signed, rad.
    TurnRad,
    /// Whether it turns by 90° or more.
    #[strum(serialize = "turns_90")]
    #[serde(rename = "turns_90")]
    Turns90,
    /// Whether it turns by 180° or more.
    #[strum(serialize = "turns_180")]
    #[serde(rename = "turns_180")]
    Turns180,
    /// Whether it is touched, turns by less than 90° and is let go.
    Recovers,
    /// Whether it stands across the lane in front of the striking car at the end: at 60° to 120° to it, and
    /// within 1.5 car lengths of its nose.
    AcrossLane,
    /// Whether a door of it is dented.
    DoorContact,
    /// Whether a wheel of it lifts off the road.
    WheelLift,
    /// Its way to the end, m.
    TravelM,
    /// Greatest distance forward along the lane, m.
    ReachM,
    /// Greatest distance to either side of its lane, m.
    OffsetM,
    /// When it is at rest, s.
    RestTimeS,
    /// Its way to rest, m.
    RestDistanceM,
    /// Velocity change of the struck car by all contacts, m/s.
    #[strum(serialize = "delta_v_target_m_s")]
    #[serde(rename = "delta_v_target_m_s")]
    DeltaVTargetMS,
    /// The same of the striking car, m/s.
    #[strum(serialize = "delta_v_bullet_m_s")]
    #[serde(rename = "delta_v_bullet_m_s")]
    DeltaVBulletMS,
    /// Time in contact, s.
    ContactS,
    /// Speed as it first faces backwards, m/s.
    #[strum(serialize = "speed_backwards_m_s")]
    #[serde(rename = "speed_backwards_m_s")]
    SpeedBackwardsMS,
    /// How far the force network applies, 0 to 1.
    ForceApplies,
    /// How far the response network applies, 0 to 1.
    ResponseApplies,
}

impl Outcome {
    /// All of them, in the order of the columns.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Name of its column.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The outcome of a column; `None` if it is none.
    pub fn from_name(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// Its SI unit; "1" for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::TurnRad => "rad",
            Self::TravelM | Self::ReachM | Self::OffsetM | Self::RestDistanceM => "m",
            Self::RestTimeS | Self::ContactS => "s",
            Self::DeltaVTargetMS | Self::DeltaVBulletMS | Self::SpeedBackwardsMS => "m/s",
            _ => "1",
        }
    }

    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::TurnRad => "greatest turn of the struck car",
            Self::Turns90 => "the struck car turns by 90° or more",
            Self::Turns180 => "the struck car turns by 180° or more",
            Self::Recovers => "the struck car recovers",
            Self::AcrossLane => "the struck car stands across in front of the striking car",
            Self::DoorContact => "a door of the struck car is hit",
            Self::WheelLift => "a wheel of the struck car lifts",
            Self::TravelM => "distance travelled by the struck car",
            Self::ReachM => "reach along the lane",
            Self::OffsetM => "distance to the side of the lane",
            Self::RestTimeS => "time to rest",
            Self::RestDistanceM => "distance to rest",
            Self::DeltaVTargetMS => "Δv of the struck car",
            Self::DeltaVBulletMS => "Δv of the striking car",
            Self::ContactS => "time in contact",
            Self::SpeedBackwardsMS => "speed when it faces backwards",
            Self::ForceApplies => "force network applies",
            Self::ResponseApplies => "response network applies",
        }
    }

    /// Whether it is 0 or 1 in a row, so that its mean is a probability.
    pub fn is_probability(self) -> bool {
        matches!(
            self,
            Self::Turns90
                | Self::Turns180
                | Self::Recovers
                | Self::AcrossLane
                | Self::DoorContact
                | Self::WheelLift
        )
    }

    /// Its value in a draw.
    fn of(self, row: &PairRow, path: &StruckPath) -> f64 {
        let draw = &row.draw;
        let flag = |holds: bool| f64::from(u8::from(holds));
        match self {
            Self::TurnRad => path.turn_rad,
            Self::Turns90 => flag(is_quarter_turn(path.turn_rad)),
            Self::Turns180 => flag(is_half_turn(path.turn_rad)),
            Self::Recovers => flag(draw.course() == Course::Recovers),
            Self::AcrossLane => flag(is_across(row)),
            Self::DoorContact => flag(row.is_door_dented),
            Self::WheelLift => flag(row.lifts_wheel),
            Self::TravelM => path.travel_m,
            Self::ReachM => path.reach_m,
            Self::OffsetM => path.offset_m,
            Self::RestTimeS => draw.rest_s[0].unwrap_or(f64::NAN),
            Self::RestDistanceM => path.rest_distance_m,
            Self::DeltaVTargetMS => draw.impulse_n_s() / row.masses_kg[0],
            Self::DeltaVBulletMS => draw.impulse_n_s() / row.masses_kg[1],
            Self::ContactS => draw.contact_s(draw.end_s()),
            Self::SpeedBackwardsMS => path.speed_backwards_m_s,
            Self::ForceApplies => row.force_applicability,
            Self::ResponseApplies => row.response_applicability,
        }
    }
}

/// The outcomes of a draw, in the order of [`Outcome::ALL`].
pub fn outcomes(row: &PairRow) -> Vec<f64> {
    let path = StruckPath::new(row);
    Outcome::ALL.iter().map(|outcome| outcome.of(row, &path)).collect()
}

/// What the path of the struck car comes to.
struct StruckPath {
    turn_rad: f64,
    travel_m: f64,
    reach_m: f64,
    offset_m: f64,
    rest_distance_m: f64,
    speed_backwards_m_s: f64,
}

impl StruckPath {
    fn new(row: &PairRow) -> Self {
        let states = &row.draw.states[0];
        let first = states.first().copied().unwrap_or_default();
        let (sin, cos) = first.yaw_rad.sin_cos();
        let mut path = Self {
            turn_rad: 0.0,
            travel_m: 0.0,
            reach_m: 0.0,
            offset_m: 0.0,
            rest_distance_m: f64::NAN,
            speed_backwards_m_s: f64::NAN,
        };
        let rest_s = row.draw.rest_s[0];
        let rest = rest_s.map(|rest_s| (rest_s / STEP_S).round() as usize);
        let mut before = first;
        for (i, state) in states.iter().enumerate() {
            let (x_m, y_m) = (state.x_m - first.x_m, state.y_m - first.y_m);
            path.travel_m += (state.x_m - before.x_m).hypot(state.y_m - before.y_m);
            path.reach_m = path.reach_m.max(x_m * cos + y_m * sin);
            path.offset_m = path.offset_m.max((y_m * cos - x_m * sin).abs());
            let turn_rad = state.yaw_rad - first.yaw_rad;
            if turn_rad.abs() > path.turn_rad.abs() {
                path.turn_rad = turn_rad;
            }
            if is_half_turn(turn_rad) && path.speed_backwards_m_s.is_nan() {
                path.speed_backwards_m_s = state.vx_body_m_s.hypot(state.vy_body_m_s);
            }
            if rest == Some(i) {
                path.rest_distance_m = path.travel_m;
            }
            before = *state;
        }
        path
    }
}

/// Whether the struck car stands across in front of the striking one at the end.
fn is_across(row: &PairRow) -> bool {
    let [struck, striking] = row.draw.states.each_ref().map(|states| states.last());
    let (Some(struck), Some(striking)) = (struck, striking) else { return false };
    let between_rad = wrap_angle_rad(struck.yaw_rad - striking.yaw_rad).abs();
    let [low, high] = ACROSS_RAD;
    // Middle of the struck car from the nose of the striking one, in the axes of that.
    let footprints = row.footprints;
    let middle_m = footprints[0].cg_from_front_m - footprints[0].length_m / 2.0;
    let middle = Pose::from_state(struck).world_from_body([middle_m, 0.0]);
    let [x_m, y_m] = Pose::from_state(striking).body_from_world(middle);
    let ahead_m = x_m - footprints[1].cg_from_front_m;
    let nearest_m = ACROSS_LENGTHS * footprints[0].length_m;
    (low..=high).contains(&between_rad) && ahead_m > 0.0 && ahead_m.hypot(y_m) <= nearest_m
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use impactlab_core::collision::Footprint;
    use impactlab_core::collision::contact::{ContactPhase, PhaseOfVehicle};
    use impactlab_core::vehicle::VehicleState;
    use impactlab_networks::pair::PairDraw;

    fn state(x_m: f64, y_m: f64, yaw_rad: f64, speed_m_s: f64) -> VehicleState<f64> {
        VehicleState { x_m, y_m, yaw_rad, vx_body_m_s: speed_m_s, ..VehicleState::default() }
    }

    fn row(struck: Vec<VehicleState<f64>>, striking: Vec<VehicleState<f64>>) -> PairRow {
        let footprint = Footprint { length_m: 4.8, width_m: 1.8, cg_from_front_m: 2.4 };
        PairRow {
            draw: PairDraw {
                number: 0,
                states: [struck, striking],
                phases: Vec::new(),
                rest_s: [Some(0.02), None],
                hand_over: None,
            },
            footprints: [footprint; 2],
            masses_kg: [1500.0, 2000.0],
            is_door_dented: true,
            lifts_wheel: false,
            force_applicability: 0.25,
            response_applicability: 0.5,
        }
    }

    #[test]
    fn the_outcomes_of_a_motion_are_those_of_its_path() {
        let struck = vec![
            state(0.0, 0.0, FRAC_PI_2, 20.0),
            state(0.0, 3.0, FRAC_PI_2 - 2.0, 15.0),
            state(4.0, 3.0, FRAC_PI_2 - 3.5, 8.0),
            state(4.0, 2.0, FRAC_PI_2 - 3.0, 0.0),
        ];
        let striking = vec![state(1.0, -5.0, FRAC_PI_2, 20.0); 4];
        let values = outcomes(&row(struck, striking));
        let value = |outcome: Outcome| values[outcome as usize];
        assert!((value(Outcome::TurnRad) + 3.5).abs() < 1e-12);
        assert_eq!(
            [Outcome::Turns90, Outcome::Turns180, Outcome::Recovers].map(value),
            [1.0, 1.0, 0.0]
        );
        assert!((value(Outcome::TravelM) - 8.0).abs() < 1e-12);
        assert!((value(Outcome::RestDistanceM) - 7.0).abs() < 1e-12);
        assert!((value(Outcome::ReachM) - 3.0).abs() < 1e-12);
        assert!((value(Outcome::OffsetM) - 4.0).abs() < 1e-12);
        assert_eq!(value(Outcome::SpeedBackwardsMS), 8.0);
        assert_eq!([Outcome::DoorContact, Outcome::WheelLift].map(value), [1.0, 0.0]);
        assert_eq!(value(Outcome::ForceApplies), 0.25);
    }

    /// A row said of just 90° that the car turned by a quarter, and the course of events that it did not.
    #[test]
    fn a_turn_of_just_a_quarter_or_half_is_one_in_the_row_and_in_the_course() {
        let of_vehicle = PhaseOfVehicle {
            impulse_body_n_s: [0.0; 2],
            yaw_impulse_n_m_s: 0.0,
            delta_v_m_s: 0.0,
            principal_direction: None,
        };
        let let_go = ContactPhase {
            start_s: 0.0,
            end_s: Some(0.1),
            impulse_world_n_s: [0.0; 2],
            peak_force_n: 0.0,
            vehicles: [of_vehicle; 2],
        };
        for (turn_rad, expected, course) in [
            (FRAC_PI_2, [1.0, 0.0, 0.0], Course::Turns),
            (-FRAC_PI_2, [1.0, 0.0, 0.0], Course::Turns),
            (PI, [1.0, 1.0, 0.0], Course::Spins),
            (1.5, [0.0, 0.0, 1.0], Course::Recovers),
        ] {
            let struck = vec![state(0.0, 0.0, 0.0, 20.0), state(9.0, 0.0, turn_rad, 0.0)];
            let mut row = row(struck, vec![state(1.0, -5.0, 0.0, 20.0); 2]);
            row.draw.phases = vec![let_go];
            let values = outcomes(&row);
            let counted = [Outcome::Turns90, Outcome::Turns180, Outcome::Recovers]
                .map(|outcome| values[outcome as usize]);
            assert_eq!((counted, row.draw.course()), (expected, course), "{turn_rad} rad");
        }
    }

    #[test]
    fn a_car_stands_across_in_front_of_the_nose_and_not_beside_or_far_from_it() {
        let across = |x_m: f64, y_m: f64, yaw_rad: f64| {
            let struck = vec![state(0.0, 0.0, 0.0, 20.0), state(x_m, y_m, yaw_rad, 0.0)];
            let striking = vec![state(-5.0, -2.0, 0.0, 20.0), state(50.0, 0.0, 0.0, 0.0)];
            outcomes(&row(struck, striking))[Outcome::AcrossLane as usize]
        };
        assert_eq!(across(54.0, 0.0, FRAC_PI_2), 1.0);
        assert_eq!(across(54.0, 0.0, 0.3), 0.0, "not across");
        assert_eq!(across(62.0, 0.0, FRAC_PI_2), 0.0, "far ahead");
        assert_eq!(across(46.0, 0.0, FRAC_PI_2), 0.0, "behind");
    }

    #[test]
    fn every_outcome_has_a_column_of_its_own() {
        let names: std::collections::BTreeSet<_> =
            Outcome::ALL.iter().map(|it| it.name()).collect();
        assert_eq!(names.len(), Outcome::ALL.len());
        for outcome in Outcome::ALL {
            assert_eq!(Outcome::from_name(outcome.name()), Some(*outcome));
        }
        let expected = ["turn_rad", "turns_90", "delta_v_target_m_s", "speed_backwards_m_s"];
        for name in expected {
            assert!(names.contains(name), "{name} of {names:?}");
        }
    }
}
