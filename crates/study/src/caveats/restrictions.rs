//! What restricts an answer: findings that a report has in a form of its own, as caveats.

use crate::analysis::{RestOutcome, Rival, RivalForce};
use crate::caveats::domain::outside_domain_caveats;
use crate::caveats::few_draws::{few_draws, independent_draws};
use crate::questions::predict::implied_contact::{
    LEAST_P_RIGID, MOST_P_ENERGY_GAIN, warning_phrase,
};
use crate::{
    ImpliedContactReport, PredictForceReport, PredictMotionReport, ReplayedCaseReport,
    SimulateReport,
};
use impactlab_core::collision::{
    Footprint, Scenario, ScenarioGeometry, ScenarioVehicle, TOUCH_TOLERANCE_M,
};
use impactlab_core::data::{
    CONTACT_SHARE_OF_PEAK, Case, Flag, FlagKind, ForceAxes, ForceHistory, Loaded, Note, Severity,
    check_case, check_file, cut_at_s,
};
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_core::vehicle::{
    ContactPoint, REST_SPEED_M_S, RoadSlope, USUAL_SLOPE, VehicleParameters,
};
use impactlab_networks::response::STEP_S;

/// Speed against the heading from which a vehicle moves backwards, m/s; slower ones roll back or slip.
const BACKWARDS_M_S: f64 = 0.5;

/// Outlines that overlap by more than the tolerance within which they touch.
pub(crate) fn overlap_caveat(geometry: &ScenarioGeometry) -> Option<Caveat> {
    let overlap_m = geometry.overlap_m.filter(|overlap_m| *overlap_m > TOUCH_TOLERANCE_M)?;
    let text = Phrase::new(
        "the outlines overlap by {0}; the contact is that at which they first touched",
        "Die Umrisse der Fahrzeuge überdecken sich um {0}; als Kontakt gilt ihre erste Berührung",
    )
    .with(PhraseValue::fixed(Quantity::Length, overlap_m, 2));
    let caveat = Caveat::new(CaveatKind::Overlap, text)
        .with_value("overlap of the outlines [m]", overlap_m)
        .with_range([f64::NEG_INFINITY, TOUCH_TOLERANCE_M]);
    Some(caveat)
}

/// Vehicles that move backwards at the first contact, which a wrong sign or heading says more often than a driver
/// does.
pub(crate) fn backwards(scenario: &Scenario) -> Vec<Caveat> {
    let vehicles = [
        (&scenario.struck, "the struck vehicle", "das gestoßene Fahrzeug"),
        (&scenario.striking, "the striking vehicle", "das stoßende Fahrzeug"),
    ];
    let caveat = |(vehicle, en, de): (&ScenarioVehicle, &'static str, &'static str)| {
        let velocity_m_s = [vehicle.vx_world_m_s, vehicle.vy_world_m_s];
        let [ahead_m_s, _] = body_from_world(vehicle.heading_rad, velocity_m_s);
        backwards_caveat(Phrase::new(en, de), ahead_m_s)
    };
    vehicles.into_iter().filter_map(caveat).collect()
}

/// That a vehicle begins by moving backwards.
///
/// - `ahead_m_s`: its velocity along its heading, m/s.
pub(crate) fn backwards_caveat(which: Phrase, ahead_m_s: f64) -> Option<Caveat> {
    let text = Phrase::new(
        "at the start {0} moves backwards, at {1} against its heading; if it drove ahead, the sign of its speed or \
         its heading is wrong",
        "zu Beginn bewegt sich {0} rückwärts, mit {1} gegen seine Fahrtrichtung; fuhr es vorwärts, stimmt das \
         Vorzeichen der Geschwindigkeit oder die Richtung nicht",
    )
    .with(PhraseValue::phrase(which))
    .with(PhraseValue::significant(Quantity::Speed, ahead_m_s.abs()));
    (ahead_m_s < -BACKWARDS_M_S).then(|| Caveat::new(CaveatKind::Note, text))
}

