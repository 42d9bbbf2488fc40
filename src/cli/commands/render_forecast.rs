//! `impactlab render forecast`: what the response network says of a recorded case.

use clap::Args;

use crate::cli::CliError;
use crate::cli::commands::predict_motion::check_window_end;
use crate::cli::commands::render::{OutputArgs, VehicleArgs};
use crate::cli::commands::render_figure::{Noted, noted};
use crate::cli::console::Console;
use crate::cli::options::{SourceArgs, Values, number, one_value_of, window_s};
use impactlab_core::data::Channel;
use impactlab_core::ranges::INSTANT;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::{
    FORECAST_CHANNELS, MotionForecastFigure, forecast_channel_figure, forecast_scene_figure,
};
use impactlab_networks::shipped::ModelSource;
use impactlab_study::analysis::{DensityTask, MotionBands};
use impactlab_study::{ForceSource, PredictMotionRequest};

/// What is drawn of which forecast.
#[derive(Debug, Args)]
pub(in crate::cli) struct ForecastArgs {
    #[command(flatten)]
    source: SourceArgs,
    /// This quantity over time instead of the scene
    #[arg(long, value_parser = one_value_of(CHANNELS))]
    channel: Option<Channel>,
    /// The moment of outlines and density, s; the end if not given
    #[arg(long, value_parser = number(INSTANT))]
    time: Option<f64>,
    /// Density over a window of time, s, instead of the moment
    #[arg(long, value_parser = window_s, value_name = "FROM,TO")]
    window: Option<[f64; 2]>,
    /// The response network: `shipped`, `shipped-pretrained` or a file
    #[arg(long, default_value_t, value_name = "MODEL")]
    response_model: ModelSource,
    #[command(flatten)]
    vehicle: VehicleArgs,
    #[command(flatten)]
    pub(super) output: OutputArgs,
}

/// The quantities with bands.
const CHANNELS: Values<Channel> = &[
    (Channel::X, ""),
    (Channel::Y, ""),
    (Channel::Yaw, ""),
    (Channel::Vx, ""),
    (Channel::Vy, ""),
    (Channel::YawRate, ""),
];

/// The scene or a quantity over time, with what was recorded and what the 4DOF model says.
pub(super) fn figure(
    args: &ForecastArgs,
    units: UnitSystem,
    console: &mut Console<'_>,
) -> Result<Noted, CliError> {
    let motion = args.vehicle.request(&args.source, console)?;
    let force = ForceSource::usual(&motion.source);
    let request = PredictMotionRequest {
        response_model: args.response_model.clone().into(),
        motion: motion.clone(),
        ..PredictMotionRequest::new(motion.source, force)
    };
    let answer = console.answer(&request)?;
    let (forecast, analysis) = (&answer.forecast, &answer.analysis);
    let duration_s = forecast.end_s();
    check_window_end(args.window, duration_s)?;
    let at_s = args.time.unwrap_or(duration_s);
    if !(0.0..=duration_s).contains(&at_s) {
        return Err(CliError::TimeOutside {
            option: "--time",
            time_s: at_s,
            start_s: 0.0,
            end_s: duration_s,
        });
    }
    let density = DensityTask::new(&forecast.distribution, args.window.unwrap_or([at_s; 2]));
    let (density, bands) = (density.on_cpu(), MotionBands::for_figure(&forecast.distribution));
    let caveats = &answer.report.caveats;
    let input = MotionForecastFigure {
        density: Some(&density),
        draws: true,
        ..MotionForecastFigure::new(&answer, &bands, caveats, at_s, units).with_motions(analysis)
    };
    let channel = FORECAST_CHANNELS.into_iter().find(|of| Some(of.channel) == args.channel);
    let figure = match channel {
        Some(channel) => forecast_channel_figure(&input, channel),
        None => forecast_scene_figure(&input),
    };
    Ok((figure, noted(caveats, units)))
}
