//! The face law: the load that a strip of a vehicle's outline carries as it is pressed in, by itself
//! and against a strip of another vehicle.
//!
//! ```text
//! virgin    p = A δ/δ_e                      δ ≤ δ_e        elastic branch through the origin
//!           p = A + B (δ − δ_e)              δ_e < δ ≤ δ_s
//!           p = A + B (δ_s − δ_e)            δ > δ_s        saturation
//! below h   p = p_h max(0, 1 − (h − δ)/(ρ h))               straight unloading and reloading
//! dent      (1 − ρ) h
//! ```
//!
//! p is a force per width of the face, N/m; δ is the deflection; h is the greatest deflection so far
//! and p_h the load there. Each deflection δ(p) is piecewise linear and rising, so the load of two
//! strips in series follows from their overlap in closed form.
//!
//! Source: the line A + B δ is that of [`Campbell1974`](crate::bibliography::Campbell1974); the share
//! ρ that is given back, and its fall with depth, are those of
//! [`EdsmacManual`](crate::bibliography::EdsmacManual). The elastic branch is our own: a law that
//! begins with A at the first touch is far too hard for vehicles that push each other. In seven staged
//! sideswipes ([`FunkCormierBain2004`](crate::bibliography::FunkCormierBain2004)) such a law
//! overestimates the peak by 83 %.
//! Assumes that neighbouring strips do not hold each other and that the load does not depend on the
//! speed. Generic over the scalar, so that strips of several pairs may lie side by side.

use crate::numerics::{Lanes, LanesOver};
use crate::units::INCH_M;

/// Deflection beyond which nothing is given back, m: 52.5 in, where the parabola of
/// [`EdsmacManual`](crate::bibliography::EdsmacManual) ends.
pub const RECOVERY_END_M: f64 = 52.5 * INCH_M;

/// Share ρ that a crushed face gives back at no depth, after
/// [`EdsmacManual`](crate::bibliography::EdsmacManual).
pub const CRUSHED_RECOVERY: f64 = 0.046_06;

/// Share ρ that the elastic branch gives back, a coefficient of restitution √ρ of 0.22. Slow impacts of
/// bumpers have 0.32 to 0.4; pushing pairs, whose faces slide along each other, come out nearer with less.
pub const ELASTIC_RECOVERY: f64 = 0.05;

/// Load below which there is none, N/m, so that no quotient has a divisor of zero.
const NO_LOAD_N_PER_M: f64 = 1e-9;

/// Deflection below which there is none, m.
const NO_DEPTH_M: f64 = 1e-12;

/// Turns in which the greatest deflection that leaves a dent is found.
const DENT_TURNS: usize = 8;

/// Least share of a greatest deflection that stays as a dent where one is known.
const LEAST_DENT_SHARE: f64 = 0.1;

/// Share ρ of its greatest deflection h over which a strip unloads, which is the square of the
/// coefficient of restitution of a linear spring.
///
/// ```text
/// ρ(h) = ρ_e                              h ≤ δ_e
/// ρ(h) = ρ_c (1 − h/h_end)²               h ≥ 2 δ_e, at least 0          linear between both
/// ```
///
/// With ρ_c = 0.04606 and h_end = 52.5 in, the second line is EDSMAC's
/// `0.04606 − 0.0017547 h + 0.000016711 h²` with h in inches
/// ([`EdsmacManual`](crate::bibliography::EdsmacManual)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recovery<P = f64> {
    /// Share ρ_e of the elastic branch, 0 to 1.
    pub elastic: P,
    /// Share ρ_c of a crushed face, extrapolated to no depth, 0 to 1.
    pub crushed: P,
    /// 1/h_end, 1/m; 0 for a share that does not depend on the depth.
    pub per_end_1_m: P,
}

impl Default for Recovery {
    fn default() -> Self {
        Self { elastic: ELASTIC_RECOVERY, ..Self::EDSMAC }
    }
}

impl Recovery {
    /// The share of EDSMAC, which knows no elastic branch.
    pub const EDSMAC: Self = Self {
        elastic: CRUSHED_RECOVERY,
        crushed: CRUSHED_RECOVERY,
        per_end_1_m: 1.0 / RECOVERY_END_M,
    };

