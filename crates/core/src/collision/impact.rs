//! Planar impact of two rigid bodies: impulse, velocities after the impact and dissipated energy.
//!
//! Source: [`PitPinnPaper`](crate::bibliography::PitPinnPaper), `eq:collision_model1` to
//! `eq:friction_coefficient2`, with the planar impact mechanics of
//! [`Brach2011`](crate::bibliography::Brach2011): a solution without sliding and a friction limit.
//! For e = 0 this solution is also that of
//! [`CarpenterWelcher2019`](crate::bibliography::CarpenterWelcher2019). With restitution theirs is
//! another one, which is selectable; see [`RestitutionForm`].
//!
//! Assumptions: the impact is instantaneous, so neither vehicle moves or turns during it; the force
//! acts at one contact point and has no moment about it; tire forces are negligible beside the
//! contact force.
//!
//! Departures from the paper:
//! 1. The two yaw equations of the paper have the same sign, which violates the conservation of
//!    angular momentum. Here `I Δr = r × P` with the impulse that acts on each vehicle.
//! 2. In the paper the vehicles always slide, `P_τ = ±μ P_n`. Here they slide only if the solution
//!    without sliding needs a larger impulse ratio than the friction limit
//!    ([`FrictionModel::Limit`]). The form of the paper is [`FrictionModel::Paper`].
//! 3. Restitution refers to the normal velocities of the contact points. The paper does not say
//!    which velocities are meant.
//! 4. With [`FrictionModel::Limit`] kinetic energy never grows: [`RestitutionForm::Normal`] needs
//!    [`Regime::EnergyLimited`] for this, [`RestitutionForm::CommonVelocity`] nothing.
//!
//! Validated in `tests/library/validation_collision.rs` against the published worked example and
//! against finite-element runs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::collision::PrincipalDirectionOfForce;
use crate::collision::contact_work_j;
use crate::collision::restitution_line::RestitutionLine;
use crate::numerics::Scalar;

/// One of the two rigid bodies of an impact, with its motion before the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactBody<T = f64> {
    /// Mass, kg, positive.
    pub mass_kg: T,
    /// Yaw moment of inertia about the CG, kg m², positive.
    pub yaw_inertia_kg_m2: T,
    /// Heading (yaw angle ψ) in world axes, rad. It is used only for the principal direction of
    /// force.
    pub heading_rad: f64,
    /// Velocity of the CG before the impact in world axes, m/s.
    pub velocity_world_m_s: [T; 2],
    /// Yaw rate before the impact, rad/s.
    pub yaw_rate_rad_s: T,
    /// Vector from the CG to the contact point in world axes, m.
    pub contact_arm_world_m: [T; 2],
}

/// Model of friction at the contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FrictionModel {
    /// The contact points do not slide at the end of the contact, unless that needs `|P_τ| > μ_c
    /// P_n`; in that case they slide with `|P_τ| = μ_c P_n`.
    #[default]
    Limit,
    /// The model of the paper, for comparison: the contact points always slide, `P_τ = ±μ_c P_n`.
    /// The paper gives no rule for the sign; here it is that of [`FrictionModel::Limit`]. In this
    /// model friction may reverse the direction of sliding, which real friction can only stop, and
    /// kinetic energy may grow.
    Paper,
}

/// Meaning of the coefficient of restitution e at the contact.
///
/// With the relative velocity `(v_n, v_τ)` of the contact points before and `(v_n', v_τ')` after the
/// impact, and the inverse mass matrix K of [`Impact::inverse_mass_1_kg`]:
///
/// ```text
/// normal            v_n' = −e v_n      and without sliding v_τ' = 0
/// common velocity   P = (1 + e) P_c    P_c: impulse up to the common normal velocity, v_n = 0;
///                                      without sliding v_τ = 0 there too, so P_c = K⁻¹ v, v' = −e v
/// ```
///
/// Both give `v_n' = −e v_n`. They agree for e = 0, and while the contact points slide to the same
/// side, since then `P_τ = ±μ_c P_n` in both. Without sliding they agree for e = 0 alone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RestitutionForm {
    /// Restitution acts on the normal component alone (Newton's hypothesis). Source:
    /// [`Brach2011`](crate::bibliography::Brach2011), planar impact mechanics.
    #[default]
    Normal,
    /// Restitution acts on both components from the point of common velocity: the impulse of the
    /// restitution is the share e of that of the compression (Poisson's hypothesis). Kinetic energy
    /// cannot grow. Source: [`Kudlich1966`](crate::bibliography::Kudlich1966),
    /// [`Slibar1966`](crate::bibliography::Slibar1966);
    /// [`CarpenterWelcher2019`](crate::bibliography::CarpenterWelcher2019).
    CommonVelocity,
}

