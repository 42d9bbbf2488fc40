//! Inputs that are made to take the memory or the time of the machine, or to write to the terminal.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use crate::program::{program, text};

/// Longest time for an input to be refused, on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(50);

/// Runs the program with an address space of this many KiB, so that the test fails rather than the
/// machine.
fn within(kib: u64, args: &[&str]) -> (i32, String, String) {
    let mut command = Command::new("sh");
    // A program that blocks is ended: `timeout` is part of every system with a shell.
    command.arg("-c").arg(format!("ulimit -v {kib}; exec timeout 60 \"$0\" \"$@\""));
    command.arg(program().get_program()).args(args);
    let started = Instant::now();
    let Output { status, stdout, stderr } = command.output().unwrap();
    assert!(started.elapsed() < PATIENCE, "{:?} for {args:?}", started.elapsed());
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let (out, err) = (text(stdout), text(stderr));
    (status.code().unwrap_or_else(|| panic!("killed: {args:?}: {out}{err}")), out, err)
}

#[test]
fn a_column_of_short_numbers_takes_a_small_multiple_of_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("column.csv");
    fs::write(&path, "x\n".to_owned() + &"1\n".repeat(5_000_000)).unwrap();
    // The program alone needs some 300 MiB of address space. These 10 MB took 930 MB more.
    let (code, out, err) = within(600 << 10, &["check", text(&path)]);
    assert_eq!(code, 1, "{err}");
    assert!(out.contains("column.csv:1: no column for time, fx and fy"), "{out}{err}");
}

/// Address space for inputs that are refused at once.
const REFUSED_KIB: u64 = 1 << 20;

/// The message for arguments that are refused, after checking that it is one line.
fn refused(args: &[&str]) -> String {
    let (code, out, err) = within(REFUSED_KIB, args);
    assert_eq!((code, out.as_str()), (1, ""), "{args:?}: {err}");
    let message = err.strip_prefix("error: ").unwrap_or_else(|| panic!("{args:?}: {err}"));
    assert_eq!(message.lines().count(), 1, "{message}");
    message.trim_end().to_owned()
}

#[test]
fn deep_nesting_and_large_settings_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        path
    };
    let n = 100_000;
    let json = [
        "[".repeat(n),
        r#"{"a":"#.repeat(n),
        format!(r#"{{"question":{}"#, "[".repeat(n)),
        format!(r#"{{"question":"check","paths":{}"#, "[".repeat(n)),
    ];
    for content in json {
        let path = write("question.json", &content);
        let message = refused(&["ask", text(&path)]);
        assert!(message.starts_with(&format!("{}: is no request", path.display())), "{message}");
        let path = write("comparison.json", &content);
        assert!(impactlab_networks::response::evaluate::Comparison::load(&path).is_err());
    }
    let key = "a.".repeat(n) + "a";
    for content in [
        format!("x = {}", "[".repeat(n)),
        format!("x = {}", "{a=".repeat(n)),
        format!("{key} = 1"),
        format!("[{key}]"),
        format!("[[{key}]]"),
        format!("x = {{ {key} = 1 }}"),
        "[x]\n".to_owned() + &"y.z = 1\n".repeat(n),
    ] {
        let path = write("scenario.toml", &content);
        for args in [
            &["impact", text(&path)][..],
            &["simulate", "--speed", "20", "--vehicle", text(&path)],
            &[
                "train",
                "force",
                "--data",
                "datasets/fea",
                "--out",
                text(&folder.path().join("model.safetensors")),
                "--config",
                text(&path),
            ],
        ] {
            let message = refused(args);
            let place = format!("{}:", path.display());
            assert!(message.starts_with(&place) && message.len() < 1000, "{message:.300}");
        }
    }
    let path = write("large.toml", &"# comment\n".repeat(200_000));
    let size = "has 2000000 bytes, at most 1048576 are read; split it or thin it out";
    assert_eq!(refused(&["impact", text(&path)]), format!("{}: {size}", path.display()));
    let path = write("large.json", &" ".repeat(2_000_000));
    assert_eq!(refused(&["ask", text(&path)]), format!("{}: {size}", path.display()));
}

#[test]
fn pipes_block_no_command() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
    let (pipe, out) = (text(&path), folder.path().join("out"));
    let out = text(&out);
    for args in [
        &["ask", pipe][..],
        &["impact", pipe],
        &["simulate", "--speed", "20", "--vehicle", pipe],
        &["simulate", "--vehicle", "reference-2000", "--force", pipe],
        &["simulate", "--vehicle", "reference-2000", "--steer", pipe],
        &["predict", "force", "--scenario", "pit-right-rear", "--model", pipe],
        &["predict", "--scenario", "pit-right-rear", "--out", out, "--response-model", pipe],
        &["train", "force", "--data", "datasets/fea", "--out", out, "--config", pipe],
    ] {
        assert_eq!(refused(args), format!("{pipe}: is a pipe, expected a file"), "{args:?}");
    }
    let (code, out, _) = within(REFUSED_KIB, &["check", pipe]);
    assert_eq!(code, 1);
    assert!(out.contains("pipe: is a pipe, expected a file"), "{out}");
}

#[test]
fn names_in_files_do_not_act_on_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let (hidden, clear) = ("\u{202e}\u{9b}2J", "\x1b[2J");
    let root = folder.path().join(format!("set{clear}{hidden}\n0 problems"));
    fs::create_dir_all(root.join("trajectories")).unwrap();
    fs::write(root.join("cases.csv"), format!("case,{hidden}\na{hidden},1\nb,2\n")).unwrap();
    let rows = "t,x,y,yaw,{}\n0,0,0,0,1\n0.1,1,0,0,1\n".replace("{}", hidden);
    fs::write(root.join("trajectories/b.csv"), &rows).unwrap();
    let file = folder.path().join(format!("file{clear}{hidden}.csv"));
    fs::write(&file, &rows).unwrap();
    let vehicle = fs::read_to_string("assets/vehicles/reference-2000.toml").unwrap();
    let start = vehicle.find("name = ").unwrap();
    let end = start + vehicle[start..].find('\n').unwrap();
    let name = "name = \"x\\u001b[2J\\u202e\\u009b\"";
    let vehicle = format!("{}{name}{}", &vehicle[..start], &vehicle[end..]);
    let vehicle_file = folder.path().join(format!("vehicle{clear}{hidden}.toml"));
    fs::write(&vehicle_file, vehicle).unwrap();
    let missing = folder.path().join(format!("missing{clear}{hidden}.toml"));
    let paths = [&root, &file, &vehicle_file, &missing].map(|path| text(path));
    let [root, file, vehicle, missing] = paths;
    for args in [
        &["check", root, file, vehicle, missing][..],
        &["check", "--json", root, file, vehicle, missing],
        &["simulate", "--speed", "20", "--vehicle", vehicle],
        &["simulate", "--speed", "20", "--vehicle", vehicle, "--json"],
        &["simulate", "--dataset", root],
        &["impact", missing],
        &["render", file, "--out", missing],
        &["check", "--no-such-option", missing],
        &["no-such-command", missing],
    ] {
        let (_, out, err) = within(REFUSED_KIB, args);
        for printed in [&out, &err] {
            let acts = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
            assert!(!printed.contains(acts), "{args:?}: {printed:?}");
        }
        assert!(!out.contains("\n0 problems") && !err.contains("\n0 problems"), "{out}{err}");
        if args.contains(&"--json") {
            serde_json::from_str::<serde_json::Value>(&out).unwrap();
        }
    }
}
