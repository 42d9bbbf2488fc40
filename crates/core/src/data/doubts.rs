//! What the numbers of a file put in doubt about its columns, beside what contradicts itself.

use std::collections::BTreeMap;

use crate::data::{
    Channel, ColumnMap, ColumnUse, GeographicPlace, Note, Table, TimeSeries, course, path_speed,
    placeholders, signals, steering,
};
use crate::numerics::line_length;
use crate::units::significant;

/// How far a path of degrees reaches in metres at most, m, and on the earth at least, m.
const READ_M: f64 = 1.0;
const ON_EARTH_M: f64 = 5.0;
/// How fast it then goes there, m/s.
const SPEEDS_M_S: std::ops::Range<f64> = 0.5..70.0;
/// Way from row to row over how far the path reaches, at most: noise at rest goes to and fro.
const TO_AND_FRO: f64 = 3.0;
/// Latitude below which coordinates may as well be those of a plane, degrees.
const LEAST_LATITUDE_DEG: f64 = 1.0;

/// The remarks of every check that finds such a doubt.
pub(super) fn of_numbers(
    table: &Table,
    by_channel: &BTreeMap<Channel, ColumnUse>,
    series: &TimeSeries,
    map: Option<&ColumnMap>,
) -> Vec<Note> {
    let all = [
        degrees(by_channel, series),
        course::offset_note(series),
        course::backwards_note(series),
        course::yaw_rate_note(series),
        path_speed::note(table, by_channel, series),
        steering::note(by_channel, map, series),
        steering::opposed(by_channel, series),
    ];
    let placeholders = placeholders::notes(table, by_channel, series);
    let all = all.into_iter().flatten().chain(placeholders);
    all.chain(signals::notes(by_channel, series)).collect()
}

/// That x and y without a unit are longitude and latitude, as maps write them: in metres the vehicle stands, and in degrees
/// it drives.
fn degrees(by_channel: &BTreeMap<Channel, ColumnUse>, series: &TimeSeries) -> Option<Note> {
    let number = |channel: Channel| {
        let column = by_channel.get(&channel)?;
        (!column.unit_is_stated && column.terms.len() == 1).then_some(column.number)
    };
    let [x_number, y_number] = [number(Channel::X)?, number(Channel::Y)?];
    let [x, y] = [series.get(Channel::X)?, series.get(Channel::Y)?];
    let places: Vec<[f64; 2]> = x.iter().zip(y).map(|(x, y)| [*x, *y]).collect();
    let &[longitude_deg, latitude_deg] = places.first()?;
    let duration_s = series.time_s().last()? - series.time_s().first()?;
    let origin = GeographicPlace::from_degrees(latitude_deg, longitude_deg)?;
    let on_earth_m = |[longitude_deg, latitude_deg]: &[f64; 2]| {
        let place = GeographicPlace::from_degrees(*latitude_deg, *longitude_deg)?;
        Some(origin.to_east_m(place).hypot(origin.to_north_m(place)))
    };
    let on_earth_m: Vec<f64> = places.iter().map(on_earth_m).collect::<Option<_>>()?;
    let on_earth_m = on_earth_m.into_iter().fold(0.0, f64::max);
    let read_m = places.iter().map(|at| line_length(&[places[0], *at])).fold(0.0, f64::max);
    let steps_m = line_length(&places);
    let is_driven = on_earth_m > ON_EARTH_M && SPEEDS_M_S.contains(&(on_earth_m / duration_s));
    let stands = read_m < READ_M && steps_m < TO_AND_FRO * read_m;
    (stands && is_driven && latitude_deg.abs() > LEAST_LATITUDE_DEG).then(|| Note::Doubt {
        text: format!(
            "x and y name no unit, and in metres the path reaches {} m: as longitude and latitude in degrees it reaches \
             {on_earth_m:.0} m (map x=east({y_number} {x_number}),y=north({y_number} {x_number}))",
            significant(read_m)
        ),
    })
}
