//! Archives: workbooks, packages of cases and atlases, of which parts are changed; and the checkpoints
//! of reconstructions, with a checksum that fits.

use std::io::{Cursor, Read, Write};
use std::path::Path;

use impactlab_core::data::{Existing, read_any_series};
use impactlab_core::numerics::sha256_hex;
use impactlab_reconstruct::sampler::{SamplerCheckpoint, SamplerSettings, Target, sample};
use impactlab_study::case_file::{CaseFile, Variant, pack, unpack};
use impactlab_study::{CheckRequest, Request};
use impactlab_sweep::atlas::{Atlas, Axis, Measure};
use impactlab_sweep::{Column, Outcome, Rows, RowsMeta};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::harness::{Answer, Format, run};
use crate::mutation::Mutator;

type Parts = Vec<(String, Vec<u8>)>;

/// The parts of an archive; `None` if it is none, or has a part that is too long to be changed.
fn parts_of(bytes: &[u8]) -> Option<Parts> {
    const LONGEST_PART: u64 = 1 << 16;
    let mut archive = ZipArchive::new(Cursor::new(bytes)).ok()?;
    (0..archive.len())
        .map(|idx| {
            let part = archive.by_index(idx).ok()?;
            let (name, mut content) = (part.name().ok()?.into_owned(), Vec::new());
            part.take(LONGEST_PART).read_to_end(&mut content).ok()?;
            Some((name, content))
        })
        .collect()
}

fn zipped(parts: &Parts) -> Option<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, content) in parts {
        zip.start_file(name.as_str(), options).ok()?;
        zip.write_all(content).ok()?;
    }
    Some(zip.finish().ok()?.into_inner())
}

/// Another archive: one part or its name is changed, or bytes of the whole.
fn changed(mutator: &mut Mutator, input: &[u8], other: &[u8]) -> Vec<u8> {
    let parts = if mutator.once_in(4) { None } else { parts_of(input) };
    let Some(mut parts) = parts.filter(|parts| !parts.is_empty()) else {
        return mutator.text(input, other);
    };
    for _ in 0..=mutator.below(2) {
        let at = mutator.below(parts.len());
        let (name, content) = &mut parts[at];
        if mutator.once_in(6) {
            let changed = mutator.text(name.as_bytes(), b"../x");
            *name = String::from_utf8_lossy(&changed).chars().take(300).collect();
        } else {
            *content = mutator.text(content, b"<c r=\"B4294967295\"><v>1</v></c>");
        }
    }
    zipped(&parts).unwrap_or_else(|| mutator.text(input, other))
}

