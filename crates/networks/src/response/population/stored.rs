//! The distribution of strengths over cars in a model file.

use candle_core::{Device, Tensor};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::nn::{Checkpoint, Expected, NamedTensors, NnError, check_number, check_numbers};
use crate::response::population::linearized::N_ROWS;
use crate::response::{CarStrengths, KnownCar, N_EFFECTS, StrengthPopulation, Widths};
use impactlab_core::vehicle::VehicleParameters;

/// Key of the metadata and group of the tensors.
const NAME: &str = "population";

/// What of a distribution is no matrix.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stored {
    noise: [f64; N_ROWS],
    remainder: f64,
    widening: f64,
    #[serde(default = "normal")]
    tail_ratio: f64,
    #[serde(default)]
    growth: f64,
    #[serde(default = "not_wider")]
    braked: f64,
    step_noise: f64,
    cars: Vec<StoredCar>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredCar {
    vehicle: VehicleParameters,
    n_trajectories: usize,
    remainder: f64,
    widening: f64,
    #[serde(default = "normal")]
    tail_ratio: f64,
    #[serde(default)]
    growth: f64,
    #[serde(default = "not_wider")]
    braked: f64,
}

impl StrengthPopulation {
    /// Puts the distribution into a file.
    ///
    /// # Errors
    /// [`NnError`].
    pub(crate) fn put(&self, file: &mut Checkpoint) -> Result<(), NnError> {
        let mut tensors = NamedTensors::new();
        let mut add = |name: String, matrix: &DMatrix<f64>| -> Result<(), NnError> {
            tensors.insert(name, tensor(matrix)?);
            Ok(())
        };
        let row =
            |vector: &DVector<f64>| DMatrix::from_column_slice(1, N_EFFECTS, vector.as_slice());
        add("mean".to_owned(), &row(&self.mean))?;
        add("between".to_owned(), &self.between)?;
        add("within".to_owned(), &self.within)?;
        add("bare".to_owned(), &self.bare)?;
        add("importance".to_owned(), &self.importance)?;
        let mut cars = Vec::new();
        for (i, car) in self.cars.iter().enumerate() {
            add(format!("car{i}.covariance"), &car.strengths.covariance)?;
            add(format!("car{i}.mean"), &row(&car.strengths.mean))?;
            let (vehicle, n_trajectories) = (car.vehicle.clone(), car.n_trajectories);
            let CarStrengths { remainder, widths, .. } = car.strengths;
            let Widths { widening, tail_ratio, growth, braked } = widths;
            cars.push(StoredCar {
                vehicle,
                n_trajectories,
                remainder,
                widening,
                tail_ratio,
                growth,
                braked,
            });
        }
        let Self { noise, remainder, step_noise, widths, .. } = *self;
        let Widths { widening, tail_ratio, growth, braked } = widths;
        file.put(
            NAME,
            &Stored { noise, remainder, widening, tail_ratio, growth, braked, step_noise, cars },
        )?;
        file.put_group(NAME, tensors);
        Ok(())
    }

