//! Scenes drawn by the graphics processor: the same picture as on the CPU, of the same strokes, meshes
//! and numbers, but for rounding.
//!
//! The ground is drawn when the camera, the size or the scene changes, and kept. A picture at another
//! time copies it and adds marks, shadows and lines; cars are drawn with four samples a pixel in a
//! picture of twice the size, at the places at which the CPU takes its samples. Meshes, the picture of
//! the ground and its smaller copies, and the density are sent once.

mod buffers;
mod cars;
mod ground;
mod lines;
mod pipelines;
mod targets;
mod uniforms;
mod window;

use std::sync::Arc;

use eframe::wgpu;
use egui::Color32;

use crate::gpu::{GpuError, check_limit, checked, headless_device};
use crate::scene::SceneLook;
use crate::scene::canvas::{draw_ground, ground_of};
use crate::scene::cars::seen_cars;
use crate::scene::gpu::buffers::GrowingBuffer;
use crate::scene::gpu::cars::{CarParts, Meshes, PartDraw};
use crate::scene::gpu::ground::GroundResources;
use crate::scene::gpu::lines::{shadow_instance, stroke_instances};
use crate::scene::gpu::pipelines::Pipelines;
use crate::scene::gpu::targets::{SAMPLES, Targets};
use crate::scene::gpu::uniforms::uniforms;
use crate::scene::ground::Ground;
use crate::scene::marks::MarkStrokes;
use crate::scene::moving_lines::MovingLines;
use crate::scene::shade::ground_color;
use crate::scene::shadow::Shadow;
use impactlab_document::scene::Scene;

pub use self::window::{WindowCanvas, WindowDevice};

/// Storage buffers that a stage needs: the corners of surfaces.
const STORAGE_BUFFERS: u32 = 1;
/// A graphics device that is ready to draw scenes.
#[derive(Debug)]
pub struct SceneDevice {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Pipelines,
}

impl SceneDevice {
    /// Prepares an existing device, such as that of the window.
    ///
    /// # Errors
    /// [`GpuError::Limit`] if its shaders can read no buffers, [`GpuError::Device`] if it rejects a
    /// shader.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, GpuError> {
        let most = device.limits().max_storage_buffers_per_shader_stage;
        check_limit("the number of buffers", STORAGE_BUFFERS.into(), most.into())?;
        let pipelines = Pipelines::new(&device)?;
        Ok(Self { device, queue, pipelines })
    }

    /// Prepares a new device, without a window.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] and [`GpuError::NoDevice`], and those of [`SceneDevice::new`].
    pub fn headless() -> Result<Self, GpuError> {
        let (device, queue) = headless_device()?;
        Self::new(device, queue)
    }

    /// Name and kind of the graphics processor, which may be an emulation on the CPU.
    pub fn adapter_info(&self) -> wgpu::AdapterInfo {
        self.device.adapter_info()
    }

    /// The device itself.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }
}

/// Draws scenes on a graphics device, and keeps what it can of the last picture.
pub struct GpuCanvas {
    on: Arc<SceneDevice>,
    scene_buffer: wgpu::Buffer,
    scene_group: wgpu::BindGroup,
    targets: Option<Targets>,
    ground: GroundResources,
    meshes: Meshes,
    cars: CarParts,
    ground_strokes: GrowingBuffer,
    marks: MarkStrokes,
    mark_strokes: GrowingBuffer,
    shadows: GrowingBuffer,
    lines: MovingLines,
    below: GrowingBuffer,
    above: GrowingBuffer,
    /// The scene and the look of the ground that is kept.
    drawn: Option<(Arc<Scene>, SceneLook)>,
    time_s: Option<f64>,
}

