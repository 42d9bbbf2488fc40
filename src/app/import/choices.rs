//! What the user has chosen in the import dialog: a channel and a unit for each column.

use std::collections::BTreeMap;

use impactlab_core::data::{
    Channel, ColumnMap, ColumnProposal, ColumnRef, ColumnSource, Formula, FormulaPart,
    ReadSettings, SignedColumn,
};
use impactlab_core::units::{Quantity, Unit};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Held {
    /// A channel, or a part of its sum.
    Channel(Channel),
    /// What a channel is computed from.
    Part(FormulaPart),
}

/// The choice for one column.
pub(super) struct ColumnChoice {
    pub proposal: ColumnProposal,
    /// What the column holds; `None` if it is not used.
    pub held: Option<Held>,
    /// The unit of its numbers; `None` as long as neither the file nor the user has said it.
    pub unit: Option<Unit>,
    /// Whether the numbers count with the other sign.
    pub is_negated: bool,
}

/// The choices for all columns.
pub(super) struct Choices {
    pub columns: Vec<ColumnChoice>,
    /// Whether the component of the force that no column holds is zero.
    pub other_force_is_zero: bool,
    /// Which way x and y point if they follow from latitude and longitude.
    places: [(Channel, Formula); 2],
}

/// x to the east and y to the north.
const PLACES: [(Channel, Formula); 2] = [(Channel::X, Formula::East), (Channel::Y, Formula::North)];

/// What a yaw angle is computed from; of several the last one counts.
const YAWS: [Formula; 2] = [Formula::Course, Formula::Quaternion];

impl ColumnChoice {
    fn new(proposal: ColumnProposal) -> Self {
        Self { proposal, held: None, unit: None, is_negated: false }
    }

    /// The channel that the column holds.
    pub fn channel(&self) -> Option<Channel> {
        match self.held {
            Some(Held::Channel(channel)) => Some(channel),
            Some(Held::Part(_)) | None => None,
        }
    }

    /// Chooses what the column holds. The unit of a channel is the one that the file states for it; a unit
    /// that the user has chosen stays if it measures the channel. The sign is that which the header says.
    pub fn choose(&mut self, held: Option<Held>) {
        self.held = held;
        let Some(channel) = self.channel() else { return };
        self.is_negated = self.proposal.is_turned(channel);
        let quantity = channel.quantity();
        let stated = self.proposal.stated_unit(quantity).ok().flatten();
        let chosen = self.unit.filter(|unit| unit.quantity == quantity);
        self.unit = stated.or(chosen);
    }

    /// Whether the channel of the column has units and none of them is known.
    pub fn lacks_unit(&self) -> bool {
        self.unit.is_none()
            && self.channel().is_some_and(|channel| channel.quantity() != Quantity::Ratio)
    }
}

