//! Tests in ISO-MME as tables: times, cut channels and lines that are no values.

use super::*;
use crate::data::{Channel, Table, read_any_series};

fn channel(pairs: &[(&str, &str)], values: &[&str]) -> String {
    let head: String = pairs.iter().map(|(key, value)| format!("{key:<28}:{value}\n")).collect();
    head + &values.join("\n") + "\n"
}

/// A test with a time of its own, a force over it and an acceleration with an implicit time.
fn write(folder: &Path, newline: &str) -> PathBuf {
    let inner = folder.join("CHANNEL");
    std::fs::create_dir(&inner).unwrap();
    let put = |path: PathBuf, text: String| {
        let bytes: Vec<u8> = text.replace('\n', newline).chars().map(|c| c as u8).collect();
        std::fs::write(path, bytes).unwrap();
    };
    let mme = channel(&[("Laboratory name", "Pr\u{fc}fer"), ("Data format", "ISO-MME")], &[]);
    put(folder.join("t.mme"), mme);
    let time =
        [("Channel code", "11TIRS000000TIRP"), ("Name of the channel", "time"), ("Unit", "ms")];
    put(inner.join("T.001"), channel(&time, &["0", "1", "2"]));
    let force = [
        ("CHANNEL CODE", "11BARR000000FOXP"),
        ("Name of the channel", "Kraft"),
        ("Reference channel", "explicit"),
        ("Reference channel name", "11TIRS000000TIRP"),
        ("Unit", "kN"),
        ("Data status", "ok"),
    ];
    put(inner.join("t.002"), channel(&force, &["-1", "-2", "-1"]));
    let other = [
        ("Channel code", "11SEAT000000ACXP"),
        ("Reference channel", "implicit"),
        ("Time of first sample", "-0.001"),
        ("Sampling interval", "0.0005"),
        ("Unit", "g"),
    ];
    put(inner.join("t.003"), channel(&other, &["0", "NOVALUE", "3", "4"]));
    folder.join("t.mme")
}

#[test]
fn explicit_and_implicit_times_are_parts() {
    for newline in ["\n", "\r\n"] {
        let folder = tempfile::tempdir().unwrap();
        let path = write(folder.path(), newline);
        let table = Table::read(&path).unwrap();
        assert_eq!(table.header(), ["time [s]", "11BARR000000FOXP Kraft [kN]"]);
        assert_eq!(table.sheet().unwrap().all.len(), 2);
        let map = "fx_body=2:kN,fy_body=none".parse().unwrap();
        let loaded = read_any_series(&path, Some(&map)).unwrap();
        assert_eq!(loaded.series.time_s(), [0.0, 0.001, 0.002]);
        assert_eq!(loaded.series.require(Channel::FxBody).unwrap(), [-1e3, -2e3, -1e3]);
        let beside = crate::data::parts_beside(&path);
        assert_eq!(beside.len(), 4, "{beside:?}");
        assert!(beside[0] == path && beside[1].ends_with("CHANNEL/T.001"), "{beside:?}");
        // The other part has no channel with all of its samples.
        let alone = folder.path().join("CHANNEL/t.002");
        assert!(Table::read(&alone).is_err());
    }
}

#[test]
fn a_cut_channel_and_another_axis_are_said() {
    let keys = [
        ("Channel code", "11SEAT000000ACYP"),
        ("Time of first sample", "-0.1"),
        ("Sampling interval", "0.1"),
        ("Number of samples", "3"),
    ];
    let doubts = |values: &[&str]| {
        let text = channel(&keys, values);
        let settings = ReadSettings::default();
        as_table(Path::new("a.001"), &text, &settings).unwrap().unwrap().said.doubts
    };
    assert!(doubts(&["1", "2"])[0].contains("has 2 samples and says 3"));
    let whole = doubts(&["1", "2", "3"]);
    assert!(whole.len() == 1 && whole[0].contains("to the right and down"), "{whole:?}");
}

