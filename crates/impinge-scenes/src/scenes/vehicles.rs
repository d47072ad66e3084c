//! Solids as large as vehicles on ground whose triangles are small beside them.

use super::pile::signed_speed;
use super::terrain::{CELL, Ground};
use super::{MARGIN, NEAR_CONTACTS};
use crate::placement::cross;
use crate::random::{Random, root};
use crate::{Motion, Scene, SceneObject, SceneShape, Wave, rounded};

/// Half the length, the height and the width of a vehicle, in its frame: it heads along the first axis.
const HALF: [f64; 3] = [2.0, 0.75, 1.0];
/// How many times the ground that a solid of size 1 has is there for a vehicle.
const SHARE: usize = 4;
/// How far the underside lies below the mean of the ground under it: about as much as the ground is
/// rough and bent there, so that most triangles under a vehicle touch it.
const SINKING: f64 = 0.03;
/// How far vehicles stay away from the border of the ground.
const BORDER: f64 = 4.0;

/// `count` boxes, hulls and capsules of half extents 2, 0.75 and 1, as many of each, on a hilly ground
/// of triangles 0.5 wide, which is the first object: 400 triangles for each. In the plane the ground is a
/// line of 40 segments for each.
///
/// Each lies along the slope where it is, covers dozens of triangles, and drives by 0.01 to 0.03 per step
/// along its length, to and fro by 1, uphill and downhill with the ground. Few touch one another.
#[must_use]
pub fn vehicles_mesh<const D: usize>(count: usize) -> Scene<D> {
    scene("vehicles on mesh", count, Ground::mesh, driving)
}

/// The same vehicles on the same ground, which is a height field.
#[must_use]
pub fn vehicles_field<const D: usize>(count: usize) -> Scene<D> {
    scene("vehicles on field", count, Ground::field, driving)
}

/// The vehicles on their mesh, each of which trembles where it is: to and fro by 0.001 in all, and by an
/// angle of 0.0004.
#[must_use]
pub fn trembling_vehicles_mesh<const D: usize>(count: usize) -> Scene<D> {
    scene("trembling vehicles on mesh", count, Ground::mesh, trembling)
}

/// The same on the height field.
#[must_use]
pub fn trembling_vehicles_field<const D: usize>(count: usize) -> Scene<D> {
    scene("trembling vehicles on field", count, Ground::field, trembling)
}

/// How a vehicle moves that would rest at a seat.
type Move<const D: usize> = fn(&Seat<'_, D>, &mut Random) -> Motion<D>;

fn scene<const D: usize>(
    name: &'static str,
    count: usize,
    shape: fn(&Ground<D>) -> SceneShape<D>,
    motion: Move<D>,
) -> Scene<D> {
    let random = &mut Random::new(8);
    let ground = Ground::new(SHARE * count.max(1), random);
    let ground_object = SceneObject::new(shape(&ground), NEAR_CONTACTS, Motion::rest([0.0; D]));
    let vehicles = (0..count).map(|n| {
        let kind = n % 3;
        let shape = vehicle(kind, random);
        let seat = Seat::new(&ground, lot(n, count, &ground, random), kind == CAPSULE, random);
        SceneObject::new(shape, NEAR_CONTACTS, motion(&seat, random))
    });
    let objects = std::iter::once(ground_object).chain(vehicles).collect();
    Scene { name, margin: MARGIN, objects, steps: 100 }
}

/// The kind that stands upright in its own frame and has to be laid down.
const CAPSULE: usize = 2;

fn vehicle<const D: usize>(kind: usize, random: &mut Random) -> SceneShape<D> {
    match kind {
        0 => SceneShape::Cuboid { half_extents: std::array::from_fn(|i| HALF[i]) },
        CAPSULE => SceneShape::Capsule { half_height: HALF[0] - HALF[1], radius: HALF[1] },
        _ => SceneShape::Convex { points: body(HALF, random) },
    }
}

/// The corners of a box of these half extents, the upper ones of which are drawn in by a tenth to a third.
pub(super) fn body<const D: usize>(half: [f64; 3], random: &mut Random) -> Vec<[f64; D]> {
    let corners = (0..1_usize << D).map(|corner| {
        let is_upper = |axis: usize| corner >> axis & 1 == 1;
        let shrink = if is_upper(1) { random.between(0.67, 0.9) } else { 1.0 };
        std::array::from_fn(|axis| {
            let reach = if axis == 1 { half[1] } else { shrink * half[axis] };
            rounded(if is_upper(axis) { reach } else { -reach })
        })
    });
    corners.collect()
}

/// A place of its own for the `n`-th of `count` vehicles, along the ground: the first coordinate and, in
/// space, the third.
fn lot<const D: usize>(
    n: usize,
    count: usize,
    ground: &Ground<D>,
    random: &mut Random,
) -> [f64; 2] {
    let side = if D < 3 { count as f64 } else { root::<2>(count as f64).ceil() };
    let row = (n as f64 / side).floor();
    let extents = ground.extents();
    let place = |index: f64, axis: usize, shift: f64| {
        let width = extents[axis] - 2.0 * BORDER;
        width * ((index + 0.5) / side - 0.5) + shift
    };
    let shifts = [0, 1].map(|_| random.between(-0.5, 0.5));
    let across = if D < 3 { 0.0 } else { place(row, D - 1, shifts[1]) };
    [place(n as f64 - row * side, 0, shifts[0]), across]
}

/// Where a vehicle rests on the ground. Its frame has three coordinates in the plane, too.
struct Seat<'a, const D: usize> {
    ground: &'a Ground<D>,
    /// The place along the ground.
    at: [f64; 2],
    /// Where the vehicle is headed, as a unit vector along the ground, uphill or downhill left aside.
    heading: [f64; 2],
    /// The axis and the tangent of half the angle of its turn.
    turn: ([f64; 3], f64),
}

