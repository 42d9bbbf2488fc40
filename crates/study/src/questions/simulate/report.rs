//! What is told about the simulation of one vehicle.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::{Analysis, ContactPhaseReport, MotionEnd, StruckVehicle, told};
use crate::{
    FlagReport, ImpulseRival, MomentumReport, MotionSource, SimulateRequest, SkidReport,
    TireMarkReport, VehicleUncertainty, word,
};
use impactlab_core::collision::{PrincipalDirectionOfForce, Role};
use impactlab_core::compare::{MotionError, largest_yaw_change_rad};
use impactlab_core::data::{
    Channel, ForceAxes, ForceHistory, SeriesError, TimeSeries, contact_interval,
};
use impactlab_core::numerics::interpolate;
use impactlab_core::vehicle::frames::world_from_body;
use impactlab_core::vehicle::{FrictionZone, Motion, RoadSlope};

/// A part of the ground with its own friction.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FrictionZoneReport {
    /// What it is called.
    pub name: String,
    /// Peak friction in it.
    pub friction: f64,
}

impl FrictionZoneReport {
    pub(crate) fn from_zone(zone: &FrictionZone) -> Self {
        Self { name: zone.name.clone(), friction: zone.friction }
    }

    /// The zones with their friction in a few words; `None` if there are none.
    pub fn listed(zones: &[Self]) -> Option<String> {
        let one = |zone: &Self| format!("{} {}", zone.name, zone.friction);
        let all: Vec<String> = zones.iter().map(one).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }
}

/// The simulation of one vehicle, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SimulateReport {
    /// The case, file or scenario.
    pub name: String,
    /// The struck vehicle.
    pub vehicle: String,
    /// Which equations of motion.
    pub equations: String,
    /// How they are integrated.
    pub integrator: String,
    /// Peak friction of the road.
    pub friction: f64,
    /// Parts of the ground with their own friction, in which the wheels may stand.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub friction_zones: Vec<FrictionZoneReport>,
    /// Slope of the road, rise over run along X and Y; none on a level road.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<RoadSlope>,
    /// Duration of the simulation, s.
    pub duration_s: f64,
    /// The force on the vehicle.
    pub force: Option<ForceReport>,
    /// The momentum solution whose impulse the force carries, world axes; none without a scenario.
    pub momentum: Option<MomentumReport>,
    /// The force network beside that impulse; none where it is not asked or has nothing of its own to
    /// say.
    pub rival: Option<ImpulseRival>,
    /// Change of the velocity of the CG over the contact [x, y], world axes, tires included, m/s.
    pub delta_v_m_s: Option<[f64; 2]>,
    /// Its size, m/s.
    pub delta_v_magnitude_m_s: Option<f64>,
    /// The state at the last sample; none where a recorded motion cannot be simulated.
    pub end: Option<EndState>,
    /// Length of the path of the CG, m.
    pub distance_m: Option<f64>,
    /// Where the vehicle has come to rest; none if it still moves at the end.
    pub rest: Option<RestState>,
    /// Largest change of yaw from the start, rad.
    pub largest_yaw_change_rad: Option<f64>,
    /// The marks that tires leave in the simulation, of the struck vehicle and of the striking one.
    #[serde(rename = "tyre_marks")]
    pub tire_marks: Vec<TireMarkReport>,
    /// How far the simulation lies from the recorded motion, where there is one.
    pub error: Option<MotionError>,
    /// How the end varies with what the data sheet of the struck vehicle leaves open.
    pub uncertainty: Option<VehicleUncertainty>,
    /// Phases of contact of the vehicles, where both were followed through all of them; without grazes, of
    /// less than 1 % of the impulse of the largest.
    pub contacts: Vec<ContactPhaseReport>,
    /// The vehicles of a scenario before skids that end at the first contact.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub skids: Vec<SkidReport>,
    /// Wheel lift and roll beyond the limit of the struck and of the striking vehicle, a second contact.
    pub flags: Vec<FlagReport>,
}

