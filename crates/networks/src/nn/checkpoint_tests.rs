//! Tests of [`Checkpoint`]: round trips, and every way in which a file can be wrong.

use std::path::PathBuf;

use candle_core::{DType, Device, Tensor};
use proptest::prelude::*;
use safetensors::tensor::{Dtype, TensorView};

use crate::nn::checkpoint_bytes::{decode, encode};
use crate::nn::gradient_check::random_tensor;
use crate::nn::{Checkpoint, ModelKind, NamedTensors, NnError};
use impactlab_core::data::Existing;
use impactlab_core::error_chain;

const KIND: ModelKind = ModelKind { name: "force network", version: 3 };

fn checkpoint() -> Checkpoint {
    let mut checkpoint = Checkpoint::new(KIND);
    checkpoint.put("seed", &7_u64).unwrap();
    checkpoint.put("scale", &[0.1 + 0.2, 1.0 / 3.0, 5e-324]).unwrap();
    let tensor = |dims: &[usize], number_type, number| random_tensor(dims, number_type, number);
    let weights = [
        ("0.weight".to_owned(), tensor(&[3, 2], DType::F32, 1)),
        ("0.bias".to_owned(), tensor(&[3], DType::F32, 2)),
    ];
    checkpoint.put_group("parameters", weights.into());
    let means = [("mean".to_owned(), tensor(&[2], DType::F64, 3))];
    checkpoint.put_group("scaling", means.into());
    checkpoint
}

fn bytes() -> Vec<u8> {
    encode(&checkpoint()).unwrap()
}

fn chain(result: Result<Checkpoint, NnError>) -> String {
    error_chain(&result.unwrap_err())
}

/// A file of the safetensors crate, with our key if `ours` is given.
fn foreign(dtype: Dtype, shape: Vec<usize>, data: &[u8], ours: Option<&str>) -> Vec<u8> {
    let view = TensorView::new(dtype, shape, data).unwrap();
    let ours = ours.map(|text| [("impactlab".to_owned(), text.to_owned())].into());
    safetensors::serialize([("weight", view)], ours).unwrap()
}

const OURS: &str = r#"{"kind":"force network","version":3,"metadata":{},"sha256":"0"}"#;

#[test]
fn what_is_written_is_read_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.safetensors");
    checkpoint().write(&path, Existing::Refuse).unwrap();
    let mut read = Checkpoint::read(&path, KIND).unwrap();
    assert_eq!(read.get::<u64>("seed").unwrap(), 7);
    assert_eq!(read.get::<Vec<f64>>("scale").unwrap(), [0.1 + 0.2, 1.0 / 3.0, 5e-324]);
    let (weights, mut expected) = (read.take_group("parameters"), checkpoint());
    let values = |tensors: &NamedTensors| -> Vec<Vec<f32>> {
        tensors.values().map(|t| t.flatten_all().unwrap().to_vec1().unwrap()).collect()
    };
    assert_eq!(weights.keys().collect::<Vec<_>>(), ["0.bias", "0.weight"]);
    assert_eq!(weights["0.weight"].dims(), [3, 2]);
    assert_eq!(values(&weights), values(&expected.take_group("parameters")));
    let left = read.check_all_taken().unwrap_err().to_string();
    assert_eq!(left, "the tensor \"scaling.mean\" is unexpected; the model has none of this name");
    let mean = &read.take_group("scaling")["mean"];
    let expected = &expected.take_group("scaling")["mean"];
    assert_eq!(mean.to_vec1::<f64>().unwrap(), expected.to_vec1::<f64>().unwrap());
    read.check_all_taken().unwrap();
}

#[test]
fn the_same_contents_give_the_same_bytes() {
    assert_eq!(bytes(), bytes());
}

#[test]
fn metadata_is_named_when_missing_or_of_another_form() {
    let error = checkpoint().get::<u64>("config").unwrap_err().to_string();
    assert_eq!(error, "the metadata key \"config\" is missing");
    let error = error_chain(&checkpoint().get::<String>("seed").unwrap_err());
    let expected = "the metadata \"seed\" cannot be understood: invalid type: ";
    assert!(error.starts_with(expected), "{error}");
}

#[test]
fn a_file_that_is_no_model_is_refused_with_its_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("notes.txt");
    let missing = Checkpoint::read(&path, KIND).unwrap_err();
    assert!(missing.to_string().ends_with("does not exist; check the name"), "{missing}");
    for text in ["", "time_s,force_n\n0,1\n", "{\"kind\": \"force network\"}"] {
        std::fs::write(&path, text).unwrap();
        let error = chain(Checkpoint::read(&path, KIND));
        let why = "cannot be used as a model: is not a safetensors file";
        assert_eq!(error, format!("{}: {why}", path.display()), "{text:?}");
    }
    let error = Checkpoint::new(KIND)
        .write(&PathBuf::from("no/such/folder/model"), Existing::Refuse)
        .unwrap_err();
    assert!(matches!(error, NnError::File(_)), "{error}");
}

