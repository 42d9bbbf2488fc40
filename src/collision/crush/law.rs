//! What the springs are like: the parameters of the crush model.

use serde::{Deserialize, Serialize};

use super::outline::{N_OUTLINE_FACTORS, Nose};

/// Crush depths between which the stiffness of the skin is constant, m; beyond the last it stays.
pub(super) const DEPTH_KNOTS_M: [f64; 7] = [0.0, 0.04, 0.08, 0.12, 0.17, 0.24, 0.34];
/// Places along the target's side, from its rear axle forwards, m, at which the skin's stiffness
/// and bulge are given; linear in between.
pub(super) const SKIN_KNOTS_M: [f64; 8] = [-0.66, -0.36, -0.16, 0.0, 0.16, 0.34, 0.64, 1.04];
/// Places along the target's side, from its rear axle forwards, m, at which the depth of the wheel
/// behind the skin is given; linear in between.
pub(super) const WHEEL_KNOTS_M: [f64; 7] = [-0.46, -0.32, -0.16, 0.0, 0.16, 0.32, 0.48];
/// Places along the bullet's outline, from the start of its corner forwards, m, at which the depth
/// of its stiff structure behind the skin is given; linear in between.
pub(super) const STRUCTURE_KNOTS_M: [f64; 4] = [-0.4, 0.0, 0.25, 0.55];

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
    /// Logarithm of the factor on the stiffness against the wheel.
    pub wheel_log_factor: f64,
    /// How much deeper it gets before it meets the wheel, m.
    pub wheel_depth_m: f64,
    /// Share of the greatest crush that comes back.
    pub recovery: f64,
    /// What it adds to the friction coefficient.
    pub friction: f64,
}

/// The parameters of the crush model, shared by all bodies and for each body.
///
/// Force per metre of outline at a depth d that grows, at a place s along the target's side:
///
/// ```text
/// p = f₁ · ∫₀^(d + b(s)) k(z) dz  +  k_w · softplus(d − d_w(s) − d_b − d_θ (θ_b − 0.35))
/// ```
///
/// the skin (k by ranges of depth, factor f₁ of place and body, bulge b) and behind it the wheel.
/// Below the greatest depth d_max so far, with recovery q and exponent ν:
///
/// ```text
/// p = p_max · max(0, 1 − (d_max − d) / (q d_max))^ν · (1 + c v_n)
/// ```
///
/// It acts along a normal between the target's and the bullet's, with friction μ tanh(v_t / v₀)
/// across it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrushLaw {
    /// ln k by range of depth, k in N/m per m of outline and m of depth.
    pub depth_log_stiffness: [f64; DEPTH_KNOTS_M.len()],
    /// Logarithm of the factor on the skin's stiffness along the target's side.
    pub skin_log_factor: [f64; SKIN_KNOTS_M.len()],
    /// Bulge b of the target's side, m.
    pub skin_bulge_m: [f64; SKIN_KNOTS_M.len()],
    /// ln k_w, as ln k.
    pub wheel_log_stiffness: f64,
    /// Depth d_w of the wheel behind the skin, m.
    pub wheel_depth_m: [f64; WHEEL_KNOTS_M.len()],
    /// d_θ: how much deeper the wheel lies per radian of bullet angle, m/rad.
    pub wheel_depth_angle_m_rad: f64,
    /// d_b: depth of the bullet's structure along its outline, m.
    pub structure_depth_m: [f64; STRUCTURE_KNOTS_M.len()],
    /// ν, exponent of unloading.
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
            wheel_log_factor: 0.0,
            wheel_depth_m: 0.0,
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
        visit($($reference)+ law.wheel_log_stiffness, 0.7);
        for value in $($reference)+ law.wheel_depth_m { visit(value, 0.05); }
        visit($($reference)+ law.wheel_depth_angle_m_rad, 0.1);
        for value in $($reference)+ law.structure_depth_m { visit(value, 0.05); }
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
            visit($($reference)+ body.wheel_log_factor, 0.3);
            visit($($reference)+ body.wheel_depth_m, 0.03);
            visit($($reference)+ body.recovery, 0.15);
            visit($($reference)+ body.friction, 0.1);
        }
    }};
}

impl CrushLaw {
    /// What is believed before any data are seen: a skin of some 0.1 to 1 MN/m per m of outline
    /// that stiffens with depth, a rim 0.12 m behind it, half the crush recovered, friction 0.4.
    ///
    /// - `bodies`: at least one.
    /// - `rear_axle_x_m`: the target's rear axle in its body axes.
    pub fn prior(bodies: Vec<BodyCrush>, rear_axle_x_m: f64) -> Self {
        Self {
            depth_log_stiffness: [11.5, 12.5, 13.3, 13.8, 14.0, 14.0, 14.0],
            skin_log_factor: [0.0; SKIN_KNOTS_M.len()],
            skin_bulge_m: [0.0; SKIN_KNOTS_M.len()],
            wheel_log_stiffness: 14.5,
            wheel_depth_m: [0.3, 0.18, 0.13, 0.12, 0.13, 0.18, 0.3],
            wheel_depth_angle_m_rad: 0.0,
            structure_depth_m: [0.05, 0.0, 0.0, 0.05],
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