impl GpuCanvas {
    /// A canvas on a device.
    pub fn new(on: Arc<SceneDevice>) -> Self {
        let device = &on.device;
        let scene_buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("scene"),
            size: (uniforms::N_VECTORS * size_of::<[f32; 4]>()) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            scene_group: on.pipelines.scene_group(device, &scene_buffer),
            scene_buffer,
            targets: None,
            ground: GroundResources::new(device),
            meshes: Meshes::new(),
            cars: CarParts::new(),
            ground_strokes: GrowingBuffer::for_vertices("ground strokes"),
            marks: MarkStrokes::default(),
            mark_strokes: GrowingBuffer::for_vertices("marks"),
            shadows: GrowingBuffer::for_vertices("shadows"),
            lines: MovingLines::default(),
            below: GrowingBuffer::for_vertices("lines below"),
            above: GrowingBuffer::for_vertices("lines above"),
            drawn: None,
            time_s: None,
            on,
        }
    }

    /// Draws a scene at a time, if that is not the last picture already.
    ///
    /// - returns whether the picture has changed.
    ///
    /// # Errors
    /// [`GpuError::Limit`] for a picture that is too large for the device, [`GpuError::Device`] if it
    /// rejects a command. Nothing is kept then.
    pub fn draw(
        &mut self,
        scene: &Arc<Scene>,
        look: &SceneLook,
        time_s: f64,
    ) -> Result<bool, GpuError> {
        let drawn = self.drawn.take();
        let is_drawn = drawn
            .as_ref()
            .is_some_and(|(drawn, as_seen)| Arc::ptr_eq(drawn, scene) && as_seen == look);
        if is_drawn && self.time_s == Some(time_s) {
            self.drawn = drawn;
            return Ok(false);
        }
        let on = Arc::clone(&self.on);
        checked(&on.device, || self.encode(scene, look, time_s, is_drawn))??;
        self.drawn = Some((Arc::clone(scene), *look));
        self.time_s = Some(time_s);
        Ok(true)
    }

    /// The last picture.
    pub fn view(&self) -> Option<&wgpu::TextureView> {
        self.targets.as_ref().map(|targets| &targets.picture_view)
    }

    /// Waits for the last picture and copies its pixels, row by row from the top.
    ///
    /// # Errors
    /// [`GpuError::NoValues`], for example if the device was lost.
    pub fn read(&self, pixels: &mut Vec<Color32>) -> Result<(), GpuError> {
        self.targets.as_ref().map_or(Ok(()), |targets| targets.read(&self.on, pixels))
    }

    fn encode(
        &mut self,
        scene: &Arc<Scene>,
        look: &SceneLook,
        time_s: f64,
        is_drawn: bool,
    ) -> Result<(), GpuError> {
        let on = Arc::clone(&self.on);
        let projection = look.projection();
        let ground = ground_of(scene, look, &projection);
        let targets = self.targets_of(look.size_px)?;
        let mut encoder =
            on.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if !is_drawn {
            self.draw_ground(&mut encoder, &ground, look, &targets)?;
        }
        self.update_frame(&ground, look.size_px, time_s);
        self.draw_frame(&mut encoder, &targets, time_s);
        on.queue.submit([encoder.finish()]);
        self.targets = Some(targets);
        Ok(())
    }

    /// The pictures of a size: those of before, if it is the same.
    fn targets_of(&mut self, size_px: [usize; 2]) -> Result<Targets, GpuError> {
        let most = u64::from(self.on.device.limits().max_texture_dimension_2d);
        for side in size_px {
            let fine = side as u64 * u64::from(SAMPLES);
            check_limit("the side of a picture in samples", fine, most)?;
        }
        let size = size_px.map(|side| side.max(1) as u32);
        let held = self.targets.take().filter(|targets| targets.size == size);
        Ok(held.unwrap_or_else(|| Targets::new(&self.on.device, &self.on.pipelines, size)))
    }

    /// Draws what does not change with time, and sends what the pictures at all times need of it.
    fn draw_ground(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        ground: &Ground<'_>,
        look: &SceneLook,
        targets: &Targets,
    ) -> Result<(), GpuError> {
        let (on, size) = (Arc::clone(&self.on), look.size_px);
        let numbers = uniforms(ground, size);
        on.queue.write_buffer(&self.scene_buffer, 0, bytemuck::cast_slice(&numbers));
        let shapes: Vec<_> = ground.scene.cars.iter().map(|car| &car.shape).collect();
        self.meshes.update(&on, &shapes);
        self.marks = MarkStrokes::new(ground);
        self.mark_strokes.write(&on, &stroke_instances(self.marks.all(), size));
        match self.ground.update(&on, ground) {
            Ok(()) => {
                self.ground_strokes.write(&on, &stroke_instances(&ground.strokes(), size));
                self.encode_ground(encoder, targets, ground_color(ground.dark));
            }
            // A picture that is too large for the device is drawn here, which takes longer.
            Err(GpuError::Limit { .. }) => {
                let mut pixels = vec![Color32::BLACK; size[0] * size[1]];
                draw_ground(ground, size, &mut pixels);
                targets.write_ground(&on.queue, &pixels);
            }
            Err(error) => return Err(error),
        }
        Ok(())
    }

    fn encode_ground(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets, bare: Color32) {
        let pipelines = &self.on.pipelines;
        let mut pass =
            begin_pass(encoder, &targets.ground_view, wgpu::LoadOp::Clear(clear_color(bare)));
        pass.set_bind_group(0, &self.scene_group, &[]);
        pass.set_bind_group(1, self.ground.group.as_ref(), &[]);
        if self.ground.has_picture() {
            pass.set_pipeline(&pipelines.picture);
            pass.draw(0..3, 0..1);
        }
        draw_instances(&mut pass, &pipelines.areas, &self.ground.areas, self.ground.areas.n());
        pass.set_pipeline(&pipelines.cover);
        pass.draw(0..3, 0..1);
        draw_instances(
            &mut pass,
            &pipelines.strokes,
            &self.ground_strokes,
            self.ground_strokes.n(),
        );
    }

    /// Sends what changes with time.
    fn update_frame(&mut self, ground: &Ground<'_>, size: [usize; 2], time_s: f64) {
        let (on, projection) = (&self.on, ground.projection);
        let seen = seen_cars(ground, time_s);
        self.cars.update(on, &self.meshes, &seen, projection);
        let target = projection.target_m();
        let shadows = seen.iter().filter_map(|car| Shadow::new(car, projection));
        let shadows: Vec<_> = shadows.map(|shadow| shadow_instance(&shadow, target)).collect();
        self.shadows.write(on, &shadows);
        self.lines.fill(ground, time_s);
        self.below.write(on, &stroke_instances(&self.lines.below, size));
        self.above.write(on, &stroke_instances(&self.lines.above, size));
    }

    fn draw_frame(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets, time_s: f64) {
        let pipelines = &self.on.pipelines;
        targets.copy_ground(encoder);
        {
            let mut pass = begin_pass(encoder, &targets.picture_view, wgpu::LoadOp::Load);
            pass.set_bind_group(0, &self.scene_group, &[]);
            let n_marks = self.marks.until(time_s).len() as u32;
            draw_instances(&mut pass, &pipelines.strokes, &self.mark_strokes, n_marks);
            draw_instances(&mut pass, &pipelines.shadows, &self.shadows, self.shadows.n());
            draw_instances(&mut pass, &pipelines.strokes, &self.below, self.below.n());
        }
        let covered = self.cars.bounds.and_then(|bounds| pixels_within(bounds, targets.size));
        if let Some(covered) = covered {
            self.draw_cars(encoder, targets, covered);
        }
        let mut pass = begin_pass(encoder, &targets.picture_view, wgpu::LoadOp::Load);
        pass.set_bind_group(0, &self.scene_group, &[]);
        if let Some([left, top, width, height]) = covered {
            pass.set_scissor_rect(left, top, width, height);
            pass.set_bind_group(1, &targets.sample_group, &[]);
            pass.set_pipeline(&pipelines.means);
            pass.draw(0..3, 0..1);
            pass.set_scissor_rect(0, 0, targets.size[0], targets.size[1]);
        }
        draw_instances(&mut pass, &pipelines.strokes, &self.above, self.above.n());
    }

    fn draw_cars(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets, covered: [u32; 4]) {
        let (Some(meshes), Some(parts)) = (self.meshes.buffer(), self.cars.parts.buffer()) else {
            return;
        };
        let pipelines = &self.on.pipelines;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("cars"),
            color_attachments: &[Some(attachment(
                &targets.sample_view,
                wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            ))],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth_view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        let [left, top, width, height] = covered.map(|value| value * SAMPLES);
        pass.set_scissor_rect(left, top, width, height);
        pass.set_bind_group(0, &self.scene_group, &[]);
        pass.set_bind_group(1, &targets.picture_group, &[]);
        pass.set_pipeline(&pipelines.behind);
        pass.draw(0..3, 0..1);
        pass.set_vertex_buffer(0, meshes.slice(..));
        pass.set_vertex_buffer(1, parts.slice(..));
        draw_parts(&mut pass, &pipelines.opaque, &self.cars.opaque);
        for ghost in &self.cars.ghosts {
            draw_parts(&mut pass, &pipelines.ghost_front, ghost);
            draw_parts(&mut pass, &pipelines.ghost_color, ghost);
        }
    }
}

