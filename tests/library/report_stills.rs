//! The stills of scenes in a report: what they show, and the ground below them.

use std::fs;
use std::path::{Path, PathBuf};

use impactlab_core::data::Existing;
use impactlab_document::report::{Picture, PictureContent, ReportDocument};
use impactlab_document::scene::{SceneStill, ViewKind};
use impactlab_study::analysis::PulseSetup;
use impactlab_study::case_file::{CaseFile, Variant, pack, unpack};
use impactlab_study::{
    EvidenceChoice, MotionSource, ReconstructRequest, Request, ScenarioChoice, SimulateRequest,
};

use crate::report::{english, report};

fn case_of(name: &str, question: impl Into<Request>) -> CaseFile {
    let questions = vec![question.into()];
    CaseFile::new(name, Variant { name: name.to_owned(), questions, ..Variant::default() })
}

/// The simulation of the shipped scenario on a ground.
fn on_ground(site: PathBuf) -> CaseFile {
    let scenario = ScenarioChoice::File(PathBuf::from("pit-right-rear"));
    let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
    let question = SimulateRequest {
        vehicle_draws: Some(0),
        site: Some(site),
        ..SimulateRequest::new(source)
    };
    case_of("pit", question)
}

/// The pictures of a document that show a scene.
fn stills(document: &ReportDocument) -> Vec<(&Picture, &SceneStill)> {
    let all = document.pictures().filter_map(|picture| match &picture.content {
        PictureContent::Scene(still) => Some((picture, still)),
        PictureContent::Figure(_) => None,
    });
    all.collect()
}

/// The friction zones in the table of inputs, each with its value.
fn zones(document: &ReportDocument) -> Vec<String> {
    let markdown = document.to_markdown();
    let is_zone = |line: &&str| line.starts_with("| ") && line.contains("corners (X; Y)");
    markdown.lines().filter(is_zone).map(str::to_owned).collect()
}

/// Evidence of a car that spun to rest.
fn spin() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/evidence/spin.toml")
}

fn road() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sites/country-road/site.toml")
}

#[test]
fn a_simulation_is_seen_at_its_end_and_at_its_contact_on_its_ground() {
    let (document, answers) = report(&on_ground(road()), &english());
    assert!(answers.is_clean());
    let stills = stills(&document);
    let seen: Vec<_> =
        stills.iter().map(|(_, still)| (still.view, still.near_m.is_some())).collect();
    assert_eq!(seen, [(ViewKind::Above, false), (ViewKind::Perspective, true)]);
    for (picture, still) in &stills {
        let ground = still.scene.ground.as_ref().expect("the road");
        assert!(ground.picture.is_some(), "its orthophoto");
        assert!(still.scene.struck().is_some() && still.scene.striking().is_some());
        assert!(picture.alt.contains("striking vehicle"), "{}", picture.alt);
        assert!(!picture.caption.contains("not drawn"), "{}", picture.caption);
    }
    let [end_s, contact_s] = [0, 1].map(|idx: usize| stills[idx].1.time_s);
    assert!(contact_s < 0.2 && end_s > 3.0, "{contact_s} s, {end_s} s");
    let zones = zones(&document);
    assert_eq!(zones.len(), 2, "{zones:?}");
    assert!(zones[0].contains("0.45") && zones[0].contains("(94.00; -12.00)"), "{zones:?}");
}

#[test]
fn a_ground_that_cannot_be_drawn_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let site = folder.path().join("site.toml");
    fs::write(&site, "name = \"torn\"\n[dxf]\nfile = \"torn.dxf\"\nunit = \"m\"\n")
        .expect("written");
    fs::write(folder.path().join("torn.dxf"), "no drawing").expect("written");
    let (document, _) = report(&on_ground(site), &english());
    let stills = stills(&document);
    assert_eq!(stills.len(), 2);
    for (picture, still) in stills {
        assert!(still.scene.ground.is_none());
        let is_noted = picture.caption.contains("the ground is not drawn")
            && picture.caption.contains("torn.dxf");
        assert!(is_noted, "{}", picture.caption);
    }
}

#[test]
fn a_reconstruction_is_seen_on_the_ground_whose_zones_it_uses() {
    let question = ReconstructRequest {
        particles: 60,
        site: Some(road()),
        ..ReconstructRequest::new(EvidenceChoice::File(spin()))
    };
    let (document, _) = report(&case_of("found", question), &english());
    let stills = stills(&document);
    let [(picture, still)] = &stills[..] else { panic!("one still: {stills:?}") };
    assert!(still.scene.ground.is_some() && still.scene.struck().is_some());
    assert!(picture.alt.contains("particles"), "{}", picture.alt);
    assert_eq!(zones(&document).len(), 2);
    let markdown = document.to_markdown();
    for text in [
        "grass verge, right 0.45; grass verge, left 0.45",
        "friction of the zones over that of the site",
    ] {
        assert!(markdown.contains(text), "{text}");
    }
}

#[test]
fn a_ground_that_lies_elsewhere_or_has_no_scale_is_said_below_the_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    image::RgbImage::new(40, 30).save(at("photo.png")).expect("a picture");
    let (document, _) = report(&on_ground(at("photo.png")), &english());
    assert_eq!(stills(&document).len(), 2);
    for (picture, _) in stills(&document) {
        assert!(picture.caption.contains("0.05 m per pixel"), "{}", picture.caption);
    }
    // A world file in survey coordinates, without an origin that is subtracted.
    fs::write(at("photo.pgw"), "0.1\n0\n0\n-0.1\n512000\n5423000\n").expect("written");
    let (document, _) = report(&on_ground(at("photo.png")), &english());
    for (picture, _) in stills(&document) {
        assert!(picture.caption.contains("m away from the scene"), "{}", picture.caption);
    }
}

/// The site travels with its orthophoto and its drawing in the package of a case, and the report of what is
/// unpacked elsewhere has the same answer and the same ground.
#[test]
fn the_ground_of_a_reconstruction_is_in_the_package_of_its_case() {
    let folder = tempfile::tempdir().expect("a folder");
    let from = folder.path().join("from");
    fs::create_dir(&from).expect("a folder");
    for file in ["site.toml", "orthophoto.jpg", "orthophoto.jgw", "edges.dxf"] {
        fs::copy(road().with_file_name(file), from.join(file)).expect("copied");
    }
    let evidence = from.join("evidence.toml");
    fs::copy(spin(), &evidence).expect("copied");
    let question = ReconstructRequest {
        particles: 60,
        site: Some(from.join("site.toml")),
        ..ReconstructRequest::new(EvidenceChoice::File(evidence))
    };
    let mut case = case_of("found", question);
    case.record_files();
    let (first, _) = report(&case, &english());
    let package = folder.path().join("case.zip");
    pack(&case, &package, Existing::Refuse).expect("packed");
    fs::remove_dir_all(&from).expect("removed");
    let unpacked = unpack(&package, &folder.path().join("to")).expect("unpacked");
    let (again, answers) = report(&CaseFile::load(&unpacked).expect("a case"), &english());
    assert!(answers.is_clean(), "{:?}", answers.changes);
    assert_eq!(stills(&again)[0].1, stills(&first)[0].1);
    assert_eq!(again.to_markdown(), first.to_markdown());
}
