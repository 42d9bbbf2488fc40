//! Sets pictures: scenes from above over the width of the page, others two beside each other.

use crate::report::write::pdf::flow::{
    CAPTION_PT, Flow, LEADING, MARGIN_PT, Role, Style, caption_style,
};
use crate::report::write::pdf::lines::lines;
use crate::report::write::pdf::page::Item;
use crate::report::{Block, Picture};

/// Height of a scene over its width: three of them fit onto a page.
const SCENE_ASPECT: f32 = 0.38;
/// The same of what takes half of the width: eight of them fit onto a page.
const HALF_ASPECT: f32 = 0.58;
/// Distance between two pictures beside each other, points.
const BETWEEN_HALVES_PT: f32 = 14.0;

impl Flow<'_> {
    /// Sets the first of some blocks, and the picture beside it; gives the blocks behind.
    pub fn first_of<'b>(&mut self, blocks: &'b [Block]) -> &'b [Block] {
        match blocks {
            [Block::Picture(left), Block::Picture(right), behind @ ..]
                if left.content.is_half_wide() && right.content.is_half_wide() =>
            {
                self.pair(&[left.as_ref(), right.as_ref()]);
                behind
            }
            [Block::Picture(only), behind @ ..] if only.content.is_half_wide() => {
                self.pair(&[only.as_ref()]);
                behind
            }
            [block, behind @ ..] => {
                self.block(block, behind);
                behind
            }
            [] => blocks,
        }
    }

    /// Pictures beside each other, each with its caption below it.
    fn pair(&mut self, pictures: &[&Picture]) {
        let needed_pt = self.pair_pt(pictures);
        if needed_pt > self.page_pt() {
            // A caption that takes a page of its own goes over pages.
            pictures.iter().for_each(|picture| self.scene(picture));
            return;
        }
        self.need(needed_pt);
        let (width_pt, top_pt) = (self.half_width_pt(), self.y_pt);
        let height_pt = width_pt * HALF_ASPECT;
        let mut bottom_pt = top_pt;
        for (idx, picture) in pictures.iter().enumerate() {
            let left_pt = MARGIN_PT + idx as f32 * (width_pt + BETWEEN_HALVES_PT);
            let alt = picture.alt.clone();
            let owner = self.part(Role::Figure { alt }, None);
            let rect_pt = [left_pt, top_pt, width_pt, height_pt];
            self.push(Item::Picture { rect_pt, number: picture.number, owner });
            let owner = self.part(Role::Paragraph, None);
            self.y_pt = top_pt + height_pt + 3.0;
            for line in lines(&picture.caption, self.fonts, CAPTION_PT, width_pt) {
                self.line(&line, Style { left_pt, ..caption_style() }, owner);
                self.y_pt += CAPTION_PT * LEADING;
            }
            bottom_pt = bottom_pt.max(self.y_pt);
        }
        self.y_pt = bottom_pt;
        self.space(7.0);
    }

    /// A scene, and its caption below it.
    pub fn scene(&mut self, picture: &Picture) {
        let width_pt = self.width_pt();
        let height_pt = width_pt * SCENE_ASPECT;
        self.need(self.scene_pt(picture));
        let alt = picture.alt.clone();
        let owner = self.part(Role::Figure { alt }, None);
        let rect_pt = [MARGIN_PT, self.y_pt, width_pt, height_pt];
        self.push(Item::Picture { rect_pt, number: picture.number, owner });
        self.y_pt += height_pt + 3.0;
        let owner = self.part(Role::Paragraph, None);
        self.text(&picture.caption, caption_style(), owner);
        self.space(9.0);
    }

    /// Height of a scene with its caption, points.
    pub fn scene_pt(&self, picture: &Picture) -> f32 {
        let width_pt = self.width_pt();
        width_pt * SCENE_ASPECT + 4.0 + self.caption_pt(picture, width_pt)
    }

    /// Height of pictures beside each other with their captions, points.
    pub fn pair_pt(&self, pictures: &[&Picture]) -> f32 {
        let width_pt = self.half_width_pt();
        let captions = pictures.iter().map(|picture| self.caption_pt(picture, width_pt));
        width_pt * HALF_ASPECT + 4.0 + captions.fold(0.0, f32::max)
    }

    fn half_width_pt(&self) -> f32 {
        0.5 * (self.width_pt() - BETWEEN_HALVES_PT)
    }

    fn caption_pt(&self, picture: &Picture, width_pt: f32) -> f32 {
        let n = lines(&picture.caption, self.fonts, CAPTION_PT, width_pt).len();
        n as f32 * CAPTION_PT * LEADING
    }
}
