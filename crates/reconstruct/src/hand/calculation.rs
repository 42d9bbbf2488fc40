//! A method by hand with its numbers: what it gives, how sure that is, and what moves it.
//!
//! ```text
//! σ_y² = Σ_i (y(x_i + σ_i/2) − y(x_i − σ_i/2))²        to first order
//! ```
//!
//! The intervals come from draws: each input is normal about its value with its standard deviation, cut off at
//! the limits of its range, and independent of the others; points of a mark are normal in X and in Y. Inputs
//! whose standard deviation is that of one rule, such as the drag factors of several surfaces, are off together:
//! all too large or all too small. Where that makes errors of an output cancel, as of speeds after an impact whose
//! courses part, they are independent there: each output has the wider of both intervals. Inputs whose standard
//! deviation is 0 are exact. The draws follow from the seed alone.

use std::collections::BTreeMap;

use rand::RngExt as _;

use crate::evidence::Stated;
use crate::hand::field::POINTS;
use crate::hand::spread::{first_order, share_of, widest};
use crate::hand::values::HandValues;
use crate::hand::{HandDefault, HandError, HandField, HandMethod, HandOutput};
use impactlab_core::numerics::{TruncatedNormal, normal_quantile, random_stream};
use impactlab_core::ranges::HAND_COORDINATE;
use impactlab_core::units::{Estimate, Phrase};

/// Share of draws without an answer beyond which there is none: they are left out on one side of the others, so
/// that with more of them no interval of 90 % has known ends.
const LARGEST_UNSOLVED_SHARE: f64 = 0.05;
/// Most points of a mark.
const MOST_POINTS: usize = 500;
/// Change of an input that is exact by which the others are compared, as a share of its value.
const EXACT_STEP: f64 = 0.01;

/// Key of the standard deviation of the points of a mark.
const POINT_ERROR: &str = "point_error";

/// Inputs by their keys with SI units.
pub type HandInputs = BTreeMap<String, Stated>;

/// A method with its numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct HandQuestion<'a> {
    /// The method.
    pub method: HandMethod,
    /// Its inputs.
    pub inputs: &'a HandInputs,
    /// Points of a mark, in the order in which it was left, m.
    pub points_m: &'a [[f64; 2]],
}

/// An input as a method has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandNumber {
    /// What it is.
    pub field: &'static HandField,
    /// Its value, SI.
    pub value: f64,
    /// Its standard deviation, SI; 0 if it is exact.
    pub sigma: f64,
    /// Whether the value is that of the program.
    pub is_value_assumed: bool,
    /// Whether the standard deviation is that of the program.
    pub is_sigma_assumed: bool,
}

impl HandNumber {
    /// The rule by which it is off together with others: one that stands for their standard deviations.
    pub fn rule(&self) -> Option<&'static str> {
        self.field.rule.filter(|_| self.is_sigma_assumed)
    }

    /// How it is drawn if it is not exact: cut off at the limits of its range.
    fn distribution(&self) -> TruncatedNormal {
        let range = &self.field.range;
        TruncatedNormal::new([self.value, self.sigma], [range.low, range.high])
    }
}

/// How the inputs of one rule are off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum OfRule {
    /// All of them too large or too small by the same probability.
    Together,
    /// Each by itself.
    Apart,
}

/// An input that is drawn.
struct Drawn {
    /// Where it stands among the fields of the method.
    idx: usize,
    distribution: TruncatedNormal,
    /// The first of its rule among those that are drawn; itself without a rule.
    first: usize,
    /// Whether it has the other sign than that one, so that it is too low where that one is too high.
    is_mirrored: bool,
}

/// A number that a method gives.
#[derive(Debug, Clone, PartialEq)]
pub struct HandQuantity {
    /// What it is.
    pub output: &'static HandOutput,
    /// Its value at the values of the inputs, SI.
    pub value: f64,
    /// Standard deviation to first order, SI; `None` where it has none to first order.
    pub sigma: Option<f64>,
    /// Median and intervals of the draws, SI; the value alone if all inputs are exact.
    pub estimate: Estimate,
}

