//! A folder of staged collisions: `evidence/<case>.toml`, what is found, and `truth/<case>.toml`, what
//! had happened.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ReconstructedQuantity;
use impactlab_core::data::{DataError, TomlError, TomlFile, TomlTable, list_folder};
use impactlab_core::numerics::sha256_hex;
use impactlab_core::ranges::{EVIDENCE_SPEED, HEADING, SPEED, YAW_RATE};

/// Which cases of a folder.
///
/// The cases are put into the order of the SHA-256 of their names in hexadecimal digits, so that the
/// order has nothing to do with how they were made.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StagedSplit {
    /// All of them.
    #[default]
    All,
    /// The first half, rounded down: those that settings may be chosen on.
    Tuning,
    /// The others: those whose figures are reported.
    Reported,
}

/// A folder of staged collisions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StagedCollisions {
    root: PathBuf,
    names: Vec<String>,
}

impl StagedCollisions {
    /// Whether a folder is one of staged collisions: it has `evidence/` and `truth/`.
    pub fn is_at(root: &Path) -> bool {
        ["evidence", "truth"].iter().all(|folder| root.join(folder).is_dir())
    }

    /// Evidence and truth of all cases, in the order of their names: which half a case is of is known by the
    /// names of all. A folder that has no staged collisions has none.
    pub fn files(root: &Path) -> Vec<PathBuf> {
        let Some(staged) = Self::is_at(root).then(|| Self::open(root).ok()).flatten() else {
            return Vec::new();
        };
        let of_case = |name: &String| [staged.evidence_file(name), staged.truth_file(name)];
        let mut files: Vec<PathBuf> = staged.names.iter().flat_map(of_case).collect();
        files.retain(|file| file.is_file());
        files.sort();
        files
    }

    /// Lists the cases of a folder. No file is read.
    ///
    /// # Errors
    /// [`DataError`] if the folder or its folder `evidence` cannot be listed.
    pub fn open(root: &Path) -> Result<Self, DataError> {
        let mut names: Vec<String> = list_folder(&root.join("evidence"))?
            .iter()
            .filter(|path| path.extension().is_some_and(|end| end == "toml"))
            .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
            .collect();
        names.sort();
        Ok(Self { root: root.to_owned(), names })
    }

    /// The names of all cases in their order.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The names of the cases of a split in their order.
    pub fn names_in(&self, split: StagedSplit) -> Vec<String> {
        let mut shuffled = self.names.clone();
        shuffled.sort_by_cached_key(|name| sha256_hex([name.as_bytes()]));
        let (tuning, reported) = shuffled.split_at(shuffled.len() / 2);
        let mut chosen = match split {
            StagedSplit::All => shuffled,
            StagedSplit::Tuning => tuning.to_vec(),
            StagedSplit::Reported => reported.to_vec(),
        };
        chosen.sort();
        chosen
    }

    /// The file that says what is found of a case.
    pub fn evidence_file(&self, name: &str) -> PathBuf {
        self.root.join("evidence").join(format!("{name}.toml"))
    }

    /// The file that says what had happened.
    pub fn truth_file(&self, name: &str) -> PathBuf {
        self.root.join("truth").join(format!("{name}.toml"))
    }
}

/// What had happened.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TrueQuantities {
    /// Speed of the struck car before the impact, m/s.
    pub struck_m_s: f64,
    /// Speed of the striking car before the impact, m/s.
    pub striking_m_s: f64,
    /// Size of the difference of both velocities, m/s.
    pub closing_m_s: f64,
    /// Heading of the striking car against that of the struck car, rad, where it is said.
    pub heading_difference_rad: Option<f64>,
    /// Change of velocity of the struck car by the contact alone, m/s, where it is said.
    pub delta_v_struck_m_s: Option<f64>,
    /// Yaw rate of the struck car at the end of the contact, rad/s, where it is said.
    pub yaw_rate_after_rad_s: Option<f64>,
}

impl TrueQuantities {
    /// Reads what had happened; of both cars `speed_before_m_s` and `velocity_before_m_s`, and
    /// where they are said `delta_v_contact_m_s` and `yaw_rate_after_rad_s` of the struck car and
    /// `heading_rad` of the striking car. Other keys are not looked at.
    ///
    /// # Errors
    /// [`TomlError`] with file, line and key.
    pub fn load(path: &Path) -> Result<Self, TomlError> {
        let text = TomlFile::read(path)?;
        Self::from_toml(TomlFile { path, text: &text })
    }

