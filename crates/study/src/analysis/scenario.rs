//! Analysis of a two-vehicle scenario: the collision is solved by conservation of momentum, its
//! impulse is spread over a classic force pulse, and the motion of both vehicles is simulated.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{
    Analysis, AnalysisError, ContactPair, Settings, StruckVehicle, VehicleTrack,
};
use impactlab_core::collision::{
    Footprint, Pose, Pulse, PulseShape, Scenario, ScenarioVehicle, SecondContact,
};
use impactlab_core::data::{ForceHistory, check_contact_within};
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Controls, Manoeuvre, Motion, Preset, VehicleParameters, VehicleState,
};

/// Longest sample interval of the pulse, s; a shorter pulse has at least 20 intervals.
const PULSE_INTERVAL_S: f64 = 1e-3;

/// Height of the force of one impact above the ground where nobody says it, m: that of
/// half of the runs in `datasets/fea`; the others have 0.57 m.
pub(crate) const USUAL_CONTACT_HEIGHT_M: f64 = 0.52;

/// Force pulse over which the impulse of the momentum solution is spread.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PulseSetup {
    /// Shape of the pulse.
    pub shape: PulseShape,
    /// Duration of the pulse, s.
    pub duration_s: f64,
    /// Height of the contact point above the ground, m.
    pub contact_height_m: f64,
}

impl Default for PulseSetup {
    /// A haversine over 0.1 s. The contact durations of the shipped finite-element runs lie around
    /// 0.116 s.
    fn default() -> Self {
        Self {
            shape: PulseShape::Haversine,
            duration_s: 0.1,
            contact_height_m: USUAL_CONTACT_HEIGHT_M,
        }
    }
}

impl PulseSetup {
    /// Whether the contact is as high as where nobody says how high it is.
    pub(crate) fn is_height_open(&self) -> bool {
        self.contact_height_m == Self::default().contact_height_m
    }

    /// Height of the contact between two vehicles, m: where nobody says it, that of cars in the scale of
    /// the smaller one, which may be a model of a car.
    pub(crate) fn height_m(&self, scenario: &Scenario) -> f64 {
        if !self.is_height_open() {
            return self.contact_height_m;
        }
        let vehicles = [&scenario.struck, &scenario.striking].into_iter();
        let scales = vehicles
            .filter(|vehicle| vehicle.fixed.is_none())
            .map(|vehicle| scale_of_car(vehicle.footprint().length_m));
        self.contact_height_m * scales.fold(1.0, f64::min)
    }

    /// An impulse `[P_X, P_Y]`, N s, as the force over time.
    ///
    /// # Errors
    /// [`AnalysisError::Pulse`] if the pulse is invalid.
    pub(super) fn history(&self, impulse_n_s: [f64; 2]) -> Result<ForceHistory, AnalysisError> {
        let pulse = Pulse::new(self.shape, impulse_n_s, 0.0, self.duration_s)?;
        Ok(pulse.to_history(PULSE_INTERVAL_S.min(pulse.end_s() / 20.0))?)
    }
}

/// Scale of a model of a car by its length; 1 for a car.
pub(crate) fn scale_of_car(length_m: f64) -> f64 {
    Preset::Reference.parameters().model_scale(length_m)
}

/// Solves the collision of a scenario, and simulates both vehicles from first contact on under the
/// impulse of the solution, which is spread over a classic pulse.
///
/// # Errors
/// [`AnalysisError::Scenario`] if the vehicles do not meet or the collision cannot be solved,
/// [`AnalysisError::Pulse`] if the pulse is invalid, [`AnalysisError::ContactOutside`] if it is
/// longer than the simulation, [`AnalysisError::Simulation`] if a motion
/// diverges.
pub fn analyse_scenario(
    scenario: &Scenario,
    pulse: &PulseSetup,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let solution = scenario.solve()?;
    let [px, py] = solution.impulse_world_n_s;
    let force = pulse.history([px, py])?;
    check_contact_within(&force, settings.duration_s)?;
    let (starts, normal_rad) = starts(scenario, pulse, settings)?;
    let outlines = [scenario.struck.footprint(), scenario.striking.footprint()];
    let name = scenario.name.clone();
    let note = format!(
        "force: {} of {:.0} ms that carries the impulse of the momentum solution",
        pulse.shape.label(),
        pulse.duration_s * 1e3
    );
    let mut analysis = match settings.one_contact {
        true => apart(starts, outlines, (force, pulse.history([-px, -py])?), pulse, settings)?,
        false => through_all_contacts(starts, outlines, force, normal_rad, settings)?,
    };
    analysis.name = name;
    analysis.notes.push(note);
    Ok(analysis)
}

