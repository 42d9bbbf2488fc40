//! What a data sheet states that no car of its other figures has.

use crate::vehicle::sheet::{DataSheet, Rule, SheetQuantity as Q, VehicleClass};

use super::rules::is_model;

/// How many standard deviations of its rule a stated value lies away from it at least.
const FAR: f64 = 4.0;

/// Factor between a stated value and its rule at least: that of miles and kilometres. Vehicles of the library
/// stay within 1.2; a pound for a kilogram and a diameter for a radius are beyond.
const FACTOR: f64 = 1.6;

/// The same of the mass of a van, which may carry its own weight; a pound for a kilogram is beyond that, too.
const LADEN_FACTOR: f64 = 2.0;

/// Width from which a vehicle is a truck or a bus, of which the rules know nothing, m.
const TRUCK_WIDTH_M: f64 = 2.2;

/// Mass up to which a vehicle of unknown size is a car or a van, kg.
const CAR_MASS_KG: f64 = 3500.0;

/// What is compared where length or width is not known: what mass and axles decide.
const WITHOUT_SIZE: [Q; 2] = [Q::FrontShare, Q::YawInertia];

/// What is compared: what size, mass and axles of a car decide.
const COMPARED: [Q; 9] = [
    Q::Mass,
    Q::Wheelbase,
    Q::FrontShare,
    Q::Track,
    Q::FrontOverhang,
    Q::CgHeight,
    Q::YawInertia,
    Q::SprungMass,
    Q::WheelRadius,
];

/// A stated quantity that the rest of the sheet contradicts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unusual {
    /// Which quantity.
    pub quantity: Q,
    /// What is stated, SI.
    pub stated: f64,
    /// What its rule makes of the quantities before it, SI.
    pub by_rule: f64,
}

impl DataSheet {
    /// The stated quantities that lie far from what cars of that size have, as one in another unit does. Those
    /// of models of cars and of trucks are not judged. Of a sheet without length or width, what mass and axles decide
    /// is, where the mass is that of a car.
    pub fn unusual(&self) -> Vec<Unusual> {
        let sized = self.known(Q::Length).and(self.known(Q::Width));
        let values = self.resolve(|_, _| {});
        let is_truck = match sized {
            Some(width_m) => width_m > TRUCK_WIDTH_M,
            None => self.known(Q::Mass).is_none_or(|mass_kg| mass_kg > CAR_MASS_KG),
        };
        if is_truck || is_model(self.class, &values) {
            return Vec::new();
        }
        let compared = if sized.is_some() { &COMPARED[..] } else { &WITHOUT_SIZE[..] };
        let judge = |quantity: Q| {
            let stated = self.known(quantity)?;
            let rule = Rule::new(quantity, self.class, self.drive, &values);
            let by_rule = rule.median;
            let is_laden = quantity == Q::Mass && self.class == VehicleClass::Van;
            let above = if is_laden { LADEN_FACTOR } else { FACTOR };
            let is_by_factor = !(by_rule / FACTOR..=by_rule * above).contains(&stated);
            let is_far = stated < rule.at(-FAR) || stated > rule.at(FAR);
            let is_wider = quantity == Q::Track && sized.is_some_and(|width_m| stated >= width_m);
            (is_wider || is_by_factor && is_far).then_some(Unusual { quantity, stated, by_rule })
        };
        compared.iter().copied().filter_map(judge).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::LibraryVehicle;

    #[test]
    fn a_figure_in_another_unit_is_found() {
        let car = || {
            DataSheet::new("car", VehicleClass::Any)
                .with(Q::Mass, 1500.0)
                .with(Q::Length, 4.7)
                .with(Q::Width, 1.8)
        };
        assert_eq!(car().unusual(), []);
        // Kilograms as pounds, the length as wheelbase, a distance from the rear axle, half the track, one that is
        // wider than the car, the height of the roof, digits that are lost, and a diameter.
        for (quantity, value) in [
            (Q::Mass, 680.4),
            (Q::Wheelbase, 4.7),
            (Q::FrontShare, 0.28),
            (Q::Track, 0.75),
            (Q::Track, 1.85),
            (Q::CgHeight, 1.4),
            (Q::YawInertia, 250.0),
            (Q::SprungMass, 150.0),
            (Q::WheelRadius, 0.62),
        ] {
            let found = car().with(quantity, value).unusual();
            let quantities: Vec<Q> = found.iter().map(|unusual| unusual.quantity).collect();
            assert_eq!(quantities, [quantity], "{found:?}");
            assert_eq!(found[0].stated, value);
        }
        // What is known of a car by its mass alone.
        let unsized_car = DataSheet::new("car", VehicleClass::Any).with(Q::Mass, 1500.0);
        assert_eq!(unsized_car.unusual(), []);
        assert_eq!(unsized_car.with(Q::YawInertia, 250.0).unusual().len(), 1);
        // Loaded vans, a truck and a model of a car; and a van in pounds.
        let van = |mass_kg: f64, length_m: f64| {
            DataSheet::new("van", VehicleClass::Van)
                .with(Q::Mass, mass_kg)
                .with(Q::Length, length_m)
                .with(Q::Width, 1.99)
        };
        assert_eq!(van(2300.0 / 0.453_592_37, 5.93).unusual().len(), 1);
        let truck = car().with(Q::Mass, 18e3).with(Q::Length, 11.0).with(Q::Width, 2.5);
        let model = car().with(Q::Mass, 4.0).with(Q::Length, 0.6).with(Q::Width, 0.3);
        for sheet in [van(3500.0, 5.93), van(5500.0, 7.37), truck, model] {
            assert_eq!(sheet.unusual(), [], "{}", sheet.name);
        }
    }

    #[test]
    fn no_vehicle_of_the_library_is_unusual() {
        for vehicle in LibraryVehicle::ALL {
            let parameters = vehicle.parameters();
            let sheet = parameters.sheet.as_ref().unwrap();
            assert_eq!(sheet.unusual(), [], "{}", vehicle.id());
        }
    }
}
