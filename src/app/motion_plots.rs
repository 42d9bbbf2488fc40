//! The figures of the motion over time. They are made anew when what they show changes, and not for every
//! frame in which a motion is played.

use std::sync::Arc;

use crate::app::recording::{OverlaidRecording, overlaid};
use crate::app::source::{Content, Source};
use impactlab_core::data::Channel;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{Figure, analysis_motion_figure, control_figures, recording_line};
use impactlab_study::{CheckedFile, SimulateAnswer};

/// A recording that is drawn over a motion, with what was read of its file.
pub type Recorded = (OverlaidRecording, Arc<CheckedFile>);

/// What the figures show.
pub struct MotionSource {
    /// The simulation.
    pub answer: Arc<SimulateAnswer>,
    /// What restricts it.
    pub caveats: Caveats,
    /// Simulations of other variants, by name.
    pub others: Vec<(String, Arc<SimulateAnswer>)>,
    /// The recording beside them.
    pub recording: Option<Recorded>,
    /// The curves over time.
    pub channels: Vec<Channel>,
    /// System of units of the figures.
    pub units: UnitSystem,
}

/// The figures of the motion over time.
#[derive(Default)]
pub struct MotionPlots {
    of: Option<MotionSource>,
    /// One for each channel, in their order.
    pub channels: Vec<Figure>,
    /// What was done to the wheels.
    pub controls: Vec<ControlPlot>,
}

/// A figure of what was done to the wheels.
pub struct ControlPlot {
    /// That of the simulation alone.
    pub own: Figure,
    /// The same with those of other variants over it.
    pub figure: Figure,
}

impl MotionPlots {
    /// Makes the figures, if they are of something else.
    pub fn update(&mut self, source: MotionSource, sources: &[Source]) {
        if self.of.as_ref().is_some_and(|of| of.is_same(&source)) {
            return;
        }
        let figure = |channel: &Channel| source.channel_figure(*channel, sources);
        self.channels = source.channels.iter().map(figure).collect();
        self.controls = source.control_plots();
        self.of = Some(source);
    }
}

/// The recording that is drawn over the motion with its file, if that is open.
pub fn recorded(chosen: Option<&OverlaidRecording>, sources: &[Source]) -> Option<Recorded> {
    let chosen = chosen?;
    let source = sources.iter().find(|source| source.path == chosen.file.path)?;
    let Content::File(file) = &source.content else { return None };
    Some((chosen.clone(), Arc::clone(file)))
}

/// Whether two recordings are the same, of a file that has not been read again in between.
pub fn is_same_recording(of: Option<&Recorded>, other: Option<&Recorded>) -> bool {
    match (of, other) {
        (Some((of, file)), Some((other, other_file))) => {
            of == other && Arc::ptr_eq(file, other_file)
        }
        (of, other) => of.is_none() && other.is_none(),
    }
}

impl MotionSource {
    fn is_same(&self, other: &Self) -> bool {
        let mut others = self.others.iter().zip(&other.others);
        Arc::ptr_eq(&self.answer, &other.answer)
            && is_same_recording(self.recording.as_ref(), other.recording.as_ref())
            && self.others.len() == other.others.len()
            && others.all(|(of, other)| of.0 == other.0 && Arc::ptr_eq(&of.1, &other.1))
            && self.caveats == other.caveats
            && self.channels == other.channels
            && self.units == other.units
    }

    fn channel_figure(&self, channel: Channel, sources: &[Source]) -> Figure {
        let figure_of = |answer: &SimulateAnswer, caveats: &Caveats| {
            analysis_motion_figure(&answer.analysis, caveats, channel, self.units)
        };
        let mut figure = figure_of(&self.answer, &self.caveats);
        for (i, (name, other)) in self.others.iter().enumerate() {
            figure.overlay(name, i, &figure_of(other, &other.report.caveats));
        }
        let recording = self.recording.as_ref().map(|(of, _)| of);
        if let Some((name, series, offset_s)) = overlaid(recording, sources) {
            let line = recording_line(&name, series, offset_s, channel, self.units);
            figure.elements.extend(line);
        }
        figure
    }

    /// The plots of what was done to the wheels; those of other variants over those of the same kind.
    fn control_plots(&self) -> Vec<ControlPlot> {
        let own = control_figures(&self.answer.analysis, &self.caveats, self.units);
        let mut figures = own.clone();
        for (i, (name, other)) in self.others.iter().enumerate() {
            let others = control_figures(&other.analysis, &other.report.caveats, self.units);
            for figure in &mut figures {
                let same = others.iter().find(|other| other.y.label == figure.y.label);
                same.into_iter().for_each(|other| figure.overlay(name, i, other));
            }
        }
        let plots = own.into_iter().zip(figures);
        plots.map(|(own, figure)| ControlPlot { own, figure }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_study::{Library, SeriesFile};

    /// The scene went on with a recording that had been corrected and opened again, where it had as many samples.
    #[test]
    fn a_recording_that_was_read_again_is_another() {
        let library = Library::default();
        let file = SeriesFile::new("datasets/trajectories-fea/trajectories/FE_c001.csv");
        let read = || {
            library.forget(&file.path);
            let loaded = library.series(&file).unwrap();
            let checked = Arc::new(CheckedFile { loaded, flags: Vec::new() });
            (OverlaidRecording { file: file.clone(), offset_s: 0.0 }, checked)
        };
        let (before, after) = (read(), read());
        let n_samples = |(_, file): &Recorded| file.loaded.series.n_samples();
        assert_eq!(n_samples(&before), n_samples(&after));
        assert!(is_same_recording(Some(&before), Some(&before.clone())));
        assert!(!is_same_recording(Some(&before), Some(&after)));
        assert!(!is_same_recording(Some(&before), None) && is_same_recording(None, None));
    }
}