    /// The same share at every depth.
    pub const fn constant(share: f64) -> Self {
        Self { elastic: share, crushed: share, per_end_1_m: 0.0 }
    }
}

/// The law of one face of a vehicle. Its numbers were checked in [`FaceLaw::new`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceLaw<P = f64> {
    onset_n_per_m: P,
    stiffness_n_per_m2: P,
    elastic_depth_m: P,
    saturation_n_per_m: P,
    recovery: Recovery<P>,
}

/// The numbers of a [`FaceLaw`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceParameters {
    /// A: load at which the face begins to crush, N/m, 0 or more.
    pub onset_n_per_m: f64,
    /// B: growth of the load with the depth of the crush, N/m², more than 0.
    pub stiffness_n_per_m2: f64,
    /// δ_e: length of the elastic branch, m, 0 or more. With 0 the law begins with A at once.
    pub elastic_depth_m: f64,
    /// δ_s: deflection beyond which the load grows no further, m, more than δ_e; it may be infinite.
    pub saturation_depth_m: f64,
    /// What is given back on unloading.
    pub recovery: Recovery,
}

/// A number of a face law that is out of range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{name} is {value}, expected {expected}")]
pub struct FaceLawError {
    /// Name of the number.
    pub name: &'static str,
    /// Its value, SI units.
    pub value: f64,
    /// The permitted range.
    pub expected: &'static str,
}

impl FaceLaw {
    /// Checks the numbers of a law.
    ///
    /// # Errors
    /// [`FaceLawError`] names the first number that is out of range.
    pub fn new(parameters: FaceParameters) -> Result<Self, FaceLawError> {
        let FaceParameters {
            onset_n_per_m,
            stiffness_n_per_m2,
            elastic_depth_m,
            saturation_depth_m,
            recovery,
        } = parameters;
        let is_share = |share: f64| (0.0..=1.0).contains(&share);
        let is_some = |value: f64| value.is_finite() && value >= 0.0;
        for (is_good, name, value, expected) in [
            (is_some(onset_n_per_m), "onset_n_per_m", onset_n_per_m, "0 or more"),
            (
                stiffness_n_per_m2.is_finite() && stiffness_n_per_m2 > 0.0,
                "stiffness_n_per_m2",
                stiffness_n_per_m2,
                "more than 0",
            ),
            (is_some(elastic_depth_m), "elastic_depth_m", elastic_depth_m, "0 or more"),
            (
                saturation_depth_m > elastic_depth_m,
                "saturation_depth_m",
                saturation_depth_m,
                "more than elastic_depth_m",
            ),
            (is_share(recovery.elastic), "recovery.elastic", recovery.elastic, "0 to 1"),
            (is_share(recovery.crushed), "recovery.crushed", recovery.crushed, "0 to 1"),
            (
                is_some(recovery.per_end_1_m),
                "recovery.per_end_1_m",
                recovery.per_end_1_m,
                "0 or more",
            ),
        ] {
            if !is_good {
                return Err(FaceLawError { name, value, expected });
            }
        }
        let crushed_m = saturation_depth_m - elastic_depth_m;
        Ok(Self {
            onset_n_per_m,
            stiffness_n_per_m2,
            elastic_depth_m,
            saturation_n_per_m: onset_n_per_m + stiffness_n_per_m2 * crushed_m,
            recovery,
        })
    }

    /// A linear spring without saturation: `p = k δ`, with the same share of recovery at every depth.
    ///
    /// - `stiffness_n_per_m2`: k, stiffness per width, N/m², more than 0;
    ///
    /// # Errors
    /// [`FaceLawError`] if a number is out of range.
    pub fn linear(stiffness_n_per_m2: f64, recovery: Recovery) -> Result<Self, FaceLawError> {
        Self::new(FaceParameters {
            onset_n_per_m: 0.0,
            stiffness_n_per_m2,
            elastic_depth_m: 0.0,
            saturation_depth_m: f64::INFINITY,
            recovery,
        })
    }

