//! How stiff the faces of a vehicle are: values of printed cars, a rule for other cars, and what a test
//! against a rigid barrier says.
//!
//! ```text
//! A = m b₀ b₁/L      B = m b₁²/L      b₁ = (V − b₀)/C̄      C̄ = (C₁/2 + C₂ + … + C₅ + C₆/2)/5
//! ```
//!
//! m is the mass of the car, L the width of its crushed face, V the speed of the test, b₀ the speed up
//! to which nothing is crushed, C₁ to C₆ the crush at six equidistant places.
//! Source: [`Campbell1974`](crate::bibliography::Campbell1974); the printed cars are those of
//! [`EdsmacManual`](crate::bibliography::EdsmacManual).

use crate::collision::Side;
use crate::collision::contact::law::{FaceLaw, FaceLawError, FaceParameters, Recovery};
use crate::data::CrashTest;
use crate::numerics::normal_quantile;
use crate::units::{Estimate, Interval, MILE_PER_HOUR_M_S};
use crate::vehicle::{CrushFace, CrushParameters, CrushStiffness, VehicleClass, VehicleParameters};

/// A and B of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceStiffness {
    /// A: load at which the face begins to crush, N/m.
    pub onset_n_per_m: f64,
    /// B: growth of the load with the depth of the crush, N/m².
    pub stiffness_n_per_m2: f64,
}

/// One value for each face of a vehicle; both sides have the same.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ByFace<T> {
    /// Of the front.
    pub front: T,
    /// Of the left and of the right side.
    pub side: T,
    /// Of the rear.
    pub rear: T,
}

impl<T> ByFace<T> {
    /// The value of a side of the outline.
    pub fn at(&self, side: Side) -> &T {
        match side {
            Side::Front => &self.front,
            Side::Left | Side::Right => &self.side,
            Side::Rear => &self.rear,
        }
    }

    /// The value of a face.
    pub fn at_face(&self, face: CrushFace) -> &T {
        match face {
            CrushFace::Front => &self.front,
            CrushFace::Side => &self.side,
            CrushFace::Rear => &self.rear,
        }
    }

    /// Converts the value of each face.
    pub fn map<U>(self, convert: impl Fn(T) -> U) -> ByFace<U> {
        ByFace { front: convert(self.front), side: convert(self.side), rear: convert(self.rear) }
    }
}

/// The laws of the faces of a vehicle.
pub type FaceLaws = ByFace<FaceLaw>;

/// Standard deviation of the logarithm of A and B, which vary together, of cars of a class. Sides "vary
/// widely, even within a given class" (SAE 2020-01-0640, 49 tests); the numbers were chosen.
pub const STIFFNESS_LOG_SIGMA: ByFace<f64> = ByFace { front: 0.25, side: 0.4, rear: 0.35 };

/// The same of a car of which a test is known: what one test against a flat barrier leaves open of the
/// corner that meets another car. Chosen.
pub const TESTED_LOG_SIGMA: f64 = 0.15;

/// Standard deviations of the logarithm of A and B of the faces of a vehicle.
pub fn stiffness_log_sigma(said: &CrushParameters) -> ByFace<f64> {
    let sigma = |said: Option<CrushStiffness>, by_rule| {
        if said.is_some() { TESTED_LOG_SIGMA } else { by_rule }
    };
    let by_rule = STIFFNESS_LOG_SIGMA;
    ByFace {
        front: sigma(said.front, by_rule.front),
        side: sigma(said.side, by_rule.side),
        rear: sigma(said.rear, by_rule.rear),
    }
}

/// Length δ_e of the elastic branch, m. Fitted with [`PRINTED_FACTORS`].
pub const ELASTIC_DEPTH_M: ByFace<f64> = ByFace { front: 0.04, side: 0.035, rear: 0.04 };

/// Standard deviation of the logarithm of δ_e of a vehicle. Chosen.
pub const ELASTIC_DEPTH_LOG_SIGMA: f64 = 0.3;

/// Factors on A and on B of the printed cars.
///
/// A and B of tests are means over deep crush of the whole face against a flat barrier. What a corner of
/// a nose meets as it pushes the side of another vehicle is stiffer, and begins softer: with these
/// factors the motions of pushing pairs of the data set `pairs` come out nearest, which was tried on half
/// of its cases (`docs/VALIDATION.md`). They carry over what that data set has of finite-element runs.
pub const PRINTED_FACTORS: ByFace<[f64; 2]> =
    ByFace { front: [0.5, 6.0], side: [2.0, 6.0], rear: [0.5, 0.5] };

