//! The evidence with its items, in SI units.
//!
//! World axes: origin at the CG of the struck car at first contact, X along its heading before the
//! impact, Y to the left. Those of a single car are free: everything found is in the same ones.

use impactlab_core::units::Phrase;
use impactlab_core::vehicle::RoadSlope;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use crate::evidence::{
    After, CarEvidence, Damage, Edr, EvidenceKind, Item, Items, Mark, Measured, PriorRanges,
    RecordedSpeed, RestPose, Road, SkidBefore, Start, VideoPosition, Weighing, YesNoUnknown, after,
    car, damage, ends, mark, position, prior_ranges, recorder, rest, road, skid, speed, start,
    weighing,
};
use crate::likelihood::{Compared, ComparedCar, Comparison, Discrepancy, PathResidual, Track};
use crate::{CollisionMotion, StrikingMotion};

/// Everything that is found. Each item is shown to what reads, writes, draws and tells the evidence by
/// [`Evidence::items`], and is compared with a motion by `Evidence::compared`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// Name of the case.
    pub case: String,
    /// What it is of. A single car has the items `struck_car`, `rest`, `after`, `marks` and `positions` of a
    /// struck one, and none of the impact or of another car.
    #[serde(default, skip_serializing_if = "EvidenceKind::is_collision")]
    pub kind: EvidenceKind,
    /// Peak friction of the road, where it was measured.
    pub friction: Option<Road>,
    /// The car that was struck, or the single one.
    pub struck_car: CarEvidence,
    /// The car that struck it.
    #[serde(default)]
    pub striking_car: CarEvidence,
    /// The one scale that weighed both cars; `None` if they were not weighed on one.
    #[serde(default, rename = "shared_scale_sigma")]
    pub weighing: Option<Weighing>,
    /// Where the struck car was hit.
    #[serde(default)]
    pub damage: Damage,
    /// Skid of the struck car that ended at the first contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skid_before: Option<SkidBefore>,
    /// The same of the striking car.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub striking_skid_before: Option<SkidBefore>,
    /// Where the struck car came to rest; `None` if that is not known.
    pub rest: Option<RestPose>,
    /// Where the striking car came to rest.
    pub striking_rest: Option<RestPose>,
    /// What driver and damage did to the wheels of the struck car.
    pub after: After,
    /// The same of the striking car.
    #[serde(default)]
    pub striking_after: After,
    /// Tire marks of the struck car.
    pub marks: Vec<Mark>,
    /// Tire marks of the striking car.
    #[serde(default)]
    pub striking_marks: Vec<Mark>,
    /// Event data recorder of the struck car.
    #[serde(deserialize_with = "with_record")]
    pub edr: Option<Edr>,
    /// Event data recorder of the striking car.
    #[serde(default, deserialize_with = "with_record")]
    pub striking_edr: Option<Edr>,
    /// Positions of the struck car from a video.
    pub positions: Vec<VideoPosition>,
    /// Where a single car was at the start, with ranges of how it moved there.
    #[serde(default, skip_serializing_if = "is_default")]
    pub start: Start,
    /// Speeds of a single car at times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub speeds: Vec<RecordedSpeed>,
    /// Ranges that the user gives to what is asked for.
    pub prior: PriorRanges,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// A recorder; `None` for one that recorded nothing, as which cases of earlier versions have none.
fn with_record<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Edr>, D::Error> {
    let edr: Option<Edr> = Option::deserialize(deserializer)?;
    Ok(edr.filter(|edr| !edr.is_empty()))
}

impl Evidence {
    /// Shows every item that evidence of this kind has.
    pub fn items(&mut self, visitor: &mut impl Items) {
        match self.kind {
            EvidenceKind::Collision => self.items_of_collision(visitor),
            EvidenceKind::SingleCar => self.items_of_single_car(visitor),
        }
    }

