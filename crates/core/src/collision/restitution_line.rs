//! The impulses that satisfy the condition of restitution, and the one among them that friction
//! brings about; part of the planar impact ([`Impact`](crate::collision::Impact)).

use crate::collision::impact::{dot, multiply, perpendicular};
use crate::collision::{
    ContactSurface, FrictionModel, Impact, ImpactError, Regime, RestitutionForm,
};
use crate::numerics::Scalar;

/// The line of impulses that satisfy the condition of restitution: `K_nn P_n + K_nτ P_τ = (1 + e)
/// v_n`.
pub(super) struct RestitutionLine<T> {
    k_nn: T,
    k_nt: T,
    k_tt: T,
    closing: [T; 2],
    restitution: T,
}

impl<T: Scalar> RestitutionLine<T> {
    /// The line of an impact; that of its compression, e = 0, if restitution starts at the common
    /// velocity.
    pub(super) fn new(impact: &Impact<T>) -> Self {
        let k = impact.inverse_mass_1_kg();
        let normal = impact.surface.normal();
        let tangent = perpendicular(normal);
        let (k_normal, k_tangent) = (multiply(k, normal), multiply(k, tangent));
        Self {
            k_nn: dot(normal, k_normal),
            k_nt: dot(normal, k_tangent),
            k_tt: dot(tangent, k_tangent),
            closing: impact.closing_velocity_m_s(),
            restitution: match impact.surface.restitution_form {
                RestitutionForm::Normal => impact.surface.restitution,
                RestitutionForm::CommonVelocity => T::from(0.0),
            },
        }
    }

    /// Normal impulse at a tangential one, N s.
    pub(super) fn normal_impulse_n_s(&self, p_t: T) -> T {
        ((self.restitution + 1.0) * self.closing[0] - self.k_nt * p_t) / self.k_nn
    }

    /// `S = K_ττ − K_nτ²/K_nn`, 1/kg.
    fn schur(&self) -> T {
        self.k_tt - self.k_nt * self.k_nt / self.k_nn
    }

    /// Tangential impulse after which the contact points do not slide, N s.
    pub(super) fn no_slide_impulse_n_s(&self) -> T {
        let frictionless = self.normal_impulse_n_s(T::from(0.0));
        (self.closing[1] - self.k_nt * frictionless) / self.schur()
    }

    /// Tangential impulse of the solution, N s, and the state of the contact at its end; the
    /// equations are given at [`Impact::solve_unchecked`].
    ///
    /// # Errors
    /// [`ImpactError::Jammed`], only with [`FrictionModel::Paper`].
    pub(super) fn tangential_impulse_n_s(
        &self,
        surface: &ContactSurface<T>,
    ) -> Result<(T, Regime), ImpactError> {
        let [v_n, v_t] = self.closing;
        let coupling = self.k_nt / self.k_nn;
        let schur = self.schur();
        let frictionless = self.normal_impulse_n_s(T::from(0.0));
        let no_slide = self.no_slide_impulse_n_s();
        let sign = if no_slide.re() < 0.0 { -1.0 } else { 1.0 };
        // P_n = frictionless / (1 + s μ K_nτ/K_nn). If the denominator is not positive, there is no
        // point of sliding on the side s of the frictionless point.
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
        // At the critical impulse ratio both are equal up to rounding.
        if resistance.re() > 0.0 && sliding.re().abs() < no_slide.re().abs() * (1.0 - 1e-12) {
            (p_t, regime) = (sliding, Regime::Sliding);
        }
        let slope = v_t - coupling * v_n;
        let e2 = self.restitution.squared();
        let at_frictionless = (-e2 + 1.0) * v_n.squared() / self.k_nn * 0.5;
        let created = schur * p_t.squared() * 0.5 - slope * p_t - at_frictionless;
        // The tolerance covers rounding errors: with e = 1 and no friction the energy created is
        // exactly zero.
        if created.re() > 1e-12 * (at_frictionless.re() + (slope * p_t).re().abs()) {
            let root = (slope.squared() + schur * at_frictionless * 2.0).sqrt();
            (p_t, regime) = ((slope + root * sign) / schur, Regime::EnergyLimited);
        }
        Ok((p_t, regime))
    }
}
