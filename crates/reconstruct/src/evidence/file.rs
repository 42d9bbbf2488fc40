//! Reads an evidence file. Its key names contain the units; another unit of the same quantity may
//! stand in a key, such as `speed_before_km_h`.
//!
//! ```toml
//! case = "B 27"
//!
//! [road]                            # optional, as everything but struck_car, striking_car, damage
//! friction = 0.72
//! friction_sigma = 0.04
//!
//! [struck_car]                      # mass_kg, or a data sheet (--vehicle)
//! mass_kg = 1520
//! mass_sigma_kg = 30
//! cg_to_front_axle_m = 1.25         # and cg_to_rear_axle_m, track_m, cg_height_m, length_m,
//! cg_to_rear_axle_m = 1.45          # width_m, yaw_inertia_kg_m2
//!
//! [striking_car]
//! mass_kg = 1900
//!
//! [weighing]                        # if one scale weighed both cars: its error as a share; the
//! shared_scale_sigma = 0.01         # mass_sigma_kg are those of the other errors
//!
//! [damage]
//! side = "right"                    # left, right, front, rear
//! x_m = -1.7                        # along the side, from the CG; y_m at front and rear
//! x_sigma_m = 0.1
//! y_m = -0.9                        # the other coordinate, optional
//! angle_deg = 20                    # heading of the striking car against the struck car
//! angle_sigma_deg = 10
//!
//! [rest]                            # and [striking_rest]
//! x_m = 41.2
//! y_m = -6.3
//! position_sigma_m = 0.15
//! heading_rad = 2.9                 # whole turns do not count
//! heading_sigma_rad = 0.035
//! # known = false                   # the car was moved
//!
//! [after]
//! blocked_wheels = ["RR"]           # FL, FR, RL, RR; [] if all turn
//! driver_braked = "unknown"         # yes, no
//!
//! [[mark]]
//! wheel = "RR"
//! kind = "locked"                   # side-slip
//! points_m = [[1.0, -0.7], [6.0, -0.8], [11.0, -1.6]]   # from start to end
//! sigma_m = 0.1
//!
//! [edr]
//! delta_v_y_min_m_s = 1.0           # and delta_v_x_…, heading axes of the struck car
//! delta_v_y_max_m_s = 1.3
//! speed_before_m_s = 21.4
//! speed_before_sigma_m_s = 0.9
//! sensor_x_m = 0.2                  # from the CG; and sensor_y_m
//! ends_s = 0.25                     # where the record is cut off
//!
//! [[position]]                      # from a video
//! time_s = 1.2
//! x_m = 20.1
//! y_m = -2.0
//! sigma_m = 0.3
//!
//! [prior]                           # ranges, each value inside equally likely
//! target_speed_m_s = [5, 45]
//! ```

use std::path::Path;

use crate::evidence::defaults::{
    DEFAULT_ANGLE_SIGMA_RAD, DEFAULT_DAMAGE_SIGMA_M, DEFAULT_FRICTION_SIGMA,
    DEFAULT_HEADING_SIGMA_RAD, DEFAULT_MARK_SIGMA_M, DEFAULT_MASS_SHARE, DEFAULT_REST_SIGMA_M,
    DEFAULT_VIDEO_SIGMA_M, default_edr_speed_sigma,
};
use crate::evidence::{
    After, CarEvidence, Damage, DriverBraked, Edr, Evidence, Mark, MarkKind, Measured, PriorRanges,
    RestPose, VideoPosition,
};
use impactlab_core::collision::Side;
use impactlab_core::data::{TomlError, TomlFile, TomlTable};
use impactlab_core::ranges::{
    ANGLE_SIGMA, BRAKE_SHARE, CG_HEIGHT, CG_TO_AXLE, CONTACT_X, CONTACT_Y, CONTROL_TIME,
    EVIDENCE_HEADING, EVIDENCE_POSITION, EVIDENCE_SPEED, EVIDENCE_TIME, FRICTION_LIMIT,
    FRICTION_SIGMA, HEADING, MASS_SIGMA, OUTER_LENGTH, OUTER_WIDTH, POSITION_SIGMA, PULSE_END,
    RESTITUTION, ROAD_FRICTION, Range, SCALE_SIGMA, SPEED, SPEED_SIGMA, TRACK_WIDTH, VEHICLE_MASS,
    VEHICLE_YAW_INERTIA,
};
use impactlab_core::vehicle::Wheel;

