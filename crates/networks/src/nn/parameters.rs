//! The parameters of a network by name, in the order of its layers.

use std::fmt::Display;

use candle_core::{DType, Device, Tensor, Var};
use rand_chacha::ChaCha8Rng;

use crate::nn::named_tensors::{check_finite, check_no_other, find};
use crate::nn::{Init, NamedTensors, NnError};

/// Numbers of all parameters of a network together. A training holds them some six times in up to 64
/// bits, as values, gradients, moments and copies: less than a gigabyte.
pub const MAX_PARAMETERS: usize = 16_000_000;

/// Tensors of a network.
pub const MAX_PARAMETER_TENSORS: usize = 1_000;

/// Every parameter of a network, in the order in which its layers were made.
///
/// The layers share these tensors, so that they compute with the values that the optimiser or
/// [`Parameters::import`] writes.
#[derive(Debug)]
pub struct Parameters {
    number_type: DType,
    entries: Vec<Parameter>,
    /// How many numbers may still be added.
    n_left: usize,
}

/// A parameter and whether it is trained.
#[derive(Debug)]
pub(crate) struct Parameter {
    pub(crate) name: String,
    pub(crate) variable: Var,
    pub(crate) trained: bool,
}

impl Parameters {
    /// An empty list of parameters.
    ///
    /// - `number_type`: [`DType::F32`], or [`DType::F64`] for checks of gradients.
    pub fn new(number_type: DType) -> Self {
        Self { number_type, entries: Vec::new(), n_left: MAX_PARAMETERS }
    }

    /// The same, for at most `n_values` numbers, such as those that a file holds.
    #[must_use]
    pub(crate) fn at_most(self, n_values: usize) -> Self {
        Self { n_left: n_values.min(MAX_PARAMETERS), ..self }
    }

    /// The builder through which layers add their parameters, whose first values are drawn from `rng`.
    pub fn builder<'a>(&'a mut self, rng: &'a mut ChaCha8Rng) -> ParameterBuilder<'a> {
        ParameterBuilder { parameters: self, rng, prefix: String::new() }
    }

    /// The number type of all parameters.
    pub fn number_type(&self) -> DType {
        self.number_type
    }

    /// Names and values in their order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&str, &Var)> {
        self.entries.iter().map(|entry| (entry.name.as_str(), &entry.variable))
    }

    pub(crate) fn entries(&self) -> &[Parameter] {
        &self.entries
    }

    /// The parameter of this name.
    pub fn get(&self, name: &str) -> Option<&Var> {
        self.entries.iter().find(|entry| entry.name == name).map(|entry| &entry.variable)
    }

    /// Number of values of all parameters together.
    pub fn n_values(&self) -> usize {
        self.entries.iter().map(|entry| entry.variable.elem_count()).sum()
    }

    /// Selects by name the parameters that the optimiser changes. Without a call it changes all.
    ///
    /// - returns the number of parameters that it changes.
    pub fn set_trained(&mut self, is_trained: impl Fn(&str) -> bool) -> usize {
        self.entries.iter_mut().for_each(|entry| entry.trained = is_trained(&entry.name));
        self.entries.iter().filter(|entry| entry.trained).count()
    }

    /// Takes the room for a parameter from what is left.
    ///
    /// # Errors
    /// [`NnError::TooManyParameters`] if there is not enough.
    fn reserve(&mut self, name: &str, shape: &[usize]) -> Result<(), NnError> {
        let too_many =
            |what, limit| NnError::TooManyParameters { name: name.to_owned(), what, limit };
        if self.entries.len() >= MAX_PARAMETER_TENSORS {
            return Err(too_many("tensors", MAX_PARAMETER_TENSORS));
        }
        let n_values = shape.iter().try_fold(1_usize, |n, length| n.checked_mul(*length));
        let n_left = n_values.and_then(|n_values| self.n_left.checked_sub(n_values));
        let limit = || self.n_values() + self.n_left;
        self.n_left = n_left.ok_or_else(|| too_many("numbers", limit()))?;
        Ok(())
    }

    /// Copies of all parameters, in their number type.
    ///
    /// # Errors
    /// [`NnError::NonFinite`] with the first number that is not finite.
    pub fn export(&self) -> Result<NamedTensors, NnError> {
        let mut tensors = NamedTensors::new();
        for (name, variable) in self.iter() {
            check_finite(name, variable)?;
            tensors.insert(name.to_owned(), variable.as_detached_tensor().copy()?);
        }
        Ok(tensors)
    }

    /// Takes over the values of tensors with exactly the names and shapes of the parameters.
    /// Nothing is changed unless all of them fit.
    ///
    /// # Errors
    /// [`NnError::MissingTensor`], [`NnError::UnexpectedTensor`], [`NnError::WrongShape`],
    /// [`NnError::NonFinite`], each with the first tensor it holds for.
    pub fn import(&self, tensors: &NamedTensors) -> Result<(), NnError> {
        let mut checked = Vec::with_capacity(self.entries.len());
        for (name, variable) in self.iter() {
            let tensor = find(tensors, name, variable.dims())?;
            checked.push(tensor.to_dtype(self.number_type)?.contiguous()?);
        }
        check_no_other(tensors, |name| self.get(name).is_some())?;
        for (entry, tensor) in self.entries.iter().zip(&checked) {
            entry.variable.set(tensor)?;
        }
        Ok(())
    }
}

/// A place in the tree of names, such as `trunk.0`, where a layer adds its parameters.
#[derive(Debug)]
pub struct ParameterBuilder<'a> {
    parameters: &'a mut Parameters,
    rng: &'a mut ChaCha8Rng,
    prefix: String,
}

