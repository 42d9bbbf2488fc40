//! The crush law: the parameters of the crush model, their prior values and their order in a
//! vector.

use serde::{Deserialize, Serialize};

use super::knots::CrushKnots;
use super::outline::{N_OUTLINE_FACTORS, Nose};

/// Rear end of the struck vehicle relative to its rear axle, m, of laws that do not store it.
const REAR_END_BEFORE_M: f64 = -0.96;

/// Parameters of one kind of body of the striking vehicle, which modify those that all bodies share
/// ([`CrushLaw`]).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyCrush {
    /// Name of the body in the data; empty if the data do not name the bodies.
    pub name: String,
    /// Outline of the front of the striking vehicle.
    pub nose: Nose,
    /// Logarithm of the factor on the stiffness of the skins in each range of crush depth.
    pub depth_log_factor: Vec<f64>,
    /// Logarithm of the factor on the stiffness of the skins at marks along the outline of the
    /// striking vehicle: rear end of the side; start, middle and end of the corner; inner end of
    /// the front.
    pub outline_log_factor: [f64; N_OUTLINE_FACTORS],
    /// Logarithm of the factor on the stiffness k₂ of the inner structures.
    pub structure_log_factor: f64,
    /// Amount that is added to the depth d_b of the inner structure of the striking vehicle, m.
    pub structure_depth_m: Vec<f64>,
    /// Recovery q: ratio of the length over which the skins unload to the crush, at a crush of 0.1
    /// m.
    pub recovery: f64,
    /// Amount that is added to the friction coefficient μ.
    pub friction: f64,
}

/// Corrections of the shared parameters ([`CrushLaw`]) for one kind of body of the struck vehicle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StruckBodyCrush {
    /// Name of the body in the data; empty for cases that do not name it.
    pub name: String,
    /// Logarithm of the factor on the stiffness of the skins in each range of crush depth.
    pub depth_log_factor: Vec<f64>,
    /// Amount that is added to the logarithm of the factor of the skins along the side.
    pub skin_log_factor: Vec<f64>,
    /// Amount that is added to the bulge b of the side, m.
    pub skin_bulge_m: Vec<f64>,
    /// Logarithm of the factor on the stiffness k₂ of the inner structures.
    pub structure_log_factor: f64,
    /// Amount that is added to the depth d_t of the inner structure of the struck vehicle, m.
    pub structure_depth_m: Vec<f64>,
    /// Amount that is added to the friction coefficient μ.
    pub friction: f64,
}

