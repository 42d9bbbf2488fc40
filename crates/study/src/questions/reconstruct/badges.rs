//! Badges of the answer of a reconstruction: too few particles, several courses of events, evidence that
//! nothing explains.

use impactlab_core::numerics::NORMAL_QUANTILE_95;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::FrictionZone;
use impactlab_reconstruct::evaluate::KnownEvidence;
use impactlab_reconstruct::evidence::{After, Evidence, Mark, MarkKind, YesNoUnknown};
use impactlab_reconstruct::sampler::Particles;
use impactlab_reconstruct::{
    EvidenceFit, HandCheck, LEAST_ESS_FOR_INTERVALS, LeftOut, Mode, Posterior,
    ReconstructedQuantity,
};

/// Effective sample size below which intervals may be too narrow.
const LEAST_ESS: f64 = 400.0;

/// Sum of probabilities below 1 that is rounding.
const ROUNDING: f64 = 1e-9;

/// That the evidence leaves more than one course of events possible.
pub(super) fn several_courses(modes: &[Mode]) -> Option<Caveat> {
    let course = |mode: &Mode| {
        let (share, error) = (mode.probability, Some(mode.standard_error));
        Phrase::new("{0} with {1}", "{0} mit {1}")
            .with(PhraseValue::Term(mode.name.clone()))
            .with(PhraseValue::Chance { share, error })
    };
    // Those that are too rare to be told one by one.
    let rare = 1.0 - modes.iter().map(|mode| mode.probability).sum::<f64>();
    let others = (rare > ROUNDING).then(|| {
        Phrase::new("rarer ones with {0} together", "seltenere mit zusammen {0}")
            .with(PhraseValue::Share(rare))
    });
    (modes.len() > 1).then(|| {
        let text = Phrase::new(
            "{0} courses of events are possible ({1}): a median or an interval over all of them may be true of \
             none; use those of each course",
            "{0} Geschehensabläufe sind möglich ({1}): Ein Median oder ein Intervall über alle trifft unter \
             Umständen auf keinen zu. Maßgeblich sind die Werte jedes einzelnen",
        )
        .with(PhraseValue::Name(modes.len().to_string()))
        .with(PhraseValue::phrase(Phrase::joined(modes.iter().map(course).chain(others), "; ")));
        Caveat::new(CaveatKind::SeveralCourses, text)
            .with_value("courses of events", modes.len() as f64)
            .with_range([1.0, 1.0])
    })
}

/// Whether there are enough particles, and whether they are of the posterior.
pub(super) fn of_particles(particles: &Particles) -> Vec<Caveat> {
    match (particles.is_weakened(), particles.is_posterior()) {
        (true, _) => vec![weakened(particles)],
        (_, true) => few(particles).into_iter().collect(),
        (false, false) => {
            let out_of_sight = out_of_sight(particles);
            std::iter::once(out_of_sight).chain(few(particles)).collect()
        }
    }
}

/// That the particles are those of evidence with larger standard deviations.
fn weakened(particles: &Particles) -> Caveat {
    let answer = match particles.ess < LEAST_ESS_FOR_INTERVALS {
        true => Phrase::new(
            "no intervals are given, and the medians are those of evidence whose standard deviations are {0} \
             times as large as stated",
            "Es werden keine Intervalle angegeben, und die Mediane sind die von Anknüpfungstatsachen mit dem \
             {0}-Fachen der angegebenen Standardabweichungen",
        ),
        false => Phrase::new(
            "intervals are those of evidence whose standard deviations are {0} times as large as stated, and \
             wider than they need be",
            "Die Intervalle sind die von Anknüpfungstatsachen mit dem {0}-Fachen der angegebenen \
             Standardabweichungen und weiter als nötig",
        ),
    };
    let answer = answer.with(PhraseValue::fixed(Quantity::Ratio, particles.sigma_factor(), 2));
    let text = Phrase::new(
        "with the evidence as stated the sample is equivalent to {0} independent draws only: {1}",
        "Mit den Anknüpfungstatsachen wie angegeben entspricht die Stichprobe nur {0} unabhängigen \
         Ziehungen: {1}",
    )
    .with(PhraseValue::fixed(Quantity::Ratio, particles.posterior_ess, 0))
    .with(PhraseValue::phrase(answer));
    Caveat::new(CaveatKind::FewParticles, text)
        .with_value("effective sample size", particles.posterior_ess)
        .with_range([LEAST_ESS, f64::INFINITY])
}

/// That the particles are not of the posterior.
fn out_of_sight(particles: &Particles) -> Caveat {
    let text = Phrase::new(
        "hardly a motion goes with all of the evidence: these particles are not of the posterior, and \
         no intervals are given",
        "Kaum eine Bewegung ist mit allen Anknüpfungstatsachen vereinbar. Es werden keine Intervalle \
         angegeben",
    );
    Caveat::new(CaveatKind::FewParticles, text)
        .with_value("temperature", particles.temperature)
        .with_range([1.0, f64::INFINITY])
}

