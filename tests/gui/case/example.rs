//! The example case that comes with the program.

use super::*;

/// The example case as the window makes it: the PIT with the force that is predicted, with a driver who brakes,
/// and with a lighter car.
fn example(harness: &mut Harness<'_, App>) {
    // A case holds questions: the forecasts of the steps on the way are not waited for.
    let settled = |harness: &mut Harness<'_, App>| {
        harness.run_steps(2);
        step_until(harness, "the simulation", is_idle);
    };
    // The same force as where the command line is asked.
    let project = &mut harness.state_mut().state_mut().project;
    project.predict_motion.force = ForceSource::Predicted(ModelChoice::default());
    settled(harness);
    variant(harness, VariantCommand::Rename("coasts".to_owned()));
    variant(harness, VariantCommand::Duplicate);
    variant(harness, VariantCommand::Rename("driver brakes".to_owned()));
    let brake = Braking::new(0.7, 0.8, 0.2);
    let ending = Ending { brake: Some(brake), ..Ending::default() };
    scenario(harness).ending = Some(ending);
    settled(harness);
    variant(harness, VariantCommand::Show("coasts".to_owned()));
    settled(harness);
    variant(harness, VariantCommand::Duplicate);
    variant(harness, VariantCommand::Rename("struck vehicle of 1500 kg".to_owned()));
    let struck = &mut scenario(harness).struck;
    struck.yaw_inertia_kg_m2 *= 1500.0 / struck.mass_kg;
    struck.mass_kg = 1500.0;
    settled(harness);
    variant(harness, VariantCommand::Show("coasts".to_owned()));
    settled(harness);
    step_until(harness, "the forecast", is_answered);
    let notes =
        "A PIT at 54 km/h: does it matter whether the driver brakes, and how heavy the car is?";
    harness.state_mut().state_mut().case.file.notes = notes.to_owned();
}

#[test]
fn the_example_case_is_what_the_window_saves_and_has_an_answer_to_every_question() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/examples/pit.impactlab");
    let mut harness = open(&[SCENARIO]);
    step_until(&mut harness, "the forecast", is_answered);
    example(&mut harness);
    if std::env::var_os("UPDATE_EXAMPLES").is_some() {
        apply(&mut harness, Command::Write(Output::Case, shipped.clone()));
        apply(&mut harness, Command::Replace(Output::Case, shipped.clone()));
        step_until(&mut harness, "the example", |state| {
            !state.session.tasks.is_running(&TaskKey::SaveCase)
        });
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pit.impactlab");
    save_as(&mut harness, &path);
    let [made, found] = [&path, &shipped].map(|path| CaseFile::load(path).expect("a case"));
    assert_eq!(found.variants, made.variants, "UPDATE_EXAMPLES=1 writes it anew");
    assert_eq!((&found.models, &found.notes), (&made.models, &made.notes));
    let answers = answers_of(&shipped);
    assert_eq!(answers.len(), 3);
    assert!(answers.iter().all(|(_, reports)| reports.len() == 4), "{answers:?}");
}
