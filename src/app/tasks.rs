//! The work that the window has done on other threads and that ends by itself: reading, writing,
//! measuring, making reports and films.
//!
//! A task ends with a [`Command`], which [`State::update`](crate::app::State::update) carries out
//! before anything else. So there is one place in which threads are started and one in which their
//! results are received. What is asked again and again has a thread of its own instead
//! ([`Latest`](crate::app::latest::Latest)), and so do long questions and trainings.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use egui::Context;

use crate::app::command::Command;
use crate::app::network::Network;
use crate::app::reading::ReadingRecord;
use impactlab_core::jobs::{Job, Progress, ProgressCallback};

/// Which work a task does. There is one task of each at a time; a new one takes the place of the other,
/// which is cancelled and whose result never comes. What writes is not cancelled by another of its kind,
/// which begins once the result of the first was received: nothing is lost, and the later one stays.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TaskKey {
    /// A path that is opened is read and checked.
    Load(PathBuf),
    /// A file or folder is written of what is shown.
    Write(PathBuf),
    /// The case is written.
    SaveCase,
    /// The files of the case are compared with what they were.
    CheckCase,
    /// A film is made and written.
    Film(PathBuf),
    /// The report of the case is made.
    Report,
    /// The ground of the scene is read, by its path.
    Ground(PathBuf),
    /// A ground is made of a point cloud.
    MakeGround,
    /// The table or the curve of a file is read for the import dialog.
    Import,
    /// A crash test and the channels of its barrier are read, by the path of its description.
    CrashTest(PathBuf),
    /// The desktop asks the user for a path.
    FileDialog,
    /// A trained network is read.
    LoadModel(Network),
    /// The network in use is written to a file of the user.
    SaveModel(Network),
    /// A network of this name is kept in the user's data folder.
    KeepModel(Network, String),
    /// The list of what is kept is read.
    ListArchive,
    /// A comparison or an evaluation is kept, by its content.
    KeepResult(Arc<Vec<u8>>),
    /// The note of something that is kept is written, by the digest of its content.
    PutIntoArchive(String),
    /// Files of what is kept are removed.
    RemoveArchived(Vec<PathBuf>),
    /// A comparison or an evaluation that is kept is read.
    OpenArchived,
    /// The list of trainings that have not ended is read.
    ListTrainings,
    /// A comparison is read from a file of the user.
    OpenComparison,
    /// What a form will cost is measured.
    Cost,
    /// An atlas is read.
    ReadAtlas,
    /// The plan of a sweep is read, and what its folder holds.
    ReadSweep,
    /// Some rows of a sweep are timed.
    TimeSweep,
    /// A sweep is computed.
    Sweep,
    /// The chunks of a sweep are put together.
    MergeSweep,
}

/// What a task makes of its result.
type Then<T> = Box<dyn FnOnce(Result<T, String>) -> Option<Command>>;

/// A task with a result of some type.
trait Work {
    /// The command that follows once the task has ended; the outer `None` while it is running.
    fn poll(&mut self) -> Option<Option<Command>>;

    fn progress(&self) -> (&Progress, Option<Duration>);

    fn cancel(&self);
}

struct Running<T> {
    job: Job<Result<T, String>>,
    then: Option<Then<T>>,
}

impl<T: Send + 'static> Work for Running<T> {
    fn poll(&mut self) -> Option<Option<Command>> {
        let result = self.job.poll().into_result("the task")?;
        Some(self.then.take().and_then(|then| then(result)))
    }

    fn progress(&self) -> (&Progress, Option<Duration>) {
        (self.job.progress(), self.job.time_left())
    }

    fn cancel(&self) {
        self.job.cancel();
    }
}

/// A task that is running, or that waits for the one before.
struct Task {
    key: TaskKey,
    work: Box<dyn Work>,
    /// Dropped with this task: then the one that waits for it begins.
    next: Option<Sender<()>>,
}

