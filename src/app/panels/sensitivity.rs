//! The “What moves it” pane: the Sobol indices of the outcome of the map.

use egui::{Label, RichText, ScrollArea, Ui};

use crate::app::panes::PaneContext;
use crate::app::widgets::{TITLE_HEIGHT, figure_frame};
use impactlab_document::figure::sensitivity_figure;
use impactlab_draw::FigureOptions;
use impactlab_sweep::atlas::Measure;

/// What the bars are, as one line above them.
const MEANING: &str = "Sobol indices: the share of the variance that each input moves alone, and in all \
    together with others. What a draw leaves open counts as one input, the unknowns.";

/// Height at which a bar has its name beside it, points.
const BAR_HEIGHT: f32 = 24.0;
/// Height of the axis and the legend, points.
const AXIS_HEIGHT: f32 = 70.0;

/// Draws the indices as bars.
pub fn sensitivity_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, session, commands, .. } = pane;
    let Some(atlas) = session.atlas.atlas() else {
        ui.weak("Which input moves the outcome most is shown here, once an atlas is open.");
        return;
    };
    let Some(choice) = view.atlas.choice(atlas) else { return };
    let Measure::Mean(outcome) = choice.measure else {
        ui.weak("The corridor has no Sobol indices: it is a quantile of many runs.");
        return;
    };
    let Some(indices) = atlas.sensitivity(outcome) else {
        ui.weak(format!("This atlas has no Sobol indices of: {}.", choice.measure.label()));
        return;
    };
    ui.add(Label::new(RichText::new(MEANING).weak()).wrap());
    let other_networks = session.atlas.other_networks();
    let figure = sensitivity_figure(choice.measure.label(), atlas, &indices, other_networks);
    // In a low pane the bars are scrolled: squeezed, they lose their names.
    let least = BAR_HEIGHT * figure.y.names.len() as f32 + AXIS_HEIGHT;
    let options = FigureOptions {
        id: "sensitivity".to_owned(),
        height: Some((ui.available_height() - TITLE_HEIGHT).max(least)),
        reset: session.fit_plots,
        pans: false,
        ..FigureOptions::default()
    };
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        figure_frame(ui, &figure.title, &figure, &options, commands);
    });
}
