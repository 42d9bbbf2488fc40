//! Reports of reconstructions.

use std::fs;
use std::path::Path;

use impactlab_core::units::{NumberFormat, UnitSystem};
use impactlab_document::report::ReportDocument;
use impactlab_reconstruct::evidence::{Edr, Evidence, Measured};
use impactlab_study::Report;

use crate::report::{
    assert_says, count_of, english, position_alone, reconstruction_of, report, staged, texts,
};

#[test]
fn a_reconstruction_tells_evidence_courses_budget_and_prior() {
    let (_, case, document, answers) = staged();
    let Some(Report::Reconstruct(report)) = answers.variants[0].reports().next() else {
        panic!("a reconstruction");
    };
    for of in &report.quantities {
        let text = NumberFormat::english(UnitSystem::Si).estimate(of.quantity(), &of.estimate);
        for level in [0.5, 0.9, 0.95] {
            assert_says(document, &text.at(level).expect("an interval").range);
        }
    }
    for item in &report.fit {
        assert_says(document, &item.evidence);
        let p = match item.p {
            p if p < 0.001 => "< 0.001".to_owned(),
            p if p >= 0.9995 => "> 0.999".to_owned(),
            p => format!("{p:.3}"),
        };
        assert_says(document, &p);
    }
    for mode in &report.modes {
        assert_says(document, &mode.name);
    }
    assert_eq!(report.priors.len(), count_of(document, "prior; "));
    assert_says(document, &case.files[0].sha256);
    assert_says(document, "evidence.toml");
    assert_says(document, "seed 0");
    // What nobody said of the cars is told with rule, source and range.
    assert_says(document, "yaw inertia");
    assert!(texts(document).iter().filter(|text| *text == "estimated by rule").count() > 20);
    let folder = case.files[0].path.parent().expect("a folder").display().to_string();
    assert!(!document.to_markdown().contains(&folder), "a path of this machine is in the report");
}

/// That the cars meet again in most motions, and that this was not followed, was a note of the annex.
#[test]
fn a_reconstruction_that_leaves_later_contacts_out_says_so_in_the_opinion() {
    let says = |document: &ReportDocument| {
        texts(document).iter().any(|of| of.contains("Later contacts of this case"))
    };
    assert!(says(position_alone()));
    let (_, _, document, answers) = staged();
    let Some(Report::Reconstruct(report)) = answers.variants[0].reports().next() else {
        panic!("a reconstruction");
    };
    let later = report.later_contacts.expect("how often they meet again");
    assert_eq!(says(document), later.is_told() && !later.are_followed, "{later:?}");
}

/// Of a recorder alone, courses of events and their probabilities stood in the opinion as if found.
#[test]
fn courses_that_no_evidence_decides_between_are_said_to_be_those_of_the_assumptions() {
    let folder = tempfile::tempdir().expect("a folder");
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide/examples/position_alone.toml");
    let mut evidence = Evidence::load(&path).expect("evidence");
    let said = "follow from the assumptions alone";
    let is_told = |of: &ReportDocument| texts(of).iter().any(|text| text.contains(said));
    assert!(!is_told(position_alone()), "a position is evidence");
    evidence.rest = None;
    let speed_before_m_s = Some(Measured { value: 15.0, sigma: 0.5 }.into());
    evidence.edr = Some(Edr { speed_before_m_s, ..Edr::default() });
    let path = folder.path().join("recorder.toml");
    fs::write(&path, evidence.to_toml()).expect("written");
    let case = reconstruction_of(path.to_str().expect("text"), folder.path());
    assert!(is_told(&report(&case, &english()).0));
}
