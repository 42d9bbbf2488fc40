//! Numbers that a question gives and its answer does not depend on: each is listed in the report.
//!
//! A force network knows masses, yaw inertias, velocities, headings, contact point and position of
//! the two vehicles, and the physics about which it is centred their yaw rates.

use crate::analysis::{PulseSetup, StruckVehicle};
use crate::{
    DEFAULT_DRAWS, DEFAULT_DURATION_S, ForceSource, MotionSource, PredictMotionRequest,
    ScenarioChoice, SimulateRequest, StudyError, VehicleChoice,
};
use impactlab_core::collision::{
    FrictionModel, RestitutionForm, Role, Scenario, ScenarioContact, ScenarioVehicle,
};
use impactlab_core::site::Site;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::{ClosedLoop, Integrator, Preset, VehicleParameters};

/// Relative difference of a length from that of the training cases beyond which it is listed.
const SIZE_TOLERANCE: f64 = 0.1;

/// Friction zones, which a forecast with a network does not know.
pub(crate) fn zones_by_network(struck: &StruckVehicle) -> Option<Caveat> {
    let names: Vec<&str> = struck.friction_zones.iter().map(|zone| zone.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        Caveat::not_used(
            Phrase::new("friction zones: {0}", "Bereiche mit eigenem Reibbeiwert: {0}")
                .with(PhraseValue::Name(names.join(", "))),
            Phrase::new(
                "the response network has learned motions on one ground: the forecast has the friction of \
                 the vehicle's tires everywhere",
                "das Bewegungsnetz hat Bewegungen auf einheitlichem Grund gelernt: die Vorhersage hat \
                 überall den Reibbeiwert der Reifen des Fahrzeugs",
            ),
        )
    })
}

/// A slope of the road in a forecast with a response network.
pub(crate) fn slope_by_network(struck: &StruckVehicle) -> Option<Caveat> {
    (!struck.vehicle.slope.is_level()).then(|| {
        Caveat::new(
            CaveatKind::Note,
            Phrase::new(
                "the response network has learned motions on level roads: the weight along the slope is \
                 added to its motion by the equations of motion",
                "das Bewegungsnetz hat Bewegungen auf ebener Fahrbahn gelernt: die Hangabtriebskraft \
                 kommt durch die Bewegungsgleichungen hinzu",
            ),
        )
    })
}

/// A vehicle that was chosen in place of an object that does not move.
pub(crate) fn vehicle_of_fixed(scenario: &Scenario, choice: &VehicleChoice) -> Option<Caveat> {
    let object = scenario.striking.fixed.filter(|_| *choice != VehicleChoice::Automatic)?;
    Some(Caveat::not_used(
        Phrase::new("the chosen striking vehicle", "das gewählte stoßende Fahrzeug"),
        Phrase::new(
            "what the struck vehicle meets is an object that does not move: {0}",
            "das gestoßene Fahrzeug trifft auf ein unbewegliches Objekt: {0}",
        )
        .with(PhraseValue::Term(object.word().to_owned())),
    ))
}

/// The force network, which has learned from collisions of two cars.
pub(crate) fn network_of_fixed(scenario: &Scenario) -> Option<Caveat> {
    let object = scenario.striking.fixed?;
    Some(Caveat::not_used(
        Phrase::new("the force network", "das Kraftnetz"),
        Phrase::new(
            "it has learned from collisions of two cars, and this is one with an object that does not move: \
             {0}; the impulse by momentum and the contact law stand alone",
            "es hat an Kollisionen zweier Fahrzeuge gelernt, diese ist eine mit einem unbeweglichen Objekt: \
             {0}; Impulslösung und Kontaktgesetz gelten allein",
        )
        .with(PhraseValue::Term(object.word().to_owned())),
    ))
}

/// Lanes and kerbs, where a forecast follows one vehicle by itself.
pub(crate) fn lanes_by_network(site: &Site) -> Option<Caveat> {
    let has_places = !site.lanes.is_empty() || !site.kerbs.is_empty();
    has_places.then(|| {
        Caveat::not_used(
            Phrase::new("lanes and kerbs of the site", "Fahrstreifen und Bordsteine des Geländes"),
            Phrase::new(
                "how likely a vehicle comes to them is counted in whole motions: those of both vehicles \
                 through all contacts, of a scenario",
                "wie wahrscheinlich ein Fahrzeug sie erreicht, wird an ganzen Bewegungen gezählt: an denen \
                 beider Fahrzeuge eines Szenarios durch alle Kontakte",
            ),
        )
    })
}

