//! The line of a form that says how long the work will take.

use egui::Ui;

use crate::app::cost::{CostPlace, Costs};
use impactlab_study::Cost;

/// Seconds up to which a time is said in seconds, and minutes up to which it is said in minutes.
const MOST_UNITS: f64 = 90.0;

/// Draws how long the work of a form will take on this machine, and makes it be measured.
///
/// - `label`: what the work is called, such as “Training”.
pub fn cost_ui(ui: &mut Ui, costs: &mut Costs, place: CostPlace, label: &str) {
    costs.see(place);
    ui.horizontal_wrapped(|ui| {
        if costs.is_measuring(place) {
            ui.spinner();
            ui.weak(format!("{label}: measuring how long it takes…"));
            return;
        }
        match costs.get(place) {
            None => drop(ui.weak(format!("{label}: how long it takes is not measured yet"))),
            Some(Ok(None)) => drop(ui.weak(format!("{label}: takes a moment"))),
            Some(Err(problem)) => drop(ui.weak(format!("{label}: cannot be measured: {problem}"))),
            Some(Ok(Some(cost))) => {
                let text = format!("{label}: {} on this machine", cost_text(cost));
                ui.label(text).on_hover_text(parts_text(cost));
            }
        }
        let measure = ui.small_button("Measure");
        if measure
            .on_hover_text("A few seconds of the same work, with nothing left behind")
            .clicked()
        {
            costs.measure_again(place);
        }
    });
}

/// The time in all, such as “about 4 min”.
fn cost_text(cost: &Cost) -> String {
    let seconds = cost.seconds();
    let time = match seconds {
        s if s < MOST_UNITS => format!("{} s", (s.max(1.0) / 5.0).ceil() * 5.0),
        s if s < MOST_UNITS * 60.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    };
    if cost.is_most { format!("at most about {time}") } else { format!("about {time}") }
}

fn parts_text(cost: &Cost) -> String {
    let part = |part: &impactlab_study::CostPart| match part.n {
        1.0 => format!("{}: {:.2} s", part.what, part.seconds_each),
        n => format!("{}: {n} of {:.3} s", part.what, part.seconds_each),
    };
    let mut lines: Vec<String> = cost.parts.iter().map(part).collect();
    if cost.is_most {
        lines.push("It ends sooner where a fit settles or the loss stops falling.".to_owned());
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_study::CostPart;

    #[test]
    fn a_time_is_said_as_coarsely_as_it_is_known() {
        let cost = |n, is_most| {
            let part = CostPart { what: "epochs".to_owned(), n, seconds_each: 2.0 };
            Cost { parts: vec![part], is_most }
        };
        assert_eq!(cost_text(&cost(6.0, false)), "about 15 s");
        assert_eq!(cost_text(&cost(100.0, true)), "at most about 3 min");
        assert_eq!(cost_text(&cost(9000.0, false)), "about 5.0 h");
        assert!(parts_text(&cost(6.0, false)).starts_with("epochs: 6 of 2.000 s"));
    }
}
