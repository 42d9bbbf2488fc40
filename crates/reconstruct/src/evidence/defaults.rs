//! Standard deviations that stand in where the evidence file gives none.

/// Rest position along each axis, m: a total station or GNSS rover is far better, a tape or a pace
/// from a photograph about this good ([`Brach2011`](impactlab_core::bibliography::Brach2011), chapter on
/// uncertainty of measurements at the scene).
pub const DEFAULT_REST_SIGMA_M: f64 = 0.15;
/// Rest heading, rad: 2°, read off a sketch to scale or a photograph from above. Assumed.
pub const DEFAULT_HEADING_SIGMA_RAD: f64 = 0.035;
/// Point of a tire mark along each axis, m: half the width of a tire's tread. Assumed.
pub const DEFAULT_MARK_SIGMA_M: f64 = 0.10;
/// First contact along the struck side, m: a third of the width of a usual dent. Assumed.
pub const DEFAULT_DAMAGE_SIGMA_M: f64 = 0.10;
/// Position from a video along each axis, m. Assumed.
pub const DEFAULT_VIDEO_SIGMA_M: f64 = 0.30;
/// Mass as a share of it: kerb mass of the type with an estimate of the load. Assumed.
pub const DEFAULT_MASS_SHARE: f64 = 0.03;
/// Peak friction of a road of which nothing was measured: dry and wet asphalt together. The dry
/// half is that of the data sheets of this program.
pub const DEFAULT_FRICTION: f64 = 0.72;
/// Its standard deviation.
pub const DEFAULT_FRICTION_SIGMA: f64 = 0.13;
/// Angle of damage, rad. Damage is bent by the turn of the cars during the contact. Assumed.
pub const DEFAULT_ANGLE_SIGMA_RAD: f64 = 0.17;
/// Speed before the impact in an event data recorder as a share of it: 4 %, the accuracy that 49 CFR
/// 563 asks for with the rounding of the record.
pub const DEFAULT_EDR_SPEED_SHARE: f64 = 0.04;
/// Least standard deviation of that speed, m/s: the rounding of the record.
const LEAST_EDR_SPEED_SIGMA_M_S: f64 = 0.3;

/// Standard deviation of the speed before the impact in an event data recorder, m/s.
pub fn default_edr_speed_sigma(speed_m_s: f64) -> f64 {
    (DEFAULT_EDR_SPEED_SHARE * speed_m_s).max(LEAST_EDR_SPEED_SIGMA_M_S)
}
