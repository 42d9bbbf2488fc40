//! The losses of a training of either network over the epochs.

use egui::{Grid, Ui};

use crate::app::command::Command;
use crate::app::network::Network;
use crate::app::widgets::{figure_frame, value_row};
use impactlab_core::units::{UnitSystem, significant};
use impactlab_document::figure::{Figure, LossCurve, balance_figure, loss_figure};
use impactlab_draw::FigureOptions;
use impactlab_networks::learning::{EpochSummary, PhysicsBalance};

/// Smallest height of a plot, points.
const MIN_PLOT_HEIGHT: f32 = 200.0;
/// Height that is reserved for the titles of the plots and for the numbers below them, points.
const BELOW_PLOT: f32 = 190.0;

/// Settings that determine how the losses are drawn.
pub struct LossView<'a> {
    /// Names of the loss terms that are drawn; the user changes them with checkboxes.
    pub terms: &'a mut Vec<String>,
    /// Whether the axis of the losses should be logarithmic. It is linear if a shown loss is not
    /// positive.
    pub log: &'a mut bool,
    /// Whether the plots fit their view to the data again.
    pub reset: bool,
    /// System of units of what was assumed.
    pub units: UnitSystem,
}

/// Draws the losses, the balance between the data and the physics loss if the training has one, and
/// the numbers of the last epoch. An empty history draws nothing.
///
/// - `title`: title of the plot of the losses.
/// - `history`: the epochs of the training, in order.
/// - `best_epoch`: the epoch with the best weights, if the training keeps those instead of the
///   last.
pub fn losses_ui(
    ui: &mut Ui,
    network: Network,
    title: &str,
    history: &[EpochSummary],
    best_epoch: Option<usize>,
    view: LossView<'_>,
    commands: &mut Vec<Command>,
) {
    let Some(first) = history.first() else { return };
    let names: Vec<&'static str> = first.losses.iter().map(|loss| loss.name).collect();
    loss_choice_ui(ui, &names, view.terms, view.log);
    let losses = loss_figure(
        title,
        &curves(history, &names, view.terms),
        first.epoch,
        best_epoch,
        *view.log,
    );
    if *view.log && !losses.log_y {
        ui.weak("A shown loss is zero or less, as a likelihood may be: the axis is linear.");
    }
    let height = (ui.available_height() - BELOW_PLOT).max(MIN_PLOT_HEIGHT);
    let mut plot = |ui: &mut Ui, figure: &Figure, name: &str| {
        let options = FigureOptions {
            id: format!("{name} of the {}", network.model()),
            link: Some(egui::Id::unique("epochs")),
            height: Some(height),
            reset: view.reset,
            ..FigureOptions::default()
        };
        figure_frame(ui, &figure.title, figure, &options, commands);
    };
    match balance(history) {
        None => plot(ui, &losses, "losses"),
        Some(balance) => ui.columns(2, |columns| {
            plot(&mut columns[0], &losses, "losses");
            plot(&mut columns[1], &balance, "balance");
        }),
    }
    if let Some(last) = history.last() {
        Grid::new(("last epoch", network.model()))
            .num_columns(2)
            .show(ui, |ui| last_epoch_ui(ui, last, best_epoch));
    }
}

/// The training and the validation loss of each chosen term over the epochs.
///
/// - `names`: the loss terms in the order in which every epoch lists them.
fn curves(history: &[EpochSummary], names: &[&'static str], chosen: &[String]) -> Vec<LossCurve> {
    let of_term = |idx: usize| history.iter().filter_map(move |epoch| epoch.losses.get(idx));
    let is_chosen = |name: &str| chosen.iter().any(|chosen| chosen == name);
    let names = names.iter().enumerate().filter(|(_, name)| is_chosen(name));
    names
        .map(|(idx, name)| LossCurve {
            name: (*name).to_owned(),
            train: of_term(idx).map(|loss| loss.train).collect(),
            validation: of_term(idx).filter_map(|loss| loss.validation).collect(),
        })
        .collect()
}

/// The share of the data in the loss and the weight of the physics loss over the epochs; `None` if
/// no epoch reports them.
fn balance(history: &[EpochSummary]) -> Option<Figure> {
    let over_epochs = |value: fn(PhysicsBalance) -> f64| -> Vec<[f64; 2]> {
        let point = |epoch: &EpochSummary| Some([epoch.epoch as f64, value(epoch.physics?)]);
        history.iter().filter_map(point).collect()
    };
    let shares = over_epochs(|physics| physics.data_share);
    let weights = over_epochs(|physics| physics.weight);
    (!shares.is_empty()).then(|| balance_figure(shares, weights))
}

/// Draws the numbers of the last epoch in a two-column grid: losses, learning rate, gradient norm
/// and time.
fn last_epoch_ui(ui: &mut Ui, last: &EpochSummary, best_epoch: Option<usize>) {
    let stage = last.stage.as_ref().map_or(String::new(), |stage| format!(", {stage}"));
    match best_epoch {
        Some(best) => value_row(ui, "Best epoch, last epoch", &format!("{best}, {}", last.epoch)),
        None => value_row(ui, "Last epoch", &format!("{}{stage}", last.epoch)),
    }
    match last.total() {
        (train, Some(validation)) => {
            let losses = [train, validation].map(significant).join(", ");
            value_row(ui, "Loss, train and validation", &losses);
        }
        (train, None) => value_row(ui, "Loss", &significant(train)),
    }
    if let Some(physics) = last.physics {
        let balance = format!("{:.2}, {}", physics.data_share, significant(physics.weight));
        value_row(ui, "Balance, weight of physics", &balance);
    }
    value_row(ui, "Learning rate", &format!("{:.2e}", last.learning_rate));
    value_row(ui, "Longest gradient", &format!("{:.2e}", last.gradient_norm));
    if let Some(seconds) = last.seconds {
        value_row(ui, "Time per epoch", &format!("{seconds:.2} s"));
    }
}

/// Draws the choice of the loss terms and of the logarithmic axis.
///
/// - `selected`: names of the chosen terms.
fn loss_choice_ui(ui: &mut Ui, names: &[&'static str], selected: &mut Vec<String>, log: &mut bool) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Losses");
        for name in names {
            let position = selected.iter().position(|other| other == name);
            let mut is_selected = position.is_some();
            if ui.checkbox(&mut is_selected, *name).changed() {
                match position {
                    Some(position) => drop(selected.remove(position)),
                    None => selected.push((*name).to_owned()),
                }
            }
        }
        ui.separator();
        ui.checkbox(log, "logarithmic")
            .on_hover_text("Where no shown loss is zero or less, as a likelihood may be");
    });
}
