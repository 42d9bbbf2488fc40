//! Planar impact of two rigid bodies: impulse, velocities after it, energy.
//!
//! Source: [`PitPinnPaper`](crate::bibliography::PitPinnPaper), `eq:collision_model1` to
//! `eq:friction_coefficient2`; the no-slide solution with a friction limit is that of
//! [`CarpenterWelcher2019`](crate::bibliography::CarpenterWelcher2019).
//!
//! Assumptions: the impact takes no time, so neither vehicle turns or moves during it; one contact
//! point; no moment at the contact; tyre forces are small beside the contact force.
//!
//! Departures from the paper:
//! 1. its two yaw equations carry the same sign, which breaks angular momentum; here
//!    `I Δr = r × P` with the impulse that acts on each vehicle;
//! 2. it always slides, `P_τ = ±μ P_n`; here the vehicles slide only if not sliding would need more
//!    friction than there is ([`FrictionModel::Limit`]). Its form is [`FrictionModel::Paper`];
//! 3. restitution is that of the contact points' normal velocities, where the paper leaves open
//!    whose velocity is meant;
//! 4. kinetic energy never grows ([`Regime::EnergyLimited`]).
//!
//! Validated in `tests/library/validation_collision.rs` against the published worked example and against
//! finite-element runs.

use serde::{Deserialize, Serialize};

use crate::collision::PrincipalDirectionOfForce;
use crate::numerics::Scalar;

/// A vehicle as the impact sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactBody<T = f64> {
    /// Mass, kg, positive.
    pub mass_kg: T,
    /// Yaw inertia about the CG, kg m², positive.
    pub yaw_inertia_kg_m2: T,
    /// Heading (yaw ψ), rad. Turns nothing but the force's direction as the occupants see it.
    pub heading_rad: f64,
    /// Velocity of the CG before the impact, world axes, m/s.
    pub velocity_m_s: [T; 2],
    /// Yaw rate before the impact, rad/s.
    pub yaw_rate_rad_s: T,
    /// From the CG to the contact point, world axes, m.
    pub contact_arm_m: [T; 2],
}

/// How friction at the contact is resolved.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionModel {
    /// No slide at the end of contact, unless that needs `|P_τ| > μ_c P_n`; then sliding.
    #[default]
    Limit,
    /// The paper's ablation: always sliding, `P_τ = ±μ_c P_n`, with the sign that
    /// [`FrictionModel::Limit`] would take (the paper gives none). Friction may reverse the sliding
    /// that it should only stop, and kinetic energy may grow.
    Paper,
}

/// The surface along which the two vehicles touch, and what it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSurface<T = f64> {
    /// Angle Γ of the normal in world axes, rad, pointing INTO the target: the way the bullet
    /// pushes it.
    pub normal_angle_rad: T,
    /// Coefficient of restitution e, 0 to 1.
    pub restitution: T,
    /// Largest impulse ratio μ_c = `|P_τ| / P_n`, 0 or more.
    pub friction_limit: T,
    /// How friction is resolved.
    pub friction_model: FrictionModel,
}

/// An impact to be solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact<T = f64> {
    /// The vehicle that is struck; the impulse acts ON it.
    pub target: ImpactBody<T>,
    /// The vehicle that strikes.
    pub bullet: ImpactBody<T>,
    /// Where they touch.
    pub surface: ContactSurface<T>,
}

/// How the contact ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Regime {
    /// The contact points share their tangential velocity at the end.
    NoSlide,
    /// They still slide: `|P_τ| = μ_c P_n`.
    Sliding,
    /// Friction is held at the most that creates no energy (only for large restitution together
    /// with long lever arms).
    EnergyLimited,
    /// The contact points do not approach along the normal: no impulse.
    NotApproaching,
}

impl Regime {
    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::NoSlide => "no sliding at the end",
            Self::Sliding => "sliding throughout",
            Self::EnergyLimited => "friction limited by energy",
            Self::NotApproaching => "not approaching: no impact",
        }
    }
}

/// What the impact did to one vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyAfter<T = f64> {
    /// Velocity of the CG after the impact, world axes, m/s.
    pub velocity_m_s: [T; 2],
    /// Yaw rate after the impact, rad/s.
    pub yaw_rate_rad_s: T,
    /// Change of the CG's velocity Δv, world axes, m/s.
    pub delta_v_m_s: [T; 2],
    /// Change of the yaw rate, rad/s.
    pub delta_yaw_rate_rad_s: T,
    /// Principal direction of force on this vehicle; `None` without an impulse.
    pub pdof: Option<PrincipalDirectionOfForce>,
}

