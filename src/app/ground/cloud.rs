//! Makes a ground of a point cloud.

use std::path::{Path, PathBuf};

use impactlab_core::data::Existing;
use impactlab_core::data::write::{FileDigest, OutputFolder, RunRecord};
use impactlab_core::error_chain;
use impactlab_core::jobs::ProgressCallback;
use impactlab_core::site::{
    CloudFormat, CloudOptions, LengthUnit, SiteError, import_cloud, stated_cloud_unit,
};

/// How a point cloud becomes a ground.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudForm {
    /// The point cloud.
    pub path: PathBuf,
    /// Side of a pixel of its picture, m.
    pub pixel_m: f64,
    /// Unit of its coordinates; `None` for a format in metres.
    pub unit: Option<LengthUnit>,
    /// The folder for the ground, as it is typed.
    pub folder: String,
}

/// A ground that was made.
#[derive(Debug, Clone, PartialEq)]
pub struct MadeGround {
    /// Its site file.
    pub site: PathBuf,
    /// What whoever uses it has to know.
    pub notes: Vec<String>,
}

impl CloudForm {
    /// The usual choices, with the unit that the cloud states and a folder beside it.
    pub fn new(path: PathBuf) -> Self {
        let is_las = CloudFormat::from_path(&path) != Some(CloudFormat::E57);
        let folder = format!("{} ground", path.with_extension("").display());
        let pixel_m = CloudOptions::default().pixel_m;
        let unit = is_las.then(|| stated_cloud_unit(&path).unwrap_or_default());
        Self { path, pixel_m, unit, folder }
    }
}

/// Reads the cloud and writes the ground; `None` if that was cancelled, when nothing is left behind.
///
/// # Errors
/// A message for the user.
pub(super) fn make_ground(
    form: &CloudForm,
    report: &mut ProgressCallback<'_>,
) -> Result<Option<MadeGround>, String> {
    let CloudForm { path, pixel_m, unit, folder } = form;
    let format = CloudFormat::from_path(path);
    let format = format.ok_or_else(|| format!("{}: is no point cloud", path.display()))?;
    let inputs = vec![path.clone()];
    let output = OutputFolder::begin(Path::new(folder.trim()), Existing::Refuse, &[], inputs)
        .map_err(|error| error_chain(&error))?;
    let options = CloudOptions { pixel_m: *pixel_m, unit: *unit, ..CloudOptions::default() };
    let made = match import_cloud(path, format, &options, output.staging(), report) {
        Ok(made) => made,
        Err(SiteError::Cancelled) => return Ok(None),
        Err(error) => return Err(error_chain(&error)),
    };
    let digest = FileDigest::from_file(path.display().to_string(), path);
    let inputs = vec![digest.map_err(|error| error_chain(&error))?];
    let site = output.path_of("site.toml");
    output
        .finish(RunRecord { inputs, ..RunRecord::default() })
        .map_err(|error| error_chain(&error))?;
    Ok(Some(MadeGround { site, notes: made.notes }))
}
