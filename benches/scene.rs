//! Measures how long the picture of a scene takes, on the processor and on the graphics processor, which
//! may be emulated in software: with the draws of a forecast as
//! ghosts and its density, at another time in every picture, and with another camera in every picture.
//!
//! `cargo bench --bench scene`

#![allow(clippy::print_stdout)]

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use cpu_time::{ProcessTime, ThreadTime};
use eframe::wgpu;
use impactlab_core::error_chain;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{
    ForecastScene, LoadedGround, Scene, SimulationScene, add_forecast, simulation_scene,
};
use impactlab_draw::scene::gpu::{GpuCanvas, SceneDevice};
use impactlab_draw::scene::{Camera, SceneCanvas, SceneLook, ViewKind};
use impactlab_study::analysis::DensityTask;
use impactlab_study::{ForceSource, Library, MotionSource, PredictMotionRequest, Question};

/// Size of a picture, pixels.
const SIZE: [usize; 2] = [1440, 900];
/// Ghosts in it.
const N_GHOSTS: usize = ForecastScene::N_GHOSTS;
/// Pictures of a measurement.
const N_PICTURES: usize = 200;

/// The scene of a shipped case with a forecast.
fn scene() -> Scene {
    let (dataset, case) = (PathBuf::from("datasets/trajectories-fea"), "FE_c002".to_owned());
    let source = MotionSource::Case { dataset, case };
    let request = PredictMotionRequest::new(source, ForceSource::Given);
    let answer = request
        .answer(&Library::default(), &mut |_| ControlFlow::Continue(()))
        .expect("a shipped case has a forecast")
        .complete()
        .expect("nothing cancels");
    let (caveats, units) = (Caveats::default(), UnitSystem::Si);
    let analysis = &answer.analysis;
    let input = SimulationScene { analysis, others: &[], units, caveats: &caveats };
    let mut scene = simulation_scene(&input);
    let density = Arc::new(DensityTask::new(&answer.forecast.distribution, [3.0; 2]).on_cpu());
    let forecast = &answer.forecast;
    let (density, n_ghosts) = (Some(&density), N_GHOSTS);
    add_forecast(
        &mut scene,
        &ForecastScene { analysis, forecast, density, until_s: f64::INFINITY, n_ghosts },
    );
    scene
}

/// What draws.
enum Canvas {
    Cpu(Box<SceneCanvas>),
    Gpu(Arc<SceneDevice>, Box<GpuCanvas>),
}

impl Canvas {
    fn new(device: Option<&Arc<SceneDevice>>) -> Self {
        match device {
            None => Self::Cpu(Box::default()),
            Some(on) => Self::Gpu(Arc::clone(on), Box::new(GpuCanvas::new(Arc::clone(on)))),
        }
    }

    /// Draws a picture and waits until it is there.
    ///
    /// - returns the time of this thread until it would wait, s: with a graphics processor, all that the
    ///   processor has to do.
    fn draw(&mut self, scene: &Arc<Scene>, look: &SceneLook, time_s: f64) -> f64 {
        let started = ThreadTime::now();
        match self {
            Self::Cpu(canvas) => {
                canvas.draw(scene, look, time_s);
                started.elapsed().as_secs_f64()
            }
            Self::Gpu(on, canvas) => {
                canvas.draw(scene, look, time_s).expect("it is drawn");
                let own_s = started.elapsed().as_secs_f64();
                on.device().poll(wgpu::PollType::wait_indefinitely()).expect("it waits");
                own_s
            }
        }
    }
}

/// Draws pictures and prints the time of one.
fn measure(
    name: &str,
    (scene, device): (&Arc<Scene>, Option<&Arc<SceneDevice>>),
    (kind, turns): (ViewKind, bool),
) {
    let fitted = Camera { kind, ..Camera::default() };
    let fitted = fitted.fitted(&scene.places_m(), SIZE.map(|side| side as f64));
    let mut canvas = Canvas::new(device);
    let picture = |idx: usize, canvas: &mut Canvas| {
        let share = idx as f64 / N_PICTURES as f64;
        let camera = match (turns, kind) {
            (false, _) => fitted,
            (true, ViewKind::Perspective) => fitted.orbited([0.5 * share, 0.0]),
            (true, ViewKind::Above) => {
                let [x, y] = fitted.target_m;
                Camera { target_m: [x + 5.0 * share, y], ..fitted }
            }
        };
        let look = SceneLook { size_px: SIZE, camera, dark: false, pixels_per_point: 1.0 };
        canvas.draw(scene, &look, 0.01 + 3.9 * share)
    };
    picture(0, &mut canvas);
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let (mut longest_s, mut own_s) = (0.0_f64, 0.0);
    for idx in 1..=N_PICTURES {
        let started = Instant::now();
        own_s += picture(idx, &mut canvas);
        longest_s = longest_s.max(started.elapsed().as_secs_f64());
    }
    let each = |seconds: f64| 1e3 * seconds / N_PICTURES as f64;
    let (wall_ms, cpu_ms) = (each(wall.elapsed().as_secs_f64()), each(cpu.elapsed().as_secs_f64()));
    println!(
        "{name:<32} {wall_ms:6.1} ms, {:5.0} pictures/s, longest {:5.1} ms, processor {cpu_ms:6.1} ms, \
         calling thread {:5.2} ms",
        1e3 / wall_ms,
        1e3 * longest_s,
        each(own_s),
    );
}

/// Both views of a scene, playing and with a camera that moves.
fn measure_views(scene: &Arc<Scene>, device: Option<&Arc<SceneDevice>>) {
    for (name, kind) in [("from above", ViewKind::Above), ("in perspective", ViewKind::Perspective)]
    {
        measure(&format!("{name}, playing"), (scene, device), (kind, false));
        measure(&format!("{name}, camera moves too"), (scene, device), (kind, true));
    }
}

fn main() {
    let scene = Arc::new(scene());
    let site = Path::new("assets/sites/country-road/site.toml");
    let loaded = LoadedGround::load(site).expect("a shipped site");
    let on_road = Arc::new(Scene { ground: Some(loaded.ground), ..(*scene).clone() });
    let device = SceneDevice::headless().map(Arc::new);
    if let Err(error) = &device {
        println!("no graphics device: {}", error_chain(error));
    }
    println!("{} x {} pixels, {N_GHOSTS} ghosts and a density", SIZE[0], SIZE[1]);
    for device in [None, device.as_ref().ok()].into_iter().take(1 + usize::from(device.is_ok())) {
        let name = device.map_or("the processor".to_owned(), |on| on.adapter_info().name);
        println!("on {name}");
        measure_views(&scene, device);
        println!("on {name}, over an orthophoto with zones and lanes");
        measure_views(&on_road, device);
    }
}
