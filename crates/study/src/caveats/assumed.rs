//! Values that a question leaves open and the program chose.

use impactlab_core::collision::{
    Impact, Scenario, ScenarioGeometry, TOUCH_TOLERANCE_M, default_restitution_in_words,
};
use impactlab_core::numerics::NORMAL_QUANTILE_95;
use impactlab_core::ranges::ROAD_FRICTION;
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject, CaveatText};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::sheet::{Estimate, SheetQuantity};
use impactlab_core::vehicle::{
    BuiltInVehicle, ContactPoint, FrictionZone, LEAST_ROAD_FRICTION_SIGMA, ROAD_FRICTION_SPREAD,
    RoadDraws, VehicleParameters, ZONE_FRICTION_LOG_SIGMA, hidden_zones,
};

use crate::SimulateRequest;

/// Each parameter that was estimated because the data sheet of a vehicle does not state it.
pub(crate) fn estimates(vehicle: &VehicleParameters) -> Vec<Caveat> {
    let sheet = vehicle.sheet.as_ref();
    let estimates = sheet.map_or_else(Vec::new, |sheet| sheet.estimates());
    estimates.iter().map(estimate).collect()
}

fn estimate(estimate: &Estimate) -> Caveat {
    let Estimate { quantity, unit, value, rule, source } = estimate;
    let [low, high] = value.ninety();
    let number = |value: f64| match Quantity::from_si_symbol(unit) {
        Some(quantity) => PhraseValue::three_digits(quantity, value),
        None if unit.is_empty() => PhraseValue::three_digits(Quantity::Ratio, value),
        // A unit that no quantity has; the number has the decimal sign of the language.
        None => PhraseValue::phrase(
            Phrase::new(format!("{{0}} {unit}"), format!("{{0}} {}", unit.replace("deg", "°")))
                .with(PhraseValue::three_digits(Quantity::Ratio, value)),
        ),
    };
    let bare = |value: f64| match Quantity::from_si_symbol(unit) {
        Some(quantity) => PhraseValue::three_digits(quantity, value).bare(),
        None => PhraseValue::three_digits(Quantity::Ratio, value),
    };
    let value = with_ninety(*quantity, number(value.median), [bare(low), bare(high)]);
    Caveat::assumed(subject_of(*quantity), value, format!("{rule}; {source}"))
}

/// How uncertain the friction of the road is, where nobody said it and no data sheet does.
///
/// - `vehicle`: the struck vehicle, with the friction of the question if that says one.
pub(crate) fn road(question: &SimulateRequest, vehicle: &VehicleParameters) -> Option<Caveat> {
    let is_estimated =
        vehicle.sheet.as_ref().is_some_and(|sheet| sheet.known(SheetQuantity::Friction).is_none());
    if question.friction_sigma.is_some() || is_estimated {
        return None;
    }
    let RoadDraws { sigma, .. } = question.road(vehicle, 0)?;
    let friction = vehicle.tires.friction;
    let [median, low, high] =
        [friction, friction - NORMAL_QUANTILE_95 * sigma, friction + NORMAL_QUANTILE_95 * sigma]
            .map(|value| value.clamp(ROAD_FRICTION.low, ROAD_FRICTION.high))
            .map(|value| PhraseValue::three_digits(Quantity::Ratio, value));
    let value = with_ninety(SheetQuantity::Friction, median, [low, high]);
    let whose = match question.friction {
        Some(_) => Phrase::new(
            "how well it is known was not said",
            "seine Unsicherheit ist nicht angegeben",
        ),
        None => Phrase::new(
            "that of the vehicle's file, as the road was not said; another one: --friction",
            "der Wert aus der Fahrzeugdatei, da zur Fahrbahn nichts angegeben ist; anderer Wert: --friction",
        ),
    };
    let is_slippery = ROAD_FRICTION_SPREAD * friction < LEAST_ROAD_FRICTION_SIGMA;
    let reason = match is_slippery {
        true => Phrase::new(
            "{0}; σ {1}, the least of a road that nobody has measured: --friction-sigma",
            "{0}; σ {1}, der kleinste Wert für eine nicht gemessene Fahrbahn: --friction-sigma",
        )
        .with(PhraseValue::phrase(whose))
        .with(PhraseValue::given(Quantity::Ratio, LEAST_ROAD_FRICTION_SIGMA)),
        false => Phrase::new(
            "{0}; σ {1} of it, as of dry asphalt: --friction-sigma",
            "{0}; σ {1} davon, wie bei trockenem Asphalt: --friction-sigma",
        )
        .with(PhraseValue::phrase(whose))
        .with(PhraseValue::given(Quantity::Ratio, ROAD_FRICTION_SPREAD).in_unit("%")),
    };
    Some(Caveat::assumed(CaveatSubject::RoadFriction, value, reason))
}

