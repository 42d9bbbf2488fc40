//! What is sampled.

/// A likelihood over standard normal variables.
///
/// ```text
/// p(z | E) ∝ N(z; 0, I) · L(z)
/// ```
///
/// Physical quantities are transformations of z, for example by their quantile functions, so that
/// the prior is always the same. A discrete question, such as which wheel is locked, is a threshold
/// on a component of z; the likelihood may be discontinuous there.
pub trait Target: Sync {
    /// Number of variables z. The prior of each is N(0, 1), independent of the others.
    fn dim(&self) -> usize;

    /// Natural logarithm of the likelihood of each particle, one entry for each, in their order.
    /// −∞ where the evidence is impossible; NaN counts as −∞.
    ///
    /// One call has many particles, which the implementation may evaluate side by side on all
    /// cores. The value of a particle must not depend on the others of the call.
    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64>;

    /// The same, and without each part of the evidence that can be left out.
    fn likelihoods(&self, z: &[Vec<f64>]) -> Vec<Likelihood> {
        let whole = self.log_likelihoods(z).into_iter();
        whole.map(|log| Likelihood { log, without: Vec::new() }).collect()
    }
}

/// How well a particle goes with the evidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Likelihood {
    /// Natural logarithm of the likelihood.
    pub log: f64,
    /// The same without each part of the evidence; as many entries for each particle of a target.
    pub without: Vec<f64>,
}