fn begin_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(attachment(view, load))],
        ..wgpu::RenderPassDescriptor::default()
    })
}

fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}

fn clear_color(color: Color32) -> wgpu::Color {
    let [r, g, b] = [color.r(), color.g(), color.b()].map(|value| f64::from(value) / 255.0);
    wgpu::Color { r, g, b, a: 1.0 }
}

/// Draws the first `n` of a buffer, each as a strip of four corners.
fn draw_instances(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    instances: &GrowingBuffer,
    n: u32,
) {
    if let (Some(buffer), true) = (instances.buffer(), n > 0) {
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..4, 0..n.min(instances.n()));
    }
}

fn draw_parts(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    draws: &[PartDraw],
) {
    pass.set_pipeline(pipeline);
    for (corners, part) in draws {
        pass.draw(corners.clone(), *part..*part + 1);
    }
}

/// Left, top, width and height of the pixels that bounds touch within a picture; `None` if there are none.
fn pixels_within([low, high]: [[f64; 2]; 2], size: [u32; 2]) -> Option<[u32; 4]> {
    let at = |value: f64, axis: usize| value.clamp(0.0, size[axis].into()) as u32;
    let [left, top] = [0, 1].map(|axis| at(low[axis].floor(), axis));
    let [right, bottom] = [0, 1].map(|axis| at(high[axis].ceil(), axis));
    (right > left && bottom > top).then(|| [left, top, right - left, bottom - top])
}
