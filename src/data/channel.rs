//! The quantities that time-series files hold: one place for their names in our files, their
//! units, what a plot calls them and how other programs spell them.

use serde::{Deserialize, Serialize};

use crate::units::Quantity;

macro_rules! channels {
    ($($(#[$doc:meta])* $variant:ident: $name:literal, $quantity:ident, $label:literal, [$($alias:literal),*];)+) => {
        /// A column of a time-series file.
        ///
        /// Force and moment act ON the target. World axes unless the name says `Body`: body axes
        /// are the heading axes at the centre of gravity (ISO 8855: x forward, y left).
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        pub enum Channel {
            $($(#[$doc])* $variant,)+
        }

        impl Channel {
            /// Every channel, in the order in which files are written.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// The header in our own files, with the SI unit at its end.
            pub fn header(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// The header without its unit: what `--map` and messages call the channel.
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

            /// What it measures.
            pub fn quantity(self) -> Quantity {
                match self { $(Self::$variant => Quantity::$quantity),+ }
            }

            /// What a plot or a table calls it, without unit.
            pub fn label(self) -> &'static str {
                match self { $(Self::$variant => $label),+ }
            }

            /// Spellings of other programs, in lower-case letters and digits only, without unit.
            pub fn aliases(self) -> &'static [&'static str] {
                match self { $(Self::$variant => &[$($alias),*]),+ }
            }
        }
    };
}

channels! {
    /// Time.
    Time: "time_s", Time, "Time", ["time", "t", "zeit", "temps", "tiempo"];
    /// Position along the road.
    X: "x_m", Length, "X", ["x", "xpos", "posx", "positionx", "xposition", "xm", "xworld", "easting", "xg"];
    /// Position to the left of the road.
    Y: "y_m", Length, "Y", ["y", "ypos", "posy", "positiony", "yposition", "ym", "yworld", "northing", "yg"];
    /// Yaw ψ, counter-clockwise.
    Yaw: "yaw_rad", Angle, "Yaw ψ", ["yaw", "yawangle", "psi", "heading", "headingangle", "gierwinkel"];
    /// Roll φ about the forward axis.
    Roll: "roll_rad", Angle, "Roll φ", ["roll", "rollangle", "phi", "wankwinkel"];
    /// Forward velocity of the centre of gravity.
    Vx: "vx_m_s", Speed, "v_x", ["vx", "vxbody", "velx", "velocityx", "longitudinalvelocity", "speedx"];
    /// Leftward velocity of the centre of gravity.
    Vy: "vy_m_s", Speed, "v_y", ["vy", "vybody", "vely", "velocityy", "lateralvelocity", "speedy"];
    /// Yaw rate r.
    YawRate: "yaw_rate_rad_s", AngularVelocity, "Yaw rate r", ["yawrate", "r", "psidot", "wz", "omegaz", "gyroz", "gierrate"];
    /// Roll rate.
    RollRate: "roll_rate_rad_s", AngularVelocity, "Roll rate", ["rollrate", "p", "phidot", "wx", "omegax", "gyrox"];
    /// Forward acceleration.
    Ax: "ax_m_s2", Acceleration, "a_x", ["ax", "accx", "accelx", "accelerationx", "longitudinalacceleration"];
    /// Leftward acceleration.
    Ay: "ay_m_s2", Acceleration, "a_y", ["ay", "accy", "accely", "accelerationy", "lateralacceleration"];
    /// Contact force along the world X axis.
    Fx: "fx_n", Force, "F_x", ["fx", "forcex", "xforce", "contactforcex", "fxworld", "kraftx"];
    /// Contact force along the world Y axis.
    Fy: "fy_n", Force, "F_y", ["fy", "forcey", "yforce", "contactforcey", "fyworld", "krafty"];
    /// Contact force along the heading.
    FxBody: "fx_body_n", Force, "F_x body", ["fxbody", "fxheading", "fxlocal"];
    /// Contact force to the left of the heading.
    FyBody: "fy_body_n", Force, "F_y body", ["fybody", "fyheading", "fylocal"];
    /// Yaw moment of the contact force about the centre of gravity.
    Mz: "mz_nm", Moment, "M_z", ["mz", "yawmoment", "momentz", "zmoment"];
    /// Roll moment of the contact force about the centre of gravity.
    Mx: "mx_nm", Moment, "M_x", ["mx", "rollmoment", "momentx", "xmoment"];
    /// Road-wheel angle of the front axle.
    Steer: "steer_rad", Angle, "Steer δ", ["steer", "steerangle", "delta", "roadwheelangle", "lenkwinkel"];
    /// Road-wheel angle, front left.
    SteerFl: "steer_fl_rad", Angle, "Steer FL", ["steerfl", "deltafl"];
    /// Road-wheel angle, front right.
    SteerFr: "steer_fr_rad", Angle, "Steer FR", ["steerfr", "deltafr"];
    /// Vertical load, front left.
    FzFl: "fz_fl_n", Force, "F_z FL", ["fzfl"];
    /// Vertical load, front right.
    FzFr: "fz_fr_n", Force, "F_z FR", ["fzfr"];
    /// Vertical load, rear left.
    FzRl: "fz_rl_n", Force, "F_z RL", ["fzrl"];
    /// Vertical load, rear right.
    FzRr: "fz_rr_n", Force, "F_z RR", ["fzrr"];
    /// Target's velocity along world X.
    TargetVx: "target_vx_m_s", Speed, "Target v_x", ["targetvx"];
    /// Target's velocity along world Y.
    TargetVy: "target_vy_m_s", Speed, "Target v_y", ["targetvy"];
    /// Target's yaw rate.
    TargetYawRate: "target_yaw_rate_rad_s", AngularVelocity, "Target yaw rate", ["targetyawrate"];
    /// Target's yaw.
    TargetYaw: "target_yaw_rad", Angle, "Target yaw", ["targetyaw"];
    /// Bullet's velocity along world X.
    BulletVx: "bullet_vx_m_s", Speed, "Bullet v_x", ["bulletvx"];
    /// Bullet's velocity along world Y.
    BulletVy: "bullet_vy_m_s", Speed, "Bullet v_y", ["bulletvy"];
    /// Bullet's yaw rate.
    BulletYawRate: "bullet_yaw_rate_rad_s", AngularVelocity, "Bullet yaw rate", ["bulletyawrate"];
    /// Bullet's yaw.
    BulletYaw: "bullet_yaw_rad", Angle, "Bullet yaw", ["bulletyaw"];
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
