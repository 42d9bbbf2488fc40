//! How the strengths of the effects differ between the cars of a fleet, learned from cars, each with a
//! network that has not seen it.

use crate::learning::{FitSteps, LearningError, TrainingProgress};
use crate::response::train::fleet::cars_of;
use crate::response::train::widths::{
    AskedCases, calibrated, n_calibration_steps, spread_over_cars,
};
use crate::response::{
    MotionDomain, ResponseCase, ResponseModel, StrengthPopulation, UnseenCar, Widths, is_same_car,
};

/// Trajectories of cars, and a model that has not seen them.
#[derive(Debug)]
pub struct UnseenCars<'a> {
    /// The model.
    pub model: &'a ResponseModel,
    /// The trajectories of each car.
    pub cars: Vec<Vec<&'a ResponseCase>>,
    /// Trajectories that it has not seen of cars that it has learned from.
    pub motions: Vec<&'a ResponseCase>,
}

/// Gives a model the distribution of strengths over cars, and makes cars known to it.
///
/// - `unseen`: cars, each with a model that has not seen it;
/// - `train`: the trajectories that the model has learned from;
/// - `report`: called while it goes on; if it breaks, the model stays as it was.
///
/// # Errors
/// [`LearningError::Network`].
pub fn learn_population(
    model: &mut ResponseModel,
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
    report: &mut TrainingProgress<'_>,
) -> Result<(), LearningError> {
    let cars: Vec<UnseenCar<'_>> = unseen
        .iter()
        .flat_map(|part| {
            part.cars.iter().map(|cases| UnseenCar { cases, network: part.model.network() })
        })
        .collect();
    let mut steps = FitSteps::new(report, true, n_population_steps(&cars, unseen, train));
    let Some(mut population) = StrengthPopulation::fit(&cars, &mut steps)? else { return Ok(()) };
    let domain = MotionDomain::from_cases(train);
    let of_unseen: Vec<AskedCases<'_>> = unseen
        .iter()
        .zip(spread_over_cars(unseen.iter().map(|part| part.cars.iter().flatten().copied())))
        .map(|(part, cases)| AskedCases::new(part.model, &domain, population.clone(), cases))
        .collect::<Result<_, LearningError>>()?;
    let what = "how wide the regions of other cars are";
    let Some(widths) = calibrated(&of_unseen, what, &mut steps)? else { return Ok(()) };
    population.set_widths(widths);
    let well_known = well_known_widths(&population, unseen, train, &domain, &mut steps)?;
    let Some(well_known) = well_known else { return Ok(()) };
    steps.name("the strengths of the cars learned from");
    for car in cars_of(train) {
        let cases: Vec<&ResponseCase> = car.iter().filter_map(|idx| train.get(*idx)).collect();
        let is_of_car = |case: &&ResponseCase| {
            cases.first().is_some_and(|first| is_same_car(&first.vehicle, &case.vehicle))
        };
        let is_well_known = unseen.iter().flat_map(|part| &part.motions).any(is_of_car);
        let widths = if is_well_known { well_known } else { population.widths() };
        population = population.with_learned_car(model.network(), widths, &cases)?;
        if steps.advance(StrengthPopulation::n_paths_of_car(cases.len())).is_break() {
            return Ok(());
        }
    }
    model.set_domain(domain);
    model.set_population(population);
    Ok(())
}

/// How many steps are reported while the distribution over cars is learned: paths of 4 s that are
/// computed, or what takes as long.
fn n_population_steps(
    cars: &[UnseenCar<'_>],
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
) -> usize {
    let n_known: usize =
        unseen.iter().flat_map(|part| well_known_cars(part, train)).map(|cases| cases.len()).sum();
    let of_cars = spread_over_cars(unseen.iter().map(|part| part.cars.iter().flatten().copied()));
    let of_motions = spread_over_cars(unseen.iter().map(|part| part.motions.iter().copied()));
    StrengthPopulation::n_fit_steps(cars)
        + n_calibration_steps(of_cars.iter().flatten().copied())
        + n_calibration_steps(of_motions.iter().flatten().copied())
        + StrengthPopulation::n_paths_of_car(n_known + train.len())
}

/// How wide the distributions are for cars of which many trajectories are known, by trajectories of
/// theirs that were left out; as for other cars where there are none. `None` if it was broken off.
fn well_known_widths(
    population: &StrengthPopulation,
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
    domain: &MotionDomain,
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<Widths>, LearningError> {
    steps.name("the strengths of well-known cars");
    let mut unseen_cases = Vec::new();
    let asked = spread_over_cars(unseen.iter().map(|part| part.motions.iter().copied()));
    for (part, cases) in unseen.iter().zip(asked).filter(|(_, cases)| !cases.is_empty()) {
        let mut known = population.clone();
        for learned in well_known_cars(part, train) {
            let learned: Vec<&ResponseCase> = learned.iter().collect();
            known = known.with_learned_car(part.model.network(), Widths::NORMAL, &learned)?;
            if steps.advance(StrengthPopulation::n_paths_of_car(learned.len())).is_break() {
                return Ok(None);
            }
        }
        unseen_cases.push(AskedCases::new(part.model, domain, known, cases)?);
    }
    match unseen_cases.is_empty() {
        true => Ok(Some(population.widths())),
        false => calibrated(&unseen_cases, "how wide the regions of well-known cars are", steps),
    }
}

/// What the model of a part has learned from of each car of which it leaves out single trajectories.
fn well_known_cars(part: &UnseenCars<'_>, train: &[ResponseCase]) -> Vec<Vec<ResponseCase>> {
    if part.motions.is_empty() {
        return Vec::new();
    }
    let learned: Vec<ResponseCase> =
        train.iter().filter(|case| part.model.is_trained_on(case)).cloned().collect();
    let is_well_known = |cases: &Vec<ResponseCase>| {
        let first = cases.first();
        let is_of_car = |other: &&ResponseCase| {
            first.is_some_and(|case| is_same_car(&case.vehicle, &other.vehicle))
        };
        part.motions.iter().any(is_of_car)
    };
    cars_of(&learned)
        .into_iter()
        .map(|car| car.iter().filter_map(|idx| learned.get(*idx)).cloned().collect())
        .filter(is_well_known)
        .collect()
}
