//! What the springs are like: the parameters of the crush model.

use serde::{Deserialize, Serialize};

use super::outline::{N_OUTLINE_FACTORS, Nose};

/// Crush depths between which the stiffness of the skins is constant, m; beyond the last it stays.
pub(super) const DEPTH_KNOTS_M: [f64; 8] = [0.0, 0.03, 0.06, 0.09, 0.105, 0.13, 0.17, 0.24];
/// Places along the target's side, from its rear axle forwards, m, at which the skin's stiffness
/// and bulge are given; linear in between.
pub(super) const SKIN_KNOTS_M: [f64; 8] = [-0.66, -0.36, -0.16, 0.0, 0.16, 0.34, 0.64, 1.04];
/// Places along the target's side, from its rear axle forwards, m, at which the depth of its hard
/// structure is given (wheel, edges of the wheel arch); linear in between.
pub(super) const TARGET_STRUCTURE_KNOTS_M: [f64; 12] =
    [-0.8, -0.6, -0.45, -0.32, -0.2, -0.1, 0.0, 0.1, 0.2, 0.32, 0.45, 0.6];
/// Places along the bullet's outline, from the start of its corner forwards, m, at which the depth
/// of its hard structure is given (wheel behind the corner, beam before it); linear in between.
pub(super) const BULLET_STRUCTURE_KNOTS_M: [f64; 10] =
    [-0.7, -0.45, -0.25, -0.1, 0.05, 0.2, 0.3, 0.38, 0.46, 0.54];

/// What one kind of bullet body is like.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyCrush {
    /// As the data name it; a single nameless body where they do not.
    pub name: String,
    /// Its outline.
    pub nose: Nose,
    /// Logarithm of the factor on the skin's stiffness in each range of depth.
    pub depth_log_factor: [f64; DEPTH_KNOTS_M.len()],
    /// Logarithm of the factor on the skin's stiffness along the outline.
    pub outline_log_factor: [f64; N_OUTLINE_FACTORS],
    /// Logarithm of the factor on the stiffness of structure against structure.
    pub structure_log_factor: f64,
    /// How much deeper than other bodies' its structure lies along its outline, m.
    pub structure_depth_m: [f64; BULLET_STRUCTURE_KNOTS_M.len()],
    /// q: share of a crush of 0.1 m that comes back.
    pub recovery: f64,
    /// What it adds to the friction coefficient.
    pub friction: f64,
}

