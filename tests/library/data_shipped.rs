//! The shipped data sets load without a problem.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::{
    Dataset, DatasetKind, FlagKind, ForceAttributes, Opened, TrajectoryAttributes, check_case,
    contradictions, open,
};

#[test]
fn all_shipped_data_sets_load_without_a_problem() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets");
    let mut reports = 0;
    let mut report = |_| {
        reports += 1;
        ControlFlow::Continue(())
    };
    let opened = open(&root, &mut report).unwrap().complete().unwrap();
    let Opened::Collection { datasets, problems } = opened else {
        panic!("a folder of data sets is a collection");
    };
    assert!(problems.is_empty(), "{problems:?}");
    assert_eq!(datasets.len(), 7);
    for dataset in &datasets {
        assert!(dataset.problems.is_empty(), "{:?}", dataset.problems);
        let is_staged = dataset.root.ends_with("staged");
        let n_cases = match dataset.root.file_name().and_then(|name| name.to_str()) {
            Some("staged") => 40,
            Some("fea-road") => 190,
            Some("fea-road-held-out") => 67,
            _ => 100,
        };
        assert_eq!(dataset.cases.len(), n_cases, "{}", dataset.root.display());
        for case in &dataset.cases {
            match dataset.kind {
                DatasetKind::Force => assert!(ForceAttributes::read(&case.attributes).is_ok()),
                DatasetKind::Trajectory => {
                    // How the wheels of a staged collision were braked is part of its truth.
                    let read = TrajectoryAttributes::read(&case.attributes);
                    assert_eq!(read.is_ok(), !is_staged, "{}", case.name);
                }
            }
            assert!(case.force_history().is_ok(), "{}", case.name);
            // Cars that spin are no contradiction.
            assert_eq!(contradictions(&case.series), [], "{}", case.name);
        }
    }
    assert_eq!(reports, 14);
}

#[test]
fn clean_cases_raise_no_warning_and_the_others_say_why() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets");
    let mut go_on = |_| ControlFlow::Continue(());
    for (name, n_hooked, n_not_separated) in [
        ("fea", 12, 13),
        ("fea-wide", 11, 21),
        ("trajectories-fea", 0, 18),
        ("trajectories-pulse", 0, 0),
    ] {
        let dataset = Dataset::load(&root.join(name), &mut go_on).unwrap();
        let cases = dataset.complete().unwrap().cases;
        let flags: Vec<_> = cases.iter().flat_map(check_case).collect();
        let count = |kind| flags.iter().filter(|flag| flag.kind == kind).count();
        assert_eq!(count(FlagKind::Hooked), n_hooked, "{name}");
        assert_eq!(count(FlagKind::NotSeparated), n_not_separated, "{name}");
        assert_eq!(flags.len(), n_hooked + n_not_separated, "{name}: {flags:?}");
    }
}

/// The cars of a sample: each is a data set of its own, and none stands in both parts.
#[test]
fn sampled_cars_load_without_a_problem_and_those_held_out_are_others() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets");
    let mut go_on = |_| ControlFlow::Continue(());
    let mut names = BTreeSet::new();
    let parts = [
        ("trajectories-cars", 44, 528),
        ("trajectories-cars-held-out", 15, 180),
        ("trajectories-cars-wide", 15, 180),
        ("trajectories-cars-wide-held-out", 9, 108),
        ("trajectories-cars-edge", 16, 192),
        // One motion of car-104 diverges in the multibody program.
        ("trajectories-cars-edge-held-out", 7, 83),
    ];
    for (part, n_cars, n_motions) in parts {
        let (mut n_found, mut n_motions_found) = (0, 0);
        for entry in std::fs::read_dir(root.join(part)).unwrap() {
            let folder = entry.unwrap().path();
            if !folder.is_dir() {
                continue;
            }
            n_found += 1;
            let dataset = Dataset::load(&folder, &mut go_on).unwrap().complete().unwrap();
            assert!(dataset.problems.is_empty(), "{:?}", dataset.problems);
            n_motions_found += dataset.cases.len();
            for case in &dataset.cases {
                assert!(TrajectoryAttributes::read(&case.attributes).is_ok(), "{}", case.name);
                assert!(case.force_history().is_ok(), "{}", case.name);
                assert_eq!(contradictions(&case.series), [], "{}", case.name);
            }
            assert!(names.insert(dataset.root.file_name().unwrap().to_owned()));
        }
        assert_eq!((n_found, n_motions_found), (n_cars, n_motions), "{part}");
    }
}
