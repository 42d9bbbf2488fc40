//! `impactlab stiffness`: how stiff a face is, from a test against a rigid barrier.

use clap::Args;
use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{Values, number, one_value_of};
use impactlab_core::collision::contact::{BarrierTest, FaceStiffness};
use impactlab_core::error_chain;
use impactlab_core::ranges::{BODY_WIDTH, CRUSH_DEPTH, SPEED, VEHICLE_MASS};
use impactlab_core::vehicle::CrushFace;

/// Compute A and B of a face from a test against a rigid barrier
///
/// Prints the section of a vehicle file that says how stiff the face is, for the contact of two
/// vehicles. What a file leaves out follows from class and mass by rule.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct StiffnessArgs {
    /// Mass of the car in the test
    #[arg(long, value_name = "KG", value_parser = number(VEHICLE_MASS))]
    mass: f64,
    /// Width of the crushed face
    #[arg(long, value_name = "M", value_parser = number(BODY_WIDTH))]
    width: f64,
    /// Speed of the impact
    #[arg(long, value_name = "SPEED", value_parser = number(SPEED))]
    speed: f64,
    /// Crush C1 to C6 at six equidistant places across the face
    #[arg(long, value_name = "C1,…,C6", value_parser = crush)]
    crush: [f64; 6],
    /// Speed up to which nothing is crushed
    #[arg(long, value_name = "SPEED", default_value = "5mph", value_parser = number(SPEED))]
    no_damage_speed: f64,
    /// The face
    #[arg(long, value_parser = one_value_of(FACES), default_value = "front")]
    face: CrushFace,
}

const EXAMPLES: &str = "\
Examples:
  impactlab stiffness --mass 1719 --width 1.837 --speed 57.09km/h \\
      --crush 380mm,466mm,511mm,518mm,489mm,370mm

A = m b0 b1/L and B = m b1²/L with b1 = (V − b0)/C and C = (C1/2 + C2 + … + C5 + C6/2)/5 (Campbell
1974). Side tests are against a deformable barrier as a rule: its share of the energy is not known here.

JSON: {face, mean_crush_m, onset_n_per_m, stiffness_n_per_m2}";

const FACES: Values<CrushFace> =
    &[(CrushFace::Front, ""), (CrushFace::Side, ""), (CrushFace::Rear, "")];

/// Six depths, each with or without a unit.
fn crush(text: &str) -> Result<[f64; 6], String> {
    let depth = number(CRUSH_DEPTH);
    let depths: Result<Vec<f64>, _> = text.split(',').map(|text| depth(text.trim())).collect();
    let depths = depths.map_err(|error| error_chain(&error))?;
    let n = depths.len();
    let six = <[f64; 6]>::try_from(depths).ok();
    six.ok_or_else(|| format!("{n} depths, expected 6"))
}

/// A and B of a face.
#[derive(Debug, Serialize)]
struct PrintedStiffness {
    face: CrushFace,
    mean_crush_m: f64,
    onset_n_per_m: f64,
    stiffness_n_per_m2: f64,
}

/// Prints A and B.
pub(in crate::cli) fn run(
    args: &StiffnessArgs,
    console: &mut Console<'_>,
) -> Result<Verdict, CliError> {
    let test = BarrierTest {
        mass_kg: args.mass,
        width_m: args.width,
        speed_m_s: args.speed,
        no_damage_speed_m_s: args.no_damage_speed,
        crush_m: args.crush,
    };
    let FaceStiffness { onset_n_per_m, stiffness_n_per_m2 } = test.stiffness()?;
    let printed = PrintedStiffness {
        face: args.face,
        mean_crush_m: test.mean_crush_m(),
        onset_n_per_m,
        stiffness_n_per_m2,
    };
    console.print(&printed, |out| {
        writeln!(out, "[crush.{}]", args.face.word())?;
        writeln!(out, "onset_n_per_m = {onset_n_per_m:.0}")?;
        writeln!(out, "stiffness_n_per_m2 = {stiffness_n_per_m2:.0}")
    })?;
    Ok(Verdict::Clean)
}
