//! Sobol indices: which input of a sweep moves an outcome, alone and with the others.
//!
//! ```text
//! A, B         two independent sets of n points;  AB_j: A with input j from B
//! V = Σ (f_A² + f_B²)/2n                          f less its mean
//! S_j = Σ f_B (f_ABj − f_A)/(n V)                 first order
//! T_j = Σ (f_A − f_ABj)²/(2 n V)                  total, with all that j does together with others
//! ```
//!
//! Source: Saltelli et al. (2010), Computer Physics Communications 181, 259–270, table 2, (b) and (f);
//! (f) is of Jansen (1999). The standard errors are those of a ratio of means (delta method) of
//! independent points, which is more than the error of points that fill the space evenly.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::{Column, Outcome, Rows, UNKNOWNS};

/// Fewest base points of which indices are told.
const MIN_BASES: usize = 100;

/// Least share of the base points of which every row has the outcome: of fewer the indices would be those
/// of a part of the space.
const LEAST_COMPLETE: f64 = 0.9;

/// Values that rows of base points repeat of A or B, from which on they are no chance: each of an input of two
/// values would be so in every second of independent rows.
const LEAST_REPEATED: usize = 40;

/// How an input moves an outcome: shares of its variance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensitivity {
    /// The input; `unknowns` is all that a draw leaves open.
    pub name: String,
    /// First-order index: the share that goes with this input alone.
    pub first: f64,
    /// Its standard error.
    pub first_error: f64,
    /// Total index: the share that this input has a part in.
    pub total: f64,
    /// Its standard error.
    pub total_error: f64,
}

/// Sobol indices of an outcome.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutcomeSensitivity {
    /// The outcome.
    pub outcome: String,
    /// Base points that they rest on.
    pub n_bases: u64,
    /// Of every input, in the order of the plan.
    pub inputs: Vec<Sensitivity>,
}

/// Why there are no Sobol indices.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SensitivityError {
    /// The rows are not those of a Saltelli design.
    #[error("they are no Saltelli design of {n_inputs} inputs; plan it with design = \"saltelli\"")]
    NoDesign {
        /// Inputs that vary.
        n_inputs: usize,
    },
    /// There are too few base points.
    #[error("there are {n} base points, expected {MIN_BASES} or more")]
    FewBases {
        /// Base points.
        n: usize,
    },
    /// The values are not those of all matrices of all base points.
    #[error("there are {n} values, expected a multiple of {size}")]
    Values {
        /// Values.
        n: usize,
        /// Rows of a base point.
        size: usize,
    },
    /// The outcome is the same in all rows.
    #[error("the outcome is the same in all rows")]
    NoVariance,
}

impl Sensitivity {
    /// Whether all its numbers are finite.
    pub(super) fn is_finite(&self) -> bool {
        let Self { name: _, first, first_error, total, total_error } = self;
        [first, first_error, total, total_error].iter().all(|number| number.is_finite())
    }
}

/// The Sobol indices of every input.
///
/// - `names`: the k inputs;
/// - `values`: outcome of the k + 2 rows of each base point, one base point after the other: A, B, then
///   A with each input from B.
///
/// # Errors
/// [`SensitivityError`] where they cannot be told.
pub fn sobol_indices(
    names: &[String],
    values: &[f64],
) -> Result<Vec<Sensitivity>, SensitivityError> {
    let size = names.len() + 2;
    if !values.len().is_multiple_of(size) {
        return Err(SensitivityError::Values { n: values.len(), size });
    }
    let n = values.len() / size;
    if n < MIN_BASES {
        return Err(SensitivityError::FewBases { n });
    }
    let both = values.chunks_exact(size).filter_map(|base| base.get(..2)).flatten();
    let mean = both.sum::<f64>() / (2 * n) as f64;
    let bases: Vec<Vec<f64>> = values
        .chunks_exact(size)
        .map(|base| base.iter().map(|value| value - mean).collect())
        .collect();
    let squares: Vec<f64> = bases
        .iter()
        .map(|base| 0.5 * base.iter().take(2).map(|value| value * value).sum::<f64>())
        .collect();
    let variance = squares.iter().sum::<f64>() / n as f64;
    // A variance of rounding alone is none.
    if variance <= 1e-20 * mean * mean || !variance.is_finite() || variance == 0.0 {
        return Err(SensitivityError::NoVariance);
    }
    let index = |of: &dyn Fn(&[f64]) -> f64| {
        let terms: Vec<f64> = bases.iter().map(|base| of(base)).collect();
        ratio_of_means(&terms, &squares)
    };
    let indices = names.iter().enumerate().map(|(input, name)| {
        let parts = |base: &[f64]| match base {
            [a, b, mixed @ ..] => (*a, *b, mixed.get(input).copied().unwrap_or(*a)),
            _ => (0.0, 0.0, 0.0),
        };
        let (first, first_error) = index(&|base| {
            let (a, b, mixed) = parts(base);
            b * (mixed - a)
        });
        let (total, total_error) = index(&|base| {
            let (a, _, mixed) = parts(base);
            0.5 * (a - mixed) * (a - mixed)
        });
        Sensitivity { name: name.clone(), first, first_error, total, total_error }
    });
    Ok(indices.collect())
}

