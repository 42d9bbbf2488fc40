//! Figures as plain data: what is drawn, in which units, with which meaning of the colours. The
//! panel on screen, the PNG and the CSV of a figure all come from the same [`Figure`].

mod export;
mod force;
mod model;
mod motion;
mod scene;

pub use export::write_figure_csv;
pub use force::{ForceFigure, force_figure};
pub use model::{Axis, Band, Element, Figure, LineStyle, Role, Series};
pub use motion::{MOTION_CHANNELS, motion_figure};
pub use scene::{SceneFigure, SceneVehicle, outline_m, pose_at, scene_figure};
