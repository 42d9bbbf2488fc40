//! A scene must look the same on the graphics processor as on the processor.
//!
//! The tests need a graphics driver, for which a software implementation suffices
//! (`mesa-vulkan-drivers`). Without one they print that nothing was compared and pass, unless
//! `IMPACTLAB_REQUIRE_GPU` is set. Where pictures differ, both are kept below
//! `target/tmp/scene-gpu`.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Color32;
use image::{Rgba, RgbaImage};
use impactlab_core::error_chain;
use impactlab_core::site::PixelMap;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{
    ForecastScene, GroundPicture, LoadedGround, Scene, SceneGround, SimulationScene, add_forecast,
    simulation_scene,
};
use impactlab_draw::GpuError;
use impactlab_draw::scene::gpu::{GpuCanvas, SceneDevice};
use impactlab_draw::scene::{Camera, SceneCanvas, SceneLook, ViewKind};
use impactlab_study::analysis::DensityTask;
use impactlab_study::{ForceSource, Library, MotionSource, PredictMotionRequest, Question};

use crate::snapshots::braked_pit;

const SIZE: [usize; 2] = [640, 400];
const ROAD: &str = "assets/sites/country-road/site.toml";

/// Largest mean difference of a channel, of 255: colours are rounded differently where they are mixed.
const MEAN: f64 = 1.5;
/// Difference of a channel from which a pixel counts as another one, of 255, and the largest share of
/// such pixels: those at the edges of triangles.
const LARGE: u8 = 24;
const SHARE: f64 = 0.001;

#[expect(clippy::print_stdout, reason = "a test that compares nothing says so")]
fn device() -> Option<Arc<SceneDevice>> {
    let may_lack = std::env::var_os("IMPACTLAB_REQUIRE_GPU").is_none();
    match SceneDevice::headless() {
        Ok(device) => Some(Arc::new(device)),
        Err(error @ GpuError::NoAdapter(_)) if may_lack => {
            println!("nothing was compared: {}", error_chain(&error));
            None
        }
        Err(error) => panic!("{}", error_chain(&error)),
    }
}

/// A shipped case with 30 draws of its forecast and the density of where it ends.
fn forecast_scene() -> Scene {
    let (dataset, case) = (PathBuf::from("datasets/trajectories-fea"), "FE_c002".to_owned());
    let source = MotionSource::Case { dataset, case };
    let request = PredictMotionRequest::new(source, ForceSource::Given);
    let answer = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
    let answer = answer.expect("a shipped case has a forecast").complete().expect("not cancelled");
    let (caveats, analysis) = (Caveats::default(), &answer.analysis);
    let input = SimulationScene { analysis, others: &[], units: UnitSystem::Si, caveats: &caveats };
    let mut scene = simulation_scene(&input);
    let density = Arc::new(DensityTask::new(&answer.forecast.distribution, [1.0; 2]).on_cpu());
    let (forecast, density) = (&answer.forecast, Some(&density));
    add_forecast(
        &mut scene,
        &ForecastScene { analysis, forecast, density, until_s: f64::INFINITY, n_ghosts: 30 },
    );
    scene
}

/// A struck car that is braked: marks of tires, dented outlines, locked wheels.
fn braked_scene() -> Scene {
    let (analysis, caveats) = (braked_pit(), Caveats::default());
    let units = UnitSystem::Us;
    simulation_scene(&SimulationScene {
        analysis: &analysis,
        others: &[],
        units,
        caveats: &caveats,
    })
}

fn road() -> SceneGround {
    let loaded = LoadedGround::load(Path::new(ROAD)).expect("a shipped site");
    Arc::unwrap_or_clone(loaded.ground)
}

fn look_at(scene: &Scene, kind: ViewKind, dark: bool) -> SceneLook {
    let camera = Camera { kind, ..Camera::default() };
    let camera = camera.fitted(&scene.places_m(), SIZE.map(|side| side as f64));
    SceneLook { size_px: SIZE, camera, dark, pixels_per_point: 1.0 }
}