/// The tasks that are running.
#[derive(Default)]
pub struct Tasks {
    /// The window that is drawn again when a task has news; `None` without a window.
    window: Option<Context>,
    running: Vec<Task>,
    /// The commands of tasks that could not be started.
    ended: Vec<Command>,
    /// Where it is written down what is being read.
    reading: ReadingRecord,
}

impl Tasks {
    /// Lets tasks draw a window again when they have news.
    pub fn wake(&mut self, window: Context) {
        self.window = Some(window);
    }

    /// Writes down what is being read from now on.
    pub(in crate::app) fn record_reading(&mut self, record: ReadingRecord) {
        self.reading = record;
    }

    /// Forgets what is being read, because the program ends as it should.
    pub(in crate::app) fn end_reading(&mut self) {
        self.reading.write(std::iter::empty());
    }

    /// Writes down what is being read.
    ///
    /// - `coming`: what will be read besides.
    fn write_reading(&mut self, coming: Option<&TaskKey>) {
        let running = self.running.iter().map(|task| &task.key);
        self.reading.write(running.chain(coming).filter_map(TaskKey::read_path));
    }

    /// Starts a task on a thread of normal priority.
    ///
    /// - `work`: receives a callback for its progress, which says whether to go on;
    /// - `then`: makes a command of the result, or of the reason why there is none: a message of the
    ///   work, a panic, or that no thread could be started.
    pub fn start<T: Send + 'static, C: Into<Option<Command>>>(
        &mut self,
        key: TaskKey,
        work: impl FnOnce(&mut ProgressCallback<'_>) -> Result<T, String> + Send + 'static,
        then: impl FnOnce(Result<T, String>) -> C + 'static,
    ) {
        self.write_reading(Some(&key));
        let work = after(self.earlier(&key), work);
        let job = Job::spawn(key.thread_name(), self.waker(), work);
        self.add(key, job, then);
    }

    /// Starts a task that takes a while, on threads of the lowest priority.
    pub fn start_in_background<T: Send + 'static, C: Into<Option<Command>>>(
        &mut self,
        key: TaskKey,
        work: impl FnOnce(&mut ProgressCallback<'_>) -> Result<T, String> + Send + 'static,
        then: impl FnOnce(Result<T, String>) -> C + 'static,
    ) {
        let work = after(self.earlier(&key), work);
        let job = Job::spawn_in_background(key.thread_name(), self.waker(), work);
        self.add(key, job, then);
    }

    /// What ends once the result of the latest task of this kind was received, if that one writes.
    fn earlier(&mut self, key: &TaskKey) -> Option<Receiver<()>> {
        let is_same = |task: &&mut Task| key.is_write() && task.key == *key;
        let latest = self.running.iter_mut().rev().find(is_same)?;
        let (next, end) = channel();
        latest.next = Some(next);
        Some(end)
    }

