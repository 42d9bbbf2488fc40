//! Makes staged collisions of recorded pairs: what an investigator would find of both cars, with errors, and
//! what had happened. `impactlab evaluate reconstruction` reads the folder.
//!
//! ```text
//! cargo run --release --example pair_evidence -- datasets/pairs DIR 1
//! impactlab evaluate reconstruction DIR --known everything --without-swarm
//! ```
//!
//! The third argument is the seed of the errors. A fourth one, `all`, keeps the pairs of which a car still
//! moves at the end of its record, and therefore has no place of rest; without it, both cars are at rest.
//! Of two twins with and without stability control both are kept. A line for each case is printed and
//! written to `DIR/cases.csv`. Files that are there are replaced.

#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use impactlab_core::compare::{PairCase, PairRecords};
use impactlab_reconstruct::evaluate::PairEvidence;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (source, folder, seed, keeps_all) = match &arguments[..] {
        [source, folder, seed] => (source, folder, seed, false),
        [source, folder, seed, all] if all == "all" => (source, folder, seed, true),
        _ => {
            return Err(
                "expected: the folder of the pairs, a folder, a seed, and perhaps all".into()
            );
        }
    };
    let (source, folder, seed) = (Path::new(source), Path::new(folder), seed.parse()?);
    for part in ["evidence", "truth", "vehicles"] {
        fs::create_dir_all(folder.join(part))?;
    }
    let records = PairRecords::open(source)?;
    let mut rows = String::from(
        "case,kind,struck_car,striking_car,stability_control,struck_rests,striking_rests,\
         struck_marks,striking_marks,struck_recorder,striking_recorder\n",
    );
    for name in records.names() {
        let Some(case) = records.load(name) else { continue };
        let case = case?;
        let staged = match PairEvidence::from_record(&case, seed) {
            Ok(staged) => staged,
            Err(error) => {
                eprintln!("left out: {error}");
                continue;
            }
        };
        let evidence = &staged.evidence;
        if !keeps_all && (evidence.rest.is_none() || evidence.striking_rest.is_none()) {
            continue;
        }
        fs::write(folder.join("evidence").join(format!("{name}.toml")), evidence.to_toml())?;
        fs::write(folder.join("truth").join(format!("{name}.toml")), &staged.truth)?;
        for car in &case.attributes.cars {
            let file = format!("{car}.toml");
            fs::copy(source.join("vehicles").join(&file), folder.join("vehicles").join(&file))?;
        }
        let row = row(&case, &staged);
        println!("{row}");
        writeln!(rows, "{row}")?;
    }
    fs::write(folder.join("cases.csv"), rows)?;
    Ok(())
}

fn row(case: &PairCase, staged: &PairEvidence) -> String {
    let evidence = &staged.evidence;
    let [struck, striking] = &case.attributes.cars;
    let recorders = [evidence.edr, evidence.striking_edr].map(|edr| match edr {
        None => "",
        Some(edr) if edr.speed_before_m_s.is_some() => "speed",
        Some(_) => "delta-v",
    });
    format!(
        "{},{},{struck},{striking},{},{},{},{},{},{},{}",
        case.name,
        case.attributes.kind,
        u8::from(case.attributes.has_stability_control),
        u8::from(evidence.rest.is_some()),
        u8::from(evidence.striking_rest.is_some()),
        evidence.marks.len(),
        evidence.striking_marks.len(),
        recorders[0],
        recorders[1],
    )
}