impl ParameterBuilder<'_> {
    /// The place `name` below this one.
    pub fn at(&mut self, name: impl Display) -> ParameterBuilder<'_> {
        let prefix = self.name(name);
        ParameterBuilder { parameters: self.parameters, rng: self.rng, prefix }
    }

    /// The name of this place, which a layer names itself by in errors.
    pub fn prefix(&self) -> &str {
        &self.prefix
    }

    /// Adds a parameter below this place and returns the tensor that follows its value.
    ///
    /// # Errors
    /// [`NnError::DuplicateParameter`], [`NnError::TooManyParameters`] before anything is allocated.
    pub fn add(&mut self, name: &str, shape: &[usize], init: Init) -> Result<Tensor, NnError> {
        let name = self.name(name);
        if self.parameters.get(&name).is_some() {
            return Err(NnError::DuplicateParameter { name });
        }
        self.parameters.reserve(&name, shape)?;
        let values = Tensor::from_vec(init.values(shape, self.rng), shape, &Device::Cpu)?;
        let variable = Var::from_tensor(&values.to_dtype(self.parameters.number_type)?)?;
        let tensor = variable.as_tensor().clone();
        self.parameters.entries.push(Parameter { name, variable, trained: true });
        Ok(tensor)
    }

    fn name(&self, name: impl Display) -> String {
        if self.prefix.is_empty() { name.to_string() } else { format!("{}.{name}", self.prefix) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::numerics::random_stream;

    fn two(seed: u64) -> Parameters {
        let mut parameters = Parameters::new(DType::F32);
        let mut rng = random_stream(seed, "weights", 0);
        let mut root = parameters.builder(&mut rng);
        let mut trunk = root.at("trunk");
        trunk.at(0).add("weight", &[2, 3], Init::KaimingNormal).unwrap();
        trunk.at(0).add("bias", &[2], Init::Zero).unwrap();
        parameters
    }

    fn bits(parameters: &Parameters) -> Vec<u32> {
        let all = parameters.iter();
        let values = all.flat_map(|(_, v)| v.flatten_all().unwrap().to_vec1::<f32>().unwrap());
        values.map(f32::to_bits).collect()
    }

    #[test]
    fn names_follow_the_layers_in_their_order() {
        let parameters = two(1);
        let names: Vec<_> = parameters.iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["trunk.0.weight", "trunk.0.bias"]);
        assert_eq!(parameters.n_values(), 8);
        assert_eq!(bits(&two(1)), bits(&two(1)));
        assert_ne!(bits(&two(1)), bits(&two(2)));
    }

    #[test]
    fn exported_and_imported_parameters_have_the_same_bits() {
        let (from, to) = (two(1), two(2));
        to.import(&from.export().unwrap()).unwrap();
        assert_eq!(bits(&from), bits(&to));
    }

    #[test]
    fn tensors_that_do_not_fit_change_nothing_and_are_named() {
        let parameters = two(1);
        let before = bits(&parameters);
        let good = two(2).export().unwrap();
        let device = Device::Cpu;
        let import = |change: &dyn Fn(&mut NamedTensors)| {
            let mut tensors = good.clone();
            change(&mut tensors);
            parameters.import(&tensors).unwrap_err().to_string()
        };
        let error = import(&|tensors| drop(tensors.remove("trunk.0.bias")));
        assert_eq!(error, "the tensor \"trunk.0.bias\" is missing");
        let zeros = Tensor::zeros(3, DType::F32, &device).unwrap();
        let error = import(&|tensors| drop(tensors.insert("head".into(), zeros.clone())));
        assert_eq!(error, "the tensor \"head\" is unexpected; the model has none of this name");
        let error = import(&|tensors| drop(tensors.insert("trunk.0.bias".into(), zeros.clone())));
        assert_eq!(error, "the tensor \"trunk.0.bias\" has the shape [3], expected [2]");
        let nan = Tensor::new(&[0.0, f32::NAN], &device).unwrap();
        let error = import(&|tensors| drop(tensors.insert("trunk.0.bias".into(), nan.clone())));
        let expected = "holds NaN at index 1, expected finite numbers";
        assert_eq!(error, format!("the tensor \"trunk.0.bias\" {expected}"));
        assert_eq!(bits(&parameters), before);
    }

    #[test]
    fn sizes_are_checked_before_anything_is_allocated() {
        let mut rng = random_stream(1, "weights", 0);
        for shape in [&[1 << 40, 1 << 40][..], &[usize::MAX, 2], &[16_000_001]] {
            let mut parameters = Parameters::new(DType::F32);
            let error = parameters.builder(&mut rng).add("w", shape, Init::Zero).unwrap_err();
            let expected = "w: the network has more than 16000000 numbers";
            assert!(error.to_string().starts_with(expected), "{shape:?}: {error}");
        }
        let mut parameters = Parameters::new(DType::F32).at_most(5);
        let mut builder = parameters.builder(&mut rng);
        builder.add("a", &[2, 2], Init::Zero).unwrap();
        let error = builder.add("b", &[2], Init::Zero).unwrap_err().to_string();
        assert!(error.starts_with("b: the network has more than 5 numbers"), "{error}");
        let mut many = Parameters::new(DType::F32);
        let mut builder = many.builder(&mut rng);
        let error = (0..).find_map(|i| builder.at(i).add("w", &[1], Init::Zero).err()).unwrap();
        assert!(error.to_string().contains("more than 1000 tensors"), "{error}");
    }

    #[test]
    fn a_name_is_given_once() {
        let (mut parameters, mut rng) = (two(1), random_stream(1, "weights", 1));
        let error = parameters.builder(&mut rng).add("trunk.0.bias", &[1], Init::Zero);
        assert!(
            matches!(error, Err(NnError::DuplicateParameter { name }) if name == "trunk.0.bias")
        );
    }
}