    /// The items of a single car.
    fn items_of_single_car(&mut self, visitor: &mut impl Items) {
        visitor.optional(&road::SECTION, &mut self.friction);
        visitor.item(&car::SINGLE, None, &mut self.struck_car);
        visitor.item(&start::SECTION, None, &mut self.start);
        visitor.optional(&rest::SINGLE, &mut self.rest);
        visitor.many(&mark::STRUCK, &mut self.marks);
        visitor.many(&speed::SECTION, &mut self.speeds);
        visitor.many(&position::SECTION, &mut self.positions);
        visitor.item(&after::SINGLE, None, &mut self.after);
    }

    /// The items of a collision. The evidence is taken apart without `..`, so that none is left out.
    fn items_of_collision(&mut self, visitor: &mut impl Items) {
        let Self {
            case: _,
            kind: _,
            friction,
            struck_car,
            striking_car,
            weighing,
            damage,
            skid_before,
            striking_skid_before,
            rest,
            striking_rest,
            after,
            striking_after,
            marks,
            striking_marks,
            edr,
            striking_edr,
            positions,
            start: _,
            speeds: _,
            prior,
        } = self;
        visitor.optional(&road::SECTION, friction);
        visitor.item(&car::STRUCK, None, struck_car);
        visitor.item(&car::STRIKING, None, striking_car);
        visitor.optional(&weighing::SECTION, weighing);
        visitor.optional(&skid::STRUCK, skid_before);
        visitor.optional(&skid::STRIKING, striking_skid_before);
        visitor.optional(&rest::STRUCK, rest);
        visitor.optional(&rest::STRIKING, striking_rest);
        visitor.many(&mark::STRUCK, marks);
        visitor.many(&mark::STRIKING, striking_marks);
        visitor.item(&damage::SECTION, None, damage);
        visitor.optional(&recorder::STRUCK, edr);
        visitor.optional(&recorder::STRIKING, striking_edr);
        visitor.many(&position::SECTION, positions);
        visitor.item(&after::STRUCK, None, after);
        visitor.item(&after::STRIKING, None, striking_after);
        visitor.item(&prior_ranges::SECTION, None, prior);
    }

    /// Likelihood of a motion, with and without each part of the evidence, and its terms if they are
    /// wanted.
    ///
    /// The order of the items is that of the terms and of the sums, whose last digits depend on it.
    pub(crate) fn compared(
        &self,
        discrepancy: &Discrepancy,
        motion: &CollisionMotion,
        wants_terms: bool,
    ) -> Compared {
        let Self {
            case: _,
            kind,
            friction,
            struck_car,
            striking_car,
            // The scale is a quantity of the prior.
            weighing: _,
            damage,
            // Their lengths are quantities of the prior, and nothing else of the motion depends on them.
            skid_before: _,
            striking_skid_before: _,
            rest,
            striking_rest,
            // What driver and wheels did, and ranges, are parts of the forward model and the prior.
            after: _,
            striking_after: _,
            marks,
            striking_marks,
            edr,
            striking_edr,
            positions,
            // Where a single car is at the start is a part of the prior.
            start: _,
            speeds,
            prior: _,
        } = self;
        let Some(track) = Track::from_path(&motion.path) else { return Compared::impossible() };
        let car = struck_car_of(motion, &track);
        let mut comparison = Comparison::new(discrepancy, motion, car, wants_terms);
        rest.iter().for_each(|rest| rest.compare(&mut comparison));
        if !positions.is_empty() {
            comparison.part("positions in a video", |comparison| {
                positions.iter().for_each(|position| position.compare(comparison));
            });
        }
        marks.iter().for_each(|mark| mark.compare(marks.len(), &mut comparison));
        edr.iter().for_each(|edr| edr.compare(&mut comparison));
        speeds.iter().for_each(|speed| speed.compare(speeds.len(), &mut comparison));
        comparison.add_path();
        if self.follows_striking_car() {
            let striking = motion.striking.as_ref();
            let track = striking.and_then(|striking| Track::from_path(&striking.path));
            let Some((striking, track)) = striking.zip(track.as_ref()) else {
                return Compared::impossible();
            };
            let car = striking_car_of(motion, striking, track);
            let mut own = Comparison::new(discrepancy, motion, car, wants_terms);
            striking_rest.iter().for_each(|rest| rest.compare(&mut own));
            striking_marks.iter().for_each(|mark| mark.compare(striking_marks.len(), &mut own));
            striking_edr.iter().for_each(|edr| edr.compare(&mut own));
            // What the model errs by is alike along the path of one car, and not for both.
            own.add_path();
            comparison.add(own);
        }
        friction.iter().for_each(|road| road.compare_drag(&mut comparison));
        if wants_terms {
            friction.iter().for_each(|road| road.compare(&mut comparison));
        }
        if wants_terms && kind.is_collision() {
            struck_car.compare_struck(&mut comparison);
            striking_car.compare_striking(&mut comparison);
            damage.compare(&mut comparison);
        }
        comparison.finish()
    }

