//! Meshes in the memory of the graphics processor, and where they stand in a picture.

use std::ops::Range;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::wgpu;

use crate::scene::Projection;
use crate::scene::camera::NEAR_M;
use crate::scene::cars::{PartKind, Placed, SeenCar};
use crate::scene::gpu::SceneDevice;
use crate::scene::gpu::buffers::GrowingBuffer;
use crate::scene::shade::SUN;
use impactlab_document::scene::{CarShape, Mesh, Surface, triangle_normal};

/// A corner of a triangle, as in `cars.wgsl`.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct MeshVertex {
    place: [f32; 3],
    normal: [f32; 3],
    surface: [u8; 4],
}

/// A mesh at its place, as in `cars.wgsl`.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct PartInstance {
    /// Rows of the map from the axes of the mesh to those of the camera.
    rows: [[f32; 4]; 3],
    sun: [f32; 4],
    paint: [f32; 4],
    depth: [f32; 2],
}

/// Corners of the meshes of a shape within the buffer, by [`PartKind`].
#[derive(Debug)]
struct HeldShape {
    shape: Arc<CarShape>,
    ranges: [Range<u32>; 3],
}

/// The meshes of all cars of a scene.
#[derive(Debug)]
pub struct Meshes {
    vertices: GrowingBuffer,
    shapes: Vec<HeldShape>,
}

impl Meshes {
    /// No meshes.
    pub fn new() -> Self {
        Self { vertices: GrowingBuffer::for_vertices("meshes"), shapes: Vec::new() }
    }

    /// Sends the meshes of cars, unless they are there.
    pub fn update(&mut self, on: &SceneDevice, shapes: &[&Arc<CarShape>]) {
        let is_held = |shape: &&&Arc<CarShape>| {
            self.shapes.iter().any(|held| Arc::ptr_eq(&held.shape, shape))
        };
        if shapes.iter().filter(is_held).count() == shapes.len() {
            return;
        }
        self.shapes.clear();
        let mut vertices = Vec::new();
        for shape in shapes {
            if self.range_of(shape, PartKind::Body).is_none() {
                let meshes = [&shape.mesh, &shape.coarse, &shape.wheel];
                let ranges = meshes.map(|mesh| add_mesh(mesh, &mut vertices));
                self.shapes.push(HeldShape { shape: Arc::clone(shape), ranges });
            }
        }
        self.vertices.write(on, &vertices);
    }

    /// The corners of all meshes.
    pub fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.vertices.buffer()
    }

    fn range_of(&self, shape: &Arc<CarShape>, kind: PartKind) -> Option<Range<u32>> {
        let held = self.shapes.iter().find(|held| Arc::ptr_eq(&held.shape, shape))?;
        let place = match kind {
            PartKind::Body => 0,
            PartKind::CoarseBody => 1,
            PartKind::Wheel => 2,
        };
        Some(held.ranges[place].clone())
    }
}

fn add_mesh(mesh: &Mesh, vertices: &mut Vec<MeshVertex>) -> Range<u32> {
    let first = vertices.len() as u32;
    for triangle in &mesh.triangles {
        let Some(corners) = mesh.corners_m(triangle) else { continue };
        let normal = triangle_normal(corners).map(|value| value as f32);
        let kind = match triangle.surface {
            Surface::Body => 1,
            Surface::Hub | Surface::HubGap => 2,
            _ => 0,
        };
        let [r, g, b] = triangle.surface.rgb([0; 3]);
        vertices.extend(corners.map(|place| MeshVertex {
            place: place.map(|value| value as f32),
            normal,
            surface: [r, g, b, kind],
        }));
    }
    first..vertices.len() as u32
}

/// A draw of one mesh: its corners, and its place in the buffer of parts.
pub type PartDraw = (Range<u32>, u32);

/// The cars of a picture at a time.
#[derive(Debug)]
pub struct CarParts {
    /// Where the meshes stand.
    pub parts: GrowingBuffer,
    /// Parts of opaque cars.
    pub opaque: Vec<PartDraw>,
    /// Parts of each ghost, from far to near.
    pub ghosts: Vec<Vec<PartDraw>>,
    /// Lowest and highest `[x, y]` in the picture that cars may cover, pixels; `None` without cars.
    pub bounds: Option<[[f64; 2]; 2]>,
}

impl CarParts {
    /// No cars.
    pub fn new() -> Self {
        let (opaque, ghosts) = (Vec::new(), Vec::new());
        Self { parts: GrowingBuffer::for_vertices("parts"), opaque, ghosts, bounds: None }
    }

