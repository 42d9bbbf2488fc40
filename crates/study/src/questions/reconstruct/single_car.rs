//! What the evidence of a single car leaves open, and what of its question it has no use for.

use crate::questions::reconstruct::assumed::Group;
use crate::{ReconstructRequest, VehicleChoice};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::Phrase;
use impactlab_reconstruct::Latent;
use impactlab_reconstruct::evidence::{Evidence, Start, YesNoUnknown, ends};

/// What is assumed of everything but the friction that nobody stated.
pub(super) const GROUPS: &[Group] = &[
    Group {
        subject: CaveatSubject::Start,
        latents: &[Latent::CarSpeed],
        reason: [
            "each value equally likely; otherwise: [start] speed_m_s",
            "jeder Wert gleich wahrscheinlich; sonst: [start] speed_m_s",
        ],
    },
    Group {
        subject: CaveatSubject::Start,
        latents: &[Latent::CarSideslip, Latent::CarYawRate],
        reason: [
            "a car at the limit of friction that has not turned around yet; otherwise: [start] \
             sideslip_deg, yaw_rate_deg_s",
            "ein Fahrzeug an der Haftgrenze, das sich noch nicht gedreht hat; sonst: [start] \
             sideslip_deg, yaw_rate_deg_s",
        ],
    },
    Group {
        subject: CaveatSubject::Start,
        latents: &[Latent::StartCourse],
        reason: [
            "along the first piece of the earliest mark, or else towards rest; otherwise: [start] \
             heading_deg",
            "längs des ersten Stücks der frühesten Spur, sonst zum Stillstand hin; sonst: [start] \
             heading_deg",
        ],
    },
    Group {
        subject: CaveatSubject::Wheels,
        latents: &[
            Latent::BrakeDecision,
            Latent::BrakeStart,
            Latent::BrakeShare,
            Latent::BrakeRise,
            Latent::FrontBrakeShift,
        ],
        reason: [
            "nobody says what the driver did; otherwise: [wheels] driver_braked, blocked_wheels, \
             [start] brake_start_s, brake_share",
            "zum Verhalten des Fahrers liegt keine Angabe vor; sonst: [wheels] driver_braked, \
             blocked_wheels, [start] brake_start_s, brake_share",
        ],
    },
    Group {
        subject: CaveatSubject::Wheels,
        latents: &[Latent::BrakedBeforeShare],
        reason: [
            "how hard the driver braked before the start is not said; otherwise: [start] \
             braked_before_share",
            "wie stark der Fahrer vor dem Anfang bremste, ist nicht angegeben; sonst: [start] \
             braked_before_share",
        ],
    },
    Group {
        subject: CaveatSubject::Wheels,
        latents: &[Latent::AntiLockDecision],
        reason: [
            "without it, wheels that are braked too hard lock and slide, and the car was slower; otherwise: \
             [wheels] anti_lock",
            "ohne es blockieren und gleiten zu stark gebremste Räder, und das Fahrzeug war langsamer; sonst: \
             [wheels] anti_lock",
        ],
    },
    Group {
        subject: CaveatSubject::Wheels,
        latents: &[Latent::EngineBraking, Latent::SteerAngle],
        reason: [
            "neutral to third gear where the driver does not brake; front wheels held at one angle; \
             otherwise: [start] road_wheel_deg",
            "Leerlauf bis dritter Gang, wo der Fahrer nicht bremst; Vorderräder mit einem Winkel \
             gehalten; sonst: [start] road_wheel_deg",
        ],
    },
    Group {
        subject: CaveatSubject::Wheels,
        latents: &[Latent::BlockedDrag],
        reason: [
            "how much a wheel drags is not known",
            "wie stark ein Rad schleift, ist nicht bekannt",
        ],
    },
];

