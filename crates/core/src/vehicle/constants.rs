//! What the equations of motion need of a vehicle, prepared once for all their evaluations: of one
//! vehicle, or of several side by side, each in a lane of its own.

use pulp::Simd;

use crate::numerics::{Lanes, LanesOver, MAX_LANES, Packed};
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::loads::static_axle_loads_n;
use crate::vehicle::tire::TireParameters;
use crate::vehicle::{Equations, VehicleParameters};

/// Constants of type `P`: `f64` for one vehicle, [`Packed`] for several.
macro_rules! constants {
    ($(#[$of_struct:meta])* $name:ident { $($(#[$of_field:meta])* $field:ident),+ $(,)? }) => {
        $(#[$of_struct])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub(super) struct $name<P> {
            $($(#[$of_field])* pub(super) $field: P),+
        }

        impl $name<f64> {
            /// - `constants`: of a lane.
            fn packed<'a, S: Simd>(
                simd: S,
                constants: &impl Fn(usize) -> &'a Self,
            ) -> $name<Packed<S>> {
                let pack = |field: fn(&Self) -> f64| -> Packed<S> {
                    let values: [f64; MAX_LANES] = std::array::from_fn(|lane| field(constants(lane)));
                    Packed::new(simd, &values)
                };
                $name { $($field: pack(|constants| constants.$field)),+ }
            }
        }

        impl<P: Copy> $name<P> {
            /// The same constants as numbers of another type.
            ///
            /// - `convert`: to a number of this type, whose value does not matter.
            #[inline(always)]
            #[allow(dead_code, reason = "not all constants are converted")]
            pub(super) fn along<T: Lanes + LanesOver<P>, U>(
                &self,
                number: T,
                convert: impl Fn(T) -> U,
            ) -> $name<U> {
                let zero = number.constant(0.0);
                $name { $($field: convert(zero + self.$field)),+ }
            }
        }
    };
}

constants! {
    /// Constants of the body and of its roll.
    BodyConstants {
        /// 1/m, 1/kg.
        per_mass_1_kg,
        /// m/2, kg.
        half_mass_kg,
        /// I_zz/2, kg m².
        half_yaw_inertia_kg_m2,
        /// Weight m g, N.
        weight_n,
        /// Moment of the weight about the rear axle, m g l_r, N m.
        weight_about_rear_n_m,
        /// 1/(l_f + l_r), 1/m.
        per_wheelbase_1_m,
        /// Share of the front axle in the roll stiffness over the track width, 1/m.
        front_shift_1_m,
        /// The same of the rear axle, 1/m.
        rear_shift_1_m,
        /// Vertical load of a front wheel at rest, N.
        front_static_n,
        /// Vertical load of a rear wheel at rest, N.
        rear_static_n,
        /// l_f, m.
        front_x_m,
        /// −l_r, m.
        rear_x_m,
        /// Half of the track width, m.
        half_track_m,
        /// h_cog, m.
        cg_height_m,
        /// Height of the roll axis, m.
        roll_axis_height_m,
        /// m_s g h, N m.
        weight_moment_n_m,
        /// m_s h, kg m.
        sprung_moment_kg_m,
        /// K_φ, N m/rad.
        roll_stiffness_n_m_rad,
        /// B, N m s/rad.
        roll_damping_n_m_s_rad,
        /// I_xx/(I_zz I_xx − I_xz²), 1/(kg m²).
        yaw_by_yaw,
        /// I_xz/(I_zz I_xx − I_xz²), 1/(kg m²).
        yaw_by_roll,
        /// I_zz/(I_zz I_xx − I_xz²), 1/(kg m²).
        roll_by_roll,
    }
}

constants! {
    /// Constants of the tires; see [`TireParameters`].
    TireConstants {
        /// C = c/μ of the front tires, 1/rad.
        front_stiffness_1_rad,
        /// C = c/μ of the rear tires, 1/rad.
        rear_stiffness_1_rad,
        /// μ.
        friction,
        /// 1 − sliding friction over peak friction.
        sliding_loss,
        /// μ_s across the wheel.
        sliding_friction,
        /// κ.
        longitudinal_ratio,
        /// 1/κ.
        per_longitudinal_ratio,
        /// f_r0.
        rolling_resistance,
        /// f_r1, s/m.
        rolling_resistance_s_m,
        /// f_r2, s²/m².
        rolling_resistance_s2_m2,
        /// m_w, kg.
        wheel_mass_kg,
    }
}

constants! {
    /// Constants that only the equations as the paper prints them have.
    PrintedConstants {
        /// I_zz, kg m².
        yaw_inertia_kg_m2,
        /// I_xx, kg m².
        roll_inertia_kg_m2,
        /// I_xz, kg m².
        roll_yaw_product_kg_m2,
        /// m h_cog/(2 (l_f + l_r)), kg.
        pitch_kg,
        /// m h_cog/w, kg.
        lateral_kg,
        /// 1/w, 1/m.
        per_track_1_m,
        /// Share of the front axle in the cornering stiffness.
        front_share,
        /// 1 − that share.
        rear_share,
    }
}

/// What the equations of motion need of a vehicle. The numbers are of type `P`: `f64` for one vehicle,
/// [`Packed`] for one in each lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleConstants<P> {
    pub(super) equations: Equations,
    pub(super) body: BodyConstants<P>,
    pub(super) tires: TireConstants<P>,
    pub(super) printed: PrintedConstants<P>,
    /// Acceleration `[g_X, g_Y]` by the weight along the road in world axes, m/s²; `None` where the road
    /// is level in every lane.
    pub(super) slope_m_s2: Option<[P; 2]>,
}

impl TireParameters {
    /// The constants of the tires.
    pub(super) fn constants(&self) -> TireConstants<f64> {
        TireConstants {
            front_stiffness_1_rad: self.cornering_coefficient_front_per_rad / self.friction,
            rear_stiffness_1_rad: self.cornering_coefficient_rear_per_rad / self.friction,
            friction: self.friction,
            // A sliding friction above the peak would be none.
            sliding_loss: (1.0 - self.sliding_friction_ratio).max(0.0),
            sliding_friction: self.friction * self.sliding_friction_ratio,
            longitudinal_ratio: self.longitudinal_friction_ratio,
            per_longitudinal_ratio: 1.0 / self.longitudinal_friction_ratio,
            rolling_resistance: self.rolling_resistance,
            rolling_resistance_s_m: self.rolling_resistance_s_m,
            rolling_resistance_s2_m2: self.rolling_resistance_s2_m2,
            wheel_mass_kg: self.wheel_mass_kg(),
        }
    }
}

impl VehicleParameters {
    /// What the equations of motion need of the vehicle, in the form that
    /// [`VehicleParameters::equations`] selects.
    pub fn constants(&self) -> VehicleConstants<f64> {
        VehicleConstants {
            equations: self.equations,
            body: self.body_constants(),
            tires: self.tires.constants(),
            printed: self.printed_constants(),
            slope_m_s2: (!self.slope.is_level()).then(|| self.slope.gravity_m_s2()),
        }
    }

    fn body_constants(&self) -> BodyConstants<f64> {
        let Self { mass, geometry, suspension, .. } = self;
        let weight_n = mass.mass_kg * STANDARD_GRAVITY_M_S2 * self.slope.normal_share();
        let sprung_moment_kg_m = mass.sprung_mass_kg * suspension.roll_arm_m;
        let (izz, ixx) = (mass.yaw_inertia_kg_m2, mass.roll_inertia_kg_m2);
        let ixz = mass.roll_yaw_product_kg_m2;
        let determinant = izz * ixx - ixz * ixz; // > 0: checked with the parameters
        let share = suspension.front_roll_stiffness_share;
        let [front_static_n, rear_static_n] = static_axle_loads_n(self).map(|load| load / 2.0);
        BodyConstants {
            per_mass_1_kg: 1.0 / mass.mass_kg,
            half_mass_kg: mass.mass_kg / 2.0,
            half_yaw_inertia_kg_m2: izz / 2.0,
            weight_n,
            weight_about_rear_n_m: weight_n * geometry.cg_to_rear_axle_m,
            per_wheelbase_1_m: 1.0 / geometry.wheelbase_m(),
            front_shift_1_m: share / geometry.track_width_m,
            rear_shift_1_m: (1.0 - share) / geometry.track_width_m,
            front_static_n,
            rear_static_n,
            front_x_m: geometry.cg_to_front_axle_m,
            rear_x_m: -geometry.cg_to_rear_axle_m,
            half_track_m: geometry.track_width_m / 2.0,
            cg_height_m: geometry.cg_height_m,
            roll_axis_height_m: suspension.roll_axis_height_m,
            weight_moment_n_m: sprung_moment_kg_m * STANDARD_GRAVITY_M_S2,
            sprung_moment_kg_m,
            roll_stiffness_n_m_rad: suspension.roll_stiffness_n_m_rad,
            roll_damping_n_m_s_rad: suspension.roll_damping_n_m_s_rad,
            yaw_by_yaw: ixx / determinant,
            yaw_by_roll: ixz / determinant,
            roll_by_roll: izz / determinant,
        }
    }

    fn printed_constants(&self) -> PrintedConstants<f64> {
        let Self { mass, geometry, tires, .. } = self;
        let front = tires.cornering_coefficient_front_per_rad * geometry.cg_to_rear_axle_m;
        let rear = tires.cornering_coefficient_rear_per_rad * geometry.cg_to_front_axle_m;
        let front_share = front / (front + rear);
        let mass_times_height = mass.mass_kg * geometry.cg_height_m;
        PrintedConstants {
            yaw_inertia_kg_m2: mass.yaw_inertia_kg_m2,
            roll_inertia_kg_m2: mass.roll_inertia_kg_m2,
            roll_yaw_product_kg_m2: mass.roll_yaw_product_kg_m2,
            pitch_kg: mass_times_height / (2.0 * geometry.wheelbase_m()),
            lateral_kg: mass_times_height / geometry.track_width_m,
            per_track_1_m: 1.0 / geometry.track_width_m,
            front_share,
            rear_share: 1.0 - front_share,
        }
    }
}

impl VehicleConstants<f64> {
    /// Several vehicles side by side, one in each lane. All have the same form of the equations.
    ///
    /// - `vehicle`: the constants of a lane, for lanes from 0 to [`MAX_LANES`] − 1.
    pub fn packed<'a, S: Simd>(
        simd: S,
        vehicle: impl Fn(usize) -> &'a Self,
    ) -> VehicleConstants<Packed<S>> {
        let slope = |lane: usize| vehicle(lane).slope_m_s2;
        let is_sloped = (0..MAX_LANES).any(|lane| slope(lane).is_some());
        let along = |axis: usize| -> Packed<S> {
            let values: [f64; MAX_LANES] =
                std::array::from_fn(|lane| slope(lane).map_or(0.0, |slope| slope[axis]));
            Packed::new(simd, &values)
        };
        VehicleConstants {
            equations: vehicle(0).equations,
            body: BodyConstants::packed(simd, &|lane| &vehicle(lane).body),
            tires: TireConstants::packed(simd, &|lane| &vehicle(lane).tires),
            printed: PrintedConstants::packed(simd, &|lane| &vehicle(lane).printed),
            slope_m_s2: is_sloped.then(|| [along(0), along(1)]),
        }
    }
}
