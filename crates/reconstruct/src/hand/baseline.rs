//! The classic hand calculation, as a baseline: how fast the struck car left the impact from the
//! distance of its spin-out, and from there back through the impact by momentum.
//!
//! ```text
//! v_after  = √(2 g d (μ_s s + f (1 − s) + G))    d: straight distance from impact to rest, G: grade along it
//! v_before = v_after − Δv_x                       s: share of d along which the wheels left marks
//! v_n      = Δv_n (m_t (1/m_t + 1/m_b + r_t²/I_t + r_b²/I_b))/(1 + e)     closing, from Δv
//! ```
//!
//! Sources: [`Brach2011`](impactlab_core::bibliography::Brach2011), drag factors and the critical drag of a
//! spinning car, whose mean over a spin is about half of that of locked wheels; planar impact.
//! Where the ground has zones of their own friction, μ is its mean along d.
//! Marks count with the mean over the four wheels. Without marks s is taken from the spin: the drag of
//! a spinning car is 0.5 μ on the average. The normal part of Δv is that of the event data recorder,
//! or it is left at what its prior says.
//! The standard deviation is that of its parts: friction as measured, the drag share ± 0.15 without
//! marks and ± 0.12 with, and 5 % for the formula.

use crate::Cars;
use crate::evidence::{DEFAULT_FRICTION, DEFAULT_FRICTION_SIGMA, Evidence, Measured};
use crate::hand::slide::{SPIN_DRAG, SPIN_DRAG_SIGMA, slide_speed_m_s};
use crate::prior::USUAL_SLIDING_RATIO;
use impactlab_core::collision::Side;
use impactlab_core::numerics::line_length;
use impactlab_core::vehicle::{FrictionZone, friction_at};

/// Drag factor of a car that rolls, with engine braking.
const ROLLING_DRAG: f64 = 0.03;
/// Restitution of the hand calculation.
const RESTITUTION: f64 = 0.3;
/// Places on the way to rest at which the friction of the ground is looked up.
const N_ON_THE_WAY: usize = 200;
/// Change of velocity across where no recorder tells it, m/s, and its standard deviation: what a PIT
/// manoeuvre usually brings.
const USUAL_DELTA_V_M_S: Measured = Measured { value: 1.2, sigma: 0.5 };

/// Speeds by hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandCalculation {
    /// Speed of the struck car before the impact, m/s.
    pub struck_speed_m_s: Measured,
    /// Closing speed across the struck side, m/s.
    pub closing_speed_m_s: Measured,
}

impl HandCalculation {
    /// The speeds of a case; `None` if its rest position is not known, or if it lies down a slope on which nothing
    /// comes to rest.
    ///
    /// - `zones`: parts of the ground with their own friction.
    pub fn new(evidence: &Evidence, cars: &Cars, zones: &[FrictionZone]) -> Option<Self> {
        let [x_m, y_m] = evidence.free_rest()?.place_m()?;
        let distance_m = x_m.hypot(y_m);
        let road = evidence
            .road_friction()
            .unwrap_or(Measured { value: DEFAULT_FRICTION, sigma: DEFAULT_FRICTION_SIGMA });
        let friction = friction_on_the_way(road, [x_m, y_m], zones);
        let (drag_share, scatter) = drag_share(evidence, distance_m, friction.value);
        let drag = friction.value * drag_share;
        let grade = evidence.slope().along(y_m.atan2(x_m));
        if drag + grade <= 0.0 {
            return None;
        }
        let after = slide_speed_m_s((drag + grade) / grade.hypot(1.0), distance_m);
        // v goes with the root of the drag.
        let relative = [friction.sigma / friction.value, scatter / drag_share]
            .map(|share| share / 2.0 * drag / (drag + grade))
            .into_iter()
            .chain([0.05])
            .map(|share| share * share)
            .sum::<f64>()
            .sqrt();
        let along = evidence.recorder().delta_v_x().map_or(0.0, |[low, high]| (low + high) / 2.0);
        let by_record = evidence.recorder().speed_before();
        let own = Measured { value: (after - along).max(0.0), sigma: relative * after };
        let struck_speed_m_s = by_record.map_or(own, |record| combined(own, record));
        Some(Self { struck_speed_m_s, closing_speed_m_s: closing(evidence, cars) })
    }
}

/// Mean friction on the straight way from the impact to rest, with the relative scatter of the road.
fn friction_on_the_way(road: Measured, rest_m: [f64; 2], zones: &[FrictionZone]) -> Measured {
    if zones.is_empty() {
        return road;
    }
    let at = |i: usize| {
        let share = (i as f64 + 0.5) / N_ON_THE_WAY as f64;
        friction_at(zones, rest_m.map(|coordinate| share * coordinate), road.value)
    };
    let mean = (0..N_ON_THE_WAY).map(at).sum::<f64>() / N_ON_THE_WAY as f64;
    Measured { value: mean, sigma: road.sigma * mean / road.value }
}

