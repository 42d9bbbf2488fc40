//! A forecast of the struck vehicle by itself, and a force that is read from a file.

use crate::analysis::{
    Analysis, MotionForecast, MotionForecastSettings, StruckVehicle, forecast_collision,
    forecast_forces,
};
use crate::caveats::restrictions;
use crate::caveats::unused::{by_force_network, drivers_by_network, zones_by_network};
use crate::questions::predict::motion::Noted;
use crate::questions::simulate::dataset::take_case;
use crate::{
    ForceSource, Library, MotionSource, Observer, PredictMotionRequest, SeriesFile, StudyError,
};
use impactlab_core::data::{DatasetKind, ForceHistory, Outcome, check_contact_within};
use impactlab_core::uncertainty::Caveat;
use impactlab_networks::response::{ResponseCase, ResponseModel};

impl PredictMotionRequest {
    /// The forecast of the struck vehicle by itself.
    pub(super) fn of_one_vehicle(
        &self,
        analysis: &Analysis,
        model: &ResponseModel,
        settings: &MotionForecastSettings,
        (library, observer): (&Library, &mut Observer<'_>),
        noted: &mut Noted,
    ) -> Result<Outcome<MotionForecast>, StudyError> {
        let name = || self.motion.source.name();
        let (Some(struck), Some(own_force)) = (&analysis.struck, &analysis.force) else {
            return Err(StudyError::NoForce { name: name() });
        };
        if let (ForceSource::Predicted(_), MotionSource::Scenario { scenario, .. }) =
            (&self.force, &self.motion.source)
        {
            noted.unused.extend(by_force_network(scenario, &scenario.load()?)?);
        }
        noted.unused.extend(self.learned_motion(model, struck, (library, observer)));
        noted.unused.extend(zones_by_network(struck));
        noted.unused.extend(drivers_by_network(struck));
        // A fleet has braked and dragged wheels, none that are steered or driven.
        let controls = &struck.controls;
        let is_like_fleet =
            model.population().is_some() && !(controls.is_steered() || controls.is_driven());
        if !controls.is_coasting() && !is_like_fleet {
            return Err(StudyError::NotCoasting { name: name() });
        }
        let caveats = &mut noted.of_force;
        let forecast = match &self.force {
            ForceSource::Given => {
                let own = Some(own_force).filter(|_| self.motion.source.is_recorded());
                caveats.extend(own.and_then(restrictions::cut_record_caveat));
                forecast_forces(std::slice::from_ref(own_force), model, struck, settings)
            }
            ForceSource::File(path) => {
                let file = SeriesFile { path: path.clone(), map: self.force_map.clone() };
                let force = given_force(&file, struck, settings.duration_s, library, caveats)?;
                forecast_forces(&[force], model, struck, settings)
            }
            ForceSource::Predicted(choice) => {
                let predicted = self.predicted(choice, library, observer)?;
                let Outcome::Complete((force_model, collision)) = predicted else {
                    return Ok(Outcome::Cancelled);
                };
                forecast_collision(&collision, &force_model, model, struck, settings)
            }
        };
        let forecast = forecast
            .map_err(|source| StudyError::Forecast { name: name(), source: Box::new(source) })?;
        Ok(Outcome::Complete(forecast))
    }

    /// That the network has learned from the recorded motion that it forecasts.
    fn learned_motion(
        &self,
        model: &ResponseModel,
        struck: &StruckVehicle,
        (library, observer): (&Library, &mut Observer<'_>),
    ) -> Option<Caveat> {
        let MotionSource::Case { dataset, case } = &self.motion.source else { return None };
        let dataset = library.dataset(dataset, observer).ok()?.complete()?;
        let case = take_case(&dataset, case).ok()?;
        let is_motion = case.kind == DatasetKind::Trajectory;
        let case = is_motion.then(|| ResponseCase::from_case(case, &struck.vehicle).ok())??;
        model.is_trained_on(&case).then(restrictions::learned_motion_caveat)
    }
}

/// The force of a file. Where it acts without a yaw moment of its own, the source of the motion says.
///
/// - `duration_s`: duration of the motion, s, within which the contact lies;
/// - `caveats`: gets what is wrong with the file.
pub(super) fn given_force(
    file: &SeriesFile,
    struck: &StruckVehicle,
    duration_s: f64,
    library: &Library,
    caveats: &mut Vec<Caveat>,
) -> Result<ForceHistory, StudyError> {
    let path = &file.path;
    let loaded = library.series(file).map_err(|error| error.of_option("--force-map"))?;
    caveats.extend(restrictions::doubtful_data_caveats(&file.title(), &loaded));
    caveats.extend(restrictions::doubtful_note_caveats(&file.title(), &loaded));
    let force = ForceHistory::from_series(&loaded.series, loaded.force_sampling())
        .map_err(|source| StudyError::Series { path: path.to_owned(), source })?;
    // A recorded yaw moment acts about the CG: it does not say where another force acts.
    let has_contact = [struck.contact.x_body_m, struck.contact.y_body_m] != [0.0; 2];
    if force.mz_n_m.is_none() && !has_contact {
        return Err(StudyError::NoYawMoment { path: path.to_owned() });
    }
    check_contact_within(&force, duration_s).map_err(|outside| StudyError::ContactOutside {
        name: path.display().to_string(),
        outside,
    })?;
    caveats.extend(restrictions::cut_record_caveat(&force));
    Ok(force)
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use crate::analysis::PulseSetup;
    use crate::questions::predict::motion::ONE_VEHICLE_DRAWS;
    use crate::{
        COARSE_DRAWS, DEFAULT_DRAWS, ForceSource, Library, MotionSource, PredictMotionRequest,
        Question, ScenarioChoice,
    };
    use impactlab_core::collision::Scenario;
    use impactlab_core::uncertainty::CaveatKind;

    /// A forecast lay on the record that the network had learned from, and nothing said why.
    #[test]
    fn a_motion_that_the_network_has_learned_from_is_said_to_be_one() {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets");
        for (set, case, is_learned) in [
            ("trajectories-fea", "FE_c002", true),
            ("trajectories-cars-held-out/car-000", "car-000_00", false),
        ] {
            let source = MotionSource::Case { dataset: data.join(set), case: case.to_owned() };
            let force = ForceSource::Given;
            let request =
                PredictMotionRequest { draws: 2, ..PredictMotionRequest::new(source, force) };
            let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
            let answer = request.answer(&Library::default(), &mut go_on).unwrap();
            let caveats = answer.complete().unwrap().report.caveats;
            assert_eq!(caveats.has(CaveatKind::TrainedOn), is_learned, "{case}");
        }
    }

    #[test]
    fn one_vehicle_is_drawn_less_often_than_both_unless_somebody_says_how_often() {
        let scenario = ScenarioChoice::Inline(Box::new(Scenario::example()));
        let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
        let both = PredictMotionRequest::new(source, ForceSource::Given);
        assert_eq!(both.n_vehicles(), DEFAULT_DRAWS);
        let mut one = both.clone();
        one.motion.one_contact = true;
        assert_eq!(one.n_vehicles(), ONE_VEHICLE_DRAWS);
        // Its road is drawn where nothing else is, so that there is an answer in the meantime.
        let coarse = one.coarse().map(|coarse| coarse.n_vehicles());
        assert_eq!(coarse, Some(COARSE_DRAWS));
        for n in [0, 200] {
            one.motion.vehicle_draws = Some(n);
            assert_eq!(one.n_vehicles(), n);
        }
        (one.draws, one.motion.vehicle_draws) = (COARSE_DRAWS, Some(COARSE_DRAWS));
        assert_eq!(one.coarse(), None, "it is no coarser");
    }
}