/// Deflection beyond which the load grows no further, m. Chosen: about the deepest crush of the tests
/// behind A and B, so that a deep overlap is not extrapolated.
pub const SATURATION_DEPTH_M: ByFace<f64> = ByFace { front: 1.0, side: 0.6, rear: 1.0 };

/// A car whose stiffness is printed.
struct PrintedCar {
    mass_kg: f64,
    stiffness: ByFace<FaceStiffness>,
}

/// - `[A, B]` of front, side and rear, N/cm and N/cm², as printed.
const fn printed(mass_kg: f64, [front, side, rear]: [[f64; 2]; 3]) -> PrintedCar {
    const fn face([onset_n_cm, stiffness_n_cm2]: [f64; 2]) -> FaceStiffness {
        FaceStiffness { onset_n_per_m: onset_n_cm * 1e2, stiffness_n_per_m2: stiffness_n_cm2 * 1e4 }
    }
    let stiffness = ByFace { front: face(front), side: face(side), rear: face(rear) };
    PrintedCar { mass_kg, stiffness }
}

/// Ford Escort 1991–96, a hatchback.
const HATCHBACK: PrintedCar = printed(1125.0, [[515.6, 70.9], [154.5, 41.2], [313.5, 29.6]]);
/// Nissan Sentra 1995–99, a small saloon.
const SMALL_SALOON: PrintedCar = printed(1150.0, [[432.1, 50.5], [175.1, 45.6], [284.2, 34.1]]);
/// BMW 740iL, a large saloon.
const LARGE_SALOON: PrintedCar = printed(1922.0, [[505.6, 78.2], [239.9, 65.5], [512.1, 95.1]]);
/// Chevrolet K-5 Blazer, an off-road vehicle.
const OFF_ROADER: PrintedCar = printed(2207.0, [[516.6, 60.3], [136.6, 27.6], [509.0, 84.8]]);

impl From<CrushStiffness> for FaceStiffness {
    fn from(said: CrushStiffness) -> Self {
        let CrushStiffness { onset_n_per_m, stiffness_n_per_m2 } = said;
        Self { onset_n_per_m, stiffness_n_per_m2 }
    }
}

impl FaceStiffness {
    /// Mean of the logarithms of A and of B.
    ///
    /// - `share`: weight of `other`, 0 to 1.
    fn between(self, other: Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a * (b / a).powf(share);
        Self {
            onset_n_per_m: mix(self.onset_n_per_m, other.onset_n_per_m),
            stiffness_n_per_m2: mix(self.stiffness_n_per_m2, other.stiffness_n_per_m2),
        }
    }

    fn scaled(self, factor: f64) -> Self {
        self.multiplied([factor; 2])
    }

    fn multiplied(self, [onset, stiffness]: [f64; 2]) -> Self {
        Self {
            onset_n_per_m: self.onset_n_per_m * onset,
            stiffness_n_per_m2: self.stiffness_n_per_m2 * stiffness,
        }
    }
}

impl ByFace<FaceStiffness> {
    fn between(self, other: Self, share: f64) -> Self {
        Self {
            front: self.front.between(other.front, share),
            side: self.side.between(other.side, share),
            rear: self.rear.between(other.rear, share),
        }
    }
}

/// The rule of [`class_stiffness`] in a few words.
pub const STIFFNESS_RULE: &str = "by class and mass, between cars whose A and B are printed";
/// Where its cars and its scatter come from.
pub const STIFFNESS_SOURCE: &str =
    "EDSMAC manual, four cars; scatter chosen, sides after SAE 2020-01-0640";

/// Medians of A and B of a vehicle of which only class and mass are known.
///
/// Passenger cars, and vehicles of no stated class: between the two small cars and the large saloon
/// the logarithms are linear in that of the mass. Other classes have the values of the off-road vehicle.
/// Outside of these masses, and for other classes, A and B are in proportion to the mass: a car with
/// the same b₀ and b₁, so that it is crushed as deep at the same speed.
///
/// - `mass_kg`: more than 0.
pub fn class_stiffness(class: VehicleClass, mass_kg: f64) -> ByFace<FaceStiffness> {
    match class {
        VehicleClass::Any | VehicleClass::Car => {
            let small = HATCHBACK.stiffness.between(SMALL_SALOON.stiffness, 0.5);
            let low_kg = (HATCHBACK.mass_kg * SMALL_SALOON.mass_kg).sqrt();
            let high_kg = LARGE_SALOON.mass_kg;
            let inside_kg = mass_kg.clamp(low_kg, high_kg);
            let share = (inside_kg / low_kg).ln() / (high_kg / low_kg).ln();
            let stiffness = small.between(LARGE_SALOON.stiffness, share);
            stiffness.map(|face| face.scaled(mass_kg / inside_kg))
        }
        VehicleClass::Suv | VehicleClass::Pickup | VehicleClass::Van => {
            OFF_ROADER.stiffness.map(|face| face.scaled(mass_kg / OFF_ROADER.mass_kg))
        }
    }
}

