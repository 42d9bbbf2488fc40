//! What varies in a sweep: its name, where it goes, and how it is distributed.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use impactlab_core::numerics::{TruncatedNormal, index_of_share};
use impactlab_core::units::Quantity;

/// A varied input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vary {
    /// Name of its column.
    pub name: String,
    /// SI unit; "1" for a pure number.
    pub unit: String,
    /// Where it goes in the request, as JSON pointers; empty for a question that knows its inputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<String>,
    /// How it is distributed.
    pub distribution: Distribution,
}

/// The least and the greatest share of the probability that a row can have: half of a 32-bit step from 0 and 1.
const END_SHARES: [f64; 2] = [0.5 / 4_294_967_296.0, 1.0 - 0.5 / 4_294_967_296.0];

/// A distribution of one number, or a list of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Distribution {
    /// Every value between two ends alike.
    Uniform {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// Normal, cut off at its ends.
    Normal {
        /// Mean before it is cut off.
        mean: f64,
        /// Standard deviation before it is cut off, more than 0.
        sigma: f64,
        /// Lower end; none if `None`.
        low: Option<f64>,
        /// Upper end; none if `None`.
        high: Option<f64>,
    },
    /// Lognormal, cut off at its ends.
    Lognormal {
        /// Median before it is cut off, more than 0.
        median: f64,
        /// Standard deviation of the logarithm, more than 0.
        log_sigma: f64,
        /// Lower end, 0 or more; 0 if `None`.
        low: Option<f64>,
        /// Upper end; none if `None`.
        high: Option<f64>,
    },
    /// Triangular.
    Triangular {
        /// Lower end.
        low: f64,
        /// Likeliest value.
        mode: f64,
        /// Upper end.
        high: f64,
    },
    /// One of several values.
    List {
        /// The values: numbers, texts, or true and false.
        values: Vec<Value>,
        /// How likely each is, in any scale; all alike if empty.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        weights: Vec<f64>,
    },
}

/// A value of an input: the number of its column, and what goes into the request.
#[derive(Debug, Clone, PartialEq)]
pub struct InputValue {
    /// The number; of a list with values that are none, the place in the list, from 0.
    pub number: f64,
    /// The value.
    pub value: Value,
}

impl Distribution {
    /// What is wrong with its numbers, in words; `None` if nothing is.
    pub fn fault(&self) -> Option<String> {
        let increasing = |numbers: &[f64]| numbers.windows(2).all(|pair| pair[0] <= pair[1]);
        let (numbers, ends) = self.numbers();
        if numbers.iter().chain(&ends).any(|number| !number.is_finite()) {
            return Some("finite numbers".to_owned());
        }
        let is_good = match self {
            Self::Uniform { low, high } => low < high && (high - low).is_finite(),
            Self::Normal { sigma, .. } => *sigma > 0.0 && ends.windows(2).all(|it| it[0] < it[1]),
            Self::Lognormal { median, log_sigma, low, .. } => {
                *median > 0.0
                    && *log_sigma > 0.0
                    && low.is_none_or(|low| low >= 0.0)
                    && ends.windows(2).all(|it| it[0] < it[1])
            }
            // A row has the root of a product of two widths.
            Self::Triangular { low, mode, high } => {
                low < high
                    && increasing(&[*low, *mode, *high])
                    && ((high - low) * (high - low)).is_normal()
            }
            Self::List { values, weights } => return list_fault(values, weights),
        };
        let expected = match self {
            Self::Uniform { .. } => "[low, high] with low < high and a finite width",
            Self::Normal { .. } => "[mean, sigma] with sigma > 0, and low < high",
            Self::Lognormal { .. } => {
                "[median, sigma of the logarithm], both more than 0, and 0 <= low < high"
            }
            Self::Triangular { .. } => {
                "[low, mode, high] in this order with low < high, and the square of the width a number"
            }
            Self::List { .. } => "",
        };
        if !is_good {
            return Some(expected.to_owned());
        }
        if self.normal().is_some_and(|normal| normal.share() < 1e-9) {
            return Some("ends between which the distribution has some share".to_owned());
        }
        let is_number = |number: f64| {
            number.is_finite() && (number > 0.0 || !matches!(self, Self::Lognormal { .. }))
        };
        let in_rows = END_SHARES.map(|share| self.at(share).number);
        (!in_rows.into_iter().all(is_number)).then(|| {
            let [least, most] = in_rows;
            format!(
                "a distribution whose rows have numbers: they would reach from {least:e} to {most:e}"
            )
        })
    }

