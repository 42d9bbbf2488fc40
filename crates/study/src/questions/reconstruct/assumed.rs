//! What the evidence leaves open and the program fills: every distribution of the prior that nobody stated,
//! with the key that states it.

use crate::questions::reconstruct::impact_place::impact_place;
use crate::questions::reconstruct::single_car;
use impactlab_core::uncertainty::{Caveat, CaveatSubject};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_reconstruct::evidence::{After, Evidence, YesNoUnknown};
use impactlab_reconstruct::{
    ANTI_LOCK_PROBABILITY, BLOCKED_PROBABILITY, BRAKE_PROBABILITY, ForwardModel, Latent,
    PUSH_PROBABILITY, Prior, PriorComponent, PriorSource, STRIKING_BRAKES, STRIKING_BRAKES_BEFORE,
};

/// Quantities of the prior that are assumed together.
pub(super) struct Group {
    pub subject: CaveatSubject,
    pub latents: &'static [Latent],
    /// Why, in English and in German.
    pub reason: [&'static str; 2],
}

/// What is assumed of everything that nobody stated. A quantity stands in one group only.
const GROUPS: &[Group] = &[
    Group {
        subject: CaveatSubject::Speed,
        latents: &[Latent::StruckSpeed, Latent::StrikingSpeed],
        reason: [
            "each value equally likely; otherwise: [prior] target_speed_m_s, bullet_speed_m_s",
            "jeder Wert gleich wahrscheinlich; sonst: [prior] target_speed_m_s, \
             bullet_speed_m_s",
        ],
    },
    Group {
        subject: CaveatSubject::Speed,
        latents: &[Latent::SpeedDifference],
        reason: [
            "it hit a flank behind the CG, as in a PIT manoeuvre; otherwise: [prior] \
             bullet_speed_m_s",
            "Anstoß an die Flanke hinter dem Schwerpunkt, wie bei einem PIT-Manöver; sonst: \
             [prior] bullet_speed_m_s",
        ],
    },
    Group {
        subject: CaveatSubject::ContactPoint,
        latents: &[Latent::HeadingTowards],
        reason: [
            "by the struck side; otherwise: [damage] angle_deg or [prior] \
             heading_difference_deg",
            "nach der gestoßenen Seite; sonst: [damage] angle_deg oder [prior] \
             heading_difference_deg",
        ],
    },
    Group {
        subject: CaveatSubject::ContactPoint,
        latents: &[Latent::SideslipTowards, Latent::NormalTilt],
        reason: [
            "a car that turns in; otherwise: [prior] bullet_sideslip_deg",
            "ein einlenkendes Fahrzeug; sonst: [prior] bullet_sideslip_deg",
        ],
    },
    Group {
        subject: CaveatSubject::Restitution,
        latents: &[Latent::ContactFriction],
        reason: [
            "finite-element runs; otherwise: [prior] contact_friction",
            "Finite-Elemente-Rechnungen; sonst: [prior] contact_friction",
        ],
    },
    Group {
        subject: CaveatSubject::Pulse,
        latents: &[Latent::PulseDuration],
        reason: ["finite-element runs", "Finite-Elemente-Rechnungen"],
    },
    Group {
        subject: CaveatSubject::StrikingParameter,
        latents: &[Latent::ContactStiffnessFactor],
        reason: [
            "barrier tests of other cars; their scatter for a side",
            "Barrierenversuche anderer Fahrzeuge; deren Streuung für eine Seite",
        ],
    },
    Group {
        subject: CaveatSubject::RoadFriction,
        latents: &[Latent::RoadFriction],
        reason: [
            "dry and wet asphalt together; otherwise: [road] friction or drag_factor",
            "trockener und nasser Asphalt zusammen; sonst: [road] friction oder drag_factor",
        ],
    },
    Group {
        subject: CaveatSubject::RoadFriction,
        latents: &[
            Latent::TireFrictionFactor,
            Latent::StrikingTireFrictionFactor,
            Latent::LongitudinalFrictionRatio,
        ],
        reason: [
            "tires differ from those of a friction test; otherwise: [road] drag_factor, of this \
             car with locked wheels",
            "die Reifen sind nicht die der Reibwertmessung; sonst: [road] drag_factor, dieses \
             Fahrzeugs mit blockierten Rädern",
        ],
    },
    Group {
        subject: CaveatSubject::RoadFriction,
        latents: &[Latent::ZoneFrictionFactor],
        reason: [
            "nothing says how well the zones of the site are known; all are better or worse \
             together",
            "nichts sagt, wie genau die Bereiche des Geländes bekannt sind; alle sind gemeinsam \
             griffiger oder glatter",
        ],
    },
    Group {
        subject: CaveatSubject::Vehicle,
        latents: &[
            Latent::BrakeDecision,
            Latent::BrakeStart,
            Latent::BrakeShare,
            Latent::BrakeRise,
            Latent::FrontBrakeShift,
        ],
        reason: [
            "nobody says what the driver did; otherwise: [after] driver_braked, [prior] \
             brake_start_s, brake_share",
            "zum Verhalten des Fahrers liegt keine Angabe vor; sonst: [after] driver_braked, \
             [prior] brake_start_s, brake_share",
        ],
    },
    Group {
        subject: CaveatSubject::Vehicle,
        latents: &[Latent::EngineBraking, Latent::SteerAngle],
        reason: [
            "neutral to third gear where the driver does not brake; toe, play and a hand on the \
             wheel",
            "Leerlauf bis dritter Gang, wo der Fahrer nicht bremst; Spur, Spiel und eine Hand \
             am Lenkrad",
        ],
    },
    Group {
        subject: CaveatSubject::Vehicle,
        latents: &[Latent::BlockedWheel, Latent::BlockedDrag],
        reason: [
            "nobody looked; otherwise: [after] blocked_wheels, dragging_wheels",
            "nicht untersucht; sonst: [after] blocked_wheels, dragging_wheels",
        ],
    },
    Group {
        subject: CaveatSubject::Striking,
        latents: &[
            Latent::StrikingBrakeDecision,
            Latent::StrikingBrakeStart,
            Latent::StrikingBrakeShare,
        ],
        reason: [
            "nobody says what its driver did; otherwise: [striking_after] driver_braked, \
             [prior] bullet_brake_start_s, bullet_brake_share",
            "zum Verhalten seines Fahrers liegt keine Angabe vor; sonst: [striking_after] \
             driver_braked, [prior] bullet_brake_start_s, bullet_brake_share",
        ],
    },
    Group {
        subject: CaveatSubject::Striking,
        latents: &[
            Latent::PushDecision,
            Latent::PushSteeringWheel,
            Latent::PushDuration,
            Latent::StrikingYawRate,
        ],
        reason: [
            "it hit a flank behind the CG, as in a PIT manoeuvre; otherwise: [prior] \
             bullet_steering_wheel_deg, 0 to 5 if its driver did not push on",
            "Anstoß an die Flanke hinter dem Schwerpunkt, wie bei einem PIT-Manöver; sonst: \
             [prior] bullet_steering_wheel_deg, 0 bis 5, wenn sein Fahrer nicht weiterschob",
        ],
    },
    Group {
        subject: CaveatSubject::Striking,
        latents: &[Latent::StrikingBlockedWheel, Latent::StrikingBlockedDrag],
        reason: [
            "nobody looked; otherwise: [striking_after] blocked_wheels, dragging_wheels",
            "nicht untersucht; sonst: [striking_after] blocked_wheels, dragging_wheels",
        ],
    },
];

/// What the evidence leaves open and the defaults of the prior fill.
pub(super) fn assumptions(evidence: &Evidence, model: &ForwardModel) -> Vec<Caveat> {
    let (cars, prior) = (model.cars(), model.prior());
    let is_single_car = evidence.is_single_car();
    let is_common = |group: &&Group| group.subject == CaveatSubject::RoadFriction || !is_single_car;
    let own = if is_single_car { single_car::GROUPS } else { &[] };
    let groups = own.iter().chain(GROUPS.iter().filter(is_common));
    let mut all: Vec<Caveat> = groups.filter_map(|group| group.caveat(prior)).collect();
    all.extend(impact_place(evidence));
    let mut add = |subject, value: Phrase, [en, de]: [&str; 2]| {
        all.push(Caveat::assumed(subject, value, Phrase::new(en, de)));
    };
    if evidence.prior.restitution.is_none() && !is_single_car {
        let reason = [
            "finite-element runs; otherwise: [prior] restitution",
            "Finite-Elemente-Rechnungen; sonst: [prior] restitution",
        ];
        let value = Phrase::new(
            "0.24 to 0.66 up to {0}, less beyond",
            "0,24 bis 0,66 bis zu {0}, darüber weniger",
        )
        .with(PhraseValue::given(Quantity::Speed, 5.0));
        add(CaveatSubject::Restitution, value, reason);
    }
    if evidence.road_friction().is_some() && evidence.drag_factor().is_none() {
        let value = Phrase::new(
            "the stated friction is the peak; locked wheels drag with less",
            "der angegebene Reibbeiwert ist der größte; blockierte Räder verzögern weniger",
        );
        let reason = [
            "a drag factor of locked wheels, which is what it is: [road] drag_factor",
            "ein Verzögerungsfaktor blockierter Räder gilt, wie er ist: [road] drag_factor",
        ];
        add(CaveatSubject::RoadFriction, value, reason);
    }
    if !is_single_car {
        for (subject, reason) in without_anti_lock(evidence, prior) {
            add(subject, Phrase::new("no anti-lock brakes", "kein Antiblockiersystem"), reason);
        }
    }
    let estimated = cars.struck.estimated().count();
    if estimated > 0 {
        let value = Phrase::new("{0} estimated from the rest", "{0} aus den übrigen geschätzt")
            .with(PhraseValue::Name(estimated.to_string()));
        let reason = [
            "the evidence does not say them; a data sheet: --vehicle",
            "unter den Anknüpfungstatsachen nicht enthalten; ein Datenblatt: --vehicle",
        ];
        add(CaveatSubject::VehicleParameter, value, reason);
    }
    let estimated = cars.striking.estimated().count();
    if estimated > 0 && !is_single_car {
        let value = Phrase::new(
            "{0} estimated from the rest, at their medians",
            "{0} aus den übrigen geschätzt, mit ihren Medianen",
        )
        .with(PhraseValue::Name(estimated.to_string()));
        let reason = [
            "the evidence does not say them; a data sheet: --striking",
            "unter den Anknüpfungstatsachen nicht enthalten; ein Datenblatt: --striking",
        ];
        add(CaveatSubject::StrikingParameter, value, reason);
    }
    all
}

/// The cars of a collision whose drivers may brake and of whose brakes nobody says whether they have an
/// anti-lock system, with why none is assumed.
fn without_anti_lock(
    evidence: &Evidence,
    prior: &Prior,
) -> Vec<(CaveatSubject, [&'static str; 2])> {
    let both = [
        (
            &evidence.after,
            Latent::BrakeShare,
            CaveatSubject::Vehicle,
            [
                "wheels that are braked too hard lock and slide; otherwise: [after] anti_lock",
                "zu stark gebremste Räder blockieren und gleiten; sonst: [after] anti_lock",
            ],
        ),
        (
            &evidence.striking_after,
            Latent::StrikingBrakeShare,
            CaveatSubject::Striking,
            [
                "its wheels that are braked too hard lock and slide; otherwise: [striking_after] anti_lock",
                "seine zu stark gebremsten Räder blockieren und gleiten; sonst: [striking_after] anti_lock",
            ],
        ),
    ];
    let brakes =
        |share: Latent| prior.components().iter().any(|component| component.latent == share);
    let open = both
        .into_iter()
        .filter(|(after, share, ..)| after.anti_lock.is_unknown() && brakes(*share));
    open.map(|(_, _, subject, reason)| (subject, reason)).collect()
}

/// What the evidence says and the answer does not depend on.
///
/// - `are_followed`: whether both cars are followed through later contacts.
pub(crate) fn unused(evidence: &Evidence, are_followed: bool) -> Vec<Caveat> {
    let Evidence { after, striking_after, prior, .. } = evidence;
    let striking_brakes = prior.striking_brake_start_s.or(prior.striking_brake_share);
    let is_striking_stated = *striking_after != After::default() || striking_brakes.is_some();
    if !evidence.follows_striking_car() && is_striking_stated && !are_followed {
        return vec![Caveat::not_used(
            Phrase::new(
                "wheels and driver of the striking car after the impact",
                "Räder und Fahrer des stoßenden Fahrzeugs nach dem Anstoß",
            ),
            Phrase::new(
                "nothing of its way is among the evidence ([striking_rest], [[striking_mark]], \
                 [striking_edr]), so that it is not followed",
                "zu seinem Weg fehlen Anknüpfungstatsachen (Endlage, Reifenspuren oder \
                 Unfalldatenspeicher), so dass es nicht verfolgt wird",
            ),
        )];
    }
    let both = [
        ("struck", after, prior.brake_start_s.or(prior.brake_share)),
        ("striking", striking_after, striking_brakes),
    ];
    let idle = both.into_iter().filter(|(_, after, _)| after.driver_braked == YesNoUnknown::No);
    let stated = idle.flat_map(|(car, after, range)| {
        let told = [
            (range.is_some(), ["ranges of the braking of the {0}", "Bereiche der Bremsung, {0}"]),
            (
                after.anti_lock == YesNoUnknown::Yes,
                ["anti-lock brakes of the {0}", "Antiblockiersystem, {0}"],
            ),
        ];
        told.into_iter().filter(|(is_stated, _)| *is_stated).map(move |(_, [en, de])| {
            Caveat::not_used(
                Phrase::new(en, de).with(PhraseValue::Term(format!("{car} car"))),
                Phrase::new(
                    "its driver is said not to have braked",
                    "sein Fahrer bremste nach der Angabe nicht",
                ),
            )
        })
    });
    stated.collect()
}

impl Group {
    /// What of the group is assumed; `None` if everything is stated or measured.
    fn caveat(&self, prior: &Prior) -> Option<Caveat> {
        let is_assumed = |component: &&PriorComponent| {
            component.source == PriorSource::Assumed && self.latents.contains(&component.latent)
        };
        let texts: Vec<Phrase> = prior.components().iter().filter(is_assumed).map(text).collect();
        let [en, de] = self.reason;
        let caveat =
            |texts| Caveat::assumed(self.subject, Phrase::joined(texts, "; "), Phrase::new(en, de));
        Some(texts).filter(|texts| !texts.is_empty()).map(caveat)
    }
}

/// The quantity with the interval that holds 90 % of it, or what becomes of it with which probability.
fn text(PriorComponent { latent, distribution, .. }: &PriorComponent) -> Phrase {
    let percent = |share: f64| PhraseValue::fixed(Quantity::Ratio, share, 0).in_unit("%");
    let [low, high] = distribution.support();
    let share_below = |threshold: f64| ((threshold - low) / (high - low)).clamp(0.0, 1.0);
    match latent {
        Latent::BrakeDecision => {
            Phrase::new("the driver brakes with {0}", "der Fahrer bremst mit {0}")
                .with(percent(share_below(BRAKE_PROBABILITY)))
        }
        Latent::AntiLockDecision => Phrase::new(
            "the brakes have an anti-lock system with {0}",
            "die Bremsen haben mit {0} ein Antiblockiersystem",
        )
        .with(percent(share_below(ANTI_LOCK_PROBABILITY))),
        Latent::BlockedWheel | Latent::StrikingBlockedWheel => Phrase::new(
            "each of two wheels near the damage is blocked with {0}",
            "jedes von zwei Rädern nahe dem Schaden ist mit {0} blockiert",
        )
        .with(percent(BLOCKED_PROBABILITY)),
        Latent::StrikingBrakeDecision => {
            let before = share_below(STRIKING_BRAKES_BEFORE);
            let later = share_below(STRIKING_BRAKES) - before;
            Phrase::new(
                "the driver brakes from the first contact on with {0}, later with {1}",
                "der Fahrer bremst mit {0} vom ersten Kontakt an, mit {1} später",
            )
            .with(percent(before))
            .with(percent(later))
        }
        Latent::PushDecision => Phrase::new(
            "its driver steers in and pushes on with {0}",
            "sein Fahrer lenkt mit {0} ein und schiebt weiter",
        )
        .with(percent(share_below(PUSH_PROBABILITY))),
        Latent::ZoneFrictionFactor => {
            let [low, high] =
                distribution.ninety().map(|end| PhraseValue::significant(Quantity::Ratio, end));
            Phrase::new(
                "zones of the site, all with {0} to {1} times the friction that it says",
                "Bereiche des Geländes, alle mit dem {0}- bis {1}-Fachen des angegebenen Reibbeiwerts",
            )
            .with(low)
            .with(high)
        }
        _ => {
            let quantity = latent.quantity();
            let [low, high] =
                distribution.ninety().map(|end| PhraseValue::three_digits(quantity, end));
            let (range, [low, high]) = match quantity {
                Quantity::Angle => {
                    let range =
                        Phrase::new("{0}, 90 %: {1} to {2} deg", "{0}, 90 %: {1}° bis {2}°");
                    (range, [low, high].map(|end| end.in_unit("deg").bare()))
                }
                _ => (
                    Phrase::new("{0}, 90 %: {1} to {2}", "{0}, 90 %: {1} bis {2}"),
                    [low.bare(), high],
                ),
            };
            range.with(PhraseValue::Term(latent.label().to_owned())).with(low).with(high)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::examples::spin;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};
    use impactlab_reconstruct::Cars;
    use impactlab_reconstruct::evidence::RestPose;

    /// What is drawn and not stated stands in the list, whatever it is.
    #[test]
    fn every_assumed_quantity_stands_in_the_list_once() {
        for latent in Latent::ALL {
            let n = GROUPS.iter().filter(|group| group.latents.contains(latent)).count();
            assert!(n <= 1, "{latent:?} stands in {n} groups");
        }
        let mut evidence = spin();
        evidence.friction = None;
        evidence.after = Default::default();
        evidence.striking_rest =
            Some(RestPose { x_m: Some(20.0), y_m: Some(3.0), ..RestPose::default() });
        let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
        let found = assumptions(&evidence, &model);
        for component in model.prior().components() {
            if component.source == PriorSource::Assumed
                && component.latent != Latent::RestitutionShare
            {
                let text = text(component).say(&NumberFormat::default());
                let stands = found.iter().any(|caveat| caveat.text.contains(&text));
                assert!(stands, "{text} is assumed and not told");
            }
        }
        for component in model.prior().components() {
            let text = text(component).say(&NumberFormat::default());
            assert!(!text.contains('°'), "degrees are deg in English: {text}");
        }
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        for caveat in &found {
            assert!(caveat.text_in(&german, &str::to_owned).is_some(), "{caveat}");
            assert!(caveat.reason_in(&german, &str::to_owned).is_some(), "{caveat}");
        }
        let striking = found.iter().find(|caveat| caveat.to_string().contains("[striking_after]"));
        let text = striking.expect("the driver of the striking car").to_string();
        assert!(text.contains("from the first contact on with 40 %, later with 40 %"), "{text}");
    }

    #[test]
    fn what_is_said_and_not_used_is_listed() {
        let mut evidence = spin();
        assert_eq!(unused(&evidence, false), []);
        evidence.striking_after.driver_braked = YesNoUnknown::Yes;
        let texts = unused(&evidence, false).iter().map(Caveat::to_string).collect::<Vec<_>>();
        assert!(matches!(&texts[..], [text] if text.contains("[striking_rest]")), "{texts:?}");
        evidence.striking_rest =
            Some(RestPose { x_m: Some(20.0), y_m: Some(3.0), ..RestPose::default() });
        assert_eq!(unused(&evidence, false), []);
        evidence.striking_after.driver_braked = YesNoUnknown::No;
        evidence.prior.striking_brake_share = Some([Some(1.0), Some(1.2)]);
        let texts = unused(&evidence, false).iter().map(Caveat::to_string).collect::<Vec<_>>();
        assert!(matches!(&texts[..], [text] if text.contains("striking car")), "{texts:?}");
        evidence.striking_after.anti_lock = YesNoUnknown::Yes;
        assert_eq!(unused(&evidence, false).len(), 2);
    }

    #[test]
    fn what_is_stated_is_no_assumption() {
        let mut evidence = spin();
        let assumed = |evidence: &Evidence| {
            let model = ForwardModel::new(evidence, Cars::new(evidence, None, None));
            assumptions(evidence, &model).iter().map(Caveat::to_string).collect::<Vec<_>>()
        };
        let has = |texts: &[String], part: &str| texts.iter().any(|text| text.contains(part));
        assert!(has(&assumed(&evidence), "brakes from, 90 %: 0.4"), "{:?}", assumed(&evidence));
        let (none, drawn) = ("no anti-lock brakes", "anti-lock system with");
        assert!(has(&assumed(&evidence), none) && !has(&assumed(&evidence), drawn));
        let mut said = evidence.clone();
        said.after.anti_lock = YesNoUnknown::No;
        assert!(!has(&assumed(&said), none), "{:?}", assumed(&said));
        evidence.prior.brake_start_s = Some([Some(0.0), Some(0.1)]);
        assert!(!has(&assumed(&evidence), "brakes from"), "{:?}", assumed(&evidence));
    }
}
