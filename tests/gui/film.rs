//! Films of a scene: what is in the file is what the pictures show, and the window makes one.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use egui::{Color32, ColorImage};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use impactlab::app::{
    App, Command, FilmCommand, Output, Pane, PlaybackCommand, ReconstructionCommand,
};
use impactlab_core::data::{Existing, Outcome, Severity};
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};
use impactlab_core::units::UnitSystem;
use impactlab_document::scene::{FilmSection, FilmTiming, SimulationScene, simulation_scene};
use impactlab_draw::film::{Film, FilmError, FrameRenderer, write_film};
use impactlab_draw::scene::{Camera, CameraKey, Follow, SceneCourse, ScenePicture, ViewKind};
use impactlab_draw::{Canvas, theme};
use impactlab_study::{Library, MotionSource, Question, SimulateRequest};
use openh264::decoder::Decoder;
use openh264::formats::YUVSource;
use shiguredo_mp4::boxes::SampleEntry;
use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};

use crate::harness::{apply, is_idle, open, step_until};
use crate::pictures::save;
use crate::reconstruct::{EVIDENCE, evidence_in, is_answered, opened};

/// A small film of a shipped case, partly in slow motion.
fn film() -> Film {
    let dataset = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/trajectories-fea").into();
    let source = MotionSource::Case { dataset, case: "FE_c002".to_owned() };
    let request = SimulateRequest { vehicle_draws: Some(0), ..SimulateRequest::new(source) };
    let answer = request.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
    let answer = answer.expect("a shipped case is simulated").complete().expect("not cancelled");
    let scene = simulation_scene(&SimulationScene {
        analysis: &answer.analysis,
        others: &[],
        units: UnitSystem::Si,
        caveats: &Caveats::default(),
    });
    let timing = FilmTiming {
        frames_per_s: 10,
        from_s: 0.2,
        to_s: 1.5,
        sections: vec![FilmSection { from_s: 0.4, to_s: 0.5, speed: 0.25 }],
        ..FilmTiming::from_scene(&scene)
    };
    let picture = ScenePicture {
        scene: Arc::new(scene),
        courses: Vec::new(),
        time_s: 0.0,
        camera: Camera { kind: ViewKind::Perspective, ..Camera::default() },
        is_placed: false,
        seen_aspect: None,
        distance_m: None,
        follow: Follow::Struck,
    };
    let canvas = Canvas { size_px: [480, 270], scale: 1.0, dark: false };
    Film { picture, timing, canvas, keys: Vec::new() }
}

fn make(film: &Film, path: &Path) -> Result<Outcome<()>, FilmError> {
    write_film(film, path, Existing::Refuse, &mut |_| ControlFlow::Continue(()))
}

/// The frames of an MP4 file as red, green, blue and alpha, after a check of its table of frames.
fn decoded(path: &Path, frames_per_s: u32) -> Vec<Vec<u8>> {
    let file = std::fs::read(path).expect("the film is there");
    let mut demuxer = Mp4FileDemuxer::new();
    demuxer.handle_input(Input { position: 0, data: &file });
    let [track] = demuxer.tracks().expect("a track") else { panic!("one track") };
    assert_eq!(track.timescale.get(), frames_per_s);
    let mut decoder = Decoder::new().expect("a decoder");
    let mut frames: Vec<Vec<u8>> = Vec::new();
    let mut stream: Vec<u8> = Vec::new();
    while let Some(sample) = demuxer.next_sample().expect("a whole table of frames") {
        assert_eq!((sample.timestamp, sample.duration), (frames.len() as u64, 1));
        assert_eq!(sample.keyframe, frames.len().is_multiple_of(frames_per_s as usize));
        stream.clear();
        if let Some(SampleEntry::Avc1(entry)) = sample.sample_entry {
            for set in entry.avcc_box.sps_list.iter().chain(&entry.avcc_box.pps_list) {
                stream.extend([0, 0, 0, 1]);
                stream.extend(set);
            }
        }
        let start = sample.data_offset as usize;
        let mut rest = &file[start..start + sample.data_size];
        while let Some((length, behind)) = rest.split_first_chunk::<4>() {
            let (unit, next) = behind.split_at(u32::from_be_bytes(*length) as usize);
            stream.extend([0, 0, 0, 1]);
            stream.extend(unit);
            rest = next;
        }
        let frame = decoder.decode(&stream).expect("H.264").expect("a frame for every sample");
        let (width, height) = frame.dimensions();
        let mut pixels = vec![0; 4 * width * height];
        frame.write_rgba8(&mut pixels);
        frames.push(pixels);
    }
    frames
}

