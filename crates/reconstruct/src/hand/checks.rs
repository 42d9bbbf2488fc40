//! What one computes by hand beside a reconstruction: checks that share no model with it. Each uses one way
//! to a number, borrows nothing from another, says under which conditions it holds, and is left out where
//! they do not.
//!
//! ```text
//! way to rest     v' = √(2 g d (f + G)/√(1 + G²))      f: drag factor, d: straight way from impact to rest,
//!                                                     G: grade along it
//! momentum        m_t v_t + m_b v_b = m_t v_t' + m_b v_b'     v' along the ways to rest
//! ```
//!
//! The drag factor is that of locked wheels, as measured or, where it was not, the friction of the road;
//! that of a car that spins with wheels that turn is half of the friction on the average. Momentum gives
//! both speeds of cars that meet at an angle; where they meet in line, it gives that of the striking car if
//! that of the struck car is stated. Both ways have the friction of one road, so that its error moves both
//! speeds after the impact together.
//!
//! Source: [`Brach2011`](impactlab_core::bibliography::Brach2011).

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::Serialize;

use crate::Cars;
use crate::evidence::{After, Evidence, Mark, MarkKind, Measured, RestPose, YesNoUnknown, ends};
use crate::hand::momentum::{LEAST_ANGLE_RAD, speed_in_line, speeds_at_angles};
use crate::hand::slide::{SPIN_DRAG, SPIN_DRAG_SIGMA, slide_speed_m_s};
use crate::single_car::StartPlace;
use impactlab_core::collision::Side;
use impactlab_core::numerics::{is_quarter_turn, line_length, wrap_angle_rad};
use impactlab_core::vehicle::{FrictionZone, Wheel};

/// Relative scatter of the friction of the road as the drag factor of a car.
const DRAG_BY_FRICTION: f64 = 0.08;
/// Scatter of the distance that a car slides before its wheels are locked, m.
const LOCKING_WAY_M: f64 = 0.5;
/// Way to rest below which nothing follows from it, m.
const LEAST_WAY_M: f64 = 1.0;
/// Share of the way over which the marks of each wheel have to reach for it to have been locked all along.
const MARKED_SHARE: f64 = 0.9;
/// When braking may begin that locks the wheels from the impact on, s.
const AT_ONCE_S: f64 = 0.15;
/// Largest width of a range in which a stated speed lies, m/s.
const STATED_WIDTH_M_S: f64 = 2.0;
/// Largest angle between the cars at which they meet in line, rad.
const IN_LINE_RAD: f64 = 0.2;
/// Standard deviation of the place of the impact along a car, m: how far both are crushed.
const CRUSH_M: f64 = 0.3;

/// A number by hand.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct HandCheck {
    /// The speed that it gives.
    pub speed: HandSpeed,
    /// The speed, m/s.
    pub value_m_s: f64,
    /// Standard deviation, m/s.
    pub sigma_m_s: f64,
    /// What it follows from, and when it holds.
    pub holds: &'static str,
}

/// A speed that a check gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HandSpeed {
    /// The struck car after the impact.
    StruckAfter,
    /// The striking car after the impact.
    StrikingAfter,
    /// The struck car before the impact.
    Struck,
    /// The striking car before the impact.
    Striking,
    /// A single car at the start.
    AtStart,
}

impl HandSpeed {
    /// What it is called.
    pub fn label(self) -> &'static str {
        match self {
            Self::StruckAfter => "struck car after the impact",
            Self::StrikingAfter => "striking car after the impact",
            Self::Struck => "struck car before the impact",
            Self::Striking => "striking car before the impact",
            Self::AtStart => "car at the start",
        }
    }
}

/// What a car did after the impact, by hand.
#[derive(Debug, Clone, Copy)]
struct Departure {
    speed: Measured,
    /// Part of its standard deviation that comes of the drag, as a share of the speed.
    drag_share: f64,
    course_rad: Measured,
    holds: &'static str,
}

