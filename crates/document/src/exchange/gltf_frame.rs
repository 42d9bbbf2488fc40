//! Where time and place of a glTF file begin.
//!
//! Its numbers have single precision: beside a clock that counts from 1970 all times of a motion are the
//! same, and survey coordinates of millions of metres are off by half a metre. So time is counted from the
//! first instant, and places that are far away from a round place near the scene.

use serde_json::json;

use crate::scene::Scene;

/// Coordinates up to this are written as they are, m: single precision keeps 1 mm of them.
const NEAR_M: f64 = 1e4;
/// Places from which coordinates are counted are multiples of this, m.
const ROUND_M: f64 = 1000.0;

/// What is subtracted from times and places of a scene in a glTF file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GltfFrame {
    /// Time of the scene at time 0 of the animation, s.
    pub start_s: f64,
    /// Place of the scene at the origin of the file, `[X, Y]`, m.
    pub origin_m: [f64; 2],
}

impl GltfFrame {
    /// The frame of a scene.
    pub fn new(scene: &Scene) -> Self {
        let cars = scene.cars.iter().filter(|car| !car.is_draw());
        let times = cars.map(|car| car.motion.time_s()).filter(|all| all.len() > 1);
        let firsts = times.filter_map(|all| all.first().copied());
        let [low, high] = scene.extent_m();
        Self {
            start_s: firsts.fold(f64::INFINITY, f64::min).min(scene.end_s),
            origin_m: std::array::from_fn(|axis| {
                let is_near = low[axis].abs().max(high[axis].abs()) <= NEAR_M;
                let middle_m = (low[axis] + high[axis]) / 2.0;
                if is_near { 0.0 } else { (middle_m / ROUND_M).round() * ROUND_M }
            }),
        }
    }

    /// A place of the scene in the file, m.
    pub fn place(&self, [x_m, y_m]: [f64; 2]) -> [f32; 2] {
        [(x_m - self.origin_m[0]) as f32, (y_m - self.origin_m[1]) as f32]
    }

    /// A time of the scene in the file, s.
    pub fn time(&self, time_s: f64) -> f32 {
        (time_s - self.start_s) as f32
    }

    /// What was subtracted, in words; nothing if nothing was.
    pub fn notes(&self) -> Vec<String> {
        let Self { start_s, origin_m: [x_m, y_m] } = *self;
        let time = (start_s != 0.0)
            .then(|| format!("glTF: time 0 of the animation is {start_s} s of the scene"));
        let place = (self.origin_m != [0.0; 2])
            .then(|| format!("glTF: the origin of the file is X {x_m} m, Y {y_m} m of the scene"));
        time.into_iter().chain(place).collect()
    }

    /// The same for programs.
    pub(super) fn extras(&self) -> serde_json::Value {
        json!({ "time_0_s": self.start_s, "origin_m": self.origin_m })
    }
}
