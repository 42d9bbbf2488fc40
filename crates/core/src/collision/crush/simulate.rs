//! Simulates the crush of two vehicles: force over time from first contact on.

use super::knots::{CrushKnots, linear, slope, sums};
use super::law::{CrushLaw, StruckBodyCrush};
use super::outline::SkinElement;

/// Largest overlap of an element that counts as crush, m. An element with a larger overlap has
/// passed to the other side of the struck vehicle.
const MAX_DEPTH_M: f64 = 0.9;
/// Gap beyond which the simulation ends, m: vehicles that are this far apart do not meet again
/// within a quarter of a second.
const PARTED_M: f64 = 0.1;
/// Smallest length over which the load of the skins or structures decreases on unloading, m. A
/// shorter length would remove the whole load within one time step.
const MIN_RECOVERY_M: f64 = 1e-4;
/// Overlap to which the parameters of friction, normal direction and recovery refer, m.
const REFERENCE_DEPTH_M: f64 = 0.1;
/// Heading angle of the striking vehicle to which the parameters of friction and structure depth
/// refer, rad.
const REFERENCE_ANGLE_RAD: f64 = 0.35;

/// Two vehicles at first contact. The heading of the struck vehicle is along x and the striking
/// vehicle is on its right, so that its left front corner touches the right side of the struck
/// vehicle. The axes are fixed; they coincide with the body axes of the struck vehicle at first
/// contact.
#[derive(Debug, Clone, PartialEq)]
pub struct CrushScenario {
    /// Masses of the struck and the striking vehicle, kg.
    pub mass_kg: [f64; 2],
    /// Yaw moments of inertia of the struck and the striking vehicle about their CGs, kg m².
    pub yaw_inertia_kg_m2: [f64; 2],
    /// Velocity of the striking vehicle relative to the struck vehicle, `[x, y]`, m/s.
    pub relative_velocity_m_s: [f64; 2],
    /// Yaw rates of the struck and the striking vehicle, rad/s, counter-clockwise positive.
    pub yaw_rate_rad_s: [f64; 2],
    /// Heading of the striking vehicle relative to that of the struck vehicle, rad,
    /// counter-clockwise positive.
    pub theta_b_rad: f64,
    /// Point of first contact in body axes of the struck vehicle, from its CG, m.
    pub contact_m: [f64; 2],
    /// Index of the kind of body of the striking vehicle in [`CrushLaw::bodies`].
    pub body_idx: usize,
    /// Index of the kind of body of the struck vehicle in [`CrushLaw::struck_bodies`]; none where the
    /// shared parameters hold.
    pub struck_body_idx: Option<usize>,
}

/// Result of a simulation: one value for each time step; zeros after the vehicles have separated.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CrushHistory {
    /// Force on the struck vehicle along x in the axes of the scenario, N.
    pub fx_n: Vec<f64>,
    /// Force on the struck vehicle along y in the axes of the scenario, N.
    pub fy_n: Vec<f64>,
    /// Largest overlap of the outlines, m; zero if they do not overlap.
    pub depth_m: Vec<f64>,
    /// Sliding velocity of the striking vehicle along the struck vehicle, averaged over the
    /// elements with their normal forces as weights, m/s.
    pub slip_m_s: Vec<f64>,
}

impl CrushHistory {
    fn zero(n_steps: usize) -> Self {
        let zero = || vec![0.0; n_steps];
        Self { fx_n: zero(), fy_n: zero(), depth_m: zero(), slip_m_s: zero() }
    }
}

/// Position and velocity of a rigid body in the plane, in the axes of the scenario.
#[derive(Debug, Clone, Copy)]
struct Body {
    position_m: [f64; 2],
    yaw_rad: f64,
    velocity_m_s: [f64; 2],
    yaw_rate_rad_s: f64,
}

impl Body {
    /// One step of the symplectic Euler method: the velocities are updated first, and the positions
    /// with the new velocities.
    fn step(&mut self, [fx, fy]: [f64; 2], moment: f64, [mass, inertia]: [f64; 2], dt_s: f64) {
        self.velocity_m_s[0] += dt_s * fx / mass;
        self.velocity_m_s[1] += dt_s * fy / mass;
        self.yaw_rate_rad_s += dt_s * moment / inertia;
        self.position_m[0] += dt_s * self.velocity_m_s[0];
        self.position_m[1] += dt_s * self.velocity_m_s[1];
        self.yaw_rad += dt_s * self.yaw_rate_rad_s;
    }
}

