//! Model files as they are mutated: taken apart, changed, and put together with a checksum that
//! fits again, so that what stands behind the checksum is tried.

use std::collections::{BTreeMap, HashMap};

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::mutation::Mutator;

/// The key under which the program keeps its own part of the header.
const OUR_KEY: &str = "impactlab";

/// Type, shape and bytes of a tensor.
type Stored = (Dtype, Vec<usize>, Vec<u8>);

/// The contents of a model file.
struct Parts {
    /// Kind, version and metadata.
    header: Value,
    tensors: BTreeMap<String, Stored>,
}

impl Parts {
    /// `None` if the file is not a model, or no longer one.
    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let file = SafeTensors::deserialize(bytes).ok()?;
        let (_, header) = SafeTensors::read_metadata(bytes).ok()?;
        let mut header: Value =
            serde_json::from_str(header.metadata().as_ref()?.get(OUR_KEY)?).ok()?;
        header.as_object_mut()?.remove("sha256");
        let stored =
            |view: &TensorView<'_>| (view.dtype(), view.shape().to_vec(), view.data().to_vec());
        let tensors = file.tensors();
        let tensors = tensors.iter().map(|(name, view)| (name.clone(), stored(view)));
        Some(Self { header, tensors: tensors.collect() })
    }

    /// The bytes of a file with a checksum that fits; `None` if it cannot be written.
    ///
    /// - `header`: the text of kind, version and metadata, without the bracket that closes it.
    fn sealed(&self, header: &str) -> Option<Vec<u8>> {
        let views = self.tensors.iter().map(|(name, (dtype, shape, bytes))| {
            TensorView::new(*dtype, shape.clone(), bytes).map(|view| (name.as_str(), view))
        });
        let views: Vec<_> = views.collect::<Result<_, _>>().ok()?;
        let mut digest = Sha256::new();
        digest.update(header);
        for (name, view) in &views {
            digest.update(format!("\n{name:?} {:?} {:?}\n", view.dtype(), view.shape()));
            digest.update(view.data());
        }
        let sha256: String = digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        let ours = format!("{header},\"sha256\":\"{sha256}\"}}");
        safetensors::serialize(views, Some(HashMap::from([(OUR_KEY.to_owned(), ours)]))).ok()
    }

    /// The text that the checksum covers. Its keys stand in the order in which the program writes
    /// them.
    fn covered(&self) -> String {
        let of = |key: &str| self.header.get(key).map(Value::to_string);
        let known = ["kind", "version", "metadata"];
        let pairs = known.iter().filter_map(|key| Some(format!("\"{key}\":{}", of(key)?)));
        format!("{{{}", pairs.collect::<Vec<_>>().join(","))
    }
}

/// Another model file, in most cases with a checksum that fits.
pub fn mutated(mutator: &mut Mutator, input: &[u8], other: &[u8]) -> Vec<u8> {
    let parts = if mutator.once_in(16) { None } else { Parts::from_bytes(input) };
    let Some(mut parts) = parts else { return mutator.text(input, other) };
    let mut header = None;
    for _ in 0..=mutator.below(3) {
        match mutator.below(8) {
            0..4 => {
                let of = parts.header.get_mut("metadata");
                of.into_iter().for_each(|metadata| mutator.edit_json(metadata));
            }
            4 => mutator.edit_json(&mut parts.header),
            5 => header = Some(mutator.text(parts.covered().as_bytes(), b"")),
            _ => edit_tensor(mutator, &mut parts.tensors),
        }
    }
    let text = header.and_then(|bytes| String::from_utf8(bytes).ok());
    let sealed = parts.sealed(&text.unwrap_or_else(|| parts.covered()));
    sealed.unwrap_or_else(|| input.to_vec())
}

/// Changes numbers, name, type or shape of one tensor.
fn edit_tensor(mutator: &mut Mutator, tensors: &mut BTreeMap<String, Stored>) {
    let at = mutator.below(tensors.len());
    let Some(name) = tensors.keys().nth(at).cloned() else { return };
    let Some(mut tensor) = tensors.remove(&name) else { return };
    let other_name = tensors.keys().nth(mutator.below(tensors.len())).cloned();
    match mutator.below(8) {
        0 => return,
        1 => drop(tensors.insert(format!("{name}.{}", mutator.number()), tensor.clone())),
        2 => drop(other_name.map(|other| tensors.insert(other, tensor.clone()))),
        3 => reshape(mutator, &mut tensor),
        4 => {
            // As many bytes, other numbers.
            let is_wide = tensor.0 == Dtype::F64;
            tensor.0 = if is_wide { Dtype::F32 } else { Dtype::I32 };
            if is_wide {
                tensor.1.push(2);
            }
        }
        _ => edit_numbers(mutator, &mut tensor),
    }
    tensors.insert(name, tensor);
}

fn edit_numbers(mutator: &mut Mutator, (dtype, _, bytes): &mut Stored) {
    let value: f64 = mutator.number().parse().unwrap_or(1e30);
    let value: Vec<u8> = match dtype {
        Dtype::F64 => value.to_le_bytes().to_vec(),
        _ => (value as f32).to_le_bytes().to_vec(),
    };
    let n = bytes.len() / value.len();
    let all = mutator.once_in(4);
    let at = mutator.below(n);
    for (idx, chunk) in bytes.chunks_exact_mut(value.len()).enumerate() {
        if all || idx == at {
            chunk.copy_from_slice(&value);
        }
    }
}

fn reshape(mutator: &mut Mutator, (dtype, shape, bytes): &mut Stored) {
    match mutator.below(5) {
        0 => shape.reverse(),
        1 => shape.push(1),
        2 => *shape = vec![shape.iter().product()],
        3 => {
            shape.clear();
            bytes.truncate(if *dtype == Dtype::F64 { 8 } else { 4 });
        }
        _ => {
            // A row more, or none.
            let Some(first) = shape.first_mut() else { return };
            let row = bytes.len() / (*first).max(1);
            if mutator.once_in(2) {
                *first += 1;
                bytes.extend(vec![0; row]);
            } else {
                *first = 0;
                bytes.clear();
            }
        }
    }
}
