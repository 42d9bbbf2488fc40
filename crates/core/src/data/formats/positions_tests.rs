//! Logs of satellite receivers as tables: places, what is left out, and what is said of it.

use super::*;
use crate::data::{Channel, SheetRef, read_any_series};

fn read(name: &str, text: &str) -> Result<crate::data::Loaded, DataError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    read_any_series(&path, None)
}

fn sentence(body: &str) -> String {
    let sum = body.bytes().fold(0, |sum: u8, byte| sum ^ byte);
    format!("${body}*{sum:02X}\r\n")
}

#[test]
fn a_gpx_track_becomes_a_path_in_metres() {
    let point = |lon: f64, second: u32| {
        format!(
            "<trkpt lat=\"52.0\" lon=\"{lon}\"><ele>9</ele><time>2026-11-25T10:00:0{second}Z</time></trkpt>"
        )
    };
    let text = format!(
        "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\"><trk><trkseg>{}{}</trkseg></trk></gpx>",
        point(-1.0, 0),
        point(-0.999, 5)
    );
    let loaded = read("a.gpx", &text).unwrap();
    // 0.001° of longitude at 52° is 68.7 m.
    let x = loaded.series.require(Channel::X).unwrap();
    assert!((x[1] - 68.68).abs() < 0.05 && x[0] == 0.0, "{x:?}");
    assert_eq!(loaded.series.time_s(), [36_000.0, 36_005.0]);
    let said = |loaded: &crate::data::Loaded| {
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        notes.join("\n").contains("one of 2 parts of the file; not read are sheet=2 \"track 2\"")
    };
    assert!(!said(&loaded), "{:?}", loaded.notes);
    let twice = text.replace("</trk>", "</trk><trk></trk>");
    let segment = text.split("<trk>").nth(1).and_then(|of| of.split("</trk>").next()).unwrap();
    let twice = twice.replace("<trk></trk>", &format!("<trk>{segment}</trk>"));
    assert!(said(&read("a.gpx", &twice).unwrap()));
    assert!(read("a.gpx", "<?xml version=\"1.0\"?>\n<gpx></gpx>").is_err());
    let timeless = text.replace("<time>", "<cmt>").replace("</time>", "</cmt>");
    let error = read("a.gpx", &timeless).unwrap_err().to_string();
    assert!(error.contains("its points have no times"), "{error}");
}

#[test]
fn sentences_become_a_path_and_bad_ones_are_counted() {
    let rmc = |seconds: &str, lon: &str, status: char| {
        sentence(&format!("GPRMC,1000{seconds},{status},5200.0000,N,{lon},W,10.0,090.0,251126,,"))
    };
    let good = rmc("00.00", "00100.0000", 'A') + &rmc("01.00", "00059.9950", 'A');
    let bad = good.clone() + &rmc("02.00", "00059.9900", 'V') + "$GPRMC,100003.00,A,1,N*00\r\n";
    let loaded = read("a.nmea", &bad).unwrap();
    assert_eq!(loaded.series.n_samples(), 2);
    let x = loaded.series.require(Channel::X).unwrap();
    assert!((x[1] - 5.72).abs() < 0.01, "{x:?}");
    let speed = loaded.series.require(Channel::Speed).unwrap();
    assert!((speed[0] - 5.144_44).abs() < 1e-4, "{speed:?}");
    assert!(loaded.series.require(Channel::Yaw).unwrap()[0].abs() < 1e-12);
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    for said in [
        "1 sentences with a wrong",
        "1 sentences without a position",
        "the antenna",
        "course over ground",
    ] {
        assert!(notes.iter().any(|note| note.contains(said)), "{said}: {notes:?}");
    }
}

/// Signs that were changed on the way are said, and not that there are no positions.
#[test]
fn a_log_of_wrong_checksums_says_how_many() {
    let rmc = |second: u32| {
        sentence(&format!("GPRMC,10000{second}.00,A,5200.0000,N,00059.9950,W,10.0,090.0,251126,,"))
    };
    let wrong = |second: u32| rmc(second).replace(",10.0,", ",11.0,");
    for n_good in [0, 1] {
        let text: String = (0..n_good).map(rmc).chain((n_good..9).map(wrong)).collect();
        let error = read("a.nmea", &text).unwrap_err().to_string();
        let said = format!("two are read: {} sentences with a wrong checksum", 9 - n_good);
        assert!(error.contains(&said), "{error}");
    }
}

