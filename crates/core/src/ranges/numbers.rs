//! The ranges of quantities that files, options, fields and questions give.
//!
//! Sources: dimensions and masses of road vehicles in the European Union end at 18.75 m, 2.55 m and
//! 44 t (Directive 96/53/EC); the ranges leave room for others and, below, for models at a scale of
//! 1:10.

use std::f64::consts::PI;

use crate::ranges::{Range, RangeGroup};
use crate::units::Quantity;

/// Defines ranges as constants, with their meaning as documentation, and the group that lists them.
macro_rules! ranges {
    (
        $(#[$doc:meta])* $group:ident = $title:literal;
        $($constant:ident: $name:literal = $kind:ident($($limit:expr),+), $meaning:literal;)+
    ) => {
        $(
            #[doc = concat!("Range of “", $name, "”: ", $meaning, ".")]
            pub const $constant: Range = Range::$kind($name, $($limit),+, $meaning);
        )+
        $(#[$doc])*
        pub const $group: RangeGroup = RangeGroup { title: $title, ranges: &[$($constant),+] };
    };
}

ranges! {
    /// Motion of a vehicle, and the road.
    MOTION = "motion and road";
    SPEED: "speed" = real(Quantity::Speed, [-150.0, 150.0]),
        "speed or component of a velocity; negative backwards or to the right";
    YAW_RATE: "yaw rate" = real(Quantity::AngularVelocity, [-50.0, 50.0]),
        "yaw rate of a vehicle, positive to the left";
    HEADING: "angle" = real(Quantity::Angle, [-4.0 * PI, 4.0 * PI]),
        "heading of a vehicle or direction of a contact normal";
    POSITION: "position" = real(Quantity::Length, [-1e6, 1e6]),
        "coordinate of a vehicle in world axes";
    STEER_ANGLE: "steer angle" = real(Quantity::Angle, [-0.9, 0.9]),
        "angle of a road wheel; say an angle of the steering wheel as such, with the steering ratio";
    ROAD_FRICTION: "road friction" = real(Quantity::Ratio, [0.01, 2.0]),
        "peak friction between tire and road; 0.8 on dry asphalt, 0.1 on ice";
    ROAD_FRICTION_SIGMA: "uncertainty of the road friction" = real(Quantity::Ratio, [0.0, 0.5]),
        "standard deviation of the peak friction between tire and road; 0 if it is known exactly";
    ROAD_GRADE: "grade of the road" = real(Quantity::Ratio, [-0.3, 0.3]),
        "rise over run along X, positive uphill; 0.06 on steep main roads";
    ROAD_CROSS_SLOPE: "cross slope of the road" = real(Quantity::Ratio, [-0.3, 0.3]),
        "rise over run along Y, positive where the road rises to the left; 0.025 to 0.08 in bends";
}

ranges! {
    /// What brakes, drags and steers a vehicle after the impact.
    CONTROLS = "driver and damage";
    CONTROL_TIME: "start of a control" = real(Quantity::Time, [0.0, 3600.0]),
        "when brake, drag or steering begins, from the start of the motion";
    STEERING_WHEEL_ANGLE: "steering-wheel angle" = real(Quantity::Angle, [-25.0, 25.0]),
        "angle of the steering wheel, positive to the left";
    ROAD_WHEEL_RATE: "rate of the road wheels" = real(Quantity::AngularVelocity, [1e-3, 20.0]),
        "how fast the front wheels turn to an angle";
    STEERING_RATIO: "steering ratio" = real(Quantity::Ratio, [1.0, 40.0]),
        "angle of the steering wheel over that of the road wheels; 12 to 20 in cars";
    STEERING_RATIO_SIGMA: "uncertainty of the steering ratio" = real(Quantity::Ratio, [0.0, 10.0]),
        "standard deviation of the steering ratio; 0 if it is known exactly";
    BRAKE_SHARE: "braking" = real(Quantity::Ratio, [0.0, 3.0]),
        "braking force over the largest that the road can hold; more than 1 locks the wheels";
    BRAKED_BEFORE: "braking before the start" = real(Quantity::Time, [0.0, 20.0]),
        "how long a driver braked before the first mark";
    BRAKED_SHARE: "share of the friction" = real(Quantity::Ratio, [0.0, 1.0]),
        "braking force over the largest that the road can hold, without a mark";
    BRAKE_FRONT_SHARE: "front share of the braking" = real(Quantity::Ratio, [0.0, 1.0]),
        "share of the front axle in the braking force";
    BRAKE_RISE: "rise of a control" = real(Quantity::Time, [0.01, 60.0]),
        "time over which brake or steering reach their full value";
    DRAG_SHARE: "drag" = real(Quantity::Ratio, [0.0, 3.0]),
        "drag of a damaged wheel over the largest that the road can hold at its static load";
    BRAKE_TORQUE: "brake torque" = real(Quantity::Moment, [0.0, 100_000.0]),
        "torque of the brake of a wheel against its rotation";
    DRIVE_TORQUE: "drive torque" = real(Quantity::Moment, [0.0, 20_000.0]),
        "torque at the wheels of a driven axle together, forwards";
    ENGINE_BRAKING: "engine braking" = real(Quantity::Acceleration, [0.0, 5.0]),
        "deceleration that the engine causes on a straight course";
}

ranges! {
    /// Drivers that react to the motion of the vehicle, stability control and anti-lock system.
    DRIVERS = "drivers and stability control";
    ESC_FILTER: "filter of the stability control" = real(Quantity::Time, [0.0, 1.0]),
        "time constant by which the error of the yaw rate is smoothed";
    ESC_THRESHOLD: "threshold of the stability control" =
        real(Quantity::AngularVelocity, [0.01, 1.0]),
        "oversteer beyond which the stability control brakes; 4 to 8 deg/s in cars";
    ESC_OFF_SHARE: "release of the stability control" = real(Quantity::Ratio, [0.0, 1.0]),
        "share of the threshold below which the stability control lets go";
    ESC_SPEED: "lowest speed of the stability control" = real(Quantity::Speed, [0.0, 40.0]),
        "speed below which the stability control does nothing";
    ESC_ACCELERATION_SHARE: "limit of the reference yaw rate" = real(Quantity::Ratio, [0.1, 2.0]),
        "lateral acceleration that the driver may ask for over what the road holds";
    ESC_FULL_ERROR: "error of full braking" = real(Quantity::AngularVelocity, [0.01, 5.0]),
        "oversteer at which the stability control brakes as hard as it can";
    SLIP_RATIO: "slip of a braked wheel" = real(Quantity::Ratio, [0.02, 0.5]),
        "slip at which a wheel is held; 0.1 to 0.15 in cars";
    SIDESLIP: "side slip" = real(Quantity::Angle, [0.0, PI / 2.0]),
        "angle between the heading and the direction of the motion";
    REAR_BRAKE_SHARE: "rear share of the stability control" = real(Quantity::Ratio, [0.0, 1.0]),
        "braking of the outer rear wheel over that of the outer front wheel";
    DEAD_TIME: "dead time" = real(Quantity::Time, [0.0, 2.0]),
        "time from a command to the first force of the brake";
    PEAK_SHARE: "share of peak friction" = real(Quantity::Ratio, [0.1, 1.0]),
        "braking force that an anti-lock system allows over the largest that the road can hold";
    REACTION_TIME: "reaction time" = real(Quantity::Time, [0.0, 60.0]),
        "time from the first contact to the first reaction of the driver";
    SIDESLIP_GAIN: "steering by side slip" = real(Quantity::Ratio, [0.0, 10.0]),
        "steer angle of the road wheels over the side slip of the vehicle";
    YAW_RATE_GAIN: "steering by yaw rate" = real(Quantity::Time, [0.0, 5.0]),
        "steer angle of the road wheels over the yaw rate of the vehicle";
    LARGEST_STEERING_WHEEL_ANGLE: "largest steering-wheel angle" =
        real(Quantity::Angle, [0.0, 25.0]),
        "angle of the steering wheel to either side that the driver does not exceed";
    STEERING_WHEEL_RATE: "rate of the steering wheel" = real(Quantity::AngularVelocity, [0.1, 50.0]),
        "angular velocity of the steering wheel that the driver does not exceed";
    PIT_START: "start of the turn" = real(Quantity::Time, [-2.0, 60.0]),
        "when the striking driver begins to turn the steering wheel, after the first contact";
    THROTTLE_LIMIT: "largest acceleration" = real(Quantity::Acceleration, [0.0, 15.0]),
        "acceleration of the vehicle alone that the engine allows";
    STRUCK_TURN: "turn of the struck vehicle" = real(Quantity::Angle, [0.0, 2.0 * PI]),
        "turn since the first contact at which the striking driver lets go";
}

ranges! {
    /// Instants and durations.
    TIMES = "times";
    INSTANT: "time" = real(Quantity::Time, [-1e10, 1e10]),
        "instant on the clock of a file; some clocks count the seconds since 1970";
    TIME_STEP: "time step" = real(Quantity::Time, [1e-9, 1e6]),
        "time between two samples of a file";
    REPLAY_START: "start of a replay" = real(Quantity::Time, [-60.0, -0.1]),
        "instant on the clock of a recorder from which on its samples are followed";
    SIMULATED_DURATION: "duration" = real(Quantity::Time, [0.01, 3600.0]),
        "duration of a simulation";
    FORECAST_DURATION: "duration of a forecast" = real(Quantity::Time, [0.1, 60.0]),
        "duration of a motion that the response network predicts";
    REST_LIMIT: "time to rest" = real(Quantity::Time, [0.1, 120.0]),
        "time after which a predicted motion is followed no further to rest";
    LOG_DURATION: "duration of a log" = real(Quantity::Time, [0.1, 600.0]),
        "part of a log after the first contact that is learned from";
    WINDOW: "window" = real(Quantity::Time, [0.0, 120.0]),
        "start or end of the time over which a density is averaged";
    PULSE_DURATION: "pulse duration" = real(Quantity::Time, [0.001, 2.0]),
        "time over which the impulse of a scenario is spread";
}

ranges! {
    /// The contact of two vehicles.
    CONTACT = "contact";
    CONTACT_X: "contact x" = real(Quantity::Length, [-30.0, 30.0]),
        "contact point ahead of the CG, in body axes";
    CONTACT_Y: "contact y" = real(Quantity::Length, [-10.0, 10.0]),
        "contact point to the left of the CG, in body axes";
    CONTACT_HEIGHT: "contact height" = real(Quantity::Length, [0.0, 5.0]),
        "height of the contact point above the ground";
    CONTACT_OFFSET: "contact offset" = real(Quantity::Length, [-50.0, 50.0]),
        "touching point from the middle of the struck side";
    CONTACT_COORDINATE: "contact coordinate" = real(Quantity::Length, [-100.0, 100.0]),
        "contact point of a scenario from the CG of the struck vehicle, in its body axes";
    STRIKING_OFFSET: "position of the striking vehicle" = real(Quantity::Length, [-100.0, 100.0]),
        "CG of the striking vehicle from the CG of the struck vehicle at first contact";
    OFF_OUTLINE: "distance from the outline" = real(Quantity::Ratio, [0.0, 0.1]),
        "distance of a contact point outside a vehicle, as a share of the vehicle's length";
    RESTITUTION: "restitution" = real(Quantity::Ratio, [0.0, 1.0]),
        "coefficient of restitution along the contact normal";
    FRICTION_LIMIT: "friction limit" = real(Quantity::Ratio, [0.0, 10.0]),
        "largest ratio of tangential to normal impulse between the vehicles";
    FRICTION_OF_CRITICAL: "friction of critical" = real(Quantity::Ratio, [0.0, 1.0]),
        "friction limit as a share of the impulse ratio at which the vehicles just stop sliding";
}

ranges! {
    /// Bodies that collide: vehicles, and fixed barriers as very heavy ones.
    BODIES = "bodies of a collision";
    BODY_MASS: "mass of a body" = real(Quantity::Mass, [1.0, 1e8]),
        "mass in a collision; a fixed barrier is a very heavy body";
    BODY_YAW_INERTIA: "yaw inertia of a body" = real(Quantity::MomentOfInertia, [1e-3, 1e10]),
        "yaw moment of inertia about the CG";
    BODY_LENGTH: "length of a body" = real(Quantity::Length, [0.1, 100.0]), "outer length";
    BODY_WIDTH: "width of a body" = real(Quantity::Length, [0.05, 20.0]), "outer width";
    BODY_CG: "CG of a body" = real(Quantity::Length, [0.0, 100.0]),
        "distance from the front end back to the CG, at most the length";
}

ranges! {
    /// The parameters of a vehicle file.
    VEHICLE = "vehicle file";
    VEHICLE_MASS: "mass" = real(Quantity::Mass, [1.0, 50_000.0]), "whole mass";
    SPRUNG_MASS: "sprung mass" = real(Quantity::Mass, [0.5, 50_000.0]),
        "sprung mass, at most the whole mass";
    VEHICLE_YAW_INERTIA: "yaw inertia" = real(Quantity::MomentOfInertia, [1e-3, 1e6]),
        "yaw moment of inertia about the CG";
    ROLL_INERTIA: "roll inertia" = real(Quantity::MomentOfInertia, [1e-3, 1e5]),
        "roll moment of inertia about the roll axis";
    ROLL_YAW_PRODUCT: "roll-yaw product" = real(Quantity::MomentOfInertia, [-1e6, 1e6]),
        "product of inertia, in size at most 0.95 of the geometric mean of both moments";
    CG_TO_AXLE: "CG to axle" = real(Quantity::Length, [0.05, 10.0]),
        "distance from the CG to an axle";
    TRACK_WIDTH: "track width" = real(Quantity::Length, [0.05, 4.0]),
        "distance between the wheels of an axle";
    CG_HEIGHT: "CG height" = real(Quantity::Length, [0.01, 3.0]), "height of the CG";
    OUTER_LENGTH: "outer length" = real(Quantity::Length, [0.1, 25.0]), "length of the body";
    OUTER_WIDTH: "outer width" = real(Quantity::Length, [0.05, 4.0]), "width of the body";
    CG_TO_FRONT_END: "CG to front end" = real(Quantity::Length, [0.0, 25.0]),
        "distance from the CG to the front end, at most the outer length";
    ROLL_AXIS_HEIGHT: "roll axis height" = real(Quantity::Length, [-1.0, 2.0]),
        "height of the roll axis below the CG above the ground";
    ROLL_ARM: "roll arm" = real(Quantity::Length, [0.0, 3.0]),
        "distance from the roll axis to the CG of the sprung mass";
    CRUSH_ONSET: "crush onset" = real(Quantity::ForcePerLength, [0.0, 1e7]),
        "load over the width of a face at which it begins to crush, A";
    CRUSH_STIFFNESS: "crush stiffness" = real(Quantity::ForcePerArea, [1e3, 1e9]),
        "growth of that load with the depth of the crush, B";
    CRUSH_DEPTH: "crush depth" = real(Quantity::Length, [0.0, 5.0]),
        "depth to which a face is crushed";
    ROLL_STIFFNESS: "roll stiffness" = in_unit("N m/rad", [1.0, 1e7]),
        "roll stiffness of both axles";
    ROLL_DAMPING: "roll damping" = in_unit("N m s/rad", [0.0, 1e6]), "roll damping";
    FRONT_ROLL_SHARE: "front roll stiffness share" = real(Quantity::Ratio, [0.0, 1.0]),
        "share of the front axle in the roll stiffness";
    CORNERING_COEFFICIENT: "cornering coefficient" = in_unit("1/rad", [1.0, 60.0]),
        "cornering stiffness over vertical load";
    SLIDING_FRICTION_RATIO: "sliding friction ratio" = real(Quantity::Ratio, [0.1, 1.0]),
        "sliding friction over peak friction";
    LONGITUDINAL_FRICTION_RATIO: "longitudinal friction ratio" = real(Quantity::Ratio, [0.5, 2.0]),
        "friction of a wheel along its plane over that across it";
    ROLLING_RADIUS: "rolling radius" = real(Quantity::Length, [0.02, 1.0]),
        "rolling radius of the tires";
    WHEEL_INERTIA: "wheel inertia" = in_unit("kg m²", [0.0, 100.0]),
        "moment of inertia of a wheel with its tire about its axis";
    ROLLING_RESISTANCE: "rolling resistance" = real(Quantity::Ratio, [0.0, 0.5]),
        "rolling resistance over vertical load";
    ROLLING_RESISTANCE_PER_SPEED: "rolling resistance per speed" = in_unit("s/m", [0.0, 0.01]),
        "part of the rolling resistance that grows with the speed";
    ROLLING_RESISTANCE_PER_SPEED_2: "rolling resistance per speed²"
        = in_unit("s²/m²", [0.0, 0.001]),
        "part of the rolling resistance that grows with the square of the speed";
}

ranges! {
    /// What a data sheet states beside the parameters of a vehicle file.
    DATA_SHEET = "data sheet of a car";
    WHEELBASE: "wheelbase" = real(Quantity::Length, [0.1, 20.0]), "distance between the axles";
    FRONT_OVERHANG: "front overhang" = real(Quantity::Length, [0.0, 5.0]),
        "distance from the front axle to the front end";
    FRONT_LOAD_SHARE: "front share" = real(Quantity::Ratio, [0.2, 0.85]),
        "share of the front axle in the weight";
    STATIC_STABILITY_FACTOR: "static stability factor" = real(Quantity::Ratio, [0.5, 3.0]),
        "half the track over the height of the CG";
    WHEEL_RADIUS: "wheel radius" = real(Quantity::Length, [0.03, 1.0]),
        "rolling radius of the wheels";
    ROLL_GRADIENT: "roll gradient" = in_unit("deg/g", [0.5, 30.0]),
        "steady roll angle over lateral acceleration";
    ROLL_DAMPING_RATIO: "roll damping ratio" = real(Quantity::Ratio, [0.0, 3.0]),
        "damping ratio of the roll motion";
    DRAG_AREA: "drag area" = in_unit("m²", [0.0, 15.0]), "drag coefficient times frontal area";
}

ranges! {
    /// Columns of time series; speeds, times and steer angles have the ranges above. A value
    /// outside means that its unit is wrong; values that are merely unusual are flagged by
    /// `impactlab check`.
    CHANNELS = "columns of time series";
    FORCE_SAMPLE: "force" = real(Quantity::Force, [-2e7, 2e7]),
        "heavy trucks against rigid barriers reach a few MN";
    MOMENT_SAMPLE: "moment" = real(Quantity::Moment, [-1e8, 1e8]),
        "moment of the contact force";
    ACCELERATION_SAMPLE: "acceleration" = real(Quantity::Acceleration, [-1e6, 1e6]),
        "acceleration of a vehicle";
    ANGULAR_VELOCITY_SAMPLE: "angular velocity" = real(Quantity::AngularVelocity, [-200.0, 200.0]),
        "rate of yaw or roll";
    ANGLE_SAMPLE: "angle" = real(Quantity::Angle, [-1e4, 1e4]),
        "yaw or roll, counted over whole turns";
    LENGTH_SAMPLE: "position" = real(Quantity::Length, [-2e7, 2e7]),
        "coordinates of national grids reach 10⁷ m";
}

ranges! {
    /// What a question asks for.
    QUESTIONS = "questions";
    DRAWS: "draws" = whole([1, 10_000]), "force histories that are drawn for a forecast";
    VEHICLE_DRAWS: "vehicle draws" = whole([0, 10_000]),
        "vehicles that are drawn from the estimates of a data sheet; 0 takes their medians";
    REPLAY_DRAWS: "draws of a replay" = whole([50, 5000]),
        "draws from which the interval of a replay follows";
    SAMPLES: "samples" = whole([0, 10_000]), "whole force curves that are drawn";
    FOLDS: "folds" = whole([2, 1000]),
        "parts of a cross-validation, at most as many as there are cases";
    CHOICES: "choices" = whole([1, 1000]), "choices of the trajectories in a comparison";
    TRAJECTORIES: "trajectories" = whole([1, 1_000_000]), "trajectories to learn from";
    TRAJECTORY_SETS: "numbers of trajectories" = whole([1, 100]),
        "how many numbers of trajectories a comparison tries";
    RECONSTRUCTION_PARTICLES: "particles" = whole([50, 100_000]),
        "particles of a reconstruction";
    EPOCHS: "epochs" = whole([1, 100_000]), "passes over the training cases";
    TEST_SHARE: "test share" = real(Quantity::Ratio, [0.0, 0.9]),
        "share of the cases that is kept for the test";
}

ranges! {
    /// The evidence of a reconstruction.
    EVIDENCE = "evidence of a reconstruction";
    EVIDENCE_POSITION: "position of evidence" = real(Quantity::Length, [-2000.0, 2000.0]),
        "coordinate of a rest position, a mark or a position in a video, from the impact";
    EVIDENCE_HEADING: "heading of evidence" = real(Quantity::Angle, [-2.0 * PI, 2.0 * PI]),
        "heading against that of the struck car before the impact; whole turns do not count";
    EVIDENCE_SPEED: "speed of evidence" = real(Quantity::Speed, [0.0, 150.0]),
        "speed before the impact";
    POSITION_SIGMA: "standard deviation of a position" = real(Quantity::Length, [0.001, 100.0]),
        "how well a position was measured; nothing is measured exactly";
    ANGLE_SIGMA: "standard deviation of an angle" = real(Quantity::Angle, [0.0001, PI]),
        "how well an angle was measured";
    SPEED_SIGMA: "standard deviation of a speed" = real(Quantity::Speed, [0.001, 50.0]),
        "how well a speed was measured";
    MASS_SIGMA: "standard deviation of a mass" = real(Quantity::Mass, [0.01, 10_000.0]),
        "how well a mass is known";
    SCALE_SIGMA: "standard deviation of a scale" = real(Quantity::Ratio, [1e-4, 0.2]),
        "error that two masses share, as a share of them";
    FRICTION_SIGMA: "standard deviation of friction" = real(Quantity::Ratio, [0.001, 1.0]),
        "how well the friction of the road is known";
    RECORDED_SPEED_SIGMA: "uncertainty of a recorded speed" = real(Quantity::Ratio, [0.0, 0.5]),
        "standard deviation of the speed of a recorder, as a share of it";
    SKID_LENGTH: "length of a skid" = real(Quantity::Length, [0.1, 500.0]),
        "distance over which a car skidded to the first contact";
    EVIDENCE_TIME: "time of evidence" = real(Quantity::Time, [0.0, 60.0]),
        "time from the start of the motion";
    PULSE_END: "end of a recorded pulse" = real(Quantity::Time, [0.005, 5.0]),
        "time after the first contact at which a recorder ends";
}

ranges! {
    /// Calculations by hand.
    HAND = "hand methods";
    HAND_DRAWS: "draws of the inputs" = whole([1000, 1_000_000]),
        "draws from which the interval of a calculation by hand follows";
    HAND_GRADE: "grade by hand" = real(Quantity::Ratio, [-0.5, 0.5]),
        "rise over run of a road along or across the path";
    HAND_DISTANCE: "distance by hand" = real(Quantity::Length, [0.0, 2000.0]),
        "distance over which a vehicle slides, flies or drives";
    HAND_COORDINATE: "point of a yaw mark" = real(Quantity::Length, [-2e7, 2e7]),
        "coordinate of a point of a tire mark";
    MARK_CHORD: "chord" = real(Quantity::Length, [0.5, 500.0]), "chord of a curved tire mark";
    MIDDLE_ORDINATE: "middle ordinate" = real(Quantity::Length, [0.001, 100.0]),
        "height of a curved mark above the middle of its chord";
    MARK_RADIUS: "radius of a mark" = real(Quantity::Length, [1.0, 10_000.0]),
        "radius of a curved tire mark";
    MARK_TO_CG: "mark to CG" = real(Quantity::Length, [-3.0, 3.0]),
        "how much smaller the radius of the path of the CG is than that of the mark";
    FRICTION_SHARE: "share of the friction" = real(Quantity::Ratio, [0.0, 1.0]),
        "drag of a vehicle over that of one with all wheels locked";
    LAUNCH_ANGLE: "launch angle" = real(Quantity::Angle, [-1.2, 1.2]),
        "direction at take-off above the horizontal";
    HAND_DROP: "drop" = real(Quantity::Length, [-100.0, 500.0]),
        "how far the CG lies lower where it lands than where it takes off";
    HAND_DECELERATION: "deceleration by hand" = real(Quantity::Acceleration, [0.1, 20.0]),
        "mean deceleration of a braking vehicle";
    HAND_ENERGY: "energy by hand" = real(Quantity::Energy, [0.0, 1e8]),
        "energy that a vehicle has taken up by crush";
    HAND_RESTITUTION: "restitution by hand" = real(Quantity::Ratio, [0.0, 0.9]),
        "coefficient of restitution of a calculation from crush";
    PDOF_OFF_NORMAL: "angle of force" = real(Quantity::Angle, [-1.4, 1.4]),
        "principal direction of force from the normal of the crushed face";
    MASS_FACTOR: "effective mass" = real(Quantity::Ratio, [0.05, 1.0]),
        "share of a mass that acts at the point of the force; 1 in a central impact";
    FORMULA_FACTOR: "factor of the formula" = real(Quantity::Ratio, [0.2, 5.0]),
        "speed over what the formula gives";
}

ranges! {
    /// The ground of a scene.
    SITE = "site file";
    SURVEY_COORDINATE: "coordinate of the ground" = real(Quantity::Length, [-2e7, 2e7]),
        "coordinates of national grids reach 10⁷ m";
    SITE_AZIMUTH: "azimuth of X" = real(Quantity::Angle, [-2.0 * PI, 2.0 * PI]),
        "direction of X, clockwise from grid north";
    LATITUDE: "latitude" = real(Quantity::Angle, [-PI / 2.0, PI / 2.0]),
        "positive to the north";
    LONGITUDE: "longitude" = real(Quantity::Angle, [-PI, PI]),
        "positive to the east";
    PIXEL_COORDINATE: "point of an orthophoto" = in_unit("px", [0.0, 1e6]),
        "column or row, counted from the left top corner of the picture";
    PIXEL_SIZE: "pixel of an orthophoto" = real(Quantity::Length, [0.0005, 100.0]),
        "side of a pixel on the ground";
    SITE_DISTANCE: "distance on the ground" = real(Quantity::Length, [0.05, 1e5]),
        "distance between two points of an orthophoto";
    LANE_WIDTH: "lane width" = real(Quantity::Length, [0.5, 50.0]), "width of a lane";
}

ranges! {
    /// Pictures.
    PICTURES = "pictures";
    PICTURE_SIDE: "picture side" = whole([16, 16_384]), "width or height of a picture in pixels";
    PICTURE_PIXELS: "pixels of a picture" = whole([256, 40_000_000]),
        "width times height; as many take 1 GB of memory while they are drawn";
    PICTURE_SCALE: "picture scale" = real(Quantity::Ratio, [0.25, 8.0]), "pixels per point";
    CAMERA_AZIMUTH: "camera azimuth" = real(Quantity::Angle, [-2.0 * PI, 2.0 * PI]),
        "direction from the scene to the camera, counter-clockwise from X";
    CAMERA_ELEVATION: "camera elevation" = real(Quantity::Angle, [0.035, 1.56]),
        "height of the camera above the horizon of what it looks at";
    CAMERA_DISTANCE: "camera distance" = real(Quantity::Length, [2.0, 20_000.0]),
        "distance of the camera from what it looks at";
    GHOSTS: "ghosts" = whole([0, 200]), "paths that are drawn from a forecast into a scene";
    FILM_SIDE: "film side" = whole([64, 3840]),
        "width or height of a film in pixels, even; 3840 × 2160 is the largest film";
    FILM_RATE: "frames per second" = whole([1, 120]), "frames of a film in a second of its time";
    FILM_SPEED: "speed of a film" = real(Quantity::Ratio, [0.001, 100.0]),
        "seconds of the scene that a film plays in a second; 0.1 is slow motion";
    FILM_FRAMES: "frames of a film" = whole([2, 36_000]),
        "frames of a whole film; 36000 are 20 minutes at 30 in a second";
}
