//! A scene in a part of the window, moved with the mouse.

use std::sync::Arc;

use egui::{
    ColorImage, Image, Key, Modifiers, Pos2, Rect, Response, Sense, TextureHandle, TextureOptions,
    Ui, Vec2, pos2,
};
use serde::{Deserialize, Serialize};

use crate::scene::gpu::{WindowCanvas, WindowDevice};
use crate::scene::labels::{Labels, covered};
use crate::scene::legend::legend_ui;
use crate::scene::{Camera, Projection, SceneCanvas, SceneLook, ScenePicture, ViewKind};
use impactlab_core::error_chain;
use impactlab_document::scene::Scene;

/// Angle of a turn for each point that the mouse is dragged, rad.
const TURN_PER_POINT: f64 = 0.006;
/// Logarithm of the zoom for each point that the wheel scrolls.
const ZOOM_PER_POINT: f64 = 0.004;

/// Angle of a turn for each press of an arrow key, rad.
const TURN_PER_KEY: f64 = 0.1;
/// Share of the picture by which the scene moves for each press of an arrow key.
const SHARE_PER_KEY: f64 = 0.1;
/// Zoom for each press of + or −.
const ZOOM_PER_KEY: f64 = 1.25;

/// Step by which a fitted camera goes back to clear the edge of the picture, and most steps.
const STEP_BACK: f64 = 1.05;
const MAX_STEPS_BACK: i32 = 8;
/// Height from which a scene has a legend above it, points: in less, the picture has the room.
const LEGEND_FROM: f32 = 200.0;

/// Which car the camera follows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Follow {
    /// None: the camera stands.
    #[default]
    Nothing,
    /// The struck car.
    Struck,
    /// The striking car.
    Striking,
}

impl Follow {
    /// Where the followed car is at a time, m.
    pub(crate) fn target_m(self, scene: &Scene, time_s: f64) -> Option<[f64; 2]> {
        let car = match self {
            Self::Nothing => None,
            Self::Struck => scene.struck(),
            Self::Striking => scene.striking(),
        };
        car.map(|car| car.at(time_s).pose).map(|pose| [pose.x_m, pose.y_m])
    }
}

/// What a picture of a scene is part of.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum PartOf {
    /// A pane, where the time stands over it.
    #[default]
    Pane,
    /// Courses of events in the window, above which the time stands.
    Courses,
    /// A frame of a film: it is not painted but copied below the text, and the time stands beside it.
    Frame,
}

/// Drawing of a scene in a part of the window: the picture and the camera.
#[derive(Default)]
pub struct SceneView {
    canvas: SceneCanvas,
    /// What draws on the graphics processor of the window, if it has one.
    on_gpu: Option<WindowCanvas>,
    /// Why it does not draw any more.
    refusal: Option<String>,
    texture: Option<TextureHandle>,
    /// Pixels of the texture, which are written into again and again.
    image: Option<Arc<ColorImage>>,
    /// The camera; `None` fits it to the scene.
    camera: Option<Camera>,
    /// Where the picture was drawn last, with its projection and the pixels per point.
    seen: Option<(Rect, Projection, f32)>,
    /// Whether clicks are taken by somebody else, so that a double click does not fit the camera.
    pub takes_clicks: bool,
    /// What the picture is part of.
    part_of: PartOf,
    /// Left, top, width and height of the last picture on the screen, pixels.
    area_px: [usize; 4],
}

impl SceneView {
    /// A view whose picture is copied below the text and not painted, which takes far less time where
    /// egui's triangles are drawn on the CPU.
    pub(crate) fn in_frame() -> Self {
        Self { part_of: PartOf::Frame, ..Self::default() }
    }

    /// A view of one of several courses of events in the window.
    pub(crate) fn among_courses() -> Self {
        Self { part_of: PartOf::Courses, ..Self::default() }
    }

    /// Draws on the graphics processor of the window from now on.
    pub fn draw_on(&mut self, device: WindowDevice) {
        self.on_gpu = Some(WindowCanvas::new(device));
    }

    /// Why the graphics processor does not draw any more, once.
    pub fn take_refusal(&mut self) -> Option<String> {
        self.refusal.take()
    }