/// Mean difference of the colours of two pictures, of 255.
fn difference(decoded: &[u8], drawn: &ColorImage) -> f64 {
    let drawn = drawn.as_raw();
    assert_eq!(decoded.len(), drawn.len());
    let sum: f64 = decoded.iter().zip(drawn).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    sum / drawn.len() as f64
}

#[test]
fn every_frame_is_the_picture_of_its_instant() {
    let (folder, film) = (tempfile::tempdir().expect("a folder"), film());
    let path = folder.path().join("film.mp4");
    assert!(matches!(make(&film, &path), Ok(Outcome::Complete(()))));
    let instants = film.instants().expect("a possible film");
    // 0.2 s, 0.1 s at a quarter of the speed, 1 s: 1.6 s.
    assert_eq!(instants.len(), 17);
    let frames = decoded(&path, 10);
    assert_eq!(frames.len(), instants.len());
    let drawn: Vec<ColorImage> = instants
        .iter()
        .map(|instant| {
            let picture = ScenePicture { time_s: instant.time_s, ..film.picture.clone() };
            let mut renderer = FrameRenderer::new(film.canvas).expect("a possible size");
            renderer.draw(&picture, instant.speed).clone()
        })
        .collect();
    for (idx, frame) in frames.iter().enumerate() {
        let own = difference(frame, &drawn[idx]);
        let other = difference(frame, &drawn[(idx + 5) % drawn.len()]);
        assert!(
            own < 2.5 && other > 1.5 * own,
            "frame {idx}: {own} of its own, {other} of another"
        );
    }
}

#[test]
fn the_camera_of_a_film_moves_from_key_to_key() {
    let (folder, mut film) = (tempfile::tempdir().expect("a folder"), film());
    let far = Camera { target_m: [5.0, 0.0], distance_m: 90.0, ..film.picture.camera };
    let near = Camera { distance_m: 15.0, azimuth_rad: 0.5, ..far };
    let (first, last) = (Follow::Nothing, Follow::Struck);
    film.keys = vec![CameraKey::new(0.2, &far, first), CameraKey::new(1.4, &near, last)];
    let path = folder.path().join("film.mp4");
    assert!(matches!(make(&film, &path), Ok(Outcome::Complete(()))));
    let frames = decoded(&path, 10);
    let drawn = |time_s: f64, (camera, follow): (Camera, Follow)| {
        let picture = &film.picture;
        let picture = ScenePicture { time_s, camera, follow, is_placed: true, ..picture.clone() };
        let mut renderer = FrameRenderer::new(film.canvas).expect("a possible size");
        renderer.draw(&picture, 1.0).clone()
    };
    let ends = [(frames.first(), 0.2), (frames.last(), 1.5)];
    let cameras = [(far, first), (near, last)];
    for (idx, (frame, time_s)) in ends.into_iter().enumerate() {
        let frame = frame.expect("frames");
        let own = difference(frame, &drawn(time_s, cameras[idx]));
        let other = difference(frame, &drawn(time_s, cameras[1 - idx]));
        assert!(own < 2.5 && other > 1.5 * own, "{time_s} s: {own} of its own, {other} of another");
    }
    film.keys.reverse();
    let error = film.instants().expect_err("keys out of order").to_string();
    assert!(error.contains("expected keys in the order of time"), "{error}");
    film.keys = vec![CameraKey::new(2.0, &far, first)];
    let error = film.instants().expect_err("a key after the film").to_string();
    assert!(error.contains("expected times between 0.200 s and 1.500 s"), "{error}");
}

