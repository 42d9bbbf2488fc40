//! What a path holds that a person opens, checks or names, found out from its content.
//!
//! Command line, window and case ask here and nowhere else. The ending of a name counts only where the
//! content does not decide: for a file that is not there, is empty or is damaged.

use std::fmt;
use std::io::Read;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::StudyError;
use crate::case_file::{CASE_ENDING, FORMAT};
use impactlab_core::compare::PairRecords;
use impactlab_core::data::{ARCHIVE_START, CASES_FILE, DatasetKind, TomlFile, is_gltf, open_file};
use impactlab_core::site::{CloudFormat, SurveyFormat, is_picture, is_picture_file};

/// Bytes at the start of a file by which its kind is found out; a settings file is read whole.
const HEAD_BYTES: u64 = 4096;

/// Ending of the names of trained networks.
pub const MODEL_ENDING: &str = "safetensors";

/// Ending of the names of atlases.
pub const ATLAS_ENDING: &str = "atlas";

/// The first file in the archive of an atlas, whose name stands behind the header.
const ATLAS_HEAD: &[u8] = b"atlas.json";
const ARCHIVE_HEADER_BYTES: usize = 30;

/// Endings of the names of surveyed lines and points, and of point clouds.
const SURVEYS: [&str; 3] = ["kml", "kmz", "geojson"];
const CLOUDS: [&str; 3] = ["las", "laz", "e57"];

/// What stands at the beginning of the state of a reconstruction.
const CHECKPOINT: &[u8] = b"impactlab reconstruction";

/// Keys and tables at the top of a TOML file that belong to one kind of file.
const TOML_KEYS: [(InputKind, &[&str]); 6] = [
    (
        InputKind::Evidence,
        &[
            "struck_car",
            "striking_car",
            "damage",
            "rest",
            "striking_rest",
            "mark",
            "striking_mark",
            "after",
            "edr",
            "striking_edr",
            "prior",
            "weighing",
            "position",
            "road",
            "skid_before",
            "striking_skid_before",
            "car",
            "start",
            "wheels",
            "recorded_speed",
        ],
    ),
    (InputKind::Scenario, &["target", "bullet", "contact", "ending", "bullet_ending", "road"]),
    (
        InputKind::Vehicle,
        &["mass", "geometry", "suspension", "tires", "estimates", "data_sheet", "equations"],
    ),
    (
        InputKind::Site,
        &["origin", "orthophoto", "lane", "kerb", "friction_zone", "line", "point", "dxf", "road"],
    ),
    (
        InputKind::Settings,
        &[
            "network",
            "loss",
            "training",
            "crush",
            "pretraining",
            "single_steps",
            "rollouts",
            "physics",
            "effects",
            "calibration",
            "tuning",
        ],
    ),
    (InputKind::Plan, &["question", "design", "n", "chunk", "pit", "request", "vary"]),
];

/// What a path holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InputKind {
    /// The folder of a data set, or the table of its cases.
    Dataset,
    /// The folder of a data set of recorded pairs of vehicles, or the table of its cases.
    Pairs,
    /// Another folder, which may hold data sets.
    Folder,
    /// A case with its variants.
    Case,
    /// What was found after a collision.
    Evidence,
    /// A collision of two vehicles.
    Scenario,
    /// A vehicle, by its parameters or by its data sheet.
    Vehicle,
    /// The ground of a scene.
    Site,
    /// A picture from above, which is a ground of its own.
    Orthophoto,
    /// Surveyed lines and points, which are a ground of their own: KML, GeoJSON, a table of points.
    Survey,
    /// A point cloud, which becomes a ground: LAS, LAZ, E57.
    PointCloud,
    /// A trained network.
    Network,
    /// The comparison of response networks.
    Comparison,
    /// A question that `--print-request` wrote.
    Request,
    /// The state in which a reconstruction was broken off.
    Checkpoint,
    /// Settings of a training.
    Settings,
    /// An atlas: a map of many computed collisions.
    Atlas,
    /// The plan of a sweep.
    Plan,
    /// A TOML file without a key of any kind.
    UnknownToml,
    /// A table of time series: force, trajectory, steering or torques at the wheels.
    Series,
}

