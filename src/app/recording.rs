//! A recording that is drawn over the motion, such as a measured one over a scenario.

use egui::{DragValue, Ui};
use serde::{Deserialize, Serialize};

use crate::app::source::{Content, Source};
use impactlab_core::data::{Channel, TimeSeries};
use impactlab_study::CheckedFile;
use impactlab_study::SeriesFile;

/// The recording that is drawn over the motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OverlaidRecording {
    /// Its file, which is open.
    pub file: SeriesFile,
    /// Time of the motion at which the recording begins its own time, s.
    pub offset_s: f64,
}

/// A recording with its name and offset, s.
pub type Overlaid<'a> = (String, &'a TimeSeries, f64);

/// The recording that is drawn over the motion, if its file is open.
pub fn overlaid<'a>(
    chosen: Option<&OverlaidRecording>,
    sources: &'a [Source],
) -> Option<Overlaid<'a>> {
    let chosen = chosen?;
    let source = sources.iter().find(|source| source.path == chosen.file.path)?;
    Some((source.name(), &motion_file(source)?.loaded.series, chosen.offset_s))
}

/// The file of a source, if it holds a motion.
fn motion_file(source: &Source) -> Option<&CheckedFile> {
    let Content::File(file) = &source.content else { return None };
    let motion = [Channel::X, Channel::Y, Channel::Vx, Channel::Vy, Channel::YawRate, Channel::Yaw];
    motion.iter().any(|channel| file.loaded.series.get(*channel).is_some()).then_some(file)
}

/// Draws the choice of the recording among the open files, and its offset in time.
pub fn recording_menu_ui(ui: &mut Ui, chosen: &mut Option<OverlaidRecording>, sources: &[Source]) {
    let files: Vec<&Source> = sources.iter().filter(|of| motion_file(of).is_some()).collect();
    if files.is_empty() && chosen.is_none() {
        return;
    }
    ui.menu_button("Recording", |ui| {
        ui.weak("Drawn over the motion; open its file first");
        ui.selectable_value(chosen, None, "none");
        for source in files {
            let is_chosen = chosen.as_ref().is_some_and(|chosen| chosen.file.path == source.path);
            if ui.selectable_label(is_chosen, source.name()).clicked() && !is_chosen {
                *chosen = Some(OverlaidRecording { file: source.series_file(), offset_s: 0.0 });
            }
        }
    });
    if let Some(OverlaidRecording { offset_s, .. }) = chosen {
        let name = ui.label("begins at");
        let field = DragValue::new(offset_s).speed(0.005).max_decimals(3).suffix(" s");
        let hint = "Time of the motion at which the recording has its time zero";
        ui.add(field).labelled_by(name.id).on_hover_text(hint);
    }
}