impl HandCheck {
    /// The checks that hold for a case.
    ///
    /// - `zones`: parts of the ground with their own friction; no check knows what a way over several has.
    pub fn all(evidence: &Evidence, cars: &Cars, zones: &[FrictionZone]) -> Vec<Self> {
        if !zones.is_empty() {
            return Vec::new();
        }
        let rests = [evidence.free_rest(), evidence.free_striking_rest()];
        let struck = slide(evidence, rests[0].as_ref(), Which::Struck, cars);
        let striking = slide(evidence, rests[1].as_ref(), Which::Striking, cars);
        let of_struck = match evidence.is_single_car() {
            true => HandSpeed::AtStart,
            false => HandSpeed::StruckAfter,
        };
        let after = [(of_struck, struck), (HandSpeed::StrikingAfter, striking)];
        let mut checks: Vec<Self> = after
            .into_iter()
            .filter_map(|(speed, after)| {
                after.map(|after| Self::new(speed, after.speed, after.holds))
            })
            .collect();
        if let (Some(struck), Some(striking)) = (struck, striking) {
            checks.extend(momentum(evidence, cars, [struck, striking]));
        }
        checks
    }

    fn new(speed: HandSpeed, Measured { value, sigma }: Measured, holds: &'static str) -> Self {
        Self { speed, value_m_s: value, sigma_m_s: sigma, holds }
    }
}

/// One of the two cars.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Which {
    Struck,
    Striking,
}

/// The speed after the impact by the way to rest; `None` where the drag on it is not known.
fn slide(
    evidence: &Evidence,
    rest: Option<&RestPose>,
    which: Which,
    cars: &Cars,
) -> Option<Departure> {
    let rest = rest?;
    let [x_m, y_m] = rest.place_m()?;
    let [from_x_m, from_y_m] = match which {
        Which::Struck => StartPlace::of(evidence, cars).map_or([0.0; 2], |start| start.cg_m()),
        Which::Striking => striking_at_contact_m(evidence, cars)?,
    };
    let way_m = [x_m - from_x_m, y_m - from_y_m];
    let length_m = way_m[0].hypot(way_m[1]);
    if length_m < LEAST_WAY_M {
        return None;
    }
    let (drag, holds) = drag(evidence, rest, which, length_m)?;
    let place_m = rest.position_sigma_m().hypot(LOCKING_WAY_M);
    let place_m = if which == Which::Striking { place_m.hypot(CRUSH_M) } else { place_m };
    let course_rad = Measured { value: way_m[1].atan2(way_m[0]), sigma: place_m / length_m };
    let grade = evidence.slope().along(course_rad.value);
    let resistance = drag.value + grade;
    if resistance <= 0.0 {
        return None;
    }
    let value = slide_speed_m_s(resistance / grade.hypot(1.0), length_m);
    // v goes with the root of resistance and way.
    let drag_share = drag.sigma / resistance / 2.0;
    let sigma = value * drag_share.hypot(place_m / length_m / 2.0);
    Some(Departure { speed: Measured { value, sigma }, drag_share, course_rad, holds })
}

/// The mean drag factor on the way of a car, where it is known, and why.
///
/// - `way_m`: from the impact to rest, m.
fn drag(
    evidence: &Evidence,
    rest: &RestPose,
    which: Which,
    way_m: f64,
) -> Option<(Measured, &'static str)> {
    let friction = evidence.road_friction();
    let locked = evidence.drag_factor().or(friction
        .map(|road| Measured { sigma: road.sigma.hypot(DRAG_BY_FRICTION * road.value), ..road }));
    let ranges = &evidence.prior;
    let (after, marks, ranges) = match which {
        Which::Struck => {
            (&evidence.after, &evidence.marks, [ranges.brake_start_s, ranges.brake_share])
        }
        Which::Striking => {
            let ranges = [ranges.striking_brake_start_s, ranges.striking_brake_share];
            (&evidence.striking_after, &evidence.striking_marks, ranges)
        }
    };
    let [start_s, share] = ranges.map(ends);
    let is_braked_hard = after.driver_braked == YesNoUnknown::Yes
        && start_s.is_some_and(|[_, last]| last <= AT_ONCE_S)
        && share.is_some_and(|[least, _]| least > 1.0);
    let has_anti_lock = after.anti_lock == YesNoUnknown::Yes;
    if after.is_all_locked() || (!has_anti_lock && has_four_locked_marks(marks, way_m)) {
        let holds = match evidence.is_single_car() {
            true => "distance to rest; all wheels were locked from the start on",
            false => "distance to rest; all wheels were locked from the impact on",
        };
        return locked.map(|drag| (drag, holds));
    }
    if evidence.is_single_car() {
        return None;
    }
    if is_braked_hard && !has_anti_lock {
        return locked.map(|drag| (drag, "distance to rest; the brakes locked all wheels at once"));
    }
    let turned = rest.heading().map(|heading| wrap_angle_rad(heading.value).abs());
    let has_spun = turned.is_some_and(is_quarter_turn);
    let turns = after.driver_braked == YesNoUnknown::No && is_free(after);
    (which == Which::Struck && has_spun && turns).then_some(())?;
    let road = friction?;
    let value = SPIN_DRAG * road.value;
    let relative = (SPIN_DRAG_SIGMA / SPIN_DRAG).hypot(road.sigma / road.value);
    let drag = Measured { value, sigma: relative * value };
    Some((drag, "distance to rest; it spun with wheels that turned, with half of the friction"))
}

