//! Models and checkpoints that were changed and given a new checksum: each is refused with its name
//! and the number that is wrong, before anything is computed or allocated.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use candle_core::{Device, Tensor};
use impactlab_core::data::Existing;
use impactlab_core::error_chain;
use impactlab_networks::force::ForceModel;
use impactlab_networks::learning::ModelFile;
use impactlab_networks::nn::{Checkpoint, NnError, kind_of_file};
use impactlab_networks::response::ResponseModel;
use serde_json::{Value, json};

/// Longest time to refuse a model, on a machine that is busy.
const PATIENCE: Duration = Duration::from_secs(20);

fn shipped(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/models").join(name)
}

/// The message for a model that was changed, after checking that it starts with the path.
fn refused<M: ModelFile + std::fmt::Debug>(
    file: &str,
    change: impl FnOnce(&mut Checkpoint),
) -> String {
    let mut checkpoint = Checkpoint::read(&shipped(file), M::KIND).unwrap();
    change(&mut checkpoint);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.safetensors");
    checkpoint.write(&path, Existing::Replace).unwrap();
    let started = Instant::now();
    let error = error_chain(&M::load(&path).unwrap_err());
    assert!(started.elapsed() < PATIENCE, "{:?}: {error}", started.elapsed());
    let prefix = format!("{}: cannot be used as a model: ", path.display());
    error.strip_prefix(&prefix).unwrap_or_else(|| panic!("{error}")).to_owned()
}

/// Sets the metadata at a path such as `/residuals/usual/variance/0`.
fn set(pointer: &'static str, value: Value) -> impl FnOnce(&mut Checkpoint) {
    move |checkpoint| {
        let (key, rest) = match pointer[1..].split_once('/') {
            Some((key, rest)) => (key, format!("/{rest}")),
            None => (&pointer[1..], String::new()),
        };
        let mut metadata: Value = checkpoint.get(key).unwrap();
        *metadata.pointer_mut(&rest).unwrap_or_else(|| panic!("no {pointer}")) = value;
        checkpoint.put(key, &metadata).unwrap();
    }
}