/// Rows of a picture in which the scene reaches the left and the right edge, which no text does.
fn scene_rows(image: &ColorImage, background: Color32) -> Vec<usize> {
    let rows = image.pixels.chunks_exact(image.size[0]).enumerate();
    let is_scene =
        |row: &[Color32]| row.first() != Some(&background) && row.last() != Some(&background);
    rows.filter(|(_, row)| is_scene(row)).map(|(idx, _)| idx).collect()
}

#[test]
fn the_scene_goes_from_edge_to_edge_and_its_text_does_not_move() {
    let mut film = film();
    let sentence =
        "a sentence that is longer than a small frame is wide, and stands in one line of it";
    let kinds = [CaveatKind::WheelLift, CaveatKind::Overlap, CaveatKind::NotAtRest];
    let scene = Arc::make_mut(&mut film.picture.scene);
    scene.caveats = kinds.map(|kind| Caveat::new(kind, sentence)).into_iter().collect();
    for (size_px, least_share, dark) in [
        ([1920, 1080], 0.88, false),
        ([1920, 1080], 0.88, true),
        ([1280, 720], 0.88, false),
        ([320, 240], 0.72, false),
    ] {
        let canvas = Canvas { size_px, scale: Canvas::scene_scale(size_px), dark };
        let background = if dark { Color32::from_gray(27) } else { Color32::WHITE };
        let warning = theme::severity_color(Severity::Warning, dark);
        let mut renderer = FrameRenderer::new(canvas).expect("a possible size");
        let mut rows: Option<Vec<usize>> = None;
        for (time_s, speed) in [(0.2, 1.0), (0.45, 0.25), (1.5, 1.0)] {
            let picture = ScenePicture { time_s, ..film.picture.clone() };
            let image = renderer.draw(&picture, speed).clone();
            let own = scene_rows(&image, background);
            let share = own.len() as f64 / f64::from(size_px[1]);
            assert!(share > least_share, "{size_px:?}: {share}");
            let below = own.last().expect("a scene") + 1;
            let foot = image.pixels.iter().skip(below * image.size[0]);
            let n_warning = foot.filter(|pixel| **pixel == warning).count();
            assert!(n_warning > 10, "{size_px:?}, dark {dark}: {n_warning} pixels of a warning");
            assert_eq!(*rows.get_or_insert_with(|| own.clone()), own, "{size_px:?} at {time_s} s");
        }
    }
}

#[test]
fn courses_of_events_stand_side_by_side_with_their_probabilities() {
    let film = film();
    let course =
        |name: &str| SceneCourse { name: name.to_owned(), scene: Arc::clone(&film.picture.scene) };
    let drawn = |courses: Vec<SceneCourse>| {
        let picture = ScenePicture { time_s: 0.5, courses, ..film.picture.clone() };
        let mut renderer = FrameRenderer::new(film.canvas).expect("a possible size");
        renderer.draw(&picture, 1.0).clone()
    };
    let image = drawn(vec![course("62 %: it spins"), course("38 %: it slides off")]);
    let rows = scene_rows(&image, Color32::WHITE);
    // Two scenes of 239 pixels with 2 between them.
    let pair = |row: &usize| {
        let row = &image.pixels[480 * row..480 * (row + 1)];
        row[..239].iter().zip(&row[241..]).filter(|(a, b)| a != b).count()
    };
    let n_other: usize = rows.iter().map(pair).sum();
    assert!((50..2500).contains(&n_other), "{n_other} pixels differ by more than the names");
    let alone = drawn(Vec::new());
    assert!(alone.pixels != image.pixels);
}

