//! The ranges of all settings of both networks and their trainings. A setting with several numbers
//! has one range for each of them and, where their number is free, one for how many there are.

use crate::ranges::{Range, RangeGroup};
use crate::units::Quantity;

const WIDTH: [u64; 2] = [1, 4096];
const LAYERS: [u64; 2] = [1, 32];
const EPOCHS: [u64; 2] = [1, 100_000];
const WEIGHT: [f64; 2] = [0.0, 1e6];
const LEARNING_RATE: [f64; 2] = [1e-9, 1.0];
const PEAK: [f64; 2] = [0.0, 10.0];

const fn count(name: &'static str, limits: [u64; 2], meaning: &'static str) -> Range {
    Range::whole(name, limits, meaning)
}

const fn number(name: &'static str, limits: [f64; 2], meaning: &'static str) -> Range {
    Range::real(name, Quantity::Ratio, limits, meaning)
}

/// Settings of the force network.
pub const FORCE_SETTINGS: RangeGroup = RangeGroup {
    title: "settings of the force network",
    ranges: &[
        count("network.encoder_branches", WIDTH, "width of a layer of the encoder"),
        count("network.encoder_branches (number)", [1, 8], "branches of the encoder"),
        count("network.position_channels", [2, 1024], "channels of the positional encoding, even"),
        count("network.attention_channels", WIDTH, "channels of the attention over time"),
        count("network.attention_heads", [1, 64], "heads of the attention over time"),
        count("network.attention_stride", [1, 1000], "stride of the keys of the attention"),
        count("network.trunk", WIDTH, "width of a layer of the trunk"),
        count("network.trunk (number)", LAYERS, "layers of the trunk"),
        count("network.components", [1, 32], "components of the mixture"),
        count("network.factors", [0, 128], "latent factors per component"),
        number("network.shape_correction", [0.0, 0.99], "largest relative change of the shape"),
        number("network.force_correction", PEAK, "largest added force, peaks of the centre"),
        number("network.impulse_correction", [0.0, 2.0], "largest relative change of the impulse"),
        number("network.component_shift", PEAK, "largest shift of a mean, peaks of the centre"),
        number("network.hooking_shift", PEAK, "the same for the component of hooking"),
        Range::real("network.duration_max_s", Quantity::Time, [0.01, 10.0], "largest duration"),
        number("network.min_std", [1e-9, 10.0], "smallest standard deviation of a force"),
        number("loss.likelihood", WEIGHT, "weight of the likelihood"),
        number("loss.data", WEIGHT, "weight of the mean curve"),
        number("loss.impulse", WEIGHT, "weight of the impulse"),
        number("loss.energy", WEIGHT, "weight of the absorbed energy"),
        number("loss.duration", WEIGHT, "weight of the duration"),
        number("loss.hooking", WEIGHT, "weight of hooking"),
        count("training.epochs", EPOCHS, "epochs at most"),
        count("training.batch_cases", [1, 100_000], "cases per step"),
        number("training.learning_rate", LEARNING_RATE, "learning rate of AdamW"),
        number("training.weight_decay", [0.0, 100.0], "weight decay of AdamW"),
        number("training.max_gradient_norm", [1e-9, 1e9], "largest norm of the gradient"),
        number("training.validation_share", [0.0, 0.5], "share of the cases that decide to stop"),
        count("training.patience", [0, 100_000], "epochs without a better validation loss"),
        number("training.test_share", [0.0, 0.9], "share of the cases that is kept for the test"),
        count("training.checkpoint_epochs", EPOCHS, "epochs between checkpoints"),
        count("crush.folds", [2, 1000], "folds of the crush model"),
        number("crush.prior_weight", [1e-9, 1e6], "weight of the prior of the parameters"),
        number("crush.impulse_weight", [0.0, 1e6], "weight of the impulse beside the history"),
        number("crush.hooked_weight", [0.0, 1.0], "weight of hooked and unseparated cases"),
        count("crush.max_steps", [1, 100_000], "steps of each fit at most"),
    ],
};

