//! `impactlab render`: a figure as a picture or as numbers, without a window.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::commands::render_figure;
use crate::cli::commands::render_film::{self, FilmArgs};
use crate::cli::commands::render_forecast::{self, ForecastArgs};
use crate::cli::commands::render_reconstruction::{self, ReconstructionArgs};
use crate::cli::commands::render_replay::{self, ReplayFigureArgs};
use crate::cli::commands::render_scene::{self, SceneArgs, ShownScene};
use crate::cli::console::{Console, Verdict, print_json, shown_path};
use crate::cli::options::{
    OverwriteArg, SourceArgs, UNITS, Values, VehicleArg, Words, contact_point, number, one_of,
    one_value_of, size_px,
};
use impactlab_core::collision::ChannelClass;
use impactlab_core::data::{Channel, write_atomically};
use impactlab_core::ranges::{PICTURE_SCALE, SPEED};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::ContactPoint;
use impactlab_document::figure::{Figure, WheelInput, write_figure_csv};
use impactlab_draw::Canvas;
use impactlab_study::{Drive, ImpactRequest, ScenarioChoice, SimulateRequest, VehicleChoice};

/// Draw a figure into a PNG, or write its numbers as CSV
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct RenderArgs {
    #[command(subcommand)]
    command: RenderCommand,
}

#[derive(Debug, Subcommand)]
enum RenderCommand {
    #[command(flatten)]
    Figure(FigureArgs),
    /// The scene as a film, from above or in perspective, with slow motion; of the evidence of a
    /// collision, the course of events that is reconstructed from it
    #[command(after_help = "\
Examples:\n  impactlab render film datasets/trajectories-fea --case FE_c002 --view perspective \
--follow struck --slow 0..0.3=0.1 --out film.mp4\n  \
impactlab render film datasets/trajectories-fea --case FE_c002 --fps 25 --out frames\n  \
impactlab render film datasets/staged/evidence/s11.toml --view perspective --out reconstruction.mp4\n\n\
JSON: out, title, n_frames, frames_per_s, duration_s, size_px [width, height], notes")]
    Film(FilmArgs),
}

const EXAMPLES: &str = "\
Examples:
  impactlab render force datasets/fea --case c001 --cfc 60 --out force.png
  impactlab render scene datasets/trajectories-fea --case FE_c002 --time 1.5 --out scene.png
  impactlab render impact pit-right-rear --out impact.csv

JSON: out, title, x_axis, y_axis, notes";

#[derive(Debug, Subcommand)]
enum FigureArgs {
    /// The contact force over time
    #[command(after_help = "\
Example:\n  impactlab render force datasets/fea --case c001 --cfc 60 --out force.png")]
    Force(ForceArgs),
    /// The motion over time: simulation and reference
    #[command(after_help = "\
Example:\n  impactlab render motion datasets/trajectories-fea --case FE_c002 --channel yaw-rate \
--out motion.png")]
    Motion(MotionArgs),
    /// What drivers and stability control did to the wheels of both cars over time
    #[command(after_help = "\
Example:\n  impactlab render controls scenario.toml --plot steering --out steering.png")]
    Controls(ControlsArgs),
    /// The scene at a moment, from above or in perspective: simulation and reference
    #[command(after_help = "\
Example:\n  impactlab render scene datasets/trajectories-fea --case FE_c002 --time 1.5 \
--out scene.png --dark\n  \
impactlab render scene datasets/trajectories-fea --case FE_c002 --time 2 --view perspective \
--ghosts 30 --out ghosts.png")]
    Scene(SceneArgs),
    /// Where the response network says the struck vehicle goes under the recorded force, beside the
    /// record
    #[command(after_help = "\
Example:\n  impactlab render forecast datasets/trajectories-fea --case FE_c002 --time 2 --out forecast.png\n  \
impactlab render forecast datasets/trajectories-fea --case FE_c002 --channel yaw --out yaw.png")]
    Forecast(ForecastArgs),
    /// What the evidence of a collision says: paths over the evidence, a quantity before and after it,
    /// or what further evidence would bring
    #[command(after_help = "\
Example:\n  impactlab render reconstruction case.toml --plot target-speed --out speed.png")]
    Reconstruction(ReconstructionArgs),
    /// The path of a car by its event data recorder, or what was recorded beside what was replayed
    #[command(after_help = "\
Example:\n  impactlab render replay report.csv --steering-ratio 14.5 --plot yaw-rate --out yaw-rate.png")]
    Replay(Box<ReplayFigureArgs>),
    /// The impact of a scenario from above: impulse and delta-v
    #[command(after_help = "\
Example:\n  impactlab render impact pit-right-rear --out impact.png")]
    Impact(ImpactFigureArgs),
}

