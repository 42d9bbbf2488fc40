//! Recognises the spelling of column headers and units, such as `Fx [kN]`, `time(ms)`,
//! `yaw_rate_deg_s` and `Fx in kN`.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::data::Channel;
use crate::data::stated_side::without_side;
use crate::units::{Quantity, Unit};

const OPENING: [char; 4] = ['[', '(', '{', '<'];
const CLOSING: [char; 4] = [']', ')', '}', '>'];

/// The longest header, bytes, that is taken for the name of a channel and its unit.
const MAX_NAME_BYTES: usize = 128;

/// The longest text, bytes, that is taken for a unit.
const MAX_UNIT_BYTES: usize = 40;

/// The channel and the unit that a header names.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Meaning {
    /// The header names a channel; the unit is `None` if the header names no unit.
    Channel(Channel, Option<Unit>),
    /// The header names a channel, followed by a unit that does not measure it.
    WrongUnit(Channel, String),
    /// The header names no channel.
    Unknown,
}

/// Interprets a header: the longest beginning that names a channel, with what follows as its unit.
pub(crate) fn meaning(header: &str) -> Meaning {
    if let Some(&own) = Channel::ALL.iter().find(|own| own.header() == header) {
        return Meaning::Channel(own, Some(own.quantity().si_unit()));
    }
    if header.len() > MAX_NAME_BYTES {
        return Meaning::Unknown;
    }
    let mut wrong_unit = None;
    for (channel, rest) in divisions(header).into_iter().rev() {
        let Some(text) = unit_text(rest) else {
            return Meaning::Channel(channel, None);
        };
        if let Some(unit) = unit(channel.quantity(), text) {
            return Meaning::Channel(channel, Some(unit));
        }
        if is_bracketed(rest) || is_unit(text) {
            wrong_unit.get_or_insert(Meaning::WrongUnit(channel, text.to_owned()));
        }
    }
    match (channel(header), wrong_unit) {
        // The letters alone do not tell `steering_wheel [%]` from a header without a unit, nor an
        // acceleration `X (g)` from the position `xg`.
        (Some(_), Some(Meaning::WrongUnit(channel, text))) if is_unit(&text) => {
            Meaning::WrongUnit(channel, text)
        }
        (Some(channel), _) => Meaning::Channel(channel, None),
        (None, Some(wrong_unit)) => wrong_unit,
        (None, None) => Meaning::Unknown,
    }
}

/// The name in a header without its unit and without a number at its end, by which `Fx`, `Fx.1` and
/// `Fx_2 [kN]` are the same.
pub(crate) fn stem(header: &str) -> String {
    let (name, _) = numbered(header).unwrap_or((header, ""));
    letters_and_digits(name.split(OPENING).next().unwrap_or(name))
}

/// The name and the rest of a header whose name ends in a number, such as `Fx.1` or `Fx 2 [kN]`.
fn numbered(header: &str) -> Option<(&str, &str)> {
    let end = header.find(OPENING).unwrap_or(header.len());
    let (name, rest) = header.split_at(end);
    let name = name.trim_end();
    let bare = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let bare =
        if bare.len() < name.len() { bare.trim_end_matches([' ', '.', '_', '-', '#']) } else { "" };
    (!bare.is_empty()).then_some((bare, rest))
}

/// The meaning of a header that ends in a number, if it is that of a force or moment: of one contact of
/// several.
pub(crate) fn numbered_force(header: &str) -> Option<Meaning> {
    let (name, rest) = numbered(header)?;
    let meaning = meaning(&format!("{name}{rest}"));
    let Meaning::Channel(channel, _) = meaning else { return None };
    matches!(channel.quantity(), Quantity::Force | Quantity::Moment).then_some(meaning)
}

