//! `impactlab render film`: the cars of a case as a film, or as numbered pictures.

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::commands::render_reconstruction::cars_scene;
use crate::cli::commands::render_scene::{BuiltScene, CaseArgs, SeenArgs, ShownScene, build};
use crate::cli::console::{Console, Verdict, print_json, shown_path};
use crate::cli::options::{
    CameraKeyArg, OverwriteArg, UNITS, VehicleArg, camera_key, count, film_section, number,
    one_value_of, size_px,
};
use impactlab_core::ranges::{
    FILM_RATE, FILM_SPEED, INSTANT, PICTURE_SCALE, RECONSTRUCTION_PARTICLES,
};
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{FilmSection, FilmTiming, Scene};
use impactlab_draw::film::Film;
use impactlab_draw::scene::{CameraKey, SceneCourse};
use impactlab_study::{EvidenceChoice, InputKind, ReconstructRequest};

/// What is filmed, and how.
#[derive(Debug, Args)]
pub(super) struct FilmArgs {
    #[command(flatten)]
    seen: SeenArgs,
    #[command(flatten)]
    sampled: SampledArgs,
    /// First moment; the start of the motion if not given
    #[arg(long, value_name = "TIME", value_parser = number(INSTANT))]
    from: Option<f64>,
    /// Last moment; the end of the motion if not given
    #[arg(long, value_name = "TIME", value_parser = number(INSTANT))]
    to: Option<f64>,
    /// Frames per second of the film
    #[arg(long, value_name = "N", value_parser = count::<u32>(FILM_RATE), default_value = "30")]
    fps: u32,
    /// Seconds of the motion in a second of the film: 0.1 is slow motion throughout
    #[arg(long, value_name = "FACTOR", value_parser = number(FILM_SPEED), default_value = "1")]
    playback: f64,
    /// A part of the motion at a speed of its own, such as 0.2..0.6=0.1; several times for several parts
    #[arg(long, value_name = "FROM..TO=FACTOR", value_parser = film_section)]
    slow: Vec<FilmSection>,
    /// The camera at a time, such as t=0.5,distance=20,azimuth=30deg,elevation=60deg,follow=struck; several
    /// times, in the order of time, for a camera that moves smoothly from one to the next. Names: t, x and y
    /// (what it looks at), distance, azimuth, elevation, follow (none, struck, striking). What a key leaves out
    /// is as in the key before it, and in the first one as it were without keys
    #[arg(long, value_name = "t=TIME,…", value_parser = camera_key)]
    key: Vec<CameraKeyArg>,
    /// The film: a file that ends in .mp4; a name without an ending is a folder of numbered PNG files
    #[arg(long, value_name = "FILE.mp4|DIR")]
    out: PathBuf,
    #[command(flatten)]
    overwrite: OverwriteArg,
    /// Units of the labels
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
    /// Dark ground
    #[arg(long)]
    dark: bool,
    /// Width x height, pixels, both even
    #[arg(long, value_parser = size_px, default_value = "1920x1080")]
    size: [u32; 2],
    /// Pixels per point: larger text and lines; in proportion to the size if not given
    #[arg(long, value_parser = number(PICTURE_SCALE))]
    scale: Option<f64>,
}

/// How a reconstruction is sampled, if the scene is of one.
#[derive(Debug, Args)]
pub(super) struct SampledArgs {
    /// Of evidence: the striking car, where the evidence gives no value
    #[arg(long, value_name = "NAME|FILE")]
    striking: Option<VehicleArg>,
    /// Of evidence: number of particles, as in reconstruct
    #[arg(long, value_name = "N", value_parser = count::<usize>(RECONSTRUCTION_PARTICLES))]
    particles: Option<usize>,
    /// Of evidence: seed of all draws
    #[arg(long)]
    seed: Option<u64>,
}

#[derive(Debug, Serialize)]
struct RenderedFilm<'a> {
    out: &'a Path,
    title: String,
    n_frames: usize,
    frames_per_s: u32,
    duration_s: f64,
    size_px: [u32; 2],
    notes: &'a [String],
}

/// Makes the film and says so.
pub(super) fn run(args: &FilmArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let kind = FilmKind::from_path(&args.out)?;
    match kind {
        FilmKind::Mp4 => console.check_target(Some(&args.out), args.overwrite.into())?,
        FilmKind::Pictures => console.expect_folder(),
    }
    let (scene, courses, mut notes) = scene(args, console)?;
    let timing = timing(args, &scene, &mut notes);
    let instants = timing.instants(&scene)?;
    let shown = args.seen.shown(scene, timing.from_s).beside(courses);
    let title = shown.subject();
    let duration_s = instants.len() as f64 / f64::from(args.fps);
    make(args, (kind, shown, timing), console)?;
    let (n_frames, frames_per_s, size_px) = (instants.len(), args.fps, args.size);
    let out = &args.out;
    if console.json {
        let answer =
            RenderedFilm { out, title, n_frames, frames_per_s, duration_s, size_px, notes: &notes };
        print_json(console.out, &answer)?;
        return Ok(Verdict::Clean);
    }
    let text =
        format!("{title}: {n_frames} frames, {duration_s:.2} s at {frames_per_s} in a second");
    writeln!(console.out, "{}: {text}", shown_path(out))?;
    for note in &notes {
        writeln!(console.out, "note: {note}")?;
    }
    Ok(Verdict::Clean)
}