impl RestitutionForm {
    /// Both forms.
    pub const ALL: [Self; 2] = [Self::Normal, Self::CommonVelocity];

    /// Name of the form in scenario files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::CommonVelocity => "common_velocity",
        }
    }

    /// Description of the form in reports and choices.
    pub fn label(self) -> &'static str {
        match self {
            Self::Normal => "on the normal component",
            Self::CommonVelocity => "from the common velocity",
        }
    }
}

/// The contact surface between the two vehicles: its direction, restitution and friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSurface<T = f64> {
    /// Angle Γ of the contact normal in world axes, rad. The normal points INTO the struck vehicle,
    /// which is the direction in which the striking vehicle pushes.
    pub normal_angle_world_rad: T,
    /// Coefficient of restitution e, 0 to 1.
    pub restitution: T,
    /// Meaning of the coefficient of restitution.
    pub restitution_form: RestitutionForm,
    /// Friction limit μ_c, the largest impulse ratio `|P_τ| / P_n`, 0 or more.
    pub friction_limit: T,
    /// Friction model.
    pub friction_model: FrictionModel,
}

/// A planar impact of two rigid bodies at one contact point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact<T = f64> {
    /// The vehicle that is struck. Impulses are those that act ON this vehicle.
    pub struck: ImpactBody<T>,
    /// The vehicle that strikes.
    pub striking: ImpactBody<T>,
    /// The contact surface.
    pub surface: ContactSurface<T>,
}

/// State of the contact at its end, which determines the tangential impulse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Regime {
    /// The contact points have the same tangential velocity at the end of the contact.
    NoSlide,
    /// The contact points reach the same velocity, normal and tangential, and part from it with the
    /// share e of their velocity before ([`RestitutionForm::CommonVelocity`]).
    CommonVelocity,
    /// The contact points slide along each other throughout: `|P_τ| = μ_c P_n`.
    Sliding,
    /// The tangential impulse is limited to the largest value that creates no kinetic energy. This
    /// occurs only for large restitution together with long lever arms.
    EnergyLimited,
    /// The contact points do not approach each other along the normal, so there is no impulse.
    NotApproaching,
}

impl Regime {
    /// Description of the regime in reports and tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::NoSlide => "no sliding at the end",
            Self::CommonVelocity => "common velocity, no sliding",
            Self::Sliding => "sliding throughout",
            Self::EnergyLimited => "friction limited by energy",
            Self::NotApproaching => "not approaching: no impact",
        }
    }
}

/// Motion of one vehicle after the impact, and its change by the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyAfter<T = f64> {
    /// Velocity of the CG after the impact in world axes, m/s.
    pub velocity_world_m_s: [T; 2],
    /// Yaw rate after the impact, rad/s.
    pub yaw_rate_rad_s: T,
    /// Change Δv of the velocity of the CG in world axes, m/s.
    pub delta_v_world_m_s: [T; 2],
    /// Change of the yaw rate, rad/s.
    pub delta_yaw_rate_rad_s: T,
    /// Principal direction of force on this vehicle; `None` if there is no impulse.
    pub pdof: Option<PrincipalDirectionOfForce>,
}

/// Solution of an impact: the impulse and the quantities that follow from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactSolution<T = f64> {
    /// Impulse on the struck vehicle in world axes, N s.
    pub impulse_world_n_s: [T; 2],
    /// Component `P_n` of the impulse along the contact normal, N s, never negative.
    pub impulse_normal_n_s: T,
    /// Component `P_τ` of the impulse along the tangent, N s. The tangent is the normal turned by
    /// 90° counter-clockwise.
    pub impulse_tangential_n_s: T,
    /// State of the contact at its end.
    pub regime: Regime,
    /// Velocity of the contact point of the striking vehicle relative to that of the struck vehicle
    /// before the impact, `[normal, tangential]`, m/s. The normal component is positive if the
    /// points approach each other.
    pub closing_velocity_m_s: [T; 2],
    /// Motion of the struck vehicle after the impact.
    pub struck: BodyAfter<T>,
    /// Motion of the striking vehicle after the impact.
    pub striking: BodyAfter<T>,
    /// Kinetic energy of both vehicles that the impact dissipates, J.
    pub dissipated_energy_j: T,
}