/// Both vehicles at first contact, struck and striking, and the angle of the contact normal, rad.
///
/// # Errors
/// [`AnalysisError::Scenario`] if the vehicles do not meet.
pub(super) fn starts(
    scenario: &Scenario,
    pulse: &PulseSetup,
    settings: &Settings,
) -> Result<([StruckVehicle; 2], f64), AnalysisError> {
    let geometry = scenario.geometry()?;
    let height_m = pulse.height_m(scenario);
    let start = |vehicle: &ScenarioVehicle, preset: &VehicleParameters, pose: &Pose| {
        let [x_body_m, y_body_m] = pose.body_from_world(geometry.contact_point_world_m);
        let contact = ContactPoint { x_body_m, y_body_m, height_m };
        let of_mass = match vehicle.fixed {
            Some(object) => object.body(),
            // A car of full size that stands in for a model would be far too light for its size.
            None => preset
                .clone()
                .at_model_scale(vehicle.footprint().length_m)
                .with_mass(vehicle.mass_kg, Some(vehicle.yaw_inertia_kg_m2)),
        };
        StruckVehicle {
            // One car has one size: that of the collision.
            vehicle: vehicle.footprint().given_to(of_mass),
            initial: initial_state(vehicle, pose),
            contact,
            controls: Controls::default(),
            friction_zones: settings.friction_zones.clone(),
        }
    };
    let mut struck = start(&scenario.struck, &settings.struck, &geometry.struck);
    struck.controls = settings.ending.controls(&struck.vehicle);
    let mut striking = start(&scenario.striking, &settings.striking, &geometry.striking);
    let mut striking_ending = scenario.striking_ending.clone().unwrap_or_default();
    if let Some(driver) = &mut striking_ending.pit {
        driver.side = driver.side.or_else(|| geometry.side_of_struck());
    }
    striking.controls = striking_ending.controls(&striking.vehicle);
    Ok(([struck, striking], geometry.normal_angle_world_rad))
}

/// Both vehicles through all contacts. The first one is the pulse; what comes after it follows from the
/// contact law.
fn through_all_contacts(
    [struck, mut striking]: [StruckVehicle; 2],
    outlines: [Footprint; 2],
    force: ForceHistory,
    normal_rad: f64,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let pair = ContactPair::new([&struck, &striking])?;
    pair.close_gap(&struck, &mut striking, normal_rad);
    let moved = pair.simulate([&struck, &striking], Some(&force), settings)?;
    let [motion, striking_motion] = moved.motions;
    Ok(Analysis {
        phases: moved.phases,
        dents_m: moved.dents_m,
        pair: Some(pair),
        ..analysis(struck, striking, outlines, Some(force), motion, striking_motion)
    })
}

/// Each vehicle for itself under the pulse.
fn apart(
    [struck, striking]: [StruckVehicle; 2],
    outlines: [Footprint; 2],
    (force, reaction): (ForceHistory, ForceHistory),
    pulse: &PulseSetup,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let motion = drive_on(&struck, force.clone(), settings)?;
    let end_s = motion.series.time_s().last().copied().unwrap_or(settings.duration_s);
    let settings = &Settings { duration_s: end_s, ends_at_rest: false, ..settings.clone() };
    let striking_motion = drive_on(&striking, reaction, settings)?;
    let second_contact = SecondContact::find(
        (outlines[0], &motion.series),
        (outlines[1], &striking_motion.series),
        pulse.duration_s,
    );
    let analysis = analysis(struck, striking, outlines, Some(force), motion, striking_motion);
    Ok(Analysis { second_contact, ..analysis })
}

/// The analysis of two vehicles whose motions are known.
///
/// - `force`: on the struck vehicle, of the first contact; `None` if it is not known beforehand.
pub(super) fn analysis(
    struck: StruckVehicle,
    striking: StruckVehicle,
    outlines: [Footprint; 2],
    force: Option<ForceHistory>,
    motion: Motion,
    striking_motion: Motion,
) -> Analysis {
    Analysis {
        name: String::new(),
        vehicle: struck.vehicle.clone(),
        footprint: outlines[0],
        force,
        controls: applied(&motion, &struck),
        has_stability_control: struck.controls.has_stability_control(),
        friction_zones: struck.friction_zones.clone(),
        struck: Some(struck),
        simulation: Some(motion),
        reference: None,
        striking: Some(VehicleTrack {
            footprint: outlines[1],
            controls: applied(&striking_motion, &striking),
            start: striking,
            motion: striking_motion.series,
            flags: striking_motion.flags,
        }),
        pair: None,
        phases: Vec::new(),
        dents_m: Default::default(),
        second_contact: None,
        error: None,
        notes: Vec::new(),
    }
}

