//! The numbers that describe the end of a forecast motion: position, heading, speed, and
//! probabilities of large changes of heading.

use egui::{Grid, Ui};

use crate::app::command::Command;
use crate::app::response::MotionAnswer;
use crate::app::widgets::{SpreadRow, caveats_ui, sensitivity_ui, spread_table_ui, value_row};
use impactlab_core::units::{Quantity, UnitSystem, percent};

/// Draws the time at which the vehicle comes to rest (or at which the forecast ends), the
/// assumptions, and the state of the vehicle at that time.
pub fn outcome_ui(
    ui: &mut Ui,
    answer: &MotionAnswer,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let report = &answer.answer.report;
    let outcome = &report.outcome;
    let when = match (&report.rest, outcome.is_at_rest) {
        (Some(rest), _) => format!(
            "At rest in {} of {} draws, within {:.0} s",
            percent(rest.share_at_rest),
            rest.n_draws,
            rest.limit_s
        ),
        (None, true) => format!("At rest after {:.2} s", outcome.time_s),
        (None, false) => format!("After {:.2} s, still moving", outcome.time_s),
    };
    ui.strong(when).on_hover_text(match report.rest {
        Some(_) => {
            "At rest: after the force, speed and yaw rate have fallen below 0.05 m/s and \
             0.01 rad/s. Draws that still move count with where they are then"
        }
        None => {
            "At rest: after the force, speed and yaw rate stay below 0.05 m/s and 0.01 rad/s to \
             the end of the forecast. Mean over the force curves, nothing about the vehicle \
             uncertain"
        }
    });
    let unit = |quantity: Quantity| quantity.display_unit(units);
    let row = |label, quantity, spread, hint| SpreadRow {
        label,
        unit: unit(quantity),
        spread,
        ninety_five: None,
        hint,
    };
    let mut rows = vec![
        row("X", Quantity::Length, outcome.x_m, "Of the CG, along the road from the impact"),
        row("Y", Quantity::Length, outcome.y_m, "Of the CG, to the left"),
        row(
            "Heading",
            Quantity::Angle,
            outcome.heading_change_rad,
            "Change since the impact, to the left; goes on beyond a turn",
        ),
    ];
    if let Some(rest) = &report.rest {
        rows.extend([
            row("Heading at rest", Quantity::Angle, rest.yaw_rad, "To the left of the X axis"),
            row("Time to rest", Quantity::Time, rest.time_s, "From the first contact"),
            row("Distance to rest", Quantity::Length, rest.distance_m, "Along the path of the CG"),
        ]);
    }
    caveats_ui(ui, &report.caveats, commands);
    spread_table_ui(ui, &report.scenario, &rows);
    Grid::new("motion outcome").num_columns(2).show(ui, |ui| {
        value_row(ui, "Speed", &Quantity::Speed.shown(outcome.speed_m_s, units));
        value_row(ui, "Yaw rate", &Quantity::AngularVelocity.shown(outcome.yaw_rate_rad_s, units));
        if let Some(rest) = &report.rest {
            value_row(ui, "50 % region of the CG", &format!("{:.1} m²", rest.region_50_m2));
        }
        value_row(ui, "90 % region of the CG", &format!("{:.1} m²", outcome.region_90_m2));
        value_row(ui, "P(quarter turn or more)", &percent(outcome.p_quarter_turn));
        value_row(ui, "P(half turn or more)", &percent(outcome.p_half_turn));
        let driven = match answer.is_predicted() {
            true => format!("{} drawn", report.n_forces),
            false => "given".to_owned(),
        };
        value_row(ui, "Force", &driven);
        if report.n_vehicles > 0 {
            value_row(ui, "Vehicles", &format!("{} drawn from the data sheet", report.n_vehicles));
        }
    });
    sensitivity_ui(ui, "forecast", &report.sensitivity);
}
