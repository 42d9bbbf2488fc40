//! Drawing of scenes, on the CPU: the same pixels in the window and off screen, without a graphics
//! driver. Text and symbols over the scene are painted by egui in both.

mod camera;
mod camera_keys;
mod canvas;
mod cars;
mod courses;
mod frame;
pub mod gpu;
mod grid;
mod ground;
mod labels;
mod legend;
mod lines;
mod marks;
mod measures;
mod moving_lines;
mod picture;
mod raster;
mod row_map;
mod shade;
mod shadow;
mod span;
mod underlay;
#[cfg(test)]
mod underlay_tests;
mod view;

pub use camera::{Camera, Projection};
pub use camera_keys::{CameraKey, CameraKeyError, camera_in_scene, check_keys, move_key, set_key};
pub use canvas::{SceneCanvas, SceneLook};
pub use courses::{CoursesView, courses_have_room, courses_view_ui};
pub(crate) use courses::{for_all_courses, name_ui, side_by_side};
pub use impactlab_document::scene::ViewKind;
pub(crate) use legend::LegendRows;
pub use measures::{draw_measure, draw_measure_text, measure_text_place};
pub use picture::{SceneCourse, ScenePicture, scene_image};
pub(crate) use view::scene_picture_ui;
pub use view::{Follow, SceneView, scene_view_ui};
