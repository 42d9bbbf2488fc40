//! The two vehicles of a reconstruction: what the evidence says of them, the rest by data sheet.

use std::collections::BTreeMap;

use crate::evidence::{CarEvidence, Evidence};
use impactlab_core::collision::Side;
use impactlab_core::numerics::NORMAL_QUANTILE_95;
use impactlab_core::vehicle::sheet::{Estimate, SheetQuantity};
use impactlab_core::vehicle::{DataSheet, RoadSlope, VehicleClass, VehicleParameters};

/// Share of the wheelbase behind the CG beyond which a flank is hit as in a PIT manoeuvre.
const PIT_SHARE: f64 = 0.2;

/// A vehicle at the medians of what is not known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Car {
    /// Its parameters, without the texts of their origin.
    pub parameters: VehicleParameters,
    scatter: BTreeMap<SheetQuantity, f64>,
}

/// The two vehicles.
#[derive(Debug, Clone, PartialEq)]
pub struct Cars {
    /// The one that was struck.
    pub struck: Car,
    /// The one that struck it.
    pub striking: Car,
}

impl Cars {
    /// The vehicles of a case.
    ///
    /// - `struck`, `striking`: vehicles whose values stand in where the evidence gives none; without
    ///   one, those of a data sheet of any car.
    pub fn new(
        evidence: &Evidence,
        struck: Option<&VehicleParameters>,
        striking: Option<&VehicleParameters>,
    ) -> Self {
        Self {
            struck: Car::new(&evidence.struck_car, struck),
            striking: Car::new(&evidence.striking_car, striking),
        }
    }

    /// The same cars on a road with a slope.
    #[must_use]
    pub fn on_slope(mut self, slope: RoadSlope) -> Self {
        for car in [&mut self.struck, &mut self.striking] {
            car.parameters.slope = slope;
        }
        self
    }

    /// Whether the struck car was hit on a flank and clearly behind its CG, as in a PIT manoeuvre.
    pub fn is_hit_behind_cg(&self, evidence: &Evidence) -> bool {
        let damage = &evidence.damage;
        let is_flank = matches!(damage.struck_side(), Side::Left | Side::Right);
        let wheelbase_m = self.struck.parameters.geometry.wheelbase_m();
        is_flank && damage.along().is_some_and(|along| along.value < -PIT_SHARE * wheelbase_m)
    }

    /// Distance of a side of the struck car from its CG, m, as a coordinate.
    pub fn depth_of(&self, side: Side) -> f64 {
        let geometry = &self.struck.parameters.geometry;
        match side {
            Side::Left => geometry.outer_width_m / 2.0,
            Side::Right => -geometry.outer_width_m / 2.0,
            Side::Front => geometry.cg_to_front_end_m,
            Side::Rear => geometry.cg_to_front_end_m - geometry.outer_length_m,
        }
    }
}

impl Car {
    fn new(evidence: &CarEvidence, vehicle: Option<&VehicleParameters>) -> Self {
        let sheet = match vehicle {
            None => DataSheet::new("car", VehicleClass::Any),
            Some(vehicle) => match &vehicle.sheet {
                Some(sheet) => DataSheet::clone(sheet),
                None => return Self::measured(evidence, vehicle),
            },
        };
        let sheet = completed(sheet, evidence);
        let scatter = sheet.estimates().into_iter().map(|estimate| {
            (
                estimate.quantity,
                (estimate.value.ninety()[1] / estimate.value.median).ln() / NORMAL_QUANTILE_95,
            )
        });
        let scatter = scatter.filter(|(_, sigma)| *sigma > 0.0).collect();
        Self { parameters: lean(sheet.vehicle()), scatter }
    }

    /// What the rules say of the quantities that evidence and vehicle leave open; nothing of a vehicle
    /// of which every parameter is known.
    pub fn estimates_of(
        evidence: &CarEvidence,
        vehicle: Option<&VehicleParameters>,
    ) -> Vec<Estimate> {
        Self::sheet_of(evidence, vehicle).map_or_else(Vec::new, |sheet| sheet.estimates())
    }

    /// The data sheet of a vehicle with what the evidence says of it; `None` of a vehicle of which every parameter is
    /// known.
    pub fn sheet_of(
        evidence: &CarEvidence,
        vehicle: Option<&VehicleParameters>,
    ) -> Option<DataSheet> {
        let sheet = match vehicle {
            None => Some(DataSheet::new("car", VehicleClass::Any)),
            Some(vehicle) => vehicle.sheet.as_deref().cloned(),
        };
        sheet.map(|sheet| completed(sheet, evidence))
    }