/// What an output does if one input is larger.
#[derive(Debug, Clone, PartialEq)]
pub struct HandSensitivity {
    /// Key of the input with its SI unit; `points_m` for the points of a mark together.
    pub input: String,
    /// What a person calls it.
    pub label: &'static str,
    /// By how much it is larger, SI: its standard deviation, or 1 % of an exact value.
    pub step: f64,
    /// Whether it is exact, so that the step is none of its errors.
    pub is_exact: bool,
    /// The rule by which it is off together with others, if it is, and whether its value is negative.
    pub rule: Option<(&'static str, bool)>,
    /// Change of each output, SI; of points the standard deviation that they bring.
    pub changes: Vec<Option<f64>>,
}

/// What a method gives.
#[derive(Debug, Clone, PartialEq)]
pub struct HandAnswer {
    /// The inputs, in the order of the method.
    pub numbers: Vec<HandNumber>,
    /// The outputs that follow, the one that was asked for first.
    pub quantities: Vec<HandQuantity>,
    /// What moves them.
    pub sensitivities: Vec<HandSensitivity>,
    /// Conditions of the method that are violated.
    pub violated: Vec<Phrase>,
    /// Share of the draws that violate a condition which the inputs meet at their values, with what is said of
    /// one of them; none where that is little.
    pub violated_in_draws: Option<(f64, Phrase)>,
    /// Draws without an answer, which are left out.
    pub n_unsolved: usize,
    /// Share of the draws in which the vehicle stops before the place of the collision, where that is asked.
    pub avoided_share: Option<f64>,
}

impl HandQuestion<'_> {
    /// The inputs with what the program puts in place of those that are left out.
    ///
    /// # Errors
    /// [`HandError`] with the first input that is unknown, missing or out of range, or why they do not go
    /// together.
    pub fn numbers(&self) -> Result<Vec<HandNumber>, HandError> {
        let fields = self.method.fields();
        let unknown = self.inputs.keys().find(|key| fields.iter().all(|of| of.si_key() != **key));
        if let Some(key) = unknown {
            let (method, key, known) = (self.method.word(), key.clone(), self.known());
            return Err(HandError::Unknown { method, key, known });
        }
        self.check_points()?;
        let mut numbers = Vec::new();
        for field in fields {
            match field.needs.filter(|other| !self.has(other)) {
                None => numbers.extend(self.number(field)?),
                Some(other) => self.check_left_out(field, other)?,
            }
        }
        let values = self.table(&numbers);
        match (self.method.formula().refuse)(&self.values(&values, self.points_m)) {
            Some(why) => Err(HandError::Refused { method: self.method.word(), why }),
            None => Ok(numbers),
        }
    }

    /// Whether points of a mark, or the value of another input, are given.
    fn has(&self, key: &str) -> bool {
        let field = self.method.fields().iter().find(|field| field.key == key);
        let stated = field.and_then(|field| self.inputs.get(&field.si_key()));
        if key == POINTS {
            !self.points_m.is_empty()
        } else {
            stated.is_some_and(|of| of.value.is_some())
        }
    }

    /// Refuses an input that has no meaning, since another one is missing.
    fn check_left_out(&self, field: &HandField, other: &str) -> Result<(), HandError> {
        let key = field.si_key();
        if self.inputs.get(&key).is_none_or(|stated| *stated == Stated::default()) {
            return Ok(());
        }
        let other = self.method.fields().iter().find(|field| field.key == other);
        let needs = other.map_or_else(|| POINTS.to_owned(), HandField::si_key);
        Err(HandError::Alone { method: self.method.word(), key, needs })
    }

