//! Buffers of the density computation on the graphics processor, and the commands that use them.

use eframe::wgpu;
use wgpu::BufferUsages;

use crate::gpu::{GpuError, read_buffer};

/// Size of the grid's uniform buffer, bytes: columns, rows and kernels, and a word of padding.
const GRID_BYTES: u64 = 16;

/// Buffers on a graphics device. They may be larger than the data that they hold.
#[derive(Debug)]
pub(super) struct Buffers {
    grid: wgpu::Buffer,
    kernels: wgpu::Buffer,
    values: wgpu::Buffer,
    /// Copy of the values that the CPU can read.
    mapped: wgpu::Buffer,
    bindings: wgpu::BindGroup,
}

impl Buffers {
    /// Creates the buffers and binds them to the pipeline.
    ///
    /// - `bytes`: sizes of the kernels and of the values.
    pub(super) fn new(
        device: &wgpu::Device,
        pipeline: &wgpu::ComputePipeline,
        bytes: [u64; 2],
    ) -> Self {
        let buffer = |label, size, usage| {
            let (label, mapped_at_creation) = (Some(label), false);
            device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation })
        };
        let (sent, read) = (BufferUsages::COPY_DST, BufferUsages::COPY_SRC);
        let grid = buffer("grid", GRID_BYTES, BufferUsages::UNIFORM | sent);
        let kernels = buffer("kernels", bytes[0], BufferUsages::STORAGE | sent);
        let values = buffer("values", bytes[1], BufferUsages::STORAGE | read);
        let mapped = buffer("mapped values", bytes[1], BufferUsages::MAP_READ | sent);
        let bound = [&grid, &kernels, &values];
        let entries: Vec<_> = (0_u32..)
            .zip(bound)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("density"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        Self { grid, kernels, values, mapped, bindings }
    }

    /// Sizes of the kernels' and of the values' buffers, bytes.
    pub(super) fn bytes(&self) -> [u64; 2] {
        [self.kernels.size(), self.values.size()]
    }

    /// Sends the kernels, starts the computation, and copies the values to the buffer that the CPU
    /// can read.
    ///
    /// - `size`: numbers of columns, rows and kernels.
    /// - `tiles`: numbers of tiles along x and y.
    /// - `kernels`: eight numbers for each kernel, as in the shader.
    pub(super) fn submit(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pipeline: &wgpu::ComputePipeline,
        size: [u32; 3],
        tiles: [u32; 2],
        kernels: &[f32],
    ) {
        let grid: Vec<u8> = size.into_iter().chain([0]).flat_map(u32::to_le_bytes).collect();
        let kernels: Vec<u8> = kernels.iter().copied().flat_map(f32::to_le_bytes).collect();
        queue.write_buffer(&self.grid, 0, &grid);
        queue.write_buffer(&self.kernels, 0, &kernels);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.bindings, &[]);
            pass.dispatch_workgroups(tiles[0], tiles[1], 1);
        }
        let bytes = u64::from(size[0]) * u64::from(size[1]) * size_of::<f32>() as u64;
        encoder.copy_buffer_to_buffer(&self.values, 0, &self.mapped, 0, bytes);
        queue.submit([encoder.finish()]);
    }

    /// Waits for the computation and returns its values.
    ///
    /// - `n_points`: number of values.
    /// - `scale`: factor by which the values are multiplied.
    ///
    /// # Errors
    /// [`GpuError::NoValues`], for example if the device was lost.
    pub(super) fn read(
        &self,
        device: &wgpu::Device,
        n_points: usize,
        scale: f64,
    ) -> Result<Vec<f64>, GpuError> {
        let bytes = (n_points * size_of::<f32>()) as u64;
        read_buffer(device, &self.mapped, bytes, |view| {
            let (words, _) = view.as_chunks();
            words.iter().map(|word| scale * f64::from(f32::from_le_bytes(*word))).collect()
        })
    }
}
