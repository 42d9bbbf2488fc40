//! What the numbers of a file put in doubt about its columns, beside what contradicts itself.

use std::collections::BTreeMap;

use crate::data::{
    Channel, ColumnMap, ColumnUse, Note, Table, TimeSeries, course, path_speed, steering,
};

/// The remarks of every check that finds such a doubt.
pub(super) fn of_numbers(
    table: &Table,
    by_channel: &BTreeMap<Channel, ColumnUse>,
    series: &TimeSeries,
    map: Option<&ColumnMap>,
) -> Vec<Note> {
    let all = [
        course::offset_note(series),
        course::yaw_rate_note(series),
        path_speed::note(table, by_channel, series),
        steering::note(by_channel, map, series),
        steering::opposed(by_channel, series),
    ];
    all.into_iter().flatten().collect()
}
