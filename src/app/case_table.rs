//! The rows of the case table: which cases are listed, in which order, and the text of their cells.
//!
//! The filter and the sorting are computed here without egui; the pane that draws the table is in
//! `panels`.

use std::path::PathBuf;

use crate::app::case_filter::{CaseFilter, FilterError};
use crate::app::case_row::CaseRow;
use crate::app::replay::{ReplayStatus, Replays};
use crate::app::source::Source;
use crate::app::state::View;
use impactlab_study::CheckedDataset;

/// The cases that are listed and their order.
///
/// The order is kept between frames, because filtering and sorting 10 000 cases takes longer than
/// one frame.
#[derive(Default)]
pub struct CaseList {
    key: Option<ListKey>,
    order: Vec<usize>,
    error: Option<FilterError>,
}

/// The inputs from which the order was computed. The order is computed again when one of them
/// changes.
#[derive(PartialEq)]
struct ListKey {
    path: PathBuf,
    n_cases: usize,
    n_answers: u64,
    filter: String,
    sort: Option<(String, bool)>,
}

/// The listed data set with its cases in the order of the table.
#[derive(Clone, Copy)]
pub struct CaseTable<'a> {
    /// The listed data set and its checks.
    pub checked: &'a CheckedDataset,
    errors: Option<&'a ReplayStatus>,
    order: &'a [usize],
    /// What is wrong with the filter; the table is empty then.
    pub error: Option<&'a FilterError>,
}

impl CaseList {
    /// Filters and sorts the cases again if an input of the order has changed: the listed data set,
    /// its number of cases, its simulation, the filter, or the sort column. Without a listed data set
    /// the list becomes empty.
    pub fn update(&mut self, sources: &[Source], replays: &Replays, view: &View) {
        let (Some(path), Some(checked)) = (&view.listed, listed_in(sources, view)) else {
            *self = Self::default();
            return;
        };
        let errors = replays.get(path);
        let key = ListKey {
            path: path.clone(),
            n_cases: checked.dataset.cases.len(),
            n_answers: errors.map_or(0, |errors| errors.n_answers),
            filter: view.filter.clone(),
            sort: view.sort_column.clone().map(|key| (key, view.sort_descending)),
        };
        if self.key.as_ref() != Some(&key) {
            let found = order(checked, errors, view);
            self.error = found.as_ref().err().cloned();
            self.order = found.unwrap_or_default();
            self.key = Some(key);
        }
    }

    /// Returns the listed data set in the current order; `None` if no data set is listed.
    pub fn table<'a>(
        &'a self,
        sources: &'a [Source],
        replays: &'a Replays,
        view: &View,
    ) -> Option<CaseTable<'a>> {
        let checked = listed_in(sources, view)?;
        let errors = replays.get(view.listed.as_ref()?);
        Some(CaseTable { checked, errors, order: &self.order, error: self.error.as_ref() })
    }
}

impl<'a> CaseTable<'a> {
    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Returns the row at `index`, counted from 0; `None` beyond the last row.
    pub fn row(&self, index: usize) -> Option<CaseRow<'a>> {
        row(self.checked, self.errors, *self.order.get(index)?)
    }

    /// Returns the row index of a case, from 0; `None` if the filter excludes the case or there is
    /// no such case.
    pub fn position(&self, name: &str) -> Option<usize> {
        let cases = &self.checked.dataset.cases;
        self.order.iter().position(|&case| cases.get(case).is_some_and(|case| case.name == name))
    }
}

/// Returns the data set that the view lists, if it is loaded.
pub fn listed_in<'a>(sources: &'a [Source], view: &View) -> Option<&'a CheckedDataset> {
    let path = view.listed.as_ref()?;
    let source = sources.iter().find(|source| source.path == *path)?;
    source.dataset().map(std::sync::Arc::as_ref)
}

fn row<'a>(
    checked: &'a CheckedDataset,
    errors: Option<&'a ReplayStatus>,
    index: usize,
) -> Option<CaseRow<'a>> {
    let (case, flags) = (checked.dataset.cases.get(index)?, checked.flags.get(index)?);
    let error = errors.and_then(|errors| errors.error(&case.name));
    Some(CaseRow { name: &case.name, case, flags, error })
}