    /// The same law with all loads multiplied by a factor, such as a draw of its scatter or the scale
    /// of a force that is known.
    ///
    /// - `factor`: more than 0.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            onset_n_per_m: self.onset_n_per_m * factor,
            stiffness_n_per_m2: self.stiffness_n_per_m2 * factor,
            saturation_n_per_m: self.saturation_n_per_m * factor,
            ..self
        }
    }

    /// The same law with an elastic branch of another length, at most half of the depth of saturation.
    ///
    /// - `factor`: on δ_e, more than 0.
    #[must_use]
    pub fn with_elastic_depth(self, factor: f64) -> Self {
        let crushed = self.saturation_n_per_m - self.onset_n_per_m;
        let saturation_m = self.elastic_depth_m + crushed / self.stiffness_n_per_m2;
        let elastic_depth_m = (self.elastic_depth_m * factor).min(saturation_m / 2.0);
        let crushed_m = saturation_m - elastic_depth_m;
        Self {
            elastic_depth_m,
            saturation_n_per_m: self.onset_n_per_m + self.stiffness_n_per_m2 * crushed_m,
            ..self
        }
    }

    /// The same law with another share of recovery of the elastic branch, 0 to 1.
    #[must_use]
    pub fn with_elastic_recovery(self, share: f64) -> Self {
        Self { recovery: Recovery { elastic: share, ..self.recovery }, ..self }
    }

    /// A, N/m.
    pub fn onset_n_per_m(&self) -> f64 {
        self.onset_n_per_m
    }

    /// B, N/m².
    pub fn stiffness_n_per_m2(&self) -> f64 {
        self.stiffness_n_per_m2
    }

    /// ρ_e.
    pub fn elastic_recovery(&self) -> f64 {
        self.recovery.elastic
    }

    /// δ_e, m.
    pub fn elastic_depth_m(&self) -> f64 {
        self.elastic_depth_m
    }
}

impl FaceLaw {
    /// The law of a strip with a dent: it was pressed in to the h with `(1 − ρ(h)) h = dent`.
    ///
    /// - `dent_m`: m, 0 or more.
    pub fn with_dent(&self, dent_m: f64) -> Strip<f64> {
        // The share falls slowly with the depth, so that each turn brings two digits.
        let greatest_m = (0..DENT_TURNS).fold(dent_m, |greatest_m, _| {
            dent_m / (1.0 - self.recovery_share(greatest_m)).max(LEAST_DENT_SHARE)
        });
        self.after(greatest_m)
    }
}

impl<P: Copy> FaceLaw<P> {
    /// Load of a strip that was never pressed in as far as this, N/m.
    ///
    /// - `deflection_m`: δ, m, 0 or more.
    #[inline(always)]
    pub fn virgin_load_n_per_m<T: Lanes + LanesOver<P>>(&self, deflection_m: T) -> T {
        let zero = deflection_m.constant(0.0);
        let elastic_m = zero + self.elastic_depth_m;
        let onset = zero + self.onset_n_per_m;
        let divisor_m = larger(elastic_m, zero.constant(NO_DEPTH_M));
        let elastic = onset * deflection_m / divisor_m;
        let crushed = onset + (deflection_m - elastic_m) * self.stiffness_n_per_m2;
        let crushed = smaller(crushed, zero + self.saturation_n_per_m);
        deflection_m.if_less(elastic_m, elastic, crushed)
    }

    /// ρ of a strip with a greatest deflection h, m.
    #[inline(always)]
    pub fn recovery_share<T: Lanes + LanesOver<P>>(&self, greatest_m: T) -> T {
        let (zero, one) = (greatest_m.constant(0.0), greatest_m.constant(1.0));
        let Recovery { elastic, crushed, per_end_1_m } = self.recovery;
        let left = larger(one - greatest_m * per_end_1_m, zero);
        let crushed = left * left * crushed;
        let elastic_m = larger(zero + self.elastic_depth_m, zero.constant(NO_DEPTH_M));
        let share = ((elastic_m * 2.0 - greatest_m) / elastic_m).clamped(zero, one);
        crushed + (zero + elastic - crushed) * share
    }

