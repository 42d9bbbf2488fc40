//! Feeds files to a loader and judges what it does.

use std::any::Any;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::env;
use std::fmt::{Debug, Write};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use sha2::{Digest, Sha256};

use crate::mutation::Mutator;

/// Longest time that reading one file may take on one core. It is time of computing: a busy
/// machine makes no file a fault.
pub const LONGEST: Duration = Duration::from_secs(2);

/// A loader that has not come back after this time waits for something that never comes. Time for
/// which other programs had the core does not count.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// Most files with faults of one run that are kept, each of another kind.
const MOST_FAULTS: usize = 10;

/// Most files whose answers were new that later files are made from.
const LARGEST_POOL: usize = 4096;

/// Longest of them, unless the file that it was made from is as long: short ones are read quickly.
const LONGEST_SEED: usize = 4096;

/// Longest message of an error that a person reads.
const LONGEST_MESSAGE: usize = 4096;

/// Longest file that is added to the corpus.
const LONGEST_STORED: usize = 1024;

/// Most files that one run adds to the corpus.
const MOST_STORED: usize = 8;

/// The most memory that reading a file of this size may take at a time.
pub fn memory_limit_bytes(file_bytes: usize) -> u64 {
    (64 << 20) + 40 * file_bytes as u64
}

/// A format, and how it is tried.
pub struct Format<'a> {
    /// The folder of its corpus.
    pub name: &'static str,
    /// Files that a run of the gate tries.
    pub n_inputs: u64,
    /// The name under which the loader sees each of them, relative to a folder of its own.
    pub file_name: &'static str,
    /// Whether its errors name the file.
    pub names_file: bool,
    /// Files to begin with beside those of the corpus.
    pub seeds: Vec<Vec<u8>>,
    /// Makes another file out of two.
    pub mutate: fn(&mut Mutator, &[u8], &[u8]) -> Vec<u8>,
    /// Reads the file.
    pub load: &'a dyn Fn(&Path) -> Answer,
}

/// What a loader says to a file.
#[derive(Debug, Default)]
pub struct Answer {
    /// Whether the file was accepted, perhaps but for parts of it.
    pub is_accepted: bool,
    /// What is wrong with the file or parts of it, as the user reads it.
    pub messages: Vec<String>,
    /// A value that is not finite, with what stands around it.
    pub not_finite: Option<String>,
    /// Memory that may be taken beside [`memory_limit_bytes`], whatever the size of the file, bytes.
    pub fixed_bytes: u64,
}

impl Answer {
    /// The file was refused.
    pub fn refused(error: &dyn std::error::Error) -> Self {
        Self { messages: vec![impactlab_core::error_chain(error)], ..Self::default() }
    }

    /// The file was accepted as this value.
    pub fn accepted(value: &impl Debug) -> Self {
        Self { is_accepted: true, not_finite: not_finite(value), ..Self::default() }
    }

    /// Looks for values that are not finite in this value, too.
    pub fn and(mut self, value: &impl Debug) -> Self {
        self.not_finite = self.not_finite.or_else(|| not_finite(value));
        self
    }
}

/// The first number in a value that is not finite, with what stands around it.
pub fn not_finite(value: &impl Debug) -> Option<String> {
    let text = format!("{value:?}").replace("\\\\", "").replace("\\\"", "");
    // Every other part stands in quotation marks.
    text.split('"').step_by(2).find_map(|part| {
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let at = ["NaN", "inf"].into_iter().find_map(|word| {
            let mut found = part.match_indices(word);
            found.find_map(|(at, _)| {
                let (before, after) = (&part[..at], &part[at + word.len()..]);
                (!before.ends_with(is_word) && !after.starts_with(is_word)).then_some(at)
            })
        })?;
        let from = part.floor_char_boundary(at.saturating_sub(60));
        Some(part[from..part.ceil_char_boundary(at + 10)].to_owned())
    })
}

/// How long a run is.
struct Extent {
    seed: u64,
    n_inputs: u64,
    duration: Option<Duration>,
    keeps: bool,
}

impl Extent {
    /// As the environment says, else as the format says.
    fn from_environment(format: &Format<'_>) -> Self {
        let number = |name: &str| {
            let text = env::var(name).ok()?;
            Some(text.parse().unwrap_or_else(|_| panic!("{name} is {text:?}, expected a number")))
        };
        let duration = number("FUZZ_SECONDS").map(Duration::from_secs);
        let unlimited = duration.map(|_| u64::MAX);
        Self {
            seed: number("FUZZ_SEED").unwrap_or(0),
            n_inputs: number("FUZZ_INPUTS").or(unlimited).unwrap_or(format.n_inputs),
            duration,
            keeps: env::var_os("FUZZ_KEEP").is_some(),
        }
    }
}

/// What was seen in a run.
#[derive(Default)]
struct Seen {
    n_inputs: u64,
    n_accepted: u64,
    longest: Duration,
    most_bytes: u64,
    /// Answers without the numbers and names in them.
    answers: BTreeSet<String>,
    /// Kinds of faults.
    kinds: BTreeSet<String>,
    /// Faults, each with the file that shows it.
    faults: Vec<String>,
    n_stored: usize,
}