/// The parameters of the crush model: those that all kinds of bodies share, those of each kind of body
/// of the striking vehicle, and the corrections for each kind of body of the struck vehicle.
///
/// While the overlap d of an element of the outline grows, the force per metre of outline at the
/// position s along the side of the struck vehicle and σ along the striking vehicle is
///
/// ```text
/// p = p₁ + p₂
/// p₁ = f(s, σ) · ∫₀^(d + b(s)) k(z) dz
/// p₂ = k₂ · softplus(d − d_t(s) − d_b(σ) − d_θ (θ_b − 0.35))
/// ```
///
/// The part p₁ is that of the outer skins of both vehicles. Their stiffness k per depth depends on
/// the range of depth, f is a factor of position and body, and b is a bulge of the side of the
/// struck vehicle. The part p₂ is that of the stiff inner structures behind the skins: wheel and
/// edges of the wheel arch of the struck vehicle, wheel and beam of the striking vehicle. The
/// structures meet where the overlap exceeds the sum of their depths d_t and d_b below the skins.
/// Softplus stands for a smooth transition, `w ln(1 + exp(x / w))` with the width w of
/// [`CrushLaw::structure_log_softness`].
///
/// While the overlap is smaller than the largest overlap d_max so far, each part decreases over a
/// length of its own:
///
/// ```text
/// p₁ = p₁,max · max(0, 1 − (d_max − d) / ℓ₁)^ν₁     ℓ₁ = 0.1 m · q (d_max / 0.1 m)^a
/// p₂ = p₂,max · max(0, 1 − (d_max − d) / ℓ₂)^ν₂
/// ```
///
/// Both parts are multiplied by max(0, 1 + c v_y), where v_y is the velocity of the striking
/// vehicle relative to the struck vehicle at the element along the y axis of the struck vehicle.
/// The normal force acts in a direction between the normals of the struck and the striking vehicle.
/// The share of the inner structures in the force tilts it by −τ ∂d_t/∂s along the x axis of the
/// struck vehicle, because a structure that slides up an edge is held back by it. Friction acts
/// perpendicular to this direction with the coefficient μ tanh(v_t / v₀), where v_t is the sliding
/// velocity.
///
/// The friction coefficient μ and the share of the normal of the striking vehicle vary linearly
/// with the largest overlap of an element, as given by the fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrushLaw {
    /// ln k in each range of crush depth, with k in N/m² (force per metre of outline and per metre
    /// of depth).
    pub depth_log_stiffness: Vec<f64>,
    /// Logarithm of the factor on the stiffness of the skins along the side of the struck vehicle.
    pub skin_log_factor: Vec<f64>,
    /// Bulge b of the side of the struck vehicle along the side, m. A positive bulge brings the
    /// skins into contact earlier.
    pub skin_bulge_m: Vec<f64>,
    /// ln k₂, with the stiffness k₂ of the inner structures in N/m².
    pub structure_log_stiffness: f64,
    /// Depth d_t of the inner structure of the struck vehicle below its skin along the side, m.
    #[serde(rename = "target_structure_depth_m")]
    pub struck_structure_depth_m: Vec<f64>,
    /// Depth d_b of the inner structure of the striking vehicle below its skin along the x axis of
    /// the striking vehicle, m.
    #[serde(rename = "bullet_structure_depth_m")]
    pub striking_structure_depth_m: Vec<f64>,
    /// d_θ: increase of the depth of the structures with the heading angle θ_b of the striking
    /// vehicle, m/rad.
    pub structure_depth_angle_m_rad: f64,
    /// τ: factor by which the slope of the structure of the struck vehicle tilts the direction of
    /// the normal force.
    pub structure_tilt: f64,
    /// Amount that is added to the friction coefficient μ where the inner structures carry the
    /// whole force.
    pub structure_friction: f64,
    /// ln ℓ₂, with the unloading length ℓ₂ of the inner structures in m.
    pub structure_log_recovery: f64,
    /// ν₂: exponent of the unloading curve of the inner structures.
    pub structure_unloading_exponent: f64,
    /// Logarithm of the depth in m over which the contact of the inner structures builds up (width
    /// of the softplus function).
    pub structure_log_softness: f64,
    /// a: exponent with which the unloading length ℓ₁ of the skins grows with the crush.
    pub recovery_exponent: f64,
    /// ν₁: exponent of the unloading curve of the skins.
    pub unloading_exponent: f64,
    /// Friction coefficient μ at an overlap of 0.1 m and a heading θ_b of the striking vehicle of
    /// 0.35 rad.
    pub friction: f64,
    /// Increase of μ with the largest overlap so far, 1/m.
    pub friction_depth_1_m: f64,
    /// Increase of μ with the heading θ_b of the striking vehicle, 1/rad.
    pub friction_angle_1_rad: f64,
    /// ln v₀, with the sliding velocity v₀ over which friction builds up in m/s.
    pub friction_log_speed: f64,
    /// Share of the normal of the striking vehicle in the direction of the normal force, at an
    /// overlap of 0.1 m and at the rear axle of the struck vehicle. The remainder is the share of
    /// the normal of the struck vehicle.
    pub normal_share: f64,
    /// Increase of that share with the largest overlap so far, 1/m.
    pub normal_share_depth_1_m: f64,
    /// Increase of that share with the position along the side of the struck vehicle, positive
    /// forwards, 1/m.
    pub normal_share_place_1_m: f64,
    /// c: damping coefficient, s/m.
    pub damping_s_m: f64,
    /// Position x of the rear axle of the struck vehicle in its body axes, m, usually negative.
    /// Positions s along the side are measured from it. It is not fitted.
    pub rear_axle_x_m: f64,
    /// Rear end of the struck vehicle, x in its body axes, m: there is no contact behind it. It is not
    /// fitted. A law that does not store it has its rear end 0.96 m behind the axle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rear_end_x_m: Option<f64>,
    /// Parameters of each kind of body of the striking vehicle.
    pub bodies: Vec<BodyCrush>,
    /// Parameters of each kind of body of the struck vehicle; empty where there is one kind only, whose
    /// parameters are the shared ones.
    #[serde(default, rename = "target_bodies", skip_serializing_if = "Vec::is_empty")]
    pub struck_bodies: Vec<StruckBodyCrush>,
    /// Where the piecewise linear functions have their knots.
    #[serde(default = "CrushKnots::before")]
    pub knots: CrushKnots,
}