/// The impulse of an impact and what follows from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactSolution<T = f64> {
    /// Impulse on the target, world axes, N s.
    pub impulse_n_s: [T; 2],
    /// Its normal part `P_n`, N s, never negative in [`FrictionModel::Limit`].
    pub impulse_normal_n_s: T,
    /// Its part `P_τ` along the tangent, which lies a quarter turn to the left of the normal, N s.
    pub impulse_tangential_n_s: T,
    /// How the contact ended.
    pub regime: Regime,
    /// Closing velocity of the contact points before the impact: along the normal (positive:
    /// approaching), along the tangent, m/s.
    pub closing_velocity_m_s: [T; 2],
    /// The target after the impact.
    pub target: BodyAfter<T>,
    /// The bullet after the impact.
    pub bullet: BodyAfter<T>,
    /// Kinetic energy lost, J.
    pub dissipated_energy_j: T,
}

/// An impact that cannot be solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ImpactError {
    /// An input outside its range.
    #[error("{of}: {name} is {value}, expected {expected}")]
    Range {
        /// Whose input: target, bullet or contact.
        of: &'static str,
        /// Which input.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// [`FrictionModel::Paper`] has no solution with a pushing normal impulse.
    #[error("always sliding at impulse ratio {friction_limit} has no solution: the contact jams")]
    Jammed {
        /// μ_c.
        friction_limit: f64,
    },
}

impl<T: Scalar> Impact<T> {
    /// Inverse mass at the contact point: `Δv_rel = −K P`, world axes, 1/kg.
    ///
    /// ```text
    /// K = (1/m_t + 1/m_b) 1 + r_t⊥ r_t⊥ᵀ / I_t + r_b⊥ r_b⊥ᵀ / I_b      r⊥ = (−r_y, r_x)
    /// ```
    ///
    /// Symmetric and positive definite.
    pub fn inverse_mass_1_kg(&self) -> [[T; 2]; 2] {
        let central = self.target.mass_kg.recip() + self.bullet.mass_kg.recip();
        let mut k = [[central, T::from(0.0)], [T::from(0.0), central]];
        for body in [&self.target, &self.bullet] {
            let lever = perpendicular(body.contact_arm_m);
            for (row, a) in k.iter_mut().zip(lever) {
                for (entry, b) in row.iter_mut().zip(lever) {
                    *entry += a * b / body.yaw_inertia_kg_m2;
                }
            }
        }
        k
    }

    /// Velocity of the bullet's contact point relative to the target's, world axes, m/s.
    pub fn relative_velocity_m_s(&self) -> [T; 2] {
        let [tx, ty] = self.target.contact_velocity_m_s();
        let [bx, by] = self.bullet.contact_velocity_m_s();
        [bx - tx, by - ty]
    }

    /// Solves the impact. For numbers that were checked: see [`Impact::solve`].
    ///
    /// With normal n, tangent τ and closing velocity (v_n, v_τ), restitution
    /// `v_n' = −e v_n` holds on the line `K_nn P_n + K_nτ P_τ = (1 + e) v_n`. On it lie
    ///
    /// ```text
    /// no slide      P_τ = (v_τ − K_nτ/K_nn (1 + e) v_n) / S         S = K_ττ − K_nτ²/K_nn
    /// sliding       P_τ = s μ_c P_n
    /// energy        ΔE = ½ (1 − e²) v_n²/K_nn + (v_τ − K_nτ/K_nn v_n) P_τ − ½ S P_τ² = 0
    /// ```
    ///
    /// and the nearest of the three to the frictionless point ends the contact. The sign s is that
    /// of the no-slide `P_τ`: it is also the sign of the sliding velocity that would be left
    /// without friction, so friction opposes the sliding that is left at the end, also when the
    /// lever arms turn the initial sliding round. Between the frictionless and the no-slide point
    /// `P_n` stays positive up to any `|P_τ|/P_n = μ_c`, so the sliding solution always exists.
    ///
    /// # Errors
    /// [`ImpactError::Jammed`], only for [`FrictionModel::Paper`].
    pub fn solve_unchecked(&self) -> Result<ImpactSolution<T>, ImpactError> {
        let normal = self.surface.normal();
        let tangent = perpendicular(normal);
        let (v, k) = (self.relative_velocity_m_s(), self.inverse_mass_1_kg());
        let closing = [dot(v, normal), dot(v, tangent)];
        if closing[0].re() <= 0.0 {
            let zero = T::from(0.0);
            return Ok(self.apply([zero, zero], closing, Regime::NotApproaching));
        }
        let (k_normal, k_tangent) = (multiply(k, normal), multiply(k, tangent));
        let line = RestitutionLine {
            k_nn: dot(normal, k_normal),
            k_nt: dot(normal, k_tangent),
            k_tt: dot(tangent, k_tangent),
            closing,
            restitution: self.surface.restitution,
        };
        let (p_t, regime) = line.tangential_impulse_n_s(&self.surface)?;
        Ok(self.apply([line.normal_impulse_n_s(p_t), p_t], closing, regime))
    }

