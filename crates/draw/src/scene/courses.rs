//! Courses of events side by side under one camera, each below its name, in a frame of a film and in the
//! window.

use egui::text::LayoutJob;
use egui::{Align2, FontId, Rect, Role, Sense, Ui, UiBuilder, Vec2, WidgetInfo, vec2};

use crate::scene::gpu::WindowDevice;
use crate::scene::legend::legend_ui;
use crate::scene::shade::ground_color;
use crate::scene::{Camera, ScenePicture, SceneView, scene_picture_ui};

/// Room between courses of events, points.
const BETWEEN: f32 = 2.0;
/// Shortest side of a course of events in the window in which its cars are still told apart, points.
const LEAST_SIDE: f32 = 150.0;
/// Size of the name of a course of events, and its distance from the edge, points.
const NAME_SIZE: f32 = 12.0;
const NAME_EDGE: f32 = 8.0;
/// Most rows of it, and opacity of what lies behind it.
const NAME_ROWS: usize = 3;
const PLATE: f32 = 0.8;

/// Drawing of courses of events side by side in a part of the window: their pictures, and the camera that
/// they share.
#[derive(Default)]
pub struct CoursesView {
    views: Vec<SceneView>,
    device: Option<WindowDevice>,
    /// The camera; `None` fits it to all of them.
    camera: Option<Camera>,
    /// Whether the user has moved it since it was fitted.
    is_moved: bool,
}

impl CoursesView {
    /// Draws on the graphics processor of the window from now on.
    pub fn draw_on(&mut self, device: WindowDevice) {
        self.views.iter_mut().for_each(|view| view.draw_on(device.clone()));
        self.device = Some(device);
    }

    /// Why the graphics processor does not draw any more, once.
    pub fn take_refusal(&mut self) -> Option<String> {
        let mut refusal = None;
        for view in &mut self.views {
            refusal = view.take_refusal().or(refusal);
        }
        if refusal.is_some() {
            self.device = None;
        }
        refusal
    }

    /// Fits the camera to all courses of events when they are drawn next.
    pub fn fit(&mut self) {
        (self.camera, self.is_moved) = (None, false);
    }

    /// The camera that they share, if the user has moved it; otherwise it is fitted to a picture of any size.
    pub fn moved_camera(&self) -> Option<Camera> {
        self.camera.filter(|_| self.is_moved)
    }

    /// The camera of the last pictures.
    pub fn camera(&self) -> Option<Camera> {
        self.camera
    }

    /// Places the camera.
    pub fn place_at(&mut self, camera: Camera) {
        (self.camera, self.is_moved) = (Some(camera), true);
    }

    /// A view for each of so many courses of events. None is dropped whose picture the window may still
    /// show.
    fn provide(&mut self, n: usize) {
        while self.views.len() < n {
            let mut view = SceneView::among_courses();
            if let Some(device) = &self.device {
                view.draw_on(device.clone());
            }
            self.views.push(view);
        }
    }
}

/// Whether so many courses of events can be told apart side by side in a part of the window.
///
/// - `size`: of that part, points.
pub fn courses_have_room(size: Vec2, n: usize) -> bool {
    size_of_each(size, n).1.min_elem() >= LEAST_SIDE
}

/// Draws the legend that courses of events share, and below it their scenes at one time. The mouse over
/// one of them moves the camera of all.
///
/// - `picture`: courses, time, and which car is in the middle;
/// - `usual`: the camera with the kind of view and the directions that are wanted, as for
///   [`scene_view_ui`](crate::scene::scene_view_ui);
/// - `height`: of legend and scenes, points.
pub fn courses_view_ui(
    ui: &mut Ui,
    picture: &ScenePicture,
    shown: &mut CoursesView,
    usual: &mut Camera,
    height: f32,
) {
    let top = ui.cursor().top();
    // They have the same names.
    if let Some(first) = picture.courses.first() {
        legend_ui(ui, &first.scene);
    }
    let used = ui.cursor().top() - top;
    let size = Vec2::new(ui.available_width().max(32.0), (height - used).max(64.0));
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let rects = side_by_side(rect, picture.courses.len());
    shown.provide(rects.len());
    let camera = match shown.camera {
        Some(camera) if camera.kind == usual.kind => camera,
        _ => {
            shown.is_moved = false;
            let of_one = rects.first().map_or(rect, |first| *first);
            let wanted = ScenePicture { camera: *usual, is_placed: false, ..picture.clone() };
            for_all_courses(&wanted, of_one).camera
        }
    };
    let (mut moved, mut is_fitted) = (camera, false);
    let courses = picture.courses.iter().zip(&rects).enumerate();
    for (view, (idx, (course, rect))) in shown.views.iter_mut().zip(courses) {
        view.place_at(camera);
        let builder = UiBuilder::new().id_salt(("course of events", idx)).max_rect(*rect);
        let (mut ui, mut directions) = (ui.new_child(builder), *usual);
        let at = (&course.scene, picture.time_s);
        let response =
            scene_picture_ui(&mut ui, at, view, &mut directions, picture.follow, rect.size());
        let name = format!("Picture of the scene: {}", course.name);
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
        name_ui(&ui, &course.name, *rect);
        is_fitted |= response.double_clicked();
        if response.hovered() || response.dragged() {
            moved = view.camera().unwrap_or(moved);
        }
    }
    // Each has its own car in the middle, which is no move of the camera.
    let is_following = picture.follow.target_m(&picture.scene, picture.time_s).is_some();
    let target_m = if is_following { camera.target_m } else { moved.target_m };
    let moved = Camera { target_m, ..moved };
    if moved != camera {
        shown.is_moved = true;
        ui.ctx().request_repaint();
    }
    shown.camera = Some(moved);
    (usual.azimuth_rad, usual.elevation_rad) = (moved.azimuth_rad, moved.elevation_rad);
    if is_fitted {
        shown.fit();
        ui.ctx().request_repaint();
    }
}