/// Reason why an impact cannot be solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImpactError {
    /// An input is out of range or not finite.
    #[error("{part}: {name} is {value}, expected {expected}")]
    Range {
        /// The part of the impact to which the input belongs: struck vehicle, striking vehicle or
        /// contact.
        part: &'static str,
        /// Name of the input.
        name: &'static str,
        /// Value of the input, in the unit that ends its name.
        value: f64,
        /// Description of the permitted range.
        expected: &'static str,
    },
    /// [`FrictionModel::Paper`] has no solution with a positive normal impulse.
    #[error("always sliding at impulse ratio {friction_limit} has no solution: the contact jams")]
    Jammed {
        /// Friction limit μ_c.
        friction_limit: f64,
    },
}

impl<T: Scalar> Impact<T> {
    /// Inverse mass matrix K at the contact point in world axes, 1/kg, `[2, 2]`. It gives the
    /// change of the relative velocity of the contact points: `Δv_rel = −K P`.
    ///
    /// ```text
    /// K = (1/m_t + 1/m_b) 1 + r_t⊥ r_t⊥ᵀ / I_t + r_b⊥ r_b⊥ᵀ / I_b      r⊥ = (−r_y, r_x)
    /// ```
    ///
    /// The matrix is symmetric and positive definite.
    pub fn inverse_mass_1_kg(&self) -> [[T; 2]; 2] {
        let central = self.struck.mass_kg.recip() + self.striking.mass_kg.recip();
        let mut k = [[central, T::from(0.0)], [T::from(0.0), central]];
        for body in [&self.struck, &self.striking] {
            let lever = perpendicular(body.contact_arm_world_m);
            for (row, a) in k.iter_mut().zip(lever) {
                for (entry, b) in row.iter_mut().zip(lever) {
                    *entry += a * b / body.yaw_inertia_kg_m2;
                }
            }
        }
        k
    }

    /// Velocity of the contact point of the striking vehicle relative to that of the struck vehicle
    /// before the impact, in world axes, m/s.
    pub fn relative_velocity_m_s(&self) -> [T; 2] {
        let [tx, ty] = self.struck.contact_velocity_m_s();
        let [bx, by] = self.striking.contact_velocity_m_s();
        [bx - tx, by - ty]
    }

    /// The same along the normal, positive if the points approach each other, and along the tangent
    /// of the contact surface, m/s.
    pub fn closing_velocity_m_s(&self) -> [T; 2] {
        let (normal, v) = (self.surface.normal(), self.relative_velocity_m_s());
        [dot(v, normal), dot(v, perpendicular(normal))]
    }

    /// Speed at which the contact points move relative to each other, in all directions, m/s.
    pub fn closing_speed_m_s(&self) -> T {
        let [x, y] = self.relative_velocity_m_s();
        (x.squared() + y.squared()).sqrt()
    }

