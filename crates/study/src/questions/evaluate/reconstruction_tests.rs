use super::*;

fn request() -> EvaluateReconstructionRequest {
    EvaluateReconstructionRequest {
        known: vec![KnownEvidence::RestOnly, KnownEvidence::Everything],
        only: vec!["s07".to_owned()],
        particles: 50,
        swarm: false,
        ..EvaluateReconstructionRequest::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../datasets/staged"
        ))
    }
}

/// The report of an evaluation that is stopped once a share of the work is done.
fn stopped_at(share: f32) -> Option<Answer<EvaluateReconstructionReport>> {
    let mut stop = |event: Event<'_>| match event {
        Event::Progress(progress) if progress.fraction().is_some_and(|done| done >= share) => {
            ControlFlow::Break(())
        }
        _ => ControlFlow::Continue(()),
    };
    let outcome = request().answer(&Library::default(), &mut stop).unwrap();
    outcome.complete().map(|answer| answer.report)
}

#[test]
fn what_is_finished_when_an_evaluation_is_stopped_is_reported() {
    let report = stopped_at(0.6).unwrap();
    assert!(report.stopped);
    let answers: Vec<_> = report.cases.iter().map(|score| (score.known, score.method)).collect();
    let methods = [ReconstructionMethod::Reconstruction, ReconstructionMethod::Hand];
    assert_eq!(answers, methods.map(|method| (KnownEvidence::RestOnly, method)));
    assert!(report.caveats.restrictions()[0].text.starts_with("1 of 2 "), "{:?}", report.caveats);
    assert_eq!(stopped_at(0.1), None);
}

#[test]
fn a_question_comes_back_from_json_and_what_it_leaves_open_is_usual() {
    let text = serde_json::to_string(&request()).unwrap();
    assert_eq!(serde_json::from_str::<EvaluateReconstructionRequest>(&text).unwrap(), request());
    let short: EvaluateReconstructionRequest = serde_json::from_str(r#"{"data": "a"}"#).unwrap();
    assert_eq!(short, EvaluateReconstructionRequest::new("a"));
}
