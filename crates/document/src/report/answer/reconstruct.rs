//! A reconstruction in a report.

use std::path::Path;

use crate::figure::{
    ReconstructionScene, marginal_figure, prior_values, reconstruction_scene_figure,
};
use crate::report::Block;
use crate::report::answer::Context;
use crate::report::answer::evidence::evidence_blocks;
use crate::report::answer::evidence_inputs::evidence_rows;
use crate::report::answer::facts::{facts_table, facts_with_meaning, provenance_of, with_writer};
use crate::report::answer::stills::reconstruction_still;
use crate::report::method::Method;
use crate::report::numbers::{Wording, fill};
use crate::report::opinion::{PartOpinion, opinion_of_reconstruction};
use crate::report::parts::{Part, PartPicture};
use impactlab_core::uncertainty::CaveatKind;
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_study::facts::HeldTooSeldom;
use impactlab_study::{
    Answer, ReconstructAnswer, ReconstructReport, ReconstructRequest, ReconstructedPaths,
};

/// Quantities of a collision whose distribution is drawn.
const DRAWN: [ReconstructedQuantity; 2] =
    [ReconstructedQuantity::StruckSpeed, ReconstructedQuantity::ClosingSpeed];
/// Those of a single car.
const DRAWN_OF_SINGLE_CAR: [ReconstructedQuantity; 2] =
    [ReconstructedQuantity::CarSpeed, ReconstructedQuantity::CarSideslip];

/// Restrictions with which an interval, or a figure without one, is no answer.
const DOUBTS: [CaveatKind; 2] = [CaveatKind::EvidenceUnexplained, CaveatKind::FewParticles];

/// What a reconstruction contributes.
pub(super) fn part(
    request: &ReconstructRequest,
    answer: &ReconstructAnswer,
    context: Context<'_>,
) -> Part {
    let (report, wording) = (&answer.report, context.wording);
    let words = wording.words;
    let ess = wording.fixed(report.ess, 0);
    let is_collision = report.kind.is_collision();
    let ask = if is_collision { words.ask_reconstruct } else { words.ask_single_car };
    let question = fill(ask, &[("name", &report.case)]);
    let mut blocks = vec![Block::paragraph(question.clone())];
    if report.modes.len() > 1 {
        // Their table stands in the opinion, and with the evidence.
        blocks.push(Block::paragraph(words.several_courses));
    }
    if let Some(hinges) = report.hinge_table() {
        blocks.extend([facts_table(&hinges, context), Block::paragraph(words.hinges_text)]);
    }
    let doubts = doubts(&answer.report, wording);
    let speeds = report.speed_table();
    match report.has_intervals() {
        true if doubts.is_empty() => {
            blocks.extend(facts_with_meaning(&speeds, words.meaning_posterior, context));
        }
        // That they hold with their probability would contradict the doubt below.
        true => blocks.push(facts_table(&speeds, context)),
        false => {
            blocks.push(facts_table(&speeds, context));
            blocks.push(Block::paragraph(words.too_few_particles));
        }
    }
    let mut opinion = opinion_of_reconstruction(report, &question, context);
    if doubts.is_empty() {
        blocks.extend(too_narrow(report.held_too_seldom(), &mut opinion, context));
    }
    blocks.extend(report.hand_table().map(|table| facts_table(&table, context)));
    if !doubts.is_empty() {
        let doubt = doubt_of(&doubts, report.has_intervals(), report.modes.len(), wording);
        opinion.answer = format!("{} {doubt}", opinion.answer);
        // How often intervals of answers without such a restriction held says nothing of these.
        opinion.held = None;
        opinion.is_doubtful = true;
        blocks.push(Block::paragraph(doubt));
    }
    let draws = [
        (words.particles, report.n_particles.to_string()),
        (words.simulated_motions, report.n_simulations.to_string()),
        (words.ess, ess),
        (words.log_evidence, wording.fixed(report.log_evidence, 2)),
    ];
    Part {
        kind: words.title_reconstruct.to_owned(),
        title: format!("{}: {}", words.title_reconstruct, report.case),
        opinion: Some(opinion),
        answer: blocks,
        pictures: pictures(request.site.as_deref(), answer, context),
        inputs: evidence_rows(request, answer, wording),
        evidence: evidence_blocks(report, context),
        sensitivity: report
            .budget_table()
            .iter()
            .map(|table| facts_table(table, context))
            .collect(),
        caveats: report.caveats.clone(),
        provenance: provenance_of(&report.provenance, &draws, wording),
        methods: match is_collision {
            true => {
                [Method::Reconstruction, Method::Impact, Method::FourDof, Method::DataSheet].into()
            }
            false => [Method::SingleCar, Method::FourDofAlone, Method::DataSheet].into(),
        },
        ..Part::default()
    }
}

/// The restrictions with which an answer is none, each once.
fn doubts(report: &Answer<ReconstructReport>, wording: &Wording) -> Vec<&'static str> {
    let doubts = report.caveats.iter().filter(|caveat| DOUBTS.contains(&caveat.kind));
    let mut doubts: Vec<&str> =
        doubts.map(|caveat| caveat.kind.label_in(wording.language)).collect();
    doubts.dedup();
    doubts
}

/// That the figures are not to be relied on, nor the probabilities of courses of events where there are several.
pub(super) fn doubt_of(
    doubts: &[&str],
    has_intervals: bool,
    n_courses: usize,
    wording: &Wording,
) -> String {
    let words = wording.words;
    let template = if has_intervals { words.meaning_doubtful } else { words.doubtful_figures };
    let courses = if n_courses > 1 { words.doubtful_courses } else { "" };
    fill(template, &[("courses", courses), ("badges", &doubts.join(", "))])
}