/// The parameters of the crush model, shared by all bodies and for each body.
///
/// Force per metre of outline at a depth d that grows, at a place s along the target's side and σ
/// along the bullet's outline:
///
/// ```text
/// p = p₁ + p₂
/// p₁ = f(s, σ) · ∫₀^(d + b(s)) k(z) dz
/// p₂ = k₂ · softplus(d − d_t(s) − d_b(σ) − d_θ (θ_b − 0.35))
/// ```
///
/// the skins (k by ranges of depth, factor f of place and body, bulge b), and the hard structures
/// behind them: the target's wheel and the edges of its wheel arch, the bullet's wheel and beam.
/// Below the greatest depth d_max so far each part comes back over a length of its own:
///
/// ```text
/// p₁ = p₁,max · max(0, 1 − (d_max − d) / ℓ₁)^ν₁     ℓ₁ = 0.1 m · q (d_max / 0.1 m)^a
/// p₂ = p₂,max · max(0, 1 − (d_max − d) / ℓ₂)^ν₂
/// ```
///
/// both times 1 + c v_n. The push acts along a normal between the target's and the bullet's, which
/// the structure's share of it tilts by −τ ∂d_t/∂s (what runs up an edge is held by it), with
/// friction μ tanh(v_t / v₀) across it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrushLaw {
    /// ln k by range of depth, k in N/m per m of outline and m of depth.
    pub depth_log_stiffness: [f64; DEPTH_KNOTS_M.len()],
    /// Logarithm of the factor on the skin's stiffness along the target's side.
    pub skin_log_factor: [f64; SKIN_KNOTS_M.len()],
    /// Bulge b of the target's side, m.
    pub skin_bulge_m: [f64; SKIN_KNOTS_M.len()],
    /// ln k₂, as ln k.
    pub structure_log_stiffness: f64,
    /// Depth d_t of the target's structure, m.
    pub target_structure_depth_m: [f64; TARGET_STRUCTURE_KNOTS_M.len()],
    /// Depth d_b of the bullet's structure, m.
    pub bullet_structure_depth_m: [f64; BULLET_STRUCTURE_KNOTS_M.len()],
    /// d_θ: how much deeper the structures lie per radian of bullet angle, m/rad.
    pub structure_depth_angle_m_rad: f64,
    /// τ: how far the slope of the target's structure tilts the push.
    pub structure_tilt: f64,
    /// What the structures add to the friction coefficient.
    pub structure_friction: f64,
    /// ln ℓ₂, ℓ₂ in m.
    pub structure_log_recovery: f64,
    /// ν₂.
    pub structure_unloading_exponent: f64,
    /// Logarithm of the depth over which the structures come into play, in m.
    pub structure_log_softness: f64,
    /// a: how the recovered length grows with the crush.
    pub recovery_exponent: f64,
    /// ν₁.
    pub unloading_exponent: f64,
    /// μ at 0.1 m depth and θ_b = 0.35 rad.
    pub friction: f64,
    /// Growth of μ with depth, 1/m.
    pub friction_depth_1_m: f64,
    /// Growth of μ with the bullet's angle, 1/rad.
    pub friction_angle_1_rad: f64,
    /// ln v₀, v₀ in m/s.
    pub friction_log_speed: f64,
    /// Share of the bullet's normal in the direction of the force, at 0.1 m depth over the axle.
    pub normal_share: f64,
    /// Growth of that share with depth, 1/m.
    pub normal_share_depth_1_m: f64,
    /// Growth of that share forwards along the target's side, 1/m.
    pub normal_share_place_1_m: f64,
    /// c: damping, s/m.
    pub damping_s_m: f64,
    /// The target's rear axle in its body axes, m (negative): places along its side count from it.
    pub rear_axle_x_m: f64,
    /// What each body is like.
    pub bodies: Vec<BodyCrush>,
}

impl BodyCrush {
    /// The prior of a body: nothing sets it apart.
    pub fn prior(name: impl Into<String>, nose: Nose) -> Self {
        Self {
            name: name.into(),
            nose,
            depth_log_factor: [0.0; DEPTH_KNOTS_M.len()],
            outline_log_factor: [0.0; N_OUTLINE_FACTORS],
            structure_log_factor: 0.0,
            structure_depth_m: [0.0; BULLET_STRUCTURE_KNOTS_M.len()],
            recovery: 0.5,
            friction: 0.0,
        }
    }
}

/// Calls `visit` with each parameter in a fixed order and the scale on which it varies: the one
/// place that knows both. `$reference` is `&` or `&mut`.
macro_rules! for_each_parameter {
    ($law:expr, $visit:expr, $($reference:tt)+) => {{
        let law = $law;
        let mut visit = $visit;
        for value in $($reference)+ law.depth_log_stiffness { visit(value, 0.5); }
        for value in $($reference)+ law.skin_log_factor { visit(value, 0.4); }
        for value in $($reference)+ law.skin_bulge_m { visit(value, 0.03); }
        visit($($reference)+ law.structure_log_stiffness, 0.7);
        for value in $($reference)+ law.target_structure_depth_m { visit(value, 0.04); }
        for value in $($reference)+ law.bullet_structure_depth_m { visit(value, 0.04); }
        visit($($reference)+ law.structure_depth_angle_m_rad, 0.1);
        visit($($reference)+ law.structure_tilt, 0.3);
        visit($($reference)+ law.structure_friction, 0.1);
        visit($($reference)+ law.structure_log_recovery, 0.5);
        visit($($reference)+ law.structure_unloading_exponent, 0.5);
        visit($($reference)+ law.structure_log_softness, 0.4);
        visit($($reference)+ law.recovery_exponent, 0.3);
        visit($($reference)+ law.unloading_exponent, 0.7);
        visit($($reference)+ law.friction, 0.1);
        visit($($reference)+ law.friction_depth_1_m, 1.0);
        visit($($reference)+ law.friction_angle_1_rad, 0.3);
        visit($($reference)+ law.friction_log_speed, 0.5);
        visit($($reference)+ law.normal_share, 0.2);
        visit($($reference)+ law.normal_share_depth_1_m, 1.0);
        visit($($reference)+ law.normal_share_place_1_m, 0.3);
        visit($($reference)+ law.damping_s_m, 0.1);
        for body in $($reference)+ law.bodies {
            for value in $($reference)+ body.depth_log_factor { visit(value, 0.4); }
            for value in $($reference)+ body.outline_log_factor { visit(value, 0.5); }
            visit($($reference)+ body.structure_log_factor, 0.3);
            for value in $($reference)+ body.structure_depth_m { visit(value, 0.03); }
            visit($($reference)+ body.recovery, 0.15);
            visit($($reference)+ body.friction, 0.1);
        }
    }};
}

