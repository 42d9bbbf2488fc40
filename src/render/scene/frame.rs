//! What moves: cars as triangles in the picture, their shadows, and the lines that change with time.

use egui::Color32;

use crate::collision::Pose;
use crate::render::scene::Projection;
use crate::render::scene::ground::{Ground, Pen};
use crate::render::scene::lines::{Rows, Stroke, over};
use crate::render::scene::raster::{Object, ScreenTriangle};
use crate::render::scene::shade::{LOCKED_COLOR, Rgb, body_color, lit, role_color, surface_color};
use crate::scene::{CarLook, CarState, Mesh, SceneCar, ScenePath, SceneRole, triangle_normal};
use crate::vehicle::Wheel;

/// Length of a car in the picture below which it is drawn in fewer triangles, pixels.
const COARSE_BELOW_PIXELS: f64 = 60.0;
/// Opacity of a ghost, and of each of many draws of a forecast.
const GHOST_OPACITY: f32 = 0.45;
const DRAW_OPACITY: f32 = 0.16;
/// Darkness of the shadow in the light and in the dark theme, its soft edge and how far the sun moves it,
/// m.
const SHADOW_OPACITY: [f32; 2] = [0.34, 0.55];
const SHADOW_EDGE_M: f64 = 0.45;
const SHADOW_SHIFT_M: [f64; 2] = [0.22, 0.26];
/// The chevron ahead of a car: distance of its wings and of its tip from the front, and half width, m.
const CHEVRON_M: [f64; 3] = [0.45, 0.95, 0.42];
/// Height at which dents are drawn, m.
const BUMPER_HEIGHT_M: f64 = 0.5;
/// Half the size of the cross at a second contact, m.
const CROSS_M: f64 = 0.6;

/// The shadow of a car.
#[derive(Debug, Clone, Copy)]
pub struct Shadow {
    pose: Pose,
    half_m: [f64; 2],
    /// Lowest and highest `[x, y]` in the picture.
    bounds: [[f64; 2]; 2],
}

/// What moves, in a picture at a time. It is filled anew for every picture, in the same memory.
#[derive(Default)]
pub struct Frame {
    /// Cars: opaque ones first, then ghosts from far to near.
    pub objects: Vec<Object>,
    /// Shadows.
    pub shadows: Vec<Shadow>,
    /// Lines on the ground below the cars.
    pub below: Vec<Stroke>,
    /// Lines over the cars.
    pub above: Vec<Stroke>,
    /// Objects that are not used now.
    spare: Vec<Object>,
}

impl Frame {
    /// Fills the frame.
    pub fn fill(&mut self, ground: &Ground<'_>, time_s: f64) {
        self.spare.append(&mut self.objects);
        self.shadows.clear();
        self.below.clear();
        self.above.clear();
        for car in &ground.scene.cars {
            self.car(ground, car, &car.at(time_s));
        }
        self.objects.sort_by(|a, b| {
            let is_ghost = |of: &Object| of.opacity < 1.0;
            is_ghost(a).cmp(&is_ghost(b)).then(a.nearness.total_cmp(&b.nearness))
        });
        self.lines(ground, time_s);
    }

    fn car(&mut self, ground: &Ground<'_>, car: &SceneCar, state: &CarState) {
        let Pose { x_m, y_m, .. } = state.pose;
        let Some([.., nearness]) = ground.projection.project([x_m, y_m, 0.0]) else { return };
        let mut object = self.spare.pop().unwrap_or_default();
        object.clear();
        object.nearness = nearness as f32;
        let is_draw = is_draw(car);
        object.opacity = match car.look {
            CarLook::Solid => 1.0,
            CarLook::Ghost if is_draw => DRAW_OPACITY,
            CarLook::Ghost => GHOST_OPACITY,
        };
        let paint = body_color(car.role, ground.dark);
        let length = ground.projection.pixels_per_m([x_m, y_m]) * car.shape.body.length_m;
        let is_coarse = is_draw || length < COARSE_BELOW_PIXELS;
        let mesh = if is_coarse { &car.shape.coarse } else { &car.shape.mesh };
        let body = Placed::body(state);
        add_mesh((&mut object, ground.projection), mesh, &body, (paint, false));
        if !is_draw {
            for wheel in Wheel::ALL {
                let placed = Placed::wheel(state, wheel, car.shape.body.wheel_m(wheel));
                let is_locked = state.locked[wheel.index()];
                let target = (&mut object, ground.projection);
                add_mesh(target, &car.shape.wheel, &placed, (paint, is_locked));
            }
        }
        if object.opacity >= 1.0 {
            self.shadows.extend(shadow(ground.projection, car, state));
        }
        self.objects.push(object);
    }