/// The rectangles of courses of events, in rows from the left top.
pub(crate) fn side_by_side(rect: Rect, n: usize) -> Vec<Rect> {
    let (n_columns, size) = size_of_each(rect.size(), n);
    let place = |idx: usize| vec2((idx % n_columns) as f32, (idx / n_columns) as f32);
    let places = (0..n).map(|idx| rect.min + place(idx) * (size + Vec2::splat(BETWEEN)));
    places.map(|min| Rect::from_min_size(min, size)).collect()
}

/// The number of columns in which so many pictures have the longest shorter side, and their size.
fn size_of_each(whole: Vec2, n: usize) -> (usize, Vec2) {
    let n = n.max(1);
    let size = |n_columns: usize| {
        let grid = vec2(n_columns as f32, n.div_ceil(n_columns) as f32);
        (whole - BETWEEN * (grid - Vec2::splat(1.0))) / grid
    };
    let others = (2..=n).map(|n_columns| (n_columns, size(n_columns)));
    let longer = |best: (usize, Vec2), other: (usize, Vec2)| {
        if other.1.min_elem() > best.1.min_elem() { other } else { best }
    };
    others.fold((1, size(1)), longer)
}

/// The picture with a camera that sees the places of all of its courses of events, so that each is as
/// large as the others; as it is if its camera is placed or it has one scene.
///
/// - `rect`: of one of them.
pub(crate) fn for_all_courses(picture: &ScenePicture, rect: Rect) -> ScenePicture {
    if picture.is_placed || picture.courses.is_empty() {
        return picture.clone();
    }
    let camera = picture.fitted_camera(rect.size());
    ScenePicture { camera, is_placed: true, seen_aspect: None, ..picture.clone() }
}

/// Draws the name of a course of events at its left top.
pub(crate) fn name_ui(ui: &Ui, name: &str, rect: Rect) {
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
    let plate = ground_color(visuals.dark_mode).gamma_multiply(PLATE);
    ui.painter().rect_filled(place.expand2(vec2(4.0, 2.0)), 2.0, plate);
    ui.painter().galley(place.min, galley, color);
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn courses_stand_beside_each_other_where_wide_and_below_each_other_where_tall() {
        for (size, n, n_columns) in [
            ([1920.0, 1040.0], 1, 1),
            ([1920.0, 1040.0], 2, 2),
            ([1920.0, 1040.0], 3, 3),
            ([1920.0, 1040.0], 4, 2),
            ([1920.0, 1040.0], 5, 3),
            ([400.0, 700.0], 2, 1),
            ([400.0, 700.0], 4, 2),
        ] {
            let whole = Rect::from_min_size(pos2(10.0, 20.0), size.into());
            let rects = side_by_side(whole, n);
            let in_first_row = rects.iter().filter(|rect| rect.top() == whole.top()).count();
            assert_eq!((rects.len(), in_first_row), (n, n_columns), "{n} in {size:?}");
            for (idx, rect) in rects.iter().enumerate() {
                assert!(whole.expand(0.01).contains_rect(*rect), "{n} in {size:?}: {rect:?}");
                assert!(rects[..idx].iter().all(|other| !other.intersects(*rect)), "{rects:?}");
            }
        }
        assert!(courses_have_room(vec2(320.0, 200.0), 2));
        assert!(!courses_have_room(vec2(280.0, 200.0), 2));
        assert!(courses_have_room(vec2(200.0, 320.0), 2));
    }
}
