//! A crash test that was opened: the stiffness that it gives to the front of a vehicle.

use std::path::{Path, PathBuf};

use crate::app::dialog::Dialog;
use crate::app::state::State;
use impactlab_core::collision::Role;
use impactlab_core::collision::contact::{BarrierTest, FaceStiffness};
use impactlab_core::data::{CrashTest, Severity};
use impactlab_core::vehicle::{CrushStiffness, DataSheet};
use impactlab_study::VehicleChoice;

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
    /// The vehicle that gets them.
    pub role: Role,
}

/// An action on a crash test that was opened.
#[derive(Debug, Clone)]
pub enum CrashTestCommand {
    /// Take the stiffness into the data of a vehicle.
    TakeStiffness(Box<CrashTestForm>),
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
        let (path, title, role) = (path.to_owned(), read.title, Role::Striking);
        Ok(Self { path, title, test, found, role })
    }
}

impl State {
    /// Asks what becomes of a crash test. One without a stiffness is opened as a table, with the reason, and so
    /// is another one as long as that is asked of one.
    pub(super) fn ask_crash_test(&mut self, path: PathBuf) {
        let is_open = |dialog: &Dialog| matches!(dialog, Dialog::CrashTest(_));
        if self.session.dialogs.iter().any(is_open) {
            return self.load(path, None);
        }
        match CrashTestForm::read(&path) {
            Ok(form) => self.session.dialogs.open(Dialog::CrashTest(Box::new(form))),
            Err(why) => {
                self.say(Severity::Info, format!("no stiffness follows from this test: {why}"));
                self.load(path, None);
            }
        }
    }

    /// Carries out what was chosen of a crash test.
    pub(super) fn take_crash_test(&mut self, command: CrashTestCommand) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::CrashTest(_)));
        match command {
            CrashTestCommand::OpenForce(path) => {
                self.session.shows_doors = false;
                self.load(path, None);
            }
            CrashTestCommand::TakeStiffness(form) => self.take_stiffness(&form),
        }
    }

    fn take_stiffness(&mut self, form: &CrashTestForm) {
        let label = form.role.label();
        let choice = self.project.chosen_vehicle(form.role).into_owned();
        let sheet = match &choice {
            VehicleChoice::Sheet(sheet) => Some((**sheet).clone()),
            choice => {
                let vehicle = choice.chosen().ok().flatten();
                vehicle.and_then(|vehicle| DataSheet::from_parameters(&vehicle))
            }
        };
        let Some(mut sheet) = sheet else {
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