    fn waker(&self) -> impl Fn() + Send + 'static {
        let window = self.window.clone();
        move || window.iter().for_each(Context::request_repaint)
    }

    fn add<T: Send + 'static, C: Into<Option<Command>>>(
        &mut self,
        key: TaskKey,
        job: std::io::Result<Job<Result<T, String>>>,
        then: impl FnOnce(Result<T, String>) -> C + 'static,
    ) {
        if !key.is_write() {
            self.stop(&key);
        }
        match job {
            Ok(job) => {
                let then: Then<T> = Box::new(move |result| then(result).into());
                let work = Box::new(Running { job, then: Some(then) });
                self.running.push(Task { key, work, next: None });
            }
            Err(error) => self.ended.extend(then(Err(error.to_string())).into()),
        }
    }

    /// Receives what the tasks have found, as commands, in the order in which they were started.
    pub fn poll(&mut self) -> Vec<Command> {
        let mut commands = std::mem::take(&mut self.ended);
        self.running.retain_mut(|task| match task.work.poll() {
            None => true,
            Some(command) => {
                commands.extend(command);
                false
            }
        });
        self.write_reading(None);
        commands
    }

    /// Whether a task is running.
    pub fn is_running(&self, key: &TaskKey) -> bool {
        self.get(key).is_some()
    }

    /// Progress of a task that is running, and the estimated time left.
    pub fn progress(&self, key: &TaskKey) -> Option<(&Progress, Option<Duration>)> {
        self.get(key).map(|work| work.progress())
    }

    /// Asks a task to end. It still ends with a command.
    pub fn cancel(&self, key: &TaskKey) {
        if let Some(work) = self.get(key) {
            work.cancel();
        }
    }

    /// Cancels a task whose result is not wanted any more: it ends without a command.
    pub fn stop(&mut self, key: &TaskKey) {
        self.running.retain(|task| task.key != *key);
        self.write_reading(None);
    }

    /// Whether a file is being written of what is shown.
    pub fn is_writing(&self) -> bool {
        self.running.iter().any(|task| matches!(task.key, TaskKey::Write(_)))
    }

    /// Whether anything is being written that would be lost if the program ended.
    pub(in crate::app) fn has_writes(&self) -> bool {
        self.running.iter().any(|task| task.key.is_write())
    }

    /// Leaves what is being written as it is, without waiting for it: the program ends.
    pub(in crate::app) fn give_up_writes(&mut self) {
        self.running.retain(|task| !task.key.is_write());
    }

    /// The file of the film that is being made.
    pub fn film(&self) -> Option<&Path> {
        self.running.iter().find_map(|task| match &task.key {
            TaskKey::Film(path) => Some(path.as_path()),
            _ => None,
        })
    }

    fn get(&self, key: &TaskKey) -> Option<&dyn Work> {
        self.running.iter().find(|task| task.key == *key).map(|task| &*task.work)
    }
}

/// Work that begins once what `end` belongs to has ended.
fn after<T: Send + 'static>(
    end: Option<Receiver<()>>,
    work: impl FnOnce(&mut ProgressCallback<'_>) -> Result<T, String> + Send + 'static,
) -> impl FnOnce(&mut ProgressCallback<'_>) -> Result<T, String> + Send + 'static {
    move |report: &mut ProgressCallback<'_>| {
        // Nothing is ever sent: this ends when the other side is dropped.
        let _ = end.map(|end| end.recv());
        work(report)
    }
}

impl TaskKey {
    /// Whether the task writes what the user, or the window by itself, wants to keep. A film is stopped
    /// by the user, and a sweep goes on from its chunks.
    fn is_write(&self) -> bool {
        matches!(
            self,
            Self::Write(_)
                | Self::SaveCase
                | Self::SaveModel(_)
                | Self::KeepModel(..)
                | Self::KeepResult(_)
                | Self::PutIntoArchive(_)
                | Self::MergeSweep
        )
    }

    /// The path that is read for the state at each start, if the task does that.
    fn read_path(&self) -> Option<&Path> {
        match self {
            Self::Load(path) | Self::Ground(path) => Some(path),
            _ => None,
        }
    }