/// The wheels in a file, in the order of [`Wheel::ALL`].
pub(super) const WHEELS: [&str; 4] = ["FL", "FR", "RL", "RR"];
pub(super) const SIDES: [(&str, Side); 4] =
    [("left", Side::Left), ("right", Side::Right), ("front", Side::Front), ("rear", Side::Rear)];
pub(super) const MARK_KINDS: [(&str, MarkKind); 2] =
    [("side-slip", MarkKind::SideSlip), ("locked", MarkKind::Locked)];

impl Evidence {
    /// Reads an evidence file.
    ///
    /// # Errors
    /// [`TomlError`] with file, line, key and what is expected.
    pub fn load(path: &Path) -> Result<Self, TomlError> {
        let text = TomlFile::read(path)?;
        Self::from_toml(TomlFile { path, text: &text })
    }

    /// Reads the text of an evidence file.
    ///
    /// # Errors
    /// The errors of [`Evidence::load`] except [`TomlError::File`].
    pub fn from_toml(file: TomlFile<'_>) -> Result<Self, TomlError> {
        let root = file.parse()?;
        let mut top = TomlTable::root(file, &root);
        let case = top.string("case")?;
        let friction = match top.optional_table("road")? {
            Some(table) => read_road(table)?,
            None => None,
        };
        let struck_car = read_car(top.table("struck_car")?)?;
        let striking_car = read_car(top.table("striking_car")?)?;
        let shared_scale_sigma = top.optional_table("weighing")?.map_or(Ok(None), read_weighing)?;
        let damage = read_damage(top.table("damage")?)?;
        let mut pose = |key| top.optional_table(key)?.map_or(Ok(None), read_rest);
        let (rest, striking_rest) = (pose("rest")?, pose("striking_rest")?);
        let after = top.optional_table("after")?.map_or(Ok(After::default()), read_after)?;
        let marks = top.tables("mark")?.into_iter().map(read_mark).collect::<Result<_, _>>()?;
        let edr = top.optional_table("edr")?.map_or(Ok(Edr::default()), read_edr)?;
        let positions =
            top.tables("position")?.into_iter().map(read_position).collect::<Result<_, _>>()?;
        let prior = top.optional_table("prior")?.map_or(Ok(PriorRanges::default()), read_prior)?;
        top.finish()?;
        Ok(Self {
            case: case.unwrap_or_else(|| file.path.display().to_string()),
            friction,
            struck_car,
            striking_car,
            shared_scale_sigma,
            damage,
            rest,
            striking_rest,
            after,
            marks,
            edr,
            positions,
            prior,
        })
    }
}

/// A number with its standard deviation, under `base` and `base_sigma`.
///
/// - `default`: the standard deviation where the file gives none, by the value.
fn measured(
    table: &mut TomlTable<'_>,
    base: &str,
    (range, sigma): (&Range, &Range),
    default: impl Fn(f64) -> f64,
) -> Result<Option<Measured>, TomlError> {
    let value = table.number(base, range)?;
    let sigma = table.number(&format!("{base}_sigma"), sigma)?;
    match (value, sigma) {
        (Some(value), sigma) => {
            Ok(Some(Measured { value, sigma: sigma.unwrap_or_else(|| default(value)) }))
        }
        (None, Some(_)) => Err(table.missing(base)),
        (None, None) => Ok(None),
    }
}

fn read_road(mut table: TomlTable<'_>) -> Result<Option<Measured>, TomlError> {
    let ranges = (&ROAD_FRICTION, &FRICTION_SIGMA);
    let friction = measured(&mut table, "friction", ranges, |_| DEFAULT_FRICTION_SIGMA)?;
    table.finish()?;
    Ok(friction)
}

fn read_car(mut table: TomlTable<'_>) -> Result<CarEvidence, TomlError> {
    let ranges = (&VEHICLE_MASS, &MASS_SIGMA);
    let car = CarEvidence {
        mass_kg: measured(&mut table, "mass", ranges, |kg| DEFAULT_MASS_SHARE * kg)?,
        cg_to_front_axle_m: table.number("cg_to_front_axle", &CG_TO_AXLE)?,
        cg_to_rear_axle_m: table.number("cg_to_rear_axle", &CG_TO_AXLE)?,
        track_m: table.number("track", &TRACK_WIDTH)?,
        cg_height_m: table.number("cg_height", &CG_HEIGHT)?,
        length_m: table.number("length", &OUTER_LENGTH)?,
        width_m: table.number("width", &OUTER_WIDTH)?,
        yaw_inertia_kg_m2: table.number("yaw_inertia", &VEHICLE_YAW_INERTIA)?,
    };
    match (car.cg_to_front_axle_m, car.cg_to_rear_axle_m) {
        (Some(_), None) => return Err(table.missing("cg_to_rear_axle_m")),
        (None, Some(_)) => return Err(table.missing("cg_to_front_axle_m")),
        _ => {}
    }
    table.finish()?;
    Ok(car)
}

