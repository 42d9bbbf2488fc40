//! `impactlab render reconstruction`: what the evidence of a collision says.

use std::sync::Arc;

use clap::{Args, ValueEnum};

use crate::cli::CliError;
use crate::cli::commands::render::OutputArgs;
use crate::cli::commands::render_figure::{Noted, noted};
use crate::cli::commands::render_scene::ShownScene;
use crate::cli::console::Console;
use crate::cli::options::EvidenceArgs;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    ReconstructionScene, budget_figure, marginal_figure, prior_values, reconstruction_scene_figure,
};
use impactlab_document::scene::{LoadedGround, ReconstructionParts, Scene, reconstruction_scene};
use impactlab_draw::scene::{SceneCourse, ViewKind};
use impactlab_reconstruct::{Mode, ReconstructedQuantity};
use impactlab_study::{NamedPath, ReconstructAnswer, ReconstructRequest, ReconstructedPaths};

/// The evidence, and what is drawn.
#[derive(Debug, Args)]
pub(super) struct ReconstructionArgs {
    #[command(flatten)]
    evidence: EvidenceArgs,
    /// What is drawn
    #[arg(long, value_enum, default_value_t)]
    plot: PlotArg,
    #[command(flatten)]
    pub(super) output: OutputArgs,
}

/// A figure of a reconstruction.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum PlotArg {
    /// The paths of the struck car over the evidence, from above
    #[default]
    Scene,
    /// The same with the cars as bodies, from above
    CarsAbove,
    /// The same in perspective
    CarsPerspective,
    /// The speed of the struck car, or of a single one, before and after the evidence
    #[value(name = "target-speed", alias = "speed")]
    StruckSpeed,
    /// The speed of the striking car
    #[value(name = "bullet-speed")]
    StrikingSpeed,
    /// The closing speed
    ClosingSpeed,
    /// The friction of the road
    RoadFriction,
    /// Δv of the struck car
    DeltaV,
    /// What further evidence would bring
    Budget,
}

impl PlotArg {
    /// The quantity whose distribution is drawn, if it is one.
    fn quantity(self) -> Option<ReconstructedQuantity> {
        match self {
            Self::Scene | Self::CarsAbove | Self::CarsPerspective | Self::Budget => None,
            Self::StruckSpeed => Some(ReconstructedQuantity::StruckSpeed),
            Self::StrikingSpeed => Some(ReconstructedQuantity::StrikingSpeed),
            Self::ClosingSpeed => Some(ReconstructedQuantity::ClosingSpeed),
            Self::RoadFriction => Some(ReconstructedQuantity::RoadFriction),
            Self::DeltaV => Some(ReconstructedQuantity::DeltaVStruck),
        }
    }
}