    /// The law of a strip with a history.
    ///
    /// - `greatest_m`: h, greatest deflection so far, m, 0 or more.
    #[inline(always)]
    pub fn after<T: Lanes + LanesOver<P>>(&self, greatest_m: T) -> Strip<T> {
        let zero = greatest_m.constant(0.0);
        let recovered_m = self.recovery_share(greatest_m) * greatest_m;
        Strip {
            greatest_m,
            dent_m: greatest_m - recovered_m,
            load_there_n_per_m: larger(zero, self.virgin_load_n_per_m(greatest_m)),
            onset_n_per_m: zero + self.onset_n_per_m,
            elastic_depth_m: zero + self.elastic_depth_m,
            per_stiffness_m2_per_n: zero.constant(1.0) / (zero + self.stiffness_n_per_m2),
            saturation_n_per_m: zero + self.saturation_n_per_m,
        }
    }
}

/// A strip of a face with its history: the deflection as a function of the load.
#[derive(Debug, Clone, Copy)]
pub struct Strip<T> {
    /// h: greatest deflection so far, m.
    pub greatest_m: T,
    /// (1 − ρ) h: deflection without a load, m.
    pub dent_m: T,
    /// p_h: load at the greatest deflection, N/m.
    pub load_there_n_per_m: T,
    pub(super) onset_n_per_m: T,
    pub(super) elastic_depth_m: T,
    pub(super) per_stiffness_m2_per_n: T,
    pub(super) saturation_n_per_m: T,
}

impl<T: Lanes> Strip<T> {
    /// Load at a deflection, N/m: on the straight line of unloading below the greatest deflection, on
    /// the virgin curve beyond it.
    #[inline(always)]
    pub fn load_n_per_m(&self, deflection_m: T) -> T {
        let zero = deflection_m.constant(0.0);
        let recovered_m = larger(self.greatest_m - self.dent_m, zero.constant(NO_DEPTH_M));
        let unloaded =
            self.load_there_n_per_m * larger((deflection_m - self.dent_m) / recovered_m, zero);
        let elastic_m = larger(self.elastic_depth_m, zero.constant(NO_DEPTH_M));
        let elastic = self.onset_n_per_m * deflection_m / elastic_m;
        let crushed = self.onset_n_per_m
            + (deflection_m - self.elastic_depth_m) / self.per_stiffness_m2_per_n;
        let virgin = deflection_m.if_less(
            self.elastic_depth_m,
            elastic,
            smaller(crushed, self.saturation_n_per_m),
        );
        deflection_m.if_less(self.greatest_m, unloaded, larger(virgin, zero))
    }

    /// Deflection at a load, m: the inverse of [`Strip::load_n_per_m`], the dent where there is no
    /// load. A load at which the deflection is free (the first load of a law without elastic branch,
    /// saturation) has the smallest one.
    ///
    /// - `load_n_per_m`: 0 up to the saturation.
    #[inline(always)]
    pub fn deflection_m(&self, load_n_per_m: T) -> T {
        let least = load_n_per_m.constant(NO_LOAD_N_PER_M);
        let share = load_n_per_m / larger(self.load_there_n_per_m, least);
        let unloaded = self.dent_m + (self.greatest_m - self.dent_m) * share;
        let elastic = self.elastic_depth_m * load_n_per_m / larger(self.onset_n_per_m, least);
        let crushed = self.elastic_depth_m
            + (load_n_per_m - self.onset_n_per_m) * self.per_stiffness_m2_per_n;
        let virgin = load_n_per_m.if_less(self.onset_n_per_m, elastic, crushed);
        load_n_per_m.if_less(self.load_there_n_per_m, unloaded, larger(virgin, self.greatest_m))
    }

    /// Deflection that is given back per load on unloading, m²/N: `ρ h/p_h`.
    #[inline(always)]
    pub fn unloading_compliance_m2_per_n(&self) -> T {
        let least = self.load_there_n_per_m.constant(NO_LOAD_N_PER_M);
        (self.greatest_m - self.dent_m) / larger(self.load_there_n_per_m, least)
    }
}