/// The pictures of the processor and of the graphics processor.
fn both(
    (cpu, gpu): (&mut SceneCanvas, &mut GpuCanvas),
    scene: &Arc<Scene>,
    (look, time_s): (&SceneLook, f64),
) -> [Vec<Color32>; 2] {
    cpu.draw(scene, look, time_s);
    gpu.draw(scene, look, time_s).expect("it is drawn");
    let mut pixels = Vec::new();
    gpu.read(&mut pixels).expect("it is read");
    [cpu.pixels().to_vec(), pixels]
}

fn save(pixels: &[Color32], [width, height]: [usize; 2], name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scene-gpu");
    std::fs::create_dir_all(&folder).expect("a folder");
    let bytes = pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
    let image = image::RgbImage::from_raw(width as u32, height as u32, bytes).expect("its size");
    let path = folder.join(name);
    image.save(&path).expect("a picture");
    path
}

/// Mean difference of a channel, and share of pixels that are another.
fn difference([a, b]: &[Vec<Color32>; 2]) -> (f64, f64) {
    assert_eq!(a.len(), b.len());
    let (mut sum, mut n_other) = (0_u64, 0_usize);
    for (a, b) in a.iter().zip(b) {
        let channels = [(a.r(), b.r()), (a.g(), b.g()), (a.b(), b.b())];
        let away = channels.map(|(a, b)| a.abs_diff(b));
        sum += away.iter().map(|value| u64::from(*value)).sum::<u64>();
        n_other += usize::from(away.iter().any(|value| *value >= LARGE));
    }
    (sum as f64 / (3 * a.len()) as f64, n_other as f64 / a.len() as f64)
}

fn compare(pictures: &[Vec<Color32>; 2], size: [usize; 2], name: &str) {
    let (mean, share) = difference(pictures);
    let [cpu, gpu] = pictures;
    let first = gpu.first().copied().unwrap_or_default();
    assert!(gpu.iter().any(|pixel| *pixel != first), "{name}: an empty picture");
    if mean > MEAN || share > SHARE {
        let reused = save(gpu, size, &format!("{name}-gpu.png"));
        save(cpu, size, &format!("{name}-cpu.png"));
        panic!("{name}: mean {mean:.3}, others {share:.5}: {}", reused.display());
    }
}

#[test]
fn a_scene_looks_the_same_on_both() {
    let Some(device) = device() else { return };
    let (forecast, braked) = (forecast_scene(), braked_scene());
    let road = road();
    let on_road = Scene { ground: Some(Arc::new(road.clone())), ..braked.clone() };
    let lanes = SceneGround { picture: None, ..road };
    let on_lanes = Scene { ground: Some(Arc::new(lanes)), ..forecast.clone() };
    let scenes =
        [("forecast", forecast), ("braked", braked), ("road", on_road), ("lanes", on_lanes)];
    let (mut cpu, mut gpu) = (SceneCanvas::default(), GpuCanvas::new(device));
    for (name, scene) in scenes {
        let scene = Arc::new(scene);
        for (kind, view) in [(ViewKind::Above, "above"), (ViewKind::Perspective, "perspective")] {
            for (dark, theme) in [(false, "light"), (true, "dark")] {
                let look = look_at(&scene, kind, dark);
                for time_s in [0.0, 0.09, 2.2] {
                    let pictures = both((&mut cpu, &mut gpu), &scene, (&look, time_s));
                    compare(&pictures, SIZE, &format!("{name}-{view}-{theme}-{time_s}"));
                }
            }
        }
    }
}

#[test]
fn a_camera_close_to_a_car_and_one_far_off_see_the_same_on_both() {
    let Some(device) = device() else { return };
    let scene = Arc::new(Scene { ground: Some(Arc::new(road())), ..braked_scene() });
    let (mut cpu, mut gpu) = (SceneCanvas::default(), GpuCanvas::new(device));
    for kind in [ViewKind::Above, ViewKind::Perspective] {
        for distance_m in [9.0, 400.0, 4000.0] {
            for elevation_rad in [0.05, 0.9] {
                let mut look = look_at(&scene, kind, false);
                (look.camera.distance_m, look.camera.elevation_rad) = (distance_m, elevation_rad);
                let pictures = both((&mut cpu, &mut gpu), &scene, (&look, 1.2));
                compare(&pictures, SIZE, &format!("{kind:?}-{distance_m}-{elevation_rad}"));
            }
        }
    }
}

