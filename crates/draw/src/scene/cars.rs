//! Which cars are in a picture at a time, how they look, and where their meshes stand.

use crate::scene::ground::Ground;
use crate::scene::shade::{Rgb, body_color};
use impactlab_core::collision::Pose;
use impactlab_core::vehicle::Wheel;
use impactlab_document::scene::{CarLook, CarState, GHOST_OPACITY, Mesh, SceneCar};

/// Length of a car in the picture below which it is drawn in fewer triangles, pixels.
const COARSE_BELOW_PIXELS: f64 = 60.0;
/// Opacity of each of many draws of a forecast.
const DRAW_OPACITY: f32 = 0.16;

/// A car in a picture at a time.
pub struct SeenCar<'a> {
    /// The car.
    pub car: &'a SceneCar,
    /// Where it is, and how its wheels stand.
    pub state: CarState,
    /// Opacity, 0 to 1. What is not opaque lets the ground shine through, shows its own front only, and
    /// lies behind everything that is opaque, so that this stays clear.
    pub opacity: f32,
    /// Colour of its painted body.
    pub paint: Rgb,
    /// The larger, the nearer.
    nearness: f64,
    is_coarse: bool,
    has_wheels: bool,
}

/// Which mesh of a car.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartKind {
    /// Body and cabin.
    Body,
    /// The same in fewer triangles.
    CoarseBody,
    /// A wheel.
    Wheel,
}

/// A mesh of a car at its place.
pub struct SeenPart {
    /// Which mesh.
    pub kind: PartKind,
    /// Where it stands.
    pub placed: Placed,
    /// Whether it is a wheel that is locked.
    pub is_locked: bool,
}

/// The cars that the camera may see, in the order in which they are drawn: opaque ones, then the others
/// from far to near.
pub fn seen_cars<'a>(ground: &Ground<'a>, time_s: f64) -> Vec<SeenCar<'a>> {
    let cars = ground.scene.cars.iter();
    let mut seen: Vec<SeenCar<'a>> =
        cars.filter_map(|car| SeenCar::new(ground, car, time_s)).collect();
    seen.sort_by(|a, b| {
        let is_ghost = |car: &SeenCar<'_>| car.opacity < 1.0;
        is_ghost(a).cmp(&is_ghost(b)).then(a.nearness.total_cmp(&b.nearness))
    });
    seen
}

impl<'a> SeenCar<'a> {
    /// A car at a time; `None` if it is behind the camera.
    fn new(ground: &Ground<'a>, car: &'a SceneCar, time_s: f64) -> Option<Self> {
        let state = car.at(time_s);
        let Pose { x_m, y_m, .. } = state.pose;
        let [.., nearness] = ground.projection.project([x_m, y_m, 0.0])?;
        let is_draw = car.is_draw();
        let opacity = match car.look {
            CarLook::Solid => 1.0,
            CarLook::Ghost if is_draw => DRAW_OPACITY,
            CarLook::Ghost => GHOST_OPACITY,
        };
        let length = ground.projection.pixels_per_m([x_m, y_m]) * car.shape.body.length_m;
        Some(Self {
            car,
            state,
            opacity,
            paint: body_color(car.role, ground.dark),
            nearness,
            is_coarse: is_draw || length < COARSE_BELOW_PIXELS,
            has_wheels: !is_draw,
        })
    }

    /// Its meshes.
    pub fn parts(&self) -> impl Iterator<Item = SeenPart> {
        let kind = if self.is_coarse { PartKind::CoarseBody } else { PartKind::Body };
        let body = SeenPart { kind, placed: Placed::body(&self.state), is_locked: false };
        let wheels = Wheel::ALL.into_iter().filter(|_| self.has_wheels).map(|wheel| {
            let middle_m = self.car.shape.body.wheel_m(wheel);
            let placed = Placed::wheel(&self.state, wheel, middle_m);
            SeenPart { kind: PartKind::Wheel, placed, is_locked: self.state.locked[wheel.index()] }
        });
        std::iter::once(body).chain(wheels)
    }

    /// The mesh of a part.
    pub fn mesh(&self, kind: PartKind) -> &'a Mesh {
        let shape = &self.car.shape;
        match kind {
            PartKind::Body => &shape.mesh,
            PartKind::CoarseBody => &shape.coarse,
            PartKind::Wheel => &shape.wheel,
        }
    }
}

/// Steer angle of a wheel, rad.
pub fn steer_of(state: &CarState, wheel: Wheel) -> f64 {
    match wheel {
        Wheel::FrontLeft => state.steer_rad[0],
        Wheel::FrontRight => state.steer_rad[1],
        Wheel::RearLeft | Wheel::RearRight => 0.0,
    }
}

/// Where a mesh stands, in world axes.
pub struct Placed {
    /// Its axes x, y and z.
    pub axes: [[f64; 3]; 3],
    /// Its origin, m.
    pub origin_m: [f64; 3],
}

impl Placed {
    fn body(state: &CarState) -> Self {
        let Pose { x_m, y_m, yaw_rad } = state.pose;
        let ((sin, cos), (roll_sin, roll_cos)) = (yaw_rad.sin_cos(), state.roll_rad.sin_cos());
        // Leaning to the right turns the body about its x axis.
        Self {
            axes: [
                [cos, sin, 0.0],
                [-sin * roll_cos, cos * roll_cos, roll_sin],
                [sin * roll_sin, -cos * roll_sin, roll_cos],
            ],
            origin_m: [x_m, y_m, 0.0],
        }
    }

    fn wheel(state: &CarState, wheel: Wheel, [x, y, z]: [f64; 3]) -> Self {
        let (sin, cos) = (state.pose.yaw_rad + steer_of(state, wheel)).sin_cos();
        // A wheel that rolls forwards turns from z towards x.
        let (turn_sin, turn_cos) = state.turned_rad[wheel.index()].sin_cos();
        let [px, py] = state.pose.world_from_body([x, y]);
        Self {
            axes: [
                [cos * turn_cos, sin * turn_cos, -turn_sin],
                [-sin, cos, 0.0],
                [cos * turn_sin, sin * turn_sin, turn_cos],
            ],
            origin_m: [px, py, z],
        }
    }

    /// A point of the mesh in world axes, m.
    pub fn in_world(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [ax, ay, az] = &self.axes;
        std::array::from_fn(|i| self.origin_m[i] + x * ax[i] + y * ay[i] + z * az[i])
    }
}
