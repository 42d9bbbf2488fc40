//! Films on the command line; one is played by a browser.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::program::{TRAJECTORIES, answer, json, program, text};

/// Browsers that are looked for.
const BROWSERS: [&str; 4] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
/// Longest time to wait for a browser. Only one that hangs exceeds it.
const PATIENCE: Duration = Duration::from_secs(120);

/// A page that plays a film and tells what it finds.
const PAGE: &str = r#"<!doctype html><video id="v" src="film.mp4" muted preload="auto"></video><script>
const v = document.getElementById("v"), told = { seen: [] };
const tell = () => fetch("/told", { method: "POST", body: JSON.stringify(told) });
const instants = [0.05, 0.75, 1.45];
const seen = () => {
  const c = document.createElement("canvas"), g = c.getContext("2d");
  [c.width, c.height] = [v.videoWidth, v.videoHeight];
  g.drawImage(v, 0, 0);
  const pixels = g.getImageData(0, 0, c.width, c.height).data;
  let sum = 0, hash = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    sum += pixels[i] + pixels[i + 1] + pixels[i + 2];
    hash = (31 * hash + pixels[i + 1]) | 0;
  }
  told.seen.push({ time_s: v.currentTime, mean: sum / pixels.length / 0.75, hash });
};
v.onerror = () => { told.error = v.error.message; tell(); };
v.oncanplaythrough = () => {
  v.oncanplaythrough = null;
  Object.assign(told, { width: v.videoWidth, height: v.videoHeight, duration_s: v.duration });
  v.currentTime = instants[0];
};
v.onseeked = () => {
  seen();
  if (told.seen.length < instants.length) v.currentTime = instants[told.seen.length];
  else { v.onended = () => { told.ended = true; tell(); }; v.playbackRate = 4; v.play(); }
};
</script>"#;

/// Makes a film of a shipped case and returns what the command says.
fn film(out: &Path, options: &[&str]) -> Value {
    let fixed = ["render", "film", TRAJECTORIES, "--case", "FE_c002", "--out", text(out)];
    answer(&[&fixed, options].concat())
}

/// The error line of a film that is not made.
fn refused(out: &Path, options: &[&str]) -> String {
    let fixed = ["render", "film", TRAJECTORIES, "--case", "FE_c002", "--out", text(out)];
    let output = program().args([&fixed, options].concat()).output().expect("it starts");
    assert!(!output.status.success(), "{options:?}");
    String::from_utf8(output.stderr).expect("UTF-8")
}

#[test]
fn a_film_says_what_it_is_and_replaces_nothing_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("film.mp4");
    let options = ["--size", "320x180", "--fps", "10", "--from", "0.2", "--to", "700ms"];
    let report = film(&out, &[&options[..], &["--slow", "0.3..0.4=0.1"]].concat());
    assert_eq!(report["title"], "FE_c002");
    // 0.1 s, 0.1 s at a tenth, 0.3 s, and the last frame.
    assert_eq!((&report["n_frames"], &report["frames_per_s"]), (&json("15"), &json("10")));
    assert_eq!(report["size_px"], json("[320, 180]"));
    let first = fs::read(&out).expect("a film");
    assert_eq!(first.get(4..8), Some(&b"ftyp"[..]));

    let again = refused(&out, &options);
    assert!(again.contains("exists already; --overwrite replaces it"), "{again}");
    assert!(fs::read(&out).expect("a film") == first);
    film(&out, &[&options[..], &["--overwrite", "--dark"]].concat());
    assert!(fs::read(&out).expect("a film") != first);
}

#[test]
fn a_name_without_an_ending_is_a_folder_of_numbered_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("frames");
    // A picture may have any size.
    let options = ["--size", "321x181", "--fps", "5", "--to", "0.6", "--view", "perspective"];
    let report = film(&out, &options);
    assert_eq!(report["n_frames"], 4);
    for idx in 1..=4 {
        let picture = fs::read(out.join(format!("frame-{idx:05}.png"))).expect("a picture");
        assert_eq!(picture.get(1..4), Some(&b"PNG"[..]));
        // Width and height in the header of a PNG.
        assert_eq!(picture.get(16..24), Some(&[0, 0, 1, 65, 0, 0, 0, 181][..]));
    }
    assert_eq!(fs::read_dir(&out).expect("a folder").count(), 5, "four pictures and a manifest");
    assert!(refused(&out, &options).contains("holds the files of an earlier run"));
    let manifest = fs::read_to_string(out.join("manifest.json")).expect("a manifest");
    let manifest = json(&manifest);
    assert_eq!(manifest["request"]["question"], "simulate");
    let inputs = manifest["inputs"].as_array().expect("inputs");
    let is_recording = |input: &&Value| {
        input["name"].as_str().is_some_and(|name| name.ends_with("trajectories/FE_c002.csv"))
    };
    assert!(inputs.iter().any(|input| is_recording(&input)), "{inputs:?}");
}