/// The force that drives a simulation.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ForceReport {
    /// Its file; `None` where it comes from a case or a scenario.
    pub path: Option<PathBuf>,
    /// What a sample stands for.
    pub sampling: String,
    /// Axes of the components.
    pub axes: String,
    /// Impulse [x, y] in these axes, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest size of the force, N.
    pub peak_n: f64,
    /// When it is reached, s.
    pub peak_time_s: f64,
    /// Principal direction of force, degrees clockwise from the struck vehicle's heading before the
    /// impact.
    pub pdof_deg: Option<f64>,
    /// The same as an hour of the clock.
    pub pdof_clock: Option<u8>,
    /// First touch, s.
    pub contact_start_s: Option<f64>,
    /// Last separation, s.
    pub contact_end_s: Option<f64>,
    /// Where the yaw moment comes from: `recorded` or `contact_point`.
    pub yaw_moment: &'static str,
}

/// The pose in which a vehicle has come to rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct RestState {
    /// The instant since which it is at rest, s.
    pub time_s: f64,
    /// X of the CG, m.
    pub x_m: f64,
    /// Y of the CG, m.
    pub y_m: f64,
    /// Heading, rad.
    pub yaw_rad: f64,
    /// Length of the path of the CG up to there, m.
    pub distance_m: f64,
}

/// State at the last sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct EndState {
    /// X of the CG, m.
    pub x_m: f64,
    /// Y of the CG, m.
    pub y_m: f64,
    /// Heading, rad.
    pub yaw_rad: f64,
    /// Roll angle, rad.
    pub roll_rad: f64,
    /// Forward velocity, m/s.
    pub vx_m_s: f64,
    /// Leftward velocity, m/s.
    pub vy_m_s: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Speed of the CG, m/s.
    pub speed_m_s: f64,
}

impl SimulateReport {
    /// What follows from an analysis.
    pub(crate) fn new(request: &SimulateRequest, analysis: &Analysis) -> Result<Self, SeriesError> {
        let motion = analysis.simulation.as_ref();
        let series = motion.map(|motion| &motion.series);
        let interval = analysis.force.as_ref().and_then(contact_interval);
        let delta_v = series
            .zip(interval)
            .map(|(series, (start_s, end_s))| delta_v_m_s(series, start_s, end_s))
            .transpose()?;
        let recorded = analysis.reference.as_ref();
        let end_s = series.and_then(|series| series.time_s().last().copied());
        let recorded_s = recorded.and_then(|series| series.time_s().last().copied());
        Ok(Self {
            name: analysis.name.clone(),
            vehicle: analysis.vehicle.name.clone(),
            equations: word(&analysis.vehicle.equations),
            integrator: word(&request.integrator),
            friction: analysis.vehicle.tires.friction,
            skids: match &request.source {
                MotionSource::Scenario { scenario, .. } => {
                    let scenario = scenario.load().ok();
                    scenario.map_or_else(Vec::new, |scenario| {
                        SkidReport::of(&scenario, &analysis.vehicle.slope)
                    })
                }
                _ => Vec::new(),
            },
            slope: Some(analysis.vehicle.slope).filter(|slope| !slope.is_level()),
            friction_zones: analysis
                .friction_zones
                .iter()
                .map(FrictionZoneReport::from_zone)
                .collect(),
            duration_s: recorded_s.or(end_s).unwrap_or(request.duration_s),
            force: ForceReport::from_analysis(request, analysis),
            momentum: None,
            rival: None,
            delta_v_m_s: delta_v,
            delta_v_magnitude_m_s: delta_v.map(|[x, y]| x.hypot(y)),
            end: series.map(EndState::from_series).transpose()?,
            distance_m: series.map(distance_m).transpose()?,
            rest: motion.map(RestState::from_motion).transpose()?.flatten(),
            largest_yaw_change_rad: series.map(largest_yaw_change_rad).transpose()?,
            tire_marks: TireMarkReport::all(analysis),
            error: analysis.error.clone(),
            uncertainty: None,
            contacts: told(&analysis.phases).into_iter().map(ContactPhaseReport::from).collect(),
            flags: flags(analysis),
        })
    }
}

