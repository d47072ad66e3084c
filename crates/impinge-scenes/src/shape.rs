//! Shapes as plain numbers.

use crate::Placement;

/// The shape of an object, in its local frame.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneShape<const D: usize> {
    /// A ball around the local origin.
    Ball {
        /// The radius.
        radius: f64,
    },
    /// A box around the local origin.
    Cuboid {
        /// Half the extent along each axis.
        half_extents: [f64; D],
    },
    /// A half-space behind a plane through the local origin.
    Plane {
        /// The outward unit normal.
        normal: [f64; D],
    },
    /// All points within `radius` of a segment along the second axis.
    Capsule {
        /// Half the length of the segment.
        half_height: f64,
        /// The radius.
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
    /// The convex hull of points that span all dimensions.
    Convex {
        /// The points; some may be inside the hull.
        points: Vec<[f64; D]>,
    },
    /// A solid cylinder around the second axis; 3D only.
    Cylinder {
        /// Half the distance between the caps.
        half_height: f64,
        /// The radius.
        radius: f64,
    },
    /// A solid cone around the second axis with its apex up; 3D only.
    Cone {
        /// Half the distance between apex and base; the local origin is midway.
        half_height: f64,
        /// The radius of the base.
        radius: f64,
    },
    /// A surface of triangles; 3D only.
    TriMesh {
        /// The corners of the triangles.
        vertices: Vec<[f64; D]>,
        /// Three vertex indices per triangle, counter-clockwise seen from outside.
        triangles: Vec<[u32; 3]>,
    },
    /// A chain of segments from each vertex to the next; 2D only.
    Polyline {
        /// The vertices.
        vertices: Vec<[f64; D]>,
    },
    /// A surface given by heights over a grid that is centred on the second axis; in 2D, a
    /// polyline.
    ///
    /// Each cell is divided along the diagonal from its lower row and column to its higher ones.
    HeightField {
        /// The numbers of rows, along the third axis, and of columns, along the first. In 2D there
        /// is one row.
        counts: [usize; 2],
        /// The heights, row by row.
        heights: Vec<f64>,
        /// The extents of the whole field. The second is the factor of the heights.
        extents: [f64; D],
    },
}

impl<const D: usize> SceneShape<D> {
    /// Returns the least and the greatest corner of a box around the placed shape; `None` for a
    /// plane.
    ///
    /// The box is the smallest one, except for cylinders, cones and height fields: for these it is
    /// the box around the placed local box.
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

/// Returns the corners of the local box of a height field; in 2D each corner occurs twice.
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

/// Returns a vector with `height` along the second axis and `width` along the others.
fn upright<const D: usize>(height: f64, width: f64) -> [f64; D] {
    std::array::from_fn(|i| if i == 1 { height } else { width })
}

/// Returns the half extents of the axis-aligned box around a placed cuboid.
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
