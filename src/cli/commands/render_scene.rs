//! `impactlab render scene`: the cars of a case at a moment, from above or in perspective.

use std::path::Path;
use std::sync::Arc;

use clap::Args;
use impactlab_core::uncertainty::Caveats;

use crate::cli::CliError;
use crate::cli::commands::render::{OutputArgs, VehicleArgs};
use crate::cli::commands::render_figure::noted;
use crate::cli::console::Console;
use crate::cli::options::{SourceArgs, Values, count, number, one_value_of};
use impactlab_core::ranges::{CAMERA_AZIMUTH, CAMERA_DISTANCE, CAMERA_ELEVATION, GHOSTS, INSTANT};
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    self, Figure, FigureElement, LineStyle, Role, Series, analysis_scene_figure,
};
use impactlab_document::scene::{
    FilmTiming, ForecastScene, LoadedGround, Scene, ScenePath, SimulationScene, add_forecast,
    simulation_scene,
};
use impactlab_draw::scene::{Camera, Follow, SceneCourse, ScenePicture, ViewKind};
use impactlab_study::analysis::{Analysis, DensityTask};
use impactlab_study::{ForceSource, PredictMotionRequest, SimulateAnswer, SimulateRequest};

/// Distance of the camera from a car that it follows, m: the car is an eighth of the width of a picture.
const FOLLOW_M: f64 = 35.0;

#[derive(Debug, Args)]
pub(super) struct SceneArgs {
    #[command(flatten)]
    seen: SeenArgs,
    /// The moment at which the vehicles are drawn, s
    #[arg(long, value_parser = number(INSTANT))]
    time: f64,
    #[command(flatten)]
    pub(super) output: OutputArgs,
}

/// What a scene is of, and from where it is seen: the same for a picture and a film.
#[derive(Debug, Args)]
pub(super) struct SeenArgs {
    #[command(flatten)]
    pub(super) case: CaseArgs,
    /// From where the scene is seen
    #[arg(long, value_parser = one_value_of(VIEWS), default_value = "above")]
    view: ViewKind,
    #[command(flatten)]
    camera: CameraArgs,
}

/// What a scene is of.
#[derive(Debug, Args)]
pub(super) struct CaseArgs {
    #[command(flatten)]
    pub(super) source: SourceArgs,
    /// Draw so many paths from a forecast of the response network under the recorded force, and into a
    /// picture its density and regions at the moment; 0 asks for no forecast. Window and reports draw 30
    #[arg(long, value_name = "N", value_parser = count::<usize>(GHOSTS), default_value = "0")]
    pub(super) ghosts: usize,
    #[command(flatten)]
    pub(super) vehicle: VehicleArgs,
}

/// Where the camera is.
#[derive(Debug, Clone, Copy, Default, Args)]
struct CameraArgs {
    /// In perspective: direction from the scene to the camera, counter-clockwise from X; such as -110deg
    #[arg(long, value_name = "ANGLE", value_parser = number(CAMERA_AZIMUTH), allow_hyphen_values = true)]
    azimuth: Option<f64>,
    /// In perspective: height of the camera above the horizon; such as 30deg
    #[arg(long, value_name = "ANGLE", value_parser = number(CAMERA_ELEVATION))]
    elevation: Option<f64>,
    /// Distance of the camera from what it looks at; if not given 35 m from the car that it follows, or
    /// where the whole scene is seen
    #[arg(long, value_name = "LENGTH", value_parser = number(CAMERA_DISTANCE))]
    distance: Option<f64>,
    /// The car in the middle of the picture
    #[arg(long, value_parser = one_value_of(FOLLOWED))]
    follow: Option<Follow>,
}

/// From where a scene is seen.
const VIEWS: Values<ViewKind> =
    &[(ViewKind::Above, "From above, to scale"), (ViewKind::Perspective, "In perspective")];

/// The cars that the camera can follow.
const FOLLOWED: Values<Follow> = &[
    (Follow::Struck, "The struck car"),
    (Follow::Striking, "The striking car, where it is known"),
];