/// That intervals rest on few particles.
fn few(particles: &Particles) -> Option<Caveat> {
    (particles.ess < LEAST_ESS).then(|| {
        let consequence = match particles.ess < LEAST_ESS_FOR_INTERVALS {
            true => Phrase::new(
                "no intervals are given, which would rest on single draws",
                "Es werden keine Intervalle angegeben, da sie auf einzelnen Ziehungen beruhten",
            ),
            false => Phrase::new(
                "intervals may be too narrow",
                "Die Intervalle können zu eng sein",
            ),
        };
        let text = Phrase::new(
            "the sample is equivalent to {0} independent draws, expected {1}: {2}; more \
             particles: --particles",
            "Die Stichprobe entspricht {0} unabhängigen Ziehungen, verlangt sind {1}. {2}; mehr Partikel: \
             --particles",
        )
        .with(PhraseValue::fixed(Quantity::Ratio, particles.ess, 0))
        .with(PhraseValue::given(Quantity::Ratio, LEAST_ESS))
        .with(PhraseValue::phrase(consequence));
        Caveat::new(CaveatKind::FewParticles, text)
            .with_value("effective sample size", particles.ess)
            .with_range([LEAST_ESS, f64::INFINITY])
    })
}

/// What the intervals have been tried on, as long as that is not enough.
///
/// - `known`: what the evidence is alike among the staged collisions; none if it is like none of them;
/// - `are_followed`: whether the cars were followed through later contacts.
pub(super) fn of_validation(
    zones: &[FrictionZone],
    known: Option<KnownEvidence>,
    are_followed: bool,
) -> Caveat {
    if are_followed {
        let text = Phrase::new(
            "intervals of cars that push each other were tried on 14 simulated pairs and on no real one: those of \
             90 % held the speed of each car in 13 and the relative heading in 9 of the 14",
            "Die Intervalle von Fahrzeugen, die einander schieben, wurden an 14 simulierten Paaren geprüft und an \
             keinem realen: jene von 90 % trafen bei der Geschwindigkeit jedes der beiden in 13, beim Winkel \
             zwischen ihnen in 9 der 14 Fälle zu",
        );
        return Caveat::new(CaveatKind::HardlyValidated, text);
    }
    let unlike = match (zones.is_empty(), known.is_some()) {
        (true, true) => Phrase::new("", ""),
        (false, true) => Phrase::new(
            ", all of which stood on one friction",
            ", sämtlich auf einheitlichem Reibbeiwert,",
        ),
        (true, false) => Phrase::new(
            ", all of which, unlike this one, were hit on a flank behind the CG and came to rest freely at a known \
             place,",
            ", sämtlich anders als hier an der Flanke hinter dem Schwerpunkt getroffen und mit bekannter \
             Endlage ohne weiteres Hindernis,",
        ),
        (false, false) => Phrase::new(
            ", all of which, unlike this one, were hit on a flank behind the CG, came to rest freely at a known \
             place and stood on one friction,",
            ", sämtlich anders als hier an der Flanke hinter dem Schwerpunkt getroffen, mit bekannter Endlage \
             ohne weiteres Hindernis und auf einheitlichem Reibbeiwert,",
        ),
    };
    let text = Phrase::new(
        "intervals were tried on 40 simulated collisions of one make of car{0} and on no real \
         one; how often they held is in docs/guide/limits.md",
        "Die Intervalle wurden an 40 simulierten Kollisionen eines Fahrzeugmodells{0} geprüft und an \
         keiner realen. Wie oft sie zutrafen, steht in docs/guide/limits.md",
    )
    .with(PhraseValue::phrase(unlike));
    Caveat::new(CaveatKind::HardlyValidated, text)
}