/// The beginnings of a header that name a channel and are followed by another character than a
/// letter or digit, with what follows. A beginning that ends within brackets is left out.
fn divisions(header: &str) -> Vec<(Channel, &str)> {
    let (mut key, mut of_key, mut is_open) = (String::new(), None, false);
    let mut found = Vec::new();
    for (at, c) in header.char_indices() {
        if c.is_alphanumeric() {
            key.extend(c.to_lowercase());
            of_key = CHANNELS.get(&key).copied();
            continue;
        }
        let (name, rest) = header.split_at(at);
        if !is_open && let Some(channel) = own_channel(name).or(of_key) {
            found.push((channel, rest));
        }
        is_open = OPENING.contains(&c) || (is_open && !CLOSING.contains(&c));
    }
    found
}

/// The channels by the letters and digits of their names.
static CHANNELS: LazyLock<BTreeMap<String, Channel>> = LazyLock::new(|| {
    let mut channels = BTreeMap::new();
    for &channel in Channel::ALL {
        let names = channel.aliases().iter().map(|&alias| alias.to_owned());
        for name in names.chain([letters_and_digits(channel.short_name())]) {
            channels.entry(name).or_insert(channel);
        }
    }
    channels
});

fn own_channel(name: &str) -> Option<Channel> {
    Channel::ALL.iter().copied().find(|channel| name.eq_ignore_ascii_case(channel.header()))
}

/// The channel of this name: the header of the program's own files with or without the unit, or a
/// header that other programs use.
pub(crate) fn channel(name: &str) -> Option<Channel> {
    own_channel(name).or_else(|| CHANNELS.get(&letters_and_digits(name)).copied())
}

/// The channel that words in a header suggest, though they do not say the whole: `Kraft [kN]` is a
/// force, of unknown direction. A dialog proposes it; no file is read so without being asked.
pub(crate) fn suggestion(header: &str) -> Option<Channel> {
    let lower = header.to_lowercase();
    let name = lower.split(OPENING).next().unwrap_or_default();
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    let last = name.trim_end().rsplit(|c: char| !c.is_alphanumeric()).next();
    let is_lateral = has(&["quer", "later", "seit"]) || last == Some("y");
    let channels = [
        (&["zeit", "time"][..], [Channel::Time, Channel::Time]),
        (&["drehrate", "gierrate", "yaw rate", "giergeschwindigkeit"], [Channel::YawRate; 2]),
        (&["kraft", "force"], [Channel::Fx, Channel::Fy]),
        (&["geschwindigkeit", "speed", "velocity"], [Channel::Vx, Channel::Vy]),
        (&["weg", "position", "displacement"], [Channel::X, Channel::Y]),
    ];
    let (_, [along, across]) = channels.into_iter().find(|(words, _)| has(words))?;
    Some(if is_lateral { across } else { along })
}

/// The unit of `quantity` with this spelling; `None` if there is none.
pub(crate) fn unit(quantity: Quantity, text: &str) -> Option<Unit> {
    let letters: String = text.chars().filter(|c| c.is_alphabetic()).collect();
    // A kilonewton is no knot.
    let is_kilonewton = quantity == Quantity::Speed && ["kN", "KN"].contains(&letters.as_str());
    let text = match (quantity, text.trim()) {
        (Quantity::Length, "'" | "′") => "ft",
        (Quantity::Length, "\"" | "″") => "in",
        (_, text) => text,
    };
    // A degree in German; `grad` without a capital may be a gon.
    let key = checked_unit_key(&text.replace("Grad", "deg"));
    unit_of_key(quantity, &key.filter(|_| !is_kilonewton)?)
}

/// The key of a text that may be a unit; `None` if it is too long or may be millinewtons.
fn checked_unit_key(text: &str) -> Option<String> {
    // Upper and lower case are not distinguished below. Only `MN` is a meganewton: `mN` is nine
    // orders of magnitude less, and `mn` may be either, so that both are refused.
    let is_milli = text.to_ascii_lowercase().contains("mn") && !text.contains("MN");
    (text.len() <= MAX_UNIT_BYTES && !is_milli).then(|| unit_key(text))
}

