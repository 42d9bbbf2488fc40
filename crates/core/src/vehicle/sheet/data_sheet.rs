//! What is known of one car, and everything else by rule.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::numerics::NORMAL_QUANTILE_95;
use crate::units::{self, Interval};
use crate::vehicle::sheet::{Rule, SheetQuantity, VehicleClass};
use crate::vehicle::{CrushParameters, DrivenAxle, Equations, VehicleMismatch, VehicleParameters};

/// Largest number of standard deviations that an estimate is drawn from its median.
const MAX_LATENT: f64 = 2.6;

/// How often the latent factors are halved until the parameters go together.
const MAX_HALVINGS: usize = 12;

/// What is known of one car. Every other parameter is estimated by its [`Rule`], and follows what it
/// was estimated from: a sheet with another mass has another yaw inertia.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DataSheet {
    /// Name of the vehicle in lists and reports.
    pub name: String,
    /// Source of the values, as free text for the user.
    pub source: String,
    /// Form of the equations of motion.
    pub equations: Equations,
    /// Kind of vehicle.
    pub class: VehicleClass,
    /// Driven axle, if known; it says where the engine's weight is.
    pub drive: Option<DrivenAxle>,
    /// How stiff its faces are, as far as it is known.
    pub crush: CrushParameters,
    pub(super) known: BTreeMap<SheetQuantity, f64>,
    /// Roll stiffness, N m/rad, where it is known instead of the roll gradient.
    pub(super) roll_stiffness_n_m_rad: Option<f64>,
    /// Roll damping, N m s/rad, where it is known instead of the damping ratio.
    pub(super) roll_damping_n_m_s_rad: Option<f64>,
    /// Standard deviations of each estimate from its median; 0 where none is given.
    pub(super) latents: BTreeMap<SheetQuantity, f64>,
}

/// An estimated quantity with its rule and what it may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Estimate {
    /// Which quantity.
    pub quantity: SheetQuantity,
    /// Symbol of the unit.
    pub unit: &'static str,
    /// Median and interval of 90 %, in that unit, with the quantities that it follows from at their
    /// medians.
    #[serde(flatten)]
    pub value: units::Estimate,
    /// The rule in a few words.
    pub rule: &'static str,
    /// Where rule and scatter come from.
    pub source: &'static str,
}

/// Values of the quantities of a data sheet, known or estimated.
pub(super) struct SheetValues<'a> {
    sheet: &'a DataSheet,
    values: BTreeMap<SheetQuantity, f64>,
}

impl SheetValues<'_> {
    /// Value of a quantity that stands before the one that is asked about.
    pub(super) fn get(&self, quantity: SheetQuantity) -> f64 {
        self.values.get(&quantity).copied().unwrap_or(f64::NAN)
    }

    /// Value of a quantity if it is known, wherever it stands.
    pub(super) fn known(&self, quantity: SheetQuantity) -> Option<f64> {
        self.sheet.known(quantity)
    }

    /// Distances `[l_f, l_r]` from the CG to the axles, m.
    pub(super) fn axle_distances_m(&self) -> [f64; 2] {
        let (wheelbase, share) =
            (self.get(SheetQuantity::Wheelbase), self.get(SheetQuantity::FrontShare));
        [(1.0 - share) * wheelbase, share * wheelbase]
    }
}

impl DataSheet {
    /// A sheet of which only the class is known.
    pub fn new(name: impl Into<String>, class: VehicleClass) -> Self {
        Self { name: name.into(), class, ..Self::default() }
    }

    /// The same sheet with a known quantity, SI units. The value is not checked.
    pub fn with(mut self, quantity: SheetQuantity, value: f64) -> Self {
        self.set(quantity, value);
        self
    }

    /// Makes a quantity known. The value is not checked.
    pub fn set(&mut self, quantity: SheetQuantity, value: f64) {
        self.known.insert(quantity, value);
    }