/// What was done to the wheels in a motion: as drivers and systems made it, else as the start says.
fn applied(motion: &Motion, start: &StruckVehicle) -> Controls {
    motion.applied_controls.clone().unwrap_or_else(|| start.controls.clone())
}

/// State of a vehicle of a scenario at first contact.
fn initial_state(vehicle: &ScenarioVehicle, pose: &Pose) -> VehicleState<f64> {
    let [vx_body_m_s, vy_body_m_s] =
        body_from_world(pose.yaw_rad, [vehicle.vx_world_m_s, vehicle.vy_world_m_s]);
    VehicleState {
        vx_body_m_s,
        vy_body_m_s,
        yaw_rad: pose.yaw_rad,
        yaw_rate_rad_s: vehicle.yaw_rate_rad_s,
        x_m: pose.x_m,
        y_m: pose.y_m,
        ..VehicleState::default()
    }
}

/// Simulates a vehicle from first contact on.
fn drive_on(
    start: &StruckVehicle,
    force: ForceHistory,
    settings: &Settings,
) -> Result<Motion, AnalysisError> {
    let manoeuvre = Manoeuvre {
        initial: start.initial,
        contact_load: Some(ContactLoad { force, contact: start.contact, recorded_moment: false }),
        controls: start.controls.clone(),
        duration_s: settings.duration_s,
        ends_at_rest: settings.ends_at_rest,
        friction_zones: start.friction_zones.clone(),
    };
    Ok(start.vehicle.simulate(&manoeuvre, settings.integrator)?)
}

