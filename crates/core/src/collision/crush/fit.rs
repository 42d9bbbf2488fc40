//! Fits the parameters of the crush model to known force histories by regularised least squares.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::law::{Applies, CrushLaw};
use super::simulate::CrushScenario;
use crate::numerics::{LeastSquaresProblem, levenberg_marquardt};

/// Number of consecutive time steps over which forces are averaged before they are compared. Faster
/// variations of the force are vibrations of the structure, which the model does not represent.
const STEPS_PER_RESIDUAL: usize = 2;

/// A collision with a known force history.
#[derive(Debug, Clone, PartialEq)]
pub struct CrushSample {
    /// The two vehicles at first contact.
    pub scenario: CrushScenario,
    /// Force on the struck vehicle along x in the axes of the scenario, N: the mean over each time
    /// step.
    pub fx_n: Vec<f64>,
    /// Force on the struck vehicle along y in the axes of the scenario, N: the mean over each time
    /// step.
    pub fy_n: Vec<f64>,
    /// Weight w of the residuals of this sample, 0 or more; 1 is the usual weight.
    pub weight: f64,
}

/// Smallest scale of the error of an impulse, as a share of the impulse of |F|. Forces that cancel out
/// have no relative error of their impulse; a collision that pushes in one direction has a share near 1.
const LEAST_NET_SHARE: f64 = 0.05;

/// Settings of the fit of a crush law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrushFit {
    /// Time step of the histories and of the simulation, s.
    pub dt_s: f64,
    /// Weight w_prior of the prior: the residual of a parameter that differs from the prior by its
    /// scale.
    pub prior_weight: f64,
    /// Weight w_P of the relative error of the impulse; the relative error of the history has a
    /// weight of 1.
    pub impulse_weight: f64,
    /// Largest number of steps of the Levenberg–Marquardt search.
    pub max_steps: usize,
}

impl CrushLaw {
    /// Fits a law to samples by the Levenberg–Marquardt method. This law is the prior and the start
    /// of the search. The fitted law minimises
    ///
    /// ```text
    /// Σ_cases w² ( ‖F̂ − F‖² / ‖F‖²  +  w_P² |P̂ − P|² / |P|² )  +  w_prior² Σ (p − p_prior)² / scale²
    /// ```
    ///
    /// where F are the forces of a history averaged over two consecutive steps, P is its impulse (its
    /// size counted as 5 % of the impulse of |F| at least, for forces that cancel out), p are the
    /// parameters of the law and scale is the range over which a parameter is expected to
    /// vary.
    ///
    /// - `samples`: histories with a time step of [`CrushFit::dt_s`].
    /// - `report`: called with half of this sum before each step of the search; if it breaks, the
    ///   search ends with the parameters found so far.
    /// - returns the fitted law; `None` if no sample has a force, or if the prior cannot simulate a
    ///   sample.
    pub fn fit(
        &self,
        samples: &[CrushSample],
        settings: CrushFit,
        report: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<Self> {
        let references: Vec<Reference<'_>> =
            samples.iter().filter_map(|sample| Reference::new(sample, settings)).collect();
        if references.is_empty() {
            return None;
        }
        let (prior, scales) = (self.to_vector(), self.scales());
        let problem = CrushProblem {
            law: self,
            references,
            prior: &prior,
            scales: &scales,
            applies: self.applications(),
            prior_weight: settings.prior_weight,
        };
        let search = levenberg_marquardt(&problem, [&prior, &scales], settings.max_steps, report);
        Some(self.with_vector(&search?.parameters))
    }
}

/// The samples and the prior as a problem of least squares: the residuals of each sample, then those of
/// the parameters.
struct CrushProblem<'a> {
    law: &'a CrushLaw,
    references: Vec<Reference<'a>>,
    prior: &'a [f64],
    scales: &'a [f64],
    applies: Vec<Applies>,
    prior_weight: f64,
}

impl CrushProblem<'_> {
    /// How far the parameters lie from the prior.
    fn of_prior<'a>(&'a self, row: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let held = row.iter().zip(self.prior).zip(self.scales);
        held.map(|((p, p0), scale)| self.prior_weight * (p - p0) / scale)
    }
}