#[test]
fn the_camera_moves_from_key_to_key() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = |name: &str, options: &[&str]| -> Vec<Vec<u8>> {
        let out = folder.path().join(name);
        let fixed = ["--size", "160x90", "--fps", "5", "--to", "0.6"];
        assert_eq!(film(&out, &[&fixed, options].concat())["n_frames"], 4, "{options:?}");
        let picture = |idx: usize| fs::read(out.join(format!("frame-{idx:05}.png")));
        (1..=4).map(|idx| picture(idx).expect("a picture")).collect()
    };
    let far = frames("far", &["--follow", "struck", "--distance", "60"]);
    let near = frames("near", &["--follow", "struck", "--distance", "12"]);
    let keys = ["--key", "t=0,distance=60,follow=struck", "--key", "t=0.6,distance=12"];
    let keyed = frames("keyed", &keys);
    assert!(keyed[0] == far[0] && keyed[3] == near[3], "the first and the last frame are keys");
    for idx in [1, 2] {
        assert!(keyed[idx] != far[idx] && keyed[idx] != near[idx], "frame {idx} lies between them");
    }
    let standing = frames("standing", &["--key", "t=0.3,distance=60,follow=struck"]);
    assert!(standing == far, "a single key is a camera that stands");
}

#[test]
fn the_manifest_of_pictures_names_the_ground() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("frames");
    let site = "assets/sites/country-road/site.toml";
    let size = ["--size", "64x64", "--fps", "5", "--to", "0.3", "--out", text(&out)];
    answer(&[&["render", "film", "pit-right-rear", "--site", site], &size[..]].concat());
    let manifest = json(&fs::read_to_string(out.join("manifest.json")).expect("a manifest"));
    assert_eq!(manifest["request"]["site"], site);
    let name = |input: &Value| input["name"].as_str().unwrap_or_default().to_owned();
    let names: Vec<String> =
        manifest["inputs"].as_array().expect("inputs").iter().map(name).collect();
    for file in ["site.toml", "orthophoto.jpg", "orthophoto.jgw", "edges.dxf"] {
        assert_eq!(names.iter().filter(|name| name.ends_with(file)).count(), 1, "{file} {names:?}");
    }
}