/// A and B of a face by [`class_stiffness`], N/m and N/m², each with the interval of 90 % of its scatter.
///
/// - `mass_kg`: more than 0.
pub fn class_estimates(class: VehicleClass, mass_kg: f64, face: CrushFace) -> [Estimate; 2] {
    let FaceStiffness { onset_n_per_m, stiffness_n_per_m2 } =
        *class_stiffness(class, mass_kg).at_face(face);
    let sigma = STIFFNESS_LOG_SIGMA.at_face(face);
    let factor = (sigma * normal_quantile(0.95)).exp();
    [onset_n_per_m, stiffness_n_per_m2].map(|median| Estimate {
        median,
        intervals: vec![Interval { level: 0.9, low: median / factor, high: median * factor }],
    })
}

impl ByFace<FaceStiffness> {
    /// The laws of the faces with the usual elastic branch, saturation and recovery.
    ///
    /// # Errors
    /// [`FaceLawError`] if a number is out of range.
    pub fn laws(self) -> Result<FaceLaws, FaceLawError> {
        let law = |stiffness: FaceStiffness, elastic_depth_m, saturation_depth_m| {
            FaceLaw::new(FaceParameters {
                onset_n_per_m: stiffness.onset_n_per_m,
                stiffness_n_per_m2: stiffness.stiffness_n_per_m2,
                elastic_depth_m,
                saturation_depth_m,
                recovery: Recovery::default(),
            })
        };
        let (elastic, saturation) = (ELASTIC_DEPTH_M, SATURATION_DEPTH_M);
        Ok(ByFace {
            front: law(self.front, elastic.front, saturation.front)?,
            side: law(self.side, elastic.side, saturation.side)?,
            rear: law(self.rear, elastic.rear, saturation.rear)?,
        })
    }
}

impl FaceLaws {
    /// The laws of a vehicle: A and B of its file, and by the rule for its class and mass where that says
    /// nothing, see [`class_stiffness`] and [`PRINTED_FACTORS`].
    ///
    /// # Errors
    /// [`FaceLawError`] if the mass is not more than 0.
    pub fn by_class(vehicle: &VehicleParameters) -> Result<Self, FaceLawError> {
        let class = vehicle.sheet.as_ref().map_or(VehicleClass::Any, |sheet| sheet.class);
        let by_rule = class_stiffness(class, vehicle.mass.mass_kg);
        let said = vehicle.crush;
        let face =
            |said: Option<CrushStiffness>, by_rule| said.map_or(by_rule, FaceStiffness::from);
        let printed = ByFace {
            front: face(said.front, by_rule.front),
            side: face(said.side, by_rule.side),
            rear: face(said.rear, by_rule.rear),
        };
        let factors = PRINTED_FACTORS;
        ByFace {
            front: printed.front.multiplied(factors.front),
            side: printed.side.multiplied(factors.side),
            rear: printed.rear.multiplied(factors.rear),
        }
        .laws()
    }

    /// The laws at a number of standard deviations of their scatter.
    ///
    /// - `latents`: standard normal values;
    /// - `sigma`: of the logarithms, see [`stiffness_log_sigma`].
    #[must_use]
    pub fn drawn(self, latents: ByFace<f64>, sigma: ByFace<f64>) -> Self {
        Self {
            front: self.front.scaled((sigma.front * latents.front).exp()),
            side: self.side.scaled((sigma.side * latents.side).exp()),
            rear: self.rear.scaled((sigma.rear * latents.rear).exp()),
        }
    }
}

/// A test of a car against a rigid barrier, over the whole width of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarrierTest {
    /// Mass m of the car, kg.
    pub mass_kg: f64,
    /// Width L of the crushed face, m.
    pub width_m: f64,
    /// Speed V of the impact, m/s.
    pub speed_m_s: f64,
    /// Speed b₀ up to which nothing is crushed, m/s; 5 mph where nobody says it.
    pub no_damage_speed_m_s: f64,
    /// Crush C₁ to C₆ at six equidistant places across the face, m.
    pub crush_m: [f64; 6],
}

