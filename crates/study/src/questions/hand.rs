//! A method by hand: `hand`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::check_count;
use crate::{Answer, Library, Observer, Provenance, Question, StudyError};
use impactlab_core::data::Outcome;
use impactlab_core::ranges::HAND_DRAWS;
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};
use impactlab_core::units::{Estimate, NumberFormat, Phrase, PhraseValue, Quantity};
use impactlab_reconstruct::hand::{
    HandAnswer, HandInputs, HandMethod, HandNumber, HandQuantity, HandQuestion, HandSensitivity,
    YawMarkBias,
};

/// Draws of the inputs where nobody says how many.
pub const DEFAULT_HAND_DRAWS: usize = 10_000;

/// Ratio of the critical speed of marks of the model to the true speed that is not worth a warning.
const UNBIASED: [f64; 2] = [0.95, 1.05];

/// Asks what a method by hand gives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HandRequest {
    /// The method.
    pub method: HandMethod,
    /// Its inputs by their keys, which say the SI unit, each with its standard deviation. One that is left out
    /// has the value of the program, if it has one, and a standard deviation that is left out is that of the
    /// program; 0 says that a number is exact.
    #[serde(default)]
    pub inputs: HandInputs,
    /// Points [x, y] of a yaw mark in the order in which it was left, m.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points_m: Vec<[f64; 2]>,
    /// Number of draws of the inputs.
    #[serde(default = "default_draws")]
    pub input_draws: usize,
    /// Seed of the draws.
    #[serde(default)]
    pub seed: u64,
}

fn default_draws() -> usize {
    DEFAULT_HAND_DRAWS
}

impl Default for HandRequest {
    fn default() -> Self {
        Self::new(HandMethod::default())
    }
}

impl HandRequest {
    /// A method of which no input is known yet.
    pub fn new(method: HandMethod) -> Self {
        let (inputs, points_m) = (HandInputs::new(), Vec::new());
        Self { method, inputs, points_m, input_draws: DEFAULT_HAND_DRAWS, seed: 0 }
    }

    fn question(&self) -> HandQuestion<'_> {
        HandQuestion { method: self.method, inputs: &self.inputs, points_m: &self.points_m }
    }
}

/// What a method by hand gives. Numbers are in the SI unit that stands with them.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct HandReport {
    /// The method.
    pub method: HandMethod,
    /// What it is called.
    pub name: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Under which conditions it holds.
    pub holds: String,
    /// Its sources.
    pub sources: Vec<String>,
    /// The inputs that it was computed with.
    pub inputs: Vec<HandInputReport>,
    /// Number of points of a mark that it was computed with.
    pub n_points: usize,
    /// What it gives, what was asked for first.
    pub results: Vec<HandResult>,
    /// What each input does to the results.
    pub sensitivities: Vec<HandSensitivityReport>,
    /// Share of the draws in which the vehicle stops before the place of the collision; none where that is not
    /// asked.
    pub avoided_share: Option<f64>,
    /// Draws of the inputs.
    pub draws: usize,
    /// Draws from which nothing follows, which are left out.
    pub draws_left_out: usize,
    /// How far the critical speed is off on marks of the 4DOF model; none of other methods.
    pub yaw_mark_bias: Option<YawMarkBias>,
}

/// An input of a method.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct HandInputReport {
    /// Key with the SI unit.
    pub key: String,
    /// What it is called.
    pub label: &'static str,
    /// What it measures.
    #[serde(skip)]
    pub quantity: Quantity,
    /// SI unit; empty for a pure number.
    pub unit: &'static str,
    /// Value.
    pub value: f64,
    /// Standard deviation; 0 if it is exact.
    pub sigma: f64,
    /// Whether the value is that of the program.
    pub is_value_assumed: bool,
    /// Whether the standard deviation is that of the program.
    pub is_sigma_assumed: bool,
}

