//! Strengths of the effects over cars: how they are distributed, and what trajectories of a car say of
//! its own.
//!
//! ```text
//! c_car  = c(Θ) + d_car     d_car ~ N(0, Σ_between)       over cars
//! c_case = c_car + w        w ~ N(0, Σ_within)            over the motions of a car
//! y      ~ N(path(c_case), R)                             a recorded motion, in windows
//! ```
//!
//! c(Θ) is what the network says, which sees the parameters Θ of the vehicle. w is what the effects do
//! not explain the same way on every motion: a road that grips a little less than its friction says, a
//! collision that turns the car a little more, a tyre under loads that the others did not have. Without
//! it one trajectory would seem to say all of a car. For a car that nobody has measured d has the first
//! distribution; every trajectory of it is a Gaussian update.
//!
//! The three covariances are learned by expectation maximisation from a fleet whose every car is predicted by a
//! network that has not seen it: what a network says of the cars that it has learned from would be too
//! good.
//!
//! Source: N. M. Laird, J. H. Ware, Random-Effects Models for Longitudinal Data, Biometrics 38 (1982)
//! 963–974; A. P. Dempster, N. M. Laird, D. B. Rubin, J. R. Stat. Soc. B 39 (1977) 1–38.

mod distribution;

mod fit;

mod linearized;

mod stored;

mod strengths;

pub(crate) use distribution::is_same_car;
pub use distribution::{KnownCar, StrengthPopulation};
pub(crate) use fit::UnseenCar;
pub use strengths::CarStrengths;