/// Settings of the response network.
pub const RESPONSE_SETTINGS: RangeGroup = RangeGroup {
    title: "settings of the response network",
    ranges: &[
        count("network.encoder", WIDTH, "width of a layer of the encoder"),
        count("network.encoder (number)", LAYERS, "layers of the encoder"),
        count("network.token_encoder", WIDTH, "width of a layer of a vehicle token"),
        count("network.attention_heads", [1, 64], "heads of the attention, a divisor of the width"),
        count("network.trunk", WIDTH, "width of a layer of the trunk"),
        count("network.trunk (number)", LAYERS, "layers of the trunk"),
        count("network.components", [1, 32], "components of the mixture"),
        number("network.bound", [1e-6, 1e6], "bound of the correction, SI units"),
        number("network.unit", [1e-9, 1e6], "correction at an output of one, SI units"),
        number("network.min_std", [1e-9, 10.0], "smallest standard deviation after a step"),
        count("pretraining.motions", [1, 1_000_000], "simulated motions"),
        count("pretraining.epochs", [0, 100_000], "passes over the simulated motions"),
        number("pretraining.learning_rate", LEARNING_RATE, "learning rate of AdamW"),
        count("single_steps.epochs", [0, 100_000], "passes over the instants"),
        count("single_steps.batch_instants", [1, 1_000_000], "instants per step"),
        number("single_steps.learning_rate", LEARNING_RATE, "learning rate of AdamW"),
        number("single_steps.weight_decay", [0.0, 100.0], "weight decay of AdamW"),
        number("single_steps.max_gradient_norm", [1e-9, 1e9], "largest norm of the gradient"),
        number("single_steps.feature_noise", [0.0, 10.0], "noise that is added to the features"),
        number("single_steps.frozen_share", [0.0, 1.0], "share of the layers that is not changed"),
        count("rollouts.lengths", [1, 10_000], "steps of a rollout"),
        count("rollouts.lengths (number)", [0, 100], "stages of the rollouts"),
        count("rollouts.epochs", [0, 100_000], "passes over the trajectories per stage"),
        count("rollouts.batch_windows", [1, 100_000], "rollouts per step"),
        number("rollouts.learning_rate", LEARNING_RATE, "learning rate of AdamW"),
        count("rollouts.truncation", [1, 100_000], "steps of the gradient back in time"),
        number("loss.likelihood", WEIGHT, "weight of the likelihood"),
        number("loss.physics", WEIGHT, "weight of the physics"),
        number("loss.diversity", WEIGHT, "weight on components that coincide"),
        number("loss.trajectory", WEIGHT, "weight of the position of rollouts"),
        number("loss.smoothness", WEIGHT, "weight of the second derivative of rollouts"),
        number("loss.boundary", WEIGHT, "weight of states near what is physical"),
        number("physics.min", WEIGHT, "smallest weight of the physics"),
        number("physics.max", WEIGHT, "largest weight of the physics"),
        number("physics.midpoint_epoch", [-1e6, 1e6], "epoch at the middle of the change"),
        number("physics.epoch_scale", [1e-3, 1e6], "width of the change, epochs"),
        number("physics.quality_distance", [1e-6, 1e6], "distance over which data count"),
        count("physics.batch_instants", [0, 1_000_000], "simulated instants per step"),
        number("effects.ridge", [1e-12, 1e6], "ridge of the strengths"),
        number("effects.common", [0.0, 0.999_999], "how far strengths change together"),
        number("effects.huber", [1e-6, 1e6], "residual beyond which errors count linearly"),
        count("calibration.folds", [0, 1000], "trainings that calibrate; below 2 none"),
        number("calibration.prior_std", [1e-6, 1e3], "prior deviation of the scales"),
        count("tuning.particles", [1, 100_000], "particles of the swarm"),
        count("tuning.iterations", [0, 1_000_000], "moves of the swarm"),
        number("tuning.prior_weight", [0.0, 1e6], "how strongly the data sheet holds"),
        number("tuning.prior_std", [1e-6, 1e3], "expected deviation from the data sheet"),
    ],
};
