//! What moves, on the CPU: cars as triangles in the picture, their shadows, and lines.

use egui::Color32;

use crate::scene::Projection;
use crate::scene::cars::{Placed, SeenCar, seen_cars};
use crate::scene::ground::Ground;
use crate::scene::moving_lines::MovingLines;
use crate::scene::raster::{Object, ScreenTriangle};
use crate::scene::shade::{Rgb, lit, surface_color};
use crate::scene::shadow::Shadow;
use impactlab_document::scene::{Mesh, triangle_normal};

/// What moves, in a picture at a time. It is filled anew for every picture, in the same memory.
#[derive(Default)]
pub struct Frame {
    /// Cars: opaque ones first, then ghosts from far to near.
    pub objects: Vec<Object>,
    /// Shadows.
    pub shadows: Vec<Shadow>,
    /// Lines.
    pub lines: MovingLines,
    /// Objects that are not used now.
    spare: Vec<Object>,
}

impl Frame {
    /// Fills the frame.
    pub fn fill(&mut self, ground: &Ground<'_>, time_s: f64) {
        self.spare.append(&mut self.objects);
        self.shadows.clear();
        for seen in seen_cars(ground, time_s) {
            self.car(ground, &seen);
        }
        self.lines.fill(ground, time_s);
    }

    fn car(&mut self, ground: &Ground<'_>, seen: &SeenCar<'_>) {
        let mut object = self.spare.pop().unwrap_or_default();
        object.clear();
        object.opacity = seen.opacity;
        for part in seen.parts() {
            add_mesh(
                &mut object,
                ground.projection,
                seen.mesh(part.kind),
                &part.placed,
                seen.paint,
                part.is_locked,
            );
        }
        self.shadows.extend(Shadow::new(seen, ground.projection));
        self.objects.push(object);
    }
}

/// Adds the triangles of a mesh that face the camera.
fn add_mesh(
    object: &mut Object,
    projection: &Projection,
    mesh: &Mesh,
    placed: &Placed,
    paint: Rgb,
    is_locked: bool,
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