impl CrushLaw {
    /// What is believed before any data are seen: skins of some 0.1 to 1 MN/m per m of outline
    /// that stiffen with depth, structures some 0.13 m behind them together (less where the
    /// bullet's wheel is), half the crush recovered, friction 0.4.
    ///
    /// - `bodies`: at least one.
    /// - `rear_axle_x_m`: the target's rear axle in its body axes.
    pub fn prior(bodies: Vec<BodyCrush>, rear_axle_x_m: f64) -> Self {
        Self {
            depth_log_stiffness: [11.5, 11.8, 12.3, 13.0, 13.5, 13.5, 13.8, 14.0],
            skin_log_factor: [0.0; SKIN_KNOTS_M.len()],
            skin_bulge_m: [0.0; SKIN_KNOTS_M.len()],
            structure_log_stiffness: 15.5,
            target_structure_depth_m: [
                0.2, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.15, 0.2,
            ],
            bullet_structure_depth_m: [
                -0.06, -0.06, -0.05, -0.02, 0.0, 0.0, 0.0, -0.03, -0.03, -0.03,
            ],
            structure_depth_angle_m_rad: 0.0,
            structure_tilt: 0.5,
            structure_friction: 0.0,
            structure_log_recovery: -3.2,
            structure_unloading_exponent: 1.5,
            structure_log_softness: -4.6,
            recovery_exponent: 0.8,
            unloading_exponent: 2.0,
            friction: 0.4,
            friction_depth_1_m: 0.0,
            friction_angle_1_rad: 0.0,
            friction_log_speed: -1.0,
            normal_share: 0.45,
            normal_share_depth_1_m: 0.0,
            normal_share_place_1_m: 0.0,
            damping_s_m: 0.05,
            rear_axle_x_m,
            bodies,
        }
    }

    /// Index of the body of this name; `None` if the law does not know it.
    pub fn body_idx(&self, name: Option<&str>) -> Option<usize> {
        match (name, self.bodies.as_slice()) {
            (_, [_]) => Some(0),
            (Some(name), bodies) => bodies.iter().position(|body| body.name == name),
            (None, _) => None,
        }
    }

    /// All fitted parameters in a row (the noses are not among them).
    pub(super) fn to_vector(&self) -> Vec<f64> {
        let mut row = Vec::new();
        for_each_parameter!(self, |value: &f64, _: f64| row.push(*value), &);
        row
    }

    /// The law with these parameters.
    pub(super) fn with_vector(&self, row: &[f64]) -> Self {
        let mut law = self.clone();
        let mut values = row.iter();
        for_each_parameter!(
            &mut law,
            |value: &mut f64, _: f64| {
                if let Some(new) = values.next() {
                    *value = *new;
                }
            },
            &mut
        );
        law
    }

    /// The scale of each parameter: about how far the prior lets it go.
    pub(super) fn scales(&self) -> Vec<f64> {
        let mut row = Vec::new();
        for_each_parameter!(self, |_: &f64, scale: f64| row.push(scale), &);
        row
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.to_vector().iter().all(|value| value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_go_into_a_row_and_back() {
        let bodies =
            vec![BodyCrush::prior("A", Nose::default()), BodyCrush::prior("B", Nose::default())];
        let law = CrushLaw::prior(bodies, -1.54);
        let row: Vec<f64> = (0..law.to_vector().len()).map(|i| i as f64).collect();
        assert_eq!(law.with_vector(&row).to_vector(), row);
        assert_eq!(law.scales().len(), row.len());
        assert_eq!(law.body_idx(Some("B")), Some(1));
        assert_eq!(law.body_idx(Some("C")), None);
        assert_eq!(law.body_idx(None), None);
    }
}
