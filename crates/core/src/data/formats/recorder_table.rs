//! What the columns of one table of an event data recorder hold, known by their names.

use crate::data::formats::recorder::{
    LONGEST_S, RecordedControls, RecordedDeltaV, RecordedSide, RecordedSpeed, RecorderRecord,
    SETTLED_S,
};
use crate::data::formats::recorder_columns::{NO_RECORD, Table563, has, is_of_road_wheels};
use crate::data::spelling::is_delta_v;
use crate::ranges::{ANGULAR_VELOCITY_SAMPLE, INSTANT, Range, SPEED, STEERING_WHEEL_ANGLE};
use crate::units::{KILOMETRE_PER_HOUR_M_S, MILE_PER_HOUR_M_S, Quantity};

/// Change over this time from which the record is cut off, m/s.
const CUT_M_S: f64 = 0.3;

/// Rate at which a change of velocity grows in no crash of a car, m/s²: 100 g. That of barrier tests at 56 km/h is
/// 30 to 60 g.
const JUMP_M_S2: f64 = 981.0;

/// Change of velocity from which a record that ends in zeros was filled up with them, m/s.
const FILLED_UP_M_S: f64 = 2.0;

/// Largest change of velocity that a record begins with when the recorder wakes up, m/s.
const FIRST_M_S: f64 = 2.0;

/// How much of its largest value a record of one impact holds at its end, and from which largest value on that tells,
/// m/s: the changes from one sample to the next are smaller than the whole change.
const HELD_SHARE: f64 = 0.5;
const TELLING_M_S: f64 = 0.8;

/// Rate at which a car that drives on its tires changes its speed at most, m/s²: that of dry friction and some.
const TIRES_M_S2: f64 = 12.0;

/// Speeds at which recorders stop, or that stand for no value, m/s: 126 and 127 mph, 254 and 255 km/h. What is read there
/// may be any speed from it on.
const LIMITS_M_S: [f64; 4] = [
    126.0 * MILE_PER_HOUR_M_S,
    127.0 * MILE_PER_HOUR_M_S,
    254.0 * KILOMETRE_PER_HOUR_M_S,
    255.0 * KILOMETRE_PER_HOUR_M_S,
];
/// By how much such a number may be off for its rounding in another unit, m/s.
const AT_LIMIT_M_S: f64 = 0.02;

/// Times that several rows before a crash cover at least and at most, s: recorders keep one to ten a second, for 5
/// to 20 s.
const COVERED_S: [f64; 2] = [0.1, 60.0];

/// Angle of the steering wheel up to which 49 CFR 563 and UN R160 ask a recorder to count, rad: 250 deg.
const STEERING_END_RAD: f64 = 250.0 * std::f64::consts::PI / 180.0;

/// What is said of times before a crash that go back.
const OTHER_EVENT: &str = "the times before the crash do not increase, and none is taken: a table has one event; put \
                           each event into a file of its own";

/// Rounding of a recorded speed, m/s: 1 mph and its halves.
pub(super) const ROUNDING_M_S: f64 = 0.6;

impl RecorderRecord {
    /// Adds what the columns of a table hold.
    pub(super) fn add_table(&mut self, table: &Table563<'_>, has_controls: bool) {
        let mut doubts = Vec::new();
        let Some(time_s) = table.instants_s(&mut doubts) else {
            self.doubts.extend(doubts);
            return;
        };
        for (words, slot, name) in [
            ("longitudinal", &mut self.delta_v_ahead, "ahead"),
            ("lateral", &mut self.delta_v_right, "to the right"),
        ] {
            let is_wanted =
                |key: &str| is_delta_v(key) && key.contains(words) && !has(key, &NO_RECORD);
            let usual = (words == "lateral").then_some(RecordedSide::Right);
            let found = table.sided(Quantity::Speed, usual, &mut doubts, is_wanted);
            let Some((values, side)) = found else { continue };
            doubts.extend(table.other_ends(&time_s, is_wanted, name));
            let pairs = delta_v_pairs(&time_s, &values);
            doubts.extend(table.other_largest(&pairs, words, name));
            if let Some(why) = no_delta_v(&pairs) {
                doubts.push(format!("the change of velocity {name} {why}; it is left out"));
                continue;
            }
            let Some(recorded) = recorded_delta_v(&pairs) else { continue };
            if slot.is_some() {
                doubts.push(format!(
                    "the change of velocity {name} is recorded twice for the event; the first one is read"
                ));
                continue;
            }
            doubts.extend(falls_back(&pairs, name));
            if recorded.is_cut {
                doubts.push(format!(
                    "the change of velocity {name} still changes at the end of its record: the pulse is cut \
                     off there"
                ));
            }
            *slot = Some(recorded);
            self.sides.lateral = self.sides.lateral.or(side);
        }
        doubts.extend(table.unread_delta_v());
        match has_controls {
            true if self.before.time_s.is_empty() => {
                self.add_controls(table, &time_s, &mut doubts);
            }
            true => doubts.push(
                "another table of the seconds before the crash is not read; open it as a table"
                    .to_owned(),
            ),
            false => {}
        }
        self.doubts.extend(doubts);
    }

