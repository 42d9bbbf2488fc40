//! When the vehicle was struck, from its motion alone.
//!
//! ```text
//! gain(w) = ln p(samples | lively within w) − ln p(samples | quiet)      w* = argmax gain
//! ```

use crate::response::motion_log::tracks::{LogWindow, TrackScales, Tracks};

/// Contact times that are tried, s: what the shipped finite-element runs last, and shorter.
const DURATIONS_S: [f64; 4] = [0.05, 0.1, 0.15, 0.2];
/// Duration with which the start is looked for.
const USUAL_S: f64 = 0.1;
/// Samples before and after a window that have a say in it, s.
const ABOUT_S: f64 = 0.5;
/// Steps of the start: coarse, then fine about the best, s.
const STEPS_S: [f64; 2] = [0.04, 0.01];
/// Below this gain there was no contact: a factor of some 20 000.
const LEAST_GAIN: f64 = 10.0;

/// The window of contact; `None` where a quiet motion explains the samples as well.
///
/// - `groups`: coordinates with their scales to start with;
/// - `[from_s, to_s]`: the log's first and last instant;
/// - `known_s`: first contact, s, where it is known: the window starts there.
pub(super) fn find_contact(
    groups: &[(&Tracks, TrackScales)],
    [from_s, to_s]: [f64; 2],
    known_s: Option<f64>,
) -> LogWindow {
    let gain = |window: [f64; 2]| {
        let within = [window[0] - ABOUT_S, window[1] + ABOUT_S];
        let log_likelihood = |(tracks, scales): &(&Tracks, TrackScales)| {
            let likelihood = |window| tracks.log_likelihood(scales, window, within);
            likelihood(Some(window)) - likelihood(None)
        };
        groups.iter().map(log_likelihood).sum::<f64>()
    };
    let best = |starts_s: [f64; 2], step_s: f64, durations_s: &[f64]| {
        let first_s = starts_s[0].max(from_s);
        let n = ((starts_s[1].min(to_s) - first_s) / step_s).floor().max(0.0) as usize;
        let starts = (0..=n).map(|i| first_s + i as f64 * step_s);
        let windows =
            starts.flat_map(|start| durations_s.iter().map(move |length| [start, start + length]));
        windows.map(|window| (gain(window), window)).max_by(|a, b| a.0.total_cmp(&b.0))
    };
    if let Some(known_s) = known_s {
        return best([known_s; 2], STEPS_S[1], &DURATIONS_S).map(|(_, window)| window);
    }
    let (_, [near_s, _]) = best([from_s, to_s], STEPS_S[0], &[USUAL_S])?;
    let (gain, window) = best([near_s - 0.1, near_s + 0.1], STEPS_S[1], &DURATIONS_S)?;
    (gain > LEAST_GAIN).then_some(window)
}