/// Says beside each figure of the opinion whose intervals held too seldom when they were tried how often they
/// did, and which these are; none where all held.
fn too_narrow(
    held_too_seldom: Vec<HeldTooSeldom>,
    opinion: &mut PartOpinion,
    context: Context<'_>,
) -> Option<Block> {
    let (words, format) = (context.wording.words, context.wording);
    let item = |HeldTooSeldom { held, is_of_everything }: HeldTooSeldom| {
        let name = with_writer(context, |writer| (writer.phrase)(&held.quantity));
        let known = if is_of_everything { words.with_everything_known } else { "" };
        let (share, n) = (format.percent(held.share_in_90()), held.n.to_string());
        let values = [("name", &*name), ("share", &*share), ("n", &*n), ("known", known)];
        if let Some([_, value]) = opinion.figures.iter_mut().find(|[of, _]| *of == name) {
            value.push_str(&fill(words.held_when_tried, &values));
        }
        fill(words.too_narrow_item, &values)
    };
    let items: Vec<String> = held_too_seldom.into_iter().map(item).collect();
    let text = || fill(words.too_narrow, &[("list", &items.join("; "))]);
    (!items.is_empty()).then(|| Block::paragraph(text()))
}

fn pictures(
    site: Option<&Path>,
    answer: &ReconstructAnswer,
    context: Context<'_>,
) -> Vec<PartPicture> {
    let Context { wording, .. } = context;
    let (words, units, report) = (wording.words, wording.units, &answer.report);
    let caveats = &report.caveats;
    let paths = ReconstructedPaths::in_language(answer, wording, &|label| wording.name(label));
    let scene = ReconstructionScene::new(answer, &paths);
    let plan = PartPicture::figure(
        words.reconstruction_picture.to_owned(),
        reconstruction_scene_figure(&scene, caveats, units),
    );
    let still = reconstruction_still(answer, &paths, site, caveats, context);
    let mut pictures: Vec<PartPicture> = still.into_iter().chain([plan]).collect();
    let drawn = if report.kind.is_collision() { DRAWN } else { DRAWN_OF_SINGLE_CAR };
    for quantity in drawn {
        let prior = prior_values(&answer.target, quantity);
        let label = wording.term(quantity.label());
        pictures.push(PartPicture::figure(
            fill(words.marginal_picture, &[("quantity", &label)]),
            marginal_figure(answer, quantity, &prior, caveats, units),
        ));
    }
    pictures
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Language;
    use crate::report::answer::stills::Grounds;
    use crate::report::language::words_of;
    use crate::report::opinion::Rank;
    use crate::report::paths::ShownPaths;
    use impactlab_core::units::UnitSystem;
    use impactlab_study::{Measured, Measurement};

    /// A warning of 3 independent draws stood above “equivalent to only 60 independent draws”: those of all
    /// motions, which the table tells, are not those of the evidence as stated, which the warning tells.
    #[test]
    fn why_there_is_no_interval_is_said_with_no_second_number_of_draws() {
        for language in [Language::En, Language::De] {
            let text = words_of(language).too_few_particles;
            let has_number = text.contains(|c: char| c == '{' || c.is_ascii_digit());
            assert!(!has_number, "{text}");
        }
    }

    /// “… and probabilities of courses of events” were doubted where the answer told of a single course.
    #[test]
    fn probabilities_of_courses_are_doubted_where_there_are_several() {
        let wording = Wording::english(UnitSystem::Si);
        let told = |n| doubt_of(&["few particles"], true, n, &wording);
        assert!(told(2).starts_with("These intervals, and the probabilities of the courses"));
        assert!(told(1).starts_with("These intervals are not to be relied on"), "{}", told(1));
    }

    /// The annex alone said that intervals of the heading and of the yaw rate are known to be too narrow.
    #[test]
    fn a_figure_whose_intervals_held_too_seldom_says_so_beside_it() {
        let tried = Measurement::shipped(Measured::ReconstructionOfEverything).unwrap();
        let names = ["relative heading of the cars", "yaw rate after the impact", "closing speed"];
        let [heading, yaw_rate, _] = names.map(|name| {
            let held = tried.held_in_all.iter().find(|held| held.quantity == name).unwrap();
            HeldTooSeldom { held, is_of_everything: name.contains("heading") }
        });
        let mut opinion = PartOpinion {
            rank: Rank::Reconstruction,
            question: String::new(),
            answer: String::new(),
            courses: Vec::new(),
            figures: names.map(|name| [name.to_owned(), "1".to_owned()]).into(),
            held: None,
            is_doubtful: false,
            hinges: Vec::new(),
            left_out: Vec::new(),
        };
        let (wording, paths) = (Wording::english(UnitSystem::Si), ShownPaths::default());
        let grounds = Grounds::default();
        let context = Context { wording: &wording, paths: &paths, grounds: &grounds };
        let block = too_narrow(vec![heading, yaw_rate], &mut opinion, context);
        let said = format!("{:?}", block.expect("two are too narrow"));
        assert!(said.contains(names[0]) && said.contains(names[1]), "{said}");
        let [of_heading, of_yaw_rate, of_closing] = &opinion.figures[..] else {
            panic!("{:?}", opinion.figures)
        };
        let held = "such intervals held in 80.0 % of 40 cases";
        let known = wording.words.with_everything_known;
        assert!(of_heading[1].ends_with(held) && of_heading[1].contains(known), "{of_heading:?}");
        assert!(of_yaw_rate[1].ends_with("held in 87.5 % of 40 cases"), "{of_yaw_rate:?}");
        assert_eq!(of_closing[1], "1");
        assert!(too_narrow(Vec::new(), &mut opinion, context).is_none());
    }
}