    fn numbers(&self) -> (Vec<f64>, Vec<f64>) {
        let ends = |low: &Option<f64>, high: &Option<f64>| [*low, *high].into_iter().flatten();
        match self {
            Self::Uniform { low, high } => (vec![*low, *high], Vec::new()),
            Self::Normal { mean, sigma, low, high } => {
                (vec![*mean, *sigma], ends(low, high).collect())
            }
            Self::Lognormal { median, log_sigma, low, high } => {
                (vec![*median, *log_sigma], ends(low, high).collect())
            }
            Self::Triangular { low, mode, high } => (vec![*low, *mode, *high], Vec::new()),
            Self::List { weights, .. } => (weights.clone(), Vec::new()),
        }
    }

    /// Smallest and largest number, infinite where there is none; `None` for a list with other values.
    pub fn support(&self) -> Option<[f64; 2]> {
        let (inf, no) = (f64::INFINITY, f64::NEG_INFINITY);
        Some(match self {
            Self::Uniform { low, high } | Self::Triangular { low, high, .. } => [*low, *high],
            Self::Normal { low, high, .. } => [low.unwrap_or(no), high.unwrap_or(inf)],
            Self::Lognormal { low, high, .. } => [low.unwrap_or(0.0), high.unwrap_or(inf)],
            Self::List { values, .. } => {
                let numbers: Option<Vec<f64>> = values.iter().map(Value::as_f64).collect();
                let fold = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
                numbers?.into_iter().fold([inf, no], fold)
            }
        })
    }

    /// The values of a list; `None` for another distribution.
    pub fn list(&self) -> Option<&[Value]> {
        match self {
            Self::List { values, .. } => Some(values),
            _ => None,
        }
    }

    /// That of a normal number, or of the logarithm of a lognormal one over its median.
    fn normal(&self) -> Option<TruncatedNormal> {
        let (inf, no) = (f64::INFINITY, f64::NEG_INFINITY);
        match *self {
            Self::Normal { mean, sigma, low, high } => {
                let ends = [low.unwrap_or(no), high.unwrap_or(inf)];
                Some(TruncatedNormal::new([mean, sigma], ends))
            }
            Self::Lognormal { median, log_sigma, low, high } => {
                let log = |end: f64| (end / median).ln();
                let ends = [low.map_or(no, log), high.map_or(inf, log)];
                Some(TruncatedNormal::new([0.0, log_sigma], ends))
            }
            _ => None,
        }
    }

    /// The value at a share of the probability, between 0 and 1.
    pub fn at(&self, share: f64) -> InputValue {
        let number = |number: f64| InputValue { number, value: Value::from(number) };
        let normal = self.normal().map_or(f64::NAN, |normal| normal.quantile(share));
        match *self {
            Self::Uniform { low, high } => number((low + share * (high - low)).clamp(low, high)),
            Self::Normal { .. } => number(normal),
            Self::Lognormal { median, low, high, .. } => {
                number(within(median * normal.exp(), [low, high]))
            }
            Self::Triangular { low, mode, high } => {
                let (width, left) = (high - low, mode - low);
                number(if share * width < left {
                    low + (share * width * left).sqrt()
                } else {
                    high - ((1.0 - share) * width * (high - mode)).sqrt()
                })
            }
            Self::List { ref values, ref weights } => {
                listed(values, share_idx(share, values.len(), weights))
            }
        }
    }
}

/// A number between the ends that there are.
fn within(value: f64, [low, high]: [Option<f64>; 2]) -> f64 {
    let value = low.map_or(value, |low| value.max(low));
    high.map_or(value, |high| value.min(high))
}