/// Whether no wheel is known to be held.
fn is_free(after: &After) -> bool {
    let none = |wheels: &Option<Vec<Wheel>>| wheels.as_ref().is_none_or(Vec::is_empty);
    after.blocked_wheels.as_ref().is_some_and(Vec::is_empty) && none(&after.dragging_wheels)
}

/// Whether each wheel has left marks as a locked wheel does over nearly the whole way.
fn has_four_locked_marks(marks: &[Mark], way_m: f64) -> bool {
    let length_m = |mark: &Mark| line_length(&mark.points_m);
    let is_locked = |wheel: &Wheel| {
        let locked = marks.iter().filter(|m| m.wheel == *wheel && m.kind == Some(MarkKind::Locked));
        locked.map(length_m).sum::<f64>() > MARKED_SHARE * way_m
    };
    Wheel::ALL.iter().all(is_locked)
}

/// Heading of the striking car at the impact, by the damage or by the struck end.
fn heading(evidence: &Evidence) -> Option<Measured> {
    let by_end = |value| Measured { value, sigma: 0.1 };
    evidence.damage.angle().or(match evidence.damage.struck_side() {
        Side::Rear => Some(by_end(0.0)),
        Side::Front => Some(by_end(PI)),
        Side::Left | Side::Right => None,
    })
}

/// CG of the striking car at first contact, which it touches with the middle of its front.
fn striking_at_contact_m(evidence: &Evidence, cars: &Cars) -> Option<[f64; 2]> {
    let damage = &evidence.damage;
    let along_m = damage.along()?.value;
    let across_m = damage.depth_m.unwrap_or_else(|| cars.depth_of(damage.struck_side()));
    let [x_m, y_m] = match damage.struck_side() {
        Side::Left | Side::Right => [along_m, across_m],
        Side::Front | Side::Rear => [across_m, along_m],
    };
    let (sin, cos) = heading(evidence)?.value.sin_cos();
    let front_m = cars.striking.parameters.geometry.cg_to_front_end_m;
    Some([x_m - front_m * cos, y_m - front_m * sin])
}

/// Speeds before the impact by momentum, where the angle of the cars or a stated speed allows it.
fn momentum(
    evidence: &Evidence,
    cars: &Cars,
    [struck, striking]: [Departure; 2],
) -> Vec<HandCheck> {
    let Some(heading) = heading(evidence) else { return Vec::new() };
    let mass = |measured: Option<Measured>, kg: f64| {
        measured.unwrap_or(Measured { value: kg, sigma: 0.1 * kg })
    };
    let struck_kg = mass(evidence.struck_car.mass(), cars.struck.parameters.mass.mass_kg);
    let striking_kg = mass(evidence.striking_car.mass(), cars.striking.parameters.mass.mass_kg);
    let common = struck.drag_share.min(striking.drag_share);
    let own = |after: Departure| {
        let Measured { value, sigma } = after.speed;
        let rest = sigma.powi(2) - (common * value).powi(2);
        Measured { value, sigma: rest.max(0.0).sqrt() }
    };
    let inputs = [
        own(struck),
        struck.course_rad,
        own(striking),
        striking.course_rad,
        struck_kg,
        striking_kg,
        heading,
        Measured { value: 1.0, sigma: common },
    ];
    let after = |[v_t, a_t, v_b, a_b, m_t, m_b, _, friction]: [f64; 8]| {
        let x = m_t * v_t * a_t.cos() + m_b * v_b * a_b.cos();
        [friction * x, friction * (m_t * v_t * a_t.sin() + m_b * v_b * a_b.sin())]
    };
    let across = heading.value.sin().abs();
    if across > LEAST_ANGLE_RAD.sin() {
        let before = |inputs: [f64; 8]| {
            speeds_at_angles(after(inputs), [inputs[4], inputs[5]], [0.0, inputs[6]])
        };
        let struck = propagated(inputs, |inputs| before(inputs)[0]);
        let striking = propagated(inputs, |inputs| before(inputs)[1]);
        let holds = "momentum of both cars before and after; the struck car drove straight on, the \
                     striking car along its heading";
        let both = [(HandSpeed::Struck, struck), (HandSpeed::Striking, striking)];
        let checks = both.map(|(speed, value)| HandCheck::new(speed, value, holds));
        return checks.into_iter().filter(|check| check.value_m_s >= 0.0).collect();
    }
    let stated = ends(evidence.prior.struck_speed_m_s);
    let Some([low, high]) = stated.filter(|[low, high]| high - low <= STATED_WIDTH_M_S) else {
        return Vec::new();
    };
    if across > IN_LINE_RAD.sin() {
        return Vec::new();
    }
    let before = (low + high) / 2.0;
    let striking = propagated(inputs, |inputs| {
        speed_in_line(after(inputs)[0], inputs[5] * inputs[6].cos(), inputs[4] * before)
    });
    // Every value of the stated range is equally likely.
    let own = (high - low) / 12.0_f64.sqrt();
    let sigma = striking.sigma.hypot(own * struck_kg.value / striking_kg.value);
    let holds = "momentum in line; the speed of the struck car is the one that is stated";
    let value = Measured { sigma, ..striking };
    let check = HandCheck::new(HandSpeed::Striking, value, holds);
    (check.value_m_s >= 0.0).then_some(check).into_iter().collect()
}