/// Where the figure goes, and how it looks.
#[derive(Debug, Args)]
pub(super) struct OutputArgs {
    /// The file: .png for a picture, .csv for the figure's numbers
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of the figure
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    pub(super) units: UnitSystem,
    /// Dark ground
    #[arg(long)]
    dark: bool,
    /// Width x height, pixels
    #[arg(long, value_parser = size_px, default_value = "1920x1080")]
    size: [u32; 2],
    /// Pixels per point: larger text and lines; 2 if not given, for print and slides, and for a scene in
    /// proportion to its size
    #[arg(long, value_parser = number(PICTURE_SCALE))]
    scale: Option<f64>,
}

/// With what a case is simulated.
#[derive(Debug, Args)]
pub(super) struct VehicleArgs {
    /// The struck vehicle: a file, or a name from `impactlab vehicles`; a trajectory data set has
    /// its own, else reference-2000. A scenario takes over its mass, yaw inertia and outline
    #[arg(long, value_name = "V.toml|PRESET")]
    vehicle: Option<VehicleArg>,
    /// The striking vehicle, where it is simulated; with a data set, mass and inertia are the case's
    #[arg(id = "bullet", long = "bullet", value_name = "V.toml|PRESET")]
    striking: Option<VehicleArg>,
    /// For a single force file: forward speed at the start, as in simulate
    #[arg(long, value_parser = number(SPEED), allow_hyphen_values = true)]
    speed: Option<f64>,
    /// For a single file with a force but no mz: where the force acts, as in simulate
    #[arg(long, value_name = "X,Y,Z", value_parser = contact_point, allow_hyphen_values = true)]
    contact: Option<ContactPoint>,
    /// The ground: a site file with orthophoto, lanes, drawing and zones of their own friction, or an
    /// orthophoto alone
    #[arg(long, value_name = "SITE.toml")]
    pub(super) site: Option<PathBuf>,
}

impl VehicleArgs {
    /// The struck vehicle.
    pub(super) fn struck(&self) -> VehicleChoice {
        VehicleArg::choice(&self.vehicle)
    }

    /// The options that say nothing of a reconstruction, each with whether it is there.
    pub(super) fn given(&self) -> [(&'static str, bool); 3] {
        [
            ("--bullet", self.striking.is_some()),
            ("--speed", self.speed.is_some()),
            ("--contact", self.contact.is_some()),
        ]
    }

    /// The simulation of what a path and `--case` choose.
    pub(super) fn request(
        &self,
        source: &SourceArgs,
        console: &mut Console<'_>,
    ) -> Result<SimulateRequest, CliError> {
        let start = Drive { speed_m_s: self.speed, contact: self.contact, ..Drive::default() };
        let mut request = SimulateRequest {
            vehicle: self.struck(),
            striking: VehicleArg::choice(&self.striking),
            vehicle_draws: Some(0),
            site: self.site.clone(),
            ..SimulateRequest::new(source.motion_source(&console.library, start)?)
        };
        console.take_vehicles(&mut request)?;
        Ok(request)
    }
}

#[derive(Debug, Args)]
struct ForceArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// Filter with this channel frequency class (SAE J211), the unfiltered force behind
    #[arg(long, value_parser = one_of(CLASSES))]
    cfc: Option<ChannelClass>,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Debug, Args)]
struct MotionArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// What is shown
    #[arg(long, value_parser = one_value_of(CHANNELS))]
    channel: Channel,
    #[command(flatten)]
    vehicle: VehicleArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Debug, Args)]
struct ControlsArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// What is shown
    #[arg(long, value_parser = one_of(INPUTS))]
    plot: WheelInput,
    #[command(flatten)]
    vehicle: VehicleArgs,
    #[command(flatten)]
    output: OutputArgs,
}

#[derive(Debug, Args)]
struct ImpactFigureArgs {
    /// The scenario: a file, or `pit-right-rear`
    #[arg(value_name = "NAME|FILE")]
    scenario: PathBuf,
    /// Friction as in the paper: always sliding
    #[arg(long)]
    paper: bool,
    #[command(flatten)]
    output: OutputArgs,
}

/// The channel frequency classes.
const CLASSES: Words<ChannelClass> = &[
    ("60", "", ChannelClass::Cfc60),
    ("180", "", ChannelClass::Cfc180),
    ("600", "", ChannelClass::Cfc600),
    ("1000", "", ChannelClass::Cfc1000),
];

/// The channels of the motion.
const CHANNELS: Values<Channel> =
    &[(Channel::Vx, ""), (Channel::Vy, ""), (Channel::YawRate, ""), (Channel::Roll, "")];

/// What acts on the wheels.
const INPUTS: Words<WheelInput> = &[
    ("steering", "Steer angle of the road wheels", WheelInput::Steering),
    ("braking", "Braking torque, summed over the wheels", WheelInput::Braking),
    ("drive", "Drive torque, summed over the wheels", WheelInput::Drive),
    ("struck-brakes", "Each brake of the struck car, with ESC", WheelInput::StruckBrakes),
    ("striking-brakes", "Each brake of the striking car, with ESC", WheelInput::StrikingBrakes),
];

