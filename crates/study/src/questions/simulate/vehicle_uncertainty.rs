//! How the end of a simulated motion varies with what the data sheet of the vehicle leaves open.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::numerics::{latin_normals, random_stream};
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::{
    RoadDraws, Sensitivity, SheetQuantity, VehicleDraws, VehicleParameters, ZONE_FRICTION_LOG_SIGMA,
};

use crate::EndState;
use crate::analysis::{Analysis, AnalysisError, MonteCarloError, MotionEnd, RestOutcome, Settings};
use crate::questions::simulate::flag::is_no_rare_contact;
use crate::questions::simulate::report::motion_end;

/// Where and how the motion ends over vehicles that are drawn from the estimates of a data sheet, SI
/// units. The rest of what is asked is the same for all of them.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct VehicleUncertainty {
    /// Vehicles that were drawn.
    pub n_draws: usize,
    /// Of these, how many have a motion that cannot be simulated; they are left out.
    pub n_failed: usize,
    /// X of the CG at the end, m.
    pub x_m: Estimate,
    /// Y of the CG at the end, m.
    pub y_m: Estimate,
    /// Heading at the end, rad.
    pub yaw_rad: Estimate,
    /// Speed of the CG at the end, m/s.
    pub speed_m_s: Estimate,
    /// Where, when and after what distance the vehicle comes to rest; none unless the question asks for
    /// it. After a second contact, which is not computed, this and what stands above has no intervals.
    pub rest: Option<RestOutcome>,
    /// Share of the draws in which the two vehicles meet again; none where one vehicle moves.
    pub second_contact_probability: Option<f64>,
    /// Which estimates the end depends on, the one that moves the end position most first.
    pub sensitivity: Vec<Sensitivity>,
    /// How much of the intervals is chance, because the vehicle is drawn a limited number of times.
    pub monte_carlo: Option<MonteCarloError>,
}

/// How the motion of one drawn vehicle ends.
struct DrawnEnd {
    state: EndState,
    end: MotionEnd,
    has_met: bool,
}

/// Simulates the motion with vehicles drawn from what the data sheet leaves open, on ground that is drawn;
/// `None` if nothing is open, if no draws are asked for, or if nothing is simulated.
///
/// - `n_draws`, `seed`, `road`: number and seed of the draws, and how the friction of the road is drawn.
/// - `settings`: with the vehicle at the medians of its estimates;
/// - `central`: the analysis with these settings.
pub(crate) fn vehicle_uncertainty(
    (n_draws, seed, road): (usize, u64, Option<RoadDraws>),
    settings: &Settings,
    central: &Analysis,
    analyse: &(impl Fn(&Settings) -> Result<Analysis, AnalysisError> + Sync + ?Sized),
) -> Option<VehicleUncertainty> {
    central.simulation.as_ref()?;
    let draws = VehicleDraws::new(&settings.struck, true, road, n_draws, seed);
    if draws.is_empty() {
        return None;
    }
    let vehicles = draws.vehicles(&settings.struck);
    let of_zones = latin_normals(vehicles.len(), &mut random_stream(seed, "friction zones", 0));
    let end = |(struck, of_zones): (VehicleParameters, f64)| {
        let factor = (ZONE_FRICTION_LOG_SIGMA * of_zones).exp();
        let friction_zones = settings.friction_zones.iter().map(|zone| zone.scaled(factor));
        let friction_zones = friction_zones.collect();
        // Both are on one road.
        let friction = settings.striking.tires.friction * struck.tires.friction;
        let striking =
            settings.striking.clone().with_friction(friction / settings.struck.tires.friction);
        let drawn = Settings { struck, striking, friction_zones, ..settings.clone() };
        let analysis = analyse(&drawn).ok()?;
        let motion = analysis.simulation?;
        Some(DrawnEnd {
            state: EndState::from_series(&motion.series).ok()?,
            end: motion_end(&motion).ok()?,
            has_met: analysis.second_contact.is_some(),
        })
    };
    let drawn: Vec<Option<DrawnEnd>> = vehicles.into_par_iter().zip(of_zones).map(end).collect();
    let ends: Vec<Option<EndState>> =
        drawn.iter().map(|drawn| drawn.as_ref().map(|end| end.state)).collect();
    let motion_ends: Vec<MotionEnd> = drawn.iter().flatten().map(|drawn| drawn.end).collect();
    let rest = || RestOutcome::from_ends(&motion_ends, settings.duration_s);
    let spread = |value: fn(&EndState) -> f64| {
        Estimate::from_draws(ends.iter().flatten().map(value).collect::<Vec<f64>>())
    };
    let places: Vec<_> =
        ends.iter().map(|end| end.map(|end| [end.x_m, end.y_m, end.yaw_rad])).collect();
    let n_failed = ends.iter().filter(|end| end.is_none()).count();
    if n_failed == ends.len() {
        return None;
    }
    // What the case or the scenario says itself is no estimate any more.
    let is_estimated = |share: &Sensitivity| {
        let sheet = central.vehicle.sheet.as_ref();
        (share.quantity == SheetQuantity::Friction && road.is_some())
            || sheet.is_some_and(|sheet| sheet.known(share.quantity).is_none())
    };
    let mut sensitivity = draws.sensitivities(&places);
    sensitivity.retain(is_estimated);
    let n_met = drawn.iter().flatten().filter(|drawn| drawn.has_met).count();
    let share_met = n_met as f64 / (ends.len() - n_failed) as f64;
    let uncertainty = VehicleUncertainty {
        n_draws: ends.len(),
        n_failed,
        x_m: spread(|end| end.x_m),
        y_m: spread(|end| end.y_m),
        yaw_rad: spread(|end| end.yaw_rad),
        speed_m_s: spread(|end| end.speed_m_s),
        rest: settings.ends_at_rest.then(rest).flatten(),
        second_contact_probability: (central.striking.is_some() && central.pair.is_none())
            .then_some(share_met),
        sensitivity,
        monte_carlo: MonteCarloError::from_ends(&motion_ends, settings.duration_s),
    };
    let met = uncertainty.second_contact_probability;
    Some(match met.is_some_and(|share| is_no_rare_contact(Some(share))) {
        true => uncertainty.after_contact(),
        false => uncertainty,
    })
}

