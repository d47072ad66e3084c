//! Regimes of distance, and the random placements of two solids in each regime.

use impinge_reference::geometry::vector::{add, negate, scale};
use impinge_reference::random::Random;

use super::form::{Form, Solid, up};
use super::placement::{Placement, UNTURNED, any_rotation, turning};

/// The number of pairs in a case.
pub const PAIRS: usize = 256;

/// The number of sets of slightly moved solids.
const MOVED_SETS: usize = 4;

/// The limit of the translation, and of the rotation in radians, of a solid between two warm
/// updates.
const MOVE: f64 = 1e-3;

/// The number of draws after which a regime is considered impossible for a pair, for instance deep
/// overlap of two segments.
const DRAWS: usize = 20;

/// A class of placements of two solids, by their distance (see [`Regime::distance`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Regime {
    Far,
    Near,
    Touching,
    Shallow,
    Deep,
    /// A flat side of each solid faces the other solid; the overlap is 0.001.
    Stacked,
}

impl Regime {
    pub const ALL: [Self; 6] =
        [Self::Far, Self::Near, Self::Touching, Self::Shallow, Self::Deep, Self::Stacked];

    pub fn name(self) -> &'static str {
        match self {
            Self::Far => "far",
            Self::Near => "near",
            Self::Touching => "touching",
            Self::Shallow => "shallow",
            Self::Deep => "deep",
            Self::Stacked => "stacked",
        }
    }

    /// Returns the distance of the solids; negative if they overlap.
    pub fn distance(self) -> f64 {
        match self {
            Self::Far => 2.0,
            Self::Near => 0.05,
            Self::Touching => 0.0,
            Self::Shallow => -0.01,
            Self::Deep => -0.3,
            Self::Stacked => -0.001,
        }
    }
}

/// The placements of all pairs of a case.
#[derive(Clone, Debug)]
pub struct Poses<const D: usize> {
    /// Whether the first solid is a half-space or a terrain, fixed at the origin and common to all
    /// pairs.
    pub is_ground: bool,
    pub first: Vec<Placement<D>>,
    /// Two unrelated sets of placements of the second solids, both in the regime.
    pub second: [Vec<Placement<D>>; 2],
    /// Copies of the first set with small random perturbations, different in each copy.
    pub moved: Vec<Vec<Placement<D>>>,
    /// Velocities of the second solids of the first set: towards the first solid, with a small
    /// random deviation.
    pub velocities: Vec<[f64; D]>,
}

/// A function that returns the signed distance of the two placed solids.
pub type Judge<'a, const D: usize> = &'a dyn Fn(&Placement<D>, &Placement<D>) -> f64;

/// The two solids of a case, and its name.
#[derive(Clone, Debug)]
pub struct Pair<const D: usize> {
    pub name: String,
    pub solids: [Solid<D>; 2],
}

impl<const D: usize> Pair<D> {
    pub fn forms(&self) -> [&Form<D>; 2] {
        [&self.solids[0].form, &self.solids[1].form]
    }
}

/// Returns all unordered pairs of solids, except two half-spaces. A half-space or terrain is the
/// first solid. If both are, the second one is a patch of terrain.
pub fn pairs<const D: usize>(solids: &[Solid<D>]) -> Vec<Pair<D>> {
    let two = (0..solids.len()).flat_map(|i| (i..solids.len()).map(move |j| [i, j]));
    two.filter_map(|[i, j]| pair(&solids[i], &solids[j])).collect()
}

fn pair<const D: usize>(first: &Solid<D>, second: &Solid<D>) -> Option<Pair<D>> {
    let name = format!("{D}D {}, {}", first.name, second.name);
    let solids = match (first.is_ground(), second.is_ground()) {
        (_, false) => [first.clone(), second.clone()],
        (false, true) => [second.clone(), first.clone()],
        (true, true) => [first.clone(), patch_of(second)?],
    };
    Some(Pair { name, solids })
}

fn patch_of<const D: usize>(solid: &Solid<D>) -> Option<Solid<D>> {
    let form = solid.patch.clone()?;
    Some(Solid { form, patch: None, ..solid.clone() })
}

/// Returns random placements in the regime; `None` if the regime is impossible for a pair.
pub fn poses<const D: usize>(
    pair: &Pair<D>,
    regime: Regime,
    judge: Judge<'_, D>,
) -> Option<Poses<D>> {
    let mut random = Random::new(17);
    let is_ground = pair.solids[0].is_ground();
    let mut poses = Poses {
        is_ground,
        first: vec![],
        second: [vec![], vec![]],
        moved: vec![],
        velocities: vec![],
    };
    for index in 0..PAIRS {
        let mut search =
            Search { pair, regime, judge, cell: cell(is_ground, index), random: &mut random };
        let first = search.first(is_ground);
        let [(second, direction), (other, _)] = [search.second(&first)?, search.second(&first)?];
        let aside = random.vector(0.2);
        poses.velocities.push(add(&negate(&direction), &aside));
        poses.first.push(first);
        poses.second[0].push(second);
        poses.second[1].push(other);
    }
    poses.moved = moved(&poses.second[0], &mut random);
    Some(poses)
}