    /// Solves the impact without a check of its inputs, which have to be in range; see
    /// [`Impact::solve`] for a solution with a check.
    ///
    /// With the normal n, the tangent τ and the closing velocity (v_n, v_τ), the condition of
    /// restitution `v_n' = −e v_n` holds on the line `K_nn P_n + K_nτ P_τ = (1 + e) v_n` in the
    /// plane of the impulse components. Three points on this line are of interest:
    ///
    /// ```text
    /// no slide      P_τ = (v_τ − K_nτ/K_nn (1 + e) v_n) / S         S = K_ττ − K_nτ²/K_nn
    /// sliding       P_τ = s μ_c P_n
    /// energy        ΔE = ½ (1 − e²) v_n²/K_nn + (v_τ − K_nτ/K_nn v_n) P_τ − ½ S P_τ² = 0
    /// ```
    ///
    /// The solution is the one of them that is nearest to the frictionless point `P_τ = 0`; with
    /// [`FrictionModel::Paper`] it is always the point of sliding. The sign s is that of `P_τ`
    /// without sliding. It is also the sign of the sliding velocity that would remain without
    /// friction. Friction therefore opposes the sliding that remains at the end, also if the lever
    /// arms reverse the initial sliding. On the way from the frictionless point to the no-slide
    /// point, the ratio `|P_τ|/P_n` grows from zero while `P_n` is positive. If the no-slide point
    /// violates the friction limit, the ratio thus reaches μ_c before, and a solution with sliding
    /// exists.
    ///
    /// With [`RestitutionForm::CommonVelocity`] the impulse is (1 + e) times this solution for e = 0,
    /// which is the impulse of the compression.
    ///
    /// If the contact points do not approach each other, the impulse is zero.
    ///
    /// # Errors
    /// [`ImpactError::Jammed`], only with [`FrictionModel::Paper`].
    pub fn solve_unchecked(&self) -> Result<ImpactSolution<T>, ImpactError> {
        let closing = self.closing_velocity_m_s();
        if closing[0].re() <= 0.0 {
            let zero = T::from(0.0);
            return Ok(self.apply([zero, zero], closing, Regime::NotApproaching));
        }
        let line = RestitutionLine::new(self);
        let (p_t, regime) = line.tangential_impulse_n_s(&self.surface)?;
        let p = [line.normal_impulse_n_s(p_t), p_t];
        let (p, regime) = match self.surface.restitution_form {
            RestitutionForm::Normal => (p, regime),
            RestitutionForm::CommonVelocity => {
                let regime = match regime {
                    Regime::NoSlide => Regime::CommonVelocity,
                    other => other,
                };
                (p.map(|p| p * (self.surface.restitution + 1.0)), regime)
            }
        };
        Ok(self.apply(p, closing, regime))
    }

    /// The critical impulse ratio: `|P_τ| / P_n` of the solution without sliding, the smallest
    /// friction limit with which the contact points do not slide. With [`RestitutionForm::Normal`]
    /// it depends on e, with [`RestitutionForm::CommonVelocity`] it does not.
    ///
    /// Source: [`Brach2011`](crate::bibliography::Brach2011), who gives the impulse ratio of an
    /// impact as a percentage of it.
    ///
    /// Returns `None` if the contact points do not approach each other, or if they slide whatever
    /// the friction, since the solution without sliding would need a pull along the normal.
    pub fn critical_impulse_ratio(&self) -> Option<T> {
        let line = RestitutionLine::new(self);
        let p_t = line.no_slide_impulse_n_s();
        let p_n = line.normal_impulse_n_s(p_t);
        (self.closing_velocity_m_s()[0].re() > 0.0 && p_n.re() > 0.0).then(|| (p_t / p_n).abs())
    }

    /// The solution that follows from an impulse on the struck vehicle with the components `[P_n,
    /// P_τ]`, N s.
    fn apply(&self, [p_n, p_t]: [T; 2], closing: [T; 2], regime: Regime) -> ImpactSolution<T> {
        let normal = self.surface.normal();
        let tangent = perpendicular(normal);
        let p = [normal[0] * p_n + tangent[0] * p_t, normal[1] * p_n + tangent[1] * p_t];
        ImpactSolution {
            impulse_world_n_s: p,
            impulse_normal_n_s: p_n,
            impulse_tangential_n_s: p_t,
            regime,
            closing_velocity_m_s: closing,
            struck: self.struck.after(p),
            striking: self.striking.after([-p[0], -p[1]]),
            dissipated_energy_j: contact_work_j(
                self.relative_velocity_m_s(),
                self.inverse_mass_1_kg(),
                p,
            ),
        }
    }
}