#[test]
fn what_is_kept_does_not_show() {
    let Some(device) = device() else { return };
    let scene = Arc::new(Scene { ground: Some(Arc::new(road())), ..braked_scene() });
    let other = Arc::new(forecast_scene());
    let mut reused = GpuCanvas::new(Arc::clone(&device));
    let looks = [ViewKind::Above, ViewKind::Perspective].map(|kind| look_at(&scene, kind, false));
    let small = SceneLook { size_px: [333, 219], ..looks[0] };
    let steps = [
        (&scene, looks[0], 0.5),
        (&scene, looks[0], 2.0),
        (&scene, looks[0], 0.5),
        (&other, looks[0], 0.5),
        (&other, small, 1.5),
        (&scene, looks[1], 1.5),
    ];
    for (scene, look, time_s) in steps {
        let mut fresh = GpuCanvas::new(Arc::clone(&device));
        let [mut from_reused, mut from_fresh] = [Vec::new(), Vec::new()];
        assert!(reused.draw(scene, &look, time_s).expect("it is drawn"));
        assert!(!reused.draw(scene, &look, time_s).expect("it is drawn"), "nothing has changed");
        reused.read(&mut from_reused).expect("it is read");
        fresh.draw(scene, &look, time_s).expect("it is drawn");
        fresh.read(&mut from_fresh).expect("it is read");
        assert!(from_reused == from_fresh, "{look:?} at {time_s} s");
    }
}

/// A picture of the ground that is too large for the device is drawn on the processor, and leaves no
/// trace in the scenes after it.
#[test]
fn a_ground_that_is_too_large_for_the_device_is_drawn_too() {
    let Some(device) = device() else { return };
    let side = device.device().limits().max_texture_dimension_2d + 1;
    let (forecast, mut wide) = (Arc::new(forecast_scene()), braked_scene());
    let stripes = RgbaImage::from_fn(side, 8, |x, _| Rgba([(x / 64 % 2 * 90) as u8, 80, 60, 255]));
    let (per_column_m, per_row_m) = ([100.0 / f64::from(side), 0.0], [0.0, -2.0]);
    let map = PixelMap { corner_m: [-20.0, 8.0], per_column_m, per_row_m };
    let picture = Some(Arc::new(GroundPicture::new(&stripes, map)));
    wide.ground = Some(Arc::new(SceneGround { picture, ..SceneGround::default() }));
    // The density is another one in the picture that the device refuses.
    wide.density.clone_from(&forecast.density);
    let (wide, look) = (Arc::new(wide), look_at(&forecast, ViewKind::Above, false));
    let bare = Arc::new(braked_scene());
    let (mut cpu, mut gpu) = (SceneCanvas::default(), GpuCanvas::new(device));
    for (name, scene) in
        [("bare", &bare), ("wide", &wide), ("after", &forecast), ("wide-2", &wide), ("end", &bare)]
    {
        let pictures = both((&mut cpu, &mut gpu), scene, (&look, 1.0));
        compare(&pictures, SIZE, name);
    }
}

#[test]
fn what_is_too_large_for_the_device_is_said() {
    let Some(device) = device() else { return };
    let scene = Arc::new(braked_scene());
    let look = look_at(&scene, ViewKind::Above, false);
    let most = device.device().limits().max_texture_dimension_2d as usize;
    let mut canvas = GpuCanvas::new(device);
    let wide = SceneLook { size_px: [most, 16], ..look };
    assert!(matches!(canvas.draw(&scene, &wide, 0.0), Err(GpuError::Limit { .. })));
    assert!(canvas.draw(&scene, &look, 0.0).expect("it is drawn"), "it goes on after that");
}
