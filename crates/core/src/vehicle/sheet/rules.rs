//! Rules by which the parameters of a car are estimated that its data sheet does not state, each
//! with its scatter over cars.
//!
//! A rule gives the median of a quantity from quantities that are known or estimated already, and the
//! standard deviation of what is found around it, relative (lognormal) or absolute (normal).
//!
//! Where the numbers come from:
//! - Inertia: dynamic index `k_z²/(l_f l_r)` and ratio of `k_x` to the track, medians and quartiles of
//!   73 cars and 131 light trucks of the database of
//!   [`Heydinger1999`](crate::bibliography::Heydinger1999), as
//!   [`KktseInertia2020`](crate::bibliography::KktseInertia2020) evaluates it.
//! - Height of the CG and weight on the front axle: means and standard deviations over the 49 vehicles
//!   of model year 2003 to 2005 in [`Ncap2004`](crate::bibliography::Ncap2004)
//!   (`tests/data/vehicles/ncap-2004.csv`; a test compares the rules with it), measured with the
//!   weight of a driver.
//! - Wheelbase, track and mass from the outer size: the vehicles of the library, of which
//!   [`Cvs2024`](crate::bibliography::Cvs2024) gives length and width.
//! - Suspension and tires: 12 multibody cars and the reference car, whose values were measured on the
//!   models in static and steady tests. They are plausible cars, not measured ones; published
//!   measurements of single cars lie within the scatter
//!   ([`KktseCornering2019`](crate::bibliography::KktseCornering2019): cornering compliance 6.7 and 3.1 deg/g, that is
//!   8.6 and 18.5 1/rad).
//! - What no source could be found for is said to be assumed, with a wide scatter.

use crate::vehicle::DrivenAxle;
use crate::vehicle::sheet::{SheetQuantity, VehicleClass};
use crate::vehicle::tire::WHEEL_MASS_SHARE;

use super::data_sheet::SheetValues;

/// Median, scatter and origin of an estimated quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Median, SI units.
    pub median: f64,
    /// Distribution around the median.
    pub scatter: Scatter,
    /// The rule in a few words.
    pub text: &'static str,
    /// Where rule and scatter come from.
    pub source: &'static str,
}

/// Distribution of a quantity around its median.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scatter {
    /// Lognormal: standard deviation of the natural logarithm.
    Relative(f64),
    /// Normal: standard deviation in SI units.
    Absolute(f64),
}

const NHTSA_INERTIA: &str = "Heydinger 1999 (NHTSA), 204 vehicles";
const NCAP: &str = "NHTSA NCAP 2004, 49 vehicles";
const LIBRARY: &str = "21 vehicles of the library";
const MULTIBODY: &str = "13 multibody cars, steady tests";
const ASSUMED: &str = "assumed, no source";

impl Rule {
    /// Value at a number of standard deviations from the median.
    pub fn at(&self, latent: f64) -> f64 {
        match self.scatter {
            Scatter::Relative(deviation) => self.median * (deviation * latent).exp(),
            Scatter::Absolute(deviation) => self.median + deviation * latent,
        }
    }

    /// The rule for a quantity.
    ///
    /// - `values`: the quantities before it, known or estimated.
    pub(super) fn new(
        quantity: SheetQuantity,
        class: VehicleClass,
        drive: Option<DrivenAxle>,
        values: &SheetValues<'_>,
    ) -> Self {
        use SheetQuantity as Q;
        match quantity {
            Q::Length | Q::Width | Q::Mass | Q::Wheelbase | Q::Track | Q::FrontOverhang => {
                size(quantity, class, values)
            }
            Q::FrontShare => front_share(class, drive),
            Q::CgHeight | Q::YawInertia | Q::RollInertia | Q::RollYawProduct => {
                inertia(quantity, class, values)
            }
            Q::SprungMass
            | Q::WheelRadius
            | Q::WheelInertia
            | Q::RollAxisHeight
            | Q::RollGradient
            | Q::RollDampingRatio
            | Q::FrontRollShare => suspension(quantity, class, values),
            Q::RearCornering
            | Q::FrontCornering
            | Q::Friction
            | Q::SlidingRatio
            | Q::RollingResistance
            | Q::DragArea => tires(quantity, class, values),
        }
    }
}

/// Outer widths of the classes, m.
const WIDTHS_M: [f64; 5] = [1.842, 1.759, 1.896, 1.836, 1.966];