/// Reads the corpus of a format, then files that are made from it.
///
/// # Panics
/// If a file shows a fault, or if no file of the corpus is accepted.
pub fn run(format: &Format<'_>) {
    let extent = Extent::from_environment(format);
    let corpus = [corpus(format.name), format.seeds.clone()].concat();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join(format!("fuzz/{}-{}", format.name, extent.seed));
    let path = folder.join(format.file_name);
    fs::create_dir_all(path.parent().unwrap_or(&folder)).expect("a folder for the files");
    let (n_done, is_over) = (AtomicU64::new(0), AtomicBool::new(false));
    let mut seen = Seen::default();
    let started = Instant::now();
    // A loader on several threads stays on this one, whose time and memory are measured.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
    pool.expect("a pool of this thread");
    let queue = RunQueue::of_this_thread();
    thread::scope(|scope| {
        scope.spawn(|| watch((&n_done, &is_over), &queue, &path));
        let _over = Over(&is_over);
        let mut trial = Trial { format, path: &path, folder: &folder, keeps: extent.keeps };
        let mut pool = corpus.clone();
        for input in &corpus {
            trial.try_one(input, &mut seen);
            n_done.fetch_add(1, Ordering::Relaxed);
        }
        let is_any_accepted = seen.n_accepted > 0;
        let mut mutator = Mutator::new(extent.seed, &corpus);
        while seen.n_inputs < extent.n_inputs.max(corpus.len() as u64)
            && extent.duration.is_none_or(|duration| started.elapsed() < duration)
            && seen.faults.len() < MOST_FAULTS
        {
            let [one, other] = [0; 2].map(|_: usize| mutator.below(pool.len()));
            let input = (format.mutate)(&mut mutator, &pool[one], &pool[other]);
            let is_new = trial.try_one(&input, &mut seen);
            let is_small = input.len() <= LONGEST_SEED.max(pool[one].len());
            if is_new && is_small && pool.len() < LARGEST_POOL {
                pool.push(input);
            }
            n_done.fetch_add(1, Ordering::Relaxed);
        }
        assert!(is_any_accepted, "{}: no file of the corpus is accepted", format.name);
    });
    println!(
        "{}: {} files, {} accepted, {} different answers, {:.1} s; at most {:.0} ms, {:.1} MB",
        format.name,
        seen.n_inputs,
        seen.n_accepted,
        seen.answers.len(),
        started.elapsed().as_secs_f64(),
        seen.longest.as_secs_f64() * 1e3,
        seen.most_bytes as f64 / 1e6,
    );
    assert!(seen.faults.is_empty(), "{}:\n{}", format.name, seen.faults.join("\n"));
}

/// The kept files of a format, in the order of their names.
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let Ok(entries) = fs::read_dir(corpus_folder(name)) else { return Vec::new() };
    let mut paths: Vec<PathBuf> =
        entries.map(|entry| entry.expect("a file of the corpus").path()).collect();
    paths.sort();
    let read = |path: &PathBuf| fs::read(path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    paths.iter().map(read).collect()
}

fn corpus_folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(name)
}

/// Says that a run is over when it is dropped, by a panic too.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Where the system counts for how long a thread was ready to run while another one had its core.
struct RunQueue(PathBuf);

impl RunQueue {
    fn of_this_thread() -> Self {
        let thread = fs::read_link("/proc/thread-self").unwrap_or_default();
        Self(Path::new("/proc").join(thread).join("schedstat"))
    }

    /// Zero where the system does not count it.
    fn waited(&self) -> Duration {
        let counts = fs::read_to_string(&self.0).unwrap_or_default();
        let waited_ns = counts.split_whitespace().nth(1).and_then(|count| count.parse().ok());
        Duration::from_nanos(waited_ns.unwrap_or(0))
    }
}

/// Ends the program if a loader does not come back; the file that it reads stays where it is.
///
/// - `queue`: that of the thread of the loader.
fn watch((n_done, is_over): (&AtomicU64, &AtomicBool), queue: &RunQueue, path: &Path) {
    let (mut last, mut since, mut queued) = (0, Instant::now(), queue.waited());
    while !is_over.load(Ordering::Relaxed) {
        thread::sleep(Duration::from_millis(20));
        let done = n_done.load(Ordering::Relaxed);
        if done != last {
            (last, since, queued) = (done, Instant::now(), queue.waited());
        } else if since.elapsed() > LONGEST_WAIT + queue.waited().saturating_sub(queued) {
            eprintln!("{}: still not read after {LONGEST_WAIT:?}", path.display());
            process::abort();
        }
    }
}

/// A loader and where its files are.
struct Trial<'a> {
    format: &'a Format<'a>,
    path: &'a Path,
    folder: &'a Path,
    keeps: bool,
}