    fn add_controls(
        &mut self,
        table: &Table563<'_>,
        time_s: &[Option<f64>],
        doubts: &mut Vec<String>,
    ) {
        let speed = table.column(Quantity::Speed, doubts, is_speed);
        if speed.is_none() {
            doubts.extend(table.other_speeds());
        }
        let speed = speed.unwrap_or_default();
        let is_steering = |key: &str| key.contains("steering") && !is_of_road_wheels(key);
        let usual = Some(RecordedSide::Left);
        let steering = table.sided(Quantity::Angle, usual, doubts, is_steering);
        let (steering, steering_side) = steering.unzip();
        doubts.extend(table.unread_steering());
        let is_yaw_rate = |key: &str| key.contains("yawrate") && !has(key, &["desired", "target"]);
        let usual = Some(RecordedSide::Right);
        let yaw_rate = table.sided(Quantity::AngularVelocity, usual, doubts, is_yaw_rate);
        let (yaw_rate, yaw_rate_side) = yaw_rate.unzip();
        if speed.is_empty() && (steering.is_some() || yaw_rate.is_some()) {
            doubts.push(
                "a table with the steering or the yaw rate has no speed of the car; it is not read"
                    .to_owned(),
            );
        }
        let rows = rows_before(time_s, &speed, doubts);
        let all = |values: &[Option<f64>], range: Range| {
            let of = |row: &usize| {
                values.get(*row).copied().flatten().filter(|value| range.contains(*value))
            };
            rows.iter().map(of).collect::<Option<Vec<f64>>>()
        };
        let Some(speed_m_s) = all(&speed, SPEED) else {
            doubts
                .push("a speed before the crash is beyond that of a car; none is taken".to_owned());
            return;
        };
        // The crash may stand there at −0 s.
        let in_time = |row: &usize| time_s.get(*row).copied().flatten().map(|at_s| at_s + 0.0);
        let time_s: Vec<f64> = rows.iter().filter_map(in_time).collect();
        if time_s.windows(2).any(|pair| pair.first() >= pair.last()) {
            doubts.push(OTHER_EVENT.to_owned());
            return;
        }
        doubts.extend(wrong_span(&time_s));
        match beyond_tires(&time_s, &speed_m_s).or_else(|| at_limit(&time_s, &speed_m_s)) {
            Some(why) => doubts.push(why),
            None => {
                let last = time_s.last().copied().zip(speed_m_s.last().copied());
                self.speed_before = last.map(|(at_s, speed_m_s)| RecordedSpeed { speed_m_s, at_s });
            }
        }
        let of = |values: Option<Vec<Option<f64>>>, range, name: &str, doubts: &mut Vec<String>| {
            let values = values?;
            let found = all(&values, range);
            if found.is_none() {
                doubts.push(format!("the {name} is not recorded throughout; it is left out"));
            }
            found
        };
        let steering = of(steering, STEERING_WHEEL_ANGLE, "angle of the steering wheel", doubts);
        let yaw_rate = of(yaw_rate, ANGULAR_VELOCITY_SAMPLE, "yaw rate", doubts);
        let braked = table.switch(&rows, is_brake, "service brake", doubts);
        let anti_lock = table.switch(&rows, is_anti_lock, "anti-lock system", doubts);
        doubts.extend(steering.as_deref().and_then(steered_to_the_end));
        self.sides.steering = steering_side.flatten();
        self.sides.yaw_rate = yaw_rate_side.flatten();
        self.before = RecordedControls {
            time_s,
            speed_m_s,
            steering_wheel_rad: steering.unwrap_or_default(),
            yaw_rate_right_rad_s: yaw_rate.unwrap_or_default(),
            is_braked: braked.unwrap_or_default(),
            is_anti_lock_active: anti_lock.unwrap_or_default(),
        };
    }
}

/// Whether a column has the speed of the car, and not that of a wheel, of the engine, of another car or of a driver's
/// wish, or the part to its side.
fn is_speed(key: &str) -> bool {
    let others = [
        "deltav", "change", "engine", "motor", "cruise", "setspeed", "acc", "limit", "relative",
        "target", "lead", "gps", "lateral",
    ];
    let is_of_wheel = key.contains("wheel") && !key.contains("vehicle");
    key.contains("speed") && !is_of_wheel && !has(key, &others)
}