fn unit_of_key(quantity: Quantity, key: &str) -> Option<Unit> {
    let key = match (quantity, key) {
        (Quantity::Time, "ss" | "sek") => "s",
        (Quantity::Time, "millis" | "mss") => "ms",
        (Quantity::Time, "minute" | "minutes" | "mins") => "min",
        (Quantity::Time, "hr" | "hrs" | "hour" | "hours") => "h",
        (Quantity::Length, "meter" | "metre" | "meters" | "metres") => "m",
        (Quantity::Length, "foot" | "feet") => "ft",
        (Quantity::Length, "inch" | "inches") => "in",
        (Quantity::Length, "yard" | "yards" | "yds") => "yd",
        (Quantity::Length, "mile" | "miles") => "mi",
        (Quantity::Speed, "mps" | "ms1") => "ms",
        (Quantity::Speed, "kph" | "kmph") => "kmh",
        (Quantity::Speed, "fps") => "fts",
        (Quantity::Speed, "ips" | "inchs") => "ins",
        (Quantity::Speed, "mih") => "mph",
        (Quantity::Speed, "kt" | "kts" | "kns" | "knot" | "knots") => "kn",
        (Quantity::Acceleration, "mss") => "ms2",
        (Quantity::Acceleration, "gs") => "g",
        (Quantity::Acceleration, "gal") => "cms2",
        (Quantity::AngularVelocity, "dps" | "degs1") => "degs",
        (Quantity::AngularVelocity, "rads1" | "1s" | "s1") => "rads",
        (Quantity::Force, "newton" | "newtons") => "n",
        (Quantity::Force, "lb" | "lbs") => "lbf",
        (Quantity::Force, "kips") => "kip",
        (Quantity::Force, "kp") => "kgf",
        (Quantity::Mass, "lbs") => "lb",
        (Quantity::Moment, "inlb" | "inlbs" | "lbin" | "lbsin" | "inlbf") => "lbfin",
        (Quantity::Moment, "ftlb" | "ftlbs" | "lbft" | "lbsft" | "ftlbf") => "lbfft",
        (_, key) => key,
    };
    let find = |quantity| {
        let mut units = UNITS.iter().filter(|(measured, ..)| *measured == quantity);
        units.find(|(_, spelling, _)| !key.is_empty() && spelling == key).map(|(.., unit)| *unit)
    };
    // A column of a force may hold what it has summed up to.
    let integral = || (quantity == Quantity::Force).then(|| find(Quantity::Impulse)).flatten();
    find(quantity).or_else(integral)
}

/// All units with their keys.
static UNITS: LazyLock<Vec<(Quantity, String, Unit)>> = LazyLock::new(|| {
    let units = |quantity: Quantity| {
        quantity.units().iter().map(move |unit| (quantity, unit_key(unit.symbol), *unit))
    };
    Quantity::ALL.iter().copied().flat_map(units).collect()
});

/// The unit at the end of a header whose name need not be that of a channel, such as `Kraft X
/// [kN]`; `None` if the header has no unit.
///
/// The error is the text of a unit in brackets that does not measure `quantity`.
pub(crate) fn trailing_unit(header: &str, quantity: Quantity) -> Result<Option<Unit>, String> {
    let bare = without_side(header).map(|(bare, _)| bare);
    let header = bare.as_deref().unwrap_or(header);
    let mut wrong = None;
    for (at, _) in header.match_indices(|c: char| !c.is_alphanumeric()) {
        let (_, rest) = header.split_at(at);
        let Some(text) = unit_text(rest) else {
            continue;
        };
        if let Some(unit) = unit(quantity, text) {
            return match with_factor(header, at) {
                Some(text) => Err(text.to_owned()),
                None => Ok(Some(unit)),
            };
        }
        if is_bracketed(rest) && is_unit(text) {
            wrong = Some(text.to_owned());
        }
    }
    wrong.map_or(Ok(None), Err)
}