/// How drivers and systems act in a forecast with a response network, if there are some.
pub(crate) fn drivers_by_network(struck: &StruckVehicle) -> Option<Caveat> {
    struck.controls.closed_loop.as_ref().map(|_| {
        Caveat::new(
            CaveatKind::Note,
            Phrase::new(
                "stability control and anti-lock system act in the forecast as in the motion of the 4DOF \
                 model under the same force; they do not react to what the network adds to it",
                "Fahrdynamikregelung (ESC) und Antiblockiersystem wirken in der Vorhersage wie in der Bewegung \
                 des 4DOF-Modells unter derselben Kraft; auf das, was das Netz hinzufügt, reagieren sie nicht",
            ),
        )
    })
}

/// What is drawn of drivers and systems, since nobody states it.
///
/// - `vehicles`: the struck and the striking one.
pub(crate) fn drawn_drivers(vehicles: [&StruckVehicle; 2]) -> Vec<Caveat> {
    let of_vehicle = |(vehicle, role): (&StruckVehicle, Role)| {
        let drawn = vehicle.controls.closed_loop.iter().flat_map(ClosedLoop::distributions);
        let note = |drawn: Phrase| {
            let text = Phrase::new("drawn of the {0}, {1}", "Gezogen ({0}): {1}")
                .with(PhraseValue::Term(role.label().to_owned()))
                .with(PhraseValue::phrase(drawn));
            Caveat::new(CaveatKind::Note, text)
        };
        drawn.map(note).collect::<Vec<_>>()
    };
    vehicles.into_iter().zip(Role::ALL).flat_map(of_vehicle).collect()
}

/// A method of integration that was chosen, where both vehicles are followed through all contacts.
pub(crate) fn integrator_of_pair(integrator: Integrator) -> Option<Caveat> {
    (integrator != Integrator::default()).then(|| {
        Caveat::not_used(
            Phrase::new("method of integration", "Integrationsverfahren"),
            Phrase::new(
                "two vehicles in contact are integrated by the leapfrog method, and by Runge–Kutta while \
                 they are apart",
                "zwei Fahrzeuge in Kontakt werden nach dem Leapfrog-Verfahren integriert, getrennte nach \
                 Runge–Kutta",
            ),
        )
    })
}

/// A single motion through all contacts: what it takes at its median.
///
/// - `is_fixed`: whether the struck vehicle meets an object that does not move, of which there is no forecast.
pub(crate) fn contact_at_medians(is_fixed: bool) -> Caveat {
    if is_fixed {
        let text = Phrase::new(
            "stiffness, friction and recovery of the contact are at their medians",
            "Steifigkeit, Reibung und Rückfederung des Kontakts haben ihre Medianwerte",
        );
        return Caveat::new(CaveatKind::Note, text);
    }
    let text = Phrase::new(
        "stiffness, friction and recovery of the contact are at their medians; a forecast draws them, \
         and small causes decide whether a car that is pushed comes free or spins",
        "Steifigkeit, Reibung und Rückfederung des Kontakts haben ihre Medianwerte; eine Vorhersage zieht \
         sie. Kleine Ursachen entscheiden, ob ein geschobenes Fahrzeug freikommt oder schleudert",
    );
    Caveat::new(CaveatKind::Note, text)
}

/// What a force network does not use of a scenario.
///
/// # Errors
/// [`StudyError::Scenario`] if they do not meet.
pub(crate) fn by_force_network(
    choice: &ScenarioChoice,
    scenario: &Scenario,
) -> Result<Vec<Caveat>, StudyError> {
    scenario.geometry().map_err(|source| choice.unsolved(source))?;
    let vehicles = [
        (Role::Struck, &scenario.struck, Preset::Target),
        (Role::Striking, &scenario.striking, Preset::Bullet2000),
    ];
    let mut unused = Vec::new();
    for (role, vehicle, of_training) in vehicles {
        if has_other_size(vehicle, &of_training.parameters()) {
            unused.push(Caveat::not_used(
                Phrase::new("size of the {0}, {1} × {2}", "Größe: {0}, {1} × {2}")
                    .with(PhraseValue::Term(role.label().to_owned()))
                    .with(PhraseValue::given(Quantity::Length, vehicle.length_m))
                    .with(PhraseValue::given(Quantity::Length, vehicle.width_m)),
                Phrase::new(
                    "the outlines say where the vehicles touch; how far a body reaches and crushes is that \
                     of the cases that the force network has learned from",
                    "die Umrisse sagen, wo sich die Fahrzeuge berühren; wie weit ein Aufbau reicht und sich \
                     verformt, ist durch die Fälle bestimmt, an denen das Kraftnetz gelernt hat",
                ),
            ));
        }
    }
    Ok(unused)
}