fn moved<const D: usize>(set: &[Placement<D>], random: &mut Random) -> Vec<Vec<Placement<D>>> {
    let mut moved = || set.iter().map(|at| at.perturbed(random, MOVE)).collect();
    (0..MOVED_SETS).map(|_| moved()).collect()
}

/// Returns the position of the first solid of pair `index` on a grid. If all pairs share a
/// half-space or terrain, it is the position over which the second solid lies. Otherwise the
/// spacing keeps the fat AABBs of different pairs apart.
fn cell<const D: usize>(is_ground: bool, index: usize) -> [f64; D] {
    const APART: f64 = 12.0;
    const APART_ON_GROUND: f64 = 4.0;
    if is_ground {
        let row = if D == 2 { PAIRS } else { 16 };
        let centred = |n: usize| (n as f64 - (row - 1) as f64 / 2.0) * APART_ON_GROUND;
        return std::array::from_fn(|i| [centred(index % row), 0.0, centred(index / row)][i]);
    }
    let side: usize = if D == 2 { 16 } else { 7 };
    let number = |axis: usize| index / side.pow(axis as u32) % side;
    std::array::from_fn(|i| (number(i) as f64 - (side / 2) as f64) * APART)
}

struct Search<'a, const D: usize> {
    pair: &'a Pair<D>,
    regime: Regime,
    judge: Judge<'a, D>,
    cell: [f64; D],
    random: &'a mut Random,
}

impl<const D: usize> Search<'_, D> {
    fn first(&mut self, is_ground: bool) -> Placement<D> {
        match self.regime {
            _ if is_ground => Placement::new([0.0; D], UNTURNED),
            Regime::Stacked => Placement::new(self.cell, self.laid(0, &up())),
            _ => Placement::new(self.cell, any_rotation::<D>(self.random)),
        }
    }

    /// Returns a rotation that maps a random flat side of solid `which` to the direction `to`.
    fn laid(&mut self, which: usize, to: &[f64; D]) -> [f64; 4] {
        let flat = self.random.pick(&self.pair.solids[which].flats);
        turning(flat, to)
    }

    /// Returns a random placement of the second solid in the regime, and the direction in which it
    /// was moved; `None` after [`DRAWS`] failures.
    fn second(&mut self, first: &Placement<D>) -> Option<(Placement<D>, [f64; D])> {
        (0..DRAWS).find_map(|_| self.draw(first))
    }

    fn draw(&mut self, first: &Placement<D>) -> Option<(Placement<D>, [f64; D])> {
        let is_stacked = self.regime == Regime::Stacked;
        let is_upwards = is_stacked || self.pair.solids[0].is_ground();
        let direction = if is_upwards { up() } else { self.random.unit_vector() };
        let down = negate(&up());
        let rotation =
            if is_stacked { self.laid(1, &down) } else { any_rotation::<D>(self.random) };
        let from = if is_upwards { self.beside() } else { self.cell };
        let placed = |t: f64| Placement::new(add(&from, &scale(&direction, t)), rotation);
        let share = self.share(&|t| (self.judge)(first, &placed(t)))?;
        Some((placed(share), direction))
    }

    /// Returns the start of a search upwards, with a random offset from the position of the pair.
    fn beside(&mut self) -> [f64; D] {
        let aside: [f64; D] = self.random.vector(0.25);
        let at = add(&self.cell, &aside);
        std::array::from_fn(|i| if i == 1 { self.floor(&at) } else { at[i] })
    }

    /// Returns the height at which a search upwards begins: below the surface of a half-space or
    /// terrain, otherwise that of the centre of the first solid.
    fn floor(&self, at: &[f64; D]) -> f64 {
        match &self.pair.solids[0].form {
            Form::Mesh(terrain) | Form::HeightField(terrain) | Form::Polyline(terrain) => {
                terrain.height_at([at[0], at.get(2).copied().unwrap_or(0.0)]) - 0.1
            }
            Form::HalfSpace => -1.0,
            _ => self.cell[1],
        }
    }

    /// Returns the parameter `t` along the direction at which the distance is that of the regime,
    /// by bisection. At the end of the interval the solids are apart. `None` if the distance jumps
    /// over the wanted value.
    fn share(&self, distance: &dyn Fn(f64) -> f64) -> Option<f64> {
        const LONGEST: f64 = 6.0;
        const HALVINGS: usize = 24;
        const ACCURACY: f64 = 1e-4;
        let wanted = self.regime.distance();
        let (mut low, mut high) = (0.0, LONGEST);
        for _ in 0..HALVINGS {
            let middle = (low + high) / 2.0;
            if distance(middle) <= wanted { low = middle } else { high = middle }
        }
        [low, high].into_iter().find(|&t| (distance(t) - wanted).abs() < ACCURACY)
    }
}