    /// The inputs of the method with their units, in words.
    fn known(&self) -> String {
        let mut names: Vec<String> = self.method.fields().iter().map(HandField::si_key).collect();
        if self.method.takes_points() {
            names.push(POINTS.to_owned());
        }
        names.join(", ")
    }

    fn check_points(&self) -> Result<(), HandError> {
        let n = self.points_m.len();
        if n > 0 && !self.method.takes_points() {
            return Err(HandError::Points { n, expected: "none, since the method takes no mark" });
        }
        if n > MOST_POINTS {
            return Err(HandError::Points { n, expected: "at most 500" });
        }
        let key = || POINTS.to_owned();
        self.points_m.iter().flatten().try_for_each(|coordinate| {
            let checked = HAND_COORDINATE.check(*coordinate);
            checked.map(|_| ()).map_err(|source| HandError::OutOfRange { key: key(), source })
        })
    }

    /// An input; `None` for one that the method does without.
    fn number(&self, field: &'static HandField) -> Result<Option<HandNumber>, HandError> {
        let key = field.si_key();
        let stated = self.inputs.get(&key).copied().unwrap_or_default();
        let (value, is_value_assumed) = match (stated.value, field.default) {
            (Some(value), _) => (value, false),
            (None, HandDefault::Value(value)) => (value, true),
            (None, HandDefault::Open) if stated.sigma.is_none() => return Ok(None),
            (None, HandDefault::Open | HandDefault::Required) => {
                let missing = format!("{} ({key})", field.label);
                let (method, known) = (self.method.word(), self.known());
                return Err(HandError::Missing { method, missing, known });
            }
        };
        let out_of_range = |source| HandError::OutOfRange { key: key.clone(), source };
        field.range.check(value).map_err(out_of_range)?;
        let sigma = stated.sigma.unwrap_or_else(|| field.usual_sigma(value));
        field.sigma_range().check(sigma).map_err(out_of_range)?;
        let is_sigma_assumed = stated.sigma.is_none();
        Ok(Some(HandNumber { field, value, sigma, is_value_assumed, is_sigma_assumed }))
    }

    /// The value of each field of the method.
    fn table(&self, numbers: &[HandNumber]) -> Vec<Option<f64>> {
        let value = |field: &HandField| {
            numbers.iter().find(|number| number.field.key == field.key).map(|number| number.value)
        };
        self.method.fields().iter().map(value).collect()
    }

    fn values<'b>(&self, numbers: &'b [Option<f64>], points_m: &'b [[f64; 2]]) -> HandValues<'b> {
        HandValues { fields: self.method.fields(), numbers, points_m }
    }