/// Whether a column says if the driver brakes, and not a system for him.
fn is_brake(key: &str) -> bool {
    let others = [
        "abs",
        "pressure",
        "park",
        "hand",
        "warning",
        "lamp",
        "pedalposition",
        "force",
        "torque",
        "assist",
        "emergency",
    ];
    key.contains("brake") && !has(key, &others)
}

/// Whether a column says if the anti-lock system is at work.
fn is_anti_lock(key: &str) -> bool {
    let is_its = key.starts_with("abs") || key.contains("antilock");
    is_its && !has(key, &["lamp", "warning", "indicator", "fault"])
}

/// The rows before the crash that have a speed, in the order of time.
fn rows_before(
    time_s: &[Option<f64>],
    speed: &[Option<f64>],
    doubts: &mut Vec<String>,
) -> Vec<usize> {
    let at_s = |row: &usize| time_s.get(*row).copied().flatten();
    let has_speed = |row: &usize| speed.get(*row).is_some_and(Option::is_some);
    let is_before =
        |row: &usize| at_s(row).is_some_and(|at_s| at_s <= 0.0 && INSTANT.contains(at_s));
    let is_after = |row: &usize| at_s(row).is_some_and(|at_s| at_s > 0.0);
    let n_after = (0..time_s.len()).filter(has_speed).filter(is_after).count();
    let falls_over = |rows: &[usize]| falls(&rows.iter().filter_map(at_s).collect::<Vec<_>>());
    let with_speed: Vec<usize> = (0..time_s.len()).filter(has_speed).collect();
    if n_after > 0 {
        let mend = match falls_over(&with_speed) {
            true => {
                "if they count the seconds before the crash, call their column \"Time before crash [s]\" or write them \
                 negative"
            }
            false => "if it is not, shift the times",
        };
        doubts.push(format!(
            "rows after 0 s that have a speed: {n_after}; they are not read, since 0 s is taken as the crash: {mend}"
        ));
    }
    let before: Vec<usize> = (0..time_s.len()).filter(is_before).collect();
    let mut rows: Vec<usize> = before.iter().copied().filter(has_speed).collect();
    if let (Some(first), Some(last)) = (rows.first(), rows.last()) {
        let n_between = before.iter().filter(|row| (first..=last).contains(row)).count();
        let n_missing = n_between - rows.len();
        if n_missing > 0 {
            doubts.push(format!(
                "rows before the crash that have no speed, between others that have one: {n_missing}; they \
                 are left out"
            ));
        }
    }
    // From the crash back, as some tools write them.
    if falls_over(&rows) {
        rows.reverse();
    }
    rows
}

/// Whether instants go back from each to the next. Two may be of two events.
pub(super) fn falls(time_s: &[f64]) -> bool {
    time_s.len() > 2 && time_s.windows(2).all(|pair| pair[1] < pair[0])
}

/// That rows before a crash follow each other faster than any recorder keeps them, or for longer.
fn wrong_span(time_s: &[f64]) -> Option<String> {
    let covered_s = time_s.last()? - time_s.first()?;
    let [shortest_s, longest_s] = COVERED_S;
    (covered_s > 0.0 && !(shortest_s..=longest_s).contains(&covered_s)).then(|| {
        format!(
            "the {} rows before the crash cover {covered_s:.3} s in all: check the unit of their times",
            time_s.len()
        )
    })
}

/// Times and changes of velocity of a record after the recorder has woken up.
pub(super) fn delta_v_pairs(time_s: &[Option<f64>], values: &[Option<f64>]) -> Vec<(f64, f64)> {
    let pairs = time_s.iter().zip(values).filter_map(|(at_s, value)| at_s.zip(*value));
    let is_in_range = |(at_s, value): &(f64, f64)| *at_s >= 0.0 && SPEED.contains(*value);
    pairs.filter(is_in_range).collect()
}

/// Why a record of the change of velocity is that of no crash, in words: its times are not those of one, it does
/// not begin with the impact, or it was filled up with zeros or a number that stands for none.
pub(super) fn no_delta_v(pairs: &[(f64, f64)]) -> Option<String> {
    let (first_s, first) = *pairs.first()?;
    let (at_s, largest) = largest_of(pairs)?;
    let (end_s, last) = *pairs.last()?;
    let mut steps = pairs.iter().zip(pairs.iter().skip(1));
    if let Some(((t0, _), (t1, _))) = steps.find(|((t0, _), (t1, _))| t1 < t0) {
        return Some(format!(
            "goes back from {t0} to {t1} s: a table has one event, with times that increase; put each event into a file \
             of its own"
        ));
    }
    if end_s >= LONGEST_S {
        return Some(format!(
            "goes on up to {end_s} s, longer than any recorder keeps it: check the unit of the times"
        ));
    }
    if first.abs() > FIRST_M_S + JUMP_M_S2 * first_s {
        return Some(format!(
            "is {first:.2} m/s at {first_s} s already, so that it does not begin with the impact"
        ));
    }
    if last == 0.0 && largest.abs() > FILLED_UP_M_S {
        return Some(format!(
            "is {largest:.2} m/s at {at_s} s and zero at its end, {end_s} s: remove the rows that fill it up"
        ));
    }
    let steps = pairs.iter().zip(pairs.iter().skip(1));
    let mut jumps = steps.filter(|((t0, v0), (t1, v1))| {
        (v1 - v0).abs() > ROUNDING_M_S + JUMP_M_S2 * (t1 - t0).abs()
    });
    let ((t0, v0), (t1, v1)) = jumps.next()?;
    Some(format!(
        "goes from {v0:.2} to {v1:.2} m/s between {t0} and {t1} s, as in no crash: remove the rows that have no value"
    ))
}

