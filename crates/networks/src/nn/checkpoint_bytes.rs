//! The bytes of a model file, from contents to safetensors and back with every check.
//!
//! ```text
//! 8 bytes: length of the header | header, JSON: name, type, shape, place of each tensor | numbers
//! ```
//!
//! Our own part of the header is one text, so that its bytes do not depend on the order of a map:
//! `{"kind":…,"version":…,"metadata":{…},"sha256":…}`. The checksum covers what stands before it,
//! and names, types, shapes and numbers of all tensors.

use candle_core::{DType, Device, Tensor};
use safetensors::tensor::{Dtype, Metadata, SafeTensors, TensorView};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::nn::element::NetworkNumber;
use crate::nn::named_tensors::check_finite;
use crate::nn::{Checkpoint, ModelKind, NamedTensors, NnError};
use impactlab_core::numerics::sha256_hex;

/// The longest header that is read.
pub(super) const MAX_HEADER_BYTES: u64 = 8 << 20;

/// Bytes before the header, which hold its length.
pub(super) const LENGTH_BYTES: usize = 8;

/// The key of our own part of the header.
const OUR_KEY: &str = "impactlab";

/// Our own part of the header.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct OurHeader {
    kind: String,
    version: u32,
    metadata: Map<String, Value>,
    /// Must stay last: the checksum covers the text before it.
    sha256: String,
}

/// The bytes of a file.
pub(crate) fn encode(checkpoint: &Checkpoint) -> Result<Vec<u8>, NnError> {
    let mut stored = Vec::with_capacity(checkpoint.tensors.len());
    for (name, tensor) in &checkpoint.tensors {
        check_stored(name, tensor)?;
        stored.push((name.as_str(), to_stored(tensor)?));
    }
    let views = stored.iter().map(|(name, (dtype, shape, bytes))| {
        TensorView::new(*dtype, shape.clone(), bytes).map(|view| (*name, view))
    });
    let views = views.collect::<Result<Vec<_>, _>>().map_err(NnError::Layout)?;
    let mut header = OurHeader {
        kind: checkpoint.kind.name.to_owned(),
        version: checkpoint.kind.version,
        metadata: checkpoint.metadata.clone(),
        sha256: String::new(),
    };
    let to_error = |source| NnError::Metadata { key: OUR_KEY.to_owned(), source };
    let without = serde_json::to_string(&header).map_err(to_error)?;
    let covered = without.strip_suffix(&checksum_suffix("")).unwrap_or(&without);
    header.sha256 = checksum(covered, &views);
    let text = serde_json::to_string(&header).map_err(to_error)?;
    let ours = [(OUR_KEY.to_owned(), text)].into_iter().collect();
    safetensors::serialize(views, Some(ours)).map_err(NnError::Layout)
}

/// The contents of a file.
pub(crate) fn decode(bytes: &[u8], kind: ModelKind) -> Result<Checkpoint, NnError> {
    check_length(bytes)?;
    let file = SafeTensors::deserialize(bytes).map_err(NnError::Layout)?;
    let (_, header) = SafeTensors::read_metadata(bytes).map_err(NnError::Layout)?;
    let (text, ours) = our_header(&header)?;
    if ours.kind != kind.name {
        return Err(NnError::WrongKind { expected: kind.name.to_owned(), got: ours.kind });
    }
    if ours.version != kind.version {
        let (expected, got) = (kind.version, ours.version);
        return Err(NnError::WrongVersion { kind: ours.kind, expected, got });
    }
    let mut views = file.tensors();
    views.sort_by(|(a, _), (b, _)| a.cmp(b));
    let mut tensors = NamedTensors::new();
    for (name, view) in &views {
        tensors.insert(name.clone(), from_stored(name, view)?);
    }
    let covered = text.strip_suffix(&checksum_suffix(&ours.sha256)).unwrap_or(text);
    let got = checksum(covered, &views);
    if got != ours.sha256 {
        return Err(NnError::Checksum { expected: ours.sha256, got });
    }
    Ok(Checkpoint { kind, metadata: ours.metadata, tensors })
}

/// The kind of the model, from the beginning of a file.
pub(crate) fn kind_in_header(bytes: &[u8]) -> Result<String, NnError> {
    let (_, header) = header(bytes)?;
    Ok(our_header(&header)?.1.kind)
}

/// Our own part of the header: its text, and what it says.
fn our_header(header: &Metadata) -> Result<(&str, OurHeader), NnError> {
    let missing = || NnError::MissingMetadata { key: OUR_KEY.to_owned() };
    let text = header.metadata().as_ref().and_then(|all| all.get(OUR_KEY)).ok_or_else(missing)?;
    let to_error = |source| NnError::Metadata { key: OUR_KEY.to_owned(), source };
    Ok((text, serde_json::from_str(text).map_err(to_error)?))
}

