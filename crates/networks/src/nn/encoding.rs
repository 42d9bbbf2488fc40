//! Positional encoding: the position of a sample on the time grid as sines and cosines.

use candle_core::{DType, Device, Tensor};

use crate::nn::NnError;

/// The longest wavelength is 2π times this.
const BASE: f64 = 10_000.0;

/// Sinusoidal encoding of sample positions.
///
/// ```text
/// PE(pos, 2i) = sin(pos / 10000^(2i/d))      PE(pos, 2i + 1) = cos(pos / 10000^(2i/d))
/// ```
///
/// Source: A. Vaswani et al., Attention Is All You Need, NeurIPS 2017, section 3.5.
///
/// - `positions`: sample positions on the grid, such as milliseconds on a grid of 1 ms; never
///   seconds, which would hardly move the argument.
/// - `channels`: d, even.
/// - returns `[positions, channels]`.
///
/// # Errors
/// [`NnError::Indivisible`] for an odd number of channels.
pub fn positional_encoding(
    positions: &[f64],
    channels: usize,
    number_type: DType,
) -> Result<Tensor, NnError> {
    if !channels.is_multiple_of(2) {
        let name = "positional encoding".to_owned();
        return Err(NnError::Indivisible { name, channels, divisor: 2 });
    }
    let angle = |position: f64, i: usize| position / BASE.powf((2 * i) as f64 / channels as f64);
    let values = positions.iter().flat_map(|&position| {
        (0..channels / 2).flat_map(move |i| {
            let (sin, cos) = angle(position, i).sin_cos();
            [sin, cos]
        })
    });
    let shape = (positions.len(), channels);
    let encoding = Tensor::from_vec(values.collect::<Vec<f64>>(), shape, &Device::Cpu)?;
    Ok(encoding.to_dtype(number_type)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_sine_and_cosine_get_slower() {
        let encoding = positional_encoding(&[0.0, 3.0], 4, DType::F64).unwrap();
        let rows = encoding.to_vec2::<f64>().unwrap();
        assert_eq!(rows[0], [0.0, 1.0, 0.0, 1.0]);
        let expected = [3.0_f64.sin(), 3.0_f64.cos(), 0.03_f64.sin(), 0.03_f64.cos()];
        for (got, expected) in rows[1].iter().zip(expected) {
            assert!((got - expected).abs() < 1e-12, "{got} instead of {expected}");
        }
    }

    #[test]
    fn an_odd_number_of_channels_is_refused() {
        let error = positional_encoding(&[0.0], 3, DType::F32).unwrap_err().to_string();
        assert_eq!(error, "positional encoding: 3 channels cannot be divided by 2");
    }
}