/// The scene that is filmed, its courses of events where several are possible, and notes on how it was made: a reconstruction of evidence, a simulation of
/// everything else.
fn scene(
    args: &FilmArgs,
    console: &mut Console<'_>,
) -> Result<(Scene, Vec<SceneCourse>, Vec<String>), CliError> {
    let (case, units) = (&args.seen.case, args.units);
    match reconstruction(case, &args.sampled)? {
        Some(request) => cars_scene(&request, units, console),
        None => {
            let BuiltScene { scene, notes, .. } = build(case, None, units, console)?;
            Ok((scene, Vec::new(), notes))
        }
    }
}

/// The reconstruction that is shown, if the path is evidence.
///
/// # Errors
/// [`CliError::OptionOfSimulation`] and [`CliError::OptionOfEvidence`] for an option that would have no
/// effect.
pub(super) fn reconstruction(
    case: &CaseArgs,
    sampled: &SampledArgs,
) -> Result<Option<ReconstructRequest>, CliError> {
    let path = case.source.path.clone();
    let SampledArgs { striking, particles, seed } = sampled;
    let given = |options: &[(&'static str, bool)]| -> Option<&'static str> {
        options.iter().find(|(_, is_there)| *is_there).map(|(option, _)| *option)
    };
    if InputKind::from_path(&path) != InputKind::Evidence {
        let of_evidence = [
            ("--striking", striking.is_some()),
            ("--particles", particles.is_some()),
            ("--seed", seed.is_some()),
        ];
        return match given(&of_evidence) {
            Some(option) => Err(CliError::OptionOfEvidence { path, option }),
            None => Ok(None),
        };
    }
    let others = given(&case.source.given()).or_else(|| given(&case.vehicle.given()));
    if let Some(option) = others.or_else(|| given(&[("--ghosts", case.ghosts > 0)])) {
        return Err(CliError::OptionOfSimulation { path, option });
    }
    Ok(Some(ReconstructRequest {
        vehicle: case.vehicle.struck(),
        striking: VehicleArg::choice(striking),
        site: case.vehicle.site.clone(),
        particles: particles.unwrap_or(ReconstructRequest::DEFAULT_PARTICLES),
        seed: seed.unwrap_or_default(),
        ..ReconstructRequest::new(EvidenceChoice::File(path))
    }))
}

/// The instants of the film; an end just after the motion is moved to its end, which is noted.
fn timing(args: &FilmArgs, scene: &Scene, notes: &mut Vec<String>) -> FilmTiming {
    let whole = FilmTiming::from_scene(scene);
    let wanted = FilmTiming {
        frames_per_s: args.fps,
        from_s: args.from.unwrap_or(whole.from_s),
        to_s: args.to.unwrap_or(whole.to_s),
        speed: args.playback,
        sections: args.slow.clone(),
    };
    let (timing, before_s) = wanted.ending_with_scene(scene);
    notes.extend(before_s.map(|before_s| {
        format!("--to is {before_s} s: the film ends with the motion, at {:.4} s", timing.to_s)
    }));
    timing
}

/// The keys of the camera; what the first one leaves open is as in the film without keys.
fn camera_keys(given: &[CameraKeyArg], film: &Film) -> Vec<CameraKey> {
    let Film { picture, timing, .. } = film;
    let mut key = CameraKey::new(timing.from_s, &film.standing_camera(), picture.follow);
    let next = |of: &CameraKeyArg| {
        key = of.after(&key);
        key
    };
    given.iter().map(next).collect()
}

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FilmKind {
    Mp4,
    Pictures,
}

impl FilmKind {
    fn from_path(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_deref().and_then(|ending| ending.to_str()) {
            Some("mp4") => Ok(Self::Mp4),
            None => Ok(Self::Pictures),
            Some(_) => Err(CliError::FilmKind { path: path.to_owned() }),
        }
    }
}

/// Draws and writes the film under a progress bar.
fn make(
    args: &FilmArgs,
    (kind, shown, timing): (FilmKind, ShownScene, FilmTiming),
    console: &Console<'_>,
) -> Result<(), CliError> {
    use crate::cli::console::under_bar;
    use impactlab_core::data::Outcome;
    use impactlab_draw::Canvas;
    use impactlab_draw::film::{write_film, write_frames};
    use impactlab_study::Event;

    let FilmArgs { size, scale, dark, .. } = *args;
    let scale = scale.map_or_else(|| Canvas::scene_scale(size), |scale| scale as f32);
    let canvas = Canvas { size_px: size, scale, dark };
    let mut film = Film { picture: shown.picture(), timing, canvas, keys: Vec::new() };
    film.keys = camera_keys(&args.key, &film);
    let existing = args.overwrite.into();
    let made = match kind {
        FilmKind::Mp4 => under_bar(|observer| {
            let mut report = |progress| observer(Event::Progress(progress));
            write_film(&film, &args.out, existing, &mut report)
        })?,
        FilmKind::Pictures => {
            let (folder, record) = console.begin_folder(&args.out, existing)?;
            let drawn = under_bar(|observer| {
                let mut report = |progress| observer(Event::Progress(progress));
                write_frames(&film, folder.staging(), &mut report)
            })?;
            if let Outcome::Complete(()) = drawn {
                folder.finish(record)?;
            }
            drawn
        }
    };
    made.complete().ok_or(CliError::Cancelled)
}