/// Reconstructs the case and draws the figure.
pub(super) fn figure(
    args: &ReconstructionArgs,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<(Noted, Option<ShownScene>), CliError> {
    let of = Reconstructed::new(&args.evidence.request(), console)?;
    let answer = &of.answer;
    let caveats = &answer.report.caveats;
    let (mut cars, mut notes) = (None, of.notes(units));
    let figure = match (args.plot.quantity(), args.plot) {
        (Some(quantity), _) => {
            let quantity = of.asked(quantity)?;
            let prior = prior_values(&answer.target, quantity);
            marginal_figure(answer, quantity, &prior, caveats, units)
        }
        (None, PlotArg::Budget) => budget_figure(answer, caveats, units),
        (None, _) => {
            let paths = ReconstructedPaths::from_answer(answer);
            let view = match args.plot {
                PlotArg::CarsAbove => Some(ViewKind::Above),
                PlotArg::CarsPerspective => Some(ViewKind::Perspective),
                _ => None,
            };
            cars = view.map(|view| {
                let built = of.cars(&paths, units);
                notes.extend(of.far_notes(&built));
                let end_s = built.end_s;
                ShownScene::fitted(built, end_s, view)
            });
            reconstruction_scene_figure(&ReconstructionScene::new(answer, &paths), caveats, units)
        }
    };
    Ok(((figure, notes), cars))
}

/// The scene of a reconstruction with the cars as bodies and a particle of median speed, the scene of each
/// course of events where several are possible, and notes on how they were made.
pub(super) fn cars_scene(
    request: &ReconstructRequest,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<(Scene, Vec<SceneCourse>, Vec<String>), CliError> {
    let of = Reconstructed::new(request, console)?;
    let scene = of.cars(&ReconstructedPaths::from_answer(&of.answer), units);
    let modes = &of.answer.report.modes;
    let course = |mode: &Mode| {
        let paths = ReconstructedPaths::from_mode(&of.answer, mode);
        let name = ReconstructedPaths::course_title(mode);
        SceneCourse { name, scene: Arc::new(of.cars(&paths, units)) }
    };
    let courses = if modes.len() > 1 { modes.iter().map(course).collect() } else { Vec::new() };
    let notes = of.notes(units).into_iter().chain(of.far_notes(&scene)).collect();
    Ok((scene, courses, notes))
}

/// The scene of a reconstruction for other programs: with the paths of a particle of each course of events.
pub(super) struct ExportedReconstruction {
    /// The scene, with what restricts it.
    pub(super) scene: Scene,
    /// The path of a particle of median speed, or of one of each course of events.
    pub(super) paths: Vec<NamedPath>,
    /// Notes on how it was made.
    pub(super) notes: Vec<String>,
}

/// Reconstructs a case for other programs.
pub(super) fn exported(
    request: &ReconstructRequest,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<ExportedReconstruction, CliError> {
    let of = Reconstructed::new(request, console)?;
    let paths = ReconstructedPaths::from_answer(&of.answer);
    let scene = of.cars(&paths, units);
    let notes = of.notes(units).into_iter().chain(of.far_notes(&scene)).collect();
    let paths = paths.median.into_iter().chain(paths.others).collect();
    Ok(ExportedReconstruction { scene, paths, notes })
}

/// A reconstruction with what restricts it, and the ground below its cars.
struct Reconstructed {
    answer: ReconstructAnswer,
    ground: Option<LoadedGround>,
}

impl Reconstructed {
    fn new(request: &ReconstructRequest, console: &mut Console<'_>) -> Result<Self, CliError> {
        // A picture of a site that cannot be read is said before anything is sampled.
        let site = request.site.as_deref();
        let ground = site.map(|site| console.ground(site)).transpose()?;
        let answer = console.answer(request)?;
        Ok(Self { answer, ground })
    }

    /// The quantity of the case: the speed at the start of a single car for that of a struck one.
    fn asked(&self, quantity: ReconstructedQuantity) -> Result<ReconstructedQuantity, CliError> {
        let posterior = &self.answer.posterior;
        let of_case = match quantity {
            ReconstructedQuantity::StruckSpeed => posterior.speed(),
            other => other,
        };
        match posterior.asked().contains(&of_case) {
            true => Ok(of_case),
            false => Err(CliError::NotOfSingleCar {
                name: self.answer.report.case.clone(),
                quantity: of_case.label(),
            }),
        }
    }

    fn notes(&self, units: UnitSystem) -> Vec<String> {
        let mut notes = noted(&self.answer.report.caveats, units);
        notes.extend(self.ground.iter().flat_map(|ground| ground.notes.iter().cloned()));
        notes
    }

    /// What of the ground lies too far from the scene to be seen.
    fn far_notes(&self, scene: &Scene) -> Vec<String> {
        let far = |ground: &LoadedGround| ground.far_notes(scene.extent_m(), scene.units);
        self.ground.iter().flat_map(far).collect()
    }

    fn cars(&self, paths: &ReconstructedPaths, units: UnitSystem) -> Scene {
        let parts =
            ReconstructionParts::new(&self.answer, paths, units, &self.answer.report.caveats);
        let built = reconstruction_scene(&parts);
        Scene { ground: self.ground.as_ref().map(|of| Arc::clone(&of.ground)), ..built }
    }
}
