//! From the evidence of a collision to the speeds before it, and from that of a single car to its speed at
//! the start: `reconstruct`.

use std::ffi::OsString;
use std::ops::ControlFlow;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::check_count;
use crate::caveats::bodies::unusual as unusual_sheet;
use crate::caveats::restrictions::slope_caveat;
use crate::questions::reconstruct::assumed::{assumptions, unused};
use crate::questions::reconstruct::badges::{
    apart_by_hand, beside_locked_marks, of_fit, of_left_out, of_particles, of_validation,
    several_courses,
};
use crate::questions::reconstruct::cut_off::cut_off;
use crate::questions::reconstruct::later_contacts::{LaterContactsReport, WhyNot, not_looked_for};
use crate::questions::reconstruct::paths::compared_marks;
use crate::questions::reconstruct::progress::progress;
use crate::questions::reconstruct::single_car;
use crate::questions::reconstruct::tried::untried_course;
use crate::{
    Answer, Event, EvidenceChoice, FrictionZoneReport, InputKind, Library, Observer, Provenance,
    Question, Sampling, StudyError, VehicleChoice,
};
use impactlab_core::data::Outcome;
use impactlab_core::jobs::Progress;
use impactlab_core::numerics::sha256_hex;
use impactlab_core::program;
use impactlab_core::ranges::RECONSTRUCTION_PARTICLES;
use impactlab_core::site::Site;
use impactlab_core::uncertainty::{Caveat, CaveatSubject, Caveats};
use impactlab_reconstruct::domain::{check_damage, outside_domain};
use impactlab_reconstruct::evaluate::KnownEvidence;
use impactlab_reconstruct::evidence::{Evidence, EvidenceKind};
use impactlab_reconstruct::sampler::{
    Particles, SamplerCheckpoint, SamplerReport, SamplerSettings, SamplerStart, sample_from,
};
use impactlab_reconstruct::{
    BudgetItem, Car, Cars, Discrepancy, EvidenceFit, ForwardModel, HandCheck, HandSpeed, LeftOut,
    MarkComparison, Mode, Posterior, PriorComponent, QuantityEstimate, ReconstructionTarget,
    SpeedHinge,
};

/// Evaluations of the forward model that each particle is worth at the most.
const EVALUATIONS_PER_PARTICLE: usize = 150;

/// The same of motions through later contacts, which take fifty times as long.
const FOLLOWED_PER_PARTICLE: usize = 20;

/// Asks how fast both cars were, or a single one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReconstructRequest {
    /// What was found.
    pub evidence: EvidenceChoice,
    /// The struck or single car, where the evidence leaves it open.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// The striking car, likewise.
    #[serde(default)]
    pub striking: VehicleChoice,
    /// Site file whose friction zones the wheels stand on, in the axes of the evidence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub site: Option<PathBuf>,
    /// Whether the cars are followed through the first contact alone, although they meet again.
    #[serde(default)]
    pub one_contact: bool,
    /// Number of particles.
    #[serde(default = "default_particles")]
    pub particles: usize,
    /// Seed of all draws.
    #[serde(default)]
    pub seed: u64,
    /// File that the run is saved in after each step towards the evidence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checkpoint: Option<PathBuf>,
    /// Whether to go on from that file if it exists.
    #[serde(default)]
    pub resume: bool,
}

fn default_particles() -> usize {
    ReconstructRequest::DEFAULT_PARTICLES
}