/// A scene as it is to be seen.
pub(super) struct ShownScene {
    scene: Scene,
    courses: Vec<SceneCourse>,
    time_s: f64,
    view: ViewKind,
    camera: CameraArgs,
}

impl ShownScene {
    /// A scene of which everything is seen.
    pub(super) fn fitted(scene: Scene, time_s: f64, view: ViewKind) -> Self {
        Self { scene, courses: Vec::new(), time_s, view, camera: CameraArgs::default() }
    }

    /// The same with courses of events side by side; alone if there are none.
    pub(super) fn beside(self, courses: Vec<SceneCourse>) -> Self {
        Self { courses, ..self }
    }

    /// What the scene is of.
    pub(super) fn subject(&self) -> String {
        self.scene.title.clone()
    }

    /// What it shows.
    pub(super) fn title(&self) -> String {
        self.scene.heading(self.view.phrase(), self.time_s)
    }

    /// The picture that is drawn.
    pub(super) fn picture(self) -> ScenePicture {
        let CameraArgs { azimuth, elevation, distance, follow } = self.camera;
        let usual = Camera::default();
        ScenePicture {
            camera: Camera {
                kind: self.view,
                azimuth_rad: azimuth.unwrap_or(usual.azimuth_rad),
                elevation_rad: elevation.unwrap_or(usual.elevation_rad),
                ..usual
            },
            scene: Arc::new(self.scene),
            courses: self.courses,
            time_s: self.time_s,
            is_placed: false,
            seen_aspect: None,
            distance_m: distance.or(follow.map(|_| FOLLOW_M)),
            follow: follow.unwrap_or_default(),
        }
    }
}