/// How uncertain the friction of zones of the ground is, where that of the road is drawn, and those that hold nowhere.
pub(crate) fn zones(zones: &[FrictionZone]) -> Vec<Caveat> {
    let names: Vec<&str> = zones.iter().map(|zone| zone.name.as_str()).collect();
    let reach = (NORMAL_QUANTILE_95 * ZONE_FRICTION_LOG_SIGMA).exp();
    let value = Phrase::new(
        "zones of the site ({0}), all with {1} to {2} times the friction that it says",
        "Bereiche des Geländes ({0}), alle mit dem {1}- bis {2}-Fachen des angegebenen Reibbeiwerts",
    )
    .with(PhraseValue::Name(names.join(", ")))
    .with(PhraseValue::fixed(Quantity::Ratio, 1.0 / reach, 2))
    .with(PhraseValue::fixed(Quantity::Ratio, reach, 2));
    let reason = Phrase::new(
        "90 %: nothing says how well they are known; all are better or worse together, in each draw by \
         another factor, which is that of both vehicles",
        "90 %: über ihre Unsicherheit ist nichts angegeben; alle sind gemeinsam besser oder schlechter, in \
         jeder Ziehung um einen anderen Faktor, der für beide Fahrzeuge gilt",
    );
    let drawn = Caveat::assumed(CaveatSubject::RoadFriction, value, reason);
    let hidden = hidden_zones(zones).into_iter();
    let hidden = hidden.map(|text| Caveat::new(CaveatKind::DoubtfulData, text));
    (!names.is_empty()).then_some(drawn).into_iter().chain(hidden).collect()
}

/// A quantity of a data sheet with its interval of 90 %.
fn with_ninety(quantity: SheetQuantity, median: PhraseValue, ends: [PhraseValue; 2]) -> Phrase {
    let [low, high] = ends;
    Phrase::new("{0} {1}, 90 %: {2} to {3}", "{0} {1}, 90 %: {2} bis {3}")
        .with(PhraseValue::Term(quantity.label().to_owned()))
        .with(median)
        .with(low)
        .with(high)
}

/// Where a person finds what a data sheet leaves open: the friction is that of the road.
fn subject_of(quantity: SheetQuantity) -> CaveatSubject {
    match quantity {
        SheetQuantity::Friction => CaveatSubject::RoadFriction,
        _ => CaveatSubject::VehicleParameter,
    }
}

/// That the parameters of a vehicle are estimates of which only the medians are used.
pub(crate) fn medians(subject: CaveatSubject, vehicle: &VehicleParameters) -> Option<Caveat> {
    let n = vehicle.sheet.as_ref()?.estimated().count();
    let value = Phrase::new("{0} of {1}, at their medians", "{0} von {1}, mit ihren Medianen")
        .with(PhraseValue::Name(n.to_string()))
        .with(BuiltInVehicle::name_in_phrase(&vehicle.name));
    let reason = Phrase::new(
        "its data sheet does not state them; impactlab vehicles lists the rules",
        "im Datenblatt nicht angegeben; die Schätzregeln nennt impactlab vehicles",
    );
    (n > 0).then(|| Caveat::assumed(subject, value, reason))
}

/// What stands for the contact of vehicles whose outlines overlap.
pub(crate) fn first_touch(geometry: &ScenarioGeometry) -> Option<Caveat> {
    let (surface, overlap_m) = geometry.surface.zip(geometry.overlap_m)?;
    let reason = Phrase::new(
        "the outlines overlap by {0}; they first touched there at their velocities, \
         and the middle of the overlap is the contact point",
        "die Umrisse überdecken sich um {0}; dort berührten sie sich bei ihren Geschwindigkeiten zuerst, \
         und die Mitte der Überdeckung ist der Kontaktpunkt",
    )
    .with(PhraseValue::fixed(Quantity::Length, overlap_m, 2));
    let value =
        Phrase::new("normal {0}", "Normale {0}").with(PhraseValue::Term(surface.to_string()));
    let is_deep = overlap_m > TOUCH_TOLERANCE_M;
    is_deep.then(|| Caveat::assumed(CaveatSubject::FirstTouch, value, reason))
}

