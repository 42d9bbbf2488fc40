//! The contact force of two outlines at given poses and velocities.
//!
//! Each element of one vehicle that lies inside of the outline of the other one is a strip of its
//! face law, in series with the strip at its foot, for the overlap D of the outlines as they were
//! before any deformation (`law.rs`, `outline.rs`). Two half passes are taken, the elements of the
//! struck vehicle in the outline of the striking one and the reverse, each with half the force:
//!
//! ```text
//! N = ½ p w max(0, −n_element · n_face)      along the normal of the entered face
//! T = −μ_c N clip(v_t/ζ, ±1)                 along its tangent
//! ```
//!
//! Where a face is pressed in again, below its greatest deflection, p is multiplied by 1 + c v_n, with
//! the speed of approach v_n, up to p_h. The face law by itself gives everything back there, so that
//! vehicles that push each other would bounce without end. Unloading is that of the face law.
//!
//! Each half pass has the histories of the strips on both of its sides to itself: the overlaps of the two
//! passes differ by a few per cent, which is as much as a crushed strip gives back.
//!
//! Both act at the place where the two deformed faces meet, so that force and moment on one vehicle are
//! the opposite of those on the other one to the last digit.
//! Of each outline one face at a time is entered: that which is penetrated least along the direction
//! in which the outlines overlap,
//!
//! ```text
//! min over faces of D_max/(−n_face · N)        N: direction of Σ w n over the elements inside
//! ```
//!
//! with the largest depth D_max of an element below it. The sum of the normals of one outline inside of
//! the other one is normal to the line between the two places where the outlines cross. So all of a side
//! that slides along a nose is pressed by the nose, and a corner that is deep in a side near its end
//! still is in the side.
//!
//! Source: two passes and strips in series replace the balance of pressures along radial vectors of
//! [`EdsmacManual`](crate::bibliography::EdsmacManual); full friction from a sliding speed ζ on is its,
//! too. Assumes contact at one stated height, and neighbouring elements that do not hold each other.
//! Leaves out: mounting and hooking of one vehicle on the other one, tearing, wheels, what resists a dent
//! that is drawn along a face, and two places of contact at a time that lie at different faces of one
//! vehicle.

use crate::collision::Side;
use crate::collision::contact::bodies::Relative;
use crate::collision::contact::half_pass::{PassSums, PressedElement, total};
use crate::collision::contact::outline::Foot;
use crate::collision::contact::press::{Pressing, press_side_by_side};
use crate::collision::contact::{
    ContactBody, ContactConditions, FaceLaw, PlanarMotion, PressedStrips, Strip,
};

/// Deepest overlap of an element that counts, m; one that is deeper has passed to the other side.
const LARGEST_OVERLAP_M: f64 = 1.5;

/// Factor on the way along which the face that is entered is penetrated, so that it does not change to
/// and fro.
const KEPT_FACE: f64 = 0.7;

/// Least share of the direction of overlap that counts along the normal of a face.
const LEAST_SHARE: f64 = 0.02;

/// Compliance on unloading of the strip that gives back least, m²/N.
const LEAST_COMPLIANCE_M2_PER_N: f64 = 1e-12;

/// What the vehicles do to each other at an instant. The striking vehicle has the opposite force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// Force `[F_X, F_Y]` on the struck vehicle, world axes, N.
    pub force_world_n: [f64; 2],
    /// Yaw moments on the struck and on the striking vehicle about their CGs, N m.
    pub yaw_moments_n_m: [f64; 2],
    /// Mean place of the forces of the elements, weighted by them, world axes, m.
    pub point_world_m: [f64; 2],
    /// Sum N of the normal loads of both half passes, N.
    pub normal_load_n: f64,
    /// Largest overlap of an element that carries a load, m.
    pub overlap_m: f64,
    /// Stiffness of the contact on unloading, N/m.
    pub unloading_stiffness_n_per_m: f64,
    /// Power that friction turns into heat, W.
    pub friction_power_w: f64,
    /// Power of the approach of the faces against the normal loads, W; negative as they part.
    pub normal_power_w: f64,
}

