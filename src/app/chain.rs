//! The chain above the panes: scenario, impact, force, motion, outcome. Each link says where it comes from,
//! its main figure, what restricts it, and whether it is of what is asked.

use egui::{Button, Panel, RichText, Ui};

use crate::app::command::Command;
use crate::app::looks::{Icon, colored_icon};
use crate::app::model::file_name;
use crate::app::panes::Pane;
use crate::app::response::MotionAnswer;
use crate::app::state::{State, Subject};
use crate::app::widgets::severity_color;
use impactlab_core::data::Severity;
use impactlab_core::uncertainty::{Caveat, Caveats};
use impactlab_core::units::{Estimate, NumberFormat, Quantity, UnitSystem, percent};
use impactlab_document::report::without_options;
use impactlab_study::{Answer, SimulateReport};

/// What the chain says while nothing is asked.
const NO_CASE: &str = "No case chosen";

/// A link of the chain.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// What it is.
    pub title: &'static str,
    /// Its main figure, with the interval of 90 % where it has one; none where it is not known.
    pub figure: Option<String>,
    /// Where it comes from.
    pub source: String,
    /// What restricts it, a sentence each.
    pub warnings: Vec<String>,
    /// Whether it is not of what is asked any more.
    pub is_late: bool,
    /// The panel that says more.
    pub pane: Pane,
}

impl State {
    /// The chain of answers about the subject.
    pub fn chain(&self) -> Vec<Link> {
        let units = self.view.units;
        let session = &self.session;
        let report = self.analysis().map(|answer| &answer.report);
        let motion = session.response.forecast.ok().map(AsRef::as_ref);
        let [is_simulation_late, is_motion_late] =
            [session.is_simulation_late(), session.is_motion_late()];
        vec![
            self.subject_link(),
            Link { is_late: is_simulation_late, ..self.impact_link(report) },
            Link {
                is_late: is_simulation_late || is_motion_late,
                ..force_link(report, motion, units)
            },
            Link { is_late: is_motion_late, ..motion_link(motion) },
            Link { is_late: is_motion_late, ..outcome_link(report, motion, units) },
        ]
    }

    /// The change of velocity of the struck vehicle: of a scenario by the momentum solution, which the
    /// scenario panel shows; of a recorded force over its contact, with what the tires add.
    fn impact_link(&self, report: Option<&Answer<SimulateReport>>) -> Link {
        let is_scenario = self.project.subject() == Some(Subject::Scenario);
        let solved = self.session.impact.ok().filter(|_| is_scenario && report.is_some());
        let (delta_v, source, pane) = match (is_scenario, solved) {
            (true, solved) => {
                let delta_v = solved.map(|answer| answer.report.struck.delta_v_magnitude_m_s);
                (delta_v, "momentum solution", Pane::Scenario)
            }
            (false, _) => {
                let delta_v = report.and_then(|report| report.delta_v_magnitude_m_s);
                (delta_v, "4DOF model, over the contact, with what the tires add", Pane::Force)
            }
        };
        let units = self.view.units;
        Link {
            title: "Impact",
            figure: delta_v.map(|m_s| {
                format!("Δv {}", NumberFormat::english(units).rough(Quantity::Speed, m_s))
            }),
            source: source.to_owned(),
            warnings: warnings(report.map(|report| &report.caveats), units),
            is_late: false,
            pane,
        }
    }

    /// The speed that a reconstruction gives, in the place of the chain where nothing is simulated; `None`
    /// without evidence.
    fn reconstruction_link(&self) -> Option<Link> {
        let request = self.project.reconstruct.as_ref()?;
        let session = &self.session.reconstruction;
        let answer = session.answer().filter(|_| !session.is_outdated(Some(request)));
        let report = answer.map(|answer| &answer.answer.report);
        let format = NumberFormat::english(self.view.units);
        let figure = report.and_then(|report| match report.modes.len() {
            0 | 1 => report.quantities.first().map(|of| {
                let speed = format.drawn_in_words(of.quantity(), &of.estimate);
                format!("{} {speed}", of.label())
            }),
            n => Some(format!("{n} courses of events")),
        });
        let source = match report {
            Some(_) => "from the evidence, interval of 90 %",
            None => "Run in the pane Evidence gives the speeds",
        };
        Some(Link {
            title: "Reconstruction",
            figure,
            source: source.to_owned(),
            warnings: warnings(report.map(|report| &report.caveats), self.view.units),
            is_late: session.run.is_running(),
            pane: Pane::Speeds,
        })
    }

