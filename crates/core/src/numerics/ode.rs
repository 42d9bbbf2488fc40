//! Single steps of explicit integrators for ẋ = f(t, x), generic over the scalar type.

use crate::numerics::Lanes;

/// The instant within a step of length h at which the right-hand side f is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The start of the step, t.
    Start,
    /// The middle of the step, t + h/2.
    Middle,
    /// The end of the step, t + h.
    End,
}

/// Takes one step of the explicit Euler method, which is of first order in h.
///
/// ```text
/// x⁺ = x + h f(t, x)
/// ```
///
/// - `f`: right-hand side at a stage of the step and a state.
/// - `x`: state at the start of the step.
/// - `h`: length of the step, in the unit of time of `f`.
/// - returns the state at the end of the step.
#[inline(always)]
pub fn euler_step<T: Lanes, const N: usize>(
    f: impl Fn(Stage, &[T; N]) -> [T; N],
    x: &[T; N],
    h: f64,
) -> [T; N] {
    advance(x, &f(Stage::Start, x), h)
}

/// Takes one step of the classical Runge–Kutta method, which is of fourth order in h for a smooth
/// f.
///
/// ```text
/// k₁ = f(t, x)   k₂ = f(t + h/2, x + h/2 k₁)   k₃ = f(t + h/2, x + h/2 k₂)   k₄ = f(t + h, x + h k₃)
/// x⁺ = x + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄)
/// ```
///
/// - `f`: right-hand side at a stage of the step and a state.
/// - `x`: state at the start of the step.
/// - `h`: length of the step, in the unit of time of `f`.
/// - returns the state at the end of the step.
#[inline(always)]
pub fn rk4_step<T: Lanes, const N: usize>(
    f: impl Fn(Stage, &[T; N]) -> [T; N],
    x: &[T; N],
    h: f64,
) -> [T; N] {
    rk4_step_from(&f(Stage::Start, x), f, x, h)
}

/// [`rk4_step`] where the right-hand side at the start of the step is known.
///
/// - `start`: f(t, x).
#[inline(always)]
pub fn rk4_step_from<T: Lanes, const N: usize>(
    start: &[T; N],
    f: impl Fn(Stage, &[T; N]) -> [T; N],
    x: &[T; N],
    h: f64,
) -> [T; N] {
    let (mut k, mut sum) = (*start, *start);
    // A loop, so that a large f is compiled once.
    for (stage, share, weight) in
        [(Stage::Middle, 0.5, 2.0), (Stage::Middle, 0.5, 2.0), (Stage::End, 1.0, 1.0)]
    {
        k = f(stage, &advance(x, &k, h * share));
        for (sum, k) in sum.iter_mut().zip(&k) {
            *sum += *k * weight;
        }
    }
    advance(x, &sum, h / 6.0)
}

#[inline(always)]
fn advance<T: Lanes, const N: usize>(x: &[T; N], k: &[T; N], h: f64) -> [T; N] {
    let mut next = *x;
    for (x, k) in next.iter_mut().zip(k) {
        *x += *k * h;
    }
    next
}

#[cfg(test)]
mod tests {
    use super::*;

    type Step = fn(&[f64; 2], f64) -> [f64; 2];

    fn oscillator(_: Stage, x: &[f64; 2]) -> [f64; 2] {
        [x[1], -x[0]]
    }

    fn error_after_one_second(step: Step, n: usize) -> f64 {
        let h = 1.0 / n as f64;
        let end = (0..n).fold([1.0, 0.0], |x, _| step(&x, h));
        (end[0] - 1.0_f64.cos()).hypot(end[1] + 1.0_f64.sin())
    }

    #[test]
    fn halving_the_step_divides_the_error_by_two_to_the_order() {
        let methods: [(&str, Step, f64); 2] = [
            ("euler", |x, h| euler_step(oscillator, x, h), 1.0),
            ("rk4", |x, h| rk4_step(oscillator, x, h), 4.0),
        ];
        for (name, step, order) in methods {
            let ratio = error_after_one_second(step, 50) / error_after_one_second(step, 100);
            assert!((ratio.log2() - order).abs() < 0.05, "{name}: order {}", ratio.log2());
        }
    }
}
