//! What a case does beyond reading files in its own folder, by which a case of somebody else is judged
//! before any of its questions is asked.

use std::collections::BTreeSet;
use std::fmt;
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::Request;
use crate::case_file::CaseFile;
use crate::case_file::used::links_in;
use impactlab_core::data::CASES_FILE;
use impactlab_core::site::Site;

/// What a case does beyond reading files in its own folder. Nothing of it is done without being asked for.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reach {
    /// Files and folders that it reads elsewhere, or whose names begin with a point, and folders with too much
    /// in them to be looked through; links are followed.
    pub reads: Vec<PathBuf>,
    /// Files and folders that its questions write.
    pub writes: Vec<PathBuf>,
    /// Whether it trains a network.
    pub trains: bool,
}

impl Reach {
    /// Whether it only reads files in its own folder.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// What it does, one phrase each.
    pub fn phrases(&self) -> Vec<String> {
        let phrase = |verb: &str, path: &PathBuf| format!("{verb} {}", path.display());
        let reads = self.reads.iter().map(|path| phrase("reads", path));
        let writes = self.writes.iter().map(|path| phrase("writes", path));
        let trains = self.trains.then(|| "trains a network".to_owned());
        reads.chain(writes).chain(trains).collect()
    }
}

impl fmt::Display for Reach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.phrases().join("; "))
    }
}

impl CaseFile {
    /// What the case does beyond reading files in its own folder. No file elsewhere is opened to find it
    /// out.
    ///
    /// - `path`: of the case's file.
    pub fn reach(&self, path: &Path) -> Reach {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let folder = real_path(absolute.parent().unwrap_or(Path::new("/")));
        let (mut reads, mut too_large) = (BTreeSet::new(), Vec::new());
        let mut add = |path: &Path| {
            let real = real_path(path);
            let is_inside = is_below(&real, &folder);
            if !is_inside {
                reads.insert(real);
            }
            is_inside
        };
        let mut inside = self.named_paths();
        inside.extend(self.files.iter().map(|file| file.path.clone()));
        inside.retain(|path| add(path));
        for path in &inside {
            // A site and a folder lead to other files, and the table of a data set to those beside it.
            let is_table = path.file_name().is_some_and(|name| name == CASES_FILE);
            let folder = path.parent().filter(|_| is_table).unwrap_or(path);
            let Some(links) = links_in(folder) else {
                too_large.push(real_path(path));
                continue;
            };
            for path in Site::files_named_by(path).iter().chain(&links) {
                add(path);
            }
        }
        reads.extend(too_large);
        let questions = || {
            let variants = self.variants.iter();
            variants.flat_map(|variant| variant.questions.iter().chain(&variant.unasked))
        };
        let mut writes: Vec<PathBuf> =
            questions().filter_map(Request::written_path).map(Path::to_owned).collect();
        writes.sort();
        writes.dedup();
        Reach {
            reads: reads.into_iter().collect(),
            writes,
            trains: questions().any(Request::is_training),
        }
    }
}

/// Where a path leads, as far as it exists; the rest stays as it is.
fn real_path(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let real = absolute.ancestors().find_map(|ancestor| {
        let (rest, real) = (absolute.strip_prefix(ancestor).ok()?, ancestor.canonicalize().ok()?);
        // Nothing is not joined to a path: it would end with a slash then.
        Some(if rest.as_os_str().is_empty() { real } else { real.join(rest) })
    });
    real.unwrap_or(absolute)
}

/// Whether a path lies in a folder and is not hidden there.
fn is_below(path: &Path, folder: &Path) -> bool {
    let is_plain = |part: Component<'_>| match part {
        Component::Normal(name) => !name.to_string_lossy().starts_with('.'),
        _ => false,
    };
    path.strip_prefix(folder).is_ok_and(|below| below.components().all(is_plain))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case_file::Variant;
    use crate::{
        CheckRequest, EvidenceChoice, MotionSource, ReconstructRequest, SeriesFile, SimulateRequest,
    };

    /// A case in `folder` that asks one question.
    fn reach_of(question: impl Into<Request>, folder: &Path) -> Reach {
        let questions = vec![question.into()];
        let variant = Variant { name: "one".into(), questions, ..Variant::default() };
        CaseFile::new("case", variant).reach(&folder.join("a.impactlab"))
    }

    fn check(path: PathBuf) -> CheckRequest {
        serde_json::from_value(serde_json::json!({"paths": [path]})).unwrap()
    }

    #[test]
    fn a_case_reaches_beyond_its_folder_by_no_path_unseen() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let own = root.join("case");
        std::fs::create_dir_all(own.join("data/.git")).unwrap();
        for file in ["secret", "case/data/force.csv", "case/data/.git/config"] {
            std::fs::write(root.join(file), "t\n0\n").unwrap();
        }
        let reads = |path: PathBuf| reach_of(check(path), &own).reads;
        for inside in ["data", "data/force.csv", "data/../data/force.csv", "data/none.csv"] {
            assert!(reads(own.join(inside)).is_empty(), "{inside}");
        }
        let secret = [root.join("secret")];
        assert_eq!(reads(root.join("secret")), secret);
        assert_eq!(reads(own.join("../secret")), secret);
        assert_eq!(reads(own.join("data/../../secret")), secret);
        assert_eq!(reads(own.join("data/.git/config")), [own.join("data/.git/config")]);
        assert_eq!(reads("secret".into()), [std::path::absolute("secret").unwrap()]);
        assert_eq!(reads("/dev/zero".into()), [PathBuf::from("/dev/zero")]);
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(root.join("secret"), own.join("data/link.csv")).unwrap();
            std::os::unix::fs::symlink(&root, own.join("up")).unwrap();
            assert_eq!(reads(own.join("data/link.csv")), secret);
            assert_eq!(reads(own.join("data")), secret);
            std::fs::write(own.join("data/cases.csv"), "case\nlink\n").unwrap();
            assert_eq!(reads(own.join("data/cases.csv")), secret);
            assert_eq!(reads(own.join("up/secret")), secret);
        }
    }

    /// A site names no file elsewhere, but a file beside it may be a link.
    #[cfg(unix)]
    #[test]
    fn what_a_site_leads_to_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        let (own, secret) = (root.join("case"), root.join("secret.png"));
        std::fs::create_dir(&own).unwrap();
        std::fs::write(&secret, "").unwrap();
        let site = own.join("site.toml");
        std::fs::write(&site, "[orthophoto]\nfile = \"road.png\"\n").unwrap();
        std::os::unix::fs::symlink(&secret, own.join("road.png")).unwrap();
        let source =
            MotionSource::Trajectory { file: SeriesFile::new(own.join("run.csv")), contact: None };
        let question = SimulateRequest { site: Some(site), ..SimulateRequest::new(source) };
        assert_eq!(reach_of(question, &own).reads, [secret]);
    }

    #[test]
    fn what_a_question_writes_is_seen_and_so_is_a_training() {
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().canonicalize().unwrap();
        let evidence = EvidenceChoice::File(own.join("evidence.toml"));
        let written = own.join("run.bin");
        let question = ReconstructRequest {
            checkpoint: Some(written.clone()),
            ..ReconstructRequest::new(evidence)
        };
        let reach = reach_of(question, &own);
        assert_eq!(reach, Reach { writes: vec![written.clone()], ..Reach::default() });
        assert_eq!(reach.to_string(), format!("writes {}", written.display()));
        let training = serde_json::json!({"question": "fine_tune", "data": [own.join("set")]});
        let training: Request = serde_json::from_value(training).unwrap();
        assert_eq!(reach_of(training, &own), Reach { trains: true, ..Reach::default() });
    }
}
