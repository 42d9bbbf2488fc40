//! Which command was asked for, and how the program ends.

use std::ffi::OsString;
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};

use crate::cli::CliError;
use crate::cli::commands::{
    app, ask, atlas, case, check, compare, condition, evaluate, export, fine_tune, hand, impact,
    import, licences, predict, ranges, reconstruct, render, replay, report, schema, simulate,
    stiffness, sweep, train, vehicles,
};
use crate::cli::console::{Console, Escaped, Targets, Verdict, within_line};
use impactlab_core::error_chain;
use impactlab_study::Library;

/// What happens when one vehicle hits another, and in the second after
#[derive(Debug, Parser)]
#[command(name = "impactlab", version = crate::VERSION, max_term_width = 100, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Option<CliCommand>,
    /// Print JSON (SI units, the unit in every key) instead of text
    #[arg(long, global = true)]
    json: bool,
    /// Print the question as JSON instead of answering it: `impactlab ask` answers it later
    #[arg(long, global = true)]
    print_request: bool,
}

const EXAMPLES: &str = "\
Without a command the window opens.

Examples:
  impactlab
  impactlab check datasets
  impactlab impact pit-right-rear
  impactlab simulate --dataset datasets/trajectories-fea
  impactlab predict force --scenario pit-right-rear

Exit codes: 0 = ok, 1 = the work failed or found problems, 2 = wrong usage";

#[derive(Debug, Subcommand)]
enum CliCommand {
    App(app::AppArgs),
    Check(check::CheckArgs),
    Ask(ask::AskArgs),
    Case(case::CaseArgs),
    Impact(impact::ImpactArgs),
    Hand(hand::HandArgs),
    Simulate(Box<simulate::SimulateArgs>),
    Train(train::TrainArgs),
    FineTune(fine_tune::FineTuneArgs),
    Condition(condition::ConditionArgs),
    Predict(Box<predict::PredictArgs>),
    Evaluate(evaluate::EvaluateArgs),
    Compare(compare::CompareArgs),
    Reconstruct(reconstruct::ReconstructArgs),
    Render(render::RenderArgs),
    Export(export::ExportArgs),
    Import(Box<import::ImportArgs>),
    Replay(Box<replay::ReplayArgs>),
    Report(report::ReportArgs),
    Vehicles(vehicles::VehiclesArgs),
    Stiffness(stiffness::StiffnessArgs),
    Sweep(sweep::SweepArgs),
    Atlas(atlas::AtlasArgs),
    #[command(alias = "licenses")]
    Licences(licences::LicencesArgs),
    Ranges(ranges::RangesArgs),
    Schema(schema::SchemaArgs),
}

