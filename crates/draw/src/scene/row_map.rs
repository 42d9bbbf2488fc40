//! The ground along a row of pixels.

/// Which place of the ground is under each pixel of a row. Places are off the point that is looked at, m,
/// for which single precision suffices.
pub struct RowMap {
    map: [[f32; 3]; 3],
    start: [f32; 3],
}

/// The place under a pixel.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// The place, off the point that is looked at, m.
    pub place: [f32; 2],
    depth: f32,
    per: f32,
}

impl Spot {
    /// Whether the pixel is above the horizon, where there is no ground.
    #[inline(always)]
    pub fn is_sky(&self) -> bool {
        self.depth <= 1e-9
    }
}

impl RowMap {
    /// - `map`: that of [`Projection::ground_map`](crate::scene::Projection::ground_map);
    /// - `py`: the middle of the row, pixels.
    pub fn new(map: [[f32; 3]; 3], py: f32) -> Self {
        Self { start: map.map(|row| row[0] + row[2] * py), map }
    }

    /// The place under the middle of a pixel; `None` above the horizon.
    pub fn at(&self, column: usize) -> Option<Spot> {
        let spot = self.spot(column as f32 + 0.5);
        (!spot.is_sky()).then_some(spot)
    }

    /// The place under a point of the row, of no use above the horizon.
    #[inline(always)]
    pub fn spot(&self, px: f32) -> Spot {
        let ([nx, ny, nd], [mx, my, md]) = (self.start, &self.map);
        let depth = nd + md[1] * px;
        let per = 1.0 / depth;
        Spot { place: [(nx + mx[1] * px) * per, (ny + my[1] * px) * per], depth, per }
    }

    /// By how much a coordinate changes from a pixel to the one at its right, and to the one below, m.
    #[inline(always)]
    pub fn changes(&self, spot: &Spot, axis: usize) -> [f32; 2] {
        let (row, md, at) = (&self.map[axis], &self.map[2], spot.place[axis]);
        [(row[1] - at * md[1]) * spot.per, (row[2] - at * md[2]) * spot.per]
    }

    /// By how much a coordinate changes over a pixel, m, more than 0.
    #[inline(always)]
    pub fn change(&self, spot: &Spot, axis: usize) -> f32 {
        let [a, b] = self.changes(spot, axis);
        (a * a + b * b).sqrt().max(1e-9)
    }
}