    /// Leaves a quantity to its rule.
    pub fn forget(&mut self, quantity: SheetQuantity) {
        self.known.remove(&quantity);
        match quantity {
            SheetQuantity::RollGradient => self.roll_stiffness_n_m_rad = None,
            SheetQuantity::RollDampingRatio => self.roll_damping_n_m_s_rad = None,
            _ => {}
        }
    }

    /// Takes over a value that was stated elsewhere, as in a scenario. One that is the median of the
    /// estimate, from which the scenario has it, remains an estimate. The value is not checked.
    pub(in crate::vehicle) fn state(&mut self, quantity: SheetQuantity, value: f64) {
        let is_median = |estimate: &Estimate| {
            estimate.quantity == quantity && (value / estimate.value.median - 1.0).abs() < 1e-9
        };
        if !self.estimates().iter().any(is_median) {
            self.set(quantity, value);
        }
    }

    /// A quantity if it is known, SI units.
    pub fn known(&self, quantity: SheetQuantity) -> Option<f64> {
        self.known.get(&quantity).copied()
    }

    /// The quantities that are estimated, in the order in which one follows from those before it.
    pub fn estimated(&self) -> impl Iterator<Item = SheetQuantity> {
        SheetQuantity::ALL.iter().copied().filter(|&quantity| self.is_estimated(quantity))
    }

    fn is_estimated(&self, quantity: SheetQuantity) -> bool {
        let is_replaced = match quantity {
            SheetQuantity::RollGradient => self.roll_stiffness_n_m_rad.is_some(),
            SheetQuantity::RollDampingRatio => self.roll_damping_n_m_s_rad.is_some(),
            _ => false,
        };
        !is_replaced && !self.known.contains_key(&quantity)
    }

    /// Every estimate with its median, 90 % range and rule.
    pub fn estimates(&self) -> Vec<Estimate> {
        let sheet = Self { latents: BTreeMap::new(), ..self.clone() };
        let mut estimates = Vec::new();
        sheet.resolve(|quantity, rule| {
            let at = |latent: f64| bounded(quantity, rule.at(latent));
            let ninety =
                Interval { level: 0.9, low: at(-NORMAL_QUANTILE_95), high: at(NORMAL_QUANTILE_95) };
            estimates.push(Estimate {
                quantity,
                unit: quantity.unit(),
                value: units::Estimate { median: at(0.0), intervals: vec![ninety] },
                rule: rule.text,
                source: rule.source,
            });
        });
        estimates.retain(|estimate| self.is_estimated(estimate.quantity));
        estimates
    }

    /// The same car with its estimates away from their medians.
    ///
    /// - `latents`: for each estimate, in the order of [`DataSheet::estimated`], by how many standard
    ///   deviations; missing ones are zero, and each is limited to ±2.6.
    pub fn at(&self, latents: &[f64]) -> Self {
        let limited = latents.iter().map(|latent| latent.clamp(-MAX_LATENT, MAX_LATENT));
        Self { latents: self.estimated().zip(limited).collect(), ..self.clone() }
    }

    /// The parameters of the 4DOF vehicle, each estimate where [`DataSheet::at`] has put it, or at its
    /// median. Estimates that do not go with each other are moved towards their medians until
    /// they do.
    pub fn vehicle(&self) -> VehicleParameters {
        let mut sheet = self.clone();
        for _ in 0..MAX_HALVINGS {
            let vehicle = sheet.derive();
            if vehicle.is_consistent() {
                return vehicle.with_sheet(self);
            }
            sheet.latents.values_mut().for_each(|latent| *latent /= 2.0);
        }
        sheet.latents.clear();
        sheet.derive().with_sheet(self)
    }

    /// The first reason why the known values do not go together, with the estimates at their medians.
    ///
    /// # Errors
    /// [`VehicleMismatch`], which names the parameters.
    pub fn check_relations(&self) -> Result<(), VehicleMismatch> {
        Self { latents: BTreeMap::new(), ..self.clone() }.derive().check_relations()
    }