fn relative(median: f64, deviation: f64, text: &'static str, source: &'static str) -> Rule {
    Rule { median, scatter: Scatter::Relative(deviation), text, source }
}

fn absolute(median: f64, deviation: f64, text: &'static str, source: &'static str) -> Rule {
    Rule { median, scatter: Scatter::Absolute(deviation), text, source }
}

/// Scale of a vehicle that is less than half as wide as those of its class, such as a model of a car: its
/// width over theirs; 1 of all others.
fn model_scale(class: VehicleClass, values: &SheetValues<'_>) -> f64 {
    let scale = values.get(SheetQuantity::Width) / class.pick(WIDTHS_M);
    if scale < 0.5 { scale } else { 1.0 }
}

/// Whether a vehicle is a model of a car.
pub(super) fn is_model(class: VehicleClass, values: &SheetValues<'_>) -> bool {
    model_scale(class, values) < 1.0
}

/// One text for the vehicles of a class, and one for models of them.
fn of_scale(scale: f64, usual: &'static str, model: &'static str) -> &'static str {
    if scale < 1.0 { model } else { usual }
}

/// Outer size, mass, and where the axles are.
fn size(quantity: SheetQuantity, class: VehicleClass, values: &SheetValues<'_>) -> Rule {
    use SheetQuantity as Q;
    let wheelbase_share = class.pick([0.591, 0.580, 0.589, 0.614, 0.601]);
    let wheelbase_scatter = class.pick([0.030, 0.032, 0.020, 0.030, 0.030]);
    let track_share = 0.851;
    match quantity {
        Q::Length => match values.known(Q::Wheelbase) {
            Some(wheelbase) => relative(
                wheelbase / wheelbase_share,
                wheelbase_scatter,
                "from the wheelbase, by class",
                LIBRARY,
            ),
            None => relative(
                class.pick([4.83, 4.54, 4.82, 5.39, 5.14]),
                class.pick([0.075, 0.060, 0.050, 0.066, 0.050]),
                "by class",
                LIBRARY,
            ),
        },
        Q::Width => match values.known(Q::Track) {
            Some(track) => relative(track / track_share, 0.016, "track / 0.851", LIBRARY),
            None => relative(
                class.pick(WIDTHS_M),
                class.pick([0.056, 0.030, 0.041, 0.070, 0.030]),
                "by class",
                LIBRARY,
            ),
        },
        Q::Mass => relative(
            class.pick([201.0, 186.0, 219.0, 198.0, 197.0])
                * values.get(Q::Length)
                * values.get(Q::Width),
            class.pick([0.110, 0.070, 0.076, 0.140, 0.080]),
            "length × width × mass per area of the class",
            LIBRARY,
        ),
        Q::Wheelbase => relative(
            wheelbase_share * values.get(Q::Length),
            wheelbase_scatter,
            "share of the length, by class",
            LIBRARY,
        ),
        Q::Track => relative(track_share * values.get(Q::Width), 0.016, "0.851 × width", LIBRARY),
        _ => relative(
            0.44 * (values.get(Q::Length) - values.get(Q::Wheelbase)).max(0.0),
            0.10,
            "0.44 of length minus wheelbase",
            ASSUMED,
        ),
    }
}

fn front_share(class: VehicleClass, drive: Option<DrivenAxle>) -> Rule {
    let (median, deviation, text) = match drive {
        Some(DrivenAxle::Front) => (0.605, 0.020, "front-wheel drive"),
        Some(DrivenAxle::Rear) => (
            class.pick([0.535, 0.520, 0.523, 0.569, 0.520]),
            class.pick([0.035, 0.030, 0.020, 0.020, 0.040]),
            "rear-wheel drive, by class",
        ),
        Some(DrivenAxle::All) | None => (
            class.pick([0.570, 0.590, 0.547, 0.576, 0.575]),
            class.pick([0.040, 0.036, 0.028, 0.020, 0.035]),
            "by class",
        ),
    };
    absolute(median, deviation, text, NCAP)
}

