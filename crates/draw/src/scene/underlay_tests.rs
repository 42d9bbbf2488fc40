use std::sync::Arc;

use egui::Color32;
use image::{Rgba, RgbaImage};

use crate::scene::{Camera, SceneCanvas, SceneLook, ViewKind};
use impactlab_core::site::{PixelMap, SiteOrigin, WorldFile};
use impactlab_document::scene::{AreaKind, GroundArea, GroundPicture, Scene, SceneGround};

const SIZE: [usize; 2] = [240, 160];

/// A picture of 120 x 80 pixels of 0.25 m, of which no two parts look alike, with its left top corner at
/// a place of a survey.
fn picture([easting_m, northing_m]: [f64; 2], origin: &SiteOrigin) -> GroundPicture {
    let image = RgbaImage::from_fn(120, 80, |x, y| {
        let check = if (x / 4 + y / 4) % 2 == 0 { 60 } else { 200 };
        Rgba([(2 * x) as u8, (3 * y) as u8, check, 255])
    });
    let world = WorldFile {
        per_column_m: [0.25, 0.0],
        per_row_m: [0.0, -0.25],
        first_pixel_m: [easting_m + 0.125, northing_m - 0.125],
    };
    GroundPicture::new(&image, PixelMap::from_world_file(&world, origin))
}

fn scene(ground: SceneGround) -> Arc<Scene> {
    Arc::new(Scene { ground: Some(Arc::new(ground)), ..Scene::default() })
}

fn drawn(scene: &Arc<Scene>, camera: Camera) -> Vec<Color32> {
    let mut canvas = SceneCanvas::default();
    let look = SceneLook { size_px: SIZE, camera, dark: false, pixels_per_point: 1.0 };
    canvas.draw(scene, &look, 0.0);
    canvas.pixels().to_vec()
}

fn cameras() -> [Camera; 3] {
    let above = Camera { target_m: [15.0, -10.0], distance_m: 34.0, ..Camera::default() };
    let oblique = Camera { kind: ViewKind::Perspective, ..above };
    [above, oblique, Camera { elevation_rad: 0.2, distance_m: 12.0, ..oblique }]
}

#[test]
fn large_survey_coordinates_give_the_same_picture_as_small_ones() {
    let far = [3_512_345.5, 5_423_456.25];
    let near = picture([0.0, 0.0], &SiteOrigin::default());
    let origin = SiteOrigin { survey_m: far, ..SiteOrigin::default() };
    let surveyed = picture(far, &origin);
    for camera in cameras() {
        let [a, b] = [&near, &surveyed].map(|picture| {
            let picture = Some(Arc::new(picture.clone()));
            drawn(&scene(SceneGround { picture, ..SceneGround::default() }), camera)
        });
        assert_eq!(a, b, "{camera:?}");
    }
}

#[test]
fn a_scene_that_lies_at_large_coordinates_itself_does_not_jitter() {
    // The same ground 3500 km away without an origin; the camera moves in steps of a hundredth of a pixel.
    let far = [3_500_000.0, 2_000_000.0];
    let [near_picture, far_picture] =
        [[0.0; 2], far].map(|place| Arc::new(picture(place, &SiteOrigin::default())));
    let zone = |[x, y]: [f64; 2]| GroundArea {
        name: "zone".to_owned(),
        kind: AreaKind::FrictionZone,
        border_m: [[2.0, -2.0], [18.0, -2.0], [18.0, -9.0], [2.0, -9.0]]
            .map(|[dx, dy]| [x + dx, y + dy])
            .to_vec(),
    };
    let ground = |picture: &Arc<GroundPicture>, at| {
        let (picture, areas) = (Some(Arc::clone(picture)), vec![zone(at)]);
        scene(SceneGround { picture, areas, ..SceneGround::default() })
    };
    let [near, there] = [ground(&near_picture, [0.0; 2]), ground(&far_picture, far)];
    for camera in cameras() {
        for step in 0..4 {
            let moved = |[x, y]: [f64; 2]| Camera {
                target_m: [x + camera.target_m[0] + 1e-3 * f64::from(step), y + camera.target_m[1]],
                ..camera
            };
            let [a, b] = [drawn(&near, moved([0.0; 2])), drawn(&there, moved(far))];
            let off = |(a, b): (&Color32, &Color32)| {
                [a.r().abs_diff(b.r()), a.g().abs_diff(b.g()), a.b().abs_diff(b.b())]
                    .into_iter()
                    .max()
            };
            let largest = a.iter().zip(&b).filter_map(off).max().unwrap();
            // A grid line or a hatch line may lie on the edge of a pixel.
            let n_off = a.iter().zip(&b).filter_map(off).filter(|off| *off > 8).count();
            assert!(n_off * 1000 < a.len(), "{camera:?} {step}: {n_off} pixels, up to {largest}");
        }
    }
}