impl<'a, const D: usize> Seat<'a, D> {
    fn new(ground: &'a Ground<D>, at: [f64; 2], is_upright: bool, random: &mut Random) -> Self {
        // Headings have a positive first coordinate, so that no turn is near a half one.
        let heading = random.direction::<2>();
        let heading = if D < 3 { [1.0, 0.0] } else { [heading[0].abs(), heading[1]] };
        let mut seat = Self { ground, at, heading, turn: ([0.0, 0.0, 1.0], 0.0) };
        let [forward, up, aside] = seat.frame();
        let columns =
            if is_upright { [up.map(|x| -x), forward, aside] } else { [forward, up, aside] };
        seat.turn = turn::<D>(&columns);
        seat
    }

    /// The height of the ground before the centre by some way, and beside it by another.
    fn height(&self, before: f64, beside: f64) -> f64 {
        let [x, z] = self.heading;
        height(
            self.ground,
            [self.at[0] + x * before - z * beside, self.at[1] + z * before + x * beside],
        )
    }

    /// Unit vectors along the length, out of the ground and along the width: right-handed.
    fn frame(&self) -> [[f64; 3]; 3] {
        let [long, wide] = [0.75 * HALF[0], 0.75 * HALF[2]];
        let climb = (self.height(long, 0.0) - self.height(-long, 0.0)) / (2.0 * long);
        let tilt = (self.height(0.0, wide) - self.height(0.0, -wide)) / (2.0 * wide);
        let [x, z] = self.heading;
        let forward = unit([x, climb, z]);
        let aside = if D < 3 { [0.0, 0.0, 1.0] } else { [-z, tilt, x] };
        let up = unit(cross(&aside, &forward));
        [forward, up, cross(&forward, &up)]
    }

    /// Where the centre is when the vehicle has driven some way.
    fn center(&self, way: f64) -> [f64; D] {
        let [long, wide] = [0.75 * HALF[0], 0.75 * HALF[2]];
        let under = [(0.0, 0.0), (long, wide), (long, -wide), (-long, wide), (-long, -wide)];
        let heights = under.map(|(before, beside)| self.height(way + before, beside));
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        std::array::from_fn(|axis| match axis {
            0 => self.at[0] + way * self.heading[0],
            1 => mean + HALF[1] - SINKING,
            _ => self.at[1] + way * self.heading[1],
        })
    }
}

/// To and fro along the heading, with a little steering. All coordinates turn back at the same step, but
/// for the rounding of their speeds.
fn driving<const D: usize>(seat: &Seat<'_, D>, random: &mut Random) -> Motion<D> {
    let (back, front) = (seat.center(-1.0), seat.center(1.0));
    let (share, speed) = (random.unit(), random.between(0.01, 0.03));
    let place = std::array::from_fn(|i| {
        let way = front[i] - back[i];
        let bounds = if way < 0.0 { (front[i], back[i]) } else { (back[i], front[i]) };
        // The vehicle covers the way of 2 in so many steps that all coordinates have their share.
        Wave::new(bounds, back[i] + share * way, 0.5 * way * speed)
    });
    let (axis, tangent) = seat.turn;
    let steering = Wave::new((tangent - 0.005, tangent + 0.005), tangent, 0.0005);
    Motion { place, axis, tangent: steering }
}

fn trembling<const D: usize>(seat: &Seat<'_, D>, random: &mut Random) -> Motion<D> {
    let place = seat
        .center(0.0)
        .map(|x| Wave::new((x - 0.0005, x + 0.0005), x, signed_speed(random, 0.0001, 0.0004)));
    let (axis, tangent) = seat.turn;
    let speed = signed_speed(random, 0.000_02, 0.000_05);
    let trembling = Wave::new((tangent - 0.0001, tangent + 0.0001), tangent, speed);
    Motion { place, axis, tangent: trembling }
}

/// The axis and the tangent of half the angle of the rotation whose matrix has these columns; the angle
/// is not near a half turn. The vector part of its quaternion over the scalar part is axis times tangent.
fn turn<const D: usize>([x, y, z]: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
    let scalar = 1.0 + x[0] + y[1] + z[2];
    let vector = [y[2] - z[1], z[0] - x[2], x[1] - y[0]].map(|v| v / scalar);
    let tangent = length(&vector);
    if D < 3 || tangent <= 0.0 {
        return ([0.0, 0.0, 1.0], vector[2]);
    }
    (unit(vector), tangent)
}

/// The height of the ground at a place along it, between the four vertices around; beyond the border, as
/// the outermost cell goes on.
fn height<const D: usize>(ground: &Ground<D>, at: [f64; 2]) -> f64 {
    let extents = ground.extents();
    let [rows, columns] = ground.counts;
    let (column, right) = cell(at[0] + 0.5 * extents[0], columns);
    if D < 3 {
        let [a, b] = [0, 1].map(|step| ground.vertex([0, column + step])[1]);
        return a + (b - a) * right;
    }
    let (row, down) = cell(at[1] + 0.5 * extents[D - 1], rows);
    let [near, far] = [0, 1].map(|step| {
        let [a, b] = [0, 1].map(|along| ground.vertex([row + step, column + along])[1]);
        a + (b - a) * right
    });
    near + (far - near) * down
}

/// The cell in which a distance from the first vertex lies, and how far in it, in cells.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small number that is rounded down and not negative"
)]
fn cell(distance: f64, vertices: usize) -> (usize, f64) {
    let cells = distance / CELL;
    let cell = cells.floor().clamp(0.0, vertices.saturating_sub(2) as f64);
    (cell as usize, cells - cell)
}

fn length(v: &[f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = length(&v);
    v.map(|x| x / length)
}
