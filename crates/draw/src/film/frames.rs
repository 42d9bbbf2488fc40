//! The frames of a film: pictures of a scene, one after the other.

use egui::text::LayoutJob;
use egui::{
    Align2, Color32, ColorImage, Context, FontId, Pos2, RawInput, Rect, TexturesDelta, Ui,
    UiBuilder, Vec2, vec2,
};

use crate::film::strip::Strip;
use crate::scene::{Camera, ScenePicture, SceneView, scene_picture_ui};
use crate::{Canvas, SoftwareRenderer, theme};
use impactlab_core::ranges::OutOfRange;

/// Passes after which fonts and layout of the first frame no longer change.
const SETTLING_PASSES: usize = 4;
/// Most courses of events in a row, and room between them, points.
const MOST_COLUMNS: usize = 3;
const BETWEEN: f32 = 2.0;
/// Size of the name of a course of events, and its distance from the edge, points.
const NAME_SIZE: f32 = 12.0;
const NAME_EDGE: f32 = 8.0;
/// Most rows of it.
const NAME_ROWS: usize = 3;

/// Draws pictures of scenes off screen, each below its title and above its legend and what restricts it.
/// What does not change from one picture to the next is kept: fonts, layout, and the ground of the scene.
pub struct FrameRenderer {
    canvas: Canvas,
    context: Context,
    renderer: SoftwareRenderer,
    /// One for each course of events.
    views: Vec<SceneView>,
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
            n_passes: 0,
            image: ColorImage::filled(size, ground_color(canvas.dark)),
        })
    }

    /// Draws a picture. The camera is placed for the first one and stays, but for what it follows.
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
        let Self { canvas, context, renderer, views, n_passes, .. } = self;
        views.resize_with(picture.drawn().len(), SceneView::in_frame);
        let size = Vec2::from(canvas.size_px.map(|side| side as f32)) / canvas.scale;
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            time: Some(*n_passes as f64),
            ..RawInput::default()
        };
        if let Some(viewport) = input.viewports.get_mut(&input.viewport_id) {
            viewport.native_pixels_per_point = Some(canvas.scale);
        }
        let mut output = context.run_ui(input, |ui| {
            let strip = Strip::new(ui, picture, size);
            let rect = strip.scene_rect();
            let rects = side_by_side(rect, views.len());
            let of_one = rects.first().map_or(rect, |first| *first);
            let placed = places_camera.then(|| for_all_courses(picture, of_one));
            for ((view, scene), rect) in views.iter_mut().zip(picture.drawn()).zip(&rects) {
                if let Some(placed) = &placed {
                    view.place(placed);
                }
                let (mut camera, at) = (picture.camera, (scene, picture.time_s));
                ui.scope_builder(UiBuilder::new().max_rect(*rect), |ui| {
                    scene_picture_ui(ui, at, view, &mut camera, picture.follow, rect.size());
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

/// The rectangles of courses of events, in rows from the left top.
fn side_by_side(rect: Rect, n: usize) -> Vec<Rect> {
    let n_rows = n.div_ceil(MOST_COLUMNS).max(1);
    let n_columns = n.div_ceil(n_rows).max(1);
    let grid = vec2(n_columns as f32, n_rows as f32);
    let size = (rect.size() - BETWEEN * (grid - Vec2::splat(1.0))) / grid;
    let place = |idx: usize| vec2((idx % n_columns) as f32, (idx / n_columns) as f32);
    let rects = (0..n).map(|idx| rect.min + place(idx) * (size + Vec2::splat(BETWEEN)));
    rects.map(|min| Rect::from_min_size(min, size)).collect()
}

/// The picture with a camera that sees the places of all of its courses of events, so that each is as
/// large as the others; as it is if its camera is placed or it has one scene.
///
/// - `rect`: of one of them.
fn for_all_courses(picture: &ScenePicture, rect: Rect) -> ScenePicture {
    if picture.is_placed || picture.courses.is_empty() {
        return picture.clone();
    }
    let size = [rect.width(), rect.height()].map(f64::from);
    let fitted = picture.camera.fitted(&picture.scene.places_m(), size);
    let distance_m = picture.distance_m.unwrap_or(fitted.distance_m);
    let camera = Camera { distance_m, ..fitted };
    ScenePicture { camera, is_placed: true, ..picture.clone() }
}

/// Draws the name of a course of events at its left top.
fn name_ui(ui: &Ui, name: &str, rect: Rect) {
    let visuals = ui.visuals();
    let color = visuals.strong_text_color();
    let font = FontId::proportional(NAME_SIZE);
    // The axes stand at the right.
    let widest = (rect.width() - 100.0).max(rect.width() / 2.0);
    let mut job = LayoutJob::simple(name.to_owned(), font, color, widest);
    job.wrap.max_rows = NAME_ROWS;
    let galley = ui.painter().layout_job(job);
    let at = rect.left_top() + Vec2::splat(NAME_EDGE);
    let place = Align2::LEFT_TOP.anchor_size(at, galley.size());
    let plate = ground_color(visuals.dark_mode).gamma_multiply(0.8);
    ui.painter().rect_filled(place.expand2(vec2(4.0, 2.0)), 2.0, plate);
    ui.painter().galley(place.min, galley, color);
}

/// Colour behind everything.
fn ground_color(dark: bool) -> Color32 {
    if dark { Color32::from_gray(27) } else { Color32::WHITE }
}