/// What the question or the evidence says and the answer does not depend on.
pub(super) fn unused(request: &ReconstructRequest, evidence: &Evidence) -> Vec<Caveat> {
    let Start {
        road_wheel_rad,
        brake_start_s,
        brake_share,
        braked_before_s,
        braked_before_share,
        ..
    } = &evidence.start;
    let is_before_idle =
        braked_before_s.or(*braked_before_share).is_some() && !evidence.brakes_before_start();
    let brakes = brake_start_s.or(*brake_share);
    let (after, is_all_locked) = (&evidence.after, evidence.after.is_all_locked());
    let alone =
        ["the evidence is of a single car", "die Anknüpfungstatsachen sind die eines Fahrzeugs"];
    let is_idle = after.driver_braked == YesNoUnknown::No || is_all_locked;
    let locked = [
        "its driver is said not to have braked, or all wheels are said to have been locked",
        "sein Fahrer bremste nach der Angabe nicht, oder alle Räder waren blockiert",
    ];
    let is_anti_lock = after.anti_lock == YesNoUnknown::Yes;
    let told = [
        (
            request.striking != VehicleChoice::Automatic,
            ["the striking vehicle", "das stoßende Fahrzeug"],
            alone,
        ),
        (request.one_contact, ["the choice of one contact", "die Wahl eines Kontakts"], alone),
        (is_idle && brakes.is_some(), ["ranges of the braking", "Bereiche der Bremsung"], locked),
        (
            is_before_idle,
            ["ranges of the braking before the start", "Bereiche der Bremsung vor dem Anfang"],
            [
                "its driver is said not to have braked, or for how long he did is not said",
                "sein Fahrer bremste nach der Angabe nicht, oder deren Dauer ist nicht angegeben",
            ],
        ),
        (is_idle && is_anti_lock, ["anti-lock brakes", "das Antiblockiersystem"], locked),
        (
            is_all_locked && road_wheel_rad.is_some(),
            ["range of the angle of the front wheels", "Bereich des Winkels der Vorderräder"],
            ["locked wheels do not steer", "blockierte Räder lenken nicht"],
        ),
    ];
    let caveat = |[en, de]: [&'static str; 2], [why_en, why_de]: [&'static str; 2]| {
        Caveat::not_used(Phrase::new(en, de), Phrase::new(why_en, why_de))
    };
    let stated = told.into_iter().filter(|(is_stated, ..)| *is_stated);
    stated.map(|(_, what, why)| caveat(what, why)).collect()
}

/// What the intervals do not allow for.
pub(super) fn restrictions(evidence: &Evidence) -> Vec<Caveat> {
    let open = end_open(evidence).into_iter().chain(brakes_twice(evidence));
    open.chain([of_validation()]).collect()
}

/// That a driver who braked before the start is said to begin to brake after it.
fn brakes_twice(evidence: &Evidence) -> Option<Caveat> {
    let is_later = ends(evidence.start.brake_start_s).is_some_and(|[first_s, _]| first_s > 0.0);
    let is_read = evidence.brakes_before_start() && !evidence.after.is_all_locked();
    let text = Phrase::new(
        "braking before the start does not go with a driver who begins to brake after it: [start] braked_before_s, \
         brake_start_s",
        "eine Bremsung vor dem Anfang passt nicht zu einem Fahrer, der erst danach zu bremsen beginnt: [start] \
         braked_before_s, brake_start_s",
    );
    (is_later && is_read).then(|| Caveat::new(CaveatKind::Disagreement, text))
}

/// That the end of the marks stands for the place of rest where nobody says this.
fn end_open(evidence: &Evidence) -> Option<Caveat> {
    let text = Phrase::new(
        "no place of rest is stated: a car that brakes is taken to brake until it stops, so that the end of its \
         marks tells where that is; one that let the brake go, left the road or was stopped by something there \
         was faster",
        "Ein Ort des Stillstands ist nicht angegeben: Ein Fahrzeug, das bremst, gilt als bis zum Stillstand \
         gebremst, und das Ende seiner Spuren sagt, wo es steht. Wurde dort die Bremse gelöst, die Fahrbahn \
         verlassen oder das Fahrzeug aufgehalten, war es schneller",
    );
    evidence.rest.is_none().then(|| Caveat::new(CaveatKind::DriverOpen, text))
}