impl InputKind {
    /// Finds out what a path holds. Nothing is said of what is wrong with it; reading it does that.
    pub fn from_path(path: &Path) -> Self {
        if path.is_dir() {
            return match DatasetKind::from_folder(path) {
                Some(_) => Self::Dataset,
                None if PairRecords::is_at(path) => Self::Pairs,
                None => Self::Folder,
            };
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let is_table = path.file_name().is_some_and(|name| name == CASES_FILE);
        if is_table && DatasetKind::from_folder(folder).is_some() {
            return Self::Dataset;
        }
        if is_table && PairRecords::is_at(folder) {
            return Self::Pairs;
        }
        from_content(path).unwrap_or_else(|| from_name(path))
    }

    /// What reading a file as this kind came to; where it failed because the file is of another kind,
    /// the error says which.
    ///
    /// # Errors
    /// [`StudyError::OtherKind`], or the error of the reader.
    pub(crate) fn explain<T, E: Into<StudyError>>(
        self,
        path: &Path,
        read: Result<T, E>,
    ) -> Result<T, StudyError> {
        read.map_err(|error| self.refuse_other(path).err().unwrap_or_else(|| error.into()))
    }

    /// Says of a file that cannot be read as this kind which other kind it is of.
    ///
    /// # Errors
    /// [`StudyError::OtherKind`], where something in the file says so.
    pub fn refuse_other(self, path: &Path) -> Result<(), StudyError> {
        let found = Self::from_path(path);
        // These are what is left where nothing in the file says what it is.
        let is_guess = matches!(found, Self::UnknownToml | Self::Series | Self::Comparison);
        // Each kind of ground is taken where a site is.
        let is_as_good = found == self || found.is_ground() && self.is_ground();
        if is_as_good || is_guess || !path.exists() {
            return Ok(());
        }
        Err(StudyError::OtherKind { path: path.to_owned(), found, expected: self })
    }

    /// Whether it holds time series, which are read for seconds and checked.
    pub fn is_data(self) -> bool {
        matches!(self, Self::Dataset | Self::Folder | Self::Series)
    }

    /// A command that takes such a file; `None` if the file is not used by itself.
    pub fn command(self) -> Option<&'static str> {
        Some(match self {
            Self::Dataset => "impactlab train force --data FOLDER",
            Self::Pairs => "impactlab evaluate pairs FOLDER",
            Self::Case => "impactlab report FILE",
            Self::Evidence => "impactlab reconstruct FILE",
            Self::Scenario => "impactlab impact FILE",
            Self::Vehicle => "impactlab simulate --vehicle FILE",
            Self::Request => "impactlab ask FILE",
            Self::Checkpoint => "impactlab reconstruct EVIDENCE --resume",
            Self::Network => "impactlab evaluate force (or response) --model FILE",
            Self::Settings => "impactlab train force --config FILE",
            Self::Atlas => "impactlab atlas cell --atlas FILE",
            Self::Plan => "impactlab sweep plan FILE",
            Self::PointCloud => "impactlab import FILE --out DIR --resolution 0.05",
            Self::Survey
            | Self::Site
            | Self::Orthophoto
            | Self::Comparison
            | Self::Folder
            | Self::UnknownToml
            | Self::Series => return None,
        })
    }

    /// Whether it is a TOML file.
    pub fn is_toml(self) -> bool {
        matches!(
            self,
            Self::Evidence
                | Self::Scenario
                | Self::Vehicle
                | Self::Site
                | Self::Settings
                | Self::Plan
                | Self::UnknownToml
        )
    }

    /// Whether it is the ground of a scene.
    pub fn is_ground(self) -> bool {
        matches!(self, Self::Site | Self::Orthophoto | Self::Survey)
    }
}

impl fmt::Display for InputKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Dataset => "a data set",
            Self::Pairs => "a data set of recorded pairs",
            Self::Folder => "a folder of data sets",
            Self::Case => "a case",
            Self::Evidence => "the evidence of a reconstruction",
            Self::Scenario => "a scenario",
            Self::Vehicle => "a vehicle",
            Self::Site => "a site",
            Self::Orthophoto => "an orthophoto",
            Self::Survey => "surveyed lines and points",
            Self::PointCloud => "a point cloud",
            Self::Network => "a trained network",
            Self::Comparison => "a comparison of response networks",
            Self::Request => "a question",
            Self::Checkpoint => "the state of an unfinished reconstruction",
            Self::Settings => "the settings of a training",
            Self::Atlas => "an atlas",
            Self::Plan => "the plan of a sweep",
            Self::UnknownToml => "a TOML file of no known kind",
            Self::Series => "a table of time series",
        })
    }
}

