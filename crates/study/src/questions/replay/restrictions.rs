//! What restricts a replay, and what it rests on.

use crate::questions::replay::record::Record;
use crate::questions::replay::unknowns::{FULL_BRAKING, SPEED_ROUNDING_M_S};
use crate::questions::replay::yaw_rate::YawRateCheck;
use crate::{FlagReport, ReplayReport, ReplayRequest, ReplaySample};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::{Phrase, PhraseValue, Quantity, STANDARD_GRAVITY_M_S2};
use impactlab_core::vehicle::{MotionFlag, RecordedMotion, RoadDraws, VehicleParameters};

/// Shortest time over which a recorded speed tells an acceleration, s.
const SHORTEST_CHANGE_S: f64 = 0.45;

/// Share of μ g by braking from which the slip of the wheels counts.
const HARD_BRAKING: f64 = 0.5;

/// Share of μ g from which a driven wheel spins: one of two axles carries it.
const HARD_DRIVING: f64 = 0.6;

/// Difference of computed and recorded speed beyond which the record is not followed, m/s.
const LARGEST_SPEED_DIFFERENCE_M_S: f64 = 1.0;

/// Share of the friction from which the path rests on what the tires do at their limit.
const FRICTION_LIMIT: f64 = 0.9;

/// The motion of the recorded numbers as they are.
pub(super) struct CentralMotion {
    /// When the first sample was taken, s before the first contact, negative.
    pub start_s: f64,
    pub motion: RecordedMotion,
    /// What is flagged in it, on the clock of the crash.
    pub flags: Vec<MotionFlag>,
}

impl ReplayRequest {
    /// What nobody has said.
    ///
    /// - `road`: how the friction is drawn beside the data sheet.
    pub(super) fn assumed(
        &self,
        road: Option<&RoadDraws>,
        vehicle: &VehicleParameters,
    ) -> Vec<Caveat> {
        let known = self.known();
        let number = |value| PhraseValue::three_digits(Quantity::Ratio, value);
        let ratio = Phrase::new("steering ratio {0} ± {1}", "Lenkübersetzung {0} ± {1}")
            .with(number(known.steering_ratio))
            .with(number(known.steering_ratio_sigma));
        let reason = Phrase::new(
            "cars have 12 to 20; another one: --steering-ratio",
            "Pkw haben 12 bis 20; eine andere: --steering-ratio",
        );
        let is_assumed = self.steering_ratio.is_none();
        let ratio = is_assumed.then(|| Caveat::assumed(CaveatSubject::Steer, ratio, reason));
        let speed = Phrase::new(
            "standard deviation of the recorded speed: {0}",
            "Standardabweichung der aufgezeichneten Geschwindigkeit: {0}",
        )
        .with(PhraseValue::Share(known.speed_sigma));
        let reason = Phrase::new(
            "as in the evidence of a reconstruction; 49 CFR 563 asks for 1 km/h of the sensor, not of the tires; \
             another one: --speed-sigma",
            "wie bei den Spuren einer Rekonstruktion; 49 CFR 563 verlangt 1 km/h vom Sensor, nicht von den \
             Reifen; eine andere: --speed-sigma",
        );
        let is_assumed = self.speed_sigma.is_none();
        let speed = is_assumed.then(|| Caveat::assumed(CaveatSubject::Speed, speed, reason));
        let is_assumed = self.friction.is_none() || self.friction_sigma.is_none();
        let friction = road.filter(|_| is_assumed).map(|road| {
            let value = Phrase::new("friction {0} ± {1}", "Reibbeiwert {0} ± {1}")
                .with(number(vehicle.tires.friction))
                .with(number(road.sigma));
            let reason = Phrase::new(
                "where it was not stated, that of the vehicle and 7.5 % of it; another one: --friction, \
                 --friction-sigma",
                "soweit nicht angegeben, der des Fahrzeugs und 7,5 % davon; ein anderer: --friction, \
                 --friction-sigma",
            );
            Caveat::assumed(CaveatSubject::RoadFriction, value, reason)
        });
        ratio.into_iter().chain(speed).chain(friction).collect()
    }
}