/// An impact that gives energy to the vehicles, as sliding friction as the paper prints it can.
pub(crate) fn energy_gain_caveat(dissipated_j: f64) -> Option<Caveat> {
    // Rounding is far below.
    let is_gain = dissipated_j < -1.0;
    is_gain.then(|| {
        let text = Phrase::new(
            "the contact gives kinetic energy to the vehicles, which no contact does: the friction \
             of this model pushes them instead of holding them back; do not rely on it",
            "Der Kontakt führt den Fahrzeugen Bewegungsenergie zu, was kein Anstoß vermag: Die Reibung \
             dieses Modells treibt sie an, statt sie zu bremsen. Das Ergebnis ist nicht verwertbar",
        );
        Caveat::new(CaveatKind::EnergyGain, text)
            .with_value("energy lost in the contact [J]", dissipated_j)
            .with_range([0.0, f64::INFINITY])
    })
}

/// A road that is steeper than any on which the program was compared with a motion.
pub(crate) fn slope_caveat(slope: &RoadSlope) -> Option<Caveat> {
    let steepest = [slope.grade, slope.cross_slope].map(f64::abs).into_iter().fold(0.0, f64::max);
    slope.is_unusual().then(|| {
        let text = Phrase::new(
            "the road has a slope of {0}; motions were compared on level roads, and of roads beyond {1} \
             nothing is known of how well they are followed",
            "Die Fahrbahn hat eine Neigung von {0}; verglichen wurden Bewegungen auf ebener Fahrbahn, und \
             jenseits von {1} ist über die Güte nichts bekannt",
        )
        .with(PhraseValue::fixed(Quantity::Ratio, steepest, 1).in_unit("%"))
        .with(PhraseValue::fixed(Quantity::Ratio, USUAL_SLOPE, 0).in_unit("%"));
        Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value("slope of the road", steepest)
            .with_range([0.0, USUAL_SLOPE])
    })
}

/// A record of a force that ends during the contact.
pub(crate) fn cut_record_caveat(force: &ForceHistory) -> Option<Caveat> {
    let at_s = cut_at_s(force)?;
    let (peak_n, _) = force.peak()?;
    let (x, y) = force.fx_n.last().zip(force.fy_n.last())?;
    let share = x.hypot(*y) / peak_n;
    let text = Phrase::new(
        "the record ends after {0} at {1} of the peak, with the vehicles in contact: its \
         impulse is not complete, nor the motion that follows from it",
        "Die Aufzeichnung endet nach {0} bei {1} des Höchstwerts, noch während des Kontakts: Der \
         Stoßantrieb ist unvollständig, und damit auch die Auslaufbewegung, die aus ihm folgt",
    )
    .with(PhraseValue::fixed(Quantity::Time, at_s, 3))
    .with(PhraseValue::Share(share));
    let caveat = Caveat::new(CaveatKind::ContactNotEnded, text)
        .with_value("force at the end as a share of the peak", share)
        .with_range([0.0, CONTACT_SHARE_OF_PEAK]);
    Some(caveat)
}

/// What a check of a file finds wrong with it. That a record ends during the contact is said by
/// [`cut_record_caveat`].
///
/// - `name`: of the file.
pub(crate) fn doubtful_data_caveats(name: &str, loaded: &Loaded) -> Vec<Caveat> {
    doubts(name, check_file(loaded))
}

/// What a file says of itself that puts its numbers in doubt, for an answer that has no remarks on files.
///
/// - `name`: of the file.
pub(crate) fn doubtful_note_caveats(name: &str, loaded: &Loaded) -> Vec<Caveat> {
    let doubt = |note: &Note| {
        let text = Phrase::new("{0}: {1}", "{0}: {1}")
            .with(PhraseValue::Name(name.to_owned()))
            .with(PhraseValue::English(note.to_string()));
        Caveat::new(CaveatKind::DoubtfulData, text)
    };
    loaded.notes.iter().filter(|note| note.is_doubt()).map(doubt).collect()
}

