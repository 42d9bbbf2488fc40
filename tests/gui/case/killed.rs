//! What is left of a case after a kill at any moment.

use super::*;

/// Says to a child process of this test where it stores its state.
const KILLED_STATE: &str = "IMPACTLAB_TEST_KILLED_STATE";

/// How often the child is killed; 3 times if this is not set.
const KILLS: &str = "IMPACTLAB_TEST_KILLS";

/// Frames in two seconds.
const TWO_SECONDS: usize = 120;

/// The child: changes a case in every frame, and says beside its state which frame it was.
#[test]
fn change_a_case_until_killed() {
    let Some(store) = std::env::var_os(KILLED_STATE).map(PathBuf::from) else { return };
    let mut harness = open_with(&[SCENARIO], Some(store.clone()));
    for frame in 0_usize.. {
        harness.state_mut().state_mut().case.file.notes = format!("frame {frame}");
        harness.step();
        fs::write(store.with_extension("frame"), frame.to_string()).expect("written");
        std::thread::sleep(Duration::from_millis(16));
    }
}

/// The frame that a stored state is of, which is read as the window reads it.
fn stored_frame(text: &str) -> usize {
    let (state, _) = State::restore(text).expect("a whole state");
    let notes = state.case.file.notes;
    notes.strip_prefix("frame ").and_then(|frame| frame.parse().ok()).expect("a frame")
}

#[test]
fn a_kill_at_any_moment_loses_two_seconds_at_the_most() {
    let n_kills = std::env::var(KILLS).ok().and_then(|n| n.parse().ok()).unwrap_or(3);
    let folder = tempfile::tempdir().expect("a folder");
    let store = folder.path().join("state.json");
    for kill in 0..n_kills {
        let _ = fs::remove_file(&store);
        let mut child = std::process::Command::new(std::env::current_exe().expect("this test"))
            .args(["--exact", "case::killed::change_a_case_until_killed"])
            .env(KILLED_STATE, &store)
            .stdout(std::process::Stdio::null())
            .spawn()
            .expect("a child");
        while !store.exists() {
            std::thread::sleep(Duration::from_millis(10));
            assert!(child.try_wait().expect("a child").is_none(), "the child has ended");
        }
        // A golden ratio spreads the moments evenly over the second between two writes.
        let after_s = 0.3 + (kill as f64 * 0.618_034).fract();
        std::thread::sleep(Duration::from_secs_f64(after_s));
        child.kill().expect("killed");
        child.wait().expect("ended");
        let text = fs::read_to_string(&store).expect("a state");
        let last = fs::read_to_string(store.with_extension("frame")).expect("a frame");
        // The frame file itself may be cut by the kill.
        if let Ok(last) = last.parse::<usize>() {
            let stored = stored_frame(&text);
            assert!(last - stored.min(last) <= TWO_SECONDS, "{stored} of {last}");
        }
    }
}