/// The mean of some terms over that of others, and its standard error.
fn ratio_of_means(above: &[f64], below: &[f64]) -> (f64, f64) {
    let n = above.len() as f64;
    let below_mean = below.iter().sum::<f64>() / n;
    let ratio = above.iter().sum::<f64>() / n / below_mean;
    let rest = above.iter().zip(below).map(|(above, below)| above - ratio * below);
    let variance = rest.map(|rest| rest * rest).sum::<f64>() / (n - 1.0);
    (ratio, (variance / n).sqrt() / below_mean)
}

/// The Sobol indices of every outcome of a Saltelli design that has them; an outcome that applies to too
/// few rows, or is always the same, has none.
pub(super) fn sensitivity_of_rows(
    rows: &Rows,
) -> Result<Vec<OutcomeSensitivity>, SensitivityError> {
    let n_inputs = rows.inputs.len();
    let order = places(rows);
    let design = [true, false]
        .into_iter()
        .find_map(|has_unknowns| SaltelliRows::new(rows, &order, has_unknowns))
        .ok_or(SensitivityError::NoDesign { n_inputs })?;
    if design.bases.len() < MIN_BASES {
        return Err(SensitivityError::FewBases { n: design.bases.len() });
    }
    let known = rows
        .outcomes
        .iter()
        .filter(|column| Outcome::ALL.iter().any(|outcome| outcome.name() == column.name));
    Ok(known.filter_map(|column| design.indices(column)).collect())
}

/// Whether rows are those of a Saltelli design, which do not vary independently of each other.
pub(super) fn is_saltelli(rows: &Rows) -> bool {
    let order = places(rows);
    [true, false].into_iter().any(|has_unknowns| {
        let design = SaltelliRows::new(rows, &order, has_unknowns);
        design.is_some_and(|it| it.n_repeated(&rows.inputs) >= LEAST_REPEATED)
    })
}

/// Where each row stands in the table, by its number.
fn places(rows: &Rows) -> BTreeMap<u64, usize> {
    rows.index.iter().enumerate().map(|(at, row)| (*row, at)).collect()
}

/// The rows of a Saltelli design, by their places in the table.
struct SaltelliRows {
    names: Vec<String>,
    /// Of each base point the rows A, B and A with each input from B.
    bases: Vec<Vec<usize>>,
}

impl SaltelliRows {
    /// Sorts rows into base points; `None` where they are not such rows.
    ///
    /// - `has_unknowns`: whether the unknowns are exchanged too, which are in no column.
    fn new(rows: &Rows, order: &BTreeMap<u64, usize>, has_unknowns: bool) -> Option<Self> {
        let mut names: Vec<String> = rows.inputs.iter().map(|input| input.name.clone()).collect();
        names.extend(has_unknowns.then(|| UNKNOWNS.to_owned()));
        let size = names.len() as u64 + 2;
        let base_rows = |base: u64| -> Option<Vec<usize>> {
            let place = |matrix| order.get(&base.checked_mul(size)?.checked_add(matrix)?).copied();
            (0..size).map(place).collect()
        };
        let mut numbers: Vec<u64> = order.keys().map(|row| row / size).collect();
        numbers.dedup();
        // A base point whose rows are not all there is left out.
        let bases: Vec<Vec<usize>> = numbers.into_iter().filter_map(base_rows).collect();
        let is_exchanged = |base: &Vec<usize>| is_base(&rows.inputs, base);
        (!bases.is_empty() && bases.iter().all(is_exchanged)).then_some(Self { names, bases })
    }

    /// How many values of A or B the other rows repeat, where A and B differ: rows that are all at one place are
    /// no design.
    fn n_repeated(&self, inputs: &[Column]) -> usize {
        let differ = |a: &usize, b: &usize| {
            inputs.iter().any(|column| column.values.get(*a) != column.values.get(*b))
        };
        let is_exchanged = |base: &&Vec<usize>| matches!(&base[..], [a, b, ..] if differ(a, b));
        self.bases.iter().filter(is_exchanged).count() * inputs.len() * self.names.len()
    }

