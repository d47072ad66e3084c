//! Solids that slide over a rough plain, each covering many triangles.

use super::pile::signed_speed;
use super::solids::SolidKind;
use super::terrain::Ground;
use super::vehicles::body;
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::{Random, root};
use crate::{Motion, Scene, SceneObject, SceneShape, Wave, rounded};

/// The width of a cell of the plain.
const CELL: f64 = 1.0;
/// Half the height of a plate.
const HALF_HEIGHT: f64 = 0.25;
/// The largest distance by which a solid slides from the centre of its lot (the square of the field
/// that is reserved for it), to either side along each axis.
const WAY: f64 = 1.0;

/// `count` flat boxes on a height field, which is the first object. Their half extents are `half`
/// horizontally and 0.25 vertically. The cells of the field have width 1, and its heights vary by
/// ±0.02. The boxes slide back and forth by 0.01 to 0.03 per step, each rotated by a random angle
/// about the vertical axis. Their undersides lie at the mean height, so that they touch most of the
/// triangles that they cover: about `8 · half²` in 3D, `2 · half` segments in 2D. No two boxes
/// overlap.
#[must_use]
pub fn plates<const D: usize>(count: usize, half: f64) -> Scene<D> {
    let half_extents = std::array::from_fn(|i| rounded(if i == 1 { HALF_HEIGHT } else { half }));
    let slider = Slider { half, height: HALF_HEIGHT, speed: (0.01, 0.03), is_laid: false };
    scene("plates", count, &slider, |_| SceneShape::Cuboid { half_extents })
}

/// `count` solids of one kind and of half extent 1, which slide back and forth by 0.1 per step on
/// the height field of [`plates`]. A capsule or cylinder lies on its side. A hull has a level
/// underside of its full size, and is narrower above.
#[must_use]
pub fn solids_on_plain<const D: usize>(count: usize, kind: SolidKind) -> Scene<D> {
    let (half_height, radius) = (0.5, 0.5);
    let is_laid = matches!(kind, SolidKind::Capsule | SolidKind::Cylinder);
    let height = if is_laid { radius } else { 1.0 };
    let slider = Slider { half: 1.0, height, speed: (0.1, 0.1), is_laid };
    scene("solids on plain", count, &slider, |random| match kind {
        SolidKind::Ball => SceneShape::Ball { radius: 1.0 },
        SolidKind::Cuboid => SceneShape::Cuboid { half_extents: [1.0; D] },
        SolidKind::Capsule => SceneShape::Capsule { half_height, radius },
        SolidKind::Hull => SceneShape::Convex { points: body([1.0; 3], random) },
        SolidKind::Cylinder => SceneShape::Cylinder { half_height: 1.0, radius },
    })
}

/// The sizes and speeds of the solids of a scene.
struct Slider {
    /// Half the largest horizontal extent.
    half: f64,
    /// The height of the centre above the mean height of the field.
    height: f64,
    /// The least and the greatest distance per step.
    speed: (f64, f64),
    /// Whether the solid is rotated so that its second axis is horizontal.
    is_laid: bool,
}

impl Slider {
    /// Returns the width of the field per solid, with which no two solids meet: three times `half`,
    /// which is more than the diagonal of the solid seen from above, the distance over which it
    /// slides, and two cells.
    fn lot(&self) -> f64 {
        2.0 * (1.5 * self.half + WAY + CELL)
    }

    fn motion<const D: usize>(&self, lot: [f64; 2], random: &mut Random) -> Motion<D> {
        let speed = random.between(self.speed.0, self.speed.1);
        let heading = random.direction::<2>();
        let heading = if D < 3 { [1.0, 0.0] } else { heading };
        let slide = |at: f64, share: f64, random: &mut Random| {
            let start = at + random.between(-WAY, WAY);
            Wave::new((at - WAY, at + WAY), start, share * speed)
        };
        let place = std::array::from_fn(|axis| match axis {
            0 => slide(lot[0], heading[0], random),
            1 => Wave::new(
                (self.height - 0.005, self.height + 0.005),
                self.height,
                signed_speed(random, 0.0002, 0.001),
            ),
            _ => slide(lot[1], heading[1], random),
        });
        let (axis, tangent) = self.turn::<D>(random);
        Motion { place, axis, tangent: Wave::rest(tangent) }
    }

    /// Returns the axis of a rotation and the tangent of half its angle: about the vertical axis,
    /// or, if `is_laid`, a quarter turn about a horizontal axis. In 2D, no rotation or a quarter
    /// turn.
    fn turn<const D: usize>(&self, random: &mut Random) -> ([f64; 3], f64) {
        let [x, z] = random.direction::<2>();
        match (D < 3, self.is_laid) {
            (true, is_laid) => ([0.0, 0.0, 1.0], f64::from(u8::from(is_laid))),
            (false, true) => ([x, 0.0, z], 1.0),
            (false, false) => ([0.0, 1.0, 0.0], random.between(-1.0, 1.0)),
        }
    }
}

fn scene<const D: usize>(
    name: &'static str,
    count: usize,
    slider: &Slider,
    shape: impl Fn(&mut Random) -> SceneShape<D>,
) -> Scene<D> {
    let random = &mut Random::new(14);
    let side = if D < 3 { count as f64 } else { root::<2>(count as f64).ceil() };
    let width = side.max(1.0) * slider.lot();
    let ground = Ground::plain(width, CELL, random);
    let ground_object = SceneObject::new(ground.field(), NEAR_CONTACTS, Motion::rest([0.0; D]));
    let solids = (0..count).map(|n| {
        let row = (n as f64 / side).floor();
        let lot = [n as f64 - row * side, row].map(|n| (n + 0.5) * slider.lot() - 0.5 * width);
        let shape = shape(random);
        SceneObject::new(shape, NEAR_CONTACTS, slider.motion(lot, random))
    });
    let objects = std::iter::once(ground_object).chain(solids).collect();
    Scene { name, margin: MARGIN, objects, steps: 100 }
}