/// Marks of locked wheels that neither the brakes nor damage can have locked: nobody braked, or an anti-lock system kept
/// them turning.
pub(super) fn beside_locked_marks(evidence: &Evidence) -> Option<Caveat> {
    let cars =
        [(&evidence.after, &evidence.marks), (&evidence.striking_after, &evidence.striking_marks)];
    let is_odd = |(after, marks): &(&After, &Vec<Mark>)| {
        let held = [&after.blocked_wheels, &after.dragging_wheels].into_iter().flatten().flatten();
        let is_by_brakes = evidence.is_single_car() || after.wheels_are_known();
        let is_locked = |mark: &Mark| {
            mark.kind == Some(MarkKind::Locked) && !held.clone().any(|wheel| *wheel == mark.wheel)
        };
        is_by_brakes && marks.iter().any(is_locked)
    };
    let odd: Vec<&After> = cars.into_iter().filter(is_odd).map(|(after, _)| after).collect();
    let of_driver = Phrase::new(
        "marks of locked wheels do not go with a driver who did not brake: look again at the marks, at what the driver \
         did, and at which wheels the damage held",
        "Spuren blockierter Räder passen nicht zu einem Fahrer, der nicht bremste: die Spuren, das Verhalten des \
         Fahrers und die vom Schaden gehemmten Räder noch einmal prüfen",
    );
    let of_brakes = Phrase::new(
        "marks of locked wheels do not go with anti-lock brakes: look again at the marks, or at whether the system \
         worked",
        "Spuren blockierter Räder passen nicht zu einem Antiblockiersystem: die Spuren noch einmal ansehen, oder ob \
         das System arbeitete",
    );
    let text = if odd.iter().any(|after| after.driver_braked == YesNoUnknown::No) {
        of_driver
    } else {
        odd.iter().any(|after| after.anti_lock == YesNoUnknown::Yes).then_some(of_brakes)?
    };
    Some(Caveat::new(CaveatKind::Disagreement, text))
}

/// Checks by hand whose interval of 90 % has nothing in common with that of the answer: one of them rests on
/// something that is not so.
pub(super) fn apart_by_hand(by_hand: &[HandCheck], posterior: &Posterior) -> Option<Caveat> {
    let apart = |check: &HandCheck| {
        let answer = posterior.speed_of(check.speed)?;
        let [low, high] = answer.ninety();
        let reach = NORMAL_QUANTILE_95 * check.sigma_m_s;
        let is_apart = check.value_m_s + reach < low || high < check.value_m_s - reach;
        let by_hand = [check.value_m_s - reach, check.value_m_s + reach];
        let by_hand = PhraseValue::Estimate {
            quantity: Quantity::Speed,
            median: check.value_m_s,
            ninety: Some(by_hand),
        };
        let phrase = Phrase::new("{0} {1} by hand and {2} here", "{0} {1} von Hand und {2} hier")
            .with(PhraseValue::Term(check.speed.label().to_owned()))
            .with(by_hand)
            .with(PhraseValue::estimate(Quantity::Speed, &answer));
        is_apart.then_some(phrase)
    };
    let apart: Vec<Phrase> = by_hand.iter().filter_map(apart).collect();
    (!apart.is_empty()).then(|| {
        let text = Phrase::new(
            "a calculation by hand and the reconstruction do not agree, as their intervals of 90 % have nothing in \
             common: {0}; either the condition of the calculation does not hold, or a part of the evidence is \
             misread",
            "Eine Rechnung von Hand und die Rekonstruktion widersprechen sich, ihre 90-%-Intervalle haben nichts \
             gemeinsam: {0}. Entweder trifft die Voraussetzung der Rechnung nicht zu, oder eine Anknüpfungstatsache \
             ist falsch gelesen",
        )
        .with(PhraseValue::phrase(Phrase::joined(apart, "; ")));
        Caveat::new(CaveatKind::Disagreement, text)
    })
}

/// Parts of the evidence that the others contradict, though the answer follows them.
pub(super) fn of_left_out(left_out: &[LeftOut]) -> Vec<Caveat> {
    let contradicted = left_out.iter().filter(|part| part.is_contradicted);
    contradicted
        .filter_map(|part| Some((part, part.p?)))
        .map(|(part, p)| {
            let without = part.struck_speed.as_ref().map(|speed| {
                let of_single_car = speed.name == ReconstructedQuantity::CarSpeed.key();
                let [en, de] = match of_single_car {
                    true => ["; without it the car had {0}", ". Ohne sie fuhr das Fahrzeug {0}"],
                    false => [
                        "; without it the struck car had {0}",
                        ". Ohne sie fuhr das gestoßene Fahrzeug {0}",
                    ],
                };
                Phrase::new(en, de).with(PhraseValue::estimate(Quantity::Speed, &speed.estimate))
            });
            let text = Phrase::new(
                "{0} does not go with the rest of the evidence: one of them is wrong or misread{1}",
                "{0} ist mit den übrigen Anknüpfungstatsachen nicht vereinbar: Eine von ihnen ist falsch \
                 oder falsch gelesen{1}",
            )
            .with(PhraseValue::Term(part.evidence.clone()))
            .with(PhraseValue::phrase(without.unwrap_or_else(|| Phrase::new("", ""))));
            Caveat::new(CaveatKind::EvidenceUnexplained, text)
                .with_value(format!("p of {} by the others", part.evidence), p)
        })
        .collect()
}