#[test]
fn what_cannot_be_filmed_is_said_and_leaves_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = |name: &str| folder.path().join(name);
    for (file, options, part) in [
        ("film.webm", vec![], "expected a name that ends in .mp4, or a folder"),
        ("film.mp4", vec!["--size", "321x180"], "321 × 180 pixels, expected even numbers"),
        ("film.mp4", vec!["--size", "16x16"], "film side is 16, expected 64 to 3840"),
        ("film.mp4", vec!["--to", "900"], "expected times between 0.000 s and"),
        ("film.mp4", vec!["--from", "2", "--to", "1"], "from 2 s to 1 s; expected an end after"),
        ("film.mp4", vec!["--slow", "0..1=0.1", "--slow", "0.5..2=0.1"], "do not overlap"),
        ("film.mp4", vec!["--slow", "10..12=0.1"], "lies outside the film, expected times between"),
        ("film.mp4", vec!["--slow", "0..1"], "such as 0.2..0.6=0.1"),
        ("film.mp4", vec!["--fps", "0"], "frames per second is 0, expected 1 to 120"),
        ("film.mp4", vec!["--playback", "0.001", "--fps", "120"], "expected 2 to 36000"),
        ("nowhere/film.mp4", vec![], "there is no folder"),
        ("film.mp4", vec!["--key", "t=1", "--key", "t=0.5"], "at 0.5 s comes after that at 1 s"),
        ("film.mp4", vec!["--key", "t=1", "--key", "t=1"], "each at a time of its own"),
        ("film.mp4", vec!["--key", "t=900"], "the camera key at 900 s lies outside the film"),
        ("film.mp4", vec!["--to", "1", "--key", "t=1.2"], "between 0.000 s and 1.000 s"),
        ("film.mp4", vec!["--key", "t=0,distance=1"], "camera distance is 1 m, expected 2 to"),
        ("film.mp4", vec!["--key", "t=0,elevation=60"], "camera elevation is 60 rad, expected"),
        ("film.mp4", vec!["--key", "t=0,zoom=2"], "expected t, x, y, distance, azimuth"),
        ("film.mp4", vec!["--key", "distance=20"], "expected a time, such as t=0.5"),
    ] {
        let error = refused(&name(file), &options);
        assert!(error.contains(part), "{options:?}: {error}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn a_scenario_is_filmed_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("film.mp4");
    let options = ["--size", "320x180", "--fps", "5", "--to", "1", "--out", text(&out)];
    let report = answer(&[&["render", "film", "pit-right-rear"], &options[..]].concat());
    assert_eq!(report["n_frames"], 6);
    assert!(out.exists());
}

/// A car that spun to rest, with few marks.
const EVIDENCE: &str = "tests/data/evidence/spin.toml";

#[test]
fn a_reconstruction_is_filmed_from_its_evidence() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("film.mp4");
    let road = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sites/country-road/site.toml");
    let few = ["render", "film", EVIDENCE, "--particles", "60", "--seed", "2", "--site", road];
    let seen = ["--view", "perspective", "--follow", "struck", "--size", "320x180", "--fps", "5"];
    let report = answer(&[&few[..], &seen, &["--to", "1", "--out", text(&out)]].concat());
    assert_eq!((&report["title"], &report["n_frames"]), (&json("\"spin\""), &json("6")));
    let film = fs::read(&out).expect("a film");
    assert_eq!(film.get(4..8), Some(&b"ftyp"[..]));
    // What restricts the answer is said here and burnt in.
    let notes = report["notes"].to_string();
    for part in ["few particles", "road friction: zones of the site, all with"] {
        assert!(notes.contains(part), "{notes}");
    }
}

