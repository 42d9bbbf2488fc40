//! How long the window takes to draw itself.

use egui::util::History;

/// Number of frames and time, s, over which the means are taken.
const N_FRAMES: usize = 120;
const WINDOW_S: f32 = 2.0;

/// The frames of the last seconds.
pub struct FrameTimes {
    /// Whether they are shown.
    pub is_shown: bool,
    /// Time of the processor for each frame, s.
    processor_s: History<f32>,
}

impl Default for FrameTimes {
    fn default() -> Self {
        Self { is_shown: false, processor_s: History::new(0..N_FRAMES, WINDOW_S) }
    }
}

impl FrameTimes {
    /// Adds a frame.
    ///
    /// - `now_s`: the present time, s;
    /// - `processor_s`: what the frame before this one took of the processor without the renderer, s.
    pub fn add(&mut self, now_s: f64, processor_s: Option<f32>) {
        self.processor_s.add(now_s, processor_s.unwrap_or(0.0));
    }

    /// Frames a second and time of the processor for each, as text; empty if the window stands still.
    pub fn text(&self) -> String {
        let rate = self.processor_s.rate();
        let mean = self.processor_s.average();
        rate.zip(mean).map_or(String::new(), |(rate, mean_s)| {
            format!("{rate:.0} frames a second, {:.1} ms of the processor each", 1e3 * mean_s)
        })
    }
}