    fn thread_name(&self) -> &'static str {
        match self {
            Self::Load(_) => "load",
            Self::Write(_) => "write",
            Self::SaveCase => "save case",
            Self::CheckCase => "check case",
            Self::Film(_) => "film",
            Self::Report => "report",
            Self::Ground(_) => "ground",
            Self::MakeGround => "make ground",
            Self::Import => "import",
            Self::CrashTest(_) => "read crash test",
            Self::FileDialog => "file dialog",
            Self::LoadModel(_) => "load model",
            Self::SaveModel(_) => "save model",
            Self::KeepModel(..) => "keep model",
            Self::ListArchive | Self::ListTrainings => "list",
            Self::KeepResult(_) | Self::PutIntoArchive(_) => "keep result",
            Self::RemoveArchived(_) => "remove",
            Self::OpenArchived => "open result",
            Self::OpenComparison => "open comparison",
            Self::Cost => "measure",
            Self::ReadAtlas => "read atlas",
            Self::ReadSweep => "read sweep",
            Self::TimeSweep => "time sweep",
            Self::Sweep => "sweep",
            Self::MergeSweep => "merge sweep",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::data::Severity;

    fn command_of(result: Result<&'static str, String>) -> Command {
        match result {
            Ok(text) => Command::Say(Severity::Info, text.to_owned()),
            Err(why) => Command::Say(Severity::Error, why),
        }
    }

    fn settled(tasks: &mut Tasks) -> Vec<String> {
        let mut texts = Vec::new();
        while !tasks.running.is_empty() || !tasks.ended.is_empty() {
            texts.extend(tasks.poll().into_iter().map(|command| match command {
                Command::Say(severity, text) => format!("{severity:?} {text}"),
                other => format!("{other:?}"),
            }));
            std::thread::yield_now();
        }
        texts
    }

    #[test]
    fn a_task_ends_with_a_command_also_if_it_fails_or_panics() {
        let mut tasks = Tasks::default();
        tasks.start(TaskKey::Report, |_| Ok("made"), command_of);
        assert!(tasks.is_running(&TaskKey::Report));
        assert_eq!(settled(&mut tasks), ["Info made"]);
        assert!(!tasks.is_running(&TaskKey::Report));
        tasks.start(TaskKey::Report, |_| Err("no case".to_owned()), command_of);
        assert_eq!(settled(&mut tasks), ["Error no case"]);
        tasks.start(TaskKey::Report, |_| panic!("row 7"), command_of);
        assert_eq!(settled(&mut tasks), ["Error internal error: row 7"]);
    }

    #[test]
    fn a_task_takes_the_place_of_the_same_and_a_stopped_one_is_silent() {
        let mut tasks = Tasks::default();
        let (sender, waits) = std::sync::mpsc::channel::<()>();
        let first = move |_: &mut ProgressCallback<'_>| {
            let _ = waits.recv();
            Ok("first")
        };
        tasks.start(TaskKey::Cost, first, command_of);
        tasks.start(TaskKey::Cost, |_| Ok("second"), command_of);
        drop(sender);
        assert_eq!(settled(&mut tasks), ["Info second"]);
        let ground = TaskKey::Ground("site.toml".into());
        tasks.start(ground.clone(), |_| Ok("read"), command_of);
        tasks.stop(&ground);
        assert!(settled(&mut tasks).is_empty());
        tasks.start(TaskKey::FileDialog, |_| Ok(()), |_| None::<Command>);
        assert!(settled(&mut tasks).is_empty());
    }

    /// Two saves in quick succession wrote side by side: the older text could be the last in the file,
    /// and nobody was told if the first failed.
    #[test]
    fn what_writes_is_neither_dropped_nor_overtaken_by_the_next() {
        let (mut tasks, order) = (Tasks::default(), Arc::new(std::sync::Mutex::new(Vec::new())));
        let (sender, waits) = channel::<()>();
        let written = Arc::clone(&order);
        let first = move |_: &mut ProgressCallback<'_>| {
            let _ = waits.recv();
            written.lock().unwrap().push(1);
            Err::<&str, _>("disk full".to_owned())
        };
        tasks.start(TaskKey::SaveCase, first, command_of);
        for number in [2, 3] {
            let written = Arc::clone(&order);
            let next = move |_: &mut ProgressCallback<'_>| {
                written.lock().unwrap().push(number);
                Ok("written")
            };
            tasks.start(TaskKey::SaveCase, next, command_of);
        }
        std::thread::sleep(Duration::from_millis(50));
        assert!(tasks.poll().is_empty() && order.lock().unwrap().is_empty());
        assert!(tasks.has_writes());
        drop(sender);
        assert_eq!(settled(&mut tasks), ["Error disk full", "Info written", "Info written"]);
        assert_eq!(*order.lock().unwrap(), [1, 2, 3]);
        assert!(!tasks.has_writes());
    }
}
