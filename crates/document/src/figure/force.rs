//! Figure of the contact force on the struck vehicle over time.

use crate::figure::{Axis, Figure, FigureElement, Role};
use impactlab_core::data::{ForceAxes, ForceHistory};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::{Quantity, UnitSystem};

/// Data that the force figure shows.
#[derive(Debug, Clone, Copy)]
pub struct ForceFigure<'a> {
    /// Name of the case.
    pub name: &'a str,
    /// Force on the struck vehicle, filtered if a channel class was chosen.
    pub force: &'a ForceHistory,
    /// Force before filtering, drawn in the background.
    pub raw: Option<&'a ForceHistory>,
    /// Times at which the contact starts and ends, s.
    pub contact_s: Option<(f64, f64)>,
    /// Classic pulses for comparison, by name; their resultants are drawn.
    pub pulses: &'a [(String, ForceHistory)],
    /// System of units of the axes.
    pub units: UnitSystem,
    /// What restricts the force.
    pub caveats: &'a Caveats,
}

/// Time shown after the end of contact, as a share of the contact duration.
const AFTER_CONTACT: f64 = 0.3;

/// F_x, F_y and |F| over time in ms, with markers where contact starts and ends.
pub fn force_figure(input: &ForceFigure<'_>) -> Figure {
    let x = Axis::new("Time", milliseconds());
    let y = Axis::shown("Force", Quantity::Force, input.units).with_acts_on("the struck vehicle");
    let axes = match input.force.axes {
        ForceAxes::World => "world axes",
        ForceAxes::Body => "heading axes",
    };
    // In a recording of several seconds, a contact of a tenth of a second would be a mere spike.
    let end_s =
        input.contact_s.map_or(f64::INFINITY, |(start, end)| end + AFTER_CONTACT * (end - start));
    let components = |history: &ForceHistory| {
        let points = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            let samples = history.time_s.iter().enumerate().take_while(|(_, t)| **t <= end_s);
            samples.map(|(i, &t)| [x.unit.from_si(t), y.unit.from_si(value(i))]).collect()
        };
        [
            points(&|i| history.fx_n[i]),
            points(&|i| history.fy_n[i]),
            points(&|i| history.fx_n[i].hypot(history.fy_n[i])),
        ]
    };
    let mut elements = Vec::new();
    for points in input.raw.map(components).into_iter().flatten() {
        elements.push(FigureElement::line("unfiltered", Role::Muted, points));
    }
    let [fx, fy, resultant] = components(input.force);
    elements.push(FigureElement::dashed("|F|", Role::Resultant, resultant));
    elements.push(FigureElement::line("F_x", Role::ComponentX, fx));
    elements.push(FigureElement::line("F_y", Role::ComponentY, fy));
    for (name, pulse) in input.pulses {
        let [_, _, resultant] = components(pulse);
        elements.push(FigureElement::dashed(name, Role::Pulse, resultant));
    }
    if let Some((start, end)) = input.contact_s {
        for (name, at) in [("contact starts", start), ("contact ends", end)] {
            let (name, x) = (name.to_owned(), x.unit.from_si(at));
            elements.push(FigureElement::VerticalLine { name, role: Role::Muted, x });
        }
    }
    let title = format!("{}: contact force on the struck vehicle, {axes}", input.name);
    Figure::new(title, [x, y], elements).with_caveats(&input.caveats.in_units(input.units))
}

/// The unit millisecond.
pub(super) fn milliseconds() -> impactlab_core::units::Unit {
    let units = Quantity::Time.units();
    *units.iter().find(|unit| unit.symbol == "ms").unwrap_or(&units[0])
}