impl BodyCrush {
    /// Prior of a body: it has no corrections of the shared parameters, and its recovery q is 0.5.
    pub fn prior(name: impl Into<String>, nose: Nose, knots: &CrushKnots) -> Self {
        Self {
            name: name.into(),
            nose,
            depth_log_factor: none(&knots.depth_m),
            outline_log_factor: [0.0; N_OUTLINE_FACTORS],
            structure_log_factor: 0.0,
            structure_depth_m: none(&knots.striking_structure_m),
            recovery: 0.5,
            friction: 0.0,
        }
    }
}

impl StruckBodyCrush {
    /// Prior of a struck body: it has no corrections of the shared parameters.
    pub fn prior(name: impl Into<String>, knots: &CrushKnots) -> Self {
        Self {
            name: name.into(),
            depth_log_factor: none(&knots.depth_m),
            skin_log_factor: none(&knots.skin_m),
            skin_bulge_m: none(&knots.skin_m),
            structure_log_factor: 0.0,
            structure_depth_m: none(&knots.struck_structure_m),
            friction: 0.0,
        }
    }
}

/// No correction at any knot.
fn none(knots: &[f64]) -> Vec<f64> {
    vec![0.0; knots.len()]
}

/// To which collisions a fitted parameter applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Applies {
    All,
    /// Those of one kind of striking body, by its index.
    Striking(usize),
    /// Those of one kind of struck body, by its index.
    Struck(usize),
}

/// Calls `visit` with each fitted parameter, in a fixed order, the scale over which it is expected to
/// vary, and the collisions to which it applies. Order and scales are defined only here. `$reference`
/// is `&` or `&mut`.
macro_rules! for_each_parameter {
    ($law:expr, $visit:expr, $($reference:tt)+) => {{
        let law = $law;
        let mut visit_one = $visit;
        let mut visit = |value, scale| visit_one(value, scale, Applies::All);
        for value in $($reference)+ law.depth_log_stiffness { visit(value, 0.5); }
        for value in $($reference)+ law.skin_log_factor { visit(value, 0.4); }
        for value in $($reference)+ law.skin_bulge_m { visit(value, 0.03); }
        visit($($reference)+ law.structure_log_stiffness, 0.7);
        for value in $($reference)+ law.struck_structure_depth_m { visit(value, 0.04); }
        for value in $($reference)+ law.striking_structure_depth_m { visit(value, 0.04); }
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
        for (idx, body) in ($($reference)+ law.bodies).into_iter().enumerate() {
            let mut visit = |value, scale| visit_one(value, scale, Applies::Striking(idx));
            for value in $($reference)+ body.depth_log_factor { visit(value, 0.4); }
            for value in $($reference)+ body.outline_log_factor { visit(value, 0.5); }
            visit($($reference)+ body.structure_log_factor, 0.3);
            for value in $($reference)+ body.structure_depth_m { visit(value, 0.03); }
            visit($($reference)+ body.recovery, 0.15);
            visit($($reference)+ body.friction, 0.1);
        }
        for (idx, body) in ($($reference)+ law.struck_bodies).into_iter().enumerate() {
            let mut visit = |value, scale| visit_one(value, scale, Applies::Struck(idx));
            for value in $($reference)+ body.depth_log_factor { visit(value, 0.4); }
            for value in $($reference)+ body.skin_log_factor { visit(value, 0.3); }
            for value in $($reference)+ body.skin_bulge_m { visit(value, 0.02); }
            visit($($reference)+ body.structure_log_factor, 0.3);
            for value in $($reference)+ body.structure_depth_m { visit(value, 0.03); }
            visit($($reference)+ body.friction, 0.1);
        }
    }};
}