impl Trial<'_> {
    /// Whether the answer is one that no file had before.
    fn try_one(&mut self, input: &[u8], seen: &mut Seen) -> bool {
        // A new file each time: some file systems wait for the disk when a file is emptied.
        let _ = fs::remove_file(self.path);
        fs::write(self.path, input).expect("the file can be written");
        let judged = self.judge(input, seen);
        seen.n_inputs += 1;
        match judged {
            Ok(answer) => {
                seen.n_accepted += u64::from(answer.is_accepted);
                let mut summary = format!("{} ", answer.is_accepted);
                answer.messages.iter().take(3).for_each(|text| summary += &self.kind_of(text));
                let is_new = seen.answers.insert(summary);
                if is_new && self.keeps {
                    self.keep(input, seen);
                }
                is_new
            }
            Err(fault) => {
                if seen.kinds.insert(self.kind_of(&fault)) {
                    let path = self.folder.join(format!("fault-{}", digest(input)));
                    fs::write(&path, input).expect("a file with a fault can be kept");
                    seen.faults.push(format!("{}: {fault}", path.display()));
                }
                false
            }
        }
    }

    /// What the loader says, or what is wrong with it.
    fn judge(&self, input: &[u8], seen: &mut Seen) -> Result<Answer, String> {
        hear_panics();
        let mut outcome = None;
        let started = ThreadTime::now();
        let memory = allocation_counter::measure(|| {
            outcome = Some(catch_unwind(AssertUnwindSafe(|| (self.format.load)(self.path))));
        });
        let took = started.elapsed();
        seen.longest = seen.longest.max(took);
        seen.most_bytes = seen.most_bytes.max(memory.bytes_max);
        let answer =
            outcome.expect("the loader was called").map_err(|payload| message_of(&*payload))?;
        let limit = memory_limit_bytes(input.len()) + answer.fixed_bytes;
        if took > LONGEST {
            return Err(format!("took {:.1} s for {} bytes", took.as_secs_f64(), input.len()));
        }
        if memory.bytes_max > limit {
            let (got, n) = (memory.bytes_max, input.len());
            return Err(format!("took {got} bytes of memory for {n} bytes, limit {limit}"));
        }
        if let Some(value) = &answer.not_finite {
            return Err(format!("accepted although not finite: {value}"));
        }
        if !answer.is_accepted && answer.messages.is_empty() {
            return Err("refused without a word".to_owned());
        }
        answer.messages.iter().try_for_each(|message| self.check_message(message, input))?;
        Ok(answer)
    }

    /// The name of the file, a line within it, and no more than a person reads.
    fn check_message(&self, message: &str, input: &[u8]) -> Result<(), String> {
        if message.trim().is_empty() {
            return Err("an error without a text".to_owned());
        }
        if message.len() > LONGEST_MESSAGE {
            return Err(format!("an error of {} bytes: {message:.200}", message.len()));
        }
        if !self.format.names_file {
            return Ok(());
        }
        let name = self.path.display().to_string();
        let Some((_, after)) = message.split_once(&name) else {
            // A data set has errors of its own files.
            let folder = self.folder.display().to_string();
            let is_within = self.format.file_name.contains('/') && message.contains(&folder);
            let fault = || format!("an error without the name of the file: {message}");
            return if is_within { Ok(()) } else { Err(fault()) };
        };
        let digits = after.strip_prefix(':').map(|rest| rest.split(|c: char| !c.is_ascii_digit()));
        let line: Option<u64> = digits.and_then(|mut parts| parts.next()?.parse().ok());
        let breaks = |wanted: u8| input.iter().filter(|byte| **byte == wanted).count() as u64;
        let n_lines = breaks(b'\n') + breaks(b'\r') + 1;
        match line {
            Some(line) if line == 0 || line > n_lines => {
                Err(format!("an error in line {line} of {n_lines}: {message}"))
            }
            _ => Ok(()),
        }
    }

    /// A message without what differs from file to file: numbers, and what stands in quotes.
    fn kind_of(&self, message: &str) -> String {
        let without_path = message.replace(&*self.path.to_string_lossy(), "");
        let without_path = without_path.replace("\\\\", "").replace("\\\"", "");
        let mut kind = String::new();
        for (part_idx, part) in without_path.split(['"', '`']).enumerate() {
            if part_idx % 2 == 0 {
                kind.extend(part.chars().filter(|c| c.is_alphabetic() || c.is_whitespace()));
            }
        }
        kind.truncate(kind.floor_char_boundary(200));
        kind
    }

    fn keep(&self, input: &[u8], seen: &mut Seen) {
        if input.len() <= LONGEST_STORED && seen.n_stored < MOST_STORED {
            let path = corpus_folder(self.format.name).join(format!("found-{}", digest(input)));
            fs::write(path, input).expect("a file of the corpus can be written");
            seen.n_stored += 1;
        }
    }
}

/// The first digits of the SHA-256.
fn digest(input: &[u8]) -> String {
    Sha256::digest(input).iter().take(6).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

thread_local! {
    static LAST_PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Notes where a panic was, instead of printing it: it is reported with its file.
fn hear_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            let place = info.location().map(ToString::to_string).unwrap_or_default();
            if place.starts_with("tests/fuzz") {
                usual(info);
            }
            LAST_PANIC.with(|last| *last.borrow_mut() = place);
        }));
    });
}

fn message_of(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("no text");
    LAST_PANIC.with(|place| format!("panicked at {}: {text}", place.borrow()))
}
