//! What the models of a report were compared with, and how far they were off.
//!
//! The tables are those of `assets/validation.toml`, header and rows as they stand in
//! `docs/VALIDATION.md` too, but those of methods that answer nothing; a test looks each of their lines up
//! there.

use std::collections::BTreeSet;

use crate::report::method::{Method, with_speeds};
use crate::report::numbers::Wording;
use crate::report::{Block, Column, Table};
use impactlab_study::{Measured, Measurement, ValidationTable};

/// Beginnings of lines about methods that answer nothing.
const OTHER_METHODS: [&str; 2] = ["| classic pulse |", "| Gaussian processes |"];

/// The column of the method, which says nothing where all lines are of one: the heading above the table names it.
const METHOD: &str = "method";

/// What a method was compared with: a paragraph, and tables with their captions. Of a method that the opinion
/// does not rest on the paragraph alone.
pub(super) fn validation_blocks(
    method: Method,
    opinion: &BTreeSet<Method>,
    wording: &Wording,
) -> Vec<Block> {
    let words = wording.words;
    let text = match method {
        Method::Impact => words.validation_impact,
        Method::FourDof | Method::FourDofAlone => words.validation_four_dof,
        Method::ContactLaw => words.validation_contact,
        Method::ForceNetwork => words.validation_force,
        Method::ResponseNetwork => words.validation_response,
        Method::Reconstruction => words.validation_reconstruction,
        Method::SingleCar => words.validation_single_car,
        Method::DataSheet => words.validation_sheet,
    };
    let text = with_speeds(text, wording);
    let captions: &[(Measured, &str)] = match method {
        Method::Impact => &[(Measured::Impact, words.table_impact)],
        Method::FourDof | Method::FourDofAlone => &[(Measured::FourDof, words.table_four_dof)],
        Method::ContactLaw => &[(Measured::Pairs, words.table_contact)],
        Method::ForceNetwork => &[
            (Measured::ForceNetwork, words.table_force),
            (Measured::ForceNetwork, words.table_force_coverage),
        ],
        Method::ResponseNetwork => &[(Measured::ResponseNetwork, words.table_response)],
        Method::Reconstruction => &[
            (Measured::ReconstructionOfEverything, words.table_reconstruction),
            (Measured::ReconstructionWithoutEdr, words.table_without_recorder),
            (Measured::ReconstructionOfRest, words.table_rest_alone),
        ],
        Method::SingleCar | Method::DataSheet => &[],
    };
    if !opinion.is_empty() && !opinion.contains(&method) {
        return vec![Block::paragraph(format!("{}: {text}", method.name(wording)))];
    }
    let heading = Block::heading(2, method.name(wording));
    let tables = captions.iter().enumerate().filter_map(|(idx, (subject, caption))| {
        let earlier = captions[..idx].iter().filter(|(other, _)| other == subject).count();
        let measurement = Measurement::shipped(*subject)?;
        let published = measurement.tables.get(earlier)?;
        let day = wording.day(&measurement.date);
        let caption = format!("{caption} ({} {day})", words.measured_on);
        Some(Block::Table(table(&caption, published, wording)))
    });
    [heading, Block::paragraph(text)].into_iter().chain(tables).collect()
}

/// The lines as a table.
fn table(caption: &str, published: &ValidationTable, wording: &Wording) -> Table {
    let is_shown = |line: &&String| !OTHER_METHODS.iter().any(|other| line.starts_with(other));
    let lines: Vec<Vec<&str>> =
        published.lines.iter().filter(is_shown).map(|line| raw_cells(line)).collect();
    let of_one_method = column_of_one_method(&lines);
    let cells = |line: Vec<&str>| -> Vec<String> {
        let told = line.iter().enumerate().filter(|(idx, _)| Some(*idx) != of_one_method);
        told.map(|(_, cell)| wording.validation_cell(cell)).collect()
    };
    let mut lines = lines.into_iter().map(cells);
    let header = lines.next().unwrap_or_default();
    let n = header.len();
    let column = |title| Column { title, is_numeric: false };
    let rows = lines.map(|mut row| {
        row.resize(n, String::new());
        row
    });
    let caption = caption.to_owned();
    Table { caption, columns: header.into_iter().map(column).collect(), rows: rows.collect() }
}

/// The cells of a line.
fn raw_cells(line: &str) -> Vec<&str> {
    let inner = line.trim().trim_start_matches('|').trim_end_matches('|');
    inner.split('|').map(str::trim).collect()
}

