//! The lower body: sections along the car from sill to bonnet, with wheel arches cut out.

use std::f64::consts::PI;

use crate::scene::cabin_mesh::add_cabin;
use crate::scene::mesh::{Mesh, between};
use crate::scene::proportions::Proportions;
use crate::scene::{BodyClass, CarBody, Surface};

/// Radius of a wheel arch over that of the wheel.
const ARCH_RATIO: f64 = 1.15;
/// Straight pieces by which a wheel arch is drawn.
const ARCH_PIECES: usize = 8;
/// Smallest distance of two sections, as a share of the length.
const LEAST_DISTANCE: f64 = 5e-4;
/// Half widths of the points of a section over that of the body there: sill, flank, shoulder, edge of
/// the bonnet.
const SECTION_WIDTHS: [f64; 4] = [0.93, 1.0, 0.965, 0.86];
/// Height of the widest part of the flank, over the height of the roof.
const FLANK: f64 = 0.40;
/// How far the shoulder lies below the edge of the bonnet, and the edge below its middle, over the
/// height of the roof.
const SHOULDER_DROP: f64 = 0.045;
const CROWN: f64 = 0.012;
/// Length of the lamps from either end, as a share of the length.
const LAMP_LENGTH: f64 = 0.036;
/// Half width of what lies between wheel houses, over that of the body.
const UNDERBODY_WIDTH: f64 = 0.60;

/// How much of a car is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Detail {
    /// Everything.
    Full,
    /// Without wheel arches and the space between the wheels: for many cars at once.
    Coarse,
}

/// What a section along the body is made from.
pub(super) struct Shape<'a> {
    pub body: &'a CarBody,
    pub proportions: Proportions,
}

impl Shape<'_> {
    /// x at a place, m.
    pub fn x_m(&self, place: f64) -> f64 {
        self.body.front_m - place * self.body.length_m
    }

    /// Half width at a place, m.
    pub fn half_width_m(&self, place: f64) -> f64 {
        self.body.width_m / 2.0 * Proportions::taper(place)
    }

    /// Edge of the bonnet at a place on the left side, m: where the cabin stands.
    pub fn edge_m(&self, place: f64) -> [f64; 3] {
        let z = self.proportions.top(place) - CROWN;
        [self.x_m(place), SECTION_WIDTHS[3] * self.half_width_m(place), z * self.body.height_m]
    }

    /// Points of the left half of a section from the sill to the middle of the bonnet, m.
    fn section_m(&self, place: f64, detail: Detail) -> [[f64; 3]; 5] {
        let (x, half_m, roof_m) = (self.x_m(place), self.half_width_m(place), self.body.height_m);
        let top_m = self.proportions.top(place) * roof_m;
        let shoulder_m = top_m - (SHOULDER_DROP + CROWN) * roof_m;
        let sill_m = (self.proportions.sill * roof_m).min(0.8 * shoulder_m);
        let arch_m = if detail == Detail::Full { self.arch_m(x) } else { 0.0 };
        let low_m = sill_m.max(arch_m).min(0.93 * shoulder_m);
        let flank_m = (FLANK * roof_m).clamp(low_m, shoulder_m.max(low_m));
        let heights = [low_m, flank_m, shoulder_m, top_m - CROWN * roof_m];
        let [a, b, c, d] = std::array::from_fn(|i| [x, SECTION_WIDTHS[i] * half_m, heights[i]]);
        [a, b, c, d, [x, 0.0, top_m]]
    }

    /// Height of the edge of a wheel arch, m; 0 off the wheels.
    fn arch_m(&self, x: f64) -> f64 {
        let radius = ARCH_RATIO * self.body.wheel_radius_m;
        let [front, rear] = self.body.axles_m;
        let over = [front, -rear].map(|axle| {
            let off = x - axle;
            if off.abs() <= radius {
                self.body.wheel_radius_m + (radius * radius - off * off).max(0.0).sqrt()
            } else {
                0.0
            }
        });
        over[0].max(over[1])
    }

    /// Places of the sections, in order.
    fn places(&self, detail: Detail) -> Vec<f64> {
        let mut places = self.proportions.places();
        places.extend([LAMP_LENGTH, 1.0 - LAMP_LENGTH]);
        if detail == Detail::Full {
            let radius = ARCH_RATIO * self.body.wheel_radius_m;
            let [front, rear] = self.body.axles_m;
            for axle in [front, -rear] {
                let on_arch = (0..=ARCH_PIECES).map(|i| (PI * i as f64 / ARCH_PIECES as f64).cos());
                let along = on_arch.map(|cos| axle + radius * cos);
                let beside = [1.0, -1.0].map(|side| axle + side * (radius + 0.004));
                let place = |x: f64| (self.body.front_m - x) / self.body.length_m;
                places.extend(along.chain(beside).map(place));
            }
        }
        places.retain(|place| (0.0..=1.0).contains(place));
        places.sort_by(f64::total_cmp);
        places.dedup_by(|next, before| *next - *before < LEAST_DISTANCE);
        places
    }
}

