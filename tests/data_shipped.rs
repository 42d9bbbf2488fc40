//! The shipped data sets load without a problem.

use std::ops::ControlFlow;
use std::path::Path;

use impactlab::data::{DatasetKind, ForceAttributes, Opened, TrajectoryAttributes, open};

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
    assert_eq!(datasets.len(), 4);
    for dataset in &datasets {
        assert!(dataset.problems.is_empty(), "{:?}", dataset.problems);
        assert_eq!(dataset.cases.len(), 100, "{}", dataset.root.display());
        for case in &dataset.cases {
            match dataset.kind {
                DatasetKind::Force => assert!(ForceAttributes::read(&case.attributes).is_ok()),
                DatasetKind::Trajectory => {
                    assert!(TrajectoryAttributes::read(&case.attributes).is_ok());
                }
            }
            assert!(case.force_history().is_ok(), "{}", case.name);
        }
    }
    assert_eq!(reports, 8);
}