/// Runs the command in the program's arguments.
///
/// Returns exit code 0 (ok), 1 (the work failed or found problems) or 2 (wrong usage).
pub fn run() -> ExitCode {
    impactlab_core::program::set_version(crate::VERSION);
    let cli = match Cli::try_parse().and_then(Cli::with_request) {
        Ok(cli) => cli,
        Err(help_or_error) => {
            // Nobody is left to tell if the output is closed.
            let _ = print_usage(&help_or_error);
            return ExitCode::from(u8::try_from(help_or_error.exit_code()).unwrap_or(2));
        }
    };
    let mut out = Escaped(BufWriter::new(io::stdout().lock()));
    let mut console = Console {
        json: cli.json,
        print_request: cli.print_request,
        library: Library::default(),
        targets: Targets::default(),
        out: &mut out,
    };
    let verdict = dispatch(cli.command, &mut console);
    let flushed = out.flush().map_err(CliError::Output);
    match verdict.and_then(|verdict| flushed.map(|()| verdict)) {
        Ok(Verdict::Clean) => ExitCode::SUCCESS,
        Ok(Verdict::Problems) => ExitCode::FAILURE,
        // The reader, such as `head`, has seen enough.
        Err(CliError::Output(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => {
            let _ = writeln!(io::stderr(), "error: {}", within_line(&error_chain(&error)));
            ExitCode::FAILURE
        }
    }
}

impl Cli {
    /// Refuses to print a question of a command that has none of its own.
    fn with_request(self) -> Result<Self, clap::Error> {
        let has_request = match &self.command {
            None
            | Some(
                CliCommand::App(_)
                | CliCommand::Render(_)
                | CliCommand::Export(_)
                | CliCommand::Import(_)
                | CliCommand::Vehicles(_)
                | CliCommand::Stiffness(_)
                | CliCommand::Sweep(_)
                | CliCommand::Atlas(_)
                | CliCommand::Licences(_)
                | CliCommand::Ranges(_)
                | CliCommand::Schema(_),
            ) => false,
            Some(CliCommand::Case(args)) => args.asks(),
            Some(
                CliCommand::Check(_)
                | CliCommand::Ask(_)
                | CliCommand::Impact(_)
                | CliCommand::Hand(_)
                | CliCommand::Simulate(_)
                | CliCommand::Train(_)
                | CliCommand::FineTune(_)
                | CliCommand::Condition(_)
                | CliCommand::Predict(_)
                | CliCommand::Evaluate(_)
                | CliCommand::Compare(_)
                | CliCommand::Reconstruct(_)
                | CliCommand::Replay(_)
                | CliCommand::Report(_),
            ) => true,
        };
        if self.print_request && !has_request {
            let message =
                "--print-request: this command asks no question that `impactlab ask` could answer";
            return Err(Cli::command().error(ErrorKind::ArgumentConflict, message));
        }
        Ok(self)
    }
}

/// Prints help or what is wrong with the arguments. Arguments are quoted in it, so that it has no
/// colours if one of them could write its own.
fn print_usage(help_or_error: &clap::Error) -> io::Result<()> {
    let is_plain = |argument: OsString| {
        let text = argument.to_string_lossy();
        within_line(&text) == text
    };
    if std::env::args_os().all(is_plain) {
        return help_or_error.print();
    }
    write!(Escaped(io::stderr()), "{}", help_or_error.render())
}

fn dispatch(command: Option<CliCommand>, console: &mut Console<'_>) -> Result<Verdict, CliError> {
    match command {
        None => app::run(app::AppArgs::default()),
        Some(CliCommand::App(args)) => app::run(args),
        Some(CliCommand::Check(args)) => check::run(&args, console),
        Some(CliCommand::Ask(args)) => ask::run(&args, console),
        Some(CliCommand::Case(args)) => case::run(&args, console),
        Some(CliCommand::Impact(args)) => impact::run(&args, console),
        Some(CliCommand::Hand(args)) => hand::run(&args, console),
        Some(CliCommand::Simulate(args)) => simulate::run(&args, console),
        Some(CliCommand::Train(args)) => train::run(&args, console),
        Some(CliCommand::FineTune(args)) => fine_tune::run(&args, console),
        Some(CliCommand::Condition(args)) => condition::run(&args, console),
        Some(CliCommand::Compare(args)) => compare::run(&args, console),
        Some(CliCommand::Evaluate(args)) => evaluate::run(&args, console),
        Some(CliCommand::Predict(args)) => predict::run(&args, console),
        Some(CliCommand::Reconstruct(args)) => reconstruct::run(&args, console),
        Some(CliCommand::Render(args)) => render::run(&args, console),
        Some(CliCommand::Export(args)) => export::run(&args, console),
        Some(CliCommand::Import(args)) => import::run(&args, console),
        Some(CliCommand::Replay(args)) => replay::run(&args, console),
        Some(CliCommand::Report(args)) => report::run(&args, console),
        Some(CliCommand::Vehicles(args)) => vehicles::run(&args, console),
        Some(CliCommand::Stiffness(args)) => stiffness::run(&args, console),
        Some(CliCommand::Sweep(args)) => sweep::run(&args, console),
        Some(CliCommand::Atlas(args)) => atlas::run(&args, console),
        Some(CliCommand::Licences(_)) => licences::run(console),
        Some(CliCommand::Ranges(args)) => ranges::run(&args, console),
        Some(CliCommand::Schema(args)) => schema::run(&args, console),
    }
}
