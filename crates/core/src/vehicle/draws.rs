//! What follows for a motion from what is not known of the vehicle: its estimated parameters are
//! drawn, and how the motion ends is compared with what was drawn.

use schemars::JsonSchema;
use serde::Serialize;

use crate::numerics::{latin_normals, random_stream};
use crate::ranges::ROAD_FRICTION;
use crate::vehicle::{DataSheet, SheetQuantity, VehicleParameters};

/// Standard deviation over the friction of a road that nobody has measured, as the rules of data sheets have
/// it for dry asphalt: 0.06 of 0.8.
pub const ROAD_FRICTION_SPREAD: f64 = 0.075;

/// Least standard deviation of such a friction: in proportion alone, that of ice would be known eight times as well
/// as that of dry asphalt. With it 90 % of a friction of 0.1 are 0.05 to 0.15.
pub const LEAST_ROAD_FRICTION_SIGMA: f64 = 0.03;

/// Standard deviation of the friction of a road that nobody has measured: [`ROAD_FRICTION_SPREAD`] of it, and at least
/// [`LEAST_ROAD_FRICTION_SIGMA`].
pub fn usual_road_sigma(friction: f64) -> f64 {
    (ROAD_FRICTION_SPREAD * friction).max(LEAST_ROAD_FRICTION_SIGMA)
}

/// How the friction of a road is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoadDraws {
    /// Standard deviation of the peak friction.
    pub sigma: f64,
    /// Seed: vehicles that are drawn with the same one are on the same road.
    pub seed: u64,
}

/// The estimates of a vehicle, drawn several times.
#[derive(Debug, Clone, PartialEq)]
pub struct VehicleDraws {
    quantities: Vec<SheetQuantity>,
    /// Of each draw: those of the data sheet, then that of the road.
    latents: Vec<Vec<f64>>,
    /// Standard deviation of the friction of the road, where that is drawn.
    road_sigma: Option<f64>,
}

/// How much of what is uncertain about the end of a motion comes from one estimate.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Sensitivity {
    /// The estimate.
    pub quantity: SheetQuantity,
    /// For a person.
    pub label: &'static str,
    /// Share of the variance of the end position that goes with it linearly, 0 to 1.
    pub position_share: f64,
    /// Share of the variance of the final heading that goes with it linearly, 0 to 1.
    pub heading_share: f64,
    /// Share that an estimate without any influence exceeds in one of twenty cases: smaller shares
    /// may be chance. It falls with the number of draws.
    pub chance_share: f64,
}

impl Sensitivity {
    /// Whether position or heading depend on the estimate by more than chance.
    pub fn is_clear(&self) -> bool {
        self.position_share.max(self.heading_share) > self.chance_share
    }
}

/// Quantile 0.95 of χ² with one degree of freedom: n r² without dependence.
const CHI_SQUARED_95: f64 = 3.841;

/// Variance of a place, m², or a heading, rad², up to which it is one of rounding: that of a micrometre, or of a
/// microradian.
const LEAST_VARIANCE: f64 = 1e-12;

impl VehicleDraws {
    /// Draws every estimate of a data sheet, each independent of the others; together the draws fill
    /// the space of the estimates evenly (Latin hypercube,
    /// [`McKay1979`](crate::bibliography::McKay1979)).
    pub fn from_sheet(sheet: &DataSheet, n_draws: usize, seed: u64) -> Self {
        let quantities: Vec<SheetQuantity> = sheet.estimated().collect();
        let along = |idx: usize| {
            latin_normals(n_draws, &mut random_stream(seed, "vehicle estimates", idx as u64))
        };
        let columns: Vec<Vec<f64>> = (0..quantities.len()).map(along).collect();
        let latents =
            (0..n_draws).map(|draw| columns.iter().map(|column| column[draw]).collect()).collect();
        Self { quantities, latents, road_sigma: None }
    }