/// Drag over friction, with its standard deviation.
fn drag_share(evidence: &Evidence, distance_m: f64, friction: f64) -> (f64, f64) {
    if evidence.marks.is_empty() {
        return (SPIN_DRAG, SPIN_DRAG_SIGMA);
    }
    let marks: f64 = evidence.marks.iter().map(|mark| line_length(&mark.points_m)).sum();
    let share = (marks / 4.0 / distance_m).min(1.0);
    (USUAL_SLIDING_RATIO * share + ROLLING_DRAG / friction * (1.0 - share), 0.12)
}

/// Two measurements of one number, each with the weight of its precision.
fn combined(a: Measured, b: Measured) -> Measured {
    let [wa, wb] = [a, b].map(|measured| measured.sigma.powi(-2));
    Measured { value: (a.value * wa + b.value * wb) / (wa + wb), sigma: (wa + wb).sqrt().recip() }
}

/// Closing speed across the struck side, by momentum and restitution.
fn closing(evidence: &Evidence, cars: &Cars) -> Measured {
    let damage = &evidence.damage;
    let along_m = damage.along().map_or(0.0, |along| along.value);
    let recorded = match damage.struck_side() {
        Side::Left | Side::Right => evidence.recorder().delta_v_y(),
        Side::Front | Side::Rear => evidence.recorder().delta_v_x(),
    };
    let of_record = |[low, high]: [f64; 2]| Measured {
        value: ((low + high) / 2.0).abs(),
        sigma: (high - low).abs() / 3.5,
    };
    let delta_v = recorded.map_or(USUAL_DELTA_V_M_S, of_record);
    let (struck, striking) = (&cars.struck.parameters, &cars.striking.parameters);
    let arm = |arm_m: f64, inertia: f64| arm_m * arm_m / inertia;
    let inverse = 1.0 / struck.mass.mass_kg
        + 1.0 / striking.mass.mass_kg
        + arm(along_m, struck.mass.yaw_inertia_kg_m2)
        + arm(striking.geometry.cg_to_front_end_m, striking.mass.yaw_inertia_kg_m2);
    let factor = struck.mass.mass_kg * inverse / (1.0 + RESTITUTION);
    // Restitution ± 0.15.
    let relative = (delta_v.sigma / delta_v.value).hypot(0.15 / (1.0 + RESTITUTION));
    let value = delta_v.value * factor;
    Measured { value, sigma: relative * value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::Edr;
    use impactlab_core::data::TomlFile;

    #[test]
    fn a_car_that_slid_all_the_way_has_the_speed_of_its_marks() {
        let text = r#"
            road = { friction = 0.7, friction_sigma = 0.04 }
            struck_car = { mass_kg = 1500 }
            striking_car = { mass_kg = 1500 }
            damage = { side = "right", x_m = -1.5 }
            rest = { x_m = 30, y_m = 0 }
            mark = [
                { wheel = "FL", points_m = [[0, 0], [30, 0]] },
                { wheel = "FR", points_m = [[0, 0], [30, 0]] },
                { wheel = "RL", points_m = [[0, 0], [30, 0]] },
                { wheel = "RR", points_m = [[0, 0], [30, 0]] },
            ]
        "#;
        let file = TomlFile { path: std::path::Path::new("case.toml"), text };
        let mut evidence = Evidence::from_toml(file).unwrap();
        let cars = Cars::new(&evidence, None, None);
        let hand = HandCalculation::new(&evidence, &cars, &[]).unwrap().struck_speed_m_s;
        let expected = (2.0 * 9.806_65 * 0.7 * 0.8 * 30.0_f64).sqrt();
        assert!((hand.value - expected).abs() < 1e-6, "{hand:?}, expected {expected}");
        // A recorder that is as good moves it half way, and narrows it.
        let speed_before_m_s = Some(Measured { value: expected + 1.0, ..hand }.into());
        evidence.edr = Some(Edr { speed_before_m_s, ..Edr::default() });
        let both = HandCalculation::new(&evidence, &cars, &[]).unwrap().struck_speed_m_s;
        assert!((both.value - expected - 0.5).abs() < 1e-6, "{both:?}");
        assert!((both.sigma * 2_f64.sqrt() / hand.sigma - 1.0).abs() < 1e-9, "{both:?}");
        // The second half of the way on ice takes the friction that both halves have on the average.
        evidence.edr = None;
        let border_m = vec![[15.0, -5.0], [40.0, -5.0], [40.0, 5.0], [15.0, 5.0]];
        let ice = FrictionZone { name: "ice".to_owned(), border_m, friction: 0.1 };
        let icy = HandCalculation::new(&evidence, &cars, &[ice]).unwrap().struck_speed_m_s;
        let share = (0.4_f64 / 0.7).sqrt();
        assert!((icy.value / expected - share).abs() < 1e-6, "{icy:?}, expected {share} of it");
        evidence.rest = None;
        assert_eq!(HandCalculation::new(&evidence, &cars, &[]), None);
    }
}