/// A function of independent measurements with its standard deviation, to first order.
fn propagated<const N: usize>(
    inputs: [Measured; N],
    function: impl Fn([f64; N]) -> f64,
) -> Measured {
    let at = inputs.map(|input| input.value);
    let slope_times_sigma = |idx: usize| {
        let [mut low, mut high] = [at; 2];
        low[idx] -= inputs[idx].sigma / 2.0;
        high[idx] += inputs[idx].sigma / 2.0;
        function(high) - function(low)
    };
    let variance: f64 = (0..N).map(|idx| slope_times_sigma(idx).powi(2)).sum();
    Measured { value: function(at), sigma: variance.sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::examples::read;

    const LOCKED: &str = r#"blocked_wheels = ["FL", "FR", "RL", "RR"]"#;

    fn checks(text: &str) -> Vec<(HandSpeed, f64, f64)> {
        let evidence = read(text);
        let cars = Cars::new(&evidence, None, None);
        let checks = HandCheck::all(&evidence, &cars, &[]);
        checks.iter().map(|check| (check.speed, check.value_m_s, check.sigma_m_s)).collect()
    }

    fn rear(more: &str) -> String {
        format!(
            "case = \"hand\"\nroad = {{ friction = 0.7, friction_sigma = 0.02 }}\n\
             struck_car = {{ mass_kg = 1800 }}\n\
             striking_car = {{ mass_kg = 1200, length_m = 4.4, cg_to_front_axle_m = 1.2, \
             cg_to_rear_axle_m = 1.4 }}\n\
             damage = {{ side = \"rear\", y_m = 0, x_m = -2.2 }}\n{more}"
        )
    }

    /// √(2 g · 0.7 · 20) = 16.57 m/s after the impact, and nothing of the speed before it.
    #[test]
    fn a_car_with_locked_wheels_leaves_with_the_speed_of_its_way() {
        let text = rear(&format!("rest = {{ x_m = 20, y_m = 0 }}\nafter = {{ {LOCKED} }}"));
        let found = checks(&text);
        assert_eq!(found.len(), 1, "{found:?}");
        let (speed, value, sigma) = found[0];
        assert_eq!(speed, HandSpeed::StruckAfter);
        assert!((value - (2.0 * 9.806_65 * 0.7 * 20.0_f64).sqrt()).abs() < 1e-9, "{value}");
        assert!((0.5..1.5).contains(&sigma), "{sigma}");
        // Of a car of whose wheels nothing is known, a hand calculation says nothing.
        assert_eq!(checks(&rear("rest = { x_m = 20, y_m = 0 }")), []);
    }

    /// Uphill the weight brakes, too.
    #[test]
    fn a_grade_counts_on_the_way_to_rest() {
        let text = rear(&format!("rest = {{ x_m = 20, y_m = 0 }}\nafter = {{ {LOCKED} }}"));
        for (grade, sign) in [(5.0 / 24.0, 1.0), (-5.0 / 24.0, -1.0)] {
            let of_road = format!("friction_sigma = 0.02, grade = {grade}");
            let found = checks(&text.replace("friction_sigma = 0.02", &of_road));
            let drag = (0.7 + sign * 5.0 / 24.0) / (5.0_f64 / 24.0).hypot(1.0);
            let expected = (2.0 * 9.806_65 * drag * 20.0).sqrt();
            assert!((found[0].1 - expected).abs() < 1e-9, "{found:?}, expected {expected}");
        }
    }

    /// Marks of the last metres say nothing of the way before them.
    #[test]
    fn marks_of_locked_wheels_count_where_they_reach_over_the_way() {
        let marks = |from_m: f64| -> String {
            let mark = |wheel: &str| {
                format!(
                    "[[mark]]\nwheel = \"{wheel}\"\nkind = \"locked\"\n\
                     points_m = [[{from_m}, 0], [20, 0]]\n"
                )
            };
            rear("rest = { x_m = 20, y_m = 0 }\n") + &["FL", "FR", "RL", "RR"].map(mark).concat()
        };
        assert_eq!(checks(&marks(1.0)).len(), 1);
        assert_eq!(checks(&marks(14.0)), []);
    }

    /// A car of 1.2 t pushes one of 1.8 t that stood; both slide from 15 m/s: 37.5 m/s before.
    #[test]
    fn momentum_in_line_needs_the_speed_of_the_struck_car() {
        let way_m = 15.0 * 15.0 / (2.0 * 9.806_65 * 0.7);
        let text = rear(&format!("rest = {{ x_m = {way_m}, y_m = 0 }}\nafter = {{ {LOCKED} }}\n"));
        let evidence = read(&rear("rest = { x_m = 9, y_m = 0 }"));
        let front_m =
            Cars::new(&evidence, None, None).striking.parameters.geometry.cg_to_front_end_m;
        let striking_m = way_m - 2.2 - front_m;
        let both = format!(
            "{text}striking_rest = {{ x_m = {striking_m}, y_m = 0 }}\nstriking_after = {{ {LOCKED} }}\n"
        );
        let speeds = |text: &str| checks(text).iter().map(|check| check.0).collect::<Vec<_>>();
        assert_eq!(speeds(&both), [HandSpeed::StruckAfter, HandSpeed::StrikingAfter]);
        let found = checks(&format!("{both}prior = {{ target_speed_m_s = [0, 0.2] }}\n"));
        let (speed, value, sigma) = found[2];
        assert_eq!(speed, HandSpeed::Striking);
        assert!((value - (15.0 * 3000.0 - 1800.0 * 0.1) / 1200.0).abs() < 1e-9, "{value}");
        // Friction of 0.7 ± 0.02 and 8 % moves both speeds after the impact together.
        let together = 15.0 * (0.02_f64 / 0.7).hypot(0.08) / 2.0 * 3000.0 / 1200.0;
        assert!((together..4.5).contains(&sigma), "{sigma}, expected at least {together}");
    }

    /// At right angles each component of the momentum belongs to one car.
    #[test]
    fn momentum_at_an_angle_gives_both_speeds() {
        let text = format!(
            "case = \"angle\"\nroad = {{ drag_factor = 0.7, drag_factor_sigma = 0.02 }}\n\
             struck_car = {{ mass_kg = 1500 }}\nstriking_car = {{ mass_kg = 1500 }}\n\
             damage = {{ side = \"right\", x_m = 0, angle_deg = 90, angle_sigma_deg = 2 }}\n\
             rest = {{ x_m = 10, y_m = 10 }}\nafter = {{ {LOCKED} }}\n\
             striking_rest = {{ x_m = 10, y_m = 7 }}\nstriking_after = {{ {LOCKED} }}\n"
        );
        let found = checks(&text);
        assert_eq!(found.len(), 4, "{found:?}");
        let way = |x: f64, y: f64| (2.0 * 9.806_65 * 0.7 * x.hypot(y)).sqrt() / x.hypot(y);
        let front_m = {
            let evidence = read(&text);
            let cars = Cars::new(&evidence, None, None);
            let side = cars.depth_of(Side::Right);
            7.0 - side + cars.striking.parameters.geometry.cg_to_front_end_m
        };
        let [a, b] = [way(10.0, 10.0), way(10.0, front_m)];
        assert!((found[2].1 - 10.0 * (a + b)).abs() < 1e-6, "{found:?}");
        assert!((found[3].1 - (10.0 * a + front_m * b)).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_number_errs_as_its_parts_do() {
        let measured = |value, sigma| Measured { value, sigma };
        let sum = propagated([measured(1.0, 0.3), measured(2.0, 0.4)], |[a, b]| a + b);
        assert!((sum.value - 3.0).abs() < 1e-12 && (sum.sigma - 0.5).abs() < 1e-12, "{sum:?}");
    }
}
