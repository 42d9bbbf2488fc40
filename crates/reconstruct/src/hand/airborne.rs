//! Speed at take-off of a vehicle that flew.
//!
//! ```text
//! v = d/cos θ · √(g/(2 (h + d tan θ)))        t = d/(v cos θ)
//! ```
//!
//! d: horizontal distance of the CG; h: how far it lies lower where it lands; θ: direction at take-off above the
//! horizontal. The air is neglected.
//!
//! The equation is that of a projectile, in closed form.

use crate::hand::HandField;
use crate::hand::method::{Formula, HandOutput, violated};
use crate::hand::values::HandValues;
use impactlab_core::ranges::{HAND_DISTANCE, HAND_DROP, LAUNCH_ANGLE};
use impactlab_core::units::{Phrase, PhraseValue, Quantity, STANDARD_GRAVITY_M_S2};

/// Fall below the line of take-off under which the angle decides nearly all, m.
const LEAST_FALL_M: f64 = 0.3;

pub(super) const AIRBORNE: Formula = Formula {
    label: "airborne",
    equation: "v = d/cos θ · √(g/(2 (h + d tan θ)))",
    holds: [
        "distance and drop are those of the CG from take-off to the first touch, the vehicle takes off in the \
         direction of the ground there and does not pitch before it lands",
        "Weite und Fall gelten für den Schwerpunkt vom Abheben bis zur ersten Berührung, das Fahrzeug hebt in \
         Richtung des Bodens dort ab und nickt nicht vor der Landung",
    ],
    sources: &["path of a projectile without drag, a closed form"],
    fields: &[
        HandField::new("distance", "horizontal distance of the flight", HAND_DISTANCE, 0.5),
        HandField::new("drop", "drop of the CG, down positive", HAND_DROP, 0.1),
        HandField::new("angle", "angle of take-off, up positive", LAUNCH_ANGLE, 0.035).or(0.0),
    ],
    outputs: &[
        HandOutput { key: "speed_m_s", label: "speed at take-off", quantity: Quantity::Speed },
        HandOutput { key: "time_s", label: "time of flight", quantity: Quantity::Time },
    ],
    solve,
    refuse,
    warn,
};

/// How far the vehicle falls below the line on which it takes off, m.
fn fall_m(values: &HandValues<'_>) -> f64 {
    values.number("drop") + values.number("distance") * values.number("angle").tan()
}

fn solve(values: &HandValues<'_>) -> Vec<f64> {
    let (distance_m, cos) = (values.number("distance"), values.number("angle").cos());
    let fall_m = fall_m(values);
    let time_s = (2.0 * fall_m / STANDARD_GRAVITY_M_S2).sqrt();
    if fall_m <= 0.0 {
        return vec![f64::NAN; 2];
    }
    vec![distance_m / (cos * time_s), time_s]
}

fn refuse(values: &HandValues<'_>) -> Option<&'static str> {
    let why = "the vehicle lands on or above the line of its take-off, which no speed explains: check drop \
               and angle";
    (fall_m(values) <= 0.0).then_some(why)
}

fn warn(values: &HandValues<'_>, _: &[f64]) -> Vec<Phrase> {
    let fall_m = fall_m(values);
    let flat = Phrase::new(
        "the vehicle fell only {0} below the line of its take-off: small errors of angle and drop move the \
         speed far",
        "Das Fahrzeug fiel nur {0} unter die Linie seines Abhebens: kleine Fehler von Winkel und Fall \
         verschieben die Geschwindigkeit weit",
    );
    let fall = PhraseValue::fixed(Quantity::Length, fall_m, 2);
    violated([(fall_m < LEAST_FALL_M, flat.with(fall))])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::HandMethod::Airborne;
    use crate::hand::calculation::tests::{near, solved};

    fn with(distance_m: f64, drop_m: f64, angle_rad: f64) -> Vec<f64> {
        let inputs = [("distance_m", distance_m), ("drop_m", drop_m), ("angle_rad", angle_rad)];
        solved(Airborne, &inputs)
    }

    /// Off a level edge: half a second of fall.
    #[test]
    fn a_level_flight_lasts_as_long_as_the_fall() {
        near(&with(10.0, STANDARD_GRAVITY_M_S2 / 8.0, 0.0), &[20.0, 0.5]);
    }

    /// At 45° on level ground a projectile flies v²/g.
    #[test]
    fn a_flight_on_the_level_has_the_range_of_a_projectile() {
        let time_s = 2.0 * 20.0 * 0.5_f64.sqrt() / STANDARD_GRAVITY_M_S2;
        let distance_m = 400.0 / STANDARD_GRAVITY_M_S2;
        near(&with(distance_m, 0.0, std::f64::consts::FRAC_PI_4), &[20.0, time_s]);
    }

    /// Points of the parabola of 25 m/s give 25 m/s back, upwards and downwards.
    #[test]
    fn any_point_of_a_parabola_gives_its_speed() {
        for (angle, time_s) in [(0.1_f64, 1.2), (-0.05, 0.8), (0.3, 2.0)] {
            let drop = STANDARD_GRAVITY_M_S2 * time_s * time_s / 2.0 - 25.0 * angle.sin() * time_s;
            near(&with(25.0 * angle.cos() * time_s, drop, angle), &[25.0, time_s]);
        }
    }
}
