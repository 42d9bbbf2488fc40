//! Measures how long the window takes to prepare a frame on the processor, at rest and while a
//! network is trained in the background. The time covers logic, layout, prediction and
//! tessellation, but not the work of the graphics processor.
//!
//! `cargo bench --bench window`

#![allow(clippy::print_stdout)]

use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use impactlab::app::{App, Command, Network, Pane, Source, State, TrainingCommand, collision_of};
use impactlab_networks::force::ForceScenario;
use impactlab_networks::learning::TrainingReport;

/// Time between two frames of a display at 60 Hz.
const FRAME: Duration = Duration::from_micros(16_667);
/// Duration above which a frame counts as late: fewer than 50 frames a second are then drawn.
const LATE: Duration = Duration::from_millis(20);
/// Number of frames of a measurement.
const N_FRAMES: u32 = 600;
/// Number of changes whose answers are awaited in a measurement.
const N_ANSWERS: u32 = 100;

/// The application in a test harness.
struct Window(Harness<'static, App>);

impl Window {
    /// Opens the window on the shipped force data.
    fn open() -> Self {
        let builder = Harness::builder().with_size([1440.0, 900.0]).with_step_dt(1.0 / 60.0);
        let paths: Vec<PathBuf> = vec!["datasets/fea".into()];
        Self(builder.build_eframe(move |cc| App::new(cc, paths, None)))
    }

    fn state(&self) -> &State {
        self.0.state().state()
    }

    fn apply(&mut self, command: Command) {
        let context = self.0.ctx.clone();
        self.0.state_mut().apply(command, &context);
        self.frame();
    }

    /// Draws frames until a condition on the state holds.
    fn step_until(&mut self, is_so: impl Fn(&State) -> bool) {
        while !is_so(self.state()) {
            self.frame();
            std::thread::sleep(FRAME);
        }
    }

    /// Draws a frame and returns the time that it took.
    fn frame(&mut self) -> Duration {
        let started = Instant::now();
        self.0.step();
        let output = self.0.output();
        let primitives = self.0.ctx.tessellate(output.shapes.clone(), output.pixels_per_point);
        std::hint::black_box(primitives);
        started.elapsed()
    }

    /// Draws frames at the rate of the display and prints the row of their durations.
    ///
    /// - `change`: changes the state before each frame; its second argument rises from 0 to 1.
    fn measure(&mut self, what: &str, mut change: impl FnMut(&mut State, f64)) {
        let taken: Vec<Duration> = (0..N_FRAMES)
            .map(|i| {
                let started = Instant::now();
                change(self.0.state_mut().state_mut(), f64::from(i) / f64::from(N_FRAMES));
                self.frame();
                let taken = started.elapsed();
                std::thread::sleep(FRAME.saturating_sub(taken));
                taken
            })
            .collect();
        row(what, taken);
    }

    /// Measures the time from a change of the collision to the end of the first frame that shows
    /// the predicted force for it, and prints the row.
    fn measure_answers(&mut self, when: &str) {
        let answers: Vec<Duration> = (0..N_ANSWERS)
            .map(|i| {
                let started = Instant::now();
                move_slider(self.0.state_mut().state_mut(), f64::from(i) / f64::from(N_ANSWERS));
                while !self
                    .state()
                    .force_forecast()
                    .is_some_and(|answer| collision_is(self.state(), &answer.collision))
                {
                    self.frame();
                }
                started.elapsed()
            })
            .collect();
        row(&format!("{when}, until the answer is drawn"), answers);
    }

    fn measure_all(&mut self, when: &str) {
        self.measure(&format!("{when}, nothing changes"), |_, _| {});
        self.measure(&format!("{when}, a slider of the scenario moves"), move_slider);
        self.measure_answers(when);
    }
}

/// Changes the lateral speed of the bullet, from 3 m/s to 4 m/s as `share` goes from 0 to 1.
fn move_slider(state: &mut State, share: f64) {
    let found = collision_of(&state.project.predict_force, &state.session.sources);
    let mut collision = found.expect("a collision");
    collision.numbers.striking_velocity_m_s[1] = 3.0 + share;
    collision.put_into(&mut state.project.predict_force);
}

/// Whether the collision in the form has these numbers.
fn collision_is(state: &State, numbers: &ForceScenario) -> bool {
    let found = collision_of(&state.project.predict_force, &state.session.sources);
    found.is_some_and(|collision| collision.numbers == *numbers)
}

/// Prints a row with the median, the 90th and the 99th percentile of the durations in ms, and the
/// number of late frames.
fn row(what: &str, mut taken: Vec<Duration>) {
    taken.sort_unstable();
    let at = |share: usize| taken[(taken.len() - 1) * share / 100].as_secs_f64() * 1e3;
    let n_late = taken.iter().filter(|taken| **taken > LATE).count();
    let (median, most, nearly_all) = (at(50), at(90), at(99));
    let n = taken.len();
    println!("| {what} | {median:.1} | {most:.1} | {nearly_all:.1} | {n_late} of {n} |");
}

fn main() {
    let mut window = Window::open();
    window.step_until(|state| state.session.sources.iter().all(Source::is_settled));
    window.apply(Command::Show(Pane::ForcePrediction));
    window.apply(Command::PredictCase);
    window.step_until(|state| state.force_forecast().is_some());
    println!("| frame | median, ms | 90 % | 99 % | over 20 ms |\n| --- | --- | --- | --- | --- |");
    window.measure_all("at rest");

    let form = &mut window.0.state_mut().state_mut().project.networks.train_force;
    form.epochs = Some(100_000);
    window.apply(Command::Train(Network::Force, TrainingCommand::Start));
    let is_fitting = |state: &State| {
        matches!(state.session.force.training.latest, Some(TrainingReport::Fit { .. }))
    };
    window.step_until(is_fitting);
    window.measure_all("while the crush model is fitted");
    window.step_until(|state| !state.session.force.training.history.is_empty());
    window.measure_all("while epochs run");
    window.apply(Command::Train(Network::Force, TrainingCommand::Cancel));
}