/// Forces and moments of all elements together in one step.
#[derive(Debug, Clone, Copy, Default)]
struct CrushContact {
    force_n: [f64; 2],
    struck_moment_n_m: f64,
    striking_moment_n_m: f64,
    /// Largest overlap, m; a negative value is the gap.
    depth_m: f64,
    slip_force_w: f64,
    force_sum_n: f64,
}

/// The elements of the outline, the largest loads that they have carried, and the constants of a
/// simulation.
struct Springs<'a> {
    law: &'a CrushLaw,
    knots: &'a CrushKnots,
    scenario: &'a CrushScenario,
    elements: Vec<Element>,
    slope: Vec<f64>,
    load_at_knot: Vec<f64>,
    /// Of the struck vehicle along its side: logarithm of the factor of its skins, their bulge, m, and the
    /// depth of its inner structure, m.
    skin_log_factor: Vec<f64>,
    skin_bulge_m: Vec<f64>,
    struck_structure_m: Vec<f64>,
    structure_stiffness: f64,
    structure_softness_m: f64,
    structure_recovery_m: f64,
    /// Friction coefficient at the reference depth.
    friction: f64,
    friction_speed_m_s: f64,
    /// Rear end of the struck vehicle relative to its rear axle, m. There is no contact behind it.
    rear_end_m: f64,
}

/// An element of the outline with what it has carried.
struct Element {
    skin: SkinElement,
    /// Depth of the inner structure of the striking vehicle, with the influence of the heading angle, m.
    structure_m: f64,
    greatest_depth_m: f64,
    load_there: Load,
}

/// Force of skins and inner structures per metre of outline, N/m.
#[derive(Debug, Clone, Copy, Default)]
struct Load {
    skin: f64,
    structure: f64,
}

impl CrushLaw {
    /// Simulates `n_steps` time steps of `dt_s` seconds from first contact on.
    ///
    /// Both vehicles are planar rigid bodies, on which the elements exert opposite forces. The
    /// motion is integrated by the symplectic Euler method. For the shipped runs, results with a
    /// step of 1 ms differ from those with 0.5 ms by far less than from the finite-element results.
    ///
    /// Returns `None` if the law has no kind of body with the index of the scenario.
    pub fn simulate(
        &self,
        scenario: &CrushScenario,
        n_steps: usize,
        dt_s: f64,
    ) -> Option<CrushHistory> {
        let mut springs = Springs::new(self, scenario)?;
        let [mut struck, mut striking] = springs.at_first_contact();
        let inertial = [0, 1].map(|i| [scenario.mass_kg[i], scenario.yaw_inertia_kg_m2[i]]);
        let mut history = CrushHistory::zero(n_steps);
        for step in 0..n_steps {
            let contact = springs.contact(&struck, &striking);
            if contact.depth_m < -PARTED_M {
                break;
            }
            let [fx, fy] = contact.force_n;
            history.fx_n[step] = fx;
            history.fy_n[step] = fy;
            history.depth_m[step] = contact.depth_m.max(0.0);
            history.slip_m_s[step] = contact.slip_force_w / (contact.force_sum_n + 1.0);
            struck.step([fx, fy], contact.struck_moment_n_m, inertial[0], dt_s);
            striking.step([-fx, -fy], contact.striking_moment_n_m, inertial[1], dt_s);
        }
        Some(history)
    }
}