fn order(
    checked: &CheckedDataset,
    errors: Option<&ReplayStatus>,
    view: &View,
) -> Result<Vec<usize>, FilterError> {
    let filter = CaseFilter::new(&view.filter, &checked.dataset.cases)?;
    let all = 0..checked.dataset.cases.len();
    let mut rows: Vec<(usize, CaseRow<'_>)> = all
        .filter_map(|index| Some((index, row(checked, errors, index)?)))
        .filter(|(_, row)| filter.matches(row))
        .collect();
    if let Some(key) = &view.sort_column {
        sort(&mut rows, key, view.sort_descending);
    }
    Ok(rows.into_iter().map(|(index, _)| index).collect())
}

/// Sorts rows by a column. In rising order, rows with a number come first, by value; the others
/// follow by their text, and an empty text comes before any other. `descending` reverses this
/// order. Rows with equal keys keep their order.
///
/// The key `case` sorts by name. The key `flags` puts the cases with the most flags first in rising
/// order.
fn sort(rows: &mut [(usize, CaseRow<'_>)], key: &str, descending: bool) {
    let text = |row: &CaseRow<'_>| match key {
        "case" => row.name.to_owned(),
        "flags" => format!("{:03}", 999 - row.flags.len().min(999)),
        _ => row.case.attributes.text(key).unwrap_or_default().to_owned(),
    };
    rows.sort_by(|(_, a), (_, b)| {
        let order = match (a.number(key), b.number(key)) {
            (Some(a), Some(b)) => a.total_cmp(&b),
            (Some(_), None) => std::cmp::Ordering::Less,
            (None, Some(_)) => std::cmp::Ordering::Greater,
            (None, None) => text(a).cmp(&text(b)),
        };
        if descending { order.reverse() } else { order }
    });
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;
    use std::sync::Arc;

    use super::*;
    use crate::app::source::Content;
    use impactlab_core::data::{Dataset, Flag, FlagKind, check_case};

    fn fea() -> CheckedDataset {
        let mut report = |_| ControlFlow::Continue(());
        let dataset = Dataset::load(Path::new("datasets/fea"), &mut report).unwrap();
        let dataset = Arc::new(dataset.complete().unwrap());
        let flags = dataset.cases.iter().map(check_case).collect();
        CheckedDataset { dataset, flags, vehicle: None }
    }

    fn names(checked: &CheckedDataset, view: &View) -> Vec<String> {
        let name = |index: usize| checked.dataset.cases[index].name.clone();
        order(checked, None, view).unwrap().into_iter().map(name).collect()
    }

    #[test]
    fn filters_combine_and_know_attributes_flags_and_names() {
        let checked = fea();
        let view = |filter: &str| View { filter: filter.to_owned(), ..View::default() };
        assert_eq!(names(&checked, &view("")).len(), 100);
        assert_eq!(names(&checked, &view("c007")), ["c007"]);
        let hooked = names(&checked, &view("hooked=1"));
        assert_eq!(hooked.len(), 12);
        let heavy = names(&checked, &view("hooked=1 m_b_kg>2000"));
        assert!(!heavy.is_empty() && heavy.len() < hooked.len());
        assert_eq!(names(&checked, &view("side=LEFT")), names(&checked, &view("side=left")));
        assert_eq!(names(&checked, &view("hooked")), hooked);
        let n = |filter: &str| names(&checked, &view(filter)).len();
        let is_cut =
            |flags: &&Vec<Flag>| flags.iter().any(|flag| flag.kind == FlagKind::NotSeparated);
        let n_cut = checked.flags.iter().filter(is_cut).count();
        assert!(n_cut > 0);
        assert_eq!(n("cut"), n_cut);
        assert_eq!(n("hooked!=1"), 88);
        assert_eq!(n("m_b_kg<=2000") + n("m_b_kg>2000"), 100);
        assert_eq!(n("m_b_kg>=2000") + n("m_b_kg<2000"), 100);
        assert_eq!(n("side=left") + n("side!=left"), 100);
    }

    #[test]
    fn a_filter_that_makes_no_sense_is_an_error_and_no_empty_list() {
        let checked = fea();
        for (filter, named) in [
            ("no_such_column>1", "there is no column no_such_column; the columns are case, "),
            ("c007 m_b_kg>heavy", "m_b_kg holds numbers, `heavy` is none"),
            ("side<left", "side holds texts"),
            ("m_b_kg>", "`` is none"),
        ] {
            let view = View { filter: filter.to_owned(), ..View::default() };
            let error = order(&checked, None, &view).unwrap_err().to_string();
            assert!(error.contains(named), "{error}");
        }
    }

    /// Cases that were simulated again with another vehicle stayed in the order of the errors before.
    #[test]
    fn a_second_simulation_of_a_data_set_orders_its_cases_again() {
        let path = Path::new("datasets/fea").to_owned();
        let content = Content::Dataset(Arc::new(fea()));
        let sources = [Source { content, ..Source::loading(path.clone(), None) }];
        let view = View { listed: Some(path.clone()), ..View::default() };
        let mut replays = Replays::from([(path.clone(), ReplayStatus::default())]);
        let mut list = CaseList::default();
        let n_ordered = |n_answers: u64| {
            replays.entry(path.clone()).or_default().n_answers = n_answers;
            list.update(&sources, &replays, &view);
            std::mem::take(&mut list.order).len()
        };
        assert_eq!([0, 1, 1, 2, 2].map(n_ordered), [100, 100, 0, 100, 0]);
    }

    #[test]
    fn sorting_goes_both_ways() {
        let checked = fea();
        let mut view = View { sort_column: Some("peak_force_n".to_owned()), ..View::default() };
        let rising = names(&checked, &view);
        view.sort_descending = true;
        let mut falling = names(&checked, &view);
        falling.reverse();
        assert_eq!(rising, falling);
        assert_ne!(rising[0], "c001");
    }
}
