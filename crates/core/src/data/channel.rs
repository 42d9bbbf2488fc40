//! The quantities that a time-series file can hold. For each of them one table defines the header
//! in the program's own files, the quantity and thus the unit, the label in plots, and the headers
//! that other programs use.

use serde::{Deserialize, Serialize};

use crate::units::Quantity;

macro_rules! channels {
    ($($(#[$doc:meta])* $variant:ident: $name:literal, $quantity:ident, $label:literal, [$($alias:literal),*];)+) => {
        /// A quantity that is recorded over time in one column of a file.
        ///
        /// Force and moment act ON the struck vehicle. World axes are X along the road and Y to its
        /// left. Body axes are the heading axes at the centre of gravity (ISO 8855: x forward, y
        /// left); they turn with the yaw angle. Forces are in world axes unless the name says
        /// `Body`. Velocity and acceleration are in body axes unless the name says `Struck` or
        /// `Striking`: those are in world axes.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Channel {
            $($(#[$doc])* $variant,)+
        }

        impl Channel {
            /// Every channel, in the order in which the columns of a file are written.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The header in the program's own files, which ends in the SI unit, such as
            /// `yaw_rate_rad_s`.
            pub fn header(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// The header without its unit, such as `yaw_rate`: the name of the channel in a column
            /// mapping and in messages.
            pub fn short_name(self) -> &'static str {
                let unit = match self.quantity() {
                    Quantity::Time => "_s",
                    Quantity::Length => "_m",
                    Quantity::Angle => "_rad",
                    Quantity::Speed => "_m_s",
                    Quantity::AngularVelocity => "_rad_s",
                    Quantity::Acceleration => "_m_s2",
                    Quantity::Force => "_n",
                    Quantity::Moment => "_nm",
                    _ => "",
                };
                self.header().strip_suffix(unit).unwrap_or(self.header())
            }

            /// The physical quantity that the channel measures, which decides its units.
            pub fn quantity(self) -> Quantity {
                match self { $(Self::$variant => Quantity::$quantity),+ }
            }

            /// The label of the channel in plots and tables, without the unit.
            pub fn label(self) -> &'static str {
                match self { $(Self::$variant => $label),+ }
            }

            /// The headers by which other programs name this channel, without the unit. They
            /// consist of lower-case letters and digits only, the form to which a header is reduced
            /// before it is compared.
            pub fn aliases(self) -> &'static [&'static str] {
                match self { $(Self::$variant => &[$($alias),*]),+ }
            }
        }
    };
}

channels! {
    /// Time.
    Time: "time_s", Time, "Time", ["time", "t", "zeit", "temps", "tiempo"];
    /// Position of the centre of gravity along the road, world axes.
    X: "x_m", Length, "X", ["x", "xpos", "posx", "positionx", "xposition", "xm", "xworld", "easting", "east", "rechtswert", "xg", "wegx"];
    /// Position of the centre of gravity to the left of the road, world axes.
    Y: "y_m", Length, "Y", ["y", "ypos", "posy", "positiony", "yposition", "ym", "yworld", "northing", "north", "hochwert", "yg", "wegy"];
    /// Yaw angle ψ of the vehicle, counter-clockwise positive.
    Yaw: "yaw_rad", Angle, "Yaw ψ", ["yaw", "yawangle", "psi", "heading", "headingangle", "gierwinkel"];
    /// Roll angle φ about the forward axis.
    Roll: "roll_rad", Angle, "Roll φ", ["roll", "rollangle", "phi", "wankwinkel"];
    /// Forward velocity of the centre of gravity, body axes.
    Vx: "vx_m_s", Speed, "v_x", ["vx", "vxbody", "velx", "velocityx", "longitudinalvelocity", "speedx", "geschwindigkeitx", "längsgeschwindigkeit"];
    /// Leftward velocity of the centre of gravity, body axes.
    Vy: "vy_m_s", Speed, "v_y", ["vy", "vybody", "vely", "velocityy", "lateralvelocity", "speedy", "geschwindigkeity", "quergeschwindigkeit"];
    /// Speed along the path, in whatever direction. It is compared with the path and used for nothing else.
    Speed: "speed_m_s", Speed, "Speed", ["speed", "velocity", "geschwindigkeit", "vitesse", "velocidad", "groundspeed", "speedoverground", "gpsspeed"];
    /// Yaw rate r.
    YawRate: "yaw_rate_rad_s", AngularVelocity, "Yaw rate r", ["yawrate", "r", "psidot", "wz", "omegaz", "gyroz", "gierrate", "giergeschwindigkeit", "gierwinkelgeschwindigkeit"];
    /// Roll rate about the forward axis.
    RollRate: "roll_rate_rad_s", AngularVelocity, "Roll rate", ["rollrate", "p", "phidot", "wx", "omegax", "gyrox"];
    /// Forward acceleration, body axes.
    Ax: "ax_m_s2", Acceleration, "a_x", ["ax", "accx", "accelx", "accelerationx", "longitudinalacceleration"];
    /// Leftward acceleration, body axes.
    Ay: "ay_m_s2", Acceleration, "a_y", ["ay", "accy", "accely", "accelerationy", "lateralacceleration"];
    /// Contact force along the X axis of the world.
    Fx: "fx_n", Force, "F_x", ["fx", "forcex", "xforce", "contactforcex", "fxworld", "kraftx"];
    /// Contact force along the Y axis of the world.
    Fy: "fy_n", Force, "F_y", ["fy", "forcey", "yforce", "contactforcey", "fyworld", "krafty"];
    /// Contact force along the heading of the struck vehicle.
    FxBody: "fx_body_n", Force, "F_x body", ["fxbody", "fxheading", "fxlocal"];
    /// Contact force to the left of the heading of the struck vehicle.
    FyBody: "fy_body_n", Force, "F_y body", ["fybody", "fyheading", "fylocal"];
    /// Yaw moment of the contact force about the centre of gravity of the struck vehicle.
    Mz: "mz_nm", Moment, "M_z", ["mz", "yawmoment", "momentz", "zmoment", "giermoment"];
    /// Roll moment of the contact force about the centre of gravity of the struck vehicle.
    Mx: "mx_nm", Moment, "M_x", ["mx", "rollmoment", "momentx", "xmoment"];
    /// Road-wheel steer angle of the front axle.
    Steer: "steer_rad", Angle, "Steer δ", ["steer", "steerangle", "delta", "roadwheelangle", "lenkwinkel"];
    /// Road-wheel steer angle of the front left wheel.
    SteerFl: "steer_fl_rad", Angle, "Steer FL", ["steerfl", "deltafl"];
    /// Road-wheel steer angle of the front right wheel.
    SteerFr: "steer_fr_rad", Angle, "Steer FR", ["steerfr", "deltafr"];
    /// Angle of the steering wheel.
    SteeringWheel: "steering_wheel_rad", Angle, "Steering wheel", ["steeringwheel", "steeringwheelangle", "handwheel", "handwheelangle", "swa", "lenkradwinkel"];
    /// Torque of the brake of the front left wheel.
    BrakeFl: "brake_fl_nm", Moment, "Brake FL", ["brakefl", "braketorquefl"];
    /// Torque of the brake of the front right wheel.
    BrakeFr: "brake_fr_nm", Moment, "Brake FR", ["brakefr", "braketorquefr"];
    /// Torque of the brake of the rear left wheel.
    BrakeRl: "brake_rl_nm", Moment, "Brake RL", ["brakerl", "braketorquerl"];
    /// Torque of the brake of the rear right wheel.
    BrakeRr: "brake_rr_nm", Moment, "Brake RR", ["brakerr", "braketorquerr"];
    /// Torque that drives the front left wheel forwards.
    DriveFl: "drive_fl_nm", Moment, "Drive FL", ["drivefl", "drivetorquefl"];
    /// Torque that drives the front right wheel forwards.
    DriveFr: "drive_fr_nm", Moment, "Drive FR", ["drivefr", "drivetorquefr"];
    /// Torque that drives the rear left wheel forwards.
    DriveRl: "drive_rl_nm", Moment, "Drive RL", ["driverl", "drivetorquerl"];
    /// Torque that drives the rear right wheel forwards.
    DriveRr: "drive_rr_nm", Moment, "Drive RR", ["driverr", "drivetorquerr"];
    /// Vertical load of the front left wheel.
    FzFl: "fz_fl_n", Force, "F_z FL", ["fzfl"];
    /// Vertical load of the front right wheel.
    FzFr: "fz_fr_n", Force, "F_z FR", ["fzfr"];
    /// Vertical load of the rear left wheel.
    FzRl: "fz_rl_n", Force, "F_z RL", ["fzrl"];
    /// Vertical load of the rear right wheel.
    FzRr: "fz_rr_n", Force, "F_z RR", ["fzrr"];
    /// Velocity of the struck vehicle along the X axis of the world.
    StruckVx: "target_vx_m_s", Speed, "Struck v_x", ["targetvx"];
    /// Velocity of the struck vehicle along the Y axis of the world.
    StruckVy: "target_vy_m_s", Speed, "Struck v_y", ["targetvy"];
    /// Yaw rate of the struck vehicle.
    StruckYawRate: "target_yaw_rate_rad_s", AngularVelocity, "Struck yaw rate", ["targetyawrate"];
    /// Yaw angle of the struck vehicle.
    StruckYaw: "target_yaw_rad", Angle, "Struck yaw", ["targetyaw"];
    /// Velocity of the striking vehicle along the X axis of the world.
    StrikingVx: "bullet_vx_m_s", Speed, "Striking v_x", ["bulletvx"];
    /// Velocity of the striking vehicle along the Y axis of the world.
    StrikingVy: "bullet_vy_m_s", Speed, "Striking v_y", ["bulletvy"];
    /// Yaw rate of the striking vehicle.
    StrikingYawRate:
        "bullet_yaw_rate_rad_s", AngularVelocity, "Striking yaw rate", ["bulletyawrate"];
    /// Yaw angle of the striking vehicle.
    StrikingYaw: "bullet_yaw_rad", Angle, "Striking yaw", ["bulletyaw"];
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn no_spelling_means_two_channels() {
        let mut seen = BTreeMap::new();
        for &channel in Channel::ALL {
            for &alias in channel.aliases() {
                let before = seen.insert(alias, channel);
                assert!(before.is_none(), "{alias:?} is {before:?} and {channel:?}");
            }
        }
    }
}