#[test]
fn every_shortened_file_is_truncated() {
    let (whole, n) = (bytes(), bytes().len());
    let error = chain(decode(&whole[..n - 5], KIND));
    assert_eq!(error, format!("is truncated: expected {n} bytes, has {}", n - 5));
    for length in 0..n {
        let error = decode(&whole[..length], KIND).unwrap_err();
        let expected = match error {
            NnError::Truncated { expected, got } => got == length as u64 && expected <= n as u64,
            NnError::NotSafetensors => length <= 8,
            _ => false,
        };
        assert!(expected, "{length} of {n} bytes: {error}");
    }
    let longer = [whole.as_slice(), b"\n"].concat();
    let error = chain(decode(&longer, KIND));
    assert_eq!(error, format!("is too long: expected {n} bytes, has {}", n + 1));
}

#[test]
fn models_of_another_kind_or_version_are_named() {
    let error = chain(decode(&bytes(), ModelKind { name: "response network", ..KIND }));
    assert_eq!(error, "is a model of the kind \"force network\", expected \"response network\"");
    let error = chain(decode(&bytes(), ModelKind { version: 2, ..KIND }));
    let expected = "has format version 3 of \"force network\", this program reads version 2";
    assert_eq!(error, expected);
    let error = chain(decode(&foreign(Dtype::F32, vec![1], &[0; 4], None), KIND));
    assert_eq!(error, "the metadata key \"impactlab\" is missing");
    let error = chain(decode(&foreign(Dtype::F32, vec![1], &[0; 4], Some("{}")), KIND));
    assert!(error.starts_with("the metadata \"impactlab\" cannot be understood: "), "{error}");
}

#[test]
fn tensors_that_cannot_be_used_are_named() {
    let nan = [0.0, f32::NAN].map(f32::to_le_bytes).concat();
    let error = chain(decode(&foreign(Dtype::F32, vec![2], &nan, Some(OURS)), KIND));
    assert_eq!(error, "the tensor \"weight\" holds NaN at index 1, expected finite numbers");
    let error = chain(decode(&foreign(Dtype::I64, vec![1], &[0; 8], Some(OURS)), KIND));
    assert_eq!(error, "the tensor \"weight\": holds I64 numbers, expected F32 or F64");
    let shape = vec![0, 1 << 40, 1 << 23];
    let error = chain(decode(&foreign(Dtype::F32, shape, &[], Some(OURS)), KIND));
    assert!(error.starts_with("the tensor \"weight\" is empty: its shape is [0, "), "{error}");
    let error = chain(decode(&foreign(Dtype::F32, vec![1], &[0; 4], Some(OURS)), KIND));
    assert!(error.starts_with("is damaged: the checksum is "), "{error}");

    let mut bad = checkpoint();
    let infinite = Tensor::new(&[f32::INFINITY], &Device::Cpu).unwrap();
    bad.put_group("parameters", [("1.bias".to_owned(), infinite)].into());
    let error = encode(&bad).unwrap_err().to_string();
    let expected = "the tensor \"parameters.1.bias\" holds inf at index 0, expected finite numbers";
    assert_eq!(error, expected);
}

#[test]
fn a_header_that_promises_much_costs_nothing() {
    let header =
        br#"{"w":{"dtype":"F32","shape":[1125899906842624],"data_offsets":[0,4503599627370496]}}"#;
    let file = [&(header.len() as u64).to_le_bytes()[..], header].concat();
    let error = decode(&file, KIND).unwrap_err();
    assert!(matches!(error, NnError::Truncated { .. }), "{error}");
    let error = decode(&[&[0xff; 8][..], b"{"].concat(), KIND).unwrap_err();
    assert!(matches!(error, NnError::NotSafetensors), "{error}");
    let deep = "[".repeat(100_000);
    let file = [&(deep.len() as u64 + 1).to_le_bytes()[..], b"{", deep.as_bytes()].concat();
    let error = decode(&file, KIND).unwrap_err();
    assert!(matches!(error, NnError::Header(_)), "{error}");
}

#[test]
fn every_flipped_bit_is_found() {
    let whole = bytes();
    for bit in 0..8 * whole.len() {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(decode(&flipped, KIND).is_err(), "bit {bit} of {}", 8 * whole.len());
    }
}

#[test]
fn a_tab_in_the_place_of_a_space_of_the_padding_is_found() {
    let mut changed = bytes();
    let end = 8 + u64::from_le_bytes(changed[..8].try_into().unwrap()) as usize;
    assert_eq!(changed[end - 1], b' ', "the header of the test is padded");
    changed[end - 1] = b'\t';
    assert!(matches!(decode(&changed, KIND), Err(NnError::NotSafetensors)));
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(decode(&bytes, KIND).is_err());
    }

    #[test]
    fn no_header_makes_it_panic(header in r#"\{"(__metadata__|w)":\{("(dtype|shape|data_offsets|impactlab)":("F32"|"F4"|\[[0-9]{0,20},?[0-9]{0,3}\]|"[{}a-z]*"),?){0,4}\}\}"#, data in prop::collection::vec(any::<u8>(), 0..64)) {
        let file = [&(header.len() as u64).to_le_bytes()[..], header.as_bytes(), &data].concat();
        prop_assert!(decode(&file, KIND).is_err());
    }

    #[test]
    fn no_changed_bytes_pass(changes in prop::collection::vec((any::<prop::sample::Index>(), 1..=255_u8), 1..8)) {
        let mut changed = bytes();
        let n = changed.len();
        changes.iter().for_each(|(at, mask)| changed[at.index(n)] ^= mask);
        prop_assert!(changed == bytes() || decode(&changed, KIND).is_err());
    }
}
