//! What stands in a pane while work is under way.

use std::time::Duration;

use egui::{Label, ProgressBar, Ui, WidgetText};

use crate::app::widgets::duration_text;

/// Widths of the bar of a run: where there is room, and at least, points.
const BAR_WIDTH: f32 = 420.0;
const LEAST_BAR_WIDTH: f32 = 96.0;

/// Draws a spinner beside what is done in a moment.
pub fn working_ui(ui: &mut Ui, what: impl Into<WidgetText>) {
    ui.horizontal(|ui| (ui.spinner(), ui.label(what)));
}

/// Draws a progress bar with the remaining time, or a spinner while the progress is not known.
///
/// - `what`: what the work is doing.
/// - `fraction`: the share that is done, 0 to 1.
/// - `left`: the estimated remaining time.
pub fn run_progress_ui(ui: &mut Ui, what: &str, fraction: Option<f32>, left: Option<Duration>) {
    match fraction {
        Some(fraction) => {
            let width = BAR_WIDTH.min(ui.available_size_before_wrap().x).max(LEAST_BAR_WIDTH);
            let bar = ProgressBar::new(fraction).desired_width(width);
            ui.add(bar.text(with_time_left(what, left)));
        }
        None => drop(ui.horizontal(|ui| (ui.spinner(), ui.add(Label::new(what).truncate())))),
    }
}

/// What work is doing, with the estimated remaining time.
pub fn with_time_left(what: &str, left: Option<Duration>) -> String {
    match left {
        Some(left) => format!("{what}, about {} left", duration_text(left)),
        None => what.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput};

    use super::*;

    #[test]
    fn the_time_that_is_left_is_told_as_an_estimate() {
        let left = Some(Duration::from_secs(150));
        assert_eq!(with_time_left("epoch 3 of 40", left), "epoch 3 of 40, about 2 min 30 s left");
        assert_eq!(with_time_left("reading the cases", None), "reading the cases");
    }

    #[test]
    fn a_bar_keeps_within_a_narrow_pane() {
        for (room, expected) in [(1000.0, BAR_WIDTH), (240.0, 240.0), (20.0, LEAST_BAR_WIDTH)] {
            let mut width = 0.0;
            let _ = Context::default().run_ui(RawInput::default(), |ui| {
                ui.set_max_width(room);
                let drawn = ui.scope(|ui| run_progress_ui(ui, "computing", Some(0.5), None));
                width = drawn.response.rect.width();
            });
            assert_eq!(width, expected, "in {room} points");
        }
    }
}