/// Error of a scale that weighed both cars, as a share.
fn read_weighing(mut table: TomlTable<'_>) -> Result<Option<f64>, TomlError> {
    let sigma = table.require("shared_scale_sigma", &SCALE_SIGMA)?;
    table.finish()?;
    Ok(Some(sigma))
}

fn read_damage(mut table: TomlTable<'_>) -> Result<Damage, TomlError> {
    let words = SIDES.map(|(word, _)| word);
    let Some(idx) = table.choice("side", &words)? else { return Err(table.missing("side")) };
    let side = SIDES[idx].1;
    let sigma = |_| DEFAULT_DAMAGE_SIGMA_M;
    let is_flank = matches!(side, Side::Left | Side::Right);
    let (along, range, across, across_range) = match is_flank {
        true => ("x", CONTACT_X, "y", CONTACT_Y),
        false => ("y", CONTACT_Y, "x", CONTACT_X),
    };
    let found = measured(&mut table, along, (&range, &POSITION_SIGMA), sigma)?;
    let Some(along_m) = found else { return Err(table.missing(&format!("{along}_m"))) };
    let depth_m = table.number(across, &across_range)?;
    let outward = match side {
        Side::Left | Side::Front => 1.0,
        Side::Right | Side::Rear => -1.0,
    };
    if depth_m.is_some_and(|depth_m| depth_m * outward < 0.0) {
        let expected = format!("a point on the {} of the car", words[idx]);
        return Err(table.refuse_last(&expected));
    }
    let ranges = (&EVIDENCE_HEADING, &ANGLE_SIGMA);
    let angle_rad = measured(&mut table, "angle", ranges, |_| DEFAULT_ANGLE_SIGMA_RAD)?;
    table.finish()?;
    Ok(Damage { side, along_m, depth_m, angle_rad })
}

/// A rest pose; `None` if the file says that it is not known.
fn read_rest(mut table: TomlTable<'_>) -> Result<Option<RestPose>, TomlError> {
    let is_known = table.flag("known")?.unwrap_or(true);
    let x_m = table.number("x", &EVIDENCE_POSITION)?;
    let y_m = table.number("y", &EVIDENCE_POSITION)?;
    let sigma = table.number("position_sigma", &POSITION_SIGMA)?;
    let ranges = (&EVIDENCE_HEADING, &ANGLE_SIGMA);
    let heading_rad = measured(&mut table, "heading", ranges, |_| DEFAULT_HEADING_SIGMA_RAD)?;
    if !is_known {
        table.finish()?;
        return Ok(None);
    }
    let (x_m, y_m) = match (x_m, y_m) {
        (Some(x_m), Some(y_m)) => (x_m, y_m),
        (None, _) => return Err(table.missing("x_m")),
        (_, None) => return Err(table.missing("y_m")),
    };
    table.finish()?;
    let position_sigma_m = sigma.unwrap_or(DEFAULT_REST_SIGMA_M);
    Ok(Some(RestPose { x_m, y_m, position_sigma_m, heading_rad }))
}

fn read_after(mut table: TomlTable<'_>) -> Result<After, TomlError> {
    let blocked = table.choices("blocked_wheels", &WHEELS)?;
    let braked = [DriverBraked::Yes, DriverBraked::No, DriverBraked::Unknown];
    let choice = table.choice("driver_braked", &["yes", "no", "unknown"])?;
    table.finish()?;
    Ok(After {
        blocked_wheels: blocked.map(|wheels| wheels.into_iter().map(|i| Wheel::ALL[i]).collect()),
        driver_braked: choice.map_or(DriverBraked::Unknown, |idx| braked[idx]),
    })
}