impl VehicleUncertainty {
    /// The same without what no longer holds after a second contact, which is not computed: intervals and regions.
    fn after_contact(self) -> Self {
        let [x_m, y_m, yaw_rad, speed_m_s] =
            [&self.x_m, &self.y_m, &self.yaw_rad, &self.speed_m_s].map(Estimate::without_intervals);
        let rest = self.rest.as_ref().map(RestOutcome::after_contact);
        Self { x_m, y_m, yaw_rad, speed_m_s, rest, monte_carlo: None, ..self }
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use crate::analysis::PulseSetup;
    use crate::{
        Answer, Drive, Library, MotionSource, Question, ScenarioChoice, SimulateReport,
        SimulateRequest, VehicleChoice,
    };
    use impactlab_core::collision::Scenario;
    use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
    use impactlab_core::vehicle::sheet::SheetQuantity;
    use impactlab_core::vehicle::{Braking, Ending};

    fn report(source: MotionSource, vehicle: &str, n_draws: usize) -> Answer<SimulateReport> {
        let request = SimulateRequest {
            vehicle: VehicleChoice::named(vehicle),
            vehicle_draws: Some(n_draws),
            ..SimulateRequest::new(source)
        };
        let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
        let answer = request.answer(&Library::default(), &mut go_on).unwrap();
        answer.complete().unwrap().report
    }

    fn pit() -> MotionSource {
        let scenario = ScenarioChoice::Inline(Box::new(Scenario::example()));
        MotionSource::Scenario { scenario, pulse: PulseSetup::default() }
    }

    /// The striking vehicle kept the friction of its own file.
    #[test]
    fn the_friction_of_a_question_is_that_of_both_vehicles() {
        let request =
            SimulateRequest { friction: Some(0.4), alone: true, ..SimulateRequest::new(pit()) };
        let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
        let answer = request.answer(&Library::default(), &mut go_on).unwrap();
        let analysis = answer.complete().unwrap().analysis;
        let striking = &analysis.striking.as_ref().unwrap().start.vehicle;
        assert_eq!([&analysis.vehicle, striking].map(|it| it.tires.friction), [0.4, 0.4]);
    }

    #[test]
    fn what_the_data_sheet_leaves_open_spreads_the_end() {
        let report = report(pit(), "toyota-camry-2018", 60);
        let uncertainty = report.uncertainty.as_ref().unwrap();
        assert_eq!((uncertainty.n_draws, uncertainty.n_failed), (60, 0));
        let end = report.end.unwrap();
        assert_eq!(uncertainty.second_contact_probability, None, "every contact is followed");
        let [low, high] = uncertainty.x_m.ninety();
        assert!(high - low > 0.1, "{uncertainty:?}");
        assert!((low..=high).contains(&end.x_m), "{low} {high} {end:?}");
        // Mass and inertia are those of the scenario, so that they are no estimates.
        let shares = &uncertainty.sensitivity;
        let has = |quantity| shares.iter().any(|share| share.quantity == quantity);
        assert!(has(SheetQuantity::RearCornering) && has(SheetQuantity::Friction), "{shares:?}");
        assert!(!has(SheetQuantity::Mass) && !has(SheetQuantity::YawInertia), "{shares:?}");
        let estimated = [CaveatSubject::VehicleParameter, CaveatSubject::RoadFriction].map(Some);
        let is_estimate = |caveat: &&Caveat| estimated.contains(&caveat.subject);
        assert_eq!(report.caveats.iter().filter(is_estimate).count(), shares.len());
    }

    /// The text had no intervals after a second contact, those of the speed excepted, and the answer had all of them.
    #[test]
    fn after_a_second_contact_no_end_has_an_interval() {
        let ended = |duration_s| {
            let request = SimulateRequest {
                vehicle: VehicleChoice::named("toyota-camry-2018"),
                vehicle_draws: Some(20),
                one_contact: true,
                duration_s,
                ..SimulateRequest::new(pit())
            };
            let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
            let answer = request.answer(&Library::default(), &mut go_on).unwrap();
            answer.complete().unwrap().report.report.uncertainty.unwrap()
        };
        // The vehicles meet again after 0.19 s.
        for (duration_s, is_met) in [(0.12, false), (2.0, true)] {
            let found = ended(duration_s);
            let share = found.second_contact_probability.unwrap();
            assert_eq!(share > 0.9, is_met, "{found:?}");
            for estimate in [&found.x_m, &found.y_m, &found.yaw_rad, &found.speed_m_s] {
                assert_eq!(estimate.intervals.is_empty(), is_met, "{duration_s} s: {found:?}");
            }
            assert_eq!(found.monte_carlo.is_none(), is_met, "{duration_s} s: {found:?}");
        }
    }

    /// The standard deviation was read and did nothing where the vehicle has no data sheet.
    #[test]
    fn a_stated_uncertainty_of_the_friction_spreads_the_end_of_a_known_vehicle() {
        let brake = Braking::new(0.0, 2.0, 0.3);
        let asked = |friction_sigma, vehicle_draws| {
            let drive = Drive { speed_m_s: Some(20.0), ..Drive::default() };
            let request = SimulateRequest {
                ending: Some(Ending { brake: Some(brake), ..Ending::default() }),
                friction_sigma: Some(friction_sigma),
                vehicle_draws,
                ..SimulateRequest::new(MotionSource::Drive(drive))
            };
            let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
            request.answer(&Library::default(), &mut go_on).unwrap().complete().unwrap().report
        };
        let spread = asked(0.05, Some(40)).report.uncertainty.unwrap();
        let [low, high] = spread.x_m.ninety();
        // v²/(2 μ d g) with μ = 0.8 ± 0.05 and d = 0.8, both ends by 1.645 σ.
        assert!((5.0..9.0).contains(&(high - low)), "{low} {high}");
        assert_eq!(asked(0.0, Some(40)).report.uncertainty, None);
        let medians = asked(0.05, Some(0));
        assert_eq!(medians.report.uncertainty, None);
        assert!(medians.caveats.iter().any(|it| it.kind == CaveatKind::NotUsed));
    }

    /// Draws of a vehicle of which nothing is open, and a choice of contacts of one that meets nothing, did
    /// nothing and were not told.
    #[test]
    fn what_a_simulation_of_a_known_vehicle_does_not_use_is_told() {
        let drive = Drive { speed_m_s: Some(20.0), ..Drive::default() };
        let plain = SimulateRequest::new(MotionSource::Drive(drive));
        let unused = |request: &SimulateRequest| {
            let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
            let answer = request.answer(&Library::default(), &mut go_on).unwrap();
            let caveats = answer.complete().unwrap().report.caveats;
            let unused = caveats.iter().filter(|it| it.kind == CaveatKind::NotUsed);
            unused.map(|it| it.text.clone()).collect::<Vec<String>>()
        };
        assert_eq!(unused(&plain), [""; 0]);
        let draws = SimulateRequest { vehicle_draws: Some(50), ..plain.clone() };
        assert_eq!(unused(&draws), ["number of drawn vehicles, 50"]);
        let on_open_road = SimulateRequest { friction_sigma: Some(0.05), ..draws.clone() };
        assert_eq!(unused(&on_open_road), [""; 0]);
        let of_sheet =
            SimulateRequest { vehicle: VehicleChoice::named("toyota-camry-2018"), ..draws };
        assert_eq!(unused(&of_sheet), [""; 0]);
        let one_contact = SimulateRequest { one_contact: true, ..plain };
        assert_eq!(unused(&one_contact), ["one contact only"]);
    }

    #[test]
    fn a_vehicle_that_is_known_and_one_that_coasts_straight_have_little_spread() {
        assert_eq!(report(pit(), "reference-2000", 20).uncertainty, None);
        assert_eq!(report(pit(), "toyota-camry-2018", 0).uncertainty, None);
        let drive = Drive { speed_m_s: Some(20.0), ..Drive::default() };
        let straight =
            report(MotionSource::Drive(drive), "generic-suv", 60).report.uncertainty.unwrap();
        assert_eq!(straight.second_contact_probability, None);
        let [low, high] = straight.y_m.ninety();
        assert!(low.abs() < 1e-6 && high.abs() < 1e-6, "{straight:?}");
        assert!(straight.x_m.ninety()[1] - straight.x_m.ninety()[0] < 2.0, "{straight:?}");
        let most = &straight.sensitivity[0];
        let rolling =
            [SheetQuantity::RollingResistance, SheetQuantity::DragArea, SheetQuantity::Mass];
        assert!(rolling.contains(&most.quantity) && most.position_share > 0.3, "{most:?}");
    }
}