/// What the intervals have been tried on.
fn of_validation() -> Caveat {
    let text = Phrase::new(
        "intervals of a single car were tried on cars that this program simulated with its own equations of \
         motion, and on no real one; an anti-lock system leaves no marks in it, real ones leave faint ones",
        "Die Intervalle eines einzelnen Fahrzeugs wurden an Fahrzeugen geprüft, die dieses Programm mit seinen \
         eigenen Bewegungsgleichungen berechnet hat, und an keinem realen. Ein Antiblockiersystem hinterlässt \
         darin keine Spuren, in Wirklichkeit schwache",
    );
    Caveat::new(CaveatKind::HardlyValidated, text)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::questions::reconstruct::assumed::assumptions;
    use crate::questions::reconstruct::badges::beside_locked_marks;
    use impactlab_core::data::TomlFile;
    use impactlab_core::vehicle::Wheel;
    use impactlab_reconstruct::evidence::EvidenceKind;
    use impactlab_reconstruct::{Cars, ForwardModel};

    fn evidence(start: &str, wheels: &str) -> Evidence {
        let mark = "[[mark]]\nwheel = \"FL\"\nkind = \"locked\"\npoints_m = [[0, 0], [9, 0]]\n";
        let text = format!(
            "case = \"skid\"\nkind = \"single_car\"\n[car]\n[start]\n{start}\n[wheels]\n{wheels}\n{mark}"
        );
        Evidence::from_toml(TomlFile { path: Path::new("case.toml"), text: &text }).unwrap()
    }

    #[test]
    fn what_is_taken_of_braking_before_the_start_is_said() {
        let told = |start: &str, wheels: &str| {
            let evidence = evidence(start, wheels);
            let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
            let all = assumptions(&evidence, &model);
            all.iter().any(|caveat| caveat.to_string().contains("[start] braked_before_share"))
        };
        let (time, share) = ("braked_before_s = [0.2, 0.4]", "braked_before_share = [0.4, 0.5]");
        let both = format!("{time}\n{share}");
        assert!(told(time, ""));
        assert!(!told(&both, "") && !told(share, "") && !told("", ""));
        let request = ReconstructRequest::new(crate::EvidenceChoice::File("case.toml".into()));
        let unused =
            |start: &str, wheels: &str| !unused(&request, &evidence(start, wheels)).is_empty();
        assert!(unused(share, "") && unused(&both, "driver_braked = \"no\""));
        assert!(!unused(&both, "") && !unused(time, ""));
    }

    #[test]
    fn braking_before_the_start_that_begins_after_it_is_told() {
        let told = |start: &str, wheels: &str| brakes_twice(&evidence(start, wheels)).is_some();
        let (before, later) = ("braked_before_s = [0.2, 0.4]", "brake_start_s = [1, 2]");
        let both = format!("{before}\n{later}");
        assert!(told(&both, "") && !told(&both, "driver_braked = \"no\""));
        assert!(!told(before, "") && !told(later, ""));
        assert!(!told(&format!("{before}\nbrake_start_s = [0, 2]"), ""));
        assert!(restrictions(&evidence(&both, "")).iter().any(|it| it.text.contains("after it")));
    }

    #[test]
    fn what_is_taken_of_anti_lock_brakes_is_said() {
        let drawn = |wheels: &str| {
            let evidence = evidence("", wheels);
            let model = ForwardModel::new(&evidence, Cars::new(&evidence, None, None));
            let all = assumptions(&evidence, &model);
            let found = all.iter().find(|caveat| caveat.to_string().contains("anti-lock system"));
            found.map(ToString::to_string)
        };
        let (yes, no) = ("anti_lock = \"yes\"", "anti_lock = \"no\"");
        let locked = "blocked_wheels = [\"FL\", \"FR\", \"RL\", \"RR\"]";
        let half = drawn("").unwrap();
        assert!(half.contains("have an anti-lock system with 50 %"), "{half}");
        assert!(half.contains("[wheels] anti_lock"), "{half}");
        for said in [yes, no, locked, "driver_braked = \"no\""] {
            assert_eq!(drawn(said), None, "{said}");
        }
        let with_marks = |wheels: &str| beside_locked_marks(&evidence("", wheels)).is_some();
        let both = format!("{locked}\n{yes}");
        assert!(with_marks(yes) && !with_marks(no) && !with_marks(&both) && !with_marks(""));
        assert!(!with_marks(&format!("blocked_wheels = [\"FL\"]\n{yes}")), "damage locked it");
        let mut pair = evidence("", yes);
        pair.kind = EvidenceKind::Collision;
        assert_eq!(beside_locked_marks(&pair), None, "damage may have locked it");
        pair.after.blocked_wheels = Some(Vec::new());
        assert!(beside_locked_marks(&pair).is_some());
        pair.after.dragging_wheels = Some(vec![Wheel::FrontLeft]);
        assert_eq!(beside_locked_marks(&pair), None, "a wheel that drags may have locked");
        let request = ReconstructRequest::new(crate::EvidenceChoice::File("case.toml".into()));
        assert!(!unused(&request, &evidence("", &both)).is_empty());
        assert!(unused(&request, &evidence("", yes)).is_empty());
    }

    /// The kind of a mark was weighed alike in all motions, and nothing said that none of them can leave it.
    #[test]
    fn marks_of_locked_wheels_beside_a_driver_who_did_not_brake_are_told() {
        let told = |evidence: &Evidence| beside_locked_marks(evidence).map(|caveat| caveat.text);
        let coasts = "driver_braked = \"no\"";
        let text = told(&evidence("", coasts)).unwrap();
        assert!(text.starts_with("marks of locked wheels do not go with a driver who"), "{text}");
        assert_eq!(told(&evidence("", "driver_braked = \"yes\"")), None);
        let mut pair = evidence("", &format!("{coasts}\nblocked_wheels = [\"RL\"]"));
        pair.kind = EvidenceKind::Collision;
        assert!(told(&pair).is_some());
        pair.after.blocked_wheels = Some(vec![Wheel::FrontLeft]);
        assert_eq!(told(&pair), None, "damage locked it");
        pair.after.blocked_wheels = None;
        assert_eq!(told(&pair), None, "nobody looked what the damage did");
    }
}