fn read_mark(mut table: TomlTable<'_>) -> Result<Mark, TomlError> {
    let Some(wheel) = table.choice("wheel", &WHEELS)? else { return Err(table.missing("wheel")) };
    let kind = table.choice("kind", &MARK_KINDS.map(|(word, _)| word))?;
    let kind = kind.map(|idx| MARK_KINDS[idx].1);
    let start_m = table.point("start_m", &EVIDENCE_POSITION)?;
    let points = table.points("points_m", &EVIDENCE_POSITION)?;
    let Some(points_m) = points else { return Err(table.missing("points_m")) };
    if points_m.len() < 2 {
        return Err(table.refuse_last("at least two points [x, y], the start and the end"));
    }
    if points_m.windows(2).all(|pair| pair[0] == pair[1]) {
        return Err(table.refuse_last("points that differ, the start and the end"));
    }
    let is_first = |start: [f64; 2]| {
        points_m.first().is_some_and(|first| (start[0] - first[0]).hypot(start[1] - first[1]) < 0.5)
    };
    if start_m.is_some_and(|start| !is_first(start)) {
        return Err(table.refuse_last("points that begin at start_m"));
    }
    let sigma_m = table.number("sigma", &POSITION_SIGMA)?.unwrap_or(DEFAULT_MARK_SIGMA_M);
    table.finish()?;
    Ok(Mark { wheel: Wheel::ALL[wheel], kind, points_m, sigma_m })
}

fn read_edr(mut table: TomlTable<'_>) -> Result<Edr, TomlError> {
    let delta_v_x_m_s = read_bounds(&mut table, "delta_v_x")?;
    let delta_v_y_m_s = read_bounds(&mut table, "delta_v_y")?;
    let ranges = (&EVIDENCE_SPEED, &SPEED_SIGMA);
    let sigma = default_edr_speed_sigma;
    let speed_before_m_s = measured(&mut table, "speed_before", ranges, sigma)?;
    let x_m = table.number("sensor_x", &CONTACT_X)?.unwrap_or(0.0);
    let y_m = table.number("sensor_y", &CONTACT_Y)?.unwrap_or(0.0);
    let ends_s = table.number("ends", &PULSE_END)?;
    table.finish()?;
    Ok(Edr { delta_v_x_m_s, delta_v_y_m_s, speed_before_m_s, sensor_m: [x_m, y_m], ends_s })
}

/// Lower and upper bound of a change of velocity.
fn read_bounds(table: &mut TomlTable<'_>, base: &str) -> Result<Option<[f64; 2]>, TomlError> {
    let low = table.number(&format!("{base}_min"), &SPEED)?;
    let high = table.number(&format!("{base}_max"), &SPEED)?;
    match (low, high) {
        (Some(low), Some(high)) if low <= high => Ok(Some([low, high])),
        (Some(_), Some(_)) => Err(table.refuse_last(&format!("{base}_min or more"))),
        (Some(_), None) => Err(table.missing(&format!("{base}_max_m_s"))),
        (None, Some(_)) => Err(table.missing(&format!("{base}_min_m_s"))),
        (None, None) => Ok(None),
    }
}

fn read_position(mut table: TomlTable<'_>) -> Result<VideoPosition, TomlError> {
    let time_s = table.require("time", &EVIDENCE_TIME)?;
    let x_m = table.require("x", &EVIDENCE_POSITION)?;
    let y_m = table.require("y", &EVIDENCE_POSITION)?;
    let sigma_m = table.number("sigma", &POSITION_SIGMA)?.unwrap_or(DEFAULT_VIDEO_SIGMA_M);
    table.finish()?;
    Ok(VideoPosition { time_s, x_m, y_m, sigma_m })
}

fn read_prior(mut table: TomlTable<'_>) -> Result<PriorRanges, TomlError> {
    let prior = PriorRanges {
        struck_speed_m_s: table.interval("target_speed", &EVIDENCE_SPEED)?,
        striking_speed_m_s: table.interval("bullet_speed", &EVIDENCE_SPEED)?,
        heading_difference_rad: table.interval("heading_difference", &HEADING)?,
        striking_sideslip_rad: table.interval("bullet_sideslip", &EVIDENCE_HEADING)?,
        restitution: table.interval("restitution", &RESTITUTION)?,
        contact_friction: table.interval("contact_friction", &FRICTION_LIMIT)?,
        brake_start_s: table.interval("brake_start", &CONTROL_TIME)?,
        brake_share: table.interval("brake_share", &BRAKE_SHARE)?,
    };
    table.finish()?;
    Ok(prior)
}

#[cfg(test)]
#[path = "file_tests.rs"]
mod tests;