/// What the evidence says of the speeds, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ReconstructReport {
    /// Name of the case.
    pub case: String,
    /// What the evidence is of; a collision where it is not written.
    #[serde(skip_serializing_if = "EvidenceKind::is_collision")]
    pub kind: EvidenceKind,
    /// The quantities with their intervals, which are left out where the particles are worth less than
    /// 100 independent ones or are not of the posterior.
    pub quantities: Vec<QuantityEstimate>,
    /// What the speeds hinge on, the friction of the road first; nothing with too few particles.
    pub hinges: Vec<SpeedHinge>,
    /// Courses of events that the evidence leaves possible, the most probable one first.
    pub modes: Vec<Mode>,
    /// How well each item of the evidence is explained.
    pub fit: Vec<EvidenceFit>,
    /// The answer without each part of the evidence, and whether that part goes with the others; none
    /// where there is one part only.
    pub left_out: Vec<LeftOut>,
    /// Each mark that was found beside the one that its wheel leaves in the motion of the particle of
    /// median speed.
    pub marks: Vec<MarkComparison>,
    /// What further evidence would bring.
    pub budget: Vec<BudgetItem>,
    /// Effective sample size.
    pub ess: f64,
    /// How many times as large as stated the standard deviations of the evidence count, 1 or more: larger
    /// where hardly a draw is of the posterior.
    pub sigma_factor: f64,
    /// Motions that were simulated.
    pub n_simulations: usize,
    /// Number of particles.
    pub n_particles: usize,
    /// Logarithm of the evidence, up to a constant of the case: tells assumptions about one case apart.
    pub log_evidence: f64,
    /// Speeds by hand, each from its own part of the evidence, where one holds.
    pub by_hand: Vec<HandCheck>,
    /// That of the struck car before the impact, or of a single one at the start, m/s, and its standard
    /// deviation.
    pub by_hand_m_s: Option<[f64; 2]>,
    /// The parts of the ground with their own friction.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub friction_zones: Vec<FrictionZoneReport>,
    /// What the evidence is alike among the staged collisions that reconstructions were measured on; none
    /// of an impact elsewhere than on a flank behind the CG or without a rest pose, like which none of them is,
    /// and of a single car.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub known: Option<KnownEvidence>,
    /// Whether the cars met as in those, too.
    #[serde(skip)]
    pub met_as_tried: bool,
    /// Whether the cars meet again, and what was made of it; none where sampling was stopped before, and of
    /// a single car.
    pub later_contacts: Option<LaterContactsReport>,
    /// What was taken to be likely before.
    pub priors: Vec<PriorComponent>,
    /// Whether the evidence says which way a car went. Otherwise courses of events and their probabilities are
    /// those of the prior.
    #[serde(skip)]
    pub tells_way: bool,
}

/// A reconstruction.
#[derive(Debug, Clone)]
pub struct ReconstructAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<ReconstructReport>,
    /// The posterior that was sampled.
    pub target: ReconstructionTarget,
    /// Its particles.
    pub particles: Particles,
    /// What follows from them.
    pub posterior: Posterior,
}

impl ReconstructReport {
    /// Whether there were enough particles for intervals.
    pub fn has_intervals(&self) -> bool {
        self.quantities.iter().any(|quantity| !quantity.estimate.intervals.is_empty())
    }
}

impl ReconstructRequest {
    /// Number of particles where nobody says it.
    pub const DEFAULT_PARTICLES: usize = 1000;

    /// A reconstruction with everything else left open.
    pub fn new(evidence: EvidenceChoice) -> Self {
        Self {
            evidence,
            vehicle: VehicleChoice::Automatic,
            striking: VehicleChoice::Automatic,
            site: None,
            one_contact: false,
            particles: Self::DEFAULT_PARTICLES,
            seed: 0,
            checkpoint: None,
            resume: false,
        }
    }

    /// The file of the run (`case.run`) and that of the run through all contacts which may follow it
    /// (`case.later.run`); `None` without a checkpoint.
    pub fn checkpoint_files(&self) -> Option<[PathBuf; 2]> {
        let first = self.checkpoint.clone()?;
        let mut ending = OsString::from("later");
        if let Some(of_first) = first.extension() {
            ending.push(".");
            ending.push(of_first);
        }
        let later = first.with_extension(ending);
        Some([first, later])
    }

