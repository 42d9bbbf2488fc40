//! Density of a planar mixture on a grid, computed on the graphics processor: the values of
//! [`PlanarMixture::density_on`] in single precision, for maps that are updated while a slider
//! moves.
//!
//! Lengths are in cells of the grid, means are split into a whole cell and a remainder, and
//! densities are relative to the largest peak, so that single precision suffices far from the
//! origin and for any spread. Values are within 1e-4 of the largest one, as long as no part is more
//! than a thousand times longer than wide.

use std::borrow::Cow;
use std::f64::consts::LOG2_E;
use std::sync::{Mutex, PoisonError};

use eframe::wgpu;

use crate::density_buffers::Buffers;
use crate::gpu::{GpuError, check_limit, checked, headless_device};
use impactlab_core::uncertainty::{PlanarGrid, PlanarKernel, PlanarMixture};

/// Number of points along a side of the tile that a workgroup computes, as in the shader.
const TILE: usize = 16;

/// Number of values that describe a kernel, as in the shader.
const KERNEL_LEN: usize = 8;

/// Reason for which the graphics processor cannot compute a density.
#[derive(Debug, thiserror::Error)]
pub enum DensityError {
    /// The graphics processor cannot be used.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The distance between the points of the grid is not positive and finite.
    #[error("step between points is {step_m:?} m, expected more than 0")]
    Step {
        /// Distance along x and y, m.
        step_m: [f64; 2],
    },
}

/// A graphics device that is ready to compute densities. Its buffers are kept between calls.
#[derive(Debug)]
pub struct DensityGpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipeline: wgpu::ComputePipeline,
    buffers: Mutex<Option<Buffers>>,
}

impl DensityGpu {
    /// Prepares the computation on an existing device, such as that of the window.
    ///
    /// # Errors
    /// [`GpuError::Limit`] if a workgroup of the device is smaller than a tile of 16 × 16 points,
    /// [`GpuError::Device`] if the device rejects the shader.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, GpuError> {
        let most = device.limits().max_compute_invocations_per_workgroup;
        check_limit("the size of a workgroup", (TILE * TILE) as u64, most.into())?;
        let pipeline = checked(&device, || {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("density"),
                source: wgpu::ShaderSource::Wgsl(Cow::Borrowed(include_str!("density.wgsl"))),
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("density"),
                layout: None,
                module: &module,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        })?;
        Ok(Self { device, queue, pipeline, buffers: Mutex::new(None) })
    }

    /// Prepares the computation on a new device, without a window.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] and [`GpuError::NoDevice`], and those of [`DensityGpu::new`].
    pub fn headless() -> Result<Self, GpuError> {
        let (device, queue) = headless_device()?;
        Self::new(device, queue)
    }

    /// Name and kind of the graphics processor, which may be an emulation on the CPU.
    pub fn adapter_info(&self) -> wgpu::AdapterInfo {
        self.device.adapter_info()
    }

    /// Density at the points of a grid, 1/m², row by row; see [`PlanarMixture::density_on`].
    ///
    /// # Errors
    /// [`DensityError::Step`] for points that coincide; within [`DensityError::Gpu`],
    /// [`GpuError::Limit`] for more points or parts than the device can take, [`GpuError::Device`] if it
    /// rejects a command, [`GpuError::NoValues`] if the values cannot be read.
    pub fn density_on(
        &self,
        mixture: &PlanarMixture,
        grid: &PlanarGrid,
    ) -> Result<Vec<f64>, DensityError> {
        let steps_m = steps_m(grid)?;
        let n_points = grid.size[0].saturating_mul(grid.size[1]);
        let mut kernels = mixture.kernels();
        kernels.retain(|kernel| reaches_into(kernel, grid));
        let (bytes, tiles) = (self.bytes(kernels.len(), n_points)?, self.tiles(grid)?);
        let largest = kernels.iter().map(|kernel| kernel.peak).fold(0.0, f64::max);
        if n_points == 0 || largest == 0.0 {
            return Ok(vec![0.0; n_points]);
        }
        let size = [grid.size[0], grid.size[1], kernels.len()].map(|n| n as u32);
        let packed: Vec<f32> = kernels
            .iter()
            .flat_map(|kernel| packed(kernel, grid.low_m, steps_m, largest))
            .collect();
        let mut held = self.buffers.lock().unwrap_or_else(PoisonError::into_inner);
        let (device, pipeline) = (&self.device, &self.pipeline);
        // The buffers are taken out of the mutex, so that they are not used again after an error.
        let buffers = held
            .take()
            .filter(|held| held.bytes().iter().zip(bytes).all(|(held, needed)| *held >= needed));
        let buffers = checked(device, || {
            let buffers = buffers.unwrap_or_else(|| Buffers::new(device, pipeline, bytes));
            buffers.submit(device, &self.queue, pipeline, size, tiles, &packed);
            buffers
        })?;
        let values = buffers.read(device, n_points, largest)?;
        *held = Some(buffers);
        Ok(values)
    }

    /// Sizes of the kernels and of the values, bytes.
    fn bytes(&self, n_kernels: usize, n_points: usize) -> Result<[u64; 2], GpuError> {
        let limits = self.device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        // The shader computes indices with 32 bits.
        let most = most.min(u32::MAX.into());
        let n_bytes =
            |n: usize, len: usize| (n as u64).saturating_mul((len * size_of::<f32>()) as u64);
        let bytes = [n_bytes(n_kernels, KERNEL_LEN), n_bytes(n_points, 1)];
        check_limit("the size of the parts in bytes", bytes[0], most)?;
        check_limit("the size of the grid in bytes", bytes[1], most)?;
        Ok(bytes)
    }

    /// Numbers of tiles along x and y.
    fn tiles(&self, grid: &PlanarGrid) -> Result<[u32; 2], GpuError> {
        let tiles = grid.size.map(|n| n.div_ceil(TILE));
        let most = self.device.limits().max_compute_workgroups_per_dimension;
        for n in tiles {
            check_limit("the number of tiles along a side", n as u64, most.into())?;
        }
        Ok(tiles.map(|n| n as u32))
    }
}