    /// Lines that change with time.
    fn lines(&mut self, ground: &Ground<'_>, time_s: f64) {
        // Marks that are computed would hide those that were found.
        if !ground.scene.marks.is_empty() {
            let found = ground.scene.lines.iter().filter(|line| line.role == SceneRole::Evidence);
            found.for_each(|line| ground.scene_line(line, &mut self.below));
        }
        let mut paths: Vec<&ScenePath> =
            ground.scene.paths.iter().filter(|path| path.role != SceneRole::Muted).collect();
        // The wider below the narrower, so that paths that lie over each other are all seen.
        paths.sort_by(|a, b| past_width(b.role).total_cmp(&past_width(a.role)));
        for path in paths {
            let motion = &path.motion;
            let n_past = motion.time_s().partition_point(|time| *time <= time_s);
            let past = motion.states().get(..n_past).unwrap_or_default().iter();
            let now = motion.at(time_s);
            let points: Vec<[f64; 2]> =
                past.chain([&now]).map(|state| [state.pose.x_m, state.pose.y_m]).collect();
            let color = role_color(path.role, ground.dark);
            let pen = Pen { color, width: past_width(path.role), is_dashed: path.is_dashed };
            ground.line(&points, pen, &mut self.below);
        }
        for line in ground.scene.lines.iter().filter(|line| line.is_above_cars) {
            let color = role_color(line.role, ground.dark);
            let pen = Pen { color, width: 1.8, is_dashed: line.is_dashed };
            ground.line(&line.points_m, pen, &mut self.above);
        }
        self.crushes(ground, time_s);
        for cross in &ground.scene.crosses {
            let color = role_color(SceneRole::Evidence, ground.dark);
            let is_met = cross.time_s <= time_s;
            let pen = Pen { color, width: if is_met { 3.0 } else { 1.5 }, is_dashed: false };
            let [x, y] = cross.at_m;
            for slope in [1.0, -1.0] {
                let ends = [[x - CROSS_M, y - slope * CROSS_M], [x + CROSS_M, y + slope * CROSS_M]];
                let lines = if is_met { &mut self.above } else { &mut self.below };
                ground.line(&ends, pen, lines);
            }
        }
        for car in &ground.scene.cars {
            if is_draw(car) {
                continue;
            }
            let state = car.at(time_s);
            self.chevron(ground, car, &state.pose);
            if car.look == CarLook::Ghost {
                let (color, body) = (role_color(car.role, ground.dark), &car.shape.body);
                let (front, rear, side) = (body.front_m, body.rear_m(), body.width_m / 2.0);
                let corners = [[front, side], [rear, side], [rear, -side], [front, -side]];
                let [a, b, c, d] = corners.map(|corner| state.pose.world_from_body(corner));
                let pen = Pen { color, width: 1.3, is_dashed: car.role == SceneRole::Recorded };
                ground.line(&[a, b, c, d, a], pen, &mut self.above);
            }
            if ground.projection.is_parallel() && car.look == CarLook::Solid {
                self.wheels_from_above(ground, car, &state);
            }
        }
    }

