//! A custom composite, as a user writes it, of any parts at any poses.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

pub mod scenes;

use std::fmt;

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::math::{Point, Pose, Real, Space, Vector};
use impinge::partitioning::BoxTree;
use impinge::shape::{
    CompositeShape, Geometry, Part, PartSearch, PartSolid, Segment, Shape, ShapeHandle, Triangle,
};

/// The solid of a part.
#[derive(Clone, Debug)]
pub enum Piece<N: Real, const D: usize> {
    Triangle(Triangle<N, D>),
    Segment(Segment<N, D>),
    Shape(ShapeHandle<N, D>),
}

impl<N: Real, const D: usize> Piece<N, D> {
    pub fn of<S: Shape<N, D>>(shape: S) -> Self {
        Self::Shape(ShapeHandle::new(shape))
    }

    pub fn as_shape(&self) -> &dyn Shape<N, D> {
        match self {
            Self::Triangle(triangle) => triangle,
            Self::Segment(segment) => segment,
            Self::Shape(shape) => &**shape,
        }
    }
}

/// Parts with their poses, and a tree over their boxes.
pub struct Pieces<N: Real, const D: usize> {
    pub parts: Vec<(Pose<N, D>, Piece<N, D>)>,
    tree: BoxTree<N, D>,
}

impl<N: Real, const D: usize> fmt::Debug for Pieces<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.parts).finish()
    }
}

impl<N: Space<D>, const D: usize> Pieces<N, D> {
    pub fn new(parts: Vec<(Pose<N, D>, Piece<N, D>)>) -> Self {
        let boxes: Vec<_> = parts.iter().map(|(pose, p)| p.as_shape().aabb(pose)).collect();
        Self { tree: BoxTree::from_boxes(&boxes), parts }
    }

    /// Returns a mesh of triangles in the frame of the composite.
    pub fn mesh(points: &[Point<N, D>], triangles: &[[u32; 3]]) -> Self {
        let corner = |index: u32| points[index as usize];
        let one = |t: &[u32; 3]| Triangle::new(corner(t[0]), corner(t[1]), corner(t[2]));
        let place = |t| (Pose::identity(), Piece::Triangle(one(t)));
        Self::new(triangles.iter().map(place).collect())
    }

    /// Returns a chain of segments.
    pub fn chain(points: &[Point<N, D>]) -> Self {
        let one = |ends: &[Point<N, D>]| Piece::Segment(Segment::new(ends[0], ends[1]));
        Self::new(points.windows(2).map(|ends| (Pose::identity(), one(ends))).collect())
    }

    /// Returns a composite of one solid at a pose.
    pub fn wrapped(pose: Pose<N, D>, piece: Piece<N, D>) -> Self {
        Self::new(vec![(pose, piece)])
    }
}

impl<N: Space<D>, const D: usize> CompositeShape<N, D> for Pieces<N, D> {
    fn num_parts(&self) -> u32 {
        u32::try_from(self.parts.len()).expect("few")
    }

    fn part(&self, part: u32) -> Part<'_, N, D> {
        let (pose, piece) = &self.parts[part as usize];
        let solid = match piece {
            Piece::Triangle(triangle) => PartSolid::Triangle(*triangle),
            Piece::Segment(segment) => PartSolid::Segment(*segment),
            Piece::Shape(shape) => PartSolid::Shape(&**shape),
        };
        Part { pose: *pose, solid }
    }

    fn search(&self) -> &dyn PartSearch<N, D> {
        &self.tree
    }
}

impl<N: Space<D>, const D: usize> Shape<N, D> for Pieces<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.tree.bounds().copied().unwrap_or_else(Aabb::unbounded)
    }
}

/// A search that always proposes every part. Queries must have the same results as with a tree.
#[derive(Debug)]
pub struct Everything(pub u32);

impl<N: Real, const D: usize> PartSearch<N, D> for Everything {
    fn overlapping(&self, _: &Aabb<N, D>, visit: &mut dyn FnMut(u32)) {
        (0..self.0).rev().for_each(visit);
    }

    fn nearest(&self, _: &Aabb<N, D>, mut limit: N, visit: &mut dyn FnMut(u32, N) -> N) {
        for part in (0..self.0).rev() {
            if limit >= N::ZERO {
                limit = visit(part, N::ZERO);
            }
        }
    }

    fn cast(
        &self,
        _: &Aabb<N, D>,
        _: &Vector<N, D>,
        mut limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        for part in (0..self.0).rev() {
            if limit >= N::ZERO {
                limit = visit(part, N::ZERO);
            }
        }
    }
}

/// The parts with [`Everything`] as their search, for comparison.
#[derive(Debug)]
pub struct Slow<N: Real, const D: usize>(pub Pieces<N, D>, pub Everything);

impl<N: Space<D>, const D: usize> Slow<N, D> {
    pub fn new(parts: Vec<(Pose<N, D>, Piece<N, D>)>) -> Self {
        let count = u32::try_from(parts.len()).expect("few");
        Self(Pieces::new(parts), Everything(count))
    }
}

impl<N: Space<D>, const D: usize> CompositeShape<N, D> for Slow<N, D> {
    fn num_parts(&self) -> u32 {
        self.0.num_parts()
    }

    fn part(&self, part: u32) -> Part<'_, N, D> {
        self.0.part(part)
    }

    fn search(&self) -> &dyn PartSearch<N, D> {
        &self.1
    }
}

impl<N: Space<D>, const D: usize> Shape<N, D> for Slow<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        let boxes = self.0.parts.iter().map(|(pose, piece)| piece.as_shape().aabb(pose));
        boxes.reduce(|all, aabb| all.merged(&aabb)).unwrap_or_else(Aabb::unbounded)
    }
}