#[cfg(test)]
#[path = "fixed_tests.rs"]
mod fixed_tests;

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use impactlab_core::collision::{ContactLocation, Footprint, MovingFootprint, Side, overlap_m};
    use impactlab_core::data::{Channel, TimeSeries};
    use impactlab_core::numerics::interpolate;
    use impactlab_core::units::STANDARD_GRAVITY_M_S2;
    use impactlab_core::vehicle::{
        BRAKE_TORQUES, Braking, DRIVE_TORQUES, Ending, HeldSteer, PitDriver, Preset,
        StabilityControl, TireMark, TireMarkKind, tire_marks,
    };

    /// A report gave the struck car 4.9 m in one section and 4.52 m in another.
    #[test]
    fn a_car_has_the_size_that_the_scenario_says() {
        let scenario = Scenario::example();
        let settings = Settings { duration_s: 0.5, ..Settings::of_preset(Preset::Reference) };
        let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings).unwrap();
        assert_eq!(Footprint::from(&analysis.vehicle.geometry), scenario.struck.footprint());
        let before_m = settings.struck.geometry.outer_length_m;
        assert!(before_m != scenario.struck.length_m, "{before_m} m");
        let stated = &analysis.vehicle.stated["geometry.outer_length_m"];
        assert_eq!(*stated, format!("said with the collision, instead of {before_m} m"));
        assert!(!analysis.vehicle.estimates.contains_key("geometry.outer_length_m"));
    }

    #[test]
    fn a_pit_turns_the_struck_and_both_go_on() {
        let scenario = Scenario::load(Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../assets/scenarios/pit_right_rear.toml"
        )))
        .unwrap();
        let settings = Settings { duration_s: 3.0, ..Settings::of_preset(Preset::Target) };
        let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings).unwrap();
        let solution = scenario.solve().unwrap();
        let motion = analysis.simulation.unwrap().series;
        let rate = motion.require(Channel::YawRate).unwrap();
        let expected = solution.struck.yaw_rate_rad_s;
        assert!(expected < 0.0, "a push on the right rear turns the car to the right");
        assert!(rate[10] < 0.5 * expected, "{} against {expected}", rate[10]);
        let striking = analysis.striking.unwrap().motion;
        assert_eq!(striking.n_samples(), motion.n_samples());
        assert!(analysis.struck.unwrap().contact.y_body_m < 0.0);
    }

    /// What drivers and systems did to both vehicles is kept with their motions, and written with them.
    #[test]
    fn the_inputs_of_both_vehicles_are_those_of_their_endings() {
        let mut scenario = Scenario::example();
        let esc = Some(StabilityControl::default());
        let pit = PitDriver::default();
        scenario.striking_ending = Some(Ending { pit: Some(pit), esc, ..Ending::default() });
        let steer = Some(HeldSteer { start_s: 0.2, rise_s: 0.3, road_wheel_rad: 0.05 });
        let brake = Some(Braking::new(0.4, 0.5, 0.2));
        let ending = Ending { steer, brake, ..Ending::default() };
        for one_contact in [false, true] {
            let settings = Settings {
                ending: ending.clone(),
                duration_s: 2.0,
                one_contact,
                ..Settings::of_preset(Preset::Target)
            };
            let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings).unwrap();
            assert_eq!(analysis.controls, ending.controls(&analysis.vehicle));
            let written = analysis.written_motion().unwrap().unwrap();
            let at = |series: &TimeSeries, channel, i: usize| series.require(channel).unwrap()[i];
            assert!((at(&written, Channel::SteerFl, 60) - 0.05).abs() < 1e-12);
            let (mass_kg, tires) = (analysis.vehicle.mass.mass_kg, analysis.vehicle.tires);
            let force_n = 0.5 * tires.friction * mass_kg * STANDARD_GRAVITY_M_S2;
            let torques_n_m = BRAKE_TORQUES.map(|channel| at(&written, channel, 100));
            let total_n_m: f64 = torques_n_m.iter().sum();
            assert!((total_n_m - force_n * tires.rolling_radius_m).abs() < 1e-6, "{torques_n_m:?}");
            assert_eq!(at(&written, Channel::BrakeFl, 30), 0.0, "nobody brakes before 0.4 s");
            let striking = analysis.striking.unwrap();
            let written = striking.written_motion().unwrap();
            let drives = |channel: &Channel| {
                written.require(*channel).unwrap().iter().any(|torque_n_m| *torque_n_m > 0.0)
            };
            assert!(DRIVE_TORQUES.iter().any(drives), "its torques are written, too");
            assert_eq!(striking.controls.closed_loop, None, "as it was, not as it is decided");
            let wheels = striking.controls.wheels.unwrap();
            assert_eq!(wheels.time_s, striking.motion.time_s());
            let driven = |i: usize| wheels.wheels[i].iter().any(|wheel| wheel.drive_n > 0.0);
            assert!((0..wheels.wheels.len()).any(driven), "the driver holds the throttle");
            let steer = striking.controls.steer.unwrap();
            assert_eq!(steer.steer_rad, striking.motion.require(Channel::SteerFl).unwrap());
            let turned_rad = pit.acting().road_wheel_rad();
            let largest_rad = steer.steer_rad.iter().copied().fold(0.0, f64::max);
            assert!((largest_rad - turned_rad).abs() < 3e-3, "{largest_rad}, {turned_rad} rad");
        }
    }

    /// The brakes of a driver who acts by the motion locked no wheel in marks and scenes.
    #[test]
    fn the_striking_vehicle_leaves_the_marks_of_its_driver() {
        let mut scenario = Scenario::example();
        let pit =
            PitDriver { longest_s: Some(0.3), brake_share: Some(2.0), ..PitDriver::default() };
        scenario.striking_ending = Some(Ending { pit: Some(pit), ..Ending::default() });
        let settings = Settings::of_preset(Preset::Target);
        let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings).unwrap();
        let track = analysis.striking.unwrap();
        let marks = tire_marks(&track.motion, track.controlled());
        let locked_m: Vec<f64> = marks
            .iter()
            .filter(|mark| mark.kind() == TireMarkKind::Locked)
            .map(TireMark::length_m)
            .collect();
        assert!(locked_m.iter().any(|length_m| *length_m > 1.0), "{locked_m:?} m");
    }

    /// Followed through all contacts, vehicles push each other and do not go through each other.
    #[test]
    fn vehicles_that_push_each_other_stay_apart() {
        let scenario = Scenario::example();
        let settings = Settings::of_preset(Preset::Target);
        let analysis = analyse_scenario(&scenario, &PulseSetup::default(), &settings).unwrap();
        assert_eq!(analysis.second_contact, None);
        let phase = analysis.phases[0];
        let [px, py] = phase.impulse_world_n_s;
        let first = scenario.solve().unwrap().impulse_world_n_s;
        assert!(phase.start_s == 0.0 && px.hypot(py) > first[0].hypot(first[1]), "{phase:?}");
        let (struck, striking) =
            (analysis.simulation.unwrap().series, analysis.striking.unwrap().motion);
        let outline = |i: usize| scenario_outline(&scenario, i);
        let at = |series: &TimeSeries, footprint, i: usize| {
            let value = |channel| series.require(channel).unwrap()[i];
            let (x_m, y_m) = (value(Channel::X), value(Channel::Y));
            MovingFootprint::at_rest(footprint, Pose { x_m, y_m, yaw_rad: value(Channel::Yaw) })
        };
        let overlap = |i| overlap_m(&at(&struck, outline(0), i), &at(&striking, outline(1), i));
        let deepest_m = (0..struck.n_samples()).map(overlap).fold(-1.0, f64::max);
        // Rectangles; corners that are rounded by 0.65 m, and what they crush.
        assert!((0.1..0.6).contains(&deepest_m), "{deepest_m} m");
        let dents =
            analysis.dents_m.each_ref().map(|dents| dents.iter().copied().fold(0.0, f64::max));
        assert!(dents.iter().all(|dent| (0.005..0.5).contains(dent)), "{dents:?}");
    }

    fn scenario_outline(scenario: &Scenario, vehicle: usize) -> Footprint {
        [&scenario.struck, &scenario.striking][vehicle].footprint()
    }

    /// A striking vehicle that goes on pushing was drawn through the struck vehicle without a word.
    #[test]
    fn vehicles_that_meet_again_are_said_to() {
        let mut scenario = Scenario::example();
        let settings = Settings { one_contact: true, ..Settings::of_preset(Preset::Target) };
        let meets = |scenario: &Scenario| {
            let analysis = analyse_scenario(scenario, &PulseSetup::default(), &settings).unwrap();
            let (struck, striking) =
                (analysis.simulation.unwrap().series, analysis.striking.unwrap());
            let at = |series: &TimeSeries, footprint, time_s: f64| {
                let value = |channel| {
                    let values = series.require(channel).unwrap();
                    interpolate(series.time_s(), values, time_s).unwrap()
                };
                let (x_m, y_m) = (value(Channel::X), value(Channel::Y));
                let pose = Pose { x_m, y_m, yaw_rad: value(Channel::Yaw) };
                MovingFootprint::at_rest(footprint, pose)
            };
            let overlap = |time_s| {
                let struck = at(&struck, scenario.struck.footprint(), time_s);
                let striking = at(&striking.motion, striking.footprint, time_s);
                overlap_m(&struck, &striking)
            };
            let deepest = (60..=400).map(|i| overlap(f64::from(i) * 0.01)).fold(-1.0, f64::max);
            (analysis.second_contact, deepest)
        };
        // The striking vehicle pushes on along its heading, the struck vehicle's tires hold against
        // it.
        let (second, deepest_m) = meets(&scenario);
        let second = second.unwrap();
        assert!(second.time_s > 0.1 && second.closing_speed_m_s > 0.0, "{second:?}");
        assert!(deepest_m > 0.2, "{second:?} {deepest_m}");
        // A striking vehicle that steers away is met later and more slowly.
        let steer = HeldSteer { start_s: 0.0, rise_s: 0.2, road_wheel_rad: -0.14 };
        scenario.striking_ending = Some(Ending { steer: Some(steer), ..Ending::default() });
        let away = meets(&scenario).0.unwrap();
        assert!(away.time_s > second.time_s, "{second:?} {away:?}");
        assert!(away.closing_speed_m_s < 0.8 * second.closing_speed_m_s, "{second:?} {away:?}");
        scenario.striking_ending = None;
        // From behind, the striking vehicle is braked by the impact and stays behind.
        scenario.contact.location = ContactLocation::Side { side: Side::Rear, offset_m: 0.2 };
        scenario.striking.heading_rad = 0.0;
        (scenario.struck.vx_world_m_s, scenario.striking.vx_world_m_s) = (5.0, 15.0);
        scenario.striking.vy_world_m_s = 0.0;
        let (second, deepest_m) = meets(&scenario);
        assert_eq!(second, None);
        assert!(deepest_m < 0.0, "{deepest_m}");
    }
}
