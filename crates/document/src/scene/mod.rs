//! A scene as plain data: what stands, drives and lies on the ground, over the whole course of
//! events. Pictures in the window and off screen are drawn from the same [`Scene`], at any time of it.
//!
//! Axes are those of [`frames`](impactlab_core::vehicle::frames): X along the road, Y to the left, Z up from
//! the ground; a car has x forward, y to the left, z up, with the origin on the ground below its centre
//! of gravity (CG).

mod body_class;
mod car_body;
mod mesh;

mod body_mesh;
mod cabin_mesh;
mod car_shape;
mod proportions;
mod wheel_mesh;

mod ground;
mod ground_picture;
mod load_ground;

mod car_motion;
mod parts;

mod contact_force;
mod crush_outline;
mod dents;
mod film;
mod fixed_shape;

mod forecast;
mod reconstruction;
mod simulation;
mod still;

pub use body_class::BodyClass;
pub use car_body::{CarBody, N_WHEELS};
pub use car_motion::{CarMotion, CarState};
pub use car_shape::CarShape;
pub use film::{FilmInstant, FilmSection, FilmTiming, FilmTimingError};
pub use forecast::{ForecastScene, add_forecast};
pub use ground::{AreaKind, GeographicGround, GroundArea, GroundLine, GroundLineKind, SceneGround};
pub use ground_picture::{GroundPicture, PictureLevel, TILE};
pub use load_ground::LoadedGround;
pub use mesh::{Mesh, MeshTriangle, Surface, triangle_normal};
pub use parts::{
    CarLook, GHOST_OPACITY, MeasureTextAt, Scene, SceneArrow, SceneCar, SceneCross, SceneCrush,
    SceneDensity, SceneForce, SceneLine, SceneMark, SceneMeasure, ScenePath, ScenePoint, SceneRole,
};
pub use reconstruction::{ReconstructionParts, reconstruction_scene};
pub use simulation::{OtherMotion, SimulationScene, simulation_scene};
pub use still::{SceneStill, ViewKind};