/// A number that a method gives.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct HandResult {
    /// Key with the SI unit.
    pub key: &'static str,
    /// What it is called.
    pub label: &'static str,
    /// What it measures.
    #[serde(skip)]
    pub quantity: Quantity,
    /// SI unit; empty for a pure number.
    pub unit: &'static str,
    /// Value at the values of the inputs.
    pub value: f64,
    /// Standard deviation to first order; none where it has none.
    pub sigma: Option<f64>,
    /// Median and intervals of the draws.
    pub estimate: Estimate,
}

/// What an input does to the results.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct HandSensitivityReport {
    /// Key of the input with its SI unit.
    pub input: String,
    /// What it is called.
    pub label: &'static str,
    /// What it measures.
    #[serde(skip)]
    pub quantity: Quantity,
    /// By how much the input is larger: its standard deviation, or 1 % of an exact value.
    pub step: f64,
    /// Whether the input is exact, so that the step is none of its errors.
    pub is_exact: bool,
    /// Change of each result in the order of the results.
    pub changes: Vec<Option<f64>>,
}

/// What a method by hand gives, as it is answered.
#[derive(Debug, Clone, PartialEq)]
pub struct HandMethodAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<HandReport>,
}

impl From<&HandNumber> for HandInputReport {
    fn from(number: &HandNumber) -> Self {
        let field = number.field;
        Self {
            key: field.si_key(),
            label: field.label,
            quantity: field.range.quantity,
            unit: field.range.unit(),
            value: number.value,
            sigma: number.sigma,
            is_value_assumed: number.is_value_assumed,
            is_sigma_assumed: number.is_sigma_assumed,
        }
    }
}

impl From<HandQuantity> for HandResult {
    fn from(quantity: HandQuantity) -> Self {
        let output = quantity.output;
        Self {
            key: output.key,
            label: output.label,
            quantity: output.quantity,
            unit: output.quantity.si_unit().symbol,
            value: quantity.value,
            sigma: quantity.sigma,
            estimate: quantity.estimate,
        }
    }
}

impl Question for HandRequest {
    type Answer = HandMethodAnswer;
    type Report = Answer<HandReport>;
    const NAME: &'static str = "hand";

    fn check(&self) -> Result<(), StudyError> {
        check_count("input_draws", &HAND_DRAWS, self.input_draws)?;
        self.question().numbers()?;
        Ok(())
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        _library: &Library,
        _observer: &mut Observer<'_>,
    ) -> Result<Outcome<HandMethodAnswer>, StudyError> {
        let answer = self.question().answer(self.input_draws, self.seed)?;
        let bias = self.yaw_mark_bias(&answer);
        let caveats = caveats(&answer, self.input_draws, bias.as_ref());
        let report = self.report_of(answer, bias);
        let provenance = Provenance::from_seed(self.seed);
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(HandMethodAnswer { report }))
    }
}

impl HandRequest {
    /// How far the critical speed is off on marks of the model that are like the one that is asked about.
    fn yaw_mark_bias(&self, answer: &HandAnswer) -> Option<YawMarkBias> {
        if self.method != HandMethod::YawMark {
            return None;
        }
        let friction = answer.numbers.iter().find(|number| number.field.key == "friction")?;
        YawMarkBias::compute(friction.value, answer.quantities.first()?.value)
    }

    fn report_of(&self, answer: HandAnswer, yaw_mark_bias: Option<YawMarkBias>) -> HandReport {
        let method = self.method;
        let inputs: Vec<HandInputReport> = answer.numbers.iter().map(Into::into).collect();
        let outputs = method.outputs();
        let is_told: Vec<bool> = outputs
            .iter()
            .map(|output| answer.quantities.iter().any(|quantity| quantity.output == output))
            .collect();
        let sensitivity = |of: HandSensitivity| {
            let quantity = inputs.iter().find(|input| input.key == of.input);
            let changes = of.changes.into_iter().zip(&is_told);
            HandSensitivityReport {
                quantity: quantity.map_or(Quantity::Length, |input| input.quantity),
                input: of.input,
                label: of.label,
                step: of.step,
                is_exact: of.is_exact,
                changes: changes.filter(|(_, told)| **told).map(|(change, _)| change).collect(),
            }
        };
        let sensitivities = answer.sensitivities.into_iter().map(sensitivity).collect();
        HandReport {
            method,
            name: method.label(),
            equation: method.equation(),
            holds: method.holds().say(&NumberFormat::default()),
            sources: method.sources().iter().map(|source| in_one_line(source)).collect(),
            inputs,
            results: answer.quantities.into_iter().map(Into::into).collect(),
            sensitivities,
            avoided_share: answer.avoided_share,
            n_points: self.points_m.len(),
            draws: self.input_draws,
            draws_left_out: answer.n_unsolved,
            yaw_mark_bias,
        }
    }
}