    /// Copies the last picture to its place in an image of the whole screen.
    pub(crate) fn copy_into(&self, image: &mut ColorImage) {
        let [left, top, width, _] = self.area_px;
        let [stride, _] = image.size;
        let rows = self.canvas.pixels().chunks_exact(width.max(1));
        for (row, pixels) in rows.enumerate() {
            let start = (top + row) * stride + left;
            let n = width.min(stride.saturating_sub(left));
            if let (Some(target), Some(source)) =
                (image.pixels.get_mut(start..start + n), pixels.get(..n))
            {
                target.copy_from_slice(source);
            }
        }
    }

    /// Fits the camera to the scene when it is drawn next.
    pub fn fit(&mut self) {
        self.camera = None;
    }

    /// Places the camera.
    pub fn place_at(&mut self, camera: Camera) {
        self.camera = Some(camera);
    }

    /// Places the camera as a picture wants it.
    ///
    /// - `size`: of the picture, or of one of its courses of events, in any unit.
    pub(crate) fn place(&mut self, picture: &ScenePicture, size: Vec2) {
        match (&mut self.camera, picture.distance_m) {
            _ if picture.is_placed => self.camera = Some(picture.placed_camera(size)),
            (Some(camera), Some(distance_m)) => camera.distance_m = distance_m,
            // The size may still change.
            _ => self.camera = None,
        }
    }

    /// The place on the ground under a point of the window, m; `None` above the horizon or before
    /// anything was drawn.
    pub fn ground_at(&self, at: Pos2) -> Option<[f64; 2]> {
        let (rect, projection, points) = self.seen.as_ref()?;
        let off = (at - rect.min) * *points;
        projection.ground_at([f64::from(off.x), f64::from(off.y)])
    }

    /// Where a place on the ground is in the window; `None` behind the camera.
    pub fn on_screen(&self, [x, y]: [f64; 2]) -> Option<Pos2> {
        let (rect, projection, points) = self.seen.as_ref()?;
        let [px, py, _] = projection.project([x, y, 0.0])?;
        let at = Vec2::new(px as f32, py as f32) / *points;
        (at.x.is_finite() && at.y.is_finite()).then(|| rect.min + at)
    }

    /// Width over height of the last picture; `None` before anything was drawn.
    pub fn aspect(&self) -> Option<f64> {
        self.seen.as_ref().map(|(rect, ..)| f64::from(rect.width() / rect.height().max(1.0)))
    }

    /// The camera of the last picture, if it was moved or fitted.
    pub fn camera(&self) -> Option<Camera> {
        self.camera
    }
}

/// Draws the legend of a scene, where there is room for it, and the scene at a time below it in the space
/// that is left.
///
/// - `height`: of both, points;
/// - `usual`: the camera with the kind of view and the directions that are wanted; it is fitted to the
///   scene until the user moves it.
pub fn scene_view_ui(
    ui: &mut Ui,
    scene: &Arc<Scene>,
    time_s: f64,
    view: &mut SceneView,
    usual: &mut Camera,
    follow: Follow,
    height: f32,
) -> Response {
    let top = ui.cursor().top();
    if height >= LEGEND_FROM {
        legend_ui(ui, scene);
    }
    let used = ui.cursor().top() - top;
    let size = Vec2::new(ui.available_width().max(32.0), (height - used).max(64.0));
    scene_picture_ui(ui, (scene, time_s), view, usual, follow, size)
}

