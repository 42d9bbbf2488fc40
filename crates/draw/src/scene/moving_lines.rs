//! Lines that change with time: ways that lie behind cars, and what is drawn at them.

use egui::Color32;

use crate::scene::cars::steer_of;
use crate::scene::ground::{Ground, Pen, arrow_lines};
use crate::scene::lines::Stroke;
use crate::scene::shade::{LOCKED_COLOR, role_color};
use impactlab_core::collision::Pose;
use impactlab_core::vehicle::Wheel;
use impactlab_document::scene::{CarLook, CarState, SceneCar, ScenePath, SceneRole};

/// The chevron ahead of a car: distance of its wings and of its tip from the front, and half width, m.
const CHEVRON_M: [f64; 3] = [0.45, 0.95, 0.42];
/// Height at which dents are drawn, m.
const BUMPER_HEIGHT_M: f64 = 0.5;
/// Half the size of the cross at a second contact, m.
const CROSS_M: f64 = 0.6;

/// Lines of a picture at a time. They are filled anew for every picture, in the same memory.
#[derive(Default)]
pub struct MovingLines {
    /// Lines on the ground below the cars.
    pub below: Vec<Stroke>,
    /// Lines over the cars.
    pub above: Vec<Stroke>,
}

impl MovingLines {
    /// Replaces the lines by those at a time.
    pub fn fill(&mut self, ground: &Ground<'_>, time_s: f64) {
        self.below.clear();
        self.above.clear();
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
            let width = past_width(path.role);
            let pen = Pen::dashed_if(path.is_dashed, path.role, color, width);
            ground.line(&points, pen, &mut self.below);
        }
        for line in ground.scene.lines.iter().filter(|line| line.is_above_cars) {
            let color = role_color(line.role, ground.dark);
            let pen = Pen::dashed_if(line.is_dashed, line.role, color, 1.8);
            ground.line(&line.points_m, pen, &mut self.above);
        }
        self.crushes(ground, time_s);
        for force in &ground.scene.forces {
            let Some(ends_m) = force.at(time_s) else { continue };
            let pen = Pen::solid(role_color(force.role, ground.dark), 3.2);
            for line in arrow_lines(ends_m) {
                ground.line(&line, pen, &mut self.above);
            }
        }
        for cross in &ground.scene.crosses {
            let color = role_color(SceneRole::Evidence, ground.dark);
            let is_met = cross.time_s <= time_s;
            let pen = Pen::solid(color, if is_met { 3.0 } else { 1.5 });
            let [x, y] = cross.at_m;
            for slope in [1.0, -1.0] {
                let ends = [[x - CROSS_M, y - slope * CROSS_M], [x + CROSS_M, y + slope * CROSS_M]];
                let lines = if is_met { &mut self.above } else { &mut self.below };
                ground.line(&ends, pen, lines);
            }
        }
        for car in &ground.scene.cars {
            if car.is_draw() {
                continue;
            }
            let state = car.at(time_s);
            self.chevron(ground, car, &state.pose);
            if car.look == CarLook::Ghost {
                let (color, body) = (role_color(car.role, ground.dark), &car.shape.body);
                let (front, rear, side) = (body.front_m, body.rear_m(), body.width_m / 2.0);
                let corners = [[front, side], [rear, side], [rear, -side], [front, -side]];
                let [a, b, c, d] = corners.map(|corner| state.pose.world_from_body(corner));
                let pen = Pen::dashed_if(car.role.is_dashed(), car.role, color, 1.3);
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
            let pen = |width| Pen::solid(color, width);
            let outline = in_world(&crush.outline_m);
            let is_parallel = ground.projection.is_parallel();
            let lines = if is_parallel { &mut self.above } else { &mut self.below };
            ground.line(&outline, pen(1.3), lines);
            let dent = in_world(&crush.dent_m);
            ground.line_at(&dent, BUMPER_HEIGHT_M, pen(3.2), &mut self.above);
        }
    }

    fn chevron(&mut self, ground: &Ground<'_>, car: &SceneCar, pose: &Pose) {
        let [wing, tip, half] = CHEVRON_M;
        let front = car.shape.body.front_m;
        let points = [[front + wing, half], [front + tip, 0.0], [front + wing, -half]];
        let points = points.map(|point| pose.world_from_body(point));
        let color = role_color(car.role, ground.dark);
        ground.line(&points, Pen::solid(color, 2.2), &mut self.below);
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