/// What a predicted force does not use of what a scenario says of its contact.
///
/// - `applicability`: share of the force network in the answer, 0 to 1; the rest is the momentum
///   solution, which depends on restitution and friction.
pub(crate) fn contact_by_force_network(
    contact: &ScenarioContact,
    applicability: f64,
) -> Vec<Caveat> {
    let mut stated = Vec::new();
    let number = |number: f64| PhraseValue::given(Quantity::Ratio, number);
    let restitution = |e| Phrase::new("restitution, {0}", "Stoßziffer, {0}").with(number(e));
    stated.extend(contact.restitution.map(restitution));
    if contact.restitution_form != RestitutionForm::default() {
        let form = PhraseValue::Term(contact.restitution_form.label().to_owned());
        stated.push(
            Phrase::new("form of the restitution, {0}", "Bezug der Stoßziffer: {0}").with(form),
        );
    }
    match (contact.friction_of_critical, contact.friction_limit) {
        (Some(share), _) => {
            let text = Phrase::new(
                "friction, {0} of the critical ratio",
                "Reibbeiwert, {0} des kritischen Impulsverhältnisses",
            );
            stated.push(text.with(PhraseValue::Share(share)));
        }
        (None, limit) => stated.extend(limit.map(|limit| {
            Phrase::new("friction limit, {0}", "Reibbeiwert im Kontakt, {0}").with(number(limit))
        })),
    }
    let reason = if applicability >= 1.0 {
        Phrase::new(
            "the momentum solution alone depends on it; the force network has learned the course of the \
             contact",
            "nur die Impulslösung hängt davon ab; das Kraftnetz hat den Verlauf des Kontakts gelernt",
        )
    } else {
        Phrase::new(
            "{0} of the answer are those of the force network, which has learned the course of the \
             contact and does not depend on it; the rest uses it",
            "{0} der Antwort stammen vom Kraftnetz, das den Verlauf des Kontakts gelernt hat und nicht \
             davon abhängt; der Rest verwendet den Wert",
        )
        .with(PhraseValue::Share(applicability))
    };
    if applicability <= 0.0 {
        stated.clear();
    }
    let mut unused: Vec<Caveat> =
        stated.into_iter().map(|stated| Caveat::not_used(stated, reason.clone())).collect();
    if contact.friction_model != FrictionModel::Limit {
        let what = Phrase::new("friction model of the contact", "Reibungsmodell des Kontakts");
        let reason = Phrase::new(
            "a predicted force has friction up to the limit",
            "eine vorhergesagte Kraft hat Reibung bis zur Grenze",
        );
        unused.push(Caveat::not_used(what, reason));
    }
    unused
}

fn has_other_size(vehicle: &ScenarioVehicle, of_training: &VehicleParameters) -> bool {
    let is_other =
        |value: f64, of_training: f64| (value / of_training - 1.0).abs() > SIZE_TOLERANCE;
    is_other(vehicle.length_m, of_training.geometry.outer_length_m)
        || is_other(vehicle.width_m, of_training.geometry.outer_width_m)
}

/// What a simulation does not use of its question.
///
/// - `is_recorded`: whether the motion is a recorded one, which has its own duration.
pub(crate) fn by_simulation(request: &SimulateRequest, is_recorded: bool) -> Vec<Caveat> {
    let mut unused = if is_recorded { by_record(request) } else { Vec::new() };
    let has_striking =
        !matches!(request.source, MotionSource::Trajectory { .. } | MotionSource::Drive(_))
            && !is_recorded;
    if !has_striking && request.striking != VehicleChoice::Automatic {
        unused.push(Caveat::not_used(
            Phrase::new("striking vehicle", "stoßendes Fahrzeug"),
            Phrase::new(
                "only the struck vehicle is simulated here",
                "hier wird nur das gestoßene Fahrzeug simuliert",
            ),
        ));
    }
    if request.one_contact {
        unused.push(Caveat::not_used(
            Phrase::new("one contact only", "nur der erste Kontakt"),
            Phrase::new(
                "only the vehicles of a scenario are followed through further contacts",
                "nur die Fahrzeuge eines Szenarios werden durch weitere Kontakte verfolgt",
            ),
        ));
    }
    if let MotionSource::Drive(drive) = &request.source
        && drive.force.is_none()
        && (drive.contact.is_some() || drive.sampling.is_some())
    {
        unused.push(Caveat::not_used(
            Phrase::new("contact point and sampling", "Kontaktpunkt und Abtastung"),
            Phrase::new("no force is given", "keine Kraft ist vorgegeben"),
        ));
    }
    unused
}