    /// Dented outlines. In perspective they lie on the ground below the cars, and the dents at the height
    /// of bumpers; from above they lie over the cars, which would hide them.
    fn crushes(&mut self, ground: &Ground<'_>, time_s: f64) {
        let color = role_color(SceneRole::Crush, ground.dark);
        for crush in ground.scene.crushes.iter().filter(|crush| crush.from_s <= time_s) {
            let pose = crush.motion.at(time_s).pose;
            let in_world = |line: &[[f64; 2]]| -> Vec<[f64; 2]> {
                line.iter().map(|at| pose.world_from_body(*at)).collect()
            };
            let pen = |width| Pen { color, width, is_dashed: false };
            let outline = in_world(&crush.outline_m);
            let is_parallel = ground.projection.is_parallel();
            let lines = if is_parallel { &mut self.above } else { &mut self.below };
            ground.line(&outline, pen(1.3), lines);
            let dent = in_world(&crush.dent_m);
            ground.line_at((&dent, BUMPER_HEIGHT_M), pen(3.2), &mut self.above);
        }
    }

    fn chevron(&mut self, ground: &Ground<'_>, car: &SceneCar, pose: &Pose) {
        let [wing, tip, half] = CHEVRON_M;
        let front = car.shape.body.front_m;
        let points = [[front + wing, half], [front + tip, 0.0], [front + wing, -half]];
        let points = points.map(|point| pose.world_from_body(point));
        let color = role_color(car.role, ground.dark);
        ground.line(&points, Pen { color, width: 2.2, is_dashed: false }, &mut self.below);
    }

    /// From above the body hides its wheels, which are therefore drawn over it.
    fn wheels_from_above(&mut self, ground: &Ground<'_>, car: &SceneCar, state: &CarState) {
        let body = &car.shape.body;
        let scale = ground.projection.pixels_per_m([state.pose.x_m, state.pose.y_m]);
        let half_width = (0.42 * body.wheel_width_m() * scale) as f32;
        for wheel in Wheel::ALL {
            let [x, y, _] = body.wheel_m(wheel);
            let (sin, cos) = steer_of(state, wheel).sin_cos();
            let reach = 0.8 * body.wheel_radius_m;
            let ends = [1.0, -1.0].map(|side| {
                let point = [x + side * reach * cos, y + side * reach * sin];
                let [px, py] = state.pose.world_from_body(point);
                ground.projection.project([px, py, 0.0])
            });
            let [Some(from), Some(to)] = ends else { continue };
            let is_locked = state.locked[wheel.index()];
            let [r, g, b] = if is_locked { LOCKED_COLOR } else { [22, 24, 26] };
            self.above.push(Stroke {
                ends: [from, to].map(|[x, y, _]| [x as f32, y as f32]),
                half_width: half_width.max(0.5),
                color: Color32::from_rgb(r, g, b),
                opacity: if is_locked { 0.95 } else { 0.5 },
            });
        }
    }
}

/// Width of the part of a path that lies behind the car, points.
fn past_width(role: SceneRole) -> f64 {
    match role {
        SceneRole::Forecast => 4.4,
        SceneRole::Recorded => 1.5,
        _ => 2.6,
    }
}

/// Whether a car is one of many draws of a forecast.
fn is_draw(car: &SceneCar) -> bool {
    car.look == CarLook::Ghost && car.role == SceneRole::Forecast && car.tag.is_empty()
}

/// Steer angle of a wheel, rad.
fn steer_of(state: &CarState, wheel: Wheel) -> f64 {
    match wheel {
        Wheel::FrontLeft => state.steer_rad[0],
        Wheel::FrontRight => state.steer_rad[1],
        Wheel::RearLeft | Wheel::RearRight => 0.0,
    }
}

/// Where a mesh stands: columns of the rotation and the origin, in world axes.
struct Placed {
    axes: [[f64; 3]; 3],
    origin_m: [f64; 3],
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

    fn in_world(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [ax, ay, az] = &self.axes;
        std::array::from_fn(|i| self.origin_m[i] + x * ax[i] + y * ay[i] + z * az[i])
    }
}

