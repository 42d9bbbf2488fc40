//! The curves: what grows, over which sizes, and the question that is asked.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use impactlab_core::data::{Existing, Outcome};
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{FilmTiming, SimulationScene, simulation_scene};
use impactlab_draw::Canvas;
use impactlab_draw::film::{Film, write_film};
use impactlab_draw::scene::{Camera, Follow, ScenePicture};
use impactlab_study::analysis::PulseSetup;
use impactlab_study::{
    CheckRequest, CheckedContent, EvidenceChoice, ForceSource, Library, ModelChoice, MotionSource,
    PredictMotionRequest, Question, ReconstructRequest, ScenarioChoice, SimulateRequest,
};
use impactlab_sweep::{Plan, merge, run_chunks};

use crate::{Measured, inputs};

/// Size of the frames of a film, pixels.
const FRAME_PX: [u32; 2] = [640, 360];

/// Particles of a reconstruction whose evidence grows.
const PARTICLES: usize = 100;

/// A size and the folder of what is asked about.
type Prepare = fn(u64, &Path) -> Measured<()>;
type Ask = fn(u64, &Path) -> Measured<Option<u64>>;

/// Cost of a question over its size.
pub struct Curve {
    /// Its name as an argument.
    pub name: &'static str,
    /// What grows.
    pub grows: &'static str,
    /// The smallest size and the largest one where nobody says it.
    ends: [u64; 2],
    /// Whether the cost is that of each motion, since chance decides how many motions there are.
    pub is_per_motion: bool,
    /// Writes what is asked about.
    pub prepare: Prepare,
    /// Asks and gives the number of simulated motions, where the answer says it.
    pub ask: Ask,
}

/// All curves.
pub const CURVES: &[Curve] = &[
    Curve::new(
        "cases",
        "cases of a data set, loaded and checked",
        [100, 10_000],
        inputs::cases,
        cases,
    ),
    Curve::new(
        "one-car",
        "draws of a forecast, one car over 4 s",
        [10, 3_000],
        inputs::nothing,
        draws_of_one_car,
    ),
    Curve::new(
        "both-cars",
        "draws of a forecast, both cars over 4 s",
        [10, 3_000],
        inputs::nothing,
        draws_of_both_cars,
    ),
    Curve::new(
        "particles",
        "particles of a reconstruction from a place of rest",
        [50, 1_600],
        |_, folder| inputs::evidence(1, folder),
        |n, folder| reconstruct(usize::try_from(n)?, folder),
    ),
    Curve {
        is_per_motion: true,
        ..Curve::new(
            "evidence",
            "positions in the evidence of a reconstruction",
            [3, 300],
            inputs::evidence,
            |_, folder| reconstruct(PARTICLES, folder),
        )
    },
    Curve::new(
        "rows",
        "rows of a table of forces, read and checked",
        [1_000, 1_000_000],
        inputs::rows,
        rows,
    ),
    Curve::new(
        "frames",
        "frames of a film of 640 × 360 pixels",
        [30, 3_000],
        inputs::nothing,
        frames,
    ),
    Curve::new(
        "sweep",
        "rows of a sweep, chunks of 100, computed and merged",
        [10, 1_000],
        inputs::plan,
        sweep,
    ),
];

impl Curve {
    /// A curve of the cost of the whole answer.
    const fn new(
        name: &'static str,
        grows: &'static str,
        ends: [u64; 2],
        prepare: Prepare,
        ask: Ask,
    ) -> Self {
        Self { name, grows, ends, is_per_motion: false, prepare, ask }
    }

    /// The sizes, two for each power of ten.
    ///
    /// - `largest`: instead of that of the curve.
    pub fn sizes(&self, largest: Option<u64>) -> Vec<u64> {
        let [smallest, usual] = self.ends;
        let largest = largest.unwrap_or(usual);
        let mut sizes: Vec<u64> = (0..40)
            .map(|step| (smallest as f64 * 10_f64.powf(f64::from(step) / 2.0)).round())
            .take_while(|size| *size < largest as f64)
            .map(|size| size as u64)
            .collect();
        sizes.push(largest);
        sizes
    }
}

/// The answer of a question.
fn answered<Q: Question>(question: &Q) -> Measured<Q::Answer> {
    complete(question.answer(&Library::default(), &mut |_| ControlFlow::Continue(()))?)
}

fn complete<T>(outcome: Outcome<T>) -> Measured<T> {
    outcome.complete().ok_or_else(|| "it was cancelled".into())
}