/// The text of brackets in which a number stands before the unit that begins at a place, such as `[1000 N]`: numbers are
/// in a multiple of it. `None` for any other place.
fn with_factor(header: &str, at: usize) -> Option<&str> {
    let (before, rest) = header.split_at(at);
    let open = before.rfind(OPENING)?;
    let is_multiplied =
        rest.starts_with([' ', '*', '·', '×']) && before.ends_with(char::is_numeric);
    let is_inside = !before.get(open..)?.contains(CLOSING);
    (is_multiplied && is_inside).then(|| unit_text(header.get(open..)?)).flatten()
}

/// Whether two headers are equal apart from case, blanks, punctuation and a unit in brackets.
pub(crate) fn same_name(left: &str, right: &str) -> bool {
    let bare = |name: &str| letters_and_digits(name.split(OPENING).next().unwrap_or(name));
    letters_and_digits(left) == letters_and_digits(right)
        || (!bare(left).is_empty() && bare(left) == bare(right))
}

/// Whether a line is a row of units, which some programs write beneath the header: each of its
/// cells that is not blank is a unit or in brackets, and there is at least one. Of one that names no
/// channel, a third of these cells may be units that are not known.
pub(crate) fn is_unit_row<'a>(cells: impl Iterator<Item = &'a str>) -> bool {
    let (mut n_units, mut n_others, mut has_names) = (0, 0, false);
    for (cell, text) in cells.filter_map(|cell| Some((cell, unit_text(cell)?))) {
        match is_bracketed(cell) || is_unit(text) {
            true => n_units += 1,
            false => {
                n_others += 1;
                has_names |= meaning(cell) != Meaning::Unknown;
            }
        }
    }
    n_units > 0 && !has_names && n_units >= 2 * n_others
}

/// Whether a cell of a row of units has one that is known.
pub(crate) fn is_known_unit(cell: &str) -> bool {
    unit_text(cell).is_some_and(is_unit)
}

/// The text of the unit in the end of a header or in a cell of a row of units, without brackets and
/// separators; `None` if nothing is left.
pub(crate) fn unit_text(rest: &str) -> Option<&str> {
    let outside = |c: char| c.is_whitespace() || "_,:;/[](){}<>-".contains(c);
    let text = rest.trim_matches(outside);
    let text = text.strip_prefix("in ").unwrap_or(text).trim();
    (!text.is_empty()).then_some(text)
}

/// The name of a quantity in messages.
pub(crate) fn quantity_name(quantity: Quantity) -> String {
    <&str>::from(quantity).replace('_', " ")
}

/// The symbols of all units of a quantity, for a message.
pub(crate) fn symbols(quantity: Quantity) -> String {
    let symbols: Vec<_> = quantity.units().iter().map(|unit| unit.symbol).collect();
    symbols.join(", ")
}

fn is_bracketed(text: &str) -> bool {
    let text = text.trim();
    text.starts_with(OPENING) && text.ends_with(CLOSING)
}

fn is_unit(text: &str) -> bool {
    Quantity::ALL.iter().any(|quantity| unit(*quantity, text).is_some())
}

pub(crate) fn letters_and_digits(text: &str) -> String {
    let letters = text.chars().filter(|c| c.is_alphanumeric());
    letters.flat_map(char::to_lowercase).collect()
}

/// Whether letters and digits of a header name a change of velocity.
pub(crate) fn is_delta_v(key: &str) -> bool {
    let words =
        ["deltav", "δv", "velocitychange", "geschwindigkeitsänderung", "geschwindigkeitsaenderung"];
    words.iter().any(|word| key.contains(word))
}