    fn subject_link(&self) -> Link {
        let (figure, source, pane) = match &self.project.subject() {
            Some(Subject::Scenario) => {
                let name = self.project.impact.scenario.name();
                (Some(name), "as entered".to_owned(), Pane::Scenario)
            }
            Some(subject @ Subject::Case { dataset, .. }) => {
                (Some(self.name_of(subject)), dataset.display().to_string(), Pane::Cases)
            }
            Some(Subject::File(path)) => (Some(file_name(path)), "file".to_owned(), Pane::Data),
            Some(Subject::Manoeuvre) => {
                let name = self.project.simulate.source.name();
                (Some(name), "as entered".to_owned(), Pane::Vehicle)
            }
            None => (None, NO_CASE.to_owned(), Pane::Data),
        };
        // As in the contents of the case: a log is no scenario, and nothing may have been struck in it.
        let title = match &self.project.subject() {
            Some(Subject::File(_)) => "File",
            Some(Subject::Manoeuvre) => "Manoeuvre",
            Some(Subject::Scenario | Subject::Case { .. }) | None => "Scenario",
        };
        Link { title, figure, source, warnings: Vec::new(), is_late: false, pane }
    }
}

/// The force that drives the forecast: a distribution where a network predicts it.
fn force_link(
    report: Option<&Answer<SimulateReport>>,
    motion: Option<&MotionAnswer>,
    units: UnitSystem,
) -> Link {
    let shown = |n_s: f64| Quantity::Impulse.shown(n_s, units);
    let predicted = motion.filter(|motion| motion.answer.report.force_model.is_some());
    let (figure, source, pane) = if let Some(motion) = predicted {
        let format = NumberFormat::english(units);
        let impulse = motion.impulse_n_s.as_ref();
        let figure = impulse.map(|of| format.drawn_in_words(Quantity::Impulse, of));
        let model = motion.answer.report.force_model.clone().unwrap_or_default();
        (figure, format!("force network {model}, interval of 90 %"), Pane::ForcePrediction)
    } else {
        let force = report.and_then(|report| report.force.as_ref());
        let size = force.map(|force| force.impulse_n_s[0].hypot(force.impulse_n_s[1]));
        let is_pulse = report.is_some_and(|report| report.momentum.is_some());
        let source =
            if is_pulse { "pulse with the impulse of the momentum solution" } else { "record" };
        (size.map(shown), source.to_owned(), Pane::Force)
    };
    Link { title: "Force", figure, source, warnings: Vec::new(), is_late: false, pane }
}

/// Which model says how the vehicle moves, and how far it applies.
fn motion_link(motion: Option<&MotionAnswer>) -> Link {
    let figure = motion.map(|motion| {
        let share = motion.answer.report.applicability;
        match percent(share).as_str() {
            "100.0 %" => "network alone".to_owned(),
            "0.0 %" => "physics alone".to_owned(),
            share => format!("network {share}, physics the rest"),
        }
    });
    let source = match motion {
        Some(motion) => format!("response network {}", motion.answer.report.response_model),
        None => "no forecast".to_owned(),
    };
    let warnings = Vec::new();
    Link { title: "Motion", figure, source, warnings, is_late: false, pane: Pane::MotionForecast }
}