/// Two strips that are pressed against each other.
#[derive(Debug, Clone, Copy)]
pub struct PressedStrips<T> {
    /// Load on both, N/m.
    pub load_n_per_m: T,
    /// Deflections of both, m; together they are the overlap where there is a load.
    pub deflections_m: [T; 2],
}

/// The load with which two strips in series share an overlap: the p with `δ₁(p) + δ₂(p) = D`.
///
/// The sum of the deflections is piecewise linear between the loads p_h and A of either strip and the
/// smaller one of their saturations. The load is found on the piece that holds D. Beyond saturation
/// the softer strip takes the rest.
///
/// - `overlap_m`: D, overlap of the outlines as they were before any deformation, m.
#[inline(always)]
pub fn press_together<T: Lanes>(strips: [&Strip<T>; 2], overlap_m: T) -> PressedStrips<T> {
    let [a, b] = strips;
    let zero = overlap_m.constant(0.0);
    let end = smaller(a.saturation_n_per_m, b.saturation_n_per_m);
    let sum_m = |load: T| a.deflection_m(load) + b.deflection_m(load);
    let kinks = sorted([
        smaller(a.load_there_n_per_m, end),
        smaller(a.onset_n_per_m, end),
        smaller(b.load_there_n_per_m, end),
        smaller(b.onset_n_per_m, end),
    ]);
    // The last kink whose overlap is not beyond D, and the piece that begins there.
    let (mut from, mut from_m) = (zero, a.dent_m + b.dent_m);
    let mut to = from;
    let mut to_m = from_m;
    let mut has_end = zero;
    for kink in kinks {
        let kink_m = sum_m(kink);
        let is_beyond = overlap_m.if_less(kink_m, zero.constant(1.0), zero);
        let is_first = is_beyond - is_beyond * has_end;
        let half = zero.constant(0.5);
        (to, to_m) = (half.if_less(is_first, kink, to), half.if_less(is_first, kink_m, to_m));
        from = half.if_less(is_beyond, from, kink);
        from_m = half.if_less(is_beyond, from_m, kink_m);
        has_end += is_first;
    }
    // Beyond the last kink both strips are on their last straight pieces.
    let slope_m2_per_n = a.per_stiffness_m2_per_n + b.per_stiffness_m2_per_n;
    let half = zero.constant(0.5);
    let rest_m = overlap_m - from_m;
    let between = from + (to - from) * (rest_m / larger(to_m - from_m, zero.constant(NO_DEPTH_M)));
    let load = half.if_less(has_end, between, smaller(from + rest_m / slope_m2_per_n, end));
    let load = (a.dent_m + b.dent_m).if_less(overlap_m, larger(load, zero), zero);
    let [of_a, of_b] = [a.deflection_m(load), b.deflection_m(load)];
    // What the deflections lack in the overlap: nothing but for free deflections.
    let lack_m = zero.if_less(load, larger(overlap_m - (of_a + of_b), zero), zero);
    let softer = a.saturation_n_per_m - b.saturation_n_per_m;
    let (one, none) = (zero.constant(1.0), zero);
    let share_of_a = softer.if_less(zero, one, zero.if_less(softer, none, half));
    let to_a = lack_m * share_of_a;
    let to_b = lack_m - to_a;
    PressedStrips { load_n_per_m: load, deflections_m: [of_a + to_a, of_b + to_b] }
}

/// Four numbers in rising order.
#[inline(always)]
fn sorted<T: Lanes>([a, b, c, d]: [T; 4]) -> [T; 4] {
    let order = |x: T, y: T| (smaller(x, y), larger(x, y));
    let ((a, b), (c, d)) = (order(a, b), order(c, d));
    let ((a, c), (b, d)) = (order(a, c), order(b, d));
    let (b, c) = order(b, c);
    [a, b, c, d]
}

#[inline(always)]
fn smaller<T: Lanes>(x: T, y: T) -> T {
    y.if_less(x, y, x)
}

#[inline(always)]
fn larger<T: Lanes>(x: T, y: T) -> T {
    x.if_less(y, y, x)
}

#[cfg(test)]
#[path = "law_tests.rs"]
mod tests;
