//! The baselines of the force network on the test part, by seed 0, of the shipped finite-element
//! runs.

use std::ops::ControlFlow;
use std::path::Path;

use impactlab_core::data::{Dataset, Outcome};
use impactlab_core::units::UnitSystem;
use impactlab_networks::force::{
    ColumnSet, CurvePrediction, Evaluation, EvaluationError, EvaluationSettings, ForceCase,
    evaluate,
};
use impactlab_networks::learning::{TEST_SHARE, split};
use impactlab_study::facts::FactWriter;
use impactlab_study::{EvaluateForceReport, EvaluatedCases};

fn shipped_cases() -> Vec<ForceCase> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/fea");
    let loaded = Dataset::load(&root, &mut |_| ControlFlow::Continue(())).expect("a data set");
    let (cases, problems) = ForceCase::from_dataset(&loaded.complete().expect("not cancelled"));
    assert!(problems.is_empty(), "{problems:?}");
    cases
}

/// Evaluates the baselines. The recorded curves take the place of a model, which is not tested
/// here.
fn evaluation(columns: ColumnSet) -> Evaluation {
    let cases = shipped_cases();
    let split = split(&cases, 0, TEST_SHARE);
    let pick = |part: &[usize]| part.iter().map(|idx| &cases[*idx]).collect::<Vec<_>>();
    let (train, test) = (pick(&split.train), pick(&split.test));
    let truth = test.iter().map(|case| CurvePrediction::from_curve(case.curve.clone()));
    let settings = EvaluationSettings { columns, ..EvaluationSettings::default() };
    let mut report = |_| ControlFlow::Continue(());
    let outcome =
        evaluate("the truth", &train, &test, &truth.collect::<Vec<_>>(), &settings, &mut report);
    outcome.expect("an evaluation").complete().expect("not cancelled")
}

/// Median (mean) history errors were 40.7 % (37.9 %) for the pulse, 55.3 % (51.5 %) for the nearest
/// case and 28.3 % (30.6 %) for the Gaussian processes, or 28.2 % (28.9 %) without hooked and
/// unseparated cases. The bounds are a tenth higher, because other mathematical libraries round
/// differently.
#[test]
fn baselines_on_the_test_part_of_the_shipped_runs() {
    let evaluation = evaluation(ColumnSet::Theta);
    assert_eq!((evaluation.n_train, evaluation.cases.len()), (75, 25));
    assert!(evaluation.problems.is_empty(), "{:?}", evaluation.problems);
    let baselines = &evaluation.baselines;
    for (name, of, [median, mean]) in [
        ("pulse", &baselines.pulse, [0.45, 0.42]),
        ("nearest", &baselines.nearest, [0.61, 0.57]),
        ("statistical", &baselines.statistical, [0.31, 0.34]),
    ] {
        let error = of.overall.history_error;
        assert!(error.median < median && error.mean < mean, "{name}: {error:?}");
    }
    let statistical = &baselines.statistical;
    let clean = statistical.separated.as_ref().unwrap();
    assert_eq!(clean.n_cases, 22);
    assert!(clean.history_error.mean < 0.32, "{:?}", clean.history_error);
    let spread = statistical.overall.probabilistic.as_ref().unwrap();
    for band in spread.force_n {
        let off = band.share - band.level;
        assert!((-0.1..0.25).contains(&off), "{band:?}");
    }
    assert_eq!(evaluation.metrics.overall.history_error.max, 0.0);
    check_json(&serde_json::to_value(&evaluation).unwrap());
    check_tables(evaluation);
}

fn check_tables(evaluation: Evaluation) {
    let report = EvaluateForceReport {
        model_file: "the truth".to_owned(),
        data: "fea".into(),
        split: EvaluatedCases::Test,
        n_test: 25,
        n_trained_on: 0,
        evaluation,
        left_out: vec!["c001: no force".to_owned()],
    };
    let (tables, writer) = (report.facts(), FactWriter::english(UnitSystem::Us));
    for text in tables.iter().map(|table| table.to_text(&writer)) {
        assert!(text.rows.iter().all(|row| row.cells.len() == text.header.len()), "{text:?}");
    }
    let markdown = writer.markdown(&tables);
    for word in ["the truth", "classic pulse", " lbf s |", "c001: no force"] {
        assert!(markdown.contains(word), "{word}: {markdown}");
    }
}

fn check_json(json: &serde_json::Value) {
    for block in
        ["/overall", "/separated", "/baselines/pulse/overall", "/baselines/nearest/separated"]
    {
        for figure in
            ["rmse_over_peak", "history_error", "impulse_error", "peak_error", "duration_error"]
        {
            for of in ["mean", "median", "p90"] {
                let path = format!("{block}/{figure}/{of}");
                assert!(json.pointer(&path).is_some_and(|value| value.is_f64()), "{path}");
            }
        }
    }
    for level in ["50", "80", "90", "95"] {
        let path = format!("/baselines/statistical/overall/coverage/{level}");
        assert!(json.pointer(&path).is_some_and(|value| value.is_f64()), "{path}");
    }
    assert!(json.pointer("/clusters/0/model/history_error").is_some());
}

#[test]
fn an_evaluation_can_be_cancelled_and_needs_a_prediction_a_case() {
    let cases = shipped_cases();
    let some: Vec<&ForceCase> = cases.iter().take(8).collect();
    let truth: Vec<_> =
        some.iter().map(|case| CurvePrediction::from_curve(case.curve.clone())).collect();
    let settings = EvaluationSettings::default();
    let mut stop = |_| ControlFlow::Break(());
    let some = some.as_slice();
    let cancelled = evaluate("model", some, some, &truth, &settings, &mut stop).unwrap();
    assert_eq!(cancelled, Outcome::Cancelled);
    let short = evaluate("model", some, some, &truth[1..], &settings, &mut stop).unwrap_err();
    assert!(matches!(short, EvaluationError::Predictions { expected: 8, got: 7 }), "{short}");
}