/// What is flagged in the motions; where there are two vehicles, each flag says whose it is.
fn flags(analysis: &Analysis) -> Vec<FlagReport> {
    let struck = analysis.simulation.iter().flat_map(|motion| &motion.flags);
    let second = analysis.second_contact.iter().map(FlagReport::from);
    let Some(track) = &analysis.striking else {
        return struck.map(FlagReport::from).chain(second).collect();
    };
    let struck = struck.map(|flag| FlagReport::of_vehicle(Role::Struck, flag));
    // A wall or a pole has no wheels that could lift.
    let striking = track.flags.iter().filter(|_| track.start.vehicle.fixed.is_none());
    let striking = striking.map(|flag| FlagReport::of_vehicle(Role::Striking, flag));
    struck.chain(second).chain(striking).collect()
}

impl ForceReport {
    fn from_analysis(request: &SimulateRequest, analysis: &Analysis) -> Option<Self> {
        let (force, path) = (analysis.force.as_ref()?, request.source.force_file());
        Self::from_history(force, path, analysis.struck.as_ref())
    }

    /// `None` for a force without samples.
    ///
    /// - `path`: its file, where it is one;
    /// - `struck`: the vehicle on which it acts.
    pub(crate) fn from_history(
        force: &ForceHistory,
        path: Option<&PathBuf>,
        struck: Option<&StruckVehicle>,
    ) -> Option<Self> {
        let interval = contact_interval(force);
        let (peak_n, peak_time_s) = force.peak()?;
        // Heading axes turn with the vehicle already, so that its heading is zero in them.
        let heading_rad = match (force.axes, struck) {
            (ForceAxes::World, Some(struck)) => struck.initial.yaw_rad,
            (ForceAxes::World, None) | (ForceAxes::Body, _) => 0.0,
        };
        let pdof = PrincipalDirectionOfForce::from_impulse(force.impulse_n_s(), heading_rad);
        Some(Self {
            path: path.cloned(),
            sampling: word(&force.sampling),
            axes: word(&force.axes),
            impulse_n_s: force.impulse_n_s(),
            peak_n,
            peak_time_s,
            pdof_deg: pdof.map(PrincipalDirectionOfForce::angle_deg),
            pdof_clock: pdof.map(PrincipalDirectionOfForce::clock),
            contact_start_s: interval.map(|(start, _)| start),
            contact_end_s: interval.map(|(_, end)| end),
            yaw_moment: if force.mz_n_m.is_some() { "recorded" } else { "contact_point" },
        })
    }
}

/// Change of the CG's velocity over the contact, world axes, m/s: tires included.
fn delta_v_m_s(series: &TimeSeries, start_s: f64, end_s: f64) -> Result<[f64; 2], SeriesError> {
    let [vx, vy, yaw] = [Channel::Vx, Channel::Vy, Channel::Yaw].map(|c| series.require(c));
    let (vx, vy, yaw) = (vx?, vy?, yaw?);
    let velocity = |time_s| {
        let at = |values| interpolate(series.time_s(), values, time_s).unwrap_or(f64::NAN);
        world_from_body(at(yaw), [at(vx), at(vy)])
    };
    let ([x0, y0], [x1, y1]) = (velocity(start_s), velocity(end_s));
    Ok([x1 - x0, y1 - y0])
}

/// Length of the path of the CG, m.
fn distance_m(series: &TimeSeries) -> Result<f64, SeriesError> {
    let (x, y) = (series.require(Channel::X)?, series.require(Channel::Y)?);
    Ok(path_length_m(x, y))
}

fn path_length_m(x: &[f64], y: &[f64]) -> f64 {
    let steps = x.windows(2).zip(y.windows(2));
    steps.map(|(x, y)| (x[1] - x[0]).hypot(y[1] - y[0])).sum()
}