/// A force that pulls at the point where it acts, as no contact does.
///
/// - `yaw_rad`: heading of the vehicle at the start, rad.
pub(crate) fn pulling_caveat(
    force: &ForceHistory,
    contact: ContactPoint,
    vehicle: &VehicleParameters,
    yaw_rad: f64,
) -> Option<Caveat> {
    let impulse_body_n_s = match force.axes {
        ForceAxes::World => body_from_world(yaw_rad, force.impulse_n_s()),
        ForceAxes::Body => force.impulse_n_s(),
    };
    let point_m = [contact.x_body_m, contact.y_body_m];
    Footprint::from(&vehicle.geometry).pulled_side(point_m, impulse_body_n_s)?;
    let text = Phrase::new(
        "the force pulls at its contact point ({0} ahead, {1} left of the CG) instead of pushing into the \
         vehicle; check the signs of its components, its axes and the contact point",
        "Die Kraft zieht an ihrem Kontaktpunkt ({0} vor und {1} links vom Schwerpunkt), statt in das Fahrzeug \
         zu drücken; zu prüfen sind die Vorzeichen der Komponenten, die Achsen und der Kontaktpunkt",
    )
    .with(PhraseValue::three_digits(Quantity::Length, contact.x_body_m))
    .with(PhraseValue::three_digits(Quantity::Length, contact.y_body_m));
    Some(Caveat::new(CaveatKind::DoubtfulData, text))
}

/// The same for a case of a data set.
pub(crate) fn doubtful_case_caveats(case: &Case) -> Vec<Caveat> {
    doubts(&case.name, check_case(case))
}

fn doubts(name: &str, flags: Vec<Flag>) -> Vec<Caveat> {
    let is_doubt =
        |flag: &Flag| flag.severity > Severity::Info && flag.kind != FlagKind::NotSeparated;
    let caveat = |flag: Flag| {
        let text = Phrase::new("{0}: {1}", "{0}: {1}")
            .with(PhraseValue::Name(name.to_owned()))
            .with(PhraseValue::phrase(flag.phrase()));
        Caveat::new(CaveatKind::DoubtfulData, text)
    };
    flags.into_iter().filter(is_doubt).map(caveat).collect()
}

/// What restricts the simulation of one vehicle.
///
/// - `until_rest`: whether the question asks where the vehicle comes to rest.
pub(crate) fn simulation_caveats(report: &SimulateReport, until_rest: bool) -> Vec<Caveat> {
    let moving = report.end.filter(|_| until_rest && report.rest.is_none());
    let moving = moving.map(|end| motion_caveat(end.speed_m_s, report.duration_s));
    let n_failed = report.uncertainty.as_ref().map_or(0, |uncertainty| uncertainty.n_failed);
    let left_out = left_out_caveat(n_failed, "vehicles drawn from the data sheet");
    let few = report.uncertainty.as_ref().and_then(|uncertainty| {
        let n_draws = uncertainty.n_draws - uncertainty.n_failed;
        few_draws(n_draws, uncertainty.monte_carlo.as_ref())
    });
    let flags = report.flags.iter().map(|flag| flag.caveat.clone());
    flags.chain(moving).chain(left_out).chain(few).collect()
}

/// How many cases raise each kind of flag.
pub(crate) fn flagged_cases_caveats(cases: &[ReplayedCaseReport]) -> Vec<Caveat> {
    let mut kinds: Vec<CaveatKind> =
        cases.iter().flat_map(|case| case.flags.iter().map(|flag| flag.caveat.kind)).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let of_kind = |kind| {
        let is_flagged =
            |case: &&ReplayedCaseReport| case.flags.iter().any(|flag| flag.caveat.kind == kind);
        let n = cases.iter().filter(is_flagged).count();
        let text = Phrase::new("in {0} of {1} cases", "in {0} von {1} Fällen")
            .with(PhraseValue::Name(n.to_string()))
            .with(PhraseValue::Name(cases.len().to_string()));
        Caveat::new(kind, text).with_value("cases", n as f64).with_range([0.0, 0.0])
    };
    kinds.into_iter().map(of_kind).collect()
}