impl LeastSquaresProblem for CrushProblem<'_> {
    fn residuals(&self, row: &[f64]) -> Option<Vec<f64>> {
        let law = self.law.with_vector(row);
        let cases: Vec<Option<Vec<f64>>> =
            self.references.par_iter().map(|reference| reference.residuals(&law)).collect();
        let mut all = Vec::new();
        for case in cases {
            all.extend(case?);
        }
        all.extend(self.of_prior(row));
        Some(all)
    }

    fn with_one_moved(&self, row: &[f64], idx: usize, before: &[f64]) -> Option<Vec<f64>> {
        let law = self.law.with_vector(row);
        let applies = self.applies.get(idx)?;
        let mut all = Vec::with_capacity(before.len());
        for reference in &self.references {
            match reference.has(*applies) {
                true => all.extend(reference.residuals(&law)?),
                false => all.extend(before.iter().skip(all.len()).take(reference.n_residuals())),
            }
        }
        all.extend(self.of_prior(row));
        Some(all)
    }
}

/// A sample with the quantities that its residuals need.
struct Reference<'a> {
    sample: &'a CrushSample,
    settings: CrushFit,
    /// Means of the force along `[x, y]` over pairs of consecutive steps, N.
    means: [Vec<f64>; 2],
    norm: f64,
    /// Sum of the forces of all steps, N.
    impulse: [f64; 2],
    /// What the error of this sum is divided by, N.
    impulse_scale: f64,
}

impl<'a> Reference<'a> {
    fn new(sample: &'a CrushSample, settings: CrushFit) -> Option<Self> {
        let axes = [&sample.fx_n, &sample.fy_n];
        let means = axes.map(|force| means(force));
        let norm = means.iter().flatten().map(|f| f * f).sum::<f64>().sqrt();
        let impulse: [f64; 2] = axes.map(|force| force.iter().sum());
        let total: f64 = sample.fx_n.iter().zip(&sample.fy_n).map(|(x, y)| x.hypot(*y)).sum();
        let impulse_scale = impulse[0].hypot(impulse[1]).max(LEAST_NET_SHARE * total);
        let is_usable = norm > 0.0 && norm.is_finite();
        is_usable.then_some(Self { sample, settings, means, norm, impulse, impulse_scale })
    }

    /// Whether parameters that apply to some collisions apply to this one.
    fn has(&self, applies: Applies) -> bool {
        let scenario = &self.sample.scenario;
        match applies {
            Applies::All => true,
            Applies::Striking(idx) => scenario.body_idx == idx,
            Applies::Struck(idx) => scenario.struck_body_idx == Some(idx),
        }
    }

    fn n_residuals(&self) -> usize {
        self.means.iter().map(|means| means.len() + 1).sum()
    }

    fn residuals(&self, law: &CrushLaw) -> Option<Vec<f64>> {
        let n_steps = self.sample.fx_n.len();
        let history = law.simulate(&self.sample.scenario, n_steps, self.settings.dt_s)?;
        let weight = self.sample.weight;
        let mut residuals = Vec::with_capacity(n_steps + 2);
        for (axis, force) in [&history.fx_n, &history.fy_n].into_iter().enumerate() {
            let errors = means(force).into_iter().zip(&self.means[axis]);
            residuals.extend(errors.map(|(got, known)| weight * (got - known) / self.norm));
            let error = (force.iter().sum::<f64>() - self.impulse[axis]) / self.impulse_scale;
            residuals.push(weight * self.settings.impulse_weight * error);
        }
        Some(residuals)
    }
}