#[derive(Debug, Serialize)]
struct RenderedFigure<'a> {
    out: &'a Path,
    title: &'a str,
    x_axis: String,
    y_axis: String,
    notes: &'a [String],
}

/// Makes the figure or the film.
pub(in crate::cli) fn run(
    args: &RenderArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    match &args.command {
        RenderCommand::Figure(args) => figure(args, console),
        RenderCommand::Film(args) => render_film::run(args, console),
    }
}

/// Makes the figure, writes it and says so.
fn figure(args: &FigureArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let output = match args {
        FigureArgs::Force(args) => &args.output,
        FigureArgs::Motion(args) => &args.output,
        FigureArgs::Controls(args) => &args.output,
        FigureArgs::Scene(args) => &args.output,
        FigureArgs::Forecast(args) => &args.output,
        FigureArgs::Reconstruction(args) => &args.output,
        FigureArgs::Replay(args) => &args.output,
        FigureArgs::Impact(args) => &args.output,
    };
    let ending = output.out.extension().map(|end| end.to_ascii_lowercase());
    let is_picture = match ending.as_deref().and_then(|end| end.to_str()) {
        Some("csv") => false,
        Some("png") => true,
        _ => {
            let path = output.out.clone();
            return Err(CliError::OutputKind { path });
        }
    };
    console.check_target(Some(&output.out), output.overwrite.into())?;
    let units = output.units;
    let mut scene: Option<ShownScene> = None;
    let (mut figure, notes) = match args {
        FigureArgs::Force(args) => {
            let class = args.cfc;
            render_figure::force(&args.source, class, units, console)?
        }
        FigureArgs::Motion(args) => {
            let channel = args.channel;
            let request = args.vehicle.request(&args.source, console)?;
            render_figure::motion(&request, channel, units, console)?
        }
        FigureArgs::Controls(args) => {
            let request = args.vehicle.request(&args.source, console)?;
            render_figure::controls(&request, args.plot, units, console)?
        }
        FigureArgs::Scene(args) => {
            let (figure, notes, shown) = render_scene::scene(args, units, console)?;
            scene = Some(shown);
            (figure, notes)
        }
        FigureArgs::Forecast(args) => render_forecast::figure(args, units, console)?,
        FigureArgs::Reconstruction(args) => {
            let (noted, cars) = render_reconstruction::figure(args, units, console)?;
            scene = cars;
            noted
        }
        FigureArgs::Replay(args) => render_replay::figure(args, units, console)?,
        FigureArgs::Impact(args) => {
            let scenario = ScenarioChoice::File(args.scenario.clone());
            let request = ImpactRequest { paper: args.paper, ..ImpactRequest::new(scenario) };
            render_figure::impact(&request, units, console)?
        }
    };
    match scene {
        _ if !is_picture => write_csv(&figure, output)?,
        Some(shown) => {
            figure.title = shown.title();
            write_scene(shown, output)?;
        }
        None => write_png(&figure, output)?,
    }
    if console.json {
        let answer = RenderedFigure {
            out: &output.out,
            title: &figure.title,
            x_axis: figure.x.column(),
            y_axis: figure.y.column(),
            notes: &notes,
        };
        print_json(console.out, &answer)?;
    } else {
        writeln!(console.out, "{}: {}", shown_path(&output.out), figure.title)?;
        for note in &notes {
            writeln!(console.out, "note: {note}")?;
        }
    }
    Ok(Verdict::Clean)
}

fn write_csv(figure: &Figure, output: &OutputArgs) -> Result<(), CliError> {
    write_atomically(&output.out, output.overwrite.into(), |file| {
        write_figure_csv(figure, file).map_err(std::io::Error::other)
    })?;
    Ok(())
}

/// The canvas of a picture.
///
/// - `usual_scale`: pixels per point where nobody says them.
fn canvas(output: &OutputArgs, usual_scale: f32) -> Canvas {
    let OutputArgs { size, scale, dark, .. } = *output;
    Canvas { size_px: size, scale: scale.map_or(usual_scale, |scale| scale as f32), dark }
}

fn write_png(figure: &Figure, output: &OutputArgs) -> Result<(), CliError> {
    let image = impactlab_draw::figure_image(figure, canvas(output, Canvas::default().scale))?;
    impactlab_draw::save_png(&image, &output.out, output.overwrite.into())?;
    Ok(())
}

fn write_scene(shown: ShownScene, output: &OutputArgs) -> Result<(), CliError> {
    let canvas = canvas(output, Canvas::scene_scale(output.size));
    let image = impactlab_draw::scene::scene_image(&shown.picture(), canvas)?;
    impactlab_draw::save_png(&image, &output.out, output.overwrite.into())?;
    Ok(())
}