/// What restricts the answer.
pub(super) fn all(
    record: &Record,
    central: &CentralMotion,
    report: &ReplayReport,
    vehicle: &VehicleParameters,
) -> Vec<Caveat> {
    let limit_m_s2 = report.friction * STANDARD_GRAVITY_M_S2;
    let doubts = record.doubts.iter();
    let doubts = doubts.map(|doubt| Caveat::new(CaveatKind::DoubtfulData, doubt));
    let flags = central.flags.iter().map(|flag| FlagReport::from(flag).caveat);
    doubts
        .chain(wheel_speed(record, limit_m_s2))
        .chain(not_followed(report))
        .chain(lateral(record, report, limit_m_s2))
        .chain(disagreement(report.yaw_rate.as_ref()))
        .chain(flags)
        .chain([after_last_sample(record, report, limit_m_s2)])
        .chain(left_out(record, report))
        .chain(notes(report, vehicle))
        .collect()
}

/// A change of the recorded speed, m/s², with when it begins and ends, s.
#[derive(Clone, Copy)]
struct Change {
    from_s: f64,
    to_s: f64,
    acceleration_m_s2: f64,
    /// What rounding may make of it, m/s².
    rounding_m_s2: f64,
}

/// The changes of the recorded speed over times that are long enough to tell an acceleration.
fn changes(record: &Record) -> Vec<Change> {
    let samples = &record.samples;
    let time_s = &samples.time_s;
    let change = |(from, from_s): (usize, &f64)| {
        let to = time_s.iter().position(|to_s| to_s - from_s >= SHORTEST_CHANGE_S)?;
        let to_s = *time_s.get(to)?;
        let speed = |idx: usize| samples.speed_m_s.get(idx).copied();
        let duration_s = to_s - from_s;
        Some(Change {
            from_s: *from_s,
            to_s,
            acceleration_m_s2: (speed(to)? - speed(from)?) / duration_s,
            rounding_m_s2: 2.0 * SPEED_ROUNDING_M_S / duration_s,
        })
    };
    time_s.iter().enumerate().filter_map(change).collect()
}

/// Where the speed of the wheels is not that over ground.
fn wheel_speed(record: &Record, limit_m_s2: f64) -> Vec<Caveat> {
    let changes = changes(record);
    let by = |a: &&Change, b: &&Change| a.acceleration_m_s2.total_cmp(&b.acceleration_m_s2);
    let slowest = changes.iter().min_by(by).copied();
    let fastest = changes.iter().max_by(by).copied();
    let beyond = |change: &Change, share: f64| {
        change.acceleration_m_s2.abs() > share * limit_m_s2 + change.rounding_m_s2
    };
    let braked = slowest.filter(|change| change.acceleration_m_s2 < 0.0);
    let locked = braked.filter(|change| beyond(change, 1.0)).map(|change| {
        let text = Phrase::new(
            "between {0} and {1} the recorded speed falls by {2}, and the road holds {3}: wheels locked or \
             slipped, so that it is not the speed over ground; the motion slows down by what the road holds, and \
             is then faster than recorded; locked wheels hold less, with which it would be faster still",
            "Zwischen {0} und {1} fällt die aufgezeichnete Geschwindigkeit mit {2}, die Straße hält {3}: Räder \
             haben blockiert oder gerutscht, sie ist also nicht die Geschwindigkeit über Grund; die Bewegung wird \
             so langsamer, wie die Straße hält, und ist dann schneller als aufgezeichnet; blockierte Räder halten \
             weniger, mit ihnen wäre sie noch schneller",
        );
        doubtful(text, &change, limit_m_s2)
    });
    let spun = fastest.filter(|change| change.acceleration_m_s2 > 0.0);
    let spun = spun.filter(|change| beyond(change, HARD_DRIVING)).map(|change| {
        let text = Phrase::new(
            "between {0} and {1} the recorded speed grows by {2}, and all wheels together hold {3}: driven wheels \
             spun, or the car was faster again after locked wheels; the speed over ground may be lower or higher",
            "Zwischen {0} und {1} wächst die aufgezeichnete Geschwindigkeit mit {2}, alle Räder zusammen halten \
             {3}: angetriebene Räder haben durchgedreht, oder Räder liefen nach einem Blockieren \
             wieder an; die Geschwindigkeit über Grund kann kleiner oder größer sein",
        );
        doubtful(text, &change, limit_m_s2)
    });
    let is_slipping = record.samples.is_anti_lock_active.contains(&true)
        || braked.is_some_and(|change| beyond(&change, HARD_BRAKING));
    let slipping = (is_slipping && locked.is_none()).then(|| {
        let text = Phrase::new(
            "the car was braked hard or its anti-lock system was at work: braked wheels slip, so that the recorded \
             speed is below that over ground, in tests under full braking by 8 to 18 %; the intervals are not \
             corrected for it: the car may have been faster than they say",
            "Das Fahrzeug wurde stark gebremst, oder sein ABS griff ein: gebremste Räder haben Schlupf, die \
             aufgezeichnete Geschwindigkeit liegt daher unter der über Grund, in Versuchen bei Vollbremsung um 8 \
             bis 18 %; die Bereiche sind nicht um diesen Schlupf berichtigt, das Fahrzeug kann schneller gewesen sein, als sie \
             angeben",
        );
        Caveat::new(CaveatKind::DoubtfulData, text)
    });
    locked.into_iter().chain(spun).chain(slipping).collect()
}