/// The samples of a channel that failed are no measurement; those of a questionable one are read and told.
#[test]
fn a_channel_whose_status_says_that_it_failed_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), "\n");
    let force = folder.path().join("CHANNEL/t.002");
    let good = std::fs::read_to_string(&force).unwrap();
    let failed = good.replace("11BARR000000FOXP", "11BARR000000FOYP");
    let failed = failed.replace(":ok", ":Channel failed");
    std::fs::write(folder.path().join("CHANNEL/t.004"), &failed).unwrap();
    std::fs::write(&force, good.replace(":ok", ":questionable data")).unwrap();
    let table = Table::read(&path).unwrap();
    assert_eq!(table.header(), ["time [s]", "11BARR000000FOXP Kraft [kN]"]);
    let text = channel(&[("Laboratory name", "a"), ("Data format", "ISO-MME")], &[]);
    let said = as_table(&path, &text, &ReadSettings::default()).unwrap().unwrap().said;
    let doubts = said.doubts.join("; ");
    for expected in
        ["left out: 11BARR000000FOYP (Channel failed)", "FOXP: data status questionable data"]
    {
        assert!(doubts.contains(expected), "{expected}: {doubts}");
    }
    // One that is opened alone says so, too.
    let keys = [
        ("Channel code", "11SEAT000000ACXP"),
        ("Sampling interval", "0.1"),
        ("Data status", "channel failed"),
    ];
    let alone = channel(&keys, &["1", "2"]);
    let error = as_table(Path::new("a.001"), &alone, &ReadSettings::default()).err().unwrap();
    assert!(error.to_string().contains("11SEAT000000ACXP (channel failed)"), "{error}");
}

/// The extremes that laboratories write beside the samples tell of a channel that was changed later.
#[test]
fn an_extreme_that_is_not_among_the_samples_is_said() {
    let remark = |largest: &str, smallest: &str| {
        let keys = [
            ("Channel code", "11SEAT000000ACXP"),
            ("Time of first sample", "0"),
            ("First global maximum value", largest),
            ("First global minimum value", smallest),
        ];
        let text = channel(&keys, &["0", "-301.2", "12.5"]);
        MmeChannel::parse("a.001".into(), &text).unwrap().remark()
    };
    assert_eq!(remark("12.5", "-301"), None);
    assert_eq!(remark("NOVALUE", "NOVALUE"), None);
    let other = remark("12.5", "-30.7").unwrap();
    assert!(other.contains("the minimum -301.2 and says -30.7"), "{other}");
    assert!(remark("1250", "-301.2").is_some());
}

/// A time in a unit that is none is no time in seconds, and one of two times is not guessed.
#[test]
fn a_time_that_is_not_known_is_none() {
    let of = |code: &str, more: &[(&str, &str)]| {
        let keys = [&[("Channel code", code)][..], more].concat();
        MmeChannel::parse("a.001".into(), &channel(&keys, &["0", "1"])).unwrap()
    };
    let force = of("11BARR000000FOXP", &[("Reference channel", "explicit")]);
    let [us, other] = ["us", "fortnights"].map(|unit| of("11TIRS000000TIRP", &[("Unit", unit)]));
    let again = of("12TIRS000000TIRP", &[]);
    let all = [force, us];
    assert_eq!(explicit_s(&all, &all[0]), Some(vec![0.0, 1e-6]));
    let [force, us] = all;
    let all = [force, other];
    assert_eq!(explicit_s(&all, &all[0]), None);
    let [force, _] = all;
    let all = [force, us, again];
    assert_eq!(explicit_s(&all, &all[0]), None);
}

#[test]
fn a_line_that_is_no_value_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.001");
    let keys = [("Channel code", "X"), ("Sampling interval", "0.1"), ("Unit", "N")];
    std::fs::write(&path, channel(&keys, &["1", "2 3"])).unwrap();
    let error = Table::read(&path).unwrap_err().to_string();
    assert!(error.contains("a.001:5:1: "), "{error}");
    std::fs::write(&path, channel(&keys, &["1", "2"])).unwrap();
    assert_eq!(Table::read(&path).unwrap().n_rows(), 2);
}