/// The kind by the content; `None` if that does not decide.
fn from_content(path: &Path) -> Option<InputKind> {
    let (file, _) = open_file(path, u64::MAX).ok()?;
    let mut head = Vec::new();
    file.take(HEAD_BYTES).read_to_end(&mut head).ok()?;
    if is_picture(&head) {
        return Some(InputKind::Orthophoto);
    }
    if CloudFormat::from_head(&head).is_some() {
        return Some(InputKind::PointCloud);
    }
    if SurveyFormat::from_path(path).is_some() {
        return Some(InputKind::Survey);
    }
    let first = head.get(ARCHIVE_HEADER_BYTES..).unwrap_or_default();
    if head.starts_with(ARCHIVE_START) && first.starts_with(ATLAS_HEAD) {
        return Some(InputKind::Atlas);
    }
    // The header of a trained network is JSON after its length.
    if head.get(8) == Some(&b'{') && head.first() != Some(&b'{') && head.get(7) == Some(&0) {
        return Some(InputKind::Network);
    }
    // A CBOR map whose first entry says what it is, after a checksum of 64 characters.
    let is_map = head.get(64).is_some_and(|byte| (0xa0..=0xbf).contains(byte));
    if is_map && head.windows(CHECKPOINT.len()).any(|bytes| bytes == CHECKPOINT) {
        return Some(InputKind::Checkpoint);
    }
    let text = String::from_utf8_lossy(&head);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if is_gltf(text) {
        return Some(InputKind::Series);
    }
    if text.starts_with('{') {
        let is_case = has_ending(path, CASE_ENDING) || text.contains(&format!("\"{FORMAT}\""));
        return Some(match text.contains("\"question\"") {
            _ if is_case => InputKind::Case,
            _ if is_resolved_plan(text) => InputKind::Plan,
            true => InputKind::Request,
            false => InputKind::Comparison,
        });
    }
    from_toml(path, text)
}

/// Whether a JSON text is the plan of a sweep: its question is an object, that of a request a word.
fn is_resolved_plan(text: &str) -> bool {
    let Some((before, behind)) = text.split_once("\"question\"") else { return false };
    let value = behind.trim_start().strip_prefix(':').unwrap_or_default();
    value.trim_start().starts_with('{') && before.contains("\"format\"")
}

/// The kind of TOML file with most of its keys in a text, also if the text has slips.
///
/// - `head`: start of the text, without blanks.
fn from_toml(path: &Path, head: &str) -> Option<InputKind> {
    let is_named_so = has_ending(path, "toml");
    let looks_so = head.starts_with(['[', '#']) || head.lines().next()?.contains('=');
    if !is_named_so && !looks_so {
        return None;
    }
    let text = TomlFile::read(path).ok()?;
    let keys = TomlFile { path, text: &text }.top_level_keys();
    let n_keys = |known: &[&str]| keys.iter().filter(|key| known.contains(&key.as_str())).count();
    let counted = TOML_KEYS.iter().map(|(kind, known)| (n_keys(known), *kind));
    // The first of several with as many keys.
    let (n, kind) = counted.rev().max_by_key(|(n, _)| *n)?;
    // One such word at the top of a table of a data logger does not make it a TOML file.
    match n {
        0 => is_named_so.then_some(InputKind::UnknownToml),
        1 if !is_named_so => None,
        _ => Some(kind),
    }
}

