//! Shapes as plain numbers.

use crate::Placement;

/// What an object is, in its local frame.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneShape<const D: usize> {
    /// A ball around the local origin.
    Ball {
        /// Its radius.
        radius: f64,
    },
    /// A box around the local origin.
    Cuboid {
        /// Half its edges.
        half_extents: [f64; D],
    },
    /// The half-space behind a plane through the local origin.
    Plane {
        /// The unit normal, out of the half-space.
        normal: [f64; D],
    },
    /// All points near a segment along the second axis.
    Capsule {
        /// Half the length of the segment.
        half_height: f64,
        /// How near.
        radius: f64,
    },
    /// A segment.
    Segment {
        /// Its ends.
        ends: [[f64; D]; 2],
    },
    /// A triangle with its interior.
    Triangle {
        /// Its corners.
        corners: [[f64; D]; 3],
    },
    /// The convex hull of points, which span all dimensions.
    Convex {
        /// The points; not all need be corners of the hull.
        points: Vec<[f64; D]>,
    },
    /// A solid cylinder around the second axis; in space only.
    Cylinder {
        /// Half the distance of the caps.
        half_height: f64,
        /// Its radius.
        radius: f64,
    },
    /// A solid cone around the second axis, apex up; in space only.
    Cone {
        /// Half the distance of apex and base, which are as far from the local origin.
        half_height: f64,
        /// The radius of the base.
        radius: f64,
    },
    /// A surface of triangles; in space only.
    TriMesh {
        /// The corners of the triangles.
        vertices: Vec<[f64; D]>,
        /// Three vertices each, counter-clockwise seen from outside.
        triangles: Vec<[u32; 3]>,
    },
    /// A line from each vertex to the next; in the plane only.
    Polyline {
        /// The vertices.
        vertices: Vec<[f64; D]>,
    },
    /// A surface over a grid that lies symmetrically around the second axis; in the plane, a line.
    ///
    /// Each cell is divided along the diagonal from its lower row and column to its higher ones.
    HeightField {
        /// The numbers of rows, along the third axis, and columns, along the first; in the plane there
        /// is one row.
        counts: [usize; 2],
        /// The heights, row by row.
        heights: Vec<f64>,
        /// The extents of the whole field; by the second the heights are multiplied.
        extents: [f64; D],
    },
}

impl<const D: usize> SceneShape<D> {
    /// The least and the greatest corner of a box around the placed shape; `None` for a plane.
    ///
    /// The smallest such box, but for cylinders, cones and height fields, whose local box is taken
    /// instead.
    #[must_use]
    pub fn aabb(&self, placement: &Placement<D>) -> Option<([f64; D], [f64; D])> {
        match self {
            Self::Plane { .. } => None,
            Self::Ball { radius } => Some(around(placement, &[*radius; D])),
            Self::Cuboid { half_extents } => {
                Some(around(placement, &reach(placement, half_extents)))
            }
            Self::Capsule { half_height, radius } => {
                let segment = reach(placement, &upright(*half_height, 0.0));
                Some(around(placement, &segment.map(|x| x + radius)))
            }
            Self::Cylinder { half_height, radius } | Self::Cone { half_height, radius } => {
                Some(around(placement, &reach(placement, &upright(*half_height, *radius))))
            }
            Self::Segment { ends } => Some(hull(placement, ends)),
            Self::Triangle { corners } => Some(hull(placement, corners)),
            Self::Convex { points } => Some(hull(placement, points)),
            Self::TriMesh { vertices, .. } | Self::Polyline { vertices } => {
                Some(hull(placement, vertices))
            }
            Self::HeightField { heights, extents, .. } => {
                Some(hull(placement, &corners(heights, extents)))
            }
        }
    }
}

/// The corners of the local box of a height field, those of the plane twice.
fn corners<const D: usize>(heights: &[f64], extents: &[f64; D]) -> [[f64; D]; 8] {
    let bounds = (f64::INFINITY, f64::NEG_INFINITY);
    let (low, high) = heights.iter().fold(bounds, |(low, high), h| (low.min(*h), high.max(*h)));
    std::array::from_fn(|corner| {
        std::array::from_fn(|axis| match (axis, corner >> axis & 1) {
            (1, 0) => low * extents[1],
            (1, _) => high * extents[1],
            (_, 0) => -0.5 * extents[axis],
            (..) => 0.5 * extents[axis],
        })
    })
}

/// `height` along the second axis and `width` along the others.
fn upright<const D: usize>(height: f64, width: f64) -> [f64; D] {
    std::array::from_fn(|i| if i == 1 { height } else { width })
}

/// Half the edges of the box around a placed cuboid.
fn reach<const D: usize>(placement: &Placement<D>, half_extents: &[f64; D]) -> [f64; D] {
    let mut reach = [0.0; D];
    for axis in 0..D {
        let mut edge = [0.0; D];
        edge[axis] = half_extents[axis];
        let turned = placement.turned(&edge);
        reach = std::array::from_fn(|i| reach[i] + turned[i].abs());
    }
    reach
}

fn around<const D: usize>(placement: &Placement<D>, reach: &[f64; D]) -> ([f64; D], [f64; D]) {
    let center = placement.translation;
    let corner = |sign: f64| std::array::from_fn(|i| center[i] + sign * reach[i]);
    (corner(-1.0), corner(1.0))
}

fn hull<const D: usize>(placement: &Placement<D>, points: &[[f64; D]]) -> ([f64; D], [f64; D]) {
    let empty = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    points.iter().map(|point| placement.point(point)).fold(empty, |(low, high), p| {
        let least = std::array::from_fn(|i| if p[i] < low[i] { p[i] } else { low[i] });
        let greatest = std::array::from_fn(|i| if p[i] > high[i] { p[i] } else { high[i] });
        (least, greatest)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_by_hand() {
        let quarter = Placement::<2> { tangent: 1.0, ..Placement::at([10.0, 0.0]) };
        let cuboid = SceneShape::Cuboid { half_extents: [1.0, 2.0] };
        assert_eq!(cuboid.aabb(&quarter), Some(([8.0, -1.0], [12.0, 1.0])), "lies on its side");
        let capsule = SceneShape::Capsule { half_height: 2.0, radius: 0.5 };
        assert_eq!(capsule.aabb(&quarter), Some(([7.5, -0.5], [12.5, 0.5])), "so does this");
        let segment = SceneShape::Segment { ends: [[0.0, 0.0], [1.0, 0.0]] };
        assert_eq!(segment.aabb(&quarter), Some(([10.0, 0.0], [10.0, 1.0])), "x becomes y");
        let field = SceneShape::HeightField {
            counts: [1, 3],
            heights: vec![0.0, 3.0, -1.0],
            extents: [4.0, 0.5],
        };
        assert_eq!(field.aabb(&quarter), Some(([8.5, -2.0], [10.5, 2.0])), "up becomes left");
        assert_eq!(SceneShape::Plane { normal: [0.0, 1.0] }.aabb(&quarter), None, "no end");
    }
}
