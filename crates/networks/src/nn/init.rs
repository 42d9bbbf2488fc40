//! First values of parameters.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// The first values of a parameter. Fan-in is its last dimension, fan-out its first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Init {
    /// Zero: for biases, and for heads whose output starts at zero.
    Zero,
    /// One value everywhere.
    Constant(f64),
    /// Normal with standard deviation √(2/fan-in), before Swish layers.
    ///
    /// Source: K. He et al., Delving Deep into Rectifiers, ICCV 2015.
    KaimingNormal,
    /// Uniform within ±√(6/(fan-in + fan-out)), for layers without activation.
    ///
    /// Source: X. Glorot, Y. Bengio, Understanding the difficulty of training deep feedforward
    /// neural networks, AISTATS 2010.
    XavierUniform,
}

impl Init {
    /// The values of a parameter of this shape, row by row. Always drawn in 64 bits, so that
    /// networks in 32 and in 64 bits start alike.
    pub(crate) fn values(self, shape: &[usize], rng: &mut ChaCha8Rng) -> Vec<f64> {
        let n: usize = shape.iter().product();
        let fan_in = shape.last().copied().unwrap_or(1) as f64;
        let fan_out = shape.first().copied().unwrap_or(1) as f64;
        match self {
            Self::Zero => vec![0.0; n],
            Self::Constant(value) => vec![value; n],
            Self::KaimingNormal => {
                let deviation = (2.0 / fan_in).sqrt();
                (0..n).map(|_| deviation * rng.sample::<f64, _>(StandardNormal)).collect()
            }
            Self::XavierUniform => {
                let bound = (6.0 / (fan_in + fan_out)).sqrt();
                (0..n).map(|_| bound * (2.0 * rng.random::<f64>() - 1.0)).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::numerics::random_stream;

    /// Mean, variance and largest magnitude.
    fn statistics(init: Init, shape: &[usize]) -> (f64, f64, f64) {
        let values = init.values(shape, &mut random_stream(3, "weights", 0));
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
        (mean, variance, values.iter().fold(0.0, |max, v| max.max(v.abs())))
    }

    #[test]
    fn weights_have_the_variance_of_their_rule() {
        // Standard errors for 80 000 values: mean σ/283, variance σ²·√2/283 (normal); four of them.
        let (mean, variance, _) = statistics(Init::KaimingNormal, &[400, 200]);
        assert!(mean.abs() < 4.0 * (0.01_f64).sqrt() / 283.0, "mean {mean}");
        assert!((variance / 0.01 - 1.0).abs() < 4.0 * 1.42 / 283.0, "variance {variance}");
        let (mean, variance, max) = statistics(Init::XavierUniform, &[400, 200]);
        assert!(mean.abs() < 4.0 * (0.01_f64 / 3.0).sqrt() / 283.0, "mean {mean}");
        assert!((variance / (0.01 / 3.0) - 1.0).abs() < 4.0 / 283.0, "variance {variance}");
        assert!(max <= 0.1 && max > 0.0999, "bound {max}");
    }

    #[test]
    fn constants_are_constant_and_draw_nothing() {
        let mut rng = random_stream(3, "weights", 0);
        assert_eq!(Init::Zero.values(&[2, 2], &mut rng), [0.0; 4]);
        assert_eq!(Init::Constant(1.5).values(&[2], &mut rng), [1.5; 2]);
        assert_eq!(rng, random_stream(3, "weights", 0));
    }
}
