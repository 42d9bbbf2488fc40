//! Drawing of figures and scenes. One function draws a figure, and one a scene, both in the panel on
//! screen and in a picture off screen.

mod axis_label;
mod caveats;
mod cell_map;
mod density;
mod density_buffers;
mod elements;
pub mod film;
mod gpu;
mod legend;
mod offscreen;
mod plot;
mod report;
mod report_vectors;
pub mod scene;
mod software;
pub mod theme;
mod thin;
mod ticks;

pub use caveats::picture_ui;
pub use density::{DensityError, DensityGpu};
pub use gpu::GpuError;
pub use offscreen::{Canvas, RenderError, draw_offscreen, figure_image, save_figures, save_png};
pub use plot::{Backdrop, FigureOptions, FigureResponse, figure_ui};
pub use report::{report_drawing, report_picture};
pub use software::SoftwareRenderer;
