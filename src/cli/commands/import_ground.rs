//! `impactlab import` of a ground: lines and points of a survey, and point clouds.

use std::path::Path;

use clap::Args;

use crate::cli::CliError;
use crate::cli::commands::import::Imported;
use crate::cli::console::under_bar;
use crate::cli::options::{Words, number, one_of};
use impactlab_core::data::{Existing, MAX_SETTINGS_BYTES, write_bytes};
use impactlab_core::jobs::Progress;
use impactlab_core::ranges::PIXEL_SIZE;
use impactlab_core::site::{
    CloudFormat, CloudOptions, LengthUnit, Site, SiteError, SurveyFormat, SurveyOptions,
    import_cloud,
};
use impactlab_core::units::UnitSystem;
use impactlab_study::Event;

/// How a ground is read.
#[derive(Debug, Args)]
pub(super) struct GroundArgs {
    /// Of a point cloud, the side of a pixel on the ground; 5 cm if not given
    #[arg(long, value_name = "LENGTH", value_parser = number(PIXEL_SIZE))]
    resolution: Option<f64>,
    /// Of a point cloud, the part that is drawn: smallest easting and northing, largest easting and northing, m
    #[arg(long, value_name = "E,N,E,N", value_parser = numbers::<4>, allow_hyphen_values = true)]
    within: Option<[f64; 4]>,
    /// Of a point cloud, the points between two heights alone, m
    #[arg(long, value_name = "LOW,HIGH", value_parser = numbers::<2>, allow_hyphen_values = true)]
    heights: Option<[f64; 2]>,
    /// Unit of coordinates that do not say theirs: of LAS, of a table of points, of GeoJSON in a grid
    #[arg(long, value_parser = one_of(UNITS))]
    unit: Option<LengthUnit>,
    /// Of a table of points, a code whose points are joined to a line; several times for several codes
    #[arg(long, value_name = "CODE")]
    line: Vec<String>,
}

const UNITS: Words<LengthUnit> = &[
    (LengthUnit::Metre.word(), "metres", LengthUnit::Metre),
    (LengthUnit::Centimetre.word(), "centimetres", LengthUnit::Centimetre),
    (LengthUnit::Millimetre.word(), "millimetres", LengthUnit::Millimetre),
    (LengthUnit::Foot.word(), "feet of 0.3048 m", LengthUnit::Foot),
    (LengthUnit::SurveyFoot.word(), "feet of 1200/3937 m", LengthUnit::SurveyFoot),
    (LengthUnit::Inch.word(), "inches", LengthUnit::Inch),
];

/// As many numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers =
        text.split(',').map(|part| part.trim().parse().ok().filter(|n: &f64| n.is_finite()));
    let found = numbers.collect::<Option<Vec<f64>>>().and_then(|found| found.try_into().ok());
    found.ok_or_else(|| format!("expected {N} numbers with commas between them"))
}

/// What kind of ground a file is.
pub(super) enum Ground {
    Survey(SurveyFormat),
    Cloud(CloudFormat),
}

impl Ground {
    /// `None` for a file that is none.
    pub fn from_path(path: &Path) -> Option<Self> {
        let cloud = CloudFormat::from_path(path).map(Self::Cloud);
        cloud.or_else(|| SurveyFormat::from_path(path).map(Self::Survey))
    }
}

impl GroundArgs {
    /// Refuses an option that the file does not take.
    ///
    /// - `ground`: what the file is, if it is a ground.
    pub fn check(&self, path: &Path, ground: Option<&Ground>) -> Result<(), CliError> {
        let is_cloud = matches!(ground, Some(Ground::Cloud(_)));
        let says_unit = matches!(
            ground,
            None | Some(
                Ground::Cloud(CloudFormat::E57)
                    | Ground::Survey(SurveyFormat::Kml | SurveyFormat::Kmz)
            )
        );
        let is_table = matches!(ground, Some(Ground::Survey(SurveyFormat::Table)));
        let unused = [
            ("--resolution", self.resolution.is_some() && !is_cloud),
            ("--within", self.within.is_some() && !is_cloud),
            ("--heights", self.heights.is_some() && !is_cloud),
            ("--unit", self.unit.is_some() && says_unit),
            ("--line", !self.line.is_empty() && !is_table),
        ];
        match unused.into_iter().find(|(_, is_unused)| *is_unused) {
            Some((option, _)) => Err(CliError::OptionOfGround { path: path.to_owned(), option }),
            None => Ok(()),
        }
    }
}

/// Reads the ground and writes its site file, with the pictures of a point cloud.
pub(super) fn import_ground(
    file: &Path,
    ground: &Ground,
    args: &GroundArgs,
    staging: &Path,
) -> Result<Imported, CliError> {
    match ground {
        Ground::Survey(format) => import_survey(file, *format, args, staging),
        Ground::Cloud(format) => import_points(file, *format, args, staging),
    }
}

fn import_survey(
    file: &Path,
    format: SurveyFormat,
    args: &GroundArgs,
    staging: &Path,
) -> Result<Imported, CliError> {
    let options = SurveyOptions { unit: args.unit, line_codes: args.line.clone() };
    let site = Site::from_survey(file, format, &options)?;
    let text = site.to_toml(staging).map_err(|error| SiteError::Survey {
        path: file.to_owned(),
        place: String::new(),
        message: error.to_string(),
    })?;
    if text.len() as u64 > MAX_SETTINGS_BYTES {
        let (path, bytes, limit) = (file.to_owned(), text.len(), MAX_SETTINGS_BYTES);
        return Err(SiteError::LongSite { path, bytes, limit }.into());
    }
    write_bytes(&staging.join("site.toml"), Existing::Refuse, text.as_bytes())?;
    let notes = site.contents(None, UnitSystem::Si).into_iter().chain(site.notes).collect();
    Ok(Imported { kind: "ground", files: vec!["site.toml".into()], notes })
}

fn import_points(
    file: &Path,
    format: CloudFormat,
    args: &GroundArgs,
    staging: &Path,
) -> Result<Imported, CliError> {
    let usual = CloudOptions::default();
    let options = CloudOptions {
        pixel_m: args.resolution.unwrap_or(usual.pixel_m),
        unit: args.unit,
        within_m: args.within.map(|[e0, n0, e1, n1]| [[e0, n0], [e1, n1]]),
        heights_m: args.heights,
    };
    let report = under_bar(|observer| {
        let mut progress = |progress: Progress| observer(Event::Progress(progress));
        import_cloud(file, format, &options, staging, &mut progress)
    })?;
    let [width, height] = report.size_px;
    let picture = format!("{width} x {height} pixels of {} m", options.pixel_m);
    let notes = report.summary.contents().into_iter().chain([picture]).chain(report.notes);
    let files = report.files.into_iter().map(Into::into).collect();
    Ok(Imported { kind: "ground", files, notes: notes.collect() })
}
