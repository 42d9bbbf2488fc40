//! The rows: the network as configured, and variants of it with one part changed.

use impactlab_networks::force::{Centre, ForceConfig, LossWeights, NetworkConfig, TrainingConfig};

use crate::Answer;

/// The row that the others are compared with.
pub const SHIPPED: &str = "shipped";
/// The row of the physics alone.
pub const PHYSICS: &str = "physics";

/// A configuration to train.
pub struct Row {
    /// How it is chosen on the command line.
    pub name: &'static str,
    /// How it is called in a table.
    pub label: &'static str,
    pub config: ForceConfig,
    /// Whether contact point, position and body of the bullet are withheld from the prediction,
    /// which then knows only θ: masses, velocities and heading of the bullet.
    pub is_theta_alone: bool,
    /// Whether the body of the struck vehicle is withheld from the training.
    pub is_struck_body_withheld: bool,
}

/// The rows of some names in the order of the table; all of them without names.
pub fn chosen(config: &ForceConfig, names: &[String]) -> Answer<Vec<Row>> {
    let all = all(config);
    if let Some(name) = names.iter().find(|name| all.iter().all(|row| row.name != **name)) {
        let known: Vec<&str> = all.iter().map(|row| row.name).collect();
        return Err(format!("no row {name}; there are {}", known.join(", ")));
    }
    let is_chosen = |row: &Row| names.is_empty() || names.iter().any(|name| name == row.name);
    Ok(all.into_iter().filter(is_chosen).collect())
}

fn all(config: &ForceConfig) -> Vec<Row> {
    let row = |name, label, config| Row {
        name,
        label,
        config,
        is_theta_alone: false,
        is_struck_body_withheld: false,
    };
    let network = |name, label, change: fn(&mut NetworkConfig)| {
        let mut config = config.clone();
        change(&mut config.network);
        row(name, label, config)
    };
    let loss = |name, label, change: fn(&mut LossWeights)| {
        let mut config = config.clone();
        change(&mut config.loss);
        row(name, label, config)
    };
    let untrained = ForceConfig {
        training: TrainingConfig { epochs: 1, learning_rate: 1e-9, ..config.training },
        ..config.clone()
    };
    let theta = Row { is_theta_alone: true, ..row("theta", "the same, θ alone", config.clone()) };
    let one_struck_body = Row {
        is_struck_body_withheld: true,
        ..row("one-struck-body", "one kind of struck body", config.clone())
    };
    vec![
        row(SHIPPED, "as shipped, all columns", config.clone()),
        theta,
        one_struck_body,
        row(PHYSICS, "physics and its residuals alone, network untrained", untrained),
        network("no-attention", "without attention", |of| of.attention = false),
        network("no-factors", "independent instants (no latent factors)", |of| of.factors = 0),
        network("one-component", "one component", |of| of.components = 1),
        loss("no-data-loss", "without the loss of the mean curve", |of| of.data = 0.0),
        loss("no-impulse-loss", "without the loss of the impulse", |of| of.impulse = 0.0),
        loss("no-energy-loss", "without the loss of the energy", |of| of.energy = 0.0),
        loss("no-duration-loss", "without the loss of the duration", |of| of.duration = 0.0),
        loss("no-hooking-loss", "without the loss of hooking", |of| of.hooking = 0.0),
        loss("likelihood-alone", "likelihood alone", |of| {
            *of = LossWeights {
                likelihood: of.likelihood,
                data: 0.0,
                impulse: 0.0,
                energy: 0.0,
                duration: 0.0,
                hooking: 0.0,
            };
        }),
        network("small-trunk", "trunk of one layer of 16", |of| of.trunk = vec![16]),
        network("paper-trunk", "the paper's trunk of 8 layers", |of| {
            of.trunk = ForceConfig::paper().network.trunk;
        }),
        network("no-regressions", "crush model without regressions", |of| {
            of.centre = Centre::Crush;
        }),
        network("momentum", "momentum solution instead of crush model", |of| {
            of.centre = Centre::Momentum;
        }),
        network("no-physics", "without physics layer", |of| {
            of.centre = Centre::None;
            of.component_shift = 1.0;
        }),
    ]
}