    /// Draws what is not known of a vehicle and of the road that it is on.
    ///
    /// - `uses_sheet`: whether the estimates of its data sheet are drawn, if it has one;
    /// - `road`: how the friction of the road is drawn; `None` where it is known.
    pub fn new(
        vehicle: &VehicleParameters,
        uses_sheet: bool,
        road: Option<RoadDraws>,
        n_draws: usize,
        seed: u64,
    ) -> Self {
        let vehicle = match road {
            // The road says it, and not the sheet.
            Some(_) => vehicle.clone().with_friction(vehicle.tires.friction),
            None => vehicle.clone(),
        };
        let nothing = || Self {
            quantities: Vec::new(),
            latents: vec![Vec::new(); n_draws],
            road_sigma: None,
        };
        let sheet = vehicle.sheet.as_ref().filter(|_| uses_sheet);
        let mut draws = sheet.map_or_else(nothing, |sheet| Self::from_sheet(sheet, n_draws, seed));
        if let Some(RoadDraws { sigma, seed }) = road {
            let of_road = latin_normals(n_draws, &mut random_stream(seed, "road friction", 0));
            draws.quantities.push(SheetQuantity::Friction);
            for (latents, z) in draws.latents.iter_mut().zip(of_road) {
                latents.push(z);
            }
            draws.road_sigma = Some(sigma);
        }
        draws
    }

    /// Number of draws.
    pub fn len(&self) -> usize {
        self.latents.len()
    }

    /// Whether nothing is drawn: no draws, or a vehicle without estimates.
    pub fn is_empty(&self) -> bool {
        self.latents.is_empty() || self.quantities.is_empty()
    }

    /// The vehicle of each draw.
    ///
    /// - `vehicle`: the vehicle of which the draws are.
    pub fn vehicles(&self, vehicle: &VehicleParameters) -> Vec<VehicleParameters> {
        let Some(sigma) = self.road_sigma else {
            return self.latents.iter().map(|latents| vehicle.drawn(latents)).collect();
        };
        let friction = vehicle.tires.friction;
        let vehicle = vehicle.clone().with_friction(friction);
        let drawn = |latents: &Vec<f64>| {
            let (road, of_sheet) = latents.split_last()?;
            let drawn = if of_sheet.is_empty() { vehicle.clone() } else { vehicle.drawn(of_sheet) };
            let drawn_friction = friction + sigma * road;
            Some(drawn.with_friction(drawn_friction.clamp(ROAD_FRICTION.low, ROAD_FRICTION.high)))
        };
        self.latents.iter().filter_map(drawn).collect()
    }

    /// The estimates by their part in the variance of the end position, the largest first.
    ///
    /// A share is the squared correlation with the standard normal factor of the estimate, for the
    /// position summed over both axes, less what chance gives: r² − (1 − r²)/(n − 2).
    ///
    /// - `ends`: for each draw the end position X, Y, m, and heading, rad; `None` where the motion did
    ///   not come to its end.
    pub fn sensitivities(&self, ends: &[Option<[f64; 3]>]) -> Vec<Sensitivity> {
        let drawn: Vec<(&Vec<f64>, [f64; 3])> =
            self.latents.iter().zip(ends).filter_map(|(z, end)| Some((z, (*end)?))).collect();
        let n = drawn.len() as f64;
        let adjusted = |share: f64| match n > 2.0 {
            true => (share - (1.0 - share) / (n - 2.0)).clamp(0.0, 1.0),
            false => 0.0,
        };
        let sensitivity = |(idx, &quantity): (usize, &SheetQuantity)| {
            let factor: Vec<f64> = drawn.iter().map(|(z, _)| z[idx]).collect();
            let [x, y, heading] = [0, 1, 2].map(|component| {
                let values: Vec<f64> = drawn.iter().map(|(_, end)| end[component]).collect();
                Moments::new(&factor, &values)
            });
            // Of what does not move no estimate has a part, though rounding leaves a variance.
            let share = |explained: f64, variance: f64| match variance > LEAST_VARIANCE {
                true => adjusted(explained / variance),
                false => 0.0,
            };
            Sensitivity {
                quantity,
                label: quantity.label(),
                position_share: share(x.explained() + y.explained(), x.variance + y.variance),
                heading_share: share(heading.explained(), heading.variance),
                chance_share: (CHI_SQUARED_95 / n.max(1.0)).min(1.0),
            }
        };
        let mut shares: Vec<Sensitivity> =
            self.quantities.iter().enumerate().map(sensitivity).collect();
        let size = |share: &Sensitivity| (share.position_share, share.heading_share);
        shares.sort_by(|a, b| size(b).partial_cmp(&size(a)).unwrap_or(std::cmp::Ordering::Equal));
        shares
    }
}

/// Second moments of a factor and of what may depend on it.
struct Moments {
    variance: f64,
    covariance: f64,
    variance_of_factor: f64,
}

