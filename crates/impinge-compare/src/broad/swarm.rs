//! Moving boxes as plain data: at each step a list of changed boxes, the same for every contender.

use impinge_reference::random::Random;

/// A box by its centre and half extents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell<const D: usize> {
    /// The centre.
    pub center: [f32; D],
    /// The half extents.
    pub half: [f32; D],
}

impl<const D: usize> Cell<D> {
    /// Returns the corner with the least coordinates.
    pub fn mins(&self) -> [f32; D] {
        std::array::from_fn(|axis| self.center[axis] - self.half[axis])
    }

    /// Returns the corner with the greatest coordinates.
    pub fn maxs(&self) -> [f32; D] {
        std::array::from_fn(|axis| self.center[axis] + self.half[axis])
    }

    /// Returns the largest gap between two boxes along an axis; negative if they overlap.
    pub fn gap(&self, other: &Self) -> f32 {
        let ([a, b], [c, d]) = ([self.mins(), self.maxs()], [other.mins(), other.maxs()]);
        let gaps = (0..D).map(|axis| (c[axis] - b[axis]).max(a[axis] - d[axis]));
        gaps.fold(f32::NEG_INFINITY, f32::max)
    }
}

/// Returns `true` if the distance between two boxes is so close to `distance` that rounding decides
/// which of the two is larger. Contenders compute in `f32`, each in its own order. So their results
/// may differ for such boxes.
pub fn is_borderline<const D: usize>(a: &Cell<D>, b: &Cell<D>, distance: f64) -> bool {
    let apart = (0..D).map(|axis| {
        let between = f64::from(a.center[axis]) - f64::from(b.center[axis]);
        (between.abs() - f64::from(a.half[axis]) - f64::from(b.half[axis])).max(0.0)
    });
    let apart = apart.map(|gap| gap * gap).sum::<f64>().sqrt();
    let size = a.center.iter().fold(1.0_f32, |size, x| size.max(x.abs()));
    (apart - distance).abs() <= 4.0 * f64::from(f32::EPSILON * size)
}

/// The distribution of sizes and positions of the boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Boxes with half extents 0.35 to 0.65. Each overlaps three others on average.
    Alike,
    /// Boxes with half extents 0.35 to 0.65, scaled by 1 + 99·X¹⁰ for a random X (as in a benchmark
    /// of bepuphysics). Each overlaps three others on average.
    Mixed,
    /// Boxes of half extents 0.55 on a grid of spacing 1. Each stays within 0.1 of its grid point.
    Pile,
}

/// The parameters of a swarm.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The sizes of the boxes.
    pub kind: Kind,
    /// The number of boxes.
    pub count: usize,
    /// Every `stride`-th box moves, the others are fixed.
    pub stride: usize,
    /// The mean displacement of a moving box in a step.
    pub pace: f64,
    /// Whether indices follow the position along a Morton curve, instead of being random.
    pub is_sorted: bool,
    /// The number of boxes per step that are removed and replaced by a box elsewhere.
    pub replaced: usize,
}

/// The changes of a step.
#[derive(Clone, Debug, Default)]
pub struct Change<const D: usize> {
    /// The boxes that moved, with their indices.
    pub moved: Vec<(u32, Cell<D>)>,
    /// The new boxes, each with the index of the removed box that it replaces.
    pub replaced: Vec<(u32, Cell<D>)>,
}

/// Boxes and their velocities; walls around the space reflect them.
#[derive(Clone, Debug)]
pub struct Swarm<const D: usize> {
    /// The current boxes.
    pub cells: Vec<Cell<D>>,
    velocities: Vec<[f32; D]>,
    walls: Vec<[[f32; D]; 2]>,
    plan: Plan,
    edge: f64,
    next: usize,
    random: Random,
}

impl<const D: usize> Swarm<D> {
    /// Creates the swarm in its state before the first step.
    pub fn new(plan: Plan) -> Self {
        let mut random = Random::new(1);
        let halves: Vec<_> = (0..plan.count).map(|_| half(plan.kind, &mut random)).collect();
        let edge = edge(&halves, &mut random);
        let mut cells: Vec<_> = halves
            .into_iter()
            .map(|half| Cell { center: anywhere(edge, &mut random), half })
            .collect();
        if plan.kind == Kind::Pile {
            stack(&mut cells, &mut random);
        }
        if plan.is_sorted {
            let last = edge.max(1.0);
            cells.sort_by_key(|cell| morton(&cell.center.map(|x| f64::from(x) / last)));
        }
        let velocities = cells.iter().map(|_| velocity(plan.pace, &mut random)).collect();
        let walls = cells.iter().map(|cell| walls(plan.kind, &cell.center, edge)).collect();
        Self { cells, velocities, walls, plan, edge, next: 0, random }
    }