impl CrushLaw {
    /// Prior of the law before any data are used. The stiffness of the skins rises with the depth
    /// from 0.1 to 1.2 MN/m². The inner structures lie together 0.13 m below the skins over most of
    /// the outlines, and less where the wheel of the striking vehicle is. Half of a crush of 0.1 m
    /// is recovered. The friction coefficient is 0.4.
    ///
    /// - `bodies`: kinds of bodies of the striking vehicle, at least one, with the default knots.
    /// - `struck_bodies`: kinds of bodies of the struck vehicle, with the default knots; none where there
    ///   is one only.
    /// - `[rear_axle_x_m, rear_end_x_m]`: positions x of rear axle and rear end of the struck vehicle in
    ///   its body axes, m.
    pub fn prior(
        bodies: Vec<BodyCrush>,
        struck_bodies: Vec<StruckBodyCrush>,
        [rear_axle_x_m, rear_end_x_m]: [f64; 2],
    ) -> Self {
        let knots = CrushKnots::default();
        Self {
            depth_log_stiffness: vec![11.5, 11.8, 12.3, 13.0, 13.5, 13.5, 13.8, 14.0, 14.0, 14.0],
            skin_log_factor: none(&knots.skin_m),
            skin_bulge_m: none(&knots.skin_m),
            structure_log_stiffness: 15.5,
            struck_structure_depth_m: vec![
                0.2, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13, 0.13,
                0.13,
            ],
            striking_structure_depth_m: vec![
                -0.08, -0.08, -0.07, -0.02, 0.0, 0.0, 0.0, -0.03, -0.03, -0.03,
            ],
            knots,
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
            rear_end_x_m: Some(rear_end_x_m),
            bodies,
            struck_bodies,
        }
    }

    /// Index of the kind of body of this name. A law with a single kind of body uses it for any
    /// name. Otherwise `None` is returned for an unknown or missing name.
    pub fn body_idx(&self, name: Option<&str>) -> Option<usize> {
        match (name, self.bodies.as_slice()) {
            (_, [_]) => Some(0),
            (Some(name), bodies) => bodies.iter().position(|body| body.name == name),
            (None, _) => None,
        }
    }

    /// Rear end of the struck vehicle relative to its rear axle, m.
    pub(super) fn rear_end_m(&self) -> f64 {
        self.rear_end_x_m.map_or(REAR_END_BEFORE_M, |end| end - self.rear_axle_x_m)
    }

    /// Index of the kind of struck body of this name; `None` if the law has one kind only, or does not
    /// know the name.
    pub fn struck_body_idx(&self, name: &str) -> Option<usize> {
        self.struck_bodies.iter().position(|body| body.name == name)
    }

    /// All fitted parameters as a vector. The outlines of the bodies and the positions of the rear axle
    /// and of the rear end are not fitted.
    pub fn to_vector(&self) -> Vec<f64> {
        let mut row = Vec::new();
        for_each_parameter!(self, |value: &f64, _: f64, _| row.push(*value), &);
        row
    }

    /// The law with the fitted parameters replaced by those of a vector in the order of
    /// [`Self::to_vector`].
    pub(super) fn with_vector(&self, row: &[f64]) -> Self {
        let mut law = self.clone();
        let mut values = row.iter();
        for_each_parameter!(
            &mut law,
            |value: &mut f64, _: f64, _| {
                if let Some(new) = values.next() {
                    *value = *new;
                }
            },
            &mut
        );
        law
    }

    /// Scale of each fitted parameter, by which its deviation from the prior is measured.
    pub(super) fn scales(&self) -> Vec<f64> {
        let mut row = Vec::new();
        for_each_parameter!(self, |_: &f64, scale: f64, _| row.push(scale), &);
        row
    }

    /// To which collisions each fitted parameter applies.
    pub(super) fn applications(&self) -> Vec<Applies> {
        let mut row = Vec::new();
        for_each_parameter!(self, |_: &f64, _: f64, applies| row.push(applies), &);
        row
    }

