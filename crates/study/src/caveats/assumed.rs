//! Values that a question leaves open and the program chose.

use impactlab_core::collision::{
    Impact, Scenario, ScenarioGeometry, TOUCH_TOLERANCE_M, default_restitution_in_words,
};
use impactlab_core::numerics::NORMAL_QUANTILE_95;
use impactlab_core::uncertainty::{Caveat, CaveatSubject};
use impactlab_core::vehicle::sheet::{Estimate, SheetQuantity};
use impactlab_core::vehicle::{ContactPoint, ROAD_FRICTION_SPREAD, RoadDraws, VehicleParameters};

use crate::SimulateRequest;

/// Each parameter that was estimated because the data sheet of a vehicle does not state it.
pub(crate) fn estimates(vehicle: &VehicleParameters) -> Vec<Caveat> {
    let sheet = vehicle.sheet.as_ref();
    let estimates = sheet.map_or_else(Vec::new, |sheet| sheet.estimates());
    estimates.iter().map(estimate).collect()
}

fn estimate(estimate: &Estimate) -> Caveat {
    let Estimate { quantity, unit, value, rule, source } = estimate;
    let (median, [low, high]) = (value.median, value.ninety());
    let [median, low, high] = [median, low, high].map(three_digits);
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let value = format!("{} {median}{unit}, 90 %: {low} to {high}", quantity.label());
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
            .map(three_digits);
    let value = format!("{} {median}, 90 %: {low} to {high}", SheetQuantity::Friction.label());
    let whose = match question.friction {
        Some(_) => "how well it is known was not said",
        None => "that of the vehicle's file, as the road was not said; another one: --friction",
    };
    let percent = 100.0 * ROAD_FRICTION_SPREAD;
    let reason = format!("{whose}; σ {percent} % of it, as of dry asphalt: --friction-sigma");
    Some(Caveat::assumed(CaveatSubject::RoadFriction, value, reason))
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
    let value = format!("{n} of {}, at their medians", vehicle.name);
    let reason = "its data sheet does not state them; impactlab vehicles lists the rules";
    (n > 0).then(|| Caveat::assumed(subject, value, reason))
}

/// What stands for the contact of vehicles whose outlines overlap.
pub(crate) fn first_touch(geometry: &ScenarioGeometry) -> Option<Caveat> {
    let (surface, overlap_m) = geometry.surface.zip(geometry.overlap_m)?;
    let reason = format!(
        "the outlines overlap by {overlap_m:.2} m; they first touched there at their velocities, \
         and the middle of the overlap is the contact point"
    );
    let value = format!("normal {surface}");
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
    let at_this_speed = format!(
        "the default at {closing_m_s:.1} m/s, the speed at which the contact points close in all \
         directions: {}",
        default_restitution_in_words()
    );
    let e = format!("e = {}", three_digits(surface.restitution));
    let mu = format!("μ_c = {}", surface.friction_limit);
    let by_runs = "the default, fitted to finite-element runs of slow pushes";
    let (values, reason) = match (has_restitution, has_friction) {
        (true, true) => return None,
        (false, true) => (e, at_this_speed),
        (true, false) => (mu, by_runs.to_owned()),
        (false, false) => (format!("{e}, {mu}"), format!("e: {at_this_speed}; μ_c: {by_runs}")),
    };
    Some(Caveat::assumed(CaveatSubject::Restitution, values, reason))
}

/// The contact point that stands for an unknown one.
pub(crate) fn contact_point(contact: ContactPoint, reason: &str) -> Caveat {
    let ContactPoint { x_body_m, y_body_m, height_m } = contact;
    let [x, y, z] = [x_body_m, y_body_m, height_m].map(three_digits);
    let value = format!("x {x} m, y {y} m from the CG (x forward, y left), {z} m high");
    Caveat::assumed(CaveatSubject::ContactPoint, value, reason)
}

/// A number with three digits.
pub(crate) fn three_digits(value: f64) -> String {
    let size = value.abs();
    let decimals = if size < 1e-9 { 0 } else { (2 - size.log10().floor() as i32).clamp(0, 6) };
    let rounded = format!("{value:.*}", decimals as usize);
    match decimals {
        0 => format!("{:.0}", value),
        _ => rounded.trim_end_matches('0').trim_end_matches('.').to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_have_three_digits() {
        for (value, expected) in [
            (2451.7, "2452"),
            (0.6049, "0.605"),
            (0.0110, "0.011"),
            (0.0, "0"),
            (-74.25, "-74.2"),
            (5.7, "5.7"),
            (12.34, "12.3"),
        ] {
            assert_eq!(three_digits(value), expected);
        }
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