/// What an element remembers.
#[derive(Debug, Clone, Copy)]
struct ElementMemory {
    /// Its strip in the half pass of its own vehicle, and as a partner in the other one.
    strips: [Strip<f64>; 2],
    /// Overlap D and load p at the last evaluation, m and N/m.
    overlap_m: f64,
    load_n_per_m: f64,
    /// Elastic energy that it and its partner store for it, J.
    stored_j: f64,
}

/// A strip that was pressed in further than ever before.
#[derive(Debug, Clone, Copy)]
struct Grown {
    vehicle: usize,
    element: usize,
    /// 0 for the half pass of the vehicle, 1 for the other one.
    role: usize,
    strip: Strip<f64>,
}

/// An element inside of the other outline.
#[derive(Debug, Clone, Copy)]
struct InsideElement {
    idx: usize,
    /// Its reference point from the middle of the other outline, in body axes of the other vehicle, m.
    point_m: [f64; 2],
}

/// An element that presses on the one at its foot.
#[derive(Debug, Clone, Copy)]
struct TouchingElement {
    /// Its vehicle.
    own: usize,
    idx: usize,
    /// As of [`InsideElement`].
    point_m: [f64; 2],
    foot: Foot,
    /// Width on which the load acts, m.
    weight_m: f64,
}

impl ContactForce {
    /// The same with all loads multiplied by a factor.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            force_world_n: self.force_world_n.map(|force| factor * force),
            yaw_moments_n_m: self.yaw_moments_n_m.map(|moment| factor * moment),
            normal_load_n: factor * self.normal_load_n,
            unloading_stiffness_n_per_m: factor * self.unloading_stiffness_n_per_m,
            friction_power_w: factor * self.friction_power_w,
            normal_power_w: factor * self.normal_power_w,
            ..self
        }
    }
}

impl ElementMemory {
    /// An element that nothing has pressed yet.
    fn new(face: &FaceLaw) -> Self {
        let strips = [face.after(0.0); 2];
        Self { strips, overlap_m: 0.0, load_n_per_m: 0.0, stored_j: 0.0 }
    }

    fn deepest_m(&self) -> f64 {
        self.strips[0].greatest_m.max(self.strips[1].greatest_m)
    }
}

/// Two outlines with the history of their contact. It begins with vehicles that are not damaged.
#[derive(Debug, Clone)]
pub struct PairContact<'a> {
    bodies: [ContactBody<'a>; 2],
    conditions: ContactConditions,
    memory: [Vec<ElementMemory>; 2],
    /// The face of each outline that is entered; `None` while no element of the other one is inside.
    entered: [Option<Side>; 2],
    /// Groups of elements of each vehicle that may carry a load.
    is_near: [Vec<bool>; 2],
    /// Elements of each vehicle inside of the other outline.
    inside: [Vec<InsideElement>; 2],
    /// Elements of both half passes that press, with their strips and what these do to each other.
    touching: Vec<TouchingElement>,
    pressings: Vec<Pressing>,
    pressed: Vec<PressedStrips<f64>>,
    /// Strips that an evaluation has pressed in further.
    grown: Vec<Grown>,
    is_loaded: bool,
    law_work_j: f64,
}

impl<'a> PairContact<'a> {
    /// Two vehicles that are not damaged.
    ///
    /// - `bodies`: the struck and the striking vehicle.
    pub fn new(bodies: [ContactBody<'a>; 2], conditions: ContactConditions) -> Self {
        let fresh = |body: &ContactBody<'_>| -> Vec<ElementMemory> {
            let elements = body.outline.elements().iter();
            elements.map(|element| ElementMemory::new(body.faces.at(element.face))).collect()
        };
        Self {
            memory: [fresh(&bodies[0]), fresh(&bodies[1])],
            is_near: bodies.map(|body| vec![false; body.outline.groups().len()]),
            bodies,
            entered: [None; 2],
            inside: [Vec::new(), Vec::new()],
            conditions,
            touching: Vec::new(),
            pressings: Vec::new(),
            pressed: Vec::new(),
            grown: Vec::new(),
            is_loaded: false,
            law_work_j: 0.0,
        }
    }