/// A log was refused for its sentences RMC, beside which good positions stood.
#[test]
fn gga_is_read_where_rmc_is_void() {
    let rmc = |second: u32| {
        sentence(&format!("GPRMC,10000{second}.00,V,5200.0000,N,00059.9950,W,,,251126,,"))
    };
    let gga = |second: u32| {
        sentence(&format!(
            "GPGGA,10000{second}.00,5200.0000,N,00059.99{second}0,W,1,12,0.7,9.0,M,,M,,"
        ))
    };
    let text: String = (1..4).map(|second| rmc(second) + &gga(second)).collect();
    let loaded = read("a.nmea", &text).unwrap();
    assert_eq!(loaded.series.n_samples(), 3);
    let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
    for said in ["3 sentences without a position", "GGA is read instead"] {
        assert!(notes.iter().any(|note| note.contains(said)), "{said}: {notes:?}");
    }
    let void: String = (1..4).map(rmc).collect();
    let error = read("a.nmea", &void).unwrap_err().to_string();
    assert!(error.contains("3 sentences without a position"), "{error}");
}

#[test]
fn positions_that_were_not_measured_are_said() {
    let estimated = |sentences: [String; 2]| {
        let loaded = read("a.nmea", &sentences.concat()).unwrap();
        let is_said = |note: &crate::data::Note| note.to_string().contains("did not measure");
        loaded.notes.iter().any(is_said)
    };
    for (mode, quality, expected) in [("A", 1, false), ("E", 6, true), ("S", 8, true)] {
        let rmc = |second: u32| {
            sentence(&format!(
                "GPRMC,10000{second}.00,A,5200.0000,N,00059.99{second}0,E,10.0,090.0,251126,,,{mode}"
            ))
        };
        let gga = |second: u32| {
            sentence(&format!(
                "GPGGA,10000{second}.00,5200.0000,N,00059.99{second}0,E,{quality},12,0.7,9.0,M,,M,,"
            ))
        };
        assert_eq!(estimated([rmc(1), rmc(2)]), expected, "mode {mode}");
        assert_eq!(estimated([gga(1), gga(2)]), expected, "quality {quality}");
    }
}

#[test]
fn a_receiver_that_stands_has_no_course() {
    let rmc = |second: u32, course: &str| {
        let lon = 60.0 - 0.005 * f64::from(second);
        sentence(&format!(
            "GPRMC,10000{second}.00,A,5200.0000,N,000{lon:.4},W,10.0,{course},251126,,"
        ))
    };
    let text = rmc(1, "") + &rmc(2, "080.0") + &rmc(3, "") + &rmc(4, "070.0");
    let loaded = read("a.nmea", &text).unwrap();
    let yaw = loaded.series.require(Channel::Yaw).unwrap();
    let yaw_deg: Vec<f64> = yaw.iter().map(|yaw| yaw.to_degrees().round()).collect();
    assert_eq!(yaw_deg, [10.0, 10.0, 10.0, 20.0]);
    let is_said =
        |note: &crate::data::Note| note.to_string().contains("2 sentences have no course");
    assert!(loaded.notes.iter().any(is_said), "{:?}", loaded.notes);
}

/// A receiver names its satellites by turns, another one says each instant twice.
#[test]
fn sentences_of_several_talkers_are_read_once_and_said() {
    let rmc = |talker: &str, second: u32| {
        let lon = 60.0 - 0.005 * f64::from(second);
        sentence(&format!(
            "{talker}RMC,10000{second}.00,A,5200.0000,N,000{lon:.4},W,10.0,090.0,251126,,"
        ))
    };
    let track = |talkers: &[(&str, u32)]| {
        let text: String = talkers.iter().map(|(talker, second)| rmc(talker, *second)).collect();
        let loaded = read("a.nmea", &text).unwrap();
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        (loaded.series.n_samples(), notes.join("\n"))
    };
    let (n, notes) = track(&[("GN", 1), ("GP", 2), ("GN", 3), ("GP", 4)]);
    assert!(n == 4 && notes.contains("GPRMC at 2 instants"), "{n}: {notes}");
    let (n, notes) = track(&[("GP", 1), ("GN", 1), ("GP", 2), ("GN", 2)]);
    assert!(n == 2 && notes.contains("2 sentences GNRMC give the same"), "{n}: {notes}");
    // The other receiver is late.
    let (n, notes) = track(&[("GN", 3), ("GP", 2), ("GN", 5), ("GP", 4)]);
    assert!(n == 2 && notes.contains("another receiver"), "{n}: {notes}");
    let (n, notes) = track(&[("GP", 1), ("GP", 2)]);
    assert!(n == 2 && !notes.contains("GPRMC"), "{n}: {notes}");
}

