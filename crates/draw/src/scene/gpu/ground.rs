//! What the ground is drawn from, in the memory of the graphics processor. What has not changed stays.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::wgpu;

use crate::gpu::{GpuError, check_limit};
use crate::scene::gpu::SceneDevice;
use crate::scene::gpu::buffers::GrowingBuffer;
use crate::scene::ground::Ground;
use crate::scene::underlay::seen_areas;
use impactlab_document::scene::{GroundPicture, PictureLevel, Scene, TILE};
use impactlab_study::analysis::DensityMap;

/// A surface, as in `ground.wgsl`.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct AreaInstance {
    bounds: [f32; 4],
    /// First corner, number of corners, whether it is hatched.
    range: [u32; 4],
    color: [u8; 4],
}

/// What the ground of a scene is drawn from.
#[derive(Debug)]
pub struct GroundResources {
    density: (Option<Arc<DensityMap>>, wgpu::TextureView),
    picture: (Option<Arc<GroundPicture>>, wgpu::TextureView),
    corners: GrowingBuffer,
    /// Surfaces on the ground.
    pub areas: GrowingBuffer,
    /// All of it, bound; `None` as soon as a part is another one.
    pub group: Option<wgpu::BindGroup>,
}

impl GroundResources {
    /// Nothing yet.
    pub fn new(device: &wgpu::Device) -> Self {
        let nothing = |format| texture(device, [1; 2], 1, format).create_view(&Default::default());
        Self {
            density: (None, nothing(wgpu::TextureFormat::R32Float)),
            picture: (None, nothing(PICTURE)),
            corners: GrowingBuffer::new("corners", wgpu::BufferUsages::STORAGE),
            areas: GrowingBuffer::for_vertices("areas"),
            group: None,
        }
    }

    /// Sends what has changed.
    ///
    /// # Errors
    /// [`GpuError::Limit`] for a density or a picture that is too large for the device.
    pub fn update(&mut self, on: &SceneDevice, ground: &Ground<'_>) -> Result<(), GpuError> {
        self.update_density(on, ground.scene)?;
        self.update_picture(on, ground.scene)?;
        self.update_areas(on, ground);
        if let (Some(corners), None) = (self.corners.buffer(), &self.group) {
            let views = [&self.density.1, &self.picture.1];
            self.group = Some(on.pipelines.ground_group(&on.device, views, corners));
        }
        Ok(())
    }

    /// Whether there is a picture of the ground.
    pub fn has_picture(&self) -> bool {
        self.picture.0.is_some()
    }

    fn update_density(
        &mut self,
        SceneDevice { device, queue, .. }: &SceneDevice,
        scene: &Scene,
    ) -> Result<(), GpuError> {
        let map = scene.density.as_ref().map(|density| &density.map);
        if is_same(map, self.density.0.as_ref()) {
            return Ok(());
        }
        self.density.0 = None;
        let Some(map) = map else { return Ok(()) };
        let size = map.grid.size;
        check_side(device, size)?;
        let [width, height] = size.map(|n| n.max(1) as u32);
        let format = wgpu::TextureFormat::R32Float;
        let made = texture(device, [width, height], 1, format);
        let values: Vec<f32> = map.values.iter().map(|value| *value as f32).collect();
        if values.len() == size[0] * size[1] && !values.is_empty() {
            let bytes = bytemuck::cast_slice(&values);
            let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
            queue.write_texture(made.as_image_copy(), bytes, rows(width), extent);
        }
        self.density = (Some(Arc::clone(map)), made.create_view(&Default::default()));
        self.group = None;
        Ok(())
    }

    fn update_picture(
        &mut self,
        SceneDevice { device, queue, .. }: &SceneDevice,
        scene: &Scene,
    ) -> Result<(), GpuError> {
        let picture = scene.ground.as_ref().and_then(|site| site.picture.as_ref());
        let held = self.picture.0.as_ref();
        // A picture that was only moved has the same pixels.
        let is_held = match (picture, held) {
            (Some(picture), Some(held)) => picture.has_pixels_of(held),
            (None, None) => true,
            _ => false,
        };
        if is_held {
            return Ok(());
        }
        self.picture.0 = None;
        let Some(picture) = picture else { return Ok(()) };
        let levels = picture.levels();
        // Every level is at least as large as it has pixels: sides are halved and rounded down here.
        let unit = 1_usize << levels.len().saturating_sub(1);
        let size = picture.size().map(|side| side.max(1).next_multiple_of(unit));
        check_side(device, size)?;
        let made = texture(device, size.map(|n| n as u32), levels.len() as u32, PICTURE);
        for (number, level) in (0_u32..).zip(levels) {
            write_level(queue, &made, number, level);
        }
        self.picture = (Some(Arc::clone(picture)), made.create_view(&Default::default()));
        self.group = None;
        Ok(())
    }

    fn update_areas(&mut self, on: &SceneDevice, ground: &Ground<'_>) {
        let mut corners: Vec<[f32; 2]> = Vec::new();
        let mut areas = Vec::new();
        for area in seen_areas(ground) {
            let first = corners.len() as u32;
            corners.extend(area.corners.iter().map(|corner| corner.map(|value| value as f32)));
            let [[left, top], [right, bottom]] = bounds_of(&corners[first as usize..]);
            areas.push(AreaInstance {
                bounds: [left - 1.0, top - 1.0, right + 1.0, bottom + 1.0],
                range: [first, area.corners.len() as u32, u32::from(area.hatch.is_some()), 0],
                color: area.color.to_array(),
            });
        }
        self.areas.write(on, &areas);
        if self.corners.write(on, &corners) {
            self.group = None;
        }
    }
}

/// Format of the picture of the ground.
const PICTURE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

fn bounds_of(corners: &[[f32; 2]]) -> [[f32; 2]; 2] {
    let start = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
    corners.iter().fold(start, |[low, high], corner| {
        [0, 1].map(|side| {
            std::array::from_fn(|axis| match side {
                0 => low[axis].min(corner[axis]),
                _ => high[axis].max(corner[axis]),
            })
        })
    })
}

fn is_same<T>(a: Option<&Arc<T>>, b: Option<&Arc<T>>) -> bool {
    a.map(Arc::as_ptr) == b.map(Arc::as_ptr)
}

fn check_side(device: &wgpu::Device, size: [usize; 2]) -> Result<(), GpuError> {
    let most = device.limits().max_texture_dimension_2d;
    size.into_iter().try_for_each(|side| {
        check_limit("the side of a picture in pixels", side as u64, most.into())
    })
}

fn texture(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    mip_level_count: u32,
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("ground"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Rows of texels of four bytes.
fn rows(width: u32) -> wgpu::TexelCopyBufferLayout {
    wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None }
}

/// Sends a copy of the picture tile by tile.
fn write_level(queue: &wgpu::Queue, texture: &wgpu::Texture, mip_level: u32, level: &PictureLevel) {
    let size = level.size();
    for ([x, y], pixels) in level.tiles() {
        let [width, height] = [size[0] - x, size[1] - y].map(|left| left.min(TILE) as u32);
        let origin = wgpu::Origin3d { x: x as u32, y: y as u32, z: 0 };
        let target = wgpu::TexelCopyTextureInfo { mip_level, origin, ..texture.as_image_copy() };
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        queue.write_texture(target, bytemuck::cast_slice(pixels), rows(TILE as u32), extent);
    }
}