fn means(force: &[f64]) -> Vec<f64> {
    let mean = |chunk: &[f64]| chunk.iter().sum::<f64>() / chunk.len() as f64;
    force.chunks(STEPS_PER_RESIDUAL).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::super::simulate::tests::{example, law};
    use super::*;

    fn sample(law: &CrushLaw, scenario: CrushScenario) -> CrushSample {
        let history = law.simulate(&scenario, 150, 1e-3).unwrap();
        CrushSample { scenario, fx_n: history.fx_n, fy_n: history.fy_n, weight: 1.0 }
    }

    /// The error of the impulse was divided by zero.
    #[test]
    fn forces_that_cancel_out_have_finite_residuals() {
        let settings =
            CrushFit { dt_s: 1e-3, prior_weight: 0.1, impulse_weight: 1.0, max_steps: 3 };
        let (mut fx_n, mut fy_n) = (vec![0.0; 150], vec![0.0; 150]);
        (fx_n[10], fx_n[12], fy_n[20], fy_n[22]) = (3e4, -3e4, 5e4, -5e4);
        let sample = CrushSample { scenario: example(), fx_n, fy_n, weight: 1.0 };
        let reference = Reference::new(&sample, settings).unwrap();
        let residuals = reference.residuals(&law()).unwrap();
        assert!(residuals.iter().all(|residual| residual.is_finite()), "{residuals:?}");
        let fitted = law().fit(&[sample], settings, &mut |cost| {
            assert!(cost.is_finite(), "{cost}");
            ControlFlow::Continue(())
        });
        assert!(fitted.unwrap().to_vector().iter().all(|parameter| parameter.is_finite()));
    }

    #[test]
    fn a_law_is_found_again_from_what_it_does() {
        let prior = law();
        let mut truth = law();
        truth.friction = 0.3;
        truth.depth_log_stiffness[1] += 0.4;
        truth.bodies[0].recovery = 0.35;
        let scenarios = (0..6).map(|i| CrushScenario {
            relative_velocity_m_s: [f64::from(i) * 0.4, 1.0 + 0.7 * f64::from(i)],
            yaw_rate_rad_s: [0.0; 2],
            theta_b_rad: 0.1 + 0.08 * f64::from(i),
            ..example()
        });
        let samples: Vec<_> = scenarios.map(|scenario| sample(&truth, scenario)).collect();
        let settings =
            CrushFit { dt_s: 1e-3, prior_weight: 1e-3, impulse_weight: 1.0, max_steps: 15 };
        let mut costs = Vec::new();
        let fitted = prior.fit(&samples, settings, &mut |cost| {
            costs.push(cost);
            ControlFlow::Continue(())
        });
        let fitted = fitted.unwrap();
        assert!(costs.last().unwrap() < &(costs[0] / 100.0), "{costs:?}");
        // Different parameters can compensate for each other, so the fit is judged by a collision
        // that is not among the samples.
        let unseen =
            CrushScenario { relative_velocity_m_s: [0.7, 2.6], theta_b_rad: 0.27, ..example() };
        let impulse = |law: &CrushLaw| sample(law, unseen.clone()).fy_n.iter().sum::<f64>();
        let (got, known) = (impulse(&fitted), impulse(&truth));
        assert!((got / known - 1.0).abs() < 0.02, "{got} {known}, prior {}", impulse(&prior));
    }

    /// Parameters of a body are not tried on collisions of the others.
    #[test]
    fn one_moved_parameter_gives_the_residuals_of_all_computed_anew() {
        let law = law();
        let scenarios = [None, Some(0), Some(1)]
            .map(|struck_body_idx| CrushScenario { struck_body_idx, ..example() });
        let samples = scenarios.map(|scenario| sample(&law, scenario));
        let settings =
            CrushFit { dt_s: 1e-3, prior_weight: 0.1, impulse_weight: 1.0, max_steps: 1 };
        let references = samples.iter().filter_map(|sample| Reference::new(sample, settings));
        let (prior, scales) = (law.to_vector(), law.scales());
        let problem = CrushProblem {
            law: &law,
            references: references.collect(),
            prior: &prior,
            scales: &scales,
            applies: law.applications(),
            prior_weight: 0.1,
        };
        let before = problem.residuals(&prior).unwrap();
        for idx in 0..prior.len() {
            let mut moved = prior.clone();
            moved[idx] += 0.1 * scales[idx];
            let all = problem.residuals(&moved);
            assert_eq!(problem.with_one_moved(&moved, idx, &before), all, "{idx}");
        }
    }

    #[test]
    fn nothing_to_fit_is_none() {
        let settings =
            CrushFit { dt_s: 1e-3, prior_weight: 1.0, impulse_weight: 1.0, max_steps: 1 };
        assert!(law().fit(&[], settings, &mut |_| ControlFlow::Continue(())).is_none());
    }
}
