//! Strengths of the effects over cars: how they are distributed, and what trajectories of a car say of
//! its own.
//!
//! ```text
//! c_car  ~ N(c̄, Σ_between)                       over cars
//! y      ~ N(path(c_car, ρ a_network), R)        a recorded motion, in windows
//! c_case = c_car + w       w ~ N(0, Σ_within)    over the motions of a car
//! ```
//!
//! For a car that nobody has measured the strengths have the first distribution; every trajectory of it
//! is a Gaussian update. A network learns the cars that it sees by heart: of what it adds to the effects
//! only a share ρ holds for others, the one with which it errs least on cars that it has not seen, and its
//! own strengths give way to the mean c̄ over cars.
//!
//! w is what the effects do not explain the same way on every motion: a road that grips a little less than
//! its friction says, a collision that turns the car a little more, a tire under loads that the others did
//! not have. It widens what is predicted. What trajectories say of a car is judged by R, all that its
//! strengths leave, of which a share counts, since it is not independent from row to row.
//!
//! All are learned by expectation maximisation from a fleet whose every car is predicted by a network that
//! has not seen it: what a network says of the cars that it has learned from would be too good.
//!
//! Source: N. M. Laird, J. H. Ware, Random-Effects Models for Longitudinal Data, Biometrics 38 (1982)
//! 963–974; A. P. Dempster, N. M. Laird, D. B. Rubin, J. R. Stat. Soc. B 39 (1977) 1–38.

mod distribution;

mod fit;

mod linearized;

mod stored;

mod strengths;

pub use distribution::is_same_car;
pub use distribution::{KnownCar, StrengthPopulation};
pub use fit::UnseenCar;
pub use strengths::CarStrengths;
