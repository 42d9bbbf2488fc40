//! What is taken to be likely before the motion is looked at: the ranges that the user gives, and every
//! open quantity before and after the evidence as bars.

use egui::{CollapsingHeader, Grid, Sense, Ui, vec2};

use crate::app::panels::reconstruction::fields::{FieldRows, is_narrow};
use crate::app::reconstruction::{EvidencePreview, ReconstructionSession};
use impactlab_core::units::{UnitSystem, significant};
use impactlab_document::figure::Role;
use impactlab_draw::theme;
use impactlab_reconstruct::PriorComponent;
use impactlab_reconstruct::evidence::{Item, PriorRanges};
use impactlab_study::ReconstructRequest;

/// Largest width of a bar and its height, points.
const BAR: [f32; 2] = [110.0, 14.0];
/// Room for the text beside a bar, points.
const BESIDE_BAR: f32 = 140.0;

/// Draws the ranges that the user gives instead of the defaults.
pub fn prior_ranges_ui(ui: &mut Ui, ranges: &mut PriorRanges, units: UnitSystem) {
    CollapsingHeader::new("Ranges beforehand").show(ui, |ui| {
        ui.weak("Each value inside is equally likely; what is empty has a default.");
        let is_narrow = is_narrow(ui);
        Grid::new("prior ranges").min_col_width(10.0).show(ui, |ui| {
            let mut rows = FieldRows::new(ui, units, ("prior", None));
            rows.is_narrow = is_narrow;
            ranges.fields(&mut rows);
        });
    });
}

/// Draws every open quantity: the interval that holds 90 % before the evidence, and after it if there is
/// an answer.
pub fn priors_ui(
    ui: &mut Ui,
    preview: &EvidencePreview,
    request: &ReconstructRequest,
    session: &ReconstructionSession,
    units: UnitSystem,
) {
    let answer = session.answer().filter(|_| !session.is_outdated(Some(request)));
    let title = match answer {
        Some(_) => "Before and after the evidence",
        None => "Before the evidence",
    };
    CollapsingHeader::new(title).id_salt("priors").default_open(true).show(ui, |ui| {
        ui.weak("90 % of each quantity: grey before, blue after the motion was compared.");
        for (idx, component) in preview.priors.iter().enumerate() {
            let after = answer.and_then(|of| of.intervals_90.get(idx).copied().flatten());
            prior_row(ui, component, after, units);
        }
    });
}

fn prior_row(
    ui: &mut Ui,
    PriorComponent { latent, distribution, .. }: &PriorComponent,
    after: Option<[f64; 2]>,
    units: UnitSystem,
) {
    let unit = latent.quantity().display_unit(units);
    let before = distribution.ninety();
    let text = |ends: [f64; 2]| {
        let [low, high] = ends.map(|end| significant(unit.from_si(end)));
        format!("{low} … {high} {}", unit.symbol)
    };
    ui.label(latent.label());
    ui.horizontal(|ui| {
        let [low, high] = distribution.support();
        let share = |value: f64| ((value - low) / (high - low)).clamp(0.0, 1.0) as f32;
        let width = (ui.available_width() - BESIDE_BAR).clamp(BAR[0] / 2.0, BAR[0]);
        let (rect, response) = ui.allocate_exact_size(vec2(width, BAR[1]), Sense::hover());
        let dark = ui.visuals().dark_mode;
        let bar = |[from, to]: [f64; 2], (height, role): (f32, Role)| {
            let [left, right] = [from, to].map(|end| rect.left() + share(end) * rect.width());
            let size = vec2((right - left).max(2.0), height);
            let middle = egui::pos2(left, rect.center().y - height / 2.0);
            let bar = egui::Rect::from_min_size(middle, size);
            ui.painter().rect_filled(bar, 2.0, theme::color(role, dark));
        };
        bar([low, high], (1.0, Role::Muted));
        bar(before, (BAR[1], Role::Muted));
        if let Some(after) = after {
            bar(after, (BAR[1] / 2.0, Role::Model));
        }
        let hint = format!("possible: {}", text([low, high]));
        response.on_hover_text(hint);
        ui.label(text(after.unwrap_or(before)));
    });
}