/// Sides of a cell, m; 1 m along an axis with a single point whose step is not valid.
fn steps_m(grid: &PlanarGrid) -> Result<[f64; 2], DensityError> {
    let fits = |axis: usize| grid.step_m[axis] > 0.0 && grid.step_m[axis].is_finite();
    if (0..2).any(|axis| grid.size[axis] > 1 && !fits(axis)) {
        return Err(DensityError::Step { step_m: grid.step_m });
    }
    Ok([0, 1].map(|axis| if fits(axis) { grid.step_m[axis] } else { 1.0 }))
}

/// Whether the grid meets the rectangle outside of which a part is neglected.
fn reaches_into(kernel: &PlanarKernel, grid: &PlanarGrid) -> bool {
    let reach_m = kernel.reach_m();
    (0..2).all(|axis| {
        let from_mean = grid.low_m[axis] - kernel.mean[axis];
        let side = grid.size[axis].saturating_sub(1) as f64 * grid.step_m[axis];
        from_mean <= reach_m[axis] && from_mean + side >= -reach_m[axis]
    })
}

/// A kernel in the form of the shader: whole cells and remainder of its mean, decay coefficients a
/// and d, slope and peak.
///
/// - `largest`: largest peak of all kernels.
fn packed(
    kernel: &PlanarKernel,
    low_m: [f64; 2],
    steps_m: [f64; 2],
    largest: f64,
) -> [f32; KERNEL_LEN] {
    let mean = [0, 1].map(|axis| (kernel.mean[axis] - low_m[axis]) / steps_m[axis]);
    let cell = mean.map(f64::round);
    let fall = [0, 1].map(|axis| 0.5 * LOG2_E * kernel.precision[axis] * steps_m[axis].powi(2));
    let slope = kernel.slope * steps_m[1] / steps_m[0];
    let rest = [mean[0] - cell[0], mean[1] - cell[1]];
    let peak = kernel.peak / largest;
    [cell[0], cell[1], rest[0], rest[1], fall[0], fall[1], slope, peak].map(|value| value as f32)
}