    /// Where the run is saved, with a digest of all that its likelihood is made from.
    fn checkpoint(
        &self,
        evidence: &Evidence,
        model: &ForwardModel,
    ) -> Result<Option<SamplerCheckpoint>, StudyError> {
        let Some([first, later]) = self.checkpoint_files() else { return Ok(None) };
        let follows = model.follows_later_contacts();
        let unwanted = [&first, &later].into_iter().find(|path| path.exists() && !self.resume);
        if let Some(path) = unwanted.filter(|_| !follows) {
            return Err(StudyError::ReconstructionExists { path: path.clone() });
        }
        let path = if follows { later } else { first };
        let digest = sha256_hex([likelihood_of(evidence, model).as_bytes()]);
        Ok(Some(SamplerCheckpoint { path, digest, resume: self.resume }))
    }

    fn cars(&self, evidence: &Evidence) -> Result<Cars, StudyError> {
        let (struck, striking) = (self.vehicle.chosen()?, self.striking.chosen()?);
        Ok(Cars::new(evidence, struck.as_ref(), striking.as_ref()))
    }

    /// What lies outside of what the model is known to hold for, and what the data sheets of the vehicles and the evidence
    /// state of them and no car has.
    fn outside(
        &self,
        evidence: &Evidence,
        model: &ForwardModel,
    ) -> Result<Vec<Caveat>, StudyError> {
        let mut found = outside_domain(evidence, model.cars(), model.zones());
        for (choice, car, subject) in [
            (&self.vehicle, &evidence.struck_car, CaveatSubject::Vehicle),
            (&self.striking, &evidence.striking_car, CaveatSubject::Striking),
        ] {
            let vehicle =
                Car::sheet_of(car, choice.chosen()?.as_ref()).map(|sheet| sheet.vehicle());
            found.extend(vehicle.iter().flat_map(|vehicle| unusual_sheet(vehicle, subject)));
        }
        Ok(found)
    }

    /// The forward model of the case.
    ///
    /// # Errors
    /// [`StudyError`], if vehicles or site cannot be read.
    pub fn model(&self, evidence: &Evidence) -> Result<ForwardModel, StudyError> {
        let load = |path| InputKind::Site.explain(path, Site::load(path));
        let site = self.site.as_deref().map(load).transpose()?;
        let (zones, of_site) =
            site.map_or_else(Default::default, |site| (site.friction_zones, site.slope));
        let model = ForwardModel::new(evidence, self.cars(evidence)?).on_zones(zones);
        match of_site {
            Some(slope) if evidence.slope().is_level() => Ok(model.on_slope(slope)),
            Some(slope) if slope != evidence.slope() => {
                Err(StudyError::TwoSlopes { name: self.evidence.name() })
            }
            _ => Ok(model),
        }
    }

    /// Digest of all that the particles follow from, this build of the program included.
    ///
    /// # Errors
    /// [`StudyError`], if evidence, vehicles or site cannot be read.
    pub fn run_digest(&self) -> Result<String, StudyError> {
        let evidence = self.evidence.load()?;
        let model = self.model(&evidence)?;
        let likelihood = likelihood_of(&evidence, &model);
        let settings = format!("{:?} {}", self.settings(&model), self.one_contact);
        Ok(sha256_hex([program::version(), &likelihood, &settings].map(str::as_bytes)))
    }

