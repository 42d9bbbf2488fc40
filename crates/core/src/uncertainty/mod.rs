//! Probability distributions of predictions: mixtures of normal distributions over whole force
//! curves, over scalars and over positions in the plane, with their densities, draws, quantiles and
//! scores. And the caveats of an answer: what it cannot promise and what it rests on.
//!
//! ```
//! use impactlab_core::uncertainty::{CurveComponent, CurveMixture, PeakFactors};
//! use nalgebra::DMatrix;
//! use rand::SeedableRng;
//!
//! // Two instants: [F_x(t₁), F_x(t₂), F_y(t₁), F_y(t₂), duration]; one factor scales the curve.
//! let mean = vec![0.0, 0.0, 10e3, 20e3, 0.1];
//! let factors = DMatrix::from_column_slice(5, 1, &[0.0, 0.0, 1e3, 2e3, 0.0]);
//! let variance = vec![1.0, 1.0, 1.0, 1.0, 1e-4];
//! let lag_correlation = 0.0;
//! let peak = PeakFactors::default();
//! let component = CurveComponent { weight: 1.0, mean, factors, variance, lag_correlation, peak };
//! let mixture = CurveMixture::new(vec![component])?;
//! assert_eq!(mixture.mean().fy_n, [10e3, 20e3]);
//! let [low, high] = mixture.impulse(1).interval(0.9);
//! assert!(low < 30.0 && 30.0 < high);
//! let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
//! assert_eq!(mixture.sample(20, &mut rng).len(), 20);
//! # Ok::<(), impactlab_core::uncertainty::MixtureError>(())
//! ```

mod error;

mod caveat;
mod caveat_kind;
mod caveats;

mod curve;
mod normal_mixture;

mod mixture;
mod peak_factors;

mod bands;
mod magnitude;
mod quantiles;

mod density;
mod sample;
mod scores;

mod planar;
mod planar_draws;
mod planar_grid;

pub use bands::{CurveBand, CurveBands};
pub use caveat::{Caveat, CaveatQuantity, CaveatText};
pub use caveat_kind::{CaveatKind, CaveatSubject};
pub use caveats::Caveats;
pub use curve::{CURVE_INTERVAL_S, CURVE_N_INSTANTS, ForceCurve};
pub use error::MixtureError;
pub use mixture::{CurveComponent, CurveMixture};
pub use normal_mixture::{NormalMixture, NormalPart};
pub use peak_factors::PeakFactors;
pub use planar::{PlanarMixture, PlanarPart};
pub use planar_grid::{PlanarGrid, PlanarKernel};
pub use sample::CurveQuantities;
pub use scores::{distance_n, energy_score_n, sample_crps};