impl<'a> Springs<'a> {
    fn new(law: &'a CrushLaw, scenario: &'a CrushScenario) -> Option<Self> {
        let body = law.bodies.get(scenario.body_idx)?;
        let struck = match scenario.struck_body_idx {
            Some(idx) => Some(law.struck_bodies.get(idx)?),
            None => None,
        };
        let knots = &law.knots;
        let corrected = |values: &[f64], of: fn(&StruckBodyCrush) -> &Vec<f64>| match struck {
            Some(struck) => sums(values, of(struck)),
            None => values.to_vec(),
        };
        let angle = scenario.theta_b_rad - REFERENCE_ANGLE_RAD;
        let by_angle = law.structure_depth_angle_m_rad * angle;
        let striking_structure_m = sums(&law.striking_structure_depth_m, &body.structure_depth_m);
        let element = |skin: SkinElement| {
            let along = skin.position_body_m[0] - body.nose.corner_x_m;
            let depth = linear(&knots.striking_structure_m, &striking_structure_m, along);
            Element {
                skin,
                structure_m: depth + by_angle,
                greatest_depth_m: 0.0,
                load_there: Load::default(),
            }
        };
        let elements = body.nose.elements(&body.outline_log_factor, knots.side_and_front_m);
        let log_slope = corrected(&law.depth_log_stiffness, |struck| &struck.depth_log_factor);
        let log_slope = sums(&log_slope, &body.depth_log_factor);
        let slope: Vec<f64> = log_slope.into_iter().map(f64::exp).collect();
        let mut load_at_knot = vec![0.0];
        for (slope, ends) in slope.iter().zip(knots.depth_m.windows(2)) {
            load_at_knot.push(load_at_knot.last()? + slope * (ends[1] - ends[0]));
        }
        let structure_log_factor =
            body.structure_log_factor + struck.map_or(0.0, |struck| struck.structure_log_factor);
        Some(Self {
            law,
            knots,
            scenario,
            elements: elements.into_iter().map(element).collect(),
            slope,
            load_at_knot,
            skin_log_factor: corrected(&law.skin_log_factor, |struck| &struck.skin_log_factor),
            skin_bulge_m: corrected(&law.skin_bulge_m, |struck| &struck.skin_bulge_m),
            struck_structure_m: corrected(&law.struck_structure_depth_m, |struck| {
                &struck.structure_depth_m
            }),
            structure_stiffness: (law.structure_log_stiffness + structure_log_factor).exp(),
            structure_softness_m: law.structure_log_softness.exp(),
            structure_recovery_m: law.structure_log_recovery.exp(),
            friction: law.friction
                + body.friction
                + law.friction_angle_1_rad * angle
                + struck.map_or(0.0, |struck| struck.friction),
            friction_speed_m_s: law.friction_log_speed.exp(),
            rear_end_m: law.rear_end_m(),
        })
    }

    /// The struck and the striking vehicle at first contact: the struck vehicle at rest at the
    /// origin, and the striking vehicle at the position where its outline touches the point of
    /// contact, with the relative velocity.
    fn at_first_contact(&self) -> [Body; 2] {
        let scenario = self.scenario;
        let body = &self.law.bodies[scenario.body_idx];
        let [x, y] = body.nose.touching_point_m(scenario.theta_b_rad);
        let (sin, cos) = scenario.theta_b_rad.sin_cos();
        let [contact_x, contact_y] = scenario.contact_m;
        let struck = Body {
            position_m: [0.0; 2],
            yaw_rad: 0.0,
            velocity_m_s: [0.0; 2],
            yaw_rate_rad_s: scenario.yaw_rate_rad_s[0],
        };
        let striking = Body {
            position_m: [contact_x - (cos * x - sin * y), contact_y - (sin * x + cos * y)],
            yaw_rad: scenario.theta_b_rad,
            velocity_m_s: scenario.relative_velocity_m_s,
            yaw_rate_rad_s: scenario.yaw_rate_rad_s[1],
        };
        [struck, striking]
    }

    fn contact(&mut self, struck: &Body, striking: &Body) -> CrushContact {
        let turn_struck = struck.yaw_rad.sin_cos();
        let turn_striking = striking.yaw_rad.sin_cos();
        let turn_between = (striking.yaw_rad - struck.yaw_rad).sin_cos();
        let mut sum = CrushContact { depth_m: f64::NEG_INFINITY, ..CrushContact::default() };
        for i in 0..self.elements.len() {
            let element = self.elements[i].skin;
            let arm_striking = turned(turn_striking, element.position_body_m);
            let arm_struck: [f64; 2] = std::array::from_fn(|a| {
                striking.position_m[a] + arm_striking[a] - struck.position_m[a]
            });
            let [x, y] = turned_back(turn_struck, arm_struck);
            let depth = y - self.scenario.contact_m[1];
            let place = x - self.law.rear_axle_x_m;
            if depth > MAX_DEPTH_M || place < self.rear_end_m {
                continue;
            }
            sum.depth_m = sum.depth_m.max(depth);
            if depth <= 0.0 {
                continue;
            }
            let load = self.load(i, depth, place);
            let total = load.skin + load.structure;
            if total <= 0.0 {
                continue;
            }
            let share = load.structure / total;
            let velocity = turned_back(
                turn_struck,
                [
                    striking.velocity_m_s[0]
                        - striking.yaw_rate_rad_s * arm_striking[1]
                        - (struck.velocity_m_s[0] - struck.yaw_rate_rad_s * arm_struck[1]),
                    striking.velocity_m_s[1] + striking.yaw_rate_rad_s * arm_striking[0]
                        - (struck.velocity_m_s[1] + struck.yaw_rate_rad_s * arm_struck[0]),
                ],
            );
            let damping = (1.0 + self.law.damping_s_m * velocity[1]).max(0.0);
            let normal_force = total * element.length_m * damping;
            let deepest = self.elements[i].greatest_depth_m - REFERENCE_DEPTH_M;
            let normal =
                self.normal(turned(turn_between, element.normal_body), [deepest, place, share]);
            let slip = velocity[0] * normal[1] - velocity[1] * normal[0];
            let friction = self.friction([deepest, share], slip);
            let local = [
                normal_force * (normal[0] + friction * normal[1]),
                normal_force * (normal[1] - friction * normal[0]),
            ];
            let [fx, fy] = turned(turn_struck, local);
            sum.force_n[0] += fx;
            sum.force_n[1] += fy;
            sum.struck_moment_n_m += arm_struck[0] * fy - arm_struck[1] * fx;
            sum.striking_moment_n_m -= arm_striking[0] * fy - arm_striking[1] * fx;
            sum.slip_force_w += slip * normal_force;
            sum.force_sum_n += normal_force;
        }
        sum
    }