impl Moments {
    fn new(factor: &[f64], values: &[f64]) -> Self {
        let n = factor.len().max(1) as f64;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
        let (mean_factor, mean_value) = (mean(factor), mean(values));
        let mean_of = |product: &dyn Fn(f64, f64) -> f64| {
            let pairs = factor.iter().zip(values);
            pairs.map(|(z, v)| product(z - mean_factor, v - mean_value)).sum::<f64>() / n
        };
        Self {
            variance: mean_of(&|_, v| v * v),
            covariance: mean_of(&|z, v| z * v),
            variance_of_factor: mean_of(&|z, _| z * z),
        }
    }

    /// The part of the variance that a line through the pairs explains.
    fn explained(&self) -> f64 {
        match self.variance_of_factor > 0.0 {
            true => self.covariance * self.covariance / self.variance_of_factor,
            false => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::VehicleClass;

    /// The friction of ice was known to 12 % with 90 %.
    #[test]
    fn a_low_friction_is_no_better_known_than_a_high_one() {
        assert!((usual_road_sigma(0.8) - 0.06).abs() < 1e-12);
        assert!((usual_road_sigma(0.1) - 0.03).abs() < 1e-12);
    }

    #[test]
    fn vehicles_on_one_road_have_one_friction_in_each_draw() {
        let road = RoadDraws { sigma: 0.06, seed: 5 };
        let of = |id: &str, uses_sheet, seed| {
            let vehicle = crate::vehicle::built_in_vehicle(id).unwrap();
            let draws = VehicleDraws::new(&vehicle, uses_sheet, Some(road), 200, seed);
            (draws.vehicles(&vehicle), draws)
        };
        let (known, draws) = of("reference-2000", false, 1);
        let (drawn, _) = of("toyota-corolla-2020", true, 2);
        for (one, other) in known.iter().zip(&drawn) {
            assert!((one.tires.friction - other.tires.friction).abs() < 1e-12);
            assert_eq!(one.mass, known[0].mass);
        }
        assert!(drawn.iter().any(|of| of.geometry.cg_height_m != drawn[0].geometry.cg_height_m));
        let n = known.len() as f64;
        let mean = known.iter().map(|of| of.tires.friction).sum::<f64>() / n;
        let squares = known.iter().map(|of| (of.tires.friction - mean).powi(2));
        let sigma = (squares.sum::<f64>() / n).sqrt();
        assert!((mean - 0.8).abs() < 1e-3 && (sigma / 0.06 - 1.0).abs() < 0.03, "{mean} {sigma}");
        let ends: Vec<_> = known.iter().map(|of| Some([of.tires.friction, 0.0, 0.0])).collect();
        let shares = draws.sensitivities(&ends);
        assert!(shares[0].quantity == SheetQuantity::Friction && shares[0].position_share > 0.99);
    }

    #[test]
    fn the_shares_are_those_of_a_known_dependence() {
        let sheet = DataSheet::new("car", VehicleClass::Car);
        let draws = VehicleDraws::from_sheet(&sheet, 400, 3);
        assert_eq!(draws, VehicleDraws::from_sheet(&sheet, 400, 3), "the seed decides");
        // 16 and 9 of 25 parts of the variance of the position, all of the heading.
        let end = |z: &Vec<f64>| Some([4.0 * z[2], 3.0 * z[5], -2.0 * z[7]]);
        let ends: Vec<_> = draws.latents.iter().map(end).collect();
        let shares = draws.sensitivities(&ends);
        let share = |idx: usize| {
            let quantity = draws.quantities[idx];
            let share = shares.iter().find(|share| share.quantity == quantity).unwrap();
            (share.position_share, share.heading_share)
        };
        assert_eq!(shares[0].quantity, draws.quantities[2]);
        // A heading that stays had “22.3 % of its variance” from the front overhang, by the last digits.
        let rounded = |z: &Vec<f64>| Some([4.0 * z[2], 0.0, 1e-15 * z[7]]);
        let stays: Vec<_> = draws.latents.iter().map(rounded).collect();
        let stays = draws.sensitivities(&stays);
        assert!(stays.iter().all(|share| share.heading_share == 0.0), "{stays:?}");
        assert!((share(2).0 - 0.64).abs() < 0.08, "{shares:?}");
        assert!((share(5).0 - 0.36).abs() < 0.08, "{shares:?}");
        assert!(share(7).1 > 0.999 && share(7).0 < 0.03, "{shares:?}");
        let n_clear = shares.iter().filter(|share| share.is_clear()).count();
        assert!((3..=6).contains(&n_clear), "{shares:?}");
    }
}