/// A value of the evidence in its SI unit, as finely as such things are measured.
fn of_evidence(value: f64, unit: &str) -> PhraseValue {
    match Quantity::from_si_symbol(unit) {
        Some(quantity @ Quantity::Speed) => PhraseValue::fixed(quantity, value, 1),
        Some(quantity @ (Quantity::Length | Quantity::Angle | Quantity::AngularVelocity)) => {
            PhraseValue::fixed(quantity, value, 2)
        }
        Some(quantity) => PhraseValue::significant(quantity, value),
        None if unit.is_empty() => PhraseValue::fixed(Quantity::Ratio, value, 3),
        None => PhraseValue::Name(format!("{value:.3} {unit}")),
    }
}

/// Evidence that no particle explains.
pub(super) fn of_fit(fit: &[EvidenceFit]) -> Vec<Caveat> {
    let unexplained = fit.iter().filter(|item| item.is_unexplained());
    unexplained
        .map(|item| {
            let found = match item.compared_by.is_found() {
                true => Phrase::new("found", "gefunden"),
                false => Phrase::new("computed from the mark", "aus der Spur berechnet"),
            };
            let text = Phrase::new(
                "{0}: {3} {1}, expected {2}: items of the evidence contradict each other, or the course \
                 of events is another one; do not rely on the answer",
                "{0}: {3} {1}, erwartet {2}. Anknüpfungstatsachen widersprechen einander, oder der \
                 Geschehensablauf war ein anderer; die Antwort ist nicht verwertbar",
            )
            .with(PhraseValue::Term(item.evidence.clone()))
            .with(of_evidence(item.found, item.unit))
            .with(of_evidence(item.expected, item.unit))
            .with(PhraseValue::phrase(found));
            Caveat::new(CaveatKind::EvidenceUnexplained, text)
                .with_value(format!("p of {}", item.evidence), item.p)
                .with_range([EvidenceFit::UNEXPLAINED_BELOW, 1.0])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_reconstruct::ComparedBy;

    /// Courses of less than 1 % were left out, and nothing said what the others lack to 1.
    #[test]
    fn the_chances_of_courses_that_are_told_add_up_to_one() {
        let mode = |name: &str, probability| Mode {
            name: name.to_owned(),
            probability,
            standard_error: 0.02,
            quantities: Vec::new(),
            members: Vec::new(),
        };
        let whole = several_courses(&[mode("left", 0.7), mode("right", 0.3)]).unwrap();
        assert!(!whole.text.contains("rarer"), "{}", whole.text);
        let part = several_courses(&[mode("left", 0.7), mode("right", 0.285)]).unwrap();
        assert!(part.text.contains("; rarer ones with 1.5 % together)"), "{}", part.text);
        assert_eq!(several_courses(&[mode("left", 0.995)]), None);
    }

    /// “found 99.000 km/h, expected 83.523 km/h” claimed a precision that neither has.
    #[test]
    fn unexplained_evidence_is_told_as_finely_as_it_is_measured() {
        let said = |unit, found, expected| {
            let (evidence, compared_by, p) = ("item".to_owned(), ComparedBy::Number, 1e-6);
            let item = EvidenceFit { evidence, unit, expected, found, compared_by, p };
            of_fit(&[item])[0].text.clone()
        };
        assert!(said("m/s", 27.5, 23.2009).contains("found 27.5 m/s, expected 23.2 m/s"));
        assert!(said("m", 48.21, 45.1239).contains("found 48.21 m, expected 45.12 m"));
        assert!(said("", 0.445, 0.57181).contains("found 0.445, expected 0.572"));
    }

    /// Of a crossing collision it was said that intervals had been tried on 40, which are all of a flank that was
    /// hit behind the CG; of cars that push each other, too, though these had been tried by themselves.
    #[test]
    fn what_intervals_were_tried_on_is_said_of_the_collisions_that_are_like_the_answer() {
        let said = |known, are_followed| of_validation(&[], known, are_followed).text;
        let like = said(Some(KnownEvidence::RestOnly), false);
        assert!(like.contains("tried on 40") && !like.contains("unlike"), "{like}");
        let elsewhere = said(None, false);
        assert!(elsewhere.contains("unlike this one, were hit"), "{elsewhere}");
        let pushed = said(Some(KnownEvidence::Everything), true);
        let validation = include_str!("../../../../../docs/VALIDATION.md");
        let in_90 = |quantity: &str| {
            let row = validation.lines().find(|line| {
                line.starts_with(&format!("| {quantity} |")) && line.contains(" of 14 |")
            });
            row.unwrap().split('|').nth(4).unwrap().trim().to_owned()
        };
        let [struck, striking] =
            ["speed of the struck car", "speed of the striking car"].map(in_90);
        let heading = in_90("relative heading");
        assert_eq!(struck, striking);
        let part = format!("each car in {struck} and the relative heading in {heading} of the 14");
        assert!(pushed.contains(&part), "{pushed}");
    }
}
