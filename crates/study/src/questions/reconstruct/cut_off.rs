//! Speeds and the angle of the cars that the range in which they are taken to lie cuts off.

use impactlab_core::numerics::quantile_of_sorted;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_reconstruct::{
    Distribution, Latent, Posterior, PriorComponent, ReconstructionTarget,
};

/// Distance from the end of a range to the median, over that from the median to the quantile of 5 % on the other side,
/// below which the end cuts off what the evidence says: 1 of a normal distribution that reaches its end at 95 %, 1.1
/// where every value of the range is equally likely, 0.52 of half a normal distribution, and 0.3 far out in its tail.
const LEAST_ROOM: f64 = 0.55;
/// Quantile on the other side of the median.
const FAR: f64 = 0.05;

/// What is asked for and lies at an end of its range, though the evidence may want it beyond: the interval is then that
/// of the range.
pub(super) fn cut_off(posterior: &Posterior, target: &ReconstructionTarget) -> Vec<Caveat> {
    if !posterior.has_intervals() {
        return Vec::new();
    }
    let told = |component: &PriorComponent| {
        let values = posterior.values.iter().map(|values| values.get(component.latent));
        of_component(component, &values.collect::<Vec<f64>>())
    };
    target.model().prior().components().iter().filter_map(told).collect()
}

/// - `values`: one for each motion.
fn of_component(component: &PriorComponent, values: &[f64]) -> Option<Caveat> {
    let Distribution::Uniform { low, high } = component.distribution else { return None };
    let quantity = component.latent.quantity();
    // What drivers and contacts do is seldom known, and no answer.
    if quantity != Quantity::Speed && component.latent != Latent::HeadingTowards {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let quantile = |probability| quantile_of_sorted(&sorted, probability);
    let median = quantile(0.5)?;
    let ends = [(low, quantile(1.0 - FAR)?), (high, quantile(FAR)?)];
    // No speed is below 0, and cars that stand parallel are at the end of what is turned in.
    let is_cut = |(end, far): &(f64, f64)| {
        *end > 0.0 && (end - median).abs() < LEAST_ROOM * (far - median).abs()
    };
    let (end, _) = ends.into_iter().find(is_cut)?;
    let number = |value: f64| match quantity {
        Quantity::Angle => PhraseValue::fixed(quantity, value, 0).in_unit("deg"),
        _ => PhraseValue::given(quantity, value),
    };
    let within = (end - median).abs();
    let within = match quantity {
        Quantity::Angle => PhraseValue::fixed(quantity, within, 1).in_unit("deg"),
        _ => PhraseValue::three_digits(quantity, within),
    };
    let text = Phrase::new(
        "{0}: half of the motions lie within {1} of {2}, an end of the range of {3} to {4}: the range cuts the answer \
         off, and its interval is too narrow unless nothing beyond is possible; widen the range and look whether the \
         answer moves",
        "{0}: Die Hälfte der Bewegungen liegt höchstens {1} neben {2}, einem Ende des Bereichs von {3} bis {4}. Der \
         Bereich schneidet die Antwort ab, und ihr Intervall ist zu eng, wenn jenseits davon etwas möglich ist: den \
         Bereich erweitern und prüfen, ob sich die Antwort ändert",
    )
    .with(PhraseValue::Term(component.latent.label().to_owned()))
    .with(within)
    .with(number(end))
    .with(number(low).bare())
    .with(number(high));
    Some(Caveat::new(CaveatKind::Disagreement, text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::numerics::normal_quantile;
    use impactlab_reconstruct::PriorSource;

    fn told(latent: Latent, [low, high]: [f64; 2], values: &[f64]) -> Option<String> {
        let distribution = Distribution::Uniform { low, high };
        let component = PriorComponent { latent, distribution, source: PriorSource::Given };
        of_component(&component, values).map(|caveat| caveat.text)
    }

    /// What a range leaves of a normal distribution.
    fn normal_within([low, high]: [f64; 2], mean: f64, sigma: f64) -> Vec<f64> {
        let quantiles = (0..20_000).map(|i| normal_quantile((f64::from(i) + 0.5) / 20_000.0));
        quantiles.map(|z| mean + sigma * z).filter(|at| (low..=high).contains(at)).collect()
    }

    /// Of a car at 33 m/s that may have had 30 m/s at the most the interval was 28 to 30 m/s, without a word.
    #[test]
    fn a_speed_that_its_range_cuts_off_is_told() {
        let speed = |range, mean, sigma| {
            told(Latent::StruckSpeed, range, &normal_within(range, mean, sigma))
        };
        let high = speed([5.0, 30.0], 33.0, 1.5).unwrap();
        assert!(high.starts_with("speed of the struck car: half of the motions lie"), "{high}");
        assert!(high.contains(" of 30 m/s, an end of the range of 5 to 30 m/s: "), "{high}");
        let low = speed([20.0, 45.0], 20.0, 2.0).unwrap();
        assert!(low.contains(" of 20 m/s, an end of"), "{low}");
        // Well inside, also next to the end by the width of the range, and where the evidence says little.
        assert_eq!(speed([5.0, 45.0], 20.0, 1.0), None);
        assert_eq!(speed([5.0, 45.0], 43.0, 1.0), None);
        assert_eq!(speed([19.0, 21.0], 18.0, 3.0), None);
        // No car is slower than one that stands, and a single value leaves nothing to cut off.
        assert_eq!(speed([0.0, 45.0], 0.0, 1.0), None);
        assert_eq!(told(Latent::StruckSpeed, [20.0, 20.0], &[20.0; 200]), None);
        let range = [0.1, 0.2];
        assert_eq!(told(Latent::BrakeStart, range, &normal_within(range, 0.2, 0.02)), None);
    }

    /// Of cars that met at 140° without a stated angle the interval ended at 110°, where the assumed range does.
    #[test]
    fn an_angle_of_the_cars_that_the_assumed_range_cuts_off_is_told() {
        let range = [0.0, 110_f64.to_radians()];
        let degrees = |mean: f64, sigma: f64| {
            let values = normal_within(range, mean.to_radians(), sigma.to_radians());
            told(Latent::HeadingTowards, range, &values)
        };
        let text = degrees(140.0, 15.0).unwrap();
        assert!(text.contains(" of 110 deg, an end of the range of 0 to 110 deg: "), "{text}");
        assert_eq!(degrees(90.0, 8.0), None);
        assert_eq!(degrees(0.0, 8.0), None);
    }
}