    /// Load of element `i` per metre of outline. If the overlap exceeds the largest so far, the
    /// load follows the loading curve and is stored; otherwise it follows the unloading curve.
    fn load(&mut self, i: usize, depth_m: f64, place_m: f64) -> Load {
        let element = &self.elements[i];
        let greatest = element.greatest_depth_m;
        if depth_m < greatest {
            return self.unloaded(element.load_there, greatest, greatest - depth_m);
        }
        let knots = self.knots;
        let crush = depth_m + linear(&knots.skin_m, &self.skin_bulge_m, place_m);
        let skin = if crush > 0.0 {
            let above = knots.depth_m.iter().rposition(|knot| *knot <= crush).unwrap_or(0);
            let within = crush - knots.depth_m[above];
            let place_factor = linear(&knots.skin_m, &self.skin_log_factor, place_m).exp();
            (self.load_at_knot[above] + self.slope[above] * within)
                * element.skin.factor
                * place_factor
        } else {
            0.0
        };
        let struck_structure = linear(&knots.struck_structure_m, &self.struck_structure_m, place_m);
        let overlap = depth_m - struck_structure - element.structure_m;
        let structure = self.structure_stiffness * softplus(overlap, self.structure_softness_m);
        let load = Load { skin, structure };
        let element = &mut self.elements[i];
        (element.greatest_depth_m, element.load_there) = (depth_m, load);
        load
    }

    /// Load that remains of the largest load after the overlap has decreased by `back_m` from its
    /// largest value.
    fn unloaded(&self, load: Load, greatest_m: f64, back_m: f64) -> Load {
        let law = self.law;
        let recovery = law.bodies[self.scenario.body_idx].recovery;
        let relative = greatest_m / REFERENCE_DEPTH_M;
        let length = REFERENCE_DEPTH_M * recovery * relative.powf(law.recovery_exponent);
        let share = |length: f64, exponent: f64| {
            let left = 1.0 - back_m / length.max(MIN_RECOVERY_M);
            if left > 0.0 { left.powf(exponent) } else { 0.0 }
        };
        Load {
            skin: load.skin * share(length, law.unloading_exponent),
            structure: load.structure
                * share(self.structure_recovery_m, law.structure_unloading_exponent),
        }
    }

    /// Direction of the normal force in axes of the struck vehicle: between the normal of the
    /// struck vehicle (+y) and that of the striking vehicle, tilted where the depth of the inner
    /// structure of the struck vehicle has a slope.
    ///
    /// - `deepest_m`: largest overlap of the element so far, less the reference of 0.1 m.
    fn normal(
        &self,
        striking_normal: [f64; 2],
        [deepest_m, place_m, structure_share]: [f64; 3],
    ) -> [f64; 2] {
        let law = self.law;
        let share = law.normal_share
            + law.normal_share_depth_1_m * deepest_m
            + law.normal_share_place_1_m * place_m;
        let rise = slope(&self.knots.struck_structure_m, &self.struck_structure_m, place_m);
        let tilt = law.structure_tilt * structure_share * rise;
        let [x, y] = [share * striking_normal[0] - tilt, 1.0 - share + share * striking_normal[1]];
        let length = x.hypot(y) + 1e-9;
        [x / length, y / length]
    }

