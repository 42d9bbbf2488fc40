//! The pixels of a scene, drawn on the CPU.
//!
//! What does not change with time (ground, grid, density, lines) is drawn when the camera, the size or
//! the scene changes, and kept, as are the pieces of tire marks in the order of time. A picture at another
//! time copies it and adds the marks up to then, shadows, cars, and the few lines that change. Rows are spread over threads of the canvas's own, so that a long computation
//! elsewhere does not make a picture wait.

use std::sync::Arc;

use egui::Color32;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::scene::frame::Frame;
use crate::scene::ground::Ground;
use crate::scene::lines::{Rows, Stroke};
use crate::scene::marks::MarkStrokes;
use crate::scene::moving_lines::MovingLines;
use crate::scene::raster::{TILE, Tile};
use crate::scene::shadow::draw_shadow;
use crate::scene::underlay::Underlay;
use crate::scene::{Camera, Projection};
use impactlab_document::scene::Scene;

/// Threads that draw, at most: more of them would wait for memory.
const MAX_THREADS: usize = 8;

/// How a scene is drawn, but for the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneLook {
    /// Width and height, pixels, each at least 1.
    pub size_px: [usize; 2],
    /// The camera.
    pub camera: Camera,
    /// Whether the theme is dark.
    pub dark: bool,
    /// Pixels per point, by which lines get their width.
    pub pixels_per_point: f32,
}

impl SceneLook {
    /// The projection of the camera into the picture.
    pub fn projection(&self) -> Projection {
        Projection::new(&self.camera, self.size_px.map(|side| side as f64))
    }
}

/// Draws scenes, and keeps what it can of the last picture.
#[derive(Default)]
pub struct SceneCanvas {
    threads: Option<ThreadPool>,
    /// The scene and the look of the ground that is kept.
    drawn: Option<(Arc<Scene>, SceneLook)>,
    /// The time of the picture.
    time_s: Option<f64>,
    ground: Vec<Color32>,
    /// Marks of tires as the camera sees them.
    marks: MarkStrokes,
    pixels: Vec<Color32>,
    frame: Frame,
}

impl SceneCanvas {
    /// Draws a scene at a time, if that is not the last picture already.
    ///
    /// - returns whether the picture has changed.
    pub fn draw(&mut self, scene: &Arc<Scene>, look: &SceneLook, time_s: f64) -> bool {
        let is_drawn = self
            .drawn
            .as_ref()
            .is_some_and(|(drawn, as_seen)| Arc::ptr_eq(drawn, scene) && as_seen == look);
        if is_drawn && self.time_s == Some(time_s) {
            return false;
        }
        if self.threads.is_none() {
            self.threads = threads();
        }
        let threads = self.threads.take();
        let mut work = || {
            if !is_drawn {
                self.draw_ground(scene, look);
            }
            self.draw_frame(scene, look, time_s);
        };
        match &threads {
            Some(threads) => threads.install(&mut work),
            None => work(),
        }
        self.threads = threads;
        self.drawn = Some((Arc::clone(scene), *look));
        self.time_s = Some(time_s);
        true
    }

    /// Pixels of the last picture, row by row from the top.
    pub fn pixels(&self) -> &[Color32] {
        &self.pixels
    }

    fn draw_ground(&mut self, scene: &Scene, look: &SceneLook) {
        let [width, height] = look.size_px;
        self.ground.resize(width * height, Color32::BLACK);
        let projection = look.projection();
        let ground = ground_of(scene, look, &projection);
        self.marks = MarkStrokes::new(&ground);
        draw_ground(&ground, look.size_px, &mut self.ground);
    }

    fn draw_frame(&mut self, scene: &Scene, look: &SceneLook, time_s: f64) {
        let width = look.size_px[0].max(1);
        let projection = look.projection();
        self.frame.fill(&ground_of(scene, look, &projection), time_s);
        self.pixels.resize(self.ground.len(), Color32::BLACK);
        let Frame { objects, shadows, lines: MovingLines { below, above }, .. } = &self.frame;
        let marks = self.marks.until(time_s);
        let ground = self.ground.par_chunks(width * TILE);
        let rows = self.pixels.par_chunks_mut(width * TILE).zip(ground).enumerate();
        rows.for_each_init(Tile::default, |tile, (idx, (pixels, ground))| {
            pixels.copy_from_slice(ground);
            let first = idx * TILE;
            let mut rows = Rows { pixels: &mut *pixels, width, first };
            draw_strokes(&mut rows, marks);
            for shadow in shadows {
                draw_shadow(&mut rows, shadow, &projection, look.dark);
            }
            draw_strokes(&mut rows, below);
            for left in (0..width).step_by(TILE) {
                tile.draw(pixels, width, [left, first], objects);
            }
            draw_strokes(&mut Rows { pixels, width, first }, above);
        });
    }
}

/// Draws what does not change with time, but for marks of tires.
///
/// - `pixels`: those of a picture of the size `width` and `height`, row by row from the top.
pub fn draw_ground(ground: &Ground<'_>, [width, _]: [usize; 2], pixels: &mut [Color32]) {
    let (strokes, underlay) = (ground.strokes(), Underlay::new(ground));
    let rows = pixels.par_chunks_mut(width.max(1) * TILE).enumerate();
    rows.for_each(|(idx, pixels)| {
        let mut rows = Rows { pixels, width, first: idx * TILE };
        ground.fill(&mut rows, &underlay);
        strokes.iter().for_each(|stroke| rows.stroke(stroke));
    });
}

fn draw_strokes(rows: &mut Rows<'_>, strokes: &[Stroke]) {
    strokes.iter().for_each(|stroke| rows.stroke(stroke));
}

/// What a picture of the ground is drawn with.
pub fn ground_of<'a>(scene: &'a Scene, look: &SceneLook, projection: &'a Projection) -> Ground<'a> {
    let points = f64::from(look.pixels_per_point);
    Ground { scene, projection, dark: look.dark, points }
}

/// The threads that draw; `None` if they cannot be started, so that the caller's thread draws.
fn threads() -> Option<ThreadPool> {
    let n_cores = std::thread::available_parallelism().map_or(1, usize::from);
    let builder = ThreadPoolBuilder::new().num_threads(n_cores.min(MAX_THREADS));
    builder.thread_name(|idx| format!("scene {idx}")).build().ok()
}