    /// Takes the distribution out of a file, if it has one.
    ///
    /// # Errors
    /// [`NnError`] if a matrix is missing, has another shape or is no covariance, or a number is out
    /// of range.
    pub(crate) fn take(file: &mut Checkpoint) -> Result<Option<Self>, NnError> {
        let Some(stored): Option<Stored> = file.find(NAME)? else { return Ok(None) };
        check_numbers("population.noise", &stored.noise, Expected::NotNegative)?;
        check_number("population.remainder", stored.remainder, Expected::NotNegative)?;
        let Stored { widening, tail_ratio, growth, braked, .. } = stored;
        let widths = checked("population", Widths { widening, tail_ratio, growth, braked })?;
        check_number("population.step_noise", stored.step_noise, Expected::NotNegative)?;
        let tensors = file.take_group(NAME);
        let matrix = |name: &str, n_rows: usize| matrix(&tensors, name, n_rows);
        let covariance = |name: &str| -> Result<DMatrix<f64>, NnError> {
            let found = matrix(name, N_EFFECTS)?;
            // One that is none would give no directions, and bands without a width.
            if found.clone().cholesky().is_none() {
                let value = found.symmetric_eigenvalues().min();
                let (name, expected) = (format!("{NAME}.{name}"), "a covariance".to_owned());
                return Err(NnError::StoredNumber { name, value, expected });
            }
            Ok(found)
        };
        let row = |name: &str| -> Result<DVector<f64>, NnError> {
            Ok(DVector::from_iterator(N_EFFECTS, matrix(name, 1)?.iter().copied()))
        };
        let mut cars = Vec::new();
        for (i, car) in stored.cars.into_iter().enumerate() {
            let StoredCar { vehicle, n_trajectories, remainder, .. } = car;
            let StoredCar { widening, tail_ratio, growth, braked, .. } = car;
            check_number("population.car.remainder", remainder, Expected::NotNegative)?;
            let strengths = CarStrengths {
                mean: row(&format!("car{i}.mean"))?,
                covariance: covariance(&format!("car{i}.covariance"))?,
                remainder,
                widths: checked("population.car", Widths { widening, tail_ratio, growth, braked })?,
            };
            cars.push(KnownCar { vehicle, n_trajectories, strengths });
        }
        Ok(Some(Self {
            mean: row("mean")?,
            remainder: stored.remainder,
            between: covariance("between")?,
            bare: covariance("bare")?,
            importance: matrix("importance", N_EFFECTS)?,
            within: covariance("within")?,
            noise: stored.noise,
            widths,
            step_noise: stored.step_noise,
            cars,
        }))
    }
}

/// The ratio of the widths in a file from before there were two.
fn normal() -> f64 {
    Widths::NORMAL.tail_ratio
}

/// The factor for braked wheels in a file from before there was one.
fn not_wider() -> f64 {
    Widths::NORMAL.braked
}

fn checked(name: &str, widths: Widths) -> Result<Widths, NnError> {
    check_number(&format!("{name}.widening"), widths.widening, Expected::NotNegative)?;
    check_number(&format!("{name}.tail_ratio"), widths.tail_ratio, Expected::Positive)?;
    check_number(&format!("{name}.growth"), widths.growth, Expected::NotNegative)?;
    check_number(&format!("{name}.braked"), widths.braked, Expected::Positive)?;
    Ok(widths)
}

fn tensor(matrix: &DMatrix<f64>) -> Result<Tensor, NnError> {
    let rows: Vec<f64> = matrix.transpose().iter().copied().collect();
    Ok(Tensor::from_vec(rows, matrix.shape(), &Device::Cpu)?)
}

fn matrix(tensors: &NamedTensors, name: &str, n_rows: usize) -> Result<DMatrix<f64>, NnError> {
    let missing = || NnError::MissingTensor { name: format!("{NAME}.{name}") };
    let tensor = tensors.get(name).ok_or_else(missing)?;
    let shape = [n_rows, N_EFFECTS];
    if tensor.dims() != shape {
        return Err(NnError::WrongShape {
            name: format!("{NAME}.{name}"),
            got: tensor.dims().to_vec(),
            expected: shape.to_vec(),
        });
    }
    let rows: Vec<f64> = tensor.flatten_all()?.to_vec1()?;
    check_numbers(&format!("{NAME}.{name}"), &rows, Expected::Magnitude(1e9))?;
    Ok(DMatrix::from_row_slice(n_rows, N_EFFECTS, &rows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::ModelKind;

    #[test]
    fn a_matrix_that_is_no_covariance_is_refused_by_its_name() {
        let taken = |population: &StrengthPopulation| {
            let mut file = Checkpoint::new(ModelKind { name: "test", version: 1 });
            population.put(&mut file).unwrap();
            StrengthPopulation::take(&mut file)
        };
        let mut population = StrengthPopulation::guess();
        assert_eq!(taken(&population).unwrap().as_ref(), Some(&population));
        population.within[(3, 3)] = -1e-3;
        let error = taken(&population).unwrap_err().to_string();
        assert!(error.contains("population.within") && error.contains("-0.001"), "{error}");
        let mut none = Checkpoint::new(ModelKind { name: "test", version: 1 });
        assert!(StrengthPopulation::take(&mut none).unwrap().is_none());
    }
}