/// A motion that goes on at the end of its answer.
///
/// - `speed_m_s`: speed at the end.
pub(crate) fn motion_caveat(speed_m_s: f64, after_s: f64) -> Caveat {
    let text = Phrase::new(
        "the vehicle still moves at {0} after {1}: its end is not where it comes to rest",
        "Das Fahrzeug bewegt sich nach {1} noch mit {0}: Der Endpunkt der Bewegung ist nicht seine \
         Endlage",
    )
    .with(PhraseValue::fixed(Quantity::Speed, speed_m_s, 1))
    .with(PhraseValue::fixed(Quantity::Time, after_s, 2));
    Caveat::new(CaveatKind::NotAtRest, text)
        .with_value("speed at the end [m/s]", speed_m_s)
        .with_range([0.0, REST_SPEED_M_S])
}

/// Draws of a motion that is followed to rest and still move at the limit of time.
pub(crate) fn rest_caveat(rest: &RestOutcome) -> Option<Caveat> {
    let speed_m_s = rest.moving_speed_m_s?;
    let text = Phrase::new(
        "in {0} of {1} draws the vehicle still moves after {2}, at {3} in the median: \
         times and distances to rest are longer than said",
        "In {0} von {1} Ziehungen bewegt sich das Fahrzeug nach {2} noch, im Median mit {3}: \
         Auslaufzeit und Auslaufstrecke sind länger als angegeben",
    )
    .with(PhraseValue::Share(1.0 - rest.share_at_rest))
    .with(PhraseValue::Name(rest.n_draws.to_string()))
    .with(PhraseValue::fixed(Quantity::Time, rest.limit_s, 2))
    .with(PhraseValue::fixed(Quantity::Speed, speed_m_s, 1));
    let caveat = Caveat::new(CaveatKind::NotAtRest, text)
        .with_value("share of the draws at rest", rest.share_at_rest)
        .with_range([1.0, 1.0]);
    Some(caveat)
}

/// A motion that lasts longer than those that the response network has learned from.
fn duration_caveat(report: &PredictMotionReport) -> Option<Caveat> {
    let end_s = match &report.rest {
        Some(rest) => rest.time_s.ninety()[1],
        None => report.outcome.time_s,
    };
    let learned_s = report.learned_duration_s;
    // A record of 400 samples and a forecast of 4 s differ by one of them.
    if end_s <= learned_s + 1.5 * STEP_S {
        return None;
    }
    let text = Phrase::new(
        "the motion lasts {0}, the response network has learned from motions of up to \
         {1}: from there on this is the 4DOF model with the strengths that it knows",
        "Die Bewegung dauert {0}; das Bewegungsnetz hat an Bewegungen von bis zu {1} gelernt. Danach \
         gilt das 4DOF-Modell mit den gelernten Beiwerten",
    )
    .with(PhraseValue::fixed(Quantity::Time, end_s, 2))
    .with(PhraseValue::fixed(Quantity::Time, learned_s, 2));
    let caveat = Caveat::new(CaveatKind::OutsideDomain, text)
        .with_value("duration of the motion [s]", end_s)
        .with_range([0.0, learned_s]);
    Some(caveat)
}

/// What restricts a predicted force.
///
/// - `predicted`: those of the force network.
pub(crate) fn predicted_force_caveats(
    report: &PredictForceReport,
    predicted: &[Caveat],
) -> Vec<Caveat> {
    let contact = report.implied_contact.as_ref().and_then(contact_caveat);
    predicted.iter().cloned().chain(contact).collect()
}