/// The value of a record that is largest in size, with its instant.
pub(super) fn largest_of(pairs: &[(f64, f64)]) -> Option<(f64, f64)> {
    pairs.iter().copied().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}

/// That most of a change of velocity is gone at the end of its record, as after a second impact, or where the rows are
/// the changes from one sample to the next.
fn falls_back(pairs: &[(f64, f64)], name: &str) -> Option<String> {
    let ((at_s, largest), (end_s, last)) = (largest_of(pairs)?, *pairs.last()?);
    (largest.abs() > TELLING_M_S && last.abs() < HELD_SHARE * largest.abs()).then(|| {
        format!(
            "the change of velocity {name} is {largest:.2} m/s at {at_s} s and {last:.2} m/s at its end, {end_s} s, \
             which is read: if it is of more than one impact, cut the record off after the first; if its rows are the changes \
             from one sample to the next, add them up"
        )
    })
}

/// Why the speed before a crash is not that of the car, in words: it changes by more than tires can make it.
fn beyond_tires(time_s: &[f64], speed_m_s: &[f64]) -> Option<String> {
    let rows: Vec<(f64, f64)> = time_s.iter().copied().zip(speed_m_s.iter().copied()).collect();
    let steps = rows.iter().zip(rows.iter().skip(1));
    let mut beyond = steps
        .filter(|((t0, v0), (t1, v1))| (v1 - v0).abs() > ROUNDING_M_S + TIRES_M_S2 * (t1 - t0));
    let ((t0, v0), (t1, v1)) = beyond.next()?;
    Some(format!(
        "the speed goes from {v0:.2} to {v1:.2} m/s between {t0} and {t1} s, which is more than tires can do: wheels \
         that were locked or spun, or a number that stands for none; no speed before the crash is taken"
    ))
}

/// That a steering wheel is at its largest angle where recorders may stop counting.
fn steered_to_the_end(angles_rad: &[f64]) -> Option<String> {
    let largest_rad = angles_rad.iter().fold(0.0, |of: f64, angle| of.max(angle.abs()));
    ((largest_rad / STEERING_END_RAD - 1.0).abs() < 1e-6).then(|| {
        "the steering wheel is turned to 250 deg, where recorders may stop counting: it may have been turned further"
            .to_owned()
    })
}

/// Why the last speed before a crash may be any higher one, in words: it is the limit of a recorder.
fn at_limit(time_s: &[f64], speed_m_s: &[f64]) -> Option<String> {
    let (at_s, last) = (time_s.last()?, speed_m_s.last()?);
    LIMITS_M_S.iter().any(|limit| (last - limit).abs() < AT_LIMIT_M_S).then(|| {
        format!(
            "the speed at {at_s} s is {:.0} km/h ({:.0} mph), where recorders stop counting or have no value: the car may \
             have been faster; no speed before the crash is taken",
            last / KILOMETRE_PER_HOUR_M_S,
            last / MILE_PER_HOUR_M_S
        )
    })
}

/// The last change of velocity of a record; `None` of one that ends where it begins, at 0 s.
pub(super) fn recorded_delta_v(pairs: &[(f64, f64)]) -> Option<RecordedDeltaV> {
    let (ends_s, delta_v_m_s) = *pairs.last().filter(|(ends_s, _)| *ends_s > 0.0)?;
    let earlier = pairs.iter().rev().find(|(at_s, _)| ends_s - at_s >= SETTLED_S - 1e-9);
    // Before the recorder woke up nothing had changed.
    let at_wake_up = (ends_s < SETTLED_S).then_some(0.0);
    let earlier = earlier.map(|(_, value)| *value).or(at_wake_up);
    let is_cut = earlier.is_some_and(|value| (delta_v_m_s - value).abs() > CUT_M_S);
    Some(RecordedDeltaV { delta_v_m_s, ends_s: Some(ends_s), is_cut })
}
