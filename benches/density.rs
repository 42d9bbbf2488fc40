//! Measures how fast the density of a trajectory is computed on the processor's cores and on the
//! graphics processor: 512 × 512 points, and 400 time steps of a motion of 4 s with three mixture
//! components each.
//!
//! `cargo bench --bench density`

#![allow(clippy::print_stdout)]

use divan::Bencher;
use eframe::wgpu::DeviceType;
use impactlab_core::error_chain;
use impactlab_core::uncertainty::{PlanarGrid, PlanarMixture, PlanarPart};
use impactlab_draw::DensityGpu;

/// Number of time steps of the trajectory.
const N_INSTANTS: usize = 400;
/// Number of grid points in X and Y.
const SIZE: [usize; 2] = [512, 512];

fn main() {
    match DensityGpu::headless() {
        Ok(gpu) => {
            let info = gpu.adapter_info();
            let software = info.device_type == DeviceType::Cpu;
            let kind = if software { "a software adapter, on the processor's cores" } else { "" };
            println!("graphics processor: {} ({:?}) {kind}", info.name, info.backend);
        }
        Err(error) => println!("graphics processor: {}", error_chain(&error)),
    }
    divan::main();
}

/// Returns the mixture of a trajectory along 60 m of a bend and the grid around it. The standard
/// deviation grows from 5 cm to 2.5 m along the path and is half of that across it.
fn trajectory() -> (PlanarMixture, PlanarGrid) {
    let part = |i: usize| {
        let (share, component) = ((i / 3) as f64 / (N_INSTANTS - 1) as f64, (i % 3) as f64 - 1.0);
        let (heading, spread_m) = ((0.6 + 0.2 * component) * share, 0.05 + 2.45 * share);
        let (sin, cos) = heading.sin_cos();
        let (along, across) = (spread_m * spread_m, 0.25 * spread_m * spread_m);
        PlanarPart {
            weight: 2.0 - component.abs(),
            mean: [60.0 * share * (0.5 * heading).cos(), 60.0 * share * (0.5 * heading).sin()],
            covariance: [
                along * cos * cos + across * sin * sin,
                (along - across) * sin * cos,
                along * sin * sin + across * cos * cos,
            ],
        }
    };
    let mixture = PlanarMixture::new((0..3 * N_INSTANTS).map(part).collect());
    let bounds = mixture.bounds(3.5).expect("a mixture of some parts");
    (mixture, PlanarGrid::over(bounds, SIZE))
}

#[divan::bench]
fn processor(bencher: Bencher<'_, '_>) {
    let (mixture, grid) = trajectory();
    bencher.bench_local(|| mixture.density_on(&grid));
}

#[divan::bench(sample_count = 20)]
fn graphics_processor(bencher: Bencher<'_, '_>) {
    let Ok(gpu) = DensityGpu::headless() else { return };
    let (mixture, grid) = trajectory();
    bencher.bench_local(|| gpu.density_on(&mixture, &grid).expect("a density of this size"));
}
