//! The rows of a card of the evidence: one for each field, in a grid of four columns, or of two where the
//! pane is narrow. A field that is empty is not known.

use egui::{ComboBox, Response, Ui};

use crate::app::reconstruction::{MarkKey, ReconstructionCommand};
use crate::app::widgets::{EmptyField, PointRows, optional_quantity};
use impactlab_core::ranges::Range;
use impactlab_core::units::{NumberFormat, UnitSystem, percent};
use impactlab_reconstruct::evidence::{
    Bounds, Choice, Field, Fields, PlaceMut, PointsMut, Sigma, Stated, Word,
};

/// Width of a card below which the second number of a row stands in a row of its own, points.
const NARROW: f32 = 370.0;
/// Width of a list of words, points.
const LIST_WIDTH: f32 = 84.0;
/// What an empty field says.
const NOT_KNOWN: &str = "not known";

/// Which fields of an item are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShownFields {
    /// All of them.
    All,
    /// Those with a standard deviation.
    Measured,
    /// The numbers without one.
    Plain,
}

/// Draws the fields of an item.
pub struct FieldRows<'u> {
    /// Where they are drawn.
    pub ui: &'u mut Ui,
    /// The units of the numbers.
    pub units: UnitSystem,
    /// Tells the item apart from others: its table and its number.
    pub item: (&'static str, Option<usize>),
    /// Which are drawn.
    pub shown: ShownFields,
    /// Whether the second number of a row stands below the first.
    pub is_narrow: bool,
    /// The mark to which clicks in the scene add points.
    pub adds_to: Option<MarkKey>,
    /// What the user asks for beside the edits.
    pub command: Option<ReconstructionCommand>,
}

/// Whether the rows of a card are as narrow as this place.
pub fn is_narrow(ui: &Ui) -> bool {
    ui.available_width() < NARROW
}

/// A label as the beginning of a row.
pub fn sentence_case(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_uppercase().chain(chars).collect())
}

impl<'u> FieldRows<'u> {
    /// All fields of an item.
    pub fn new(ui: &'u mut Ui, units: UnitSystem, item: (&'static str, Option<usize>)) -> Self {
        let shown = ShownFields::All;
        Self { ui, units, item, shown, is_narrow: false, adds_to: None, command: None }
    }

    /// Begins the second half of a row.
    fn second_half(&mut self) {
        if self.is_narrow {
            self.ui.end_row();
        }
    }

    fn quantity(
        &mut self,
        value: &mut Option<f64>,
        empty: EmptyField<'_>,
        range: &Range,
    ) -> Response {
        optional_quantity(self.ui, value, empty, range, self.units)
    }

    /// A standard deviation: an empty field has that of the program in parentheses.
    /// That is a share of the value for some, which is said where there is none yet.
    fn sigma(&mut self, sigma: &Sigma, value: Option<f64>, stated: &mut Option<f64>) -> Response {
        let start_si = sigma.default_at(value.unwrap_or(0.0));
        let text = match (value, sigma.relative()) {
            (None, Some(share)) => format!("({} of it)", percent(share)),
            _ => {
                let format = NumberFormat::english(self.units);
                format!("({})", format.rounded(sigma.field.range.quantity, start_si))
            }
        };
        let empty = EmptyField { text: &text, start_si };
        let response = self.quantity(stated, empty, &sigma.field.range);
        let source = format!("One standard deviation. Where the field is empty: {}", sigma.source);
        response.on_hover_text(source)
    }

    fn list(&mut self, choice: &Choice, shown: &str, draw: impl FnOnce(&mut Ui)) {
        let name = self.ui.label(sentence_case(choice.label));
        ComboBox::from_id_salt((choice.key, self.item))
            .selected_text(shown)
            .width(LIST_WIDTH)
            .show_ui(self.ui, draw)
            .response
            .labelled_by(name.id);
        self.ui.end_row();
    }
}