    /// Depth of the dents that stay, (1 − ρ) h, of the elements of each vehicle, m.
    pub fn dents_m(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|i| {
            let elements = self.bodies[i].outline.elements().iter().zip(&self.memory[i]);
            let dent_m = |face, greatest_m| self.bodies[i].faces.at(face).after(greatest_m).dent_m;
            elements.map(|(element, memory)| dent_m(element.face, memory.deepest_m())).collect()
        })
    }

    /// Elastic energy of both vehicles, J.
    pub fn stored_energy_j(&self) -> f64 {
        self.memory.iter().flatten().map(|element| element.stored_j).sum()
    }

    /// Work of the face laws so far, `Σ w ∫p dD`, J: the elastic energy and what unloading has turned
    /// into heat. Where elements are pressed straight in, that is the work which the vehicles have done
    /// against the normal loads. Where they slide along, an overlap may grow without that work: nothing
    /// resists a dent that is drawn along a face but friction.
    pub fn law_work_j(&self) -> f64 {
        self.law_work_j
    }

    /// Multiplies all loads of the face laws by a factor, those that the elements carry included.
    ///
    /// - `factor`: more than 0.
    pub fn scale_loads(&mut self, factor: f64) {
        for (body, memory) in self.bodies.iter_mut().zip(&mut self.memory) {
            body.faces = body.faces.map(|face| face.scaled(factor));
            for (memory, element) in memory.iter_mut().zip(body.outline.elements()) {
                let face = body.faces.at(element.face);
                memory.strips = memory.strips.map(|strip| face.after(strip.greatest_m));
                memory.load_n_per_m *= factor;
                memory.stored_j *= factor;
            }
        }
        self.law_work_j *= factor;
    }

    /// Takes from the elements what they carry: the strips that press each other are taken to have been
    /// pressed in further, so far that they lie at their dents now.
    pub fn unload(&mut self) {
        for (touching, pressed) in self.touching.iter().zip(&self.pressed) {
            let TouchingElement { own, idx, foot, .. } = *touching;
            if pressed.load_n_per_m <= 0.0 {
                continue;
            }
            let sides = [(own, idx), (1 - own, foot.element)];
            for (role, ((vehicle, element), dent_m)) in
                sides.into_iter().zip(pressed.deflections_m).enumerate()
            {
                let body = &self.bodies[vehicle];
                let face = body.faces.at(body.outline.elements()[element].face);
                let strip = &mut self.memory[vehicle][element].strips[role];
                let unloaded = face.with_dent(dent_m);
                if unloaded.greatest_m > strip.greatest_m {
                    *strip = unloaded;
                }
            }
            let memory = &mut self.memory[own][idx];
            (memory.load_n_per_m, memory.stored_j) = (0.0, 0.0);
        }
    }

    /// Whether the outlines are so far apart that no element can touch within a distance.
    ///
    /// - `margin_m`: the distance.
    pub fn is_apart(&self, motions: &[PlanarMotion; 2], margin_m: f64) -> bool {
        (0..2).any(|other| {
            let relative = Relative::new(motions, 1 - other);
            let [bodies_half_m, own_half_m] =
                [other, 1 - other].map(|i| self.bodies[i].outline.half_m());
            let own_middle_m = self.bodies[1 - other].outline.middle_x_m();
            let [x, y] = relative.entered_from_own([own_middle_m, 0.0]);
            let [sin, cos] = relative.turn.map(f64::abs);
            let x = x - self.bodies[other].outline.middle_x_m();
            let reach_x_m = own_half_m[0] * cos + own_half_m[1] * sin + bodies_half_m[0];
            let reach_y_m = own_half_m[0] * sin + own_half_m[1] * cos + bodies_half_m[1];
            x.abs() > reach_x_m + margin_m || y.abs() > reach_y_m + margin_m
        })
    }

    /// Evaluates the contact and lets the histories of its elements grow; `None` without a force.
    ///
    /// - `motions`: of the struck and the striking vehicle.
    pub fn advance(&mut self, motions: &[PlanarMotion; 2]) -> Option<ContactForce> {
        if !self.is_loaded && self.is_apart(motions, 0.0) {
            self.entered = [None; 2];
            return None;
        }
        let relatives = [0, 1].map(|own| Relative::new(motions, own));
        let sums_m = [0, 1].map(|own| self.find_inside(own, &relatives[own]));
        for own in 0..2 {
            let ([x, y], [dx, dy]) = (relatives[own].turned(sums_m[own]), sums_m[1 - own]);
            self.enter(1 - own, [x - dx, y - dy]);
        }
        self.pressings.clear();
        self.touching.clear();
        (0..2).for_each(|own| self.find_touching(own, &relatives[own]));
        let sums = self.press_all(&relatives);
        for Grown { vehicle, element, role, strip } in self.grown.drain(..) {
            let known = &mut self.memory[vehicle][element].strips[role];
            if strip.greatest_m > known.greatest_m {
                *known = strip;
            }
        }
        self.is_loaded = sums.iter().any(|sums| sums.size_n > 0.0);
        self.is_loaded.then(|| total(&sums, motions))
    }

    /// Finds the elements of one vehicle inside of the outline of the other one.
    ///
    /// - returns the sum of their normals times widths, in body axes of the vehicle, m.
    fn find_inside(&mut self, own: usize, relative: &Relative) -> [f64; 2] {
        let entered = self.bodies[1 - own].outline;
        let (middle_x_m, [half_length_m, half_width_m]) = (entered.middle_x_m(), entered.half_m());
        let mut sum_m = [0.0; 2];
        let mut inside = std::mem::take(&mut self.inside[own]);
        inside.clear();
        let outline = self.bodies[own].outline;
        for (number, group) in outline.groups().iter().enumerate() {
            let [x, y] = relative.entered_from_own(group.middle_body_m);
            let is_near = (x - middle_x_m).abs() < half_length_m + group.radius_m
                && y.abs() < half_width_m + group.radius_m;
            if !is_near && !self.is_near[own][number] {
                continue;
            }
            self.is_near[own][number] = is_near;
            for idx in group.elements.clone() {
                let element = outline.elements()[idx];
                let [x, y] = relative.entered_from_own(element.point_body_m);
                let point_m = [x - middle_x_m, y];
                if point_m[0].abs() >= half_length_m || point_m[1].abs() >= half_width_m {
                    self.release(own, idx);
                    continue;
                }
                for (sum, normal) in sum_m.iter_mut().zip(element.normal_body) {
                    *sum += normal * element.width_m;
                }
                inside.push(InsideElement { idx, point_m });
            }
        }
        self.inside[own] = inside;
        sum_m
    }

    /// Chooses the face of an outline that is entered by the elements inside.
    ///
    /// - `along`: direction in which the other vehicle overlaps it, in its body axes, of any length.
    fn enter(&mut self, entered: usize, along: [f64; 2]) {
        let outline = self.bodies[entered].outline;
        let mut largest_m = [f64::NEG_INFINITY; 4];
        for element in &self.inside[1 - entered] {
            for (largest, depth) in largest_m.iter_mut().zip(outline.depths_m(element.point_m)) {
                *largest = largest.max(depth);
            }
        }
        let size = along[0].hypot(along[1]);
        if self.inside[1 - entered].is_empty() || size <= 0.0 {
            self.entered[entered] = None;
            return;
        }
        let shares = [-along[0], -along[1], along[0], along[1]].map(|share| share / size);
        let mut best = (f64::INFINITY, None);
        for (i, side) in Side::ALL.into_iter().enumerate() {
            let kept = if self.entered[entered] == Some(side) { KEPT_FACE } else { 1.0 };
            let way_m = kept * largest_m[i] / shares[i].max(LEAST_SHARE);
            if way_m < best.0 {
                best = (way_m, Some(side));
            }
        }
        self.entered[entered] = best.1;
    }

    /// Finds the elements of one vehicle that press on the face of the other one.
    fn find_touching(&mut self, own: usize, relative: &Relative) {
        let Some(face) = self.entered[1 - own] else { return };
        let entered = self.bodies[1 - own].outline;
        let inside = std::mem::take(&mut self.inside[own]);
        for &InsideElement { idx, point_m } in &inside {
            let element = self.bodies[own].outline.elements()[idx];
            let normal = relative.turned(element.normal_body);
            let against =
                |foot: &Foot| -(normal[0] * foot.normal_body[0] + normal[1] * foot.normal_body[1]);
            let pressing = |foot: &Foot| foot.depth_m < LARGEST_OVERLAP_M && against(foot) > 0.0;
            let Some(foot) = entered.foot(face, point_m).filter(pressing) else {
                self.release(own, idx);
                continue;
            };
            let weight_m = 0.5 * element.width_m * against(&foot);
            let strips =
                [self.memory[own][idx].strips[0], self.memory[1 - own][foot.element].strips[1]];
            self.pressings.push(Pressing { strips, overlap_m: foot.depth_m });
            self.touching.push(TouchingElement { own, idx, point_m, foot, weight_m });
        }
        self.inside[own] = inside;
    }

    /// Presses all elements that touch, and sums up each half pass.
    fn press_all(&mut self, relatives: &[Relative; 2]) -> [PassSums; 2] {
        let mut sums = [PassSums::default(); 2];
        press_side_by_side(&self.pressings, &mut self.pressed);
        for number in 0..self.touching.len() {
            let (touching, strips) = (self.touching[number], self.pressings[number].strips);
            let TouchingElement { own, point_m, foot, .. } = touching;
            let pressed = self.press(&touching, &strips, self.pressed[number]);
            if pressed.load_n > 0.0 {
                let [nx, ny] = foot.normal_body;
                let [x, y] = [point_m[0] + self.bodies[1 - own].outline.middle_x_m(), point_m[1]];
                let place_m = [x + pressed.deflection_m * nx, y + pressed.deflection_m * ny];
                let sums = &mut sums[own];
                sums.overlap_m = sums.overlap_m.max(foot.depth_m);
                sums.unloading_stiffness_n_per_m += pressed.unloading_stiffness_n_per_m;
                sums.add(&pressed, &self.conditions, place_m, foot.normal_body, &relatives[own]);
            }
        }
        sums
    }

    /// The element has no load any more.
    fn release(&mut self, own: usize, idx: usize) {
        let memory = &mut self.memory[own][idx];
        self.law_work_j -= memory.stored_j;
        (memory.load_n_per_m, memory.stored_j) = (0.0, 0.0);
    }

    /// Takes note of what an element and the one at its foot do to each other.
    ///
    /// - `strips`: their strips before this evaluation.
    fn press(
        &mut self,
        touching: &TouchingElement,
        strips: &[Strip<f64>; 2],
        pressed: PressedStrips<f64>,
    ) -> PressedElement {
        let TouchingElement { own, idx, foot, weight_m, .. } = *touching;
        let sides = [(own, idx), (1 - own, foot.element)];
        let load_n_per_m = pressed.load_n_per_m;
        if load_n_per_m <= 0.0 {
            self.release(own, idx);
            return PressedElement::default();
        }
        let mut compliance_m2_per_n = 0.0;
        let limit_n_per_m = strips[0].load_there_n_per_m.min(strips[1].load_there_n_per_m);
        let is_below = (0..2).all(|i| pressed.deflections_m[i] <= strips[i].greatest_m);
        for i in 0..2 {
            let (vehicle, element) = sides[i];
            let deflection_m = pressed.deflections_m[i];
            let mut strip = strips[i];
            if deflection_m > strip.greatest_m {
                let body = &self.bodies[vehicle];
                strip = body.faces.at(body.outline.elements()[element].face).after(deflection_m);
                self.grown.push(Grown { vehicle, element, role: i, strip });
            }
            compliance_m2_per_n += strip.unloading_compliance_m2_per_n();
        }
        let memory = &mut self.memory[own][idx];
        let before_m = match memory.load_n_per_m > 0.0 {
            true => memory.overlap_m,
            false => strips[0].dent_m + strips[1].dent_m,
        };
        let mean_load = (load_n_per_m + memory.load_n_per_m) / 2.0;
        self.law_work_j += weight_m * mean_load * (foot.depth_m - before_m);
        memory.overlap_m = foot.depth_m;
        memory.load_n_per_m = load_n_per_m;
        memory.stored_j = weight_m * load_n_per_m * load_n_per_m * compliance_m2_per_n / 2.0;
        PressedElement {
            load_n: load_n_per_m * weight_m,
            limit_n: is_below.then(|| limit_n_per_m.max(load_n_per_m) * weight_m),
            deflection_m: pressed.deflections_m[0],
            unloading_stiffness_n_per_m: weight_m
                / compliance_m2_per_n.max(LEAST_COMPLIANCE_M2_PER_N),
        }
    }
}