    /// Replaces the cars.
    ///
    /// - `seen`: opaque ones, then ghosts from far to near.
    pub fn update(
        &mut self,
        on: &SceneDevice,
        meshes: &Meshes,
        seen: &[SeenCar<'_>],
        projection: &Projection,
    ) {
        self.opaque.clear();
        self.ghosts.clear();
        self.bounds = None;
        let nearness = nearness_of(seen, projection);
        let n_ghosts = seen.iter().filter(|car| car.opacity < 1.0).count();
        let mut instances = Vec::new();
        for car in seen {
            let depths = match car.opacity < 1.0 {
                true => slice_of(self.ghosts.len(), n_ghosts),
                false => OPAQUE_DEPTHS,
            };
            let depth = depth_map(depths, nearness);
            let mut draws = Vec::new();
            for part in car.parts() {
                let Some(range) = meshes.range_of(&car.car.shape, part.kind) else { continue };
                draws.push((range, instances.len() as u32));
                let is_locked = f32::from(u8::from(part.is_locked));
                instances.push(part_instance(car, &part.placed, is_locked, projection, depth));
            }
            match car.opacity < 1.0 {
                true => self.ghosts.push(draws),
                false => self.opaque.extend(draws),
            }
            self.bounds = joined(self.bounds, bounds_of(car, projection));
        }
        self.parts.write(on, &instances);
    }
}

/// Depths of opaque cars; ghosts lie behind them, each in a slice of its own, so that a nearer one is
/// drawn over a more distant one as a whole, as on the CPU.
const OPAQUE_DEPTHS: [f64; 2] = [0.5, 1.0];

fn slice_of(idx: usize, n_ghosts: usize) -> [f64; 2] {
    let part = OPAQUE_DEPTHS[0] / n_ghosts.max(1) as f64;
    [(idx as f64 + 0.01) * part, (idx as f64 + 0.99) * part]
}

/// Half the length of the diagonal of a car with some room, m: nothing of it is further from its CG.
fn reach_m(car: &SeenCar<'_>) -> f64 {
    let body = &car.car.shape.body;
    body.front_m.max(-body.rear_m()).hypot(body.width_m).hypot(body.height_m)
}

/// Distance ahead of the camera within which a car lies, m.
fn distances_m(car: &SeenCar<'_>, projection: &Projection) -> [f64; 2] {
    let pose = car.state.pose;
    let [.., ahead] = projection.in_camera([pose.x_m, pose.y_m, 0.0]);
    let reach = reach_m(car);
    [(ahead - reach).max(NEAR_M), ahead + reach]
}

/// Least and largest nearness of all cars.
fn nearness_of(seen: &[SeenCar<'_>], projection: &Projection) -> [f64; 2] {
    let [near, far] = seen.iter().fold([f64::INFINITY, 0.0_f64], |[near, far], car| {
        let [from, to] = distances_m(car, projection);
        [near.min(from), far.max(to)]
    });
    match projection.is_parallel() {
        true => [-far, -near],
        false => [1.0 / far, 1.0 / near],
    }
}

/// The numbers by which the shader maps nearness to depth.
fn depth_map([low, high]: [f64; 2], [least, largest]: [f64; 2]) -> [f32; 2] {
    let per = (high - low) / (largest - least);
    let base = low - least * per;
    [base, per].map(|value| value as f32)
}

fn part_instance(
    car: &SeenCar<'_>,
    placed: &Placed,
    is_locked: f32,
    projection: &Projection,
    depth: [f32; 2],
) -> PartInstance {
    let origin = projection.in_camera(placed.origin_m);
    let axes = placed.axes.map(|axis| projection.direction_in_camera(axis));
    let rows = std::array::from_fn(|i| {
        [axes[0][i], axes[1][i], axes[2][i], origin[i]].map(|value| value as f32)
    });
    let [x, y, z] = placed.axes.map(|axis| (0..3).map(|i| axis[i] * SUN[i]).sum::<f64>() as f32);
    let [r, g, b] = car.paint.map(|value| f32::from(value) / 255.0);
    PartInstance { rows, sun: [x, y, z, car.opacity], paint: [r, g, b, is_locked], depth }
}

/// Lowest and highest `[x, y]` that a car may cover; everything if it is close to the camera.
fn bounds_of(car: &SeenCar<'_>, projection: &Projection) -> [[f64; 2]; 2] {
    let pose = car.state.pose;
    let bounds = projection.bounds_of_ball([pose.x_m, pose.y_m, 0.0], reach_m(car));
    bounds.unwrap_or([[0.0; 2], [f64::MAX; 2]])
}

fn joined(a: Option<[[f64; 2]; 2]>, [low, high]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let Some([a_low, a_high]) = a else { return Some([low, high]) };
    Some([
        std::array::from_fn(|i| low[i].min(a_low[i])),
        std::array::from_fn(|i| high[i].max(a_high[i])),
    ])
}