/// The column of the method if all lines are of one.
///
/// - `lines`: header and rows.
fn column_of_one_method(lines: &[Vec<&str>]) -> Option<usize> {
    let (header, rows) = lines.split_first()?;
    let column = header.iter().position(|title| *title == METHOD)?;
    let mut methods = rows.iter().map(|row| row.get(column));
    let first = methods.next()?;
    methods.all(|method| method == first).then_some(column)
}

impl Wording {
    /// A cell of these tables: words are translated, numbers get the decimal sign of the language.
    fn validation_cell(&self, cell: &str) -> String {
        let has_words = cell.chars().filter(|c| c.is_alphabetic()).count() > 1;
        if has_words { self.local(&self.term(cell)) } else { self.local(cell) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Language;
    use crate::report::language::{Words, words_of};
    use impactlab_study::{HeldIntervals, Library, ModelChoice};

    const VALIDATION: &str = include_str!("../../../../docs/VALIDATION.md");
    const LIMITS: &str = include_str!("../../../../docs/guide/limits.md");
    const README: &str = include_str!("../../../../README.md");
    const DATASETS: &str = include_str!("../../../../datasets/README.md");

    fn words() -> [&'static Words; 2] {
        [Language::En, Language::De].map(words_of)
    }

    fn assert_each_says(told: &[(&str, String)]) {
        for (text, part) in told {
            assert!(text.contains(&**part), "{part:?} is not said");
        }
    }

    /// A column of eleven said “reconstruction” in every row below a heading that says so.
    #[test]
    fn the_method_of_all_lines_is_not_told_in_each() {
        let wording = Wording::english(impactlab_core::units::UnitSystem::Si);
        let lines = |methods: [&str; 2]| {
            let rows = methods.map(|method| format!("| speed | {method} | 2.4 |"));
            let header = "| quantity | method | bias |".to_owned();
            let lines = std::iter::once(header).chain(rows).collect();
            table("", &ValidationTable { heading: String::new(), lines }, &wording)
        };
        let alike = lines(["reconstruction"; 2]);
        assert_eq!(
            (alike.columns.len(), &alike.rows[0][..]),
            (2, &["speed", "2.4"].map(str::to_owned)[..])
        );
        assert_eq!(lines(["reconstruction", "swarm"]).columns.len(), 3);
    }

    #[test]
    fn texts_say_what_the_default_networks_learned_from() {
        let (library, choice) = (Library::default(), ModelChoice::default());
        let force = library.force_model(&choice).unwrap();
        let response = library.response_model(&choice).unwrap();
        let n_impacts = force.record().train.len() + force.record().detail.validation.len();
        let n_motions = response.record().train.len();
        let n_cars = response.population().unwrap().cars().len();
        let impacts = format!("learned from {n_impacts} simulated impacts");
        let motions = format!("from {n_motions} simulated trajectories of {n_cars} cars");
        let [en, de] = words();
        assert_each_says(&[
            (en.limits_force, impacts.clone()),
            (de.limits_force, format!("aus {n_impacts} simulierten Stößen")),
            (en.limits_response, format!("simulated motions of {n_cars} cars")),
            (de.limits_response, format!("simulierten Bewegungen von {n_cars} Fahrzeugen")),
            (LIMITS, impacts.clone()),
            (LIMITS, motions.clone()),
            (README, impacts),
            (README, motions),
            (DATASETS, format!("response network has learned from {n_cars} cars")),
            (VALIDATION, format!("Shipped model: {n_impacts} training cases")),
        ]);
    }

    #[test]
    fn texts_say_how_many_cases_were_held_out_and_what_their_intervals_held() {
        let forces = Measurement::shipped(Measured::ForceNetwork).unwrap();
        let motions = &Measurement::shipped(Measured::ResponseNetwork).unwrap().held;
        // Of the slow PITs, which answers tell nothing of by themselves.
        let [errors, shares] = [0, 1].map(|idx| &forces.tables[idx].lines);
        let all = raw_cells(&errors[0])[0];
        let n_forces =
            all.strip_prefix("all columns, all ").unwrap().strip_suffix(" cases").unwrap();
        let percent = |name: &str| {
            let line = shares.iter().find(|line| raw_cells(line)[0] == name).unwrap();
            raw_cells(line)[3].split_once(' ').unwrap().0
        };
        let n_motions = motions.first().unwrap().n;
        let [en, de] = words();
        assert_eq!(percent("impulse"), "100");
        assert_each_says(&[
            (en.validation_force, format!("against {n_forces} finite-element runs")),
            (de.validation_force, format!("gegen {n_forces} Finite-Elemente-Rechnungen")),
            (en.validation_response, format!("against {n_motions} simulated motions")),
            (de.validation_response, format!("gegen {n_motions} simulierte Bewegungen")),
            (
                LIMITS,
                format!(
                    "its intervals of the peak {} %, of the duration {} % and of the impulse all",
                    percent("peak"),
                    percent("duration")
                ),
            ),
        ]);
    }

    /// The report of a car from a data sheet stated the error of one whose every parameter was measured, and that of
    /// a wall or a T-bone the error of flanks and PITs.
    #[test]
    fn texts_say_of_other_cars_and_other_collisions_that_the_errors_are_larger_or_unknown() {
        let by_sheet = "1.13 m (0.68) in the mean over the first 4 s";
        assert!(VALIDATION.contains(&format!("{by_sheet} and")), "{by_sheet}");
        let few = "of three T-bone collisions the regions of 50 % hold next to nothing, of four rear-end collisions";
        assert!(VALIDATION.contains(few), "{few}");
        let [en, de] = words();
        assert_each_says(&[
            (en.validation_four_dof, "1.13 m in the mean over the first 4 s".to_owned()),
            (en.validation_four_dof, "0.68 m in the median".to_owned()),
            (de.validation_four_dof, "4 s im Mittel 1,13 m, im Median 0,68 m".to_owned()),
            (en.validation_contact, "four that were hit from behind".to_owned()),
            (de.validation_contact, "vier, die von hinten getroffen wurden".to_owned()),
            (en.validation_impact, "walls and poles".to_owned()),
            (de.validation_impact, "Wände und Pfähle".to_owned()),
        ]);
    }

    /// What stands in texts of the collisions of the whole range is what the table of the measurement says.
    #[test]
    fn texts_say_of_fast_collisions_what_was_measured() {
        let mut lines = VALIDATION.lines().skip_while(|line| !line.ends_with("| duration held |"));
        let cells = |line: &'static str| line.split('|').map(str::trim).collect::<Vec<_>>();
        let (header, row) = (cells(lines.next().unwrap()), cells(lines.nth(1).unwrap()));
        let at = |title: &str| row[header.iter().position(|of| *of == title).unwrap()];
        assert_eq!(row[1], "force network");
        let n = header[1].strip_suffix(" cases").unwrap();
        let rounded = |number: &str| number.parse::<f64>().unwrap().round();
        let (median, mean) = at("impulse").trim_end_matches(')').split_once(" (").unwrap();
        let (median, mean) = (rounded(median), rounded(mean));
        let held = |title| at(title).split_once(", ").unwrap().1;
        let [impulse, peak, duration] =
            [held("impulse held"), held("peak held"), held("duration held")];
        // It is what answers tell.
        for (name, share) in [("impulse", impulse), ("peak", peak), ("duration", duration)] {
            let forces = &Measurement::shipped(Measured::ForceNetwork).unwrap().held;
            let of = forces.iter().find(|of: &&HeldIntervals| of.quantity == name).unwrap();
            assert_eq!(of.n.to_string(), n);
            assert_eq!(format!("{:.0}", 100.0 * of.share_in_90()), share, "{name}");
        }
        let [en, de] = words();
        assert_each_says(&[
            (en.validation_force, format!("Of {n} others")),
            (
                en.validation_force,
                format!(
                    "held {impulse} % of the impulses, {peak} % of the peaks and {duration} % of the durations; \
                     it erred there by {mean} % of the impulse in the mean, and by {median} % in the median"
                ),
            ),
            (de.validation_force, format!("Von {n} anderen")),
            (
                de.validation_force,
                format!(
                    "{impulse} % der Impulse, {peak} % der größten Kräfte und {duration} % der Dauern; der \
                     Fehler des Impulses war dort im Mittel {mean} %, im Median {median} %"
                ),
            ),
            (LIMITS, format!("On {n} other cases")),
            (
                LIMITS,
                format!("errs by {median} % of the impulse in the median and {mean} % in the mean"),
            ),
            (
                LIMITS,
                format!(
                    "its intervals of the impulse {impulse} %, of the peak {peak} % and of the \
                     duration {duration} %"
                ),
            ),
        ]);
    }
}