/// Draws a scene at a time without its legend.
///
/// - `size`: of the picture, points.
pub(crate) fn scene_picture_ui(
    ui: &mut Ui,
    (scene, time_s): (&Arc<Scene>, f64),
    view: &mut SceneView,
    usual: &mut Camera,
    follow: Follow,
    size: Vec2,
) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let named = || egui::WidgetInfo::labeled(egui::Role::Image, true, "Picture of the scene");
    response.widget_info(named);
    let points = ui.ctx().pixels_per_point();
    // Pixels of the picture are those of the screen.
    let [left, top] = [rect.left(), rect.top()].map(|at| (at * points).round());
    let size_px =
        [rect.width(), rect.height()].map(|side| ((side * points).floor() as usize).max(1));
    let [width, height] = size_px.map(|side| side as f32);
    let rect =
        Rect::from_min_size(pos2(left / points, top / points), Vec2::new(width, height) / points);
    let size = size_px.map(|side| side as f64);
    let is_stamped = view.part_of == PartOf::Pane;
    let mut camera = match view.camera {
        Some(camera) if camera.kind == usual.kind => camera,
        _ => fitted_clear(*usual, (scene, is_stamped), rect, points),
    };
    if response.double_clicked() && !view.takes_clicks {
        camera = fitted_clear(*usual, (scene, is_stamped), rect, points);
    }
    camera = keyed(ui, &response, moved(ui, &response, camera, rect, size), size);
    if let Some(target_m) = follow.target_m(scene, time_s) {
        camera.target_m = target_m;
    }
    (usual.azimuth_rad, usual.elevation_rad) = (camera.azimuth_rad, camera.elevation_rad);
    view.camera = Some(camera);
    let dark = ui.visuals().dark_mode;
    let look = SceneLook { size_px, camera, dark, pixels_per_point: points };
    let [left, top] = [left, top].map(|at| at.max(0.0) as usize);
    view.area_px = [left, top, size_px[0], size_px[1]];
    match view.part_of {
        PartOf::Frame => drop(view.canvas.draw(scene, &look, time_s)),
        PartOf::Pane | PartOf::Courses => paint(ui, rect, view, scene, time_s, &look),
    }
    let projection = look.projection();
    let labels = Labels { rect, projection: &projection, points, dark, is_stamped };
    view.seen = Some((rect, projection, points));
    labels.draw(&ui.painter().with_clip_rect(rect), scene, time_s);
    response
}

/// The camera from which everything is seen, as far back that nothing lies under the text and the symbols
/// at the edge; as near as it can be where the picture is too small for that.
///
/// - `is_stamped`: whether the time stands over the picture;
/// - `rect`: the picture;
/// - `points`: its pixels per point.
fn fitted_clear(
    usual: Camera,
    (scene, is_stamped): (&Scene, bool),
    rect: Rect,
    points: f32,
) -> Camera {
    let size = [rect.width(), rect.height()].map(|side| f64::from(side * points));
    let (places_m, covered) = (scene.places_m(), covered(rect, scene, is_stamped));
    let nearest = usual.fitted(&places_m, size);
    let is_clear = |camera: &Camera| {
        let projection = Projection::new(camera, size);
        places_m.iter().all(|[x, y]| {
            let seen = projection.project([*x, *y, 0.0]);
            let seen = seen.map(|[px, py, _]| rect.min + Vec2::new(px as f32, py as f32) / points);
            seen.is_none_or(|at| covered.iter().all(|rect| !rect.contains(at)))
        })
    };
    let back =
        |step: i32| Camera { distance_m: nearest.distance_m * STEP_BACK.powi(step), ..nearest };
    (0..=MAX_STEPS_BACK).map(back).find(is_clear).unwrap_or(nearest)
}

/// Draws the picture, if it has changed, and shows it: on the graphics processor, or here from the first
/// time on that it refuses.
fn paint(
    ui: &Ui,
    rect: Rect,
    view: &mut SceneView,
    scene: &Arc<Scene>,
    time_s: f64,
    look: &SceneLook,
) {
    if let Some(on_gpu) = &mut view.on_gpu {
        match on_gpu.draw(scene, look, time_s) {
            Ok(picture) => {
                if let Some(id) = picture {
                    Image::new((id, rect.size())).paint_at(ui, rect);
                }
                return;
            }
            Err(error) => {
                view.refusal = Some(error_chain(&error));
                view.on_gpu = None;
            }
        }
    }
    paint_from_cpu(ui, rect, view, scene, time_s, look);
}

