//! Systems of units of finite-element models.
//!
//! A solver knows no units; whoever built the model chose mass, length and time, and everything else
//! follows: a force is in mass · length / time². The files do not say the choice.

use crate::units::{FOOT_M, INCH_M, POUND_FORCE_N, significant};

/// The units of mass, length and time of a finite-element model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DeckUnits {
    /// kg, m, s: forces in N.
    KgMS,
    /// Tonne, mm, s: forces in N.
    TMmS,
    /// kg, mm, ms: forces in kN.
    KgMmMs,
    /// g, mm, ms: forces in N.
    GMmMs,
    /// kg, mm, s: forces in mN.
    KgMmS,
    /// g, cm, µs: forces in 10 MN.
    GCmUs,
    /// lbf s²/in, in, s: forces in lbf.
    LbfInS,
    /// Slug, ft, s: forces in lbf.
    SlugFtS,
}

/// What a number of a model measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dimension {
    Time,
    Length,
    Velocity,
    Acceleration,
    Angle,
    AngularVelocity,
    Force,
    Moment,
    Impulse,
}

impl DeckUnits {
    /// All of them; of several that fit equally well the first is proposed.
    pub const ALL: [Self; 8] = [
        Self::TMmS,
        Self::KgMmMs,
        Self::KgMS,
        Self::GMmMs,
        Self::KgMmS,
        Self::GCmUs,
        Self::LbfInS,
        Self::SlugFtS,
    ];

    /// The names of all of them, for a message.
    pub(in crate::data) const NAMES: &'static str =
        "t-mm-s, kg-mm-ms, kg-m-s, g-mm-ms, kg-mm-s, g-cm-us, lbfs2/in-in-s or slug-ft-s";

    /// Its name in the text of a map.
    pub fn name(self) -> &'static str {
        match self {
            Self::KgMS => "kg-m-s",
            Self::TMmS => "t-mm-s",
            Self::KgMmMs => "kg-mm-ms",
            Self::GMmMs => "g-mm-ms",
            Self::KgMmS => "kg-mm-s",
            Self::GCmUs => "g-cm-us",
            Self::LbfInS => "lbfs2/in-in-s",
            Self::SlugFtS => "slug-ft-s",
        }
    }

    /// Size of the units of mass, length and time in kg, m and s.
    fn factors(self) -> [f64; 3] {
        match self {
            Self::KgMS => [1.0, 1.0, 1.0],
            Self::TMmS => [1e3, 1e-3, 1.0],
            Self::KgMmMs => [1.0, 1e-3, 1e-3],
            Self::GMmMs => [1e-3, 1e-3, 1e-3],
            Self::KgMmS => [1.0, 1e-3, 1.0],
            Self::GCmUs => [1e-3, 1e-2, 1e-6],
            Self::LbfInS => [POUND_FORCE_N / INCH_M, INCH_M, 1.0],
            Self::SlugFtS => [POUND_FORCE_N / FOOT_M, FOOT_M, 1.0],
        }
    }

    /// The system with these factors of mass, length and time; `None` if it is none of them.
    pub(super) fn from_factors(factors: [f64; 3]) -> Option<Self> {
        let is_same = |units: &Self| {
            units.factors().iter().zip(factors).all(|(own, of)| (of / own - 1.0).abs() < 1e-5)
        };
        Self::ALL.into_iter().find(is_same)
    }

    /// Size of the unit of a quantity in SI units.
    pub(super) fn si_per_unit(self, dimension: Dimension) -> f64 {
        let [mass, length, time] = self.factors();
        match dimension {
            Dimension::Time => time,
            Dimension::Length => length,
            Dimension::Velocity => length / time,
            Dimension::Acceleration => length / time / time,
            Dimension::Angle => 1.0,
            Dimension::AngularVelocity => 1.0 / time,
            Dimension::Force => mass * length / time / time,
            Dimension::Moment => mass * length / time * length / time,
            Dimension::Impulse => mass * length / time,
        }
    }
}

impl Dimension {
    /// The SI unit in a header.
    pub(super) fn symbol(self) -> &'static str {
        match self {
            Self::Time => "s",
            Self::Length => "m",
            Self::Velocity => "m/s",
            Self::Acceleration => "m/s²",
            Self::Angle => "rad",
            Self::AngularVelocity => "rad/s",
            Self::Force => "N",
            Self::Moment => "N m",
            Self::Impulse => "N s",
        }
    }
}

/// The largest magnitudes of results, in the units of their model; `None` where there are none.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Magnitudes {
    pub duration: Option<f64>,
    pub force: Option<f64>,
    pub impulse: Option<f64>,
    pub speed: Option<f64>,
    pub distance: Option<f64>,
}

/// Units that nobody has said, with a proposal.
#[derive(Debug, Clone)]
pub(in crate::data) struct OpenUnits {
    /// The units that fit best.
    pub proposed: DeckUnits,
    /// Why, in words.
    pub why: String,
}