/// Reduces a unit to one spelling, so that `m/s²`, `m/s^2`, `m_s2` and `m/sec2` are equal, and so
/// are `deg/s`, `°/s` and `degrees per second`.
fn unit_key(text: &str) -> String {
    let text = text.to_lowercase();
    let text = text
        .replace('²', "2")
        .replace('°', "deg")
        .replace(['µ', 'μ'], "u")
        .replace("degrees", "deg")
        .replace("degree", "deg")
        .replace("radians", "rad")
        .replace(" per ", "")
        .replace("seconds", "s")
        .replace("second", "s")
        .replace("sec", "s");
    text.chars().filter(|c| c.is_alphanumeric() || *c == '%').collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_spellings_are_understood() {
        for (header, channel, symbol) in [
            ("Fx [kN]", Channel::Fx, "kN"),
            ("time(ms)", Channel::Time, "ms"),
            ("Time", Channel::Time, ""),
            ("FX_N", Channel::Fx, "N"),
            ("fx_kn", Channel::Fx, "kN"),
            ("Fx in kN", Channel::Fx, "kN"),
            ("Fx / kN", Channel::Fx, "kN"),
            ("yaw_rate_deg_s", Channel::YawRate, "deg/s"),
            ("Yaw rate [°/s]", Channel::YawRate, "deg/s"),
            ("Yaw rate [degrees per second]", Channel::YawRate, "deg/s"),
            ("vx_km_h", Channel::Vx, "km/h"),
            ("v_x [kph]", Channel::Vx, "km/h"),
            ("v_x (m/sec)", Channel::Vx, "m/s"),
            ("t,ms", Channel::Time, "ms"),
            ("t [msec]", Channel::Time, "ms"),
            ("Zeit [s]", Channel::Time, "s"),
            ("time (seconds)", Channel::Time, "s"),
            ("ax_m_s2", Channel::Ax, "m/s²"),
            ("ax (m/s^2)", Channel::Ax, "m/s²"),
            ("a_y [g]", Channel::Ay, "g"),
            ("x [m]", Channel::X, "m"),
            ("X-Position (ft)", Channel::X, "ft"),
            ("Fy (body) [lbs]", Channel::FyBody, "lbf"),
            ("Mz [N-m]", Channel::Mz, "N m"),
            ("Mz (N*m)", Channel::Mz, "N m"),
            ("Kraft X [kN]", Channel::Fx, "kN"),
            ("Fx [-]", Channel::Fx, ""),
            ("Fx [MN]", Channel::Fx, "MN"),
            ("x (')", Channel::X, "ft"),
            ("y [\"]", Channel::Y, "in"),
            ("Gierwinkel [Grad]", Channel::Yaw, "deg"),
            ("Gierrate [Grad/s]", Channel::YawRate, "deg/s"),
            ("Fx [daN]", Channel::Fx, "daN"),
            ("Fx [kgf]", Channel::Fx, "kgf"),
            ("Mz (in-lb)", Channel::Mz, "lbf in"),
            ("Mz [kip-ft]", Channel::Mz, "kip ft"),
            ("Fx [tf]", Channel::Fx, "tf"),
            ("Fx (US tonf)", Channel::Fx, "US tonf"),
            ("x [yds]", Channel::X, "yd"),
            ("vx_cm_s", Channel::Vx, "cm/s"),
            ("vx [in/sec]", Channel::Vx, "in/s"),
            ("speed [yd/s]", Channel::Speed, "yd/s"),
            ("ax [mg]", Channel::Ax, "mg"),
            ("yaw [gon]", Channel::Yaw, "gon"),
            ("yaw rate [mrad/s]", Channel::YawRate, "mrad/s"),
            ("time [h]", Channel::Time, "h"),
            ("speed [kn]", Channel::Speed, "kn"),
            ("Speed (Knots)", Channel::Speed, "kn"),
            ("vx_kts", Channel::Vx, "kn"),
            ("Fx [kn]", Channel::Fx, "kN"),
            ("xg", Channel::X, ""),
            ("x_g [m]", Channel::X, "m"),
        ] {
            let unit = unit(channel.quantity(), symbol);
            assert_eq!(meaning(header), Meaning::Channel(channel, unit), "{header}");
        }
    }

    #[test]
    fn wrong_units_are_told_from_other_columns() {
        for (header, channel, unit) in [
            ("Fx [m]", Channel::Fx, "m"),
            ("Fx [mN]", Channel::Fx, "mN"),
            ("Fx [mn]", Channel::Fx, "mn"),
            ("Mz [mNm]", Channel::Mz, "mNm"),
            ("fx_kg", Channel::Fx, "kg"),
            ("Fx [tonf]", Channel::Fx, "tonf"),
            ("speed [kN]", Channel::Speed, "kN"),
            ("Fx [kts]", Channel::Fx, "kts"),
            ("yaw [grad]", Channel::Yaw, "grad"),
            ("time [furlong]", Channel::Time, "furlong"),
            ("steering_wheel [%]", Channel::SteeringWheel, "%"),
            ("Fx (%)", Channel::Fx, "%"),
            ("X (g)", Channel::X, "g"),
            ("Y [g]", Channel::Y, "g"),
            ("x_g", Channel::X, "g"),
        ] {
            let expected = Meaning::WrongUnit(channel, unit.to_owned());
            assert_eq!(meaning(header), expected, "{header}");
        }
        for header in ["case", "v", "p_kpa", "wheel slip", "", "°", "x1", "x_std", "ratio [-]"] {
            assert_eq!(meaning(header), Meaning::Unknown, "{header}");
        }
    }

    #[test]
    fn a_multiple_of_a_unit_is_none_that_is_known() {
        let kilonewton = unit(Quantity::Force, "kN");
        for (header, expected) in [
            ("Kraft längs [1000 N]", Err("1000 N")),
            ("Load cell (10 kN)", Err("10 kN")),
            ("Load cell [10^3 N]", Err("10^3 N")),
            ("Load cell [kN]", Ok(kilonewton)),
            ("Load cell (no. 2, kN)", Ok(kilonewton)),
            ("Load cell (2) kN", Ok(kilonewton)),
            ("Load cell 2 [kN]", Ok(kilonewton)),
            ("Load cell 2", Ok(None)),
        ] {
            let expected = expected.map_err(str::to_owned);
            assert_eq!(trailing_unit(header, Quantity::Force), expected, "{header}");
        }
    }

    #[test]
    fn words_suggest_a_channel() {
        for (header, channel) in [
            ("Kraft [kN]", Some(Channel::Fx)),
            ("Kraft quer [kN]", Some(Channel::Fy)),
            ("Kraft_Y", Some(Channel::Fy)),
            ("Velocity [m/s]", Some(Channel::Vx)),
            ("Messzeit", Some(Channel::Time)),
            ("Weg (m)", Some(Channel::X)),
            ("Geschwindigkeit", Some(Channel::Vx)),
            ("Gierrate gefiltert", Some(Channel::YawRate)),
            ("Temperatur", None),
        ] {
            assert_eq!(suggestion(header), channel, "{header}");
        }
    }

    #[test]
    fn our_own_headers_are_read_back() {
        for &channel in Channel::ALL {
            let si = channel.quantity().si_unit();
            assert_eq!(meaning(channel.header()), Meaning::Channel(channel, Some(si)));
            assert_eq!(super::channel(channel.short_name()), Some(channel));
        }
    }

    #[test]
    fn a_row_of_units_has_nothing_else() {
        let is_row = |text: &str| is_unit_row(text.split(';'));
        assert!(is_row("s;kN;kN") && is_row("[s];[kN];[?]") && is_row("s;;-;N"));
        assert!(!is_row("time;kN") && !is_row(";;") && !is_row("1;2"));
        assert!(is_row("s;m;m;mils") && !is_row("s;m;mils;cubits") && !is_row("s;m;m;yaw"));
    }
}
