//! Figure of the momentum solution of a scenario, from above.

use crate::figure::{Axis, Figure, FigureElement, LineStyle, Role, vehicle_outline};
use impactlab_core::collision::{ImpactSolution, Scenario, ScenarioError};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Quantity, UnitSystem};

/// Length of the longest velocity arrow and of the impulse arrow, m.
const ARROW_LENGTH_M: f64 = 3.0;

/// Both vehicles at first contact with the contact surface, the impulse on the struck vehicle at
/// the contact point, and the velocity change of each vehicle at its CG. Both velocity changes have
/// the same scale.
///
/// # Errors
/// [`ScenarioError`] if the vehicles make no contact.
pub fn impact_figure(
    scenario: &Scenario,
    solution: &ImpactSolution,
    caveats: &Caveats,
    units: UnitSystem,
) -> Result<Figure, ScenarioError> {
    let geometry = scenario.geometry()?;
    let x = Axis::shown("X, along the road", Quantity::Length, units);
    let y = Axis::shown("Y, to the left", Quantity::Length, units);
    let shown = |point: [f64; 2]| point.map(|value| x.unit.from_si(value));
    let arrow = |name: &str, role, [px, py]: [f64; 2], [dx, dy]: [f64; 2]| {
        FigureElement::arrow(name, role, shown([px, py]), shown([px + dx, py + dy]))
    };
    let contact = geometry.contact_point_world_m;
    let [cx, cy] = contact;
    let (sin, cos) = geometry.normal_angle_world_rad.sin_cos();
    let surface = [[cx - sin, cy + cos], [cx + sin, cy - cos]].map(shown).to_vec();
    let vehicles = [
        ("struck", Role::Simulation, scenario.struck.footprint(), geometry.struck, solution.struck),
        (
            "striking",
            Role::Striking,
            scenario.striking.footprint(),
            geometry.striking,
            solution.striking,
        ),
    ];
    let [struck_dv, striking_dv] = vehicles.map(|(.., after)| after.delta_v_world_m_s);
    let longest = [struck_dv, striking_dv].map(|[x, y]| x.hypot(y)).into_iter().fold(0.0, f64::max);
    let scaled = |[dx, dy]: [f64; 2], full: f64| {
        let scale = if full > 0.0 { ARROW_LENGTH_M / full } else { 0.0 };
        [dx * scale, dy * scale]
    };
    let mut elements = vec![FigureElement::dashed("contact surface", Role::Muted, surface)];
    for (name, role, footprint, pose, after) in vehicles {
        let vehicle = format!("{name} vehicle");
        let style = LineStyle::Solid;
        elements.extend(vehicle_outline(&vehicle, role, style, &footprint, &pose, x.unit));
        // An object that does not move has no Δv.
        if role == Role::Simulation || scenario.striking.fixed.is_none() {
            let delta_v = scaled(after.delta_v_world_m_s, longest);
            elements.push(arrow(&format!("Δv {name}"), role, [pose.x_m, pose.y_m], delta_v));
        }
    }
    let [px, py] = solution.impulse_world_n_s;
    let impulse = scaled([px, py], px.hypot(py));
    elements.push(arrow("impulse on the struck vehicle", Role::Resultant, contact, impulse));
    let title = format!("{}: impulse and Δv at first contact", scenario.name);
    Ok(Figure::new(title, [x, y], elements).plan().with_caveats(&caveats.in_units(units)))
}