/// Where the numbers start, and the header.
fn header(bytes: &[u8]) -> Result<(u64, Metadata), NnError> {
    let (length, rest) = bytes.split_first_chunk().ok_or(NnError::NotSafetensors)?;
    let (header_bytes, got) = (u64::from_le_bytes(*length), bytes.len() as u64);
    if header_bytes > MAX_HEADER_BYTES || !rest.starts_with(b"{") {
        return Err(NnError::NotSafetensors);
    }
    let start = LENGTH_BYTES as u64 + header_bytes;
    let Some(header) = usize::try_from(header_bytes).ok().and_then(|n| rest.get(..n)) else {
        return Err(NnError::Truncated { expected: start, got });
    };
    // The header is padded with spaces; a tab in the place of one would be read as well.
    if header.iter().any(u8::is_ascii_control) {
        return Err(NnError::NotSafetensors);
    }
    Ok((start, serde_json::from_slice(header).map_err(NnError::Header)?))
}

/// Whether there are as many bytes as the header says, before anything is allocated for them.
fn check_length(bytes: &[u8]) -> Result<(), NnError> {
    let (start, header) = header(bytes)?;
    let got = bytes.len() as u64;
    let expected = start.saturating_add(header.data_len() as u64);
    match expected {
        _ if expected > got => Err(NnError::Truncated { expected, got }),
        _ if expected < got => Err(NnError::TrailingBytes { expected, got }),
        _ => Ok(()),
    }
}

/// What stands behind the text that the checksum covers.
fn checksum_suffix(sha256: &str) -> String {
    format!(",\"sha256\":\"{sha256}\"}}")
}

/// - `views`: in the order of their names.
fn checksum<S: AsRef<str>>(covered: &str, views: &[(S, TensorView<'_>)]) -> String {
    let labels = views.iter().map(|(name, view)| {
        format!("\n{:?} {:?} {:?}\n", name.as_ref(), view.dtype(), view.shape())
    });
    let labels: Vec<String> = labels.collect();
    let tensors = labels.iter().zip(views);
    let parts = tensors.flat_map(|(label, (_, view))| [label.as_bytes(), view.data()]);
    sha256_hex([covered.as_bytes()].into_iter().chain(parts))
}

fn check_stored(name: &str, tensor: &Tensor) -> Result<(), NnError> {
    check_shape(name, tensor.dims())?;
    check_finite(name, tensor)
}

fn check_shape(name: &str, shape: &[usize]) -> Result<(), NnError> {
    if shape.contains(&0) {
        return Err(NnError::EmptyTensor { name: name.to_owned(), shape: shape.to_vec() });
    }
    Ok(())
}

/// Type, shape and little-endian bytes.
fn to_stored(tensor: &Tensor) -> Result<(Dtype, Vec<usize>, Vec<u8>), NnError> {
    let (flat, shape) = (tensor.detach().flatten_all()?, tensor.dims().to_vec());
    if tensor.dtype() == DType::F64 {
        let values = flat.to_vec1::<f64>()?;
        return Ok((Dtype::F64, shape, values.iter().flat_map(|v| v.to_le_bytes()).collect()));
    }
    let values = flat.to_dtype(DType::F32)?.to_vec1::<f32>()?;
    Ok((Dtype::F32, shape, values.iter().flat_map(|v| v.to_le_bytes()).collect()))
}

fn from_stored(name: &str, view: &TensorView<'_>) -> Result<Tensor, NnError> {
    check_shape(name, view.shape())?;
    let tensor = match view.dtype() {
        Dtype::F32 => to_tensor(view, f32::from_le_bytes)?,
        Dtype::F64 => to_tensor(view, f64::from_le_bytes)?,
        other => {
            let (name, got) = (format!("the tensor {name:?}"), format!("{other:?}"));
            return Err(NnError::NumberType { name, expected: "F32 or F64", got });
        }
    };
    check_finite(name, &tensor)?;
    Ok(tensor)
}

fn to_tensor<T: NetworkNumber, const N: usize>(
    view: &TensorView<'_>,
    from_bytes: impl Fn([u8; N]) -> T,
) -> Result<Tensor, NnError> {
    let (chunks, _) = view.data().as_chunks::<N>();
    let values: Vec<T> = chunks.iter().map(|chunk| from_bytes(*chunk)).collect();
    Ok(Tensor::from_vec(values, view.shape(), &Device::Cpu)?)
}