/// Where the vehicle is in the end: by the forecast, or by the 4DOF model where there is none.
fn outcome_link(
    report: Option<&Answer<SimulateReport>>,
    motion: Option<&MotionAnswer>,
    units: UnitSystem,
) -> Link {
    let format = NumberFormat::english(units);
    let length = |m: f64| format.rough(Quantity::Length, m);
    let (figure, source, pane) = match (motion, report.and_then(|report| report.end)) {
        (Some(motion), _) => {
            let report = &motion.answer.report;
            let outcome = &report.outcome;
            let shown = |end: &Estimate| format.drawn_in_words(Quantity::Length, end);
            let figure = format!("X {}, Y {}", shown(&outcome.x_m), shown(&outcome.y_m));
            let when = match report.known_until_s() < outcome.time_s {
                true => "after a second contact, which is not computed: no intervals".to_owned(),
                false => format!("forecast after {:.2} s, 90 % intervals", outcome.time_s),
            };
            (Some(figure), when, Pane::MotionForecast)
        }
        (None, Some(end)) => {
            let figure = format!("X {}, Y {}", length(end.x_m), length(end.y_m));
            (Some(figure), "4DOF model alone, without an interval".to_owned(), Pane::Scene)
        }
        (None, None) => (None, "no motion".to_owned(), Pane::Scene),
    };
    let warnings = warnings(motion.map(|motion| &motion.answer.report.caveats), units);
    Link { title: "Outcome", figure, source, warnings, is_late: false, pane }
}

/// The sentences of the caveats that warn.
fn warnings(caveats: Option<&Caveats>, units: UnitSystem) -> Vec<String> {
    let warnings = caveats.into_iter().flatten().filter(|caveat| caveat.is_warning());
    let told = |caveat: &Caveat| {
        let text = without_options(&caveat.in_units(units).text);
        format!("{}: {text}", caveat.kind.label())
    };
    warnings.map(told).collect()
}

/// Draws the chain; a click on a link shows its panel. While a figure is awaited the chain keeps its height, so
/// that nothing below it moves.
///
/// - `links`: that of [`State::chain`].
pub fn chain_ui(ui: &mut Ui, state: &State, links: &[Link], commands: &mut Vec<Command>) {
    let links = match state.project.subject() {
        Some(_) => links,
        None => &[],
    };
    let is_late = links.iter().any(|link| link.is_late);
    Panel::top("chain").show(ui, |ui| {
        let id = ui.scope_id().with("height");
        if let Some(height) = ui.data(|data| data.get_temp::<f32>(id)).filter(|_| is_late) {
            ui.set_min_height(height);
        }
        let drawn = ui.horizontal_wrapped(|ui| {
            if links.is_empty() {
                match state.reconstruction_link() {
                    Some(link) => link_ui(ui, &link, commands),
                    None => no_case_ui(ui, state.session.shows_doors, commands),
                }
            }
            for (i, link) in links.iter().enumerate() {
                if i > 0 {
                    ui.weak("›");
                }
                link_ui(ui, link, commands);
            }
        });
        if !is_late {
            let height = drawn.response.rect.height();
            ui.data_mut(|data| data.insert_temp(id, height));
        }
    });
}

/// Draws in the place of the chain what to do while nothing is asked.
fn no_case_ui(ui: &mut Ui, shows_doors: bool, commands: &mut Vec<Command>) {
    ui.strong(NO_CASE);
    if shows_doors {
        ui.label("Begin with one of the three ways below");
    } else {
        ui.label("Choose a case of the data that are open, or");
        if ui.small_button("see the ways to begin").clicked() {
            commands.push(Command::ShowDoors);
        }
    }
}

fn link_ui(ui: &mut Ui, link: &Link, commands: &mut Vec<Command>) {
    let figure = match (&link.figure, link.is_late) {
        (_, true) => "computing…",
        (Some(figure), false) => figure.as_str(),
        (None, false) => "–",
    };
    let text = RichText::new(format!("{}: {figure}", link.title));
    let warning = severity_color(ui, Severity::Warning);
    let text = match (link.is_late || link.figure.is_none(), link.warnings.is_empty()) {
        (true, _) => text.weak(),
        (false, true) => text,
        (false, false) => text.color(warning),
    };
    let lines = std::iter::once(&link.source).chain(&link.warnings);
    let hint = lines.map(String::as_str).collect::<Vec<_>>().join("\n");
    // Not by its colour alone.
    let button = match link.warnings.is_empty() {
        true => Button::new(text),
        false => Button::new((text, colored_icon(Icon::TriangleAlert, warning))),
    };
    if ui.add(button.small()).on_hover_text(hint).clicked() {
        commands.push(Command::Show(link.pane));
    }
}
