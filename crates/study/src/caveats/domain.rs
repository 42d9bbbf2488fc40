//! Where a motion lies outside of what the response network has learned from.

use crate::PredictMotionReport;
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_networks::response::OutsideDomain;

/// Share of the response network below which it is told that a part of the draws lies outside.
pub(crate) const LEAST_APPLICABILITY: f64 = 0.95;

/// What lies outside of what the response network has learned from: of the struck vehicle, and of the striking one
/// what is not that of both, as their road is.
pub(super) fn outside_domain_caveats(report: &PredictMotionReport) -> Vec<Caveat> {
    let of_vehicle = |applicability: f64, outside: &[OutsideDomain]| -> Vec<Caveat> {
        let partly = partly_outside_caveat(applicability, outside);
        outside.iter().map(outside_domain_caveat).chain(partly).collect()
    };
    let struck = of_vehicle(report.applicability, &report.outside_domain);
    let striking = report.striking.iter();
    let striking = striking.flat_map(|it| of_vehicle(it.applicability, &it.outside_domain));
    let striking: Vec<Caveat> =
        striking.filter(|caveat| !struck.contains(caveat)).map(of_striking).collect();
    struck.into_iter().chain(striking).collect()
}

/// The same of the striking vehicle.
fn of_striking(caveat: Caveat) -> Caveat {
    let Some(statement) = caveat.text_phrase.clone() else { return caveat };
    let text = Phrase::new("of the striking vehicle, {0}", "stoßendes Fahrzeug: {0}");
    let text = text.with(PhraseValue::phrase(statement));
    let Caveat { text, text_phrase, .. } = Caveat::new(caveat.kind, text);
    Caveat { text, text_phrase, subject: Some(CaveatSubject::Striking), ..caveat }
}

/// A quantity of a motion that lies outside what a response network has learned from.
pub(super) fn outside_domain_caveat(outside: &OutsideDomain) -> Caveat {
    let OutsideDomain { quantity, value, range } = outside;
    let [low, high] = *range;
    let text = Phrase::new(
        "{0} is {1}, the response network has learned from {2} to {3}",
        "{0} beträgt {1}; das Bewegungsnetz hat an Werten von {2} bis {3} gelernt",
    )
    .with(PhraseValue::Heading((*quantity).to_owned()))
    .with(PhraseValue::of_named(quantity, *value))
    .with(PhraseValue::of_named(quantity, low))
    .with(PhraseValue::of_named(quantity, high));
    Caveat::new(CaveatKind::OutsideDomain, text).with_value(*quantity, *value).with_range(*range)
}

/// That draws of what a data sheet leaves open lie outside, where the usual one of them does not: of such a
/// share no single quantity is the cause, and nothing said why it is below one.
///
/// - `applicability`: mean of the draws.
pub(super) fn partly_outside_caveat(
    applicability: f64,
    outside: &[OutsideDomain],
) -> Option<Caveat> {
    let is_told = outside.is_empty() && applicability < LEAST_APPLICABILITY;
    is_told.then(|| {
        let text = Phrase::new(
            "with what the data sheet leaves open, {0} of the answer lies outside of what the response network \
             has learned from; there the bare physics answers, with wider bands",
            "mit dem, was das Datenblatt offenlässt, liegt die Antwort zu {0} außerhalb dessen, woran das \
             Bewegungsnetz gelernt hat; dort antwortet die bloße Physik mit breiteren Bändern",
        )
        .with(PhraseValue::Share(1.0 - applicability));
        Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value("share of the response network", applicability)
            .with_range([LEAST_APPLICABILITY, 1.0])
    })
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::analysis::PulseSetup;
    use crate::{
        ForceSource, Library, MotionSource, PredictMotionRequest, Question, ScenarioChoice,
    };
    use impactlab_core::collision::Scenario;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};

    /// A striking vehicle of 6 t, of which the network knows nothing, was told to end within 90 % intervals
    /// without a word.
    #[test]
    fn what_lies_outside_of_the_striking_vehicle_is_told_as_its_own() {
        let mut scenario = Scenario::example();
        (scenario.striking.mass_kg, scenario.striking.yaw_inertia_kg_m2) = (6000.0, 11_000.0);
        let scenario = ScenarioChoice::Inline(Box::new(scenario));
        let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
        let force = ForceSource::usual(&source);
        let mut request =
            PredictMotionRequest { draws: 4, ..PredictMotionRequest::new(source, force) };
        (request.motion.friction, request.motion.duration_s) = (Some(0.1), 1.0);
        let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
        let answer = request.answer(&Library::default(), &mut go_on).unwrap();
        let report = answer.complete().unwrap().report;
        assert!(report.report.striking.as_ref().unwrap().applicability < 0.5, "{report:?}");
        let named = |quantity: &str| {
            let is_it = |caveat: &&Caveat| caveat.quantity.as_deref() == Some(quantity);
            report.caveats.iter().filter(is_it).collect::<Vec<_>>()
        };
        let [heavy] = named("mass [kg]")[..] else { panic!("{:?}", report.caveats) };
        assert!(heavy.text.starts_with("of the striking vehicle, mass [kg] is 6000"), "{heavy}");
        assert!(heavy.is_warning() && heavy.subject == Some(CaveatSubject::Striking));
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let told = heavy.text_in(&german, &str::to_owned).unwrap();
        assert!(told.starts_with("stoßendes Fahrzeug: ") && told.contains("beträgt 6"), "{told}");
        // The road is that of both.
        let [ground] = named("friction")[..] else { panic!("{:?}", report.caveats) };
        assert_eq!(ground.subject, None);
    }

    /// The share of the network was 85 % of a Camry by its sheet, and nothing said why.
    #[test]
    fn a_share_below_one_is_told_of_where_no_single_quantity_lies_outside() {
        assert_eq!(partly_outside_caveat(0.96, &[]), None);
        let told = partly_outside_caveat(0.85, &[]).unwrap();
        assert_eq!(told.kind, CaveatKind::OutsideDomain);
        assert!(told.text.contains("15.0 % of the answer lies outside"), "{}", told.text);
        let mass = OutsideDomain { quantity: "mass [kg]", value: 3000.0, range: [800.0, 2500.0] };
        assert_eq!(partly_outside_caveat(0.85, &[mass]), None);
    }
}