/// A standard deviation of the friction that is stated beside draws that nobody makes.
pub(crate) fn friction_not_drawn(request: &SimulateRequest) -> Option<Caveat> {
    let sigma = request.friction_sigma.filter(|sigma| *sigma > 0.0)?;
    (request.vehicle_draws == Some(0)).then(|| {
        Caveat::not_used(
            Phrase::new(
                "standard deviation of the friction, {0}",
                "Standardabweichung des Reibbeiwerts, {0}",
            )
            .with(PhraseValue::given(Quantity::Ratio, sigma)),
            Phrase::new(
                "neither vehicles nor roads are drawn",
                "weder Fahrzeuge noch Fahrbahnen werden gezogen",
            ),
        )
    })
}

/// Vehicles that are to be drawn although neither the struck vehicle nor the road leaves anything open.
///
/// - `struck`: the struck vehicle.
pub(crate) fn vehicles_not_drawn(
    request: &SimulateRequest,
    struck: &VehicleParameters,
) -> Option<Caveat> {
    let n_draws = request.vehicle_draws.filter(|n_draws| *n_draws > 0)?;
    let is_road_open = request.friction_sigma.is_some_and(|sigma| sigma > 0.0);
    (struck.sheet.is_none() && !is_road_open).then(|| {
        Caveat::not_used(
            Phrase::new("number of drawn vehicles, {0}", "Zahl gezogener Fahrzeuge, {0}")
                .with(PhraseValue::Name(n_draws.to_string())),
            Phrase::new(
                "the struck vehicle has no data sheet with estimates, and no standard deviation of the friction \
                 is stated",
                "das gestoßene Fahrzeug hat kein Datenblatt mit Schätzwerten, und keine Standardabweichung des \
                 Reibbeiwerts ist angegeben",
            ),
        )
    })
}

/// A vehicle that was chosen for recorded pairs, which have their own.
pub(crate) fn vehicle_of_pair(role: Role) -> Caveat {
    Caveat::not_used(
        Phrase::of(PhraseValue::Term(role.label().to_owned())),
        Phrase::new(
            "each recorded pair says itself which vehicles it has",
            "jedes aufgezeichnete Paar nennt seine Fahrzeuge selbst",
        ),
    )
}

/// What the simulation of a recorded motion does not use of its question.
fn by_record(request: &SimulateRequest) -> Vec<Caveat> {
    let mut unused = Vec::new();
    if request.duration_s != DEFAULT_DURATION_S {
        unused.push(Caveat::not_used(
            Phrase::new("duration, {0}", "Dauer, {0}")
                .with(PhraseValue::given(Quantity::Time, request.duration_s)),
            Phrase::new(
                "a recorded motion has its own duration",
                "eine aufgezeichnete Bewegung hat ihre eigene Dauer",
            ),
        ));
    }
    if matches!(request.source, MotionSource::Case { .. }) {
        let by_case = Phrase::new(
            "the case says itself what happens to the wheels and how long it lasts",
            "der Fall sagt selbst, was mit den Rädern geschieht und wie lange er dauert",
        );
        let wheels = Phrase::new("what happens to the wheels", "was mit den Rädern geschieht");
        let to_rest = Phrase::new("simulation until rest", "Simulation bis zum Stillstand");
        for (is_asked, what) in [(request.ending.is_some(), wheels), (request.until_rest, to_rest)]
        {
            unused.extend(is_asked.then(|| Caveat::not_used(what, by_case.clone())));
        }
    }
    unused
}