/// Height of the CG, moments and product of inertia.
fn inertia(quantity: SheetQuantity, class: VehicleClass, values: &SheetValues<'_>) -> Rule {
    use SheetQuantity as Q;
    let mass = values.get(Q::Mass);
    match quantity {
        Q::CgHeight => relative(
            values.get(Q::Track) / 2.0 / class.pick([1.27, 1.38, 1.19, 1.165, 1.28]),
            class.pick([0.095, 0.055, 0.055, 0.060, 0.090]),
            "half the track over the stability factor of the class",
            NCAP,
        ),
        Q::YawInertia => {
            let [front, rear] = values.axle_distances_m();
            relative(
                class.pick([1.033, 1.105, 1.000, 1.000, 1.000]) * mass * front * rear,
                class.pick([0.107, 0.076, 0.092, 0.092, 0.092]),
                "dynamic index of the class × m l_f l_r",
                NHTSA_INERTIA,
            )
        }
        Q::RollInertia => {
            let radius = class.pick([0.409, 0.408, 0.412, 0.412, 0.412]) * values.get(Q::Track);
            // Twice that of the radius, which lies between that of quartiles and of extremes.
            let deviation = 2.0 * class.pick([0.050, 0.040, 0.055, 0.055, 0.055]);
            relative(mass * radius * radius, deviation, "m (0.41 × track)²", NHTSA_INERTIA)
        }
        // The database gives 0.06 m² × m in the mean for cars, negative values for many pickups, and
        // not the direction of its z axis.
        _ => absolute(
            0.0,
            0.05 * mass,
            "0 ± 0.05 m² × mass: sources differ in its sign",
            NHTSA_INERTIA,
        ),
    }
}

fn suspension(quantity: SheetQuantity, class: VehicleClass, values: &SheetValues<'_>) -> Rule {
    use SheetQuantity as Q;
    let scale = model_scale(class, values);
    match quantity {
        Q::SprungMass => absolute(
            0.85 * values.get(Q::Mass),
            0.035 * values.get(Q::Mass),
            "0.85 × mass",
            MULTIBODY,
        ),
        Q::WheelRadius => relative(
            class.pick([0.33, 0.31, 0.36, 0.36, 0.34]) * scale,
            0.06,
            of_scale(scale, "by class", "by class, in the scale of the width"),
            MULTIBODY,
        ),
        Q::WheelInertia => relative(
            WHEEL_MASS_SHARE * values.get(Q::Mass) * values.get(Q::WheelRadius).powi(2),
            0.10,
            "0.0115 × mass × radius²",
            MULTIBODY,
        ),
        Q::RollAxisHeight => absolute(
            class.pick([0.12, 0.10, 0.14, 0.14, 0.12]) * scale,
            class.pick([0.05, 0.04, 0.06, 0.06, 0.05]) * scale,
            of_scale(
                scale,
                "usual for the suspensions of the class",
                "usual for the class, in the scale of the width",
            ),
            ASSUMED,
        ),
        Q::RollGradient => relative(5.7, 0.23, "5.7 deg/g for all classes", MULTIBODY),
        Q::RollDampingRatio => relative(
            class.pick([0.32, 0.42, 0.23, 0.23, 0.23]),
            class.pick([0.48, 0.45, 0.30, 0.30, 0.30]),
            "by class",
            MULTIBODY,
        ),
        _ => absolute(0.59, 0.055, "0.59 for all classes", MULTIBODY),
    }
}

fn tires(quantity: SheetQuantity, class: VehicleClass, values: &SheetValues<'_>) -> Rule {
    use SheetQuantity as Q;
    match quantity {
        Q::RearCornering => relative(
            class.pick([15.0, 17.0, 13.0, 13.0, 13.0]),
            class.pick([0.24, 0.26, 0.12, 0.12, 0.12]),
            "by class",
            MULTIBODY,
        ),
        Q::FrontCornering => relative(
            0.69 * values.get(Q::RearCornering),
            class.pick([0.17, 0.19, 0.10, 0.10, 0.10]),
            "0.69 of the rear axle",
            MULTIBODY,
        ),
        Q::Friction => absolute(0.80, 0.06, "dry asphalt", ASSUMED),
        Q::SlidingRatio => relative(0.80, 0.065, "0.8 for all classes", MULTIBODY),
        Q::RollingResistance => relative(0.011, 0.15, "passenger-car tires on asphalt", ASSUMED),
        _ => {
            let scale = model_scale(class, values);
            relative(
                class.pick([0.80, 0.65, 1.00, 1.05, 1.00]) * scale * scale,
                class.pick([0.25, 0.10, 0.15, 0.15, 0.15]),
                of_scale(scale, "by class", "by class, in the scale of the width squared"),
                ASSUMED,
            )
        }
    }
}
