//! The marks that the tires of simulated vehicles leave, as a report tells them.

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::Analysis;
use impactlab_core::collision::Role;
use impactlab_core::vehicle::{TireMark, TireMarkKind, Wheel, tire_marks};

/// A computed mark of a tire.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TireMarkReport {
    /// `struck` or `striking`.
    pub vehicle: &'static str,
    /// The wheel that leaves it.
    pub wheel: Wheel,
    /// What leaves most of it: `locked` or `side_slip`.
    pub kind: TireMarkKind,
    /// When it begins, s.
    pub from_s: f64,
    /// When it ends, s.
    pub to_s: f64,
    /// Length along it, m.
    pub length_m: f64,
    /// Where it begins `[X, Y]`, m.
    pub start_m: [f64; 2],
    /// Where it ends `[X, Y]`, m.
    pub end_m: [f64; 2],
}

impl TireMarkReport {
    /// The marks of the struck vehicle, then those of the striking one.
    pub(crate) fn all(analysis: &Analysis) -> Vec<Self> {
        let struck = analysis.simulation.as_ref();
        let struck = struck.map(|motion| tire_marks(&motion.series, analysis.controlled()));
        let striking = analysis.striking.as_ref();
        let striking = striking.map(|track| tire_marks(&track.motion, track.controlled()));
        Role::WORDS
            .into_iter()
            .zip([struck, striking])
            .flat_map(|(vehicle, marks)| {
                let marks = marks.unwrap_or_default();
                marks.into_iter().filter_map(move |mark| Self::new(vehicle, &mark))
            })
            .collect()
    }

    fn new(vehicle: &'static str, mark: &TireMark) -> Option<Self> {
        let [first, last] = mark.ends()?;
        Some(Self {
            vehicle,
            wheel: mark.wheel,
            kind: mark.kind(),
            from_s: first.time_s,
            to_s: last.time_s,
            length_m: mark.length_m(),
            start_m: first.place_m,
            end_m: last.place_m,
        })
    }
}