impl Fields for FieldRows<'_> {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        if self.shown == ShownFields::Measured {
            return;
        }
        let name = self.ui.label(sentence_case(field.label));
        let text = if field.default.is_empty() { NOT_KNOWN } else { field.default };
        let empty = EmptyField { text, start_si: 0.0 };
        self.quantity(value, empty, &field.range).labelled_by(name.id);
        self.ui.end_row();
    }

    fn measured(&mut self, field: &Field, sigma: &Sigma, stated: &mut Option<Stated>) {
        if self.shown == ShownFields::Plain {
            return;
        }
        let mut parts = stated.unwrap_or_default();
        let name = self.ui.label(sentence_case(field.label));
        let empty = EmptyField { text: NOT_KNOWN, start_si: 0.0 };
        self.quantity(&mut parts.value, empty, &field.range).labelled_by(name.id);
        self.second_half();
        let sign = self.ui.label("±");
        self.sigma(sigma, parts.value, &mut parts.sigma).labelled_by(sign.id);
        self.ui.end_row();
        *stated = (parts != Stated::default()).then_some(parts);
    }

    fn place(&mut self, [x, y]: [&Field; 2], sigma: &Sigma, place: PlaceMut<'_>) {
        self.number(x, place.x_m);
        self.number(y, place.y_m);
        let name = self.ui.label(sigma.field.label);
        self.sigma(sigma, None, place.sigma_m).labelled_by(name.id);
        self.ui.end_row();
    }

    fn points(&mut self, field: &Field, sigma: &Sigma, points: PointsMut<'_>) {
        let PointsMut { points_m, sigma_m } = points;
        let name = self.ui.label(sigma.field.label);
        self.sigma(sigma, None, sigma_m).labelled_by(name.id);
        self.ui.end_row();
        let (section, idx) = self.item;
        let mark = idx.map(|idx| MarkKey { section, idx });
        self.ui.label(format!("{} points", points_m.len()));
        let is_adding = mark.is_some() && self.adds_to == mark;
        let hint = "Then click along the mark in the scene, from where it starts";
        if self.ui.selectable_label(is_adding, "Add points").on_hover_text(hint).clicked() {
            self.command = Some(ReconstructionCommand::AddPoints(mark.filter(|_| !is_adding)));
        }
        self.ui.end_row();
        let id = self.ui.scope_id().with(("next point", self.item));
        let (range, units, is_narrow) = (&field.range, self.units, self.is_narrow);
        PointRows { id, range, units, is_narrow }.draw(self.ui, points_m);
    }

    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        let [mut low, mut high] = bounds.unwrap_or_default();
        let name = self.ui.label(sentence_case(field.label));
        let empty = EmptyField { text: NOT_KNOWN, start_si: 0.0 };
        let up_to = field.range.at_most(high.unwrap_or(field.range.high));
        self.quantity(&mut low, empty, &up_to).labelled_by(name.id);
        self.second_half();
        self.ui.label("to");
        let from = field.range.within([low.unwrap_or(field.range.low), field.range.high]);
        self.quantity(&mut high, empty, &from).labelled_by(name.id);
        self.ui.end_row();
        *bounds = (low.is_some() || high.is_some()).then_some([low, high]);
    }

    fn choice<W: Word>(&mut self, choice: &Choice, word: &mut W) {
        let shown = word.label();
        self.list(choice, shown, |ui| {
            for other in W::ALL {
                ui.selectable_value(word, *other, other.label());
            }
        });
    }

    fn optional_choice<W: Word>(&mut self, choice: &Choice, word: &mut Option<W>) {
        let shown = word.map_or(choice.none, W::label);
        self.list(choice, shown, |ui| {
            ui.selectable_value(word, None, choice.none);
            for other in W::ALL {
                ui.selectable_value(word, Some(*other), other.label());
            }
        });
    }

    fn choices<W: Word>(&mut self, choice: &Choice, words: &mut Option<Vec<W>>) {
        let mut is_known = words.is_some();
        let hint = format!("Not checked: {}", choice.none);
        let known = self.ui.checkbox(&mut is_known, sentence_case(choice.label));
        if known.on_hover_text(hint).changed() {
            *words = is_known.then(Vec::new);
        }
        if let Some(words) = words {
            self.ui.vertical(|ui| {
                for word in W::ALL {
                    let mut is_chosen = words.contains(word);
                    if ui.checkbox(&mut is_chosen, word.label()).changed() {
                        words.retain(|other| other != word);
                        words.extend(is_chosen.then_some(*word));
                    }
                }
            });
        }
        self.ui.end_row();
    }
}