#[test]
fn the_same_film_gives_the_same_bytes() {
    let (folder, film) = (tempfile::tempdir().expect("a folder"), film());
    let [a, b] = ["a.mp4", "b.mp4"].map(|name| folder.path().join(name));
    for path in [&a, &b] {
        assert!(matches!(make(&film, path), Ok(Outcome::Complete(()))));
    }
    assert!(std::fs::read(a).expect("a film") == std::fs::read(b).expect("a film"));
}

#[test]
fn a_cancelled_film_leaves_no_file_and_an_existing_one_stays() {
    let (folder, film) = (tempfile::tempdir().expect("a folder"), film());
    let path = folder.path().join("film.mp4");
    let cancelled = write_film(&film, &path, Existing::Refuse, &mut |progress| {
        assert_eq!(progress.total, 17);
        if progress.done == 4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(cancelled, Ok(Outcome::Cancelled)));
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);

    std::fs::write(&path, "mine").expect("a file");
    let mut n_frames = 0;
    let refused = write_film(&film, &path, Existing::Refuse, &mut |_| {
        n_frames += 1;
        ControlFlow::Continue(())
    });
    assert!(refused.is_err_and(|error| error.to_string().contains("exists already")));
    assert_eq!((n_frames, std::fs::read(&path).expect("a file")), (0, b"mine".to_vec()));
    let cancelled = write_film(&film, &path, Existing::Replace, &mut |_| ControlFlow::Break(()));
    assert!(matches!(cancelled, Ok(Outcome::Cancelled)));
    assert_eq!(std::fs::read(&path).expect("a file"), b"mine");
}

#[test]
fn sizes_that_no_film_has_are_refused() {
    let film = film();
    for (size_px, part) in [
        ([481, 270], "481 × 270 pixels, expected even numbers"),
        ([480, 271], "expected even numbers"),
        ([16, 270], "film side is 16, expected 64 to 3840"),
        ([4096, 270], "film side is 4096, expected 64 to 3840"),
        ([3840, 3840], "film side is 3840, expected 64 to 2160"),
    ] {
        let canvas = Canvas { size_px, ..film.canvas };
        let error = Film { canvas, ..film.clone() }.instants().expect_err("no such film");
        assert!(error.to_string().contains(part), "{size_px:?}: {error}");
    }
}

/// Opens the form by the menu of the scene that is shown.
pub fn ask_film(harness: &mut Harness<'_, App>) {
    // Every pane with a figure has a menu of this name.
    for idx in 0..harness.get_all_by_label("Export").count() {
        harness.get_all_by_label("Export").nth(idx).expect("a menu").click();
        harness.run_steps(3);
        if harness.query_by_label_contains("Save film (MP4)").is_some() {
            break;
        }
    }
    harness.get_by_label_contains("Save film (MP4)").click();
    harness.run_steps(3);
}

/// The latest message.
fn last_message(harness: &Harness<'_, App>) -> Option<String> {
    harness.state().state().session.messages.last().map(|message| message.text.clone())
}

/// The film that the form asks about.
pub fn film_of_form(harness: &Harness<'_, App>) -> Film {
    harness.state().state().session.dialogs.film().expect("the form is open").film.clone()
}

