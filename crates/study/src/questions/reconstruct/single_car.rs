//! What the evidence of a single car leaves open, and what of its question it has no use for.

use crate::questions::reconstruct::assumed::Group;
use crate::{ReconstructRequest, VehicleChoice};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::Phrase;
use impactlab_reconstruct::Latent;
use impactlab_reconstruct::evidence::{DriverBraked, Evidence, Start};

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
    let Start { road_wheel_rad, brake_start_s, brake_share, .. } = &evidence.start;
    let brakes = brake_start_s.or(*brake_share);
    let (after, is_all_locked) = (&evidence.after, evidence.after.is_all_locked());
    let alone =
        ["the evidence is of a single car", "die Anknüpfungstatsachen sind die eines Fahrzeugs"];
    let is_idle = after.driver_braked == DriverBraked::No || is_all_locked;
    let locked = [
        "its driver is said not to have braked, or all wheels are said to have been locked",
        "sein Fahrer bremste nach der Angabe nicht, oder alle Räder waren blockiert",
    ];
    let told = [
        (
            request.striking != VehicleChoice::Automatic,
            ["the striking vehicle", "das stoßende Fahrzeug"],
            alone,
        ),
        (request.one_contact, ["the choice of one contact", "die Wahl eines Kontakts"], alone),
        (is_idle && brakes.is_some(), ["ranges of the braking", "Bereiche der Bremsung"], locked),
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
    end_open(evidence).into_iter().chain([of_validation()]).collect()
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
         motion, and on no real one; marks of a car with an anti-lock system are taken for those of locked wheels",
        "Die Intervalle eines einzelnen Fahrzeugs wurden an Fahrzeugen geprüft, die dieses Programm mit seinen \
         eigenen Bewegungsgleichungen berechnet hat, und an keinem realen. Spuren eines Fahrzeugs mit \
         Antiblockiersystem gelten als die blockierter Räder",
    );
    Caveat::new(CaveatKind::HardlyValidated, text)
}