    fn indices(&self, column: &Column) -> Option<OutcomeSensitivity> {
        let value = |at: &usize| column.values.get(*at).copied().unwrap_or(f64::NAN);
        let mut values = Vec::with_capacity(self.bases.len() * (self.names.len() + 2));
        let mut n_bases: u32 = 0;
        for base in &self.bases {
            let of_base: Vec<f64> = base.iter().map(value).collect();
            if of_base.iter().all(|value| value.is_finite()) {
                values.extend(of_base);
                n_bases += 1;
            }
        }
        if f64::from(n_bases) < LEAST_COMPLETE * self.bases.len() as f64 {
            return None;
        }
        let inputs = sobol_indices(&self.names, &values).ok()?;
        let outcome = column.name.clone();
        Some(OutcomeSensitivity { outcome, n_bases: u64::from(n_bases), inputs })
    }
}

/// Whether each row of a base point has the inputs of A, but for one from B.
fn is_base(inputs: &[Column], base: &[usize]) -> bool {
    let [a, b, mixed @ ..] = base else { return false };
    let is_same = |column: &Column, row: &usize, other: &usize| {
        let both = column.values.get(*row).zip(column.values.get(*other));
        both.is_some_and(|(value, other)| value.to_bits() == other.to_bits())
    };
    mixed.iter().enumerate().all(|(exchanged, row)| {
        inputs
            .iter()
            .enumerate()
            .all(|(input, column)| is_same(column, row, if input == exchanged { b } else { a }))
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use rand::RngExt;

    use super::*;
    use crate::RowsMeta;
    use crate::points::point;
    use impactlab_core::numerics::random_stream;

    fn names(n: usize) -> Vec<String> {
        (1..=n).map(|i| format!("x{i}")).collect()
    }

    /// Values of a function on a Saltelli design of points of twice as many dimensions.
    fn values(
        n_inputs: usize,
        points: impl Iterator<Item = Vec<f64>>,
        f: impl Fn(&[f64]) -> f64,
    ) -> Vec<f64> {
        let mut values = Vec::new();
        for point in points {
            let (a, b) = point.split_at(n_inputs);
            values.extend([f(a), f(b)]);
            for input in 0..n_inputs {
                let mut mixed = a.to_vec();
                mixed[input] = b[input];
                values.push(f(&mixed));
            }
        }
        values
    }

    /// sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ with x from −π to π, whose indices are known in closed form.
    #[test]
    fn the_indices_of_the_function_of_ishigami_are_those_of_its_closed_form() {
        let (a, b) = (7.0, 0.1);
        let f = |share: &[f64]| {
            let x: Vec<f64> = share.iter().map(|share| PI * (2.0 * share - 1.0)).collect();
            x[0].sin() + a * x[1].sin().powi(2) + b * x[2].powi(4) * x[0].sin()
        };
        let v1 = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
        let (v2, v13) = (a * a / 8.0, 8.0 * b * b * PI.powi(8) / 225.0);
        let v = v1 + v2 + v13;
        let first = [v1 / v, v2 / v, 0.0];
        let total = [(v1 + v13) / v, v2 / v, v13 / v];
        let points = (0..4096).map(|i| point(5, i, 6));
        let indices = sobol_indices(&names(3), &values(3, points, f)).unwrap();
        for (idx, told) in indices.iter().enumerate() {
            assert!((told.first - first[idx]).abs() < 0.02, "{told:?} {}", first[idx]);
            assert!((told.first - first[idx]).abs() < 4.0 * told.first_error + 1e-9, "{told:?}");
            assert!((told.total - total[idx]).abs() < 0.02, "{told:?} {}", total[idx]);
            assert!((told.total - total[idx]).abs() < 4.0 * told.total_error, "{told:?}");
        }
    }

    #[test]
    fn a_sum_has_shares_of_its_variance_and_errors_that_are_its_scatter() {
        let factors = [1.0, 2.0, 3.0];
        let f = |x: &[f64]| x.iter().zip(factors).map(|(x, a)| a * x).sum::<f64>();
        let exact = factors.map(|a| a * a / 14.0);
        let told: Vec<Vec<Sensitivity>> = (0..300)
            .map(|number| {
                let mut rng = random_stream(11, "sums", number);
                let points = (0..400).map(|_| (0..6).map(|_| rng.random::<f64>()).collect());
                sobol_indices(&names(3), &values(3, points, f)).unwrap()
            })
            .collect();
        for (input, exact) in exact.iter().enumerate() {
            let each = |of: fn(&Sensitivity) -> f64| -> Vec<f64> {
                told.iter().map(|indices| of(&indices[input])).collect()
            };
            let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
            for (values, errors) in [
                (each(|of| of.first), each(|of| of.first_error)),
                (each(|of| of.total), each(|of| of.total_error)),
            ] {
                let middle = mean(&values);
                let squares: Vec<f64> = values.iter().map(|it| (it - middle).powi(2)).collect();
                let scatter = mean(&squares).sqrt();
                assert!((middle - exact).abs() < 4.0 * scatter / 300_f64.sqrt() + 2e-3);
                let ratio = mean(&errors) / scatter;
                assert!((0.85..1.2).contains(&ratio), "{input}: {ratio}");
            }
        }
    }

    fn saltelli_rows(n_bases: u64, has_unknowns: bool) -> Rows {
        let n_inputs = 2;
        let size = n_inputs + usize::from(has_unknowns) + 2;
        let mut inputs = vec![Vec::new(); n_inputs];
        let mut travel = Vec::new();
        for base in 0..n_bases {
            let both = point(1, base, 6);
            for matrix in 0..size {
                let of = |input: usize| {
                    let is_of_b = matrix == 1 || matrix == 2 + input;
                    both[if is_of_b { 3 + input } else { input }]
                };
                for (input, values) in inputs.iter_mut().enumerate() {
                    values.push(of(input));
                }
                travel.push(of(0) + 2.0 * of(1) + if has_unknowns { 3.0 * of(2) } else { 0.0 });
            }
        }
        let n = travel.len();
        let column =
            |name: &str, values| Column { name: name.to_owned(), unit: "1".to_owned(), values };
        let [first, second] = <[Vec<f64>; 2]>::try_from(inputs).unwrap();
        Rows {
            inputs: vec![column("a", first), column("b", second)],
            outcomes: vec![column(Outcome::TravelM.name(), travel)],
            index: (0..n as u64).collect(),
            caveats: None,
            reasons: vec![String::new(); n],
            meta: RowsMeta::default(),
        }
    }

    #[test]
    fn rows_of_a_design_are_recognised_with_and_without_unknowns() {
        let indices = sensitivity_of_rows(&saltelli_rows(1024, true)).unwrap();
        let [of] = &indices[..] else { panic!("{indices:?}") };
        let names: Vec<&str> = of.inputs.iter().map(|input| input.name.as_str()).collect();
        assert_eq!((names, of.n_bases), (vec!["a", "b", UNKNOWNS], 1024));
        for (input, exact) in of.inputs.iter().zip([1.0, 4.0, 9.0]) {
            assert!((input.total - exact / 14.0).abs() < 0.02, "{input:?}");
        }
        let indices = sensitivity_of_rows(&saltelli_rows(1024, false)).unwrap();
        assert_eq!(indices[0].inputs.len(), 2);
        assert!(is_saltelli(&saltelli_rows(200, true)) && is_saltelli(&saltelli_rows(200, false)));
        // Many rows at one place are independent of each other.
        let mut one_place = saltelli_rows(200, true);
        one_place.inputs.iter_mut().for_each(|column| column.values.fill(0.5));
        assert!(!is_saltelli(&one_place));
    }

    /// Chunks of 1024 rows have 85 base points of the shipped plan; an atlas was made of them, with errors
    /// that were too small.
    #[test]
    fn a_chunk_with_few_base_points_is_recognised() {
        for n_bases in [10, 85] {
            for has_unknowns in [true, false] {
                assert!(is_saltelli(&saltelli_rows(n_bases, has_unknowns)), "{n_bases}");
            }
        }
        // One base point of choices may be so by chance.
        let mut choices = saltelli_rows(1, false);
        for column in &mut choices.inputs {
            column.values.iter_mut().for_each(|value| *value = (2.0 * *value).floor());
        }
        assert!(!is_saltelli(&choices));
    }

    #[test]
    fn other_rows_have_no_indices() {
        let mut turned = saltelli_rows(200, true);
        turned.inputs[0].values[3] += 1.0;
        let refused = sensitivity_of_rows(&turned);
        assert_eq!(refused, Err(SensitivityError::NoDesign { n_inputs: 2 }));
        let few = sensitivity_of_rows(&saltelli_rows(20, true));
        assert_eq!(few, Err(SensitivityError::FewBases { n: 20 }));
        // An outcome that often does not apply has none.
        let mut missing = saltelli_rows(200, true);
        missing.outcomes[0].values.iter_mut().step_by(10).for_each(|value| *value = f64::NAN);
        assert_eq!(sensitivity_of_rows(&missing), Ok(Vec::new()));
        let constant = [1.0; 400];
        assert_eq!(sobol_indices(&names(2), &constant), Err(SensitivityError::NoVariance));
        let cut = [1.0; 401];
        assert!(matches!(sobol_indices(&names(2), &cut), Err(SensitivityError::Values { .. })));
    }
}
