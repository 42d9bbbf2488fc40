//! A crash test that was opened: the stiffness that it gives to the front of a vehicle, and its crush energy by
//! hand.

use std::path::{Path, PathBuf};

use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::panes::Pane;
use crate::app::state::State;
use crate::app::tasks::TaskKey;
use impactlab_core::collision::Role;
use impactlab_core::collision::contact::{BarrierTest, FaceStiffness};
use impactlab_core::data::{BarrierMomentum, CrashTest, Severity};
use impactlab_core::vehicle::{CrushStiffness, DataSheet};
use impactlab_reconstruct::evidence::Stated;
use impactlab_reconstruct::hand::HandMethod;
use impactlab_study::{HandRequest, VehicleChoice};

/// Ratio of the masses of two cars from which they are hardly the same.
const OTHER_MASS: f64 = 1.15;

/// What a crash test gives to a vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct CrashTestForm {
    /// The description of the test.
    pub path: PathBuf,
    /// What was tested.
    pub title: String,
    /// The test, as far as stiffness follows from it.
    pub test: BarrierTest,
    /// A and B of the front.
    pub found: FaceStiffness,
    /// Impulse of the barrier and momentum of the car, if the barrier was measured.
    pub momentum: Option<BarrierMomentum>,
    /// What is wrong with the record of the barrier, in words.
    pub doubts: Vec<String>,
    /// The vehicle that gets them.
    pub role: Role,
    /// The vehicles whose data can be edited.
    pub editable: Vec<Role>,
}

/// An action on a crash test that was opened.
#[derive(Debug, Clone)]
pub enum CrashTestCommand {
    /// Take what was read of the test at a path, or why no stiffness follows from it.
    Read(PathBuf, Result<Box<CrashTestForm>, String>),
    /// Take the stiffness into the data of a vehicle.
    TakeStiffness(Box<CrashTestForm>),
    /// Compute its crush energy by hand.
    CheckByHand(Box<CrashTestForm>),
    /// Open the force of the barrier as a series.
    OpenForce(PathBuf),
}

impl CrashTestForm {
    /// # Errors
    /// What is missing for a stiffness, in words.
    fn read(path: &Path) -> Result<Self, String> {
        let read = CrashTest::read(path).map_err(|error| error.to_string())?;
        let test = BarrierTest::from_crash_test(&read)?;
        let found = test.stiffness().map_err(|error| error.to_string())?;
        let force = read.barrier_force().map_err(|error| error.to_string());
        let (momentum, doubts) = match &force {
            Ok(Some(force)) => (read.momentum(force), read.barrier_doubts(force)),
            Ok(None) => (None, Vec::new()),
            Err(error) => (None, vec![error.clone()]),
        };
        let (path, title, role) = (path.to_owned(), read.title, Role::Striking);
        Ok(Self { path, title, test, found, momentum, doubts, role, editable: Vec::new() })
    }

    /// The question of its crush energy.
    fn by_hand(&self) -> HandRequest {
        let Self { test, found, .. } = self;
        let [c1, c2, c3, c4, c5, c6] = test.crush_m;
        let mut request = HandRequest::new(HandMethod::CrushEnergy);
        for (key, value) in [
            ("mass_1_kg", test.mass_kg),
            ("stiffness_a_n_per_m", found.onset_n_per_m),
            ("stiffness_b_n_per_m2", found.stiffness_n_per_m2),
            ("width_m", test.width_m),
            ("c1_m", c1),
            ("c2_m", c2),
            ("c3_m", c3),
            ("c4_m", c4),
            ("c5_m", c5),
            ("c6_m", c6),
        ] {
            request.inputs.insert(key.to_owned(), Stated { value: Some(value), sigma: None });
        }
        request
    }
}

impl State {
    /// Starts to read a crash test of which it is to be asked what becomes of it.
    pub(super) fn read_crash_test(&mut self, path: PathBuf) {
        let read = path.clone();
        self.session.tasks.start(
            TaskKey::CrashTest(path.clone()),
            move |_| CrashTestForm::read(&read).map(Box::new),
            |result| Command::CrashTest(CrashTestCommand::Read(path, result)),
        );
    }

