//! Pairs of vehicles for tests: without tires, so that only the contact acts, and on tires.

use crate::collision::Footprint;
use crate::collision::contact::{
    ContactBody, ContactConditions, ContactOutline, CoupledSettings, FaceLaw, FaceLaws, PairError,
    PairMotion, PairVehicle, VehiclePair,
};
use crate::data::Channel;
use crate::vehicle::{
    Ending, HeldSteer, LibraryVehicle, Manoeuvre, Motion, Preset, VehicleParameters, VehicleState,
};

/// A vehicle with its outline, its faces and what it does.
#[derive(Debug)]
pub struct TestCar {
    pub vehicle: VehicleParameters,
    pub outline: ContactOutline,
    pub faces: FaceLaws,
    pub manoeuvre: Manoeuvre,
}

/// A rigid body in the plane, on tires that hold nothing.
pub fn free_body(mass_kg: f64, yaw_inertia_kg_m2: f64, footprint: Footprint) -> VehicleParameters {
    let mut vehicle = on_level_tires(mass_kg, yaw_inertia_kg_m2, footprint);
    vehicle.tires.friction = 1e-12;
    vehicle
}

/// A vehicle that does not roll, on tires that roll without resistance.
pub fn on_level_tires(
    mass_kg: f64,
    yaw_inertia_kg_m2: f64,
    footprint: Footprint,
) -> VehicleParameters {
    let mut vehicle = Preset::Reference.parameters();
    vehicle.mass.mass_kg = mass_kg;
    vehicle.mass.sprung_mass_kg = 0.9 * mass_kg;
    vehicle.mass.yaw_inertia_kg_m2 = yaw_inertia_kg_m2;
    vehicle.mass.roll_yaw_product_kg_m2 = 0.0;
    vehicle.geometry.outer_length_m = footprint.length_m;
    vehicle.geometry.outer_width_m = footprint.width_m;
    vehicle.geometry.cg_to_front_end_m = footprint.cg_from_front_m;
    vehicle.suspension.roll_arm_m = 0.0;
    vehicle.suspension.roll_axis_height_m = 0.5;
    vehicle.tires.rolling_resistance = 0.0;
    vehicle.tires.rolling_resistance_s_m = 0.0;
    vehicle.tires.rolling_resistance_s2_m2 = 0.0;
    vehicle.tires.wheel_inertia_kg_m2 = 0.0;
    vehicle
}

/// The same law for all faces.
pub fn alike(law: FaceLaw) -> FaceLaws {
    FaceLaws { front: law, side: law, rear: law }
}

impl TestCar {
    pub fn new(
        vehicle: VehicleParameters,
        [corner_radius_m, longest_element_m]: [f64; 2],
        faces: FaceLaws,
        initial: VehicleState<f64>,
    ) -> Self {
        let footprint = Footprint::from(&vehicle.geometry);
        let outline = ContactOutline::new(footprint, corner_radius_m, longest_element_m).unwrap();
        let manoeuvre = Manoeuvre { initial, duration_s: 0.3, ..Manoeuvre::default() };
        Self { vehicle, outline, faces, manoeuvre }
    }

    pub fn in_pair(&self) -> PairVehicle<'_> {
        let body = ContactBody { outline: &self.outline, faces: self.faces };
        PairVehicle { vehicle: &self.vehicle, manoeuvre: &self.manoeuvre, body }
    }

    /// The same vehicle as seen in a mirror along X.
    pub fn mirrored(mut self) -> Self {
        self.manoeuvre.initial = mirrored(self.manoeuvre.initial);
        self
    }

    /// Momentum `[P_X, P_Y]`, N s, angular momentum about the origin, N m s, and planar energy, J.
    pub fn momentum(&self, x: &VehicleState<f64>) -> [f64; 4] {
        let mass = &self.vehicle.mass;
        let (sin, cos) = x.yaw_rad.sin_cos();
        let vx = x.vx_body_m_s * cos - x.vy_body_m_s * sin;
        let vy = x.vx_body_m_s * sin + x.vy_body_m_s * cos;
        let (m, inertia, rate) = (mass.mass_kg, mass.yaw_inertia_kg_m2, x.yaw_rate_rad_s);
        let energy = (m * (vx * vx + vy * vy) + inertia * rate * rate) / 2.0;
        [m * vx, m * vy, m * (x.x_m * vy - x.y_m * vx) + inertia * rate, energy]
    }
}

pub fn mirrored(x: VehicleState<f64>) -> VehicleState<f64> {
    VehicleState {
        vy_body_m_s: -x.vy_body_m_s,
        yaw_rad: -x.yaw_rad,
        yaw_rate_rad_s: -x.yaw_rate_rad_s,
        roll_rad: -x.roll_rad,
        roll_rate_rad_s: -x.roll_rate_rad_s,
        y_m: -x.y_m,
        ..x
    }
}

/// - `conditions`: their height is that of the roll axes, so that the contact makes no vehicle roll.
pub fn simulate(
    cars: [&TestCar; 2],
    conditions: ContactConditions,
    step_divisor: usize,
) -> Result<PairMotion, PairError> {
    let vehicles = cars.map(TestCar::in_pair);
    let height_m = cars[0].vehicle.suspension.roll_axis_height_m;
    let conditions = ContactConditions { height_m, ..conditions };
    let settings = CoupledSettings { step_divisor, ..CoupledSettings::default() };
    VehiclePair { vehicles, conditions, settings }.simulate()
}

/// A car that drives at 20 m/s and one beside its rear, which turns into it, for 1.5 s.
pub fn pit_manoeuvre(longest_element_m: f64) -> [TestCar; 2] {
    let car = |id, x_m, y_m, yaw_deg: f64, speed_m_s| {
        let vehicle = LibraryVehicle::from_id(id).unwrap().parameters();
        let faces = FaceLaws::by_class(&vehicle).unwrap();
        let yaw_rad = yaw_deg.to_radians();
        let initial =
            VehicleState { x_m, y_m, yaw_rad, ..VehicleState::driving_straight(speed_m_s) };
        let mut car = TestCar::new(vehicle, [0.25, longest_element_m], faces, initial);
        car.manoeuvre.duration_s = 1.5;
        car
    };
    let struck = car("toyota-camry-2018", 0.0, 0.0, 0.0, 20.0);
    let mut striking = car("ford-explorer-2020", -3.6, 2.3, -8.0, 21.0);
    let steer = HeldSteer { start_s: 0.0, rise_s: 0.3, road_wheel_rad: 0.03 };
    let ending = Ending { steer: Some(steer), ..Ending::default() };
    striking.manoeuvre.controls = ending.controls(&striking.vehicle);
    [struck, striking]
}

/// State at a sample of a motion.
pub fn state_at(motion: &Motion, sample: usize) -> VehicleState<f64> {
    use Channel as C;
    let at = |channel| motion.series.require(channel).unwrap()[sample];
    VehicleState {
        vx_body_m_s: at(C::Vx),
        vy_body_m_s: at(C::Vy),
        yaw_rad: at(C::Yaw),
        yaw_rate_rad_s: at(C::YawRate),
        roll_rad: at(C::Roll),
        roll_rate_rad_s: at(C::RollRate),
        x_m: at(C::X),
        y_m: at(C::Y),
    }
}

pub fn last_state(motion: &Motion) -> VehicleState<f64> {
    state_at(motion, motion.series.time_s().len() - 1)
}