impl Impact<f64> {
    /// Checks the inputs and solves the impact. The equations are given at
    /// [`Impact::solve_unchecked`].
    ///
    /// # Errors
    /// [`ImpactError::Range`] names the first input that is out of range; [`ImpactError::Jammed`]
    /// if [`FrictionModel::Paper`] has no solution.
    pub fn solve(&self) -> Result<ImpactSolution, ImpactError> {
        for (body, part) in [(&self.struck, "target"), (&self.striking, "bullet")] {
            let [vx, vy] = body.velocity_world_m_s;
            let [rx, ry] = body.contact_arm_world_m;
            let inertia = body.yaw_inertia_kg_m2;
            check(part, "mass_kg", body.mass_kg, Expected::Positive)?;
            check(part, "yaw_inertia_kg_m2", inertia, Expected::Positive)?;
            check(part, "heading_rad", body.heading_rad, Expected::Finite)?;
            check(part, "velocity_m_s[0]", vx, Expected::Finite)?;
            check(part, "velocity_m_s[1]", vy, Expected::Finite)?;
            check(part, "yaw_rate_rad_s", body.yaw_rate_rad_s, Expected::Finite)?;
            check(part, "contact_arm_m[0]", rx, Expected::Finite)?;
            check(part, "contact_arm_m[1]", ry, Expected::Finite)?;
        }
        let (s, part) = (&self.surface, "contact");
        check(part, "normal_angle_rad", s.normal_angle_world_rad, Expected::Finite)?;
        check(part, "restitution", s.restitution, Expected::Share)?;
        check(part, "friction_limit", s.friction_limit, Expected::NotNegative)?;
        self.solve_unchecked()
    }
}

impl<T: Scalar> ImpactBody<T> {
    /// Velocity of the contact point as a point of this body, in world axes, m/s: `v + r × arm`,
    /// with the yaw rate r.
    pub fn contact_velocity_m_s(&self) -> [T; 2] {
        let lever = perpendicular(self.contact_arm_world_m);
        [0, 1].map(|i| self.velocity_world_m_s[i] + lever[i] * self.yaw_rate_rad_s)
    }

    /// Kinetic energy of the body before the impact, `½ m v² + ½ I r²`, J.
    pub fn kinetic_energy_j(&self) -> T {
        let translation = self.mass_kg * dot(self.velocity_world_m_s, self.velocity_world_m_s);
        (translation + self.yaw_inertia_kg_m2 * self.yaw_rate_rad_s.squared()) * 0.5
    }

    fn after(&self, impulse: [T; 2]) -> BodyAfter<T> {
        let delta_v_world_m_s = impulse.map(|p| p / self.mass_kg);
        let moment = dot(perpendicular(self.contact_arm_world_m), impulse);
        let delta_yaw_rate_rad_s = moment / self.yaw_inertia_kg_m2;
        BodyAfter {
            velocity_world_m_s: [0, 1].map(|i| self.velocity_world_m_s[i] + delta_v_world_m_s[i]),
            yaw_rate_rad_s: self.yaw_rate_rad_s + delta_yaw_rate_rad_s,
            delta_v_world_m_s,
            delta_yaw_rate_rad_s,
            pdof: PrincipalDirectionOfForce::from_impulse(
                impulse.map(|p| p.re()),
                self.heading_rad,
            ),
        }
    }
}

impl<T: Scalar> ContactSurface<T> {
    pub(super) fn normal(&self) -> [T; 2] {
        let (sin, cos) = self.normal_angle_world_rad.sin_cos();
        [cos, sin]
    }
}

#[derive(Clone, Copy)]
enum Expected {
    Finite,
    Positive,
    NotNegative,
    Share,
}

fn check(
    part: &'static str,
    name: &'static str,
    value: f64,
    expected: Expected,
) -> Result<(), ImpactError> {
    let (in_range, expected) = match expected {
        Expected::Finite => (true, "a finite number"),
        Expected::Positive => (value > 0.0, "more than 0"),
        Expected::NotNegative => (value >= 0.0, "0 or more"),
        Expected::Share => ((0.0..=1.0).contains(&value), "0 to 1"),
    };
    if value.is_finite() && in_range {
        return Ok(());
    }
    Err(ImpactError::Range { part, name, value, expected })
}

/// The vector turned by 90° counter-clockwise.
pub(super) fn perpendicular<T: Scalar>([x, y]: [T; 2]) -> [T; 2] {
    [-y, x]
}

pub(super) fn dot<T: Scalar>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn multiply<T: Scalar>(k: [[T; 2]; 2], p: [T; 2]) -> [T; 2] {
    [dot(k[0], p), dot(k[1], p)]
}