    /// Resolves every quantity in order, and tells the rule of those that are not known.
    pub(super) fn resolve(&self, mut report: impl FnMut(SheetQuantity, &Rule)) -> SheetValues<'_> {
        let mut values = SheetValues { sheet: self, values: BTreeMap::new() };
        for &quantity in SheetQuantity::ALL {
            let value = match self.known(quantity) {
                Some(value) => value,
                None => {
                    let rule = Rule::new(quantity, self.class, self.drive, &values);
                    report(quantity, &rule);
                    let latent = self.latents.get(&quantity).copied().unwrap_or(0.0);
                    bounded(quantity, rule.at(latent))
                }
            };
            values.values.insert(quantity, value);
        }
        values
    }
}

/// The value within the range of the quantity.
fn bounded(quantity: SheetQuantity, value: f64) -> f64 {
    let range = quantity.range();
    value.clamp(range.low, range.high)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use proptest::prelude::*;

    use super::*;
    use crate::vehicle::sheet::SheetQuantity as Q;

    fn car() -> DataSheet {
        DataSheet::new("car", VehicleClass::Car)
            .with(Q::Mass, 1450.0)
            .with(Q::Length, 4.55)
            .with(Q::Width, 1.78)
    }

    #[test]
    fn a_car_is_complete_with_mass_and_outer_size() {
        let vehicle = car().vehicle();
        assert_eq!(vehicle.check_relations(), Ok(()));
        assert_eq!(vehicle.mass.mass_kg, 1450.0);
        assert_eq!(vehicle.geometry.outer_length_m, 4.55);
        let (geometry, mass) = (&vehicle.geometry, &vehicle.mass);
        assert!((geometry.wheelbase_m() - 0.58 * 4.55).abs() < 1e-9, "{geometry:?}");
        let index = mass.yaw_inertia_kg_m2
            / (1450.0 * geometry.cg_to_front_axle_m * geometry.cg_to_rear_axle_m);
        assert!((index - 1.105).abs() < 1e-9, "{index}");
        assert_eq!(car().estimates().len(), Q::ALL.len() - 3);
        assert!(vehicle.estimates.contains_key("mass.yaw_inertia_kg_m2"));
        assert!(!vehicle.estimates.contains_key("mass.mass_kg"));
    }

    #[test]
    fn what_was_derived_from_the_mass_follows_it_and_what_was_measured_does_not() {
        let measured = car().with(Q::YawInertia, 2500.0);
        let (light, heavy) = (car().vehicle(), car().vehicle().with_mass(1900.0, None));
        let ratio = heavy.mass.yaw_inertia_kg_m2 / light.mass.yaw_inertia_kg_m2;
        assert!((ratio - 1900.0 / 1450.0).abs() < 1e-9, "{ratio}");
        assert_eq!(measured.vehicle().with_mass(1900.0, None).mass.yaw_inertia_kg_m2, 2500.0);
        let stated = car().vehicle().with_mass(1900.0, Some(3000.0));
        assert_eq!(stated.mass.yaw_inertia_kg_m2, 3000.0);
        assert!(!stated.estimates.contains_key("mass.yaw_inertia_kg_m2"));
        // What a scenario has from the estimate is no measurement.
        let inertia = car().with(Q::Mass, 1900.0).vehicle().mass.yaw_inertia_kg_m2;
        let repeated = car().vehicle().with_mass(1900.0, Some(inertia));
        assert!(repeated.estimates.contains_key("mass.yaw_inertia_kg_m2"));
        // A drawn car keeps its place in the scatter.
        let drawn = car().at(&[1.0; 30]).vehicle().with_mass(1900.0, None);
        let same = car().with(Q::Mass, 1900.0).at(&[1.0; 30]).vehicle();
        assert_eq!(drawn, same);
    }

    #[test]
    fn the_latent_factors_move_the_estimates_by_their_scatter() {
        let sheet = car();
        for (idx, estimate) in sheet.estimates().iter().enumerate() {
            let mut latents = vec![0.0; idx + 1];
            latents[idx] = NORMAL_QUANTILE_95;
            let moved = sheet.at(&latents);
            let value = moved.resolve(|_, _| {}).get(estimate.quantity);
            let (median, [low, high]) = (estimate.value.median, estimate.value.ninety());
            assert!((value / high - 1.0).abs() < 1e-9, "{estimate:?}: {value}");
            assert!(low < median && median < high);
        }
    }

    /// Share of the values that lie in the 90 % range of a rule, and their number.
    fn held(column: impl Fn(&[&str], &DataSheet) -> (Q, f64)) -> (f64, usize) {
        let text = std::fs::read_to_string(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../tests/data/vehicles/ncap-2004.csv"
        ))
        .unwrap();
        let rows: Vec<Vec<&str>> = text
            .lines()
            .filter(|line| !line.starts_with('#'))
            .skip(1)
            .map(|l| l.split(',').collect())
            .collect();
        let is_held = |row: &&Vec<&str>| {
            let number = |idx: usize| row[idx].parse::<f64>().unwrap();
            let class = VehicleClass::WORDS.iter().position(|word| *word == row[4]).unwrap();
            let sheet = DataSheet::new(row[2], VehicleClass::ALL[class])
                .with(Q::Mass, number(8) * 0.453_592_37)
                .with(Q::Wheelbase, number(7) * 0.0254)
                .with(Q::Track, (number(5) + number(6)) / 2.0 * 0.0254);
            let (quantity, value) = column(row, &sheet);
            let estimates = sheet.estimates();
            let estimate = estimates.iter().find(|e| e.quantity == quantity).unwrap();
            let [low, high] = estimate.value.ninety();
            (low..=high).contains(&value)
        };
        let n_held = rows.iter().filter(is_held).count();
        (n_held as f64 / rows.len() as f64, rows.len())
    }

    #[test]
    fn the_ranges_of_cg_height_and_front_share_hold_nine_of_ten_measured_vehicles() {
        let number = |text: &str| text.parse::<f64>().unwrap();
        let (height, n) = held(|row, _| (Q::CgHeight, number(row[10]) * 0.0254));
        let (share, _) = held(|row, _| (Q::FrontShare, 1.0 - number(row[9]) / number(row[7])));
        assert_eq!(n, 49);
        assert!((0.84..=0.98).contains(&height), "{height}");
        assert!((0.84..=0.98).contains(&share), "{share}");
    }

    fn known() -> impl Strategy<Value = DataSheet> {
        let size = (700.0..4000.0_f64, 3.2..6.2_f64, 1.5..2.1_f64);
        (0..5_usize, size, prop::option::of(0.35..0.70_f64), prop::option::of(0.4..1.1_f64))
            .prop_map(|(class, (mass, length, width), share, height)| {
                let mut sheet = DataSheet::new("car", VehicleClass::ALL[class])
                    .with(Q::Mass, mass)
                    .with(Q::Length, length)
                    .with(Q::Width, width);
                share.into_iter().for_each(|share| sheet.set(Q::FrontShare, share));
                height.into_iter().for_each(|height| sheet.set(Q::CgHeight, height));
                sheet
            })
    }

    proptest! {
        #[test]
        fn every_draw_is_a_vehicle(
            sheet in known(), latents in prop::collection::vec(-4.0..4.0_f64, 23),
        ) {
            let drawn = sheet.at(&latents).vehicle();
            prop_assert_eq!(drawn.check_relations(), Ok(()));
            // It is also one in the eyes of a file.
            let text = toml::to_string(&drawn).unwrap();
            let read = VehicleParameters::parse(&text, Path::new("drawn.toml"));
            prop_assert!(read.is_ok(), "{:?}", read);
        }
    }
}