/// The kind by the name.
fn from_name(path: &Path) -> InputKind {
    match () {
        () if has_ending(path, CASE_ENDING) => InputKind::Case,
        () if has_ending(path, "toml") => InputKind::UnknownToml,
        () if has_ending(path, MODEL_ENDING) => InputKind::Network,
        () if has_ending(path, ATLAS_ENDING) => InputKind::Atlas,
        () if has_ending(path, "json") => InputKind::Comparison,
        () if is_picture_file(path) => InputKind::Orthophoto,
        () if SURVEYS.iter().any(|ending| has_ending(path, ending)) => InputKind::Survey,
        () if CLOUDS.iter().any(|ending| has_ending(path, ending)) => InputKind::PointCloud,
        () => InputKind::Series,
    }
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|of_path| of_path.eq_ignore_ascii_case(ending))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind_of_text(name: &str, text: &[u8]) -> InputKind {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        InputKind::from_path(&path)
    }

    #[test]
    fn what_belongs_to_a_sweep_is_told_from_questions_and_other_archives() {
        let plan = b"{\n  \"format\": 1,\n  \"name\": \"\",\n  \"question\": {\n    \"pit\": {";
        assert_eq!(kind_of_text("plan.json", plan), InputKind::Plan);
        let request = b"{\"question\": \"impact\", \"format\": 1}";
        assert_eq!(kind_of_text("request.json", request), InputKind::Request);
        let archive = |first: &[u8]| [b"PK\x03\x04".as_slice(), &[0; 26], first].concat();
        assert_eq!(kind_of_text("some.zip", &archive(b"atlas.json")), InputKind::Atlas);
        assert_eq!(kind_of_text("some.xlsx", &archive(b"[Content_Types].xml")), InputKind::Series);
        assert_eq!(kind_of_text("broken.atlas", b""), InputKind::Atlas);
    }

    #[test]
    fn what_comes_with_the_program_is_recognised() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for (path, expected) in [
            ("assets/examples/reconstruction.toml", InputKind::Evidence),
            ("datasets/staged/evidence/s00.toml", InputKind::Evidence),
            ("assets/examples/pit.impactlab", InputKind::Case),
            ("assets/scenarios/pit_right_rear.toml", InputKind::Scenario),
            ("assets/vehicles/target-2000.toml", InputKind::Vehicle),
            ("assets/sites/country-road/site.toml", InputKind::Site),
            ("assets/models/response.toml", InputKind::Settings),
            ("assets/atlas/pit.toml", InputKind::Plan),
            ("assets/models/force.safetensors", InputKind::Network),
            ("docs/guide/examples/steering.csv", InputKind::Series),
            ("datasets/fea", InputKind::Dataset),
            ("datasets/fea/cases.csv", InputKind::Dataset),
            ("datasets/pairs", InputKind::Pairs),
            ("datasets/pairs/cases.csv", InputKind::Pairs),
            ("datasets", InputKind::Folder),
        ] {
            assert_eq!(InputKind::from_path(&root.join(path)), expected, "{path}");
        }
    }

    #[test]
    fn the_content_counts_and_not_the_name() {
        let vehicle = include_bytes!("../../../../../assets/vehicles/target-2000.toml");
        for name in ["car.toml", "car.TOML", "car", "car.txt"] {
            assert_eq!(kind_of_text(name, vehicle), InputKind::Vehicle, "{name}");
        }
        let case = include_bytes!("../../../../../assets/examples/pit.impactlab");
        assert_eq!(kind_of_text("case.json", case), InputKind::Case);
        assert_eq!(kind_of_text("photo.dat", b"\x89PNG\r\n\x1a\n"), InputKind::Orthophoto);
        let question = b"{\"question\": \"check\", \"paths\": []}";
        assert_eq!(kind_of_text("q.json", question), InputKind::Request);
        let run = b"\xa5\x64kind\x78\x1aimpactlab reconstruction 3\x67version";
        let state = [&[b'0'; 64][..], run].concat();
        assert_eq!(kind_of_text("run", &state), InputKind::Checkpoint);
        let scene = b"{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [], \"nodes\": []}";
        assert_eq!(kind_of_text("car.gltf", scene), InputKind::Series);
        let force = b"time_s,fx_n,fy_n\n0,0,0\n0.1,1,2\n";
        assert_eq!(kind_of_text("force.toml.csv", force), InputKind::Series);
        let map = b"{\"type\": \"FeatureCollection\", \"features\": []}";
        assert_eq!(kind_of_text("map.json", map), InputKind::Survey);
        let kml = b"<?xml version=\"1.0\"?><kml xmlns=\"http://www.opengis.net/kml/2.2\"/>";
        assert_eq!(kind_of_text("map.txt", kml), InputKind::Survey);
        let points = b"name,E,N,Z,code\n1,512345.1,5423456.2,101.3,KERB1\n";
        assert_eq!(kind_of_text("points.csv", points), InputKind::Survey);
        assert_eq!(kind_of_text("scan.dat", b"LASF\0\0"), InputKind::PointCloud);
        assert_eq!(kind_of_text("scan", b"ASTM-E57\x01"), InputKind::PointCloud);
        assert_eq!(InputKind::from_path(Path::new("no/such.laz")), InputKind::PointCloud);
        // The preamble of a data logger.
        assert_eq!(kind_of_text("log.txt", b"[mass]\nrate=100\n0;1;2\n"), InputKind::Series);
    }

    #[test]
    fn a_slip_does_not_hide_the_kind() {
        let vehicle = include_str!("../../../../../assets/vehicles/target-2000.toml");
        for slip in [
            vehicle.replace("mass_kg = 2000.0", "mass_kg = = 2000.0"),
            vehicle.replace("[suspension]", "[suspension"),
            vehicle.replace("[mass]", "[masss]"),
            vehicle.replace("friction = 0.8", "friction = \"much"),
        ] {
            assert_ne!(slip, vehicle);
            assert_eq!(kind_of_text("car.toml", slip.as_bytes()), InputKind::Vehicle, "{slip}");
        }
        assert_eq!(kind_of_text("empty.toml", b""), InputKind::UnknownToml);
        assert_eq!(InputKind::from_path(Path::new("no/such.toml")), InputKind::UnknownToml);
        assert_eq!(InputKind::from_path(Path::new("no/such.csv")), InputKind::Series);
    }
}
