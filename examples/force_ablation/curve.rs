//! Learning curves: how an error falls with the number of cases to learn from.

/// Shares of the smallest error that are tried for what no number of cases takes away.
const N_FLOORS: usize = 400;
/// Fewest points by which that can be told from a slower fall.
const LEAST_POINTS_OF_FLOOR: usize = 4;

/// An error that falls with the number n of cases: `a n^−b + c`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    pub a: f64,
    pub b: f64,
    /// What no number of cases takes away; 0 with fewer than four points.
    pub c: f64,
}

impl PowerLaw {
    /// The law with the smallest squared errors: for each c the straight line of `ln(error − c)` over
    /// `ln n`. `None` with fewer than three points, or where the error does not fall.
    ///
    /// - `points`: n and error.
    pub fn fit(points: &[[f64; 2]]) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let least = points.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
        let n_floors = if points.len() < LEAST_POINTS_OF_FLOOR { 1 } else { N_FLOORS };
        let laws = (0..n_floors)
            .filter_map(|i| Self::above(points, least * i as f64 / N_FLOORS as f64))
            .filter(|law| law.b > 0.0);
        laws.min_by(|one, other| one.squares(points).total_cmp(&other.squares(points)))
    }

    fn above(points: &[[f64; 2]], c: f64) -> Option<Self> {
        let logs = || points.iter().map(|[n, error]| [n.ln(), (error - c).ln()]);
        let n = points.len() as f64;
        let mean = |axis: usize| logs().map(|log| log[axis]).sum::<f64>() / n;
        let [x_mean, y_mean] = [mean(0), mean(1)];
        let of_x: f64 = logs().map(|[x, _]| (x - x_mean).powi(2)).sum();
        let of_both: f64 = logs().map(|[x, y]| (x - x_mean) * (y - y_mean)).sum();
        let b = -of_both / of_x;
        let law = Self { a: (y_mean + b * x_mean).exp(), b, c };
        (law.a.is_finite() && law.b.is_finite()).then_some(law)
    }

    fn squares(&self, points: &[[f64; 2]]) -> f64 {
        points.iter().map(|[n, error]| (self.at(*n) - error).powi(2)).sum()
    }

    pub fn at(&self, n: f64) -> f64 {
        self.a * n.powf(-self.b) + self.c
    }

    /// From how many cases on twice as many take less off the error than this.
    pub fn n_of_gain(&self, gain: f64) -> f64 {
        (self.a * (1.0 - 2_f64.powf(-self.b)) / gain).powf(1.0 / self.b)
    }
}