fn doubtful(text: Phrase, change: &Change, limit_m_s2: f64) -> Caveat {
    let time = |time_s| PhraseValue::fixed(Quantity::Time, time_s, 1);
    let acceleration = |value: f64| PhraseValue::fixed(Quantity::Acceleration, value.abs(), 1);
    let text = text
        .with(time(change.from_s))
        .with(time(change.to_s))
        .with(acceleration(change.acceleration_m_s2))
        .with(acceleration(limit_m_s2));
    Caveat::new(CaveatKind::DoubtfulData, text)
        .with_value("acceleration by the recorded speed [m/s²]", change.acceleration_m_s2)
        .with_range([-limit_m_s2, limit_m_s2])
}

/// A recorded speed that the motion does not have.
fn not_followed(report: &ReplayReport) -> Option<Caveat> {
    let off_m_s = |of: &ReplaySample| of.vx_body_m_s.median - of.recorded_speed_m_s;
    let by = |a: &&ReplaySample, b: &&ReplaySample| off_m_s(a).abs().total_cmp(&off_m_s(b).abs());
    let worst = report.samples.iter().max_by(by)?;
    let is_off = off_m_s(worst).abs() > LARGEST_SPEED_DIFFERENCE_M_S;
    let speed = |value| PhraseValue::fixed(Quantity::Speed, value, 1);
    let text = Phrase::new(
        "the motion does not keep the recorded speed: {0} before the recorder's time 0 it has {1} along the car, the \
         record {2}",
        "Die Bewegung hält die aufgezeichnete Geschwindigkeit nicht: {0} vor der Zeit 0 des Datenspeichers hat sie \
         {1} in Fahrzeuglängsrichtung, die Aufzeichnung {2}",
    )
    .with(PhraseValue::fixed(Quantity::Time, 0.0 - worst.recorder_time_s, 2))
    .with(speed(worst.vx_body_m_s.median))
    .with(speed(worst.recorded_speed_m_s));
    is_off.then(|| {
        Caveat::new(CaveatKind::DoubtfulData, text)
            .with_value("computed less recorded speed [m/s]", off_m_s(worst))
    })
}

