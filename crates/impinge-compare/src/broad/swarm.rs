//! Moving boxes, as data: at each step a list of the moved ones, the same for every contender.

use impinge_reference::random::Random;

/// A box by its centre and half extents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell<const D: usize> {
    /// The centre.
    pub center: [f32; D],
    /// Half of each edge.
    pub half: [f32; D],
}

impl<const D: usize> Cell<D> {
    /// The least corner.
    pub fn mins(&self) -> [f32; D] {
        std::array::from_fn(|axis| self.center[axis] - self.half[axis])
    }

    /// The greatest corner.
    pub fn maxs(&self) -> [f32; D] {
        std::array::from_fn(|axis| self.center[axis] + self.half[axis])
    }

    /// The widest gap between two boxes along an axis; negative if they overlap.
    pub fn gap(&self, other: &Self) -> f32 {
        let ([a, b], [c, d]) = ([self.mins(), self.maxs()], [other.mins(), other.maxs()]);
        let gaps = (0..D).map(|axis| (c[axis] - b[axis]).max(a[axis] - d[axis]));
        gaps.fold(f32::NEG_INFINITY, f32::max)
    }
}

/// Whether rounding decides if two boxes are within a distance of each other. Contenders compute in
/// `f32` too, each in its own order: where the numbers round differently, the results may differ.
pub fn is_borderline<const D: usize>(a: &Cell<D>, b: &Cell<D>, distance: f64) -> bool {
    let apart = (0..D).map(|axis| {
        let between = f64::from(a.center[axis]) - f64::from(b.center[axis]);
        (between.abs() - f64::from(a.half[axis]) - f64::from(b.half[axis])).max(0.0)
    });
    let apart = apart.map(|gap| gap * gap).sum::<f64>().sqrt();
    let size = a.center.iter().fold(1.0_f32, |size, x| size.max(x.abs()));
    (apart - distance).abs() <= 4.0 * f64::from(f32::EPSILON * size)
}

/// The sizes and positions of the boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Boxes of half extents 0.35 to 0.65, with about three neighbours each.
    Alike,
    /// Boxes of half extents 0.35 to 0.65 times 1 + 99·X¹⁰ for a random X (bepuphysics' benchmark),
    /// with about three neighbours each.
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
    /// Every `stride`-th box moves.
    pub stride: usize,
    /// The mean distance of a moving box in a step.
    pub pace: f64,
    /// Whether boxes that are close in space have close indices.
    pub is_sorted: bool,
    /// The number of boxes that are removed in a step, each replaced by a new one elsewhere.
    pub replaced: usize,
}

/// The changes of a step.
#[derive(Clone, Debug, Default)]
pub struct Change<const D: usize> {
    /// The boxes that moved.
    pub moved: Vec<(u32, Cell<D>)>,
    /// The removed boxes, with the new ones that take their indices.
    pub replaced: Vec<(u32, Cell<D>)>,
}

/// Boxes and their velocities; walls reflect them.
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
    /// Creates the swarm before the first step.
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

    /// Moves the boxes, and returns the changes.
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

    /// Whether a box was just added: the last one before the next to be removed.
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

/// Returns the edge of the space in which boxes have three neighbours on average. Two boxes overlap
/// if their centres are within the sum of their half extents, so the volume is a third of the mean
/// volume of boxes with these sums as half extents, times their number. The mean is estimated from as
/// many pairs as there are boxes.
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

/// Places the boxes on a grid, in random order.
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

/// Returns a random direction, scaled by 0.2 to 1.8 times the pace.
fn velocity<const D: usize>(pace: f64, random: &mut Random) -> [f32; D] {
    let speed = pace * random.range(0.2, 1.8);
    loop {
        let v: [f64; D] = [0.0; D].map(|_: f64| random.range(-1.0, 1.0));
        let squared: f64 = v.iter().map(|x| x * x).sum();
        // At least half of the trials succeed here.
        if (0.01..=1.0).contains(&squared) {
            return v.map(|x| (x * speed / squared.sqrt()) as f32);
        }
    }
}

/// Returns the position of a point of the unit cube along Morton's curve.
fn morton<const D: usize>(point: &[f64; D]) -> u64 {
    let bits = point.map(|x| (x.clamp(0.0, 1.0) * 65535.0) as u64);
    let levels = (0..16).rev();
    levels.flat_map(|level| bits.map(|x| x >> level & 1)).fold(0, |code, bit| code << 1 | bit)
}
