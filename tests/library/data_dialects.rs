//! The same force history in the formats in which measurement and simulation tools export it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;

use approx::assert_relative_eq;
use impactlab_core::data::{
    Channel, ColumnMap, Existing, FileKind, Loaded, Note, ReadSettings, Separator, TimeSeries,
    map_from_proposals, propose_columns, read_any_series, read_force_file, write_series_csv,
};
use proptest::prelude::*;

fn read(content: impl AsRef<[u8]>, map: &str) -> Loaded {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    fs::write(&path, content).unwrap();
    let map: ColumnMap = map.parse().unwrap();
    let map = map.iter().next().is_some().then_some(&map);
    read_force_file(&path, map).unwrap()
}

fn utf16(text: &str, to_bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
    let units = std::iter::once(0xfeff).chain(text.encode_utf16());
    units.flat_map(to_bytes).collect()
}

/// Checks the history: forces of 0, 1500 and −250.5 N along x and half of that along y, at 0, 1 and
/// 2 ms.
fn assert_is_the_history(loaded: &Loaded, what: &str) {
    let fx = loaded.series.require(Channel::Fx).unwrap();
    let fy = loaded.series.require(Channel::Fy).unwrap();
    assert_eq!(fx.len(), 3, "{what}");
    for (i, expected) in [0.0, 1500.0, -250.5].into_iter().enumerate() {
        let time_s = loaded.series.time_s()[i];
        assert!((time_s - i as f64 * 1e-3).abs() < 1e-12, "{what}: {time_s}");
        assert!((fx[i] - expected).abs() < 1e-9, "{what}: {fx:?}");
        assert!((fy[i] - expected / 2.0).abs() < 1e-9, "{what}: {fy:?}");
    }
}

#[test]
fn one_history_in_many_dialects() {
    let si = "0,0,0\n0.001,1500,750\n0.002,-250.5,-125.25\n";
    let milli = "0;0;0\n1;1,5;0,75\n2;-0,2505;-0,12525\n";
    let blanks = "  0   0  0\n 1\t 1.5   0.75\n\n 2 -2.505e-1 -1.2525D-01  \n";
    for (content, map) in [
        (format!("time_s,fx_n,fy_n\n{si}"), ""),
        (format!("\u{feff}time_s,fx_n,fy_n\r\n{}", si.replace('\n', "\r\n")), ""),
        (format!("time_s,fx_n,fy_n\n{si}").replace('\n', "\r"), ""),
        (format!("\"Time [s]\",\"Fx [N]\",\"Fy [N]\"\n{si}"), ""),
        (
            format!("\"Force, X (N)\",T\n{si}").replace("\"Force, X (N)\",T", "T (sec),FX_N,FY_N"),
            "",
        ),
        (format!("t [ms];Fx [kN];Fy [kN]\n{milli}"), ""),
        (format!("t;fx;fy\nms;kN;kN\n{milli}"), ""),
        (format!("t;fx;fy\n[ms];[kN];[kN]\n{milli}"), ""),
        (format!("t in ms\tFx / kN\tFy / kN\n{}", milli.replace(';', "\t")), ""),
        (format!("t,ms;Fx,kN;Fy,kN;\n{}", milli.replace('\n', ";\n")), ""),
        (format!("t_ms;fx_kn;fy_kn\n{}", milli.replace('\n', ";\n")), ""),
        (format!("  t_ms fx_kn   fy_kn\n{blanks}"), ""),
        (format!("# t_ms fx_kn fy_kn\n{blanks}"), ""),
        (format!("Crash test 12, run 3\nby someone\n\nt_ms;fx_kn;fy_kn\n{milli}"), ""),
        (format!("Speed;50;km/h\nt_ms;fx_kn;fy_kn\n{milli}"), ""),
        (format!("Mass;1500\nDate;1.2.2026;\nt_ms;fx_kn;fy_kn\n{milli}"), ""),
        (format!("% comment\n// t\n!\n$ x\nt_ms;fx_kn;fy_kn\n# late\n{milli};;\n"), ""),
        (milli.to_owned(), "time=1:ms,fx=2:kN,fy=3:kN"),
        (si.to_owned(), "time=1,fx=2,fy=3"),
        (format!("Zeit [ms];Kraft längs [kN];Quer;\n{milli}"), "fx=Kraft längs,fy=quer:kN"),
        (format!("Zeit [ms];Kraft längs [kN];Fy [kg]\n{milli}"), "fx=2,fy=Fy:kN"),
        (format!("t [ms];fx [kN];fy [kN]\n{milli}").replace(',', "."), ""),
    ] {
        assert_is_the_history(&read(&content, map), &content);
    }
}