/// A motion that asks for more than the road holds, by the record or as it is computed.
fn lateral(record: &Record, report: &ReplayReport, limit_m_s2: f64) -> Vec<Caveat> {
    let speeds = record.samples.speed_m_s.iter();
    let recorded_m_s2 = speeds
        .zip(&record.yaw_rate_rad_s)
        .map(|(speed_m_s, rate_rad_s)| (speed_m_s * rate_rad_s).abs())
        .fold(0.0, f64::max);
    let beyond = (recorded_m_s2 > limit_m_s2).then(|| {
        let acceleration = |value| PhraseValue::fixed(Quantity::Acceleration, value, 1);
        let text = Phrase::new(
            "recorded speed times recorded yaw rate is a lateral acceleration of {0}, and the road holds {1}: the \
             car spun or slid, or the friction is higher; a car that slides does not go where it steers",
            "Aufgezeichnete Geschwindigkeit mal aufgezeichnete Gierrate ist eine Querbeschleunigung von {0}, die \
             Straße hält {1}: das Fahrzeug drehte sich oder rutschte, oder der Reibbeiwert ist höher; ein \
             rutschendes Fahrzeug fährt nicht, wohin es lenkt",
        );
        let text = text.with(acceleration(recorded_m_s2)).with(acceleration(limit_m_s2));
        Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value("lateral acceleration by the record [m/s²]", recorded_m_s2)
            .with_range([0.0, limit_m_s2])
    });
    let [_, high] = report.friction_use.ninety();
    let limit = (high > FRICTION_LIMIT).then(|| {
        let text = Phrase::new(
            "the computed motion uses up to {0} of the friction (95 % of the draws use less): there the path rests \
             on friction and tires at their limit, where small errors become large",
            "Die berechnete Bewegung nutzt bis zu {0} der Reibung (95 % der Ziehungen weniger): dort hängt der Weg \
             an Reibung und Reifen an ihrer Grenze, wo aus kleinen Fehlern große werden",
        )
        .with(PhraseValue::Share(high));
        Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value("share of the friction that is used", high)
            .with_range([0.0, FRICTION_LIMIT])
    });
    beyond.into_iter().chain(limit).collect()
}

/// A recorded yaw rate that is not the computed one.
fn disagreement(check: Option<&YawRateCheck>) -> Option<Caveat> {
    let check = check.filter(|check| check.disagrees)?;
    let cause = match (check.is_opposite(), &check.implied_steering_ratio) {
        (true, _) => Phrase::new(
            "it is to the other side; say --yaw-rate left or --steering right if the record counts so",
            "sie geht zur anderen Seite; zu prüfen ist, zu welcher Seite die Aufzeichnung Gierrate und Lenkung \
             zählt",
        ),
        (false, Some(ratio)) => Phrase::new(
            "with a steering ratio of {0} they would be the same where tires are not near their limit, else the \
             car slid, or the recorded speed is not that over ground",
            "mit einer Lenkübersetzung von {0} wären sie gleich, wo die Reifen nicht nah an ihrer Grenze sind, \
             sonst rutschte das Fahrzeug, oder die aufgezeichnete Geschwindigkeit ist nicht die über Grund",
        )
        .with(PhraseValue::estimate(Quantity::Ratio, ratio)),
        (false, None) => Phrase::new(
            "the car slid, its speed over ground is not the recorded one, or steering or yaw rate are not those \
             of this motion",
            "das Fahrzeug rutschte, seine Geschwindigkeit über Grund ist nicht die aufgezeichnete, oder Lenkung oder \
             Gierrate gehören nicht zu dieser Bewegung",
        ),
    };
    let number = |value| PhraseValue::fixed(Quantity::Ratio, value, 1);
    let text = Phrase::new(
        "recorded and computed yaw rate differ by {0} standard deviations on the average (root mean square) and by \
         {1} at most: {2}",
        "Aufgezeichnete und berechnete Gierrate unterscheiden sich im Mittel um {0} Standardabweichungen \
         (quadratisch) und höchstens um {1}: {2}",
    )
    .with(number(check.deviations))
    .with(number(check.largest_deviations))
    .with(PhraseValue::phrase(cause));
    let caveat = Caveat::new(CaveatKind::Disagreement, text);
    Some(caveat.with_value("difference of the yaw rates in standard deviations", check.deviations))
}

/// What may have happened after the last sample.
fn after_last_sample(record: &Record, report: &ReplayReport, limit_m_s2: f64) -> Caveat {
    let gap_s = report.longest_gap_s;
    let gap = PhraseValue::fixed(Quantity::Time, gap_s, 2);
    let braking_m_s = FULL_BRAKING * limit_m_s2 * gap_s;
    let braking = PhraseValue::fixed(Quantity::Speed, braking_m_s, 1);
    let text = match record.ends_braked() {
        true => Phrase::new(
            "the contact is taken to be up to {0} after the last sample; braking over that time is drawn between \
             half of the recorded deceleration and a full braking, which takes up to {1}; steering that began \
             later is not in the interval",
            "Der Kontakt liegt bis zu {0} nach dem letzten Abtastwert; das Bremsen in dieser Zeit ist zwischen der \
             halben aufgezeichneten Verzögerung und einer Vollbremsung gezogen, die bis zu {1} nimmt; später \
             begonnenes Lenken ist nicht im Bereich",
        ),
        false => Phrase::new(
            "the contact is taken to be up to {0} after the last sample, at which the car was not braked: a full \
             braking or steering that began after it is not in the interval and would take up to {1}",
            "Der Kontakt liegt bis zu {0} nach dem letzten Abtastwert, bei dem das Fahrzeug nicht gebremst war: eine \
             danach begonnene Vollbremsung oder ein Lenken ist nicht im Bereich und nähme bis zu {1}",
        ),
    };
    Caveat::new(CaveatKind::DriverOpen, text.with(gap).with(braking))
}

