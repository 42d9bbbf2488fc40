//! The force that was recorded in a collision, to stand beside what methods say of it.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::{Analysis, MotionForecast, StruckVehicle};
use crate::{ForceReport, ForceSource, PredictMotionRequest};
use impactlab_core::data::ForceHistory;

/// A recorded force on the struck vehicle, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RecordedImpulse {
    /// The record.
    pub force: ForceReport,
    /// Size of its impulse, N s.
    pub impulse_magnitude_n_s: f64,
    /// Size of the change of velocity of the struck vehicle by this impulse alone, m/s.
    pub delta_v_m_s: f64,
}

impl RecordedImpulse {
    /// `None` for an empty record.
    fn new(force: &ForceHistory, path: Option<&PathBuf>, struck: &StruckVehicle) -> Option<Self> {
        let force = ForceReport::from_history(force, path, Some(struck))?;
        let [x, y] = force.impulse_n_s;
        let impulse_magnitude_n_s = x.hypot(y);
        let delta_v_m_s = impulse_magnitude_n_s / struck.vehicle.mass.mass_kg;
        Some(Self { force, impulse_magnitude_n_s, delta_v_m_s })
    }

    /// From first touch to last separation, s; none of a record without a force.
    pub fn duration_s(&self) -> Option<f64> {
        Some(self.force.contact_end_s? - self.force.contact_start_s?)
    }
}

impl PredictMotionRequest {
    /// The force of the file that drives the motion, or that of a recorded source, whatever drives it; none
    /// where nothing was recorded.
    pub(super) fn recorded(
        &self,
        analysis: &Analysis,
        struck: &StruckVehicle,
        forecast: &MotionForecast,
    ) -> Option<RecordedImpulse> {
        let (path, force) = match &self.force {
            ForceSource::File(path) => (Some(path), forecast.forces.first()),
            ForceSource::Given | ForceSource::Predicted(_) => {
                let source = &self.motion.source;
                let force = analysis.force.as_ref().filter(|_| source.is_recorded());
                (source.force_file(), force)
            }
        };
        RecordedImpulse::new(force?, path, struck)
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use super::*;
    use crate::{Answer, Library, MotionSource, PredictMotionReport, Question};
    use impactlab_core::data::{Case, Dataset};
    use impactlab_core::uncertainty::{Caveat, CaveatKind};
    use impactlab_networks::force::ForceCase;

    fn of_case(case: &str, force: ForceSource) -> Answer<PredictMotionReport> {
        let source = MotionSource::Case { dataset: fea(), case: case.to_owned() };
        let mut request =
            PredictMotionRequest { draws: 4, ..PredictMotionRequest::new(source, force) };
        request.motion.vehicle_draws = Some(0);
        let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
        let answer = request.answer(&Library::default(), &mut go_on).unwrap();
        answer.complete().unwrap().report
    }

    fn fea() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/fea")
    }

    fn record() -> ForceHistory {
        let loaded = Dataset::load(&fea(), &mut |_| ControlFlow::Continue(())).unwrap();
        loaded.complete().unwrap().case("c001").unwrap().force_history().unwrap()
    }

    /// The record stands beside both methods, whichever of them moves the vehicle.
    #[test]
    fn a_case_has_its_record_beside_network_and_momentum_solution() {
        let [px, py] = record().impulse_n_s();
        for force in [ForceSource::Given, ForceSource::Predicted(Default::default())] {
            let report = of_case("c001", force).report;
            let record = report.recorded.as_ref().unwrap();
            assert!((record.impulse_magnitude_n_s - px.hypot(py)).abs() < 1e-9, "{record:?}");
            let mass_kg = record.impulse_magnitude_n_s / record.delta_v_m_s;
            assert!((1000.0..3000.0).contains(&mass_kg), "{mass_kg} kg");
            assert!(record.duration_s().unwrap() > 0.0);
            let beside = report.impulses.as_ref().unwrap();
            let ratio = beside.network_impulse_n_s.median / record.impulse_magnitude_n_s;
            assert!((0.5..2.0).contains(&ratio), "{beside:?}");
            assert!(beside.momentum_impulse_n_s.median > 0.0);
        }
    }

    /// A network that has learned from a case is near its record whatever it is worth.
    #[test]
    fn that_the_network_has_learned_from_the_case_is_said() {
        let model = Library::default().force_model(&Default::default()).unwrap();
        let loaded = Dataset::load(&fea(), &mut |_| ControlFlow::Continue(())).unwrap();
        let cases = loaded.complete().unwrap().cases;
        for is_known in [true, false] {
            let is_like = |case: &&Case| {
                model.is_trained_on(&ForceCase::from_case(case).unwrap()) == is_known
            };
            let name = &cases.iter().find(is_like).unwrap().name;
            for (force, kind) in [
                (ForceSource::Given, CaveatKind::Note),
                (ForceSource::Predicted(Default::default()), CaveatKind::TrainedOn),
            ] {
                let caveats = of_case(name, force).caveats;
                let is_said =
                    |of: &Caveat| of.kind == kind && of.text.contains("learned from this case");
                assert_eq!(caveats.iter().any(is_said), is_known, "{name}: {caveats:?}");
            }
        }
    }
}