#[test]
fn other_encodings_are_read() {
    let text = "Zeit [ms];Kraft X [kN];Kraft Y [kN];Gierwinkel [°]\n0;0;0;0\n1;1,5;0,75;9\n2;-0,2505;-0,12525;180\n";
    let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for (bytes, encoding) in [
        (text.as_bytes().to_vec(), "UTF-8"),
        (utf16(text, u16::to_le_bytes), "UTF-16LE"),
        (utf16(text, u16::to_be_bytes), "UTF-16BE"),
        (latin1, "windows-1252"),
    ] {
        let loaded = read(bytes, "");
        assert_is_the_history(&loaded, encoding);
        assert_eq!(loaded.encoding, encoding);
        assert_eq!(loaded.dialect.separator, Separator::Semicolon);
        let yaw = loaded.series.require(Channel::Yaw).unwrap();
        assert_relative_eq!(yaw[2], std::f64::consts::PI);
    }
}

#[test]
fn what_was_assumed_and_left_out_is_noted() {
    let loaded = read("t,Fx [N],fy,v,Mz [kg],x\n0,1,1,1,1,0\n1,1,1,1,1,0\n", "");
    let notes: Vec<String> = loaded.notes.iter().map(Note::to_string).collect();
    assert_eq!(
        notes,
        [
            r#"column 1 "t" names no unit; taken as s"#,
            r#"column 6 "x" names no unit; taken as m"#,
            r#"column 3 "fy" names no unit; taken as N"#,
            r#"column 5 "Mz [kg]" is left out: "kg" is no unit of moment"#,
            "not recognised: v",
        ]
    );
}

#[test]
fn the_kind_of_a_file_is_seen_from_its_columns() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    for (header, kind) in [
        ("t,fx,fy", FileKind::Force),
        ("t,fx_body,fy_body", FileKind::Force),
        ("t,x,y", FileKind::Trajectory),
        ("t,x,y,fx_body,fy_body", FileKind::Trajectory),
        ("t,steer [deg]", FileKind::Steer),
        ("t,steer_fl,steer_fr", FileKind::Steer),
    ] {
        let row = vec!["0.5"; header.split(',').count() - 1].join(",");
        fs::write(&path, format!("{header}\n0,{row}\n1,{row}\n")).unwrap();
        assert_eq!(read_any_series(&path, None).unwrap().kind, kind, "{header}");
    }
}

#[test]
fn a_dialog_is_shown_the_columns_and_can_take_the_guesses() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    fs::write(&path, "Zeit [ms];Kraft 1;Fy [N]\n0;0,5;7\n1;1,5;8\n").unwrap();
    let mut proposals = propose_columns(&path, &ReadSettings::default()).unwrap();
    let names: Vec<&str> = proposals.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["Zeit [ms]", "Kraft 1", "Fy [N]"]);
    assert_eq!(proposals[1].samples, ["0,5", "1,5"]);
    let channels = proposals.iter().map(|column| column.guess.map(|(channel, _)| channel));
    assert!(channels.eq([Some(Channel::Time), None, Some(Channel::Fy)]));
    proposals[1].guess = Some((Channel::Fx, None));
    let map = map_from_proposals(&proposals);
    assert_eq!(map.to_string(), "time=1:ms,fx=2,fy=3:N");
    let loaded = read_force_file(&path, Some(&map)).unwrap();
    assert_eq!(loaded.series.require(Channel::Fx).unwrap(), [0.5, 1.5]);
}

