//! The learned correction of a vehicle whose contact force follows from its motion, such as that of two
//! vehicles that push each other.
//!
//! A predictor by itself takes the force as given and steps by 10 ms. Where the force is found along the
//! way, somebody else integrates the equations of motion with shorter steps, and asks here at the
//! beginning of each 10 ms for the residual acceleration over them:
//!
//! ```text
//! ẋ = f(x, u) + [a, 0]        a = b(x, u, t; z) + ε/h        z drawn once, ε at each step
//! ```
//!
//! with the bounded correction b of the response network at latent factors z. Time counts from the first
//! contact, as in the motions that were learned from; before it there is no correction.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::response::predict::dynamics::{Dynamics, NetworkBatch};
use crate::response::predict::predictor::normal;
use crate::response::{Correction, N_LATENTS, N_RESIDUAL, Predictor, STEP_S};
use impactlab_core::numerics::{index_of_share, random_stream};
use impactlab_core::vehicle::{VehicleInput, VehicleState};

/// The correction along one drawn motion.
pub struct CoupledDraw<'a> {
    dynamics: Dynamics<'a>,
    component: usize,
    latents: [f64; N_LATENTS],
    noise: Option<(ChaCha8Rng, f64)>,
    batch: NetworkBatch,
}

impl Predictor {
    /// Whether its network corrects accelerations, which a motion that somebody else integrates can take.
    pub fn corrects_accelerations(&self) -> bool {
        self.network.correction() == Correction::Acceleration
    }

    /// The correction with every latent factor at zero, without noise, of the middle component.
    pub fn coupled_median(&self) -> CoupledDraw<'_> {
        self.coupled_centre(self.n_components() / 2)
    }

    fn coupled_centre(&self, component: usize) -> CoupledDraw<'_> {
        CoupledDraw {
            dynamics: self.dynamics(),
            component: component.min(self.n_components().saturating_sub(1)),
            latents: [0.0; N_LATENTS],
            noise: None,
            batch: NetworkBatch::default(),
        }
    }

    /// A draw of the correction: a component, latent factors, and the noise of each step.
    ///
    /// - `role`: which vehicle of a pair it is, so that both are drawn independently;
    /// - `idx`: number of the draw.
    pub fn coupled_draw(&self, seed: u64, role: &str, idx: usize) -> CoupledDraw<'_> {
        let mut rng = random_stream(seed, &format!("coupled motions, {role}"), idx as u64);
        let n = self.n_components();
        let component = index_of_share(std::iter::repeat_n(1.0 / n as f64, n), rng.random());
        let shares = self.latents.component_shares(component, n);
        let width = self.latents.width(rng.random());
        let latents = std::array::from_fn(|m| {
            width * (shares[m].mean + shares[m].variance.sqrt() * normal(&mut rng))
        });
        CoupledDraw { latents, noise: Some((rng, width)), ..self.coupled_centre(component) }
    }
}

impl CoupledDraw<'_> {
    /// The residual acceleration over the coming step of [`STEP_S`]: v̇_x, v̇_y in m/s², ṙ, φ̈ in rad/s².
    ///
    /// - `u`: input over the step; its contact force is that of the step before where the coming one is
    ///   not known;
    /// - `time_s`: since the first contact, 0 or more.
    pub fn residual(
        &mut self,
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
        time_s: f64,
    ) -> [f64; N_RESIDUAL] {
        let Self { dynamics, component, latents, noise, batch } = self;
        let mut residual = dynamics.correction(*component, latents, x, u, time_s, batch);
        if let Some((rng, width)) = noise {
            let std = dynamics.noise([0, *component], batch);
            for (sum, std) in residual.iter_mut().zip(std) {
                *sum += *width * std * normal(rng) / STEP_S;
            }
        }
        residual
    }
}