/// A value of a list.
pub(crate) fn listed(values: &[Value], idx: usize) -> InputValue {
    let all_numbers = values.iter().all(Value::is_number);
    let value = values.get(idx).cloned().unwrap_or(Value::Null);
    let number = value.as_f64().filter(|_| all_numbers).unwrap_or(idx as f64);
    InputValue { number, value }
}

/// The place in a list that a share of the probability falls upon.
fn share_idx(share: f64, n: usize, weights: &[f64]) -> usize {
    if weights.is_empty() {
        return ((share * n as f64) as usize).min(n.saturating_sub(1));
    }
    let total: f64 = weights.iter().sum();
    index_of_share(weights.iter().copied(), share * total)
}

/// What is expected in place of a unit that numbers of requests and answers are not in; `None` for an SI unit, for
/// one of a quantity that the program does not know, and where a key says that it is in this unit.
///
/// - `places`: where the number goes or comes from, as JSON pointers.
pub(crate) fn unit_fault<'a>(
    unit: &str,
    places: impl IntoIterator<Item = &'a str>,
) -> Option<String> {
    let ending = format!("_{}", unit.replace('/', "_"));
    let says_so = |place: &str| place.split('/').any(|key| key.ends_with(&ending));
    if Quantity::from_si_symbol(unit).is_some() || places.into_iter().any(says_so) {
        return None;
    }
    let is_called = |quantity: &&Quantity| quantity.units().iter().any(|it| it.symbol == unit);
    let si_of = |quantity: &Quantity| match quantity.si_unit().symbol {
        "" => "\"1\"".to_owned(),
        symbol => format!("{symbol:?}"),
    };
    let si: Vec<String> = Quantity::ALL.iter().filter(is_called).map(si_of).collect();
    let expected = || format!("{}: requests and answers are in SI units", si.join(" or "));
    (!si.is_empty()).then(expected)
}