proptest! {
    #[test]
    fn a_written_series_reads_back_the_same(
        steps in prop::collection::vec(1e-6..1.0_f64, 2..40),
        scale in -1e6..1e6_f64,
    ) {
        let time_s: Vec<f64> = steps
            .iter()
            .scan(-0.3, |time, step| { *time += step; Some(*time) })
            .collect();
        let mut series = TimeSeries::new(time_s).unwrap();
        for &channel in Channel::ALL.iter().filter(|channel| **channel != Channel::Time) {
            // The angle of a road wheel is below 0.9 rad, the torque of a brake not below zero.
            let is_brake = channel.header().starts_with("brake_");
            let scale = if is_brake { scale.abs() } else { scale };
            let values = steps.iter().map(|step| step * scale / 1.2e6).collect();
            series.insert(channel, values).unwrap();
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f.csv");
        write_series_csv(&path, Existing::Replace, &series).unwrap();
        prop_assert_eq!(read_any_series(&path, None).unwrap().series, series);
    }
}

#[test]
fn a_failed_write_leaves_the_file_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("f.csv");
    fs::write(&path, "before").unwrap();
    let error = impactlab_core::data::write_atomically(&path, Existing::Replace, |out| {
        out.write_all(b"half")?;
        Err(std::io::Error::other("disk full"))
    });
    assert!(error.is_err());
    assert_eq!(fs::read_to_string(&path).unwrap(), "before");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// These were read as tables, whose header or number of fields was refused then.
#[test]
fn files_of_tests_scenes_and_drawings_are_called_by_their_names() {
    let scene = "is a scene of bodies (glTF); a motion has to be given as numbers, as CSV";
    let drawing =
        "is a drawing (DXF); name it in a site file as the ground of a scene, [dxf] file = \"…\"";
    let mme = "is a test in ISO-MME without channels over time; put its channels";
    let folder = tempfile::tempdir().unwrap();
    for (name, content, message) in [
        ("car.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": []}\n", scene),
        ("car.glb", "glTF\u{2}\0\0\0", scene),
        ("road.dxf", "999\nmade by\n  0\nSECTION\n  2\nHEADER\n", drawing),
        ("binary.dxf", "AutoCAD Binary DXF\r\n\u{1a}\0", drawing),
        ("a.svg", "<svg xmlns=\"x\"></svg>\n", "is a picture (SVG); a curve has to be given"),
        ("test.mme", "Data format edition number    :1.6\nLaboratory name               :A\n", mme),
        (
            "test.chn",
            "Instrumentation standard      :ISO 6487\nNumber of channels            :2\n",
            mme,
        ),
        (
            "test.001",
            "Test object number            :1\nName of the channel           :HEAD\n0.1\n0.2\n",
            mme,
        ),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        let error = read_any_series(&path, None).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{}: {message}", path.display())), "{error}");
    }
    // A table of numbers with such words is a table.
    let path = folder.path().join("t.csv");
    std::fs::write(&path, "# Laboratory name: A\ntime_s,fx_n,fy_n\n0,0,0\n0.1,5,1\n0.2,0,0\n")
        .unwrap();
    assert_eq!(read_any_series(&path, None).unwrap().series.n_samples(), 3);
}

#[test]
fn thousands_are_read_as_the_numbers_or_the_map_say() {
    let read = |text: &str, map: &str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f.csv");
        fs::write(&path, text).unwrap();
        let map: ColumnMap = map.parse().unwrap();
        read_any_series(&path, Some(&map))
    };
    let fx = |text: &str, map: &str| {
        read(text, map).unwrap().series.require(Channel::Fx).unwrap().to_vec()
    };
    let german = "t [ms];Fx [N];Fy [N]\n0;0,5;0\n1;1.860;0\n2;12.345,5;0\n";
    assert_eq!(fx(german, ""), [0.5, 1860.0, 12_345.5]);
    let swiss = "t [ms];Fx [N];Fy [N]\n0;0.5;0\n1;1'860;0\n2;12\u{2019}345.5;0\n";
    assert_eq!(fx(swiss, ""), [0.5, 1860.0, 12_345.5]);
    let english = "t [ms],Fx [N],Fy [N]\n0,0.5,0\n1,\"1,860\",0\n2,\"12,345.5\",0\n";
    assert_eq!(fx(english, ""), [0.5, 1860.0, 12_345.5]);
    // The first number with a fraction stands behind the lines in which the header is looked for.
    let mut late: String = (0..400).map(|i| format!("{i};1.860;0\n")).collect();
    late = format!("t [ms];Fx [N];Fy [N]\n{late}400;0,5;0\n");
    assert_eq!(fx(&late, "")[0], 1860.0);
    // Three decimals beside a number that can have no thousands.
    assert_eq!(fx("t [s];Fx [N];Fy [N]\n0.001;1.860;0\n0.002;2;0\n", ""), [1.86, 2.0]);
    let open = "t [ms];Fx [N];Fy [N]\n0;5;0\n1;1.860;0\n2;12.345;0\n";
    let error = read(open, "").unwrap_err();
    let message = error.to_string();
    let says = "f.csv:3:2: \"Fx [N]\" is \"1.860\", with a decimal sign or with thousands, and nothing in \
                the file says which; --map \"decimal=point\" or --map \"thousands=point\"";
    assert!(message.contains(says), "{message}");
    let labels: Vec<String> =
        error.corrections(None).iter().map(|of| of.label().to_owned()).collect();
    assert_eq!(labels, ["Decimal points", "Points between thousands"]);
    for (map, expected) in [
        ("decimal=point", [5.0, 1.86, 12.345]),
        ("thousands=point", [5.0, 1860.0, 12_345.0]),
        ("decimal=comma", [5.0, 1860.0, 12_345.0]),
        ("thousands=apostrophe", [5.0, 1.86, 12.345]),
    ] {
        assert_eq!(fx(open, map), expected, "{map}");
    }
    // What the map says is not bent: this is no number with points between thousands.
    assert!(read("t [ms];Fx [N];Fy [N]\n0;0.5;0\n1;2;0\n", "thousands=point").is_err());
}

#[test]
fn a_separator_that_is_said_counts() {
    // Which of them divides the fields is found wrong: there are as many numbers between commas.
    let text = "t;fx;fy\n0,5;1,5;2,5\n1,5;2,5;3,5\n";
    let loaded = read(text, "separator=semicolon,time=1:s,fx=2:N,fy=3:N");
    assert_eq!(loaded.dialect.separator, Separator::Semicolon);
    assert_eq!(loaded.series.require(Channel::Fy).unwrap(), [2.5, 3.5]);
}
