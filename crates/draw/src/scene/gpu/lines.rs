//! Strokes and shadows as the shader takes them.

use bytemuck::{Pod, Zeroable};

use crate::scene::lines::Stroke;
use crate::scene::shadow::Shadow;

/// Distance from the picture up to which ends of strokes are kept as they are, pixels: beyond it single
/// precision is too coarse.
const FAR_PIXELS: f64 = 4_000.0;

/// A stroke, as in `lines.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct StrokeInstance {
    ends: [f32; 4],
    /// Half the width, pixels, and opacity.
    pen: [f32; 2],
    color: [u8; 4],
}

/// Strokes of a picture, one for each, without the parts that lie far off it; what lies there as a whole
/// is transparent.
///
/// - `size`: of the picture, pixels.
pub fn stroke_instances(strokes: &[Stroke], size: [usize; 2]) -> Vec<StrokeInstance> {
    let instance = |stroke: &Stroke| {
        let near = near_ends(stroke.ends, size);
        let opacity = if near.is_some() { stroke.opacity } else { 0.0 };
        let [[x0, y0], [x1, y1]] = near.unwrap_or_default();
        StrokeInstance {
            ends: [x0, y0, x1, y1],
            pen: [stroke.half_width, opacity],
            color: stroke.color.to_array(),
        }
    };
    strokes.iter().map(instance).collect()
}

/// The part of a straight piece that is not far off the picture; `None` if there is none.
fn near_ends(ends: [[f32; 2]; 2], size: [usize; 2]) -> Option<[[f32; 2]; 2]> {
    let [from, to] = ends.map(|end| end.map(f64::from));
    let [mut start, mut end] = [0.0_f64, 1.0_f64];
    for axis in 0..2 {
        let (low, high) = (-FAR_PIXELS, size[axis] as f64 + FAR_PIXELS);
        let way = to[axis] - from[axis];
        let [a, b] = [low, high].map(|limit| (limit - from[axis]) / way);
        if way == 0.0 {
            if !(low..=high).contains(&from[axis]) {
                return None;
            }
        } else {
            (start, end) = (start.max(a.min(b)), end.min(a.max(b)));
        }
    }
    let at = |share: f64| [0, 1].map(|axis| (from[axis] + share * (to[axis] - from[axis])) as f32);
    match start <= end {
        true if start > 0.0 || end < 1.0 => Some([at(start), at(end)]),
        true => Some(ends),
        false => None,
    }
}

/// A shadow, as in `lines.wgsl`.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct ShadowInstance {
    bounds: [f32; 4],
    /// Middle off the point that is looked at, m; cosine and sine of the direction.
    pose: [f32; 4],
    half_m: [f32; 2],
}

/// A shadow, as the shader takes it.
///
/// - `target_m`: the point that is looked at.
pub fn shadow_instance(shadow: &Shadow, target_m: [f64; 2]) -> ShadowInstance {
    let [[left, top], [right, bottom]] = shadow.bounds;
    let (sin, cos) = shadow.pose.yaw_rad.sin_cos();
    let [x, y] = [shadow.pose.x_m - target_m[0], shadow.pose.y_m - target_m[1]];
    ShadowInstance {
        bounds: [left.floor(), top.floor(), right.ceil(), bottom.ceil()].map(|v| v as f32),
        pose: [x, y, cos, sin].map(|v| v as f32),
        half_m: shadow.half_m.map(|v| v as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strokes_far_off_the_picture_are_cut_and_the_others_kept() {
        let size = [800, 500];
        let near = [[10.0, 20.0], [900.0, -30.0]];
        assert_eq!(near_ends(near, size), Some(near));
        assert_eq!(near_ends([[-9e6, -9e6], [-9e6, 9e6]], size), None);
        let [[x0, y0], [x1, y1]] = near_ends([[-1e7, 250.0], [1e7, 250.0]], size).expect("seen");
        assert_eq!([x0, x1], [-4_000.0, 4_800.0]);
        assert_eq!([y0, y1], [250.0; 2]);
        let [[x0, y0], _] = near_ends([[-1e6, -1e6], [100.0, 100.0]], size).expect("seen");
        assert!((x0 - y0).abs() < 1.0 && x0 >= -4_001.0, "on the same line: {x0}, {y0}");
    }
}
