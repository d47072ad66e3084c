//! Random composites of any parts, and brute force over all parts.

use impinge::math::{AbstractRotation, Isometry, Point, Pose, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::{Segment, Shape, ShapeHandle, ShapeKind, Triangle};

use super::{Piece, Pieces, Slow};
use crate::support::query_support::random::Random;
use crate::support::query_support::samples::Sample;

/// The kinds of solids of a dimension, and the functions that make random solids and rotations.
pub struct Maker<N: Real, R, const D: usize> {
    pub kinds: &'static [ShapeKind],
    pub sample: Sample<N, D>,
    pub turn: fn(&mut Random) -> R,
}

/// A composite of random parts, with a tree (`fast`) and with a search that proposes all parts
/// (`slow`), and the poses of the parts as isometries.
pub struct Scene<N: Real, R, const D: usize> {
    pub places: Vec<Isometry<N, R, D>>,
    pub fast: Pieces<N, D>,
    pub slow: Slow<N, D>,
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize> Maker<N, R, D> {
    pub fn identity(&self) -> R {
        R::identity()
    }

    /// Returns a random pose up to `reach` away, rotated half of the time.
    pub fn place(&self, random: &mut Random, reach: N) -> Isometry<N, R, D> {
        let turn = if random.bits() & 1 == 0 { R::identity() } else { (self.turn)(random) };
        Isometry::from_parts((random.vector::<N, D>() * reach).into(), turn)
    }

    /// Returns a bounded solid of a random kind.
    pub fn solid(&self, random: &mut Random, scale: N) -> ShapeHandle<N, D> {
        let kinds = self.kinds.iter().filter(|kind| **kind != ShapeKind::Plane);
        let kinds: Vec<_> = kinds.copied().collect();
        let at = usize::try_from(random.bits() % 64).expect("few") % kinds.len();
        ShapeHandle::from_arc((self.sample)(kinds[at], random, scale).into())
    }

    /// Returns `count` parts of size `scale`, whose centres are at most five times `scale` from the
    /// origin. On average a third are triangles and a third segments, both in the frame of the
    /// composite.
    pub fn scene(&self, random: &mut Random, count: usize, scale: N) -> Scene<N, R, D> {
        let mut parts = Vec::new();
        for _ in 0..count {
            let five = scale * N::lit(5.0);
            let near = |random: &mut Random, middle: &Vector<N, D>| {
                Point::from(middle + random.vector::<N, D>() * scale)
            };
            let middle = random.vector::<N, D>() * five;
            let part = match random.bits() % 3 {
                0 => {
                    let corners = [0; 3].map(|_| near(random, &middle));
                    let [a, b, c] = corners;
                    (Isometry::identity(), Piece::Triangle(Triangle::new(a, b, c)))
                }
                1 => {
                    let ends = [0; 2].map(|_| near(random, &middle));
                    (Isometry::identity(), Piece::Segment(Segment::new(ends[0], ends[1])))
                }
                _ => (self.place(random, five), Piece::Shape(self.solid(random, scale))),
            };
            parts.push(part);
        }
        Scene::new(parts)
    }
}

impl<N: Space<D>, R: AbstractRotation<N, D>, const D: usize> Scene<N, R, D> {
    pub fn new(parts: Vec<(Isometry<N, R, D>, Piece<N, D>)>) -> Self {
        let posed = || parts.iter().map(|(m, piece)| (Pose::from_isometry(m), piece.clone()));
        let (fast, slow) = (Pieces::new(posed().collect()), Slow::new(posed().collect()));
        Self { places: parts.into_iter().map(|(m, _)| m).collect(), fast, slow }
    }

    /// Returns the least signed distance of the solid `g2` from any part, by a query of each part.
    pub fn brute(&self, m: &Isometry<N, R, D>, m2: &Isometry<N, R, D>, g2: &dyn Shape<N, D>) -> N {
        let one = |part: usize| {
            let (_, piece) = &self.fast.parts[part];
            let found = contact(&(m * &self.places[part]), piece.as_shape(), m2, g2, N::INFINITY);
            found.map_or(-N::INFINITY, |found| -found.depth)
        };
        (0..self.places.len()).map(one).fold(N::INFINITY, |a, b| if b < a { b } else { a })
    }
}