#[test]
fn a_pixel_of_the_picture_is_drawn_where_it_lies() {
    let image = RgbaImage::from_fn(40, 30, |x, y| match (x, y) {
        (30, 6) => Rgba([255, 0, 0, 255]),
        _ => Rgba([0, 0, 0, 255]),
    });
    let map =
        PixelMap { corner_m: [-20.0, 15.0], per_column_m: [1.0, 0.0], per_row_m: [0.0, -1.0] };
    let picture = Some(Arc::new(GroundPicture::new(&image, map)));
    let scene = scene(SceneGround { picture, ..SceneGround::default() });
    for kind in [ViewKind::Above, ViewKind::Perspective] {
        let camera = Camera { kind, distance_m: 60.0, ..Camera::default() };
        let look = SceneLook { size_px: SIZE, camera, dark: false, pixels_per_point: 1.0 };
        let [px, py, _] = look.projection().project([10.5, 8.5, 0.0]).unwrap();
        let pixels = drawn(&scene, camera);
        let redness = |at: Color32| i32::from(at.r()) - i32::from(at.b());
        let (reddest, _) =
            pixels.iter().enumerate().max_by_key(|(_, pixel)| redness(**pixel)).unwrap();
        let found = [(reddest % SIZE[0]) as f64 + 0.5, (reddest / SIZE[0]) as f64 + 0.5];
        let off = (found[0] - px).hypot(found[1] - py);
        assert!(off < 3.0, "{kind:?}: drawn at {found:?}, expected at {px}, {py}");
    }
}

#[test]
fn a_fine_pattern_far_away_is_grey_and_does_not_flicker() {
    let checker = RgbaImage::from_fn(512, 512, |x, y| match (x + y) % 2 {
        0 => Rgba([255, 255, 255, 255]),
        _ => Rgba([0, 0, 0, 255]),
    });
    let map =
        PixelMap { corner_m: [-25.6, 25.6], per_column_m: [0.1, 0.0], per_row_m: [0.0, -0.1] };
    let picture = Some(Arc::new(GroundPicture::new(&checker, map)));
    let scene = scene(SceneGround { picture, ..SceneGround::default() });
    let mut before: Option<Color32> = None;
    for step in 0..10 {
        let target_m = [0.013 * f64::from(step), 0.0];
        let camera = Camera { target_m, distance_m: 60.0, ..Camera::default() };
        let pixels = drawn(&scene, camera);
        // Off the lines of the grid.
        let here = pixels[(SIZE[1] / 2 - 9) * SIZE[0] + SIZE[0] / 2 - 9];
        let is_steady = before.is_none_or(|before| before.r().abs_diff(here.r()) < 12);
        assert!(is_steady, "{before:?} {here:?}");
        before = Some(here);
    }
}

#[test]
fn zones_are_drawn_where_they_are_and_nowhere_else() {
    let border_m = vec![[-6.0, -4.0], [5.0, -4.0], [5.0, 3.0], [0.0, 0.5], [-6.0, 3.0]];
    let area = GroundArea { name: "ice".to_owned(), kind: AreaKind::FrictionZone, border_m };
    let holds = |at: [f64; 2]| {
        let sides = area.border_m.iter().zip(area.border_m.iter().cycle().skip(1));
        let crossed = sides.filter(|(a, b)| {
            (a[1] > at[1]) != (b[1] > at[1])
                && at[0] < a[0] + (at[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossed.count() % 2 == 1
    };
    let with = scene(SceneGround { areas: vec![area.clone()], ..SceneGround::default() });
    let without = Arc::new(Scene::default());
    for kind in [ViewKind::Above, ViewKind::Perspective] {
        let camera = Camera { kind, distance_m: 22.0, ..Camera::default() };
        let look = SceneLook { size_px: SIZE, camera, dark: false, pixels_per_point: 1.0 };
        let projection = look.projection();
        let corners: Vec<[f64; 2]> = area
            .border_m
            .iter()
            .map(|[x, y]| projection.project([*x, *y, 0.0]).unwrap())
            .map(|[x, y, _]| [x, y])
            .collect();
        let [a, b] = [&with, &without].map(|scene| drawn(scene, camera));
        let (mut n_inside, mut n_changed) = (0, 0);
        for (idx, (a, b)) in a.iter().zip(&b).enumerate() {
            let pixel = [(idx % SIZE[0]) as f64 + 0.5, (idx / SIZE[0]) as f64 + 0.5];
            // The border is a line of 1.6 pixels.
            let Some(at) = projection.ground_at(pixel) else { continue };
            if distance(&corners, pixel) < 2.5 {
                continue;
            }
            let is_inside = holds(at);
            n_inside += usize::from(is_inside);
            n_changed += usize::from(a != b);
            assert!(is_inside || a == b, "{kind:?} at {pixel:?}: {a:?} {b:?}");
        }
        assert!(n_inside > 2000, "{kind:?}: {n_inside}");
        // The lines of the grid are drawn over the zone.
        assert!(n_changed > n_inside * 9 / 10, "{kind:?}: {n_changed} of {n_inside}");
    }
}

/// Distance of a point from a border, pixels.
fn distance(corners: &[[f64; 2]], at: [f64; 2]) -> f64 {
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let of_side = |(a, b): (&[f64; 2], &[f64; 2])| {
        let way = [b[0] - a[0], b[1] - a[1]];
        let along = (at[0] - a[0]) * way[0] + (at[1] - a[1]) * way[1];
        let share = (along / (way[0] * way[0] + way[1] * way[1])).clamp(0.0, 1.0);
        (a[0] + share * way[0] - at[0]).hypot(a[1] + share * way[1] - at[1])
    };
    sides.map(of_side).fold(f64::INFINITY, f64::min)
}