#[test]
fn options_that_would_do_nothing_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("film.mp4");
    let of_evidence = "is the evidence of a collision, which is reconstructed without";
    let of_others = "is no evidence of a collision; leave out";
    for (path, option, value, part) in [
        (EVIDENCE, "--case", "c001", of_evidence),
        (EVIDENCE, "--ghosts", "5", of_evidence),
        (EVIDENCE, "--bullet", "reference-2000", of_evidence),
        (EVIDENCE, "--speed", "20", of_evidence),
        ("pit-right-rear", "--particles", "100", of_others),
        ("pit-right-rear", "--seed", "1", of_others),
        ("pit-right-rear", "--striking", "reference-2000", of_others),
    ] {
        let args = ["render", "film", path, option, value, "--out", text(&out)];
        let output = program().args(args).output().expect("it starts");
        let error = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(!output.status.success() && error.contains(&format!("{part} {option}")), "{error}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn an_end_just_after_the_motion_is_its_end_and_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("film.mp4");
    let error = refused(&out, &["--to", "900"]);
    let (_, end) = error.split_once("between 0.000 s and ").expect("the end of the motion");
    let end_s: f64 = end.trim().trim_end_matches(" s").parse().expect("a number");
    let options = ["--size", "320x180", "--fps", "30", "--from"];
    let from = (end_s - 0.1).to_string();
    let to = (end_s + 0.04).to_string();
    let report = film(&out, &[&options[..], &[&from, "--to", &to]].concat());
    assert_eq!(report["n_frames"], 4);
    let notes = report["notes"].to_string();
    assert!(notes.contains(&format!("--to is {to} s: the film ends with the motion")), "{notes}");
    let later = (end_s + 0.06).to_string();
    let error = refused(&folder.path().join("other.mp4"), &["--from", &from, "--to", &later]);
    assert!(error.contains("expected times between"), "{error}");
}

/// The end of a browser, when the test ends.
struct Browser(std::process::Child);

impl Drop for Browser {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Answers a request for the page or the film; returns what the page tells.
fn serve(mut stream: TcpStream, film: &[u8]) -> std::io::Result<Option<String>> {
    let mut lines = BufReader::new(stream.try_clone()?);
    let (mut first, mut length, mut range) = (String::new(), 0, None);
    lines.read_line(&mut first)?;
    loop {
        let mut line = String::new();
        if lines.read_line(&mut line)? <= 2 {
            break;
        }
        let line = line.to_ascii_lowercase();
        if let Some(value) = line.strip_prefix("content-length:") {
            length = value.trim().parse().unwrap_or(0);
        }
        if let Some(value) = line.strip_prefix("range: bytes=") {
            let from = value.split('-').next().and_then(|from| from.parse::<usize>().ok());
            range = from.filter(|from| *from < film.len());
        }
    }
    let mut body = vec![0; length];
    lines.read_exact(&mut body)?;
    let (kind, content) = match first.split_whitespace().nth(1) {
        Some("/film.mp4") => ("video/mp4", film),
        Some("/") => ("text/html; charset=utf-8", PAGE.as_bytes()),
        _ => ("text/plain", &b""[..]),
    };
    // A browser jumps only in a film of which it can ask for a part.
    let (status, content, part) = match range.filter(|_| kind == "video/mp4") {
        Some(from) => {
            let n = film.len();
            let part = format!("Content-Range: bytes {from}-{}/{n}\r\n", n - 1);
            ("206 Partial Content", &content[from..], part)
        }
        None => ("200 OK", content, String::new()),
    };
    let n = content.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {n}\r\n{part}\
         Accept-Ranges: bytes\r\nConnection: close\r\n\r\n"
    )?;
    stream.write_all(content)?;
    Ok(first.starts_with("POST /told").then(|| String::from_utf8_lossy(&body).into_owned()))
}

/// What a page tells that a browser opens; `None` without a browser.
fn report_of_browser(film: &[u8]) -> Option<Value> {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = format!("http://{}/", listener.local_addr().expect("an address"));
    let profile = tempfile::tempdir().expect("a folder");
    let start = |name: &&str| {
        let mut command = Command::new(name);
        command.args(["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run"]);
        command.arg("--autoplay-policy=no-user-gesture-required");
        command.arg(format!("--user-data-dir={}", profile.path().display())).arg(&address);
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()
    };
    let _browser = Browser(BROWSERS.iter().find_map(start)?);
    listener.set_nonblocking(true).expect("a listener that does not block");
    let started = Instant::now();
    loop {
        assert!(started.elapsed() < PATIENCE, "the browser tells nothing");
        let Ok((stream, _)) = listener.accept() else {
            std::thread::sleep(Duration::from_millis(5));
            continue;
        };
        stream.set_nonblocking(false).expect("a stream that blocks");
        // A browser opens connections that it does not use.
        stream.set_read_timeout(Some(Duration::from_millis(500))).expect("a timeout");
        if let Ok(Some(report)) = serve(stream, film) {
            return Some(json(&report));
        }
    }
}

#[test]
fn a_browser_plays_the_film() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("film.mp4");
    film(&out, &["--size", "640x360", "--fps", "10", "--to", "1.5", "--view", "perspective"]);
    let film = fs::read(&out).expect("a film");
    let Some(report) = report_of_browser(&film) else {
        eprintln!("skipped: none of {BROWSERS:?} is installed to play the film");
        return;
    };
    assert_eq!(report["error"], Value::Null, "{report}");
    assert_eq!((&report["width"], &report["height"]), (&json("640"), &json("360")), "{report}");
    assert_eq!(report["ended"], Value::Bool(true), "{report}");
    let duration_s = report["duration_s"].as_f64().expect("a duration");
    assert!((duration_s - 1.6).abs() < 0.02, "{report}");
    let seen = report["seen"].as_array().expect("three instants");
    let hashes: std::collections::BTreeSet<i64> =
        seen.iter().filter_map(|of| of["hash"].as_i64()).collect();
    assert_eq!(hashes.len(), 3, "something moves: {report}");
    // A light ground and no picture that could not be decoded.
    let is_light =
        |of: &Value| of["mean"].as_f64().is_some_and(|mean| (200.0..255.0).contains(&mean));
    assert!(seen.iter().all(is_light), "{report}");
}
