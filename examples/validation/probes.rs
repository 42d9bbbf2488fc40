//! What a measurement was made of: the digest of its data, and numbers that a build must still compute.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use impactlab_core::data::list_folder;
use impactlab_core::numerics::sha256_hex;
use impactlab_core::vehicle::Integrator;
use impactlab_reconstruct::evaluate::KnownEvidence;
use impactlab_reconstruct::evidence::Evidence;
use impactlab_reconstruct::sampler::Target;
use impactlab_reconstruct::{
    Cars, Discrepancy, ForwardModel, Posterior, ReconstructedQuantity, ReconstructionTarget,
};
use impactlab_study::{
    EvaluatePairsRequest, Event, ForceQuestion, ForceSource, ImpactRequest, Library, Measured,
    MotionSource, PredictForceRequest, PredictMotionRequest, Question, ScenarioChoice,
    SimulateDatasetRequest, VehicleChoice,
};
use serde_json::Value;

/// Cases of which reconstructions are probed.
const STAGED: [&str; 2] = ["s07", "s24"];

type Probe = BTreeMap<String, f64>;

/// SHA-256 over the names and contents of files and of all files in folders, in the order of their names:
/// that in which a folder is listed differs between file systems.
///
/// - `root`: the folder that the names start from.
pub fn data_sha256(root: &Path, data: &[String]) -> Result<String, Box<dyn Error>> {
    let mut files = Vec::new();
    for name in data {
        collect(&root.join(name), &mut files)?;
    }
    let mut parts = Vec::new();
    for file in files {
        let name = file.strip_prefix(root)?.to_string_lossy().replace('\\', "/");
        parts.push(format!("{name}\n{}\n", sha256_hex([fs::read(&file)?.as_slice()])));
    }
    Ok(sha256_hex(parts.iter().map(String::as_bytes)))
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) -> Result<(), Box<dyn Error>> {
    if path.is_dir() {
        let mut inside = list_folder(path)?;
        inside.sort();
        for inside in inside {
            collect(&inside, files)?;
        }
    } else {
        files.push(path.to_owned());
    }
    Ok(())
}

/// The numbers of a subject that this build computes.
pub fn probe(root: &Path, subject: Measured) -> Result<Probe, Box<dyn Error>> {
    let data = root.join("datasets");
    let case = |set: &str, case: &str| (data.join(set), case.to_owned());
    match subject {
        Measured::Impact => {
            let scenario = ScenarioChoice::File(PathBuf::from("pit-right-rear"));
            let names = ["/impulse_magnitude_n_s", "/target/delta_yaw_rate_rad_s"];
            numbers(&ImpactRequest::new(scenario), &names)
        }
        Measured::FourDof => {
            let mut all = Probe::new();
            for (set, case) in [("trajectories-fea", "FE_c001"), ("trajectories-pulse", "P001")] {
                let question = SimulateDatasetRequest {
                    dataset: data.join(set),
                    case: Some(case.to_owned()),
                    vehicle: VehicleChoice::Automatic,
                    equations: None,
                    integrator: Integrator::default(),
                };
                let found = numbers(&question, &["/cases/0/average_error_m"])?;
                all.extend(found.into_iter().map(|(name, value)| (format!("{case}{name}"), value)));
            }
            Ok(all)
        }
        Measured::ForceNetwork => {
            let (dataset, case) = case("fea", "c004");
            let question = PredictForceRequest::new(ForceQuestion::Case { dataset, case });
            let names = ["/impulse_n_s/magnitude/median", "/peak_n/median", "/duration_s/median"];
            numbers(&question, &names)
        }
        Measured::ResponseNetwork => {
            let (dataset, case) = case("trajectories-cars-held-out/car-000", "car-000_00");
            let source = MotionSource::Case { dataset, case };
            let question = PredictMotionRequest {
                draws: 10,
                ..PredictMotionRequest::new(source, ForceSource::Given)
            };
            let names = ["/outcome/x_m/median", "/outcome/y_m/median", "/outcome/region_90_m2"];
            numbers(&question, &names)
        }
        Measured::Pairs => {
            let question = EvaluatePairsRequest {
                only: vec!["d064".to_owned()],
                draws: 6,
                ..EvaluatePairsRequest::new(data.join("pairs"))
            };
            let names = [
                "/cases/0/struck/average_error_m",
                "/cases/0/striking/average_error_m",
                "/cases/0/impulse_n_s/forecast",
            ];
            numbers(&question, &names)
        }
        Measured::ReconstructionOfEverything => reconstruction(&data, KnownEvidence::Everything),
        Measured::ReconstructionWithoutEdr => reconstruction(&data, KnownEvidence::WithoutEdr),
        Measured::ReconstructionOfRest => reconstruction(&data, KnownEvidence::RestOnly),
    }
}

/// Numbers of the report of an answer, by their places in its JSON.
fn numbers<Q: Question>(question: &Q, places: &[&str]) -> Result<Probe, Box<dyn Error>>
where
    Q::Report: serde::Serialize,
{
    let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
    let answer = question.answer(&Library::default(), &mut go_on)?.complete().ok_or("cancelled")?;
    let report = serde_json::to_value(Q::report(&answer))?;
    let number = |place: &&str| {
        let number = report.pointer(place).and_then(Value::as_f64);
        Ok(((*place).to_owned(), number.ok_or_else(|| format!("no number {place}"))?))
    };
    places.iter().map(number).collect()
}

/// What follows from the point of the prior at which every quantity has its median, and how likely it
/// makes the evidence.
fn reconstruction(data: &Path, known: KnownEvidence) -> Result<Probe, Box<dyn Error>> {
    let mut all = Probe::new();
    for case in STAGED {
        let evidence = Evidence::load(&data.join(format!("staged/evidence/{case}.toml")))?;
        let evidence = known.select(&evidence);
        let cars = Cars::new(&evidence, None, None);
        let model = ForwardModel::new(&evidence, cars);
        let target = ReconstructionTarget::new(evidence, model, Discrepancy::default());
        let centre = vec![vec![0.0; target.dim()]];
        let point = Posterior::from_points(target.model(), &centre);
        for quantity in ReconstructedQuantity::ALL {
            let value = point.values(*quantity).first().copied().ok_or("no value")?;
            all.insert(format!("{case}/{}", quantity.key()), value);
        }
        let likelihood = target.log_likelihoods(&centre).first().copied().ok_or("no likelihood")?;
        all.insert(format!("{case}/log_likelihood"), likelihood);
    }
    Ok(all)
}
