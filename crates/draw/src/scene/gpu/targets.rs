//! The pictures that a scene is drawn into.

use eframe::wgpu;
use egui::Color32;

use crate::gpu::{GpuError, read_buffer};
use crate::scene::gpu::SceneDevice;
use crate::scene::gpu::pipelines::{COLORS, DEPTHS, Pipelines};

/// Samples along the side of a pixel, as on the CPU.
pub const SAMPLES: u32 = 2;

/// Pictures of one size.
#[derive(Debug)]
pub struct Targets {
    /// Width and height, pixels.
    pub size: [u32; 2],
    ground: wgpu::Texture,
    picture: wgpu::Texture,
    /// The ground alone, which is kept.
    pub ground_view: wgpu::TextureView,
    /// The finished picture.
    pub picture_view: wgpu::TextureView,
    /// Samples, and how near they are.
    pub sample_view: wgpu::TextureView,
    /// How near the samples are.
    pub depth_view: wgpu::TextureView,
    /// The picture as it is read.
    pub picture_group: wgpu::BindGroup,
    /// The samples as they are read.
    pub sample_group: wgpu::BindGroup,
}

impl Targets {
    /// Pictures of a size.
    pub fn new(device: &wgpu::Device, pipelines: &Pipelines, size: [u32; 2]) -> Self {
        use wgpu::TextureUsages as Usages;
        let (drawn, read) = (Usages::RENDER_ATTACHMENT, Usages::TEXTURE_BINDING);
        let texture = |label, [width, height]: [u32; 2], format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let copied = Usages::COPY_SRC | Usages::COPY_DST;
        let ground = texture("ground", size, COLORS, drawn | copied);
        let picture = texture("scene", size, COLORS, drawn | read | copied);
        let fine = size.map(|side| side * SAMPLES);
        let samples = texture("samples", fine, COLORS, drawn | read);
        let depths = texture("depths", fine, DEPTHS, drawn);
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (picture_view, sample_view) = (view(&picture), view(&samples));
        Self {
            size,
            ground_view: view(&ground),
            depth_view: view(&depths),
            picture_group: pipelines.image_group(device, &picture_view),
            sample_group: pipelines.image_group(device, &sample_view),
            picture_view,
            sample_view,
            ground,
            picture,
        }
    }

    /// Begins the picture with the ground.
    pub fn copy_ground(&self, encoder: &mut wgpu::CommandEncoder) {
        let [from, to] = [&self.ground, &self.picture].map(wgpu::Texture::as_image_copy);
        encoder.copy_texture_to_texture(from, to, self.ground.size());
    }

    /// Replaces the ground by one that was drawn on the CPU.
    pub fn write_ground(&self, queue: &wgpu::Queue, pixels: &[Color32]) {
        let [width, height] = self.size;
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(4 * width),
            rows_per_image: Some(height),
        };
        let bytes = bytemuck::cast_slice(pixels);
        queue.write_texture(self.ground.as_image_copy(), bytes, layout, self.ground.size());
    }

    /// Waits for the picture and copies it into memory, row by row from the top.
    ///
    /// # Errors
    /// [`GpuError::NoValues`], for example if the device was lost.
    pub fn read(
        &self,
        SceneDevice { device, queue, .. }: &SceneDevice,
        pixels: &mut Vec<Color32>,
    ) -> Result<(), GpuError> {
        let [width, height] = self.size;
        let bytes_per_row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(bytes_per_row) * u64::from(height);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pixels"),
            size: bytes,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes_per_row),
            rows_per_image: None,
        };
        let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(self.picture.as_image_copy(), target, self.picture.size());
        queue.submit([encoder.finish()]);
        pixels.clear();
        read_buffer(device, &buffer, bytes, |view| {
            let rows = view.chunks_exact(bytes_per_row as usize);
            for row in rows {
                let (texels, _) = row[..4 * width as usize].as_chunks::<4>();
                pixels.extend(texels.iter().map(|[r, g, b, _]| Color32::from_rgb(*r, *g, *b)));
            }
        })
    }
}