    /// What an impulse given along normal and tangent does.
    fn apply(&self, [p_n, p_t]: [T; 2], closing: [T; 2], regime: Regime) -> ImpactSolution<T> {
        let normal = self.surface.normal();
        let tangent = perpendicular(normal);
        let p = [normal[0] * p_n + tangent[0] * p_t, normal[1] * p_n + tangent[1] * p_t];
        ImpactSolution {
            impulse_n_s: p,
            impulse_normal_n_s: p_n,
            impulse_tangential_n_s: p_t,
            regime,
            closing_velocity_m_s: closing,
            target: self.target.after(p),
            bullet: self.bullet.after([-p[0], -p[1]]),
            dissipated_energy_j: contact_work_j(
                self.relative_velocity_m_s(),
                self.inverse_mass_1_kg(),
                p,
            ),
        }
    }
}

impl Impact<f64> {
    /// Solves the impact after checking its numbers; the equations are at
    /// [`Impact::solve_unchecked`].
    ///
    /// # Errors
    /// [`ImpactError::Range`] names the first input outside its range; [`ImpactError::Jammed`].
    pub fn solve(&self) -> Result<ImpactSolution, ImpactError> {
        for (body, of) in [(&self.target, "target"), (&self.bullet, "bullet")] {
            let [vx, vy] = body.velocity_m_s;
            let [rx, ry] = body.contact_arm_m;
            let inertia = body.yaw_inertia_kg_m2;
            check(of, "mass_kg", body.mass_kg, Expected::Positive)?;
            check(of, "yaw_inertia_kg_m2", inertia, Expected::Positive)?;
            check(of, "heading_rad", body.heading_rad, Expected::Finite)?;
            check(of, "velocity_m_s[0]", vx, Expected::Finite)?;
            check(of, "velocity_m_s[1]", vy, Expected::Finite)?;
            check(of, "yaw_rate_rad_s", body.yaw_rate_rad_s, Expected::Finite)?;
            check(of, "contact_arm_m[0]", rx, Expected::Finite)?;
            check(of, "contact_arm_m[1]", ry, Expected::Finite)?;
        }
        let (s, of) = (&self.surface, "contact");
        check(of, "normal_angle_rad", s.normal_angle_rad, Expected::Finite)?;
        check(of, "restitution", s.restitution, Expected::Share)?;
        check(of, "friction_limit", s.friction_limit, Expected::NotNegative)?;
        self.solve_unchecked()
    }

    /// Restitution and impulse ratio that a known impulse stands for, e.g. a measured one: the
    /// inverse of [`Impact::solve`].
    ///
    /// ```text
    /// e = (K P)·n / v_n − 1          P_τ / P_n
    /// ```
    ///
    /// Of `surface`, only the normal is used. `None` if the contact points do not approach or the
    /// impulse does not push.
    pub fn implied_contact(&self, impulse_n_s: [f64; 2]) -> Option<ImpliedContact> {
        let normal = self.surface.normal();
        let closing = dot(self.relative_velocity_m_s(), normal);
        let p_n = dot(impulse_n_s, normal);
        let restored = dot(multiply(self.inverse_mass_1_kg(), impulse_n_s), normal);
        (closing > 0.0 && p_n > 0.0).then(|| ImpliedContact {
            restitution: restored / closing - 1.0,
            impulse_ratio: dot(impulse_n_s, perpendicular(normal)) / p_n,
        })
    }
}

/// What [`Impact::implied_contact`] finds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpliedContact {
    /// Restitution e; outside 0 to 1 if the rigid model does not fit.
    pub restitution: f64,
    /// `P_τ / P_n`, with the sign of `P_τ`.
    pub impulse_ratio: f64,
}

/// Work that the contact force does on the two vehicles' relative motion, lost by them, J.
///
/// ```text
/// ∫ F·v_rel dt = v_rel(0)·P − ½ Pᵀ K P
/// ```
///
/// A function of the impulse alone, whatever the force's history: with rigid bodies
/// `v_rel(t) = v_rel(0) − K ∫₀ᵗ F dt`. The paper's `½ m_eff V_rel² (1 − e²)` (`eq:physic_cons2`)
/// is the special case of a central, normal impact.
///
/// - `relative_velocity_m_s`: bullet's contact point relative to the target's, before;
/// - `inverse_mass_1_kg`: [`Impact::inverse_mass_1_kg`];
/// - `impulse_n_s`: on the target.
///
/// All three in the same axes.
pub fn contact_work_j<T: Scalar>(
    relative_velocity_m_s: [T; 2],
    inverse_mass_1_kg: [[T; 2]; 2],
    impulse_n_s: [T; 2],
) -> T {
    let loss_of_velocity = multiply(inverse_mass_1_kg, impulse_n_s);
    dot(relative_velocity_m_s, impulse_n_s) - dot(impulse_n_s, loss_of_velocity) * 0.5
}

