//! The frames of a film: pictures of a scene, one after the other.

use egui::{Color32, ColorImage, Context, Pos2, Rect, TexturesDelta, UiBuilder, Vec2};

use crate::film::strip::Strip;
use crate::offscreen::SETTLING_PASSES;
use crate::scene::{
    Camera, CameraKey, ScenePicture, SceneView, camera_in_scene, for_all_courses, name_ui,
    scene_picture_ui, side_by_side,
};
use crate::{Canvas, SoftwareRenderer, theme};
use impactlab_core::ranges::OutOfRange;

/// Draws pictures of scenes off screen, each below its title and above its legend and what restricts it.
/// What does not change from one picture to the next is kept: fonts, layout, and the ground of the scene.
pub struct FrameRenderer {
    canvas: Canvas,
    context: Context,
    renderer: SoftwareRenderer,
    /// One for each course of events.
    views: Vec<SceneView>,
    /// Between which the camera moves; none if it stands.
    keys: Vec<CameraKey>,
    n_passes: usize,
    image: ColorImage,
}

impl FrameRenderer {
    /// A renderer of pictures of a size.
    ///
    /// # Errors
    /// [`OutOfRange`] for a size that [`Canvas::check`] refuses.
    pub fn new(canvas: Canvas) -> Result<Self, OutOfRange> {
        canvas.check()?;
        let context = Context::default();
        context.set_visuals(theme::visuals(canvas.dark));
        let size = canvas.size_px.map(|side| side as usize);
        Ok(Self {
            canvas,
            context,
            renderer: SoftwareRenderer::default(),
            views: Vec::new(),
            keys: Vec::new(),
            n_passes: 0,
            image: ColorImage::filled(size, ground_color(canvas.dark)),
        })
    }

    /// The renderer with a camera that moves between keys, in place of that of the pictures.
    #[must_use]
    pub fn with_keys(self, keys: Vec<CameraKey>) -> Self {
        Self { keys, ..self }
    }

    /// Draws a picture. The camera is placed for the first one and stays, but for what it follows and for
    /// its keys.
    ///
    /// - `speed`: seconds of the scene that are played in a second, for the time stamp.
    pub fn draw(&mut self, picture: &ScenePicture, speed: f64) -> &ColorImage {
        while self.n_passes + 1 < SETTLING_PASSES {
            self.pass(picture, speed, true);
        }
        let is_first = self.n_passes < SETTLING_PASSES;
        let output = self.pass(picture, speed, is_first);
        let pixels_per_point = output.pixels_per_point;
        let primitives = self.context.tessellate(output.shapes, pixels_per_point);
        self.image.pixels.fill(ground_color(self.canvas.dark));
        self.views.iter().for_each(|view| view.copy_into(&mut self.image));
        self.renderer.draw_over(&primitives, pixels_per_point, &mut self.image);
        &self.image
    }

    /// Lays the picture out once.
    fn pass(
        &mut self,
        picture: &ScenePicture,
        speed: f64,
        places_camera: bool,
    ) -> egui::FullOutput {
        let Self { canvas, context, renderer, views, keys, n_passes, .. } = self;
        views.resize_with(picture.drawn().len(), SceneView::in_frame);
        let size = canvas.size_points();
        let mut output = context.run_ui(canvas.input(*n_passes), |ui| {
            let strip = Strip::new(ui, picture, size);
            let rect = strip.scene_rect();
            let rects = side_by_side(rect, views.len());
            let of_one = rects.first().map_or(rect, |first| *first);
            let placed = places_camera.then(|| for_all_courses(picture, of_one));
            for ((view, scene), rect) in views.iter_mut().zip(picture.drawn()).zip(&rects) {
                if let Some(placed) = &placed {
                    view.place(placed, rect.size());
                }
                let (mut camera, mut follow) = (picture.camera, picture.follow);
                if let Some(key) = camera_in_scene(keys, scene, picture.time_s) {
                    (camera, follow) = (key.camera(camera.kind), key.follow);
                    view.place_at(camera);
                }
                let at = (scene, picture.time_s);
                ui.scope_builder(UiBuilder::new().max_rect(*rect), |ui| {
                    scene_picture_ui(ui, at, view, &mut camera, follow, rect.size());
                });
            }
            for (course, rect) in picture.courses.iter().zip(&rects) {
                name_ui(ui, &course.name, *rect);
            }
            strip.ui(ui, picture, speed);
        });
        let mut textures: TexturesDelta = std::mem::take(&mut output.textures_delta);
        renderer.update_textures(&mut textures);
        *n_passes += 1;
        output
    }
}

/// The camera of a film without keys, about as it is in the frames.
pub(super) fn standing_camera(picture: &ScenePicture, size_px: [u32; 2]) -> Camera {
    let size = Vec2::from(size_px.map(|side| side as f32));
    let of_each = side_by_side(Rect::from_min_size(Pos2::ZERO, size), picture.drawn().len());
    picture.fitted_camera(of_each.first().map_or(size, Rect::size))
}

/// Colour behind everything.
fn ground_color(dark: bool) -> Color32 {
    if dark { Color32::from_gray(27) } else { Color32::WHITE }
}
