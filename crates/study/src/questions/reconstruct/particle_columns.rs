//! The particles of a reconstruction as columns of numbers, for tables and arrays.

use crate::ReconstructAnswer;
use impactlab_reconstruct::Latent;

impl ReconstructAnswer {
    /// Columns by name, with one number a particle: the quantities that are asked for, then those that are open
    /// beside them, then `log_likelihood`. A quantity that is asked for and open by itself stands there
    /// once.
    pub fn particle_columns(&self) -> Vec<(&'static str, Vec<f64>)> {
        let quantities = self.posterior.asked();
        let is_open = |latent: &Latent| quantities.iter().all(|of| of.key() != latent.key());
        let components = self.target.model().prior().components();
        let open = components.iter().map(|component| component.latent).filter(is_open);
        let of_open = |latent: Latent| {
            self.posterior.values.iter().map(|values| values.get(latent)).collect::<Vec<f64>>()
        };
        quantities
            .iter()
            .map(|quantity| (quantity.key(), self.posterior.values(*quantity)))
            .chain(open.map(|latent| (latent.key(), of_open(latent))))
            .chain([("log_likelihood", self.particles.log_likelihood.clone())])
            .collect()
    }
}