    /// The lists of values at knots: what each is called in a file, its values, and its knots.
    pub fn lists(&self) -> Vec<(String, &[f64], &[f64])> {
        let knots = &self.knots;
        let (depth, skin) = (knots.depth_m.as_slice(), knots.skin_m.as_slice());
        let struck = knots.struck_structure_m.as_slice();
        let striking = knots.striking_structure_m.as_slice();
        let mut lists: Vec<(String, &[f64], &[f64])> = vec![
            ("depth_log_stiffness".to_owned(), &self.depth_log_stiffness, depth),
            ("skin_log_factor".to_owned(), &self.skin_log_factor, skin),
            ("skin_bulge_m".to_owned(), &self.skin_bulge_m, skin),
            ("target_structure_depth_m".to_owned(), &self.struck_structure_depth_m, struck),
            ("bullet_structure_depth_m".to_owned(), &self.striking_structure_depth_m, striking),
        ];
        for (i, body) in self.bodies.iter().enumerate() {
            let name = |list| format!("bodies[{i}].{list}");
            lists.push((name("depth_log_factor"), &body.depth_log_factor, depth));
            lists.push((name("structure_depth_m"), &body.structure_depth_m, striking));
        }
        for (i, body) in self.struck_bodies.iter().enumerate() {
            let name = |list| format!("target_bodies[{i}].{list}");
            lists.push((name("depth_log_factor"), &body.depth_log_factor, depth));
            lists.push((name("skin_log_factor"), &body.skin_log_factor, skin));
            lists.push((name("skin_bulge_m"), &body.skin_bulge_m, skin));
            lists.push((name("structure_depth_m"), &body.structure_depth_m, struck));
        }
        lists
    }

    /// Whether every fitted parameter is finite.
    pub fn is_finite(&self) -> bool {
        self.to_vector().iter().all(|value| value.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_go_into_a_row_and_back() {
        let knots = CrushKnots::default();
        let bodies =
            ["A", "B"].map(|name| BodyCrush::prior(name, Nose::default(), &knots)).to_vec();
        let struck = ["", "A"].map(|name| StruckBodyCrush::prior(name, &knots)).to_vec();
        let law = CrushLaw::prior(bodies, struck, [-1.54, -2.5]);
        let row: Vec<f64> = (0..law.to_vector().len()).map(|i| i as f64).collect();
        assert_eq!(law.with_vector(&row).to_vector(), row);
        assert_eq!(law.scales().len(), row.len());
        assert_eq!(law.body_idx(Some("B")), Some(1));
        assert_eq!(law.body_idx(Some("C")), None);
        assert_eq!(law.body_idx(None), None);
        assert_eq!([law.struck_body_idx("A"), law.struck_body_idx("B")], [Some(1), None]);
        assert_eq!(law.applications().last(), Some(&Applies::Struck(1)));
        let lists = law.lists();
        assert!(lists.iter().all(|(_, values, knots)| values.len() == knots.len()), "{lists:?}");
        assert_eq!(lists.len(), 5 + 2 * 2 + 2 * 4);
    }

    /// A law of a model that was stored before laws named their knots and their rear end.
    #[test]
    fn a_law_without_knots_has_those_of_its_time() {
        let knots = CrushKnots::before();
        let body = BodyCrush::prior("A", Nose::default(), &knots);
        let mut law = CrushLaw::prior(vec![body], Vec::new(), [-1.54, -2.5]);
        law.depth_log_stiffness.truncate(8);
        law.skin_log_factor.truncate(8);
        law.skin_bulge_m.truncate(8);
        law.struck_structure_depth_m.truncate(12);
        let mut stored = serde_json::to_value(&law).unwrap();
        let fields = stored.as_object_mut().unwrap();
        assert!(fields.remove("knots").is_some() && fields.remove("rear_end_x_m").is_some());
        assert!(!fields.contains_key("target_bodies"));
        let read: CrushLaw = serde_json::from_value(stored).unwrap();
        assert_eq!(read.rear_end_m(), -0.96);
        assert!(read.struck_bodies.is_empty());
        let lengths: Vec<usize> = read.lists().iter().map(|(_, _, knots)| knots.len()).collect();
        assert_eq!(lengths, [8, 8, 8, 12, 10, 8, 10]);
        assert!(read.lists().iter().all(|(_, values, knots)| values.len() == knots.len()));
        let ends = |knots: &[f64]| [knots.first().copied(), knots.last().copied()];
        assert_eq!(ends(&read.knots.depth_m), [Some(0.0), Some(0.24)]);
        assert_eq!(ends(&read.knots.skin_m), [Some(-0.66), Some(1.04)]);
        assert_eq!(ends(&read.knots.struck_structure_m), [Some(-0.8), Some(0.6)]);
        assert_eq!(ends(&read.knots.striking_structure_m), [Some(-0.7), Some(0.54)]);
        assert_eq!(read.knots.side_and_front_m, [0.8, 0.6]);
    }
}