#[test]
fn the_window_films_the_cars_of_a_reconstruction() {
    let folder = tempfile::tempdir().expect("a folder");
    let evidence = evidence_in(folder.path());
    let mut harness = open(&[evidence.to_str().expect("a plain name")]);
    harness.run_steps(4);
    harness.state_mut().state_mut().project.reconstruct.as_mut().expect("evidence").particles = 60;
    harness.state_mut().state_mut().view.reconstruction.shows_cars = true;
    harness.run_steps(4);
    // Nothing moves before the evidence has been reconstructed.
    ask_film(&mut harness);
    assert!(harness.query_by_label_contains("nothing to film").is_some());
    apply(&mut harness, Command::CloseDialog);
    assert!(harness.state().state().session.dialogs.film().is_none());

    harness.get_by_label("Run").click();
    harness.run_steps(4);
    step_until(&mut harness, "the speeds", |state| {
        let of = &state.session.reconstruction;
        !of.run.is_running() && of.answer().is_some()
    });
    harness.run_steps(4);
    ask_film(&mut harness);
    save(&mut harness, "film-form-reconstruction.png");
    let mut film = film_of_form(&harness);
    let scene = &film.picture.scene;
    assert_eq!(scene.title, "spin");
    assert!(scene.struck().is_some(), "the car drives");
    assert_eq!([film.timing.from_s, film.timing.to_s], [0.0, scene.end_s]);
    assert!(!scene.caveats.restrictions().is_empty(), "few particles are a restriction");

    (film.canvas.size_px, film.timing.to_s) = ([320, 180], 0.3);
    let n_frames = film.instants().expect("a possible film").len();
    let path = folder.path().join("film.mp4");
    apply(&mut harness, Command::Write(Output::Film(Box::new(film.clone())), path.clone()));
    step_until(&mut harness, "the film", |state| state.session.tasks.film().is_none());
    assert_eq!(decoded(&path, 30).len(), n_frames);
    assert!(last_message(&harness).is_some_and(|text| text.ends_with("film.mp4 written")));

    cancel_a_long_one(&mut harness, film, &folder.path().join("other.mp4"));
}

#[test]
fn courses_of_events_of_a_reconstruction_are_seen_and_filmed_side_by_side() {
    // Without the recorder, and with wheels at which nobody looked, much is possible.
    let known = "[after]\nblocked_wheels = []\n[edr]\nspeed_before_m_s = 17\n";
    let text = EVIDENCE.replace(known, "");
    assert_ne!(text, EVIDENCE);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("evidence.toml");
    std::fs::write(&path, text).expect("a file");
    let mut harness = opened(&path, [2400.0, 1400.0], 60);
    harness.get_by_label("Run").click();
    harness.run_steps(4);
    step_until(&mut harness, "the speeds", is_answered);
    harness.get_by_label("Cars").click();
    harness.run_steps(4);
    let of = |harness: &Harness<'_, App>| -> (Vec<String>, f64) {
        let courses = harness.state().state().session.reconstruction.courses();
        let ends_s = courses
            .iter()
            .filter_map(|(_, paths)| Some(paths.median.as_ref()?.path.points.last()?.time_s));
        let end_s = ends_s.fold(0.0, f64::max);
        (courses.into_iter().map(|(title, _)| title).collect(), end_s)
    };
    let (titles, end_s) = of(&harness);
    assert!(titles.len() > 1, "{titles:?}");
    assert_eq!(harness.state().state().end_time_s(), end_s, "one clock for the longest of them");
    apply(&mut harness, Command::Playback(PlaybackCommand::SetTime(1.5)));
    harness.run_steps(3);
    save(&mut harness, "reconstruct-courses.png");
    let place = |harness: &Harness<'_, App>, title: &str| {
        assert!(title.contains(" % ± "), "{title}");
        harness.get_by_label(&format!("Picture of the scene: {title}")).rect()
    };
    let places: Vec<egui::Rect> = titles.iter().map(|title| place(&harness, title)).collect();
    let is_as_large = |other: &egui::Rect| (other.size() - places[0].size()).length() < 0.2;
    assert!(places.iter().all(is_as_large), "{places:?}");

    // The mouse over one of them moves the camera of all, which the film takes over.
    let camera = |harness: &Harness<'_, App>| {
        harness.state().state().session.reconstruction.cars.courses_view.moved_camera()
    };
    assert_eq!(camera(&harness), None);
    harness.hover_at(places[1].center());
    harness.run_steps(2);
    harness.key_press(egui::Key::Plus);
    harness.run_steps(3);
    let moved = camera(&harness).expect("the camera was moved");
    ask_film(&mut harness);
    let film = film_of_form(&harness);
    let filmed: Vec<&String> = film.picture.courses.iter().map(|course| &course.name).collect();
    assert_eq!(filmed, titles.iter().collect::<Vec<_>>());
    assert!(film.picture.is_placed && film.picture.camera == moved);
    assert!((film.timing.to_s - end_s).abs() < 1e-9, "{} of {end_s} s", film.timing.to_s);
    assert!(film.picture.courses.iter().all(|course| course.scene.struck().is_some()));
    apply(&mut harness, Command::CloseDialog);

    // One scene of all of them, or one of them alone.
    harness.get_by_label("Courses side by side").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("Picture of the scene").is_some());
    harness.get_by_label("Courses side by side").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("Picture of the scene").is_none());
    apply(&mut harness, Command::Reconstruct(ReconstructionCommand::ShowMode(Some(1))));
    harness.run_steps(4);
    assert!(harness.query_by_label("Picture of the scene").is_some());
    assert!(harness.query_by_label("Courses side by side").is_none());
    // Where there is no room they share one scene.
    apply(&mut harness, Command::Reconstruct(ReconstructionCommand::ShowMode(None)));
    harness.set_size(egui::vec2(700.0, 460.0));
    harness.run_steps(6);
    assert!(harness.query_by_label_contains("Picture of the scene: ").is_none());
}

