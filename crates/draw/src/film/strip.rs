//! The text of a frame: title and time in a line above the scene, legend and restriction below it. Each has
//! the same place at every time of a scene, and the scene goes from edge to edge between them.

use std::sync::Arc;

use egui::text::{LayoutJob, TextWrapping};
use egui::{FontId, Galley, Rect, Ui, Vec2, pos2, vec2};

use crate::caveats::{LINE_HEIGHT, RestrictionLine};
use crate::scene::{LegendRows, ScenePicture};
use impactlab_core::units::{Language, NumberFormat};

/// Height of the line above the scene, and size of its text, points.
const HEAD_HEIGHT: f32 = 20.0;
const HEAD_SIZE: f32 = 13.0;
/// Sizes of a title, the smaller ones where there is not enough room, points.
const TITLE_SIZES: [f32; 4] = [HEAD_SIZE, 11.5, 10.0, SMALLEST_SIZE];
const SMALLEST_SIZE: f32 = 8.5;
/// Distance of text from the edges at the sides, and room above and below what stands below the scene,
/// points.
const SIDE: f32 = 8.0;
const ROOM: f32 = 1.0;
/// Most rows of the legend, and the largest share of the height of the frame that they take together; one
/// row is always there.
const MOST_ROWS: usize = 2;
const LEGEND_SHARE: f32 = 0.13;
const ROW_HEIGHT: f32 = 13.0;

/// The text of a frame.
pub struct Strip {
    size: Vec2,
    legend: LegendRows,
    restriction: Option<RestrictionLine>,
}

impl Strip {
    /// The text of a frame of a size, points.
    pub fn new(ui: &Ui, picture: &ScenePicture, size: Vec2) -> Self {
        let n_rows = (LEGEND_SHARE * size.y / ROW_HEIGHT) as usize;
        let width = (size.x - 2.0 * SIDE).max(1.0);
        // Courses of events have the same names.
        let scene = picture.drawn().first().map_or(&picture.scene, |first| *first);
        let legend = LegendRows::new(ui, scene, width, n_rows.clamp(1, MOST_ROWS));
        let (units, language) = (picture.scene.units, picture.scene.language);
        let format = NumberFormat { units, language };
        let caveats = &picture.scene.caveats;
        let restriction = match language {
            Language::En => RestrictionLine::new(&caveats.in_units(units), &format),
            Language::De => RestrictionLine::new(caveats, &format),
        };
        Self { size, legend, restriction }
    }

    /// Where the scene is, points.
    pub fn scene_rect(&self) -> Rect {
        let line = if self.restriction.is_some() { LINE_HEIGHT } else { 0.0 };
        let foot = self.legend.height() + line;
        let foot = if foot > 0.0 { foot + 2.0 * ROOM } else { 0.0 };
        let bottom = (self.size.y - foot).max(HEAD_HEIGHT + 1.0);
        Rect::from_min_max(pos2(0.0, HEAD_HEIGHT), pos2(self.size.x, bottom))
    }

    /// Draws the text.
    ///
    /// - `speed`: seconds of the scene that are played in a second.
    pub fn ui(&self, ui: &mut Ui, picture: &ScenePicture, speed: f64) {
        let color = ui.visuals().strong_text_color();
        let format = NumberFormat { language: picture.scene.language, ..NumberFormat::default() };
        let time_at = |time_s, speed| {
            line(ui, &format.local(&time_text(time_s, speed)), self.size.x, HEAD_SIZE)
        };
        let time = time_at(picture.time_s, speed);
        // The widest time of a scene, so that none moves the title.
        let end_s = picture.scene.end_s.max(picture.time_s);
        let room = time_at(end_s, 0.125).size().x.max(time.size().x);
        let view = picture.camera.kind.phrase();
        let (scene, time_s) = (&picture.scene, picture.time_s);
        let titles = [scene.heading_beside_time(view, time_s), scene.heading_without_view(time_s)];
        let title = title(ui, titles, self.size.x - room - 3.0 * SIDE);
        let top = |height: f32| (HEAD_HEIGHT - height) / 2.0;
        ui.painter().galley(pos2(SIDE, top(title.size().y)), title, color);
        let left = self.size.x - SIDE - room;
        ui.painter().galley(pos2(left, top(time.size().y)), time, color);
        let scene = self.scene_rect();
        self.legend.draw(ui.painter(), scene.left_bottom() + vec2(SIDE, ROOM));
        if let Some(restriction) = &self.restriction {
            let at = scene.left_bottom() + vec2(SIDE, ROOM + self.legend.height());
            let width = (self.size.x - 2.0 * SIDE).max(1.0);
            restriction.ui(ui, Rect::from_min_size(at, vec2(width, LINE_HEIGHT)));
        }
    }
}

/// The first title that has room, in the largest letters in which it has; the last one is cut where none
/// has.
fn title(ui: &Ui, titles: [String; 2], widest: f32) -> Arc<Galley> {
    let sized = |text: &String| TITLE_SIZES.map(|size| line(ui, text, widest, size));
    let mut tried = titles.iter().flat_map(sized);
    let [_, shortest] = &titles;
    let cut = || line(ui, shortest, widest, SMALLEST_SIZE);
    tried.find(|title| !title.elided).unwrap_or_else(cut)
}

/// A line of text, which ends with “…” where it is too wide.
fn line(ui: &Ui, text: &str, widest: f32, size: f32) -> Arc<Galley> {
    let color = ui.visuals().strong_text_color();
    let font = FontId::proportional(size);
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = TextWrapping::truncate_at_width(widest.max(0.0));
    ui.painter().layout_job(job)
}

/// The time of a frame, with the speed at which it is played where that is another than its own.
fn time_text(time_s: f64, speed: f64) -> String {
    let speed = if speed == 1.0 { String::new() } else { format!("  × {speed}") };
    format!("t = {time_s:.3} s{speed}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Canvas;
    use crate::offscreen::shapes_offscreen;

    /// “scene in per…” stood above a scene that takes half of a page.
    #[test]
    fn a_title_loses_its_view_before_it_is_cut() {
        let titles = ["PIT, right rear quarter: scene in perspective", "PIT, right rear quarter"];
        let canvas = Canvas { size_px: [800, 300], scale: 1.0, dark: false };
        shapes_offscreen(canvas, |ui| {
            let told = |widest| {
                let galley = title(ui, titles.map(str::to_owned), widest);
                (galley.elided, galley.job.text.clone())
            };
            assert_eq!(told(600.0), (false, titles[0].to_owned()));
            assert_eq!(told(130.0), (false, titles[1].to_owned()));
            assert!(told(40.0).0, "a title without room is cut");
        })
        .unwrap();
    }
}