impl BarrierTest {
    /// The test of the front of one vehicle against a rigid barrier, with 5 mph up to which nothing is crushed.
    ///
    /// # Errors
    /// What is missing, or why it is no such test, in words.
    pub fn from_crash_test(test: &CrashTest) -> Result<Self, String> {
        let [vehicle] = test.vehicles.as_slice() else {
            return Err("it is not a test of one vehicle against a barrier".to_owned());
        };
        if !test.barrier.as_deref().is_some_and(|barrier| barrier.starts_with('R')) {
            return Err("the barrier is not said to be rigid".to_owned());
        }
        if test.barrier.as_deref().is_some_and(|barrier| barrier.starts_with("R POL")) {
            return Err("the barrier is a pole, which crushes a part of the face".to_owned());
        }
        if test.is_oblique {
            return Err("the impact was at an angle".to_owned());
        }
        // The third sign of the code is the face: F for the front.
        let face = vehicle.damage_code.chars().nth(2).filter(|face| face.is_alphabetic());
        if let Some(face) = face.filter(|face| *face != 'F') {
            return Err(format!("the damage {} is on the face {face}", vehicle.damage_code));
        }
        // The fourth sign is where across it: D for all of it, Y and Z for two thirds at the left and at the right.
        let part = vehicle.damage_code.chars().nth(3);
        if part.is_some_and(|part| matches!(part, 'L' | 'C' | 'R' | 'Y' | 'Z')) {
            let code = &vehicle.damage_code;
            return Err(format!(
                "the damage {code} is on a part of the face, as of an offset test"
            ));
        }
        let known =
            |value: Option<f64>, name: &str| value.ok_or_else(|| format!("no {name} is stated"));
        let crush_m = vehicle.crush_m.ok_or("no crush C1 to C6 is stated")?;
        // A wall crushes the middle of a front everywhere, and 0 is what the database writes for what is not known.
        let [_, c2, c3, c4, c5, _] = crush_m;
        if [c2, c3, c4, c5].iter().any(|depth_m| *depth_m <= 0.0) {
            return Err("one of the crush C2 to C5 is 0, so that it was not measured".to_owned());
        }
        Ok(Self {
            mass_kg: known(vehicle.mass_kg, "test mass")?,
            width_m: known(vehicle.width_m, "width")?,
            speed_m_s: known(vehicle.speed_m_s, "speed")?,
            no_damage_speed_m_s: 5.0 * MILE_PER_HOUR_M_S,
            crush_m,
        })
    }

    /// C̄: mean depth of the crush, m.
    pub fn mean_crush_m(&self) -> f64 {
        let [c1, c2, c3, c4, c5, c6] = self.crush_m;
        (c1 / 2.0 + c2 + c3 + c4 + c5 + c6 / 2.0) / 5.0
    }

    /// Kv = m V²/(L C̄²): the one coefficient of a face that is crushed from the first, N/m².
    pub fn single_stiffness_n_per_m2(&self) -> f64 {
        self.mass_kg * self.speed_m_s.powi(2) / (self.width_m * self.mean_crush_m().powi(2))
    }

    /// A and B of the face.
    ///
    /// # Errors
    /// [`FaceLawError`] names the first number that is out of range.
    pub fn stiffness(&self) -> Result<FaceStiffness, FaceLawError> {
        let mean_crush_m = self.mean_crush_m();
        let over_b0_m_s = self.speed_m_s - self.no_damage_speed_m_s;
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let b0 = self.no_damage_speed_m_s;
        for (is_good, name, value, expected) in [
            (positive(self.mass_kg), "mass_kg", self.mass_kg, "more than 0"),
            (positive(self.width_m), "width_m", self.width_m, "more than 0"),
            (b0.is_finite() && b0 >= 0.0, "no_damage_speed_m_s", b0, "0 or more"),
            (positive(over_b0_m_s), "speed_m_s", self.speed_m_s, "more than no_damage_speed_m_s"),
            (positive(mean_crush_m), "mean crush", mean_crush_m, "more than 0"),
        ] {
            if !is_good {
                return Err(FaceLawError { name, value, expected });
            }
        }
        let b1 = over_b0_m_s / mean_crush_m;
        let mass_per_width = self.mass_kg / self.width_m;
        Ok(FaceStiffness {
            onset_n_per_m: mass_per_width * b0 * b1,
            stiffness_n_per_m2: mass_per_width * b1 * b1,
        })
    }
}

#[cfg(test)]
#[path = "stiffness_tests.rs"]
mod tests;