fn in_one_line(source: &str) -> String {
    source.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What restricts the answer and what it rests on.
fn caveats(answer: &HandAnswer, draws: usize, bias: Option<&YawMarkBias>) -> Caveats {
    let violated = answer.violated.iter().cloned();
    let violated = violated.map(|phrase| Caveat::new(CaveatKind::OutsideDomain, phrase));
    let mut all: Vec<Caveat> = violated.collect();
    let odd = |of: &HandNumber| {
        of.field.range.odd_of(&PhraseValue::Term(of.field.label.to_owned()), of.value)
    };
    let odd = answer.numbers.iter().filter_map(odd);
    all.extend(odd.map(|phrase| Caveat::new(CaveatKind::DoubtfulData, phrase)));
    all.extend(answer.violated_in_draws.as_ref().map(violated_in_draws));
    let is_exact = answer.quantities.iter().all(|of| of.estimate.intervals.is_empty());
    if is_exact {
        let phrase = Phrase::new(
            "every input counts as exact, so that the answer has no interval",
            "Jede Eingabe gilt als genau, daher hat die Antwort keinen Bereich",
        );
        all.push(Caveat::new(CaveatKind::NoInterval, phrase));
    }
    all.extend(bias.and_then(bias_caveat));
    all.extend((answer.n_unsolved > 0).then(|| left_out(answer, draws)));
    all.extend(answer.numbers.iter().filter(|of| of.is_value_assumed).map(assumed_value));
    let is_assumed =
        |of: &&HandNumber| of.is_sigma_assumed && !of.is_value_assumed && of.sigma > 0.0;
    all.extend(answer.numbers.iter().filter(is_assumed).map(assumed_sigma));
    all.extend((!is_exact).then(|| how_drawn(&answer.numbers)));
    all.into_iter().collect()
}

/// How the inputs are drawn. Those whose standard deviations stand in one rule are off together where that is
/// wider, if there are several.
fn how_drawn(numbers: &[HandNumber]) -> Caveat {
    let of_rule = numbers.iter().filter(|number| number.rule().is_some() && number.sigma > 0.0);
    let labels: Vec<Phrase> = of_rule
        .map(|number| Phrase::of(PhraseValue::Term(number.field.label.to_owned())))
        .collect();
    let phrase = match labels.len() {
        0 | 1 => Phrase::new(
            "each input is normal about its value, cut off at the limits of its range and independent of the others",
            "Jede Eingabe ist normalverteilt um ihren Wert, an den Grenzen ihres Bereichs abgeschnitten und \
             unabhängig von den anderen",
        ),
        _ => Phrase::new(
            "each input is normal about its value, cut off at the limits of its range and independent of the others, \
             but for these, of which no standard deviation is stated and one rule of the program stands for all: \
             {0}; their errors are drawn together or independently, whichever gives a result the wider interval",
            "Jede Eingabe ist normalverteilt um ihren Wert, an den Grenzen ihres Bereichs abgeschnitten und \
             unabhängig von den anderen, außer diesen, für die keine Standardabweichung angegeben ist und eine \
             Regel des Programms für alle gilt: {0}. Deren Fehler sind gemeinsam oder unabhängig voneinander \
             gezogen, je nachdem, was den breiteren Bereich eines Ergebnisses ergibt",
        )
        .with(PhraseValue::phrase(Phrase::joined(labels, "; "))),
    };
    Caveat::new(CaveatKind::Note, phrase)
}

/// Draws in which the inputs do not go together, such as those of an impact that would gain energy.
fn violated_in_draws((share, said): &(f64, Phrase)) -> Caveat {
    let phrase = Phrase::new(
        "{0} of the draws violate a condition that the inputs meet at their values, and the intervals contain \
         them; of one of them: {1}",
        "{0} der Ziehungen verletzen eine Bedingung, die die Eingaben mit ihren Werten erfüllen, und die \
         Intervalle enthalten sie; von einer davon: {1}",
    )
    .with(PhraseValue::Share(*share))
    .with(PhraseValue::phrase(said.clone()));
    Caveat::new(CaveatKind::OutsideDomain, phrase)
}

/// Draws without an answer, and what they do to the intervals.
fn left_out(answer: &HandAnswer, draws: usize) -> Caveat {
    let has_all = answer.quantities.iter().all(|of| of.estimate.interval(0.95).is_some());
    let phrase = match has_all {
        true => Phrase::new(
            "nothing follows from {0} of {1} draws of the inputs, which are left out; the intervals are widened by \
             as many at either end",
            "Aus {0} von {1} Ziehungen der Eingaben folgt nichts; sie sind ausgelassen, und die Bereiche sind an \
             beiden Enden um ebenso viele erweitert",
        ),
        false => Phrase::new(
            "nothing follows from {0} of {1} draws of the inputs, which are left out; the intervals are widened by \
             as many at either end, and there is none of 95 %",
            "Aus {0} von {1} Ziehungen der Eingaben folgt nichts; sie sind ausgelassen, die Bereiche sind an beiden \
             Enden um ebenso viele erweitert, und einen von 95 % gibt es nicht",
        ),
    };
    let count = |n: usize| PhraseValue::Name(n.to_string());
    Caveat::new(CaveatKind::LeftOut, phrase.with(count(answer.n_unsolved)).with(count(draws)))
}

fn assumed_value(number: &HandNumber) -> Caveat {
    let phrase = Phrase::new("{0}: {1} ± {2}", "{0}: {1} ± {2}")
        .with(PhraseValue::Term(number.field.label.to_owned()))
        .with(PhraseValue::given(number.field.range.quantity, number.value))
        .with(PhraseValue::three_digits(number.field.range.quantity, number.sigma));
    Caveat::new(CaveatKind::Assumed, phrase)
}

fn assumed_sigma(number: &HandNumber) -> Caveat {
    let phrase = Phrase::new(
        "standard deviation of {0}: {1}, since none is stated",
        "Standardabweichung von {0}: {1}, da keine angegeben ist",
    )
    .with(PhraseValue::Term(number.field.label.to_owned()))
    .with(PhraseValue::three_digits(number.field.range.quantity, number.sigma));
    Caveat::new(CaveatKind::Assumed, phrase)
}

/// A critical speed that is off even where nothing but the formula is wrong.
fn bias_caveat(bias: &YawMarkBias) -> Option<Caveat> {
    let [low, high] = UNBIASED;
    let phrase = Phrase::new(
        "on {0} marks of the 4DOF model at like speeds and friction the formula gives {1} of the true speed on the \
         average, {2} to {3}; the answer is not corrected for it",
        "An {0} Spuren des 4DOF-Modells bei ähnlicher Geschwindigkeit und Reibung ergibt die Formel im Mittel {1} \
         der wahren Geschwindigkeit, {2} bis {3}; die Antwort ist darum nicht korrigiert",
    );
    let share = |ratio: f64| PhraseValue::fixed(Quantity::Ratio, ratio, 0).in_unit("%");
    let phrase = phrase
        .with(PhraseValue::Name(bias.runs.len().to_string()))
        .with(share(bias.mean_ratio))
        .with(share(bias.range[0]))
        .with(share(bias.range[1]));
    let is_off = !(low..=high).contains(&bias.mean_ratio);
    is_off.then(|| Caveat::new(CaveatKind::Disagreement, phrase))
}

#[cfg(test)]
#[path = "hand_tests.rs"]
mod tests;