impl RestState {
    fn from_motion(motion: &Motion) -> Result<Option<Self>, SeriesError> {
        let Some(time_s) = motion.rest_s else { return Ok(None) };
        let series = &motion.series;
        let n_before = series.time_s().partition_point(|&t| t <= time_s + 1e-9);
        let until = |channel| -> Result<&[f64], SeriesError> {
            let values = series.require(channel)?;
            Ok(values.get(..n_before).unwrap_or(values))
        };
        let (x, y, yaw) = (until(Channel::X)?, until(Channel::Y)?, until(Channel::Yaw)?);
        let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
        Ok(Some(Self {
            time_s,
            x_m: last(x),
            y_m: last(y),
            yaw_rad: last(yaw),
            distance_m: path_length_m(x, y),
        }))
    }
}

/// Where a simulated motion ends: at rest, or at its last sample.
pub(crate) fn motion_end(motion: &Motion) -> Result<MotionEnd, SeriesError> {
    let end = EndState::from_series(&motion.series)?;
    let rest = RestState::from_motion(motion)?;
    let last_s = motion.series.time_s().last().copied().unwrap_or(0.0);
    let pose = rest.map_or([end.x_m, end.y_m, end.yaw_rad], |at| [at.x_m, at.y_m, at.yaw_rad]);
    let [x_m, y_m, yaw_rad] = pose;
    Ok(MotionEnd {
        is_at_rest: rest.is_some(),
        time_s: rest.map_or(last_s, |rest| rest.time_s),
        distance_m: match rest {
            Some(rest) => rest.distance_m,
            None => distance_m(&motion.series)?,
        },
        x_m,
        y_m,
        yaw_rad,
        speed_m_s: end.speed_m_s,
        yaw_rate_rad_s: end.yaw_rate_rad_s,
    })
}

impl EndState {
    pub(crate) fn from_series(series: &TimeSeries) -> Result<Self, SeriesError> {
        let last = |channel| -> Result<f64, SeriesError> {
            let values = series.require(channel)?;
            Ok(values.last().copied().unwrap_or(f64::NAN))
        };
        let (vx_m_s, vy_m_s) = (last(Channel::Vx)?, last(Channel::Vy)?);
        Ok(Self {
            x_m: last(Channel::X)?,
            y_m: last(Channel::Y)?,
            yaw_rad: last(Channel::Yaw)?,
            roll_rad: last(Channel::Roll)?,
            vx_m_s,
            vy_m_s,
            yaw_rate_rad_s: last(Channel::YawRate)?,
            speed_m_s: vx_m_s.hypot(vy_m_s),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use super::*;
    use crate::analysis::PulseSetup;
    use crate::{ImpactRequest, Library, MotionSource, Question, ScenarioChoice};
    use impactlab_core::collision::Scenario;

    const PIT: &str = include_str!("../../../../../assets/scenarios/pit_right_rear.toml");

    #[test]
    fn the_direction_of_force_is_that_of_the_impact_whichever_way_the_vehicle_heads() {
        for heading_deg in [0, 90, 200] {
            let text = PIT
                .replace("heading_deg = 0", &format!("heading_deg = {heading_deg}"))
                .replace("heading_deg = 18", &format!("heading_deg = {}", heading_deg + 18));
            let scenario = Scenario::from_toml(&text, Path::new("pit.toml")).unwrap();
            let scenario = ScenarioChoice::Inline(Box::new(scenario));
            let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
            let library = Library::default();
            let impact = ImpactRequest::new(scenario.clone());
            let impact = impact.answer(&library, &mut go_on).unwrap().complete().unwrap();
            let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
            let motion = SimulateRequest::new(source).answer(&library, &mut go_on).unwrap();
            let force = motion.complete().unwrap().report.report.force.unwrap();
            let (expected, got) = (impact.report.struck.pdof_deg.unwrap(), force.pdof_deg.unwrap());
            assert!((expected - got).abs() < 1e-6, "{heading_deg}: {expected} {got}");
            assert_eq!(force.pdof_clock, impact.report.struck.pdof_clock, "{heading_deg}");
        }
    }
}