    fn friction(&self, [deepest_m, structure_share]: [f64; 2], slip_m_s: f64) -> f64 {
        let law = self.law;
        let limit = self.friction
            + law.friction_depth_1_m * deepest_m
            + law.structure_friction * structure_share;
        limit * (slip_m_s / self.friction_speed_m_s).tanh()
    }
}

fn turned((sin, cos): (f64, f64), [x, y]: [f64; 2]) -> [f64; 2] {
    [cos * x - sin * y, sin * x + cos * y]
}

fn turned_back((sin, cos): (f64, f64), [x, y]: [f64; 2]) -> [f64; 2] {
    [cos * x + sin * y, cos * y - sin * x]
}

fn softplus(x: f64, width: f64) -> f64 {
    let ratio = x / width;
    if ratio > 30.0 { x } else { width * ratio.exp().ln_1p() }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::{BodyCrush, Nose};
    use super::*;

    pub(crate) fn example() -> CrushScenario {
        CrushScenario {
            mass_kg: [2000.0, 1500.0],
            yaw_inertia_kg_m2: [3600.0, 2700.0],
            relative_velocity_m_s: [1.0, 3.0],
            yaw_rate_rad_s: [0.0; 2],
            theta_b_rad: 0.35,
            contact_m: [-1.5, -0.925],
            body_idx: 0,
            struck_body_idx: None,
        }
    }

    pub(crate) fn law() -> CrushLaw {
        let knots = CrushKnots::default();
        let struck = ["A", "B"].map(|name| StruckBodyCrush::prior(name, &knots)).to_vec();
        CrushLaw::prior(vec![BodyCrush::prior("A", Nose::default(), &knots)], struck, [-1.54, -2.5])
    }

    #[test]
    fn the_striking_pushes_and_the_cars_part() {
        let history = law().simulate(&example(), 250, 1e-3).unwrap();
        let impulse: f64 = history.fy_n.iter().sum::<f64>() * 1e-3;
        // The impulse lies between that which stops the approach of the contact points and that
        // with e = 1.
        assert!((500.0..6000.0).contains(&impulse), "{impulse}");
        assert_eq!(history.fy_n.last(), Some(&0.0));
        assert!(history.fy_n.iter().all(|force| force.is_finite()));
    }

    #[test]
    fn twice_the_steps_give_the_same_impulse() {
        let impulse = |n: usize| {
            let history = law().simulate(&example(), 250 * n, 1e-3 / n as f64).unwrap();
            [history.fx_n, history.fy_n].map(|f| f.iter().sum::<f64>() * 1e-3 / n as f64)
        };
        let ([x, y], [fine_x, fine_y]) = (impulse(1), impulse(4));
        assert!((x - fine_x).hypot(y - fine_y) < 0.02 * fine_x.hypot(fine_y), "{x} {y} {fine_x}");
    }

    #[test]
    fn contact_dissipates_energy() {
        // Only the translational part of the kinetic energy is compared.
        let scenario = example();
        let history = law().simulate(&scenario, 250, 1e-3).unwrap();
        let [px, py] = [&history.fx_n, &history.fy_n].map(|f| f.iter().sum::<f64>() * 1e-3);
        let [mt, mb] = scenario.mass_kg;
        let [vx, vy] = scenario.relative_velocity_m_s;
        let before = 0.5 * mb * (vx * vx + vy * vy);
        let translation = 0.5 * (px * px + py * py) / mt
            + 0.5 * mb * ((vx - px / mb).powi(2) + (vy - py / mb).powi(2));
        assert!(translation < before, "{translation} {before}");
    }

    #[test]
    fn an_unknown_body_is_none() {
        assert_eq!(law().simulate(&CrushScenario { body_idx: 3, ..example() }, 1, 1e-3), None);
        let struck = CrushScenario { struck_body_idx: Some(2), ..example() };
        assert_eq!(law().simulate(&struck, 1, 1e-3), None);
    }

    #[test]
    fn a_stiffer_struck_body_is_crushed_less() {
        let mut law = law();
        law.struck_bodies[1].depth_log_factor.fill(0.5);
        let depth = |struck_body_idx| {
            let history = law.simulate(&CrushScenario { struck_body_idx, ..example() }, 250, 1e-3);
            history.unwrap().depth_m.into_iter().fold(0.0, f64::max)
        };
        assert_eq!(depth(Some(0)), depth(None), "no correction");
        assert!(depth(Some(1)) < 0.95 * depth(None), "{} {}", depth(Some(1)), depth(None));
    }
}