    fn from_toml(file: TomlFile<'_>) -> Result<Self, TomlError> {
        let root = file.parse()?;
        let mut top = TomlTable::root(file, &root);
        let mut car = |key| {
            let mut car = top.table(key)?;
            let speed_m_s = car.require("speed_before", &EVIDENCE_SPEED)?;
            let velocity = car.point("velocity_before_m_s", &SPEED)?;
            let velocity = velocity.ok_or_else(|| car.missing("velocity_before_m_s"))?;
            Ok((speed_m_s, velocity, car))
        };
        let (struck_m_s, struck, mut struck_car) = car("struck_car")?;
        let (striking_m_s, striking, mut striking_car) = car("striking_car")?;
        let delta_v = struck_car.point("delta_v_contact_m_s", &SPEED)?;
        Ok(Self {
            struck_m_s,
            striking_m_s,
            closing_m_s: (striking[0] - struck[0]).hypot(striking[1] - struck[1]),
            heading_difference_rad: striking_car.number("heading", &HEADING)?,
            delta_v_struck_m_s: delta_v.map(|[x, y]| x.hypot(y)),
            yaw_rate_after_rad_s: struck_car.number("yaw_rate_after", &YAW_RATE)?,
        })
    }

    /// The true value of a quantity in SI units; `None` if it is not said.
    pub fn value(&self, quantity: ReconstructedQuantity) -> Option<f64> {
        match quantity {
            ReconstructedQuantity::StruckSpeed => Some(self.struck_m_s),
            ReconstructedQuantity::StrikingSpeed => Some(self.striking_m_s),
            ReconstructedQuantity::ClosingSpeed => Some(self.closing_m_s),
            ReconstructedQuantity::HeadingDifference => self.heading_difference_rad,
            ReconstructedQuantity::DeltaVStruck => self.delta_v_struck_m_s,
            ReconstructedQuantity::StruckYawRate => self.yaw_rate_after_rad_s,
            ReconstructedQuantity::RoadFriction
            | ReconstructedQuantity::StruckSpeedBeforeSkid
            | ReconstructedQuantity::StrikingSpeedBeforeSkid
            | ReconstructedQuantity::CarSpeed
            | ReconstructedQuantity::CarSideslip
            | ReconstructedQuantity::CarYawRate
            | ReconstructedQuantity::CarSpeedBeforeBraking => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_of_one_half_by_the_digest_of_its_name() {
        // SHA-256 of a: ca97…, b: 3e23…, c: 2e7d…, d: 18ac…, e: 3f79….
        let names = ["a", "b", "c", "d", "e"].map(str::to_owned).to_vec();
        let staged = StagedCollisions { root: PathBuf::new(), names };
        assert_eq!(staged.names_in(StagedSplit::Tuning), ["c", "d"]);
        assert_eq!(staged.names_in(StagedSplit::Reported), ["a", "b", "e"]);
        assert_eq!(staged.names_in(StagedSplit::All), staged.names());
    }

    #[test]
    fn the_truth_is_read_with_the_closing_speed_of_both_velocities() {
        let text = "case = \"x\"\n[struck_car]\nspeed_before_m_s = 10\nmass_kg = 1\n\
                    velocity_before_m_s = [10, 0]\n[striking_car]\nspeed_before_m_s = 13.6\n\
                    velocity_before_m_s = [13, 4]\n";
        let truth = |text: &str| TrueQuantities::from_toml(TomlFile { path: Path::new("t"), text });
        let found = truth(text).unwrap();
        let speeds =
            TrueQuantities { struck_m_s: 10.0, striking_m_s: 13.6, closing_m_s: 5.0, ..found };
        assert_eq!(found, speeds);
        assert_eq!(found.value(ReconstructedQuantity::HeadingDifference), None);
        assert_eq!(found.value(ReconstructedQuantity::RoadFriction), None);
        let after = "delta_v_contact_m_s = [3, -4]\nyaw_rate_after_deg_s = 90\n[striking_car]";
        let more = text.replace("[striking_car]", after) + "heading_deg = 180\n";
        let found = truth(&more).unwrap();
        assert_eq!(found.value(ReconstructedQuantity::DeltaVStruck), Some(5.0));
        let angle = |quantity| found.value(quantity).expect("an angle").to_degrees();
        assert!((angle(ReconstructedQuantity::StruckYawRate) - 90.0).abs() < 1e-12);
        assert!((angle(ReconstructedQuantity::HeadingDifference) - 180.0).abs() < 1e-12);
        let error = truth(&text.replace("velocity_before_m_s = [13, 4]", "")).unwrap_err();
        assert!(error.to_string().contains("velocity_before_m_s is missing"), "{error}");
    }
}
