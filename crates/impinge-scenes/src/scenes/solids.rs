//! Solids of one or several kinds that fly freely.

use super::asteroids::rock;
use super::mixed::flight;
use super::pile::edge;
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::Random;
use crate::{Scene, SceneObject, SceneShape, rounded};

/// A kind of solid, without its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidKind {
    /// A ball.
    Ball,
    /// A box.
    Cuboid,
    /// A capsule.
    Capsule,
    /// The convex hull of 12 points.
    Hull,
    /// A cylinder; 3D only.
    Cylinder,
}

impl SolidKind {
    /// Returns all kinds that exist in `D` dimensions.
    #[must_use]
    pub const fn all<const D: usize>() -> &'static [Self] {
        const KINDS: [SolidKind; 5] = [
            SolidKind::Ball,
            SolidKind::Cuboid,
            SolidKind::Capsule,
            SolidKind::Hull,
            SolidKind::Cylinder,
        ];
        if D < 3 { KINDS.split_at(4).0 } else { &KINDS }
    }

    fn solid<const D: usize>(self, random: &mut Random) -> SceneShape<D> {
        let radius = rounded(random.between(0.3, 0.5));
        let half_height = rounded(random.between(0.2, 0.4));
        match self {
            Self::Ball => SceneShape::Ball { radius },
            Self::Cuboid => SceneShape::Cuboid {
                half_extents: [0.0; D].map(|_: f64| rounded(random.between(0.3, 0.5))),
            },
            Self::Capsule => SceneShape::Capsule { half_height, radius: rounded(0.6 * radius) },
            Self::Hull => SceneShape::Convex { points: rock(12, 1.2 * radius, random) },
            Self::Cylinder => SceneShape::Cylinder { half_height, radius },
        }
    }
}

/// `count` solids of size 1, equally many of each kind. They fly by 0.01 to 0.06 per step, rotate,
/// and are reflected at the walls of their space, whose volume per solid is `spacing` to the power
/// of `D`.
///
/// At a spacing of 1 the box of a solid overlaps those of about six others in 3D and of about three
/// in 2D; at a spacing of 2, of less than one.
///
/// # Panics
/// If `kinds` is empty, or contains a cylinder in 2D.
#[must_use]
pub fn solids<const D: usize>(count: usize, kinds: &[SolidKind], spacing: f64) -> Scene<D> {
    let all = SolidKind::all::<D>();
    assert!(kinds.iter().all(|kind| all.contains(kind)), "{kinds:?} exist in space only");
    let random = &mut Random::new(13);
    let edge = edge::<D>(count, (0..D).fold(1.0, |space, _| space * spacing));
    let objects = (0..count).map(|n| {
        let shape = kinds[n % kinds.len()].solid(random);
        SceneObject::new(shape, NEAR_CONTACTS, flight(edge, random))
    });
    Scene { name: "solids", margin: MARGIN, objects: objects.collect(), steps: 100 }
}
