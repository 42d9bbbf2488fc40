//! Mathematics without any knowledge of vehicles: the scalar types of the equations of motion
//! ([`Lanes`], [`Scalar`], [`Packed`]), steps of integration, interpolation, smoothing of measured
//! motions, statistics, least squares, Gaussian processes, clusters, angles, lines and polygons.

mod angle;
mod clustering;
mod elementary;
mod four;
mod gaussian_process;
mod interpolation;
mod latin;
mod least_squares;
mod normal;
mod ode;
mod packed;
mod plane;
mod rounding;
mod scalar;
mod seed;
mod smoother;
mod statistics;

pub use angle::{
    continued_rad, counted_turns_rad, is_half_turn, is_quarter_turn, unwrapped_rad, wrap_angle_rad,
};
pub use clustering::{ClusterError, Clusters};
pub use four::Four;
pub use gaussian_process::{
    GaussianPrediction, GaussianProcess, GaussianProcessData, GaussianProcessError,
};
pub use interpolation::interpolate;
pub use latin::{latin_normals, latin_uniforms};
pub use least_squares::{LeastSquares, LeastSquaresProblem, levenberg_marquardt};
pub use normal::{
    NORMAL_QUANTILE_95, SIGMA_PER_MAD, TruncatedNormal, normal_cdf, normal_density, normal_quantile,
};
pub use ode::{Stage, euler_step, rk4_step, rk4_step_from};
pub use packed::{MAX_LANES, Packed};
pub use plane::{line_length, polygon_area, polygon_holds};
pub use rounding::nearest_multiple;
pub use scalar::{Lanes, LanesOver, Scalar};
pub use seed::{random_stream, sha256_hex};
pub use smoother::{MeasuredTrack, TrackPoint, TrackSample};
pub use statistics::{
    Summary, index_of_share, jackknife_errors, ln_sum_exp, median, quantile_error_of_sorted,
    quantile_of_sorted, quantile_of_weighted, share_standard_error, wilson_interval,
};
