//! The density of a planar mixture must be the same on the graphics processor as on the processor.
//!
//! The tests need a graphics driver, for which a software implementation suffices
//! (`mesa-vulkan-drivers`). Without one they print that nothing was compared and pass, unless
//! `IMPACTLAB_REQUIRE_GPU` is set.

use impactlab_core::error_chain;
use impactlab_core::uncertainty::{PlanarGrid, PlanarMixture, PlanarPart};
use impactlab_draw::{DensityError, DensityGpu, GpuError};

/// Largest difference as a share of the largest density. It allows for single precision and for the
/// inexact exponential function of the device.
const TOLERANCE: f64 = 1e-4;

#[expect(clippy::print_stdout, reason = "a test that compares nothing says so")]
fn device() -> Option<DensityGpu> {
    let may_lack = std::env::var_os("IMPACTLAB_REQUIRE_GPU").is_none();
    match DensityGpu::headless() {
        Ok(gpu) => Some(gpu),
        Err(error @ GpuError::NoAdapter(_)) if may_lack => {
            println!("nothing was compared: {}", error_chain(&error));
            None
        }
        Err(error) => panic!("{}", error_chain(&error)),
    }
}

fn part(weight: f64, mean: [f64; 2], covariance: [f64; 3]) -> PlanarPart {
    PlanarPart { weight, mean, covariance }
}

/// Returns the mixture of 400 time steps along 60 m of a bend with three parts each, whose standard
/// deviation grows from 2 cm to 3 m.
fn path(start_m: [f64; 2]) -> PlanarMixture {
    let of = |i: usize| {
        let (share, component) = ((i / 3) as f64 / 399.0, (i % 3) as f64 - 1.0);
        let (sin, cos) = ((0.6 + 0.2 * component) * share).sin_cos();
        let along = (0.02 + 2.98 * share).powi(2);
        let across = 0.04 * along;
        let covariance = [
            along * cos * cos + across * sin * sin,
            (along - across) * sin * cos,
            along * sin * sin + across * cos * cos,
        ];
        part(1.0, [start_m[0] + 60.0 * share * cos, start_m[1] + 60.0 * share * sin], covariance)
    };
    PlanarMixture::new((0..1200).map(of).collect())
}

fn compare(gpu: &DensityGpu, mixture: &PlanarMixture, grid: &PlanarGrid) {
    let values = gpu.density_on(mixture, grid).expect("a density of this size");
    let expected = mixture.density_on(grid);
    assert_eq!(values.len(), expected.len());
    let largest = expected.iter().copied().fold(0.0, f64::max);
    assert!(largest > 0.0, "{grid:?} holds nothing");
    let errors = values.iter().zip(&expected).map(|(value, expected)| (value - expected).abs());
    let error = errors.fold(0.0, f64::max) / largest;
    assert!(error < TOLERANCE, "{grid:?}: {error:e}");
}

#[test]
fn one_narrow_part() {
    let Some(gpu) = device() else { return };
    for (size, slant) in [([512, 512], 0.0), ([1, 1], 0.0), ([1024, 37], 0.9), ([17, 1024], -0.99)]
    {
        let half_m = [0, 1].map(|axis: usize| if size[axis] == 1 { 0.0 } else { 40.0 });
        let grid = PlanarGrid::over([half_m.map(|half| -half), half_m], size);
        let mixture = PlanarMixture::new(vec![part(1.0, [0.0; 2], [1e-2, slant * 1e-2, 1e-2])]);
        compare(&gpu, &mixture, &PlanarGrid { low_m: [-0.003, 0.004], ..grid });
        let on_a_point = [0, 1].map(|axis| -((size[axis] / 2) as f64) * grid.step_m[axis]);
        compare(&gpu, &mixture, &PlanarGrid { low_m: on_a_point, ..grid });
    }
    let mixture = PlanarMixture::new(vec![part(1.0, [100.0, 0.0], [1e-4, 0.0, 1e-4])]);
    let grid = PlanarGrid::over([[0.0; 2], [1.0; 2]], [40, 50]);
    assert!(gpu.density_on(&mixture, &grid).unwrap().iter().all(|value| *value == 0.0));
}

#[test]
fn a_motion_of_1200_parts() {
    let Some(gpu) = device() else { return };
    let mixture = path([0.0; 2]);
    let bounds = mixture.bounds(3.5).unwrap();
    // Larger and smaller grids alternate, because the buffers are kept between calls.
    for size in [[512, 512], [200, 300], [1024, 1024], [3, 5]] {
        compare(&gpu, &mixture, &PlanarGrid::over(bounds, size));
    }
}

#[test]
fn far_from_the_origin() {
    let Some(gpu) = device() else { return };
    for start_m in [[1e4, 1e4], [-1e4, 3e5]] {
        let mixture = path(start_m);
        compare(&gpu, &mixture, &PlanarGrid::over(mixture.bounds(3.5).unwrap(), [512, 512]));
        let narrow = PlanarMixture::new(vec![part(1.0, start_m, [1e-4, 0.0, 1e-4])]);
        let low_m = [start_m[0] - 60.0, start_m[1] - 0.2];
        let grid = PlanarGrid { low_m, step_m: [60.0 / 1000.0, 0.004], size: [1024, 100] };
        compare(&gpu, &narrow, &grid);
    }
}

#[test]
fn what_does_not_fit_is_an_error() {
    let Some(gpu) = device() else { return };
    let mixture = path([0.0; 2]);
    let grid = |step_m, size| PlanarGrid { low_m: [0.0; 2], step_m: [step_m, 1e-4], size };
    let of = |grid| gpu.density_on(&mixture, &grid).map(|values| values.len());
    assert!(matches!(
        of(grid(1e-4, [1 << 20, 1 << 20])),
        Err(DensityError::Gpu(GpuError::Limit { .. }))
    ));
    assert!(matches!(of(grid(1e-4, [1 << 24, 1])), Err(DensityError::Gpu(GpuError::Limit { .. }))));
    assert!(matches!(of(grid(0.0, [8, 8])), Err(DensityError::Step { .. })));
    assert!(matches!(of(grid(f64::NAN, [8, 8])), Err(DensityError::Step { .. })));
    assert_eq!(of(grid(1e-4, [0, 8])).unwrap(), 0);
}