/// The scene of a case or a file at a moment: its numbers as a figure, notes, and what is drawn.
pub(super) fn scene(
    args: &SceneArgs,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<(Figure, Vec<String>, ShownScene), CliError> {
    let time_s = args.time;
    let BuiltScene { analysis, scene, notes } =
        build(&args.seen.case, Some(time_s), units, console)?;
    let mut figure = analysis_scene_figure(&analysis, &scene.caveats, time_s, units);
    figure.elements.extend(drawn_paths(&scene, &figure));
    Ok((figure, notes, args.seen.shown(scene, time_s)))
}

/// A scene with what it was built from.
pub(super) struct BuiltScene {
    /// Motions, force and vehicles.
    pub(super) analysis: Analysis,
    /// The scene.
    pub(super) scene: Scene,
    /// Notes on how it was made.
    pub(super) notes: Vec<String>,
}

impl BuiltScene {
    /// Checks that there is a motion at a time.
    ///
    /// - `option`: which says the time, for the error.
    pub(super) fn check_time(&self, option: &'static str, time_s: f64) -> Result<(), CliError> {
        check_time(&self.analysis, (option, time_s))
    }

    /// The first instant of the motion, s.
    pub(super) fn start_s(&self) -> f64 {
        FilmTiming::from_scene(&self.scene).from_s
    }
}

/// Builds the scene of a case or a file.
///
/// - `density_s`: the moment of the density of a forecast, which has to lie within the motion; a film
///   has none.
pub(super) fn build(
    args: &CaseArgs,
    density_s: Option<f64>,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<BuiltScene, CliError> {
    let request = args.vehicle.request(&args.source, console)?;
    let SimulateAnswer { report, analysis } = console.answer(&request)?;
    console.answered(&report.provenance);
    if let Some(time_s) = density_s {
        check_time(&analysis, ("--time", time_s))?;
    }
    let mut caveats = report.caveats.clone();
    let mut notes = noted(&report.caveats, units);
    let mut scene = simulation_scene(&SimulationScene {
        analysis: &analysis,
        others: &[],
        units,
        caveats: &caveats,
    });
    if args.ghosts > 0 {
        let ghosts = (request, args.ghosts, density_s);
        let ghost_notes = add_ghosts(ghosts, (&mut scene, &mut caveats), console)?;
        notes.extend(
            ghost_notes.into_iter().filter(|note| !notes.contains(note)).collect::<Vec<_>>(),
        );
        scene.caveats = caveats;
    }
    if let Some(path) = &args.vehicle.site {
        notes.extend(add_ground(&mut scene, path, console)?);
    }
    Ok(BuiltScene { analysis, scene, notes })
}

impl SeenArgs {
    /// A scene as these options show it.
    pub(super) fn shown(&self, scene: Scene, time_s: f64) -> ShownScene {
        ShownScene { scene, courses: Vec::new(), time_s, view: self.view, camera: self.camera }
    }
}

/// Puts the ground of a site below a scene; returns what there is to say of it.
pub(super) fn add_ground(
    scene: &mut Scene,
    site: &Path,
    console: &mut Console<'_>,
) -> Result<Vec<String>, CliError> {
    let loaded = console.ground(site)?;
    let far = loaded.far_notes(scene.extent_m(), scene.units);
    let LoadedGround { ground, notes, .. } = loaded;
    scene.ground = Some(ground);
    Ok(notes.into_iter().chain(far).collect())
}

/// Checks that there is a motion at a time.
fn check_time(analysis: &Analysis, (option, time_s): (&'static str, f64)) -> Result<(), CliError> {
    let simulation = analysis.simulation.as_ref().map(|motion| &motion.series);
    let Some(shown) = analysis.reference.as_ref().or(simulation) else { return Ok(()) };
    let [start_s, end_s] = [shown.time_s().first(), shown.time_s().last()]
        .map(|time| time.copied().unwrap_or_default());
    match (start_s..=end_s).contains(&time_s) {
        true => Ok(()),
        false => Err(CliError::TimeOutside { option, time_s, start_s, end_s }),
    }
}

/// Asks for a forecast and adds it to a scene; returns its notes.
fn add_ghosts(
    (motion, n_ghosts, density_s): (SimulateRequest, usize, Option<f64>),
    (scene, caveats): (&mut Scene, &mut Caveats),
    console: &mut Console<'_>,
) -> Result<Vec<String>, CliError> {
    let force = ForceSource::usual(&motion.source);
    let request = PredictMotionRequest {
        motion: motion.clone(),
        ..PredictMotionRequest::new(motion.source, force)
    };
    let answer = console.answer(&request)?;
    console.answered(&answer.report.provenance);
    let density = density_s.map(|time_s| {
        Arc::new(DensityTask::new(&answer.forecast.distribution, [time_s; 2]).on_cpu())
    });
    add_forecast(
        scene,
        &ForecastScene {
            analysis: &answer.analysis,
            forecast: &answer.forecast,
            density: density.as_ref(),
            n_ghosts,
            until_s: answer.report.known_until_s(),
        },
    );
    let report = &answer.report;
    caveats.add_variant("forecast", &report.caveats);
    Ok(noted(&report.caveats, scene.units))
}

/// The paths that were drawn from a forecast, in the units of a figure.
fn drawn_paths(scene: &Scene, figure: &Figure) -> Vec<FigureElement> {
    let shown = |[x, y]: [f64; 2]| [figure.x.unit.from_si(x), figure.y.unit.from_si(y)];
    let drawn: Vec<&ScenePath> = scene.paths.iter().filter(|path| !path.has_ticks).collect();
    let path = |(idx, path): (usize, &&ScenePath)| {
        // The draws of each vehicle are counted from 1.
        let number = 1 + drawn[..idx].iter().filter(|of| of.name == path.name).count();
        let of_whom = path.name.strip_prefix("draws ").unwrap_or(&path.name);
        let states = path.motion.states();
        let points = states.iter().map(|state| shown([state.pose.x_m, state.pose.y_m])).collect();
        FigureElement::Path(figure::Path {
            series: Series {
                name: format!("draw {number} {of_whom}"),
                role: Role::Muted,
                style: LineStyle::Solid,
                points,
            },
            time_s: path.motion.time_s().to_vec(),
            yaw_rad: states.iter().map(|state| state.pose.yaw_rad).collect(),
        })
    };
    drawn.iter().enumerate().map(path).collect()
}