    /// A vehicle of which every parameter is known, with what the evidence says otherwise.
    fn measured(evidence: &CarEvidence, vehicle: &VehicleParameters) -> Self {
        let mass_kg = evidence.mass().map_or(vehicle.mass.mass_kg, |mass| mass.value);
        let mut parameters =
            lean(vehicle.clone()).scaled_to_mass(mass_kg, evidence.yaw_inertia_kg_m2);
        let geometry = &mut parameters.geometry;
        for (own, found) in [
            (&mut geometry.cg_to_front_axle_m, evidence.cg_to_front_axle_m),
            (&mut geometry.cg_to_rear_axle_m, evidence.cg_to_rear_axle_m),
            (&mut geometry.track_width_m, evidence.track_m),
            (&mut geometry.cg_height_m, evidence.cg_height_m),
            (&mut geometry.outer_length_m, evidence.length_m),
            (&mut geometry.outer_width_m, evidence.width_m),
        ] {
            *own = found.unwrap_or(*own);
        }
        Self { parameters, scatter: BTreeMap::new() }
    }

    /// Standard deviation of the logarithm of a quantity that is estimated; `None` if it is known.
    pub fn scatter(&self, quantity: SheetQuantity) -> Option<f64> {
        self.scatter.get(&quantity).copied()
    }

    /// Standard deviation of the logarithm of the mass; `None` if it is known. The rule of the data
    /// sheet estimates it from length and width, which may be estimates themselves and go together: long
    /// cars are wide.
    ///
    /// ```text
    /// m = c l w      σ² = σ_c² + (σ_l + σ_w)²
    /// ```
    ///
    /// For a car of which nothing is known this is 0.17; the cars of the library have 0.18.
    pub fn mass_scatter(&self) -> Option<f64> {
        let own = self.scatter(SheetQuantity::Mass)?;
        let size = [SheetQuantity::Length, SheetQuantity::Width];
        let size: f64 = size.into_iter().filter_map(|quantity| self.scatter(quantity)).sum();
        Some(own.hypot(size))
    }

    /// The quantities that are estimated.
    pub fn estimated(&self) -> impl Iterator<Item = SheetQuantity> {
        self.scatter.keys().copied()
    }
}

/// The sheet with what the evidence says of the car.
fn completed(mut sheet: DataSheet, evidence: &CarEvidence) -> DataSheet {
    use SheetQuantity as Q;
    if let (Some(front_m), Some(rear_m)) = (evidence.cg_to_front_axle_m, evidence.cg_to_rear_axle_m)
    {
        sheet.set(Q::Wheelbase, front_m + rear_m);
        sheet.set(Q::FrontShare, rear_m / (front_m + rear_m));
    }
    for (quantity, value) in [
        (Q::Mass, evidence.mass().map(|mass| mass.value)),
        (Q::Track, evidence.track_m),
        (Q::CgHeight, evidence.cg_height_m),
        (Q::Length, evidence.length_m),
        (Q::Width, evidence.width_m),
        (Q::YawInertia, evidence.yaw_inertia_kg_m2),
    ] {
        value.into_iter().for_each(|value| sheet.set(quantity, value));
    }
    sheet
}

/// The parameters alone, which are copied for each particle.
fn lean(vehicle: VehicleParameters) -> VehicleParameters {
    VehicleParameters {
        name: String::new(),
        source: String::new(),
        estimates: BTreeMap::new(),
        stated: BTreeMap::new(),
        sheet: None,
        ..vehicle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mass_of_a_car_is_known_by_scale_by_size_or_hardly() {
        let scatter = |evidence: &CarEvidence| Car::new(evidence, None).mass_scatter();
        let weighed = crate::evidence::Measured { value: 1500.0, sigma: 30.0 };
        let weighed = CarEvidence { mass_kg: Some(weighed.into()), ..CarEvidence::default() };
        assert_eq!(scatter(&weighed), None);
        let measured =
            CarEvidence { length_m: Some(4.4), width_m: Some(1.8), ..Default::default() };
        let by_size = scatter(&measured).expect("an estimate");
        let unknown = scatter(&CarEvidence::default()).expect("an estimate");
        assert!(by_size > 0.1 && unknown > 1.4 * by_size, "{by_size} {unknown}");
    }
}
