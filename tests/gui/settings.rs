//! Settings of networks that are trained within seconds.

/// A force network. Ends with the section of the network, so that more of its keys may follow.
pub const SMALL_FORCE: &str = "\
[network]
encoder_branches = [[8, 8, 8]]
position_channels = 8
attention = false
trunk = [16, 16]
factors = 2
";

/// The fit of the crush model to a force data set, quick and rough.
pub const QUICK_CRUSH: &str = "\
[crush]
folds = 2
max_steps = 2
";

/// A response network.
pub const SMALL_RESPONSE: &str = "\
[network]
encoder = [8]
token_encoder = [4, 4, 4]
attention_heads = 2
trunk = [8]
components = 2
[pretraining]
motions = 4
epochs = 2
[single_steps]
epochs = 2
[rollouts]
lengths = [5]
epochs = 2
[calibration]
folds = 2
[tuning]
iterations = 2
particles = 4
";