    /// The residuals of rest pose and positions, in this order, and the distance travelled in all, m.
    pub(crate) fn path_residuals(
        &self,
        discrepancy: &Discrepancy,
        motion: &CollisionMotion,
    ) -> Option<(Vec<PathResidual>, f64)> {
        let track = Track::from_path(&motion.path)?;
        let car = struck_car_of(motion, &track);
        let mut comparison = Comparison::new(discrepancy, motion, car, false);
        self.rest.iter().for_each(|rest| rest.compare(&mut comparison));
        self.positions.iter().for_each(|position| position.compare(&mut comparison));
        Some((comparison.path, track.whole_m()))
    }

    /// Whether it is of a single car.
    pub fn is_single_car(&self) -> bool {
        self.kind == EvidenceKind::SingleCar
    }

    /// Whether a single car is said to have been braked before its start.
    pub fn brakes_before_start(&self) -> bool {
        self.is_single_car()
            && ends(self.start.braked_before_s).is_some()
            && self.after.driver_braked != YesNoUnknown::No
    }

    /// The title of the first item that is entered although evidence of this kind does not have it.
    pub(super) fn foreign(&self) -> Option<&'static str> {
        let of_single = [
            (self.start != Start::default(), start::SECTION.title),
            (!self.speeds.is_empty(), speed::SECTION.title),
        ];
        // Cases of earlier versions have a side in every form.
        let without_side = Damage { side: None, ..self.damage };
        let of_collision = [
            (self.striking_car != CarEvidence::default(), car::STRIKING.title),
            (self.weighing.is_some(), weighing::SECTION.title),
            (without_side != Damage::default(), damage::SECTION.title),
            (self.skid_before.is_some(), skid::STRUCK.title),
            (self.striking_skid_before.is_some(), skid::STRIKING.title),
            (self.striking_rest.is_some(), rest::STRIKING.title),
            (self.striking_after != After::default(), after::STRIKING.title),
            (!self.striking_marks.is_empty(), mark::STRIKING.title),
            (self.edr.is_some(), recorder::STRUCK.title),
            (self.striking_edr.is_some(), recorder::STRIKING.title),
            (self.prior != PriorRanges::default(), prior_ranges::SECTION.title),
        ];
        let foreign = match self.kind {
            EvidenceKind::Collision => &of_single[..],
            EvidenceKind::SingleCar => &of_collision[..],
        };
        foreign.iter().find(|(is_entered, _)| *is_entered).map(|(_, title)| *title)
    }

    /// An empty form: a car that was hit and came to rest, of which nothing has been entered.
    pub fn empty() -> Self {
        Self {
            case: "new reconstruction".to_owned(),
            rest: Some(RestPose::default()),
            ..Self::default()
        }
    }

    /// An empty form of a single car that came to rest.
    pub fn empty_single_car() -> Self {
        Self { kind: EvidenceKind::SingleCar, ..Self::empty() }
    }

    /// Where the struck or single car came to rest, if nothing but the road stopped it.
    pub fn free_rest(&self) -> Option<RestPose> {
        self.rest.filter(RestPose::is_free)
    }

    /// Where the striking car came to rest, likewise.
    pub fn free_striking_rest(&self) -> Option<RestPose> {
        self.striking_rest.filter(RestPose::is_free)
    }

    /// Peak friction of the road, where it was measured.
    pub fn road_friction(&self) -> Option<Measured> {
        self.friction.and_then(|road| road.friction())
    }

    /// Drag factor of locked wheels, where it was measured.
    pub fn drag_factor(&self) -> Option<Measured> {
        self.friction.and_then(|road| road.drag_factor())
    }

    /// Slope of the road; level where nobody states it.
    pub fn slope(&self) -> RoadSlope {
        self.friction.map_or_else(RoadSlope::default, |road| road.slope())
    }

    /// The event data recorder, which may have recorded nothing.
    pub fn recorder(&self) -> Edr {
        self.edr.unwrap_or_default()
    }

    /// Whether anything says which way a car went: where it came to rest, its marks, or where and how fast it
    /// was seen on the way. A recorder knows the velocity before and its change alone.
    pub fn tells_way(&self) -> bool {
        let is_at_rest = self.free_rest().or(self.free_striking_rest()).is_some();
        let has_marks = !self.marks.is_empty() || !self.striking_marks.is_empty();
        is_at_rest || has_marks || !self.positions.is_empty() || !self.speeds.is_empty()
    }

    /// Whether anything of the striking car is evidence of how it moved, so that it is followed.
    pub fn follows_striking_car(&self) -> bool {
        let is_found = self.free_striking_rest().is_some()
            || !self.striking_marks.is_empty()
            || self.striking_edr.is_some();
        is_found && !self.is_single_car()
    }

    /// Whether somebody says what the driver of the striking car did after the impact, or that its wheels
    /// were locked: whether the cars push each other hinges on it.
    pub fn tells_striking_driver(&self) -> bool {
        let PriorRanges {
            striking_brake_start_s: start_s,
            striking_brake_share: share,
            striking_steering_wheel_rad: wheel_rad,
            ..
        } = self.prior;
        self.striking_after.driver_braked != YesNoUnknown::Unknown
            || self.striking_after.is_all_locked()
            || [start_s, share, wheel_rad].iter().any(Option::is_some)
    }

    /// What is hardly meant or contradicts itself, by the evidence alone, in words.
    pub fn odd(&self) -> Vec<Phrase> {
        [self.odd_values(), self.odd_copies(), self.odd_courses()].concat()
    }

    /// The same without the records of the event data recorders.
    pub fn without_edr(&self) -> Self {
        Self { edr: None, striking_edr: None, ..self.clone() }
    }

    /// The same with nothing of the motion but the rest poses, and nothing of what driver and wheels
    /// did.
    pub fn rest_only(&self) -> Self {
        let [after, striking_after] = [After::default(), After::default()];
        let [marks, striking_marks] = [Vec::new(), Vec::new()];
        let positions = Vec::new();
        Self { marks, striking_marks, positions, after, striking_after, ..self.without_edr() }
    }
}

/// The struck car of a motion.
fn struck_car_of<'a>(motion: &'a CollisionMotion, track: &'a Track) -> ComparedCar<'a> {
    let CollisionMotion { vehicle, manoeuvre, impact, .. } = motion;
    let speed_before_m_s = impact.map_or(f64::NAN, |impact| impact.struck_speed_m_s);
    ComparedCar { vehicle, manoeuvre, track, speed_before_m_s, prefix: "" }
}

/// The striking car of a motion.
fn striking_car_of<'a>(
    motion: &CollisionMotion,
    StrikingMotion { vehicle, manoeuvre, path: _ }: &'a StrikingMotion,
    track: &'a Track,
) -> ComparedCar<'a> {
    let speed_before_m_s = motion.impact.map_or(f64::NAN, |impact| impact.striking_speed_m_s);
    ComparedCar { vehicle, manoeuvre, track, speed_before_m_s, prefix: "striking car " }
}

#[cfg(test)]
#[path = "both_cars_tests.rs"]
mod tests;
