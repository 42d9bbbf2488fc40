//! Figures as plain data: axes with units, elements to draw, and the meaning of their colours. The
//! panel on screen, the PNG and the CSV of a figure are all made from the same [`Figure`].

mod analysis;
mod atlas;
mod calibration;
mod contours;
mod controls;
mod export;
mod force;
mod forecast;
mod impact;
mod look;
mod model;
mod model_comparison;
mod motion;
mod motion_forecast;
mod reconstruction;
mod reconstruction_scene;
mod replay;
mod scene;
mod statistics;
mod training;

pub use analysis::{
    analysis_force_figure, analysis_motion_figure, analysis_readout, analysis_scene_figure,
};
pub use atlas::{AtlasFigure, atlas_figure, sensitivity_figure, write_slice_csv};
pub use calibration::{CoveragePoint, ParityPoint, coverage_figure, parity_figure, pit_figure};
#[cfg(test)]
pub(crate) use controls::BRAKES_ALONE;
pub(crate) use controls::STRIKING;
pub use controls::{WheelInput, control_figure, control_figures, figure_readout};
pub use export::write_figure_csv;
use force::milliseconds;
pub use force::{ForceFigure, force_figure};
pub use forecast::{ForceComponent, ForecastFigure, RecordedCurve, forecast_figure};
pub use impact::impact_figure;
pub use look::{Dashes, N_VARIANT_COLORS};
pub use model::{
    Axis, Band, CellMap, Figure, FigureElement, HeatMap, LineStyle, Path, Role, Series,
};
pub use model_comparison::{
    cluster_figure, compared_case_figure, horizon_figure, model_name, ranking_figure,
};
pub use motion::{MOTION_CHANNELS, motion_figure, motion_readout, recording_line, recording_path};
pub use motion_forecast::{
    FORECAST_CHANNELS, ForecastChannel, MotionForecastFigure, forecast_channel_figure,
    forecast_readout, forecast_scene_figure, forecast_surroundings,
};
pub use reconstruction::{budget_figure, marginal_figure, pair_figure, prior_values};
pub use reconstruction_scene::{
    FollowedPath, ReconstructionScene, STRIKING_AT_REST, reconstruction_scene_figure,
    struck_at_rest,
};
pub use replay::{ReplayCurve, replay_curve_figure, replay_path_figure};
pub use scene::{SceneFigure, SceneVehicle, scene_figure, vehicle_outline};
pub use statistics::{CurveStatistics, curve_statistics};
pub use training::{LossCurve, balance_figure, loss_figure};
