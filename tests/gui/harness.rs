//! Runs the app in a test, with its own state, without stored settings unless a file is given, and
//! with pixels from the software renderer.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::{Color32, Context, Event, FullOutput, Key, Modifiers, TexturesDelta};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, TestRenderer};
use image::RgbaImage;
use impactlab::app::{App, Command, State};
use impactlab_draw::SoftwareRenderer;

/// Longest time to wait for background work. Only work that hangs exceeds it.
const PATIENCE: Duration = Duration::from_secs(600);

/// Range of the pause between two frames while work is awaited.
const SHORTEST_PAUSE: Duration = Duration::from_millis(2);
const LONGEST_PAUSE: Duration = Duration::from_millis(100);

/// Colour that a real window shows where nothing is painted.
const WINDOW_GROUND: Color32 = Color32::BLACK;

#[derive(Default)]
struct SoftwareTestRenderer(SoftwareRenderer);

impl TestRenderer for SoftwareTestRenderer {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        self.0.update_textures(delta);
    }

    fn render(&mut self, context: &Context, output: &FullOutput) -> Result<RgbaImage, String> {
        let primitives = context.tessellate(output.shapes.clone(), output.pixels_per_point);
        let size = context.content_rect().size() * output.pixels_per_point;
        let size = [size.x.round() as u32, size.y.round() as u32];
        Ok(self.0.draw(&primitives, size, output.pixels_per_point, WINDOW_GROUND))
    }
}

/// What the app holds.
pub fn state<'a>(harness: &'a Harness<'_, App>) -> &'a State {
    harness.state().state()
}

/// Opens the app on these paths.
pub fn open(paths: &[&str]) -> Harness<'static, App> {
    open_with(paths, None)
}

/// Opens the app on these paths, with its state stored in a file, if there is one.
pub fn open_with(paths: &[&str], state_file: Option<PathBuf>) -> Harness<'static, App> {
    open_at(([1440.0, 900.0], 1.0), paths, state_file)
}

/// The same in a window of another size.
///
/// - `size`: width and height, points, and the pixels of a point.
pub fn open_at(
    (size, pixels_per_point): ([f32; 2], f32),
    paths: &[&str],
    state_file: Option<PathBuf>,
) -> Harness<'static, App> {
    let paths: Vec<PathBuf> = paths.iter().map(PathBuf::from).collect();
    Harness::builder()
        .with_size(size)
        .with_pixels_per_point(pixels_per_point)
        .with_step_dt(1.0 / 60.0)
        .renderer(SoftwareTestRenderer::default())
        .build_eframe(move |cc| App::new(cc, paths, state_file))
}

/// Time between two frames while work is awaited, over that which a frame takes: drawing without a
/// graphics card has a small share of a core, and the work that is awaited has the rest.
const PAUSE_PER_FRAME: u32 = 7;

/// Draws frames until the state fulfils a condition.
///
/// - `what`: what is awaited, for the message if it takes too long.
pub fn step_until(harness: &mut Harness<'_, App>, what: &str, wanted: impl Fn(&State) -> bool) {
    let start = Instant::now();
    while !wanted(harness.state().state()) {
        assert!(start.elapsed() < PATIENCE, "waited in vain for {what}");
        let frame = Instant::now();
        harness.step();
        std::thread::sleep(
            (frame.elapsed() * PAUSE_PER_FRAME).clamp(SHORTEST_PAUSE, LONGEST_PAUSE),
        );
    }
    for _ in 0..4 {
        harness.step();
    }
}

/// Whether the data are loaded and the selected subject has been simulated.
pub fn is_idle(state: &State) -> bool {
    state.session.sources.iter().all(impactlab::app::Source::is_settled)
        && state.session.analysis.question.is_some()
        && !state.session.analysis.is_waiting()
}

/// Whether the motion of what is idle is forecast as well.
pub fn is_forecast(state: &State) -> bool {
    let forecast = &state.session.response.forecast;
    is_idle(state) && forecast.ok().is_some() && !forecast.is_waiting()
}

/// Opens the app on a scenario and waits for a forecast of few draws, for what does not depend on how many there
/// are. The case is not as it was opened any more.
pub fn open_with_few_draws(path: &str) -> Harness<'static, App> {
    let mut harness = open(&[path]);
    step_until(&mut harness, "the simulation", is_idle);
    ask_few_draws(&mut harness);
    step_until(&mut harness, "the forecast", is_forecast);
    harness
}

/// Asks for the forecast with few draws from now on.
pub fn ask_few_draws(harness: &mut Harness<'_, App>) {
    harness.state_mut().state_mut().project.predict_motion.draws = 20;
    harness.run_steps(4);
}

/// Carries out a command as if the user had asked for it.
pub fn apply(harness: &mut Harness<'_, App>, command: Command) {
    let context = harness.ctx.clone();
    harness.state_mut().apply(command, &context);
    harness.step();
}

/// Types into the field with this name.
pub fn type_into(harness: &mut Harness<'_, App>, name: &str, text: &str) {
    harness.get_by_label(name).focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.key_press(Key::Delete);
    harness.run_steps(2);
    harness.event(Event::Text(text.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
}