fn list_fault(values: &[Value], weights: &[f64]) -> Option<String> {
    let is_plain = |value: &Value| value.is_number() || value.is_string() || value.is_boolean();
    if values.is_empty() || !values.iter().all(is_plain) {
        return Some("one or more numbers, texts, or true and false".to_owned());
    }
    let total: f64 = weights.iter().sum();
    let is_good = weights.iter().all(|weight| *weight >= 0.0) && total > 0.0 && total.is_finite();
    if !weights.is_empty() && (weights.len() != values.len() || !is_good) {
        return Some(format!("{} weights of 0 or more, not all 0, of a finite sum", values.len()));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean_and_ends(distribution: &Distribution) -> (f64, f64, f64) {
        assert_eq!(distribution.fault(), None);
        let values: Vec<f64> =
            (0..10_000).map(|i| distribution.at((f64::from(i) + 0.5) / 10_000.0).number).collect();
        let fold = |low: fn(f64, f64) -> f64| values.iter().copied().reduce(low).unwrap();
        (values.iter().sum::<f64>() / 10_000.0, fold(f64::min), fold(f64::max))
    }

    #[test]
    fn distributions_have_their_means_and_stay_between_their_ends() {
        let triangular = Distribution::Triangular { low: 0.0, mode: 1.0, high: 5.0 };
        let (mean, low, high) = mean_and_ends(&triangular);
        assert!((mean - 2.0).abs() < 1e-3 && low > 0.0 && high < 5.0, "{mean} {low} {high}");
        let (low, high) = (Some(-1.0), Some(1.0));
        let normal = Distribution::Normal { mean: 0.0, sigma: 2.0, low, high };
        let (mean, low, high) = mean_and_ends(&normal);
        assert!(mean.abs() < 1e-9 && low >= -1.0 && high <= 1.0, "{mean} {low} {high}");
        let lognormal =
            Distribution::Lognormal { median: 2.0, log_sigma: 0.5, low: None, high: None };
        let (mean, _, _) = mean_and_ends(&lognormal);
        assert!((mean / (2.0 * 0.125_f64.exp()) - 1.0).abs() < 2e-3, "{mean}");
    }

    #[test]
    fn a_list_of_numbers_gives_them_and_another_its_places() {
        let weights = vec![1.0, 0.0, 3.0];
        let values = vec![Value::from(10.0), Value::from(20.0), Value::from(30.0)];
        let list = Distribution::List { values, weights };
        assert_eq!(
            [0.1, 0.24, 0.26, 0.999].map(|share| list.at(share).number),
            [10.0, 10.0, 30.0, 30.0]
        );
        let words = Distribution::List {
            values: vec![Value::from("a"), Value::from("b")],
            weights: Vec::new(),
        };
        assert_eq!(words.at(0.7), InputValue { number: 1.0, value: Value::from("b") });
        assert_eq!(words.support(), None);
    }

    /// A speed in m/s stood in a column of km/h.
    #[test]
    fn a_unit_is_that_of_requests_and_answers() {
        for (unit, si) in [("km/h", "\"m/s\""), ("deg", "\"rad\""), ("%", "\"1\""), ("", "\"1\"")] {
            let told = unit_fault(unit, ["/end/speed"]);
            assert!(told.is_some_and(|expected| expected.starts_with(si)), "{unit}");
        }
        // That of an acceleration, and of a mass.
        assert!(unit_fault("g", []).is_some_and(|it| it.starts_with("\"m/s²\" or \"kg\":")));
        for unit in ["m/s", "rad", "1", "kg m²", "W"] {
            assert_eq!(unit_fault(unit, ["/end/speed"]), None);
        }
        // A principal direction of force is in degrees in some answers, and their keys say so.
        for place in ["/force/pdof_deg", "/pdof_interval_deg/median"] {
            assert_eq!(unit_fault("deg", [place]), None);
            assert!(unit_fault("km/h", [place]).is_some());
        }
    }

    #[test]
    fn what_is_no_distribution_is_refused() {
        let nan = Distribution::Uniform { low: f64::NAN, high: 1.0 };
        let turned = Distribution::Uniform { low: 2.0, high: 1.0 };
        let far = Distribution::Normal { mean: 0.0, sigma: 1.0, low: Some(50.0), high: Some(51.0) };
        let empty = Distribution::List { values: Vec::new(), weights: Vec::new() };
        for bad in [nan, turned, far, empty] {
            assert!(bad.fault().is_some(), "{bad:?}");
        }
    }

    /// The width of the first was infinite, and every row had its upper end; the rows of others had infinity, 0 or
    /// the last value alone.
    #[test]
    fn a_distribution_whose_numbers_overflow_in_rows_is_refused() {
        let (low, high) = (-1e308, 1e308);
        let normal = |mean, sigma, low| Distribution::Normal { mean, sigma, low, high: None };
        let lognormal =
            |log_sigma, high| Distribution::Lognormal { median: 0.7, log_sigma, low: None, high };
        let triangular = |high: f64| Distribution::Triangular { low: 0.0, mode: high / 2.0, high };
        let values = vec![Value::from(1.0), Value::from(2.0)];
        for bad in [
            Distribution::Uniform { low, high },
            normal(1e308, 1e308, None),
            normal(1e308, 1e308, Some(0.0)),
            lognormal(900.0, None),
            lognormal(900.0, Some(2.0)),
            triangular(1e200),
            triangular(1e-200),
            Distribution::List { values, weights: vec![1e308, 1e308] },
        ] {
            assert!(bad.fault().is_some(), "{bad:?}");
        }
        // As wide as it can be.
        for good in [
            Distribution::Uniform { low: low / 2.0, high: high / 2.0 },
            normal(1e300, 1e300, None),
            lognormal(100.0, None),
            triangular(1e150),
        ] {
            assert_eq!(good.fault(), None);
            let ends = END_SHARES.map(|share| good.at(share).number);
            assert!(
                ends[0] < ends[1] && ends.iter().all(|end| end.is_finite()),
                "{good:?} {ends:?}"
            );
        }
    }
}