/// What restricts a predicted motion.
///
/// - `predicted`: those of the force network, where it predicts the force.
pub(crate) fn predicted_motion_caveats(
    report: &PredictMotionReport,
    predicted: &[Caveat],
) -> Vec<Caveat> {
    let domain = outside_domain_caveats(report);
    let contact = report.implied_contact.as_ref().and_then(contact_caveat);
    let flags = report.flags.iter().map(|flag| flag.caveat.clone());
    let end = &report.outcome;
    let moving = match &report.rest {
        Some(rest) => rest_caveat(rest),
        None => (!end.is_at_rest).then(|| motion_caveat(end.speed_m_s, end.time_s)),
    };
    let beyond = duration_caveat(report);
    let few = few_draws(independent_draws(report), end.monte_carlo.as_ref());
    let n_failed = report.contacts.as_ref().map_or(0, |contacts| contacts.n_failed);
    let left_out = left_out_caveat(n_failed, "draws of the forecast");
    let outside = predicted.iter().cloned().chain(domain).chain(beyond);
    let apart = report.rival.as_ref().and_then(disagreement_caveat);
    outside
        .chain(contact)
        .chain(flags)
        .chain(moving)
        .chain(left_out)
        .chain(few)
        .chain(apart)
        .collect()
}

/// A predicted impulse that no contact brings about.
pub(crate) fn contact_caveat(implied: &ImpliedContactReport) -> Option<Caveat> {
    implied.warning.as_ref()?;
    let text = warning_phrase(implied.p_rigid, implied.p_energy_gain);
    let caveat = Caveat::new(CaveatKind::ImplausibleContact, text);
    Some(if implied.p_rigid < LEAST_P_RIGID {
        let quantity = "share of the impulse with a restitution between 0 and 1";
        caveat.with_value(quantity, implied.p_rigid).with_range([LEAST_P_RIGID, 1.0])
    } else {
        let quantity = "share of the impulse that adds kinetic energy";
        caveat.with_value(quantity, implied.p_energy_gain).with_range([0.0, MOST_P_ENERGY_GAIN])
    })
}

/// A forecast in whose bands the other method does not end, by more than that method is known to err.
fn disagreement_caveat(rival: &Rival) -> Option<Caveat> {
    let Rival { apart_m, time_s, known_error_m, .. } = *rival;
    if rival.is_in_region() || rival.is_within_known_error() {
        return None;
    }
    let force = match rival.force {
        RivalForce::Same => Phrase::new("under the same force", "unter derselben Kraft"),
        RivalForce::Momentum => Phrase::new(
            "under the impulse of the momentum solution",
            "unter dem Stoßantrieb der Impulslösung",
        ),
    };
    let text = Phrase::new(
        "the 4DOF model {0} is {1} away after {2}, outside the 90 % region and more \
         than it is known to err: network and physics do not say the same",
        "Das 4DOF-Modell {0} liegt nach {2} um {1} entfernt, außerhalb des 90-%-Bereichs und weiter, als \
         sein bekannter Fehler reicht: Netz und Physik widersprechen sich",
    )
    .with(PhraseValue::phrase(force))
    .with(PhraseValue::fixed(Quantity::Length, apart_m, 1))
    .with(PhraseValue::fixed(Quantity::Time, time_s, 2));
    let caveat = Caveat::new(CaveatKind::Disagreement, text)
        .with_value("distance to the 4DOF model [m]", apart_m)
        .with_range([0.0, known_error_m]);
    Some(caveat)
}

/// Cases or draws that could not be used.
///
/// - `what`: what they are, in the plural.
pub(crate) fn left_out_caveat(n: usize, what: &str) -> Option<Caveat> {
    let caveat = || {
        let text = Phrase::new("{0} {1} could not be used", "Nicht verwendbar: {0} {1}")
            .with(PhraseValue::Name(n.to_string()))
            .with(PhraseValue::Term(what.to_owned()));
        Caveat::new(CaveatKind::LeftOut, text).with_value(what, n as f64).with_range([0.0, 0.0])
    };
    (n > 0).then(caveat)
}

/// Cases that the network which they judge has learned from.
pub(crate) fn trained_on_caveat(n_known: usize, n_test: usize) -> Option<Caveat> {
    let text = Phrase::new(
        "the model was trained on {0} of these {1} cases",
        "Das Modell wurde mit {0} dieser {1} Fälle trainiert",
    );
    let caveat = of_cases(CaveatKind::TrainedOn, text, [n_known, n_test])?;
    Some(caveat.with_value("cases that it was trained on", n_known as f64).with_range([0.0, 0.0]))
}