    /// Samples the posterior of a forward model; breaks if the observer did.
    ///
    /// - `start`: from the particles of a model without later contacts.
    fn sampled(
        &self,
        evidence: &Evidence,
        model: ForwardModel,
        start: Option<&SamplerStart>,
        observer: &mut Observer<'_>,
    ) -> Result<(ReconstructionTarget, Particles, ControlFlow<()>), StudyError> {
        let checkpoint = self.checkpoint(evidence, &model)?;
        let target = ReconstructionTarget::new(evidence.clone(), model, Discrepancy::default());
        let settings = self.settings(target.model());
        let (mut before, mut flow) = (None, ControlFlow::Continue(()));
        let mut watch = |report: SamplerReport<'_>| {
            let (temperature, z) = (report.temperature, report.z);
            flow = observer(Event::Sampling(Sampling { target: &target, temperature, z }));
            if flow.is_continue() {
                let progress = progress(&report, &target, &settings);
                let done_before = *before.get_or_insert(progress.done);
                flow = observer(Event::Progress(progress.going_on_from(done_before)));
            }
            flow
        };
        let particles = sample_from(start, &target, &settings, checkpoint.as_ref(), &mut watch)
            .map_err(|source| StudyError::Reconstruction {
                name: self.evidence.name(),
                source: Box::new(source),
            })?;
        Ok((target, particles, flow))
    }

    /// The answer without each part of the evidence.
    fn left_out(
        &self,
        target: &ReconstructionTarget,
        particles: &Particles,
        fit: &[EvidenceFit],
        observer: &mut Observer<'_>,
    ) -> Vec<LeftOut> {
        let mut watch = |name: &str, report: SamplerReport<'_>| {
            let motions = report.n_evaluations;
            let message = format!("{motions} motions without the {name}");
            // How many parts are still to be sampled anew is not known.
            observer(Event::Progress(Progress::new(motions as u64, 0, message)))
        };
        let is_doubtful = fit.iter().any(EvidenceFit::is_unexplained);
        LeftOut::each(target, particles, is_doubtful, self.seed, &mut watch)
    }

    fn settings(&self, model: &ForwardModel) -> SamplerSettings {
        let per_particle = match model.follows_later_contacts() {
            true => FOLLOWED_PER_PARTICLE,
            false => EVALUATIONS_PER_PARTICLE,
        };
        SamplerSettings {
            n_particles: self.particles,
            seed: self.seed,
            least_ess: self.particles as f64,
            max_evaluations: self.particles * per_particle,
        }
    }
}

/// All that the likelihood of a case is made from.
fn likelihood_of(evidence: &Evidence, model: &ForwardModel) -> String {
    let (cars, zones) = (model.cars(), model.zones());
    let contacts = if model.follows_later_contacts() { " all contacts" } else { "" };
    format!("{evidence:?} {cars:?} {zones:?} {:?}{contacts}", Discrepancy::default())
}

impl Question for ReconstructRequest {
    type Answer = ReconstructAnswer;
    type Report = Answer<ReconstructReport>;
    const NAME: &'static str = "reconstruct";