/// A workbook of one sheet.
fn workbook() -> Vec<u8> {
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let relations = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let package = "http://schemas.openxmlformats.org/package/2006/relationships";
    let number = |at: &str, value: f64| format!("<c r=\"{at}\"><v>{value}</v></c>");
    let text = |at: &str, idx: usize| format!("<c r=\"{at}\" t=\"s\"><v>{idx}</v></c>");
    let mut rows =
        format!("<row r=\"1\">{}{}{}</row>", text("A1", 0), text("B1", 1), text("C1", 2));
    for row in 2..8_u32 {
        let at = |column: &str| format!("{column}{row}");
        let time_s = f64::from(row) * 0.01;
        let cells = [number(&at("A"), time_s), number(&at("B"), 500.0), number(&at("C"), 1.5)];
        rows += &format!("<row r=\"{row}\">{}</row>", cells.concat());
    }
    let parts = [
        (
            "xl/worksheets/sheet1.xml",
            format!(
                "<worksheet xmlns=\"{main}\"><dimension ref=\"A1:C7\"/><sheetData>{rows}</sheetData></worksheet>"
            ),
        ),
        (
            "xl/sharedStrings.xml",
            format!(
                "<sst xmlns=\"{main}\" count=\"3\" uniqueCount=\"3\"><si><t>time [s]</t></si><si><t>fx [N]</t></si><si><t>fy [N]</t></si></sst>"
            ),
        ),
        (
            "xl/styles.xml",
            format!(
                "<styleSheet xmlns=\"{main}\"><cellXfs count=\"1\"><xf numFmtId=\"0\"/></cellXfs></styleSheet>"
            ),
        ),
        (
            "xl/workbook.xml",
            format!(
                "<workbook xmlns=\"{main}\" xmlns:r=\"{relations}\"><sheets><sheet name=\"S\" sheetId=\"1\" r:id=\"rId1\"/></sheets></workbook>"
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels",
            format!(
                "<Relationships xmlns=\"{package}\"><Relationship Id=\"rId1\" Type=\"{relations}/worksheet\" Target=\"worksheets/sheet1.xml\"/></Relationships>"
            ),
        ),
        (
            "_rels/.rels",
            format!(
                "<Relationships xmlns=\"{package}\"><Relationship Id=\"rId1\" Type=\"{relations}/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"
            ),
        ),
    ];
    let parts = parts.map(|(name, content)| (name.to_owned(), content.into_bytes()));
    zipped(&parts.into()).expect("an archive in memory")
}

#[test]
fn workbooks() {
    let load = |path: &Path| match read_any_series(path, None) {
        Ok(loaded) => Answer::accepted(&loaded.series),
        Err(error) => Answer::refused(&error),
    };
    run(&Format {
        name: "workbook",
        n_inputs: 2_000,
        file_name: "force.xlsx",
        names_file: true,
        seeds: vec![workbook()],
        mutate: changed,
        load: &load,
    });
}

#[test]
fn packages() {
    let folder = tempfile::tempdir().expect("a folder");
    let force = folder.path().join("force.csv");
    std::fs::write(&force, "t,fx,fy\n0,0,0\n0.1,1,2\n").expect("written");
    let check = Request::from(CheckRequest { paths: vec![force], all: false, map: None });
    let questions = vec![check];
    let variant = Variant { name: "base".to_owned(), questions, ..Variant::default() };
    let package = folder.path().join("a.zip");
    pack(&CaseFile::new("a", variant), &package, Existing::Refuse).expect("packed");
    let seeds = vec![std::fs::read(&package).expect("a package")];
    // Nothing but the folder may come to be beside the package.
    let load = |path: &Path| {
        let beside = path.parent().expect("a folder");
        let unpacked = unpack(path, &beside.join("to"));
        let is_own = |name: &std::ffi::OsStr| name == "to" || Some(name) == path.file_name();
        let entries = std::fs::read_dir(beside).expect("a folder").flatten();
        let n_new = entries.filter(|entry| !is_own(&entry.file_name())).count();
        let _ = std::fs::remove_dir_all(beside.join("to"));
        assert_eq!(n_new, 0, "{n_new} files beside the package");
        match unpacked {
            Ok(_) => Answer { is_accepted: true, ..Answer::default() },
            Err(error) => Answer::refused(&error),
        }
    };
    run(&Format {
        name: "package",
        n_inputs: 1_000,
        file_name: "package/a.zip",
        names_file: false,
        seeds,
        mutate: changed,
        load: &load,
    });
}

/// An atlas of one axis.
fn atlas() -> Vec<u8> {
    let alternating: Vec<f64> = (0..60).map(|i| f64::from(i % 2)).collect();
    let column = |name: &str| Column {
        name: name.to_owned(),
        unit: "1".to_owned(),
        values: alternating.clone(),
    };
    let rows = Rows {
        inputs: vec![column("esc")],
        outcomes: Outcome::ALL.iter().map(|outcome| column(outcome.name())).collect(),
        index: (0..60).collect(),
        caveats: None,
        reasons: vec![String::new(); 60],
        meta: RowsMeta::default(),
    };
    let axis = Axis {
        name: "esc".to_owned(),
        word: "esc".to_owned(),
        label: "Stability control".to_owned(),
        unit: "1".to_owned(),
        edges: Vec::new(),
        labels: vec!["without".to_owned(), "with".to_owned()],
    };
    let atlas = Atlas::from_rows(&rows, vec![axis]).expect("an atlas");
    atlas.to_bytes().expect("an archive in memory")
}

#[test]
fn atlases() {
    let load = |path: &Path| match Atlas::read(path) {
        Ok(atlas) => {
            let cell = atlas.cell(&vec![None; atlas.axes.len()]);
            let means = Measure::all().filter_map(|measure| cell.measure(measure).mean);
            Answer::accepted(&means.collect::<Vec<f64>>())
        }
        Err(error) => Answer::refused(&error),
    };
    run(&Format {
        name: "atlas",
        n_inputs: 2_000,
        file_name: "a.atlas",
        names_file: true,
        seeds: vec![atlas()],
        mutate: changed,
        load: &load,
    });
}

/// A likelihood that takes no time.
struct Bump;

impl Target for Bump {
    fn dim(&self) -> usize {
        2
    }

    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
        z.iter().map(|z| -0.5 * ((z[0] - 1.0) / 0.3).powi(2)).collect()
    }
}

const SETTINGS: SamplerSettings =
    SamplerSettings { n_particles: 20, seed: 3, least_ess: 20.0, max_evaluations: 200 };

fn resumed(path: &Path) -> Answer {
    let checkpoint =
        SamplerCheckpoint { path: path.to_owned(), digest: "bump".to_owned(), resume: true };
    let mut go_on =
        |_: impactlab_reconstruct::sampler::SamplerReport<'_>| std::ops::ControlFlow::Continue(());
    match sample(&Bump, &SETTINGS, Some(&checkpoint), &mut go_on) {
        Ok(particles) => Answer::accepted(&particles.z),
        Err(error) => Answer::refused(&error),
    }
}

/// A checkpoint with other bytes behind its checksum, which fits in most cases.
fn resealed(mutator: &mut Mutator, input: &[u8], _other: &[u8]) -> Vec<u8> {
    const CHECKSUM: usize = 64;
    let mut content = input.get(CHECKSUM..).unwrap_or_default().to_vec();
    for _ in 0..=mutator.below(4) {
        let (at, value) = (mutator.below(content.len().max(1)), mutator.below(256));
        if let Some(byte) = content.get_mut(at) {
            *byte = value as u8;
        }
    }
    let checksum = match mutator.once_in(8) {
        true => input.get(..CHECKSUM).unwrap_or_default().to_vec(),
        false => sha256_hex([content.as_slice()]).into_bytes(),
    };
    [checksum, content].concat()
}

#[test]
fn checkpoints_of_reconstructions() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("seed.run");
    assert!(resumed(&path).is_accepted);
    let seeds = vec![std::fs::read(&path).expect("a checkpoint")];
    run(&Format {
        name: "reconstruction-run",
        n_inputs: 1_000,
        file_name: "seed.run",
        names_file: true,
        seeds,
        mutate: resealed,
        load: &resumed,
    });
}
