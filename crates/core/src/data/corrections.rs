//! Which changes of a map remove what contradicts itself in a motion. Each is tried on the numbers of the
//! file before it is offered: what it is to correct must be gone, and nothing else may come in its place.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use crate::data::consistency::FACTOR_REACH;
use crate::data::correction::Change;
use crate::data::si_values::{instants_s, si_values};
use crate::data::velocity_fit::{FITTING, is_other_length};
use crate::data::{
    Channel, ColumnUse, Contradiction, Correction, Note, ReadSettings, Table, TimeSeries,
    VelocityAxes, VelocityFit, contradictions, velocity_fit,
};
use crate::units::{Quantity, Unit};

/// The channels that can contradict each other.
const MOTION: [Channel; 7] = [
    Channel::Time,
    Channel::X,
    Channel::Y,
    Channel::Yaw,
    Channel::Vx,
    Channel::Vy,
    Channel::YawRate,
];

/// The remarks on what contradicts itself in a motion, with what corrects it.
///
/// - `columns`, `settings`: how the table was read;
/// - `series`: what was read, with velocities in the axes in which they stand in the file.
pub(super) fn notes(
    table: &Table,
    columns: &BTreeMap<Channel, ColumnUse>,
    settings: &ReadSettings,
    series: &TimeSeries,
) -> Vec<Note> {
    let found = findings(series, settings);
    if found.is_empty() {
        return Vec::new();
    }
    let of_motion = |channel: &Channel| Some((*channel, columns.get(channel)?.clone()));
    let columns = MOTION.iter().filter_map(of_motion).collect();
    let reading = Reading { table, columns, settings: settings.clone() };
    let note = |finding: &Finding| {
        let corrections = reading.corrections(*finding, &found);
        match *finding {
            Finding::Velocities { fit, read_as } => Note::Velocities { fit, read_as, corrections },
            Finding::Contradiction(found) => Note::Contradiction { found, corrections },
        }
    };
    found.iter().map(note).collect()
}

/// What contradicts itself in a motion.
#[derive(Clone, Copy)]
enum Finding {
    Velocities { fit: VelocityFit, read_as: VelocityAxes },
    Contradiction(Contradiction),
}

/// Velocities first, then the others.
fn findings(series: &TimeSeries, settings: &ReadSettings) -> Vec<Finding> {
    let read_as = settings.velocities.unwrap_or(VelocityAxes::Body);
    let fit = velocity_fit(series).filter(|fit| !fit.allows(read_as));
    let velocities = fit.map(|fit| Finding::Velocities { fit, read_as });
    velocities
        .into_iter()
        .chain(contradictions(series).into_iter().map(Finding::Contradiction))
        .collect()
}

impl Finding {
    /// Whether the other one is of the same kind.
    fn is_like(self, other: Self) -> bool {
        use Finding::{Contradiction as Of, Velocities as V};
        match (self, other) {
            (V { fit: a, .. }, V { fit: b, .. }) => velocity_rank(a) == velocity_rank(b),
            (Of(a), Of(b)) => std::mem::discriminant(&a) == std::mem::discriminant(&b),
            _ => false,
        }
    }

    /// Whether it may be what remains of the other one: velocities of the right size in other axes.
    fn may_remain_of(self, other: Self) -> bool {
        match (self, other) {
            (Self::Velocities { fit: a, .. }, Self::Velocities { fit: b, .. }) => {
                velocity_rank(a) > velocity_rank(b)
            }
            _ => self.is_like(other),
        }
    }
}

/// How far velocities are from fitting: in size, in direction, in their axes.
fn velocity_rank(fit: VelocityFit) -> u8 {
    match fit {
        VelocityFit::Neither(ratio) if is_other_length(ratio) => 0,
        VelocityFit::Neither(_) => 1,
        VelocityFit::Body | VelocityFit::World | VelocityFit::Both => 2,
    }
}

/// A change of how a table is read.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Edit {
    /// The numbers of a channel count with the other sign.
    Mirror(Channel),
    /// The numbers of a channel have another unit.
    Unit(Channel, Unit),
    /// Yaw angles are compass headings if they were taken as yaw angles, and the other way round.
    Headings,
    /// Yaw angles are so much larger, rad.
    Offset(f64),
    /// The velocities are in the other axes.
    Axes,
}

/// A motion in a table, and how it is read.
struct Reading<'a> {
    table: &'a Table,
    columns: BTreeMap<Channel, ColumnUse>,
    settings: ReadSettings,
}