    fn check(&self) -> Result<(), StudyError> {
        check_count("particles", &RECONSTRUCTION_PARTICLES, self.particles)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        _library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ReconstructAnswer>, StudyError> {
        match self.reconstructed(observer) {
            Err(StudyError::Reconstruction { source, .. }) if source.is_of_stop() => {
                Ok(Outcome::Cancelled)
            }
            answered => answered,
        }
    }
}

impl ReconstructRequest {
    fn reconstructed(
        &self,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ReconstructAnswer>, StudyError> {
        let evidence = self.evidence.load()?;
        let model = self.model(&evidence)?;
        self.check_damage(&evidence, model.cars())?;
        let outside = self.outside(&evidence, &model)?;
        let friction_zones = model.zones().iter().map(FrictionZoneReport::from_zone).collect();
        let (mut target, mut particles, flow) = self.sampled(&evidence, model, None, observer)?;
        let why_not = WhyNot::of(self.one_contact, &evidence, target.model(), flow.is_break());
        // Where the impact alone does not explain the evidence, later contacts may be why.
        let is_single_car = evidence.is_single_car();
        let share = if is_single_car { None } else { target.meet_again_share(&particles) };
        let later_contacts = share.map(|share| LaterContactsReport::new(share, why_not));
        let are_followed = later_contacts.is_some_and(|later| later.are_followed);
        if are_followed {
            let model = target.model().clone().through_later_contacts(&evidence);
            let start = Some(&particles.start);
            (target, particles, _) = self.sampled(&evidence, model, start, observer)?;
        }
        // What was sampled until then is mostly the prior: its medians would pass for speeds.
        if particles.is_stopped && !particles.is_posterior() {
            return Ok(Outcome::Cancelled);
        }
        let mut assumptions = assumptions(&evidence, target.model());
        assumptions.extend(match is_single_car {
            true => single_car::unused(self, &evidence),
            false => unused(&evidence, are_followed),
        });
        let posterior = Posterior::new(&target, &particles);
        let (fit, turned_rad) = target.fit(&particles);
        let (ground, cars) = (target.model().zones(), target.model().cars());
        let by_hand = checks_by_hand(&target);
        let apart_by_hand = apart_by_hand(&by_hand, &posterior);
        let mut caveats = Caveats::from(of_particles(&particles));
        if !is_single_car {
            caveats.extend(later_contacts.map_or_else(not_looked_for, |later| later.caveat()));
        }
        let modes = posterior.modes(&particles, &turned_rad);
        caveats.extend(several_courses(&modes).into_iter().chain(outside).chain(apart_by_hand));
        caveats.extend(slope_caveat(&target.model().cars().struck.parameters.slope));
        caveats.extend(of_fit(&fit).into_iter().chain(beside_locked_marks(&evidence)));
        let left_out = self.left_out(&target, &particles, &fit, observer);
        let alone = left_out.iter().map(|part| part.n_simulations).sum::<usize>();
        caveats.extend(of_left_out(&left_out).into_iter().chain(cut_off(&posterior, &target)));
        let known = KnownEvidence::like(target.evidence(), cars);
        caveats.extend(match is_single_car {
            true => single_car::restrictions(&evidence),
            false => vec![of_validation(ground, known, are_followed)],
        });
        caveats.extend(assumptions);
        let quantities = posterior.quantities();
        let is_alike = known.is_some() && !are_followed;
        let untried = untried_course(&evidence, &quantities).filter(|_| is_alike);
        let met_as_tried = untried.is_none();
        caveats.extend(untried);
        let report = ReconstructReport {
            case: target.evidence().case.clone(),
            kind: evidence.kind,
            known,
            met_as_tried,
            marks: compared_marks(&target, &particles, &posterior, &quantities, &modes),
            quantities,
            hinges: posterior.hinges(),
            modes,
            fit,
            left_out,
            budget: posterior.budget(self.seed),
            ess: particles.ess,
            sigma_factor: particles.sigma_factor(),
            n_simulations: particles.n_evaluations + particles.z.len() + alone,
            n_particles: particles.z.len(),
            log_evidence: particles.log_evidence,
            by_hand_m_s: asked_by_hand_m_s(&by_hand),
            by_hand,
            friction_zones,
            later_contacts,
            priors: target.model().prior().components().to_vec(),
            tells_way: evidence.tells_way(),
        };
        let report = Answer { report, caveats, provenance: Provenance::from_seed(self.seed) };
        Ok(Outcome::Complete(ReconstructAnswer { report, target, particles, posterior }))
    }

    /// Refuses damage off the struck car.
    ///
    /// # Errors
    /// [`StudyError::ContactOffVehicle`].
    fn check_damage(&self, evidence: &Evidence, cars: &Cars) -> Result<(), StudyError> {
        check_damage(&evidence.damage, cars).map_err(|source| StudyError::ContactOffVehicle {
            name: self.evidence.name(),
            vehicle: "the struck car".to_owned(),
            source,
        })
    }
}

/// What one computes by hand of the same evidence; nothing on a slope, of which these methods do not know.
fn checks_by_hand(target: &ReconstructionTarget) -> Vec<HandCheck> {
    let (ground, cars) = (target.model().zones(), target.model().cars());
    match cars.struck.parameters.slope.is_level() {
        true => HandCheck::all(target.evidence(), cars, ground),
        false => Vec::new(),
    }
}

/// Value and standard deviation by hand of the speed that the case is asked for, m/s.
fn asked_by_hand_m_s(by_hand: &[HandCheck]) -> Option<[f64; 2]> {
    let asked = [HandSpeed::Struck, HandSpeed::AtStart];
    let check = by_hand.iter().find(|check| asked.contains(&check.speed))?;
    Some([check.value_m_s, check.sigma_m_s])
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
