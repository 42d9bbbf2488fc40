//! `impactlab impact`: the impulse solution of a scenario.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict, print_caveats, print_facts, shown, shown_vector};
use crate::cli::options::UnitsArg;
use impactlab_core::collision::FrictionModel;
use impactlab_core::units::{Quantity, UnitSystem, percent, significant};
use impactlab_study::{ImpactAnswer, ImpactReport, ImpactRequest, ScenarioChoice};

/// Solve an impact: impulse, velocities after it, delta-v, energy, direction of force
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct ImpactArgs {
    /// The scenario: a file, or `pit-right-rear`
    #[arg(value_name = "NAME|FILE")]
    scenario: PathBuf,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_enum, default_value_t)]
    units: UnitsArg,
    /// Friction as in the paper: always sliding
    #[arg(long)]
    paper: bool,
}

const EXAMPLES: &str = "\
Example:
  impactlab impact pit-right-rear --units us

The impulse acts ON the target. World axes: X along the road, Y to the left; yaw to the left is
positive. PDOF: clockwise from straight ahead, where the force comes from.

JSON: name, restitution, restitution_form, friction_limit, friction_of_critical,
  critical_impulse_ratio, friction_model, regime, impulse_n_s [x, y], impulse_magnitude_n_s, impulse_normal_n_s,
  impulse_tangential_n_s, closing_velocity_m_s [normal, tangential], contact_point_m [x, y],
  normal_angle_rad, struck_surface {target|bullet: side}, overlap_m, dissipated_energy_j; target and bullet each with velocity_m_s [x, y],
  speed_m_s, yaw_rate_rad_s, delta_v_m_s [x, y], delta_v_magnitude_m_s, delta_yaw_rate_rad_s,
  pdof_deg, pdof_clock; assumptions [{quantity, value, reason}],
  badges [{kind, text, quantity, value, range}]";

/// Solves the scenario and prints the solution.
pub(in crate::cli) fn run(
    args: &ImpactArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let scenario = ScenarioChoice::File(args.scenario.clone());
    let request = ImpactRequest { scenario, paper: args.paper };
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    console.print(&answer.report, |out| print_text(out, &answer, args.units.into()))?;
    Ok(Verdict::Clean)
}

/// The friction limit that was used, beside the critical impulse ratio.
fn friction(report: &ImpactReport) -> String {
    let limit = match report.friction_of_critical {
        Some(_) => significant(report.friction_limit),
        None => report.friction_limit.to_string(),
    };
    let of_critical = match report.critical_impulse_ratio {
        Some(critical) if critical > 0.0 => {
            let share = percent(report.friction_limit / critical);
            format!(" ({share} of the critical impulse ratio {})", significant(critical))
        }
        _ => String::new(),
    };
    let model = match report.friction_model {
        FrictionModel::Limit => "",
        FrictionModel::Paper => ", always sliding (paper)",
    };
    format!("{limit}{of_critical}{model}")
}

/// Overlap or gap that the text leaves out, m.
const SHOWN_OVERLAP_M: f64 = 5e-4;

/// Direction of the normal, the side that it belongs to, and the overlap of the outlines.
fn normal(report: &ImpactReport, units: UnitSystem) -> String {
    let angle = shown(Quantity::Angle, report.normal_angle_rad, units);
    let side = report.struck_surface.map_or(String::new(), |side| format!(", {side}"));
    let overlap = match report.overlap_m {
        Some(depth_m) if depth_m.abs() < SHOWN_OVERLAP_M => "; the outlines touch".to_owned(),
        Some(depth_m) if depth_m < 0.0 => {
            format!("; gap {}", shown(Quantity::Length, -depth_m, units))
        }
        Some(depth_m) => format!("; overlap {}", shown(Quantity::Length, depth_m, units)),
        None => "; contact as given".to_owned(),
    };
    format!("{angle} (world axes){side}{overlap}")
}

fn print_text(out: &mut dyn Write, answer: &ImpactAnswer, units: UnitSystem) -> io::Result<()> {
    const XY: [&str; 2] = ["x", "y"];
    let ImpactAnswer { scenario, solution, report } = answer;
    let number = |quantity, value| shown(quantity, value, units);
    let vector = |quantity, value, names| shown_vector(quantity, value, names, units);
    let closing = solution.closing_velocity_m_s;
    writeln!(out, "{}\n", scenario.name)?;
    let facts = [
        ("restitution", format!("{} {}", report.restitution, report.restitution_form.label())),
        ("friction limit", friction(report)),
        ("normal", normal(report, units)),
        ("regime", solution.regime.label().to_owned()),
        ("closing velocity", vector(Quantity::Speed, closing, ["normal", "tangential"])),
        ("impulse", vector(Quantity::Impulse, solution.impulse_world_n_s, XY)),
        ("P_n", number(Quantity::Impulse, solution.impulse_normal_n_s)),
        ("P_τ", number(Quantity::Impulse, solution.impulse_tangential_n_s)),
        ("energy loss", number(Quantity::Energy, solution.dissipated_energy_j)),
    ];
    print_facts(out, &facts)?;
    for (name, body) in [("target", &solution.struck), ("bullet", &solution.striking)] {
        let pdof = body.pdof.map_or("none".to_owned(), |pdof| {
            format!("{:.1} deg, {} o'clock", pdof.angle_deg(), pdof.clock())
        });
        writeln!(out, "\n{name}")?;
        let facts = [
            ("  Δv", vector(Quantity::Speed, body.delta_v_world_m_s, XY)),
            ("  velocity after", vector(Quantity::Speed, body.velocity_world_m_s, XY)),
            ("  yaw rate after", number(Quantity::AngularVelocity, body.yaw_rate_rad_s)),
            ("  yaw rate change", number(Quantity::AngularVelocity, body.delta_yaw_rate_rad_s)),
            ("  PDOF", pdof),
        ];
        print_facts(out, &facts)?;
    }
    print_caveats(out, &report.caveats)
}
