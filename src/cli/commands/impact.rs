//! `impactlab impact`: the impulse solution of a scenario.

use std::path::PathBuf;

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::UnitsArg;
use crate::cli::text::print_answer;
use impactlab_study::{ImpactRequest, ScenarioChoice};

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

The impulse acts ON the struck vehicle. World axes: X along the road, Y to the left; yaw to the
left is positive. PDOF: clockwise from straight ahead, where the force comes from.

JSON: name, restitution, restitution_form, friction_limit, friction_of_critical,
  critical_impulse_ratio, friction_model, regime, impulse_n_s [x, y], impulse_magnitude_n_s, impulse_normal_n_s,
  impulse_tangential_n_s, closing_velocity_m_s [normal, tangential], contact_point_m [x, y],
  normal_angle_rad, struck_surface {target|bullet: side}, overlap_m, dissipated_energy_j; target and bullet each with velocity_m_s [x, y],
  speed_m_s, yaw_rate_rad_s, delta_v_m_s [x, y], delta_v_magnitude_m_s, delta_yaw_rate_rad_s,
  pdof_deg, pdof_clock; caveats
  [{kind, severity, subject, text, quantity, value, range, reason}], version; of
  former versions: notes, assumptions, badges";

/// Solves the scenario and prints the solution.
pub(in crate::cli) fn run(
    args: &ImpactArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let scenario = ScenarioChoice::File(args.scenario.clone());
    let request = ImpactRequest { scenario, paper: args.paper };
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    console.print(&answer.report, |out| print_answer(out, &answer.report, args.units.into()))?;
    Ok(Verdict::Clean)
}
