//! Triangles with the material of each.

/// Material of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Surface {
    /// Painted body, in the colour of the car's role.
    Body,
    /// Grille, bumper and sill.
    Trim,
    /// Windscreen, in a lighter shade than the other windows, so that the front is told from the rear.
    Windscreen,
    /// Side and rear windows.
    Glass,
    /// Head lamps.
    HeadLamp,
    /// Tail lamps.
    TailLamp,
    /// Underside and wheel houses.
    Underbody,
    /// Tire.
    Tire,
    /// Light sectors of a wheel disc.
    Hub,
    /// Dark sectors of a wheel disc, which show how far it has turned.
    HubGap,
}

impl Surface {
    /// Colour of the material, 8 bits each for red, green and blue.
    ///
    /// - `body`: colour of the painted body.
    pub fn rgb(self, body: [u8; 3]) -> [u8; 3] {
        match self {
            Self::Body => body,
            Self::Trim => [52, 55, 58],
            Self::Windscreen => [58, 78, 92],
            Self::Glass => [36, 44, 52],
            Self::HeadLamp => [250, 246, 226],
            Self::TailLamp => [176, 24, 32],
            Self::Underbody => [24, 25, 27],
            Self::Tire => [38, 39, 41],
            Self::Hub => [206, 209, 212],
            Self::HubGap => [96, 100, 104],
        }
    }
}

/// A triangle of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshTriangle {
    /// Its corners, as places in [`Mesh::vertices_m`], counter-clockwise from outside.
    pub corners: [u32; 3],
    /// Its material.
    pub surface: Surface,
}

/// A surface of triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Corners `[x, y, z]`, m.
    pub vertices_m: Vec<[f64; 3]>,
    /// Triangles.
    pub triangles: Vec<MeshTriangle>,
}

impl Mesh {
    /// Adds a flat polygon with convex outline, corners in either order around it. Triangles between corners
    /// that coincide or lie on a line are left out: they have no normal.
    ///
    /// - `inside`: a point on the inner side of the surface, m.
    pub(super) fn add(&mut self, surface: Surface, corners_m: &[[f64; 3]], inside: [f64; 3]) {
        let first = self.vertices_m.len() as u32;
        self.vertices_m.extend_from_slice(corners_m);
        for last in 2..corners_m.len() {
            let (Some(a), Some(b), Some(c)) =
                (corners_m.first(), corners_m.get(last - 1), corners_m.get(last))
            else {
                continue;
            };
            let out = triangle_normal([*a, *b, *c]);
            if out == [0.0; 3] {
                continue;
            }
            let is_outward = (0..3).map(|i| out[i] * (a[i] - inside[i])).sum::<f64>() >= 0.0;
            let (second, third) = (first + last as u32 - 1, first + last as u32);
            let corners = if is_outward { [first, second, third] } else { [first, third, second] };
            self.triangles.push(MeshTriangle { corners, surface });
        }
    }

    /// Adds a polygon and its mirror image in the plane y = 0, in which `inside` lies.
    pub(super) fn add_mirrored(
        &mut self,
        surface: Surface,
        corners_m: &[[f64; 3]],
        inside: [f64; 3],
    ) {
        self.add(surface, corners_m, inside);
        let mirrored: Vec<[f64; 3]> = corners_m.iter().map(|[x, y, z]| [*x, -y, *z]).collect();
        self.add(surface, &mirrored, inside);
    }

    /// Corners of a triangle, m; `None` if one is missing.
    pub fn corners_m(&self, triangle: &MeshTriangle) -> Option<[[f64; 3]; 3]> {
        let [a, b, c] = triangle.corners.map(|idx| self.vertices_m.get(idx as usize).copied());
        Some([a?, b?, c?])
    }
}

/// The point at a share of the way between two points.
pub(super) fn between(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
}

/// Unit normal of a triangle whose corners are counter-clockwise from outside; zero if it has no area.
pub fn triangle_normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let side = |to: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| to[i] - a[i]) };
    let ([x1, y1, z1], [x2, y2, z2]) = (side(b), side(c));
    let cross = [y1 * z2 - z1 * y2, z1 * x2 - x1 * z2, x1 * y2 - y1 * x2];
    let size = cross.iter().map(|v| v * v).sum::<f64>().sqrt();
    if size > 0.0 { cross.map(|v| v / size) } else { [0.0; 3] }
}
