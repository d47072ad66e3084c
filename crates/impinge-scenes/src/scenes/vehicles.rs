//! Solids of the size of vehicles, on terrain with much smaller triangles.

use super::pile::signed_speed;
use super::terrain::{CELL, Ground};
use super::{MARGIN, NEAR_CONTACTS};
use crate::placement::cross;
use crate::random::{Random, root};
use crate::{Motion, Scene, SceneObject, SceneShape, Wave, rounded};

/// Half the length, half the height and half the width of a vehicle, in its frame. The length lies
/// along the first axis.
const HALF: [f64; 3] = [2.0, 0.75, 1.0];
/// The area of terrain per vehicle, as a multiple of the area that [`Ground::new`] provides per
/// solid.
const SHARE: usize = 4;
/// The depth of the underside below the mean height of the terrain under it. It is about the
/// roughness and curvature of the terrain over this length, so that most triangles under a vehicle
/// touch it.
const SINKING: f64 = 0.03;
/// The distance of vehicles from the border of the terrain.
const BORDER: f64 = 4.0;

/// `count` boxes, hulls and capsules of half extents 2, 0.75 and 1, equally many of each, on a
/// hilly mesh of triangles 0.5 wide, which is the first object. It has 400 triangles per vehicle.
/// In 2D the terrain is a polyline of 40 segments per vehicle.
///
/// Each vehicle is tilted with the terrain, covers dozens of triangles, and drives back and forth
/// by 0.01 to 0.03 per step along its length, over a distance of 1 to either side, and up and down
/// with the terrain. Few vehicles touch each other.
#[must_use]
pub fn vehicles_mesh<const D: usize>(count: usize) -> Scene<D> {
    scene("vehicles on mesh", count, Ground::mesh, driving)
}

/// The scene of [`vehicles_mesh`], with the terrain as a height field.
#[must_use]
pub fn vehicles_field<const D: usize>(count: usize) -> Scene<D> {
    scene("vehicles on field", count, Ground::field, driving)
}

/// The scene of [`vehicles_mesh`] with vehicles that only shake: by ±0.0005 along each axis, and by
/// ±0.0002 radians.
#[must_use]
pub fn trembling_vehicles_mesh<const D: usize>(count: usize) -> Scene<D> {
    scene("trembling vehicles on mesh", count, Ground::mesh, trembling)
}

/// The scene of [`trembling_vehicles_mesh`], with the terrain as a height field.
#[must_use]
pub fn trembling_vehicles_field<const D: usize>(count: usize) -> Scene<D> {
    scene("trembling vehicles on field", count, Ground::field, trembling)
}

/// Returns the motion of a vehicle, given its position at rest.
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

/// The kind whose length is along the second axis, so that it has to be rotated.
const CAPSULE: usize = 2;

fn vehicle<const D: usize>(kind: usize, random: &mut Random) -> SceneShape<D> {
    match kind {
        0 => SceneShape::Cuboid { half_extents: std::array::from_fn(|i| HALF[i]) },
        CAPSULE => SceneShape::Capsule { half_height: HALF[0] - HALF[1], radius: HALF[1] },
        _ => SceneShape::Convex { points: body(HALF, random) },
    }
}

/// Returns the corners of a box of these half extents. The horizontal coordinates of the upper
/// corners are reduced by a tenth to a third, so that the top is narrower than the underside.
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

/// Returns a separate position along the terrain for the `n`-th of `count` vehicles: the first
/// coordinate and, in 3D, the third.
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

/// The position of a vehicle at rest on the terrain. Its frame has three coordinates in 2D too.
struct Seat<'a, const D: usize> {
    ground: &'a Ground<D>,
    /// The first and the third coordinate of the centre.
    at: [f64; 2],
    /// The horizontal heading of the vehicle, as a unit vector: its first and third component.
    heading: [f64; 2],
    /// The axis of the vehicle's rotation, and the tangent of half the angle.
    turn: ([f64; 3], f64),
}

impl<'a, const D: usize> Seat<'a, D> {
    fn new(ground: &'a Ground<D>, at: [f64; 2], is_upright: bool, random: &mut Random) -> Self {
        // Headings have a positive first coordinate, so that no rotation is near half a turn.
        let heading = random.direction::<2>();
        let heading = if D < 3 { [1.0, 0.0] } else { [heading[0].abs(), heading[1]] };
        let mut seat = Self { ground, at, heading, turn: ([0.0, 0.0, 1.0], 0.0) };
        let [forward, up, aside] = seat.frame();
        let columns =
            if is_upright { [up.map(|x| -x), forward, aside] } else { [forward, up, aside] };
        seat.turn = turn::<D>(&columns);
        seat
    }

    /// Returns the height of the terrain at a distance `before` along the heading from the centre,
    /// and `beside` across it.
    fn height(&self, before: f64, beside: f64) -> f64 {
        let [x, z] = self.heading;
        height(
            self.ground,
            [self.at[0] + x * before - z * beside, self.at[1] + z * before + x * beside],
        )
    }

    /// Returns unit vectors along the length of the vehicle, along the terrain normal and along its
    /// width: a right-handed frame.
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

    /// Returns the centre after the vehicle has driven the distance `way` along its heading.
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

/// Returns a motion back and forth along the heading, with slight steering. All coordinates reverse
/// at the same step, up to the rounding of their speeds.
fn driving<const D: usize>(seat: &Seat<'_, D>, random: &mut Random) -> Motion<D> {
    let (back, front) = (seat.center(-1.0), seat.center(1.0));
    let (share, speed) = (random.unit(), random.between(0.01, 0.03));
    let place = std::array::from_fn(|i| {
        let way = front[i] - back[i];
        let bounds = if way < 0.0 { (front[i], back[i]) } else { (back[i], front[i]) };
        // The vehicle covers the whole distance of 2 in the same number of steps in each
        // coordinate.
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

/// Returns the axis and the tangent of half the angle of the rotation whose matrix has these
/// columns. The angle must not be near half a turn. The vector part of the quaternion divided by
/// its scalar part is axis times tangent.
fn turn<const D: usize>([x, y, z]: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
    let scalar = 1.0 + x[0] + y[1] + z[2];
    let vector = [y[2] - z[1], z[0] - x[2], x[1] - y[0]].map(|v| v / scalar);
    let tangent = length(&vector);
    if D < 3 || tangent <= 0.0 {
        return ([0.0, 0.0, 1.0], vector[2]);
    }
    (unit(vector), tangent)
}

/// Returns the height of the terrain at a horizontal position, interpolated between the four
/// vertices of its cell. Beyond the border, the outermost cell is extrapolated.
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

/// Returns the index of the cell that contains a distance from the first vertex, and the position
/// in the cell as a fraction of its width.
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