impl<T: Scalar> ImpactBody<T> {
    /// Velocity of the body at the contact point, world axes, m/s: `v + r × arm`.
    pub fn contact_velocity_m_s(&self) -> [T; 2] {
        let lever = perpendicular(self.contact_arm_m);
        [0, 1].map(|i| self.velocity_m_s[i] + lever[i] * self.yaw_rate_rad_s)
    }

    /// Kinetic energy `½ m v² + ½ I r²`, J.
    pub fn kinetic_energy_j(&self) -> T {
        let translation = self.mass_kg * dot(self.velocity_m_s, self.velocity_m_s);
        (translation + self.yaw_inertia_kg_m2 * self.yaw_rate_rad_s.squared()) * 0.5
    }

    fn after(&self, impulse: [T; 2]) -> BodyAfter<T> {
        let delta_v_m_s = impulse.map(|p| p / self.mass_kg);
        let moment = dot(perpendicular(self.contact_arm_m), impulse);
        let delta_yaw_rate_rad_s = moment / self.yaw_inertia_kg_m2;
        BodyAfter {
            velocity_m_s: [0, 1].map(|i| self.velocity_m_s[i] + delta_v_m_s[i]),
            yaw_rate_rad_s: self.yaw_rate_rad_s + delta_yaw_rate_rad_s,
            delta_v_m_s,
            delta_yaw_rate_rad_s,
            pdof: PrincipalDirectionOfForce::from_impulse(
                impulse.map(|p| p.re()),
                self.heading_rad,
            ),
        }
    }
}

impl<T: Scalar> ContactSurface<T> {
    fn normal(&self) -> [T; 2] {
        let (sin, cos) = self.normal_angle_rad.sin_cos();
        [cos, sin]
    }
}

/// The impulses that restitution allows: `K_nn P_n + K_nτ P_τ = (1 + e) v_n`.
struct RestitutionLine<T> {
    k_nn: T,
    k_nt: T,
    k_tt: T,
    closing: [T; 2],
    restitution: T,
}

impl<T: Scalar> RestitutionLine<T> {
    fn normal_impulse_n_s(&self, p_t: T) -> T {
        ((self.restitution + 1.0) * self.closing[0] - self.k_nt * p_t) / self.k_nn
    }

    fn tangential_impulse_n_s(
        &self,
        surface: &ContactSurface<T>,
    ) -> Result<(T, Regime), ImpactError> {
        let [v_n, v_t] = self.closing;
        let coupling = self.k_nt / self.k_nn;
        let schur = self.k_tt - self.k_nt * coupling;
        let frictionless = self.normal_impulse_n_s(T::from(0.0));
        let no_slide = (v_t - self.k_nt * frictionless) / schur;
        let sign = if no_slide.re() < 0.0 { -1.0 } else { 1.0 };
        // P_n = frictionless / (1 + s μ K_nτ/K_nn); not positive: no such point on this side.
        let resistance = surface.friction_limit * coupling * sign + 1.0;
        let sliding = surface.friction_limit * frictionless / resistance * sign;
        if surface.friction_model == FrictionModel::Paper {
            return if resistance.re() > 0.0 {
                Ok((sliding, Regime::Sliding))
            } else {
                Err(ImpactError::Jammed { friction_limit: surface.friction_limit.re() })
            };
        }
        let (mut p_t, mut regime) = (no_slide, Regime::NoSlide);
        if resistance.re() > 0.0 && sliding.re().abs() < no_slide.re().abs() {
            (p_t, regime) = (sliding, Regime::Sliding);
        }
        let slope = v_t - coupling * v_n;
        let e2 = self.restitution.squared();
        let at_frictionless = (-e2 + 1.0) * v_n.squared() / self.k_nn * 0.5;
        let created = schur * p_t.squared() * 0.5 - slope * p_t - at_frictionless;
        // Below rounding there is nothing to limit: e = 1 without friction sits exactly at zero.
        if created.re() > 1e-12 * (at_frictionless.re() + (slope * p_t).re().abs()) {
            let root = (slope.squared() + schur * at_frictionless * 2.0).sqrt();
            (p_t, regime) = ((slope + root * sign) / schur, Regime::EnergyLimited);
        }
        Ok((p_t, regime))
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
    of: &'static str,
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
    Err(ImpactError::Range { of, name, value, expected })
}

/// A quarter turn to the left.
fn perpendicular<T: Scalar>([x, y]: [T; 2]) -> [T; 2] {
    [-y, x]
}

fn dot<T: Scalar>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

fn multiply<T: Scalar>(k: [[T; 2]; 2], p: [T; 2]) -> [T; 2] {
    [dot(k[0], p), dot(k[1], p)]
}
