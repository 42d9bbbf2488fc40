//! What the models of a report were compared with, and how far they were off.
//!
//! The tables are copied from `docs/VALIDATION.md`, header and rows as they stand there; a test looks
//! each of their lines up in it. Nothing else in the program repeats these numbers.

use crate::report::method::Method;
use crate::report::numbers::Wording;
use crate::report::{Block, Column, Table};

/// Lines of a table of `docs/VALIDATION.md`.
#[derive(Debug, Clone, Copy)]
pub struct ValidationTable {
    /// The heading in that document below which it stands.
    pub heading: &'static str,
    /// Header and rows, each a line of that document.
    pub lines: &'static [&'static str],
}

/// Impulse solution against finite-element runs.
const IMPACT: ValidationTable = ValidationTable {
    heading: "## Impact solver",
    lines: &[
        "| | e, μ_c | 65 training cases | 25 test cases |",
        "| restitution on the normal component | 0.38, 0.30 (the default) | 13.6 (17.1) | 17.2 (19.2) |",
        "| restitution from the common velocity | 0.38, 0.31 | 12.6 (16.4) | 16.9 (18.8) |",
    ],
};

/// 4DOF model against the multibody reference.
const FOUR_DOF: ValidationTable = ValidationTable {
    heading: "## 4DOF vehicle against the multibody reference",
    lines: &[
        "| set | cases | mean [m] | std [m] | median [m] | final error, median [m] | steps with energy growth |",
        "| trajectories-fea, all | 100 | 0.649 | 0.869 | 0.414 | 1.29 | 0 |",
        "| trajectories-pulse, all | 100 | 0.690 | 0.783 | 0.464 | 1.38 | 0 |",
    ],
};

/// Errors of the force network.
const FORCE: ValidationTable = ValidationTable {
    heading: "## Force network",
    lines: &[
        "| all columns, all 25 cases | history | RMSE/peak | impulse | peak | duration |",
        "| force network | 22.5 (24.0) | 4.6 (5.9) | 5.3 (7.4) | 13.5 (14.2) | 10.4 (15.8) |",
        "| classic pulse | 36.7 (35.7) | 8.0 (8.7) | 12.4 (15.5) | 14.6 (18.0) | 12.5 (16.3) |",
        "| Gaussian processes | 26.8 (27.9) | 6.0 (6.9) | 5.8 (7.2) | 14.0 (15.2) | 10.2 (15.3) |",
    ],
};

/// Coverage of the force network.
const FORCE_COVERAGE: ValidationTable = ValidationTable {
    heading: "## Force network",
    lines: &[
        "| | 50 % | 80 % | 90 % | 95 % |",
        "| F(t) | 66 ± 3 | 84 ± 3 | 89 ± 2 | 92 ± 2 |",
        "| impulse | 76 ± 9 | 100 (≥ 87) | 100 (≥ 87) | 100 (≥ 87) |",
        "| peak | 40 ± 10 | 60 ± 10 | 76 ± 9 | 96 ± 4 |",
        "| duration | 80 ± 8 | 92 ± 6 | 92 ± 6 | 92 ± 6 |",
    ],
};

/// Response network on cars that it has not seen.
const RESPONSE: ValidationTable = ValidationTable {
    heading: "## Response network on cars that it has not seen",
    lines: &[
        "| model | motions of the car | coasting (45) | braked or dragged (27) | rest (11) | in 50 % | in 90 % | ends in 50 % | ends in 90 % |",
        "| 4DOF by data sheet | 0 | 1.23 (0.98) | 1.18 (0.73) | 4.1 (3.7) | | | | |",
        "| network | 0 | 0.89 (0.53) | 0.80 (0.56) | 2.9 (1.7) | 53 % | 90 % | 35 % | 72 % |",
    ],
};

/// Reconstruction of staged collisions, everything known.
const RECONSTRUCTION: ValidationTable = ValidationTable {
    heading: "## Reconstruction",
    lines: &[
        "| quantity | method | cases | in 50 % | 80 % | 90 % | 95 % | median error [km/h] | bias [km/h] | width of 90 % [km/h] | CRPS [km/h] |",
        "| struck car | reconstruction | reported | 55 | 85 | 90 | 95 | 2.4 | −1.3 | 13.4 | 2.86 |",
        "| struck car | reconstruction | tuning | 45 | 80 | 100 | 100 | 2.4 | −0.2 | 12.7 | 2.05 |",
        "| closing speed | reconstruction | reported | 80 | 95 | 100 | 100 | 1.1 | +0.1 | 11.8 | 1.28 |",
        "| striking car | reconstruction | reported | 55 | 95 | 95 | 100 | 6.1 | −4.4 | 29.0 | 4.60 |",
    ],
};