/// Cases whose bodies the network that is judged by them draws.
pub(crate) fn open_bodies_caveat(n_open: usize, n_test: usize) -> Option<Caveat> {
    let text = Phrase::new(
        "{0} of these {1} cases name no body that the force network knows: it is left open",
        "{0} dieser {1} Fälle nennen keinen Aufbau, den das Kraftnetz kennt: Er bleibt offen",
    );
    of_cases(CaveatKind::OutsideDomain, text, [n_open, n_test])
}

/// What is said of some of all cases; none where there is none of them.
fn of_cases(kind: CaveatKind, text: Phrase, [n, n_all]: [usize; 2]) -> Option<Caveat> {
    let counted = |n: usize| PhraseValue::Name(n.to_string());
    (n > 0).then(|| Caveat::new(kind, text.with(counted(n)).with(counted(n_all))))
}

/// That the response network forecasts a motion from which it has learned.
pub(crate) fn learned_motion_caveat() -> Caveat {
    let text = Phrase::new(
        "the response network has learned from this motion: that it is near the record says nothing of other motions",
        "Das Bewegungsnetz hat an dieser Bewegung gelernt: Dass es nahe an der Aufzeichnung liegt, besagt nichts über \
         andere Bewegungen",
    );
    Caveat::new(CaveatKind::TrainedOn, text)
}

/// That a network tells of a case from which it has learned.
pub(crate) fn learned_case_caveat(kind: CaveatKind) -> Caveat {
    let text = Phrase::new(
        "the force network has learned from this case: that it is near the record says nothing of other \
         collisions",
        "Das Kraftnetz hat an diesem Fall gelernt: Dass es nahe an der Aufzeichnung liegt, besagt nichts über \
         andere Kollisionen",
    );
    Caveat::new(kind, text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caveats::domain::outside_domain_caveat;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};
    use impactlab_networks::response::OutsideDomain;
    use std::path::Path;

    #[test]
    fn a_vehicle_that_moves_against_its_heading_is_named() {
        let mut scenario = Scenario::preset_or_file(Path::new("pit-right-rear")).unwrap();
        assert!(backwards(&scenario).is_empty());
        scenario.struck.vx_world_m_s *= -1.0;
        scenario.struck.vy_world_m_s *= -1.0;
        let found = backwards(&scenario);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].text.starts_with("at the start the struck vehicle moves backwards"));
    }

    #[test]
    fn restrictions_are_told_in_the_units_and_the_language_of_the_reader() {
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let told = |caveat: &Caveat| {
            let german = caveat.text_in(&german, &str::to_owned).unwrap();
            let [si, us] =
                [UnitSystem::Si, UnitSystem::Us].map(|units| caveat.in_units(units).text);
            [caveat.text.clone(), si, us, german]
        };
        let expected = [
            "the vehicle still moves at 10.0 m/s after 4.00 s: its end is not where it comes to rest",
            "the vehicle still moves at 36.0 km/h after 4.00 s: its end is not where it comes to rest",
            "the vehicle still moves at 22.4 mph after 4.00 s: its end is not where it comes to rest",
            "Das Fahrzeug bewegt sich nach 4,00 s noch mit 36,0 km/h: Der Endpunkt der Bewegung ist nicht \
             seine Endlage",
        ];
        assert_eq!(told(&motion_caveat(10.0, 4.0)), expected);
        let (quantity, range) = ("mass [kg]", [800.0, 2500.0]);
        let heavy = outside_domain_caveat(&OutsideDomain { quantity, value: 3000.0, range });
        let expected = [
            "mass [kg] is 3000, the response network has learned from 800.0 to 2500",
            "mass [kg] is 3000, the response network has learned from 800.0 to 2500",
            "mass [lb] is 6614, the response network has learned from 1764 to 5512",
            "mass [kg] beträgt 3000; das Bewegungsnetz hat an Werten von 800,0 bis 2500 gelernt",
        ];
        assert_eq!(told(&heavy), expected);
    }
}
