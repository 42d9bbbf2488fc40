//! `impactlab impact`: the impulse solution of a scenario.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::output::{print_facts, print_json, shown, shown_vector};
use crate::cli::quantity::UnitsArg;
use crate::cli::run::{Console, Verdict};
use crate::collision::{
    BodyAfter, FrictionModel, ImpactSolution, PrincipalDirectionOfForce, Regime, Scenario,
    ScenarioGeometry,
};
use crate::units::{Quantity, UnitSystem};

/// Solve an impact: impulse, velocities after it, delta-v, energy, direction of force
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct ImpactArgs {
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

JSON: name, friction_model, regime, impulse_n_s [x, y], impulse_magnitude_n_s, impulse_normal_n_s,
  impulse_tangential_n_s, closing_velocity_m_s [normal, tangential], contact_point_m [x, y],
  normal_angle_rad, overlap_m, dissipated_energy_j; target and bullet each with velocity_m_s [x, y],
  speed_m_s, yaw_rate_rad_s, delta_v_m_s [x, y], delta_v_magnitude_m_s, delta_yaw_rate_rad_s,
  pdof_deg, pdof_clock";

/// The answer for machines.
#[derive(Debug, Serialize)]
struct Answer<'a> {
    name: &'a str,
    friction_model: FrictionModel,
    regime: Regime,
    impulse_n_s: [f64; 2],
    impulse_magnitude_n_s: f64,
    impulse_normal_n_s: f64,
    impulse_tangential_n_s: f64,
    closing_velocity_m_s: [f64; 2],
    contact_point_m: [f64; 2],
    normal_angle_rad: f64,
    overlap_m: Option<f64>,
    dissipated_energy_j: f64,
    target: Body,
    bullet: Body,
}

#[derive(Debug, Serialize)]
struct Body {
    velocity_m_s: [f64; 2],
    speed_m_s: f64,
    yaw_rate_rad_s: f64,
    delta_v_m_s: [f64; 2],
    delta_v_magnitude_m_s: f64,
    delta_yaw_rate_rad_s: f64,
    pdof_deg: Option<f64>,
    pdof_clock: Option<u8>,
}

impl From<&BodyAfter> for Body {
    fn from(after: &BodyAfter) -> Self {
        let size = |[x, y]: [f64; 2]| x.hypot(y);
        Self {
            velocity_m_s: after.velocity_m_s,
            speed_m_s: size(after.velocity_m_s),
            yaw_rate_rad_s: after.yaw_rate_rad_s,
            delta_v_m_s: after.delta_v_m_s,
            delta_v_magnitude_m_s: size(after.delta_v_m_s),
            delta_yaw_rate_rad_s: after.delta_yaw_rate_rad_s,
            pdof_deg: after.pdof.map(PrincipalDirectionOfForce::angle_deg),
            pdof_clock: after.pdof.map(PrincipalDirectionOfForce::clock),
        }
    }
}

/// Solves the scenario and prints the solution.
pub(super) fn run(args: &ImpactArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let scenario = load(&args.scenario, args.paper)?;
    let unsolved = |source| CliError::Scenario { path: args.scenario.clone(), source };
    let geometry = scenario.geometry().map_err(unsolved)?;
    let solution = scenario.solve().map_err(unsolved)?;
    if console.json {
        print_json(console.out, &answer(&scenario, &geometry, &solution))?;
    } else {
        print_text(console.out, &scenario, &solution, args.units.into())?;
    }
    Ok(Verdict::Clean)
}

/// The scenario of a file, with the paper's friction if asked for.
pub(super) fn load(path: &std::path::Path, paper: bool) -> Result<Scenario, CliError> {
    let mut scenario = Scenario::preset_or_file(path)?;
    if paper {
        scenario.contact.friction_model = FrictionModel::Paper;
    }
    Ok(scenario)
}

fn answer<'a>(
    scenario: &'a Scenario,
    geometry: &ScenarioGeometry,
    solution: &ImpactSolution,
) -> Answer<'a> {
    let [x, y] = solution.impulse_n_s;
    Answer {
        name: &scenario.name,
        friction_model: scenario.contact.friction_model,
        regime: solution.regime,
        impulse_n_s: solution.impulse_n_s,
        impulse_magnitude_n_s: x.hypot(y),
        impulse_normal_n_s: solution.impulse_normal_n_s,
        impulse_tangential_n_s: solution.impulse_tangential_n_s,
        closing_velocity_m_s: solution.closing_velocity_m_s,
        contact_point_m: geometry.contact_point_m,
        normal_angle_rad: geometry.normal_angle_rad,
        overlap_m: geometry.overlap_m,
        dissipated_energy_j: solution.dissipated_energy_j,
        target: (&solution.target).into(),
        bullet: (&solution.bullet).into(),
    }
}

fn print_text(
    out: &mut dyn Write,
    scenario: &Scenario,
    solution: &ImpactSolution,
    units: UnitSystem,
) -> io::Result<()> {
    const XY: [&str; 2] = ["x", "y"];
    let contact = &scenario.contact;
    let model = match contact.friction_model {
        FrictionModel::Limit => "",
        FrictionModel::Paper => ", always sliding (paper)",
    };
    let number = |quantity, value| shown(quantity, value, units);
    let vector = |quantity, value, names| shown_vector(quantity, value, names, units);
    let closing = solution.closing_velocity_m_s;
    writeln!(out, "{}\n", scenario.name)?;
    let facts = [
        (
            "contact",
            format!(
                "restitution {}, friction limit {}{model}",
                contact.restitution, contact.friction_limit
            ),
        ),
        ("regime", solution.regime.label().to_owned()),
        ("closing velocity", vector(Quantity::Speed, closing, ["normal", "tangential"])),
        ("impulse", vector(Quantity::Impulse, solution.impulse_n_s, XY)),
        ("P_n", number(Quantity::Impulse, solution.impulse_normal_n_s)),
        ("P_τ", number(Quantity::Impulse, solution.impulse_tangential_n_s)),
        ("energy loss", number(Quantity::Energy, solution.dissipated_energy_j)),
    ];
    print_facts(out, &facts)?;
    for (name, body) in [("target", &solution.target), ("bullet", &solution.bullet)] {
        let pdof = body.pdof.map_or("none".to_owned(), |pdof| {
            format!("{:.1} deg, {} o'clock", pdof.angle_deg(), pdof.clock())
        });
        writeln!(out, "\n{name}")?;
        let facts = [
            ("  Δv", vector(Quantity::Speed, body.delta_v_m_s, XY)),
            ("  velocity after", vector(Quantity::Speed, body.velocity_m_s, XY)),
            ("  yaw rate after", number(Quantity::AngularVelocity, body.yaw_rate_rad_s)),
            ("  yaw rate change", number(Quantity::AngularVelocity, body.delta_yaw_rate_rad_s)),
            ("  PDOF", pdof),
        ];
        print_facts(out, &facts)?;
    }
    Ok(())
}