/// Loggers write a stamp of their own, or the name of a source, in front of each sentence.
#[test]
fn sentences_behind_a_stamp_are_read_and_said() {
    let rmc = |second: u32| {
        let lon = 60.0 - 0.005 * f64::from(second);
        sentence(&format!("GPRMC,10000{second}.00,A,5200.0000,N,000{lon:.4},W,10.0,090.0,251126,,"))
    };
    for prefix in ["2026-01-01T10:00:00 ", "[12:00:00,125] GPS: ", "NMEA,", "\\s:a,c:17*00\\"] {
        let text: String = (1..4).map(|second| format!("{prefix}{}", rmc(second))).collect();
        let loaded = read("a.nmea", &text).unwrap();
        assert_eq!(loaded.series.time_s(), [36_001.0, 36_002.0, 36_003.0], "{prefix}");
        let is_said = |note: &crate::data::Note| note.to_string().contains("front of 3 sentences");
        assert!(loaded.notes.iter().any(is_said), "{prefix}: {:?}", loaded.notes);
    }
    // A row of a table has other cells, which would be lost.
    assert_eq!(kind("0.01,9.81,$GPRMC,100000.00,A"), None);
    assert_eq!(kind("$GPRMC,100000.00,A"), Some("RMC"));
}

/// Two drives in one log lie a day apart, not seconds; a log without dates goes on over midnight as before.
#[test]
fn the_date_of_a_sentence_counts() {
    let rows = |stamps: [(&str, &str); 3]| {
        let text: String = stamps
            .iter()
            .map(|(date, time)| {
                sentence(&format!("GPRMC,{time},A,5200.0000,N,00100.0000,W,10.0,090.0,{date},,"))
            })
            .collect();
        let track = nmea_track(&text, "RMC").ok().unwrap();
        let stamps = track.rows.lines().map(|row| row.split('\t').next().unwrap().to_owned());
        stamps.collect::<Vec<String>>()
    };
    let dated = rows([("311226", "235959.5"), ("010127", "000000.5"), ("020127", "000001")]);
    assert_eq!(dated, ["2026-12-31T23:59:59.5", "2027-01-01T00:00:00.5", "2027-01-02T00:00:01"]);
    for unknown in ["", "321326", "+11126", "0101270"] {
        let plain = rows([("311226", "235959.5"), (unknown, "000000.5"), ("010127", "000001")]);
        assert_eq!(plain, ["23:59:59.5", "00:00:00.5", "00:00:01"], "{unknown:?}");
    }
}

/// Of two talkers, the second one gives instants of another day that the first one leaves out.
#[test]
fn an_instant_of_another_day_is_another_one() {
    let rmc = |talker: &str, date: &str, second: u32| {
        sentence(&format!(
            "{talker}RMC,10000{second}.00,A,5200.0000,N,00100.0000,W,10.0,090.0,{date},,"
        ))
    };
    let text = rmc("GN", "251126", 1) + &rmc("GN", "251126", 2) + &rmc("GP", "261126", 1);
    let track = nmea_track(&text, "RMC").ok().unwrap();
    assert_eq!(track.rows.lines().count(), 3, "{:?}", track.doubts);
}

/// Receivers send positions at 10 Hz and the rest at 1 Hz; those between are a part that can be read.
#[test]
fn positions_that_are_denser_than_speeds_are_a_part_and_said() {
    let track = |step: usize, sheet: Option<SheetRef>| {
        let mut text = String::new();
        for tenth in (0..30_u32).step_by(step) {
            let (time, lon) = (f64::from(tenth) / 10.0, 0.001 * f64::from(tenth));
            let place = format!("5200.0000,N,000{lon:07.4},E");
            text += &sentence(&format!("GPGGA,10000{time:.1},{place},1,12,0.7,9.0,M,,M,,"));
            if tenth % 10 == 0 {
                text += &sentence(&format!("GPRMC,10000{time:.1},A,{place},22.0,090.0,251126,,"));
            }
        }
        let settings = ReadSettings { sheet, ..ReadSettings::default() };
        as_table(Path::new("a.nmea"), &text, &settings).unwrap().unwrap()
    };
    let n_rows = |converted: &Converted| converted.text.lines().count() - 1;
    let of_both = track(1, None);
    let said = of_both.said.doubts.join("; ");
    assert!(said.contains("gives 3 positions, GGA 30"), "{said}");
    assert_eq!((n_rows(&of_both), of_both.said.part.unwrap().all.len()), (3, 2));
    let denser = track(1, Some(SheetRef::Number(2)));
    assert_eq!(n_rows(&denser), 30);
    assert!(!denser.said.doubts.join("; ").contains("RMC"), "{:?}", denser.said.doubts);
    // Of one rate for both, RMC says all.
    let of_one = track(10, None);
    assert_eq!(of_one.said.part.unwrap().all, ["RMC"]);
}
