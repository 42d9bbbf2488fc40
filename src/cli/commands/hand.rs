//! `impactlab hand`: what a method by hand gives.

use clap::Args;

use crate::cli::CliError;
use crate::cli::console::{Console, Verdict};
use crate::cli::options::{UNITS, Values, count, number, one_value_of};
use crate::cli::text::print_answer;
use impactlab_core::ranges::{HAND_COORDINATE, HAND_DRAWS};
use impactlab_core::units::{TypedError, UnitSystem};
use impactlab_reconstruct::evidence::Stated;
use impactlab_reconstruct::hand::{HandField, HandInputs, HandMethod};
use impactlab_study::{DEFAULT_HAND_DRAWS, HandRequest};

/// Compute a speed or an energy by hand, with its interval and what moves it
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct HandArgs {
    /// The method
    #[arg(value_name = "METHOD", value_parser = one_value_of(METHODS))]
    method: HandMethod,
    /// Inputs with their standard deviations, such as `friction=0.7±0.05`; without ± the program's
    #[arg(value_name = "INPUT=VALUE±SIGMA", value_parser = named)]
    inputs: Vec<(String, String)>,
    /// A point of a yaw mark, in the order in which it was left; once for each point
    #[arg(long = "point", value_name = "X,Y", allow_hyphen_values = true, value_parser = point_m)]
    points: Vec<[f64; 2]>,
    /// Draws of the inputs
    #[arg(long, value_name = "N", default_value_t = DEFAULT_HAND_DRAWS, value_parser = count::<usize>(HAND_DRAWS))]
    draws: usize,
    /// Seed of the draws
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Units of the text (JSON is always SI)
    #[arg(long, value_parser = one_value_of(UNITS), default_value = "si")]
    units: UnitSystem,
}

const EXAMPLES: &str = "\
Examples:
  impactlab hand skid distance=30m±0.5m friction=0.7±0.05 end-speed=20km/h±2km/h
  impactlab hand yaw-mark chord=20m middle-ordinate=0.6m±1cm friction=0.7±0.05
  impactlab hand momentum mass-1=1500 mass-2=1200 speed-after-1=12 speed-after-2=9 \\
      course-2=80deg course-after-1=25deg course-after-2=40deg

Numbers are in SI units unless they name another one; ± may be written +-. A method without inputs says which
it takes. `±0` says that a number is exact.

JSON: impactlab schema hand --answer says every key with its unit";

const METHODS: Values<HandMethod> = &[
    (HandMethod::MomentumInLine, "two vehicles that meet in one line"),
    (HandMethod::Momentum, "two vehicles that meet at an angle: both speeds"),
    (HandMethod::CrushEnergy, "A, B and C1 to C6: energy, EES and Δv"),
    (HandMethod::SpinOut, "a spin to rest with a rolling factor"),
    (HandMethod::YawMark, "critical speed from a curved mark"),
    (HandMethod::Skid, "a skid over surfaces, and phases together"),
    (HandMethod::Airborne, "a flight off an edge or a ramp"),
    (HandMethod::TimeDistance, "where braking stops, and what it avoids"),
];

/// A name and what stands behind its `=`.
fn named(text: &str) -> Result<(String, String), &'static str> {
    let (name, value) =
        text.split_once('=').ok_or("expected INPUT=VALUE, such as friction=0.7±0.05")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// A point, m unless it says otherwise.
fn point_m(text: &str) -> Result<[f64; 2], String> {
    let (x, y) = text.split_once(',').ok_or("expected X,Y in m, such as 10,0.6")?;
    let coordinate = |text: &str| number(HAND_COORDINATE)(text.trim());
    let [x, y] = [x, y].map(|text| coordinate(text).map_err(|error| error.to_string()));
    Ok([x?, y?])
}

/// Computes what the method gives and prints it.
pub(in crate::cli) fn run(args: &HandArgs, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    let request = HandRequest {
        inputs: inputs(args)?,
        points_m: args.points.clone(),
        input_draws: args.draws,
        seed: args.seed,
        ..HandRequest::new(args.method)
    };
    let Some(answer) = console.ask(&request)? else { return Ok(Verdict::Clean) };
    console.print(&answer.report, |out| print_answer(out, &answer.report, args.units))?;
    Ok(Verdict::Clean)
}

/// The inputs by their keys.
fn inputs(args: &HandArgs) -> Result<HandInputs, CliError> {
    let mut inputs = HandInputs::new();
    for (name, text) in &args.inputs {
        let word = name.replace('_', "-");
        let field = args
            .method
            .fields()
            .iter()
            .find(|field| field.word() == word || field.si_key().replace('_', "-") == word);
        let Some(field) = field else {
            let known: Vec<String> = args.method.fields().iter().map(HandField::word).collect();
            let (name, known) = (name.clone(), known.join(", "));
            return Err(CliError::HandInput { name, known });
        };
        let value = stated(field, text).map_err(|source| {
            let (name, text) = (name.clone(), text.clone());
            CliError::HandValue { name, text, source }
        })?;
        if inputs.insert(field.si_key(), value).is_some() {
            return Err(CliError::HandTwice { name: name.clone() });
        }
    }
    Ok(inputs)
}

/// A value with or without its standard deviation.
fn stated(field: &HandField, text: &str) -> Result<Stated, TypedError> {
    let quantity = field.range.quantity;
    let parse = |text: &str| quantity.parse(text, &quantity.si_unit());
    let parts = text.split_once('±').or_else(|| text.split_once("+-"));
    Ok(match parts {
        Some((value, sigma)) => Stated { value: Some(parse(value)?), sigma: Some(parse(sigma)?) },
        None => Stated { value: Some(parse(text)?), sigma: None },
    })
}

#[cfg(test)]
mod tests {
    use clap::builder::TypedValueParser;

    use super::*;

    #[test]
    fn every_method_has_its_word() {
        let typed = one_value_of(METHODS);
        let typed = typed.possible_values().into_iter().flatten();
        let words: Vec<String> = typed.map(|value| value.get_name().to_owned()).collect();
        let methods: Vec<String> = HandMethod::ALL.iter().map(|method| method.word()).collect();
        assert_eq!(words, methods);
    }
}
