//! What the case consists of, as the tree at the left of the Case workspace shows it.

use crate::app::chain::Link;
use crate::app::command::Command;
use crate::app::ground::SITE;
use crate::app::looks::Icon;
use crate::app::model::{ModelStatus, file_name};
use crate::app::network::TrainedModel;
use crate::app::panels::ending_in_words;
use crate::app::panes::Pane;
use crate::app::source::{Content, Source};
use crate::app::state::{State, Subject};
use crate::app::widgets::{vehicle_label, vehicle_name};
use impactlab_core::collision::Role;
use impactlab_core::units::Quantity;
use impactlab_core::vehicle::FixedObject;
use impactlab_study::{DEFAULT_STRIKING, DEFAULT_VEHICLE};

/// A part of the case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::IntoStaticStr, strum::VariantArray)]
pub enum Group {
    /// The vehicles.
    Vehicles,
    /// Road, duration and what happens after the impact.
    Scene,
    /// What hits the struck vehicle.
    Impact,
    /// Recordings and data sets.
    Data,
    /// The trained networks that answer.
    Models,
    /// What was found.
    Results,
}

impl Group {
    /// Every part, from top to bottom.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// The name that is shown.
    pub fn title(self) -> &'static str {
        self.into()
    }

    /// The icon beside the name.
    pub fn icon(self) -> Icon {
        match self {
            Self::Vehicles => Icon::Car,
            Self::Scene => Icon::Map,
            Self::Impact => Icon::Zap,
            Self::Data => Icon::Database,
            Self::Models => Icon::BrainCircuit,
            Self::Results => Icon::Flag,
        }
    }
}

/// A line of the tree.
#[derive(Debug, Clone)]
pub struct ContentsEntry {
    /// The part it belongs to.
    pub group: Group,
    /// What it is.
    pub label: String,
    /// Its value, source or figure.
    pub detail: String,
    /// What is missing or wrong.
    pub missing: Option<String>,
    /// What a click does: it shows the panel in which it is changed.
    pub command: Command,
}

impl ContentsEntry {
    fn new(group: Group, label: &str, detail: String, command: Command) -> Self {
        Self { group, label: label.to_owned(), detail, missing: None, command }
    }

    fn missing(self, why: Option<String>) -> Self {
        Self { missing: why, ..self }
    }
}

impl State {
    /// What the case consists of, part by part, with what is missing for the next answer.
    ///
    /// - `chain`: that of [`State::chain`].
    pub fn contents(&self, chain: &[Link]) -> Vec<ContentsEntry> {
        let mut entries = Vec::new();
        entries.extend(self.vehicle_entries());
        entries.extend(self.scene_entries());
        entries.push(self.site_entry());
        entries.push(self.impact_entry());
        entries.extend(self.session.sources.iter().map(|source| self.source_entry(source)));
        if self.session.sources.is_empty() {
            entries.push(ContentsEntry::new(
                Group::Data,
                "nothing open",
                String::new(),
                Command::Show(Pane::Data),
            ));
        }
        entries.extend(self.evidence_entry());
        entries.push(model_entry("Force network", &self.session.force.model));
        entries.push(model_entry("Response network", &self.session.response.model));
        entries.extend(result_entries(chain));
        entries
    }

    fn vehicle_entries(&self) -> [ContentsEntry; 2] {
        let of = [
            ("Struck", Role::Struck, DEFAULT_VEHICLE),
            ("Striking", Role::Striking, DEFAULT_STRIKING),
        ];
        let units = self.view.units;
        of.map(|(label, role, default)| {
            let assumed = format!("left open (else {})", vehicle_name(default.id(), units));
            let detail = match self.fixed_object(role) {
                Some(object) => object.word().to_owned(),
                None => vehicle_label(&self.project.chosen_vehicle(role), &assumed, units),
            };
            let show = Command::Show(Pane::Vehicle);
            ContentsEntry::new(Group::Vehicles, label, detail, show)
        })
    }

    /// The object that the scenario has in place of a vehicle.
    fn fixed_object(&self, role: Role) -> Option<FixedObject> {
        let is_striking = role == Role::Striking;
        let is_scenario = self.project.subject() == Some(Subject::Scenario);
        self.project.scenario().filter(|_| is_striking && is_scenario)?.striking.fixed
    }

    fn scene_entries(&self) -> [ContentsEntry; 2] {
        let report = self.analysis().map(|answer| &answer.report);
        let road = report.map_or("–".to_owned(), |report| format!("μ {:.2}", report.friction));
        let until = match self.project.simulate.until_rest {
            true => "until rest".to_owned(),
            false => Quantity::Time.shown(self.project.simulate.duration_s, self.view.units),
        };
        let subject = self.project.subject();
        let ending = match &subject {
            Some(Subject::Scenario) => self.project.scenario().and_then(|of| of.ending.as_ref()),
            _ => self.project.simulate.ending.as_ref(),
        };
        let after = format!("{}, {until}", ending_in_words(ending));
        let is_alone = subject.is_some() && self.project.simulate.source.is_alone();
        let from = if is_alone { "From the start" } else { "After the impact" };
        let pane = match subject {
            Some(Subject::Scenario) => Pane::Scenario,
            _ => Pane::Vehicle,
        };
        [
            ContentsEntry::new(Group::Scene, "Road", road, Command::Show(pane)),
            ContentsEntry::new(Group::Scene, from, after, Command::Show(pane)),
        ]
    }