/// What the simulation of a recorded pair does not use of its question.
pub(crate) fn by_recorded_pair(request: &SimulateRequest) -> Vec<Caveat> {
    let cars = Role::ALL.into_iter().zip([&request.vehicle, &request.striking]);
    let cars = cars.filter(|(_, choice)| **choice != VehicleChoice::Automatic);
    let cars = cars.map(|(role, _)| vehicle_of_pair(role));
    let one_contact = request.one_contact.then(|| {
        Caveat::not_used(
            Phrase::new("one contact only", "nur der erste Kontakt"),
            Phrase::new(
                "the whole contact is that of the contact law",
                "der ganze Kontakt folgt dem Kontaktgesetz",
            ),
        )
    });
    let of_pair = integrator_of_pair(request.integrator);
    by_record(request).into_iter().chain(cars).chain(one_contact).chain(of_pair).collect()
}

/// What a forecast does not use of its question, beside that of the simulation.
pub(crate) fn by_forecast(request: &PredictMotionRequest) -> Vec<Caveat> {
    let mut unused = Vec::from_iter(friction_not_drawn(&request.motion));
    let is_predicted = matches!(request.force, ForceSource::Predicted(_));
    if !is_predicted && !request.is_of_both() && request.draws != DEFAULT_DRAWS {
        unused.push(Caveat::not_used(
            Phrase::new("number of drawn forces, {0}", "Zahl gezogener Kräfte, {0}")
                .with(PhraseValue::Name(request.draws.to_string())),
            Phrase::new(
                "the force is given, so that none is drawn",
                "die Kraft ist vorgegeben, so dass keine gezogen wird",
            ),
        ));
    }
    if let MotionSource::Scenario { pulse, .. } = &request.motion.source {
        let plain =
            PulseSetup { contact_height_m: pulse.contact_height_m, ..PulseSetup::default() };
        if request.force != ForceSource::Given && *pulse != plain {
            unused.push(Caveat::not_used(
                Phrase::new("shape and duration of the pulse", "Form und Dauer des Kraftverlaufs"),
                Phrase::new("another force is taken", "eine andere Kraft ist zugrunde gelegt"),
            ));
        }
    }
    unused
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};
    use impactlab_core::vehicle::{ContactPoint, Controls, FrictionZone, PitDriver, VehicleState};

    fn struck() -> StruckVehicle {
        StruckVehicle {
            vehicle: Preset::Reference.parameters(),
            initial: VehicleState::driving_straight(20.0),
            contact: ContactPoint { x_body_m: -1.5, y_body_m: -0.9, height_m: 0.5 },
            controls: Controls::default(),
            friction_zones: Vec::new(),
        }
    }

    /// “drawn of the striking vehicle, driver of the PIT: …” stood in German reports.
    #[test]
    fn what_is_drawn_of_a_driver_is_told_in_german() {
        let pit = Some(PitDriver::default());
        let mut striking = struck();
        striking.controls.closed_loop = Some(ClosedLoop { pit, ..ClosedLoop::default() });
        let notes = drawn_drivers([&struck(), &striking]);
        let [note] = &notes[..] else { panic!("{notes:?}") };
        assert!(note.text.starts_with("drawn of the striking vehicle, driver of the PIT: 90 to"));
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let text = note.text_in(&german, &|_| "stoßendes Fahrzeug".to_owned()).unwrap();
        assert!(text.starts_with("Gezogen (stoßendes Fahrzeug): Fahrer, der das PIT"), "{text}");
    }

    #[test]
    fn a_forecast_says_that_it_does_not_know_the_zones() {
        let mut struck = struck();
        assert_eq!(zones_by_network(&struck), None);
        let border_m = vec![[0.0, 0.0], [9.0, 0.0], [9.0, 9.0]];
        let ice = FrictionZone { name: "ice".to_owned(), border_m, friction: 0.1 };
        struck.friction_zones.push(ice);
        let caveat = zones_by_network(&struck).unwrap();
        assert_eq!(caveat.kind, CaveatKind::NotUsed);
        assert_eq!(caveat.text, "friction zones: ice");
        // One that knows them draws their friction.
        let drawn = crate::caveats::assumed::zones(&struck.friction_zones);
        let text = "zones of the site (ice), all with 0.78 to 1.28 times the friction that it says";
        assert_eq!(drawn.iter().map(|caveat| &caveat.text).collect::<Vec<_>>(), [text]);
        // What lies under a verge that stands after it is told to hold nowhere.
        let verge = FrictionZone { friction: 0.5, ..struck.friction_zones[0].clone() };
        struck.friction_zones.push(verge);
        let drawn = crate::caveats::assumed::zones(&struck.friction_zones);
        assert!(drawn[1].text.contains("zone \"ice\" counts nowhere"), "{drawn:?}");
        assert!(drawn[1].is_warning());
    }
}
