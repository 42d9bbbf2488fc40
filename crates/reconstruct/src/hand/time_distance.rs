//! Time and distance: where a braking vehicle stops, and whether that would have avoided the collision.
//!
//! ```text
//! stopping distance     s = v t_r + v²/(2 a)
//! speed at the place    v_d = √(v² − 2 a (d − v t_r))      0 if it stops before, v if it reacts too late
//! avoidable up to       v_a = √((a t_r)² + 2 a d) − a t_r
//! ```
//!
//! t_r: time from the stimulus to the full deceleration, half of the rise of the brake with it; a: mean
//! deceleration; d: distance to the place of the collision when the stimulus comes.
//!
//! The equations are those of a constant deceleration, in closed form.

use crate::hand::HandField;
use crate::hand::method::{Formula, HandOutput, accept, violated};
use crate::hand::values::HandValues;
use impactlab_core::ranges::{EVIDENCE_SPEED, HAND_DECELERATION, HAND_DISTANCE, REACTION_TIME};
use impactlab_core::units::{Phrase, Quantity};

pub(super) const TIME_DISTANCE: Formula = Formula {
    label: "time and distance",
    equation: "s = v t + v²/(2 a); v_d = √(v² − 2 a (d − v t)); v_a = √((a t)² + 2 a d) − a t",
    holds: [
        "speed before the reaction and deceleration after it are constant, the stimulus is the moment at which a \
         driver could see the danger, and the other party moves as it did",
        "Geschwindigkeit vor der Reaktion und Verzögerung danach sind konstant, der Reiz ist der Zeitpunkt, zu \
         dem ein Fahrer die Gefahr sehen konnte, und der andere Beteiligte bewegt sich wie geschehen",
    ],
    sources: &["motion with a constant deceleration, a closed form"],
    fields: &[
        HandField::relative("speed", "speed of the vehicle", EVIDENCE_SPEED, 0.1),
        HandField::new("reaction", "reaction time", REACTION_TIME, 0.25).or(1.0),
        HandField::relative("deceleration", "deceleration", HAND_DECELERATION, 0.08),
        HandField::new("distance", "distance to the place of the collision", HAND_DISTANCE, 1.0)
            .open(),
    ],
    outputs: &[
        HandOutput {
            key: "stopping_distance_m",
            label: "stopping distance",
            quantity: Quantity::Length,
        },
        HandOutput { key: "stopping_time_s", label: "time to stop", quantity: Quantity::Time },
        HandOutput {
            key: "margin_m",
            label: "distance left when it stops",
            quantity: Quantity::Length,
        },
        HandOutput {
            key: "speed_at_place_m_s",
            label: "speed at the place of the collision",
            quantity: Quantity::Speed,
        },
        HandOutput {
            key: "avoidable_speed_m_s",
            label: "highest speed that stops before it",
            quantity: Quantity::Speed,
        },
    ],
    solve,
    refuse: accept,
    warn,
};

fn solve(values: &HandValues<'_>) -> Vec<f64> {
    let [v, t, a] = ["speed", "reaction", "deceleration"].map(|key| values.number(key));
    let d = values.number("distance");
    let stopping = v * t + v * v / (2.0 * a);
    let braked_m = (d - v * t).max(0.0);
    let at_place = match d.is_nan() {
        true => f64::NAN,
        false => (v * v - 2.0 * a * braked_m).max(0.0).sqrt(),
    };
    let avoidable = ((a * t).powi(2) + 2.0 * a * d).sqrt() - a * t;
    vec![stopping, t + v / a, d - stopping, at_place, avoidable]
}

fn warn(values: &HandValues<'_>, _: &[f64]) -> Vec<Phrase> {
    let quick = Phrase::new(
        "a reaction time below 0.7 s is that of a driver who expects what comes",
        "Eine Reaktionszeit unter 0,7 s hat ein Fahrer, der erwartet, was kommt",
    );
    let hard = Phrase::new(
        "a deceleration above 10 m/s² is that of few cars on dry asphalt",
        "Eine Verzögerung über 10 m/s² erreichen wenige Fahrzeuge auf trockenem Asphalt",
    );
    violated([
        (values.number("reaction") < 0.7, quick),
        (values.number("deceleration") > 10.0, hard),
    ])
}

#[cfg(test)]
mod tests {
    use crate::hand::HandMethod::TimeDistance;
    use crate::hand::calculation::tests::{near, solved};

    fn with(speed: f64, reaction: f64, deceleration: f64, distance: f64) -> Vec<f64> {
        solved(
            TimeDistance,
            &[
                ("speed_m_s", speed),
                ("reaction_s", reaction),
                ("deceleration_m_s2", deceleration),
                ("distance_m", distance),
            ],
        )
    }

    /// 20 m/s, 1 s and 8 m/s²: 20 m and 25 m, in 3.5 s; 60 m leave 15 m.
    #[test]
    fn a_stop_in_time_leaves_distance() {
        let outputs = with(20.0, 1.0, 8.0, 60.0);
        near(&outputs, &[45.0, 3.5, 15.0, 0.0, (64.0_f64 + 960.0).sqrt() - 8.0]);
    }

    /// After 20 m of reaction and 9 m of braking 16 m/s are left: 400 − 16 · 9 = 256.
    #[test]
    fn a_late_stop_arrives_with_what_is_left() {
        let outputs = with(20.0, 1.0, 8.0, 29.0);
        near(&outputs[2..4], &[-16.0, 16.0]);
        // Who has not reacted yet has lost nothing.
        near(&with(20.0, 1.0, 8.0, 15.0)[3..4], &[20.0]);
    }

    /// The highest avoidable speed stops just at the place.
    #[test]
    fn the_highest_avoidable_speed_just_stops() {
        let avoidable = with(20.0, 1.2, 6.5, 40.0)[4];
        let outputs = with(avoidable, 1.2, 6.5, 40.0);
        near(&outputs[..1], &[40.0]);
        near(&outputs[2..3], &[0.0]);
    }
}