fn check(path: PathBuf) -> Measured<Option<CheckedContent>> {
    let answer = answered(&CheckRequest { paths: vec![path], all: false, map: None })?;
    if let Some(problem) = answer.report.report.problems.first() {
        return Err(problem.message.clone().into());
    }
    Ok(answer.items.into_iter().next().map(|item| item.content))
}

fn cases(n: u64, folder: &Path) -> Measured<Option<u64>> {
    match check(folder.to_owned())? {
        Some(CheckedContent::Dataset(checked)) if checked.dataset.cases.len() as u64 == n => {
            Ok(None)
        }
        _ => Err(format!("not all of the {n} cases were read").into()),
    }
}

fn rows(n: u64, folder: &Path) -> Measured<Option<u64>> {
    match check(folder.join(inputs::FORCE_FILE))? {
        Some(CheckedContent::File(checked)) if checked.loaded.series.time_s().len() as u64 == n => {
            Ok(None)
        }
        _ => Err(format!("not all of the {n} rows were read").into()),
    }
}

/// The PIT manoeuvre that comes with the program.
fn pit() -> MotionSource {
    let scenario = ScenarioChoice::File(PathBuf::from("pit-right-rear"));
    MotionSource::Scenario { scenario, pulse: PulseSetup::default() }
}

/// A forecast of the PIT manoeuvre, which follows both cars through all contacts.
fn forecast(n: u64) -> Measured<PredictMotionRequest> {
    let draws = usize::try_from(n)?;
    let force = ForceSource::Predicted(ModelChoice::default());
    let mut request = PredictMotionRequest { draws, ..PredictMotionRequest::new(pit(), force) };
    request.motion.vehicle_draws = Some(draws);
    Ok(request)
}

fn draws_of_one_car(n: u64, _folder: &Path) -> Measured<Option<u64>> {
    let mut request = forecast(n)?;
    request.motion.one_contact = true;
    answered(&request)?;
    Ok(None)
}

fn draws_of_both_cars(n: u64, _folder: &Path) -> Measured<Option<u64>> {
    answered(&forecast(n)?)?;
    Ok(None)
}

fn reconstruct(particles: usize, folder: &Path) -> Measured<Option<u64>> {
    let evidence = EvidenceChoice::File(folder.join(inputs::EVIDENCE_FILE));
    let answer = answered(&ReconstructRequest {
        one_contact: true,
        particles,
        ..ReconstructRequest::new(evidence)
    })?;
    Ok(Some(answer.report.report.n_simulations as u64))
}

fn frames(n: u64, _folder: &Path) -> Measured<Option<u64>> {
    let request =
        SimulateRequest { vehicle_draws: Some(0), alone: true, ..SimulateRequest::new(pit()) };
    let answer = answered(&request)?;
    let scene = simulation_scene(&SimulationScene {
        analysis: &answer.analysis,
        others: &[],
        units: UnitSystem::Si,
        caveats: &answer.report.caveats,
    });
    let whole = FilmTiming::from_scene(&scene);
    let duration_s = whole.to_s - whole.from_s;
    let speed = duration_s * f64::from(whole.frames_per_s) / (n.max(2) - 1) as f64;
    let timing = FilmTiming { speed, ..whole };
    let picture = ScenePicture {
        camera: Camera::default(),
        time_s: timing.from_s,
        scene: Arc::new(scene),
        courses: Vec::new(),
        is_placed: false,
        seen_aspect: None,
        distance_m: None,
        follow: Follow::Nothing,
    };
    let scale = Canvas::scene_scale(FRAME_PX);
    let canvas = Canvas { size_px: FRAME_PX, scale, dark: false };
    let film = Film { picture, timing, keys: Vec::new(), canvas };
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("film.mp4");
    let go_on = &mut |_| ControlFlow::Continue(());
    complete(write_film(&film, &path, Existing::Refuse, go_on)?)?;
    Ok(None)
}

fn sweep(n: u64, folder: &Path) -> Measured<Option<u64>> {
    let library = Library::default();
    let out = tempfile::tempdir()?;
    let plan = Plan::read(&folder.join(inputs::PLAN_FILE), &library)?;
    plan.write(out.path())?;
    let chunks: Vec<u64> = (0..plan.n_chunks()).collect();
    let go_on = &mut |_| ControlFlow::Continue(());
    let run = run_chunks(out.path(), &chunks, &library, go_on)?;
    if run.rows != n || run.failed > 0 {
        return Err(format!("{} of {n} rows were computed, {} failed", run.rows, run.failed).into());
    }
    merge(out.path(), &out.path().join("rows.parquet"), Existing::Refuse, go_on)?;
    Ok(None)
}