    /// Computes what follows.
    ///
    /// - `draws`: number of draws;
    /// - `seed`: of the draws.
    ///
    /// # Errors
    /// As for [`Self::numbers`], and [`HandError::Unsolved`] if nothing follows, or from too many draws nothing.
    pub fn answer(&self, draws: usize, seed: u64) -> Result<HandAnswer, HandError> {
        let numbers = self.numbers()?;
        let formula = self.method.formula();
        let table = self.table(&numbers);
        let at = self.values(&table, self.points_m);
        let outputs = (formula.solve)(&at);
        let unsolved = |share| HandError::Unsolved { method: self.method.word(), share };
        if !outputs.first().is_some_and(|value| value.is_finite()) {
            return Err(unsolved(100.0));
        }
        let sensitivities = self.sensitivities(&numbers, &table);
        let drawn = self.drawn(&numbers, &table, (draws, seed), OfRule::Together);
        let has_rule = numbers.iter().any(|number| number.rule().is_some());
        let apart = has_rule.then(|| self.drawn(&numbers, &table, (draws, seed), OfRule::Apart));
        let sets: Vec<&Vec<Vec<f64>>> = [&drawn].into_iter().chain(&apart).collect();
        let n_solved = sets.iter().map(|set| set.len()).min().unwrap_or(0);
        let n_unsolved = draws - n_solved;
        if n_unsolved as f64 > LARGEST_UNSOLVED_SHARE * draws as f64 {
            return Err(unsolved(100.0 * n_unsolved as f64 / draws as f64));
        }
        let is_exact =
            numbers.iter().all(|number| number.sigma == 0.0) && self.point_error(&table) == 0.0;
        let quantities = formula.outputs.iter().zip(&outputs).enumerate();
        let quantities = quantities.filter(|(_, (_, value))| value.is_finite());
        let quantities = quantities
            .filter_map(|(idx, (output, &value))| {
                let sigma = first_order(&sensitivities, idx);
                let all = widest(&sets, idx, draws)?;
                let estimate = if is_exact { all.without_intervals() } else { all };
                Some(HandQuantity { output, value, sigma, estimate })
            })
            .collect();
        let margin = formula.outputs.iter().position(|output| output.key == "margin_m");
        let avoided_share = margin
            .filter(|idx| outputs.get(*idx).is_some_and(|value| value.is_finite()))
            .map(|idx| share_of(&drawn, |outputs| outputs.get(idx).is_some_and(|m| *m >= 0.0)));
        let violated = (formula.warn)(&at, &outputs);
        let in_draws = sets.iter().filter_map(|set| formula.violated_in_draws(&at, set));
        let violated_in_draws =
            in_draws.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|_| violated.is_empty());
        Ok(HandAnswer {
            numbers,
            quantities,
            sensitivities,
            violated,
            violated_in_draws,
            n_unsolved,
            avoided_share,
        })
    }

    /// Standard deviation of the points of a mark, m; 0 without any.
    fn point_error(&self, table: &[Option<f64>]) -> f64 {
        match self.points_m.is_empty() {
            true => 0.0,
            false => self.values(table, &[]).get(POINT_ERROR).unwrap_or(0.0),
        }
    }

    fn sensitivities(&self, numbers: &[HandNumber], table: &[Option<f64>]) -> Vec<HandSensitivity> {
        let solve = self.method.formula().solve;
        let change = |low: &HandValues<'_>, high: &HandValues<'_>| -> Vec<Option<f64>> {
            let pairs = solve(low).into_iter().zip(solve(high));
            pairs.map(|(low, high)| Some(high - low).filter(|change| change.is_finite())).collect()
        };
        let of_number = |number: &HandNumber| {
            let is_exact = number.sigma == 0.0;
            let step = if is_exact { EXACT_STEP * number.value.abs() } else { number.sigma };
            let field = number.field;
            let idx = self.method.fields().iter().position(|of| of.key == field.key)?;
            let moved = |value: f64| {
                let mut moved = table.to_vec();
                if let Some(entry) = moved.get_mut(idx) {
                    *entry = Some(value);
                }
                moved
            };
            let ends = [-step / 2.0, step / 2.0]
                .map(|by| (number.value + by).clamp(field.range.low, field.range.high));
            // At the end of its range it moves to one side alone, by half of the step.
            let per_step = step / (ends[1] - ends[0]);
            let [low, high] = ends.map(moved);
            let points = self.points_m;
            let changes = change(&self.values(&low, points), &self.values(&high, points));
            let changes = changes.into_iter().map(|of| of.map(|of| of * per_step)).collect();
            let (input, label) = (field.si_key(), field.label);
            let rule = number.rule().map(|rule| (rule, number.value < 0.0));
            (step > 0.0).then_some(HandSensitivity { input, label, step, is_exact, rule, changes })
        };
        let moves = numbers.iter().filter(|number| number.field.key != POINT_ERROR);
        let mut all: Vec<HandSensitivity> = moves.filter_map(of_number).collect();
        all.extend(self.sensitivity_to_points(table, change));
        all
    }

    /// What the errors of all points of a mark bring together.
    fn sensitivity_to_points(
        &self,
        table: &[Option<f64>],
        change: impl Fn(&HandValues<'_>, &HandValues<'_>) -> Vec<Option<f64>>,
    ) -> Option<HandSensitivity> {
        let step = self.point_error(table);
        if step == 0.0 {
            return None;
        }
        let mut squares = vec![Some(0.0); self.method.outputs().len()];
        for point in 0..self.points_m.len() {
            for axis in [0, 1] {
                let moved = |by: f64| {
                    let mut moved = self.points_m.to_vec();
                    if let Some(point) = moved.get_mut(point) {
                        point[axis] += by;
                    }
                    moved
                };
                let [low, high] = [moved(-step / 2.0), moved(step / 2.0)];
                let changes = change(&self.values(table, &low), &self.values(table, &high));
                for (sum, change) in squares.iter_mut().zip(changes) {
                    *sum = sum.zip(change).map(|(sum, change): (f64, f64)| sum + change * change);
                }
            }
        }
        let changes = squares.into_iter().map(|sum| sum.map(f64::sqrt)).collect();
        let (input, label) = (POINTS.to_owned(), "points of the mark");
        Some(HandSensitivity { input, label, step, is_exact: false, rule: None, changes })
    }

    /// The inputs that are not exact.
    fn varied(&self, numbers: &[HandNumber]) -> Vec<Drawn> {
        let fields = self.method.fields();
        let varied: Vec<&HandNumber> = numbers.iter().filter(|number| number.sigma > 0.0).collect();
        let drawn = varied.iter().enumerate().filter_map(|(own, number)| {
            let idx = fields.iter().position(|field| field.key == number.field.key)?;
            let of_rule = varied.iter().position(|of| of.rule() == number.rule());
            let first = number.rule().and(of_rule).unwrap_or(own);
            let is_mirrored = (number.value < 0.0) != (varied[first].value < 0.0);
            Some(Drawn { idx, distribution: number.distribution(), first, is_mirrored })
        });
        drawn.collect()
    }

    /// The outputs of each draw from which the first one follows. Inputs that are of no rule are the same in both
    /// kinds of draws.
    fn drawn(
        &self,
        numbers: &[HandNumber],
        table: &[Option<f64>],
        (draws, seed): (usize, u64),
        of_rule: OfRule,
    ) -> Vec<Vec<f64>> {
        let solve = self.method.formula().solve;
        let varied = self.varied(numbers);
        let mut probabilities = vec![0.0; varied.len()];
        let point_error = self.point_error(table);
        let [mut rng, mut rng_apart] = [0, 1].map(|number| random_stream(seed, "hand", number));
        let (mut numbers, mut points) = (table.to_vec(), self.points_m.to_vec());
        let mut outputs = Vec::with_capacity(draws);
        for _ in 0..draws {
            for (own, input) in varied.iter().enumerate() {
                probabilities[own] = match of_rule {
                    _ if input.first == own => rng.random::<f64>(),
                    OfRule::Apart => rng_apart.random::<f64>(),
                    OfRule::Together if input.is_mirrored => 1.0 - probabilities[input.first],
                    OfRule::Together => probabilities[input.first],
                };
                if let Some(entry) = numbers.get_mut(input.idx) {
                    *entry = Some(input.distribution.quantile(probabilities[own]));
                }
            }
            if point_error > 0.0 {
                for (point, known) in points.iter_mut().zip(self.points_m) {
                    // Half open intervals leave out 0, where a normal variable is infinite.
                    let mut normal = || normal_quantile(1.0 - rng.random::<f64>()).clamp(-9.0, 9.0);
                    *point = known.map(|coordinate| coordinate + point_error * normal());
                }
            }
            outputs.push(solve(&self.values(&numbers, &points)));
        }
        outputs.retain(|of: &Vec<f64>| of.first().is_some_and(|value| value.is_finite()));
        outputs
    }
}

#[cfg(test)]
#[path = "calculation_tests.rs"]
pub(super) mod tests;