    /// Asks what becomes of a crash test. One without a stiffness is opened as a table, with the reason, and so
    /// is another one as long as that is asked of one.
    fn ask_crash_test(&mut self, path: PathBuf, read: Result<Box<CrashTestForm>, String>) {
        let is_open = |dialog: &Dialog| matches!(dialog, Dialog::CrashTest(_));
        if self.session.dialogs.iter().any(is_open) {
            return self.load(path, None);
        }
        match read {
            Ok(mut form) => {
                let is_editable = |role: &Role| self.editable_sheet(*role).is_some();
                form.editable =
                    [Role::Striking, Role::Struck].into_iter().filter(is_editable).collect();
                form.role = form.editable.first().copied().unwrap_or(form.role);
                self.session.dialogs.open(Dialog::CrashTest(form));
            }
            Err(why) => {
                self.say(Severity::Info, format!("no stiffness follows from this test: {why}"));
                self.load(path, None);
            }
        }
    }

    /// Asks about a crash test that was read, or carries out what was chosen of it.
    pub(super) fn take_crash_test(&mut self, command: CrashTestCommand) {
        if !matches!(command, CrashTestCommand::Read(..)) {
            self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::CrashTest(_)));
        }
        match command {
            CrashTestCommand::Read(path, read) => self.ask_crash_test(path, read),
            CrashTestCommand::OpenForce(path) => {
                self.session.shows_doors = false;
                self.load(path, None);
            }
            CrashTestCommand::TakeStiffness(form) => self.take_stiffness(&form),
            CrashTestCommand::CheckByHand(form) => {
                let (of_test, before) = (form.by_hand(), self.project.hand.take());
                let is_lost = |before: HandRequest| {
                    before != of_test && before != HandRequest::new(before.method)
                };
                if before.is_some_and(is_lost) {
                    let text = "the calculation by hand is that of the crash test now; Undo brings back the \
                                inputs that were there";
                    self.say(Severity::Warning, text);
                }
                self.project.hand = Some(of_test);
                self.session.shows_doors = false;
                self.view.workspaces.show_pane(Pane::Hand);
            }
        }
    }

    /// The data of a vehicle of the project, if one is chosen whose data can be edited.
    fn editable_sheet(&self, role: Role) -> Option<DataSheet> {
        let choice = self.project.chosen_vehicle(role);
        match &*choice {
            VehicleChoice::Sheet(sheet) => Some((**sheet).clone()),
            choice => {
                let vehicle = choice.chosen().ok().flatten();
                vehicle.and_then(|vehicle| DataSheet::from_parameters(&vehicle))
            }
        }
    }

    fn take_stiffness(&mut self, form: &CrashTestForm) {
        let label = form.role.label();
        let Some(mut sheet) = self.editable_sheet(form.role) else {
            let text = format!("choose the {label} first, one whose data can be edited");
            return self.say(Severity::Warning, text);
        };
        let mass_kg = sheet.vehicle().mass.mass_kg;
        let ratio = form.test.mass_kg / mass_kg;
        if !(1.0 / OTHER_MASS..=OTHER_MASS).contains(&ratio) {
            let text = format!(
                "the car of the test has {:.0} kg and the {label} {mass_kg:.0} kg: is it the same car?",
                form.test.mass_kg
            );
            self.say(Severity::Warning, text);
        }
        let FaceStiffness { onset_n_per_m, stiffness_n_per_m2 } = form.found;
        sheet.crush.front = Some(CrushStiffness { onset_n_per_m, stiffness_n_per_m2 });
        self.project.edit_vehicle(form.role, sheet);
        self.ask_again();
        let text = format!(
            "the front of the {label} has the stiffness of the test; nothing is crushed up to 5 mph, which is \
             assumed"
        );
        self.say(Severity::Info, text);
    }
}