/// The same without the event data recorder.
const WITHOUT_RECORDER: ValidationTable = ValidationTable {
    heading: "## Reconstruction",
    lines: &[
        "| quantity | method | cases | in 50 % | 80 % | 90 % | 95 % | median error [km/h] | bias [km/h] | width of 90 % [km/h] | CRPS [km/h] |",
        "| struck car | reconstruction | reported | 55 | 90 | 90 | 95 | 3.0 | −1.4 | 14.7 | 2.99 |",
        "| struck car | reconstruction | tuning | 60 | 90 | 95 | 100 | 2.8 | −0.8 | 16.5 | 2.09 |",
        "| closing speed | reconstruction | reported | 70 | 95 | 100 | 100 | 0.8 | +0.3 | 11.9 | 1.31 |",
        "| striking car | reconstruction | reported | 55 | 90 | 95 | 100 | 6.2 | −3.4 | 29.4 | 4.67 |",
    ],
};

/// The same with the rest poses, damage, masses and friction alone.
const REST_ALONE: ValidationTable = ValidationTable {
    heading: "## Reconstruction",
    lines: &[
        "| quantity | method | cases | in 50 % | 80 % | 90 % | 95 % | median error [km/h] | bias [km/h] | width of 90 % [km/h] | CRPS [km/h] |",
        "| struck car | reconstruction | reported | 65 | 90 | 95 | 100 | 3.3 | +0.8 | 28.6 | 3.44 |",
        "| struck car | reconstruction | tuning | 65 | 90 | 95 | 100 | 3.3 | −0.4 | 31.7 | 3.58 |",
        "| closing speed | reconstruction | reported | 80 | 90 | 90 | 95 | 1.6 | +0.2 | 18.5 | 2.77 |",
        "| striking car | reconstruction | reported | 80 | 100 | 100 | 100 | 3.0 | −2.3 | 39.7 | 4.18 |",
    ],
};

/// All of them.
pub const VALIDATION_TABLES: [&ValidationTable; 8] = [
    &IMPACT,
    &FOUR_DOF,
    &FORCE,
    &FORCE_COVERAGE,
    &RESPONSE,
    &RECONSTRUCTION,
    &WITHOUT_RECORDER,
    &REST_ALONE,
];

/// What a method was compared with: a paragraph, and tables with their captions.
pub(super) fn validation_blocks(method: Method, wording: &Wording) -> Vec<Block> {
    let words = wording.words;
    let (text, tables): (&str, Vec<(&str, &ValidationTable)>) = match method {
        Method::Impact => (words.validation_impact, vec![(words.table_impact, &IMPACT)]),
        Method::FourDof => (words.validation_four_dof, vec![(words.table_four_dof, &FOUR_DOF)]),
        Method::ForceNetwork => (
            words.validation_force,
            vec![(words.table_force, &FORCE), (words.table_force_coverage, &FORCE_COVERAGE)],
        ),
        Method::ResponseNetwork => {
            (words.validation_response, vec![(words.table_response, &RESPONSE)])
        }
        Method::Reconstruction => (
            words.validation_reconstruction,
            vec![
                (words.table_reconstruction, &RECONSTRUCTION),
                (words.table_without_recorder, &WITHOUT_RECORDER),
                (words.table_rest_alone, &REST_ALONE),
            ],
        ),
        Method::DataSheet => (words.validation_sheet, Vec::new()),
    };
    let heading = Block::heading(2, method.name(wording));
    let tables = tables
        .into_iter()
        .map(|(caption, published)| Block::Table(table(caption, published, wording)));
    [heading, Block::paragraph(text)].into_iter().chain(tables).collect()
}

/// The lines as a table.
fn table(caption: &str, published: &ValidationTable, wording: &Wording) -> Table {
    let cells = |line: &str| -> Vec<String> {
        let inner = line.trim().trim_start_matches('|').trim_end_matches('|');
        inner.split('|').map(|cell| wording.validation_cell(cell.trim())).collect()
    };
    let mut lines = published.lines.iter().map(|line| cells(line));
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

impl Wording {
    /// A cell of these tables: words are translated, numbers get the decimal sign of the language.
    fn validation_cell(&self, cell: &str) -> String {
        let has_words = cell.chars().filter(|c| c.is_alphabetic()).count() > 1;
        if has_words { self.local(&self.term(cell)) } else { self.local(cell) }
    }
}