/// Builds body and cabin of a car.
pub(super) fn body_mesh(body: &CarBody, detail: Detail) -> Mesh {
    let shape = Shape { body, proportions: Proportions::from_class(body.class) };
    let places = shape.places(detail);
    let sections: Vec<[[f64; 3]; 5]> =
        places.iter().map(|place| shape.section_m(*place, detail)).collect();
    let mut mesh = Mesh::default();
    for (place, pair) in places.windows(2).zip(sections.windows(2)) {
        add_strip(&mut mesh, [place[0], place[1]], [pair[0], pair[1]]);
    }
    if let (Some(front), Some(rear)) = (sections.first(), sections.last()) {
        add_end(&mut mesh, front, true);
        add_end(&mut mesh, rear, false);
    }
    if detail == Detail::Full {
        add_underbody(&mut mesh, &shape);
    }
    if body.class == BodyClass::Pickup {
        add_bed(&mut mesh, &shape);
    }
    add_cabin(&mut mesh, &shape);
    mesh
}

/// The surface between two neighbouring sections.
fn add_strip(mesh: &mut Mesh, [from, to]: [f64; 2], [front, rear]: [[[f64; 3]; 5]; 2]) {
    let [x, _, z] = between(front[0], rear[4], 0.5);
    for i in 0..4 {
        let surface = match i {
            1 | 2 if to <= LAMP_LENGTH + LEAST_DISTANCE => Surface::HeadLamp,
            1 | 2 if from >= 1.0 - LAMP_LENGTH - LEAST_DISTANCE => Surface::TailLamp,
            _ => Surface::Body,
        };
        let corners = [front[i], front[i + 1], rear[i + 1], rear[i]];
        mesh.add_mirrored(surface, &corners, [x, 0.0, 0.5 * z]);
    }
}

/// Front or tail: lamps at the sides, grille or body between them.
fn add_end(mesh: &mut Mesh, section: &[[f64; 3]; 5], is_front: bool) {
    let [sill, flank, shoulder, edge, middle] = *section;
    let inside = [sill[0] + if is_front { -1.0 } else { 1.0 }, 0.0, flank[2]];
    let at = |[x, y, z]: [f64; 3], share: f64| [x, y * share, z];
    let mut band = |[low, high]: [[f64; 3]; 2], [inner, outer]: [f64; 2], surface| {
        let corners = [at(low, inner), at(low, outer), at(high, outer), at(high, inner)];
        mesh.add_mirrored(surface, &corners, inside);
    };
    let lamp = if is_front { Surface::HeadLamp } else { Surface::TailLamp };
    band([sill, flank], [0.0, 1.0], Surface::Trim);
    band([flank, shoulder], [0.0, 0.5], if is_front { Surface::Trim } else { Surface::Body });
    band([flank, shoulder], [0.5, 1.0], lamp);
    band([shoulder, edge], [0.0, 1.0], Surface::Body);
    mesh.add_mirrored(Surface::Body, &[at(edge, 0.0), edge, middle], inside);
}

/// A dark box that fills what is seen through the wheel arches.
fn add_underbody(mesh: &mut Mesh, shape: &Shape<'_>) {
    let body = shape.body;
    let side = UNDERBODY_WIDTH * body.width_m / 2.0;
    let (front, rear) = (shape.x_m(0.05), shape.x_m(0.95));
    let (low, high) = (1.05 * shape.proportions.sill * body.height_m, 0.42 * body.height_m);
    let inside = [(front + rear) / 2.0, 0.0, (low + high) / 2.0];
    let wall = [[rear, side, low], [front, side, low], [front, side, high], [rear, side, high]];
    mesh.add_mirrored(Surface::Underbody, &wall, inside);
    let floor = [[front, 0.0, low], [rear, 0.0, low], [rear, side, low], [front, side, low]];
    mesh.add_mirrored(Surface::Underbody, &floor, inside);
}

/// The floor of the bed of a pickup, in a dark shade.
fn add_bed(mesh: &mut Mesh, shape: &Shape<'_>) {
    let [_, _, _, end] = shape.proportions.cabin;
    let lift = 1.3 * CROWN * shape.body.height_m;
    let corner = |place: f64, width: f64| {
        let [x, y, z] = shape.edge_m(place);
        [x, width * y, z + lift]
    };
    let (from, to) = (end + 0.025, 0.965);
    let corners = [corner(from, 0.0), corner(to, 0.0), corner(to, 0.92), corner(from, 0.92)];
    let inside = [corners[0][0], 0.0, 0.0];
    mesh.add_mirrored(Surface::Trim, &corners, inside);
}