/// Restitution and friction limit of a scenario where they are the default.
pub(crate) fn contact_default(scenario: &Scenario, impact: &Impact) -> Option<Caveat> {
    let contact = &scenario.contact;
    let surface = &impact.surface;
    let has_restitution = contact.restitution.is_some();
    let has_friction = contact.friction_limit.or(contact.friction_of_critical).is_some();
    let closing_m_s = impact.closing_speed_m_s();
    let at_this_speed = Phrase::new(
        "the default at {0}, the speed at which the contact points close in all directions: {1}",
        "Vorgabe bei {0}, der Annäherungsgeschwindigkeit der Kontaktpunkte in allen Richtungen: {1}",
    )
    .with(PhraseValue::fixed(Quantity::Speed, closing_m_s, 1))
    .with(PhraseValue::phrase(default_restitution_in_words()));
    let e = Phrase::new("e = {0}", "e = {0}")
        .with(PhraseValue::three_digits(Quantity::Ratio, surface.restitution));
    let mu = Phrase::new("μ_c = {0}", "μ_c = {0}")
        .with(PhraseValue::given(Quantity::Ratio, surface.friction_limit));
    let by_runs = Phrase::new(
        "the default, fitted to finite-element runs of slow pushes",
        "Vorgabe, angepasst an Finite-Elemente-Rechnungen langsamer Schübe",
    );
    let (values, reason) = match (has_restitution, has_friction) {
        (true, true) => return None,
        (false, true) => (e, at_this_speed),
        (true, false) => (mu, by_runs),
        (false, false) => {
            let reason = Phrase::new("e: {0}; μ_c: {1}", "e: {0}; μ_c: {1}")
                .with(PhraseValue::phrase(at_this_speed))
                .with(PhraseValue::phrase(by_runs));
            (Phrase::joined([e, mu], ", "), reason)
        }
    };
    Some(Caveat::assumed(CaveatSubject::Restitution, values, reason))
}

/// The contact point that stands for an unknown one.
pub(crate) fn contact_point(contact: ContactPoint, reason: impl Into<CaveatText>) -> Caveat {
    let ContactPoint { x_body_m, y_body_m, height_m } = contact;
    let [x, y, z] = [x_body_m, y_body_m, height_m]
        .map(|value_m| PhraseValue::three_digits(Quantity::Length, value_m));
    let value = Phrase::new(
        "x {0}, y {1} from the CG (x forward, y left), {2} high",
        "x {0}, y {1} vom Schwerpunkt (x nach vorn, y nach links), {2} hoch",
    )
    .with(x)
    .with(y)
    .with(z);
    Caveat::assumed(CaveatSubject::ContactPoint, value, reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Language, NumberFormat, UnitSystem};

    /// “Wankgradient 5.7 deg/g, 90 %: 3,9 bis 8,32” stood in German reports.
    #[test]
    fn a_unit_that_no_quantity_has_leaves_the_number_its_decimal_sign() {
        let sheet = impactlab_core::vehicle::built_in_vehicle("toyota-camry-2018").unwrap();
        let english = NumberFormat::english(UnitSystem::Si);
        let german = NumberFormat { language: Language::De, ..english };
        let told = |format: &NumberFormat| {
            let texts = estimates(&sheet);
            let texts = texts.iter().filter_map(|it| it.text_in(format, &str::to_owned));
            texts.collect::<Vec<_>>().join("; ")
        };
        assert!(told(&german).contains("5,7 °/g"), "{}", told(&german));
        assert!(told(&german).contains("17 1/rad") && !told(&german).contains("deg"));
        assert!(told(&english).contains("5.7 deg/g"), "{}", told(&english));
    }

    #[test]
    fn the_friction_of_a_data_sheet_is_that_of_the_road() {
        let sheet = impactlab_core::vehicle::built_in_vehicle("toyota-camry-2018").unwrap();
        let caveats = estimates(&sheet);
        let friction = caveats.iter().find(|caveat| caveat.text.contains("friction")).unwrap();
        assert_eq!(friction.subject, Some(CaveatSubject::RoadFriction), "{friction}");
        assert!(friction.to_string().starts_with("assumed road friction: "), "{friction}");
        let parameters = |caveat: &&Caveat| caveat.subject == Some(CaveatSubject::VehicleParameter);
        assert_eq!(caveats.iter().filter(parameters).count() + 1, caveats.len());
    }
}