impl Default for Choices {
    fn default() -> Self {
        Self { columns: Vec::new(), other_force_is_zero: false, places: PLACES }
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
            let part = proposal.part.map(Held::Part);
            let mut column = ColumnChoice::new(proposal);
            column.choose(suggestion.map(Held::Channel).or(part));
            column
        };
        // What the headers name counts before what their words suggest.
        let mut ordered: Vec<ColumnProposal> = proposals;
        ordered.sort_by_key(|proposal| proposal.guess.is_none());
        let mut columns: Vec<ColumnChoice> = ordered.into_iter().map(column).collect();
        columns.sort_by_key(|column| column.proposal.number);
        let mut choices = Self { columns, ..Self::default() };
        choices.leave_out_what_is_known();
        choices
    }

    /// What a channel is computed from is not proposed if a column holds the channel itself.
    fn leave_out_what_is_known(&mut self) {
        let has = |channel| self.columns.iter().any(|of| of.channel() == Some(channel));
        let (has_place, has_yaw) = (has(Channel::X) && has(Channel::Y), has(Channel::Yaw));
        for column in &mut self.columns {
            let Some(Held::Part(part)) = column.held else { continue };
            let is_known = match part {
                FormulaPart::Latitude | FormulaPart::Longitude => has_place,
                FormulaPart::QuaternionW
                | FormulaPart::QuaternionX
                | FormulaPart::QuaternionY
                | FormulaPart::QuaternionZ
                | FormulaPart::Course => has_yaw,
            };
            if is_known {
                column.held = None;
            }
        }
    }

    /// The choices that a map makes.
    pub fn from_map(proposals: Vec<ColumnProposal>, map: &ColumnMap) -> Self {
        let columns = proposals.into_iter().map(ColumnChoice::new).collect();
        let mut choices = Self { columns, ..Self::default() };
        for (channel, source) in map.iter() {
            let plain = |number| vec![SignedColumn { number, is_negated: false, unit: None }];
            let terms = match &source.column {
                ColumnRef::Number(number) => plain(*number),
                ColumnRef::Name(name) => {
                    let named = choices.columns.iter().find(|of| of.proposal.name == *name);
                    plain(named.map_or(0, |column| column.proposal.number))
                }
                ColumnRef::Sum(columns) => columns.clone(),
                ColumnRef::Computed(formula, numbers) => {
                    choices.choose_parts(channel, *formula, numbers);
                    continue;
                }
                ColumnRef::Zero => {
                    choices.other_force_is_zero = true;
                    continue;
                }
            };
            for term in terms {
                if let Some(column) = choices.column_mut(term.number) {
                    column.choose(Some(Held::Channel(channel)));
                    column.unit = term.unit.or(source.unit).or(column.unit);
                    column.is_negated = term.is_negated;
                }
            }
        }
        choices
    }

    /// Takes the SI unit for every column that is used, but for a time the one that its numbers or the file
    /// say.
    pub fn take_si_units(&mut self) {
        for column in &mut self.columns {
            let Some(channel) = column.channel() else { continue };
            let of_time = column.proposal.time_unit().filter(|_| channel == Channel::Time);
            column.unit = of_time.or(Some(channel.quantity().si_unit()));
        }
    }

    fn column_mut(&mut self, number: usize) -> Option<&mut ColumnChoice> {
        self.columns.iter_mut().find(|column| column.proposal.number == number)
    }

    fn choose_parts(&mut self, channel: Channel, formula: Formula, numbers: &[usize]) {
        if let Some(place) = self.places.iter_mut().find(|(of, _)| *of == channel) {
            place.1 = formula;
        }
        for (part, number) in formula.parts().iter().zip(numbers) {
            if let Some(column) = self.column_mut(*number) {
                column.choose(Some(Held::Part(*part)));
            }
        }
    }

    /// The columns of a formula in their order; `None` if none is chosen.
    ///
    /// # Errors
    /// What is missing or chosen twice, in words.
    fn columns_of(&self, formula: Formula) -> Option<Result<Vec<usize>, String>> {
        let of = |part: FormulaPart| {
            let holds = move |column: &&ColumnChoice| column.held == Some(Held::Part(part));
            self.columns.iter().filter(holds).map(|column| column.proposal.number)
        };
        if formula.parts().iter().all(|part| of(*part).next().is_none()) {
            return None;
        }
        let one = |part: &FormulaPart| {
            let numbers: Vec<usize> = of(*part).collect();
            match numbers[..] {
                [number] => Ok(number),
                [] => Err(format!("choose the column of the {}", part_name(*part))),
                _ => Err(format!("the {} is chosen for several columns", part_name(*part))),
            }
        };
        Some(formula.parts().iter().map(one).collect())
    }

    /// The channels that are computed from the columns that are chosen, with the numbers of these or what is
    /// open about them.
    fn computed(&self) -> Vec<(Channel, Formula, Result<Vec<usize>, String>)> {
        let computed = self.places.into_iter().chain(YAWS.map(|formula| (Channel::Yaw, formula)));
        let found = computed
            .filter_map(|(channel, formula)| Some((channel, formula, self.columns_of(formula)?)));
        found.collect()
    }

    /// Whether a channel is read, from a column of its own or computed from others.
    pub fn has(&self, channel: Channel) -> bool {
        self.columns.iter().any(|column| column.channel() == Some(channel))
            || self.computed().iter().any(|(of, ..)| *of == channel)
    }

    /// Whether positions follow from latitude and longitude, as those of a receiver do.
    pub fn has_geographic_place(&self) -> bool {
        let is_place = |(_, formula, _): &(Channel, Formula, Result<Vec<usize>, String>)| {
            matches!(formula, Formula::East | Formula::North)
        };
        self.computed().iter().any(is_place)
    }

    /// The force component that no column holds although another column holds the other one.
    pub fn missing_force(&self) -> Option<Channel> {
        let has = |channel| self.columns.iter().any(|of| of.channel() == Some(channel));
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
            if let Some(channel) = column.channel() {
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
        for (channel, _, numbers) in self.computed() {
            let question = match numbers {
                Err(question) => question,
                Ok(_) if !by_channel.contains_key(&channel) => continue,
                Ok(_) => {
                    let label = channel.label();
                    format!("{label} is chosen for a column and computed from others")
                }
            };
            if !questions.contains(&question) {
                questions.push(question);
            }
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
        for (channel, formula, numbers) in self.computed() {
            if let (Ok(numbers), false) = (numbers, chosen.contains_key(&channel)) {
                let column = ColumnRef::Computed(formula, numbers);
                map.insert(channel, ColumnSource { column, unit: None });
            }
        }
        if let Some(channel) = self.missing_force().filter(|_| self.other_force_is_zero) {
            map.insert(channel, ColumnSource { column: ColumnRef::Zero, unit: None });
        }
        map.settings = Box::new(settings.clone());
        map
    }
}

/// What a column holds of a formula, within a sentence.
fn part_name(part: FormulaPart) -> &'static str {
    match part {
        FormulaPart::Latitude => "latitude",
        FormulaPart::Longitude => "longitude",
        FormulaPart::QuaternionW => "w of the quaternion",
        FormulaPart::QuaternionX => "x of the quaternion",
        FormulaPart::QuaternionY => "y of the quaternion",
        FormulaPart::QuaternionZ => "z of the quaternion",
        FormulaPart::Course => "course",
    }
}
