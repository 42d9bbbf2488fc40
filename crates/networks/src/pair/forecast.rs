//! The motions of two vehicles over draws of what is not known of them.

use rayon::prelude::*;

use crate::pair::scatter::{PairLatents, PairScatter};
use crate::response::{CoupledDraw, N_RESIDUAL, Predictor};
use impactlab_core::collision::Role;
use impactlab_core::collision::contact::{
    ContactBody, ContactConditions, ContactOutline, ContactPhase, CoupledSettings, FaceLaws,
    HandOver, PairError, PairMotion, PairRun, PairVehicle, VehiclePair,
};
use impactlab_core::data::{Channel, Outcome};
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_core::vehicle::{
    ContactLoad, Manoeuvre, OUTPUT_INTERVAL_S, VehicleParameters, VehicleState,
};

/// Draws that are computed side by side between two reports of progress.
const BLOCK_DRAWS: usize = 32;

/// Steer angle below which a vehicle drives straight on, rad.
const STRAIGHT_RAD: f64 = 0.01;

/// Speed below which what the equations of motion miss fades, m/s.
const SLOW_M_S: f64 = 5.0;

/// Acceleration by the tires from which on a vehicle is taken to turn or slide, m/s².
const SLIDING_M_S2: f64 = 2.0;

/// Two vehicles of which a forecast is asked; arrays are struck, striking.
#[derive(Debug, Clone, Copy)]
pub struct PairQuestion<'a> {
    /// The vehicles at their medians.
    pub vehicles: [&'a VehicleParameters; 2],
    /// Their initial states, controls, ground and end. The collision force of the struck vehicle, if it
    /// has one, is that of the first contact at its median; the striking one has none.
    pub manoeuvres: [&'a Manoeuvre; 2],
    /// Their outlines.
    pub outlines: [&'a ContactOutline; 2],
    /// Laws of their faces at their medians.
    pub faces: [FaceLaws; 2],
    /// Friction, damping and height of their contact at their medians.
    pub conditions: ContactConditions,
    /// The response network for each vehicle, which corrects its motion while the vehicles are apart after
    /// the first contact; `None` for the equations of motion alone.
    pub predictors: [Option<&'a Predictor>; 2],
    /// What stands for the vehicles in the draws, in turn. Where it is empty, that is the vehicle at its
    /// median with the scatter of the settings.
    pub drawn: [&'a [DrawnVehicle]; 2],
    /// The force of the first contact in the draws, in turn: the contact law from the start on where it is
    /// `None`. Where it is empty, all draws have that of the medians.
    pub first_forces: &'a [Option<ContactLoad>],
}

/// A vehicle that was drawn, with its response network.
#[derive(Debug, Clone)]
pub struct DrawnVehicle {
    /// The vehicle.
    pub vehicle: VehicleParameters,
    /// Its network; `None` for the equations of motion alone.
    pub predictor: Option<Predictor>,
    /// Whether all that is not known of it is drawn; else the road alone, and tires and resistance are drawn as
    /// those of a vehicle that is not drawn.
    pub is_whole: bool,
}

/// How many draws, and of what.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSettings {
    /// Number of draws.
    pub n_draws: usize,
    /// Seed of all draws.
    pub seed: u64,
    /// What is not known.
    pub scatter: PairScatter,
}

impl Default for PairSettings {
    fn default() -> Self {
        Self { n_draws: 200, seed: 0, scatter: PairScatter::default() }
    }
}

/// One draw of the motions of both vehicles.
#[derive(Debug, Clone, PartialEq)]
pub struct PairDraw {
    /// Number of the draw.
    pub number: usize,
    /// States every 10 ms of the struck and of the striking vehicle.
    pub states: [Vec<VehicleState<f64>>; 2],
    /// Phases of contact.
    pub phases: Vec<ContactPhase>,
    /// Since when each vehicle is at rest, s; `None` if it still moves at the end.
    pub rest_s: [Option<f64>; 2],
    /// How the contact law took over from a known force.
    pub hand_over: Option<HandOver>,
}

/// The motions of two vehicles over draws.
#[derive(Debug, Clone, PartialEq)]
pub struct PairForecast {
    /// The motion with everything at its median.
    pub centre: PairMotion,
    /// The draws that could be computed.
    pub draws: Vec<PairDraw>,
    /// How many could not, and why the first of them could not.
    pub failed: Option<(usize, PairError)>,
}

/// Follows two vehicles over draws of what is not known of them. The result depends on the question and
/// the seed alone.
///
/// # Errors
/// [`PairError`] if the motion at the medians or every draw cannot be computed.
pub fn forecast_pair(
    question: &PairQuestion<'_>,
    settings: &PairSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<PairForecast>, PairError> {
    let centre = question.median_motion()?;
    let latents = PairLatents::new(settings.n_draws, settings.seed);
    let mut draws = Vec::with_capacity(settings.n_draws);
    let mut failed: Option<(usize, PairError)> = None;
    let all: Vec<usize> = (0..settings.n_draws).collect();
    for block in all.chunks(BLOCK_DRAWS) {
        let found: Vec<_> =
            block.par_iter().map(|&draw| question.draw(draw, &latents, settings)).collect();
        for motion in found {
            match motion {
                Ok(motion) => draws.push(motion),
                Err(error) => failed.get_or_insert((0, error)).0 += 1,
            }
        }
        let done = block.last().map_or(0, |last| last + 1);
        let (done, total) = (done as u64, settings.n_draws as u64);
        if report(Progress::new(done, total, "following both vehicles")).is_break() {
            return Ok(Outcome::Cancelled);
        }
    }
    match failed {
        Some((_, error)) if draws.is_empty() => Err(error),
        failed => Ok(Outcome::Complete(PairForecast { centre, draws, failed })),
    }
}

/// What was drawn.
struct Drawn {
    vehicles: [VehicleParameters; 2],
    manoeuvres: [Manoeuvre; 2],
    faces: [FaceLaws; 2],
    conditions: ContactConditions,
    /// What the equations of motion miss of each vehicle: v̇_x, v̇_y, m/s², ṙ, rad/s².
    missed: [[f64; 3]; 2],
}

/// The predictor, if its network corrects accelerations.
fn correcting(predictor: Option<&Predictor>) -> Option<&Predictor> {
    predictor.filter(|predictor| predictor.corrects_accelerations())
}

/// What takes its turn at a draw; `None` without any.
fn in_turn<T>(all: &[T], draw: usize) -> Option<&T> {
    all.get(draw % all.len().max(1))
}

impl PairQuestion<'_> {
    /// The motion with everything at its median.
    ///
    /// # Errors
    /// [`PairError`] if it cannot be computed.
    pub fn median_motion(&self) -> Result<PairMotion, PairError> {
        let corrections =
            [0, 1].map(|i| correcting(self.predictors[i]).map(Predictor::coupled_median));
        let median = Drawn {
            vehicles: self.vehicles.map(VehicleParameters::clone),
            manoeuvres: self.manoeuvres.map(Manoeuvre::clone),
            faces: self.faces,
            conditions: self.conditions,
            missed: [[0.0; 3]; 2],
        };
        self.simulate(&median, corrections, CoupledSettings::default())
    }

    /// One draw by itself, without the motion at the medians, in the longer steps of motions of which none
    /// is told by itself. It depends on the question, the seed and the scatter alone.
    ///
    /// # Errors
    /// [`PairError`] if it cannot be computed.
    pub fn single_draw(&self, settings: &PairSettings) -> Result<PairMotion, PairError> {
        let steps = CoupledSettings { has_long_steps: true, ..CoupledSettings::default() };
        self.drawn_motion(0, &PairLatents::new(1, settings.seed), settings, steps)
    }

    fn draw(
        &self,
        draw: usize,
        latents: &PairLatents,
        settings: &PairSettings,
    ) -> Result<PairDraw, PairError> {
        let motion = self.drawn_motion(draw, latents, settings, CoupledSettings::default())?;
        Ok(PairDraw::from_motion(draw, motion))
    }

    fn drawn_motion(
        &self,
        draw: usize,
        latents: &PairLatents,
        settings: &PairSettings,
        steps: CoupledSettings,
    ) -> Result<PairMotion, PairError> {
        let scatter = &settings.scatter;
        let own = [0, 1].map(|i| in_turn(self.drawn[i], draw));
        let vehicle = |i: usize| match own[i] {
            Some(drawn) if drawn.is_whole => drawn.vehicle.clone(),
            own => {
                let median = own.map_or(self.vehicles[i], |drawn| &drawn.vehicle);
                latents.vehicle(draw, i, median, scatter)
            }
        };
        let mut manoeuvres =
            [0, 1].map(|i| latents.manoeuvre(draw, i, self.manoeuvres[i], scatter));
        if let Some(load) = in_turn(self.first_forces, draw) {
            manoeuvres[0].contact_load.clone_from(load);
        }
        let drawn = Drawn {
            vehicles: [0, 1].map(vehicle),
            manoeuvres,
            faces: [0, 1].map(|i| {
                let said = &self.vehicles[i].crush;
                latents.faces(draw, i, (self.faces[i], said), scatter)
            }),
            missed: [0, 1].map(|i| latents.missed(draw, i, scatter)),
            conditions: latents.conditions(draw, self.conditions, scatter),
        };
        let corrections = [0, 1].map(|i| {
            let predictor = own[i].map_or(self.predictors[i], |drawn| drawn.predictor.as_ref());
            Some(correcting(predictor)?.coupled_draw(settings.seed, Role::WORDS[i], draw))
        });
        self.simulate(&drawn, corrections, steps)
    }

    fn simulate(
        &self,
        drawn: &Drawn,
        mut corrections: [Option<CoupledDraw<'_>>; 2],
        settings: CoupledSettings,
    ) -> Result<PairMotion, PairError> {
        let vehicle = |i: usize| PairVehicle {
            vehicle: &drawn.vehicles[i],
            manoeuvre: &drawn.manoeuvres[i],
            body: ContactBody { outline: self.outlines[i], faces: drawn.faces[i] },
        };
        let vehicles = [vehicle(0), vehicle(1)];
        let pair = VehiclePair { vehicles, conditions: drawn.conditions, settings };
        let mut run = PairRun::new(&pair)?;
        loop {
            let residuals = [0, 1].map(|i| {
                let learned = residual(&run, i, corrections[i].as_mut());
                let [ax, ay, yaw] = missed(&run, i, drawn.missed[i]);
                [learned[0] + ax, learned[1] + ay, learned[2] + yaw, learned[3]]
            });
            if !run.goes_on(&residuals)? {
                return run.finish();
            }
        }
    }
}

/// What the network adds to the acceleration of a vehicle over the coming interval: nothing before the
/// first contact and while the vehicles push each other. Under a known force it has learned to.
fn residual(
    run: &PairRun<'_>,
    vehicle: usize,
    correction: Option<&mut CoupledDraw<'_>>,
) -> [f64; N_RESIDUAL] {
    let is_known = run.is_driven_by_known_force();
    let first_s = run.first_contact_s().or(is_known.then(|| run.time_s()));
    let (Some(correction), Some(first_s)) = (correction, first_s) else {
        return [0.0; N_RESIDUAL];
    };
    let input = run.input(vehicle);
    if input.collision.is_some() && !is_known {
        return [0.0; N_RESIDUAL];
    }
    let time_s = (run.time_s() - first_s).max(0.0);
    correction.residual(&run.states()[vehicle], &input, time_s)
}

/// What the equations of motion miss over the coming interval: nothing of a vehicle that drives straight
/// on and has not been touched yet, and less and less of one that comes to rest or rolls freely, whose
/// resistance is drawn by itself.
fn missed(run: &PairRun<'_>, vehicle: usize, drawn: [f64; 3]) -> [f64; 3] {
    let is_straight = || run.input(vehicle).steer_rad.abs() < STRAIGHT_RAD;
    if run.first_contact_s().is_none() && is_straight() {
        return [0.0; 3];
    }
    let state = run.states()[vehicle];
    let speed_m_s = state.vx_body_m_s.hypot(state.vy_body_m_s);
    let by_tires = run.tire_acceleration_m_s2(vehicle) / SLIDING_M_S2;
    drawn.map(|missed| missed * (speed_m_s / SLOW_M_S).min(by_tires).min(1.0))
}

impl PairDraw {
    /// The draw from its motion.
    ///
    /// - `number`: of the draw.
    pub fn from_motion(number: usize, motion: PairMotion) -> Self {
        let states = [0, 1].map(|i| states_of(&motion, i));
        let rest_s = [0, 1].map(|i| motion.motions[i].rest_s);
        Self { number, states, phases: motion.phases, rest_s, hand_over: motion.hand_over }
    }

    /// When the vehicles first touch each other, s.
    pub fn first_contact_s(&self) -> Option<f64> {
        self.phases.first().map(|phase| phase.start_s)
    }

    /// When the motion ends, s.
    pub fn end_s(&self) -> f64 {
        self.states[0].len().saturating_sub(1) as f64 * OUTPUT_INTERVAL_S
    }

    /// State of a vehicle at an instant, the last one after the end of its motion.
    pub fn state(&self, vehicle: usize, instant: usize) -> Option<&VehicleState<f64>> {
        let states = &self.states[vehicle];
        states.get(instant).or(states.last())
    }
}

/// States of a vehicle every 10 ms.
fn states_of(motion: &PairMotion, vehicle: usize) -> Vec<VehicleState<f64>> {
    use Channel as C;
    let series = &motion.motions[vehicle].series;
    let column = |channel| series.get(channel).unwrap_or(&[]);
    let [x, y, yaw, vx, vy, yaw_rate, roll, roll_rate] =
        [C::X, C::Y, C::Yaw, C::Vx, C::Vy, C::YawRate, C::Roll, C::RollRate].map(column);
    let at = |values: &[f64], i: usize| values.get(i).copied().unwrap_or(0.0);
    (0..series.n_samples())
        .map(|i| VehicleState {
            vx_body_m_s: at(vx, i),
            vy_body_m_s: at(vy, i),
            yaw_rad: at(yaw, i),
            yaw_rate_rad_s: at(yaw_rate, i),
            roll_rad: at(roll, i),
            roll_rate_rad_s: at(roll_rate, i),
            x_m: at(x, i),
            y_m: at(y, i),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use impactlab_core::vehicle::{Controls, Preset};

    /// A car that is struck at its right rear by one that comes from behind and steers in.
    fn manoeuvre(place_m: [f64; 2], [speed_m_s, yaw_rad]: [f64; 2]) -> Manoeuvre {
        let initial = VehicleState {
            vx_body_m_s: speed_m_s,
            x_m: place_m[0],
            y_m: place_m[1],
            yaw_rad,
            ..VehicleState::default()
        };
        let controls = Controls::default();
        Manoeuvre { initial, controls, duration_s: 1.5, ..Manoeuvre::default() }
    }

    fn forecast(settings: &PairSettings) -> PairForecast {
        let vehicle = Preset::Reference.parameters();
        let outline = ContactOutline::from_vehicle(&vehicle).unwrap();
        let faces = FaceLaws::by_class(&vehicle).unwrap();
        let struck = manoeuvre([0.0, 0.0], [20.0, 0.0]);
        let striking = manoeuvre([-3.6, -2.1], [21.5, 0.12]);
        let question = PairQuestion {
            vehicles: [&vehicle; 2],
            manoeuvres: [&struck, &striking],
            outlines: [&outline; 2],
            faces: [faces; 2],
            conditions: ContactConditions::default(),
            predictors: [None; 2],
            drawn: [&[]; 2],
            first_forces: &[],
        };
        let found = forecast_pair(&question, settings, &mut |_| ControlFlow::Continue(()));
        found.unwrap().complete().unwrap()
    }

    #[test]
    fn draws_without_scatter_are_the_centre_and_a_seed_gives_the_same_draws() {
        let none = PairSettings { n_draws: 3, seed: 5, scatter: PairScatter::NONE };
        let alike = forecast(&none);
        assert!(!alike.centre.phases.is_empty(), "the cars meet");
        for draw in &alike.draws {
            let centre = states_of(&alike.centre, 0);
            let off =
                |a: &VehicleState<f64>, b: &VehicleState<f64>| (a.x_m - b.x_m).hypot(a.y_m - b.y_m);
            let largest = draw.states[0].iter().zip(&centre).map(|(a, b)| off(a, b));
            // The scatter of the elastic branch takes another way to the same numbers.
            assert!(largest.fold(0.0, f64::max) < 1e-6);
        }
        let usual = PairSettings { n_draws: 40, seed: 5, ..PairSettings::default() };
        let drawn = forecast(&usual);
        assert_eq!(drawn, forecast(&usual));
        assert_ne!(drawn.draws, forecast(&PairSettings { seed: 6, ..usual }).draws);
        assert_eq!(drawn.draws.len(), 40);
        let sum: f64 = drawn.courses().iter().map(|course| course.probability).sum();
        assert!((sum - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_forecast_that_is_stopped_is_cancelled() {
        let vehicle = Preset::Reference.parameters();
        let outline = ContactOutline::from_vehicle(&vehicle).unwrap();
        let faces = FaceLaws::by_class(&vehicle).unwrap();
        let apart = [manoeuvre([0.0; 2], [20.0, 0.0]), manoeuvre([-30.0, 0.0], [10.0, 0.0])];
        let question = PairQuestion {
            vehicles: [&vehicle; 2],
            manoeuvres: [&apart[0], &apart[1]],
            outlines: [&outline; 2],
            faces: [faces; 2],
            conditions: ContactConditions::default(),
            predictors: [None; 2],
            drawn: [&[]; 2],
            first_forces: &[],
        };
        let settings = PairSettings { n_draws: 4, ..PairSettings::default() };
        let stopped = forecast_pair(&question, &settings, &mut |_| ControlFlow::Break(()));
        assert_eq!(stopped.unwrap(), Outcome::Cancelled);
        let missed = forecast_pair(&question, &settings, &mut |_| ControlFlow::Continue(()));
        let missed = missed.unwrap().complete().unwrap();
        assert_eq!(missed.courses().len(), 1);
        assert_eq!(missed.courses()[0].course, crate::pair::Course::Missed);
    }
}