impl Reading<'_> {
    /// What contradicts itself; `None` if the table cannot be read so.
    fn findings(&self) -> Option<Vec<Finding>> {
        let mut series = TimeSeries::default();
        for (channel, column) in &self.columns {
            let (table, settings) = (self.table, &self.settings);
            if *channel == Channel::Time {
                series = TimeSeries::new(instants_s(table, column, settings).ok()?.0).ok()?;
                continue;
            }
            let values = si_values(table, column, series.time_s(), settings).ok()?;
            series.insert(*channel, values).ok()?;
        }
        Some(findings(&series, &self.settings))
    }

    /// The same motion, read in another way; `None` if a column cannot be read so.
    fn edited(&self, edits: &[Edit]) -> Option<Self> {
        let (mut columns, mut settings) = (self.columns.clone(), self.settings.clone());
        for edit in edits {
            match *edit {
                Edit::Mirror(channel) => {
                    let column = own_numbers(&mut columns, channel)?;
                    column.terms.iter_mut().for_each(|term| term.sign = -term.sign);
                }
                Edit::Unit(channel, unit) => {
                    let column = own_numbers(&mut columns, channel)?;
                    (column.unit, column.unit_is_stated) = (unit, true);
                    column.terms.iter_mut().for_each(|term| term.unit = unit);
                }
                Edit::Headings => settings.compass_headings = !settings.compass_headings,
                Edit::Offset(angle_rad) => {
                    let before_rad = settings.yaw_offset_rad.unwrap_or(0.0);
                    settings.yaw_offset_rad = Some(before_rad + angle_rad);
                }
                Edit::Axes => settings.velocities = Some(other_axes(&settings)),
            }
        }
        Some(Self { table: self.table, columns, settings })
    }

    /// What corrects a finding and brings in no other, the likeliest first. Of those that leave more
    /// contradictions than another does, none is returned.
    fn corrections(&self, finding: Finding, all: &[Finding]) -> Vec<Correction> {
        let tried = |edits: &Vec<Edit>| {
            let left = self.edited(edits)?.findings()?;
            let is_gone = !left.iter().any(|of| of.is_like(finding));
            let is_known = |of: &Finding| all.iter().any(|known| of.may_remain_of(*known));
            (is_gone && left.iter().all(is_known)).then_some((left.len(), edits.clone()))
        };
        let best_of = |group: Vec<Vec<Edit>>| {
            group.iter().filter_map(tried).min_by_key(|(n_left, _)| *n_left)
        };
        let found: Vec<(usize, Vec<Edit>)> =
            self.candidates(finding).into_iter().filter_map(best_of).collect();
        let least = found.iter().map(|(n_left, _)| *n_left).min();
        let least = found.iter().filter(|(n_left, _)| Some(*n_left) == least);
        least.map(|(_, edits)| self.correction(edits)).collect()
    }

    /// Changes of which one may correct a finding, in groups of which one is enough.
    fn candidates(&self, finding: Finding) -> Vec<Vec<Vec<Edit>>> {
        use Channel::{Vx, Vy, X, Y, Yaw, YawRate};
        let mirrored_yaw =
            || vec![vec![Edit::Mirror(Yaw)], vec![Edit::Mirror(Yaw), Edit::Mirror(YawRate)]];
        let angles = |of_yaw: &str, of_rate: &str| {
            let yaw = Edit::Unit(Yaw, unit(Quantity::Angle, of_yaw));
            let rate = Edit::Unit(YawRate, unit(Quantity::AngularVelocity, of_rate));
            vec![vec![yaw], vec![yaw, rate]]
        };
        let degrees = || angles("deg", "deg/s");
        // What is at a right angle to the left of the motion is turned to the right.
        let quarter = |angle_rad: f64| vec![vec![Edit::Offset(-FRAC_PI_2.copysign(angle_rad))]];
        let mirrored_place = |axis, velocity| {
            let place = Edit::Mirror(axis);
            vec![vec![place], vec![place, Edit::Mirror(velocity)]]
        };
        match finding {
            Finding::Contradiction(found) => match found {
                Contradiction::Compass => vec![vec![vec![Edit::Headings]]],
                Contradiction::Offset { angle_rad } => vec![quarter(angle_rad)],
                Contradiction::CompassOrOffset { angle_rad } => {
                    vec![vec![vec![Edit::Headings]], quarter(angle_rad)]
                }
                Contradiction::Mirrored { axis: X } => vec![mirrored_place(X, Vx)],
                Contradiction::Mirrored { .. } => vec![mirrored_place(Y, Vy), mirrored_yaw()],
                Contradiction::YawUnit { factor } if factor < 1.0 => vec![angles("rad", "rad/s")],
                Contradiction::YawUnit { .. } => vec![degrees()],
                Contradiction::YawRate { factor } => self.yaw_rate_candidates(factor),
                Contradiction::YawRateUnrelated | Contradiction::Held { .. } => Vec::new(),
            },
            Finding::Velocities { fit: VelocityFit::Neither(ratio), .. } => {
                match is_other_length(ratio) {
                    true => self.size_candidates(ratio),
                    false => {
                        let both = vec![Edit::Mirror(Vx), Edit::Mirror(Vy)];
                        let groups = [
                            vec![vec![Edit::Headings]],
                            [quarter(1.0), quarter(-1.0)].concat(),
                            vec![vec![Edit::Mirror(Vy)], both],
                            mirrored_place(Y, Vy),
                            mirrored_yaw(),
                            degrees(),
                        ];
                        groups.into_iter().map(with_axes).collect()
                    }
                }
            }
            Finding::Velocities { .. } => vec![vec![vec![Edit::Axes]]],
        }
    }

    /// Other units and signs of yaw rate and yaw angle.
    ///
    /// - `factor`: how many times what the yaw rate says the yaw angle changes by.
    fn yaw_rate_candidates(&self, factor: f64) -> Vec<Vec<Vec<Edit>>> {
        use Channel::{Yaw, YawRate};
        let is_near = |size: f64| (factor.abs() / size - 1.0).abs() < FACTOR_REACH;
        if is_near(1.0) {
            return vec![vec![vec![Edit::Mirror(YawRate)]], vec![vec![Edit::Mirror(Yaw)]]];
        }
        let mirrors: &[Edit] = match factor < 0.0 {
            true => &[Edit::Mirror(YawRate), Edit::Mirror(Yaw)],
            false => &[],
        };
        let with_mirrors = |edit: Edit| match mirrors {
            [] => vec![vec![edit]],
            _ => mirrors.iter().map(|mirror| vec![edit, *mirror]).collect(),
        };
        let rates = self.units(YawRate).filter(|(size, _)| is_near(*size));
        let angles = self.units(Yaw).filter(|(size, _)| is_near(1.0 / size));
        let rates: Vec<Edit> = rates.map(|(_, unit)| Edit::Unit(YawRate, unit)).collect();
        let angles = angles.map(|(_, unit)| Edit::Unit(Yaw, unit));
        rates.into_iter().chain(angles).map(with_mirrors).collect()
    }

    /// Other units of velocities and positions.
    ///
    /// - `ratio`: the length of the path that the velocities give over that which the positions give.
    fn size_candidates(&self, ratio: f64) -> Vec<Vec<Vec<Edit>>> {
        use Channel::{Vx, Vy, X, Y};
        // Units of nearly one size, such as km/h and ft/s, both fit the noise of positions.
        let nearest = |channel, wanted: f64| {
            let off = |size: f64| (size / wanted - 1.0).abs();
            let near = self.units(channel).filter(|(size, _)| off(*size) < FITTING);
            near.min_by(|a, b| off(a.0).total_cmp(&off(b.0))).map(|(_, unit)| unit)
        };
        let of = |unit: Option<Unit>, channels: [Channel; 2]| {
            unit.map(|unit| channels.map(|channel| Edit::Unit(channel, unit)).to_vec())
        };
        let speeds = of(nearest(Vx, 1.0 / ratio), [Vx, Vy]).into_iter();
        let lengths = of(nearest(X, ratio), [X, Y]);
        speeds.chain(lengths).map(|edits| with_axes(vec![edits])).collect()
    }

    /// The other units of a channel, each with its size over that of the unit in which it is read.
    fn units(&self, channel: Channel) -> impl Iterator<Item = (f64, Unit)> + use<'_> {
        let column = self.columns.get(&channel).filter(|column| !column.terms.is_empty());
        column.into_iter().flat_map(move |column| {
            let units = channel.quantity().units().iter().filter(|unit| unit.is_guessed());
            units.map(|unit| (unit.si_per_unit / column.unit.si_per_unit, *unit))
        })
    }

    fn correction(&self, edits: &[Edit]) -> Correction {
        let edited = self.edited(edits);
        let edited = edited.as_ref().unwrap_or(self);
        let mut changes = Vec::new();
        if edited.settings.compass_headings != self.settings.compass_headings {
            changes.push(Change::CompassHeadings(edited.settings.compass_headings));
        }
        let offset_rad = edited.settings.yaw_offset_rad;
        if let Some(offset_rad) = offset_rad.filter(|_| offset_rad != self.settings.yaw_offset_rad)
        {
            changes.push(Change::YawOffset(offset_rad));
        }
        if let Some(axes) = edited.settings.velocities.filter(|_| edits.contains(&Edit::Axes)) {
            changes.push(Change::Velocities(axes));
        }
        let is_changed = |column: &&ColumnUse| self.columns.get(&column.channel) != Some(*column);
        let columns = edited.columns.values().filter(is_changed);
        changes.extend(columns.map(|column| Change::Column(column.channel, column.source())));
        let parts: Vec<String> = self.parts(edits);
        Correction::new(capitalised(&parts.join(", ")), changes)
    }

    /// What changes do, in words; those of one kind in one part.
    fn parts(&self, edits: &[Edit]) -> Vec<String> {
        let mut parts = Vec::new();
        let names = |is_meant: &dyn Fn(&Edit) -> Option<Channel>| {
            let names: Vec<&str> = edits.iter().filter_map(is_meant).map(name).collect();
            names.join(" and ")
        };
        let mut told: Vec<Unit> = Vec::new();
        for edit in edits {
            match *edit {
                Edit::Unit(_, unit) if !told.contains(&unit) => {
                    told.push(unit);
                    let of_unit = |edit: &Edit| match edit {
                        Edit::Unit(channel, of) => (*of == unit).then_some(*channel),
                        _ => None,
                    };
                    let n = edits.iter().filter(|edit| of_unit(edit).is_some()).count();
                    let are = if n > 1 { "are" } else { "is" };
                    parts.push(format!("{} {are} in {}", names(&of_unit), unit.symbol));
                }
                Edit::Headings => parts.push(match self.settings.compass_headings {
                    false => "heading is a compass heading".to_owned(),
                    true => "heading is a yaw angle".to_owned(),
                }),
                Edit::Offset(angle_rad) => {
                    let sign = if angle_rad < 0.0 { "−" } else { "" };
                    parts
                        .push(format!("turn yaw by {sign}{:.0} deg", angle_rad.to_degrees().abs()));
                }
                Edit::Axes => parts.push(match other_axes(&self.settings) {
                    VelocityAxes::Body => "velocities are in body axes".to_owned(),
                    VelocityAxes::World => "velocities are in world axes".to_owned(),
                }),
                Edit::Unit(..) | Edit::Mirror(_) => {}
            }
        }
        let of_mirror = |edit: &Edit| match edit {
            Edit::Mirror(channel) => Some(*channel),
            _ => None,
        };
        let mirrored = names(&of_mirror);
        if !mirrored.is_empty() {
            parts.push(format!("mirror {mirrored}"));
        }
        parts
    }
}