#[test]
fn numbers_of_a_force_model_without_a_meaning_are_refused() {
    let refused = |pointer, value| refused::<ForceModel>("force.safetensors", set(pointer, value));
    for (pointer, value, message) in [
        (
            "/residuals/usual/variance/3",
            json!(-1.0),
            "residuals.usual.variance[3] is -1, expected a number above 0",
        ),
        (
            "/residuals/hooking/variance/0",
            json!(0.0),
            "residuals.hooking.variance[0] is 0, expected a number above 0",
        ),
        (
            "/residuals/usual/lag_correlation",
            json!(1.5),
            "residuals.usual.lag_correlation is 1.5, expected 0 to 1",
        ),
        (
            "/standardisation/std/2",
            json!(-2.0),
            "standardisation.std[2] is -2, expected a number above 0",
        ),
        ("/open/body/0", json!(-0.5), "open.body[0] is -0.5, expected 0 to 1"),
        ("/centre/committee/share", json!(2.0), "centre.committee.share is 2, expected 0 to 1"),
        (
            "/centre/momentum/inertia_per_mass_m2/1",
            json!(0.0),
            "centre.momentum.inertia_per_mass_m2[1] is 0, expected a number above 0",
        ),
        (
            "/centre/laws/0/bodies/0/nose/radius_m",
            json!(-0.4),
            "centre.laws[0].bodies[0].nose.radius_m is -0.4, expected a number above 0",
        ),
        (
            "/centre/committee/regression/shapes/residual_std/7",
            json!(-1.0),
            "centre.committee.regression.shapes.residual_std[7] is -1, expected 0 or more",
        ),
        (
            "/cases/0/scenario/mass_kg/0",
            json!(0.0),
            "cases[0].scenario.mass_kg[0] is 0, expected a number above 0",
        ),
    ] {
        assert_eq!(refused(pointer, value), message);
    }
    for (pointer, value, message) in [
        // JSON has no NaN; it is written as `null`.
        ("/standardisation/std/2", Value::Null, "the metadata \"standardisation\" cannot be"),
        ("/standardisation/mean", json!([1.0]), "standardisation.mean has 1 entries, expected"),
        ("/centre/laws", json!([]), "centre.laws has 0 entries, expected 1"),
        (
            "/centre/committee/regression/scales/regressions/0/output_scaling/std/0",
            json!(-1.0),
            "the metadata \"centre\" cannot be understood: the deviations holds -1",
        ),
        (
            "/centre/committee/regression/scales/regressions/0/hyperparameters/0",
            json!(1e3),
            "the metadata \"centre\" cannot be understood: the hyperparameters holds 1000",
        ),
        (
            "/centre/committee/regression/scales/regressions/0/inputs",
            json!(vec![[0.0]; 100_000]),
            "the metadata \"centre\" cannot be understood: a regression on 100000 samples",
        ),
    ] {
        let error = refused(pointer, value);
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn factors_of_a_calibration_without_a_meaning_are_refused() {
    for (pointer, value, message) in [
        (
            "/record/variance_factors/shared",
            -1.0,
            "record.variance_factors.shared is -1, expected a number above 0",
        ),
        (
            "/record/variance_factors/far/factors/single",
            0.0,
            "record.variance_factors.far.factors.single is 0, expected a number above 0",
        ),
        (
            "/record/variance_factors/peak/spread",
            0.0,
            "record.variance_factors.peak.spread is 0, expected a number above 0",
        ),
        (
            "/record/variance_factors/peak/spread",
            11.0,
            "record.variance_factors.peak.spread is 11, expected -10 to 10",
        ),
        (
            "/record/variance_factors/far/distance/0",
            -1.0,
            "record.variance_factors.far.distance[0] is -1, expected 0 or more",
        ),
    ] {
        let error = refused::<ForceModel>("force.safetensors", set(pointer, json!(value)));
        assert_eq!(error, message);
    }
}

#[test]
fn numbers_of_a_response_model_without_a_meaning_are_refused() {
    for (pointer, value, message) in [
        ("/latents/scales/1", json!(-0.1), "latents.scales[1] is -0.1, expected 0 or more"),
        ("/latents/step_noise", json!(-1.0), "latents.step_noise is -1, expected 0 or more"),
        ("/latents/shared_out", json!(4), "latents.shared_out is 4, expected -3 to 3"),
    ] {
        let error = refused::<ResponseModel>("response.safetensors", set(pointer, value));
        assert_eq!(error, message);
    }
}

#[test]
fn sizes_beyond_the_file_are_refused_before_anything_is_allocated() {
    let force = |pointer, value| refused::<ForceModel>("force.safetensors", set(pointer, value));
    let response =
        |pointer, value| refused::<ResponseModel>("response.safetensors", set(pointer, value));
    for error in [
        force("/config/network/trunk", json!(vec![1; 1_000_000])),
        force("/config/network/trunk/0", json!(1_000_000_000_000_u64)),
        force("/config/network/trunk/0", json!(u64::MAX)),
        force("/config/network/components", json!(1_000_000_000)),
        force("/config/network/encoder_branches/0", json!([u64::MAX, u64::MAX, u64::MAX])),
        force("/config/network/position_channels", json!(1_000_000_000)),
        response("/config/network/trunk", json!(vec![1; 1_000_000])),
        response("/config/network/encoder/0", json!(1_000_000_000_000_u64)),
        response("/config/network/components", json!(u64::MAX)),
    ] {
        let is_size = ["the network has more than", "expected", "GiB of memory"]
            .iter()
            .any(|part| error.contains(part));
        assert!(is_size && error.len() < 300, "{error}");
    }
}

#[test]
fn errors_of_a_model_name_its_file() {
    let error = refused::<ForceModel>("force.safetensors", |checkpoint| {
        let mut network = checkpoint.take_group("network");
        network.remove("trunk.0.bias").unwrap();
        checkpoint.put_group("network", network);
    });
    assert_eq!(error, "the tensor \"trunk.0.bias\" is missing");
    let error = refused::<ResponseModel>("response.safetensors", |checkpoint| {
        let tensor = Tensor::zeros(3, candle_core::DType::F32, &Device::Cpu).unwrap();
        checkpoint.put_group("more", BTreeMap::from([("x".to_owned(), tensor)]));
    });
    assert_eq!(error, "the tensor \"more.x\" is unexpected; the model has none of this name");
    let error =
        refused::<ForceModel>("force.safetensors", set("/config/network/factors", json!(3)));
    assert!(error.starts_with("the tensor \"residuals\" has the shape"), "{error}");
    // Another kind, and another version.
    let path = shipped("response.safetensors");
    let error = error_chain(&ForceModel::load(&path).unwrap_err());
    let prefix = format!("{}: cannot be used as a model: ", path.display());
    let rest = error.strip_prefix(&prefix).unwrap_or_else(|| panic!("{error}"));
    assert_eq!(rest, "is a model of the kind \"response network\", expected \"force network\"");
}

/// A safetensors file with this header.
fn with_header(header: &str, n_bytes: usize) -> Vec<u8> {
    let length = (header.len() as u64).to_le_bytes();
    [&length[..], header.as_bytes(), &vec![0; n_bytes]].concat()
}

#[test]
fn a_header_that_claims_more_than_the_file_has_is_refused() {
    let huge = u64::MAX;
    let tensor = |shape: &str, end: u64| {
        format!(r#"{{"a":{{"dtype":"F32","shape":{shape},"data_offsets":[0,{end}]}}}}"#)
    };
    let brackets = "[".repeat(100_000);
    for bytes in [
        with_header(&tensor("[1000000000000]", 4_000_000_000_000), 16),
        with_header(&tensor("[4]", huge), 16),
        with_header(&tensor(&format!("[{huge},{huge}]"), 16), 16),
        with_header(&tensor("[4294967296,4294967296]", 0), 0),
        with_header(&format!(r#"{{"a":{brackets}"#), 0),
        with_header(&format!(r#"{{"__metadata__":{{"impactlab":"{brackets}"}}}}"#), 0),
        u64::MAX.to_le_bytes().to_vec(),
        [&(8_u64 << 20).to_le_bytes()[..], b"{"].concat(),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.safetensors");
        std::fs::write(&path, bytes).unwrap();
        let error = error_chain(&ForceModel::load(&path).unwrap_err());
        assert!(error.starts_with(&path.display().to_string()), "{error}");
        let _: Result<String, NnError> = kind_of_file(&path);
    }
}
