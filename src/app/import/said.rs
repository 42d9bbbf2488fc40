//! What the user says in the import dialog of the vehicle that a file is about. The variant gets it with the
//! file, not before.

use std::path::Path;

use crate::app::import::dialog::ImportDialog;
use crate::app::state::{State, Subject};
use crate::app::widgets::vehicle_label;
use impactlab_core::collision::{Footprint, Role};
use impactlab_core::units::{Quantity, UnitSystem};
use impactlab_core::vehicle::ContactPoint;
use impactlab_study::{ASSUMED_CONTACT, DEFAULT_VEHICLE, Drive, VehicleChoice};

/// The struck vehicle of a file and how it starts.
#[derive(Debug, Clone, PartialEq)]
pub struct SaidOfFile {
    /// The vehicle.
    pub vehicle: VehicleChoice,
    /// Its speed before the impact, and where the force acts.
    pub start: Drive,
}

impl SaidOfFile {
    /// Whether an impulse pulls at the contact point, the assumed one if none was said.
    ///
    /// - `impulse_n_s`: in body axes.
    pub(super) fn pulls(&self, impulse_n_s: [f64; 2]) -> bool {
        let vehicle = match &self.vehicle {
            // It is read with the simulation, which says the same of it.
            VehicleChoice::File(_) => None,
            choice => choice.chosen().ok().flatten(),
        };
        let vehicle = vehicle.unwrap_or_else(|| DEFAULT_VEHICLE.parameters());
        let ContactPoint { x_body_m, y_body_m, .. } = self.start.contact.unwrap_or(ASSUMED_CONTACT);
        let outline = Footprint::from(&vehicle.geometry);
        outline.pulled_side([x_body_m, y_body_m], impulse_n_s).is_some()
    }

    /// What the variant would get, in words.
    pub(in crate::app) fn text(&self, units: UnitSystem) -> String {
        let mut parts = vec![vehicle_label(&self.vehicle, "the assumed vehicle", units)];
        if let Some(speed_m_s) = self.start.speed_m_s {
            parts.push(Quantity::Speed.shown(speed_m_s, units));
        }
        if self.start.contact.is_some() {
            parts.push("the contact point".to_owned());
        }
        parts.join(", ")
    }
}

impl State {
    /// What is said of the struck vehicle now.
    pub(in crate::app) fn said_now(&self) -> SaidOfFile {
        let Drive { speed_m_s, contact, .. } = *self.project.start();
        let start = Drive { speed_m_s, contact, ..Drive::default() };
        SaidOfFile { vehicle: self.project.simulate.vehicle.clone(), start }
    }

    /// Keeps what the import dialog says of the vehicle until the variant takes the file.
    pub(in crate::app) fn keep_said(&mut self, path: &Path) {
        let dialog = self.session.dialogs.import().filter(|dialog| dialog.path() == path);
        if let Some(said) = dialog.and_then(ImportDialog::said).cloned() {
            self.session.said_of_files.insert(path.to_owned(), said);
        }
    }

    /// Gives the variant what was said of the vehicle of a file that it has just taken.
    pub(in crate::app) fn take_said(&mut self, said: SaidOfFile) {
        let SaidOfFile { vehicle, start } = said;
        let now = self.project.start_mut();
        (now.speed_m_s, now.contact) = (start.speed_m_s, start.contact);
        if self.project.simulate.vehicle != vehicle {
            self.choose_vehicle(Role::Struck, vehicle);
        }
    }

    /// Whether the variant asks about a file, so that its vehicle and start are edited in the variant.
    pub(in crate::app) fn asks_about_file(&self, path: &Path) -> bool {
        matches!(self.project.subject(), Some(Subject::File(file)) if file == path)
    }
}