fn left_out(record: &Record, report: &ReplayReport) -> Vec<Caveat> {
    let count = |n: usize| PhraseValue::Name(n.to_string());
    let earlier = (record.n_earlier > 0).then(|| {
        let text = Phrase::new(
            "{0} earlier samples are not followed",
            "{0} frühere Abtastwerte sind nicht berücksichtigt",
        );
        Caveat::new(CaveatKind::LeftOut, text.with(count(record.n_earlier)))
    });
    let failed = (report.draws_left_out > 0).then(|| {
        let text = Phrase::new(
            "{0} of {1} draws have a motion that cannot be computed",
            "{0} von {1} Ziehungen haben eine Bewegung, die nicht berechnet werden kann",
        );
        let text = text.with(count(report.draws_left_out)).with(count(report.draws));
        Caveat::new(CaveatKind::LeftOut, text)
    });
    earlier.into_iter().chain(failed).collect()
}

/// A yaw rate that goes with another steering ratio, where its difference alone is none that is out of the
/// usual.
fn other_ratio(report: &ReplayReport) -> Option<Caveat> {
    let check = report.yaw_rate.as_ref().filter(|check| !check.disagrees)?;
    let implied = check.implied_steering_ratio.as_ref()?;
    let [low, high] = implied.ninety();
    let text = Phrase::new(
        "the recorded yaw rate goes with a steering ratio of {0} rather than with {1}: look it up for this car",
        "Die aufgezeichnete Gierrate passt eher zu einer Lenkübersetzung von {0} als zu {1}: für dieses Fahrzeug \
         nachsehen",
    )
    .with(PhraseValue::estimate(Quantity::Ratio, implied))
    .with(PhraseValue::fixed(Quantity::Ratio, report.steering_ratio, 1));
    let is_other = !(low..=high).contains(&report.steering_ratio);
    is_other.then(|| Caveat::new(CaveatKind::Note, text))
}

fn notes(report: &ReplayReport, vehicle: &VehicleParameters) -> Vec<Caveat> {
    let note = |en: &str, de: &str| Caveat::new(CaveatKind::Note, Phrase::new(en, de));
    let untried = Caveat::new(
        CaveatKind::HardlyValidated,
        Phrase::new(
            "no replay of a recorder has been compared with a measured path yet: its scatter is that of rounding, \
             speed, steering ratio, friction and moment of the contact, as they are assumed",
            "Noch ist keine Nachrechnung eines Datenspeichers mit einem gemessenen Weg verglichen: ihre Streuung \
             ist die von Rundung, Geschwindigkeit, Lenkübersetzung, Reibung und Zeitpunkt des Kontakts, wie sie \
             angenommen sind",
        ),
    );
    let steady = note(
        "before the first sample the car is taken to turn steadily with its speed and steering, on a level road",
        "Vor dem ersten Abtastwert fährt das Fahrzeug stationär mit dessen Geschwindigkeit und Lenkwinkel, auf ebener \
         Straße",
    );
    let unchecked = report.yaw_rate.is_none().then(|| {
        note(
            "no yaw rate is recorded, with which the computed one could be compared",
            "Es ist keine Gierrate aufgezeichnet, mit der die berechnete verglichen werden könnte",
        )
    });
    let exact = vehicle.sheet.is_none().then(|| {
        note(
            "the parameters of the vehicle count as exact, but for the friction; those of a data sheet are drawn",
            "Die Fahrzeugparameter gelten bis auf die Reibung als genau; die eines Datenblatts sind gezogen",
        )
    });
    let ratio = other_ratio(report);
    std::iter::once(untried).chain(ratio).chain(unchecked).chain(exact).chain([steady]).collect()
}