/// Begins a film that takes long and cancels it, after which nothing of it is left.
fn cancel_a_long_one(harness: &mut Harness<'_, App>, mut film: Film, path: &Path) {
    film.canvas.size_px = [1920, 1080];
    film.timing = FilmTiming { frames_per_s: 120, ..FilmTiming::from_scene(&film.picture.scene) };
    apply(harness, Command::Write(Output::Film(Box::new(film)), path.to_owned()));
    harness.run_steps(2);
    apply(harness, Command::Film(FilmCommand::Cancel));
    step_until(harness, "the end of the film", |state| state.session.tasks.film().is_none());
    assert!(last_message(harness).is_some_and(|text| text.ends_with("not written: cancelled")));
    assert!(!path.exists());
}

#[test]
fn the_window_makes_a_film_of_the_scene_as_it_is_seen() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("film.mp4");
    let mut harness = open(&[concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/fea")]);
    step_until(&mut harness, "the first case", is_idle);
    apply(&mut harness, Command::Show(Pane::Scene));
    harness.run_steps(4);
    ask_film(&mut harness);
    harness.get_by_label("Add slow motion").click();
    harness.run_steps(3);
    save(&mut harness, "film-form.png");
    let form = film_of_form(&harness);
    assert_eq!(form.timing.sections.len(), 1);
    assert!(form.picture.is_placed, "the camera is the one that is seen");
    harness.get_by_label("Remove part 1").click();
    harness.run_steps(3);

    let mut film = form;
    (film.canvas.size_px, film.timing.to_s) = ([320, 180], 0.5);
    film.timing.sections.clear();
    let n_frames = film.instants().expect("a possible film").len();
    apply(&mut harness, Command::Write(Output::Film(Box::new(film.clone())), path.clone()));
    let session = &harness.state().state().session;
    assert!(session.tasks.film().is_some() && session.dialogs.film().is_none());
    step_until(&mut harness, "the film", |state| state.session.tasks.film().is_none());
    assert_eq!(decoded(&path, 30).len(), n_frames);
    assert!(last_message(&harness).is_some_and(|text| text.ends_with("film.mp4 written")));

    // A film that exists already is asked about, and a cancelled one is not written.
    apply(&mut harness, Command::Write(Output::Film(Box::new(film.clone())), path));
    assert!(harness.state().state().session.dialogs.replacing().is_some());
    apply(&mut harness, Command::CloseDialog);
    cancel_a_long_one(&mut harness, film, &folder.path().join("other.mp4"));
}