    /// The site. Without one the line leads to where it is opened.
    fn site_entry(&self) -> ContentsEntry {
        let Some(file) = &self.project.simulate.site else {
            let (none, show) = ("none, lanes are not counted", Command::Show(Pane::Scenario));
            return ContentsEntry::new(Group::Scene, SITE, none.to_owned(), show);
        };
        let ground = &self.session.ground;
        let detail = match ground.shown() {
            Some(loaded) => loaded.site.name.clone(),
            None if ground.is_loading() => "loading…".to_owned(),
            None => file_name(file),
        };
        let missing = ground.shown().and_then(|loaded| loaded.notes.first().cloned());
        let missing = ground.problem.clone().or(missing);
        let show = Command::Show(Pane::Scene);
        ContentsEntry::new(Group::Scene, SITE, detail, show).missing(missing)
    }

    fn impact_entry(&self) -> ContentsEntry {
        let subject = self.project.subject();
        let (label, detail, pane) = match &subject {
            Some(Subject::Scenario) => {
                ("Scenario", self.project.impact.scenario.name(), Pane::Scenario)
            }
            Some(Subject::Case { dataset, case }) => {
                ("Recorded case", format!("{case} of {}", file_name(dataset)), Pane::Cases)
            }
            Some(Subject::File(path)) => ("File", file_name(path), Pane::Vehicle),
            Some(Subject::Manoeuvre) => {
                ("Manoeuvre", self.project.simulate.source.name(), Pane::Vehicle)
            }
            None => ("no case chosen", String::new(), Pane::Scenario),
        };
        let missing = match (&subject, self.session.analysis.problem()) {
            (None, _) => {
                Some("choose a scenario, a case of a data set, or a file with a force".to_owned())
            }
            (Some(_), problem) => problem.map(str::to_owned),
        };
        ContentsEntry::new(Group::Impact, label, detail, Command::Show(pane)).missing(missing)
    }

    fn source_entry(&self, source: &Source) -> ContentsEntry {
        let (detail, missing, command) = match &source.content {
            Content::Loading => ("loading…".to_owned(), None, Command::Show(Pane::Data)),
            Content::Dataset(checked) => {
                let detail = format!("{} cases", checked.dataset.cases.len());
                let n_problems = checked.dataset.problems.len();
                let problems = (n_problems > 0).then(|| format!("{n_problems} problems"));
                (detail, problems, Command::Show(Pane::Data))
            }
            Content::File(file) => {
                let detail = format!("{} samples", file.loaded.series.n_samples());
                let flag = file.flags.first().map(ToString::to_string);
                (detail, flag, Command::Select(Subject::File(source.path.clone())))
            }
            Content::Failed(why) => {
                ("not read".to_owned(), Some(why.clone()), Command::Show(Pane::Data))
            }
        };
        ContentsEntry::new(Group::Data, &source.name(), detail, command).missing(missing)
    }

    /// The evidence of a reconstruction, if there is any.
    fn evidence_entry(&self) -> Option<ContentsEntry> {
        self.project.reconstruct.as_ref()?;
        let file = self.session.reconstruction.file.as_ref();
        let problem = file.and_then(|file| file.evidence.as_ref().err().cloned());
        let (detail, problem) = match self.evidence() {
            Some(evidence) => (evidence.case.clone(), None),
            None => ("not read".to_owned(), problem),
        };
        let show = Command::Show(Pane::Evidence);
        Some(ContentsEntry::new(Group::Data, "Evidence", detail, show).missing(problem))
    }
}

/// The figures of the chain that were found, each with its warnings.
fn result_entries(chain: &[Link]) -> impl Iterator<Item = ContentsEntry> {
    // The first link is what they are figures of.
    chain.iter().skip(1).map(|link| {
        let (label, detail) = match (&link.figure, link.is_late) {
            (_, true) => (link.title, "computing…".to_owned()),
            (Some(figure), false) => (link.title, figure.clone()),
            (None, false) => (link.title, link.source.clone()),
        };
        let missing = (!link.warnings.is_empty()).then(|| link.warnings.join("\n"));
        let show = Command::Show(link.pane);
        ContentsEntry::new(Group::Results, label, detail, show).missing(missing)
    })
}

fn model_entry<M: TrainedModel>(label: &str, status: &ModelStatus<M>) -> ContentsEntry {
    let detail = match &status.current {
        Some(current) if current.is_saved => current.name.clone(),
        Some(current) => format!("{}, not saved", current.name),
        None if status.is_loading() => "loading…".to_owned(),
        None => "none".to_owned(),
    };
    let show = Command::Show(Pane::Training);
    ContentsEntry::new(Group::Models, label, detail, show).missing(status.problem.clone())
}