    /// Advances by one step, and returns the changes.
    pub fn step(&mut self) -> Change<D> {
        let mut change = Change::default();
        for _ in 0..self.plan.replaced {
            let cell =
                Cell { center: anywhere(self.edge, &mut self.random), ..self.cells[self.next] };
            self.cells[self.next] = cell;
            change.replaced.push((number(self.next), cell));
            self.next = (self.next + 1) % self.plan.count;
        }
        for n in (0..self.cells.len()).step_by(self.plan.stride) {
            if !self.is_new(n) {
                self.fly(n);
                change.moved.push((number(n), self.cells[n]));
            }
        }
        change
    }

    /// Returns `true` if a box was replaced in this step: it is then one of the last `replaced`
    /// boxes before `next`.
    fn is_new(&self, n: usize) -> bool {
        let age = (self.next + self.plan.count - 1 - n) % self.plan.count;
        age < self.plan.replaced
    }

    fn fly(&mut self, n: usize) {
        let [low, high] = self.walls[n];
        let (center, velocity) = (&mut self.cells[n].center, &mut self.velocities[n]);
        for axis in 0..D {
            let there = center[axis] + velocity[axis];
            if there < low[axis] || there > high[axis] {
                velocity[axis] = -velocity[axis];
            }
            center[axis] = there.clamp(low[axis], high[axis]);
        }
    }
}

fn number(n: usize) -> u32 {
    u32::try_from(n).expect("there are not that many boxes")
}

fn half<const D: usize>(kind: Kind, random: &mut Random) -> [f32; D] {
    let size = match kind {
        Kind::Alike => 1.0,
        Kind::Mixed => 1.0 + 99.0 * random.share().powi(10),
        Kind::Pile => return [0.55; D],
    };
    [0.0; D].map(|_: f32| (size * random.range(0.35, 0.65)) as f32)
}

/// Returns the edge of the cube in which boxes overlap three others on average.
///
/// Two boxes overlap if, along each axis, their centres are within the sum of their half extents.
/// Let V be the mean volume, over random pairs, of a box with these sums as half extents. A box of
/// the cube then overlaps `count * V / cube` others, which is three if the volume of the cube is
/// `count * V / 3`. As many random pairs as there are boxes estimate V.
fn edge<const D: usize>(halves: &[[f32; D]], random: &mut Random) -> f64 {
    let mut any = || halves[random.below(halves.len())].map(f64::from);
    let sum: f64 = (0..halves.len())
        .map(|_| {
            let (a, b): ([f64; D], [f64; D]) = (any(), any());
            (0..D).map(|axis| 2.0 * (a[axis] + b[axis])).product::<f64>()
        })
        .sum();
    (sum / 3.0).powf(1.0 / D as f64)
}

fn anywhere<const D: usize>(edge: f64, random: &mut Random) -> [f32; D] {
    [0.0; D].map(|_: f32| random.range(0.0, edge) as f32)
}

/// Places the boxes on the points of a grid, in random order.
fn stack<const D: usize>(cells: &mut [Cell<D>], random: &mut Random) {
    let side = (cells.len() as f64).powf(1.0 / D as f64).ceil() as usize;
    let mut places: Vec<usize> = (0..cells.len()).collect();
    for last in (1..places.len()).rev() {
        places.swap(last, random.below(last + 1));
    }
    for (cell, mut place) in cells.iter_mut().zip(places) {
        cell.center = std::array::from_fn(|_| {
            let coordinate = place % side;
            place /= side;
            coordinate as f32
        });
    }
}

fn walls<const D: usize>(kind: Kind, center: &[f32; D], edge: f64) -> [[f32; D]; 2] {
    match kind {
        Kind::Pile => [center.map(|x| x - 0.1), center.map(|x| x + 0.1)],
        Kind::Alike | Kind::Mixed => [[0.0; D], [edge as f32; D]],
    }
}

/// Returns a random direction, scaled by 0.2 to 1.8 times `pace`.
fn velocity<const D: usize>(pace: f64, random: &mut Random) -> [f32; D] {
    let speed = pace * random.range(0.2, 1.8);
    loop {
        let v: [f64; D] = [0.0; D].map(|_: f64| random.range(-1.0, 1.0));
        let squared: f64 = v.iter().map(|x| x * x).sum();
        // Rejection of points outside the unit ball; in 2D and 3D at least half of the draws are
        // inside.
        if (0.01..=1.0).contains(&squared) {
            return v.map(|x| (x * speed / squared.sqrt()) as f32);
        }
    }
}

/// Returns the Morton code of a point of the unit cube, with 16 bits per axis.
fn morton<const D: usize>(point: &[f64; D]) -> u64 {
    let bits = point.map(|x| (x.clamp(0.0, 1.0) * 65535.0) as u64);
    let levels = (0..16).rev();
    levels.flat_map(|level| bits.map(|x| x >> level & 1)).fold(0, |code, bit| code << 1 | bit)
}