/// Adds the triangles of a mesh that face the camera.
fn add_mesh(
    (object, projection): (&mut Object, &Projection),
    mesh: &Mesh,
    placed: &Placed,
    (paint, is_locked): (Rgb, bool),
) {
    for triangle in &mesh.triangles {
        let Some(corners) = mesh.corners_m(triangle) else { continue };
        let [a, b, c] = corners.map(|corner| placed.in_world(corner));
        let normal = triangle_normal([a, b, c]);
        let toward = projection.towards_camera(a);
        if (0..3).map(|i| normal[i] * toward[i]).sum::<f64>() <= 0.0 {
            continue;
        }
        let [Some(p), Some(q), Some(r)] = [a, b, c].map(|corner| projection.project(corner)) else {
            continue;
        };
        let [red, green, blue] = lit(surface_color(triangle.surface, paint, is_locked), normal);
        object.push(ScreenTriangle {
            corners: [p, q, r].map(|corner| corner.map(|value| value as f32)),
            color: Color32::from_rgb(red, green, blue),
        });
    }
}

/// The shadow of a car; `None` where part of it is behind the camera.
fn shadow(projection: &Projection, car: &SceneCar, state: &CarState) -> Option<Shadow> {
    let body = &car.shape.body;
    let middle = state.pose.world_from_body([body.front_m - body.length_m / 2.0, 0.0]);
    let pose = Pose {
        x_m: middle[0] + SHADOW_SHIFT_M[0],
        y_m: middle[1] + SHADOW_SHIFT_M[1],
        yaw_rad: state.pose.yaw_rad,
    };
    let half_m = [body.length_m / 2.0, body.width_m / 2.0];
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
        let corner = std::array::from_fn(|i| signs[i] * (half_m[i] + SHADOW_EDGE_M));
        let [x, y] = pose.world_from_body(corner);
        let at = projection.project([x, y, 0.0])?;
        for axis in 0..2 {
            bounds[0][axis] = bounds[0][axis].min(at[axis]);
            bounds[1][axis] = bounds[1][axis].max(at[axis]);
        }
    }
    Some(Shadow { pose, half_m, bounds })
}

/// Darkens the ground under a car.
pub fn draw_shadow(rows: &mut Rows<'_>, shadow: &Shadow, (projection, dark): (&Projection, bool)) {
    let (map, target) = (projection.ground_map(), projection.target_m());
    let [low, high] = shadow.bounds;
    let last = (rows.first + rows.n_rows()) as f64;
    let from = low[1].floor().clamp(rows.first as f64, last) as usize;
    let to = high[1].ceil().clamp(rows.first as f64, last) as usize;
    let limit = rows.width as f64;
    let columns =
        low[0].floor().clamp(0.0, limit) as usize..high[0].ceil().clamp(0.0, limit) as usize;
    let (sin, cos) = shadow.pose.yaw_rad.sin_cos();
    let opacity = SHADOW_OPACITY[usize::from(dark)];
    for row in from..to {
        for column in columns.clone() {
            let (px, py) = (column as f64 + 0.5, row as f64 + 0.5);
            let [x, y, d] = map.map(|of| of[0] + of[1] * px + of[2] * py);
            if d <= 0.0 {
                continue;
            }
            let off = [x / d + target[0] - shadow.pose.x_m, y / d + target[1] - shadow.pose.y_m];
            let own = [off[0] * cos + off[1] * sin, off[1] * cos - off[0] * sin];
            let beyond: [f64; 2] =
                std::array::from_fn(|i| own[i].abs() - shadow.half_m[i] + SHADOW_EDGE_M);
            let distance =
                beyond[0].max(0.0).hypot(beyond[1].max(0.0)) + beyond[0].max(beyond[1]).min(0.0);
            let share = (1.0 - distance / (2.0 * SHADOW_EDGE_M)).clamp(0.0, 1.0);
            let share = share * share * (3.0 - 2.0 * share);
            let idx = (row - rows.first) * rows.width + column;
            if let Some(pixel) = rows.pixels.get_mut(idx) {
                *pixel = over(*pixel, Color32::BLACK, opacity * share as f32);
            }
        }
    }
}