impl Magnitudes {
    /// What a collision of cars has: its SI range beside each magnitude.
    fn ranged(&self) -> impl Iterator<Item = (&'static str, Dimension, [f64; 2], f64)> {
        [
            ("duration", Dimension::Time, [0.02, 10.0], self.duration),
            ("largest force", Dimension::Force, [2e3, 5e6], self.force),
            ("largest impulse", Dimension::Impulse, [50.0, 2e5], self.impulse),
            ("largest speed", Dimension::Velocity, [0.5, 80.0], self.speed),
            ("largest coordinate", Dimension::Length, [0.05, 500.0], self.distance),
        ]
        .into_iter()
        .filter_map(|(name, dimension, range, value)| Some((name, dimension, range, value?)))
        .filter(|(.., value)| *value > 0.0 && value.is_finite())
    }

    /// By how many powers of ten the magnitudes lie outside of the ranges of a collision.
    fn decades_outside(&self, units: DeckUnits) -> f64 {
        let outside = |(_, dimension, [low, high], value): (_, _, [f64; 2], f64)| {
            let value = value * units.si_per_unit(dimension);
            (low / value).max(value / high).max(1.0).log10()
        };
        self.ranged().map(outside).sum()
    }

    /// The units with which the magnitudes are most like those of a collision of cars.
    ///
    /// - `stated`: what a file says of its units, if it says anything.
    pub(super) fn propose(&self, stated: Option<DeckUnits>) -> OpenUnits {
        let scores = DeckUnits::ALL.map(|units| (units, self.decades_outside(units)));
        let least = scores.iter().map(|(_, score)| *score).fold(f64::INFINITY, f64::min);
        let fits = |score: f64| score <= least + 1e-9;
        let stated = stated.filter(|stated| self.decades_outside(*stated) <= least + MOST_OUTSIDE);
        let fitting: Vec<DeckUnits> =
            scores.iter().filter(|(_, score)| fits(*score)).map(|(units, _)| *units).collect();
        let first = fitting.first().copied().unwrap_or(DeckUnits::KgMS);
        let proposed = stated.unwrap_or(first);
        let read: Vec<String> = self
            .ranged()
            .map(|(name, dimension, _, value)| {
                let si = value * proposed.si_per_unit(dimension);
                let (value, si) = (shown(value), shown(si));
                format!("{name} {value} is {si} {}", dimension.symbol())
            })
            .collect();
        let mut why = match stated {
            Some(units) => format!("the file has the factors of {}", units.name()),
            None => format!("the numbers are those of a collision in {}", proposed.name()),
        };
        if !read.is_empty() {
            why += &format!(" ({})", read.join(", "));
        }
        let others: Vec<&str> =
            fitting.iter().filter(|units| **units != proposed).map(|units| units.name()).collect();
        if stated.is_none() && !others.is_empty() {
            why += &format!(", and of one in {}", others.join(" or "));
        }
        OpenUnits { proposed, why }
    }
}

/// A number in a sentence; one that would need many digits has an exponent.
pub(super) fn shown(value: f64) -> String {
    match value == 0.0 || (1e-4..1e7).contains(&value.abs()) {
        true => significant(value),
        false => format!("{value:.3e}"),
    }
}

/// Powers of ten by which the units that a file states may fit worse than others.
const MOST_OUTSIDE: f64 = 0.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_units_of_a_collision_are_proposed() {
        // 0.15 s, 310 kN, 9300 N s, 20 m/s, 5 m.
        for units in [DeckUnits::TMmS, DeckUnits::KgMmMs, DeckUnits::KgMS, DeckUnits::GCmUs] {
            let of = |value: f64, dimension| Some(value / units.si_per_unit(dimension));
            let magnitudes = Magnitudes {
                duration: of(0.15, Dimension::Time),
                force: of(3.1e5, Dimension::Force),
                impulse: of(9300.0, Dimension::Impulse),
                speed: of(20.0, Dimension::Velocity),
                distance: of(5.0, Dimension::Length),
            };
            assert_eq!(magnitudes.propose(None).proposed, units);
        }
    }

    #[test]
    fn units_of_the_same_force_are_named_together() {
        let magnitudes =
            Magnitudes { duration: Some(0.15), force: Some(3.1e5), ..Magnitudes::default() };
        let open = magnitudes.propose(None);
        assert_eq!(open.proposed, DeckUnits::TMmS);
        assert!(open.why.contains("kg-m-s"), "{}", open.why);
        assert_eq!(magnitudes.propose(Some(DeckUnits::KgMS)).proposed, DeckUnits::KgMS);
        // What a file states against all reason is not proposed.
        assert_ne!(magnitudes.propose(Some(DeckUnits::GCmUs)).proposed, DeckUnits::GCmUs);
    }

    #[test]
    fn all_names_are_listed() {
        let names = DeckUnits::ALL.map(DeckUnits::name);
        assert_eq!(names.join(", "), DeckUnits::NAMES.replace(" or ", ", "));
    }

    #[test]
    fn forces_follow_from_mass_length_and_time() {
        for (units, force_n) in [
            (DeckUnits::KgMS, 1.0),
            (DeckUnits::TMmS, 1.0),
            (DeckUnits::KgMmMs, 1e3),
            (DeckUnits::GMmMs, 1.0),
            (DeckUnits::KgMmS, 1e-3),
            (DeckUnits::GCmUs, 1e7),
            (DeckUnits::LbfInS, 4.448_221_615_260_5),
            (DeckUnits::SlugFtS, 4.448_221_615_260_5),
        ] {
            let ratio = units.si_per_unit(Dimension::Force) / force_n;
            assert!((ratio - 1.0).abs() < 1e-12, "{units:?}: {ratio}");
        }
    }
}
