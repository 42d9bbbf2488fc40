//! What the user has chosen in the import dialog: a channel and a unit for each column.

use std::collections::BTreeMap;

use impactlab_core::data::{
    Channel, ColumnMap, ColumnProposal, ColumnRef, ColumnSource, ReadSettings, SignedColumn,
};
use impactlab_core::units::{Quantity, Unit};

/// The choice for one column.
pub(super) struct ColumnChoice {
    pub proposal: ColumnProposal,
    /// The channel that the column holds; `None` if it is not used.
    pub channel: Option<Channel>,
    /// The unit of its numbers; `None` as long as neither the file nor the user has said it.
    pub unit: Option<Unit>,
    /// Whether the numbers count with the other sign.
    pub is_negated: bool,
}

/// The choices for all columns.
#[derive(Default)]
pub(super) struct Choices {
    pub columns: Vec<ColumnChoice>,
    /// Whether the component of the force that no column holds is zero.
    pub other_force_is_zero: bool,
}

impl ColumnChoice {
    fn new(proposal: ColumnProposal) -> Self {
        Self { proposal, channel: None, unit: None, is_negated: false }
    }

    /// Chooses a channel. The unit is the one that the file states for it; a unit that the user has
    /// chosen stays if it measures the channel.
    pub fn choose(&mut self, channel: Option<Channel>) {
        self.channel = channel;
        let Some(quantity) = channel.map(Channel::quantity) else { return };
        let stated = self.proposal.stated_unit(quantity).ok().flatten();
        let chosen = self.unit.filter(|unit| unit.quantity == quantity);
        self.unit = stated.or(chosen);
    }

    /// Whether the channel of the column has units and none of them is known.
    pub fn lacks_unit(&self) -> bool {
        self.unit.is_none()
            && self.channel.is_some_and(|channel| channel.quantity() != Quantity::Ratio)
    }
}

impl Choices {
    /// The choices that the headers suggest. Where several columns suggest the same channel, it is
    /// proposed for the first of them.
    pub fn suggested(proposals: Vec<ColumnProposal>) -> Self {
        let mut taken = Vec::new();
        let column = |proposal: ColumnProposal| {
            let suggestion = proposal.suggestion().filter(|channel| !taken.contains(channel));
            taken.extend(suggestion);
            let mut column = ColumnChoice::new(proposal);
            column.choose(suggestion);
            column
        };
        // What the headers name counts before what their words suggest.
        let mut ordered: Vec<ColumnProposal> = proposals;
        ordered.sort_by_key(|proposal| proposal.guess.is_none());
        let mut columns: Vec<ColumnChoice> = ordered.into_iter().map(column).collect();
        columns.sort_by_key(|column| column.proposal.number);
        Self { columns, other_force_is_zero: false }
    }

    /// The choices that a map makes.
    pub fn from_map(proposals: Vec<ColumnProposal>, map: &ColumnMap) -> Self {
        let columns = proposals.into_iter().map(ColumnChoice::new).collect();
        let mut choices = Self { columns, other_force_is_zero: false };
        for (channel, source) in map.iter() {
            let plain = |number| vec![SignedColumn { number, is_negated: false, unit: None }];
            let terms = match &source.column {
                ColumnRef::Number(number) => plain(*number),
                ColumnRef::Name(name) => {
                    let named = choices.columns.iter().find(|of| of.proposal.name == *name);
                    plain(named.map_or(0, |column| column.proposal.number))
                }
                ColumnRef::Sum(columns) => columns.clone(),
                // What is computed from several columns is found by their names, without a choice.
                ColumnRef::Computed(..) => continue,
                ColumnRef::Zero => {
                    choices.other_force_is_zero = true;
                    continue;
                }
            };
            for term in terms {
                let of_number = |of: &&mut ColumnChoice| of.proposal.number == term.number;
                if let Some(column) = choices.columns.iter_mut().find(of_number) {
                    column.choose(Some(channel));
                    column.unit = term.unit.or(source.unit).or(column.unit);
                    column.is_negated = term.is_negated;
                }
            }
        }
        choices
    }

    /// The force component that no column holds although another column holds the other one.
    pub fn missing_force(&self) -> Option<Channel> {
        let has = |channel| self.columns.iter().any(|column| column.channel == Some(channel));
        let pairs = [(Channel::Fx, Channel::Fy), (Channel::FxBody, Channel::FyBody)];
        pairs.into_iter().find_map(|(x, y)| match (has(x), has(y)) {
            (true, false) => Some(y),
            (false, true) => Some(x),
            _ => None,
        })
    }

    /// The columns of each channel.
    fn by_channel(&self) -> BTreeMap<Channel, Vec<&ColumnChoice>> {
        let mut by_channel: BTreeMap<Channel, Vec<&ColumnChoice>> = BTreeMap::new();
        for column in &self.columns {
            if let Some(channel) = column.channel {
                by_channel.entry(channel).or_default().push(column);
            }
        }
        by_channel
    }

    /// What has to be said before the file can be opened, in words.
    pub fn open_questions(&self) -> Vec<String> {
        let mut questions = Vec::new();
        for column in self.columns.iter().filter(|column| column.lacks_unit()) {
            let ColumnProposal { number, name, .. } = &column.proposal;
            questions.push(format!("choose the unit of column {number}, {name:?}"));
        }
        let by_channel = self.by_channel();
        if !by_channel.contains_key(&Channel::Time) {
            questions.push("choose the column of the time".to_owned());
        }
        if let Some(channel) = self.missing_force().filter(|_| !self.other_force_is_zero) {
            let label = channel.label();
            questions.push(format!("choose a column for {label}, or say that {label} is zero"));
        }
        for (channel, columns) in by_channel {
            // A time may be in seconds and nanoseconds.
            let is_summed = channel == Channel::Time
                || matches!(channel.quantity(), Quantity::Force | Quantity::Moment);
            if columns.len() > 1 && !is_summed {
                questions.push(format!("{} is chosen for several columns", channel.label()));
            }
        }
        questions
    }

    /// The map that makes these choices.
    pub fn map(&self, settings: &ReadSettings) -> ColumnMap {
        let source = |columns: &[&ColumnChoice]| {
            let unit = columns.first().and_then(|column| column.unit);
            let is_common = columns.iter().all(|column| column.unit == unit);
            let terms = columns.iter().map(|column| SignedColumn {
                number: column.proposal.number,
                is_negated: column.is_negated,
                unit: column.unit.filter(|_| !is_common),
            });
            let column = match columns {
                [only] if !only.is_negated => ColumnRef::Number(only.proposal.number),
                _ => ColumnRef::Sum(terms.collect()),
            };
            ColumnSource { column, unit: unit.filter(|_| is_common) }
        };
        let chosen = self.by_channel();
        let mut map: ColumnMap =
            chosen.iter().map(|(channel, columns)| (*channel, source(columns))).collect();
        if let Some(channel) = self.missing_force().filter(|_| self.other_force_is_zero) {
            map.insert(channel, ColumnSource { column: ColumnRef::Zero, unit: None });
        }
        map.settings = Box::new(settings.clone());
        map
    }
}
