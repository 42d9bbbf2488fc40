//! A recorded pair of vehicles, made ready to be followed.

use std::path::Path;

use crate::StudyError;
use impactlab_core::collision::contact::{ContactConditions, ContactOutline, FaceLaws, PairMotion};
use impactlab_core::compare::{PairCase, PairRecords};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::ProgressCallback;
use impactlab_core::vehicle::Manoeuvre;
use impactlab_networks::pair::{PairForecast, PairQuestion, PairSettings, forecast_pair};
use impactlab_networks::response::{Predictor, ResponseModel};

/// A recorded pair with what follows from its data sheets. Of the contact nothing is known but its height.
pub(crate) struct ReadyPair<'a> {
    case: &'a PairCase,
    outlines: [ContactOutline; 2],
    faces: [FaceLaws; 2],
    predictors: [Option<Predictor>; 2],
}

/// A recorded pair of a folder by its name.
///
/// # Errors
/// [`StudyError::NoSuchCase`], [`StudyError::CaseUnreadable`], or why the table cannot be read.
pub(crate) fn load_pair(dataset: &Path, name: &str) -> Result<PairCase, StudyError> {
    let records = PairRecords::open(dataset)?;
    let loaded = records.load(name).ok_or_else(|| no_such_pair(dataset, name, &records))?;
    loaded.map_err(|error| {
        let (path, problem) = (dataset.to_owned(), error_chain(&error));
        StudyError::CaseUnreadable { path, problem }
    })
}

/// That a folder has no recorded pair of a name.
pub(crate) fn no_such_pair(dataset: &Path, name: &str, records: &PairRecords) -> StudyError {
    StudyError::NoSuchCase {
        path: dataset.to_owned(),
        case: name.to_owned(),
        n_cases: records.names().count(),
        first: records.names().next().unwrap_or_default().to_owned(),
    }
}

/// Names the case in a message.
pub(crate) fn of_case(case: &PairCase, error: &dyn std::error::Error) -> String {
    format!("{}: {}", case.name, error_chain(error))
}

impl<'a> ReadyPair<'a> {
    /// Makes a case ready.
    ///
    /// - `model`: the response network of both vehicles; `None` for the equations of motion alone.
    ///
    /// # Errors
    /// What is wrong with one of the vehicles, with the name of the case.
    pub fn new(case: &'a PairCase, model: Option<&ResponseModel>) -> Result<Self, String> {
        let outline = |i: usize| {
            ContactOutline::from_vehicle(&case.vehicles[i]).map_err(|error| of_case(case, &error))
        };
        let faces =
            |i: usize| FaceLaws::by_class(&case.vehicles[i]).map_err(|error| of_case(case, &error));
        let predictor = |i: usize| {
            let predictor = model.map(|model| model.predictor(&case.vehicles[i]));
            predictor.transpose().map_err(|error| of_case(case, &error))
        };
        Ok(Self {
            case,
            outlines: [outline(0)?, outline(1)?],
            faces: [faces(0)?, faces(1)?],
            predictors: [predictor(0)?, predictor(1)?],
        })
    }

    /// - `struck`: what the struck vehicle begins with and what its driver does.
    fn question<'q>(&'q self, struck: &'q Manoeuvre) -> PairQuestion<'q> {
        let usual = ContactConditions::default();
        let height_m = self.case.contact_height_m.unwrap_or(usual.height_m);
        PairQuestion {
            vehicles: [&self.case.vehicles[0], &self.case.vehicles[1]],
            manoeuvres: [struck, &self.case.manoeuvres[1]],
            outlines: [&self.outlines[0], &self.outlines[1]],
            faces: self.faces,
            conditions: ContactConditions { height_m, ..usual },
            predictors: [self.predictors[0].as_ref(), self.predictors[1].as_ref()],
            drawn: [&[]; 2],
            first_forces: &[],
        }
    }

    /// The motions with everything at its median, by what both drivers did.
    ///
    /// # Errors
    /// Why they cannot be computed, with the name of the case.
    pub fn median_motion(&self) -> Result<PairMotion, String> {
        let question = self.question(&self.case.manoeuvres[0]);
        question.median_motion().map_err(|error| of_case(self.case, &error))
    }

    /// The motions over draws of what is not known.
    ///
    /// - `struck`: see [`ReadyPair::question`].
    ///
    /// # Errors
    /// Why they cannot be computed, with the name of the case.
    pub fn forecast(
        &self,
        struck: &Manoeuvre,
        settings: &PairSettings,
        report: &mut ProgressCallback<'_>,
    ) -> Result<Outcome<PairForecast>, String> {
        let forecast = forecast_pair(&self.question(struck), settings, report);
        forecast.map_err(|error| of_case(self.case, &error))
    }
}