fn paint_from_cpu(
    ui: &Ui,
    rect: Rect,
    view: &mut SceneView,
    scene: &Arc<Scene>,
    time_s: f64,
    look: &SceneLook,
) {
    let has_changed = view.canvas.draw(scene, look, time_s);
    let SceneView { canvas, texture, image, .. } = view;
    if has_changed || texture.is_none() {
        let mut pixels = image.take().unwrap_or_default();
        let filled = Arc::make_mut(&mut pixels);
        *filled = ColorImage {
            size: look.size_px,
            pixels: std::mem::take(&mut filled.pixels),
            ..ColorImage::default()
        };
        filled.pixels.clear();
        filled.pixels.extend_from_slice(canvas.pixels());
        let options = TextureOptions::NEAREST;
        match texture {
            Some(texture) => texture.set(Arc::clone(&pixels), options),
            None => *texture = Some(ui.ctx().load_texture("scene", Arc::clone(&pixels), options)),
        }
        *image = Some(pixels);
    }
    if let Some(texture) = texture {
        Image::new((texture.id(), rect.size())).paint_at(ui, rect);
    }
}

/// The camera after what the mouse does: from above, a drag moves it; in perspective, the primary button
/// turns it and the secondary or the middle one moves it; the wheel zooms about the pointer.
fn moved(ui: &Ui, response: &Response, camera: Camera, rect: Rect, size: [f64; 2]) -> Camera {
    let points = f64::from(ui.ctx().pixels_per_point());
    let in_picture = |at: egui::Pos2| {
        let at = at - rect.min;
        [f64::from(at.x) * points, f64::from(at.y) * points]
    };
    let mut camera = camera;
    let drag = response.drag_delta();
    if drag != Vec2::ZERO
        && let Some(pointer) = response.interact_pointer_pos()
    {
        let turns = camera.kind == ViewKind::Perspective
            && response.dragged_by(egui::PointerButton::Primary)
            && !ui.input(|input| input.modifiers.shift);
        camera = if turns {
            let [dx, dy] = [drag.x, drag.y].map(|way| f64::from(way) * TURN_PER_POINT);
            camera.orbited([-dx, dy])
        } else {
            camera.panned(size, [in_picture(pointer - drag), in_picture(pointer)])
        };
    }
    if let Some(pointer) = response.hover_pos() {
        let (turned, pinched) = ui.input_mut(|input| {
            let turned = input.smooth_scroll_delta().y;
            input.smooth_scroll_delta = Vec2::ZERO;
            (turned, input.zoom_delta())
        });
        let factor = (f64::from(turned) * ZOOM_PER_POINT).exp() * f64::from(pinched);
        if factor != 1.0 {
            camera = camera.zoomed(size, in_picture(pointer), factor);
        }
    }
    camera
}

/// The camera after what the keys do while the pointer is over the scene: + and − zoom about its middle;
/// the arrows with Ctrl move it from above, and turn it in perspective.
fn keyed(ui: &Ui, response: &Response, camera: Camera, size: [f64; 2]) -> Camera {
    if !response.hovered() || ui.ctx().text_edit_focused() {
        return camera;
    }
    let pressed =
        |modifiers, key| ui.input_mut(|input| input.count_and_consume_key(modifiers, key));
    let times = |key| pressed(Modifiers::COMMAND, key) as f64;
    let way = [
        times(Key::ArrowRight) - times(Key::ArrowLeft),
        times(Key::ArrowDown) - times(Key::ArrowUp),
    ];
    let plain = |key| pressed(Modifiers::NONE, key) as f64;
    let zoom = plain(Key::Plus) + plain(Key::Equals) - plain(Key::Minus);
    let middle = size.map(|side| side / 2.0);
    let mut camera = camera;
    if way != [0.0; 2] {
        camera = match camera.kind {
            ViewKind::Perspective => {
                camera.orbited([-way[0] * TURN_PER_KEY, way[1] * TURN_PER_KEY])
            }
            ViewKind::Above => {
                let to = [0, 1].map(|i| middle[i] - way[i] * SHARE_PER_KEY * size[i]);
                camera.panned(size, [middle, to])
            }
        };
    }
    if zoom != 0.0 {
        camera = camera.zoomed(size, middle, ZOOM_PER_KEY.powf(zoom));
    }
    camera
}