/// The column of a channel if its numbers stand in it and are not computed from those of several columns.
fn own_numbers(
    columns: &mut BTreeMap<Channel, ColumnUse>,
    channel: Channel,
) -> Option<&mut ColumnUse> {
    columns.get_mut(&channel).filter(|column| column.formula.is_none())
}

fn other_axes(settings: &ReadSettings) -> VelocityAxes {
    match settings.velocities.unwrap_or(VelocityAxes::Body) {
        VelocityAxes::Body => VelocityAxes::World,
        VelocityAxes::World => VelocityAxes::Body,
    }
}

/// The same changes, and after them those with the velocities in the other axes.
fn with_axes(group: Vec<Vec<Edit>>) -> Vec<Vec<Edit>> {
    let turned = group.iter().map(|edits| [edits.as_slice(), &[Edit::Axes]].concat());
    let turned: Vec<Vec<Edit>> = turned.collect();
    [group, turned].concat()
}

fn unit(quantity: Quantity, symbol: &str) -> Unit {
    let known = quantity.units().iter().find(|unit| unit.symbol == symbol);
    known.copied().unwrap_or(quantity.si_unit())
}

/// What a channel is called in the text of a button.
fn name(channel: Channel) -> &'static str {
    match channel {
        Channel::X => "x",
        Channel::Y => "y",
        Channel::Yaw => "yaw",
        Channel::YawRate => "yaw rate",
        other => other.label(),
    }
}

fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    match chars.next() {
        // The name of a quantity keeps its letter.
        Some(first) if chars.as_str().starts_with(|c: char| c.is_alphabetic()) => {
            first.to_uppercase().chain(chars).collect()
        }
        _ => text.to_owned(),
    }
}
