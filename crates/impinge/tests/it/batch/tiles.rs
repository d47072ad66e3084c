//! Compares the pairs of all tiles together with the pairs of a single call, for several numbers of
//! tiles.

use impinge::batch::{
    BatchError, Control, Shapes, Side, TileCut, Tiles, boxes, pairs_in_tile, pairs_within_one,
    tiles,
};
use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Pose, Real, Space, Unit, Vector};
use impinge::shape::{Ball, Cuboid, Plane, ShapeHandle};

use crate::support::query_support::random::Random;
use crate::support::samples::stride;

/// Placed shapes, each with an id; the ids are distinct, but not sorted.
struct Heap<N: Space<D>, const D: usize> {
    shapes: Vec<ShapeHandle<N, D>>,
    picks: Vec<u32>,
    poses: Vec<Pose<N, D>>,
    ids: Vec<u64>,
}

impl<N: Space<D>, const D: usize> Heap<N, D> {
    fn new() -> Self {
        let tilted = Vector::<N, D>::from_fn(|axis, _| N::lit([0.25, 1.0, 0.5][axis]));
        let shapes = vec![
            ShapeHandle::new(Ball::new(N::lit(0.5))),
            ShapeHandle::new(Cuboid::new(Vector::<N, D>::repeat(N::lit(0.5)))),
            ShapeHandle::new(Cuboid::new(Vector::<N, D>::repeat(N::lit(40.0)))),
            ShapeHandle::new(Plane::new(Unit::new_normalize(tilted))),
            ShapeHandle::new(Plane::new(Vector::<N, D>::y_axis_of())),
        ];
        Self { shapes, picks: vec![], poses: vec![], ids: vec![] }
    }

    fn add(&mut self, pick: u32, place: Vector<N, D>) {
        self.picks.push(pick);
        self.poses.push(Pose::from_translation(place));
        // An odd factor is invertible modulo 2⁶⁴, so all ids differ.
        let count = u64::try_from(self.ids.len()).expect("few");
        self.ids.push(count.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    }

    /// Creates balls and boxes in three clusters of equally many objects and of the half widths 7,
    /// 70 and 700. If `odd`, also adds four balls with equal centres, a huge object, half-spaces,
    /// and a ball at NaN.
    fn uneven(count: usize, odd: bool) -> Self {
        let (mut heap, mut random) = (Self::new(), Random(5, false));
        for index in 0..count {
            let size = N::lit([7.0, 70.0, 700.0][index % 3]);
            let far = Vector::<N, D>::repeat(N::lit(1000.0 * (index % 3) as f64));
            heap.add(u32::from(index % 2 == 1), random.vector::<N, D>() * size + far);
        }
        if odd {
            let place = heap.poses[0].translation;
            (0..4).for_each(|_| heap.add(0, place));
            (2..5).for_each(|pick| heap.add(pick, -place));
            heap.add(0, Vector::<N, D>::repeat(N::lit(f64::NAN)));
        }
        heap
    }

    /// Creates cubes of size 1 on a grid of spacing 1.5: neighbours are exactly 0.5 apart, and
    /// faces lie on cuts.
    fn grid(width: usize) -> Self {
        let mut heap = Self::new();
        for index in 0..width.pow(u32::try_from(D).expect("few")) {
            let row = |axis: usize| index / width.pow(u32::try_from(axis).expect("few")) % width;
            heap.add(1, Vector::<N, D>::from_fn(|axis, _| N::lit(1.5 * row(axis) as f64)));
        }
        heap
    }

    fn picked<T: Copy>(&self, elements: &[usize], list: &[T]) -> Vec<T> {
        elements.iter().map(|&element| list[element]).collect()
    }

    fn boxes(&self) -> Vec<Option<Aabb<N, D>>> {
        let shapes = Shapes::Picked { shapes: &self.shapes, picks: &self.picks };
        boxes(&Side::try_new(shapes, &self.poses).expect("as many"), &Control::new()).expect("few")
    }

    /// Returns the pairs of ids that a single call finds.
    fn pairs(&self, distance: N) -> Vec<[u64; 2]> {
        let shapes = Shapes::Picked { shapes: &self.shapes, picks: &self.picks };
        let side = Side::try_new(shapes, &self.poses).expect("as many");
        let pairs = pairs_within_one(&side, distance, &Control::new()).expect("good");
        let named = pairs.iter().map(|pair| {
            let mut ids = pair.map(|element| self.ids[element as usize]);
            ids.sort_unstable();
            ids
        });
        let mut named: Vec<_> = named.collect();
        named.sort_unstable();
        named
    }

    /// Returns, by tile, the indices of its objects in descending order: their order must not
    /// matter.
    fn objects(&self, tiles: &Tiles<N, D>) -> Vec<Vec<usize>> {
        let rows = tiles.meeting(&self.boxes());
        let mut objects = vec![vec![]; tiles.number() as usize];
        for object in (0..self.ids.len()).rev() {
            rows.tiles_of(object).iter().for_each(|&tile| objects[tile as usize].push(object));
        }
        objects
    }

    fn pairs_of(&self, tiles: &Tiles<N, D>, tile: u32, objects: &[usize]) -> Vec<[u64; 2]> {
        let picks = self.picked(objects, &self.picks);
        let poses = self.picked(objects, &self.poses);
        let shapes = Shapes::Picked { shapes: &self.shapes, picks: &picks };
        let side = Side::try_new(shapes, &poses).expect("as many");
        let ids = self.picked(objects, &self.ids);
        let found = pairs_in_tile(&side, &ids, tiles, tile, &Control::new()).expect("good");
        assert!(found.is_sorted_by(|a, b| a < b), "ascending, and none twice");
        found
    }

    /// Asserts that the pairs of all tiles are the pairs of a single call; the tiles are made from
    /// every `step`-th box. Returns the number of pairs.
    fn check(&self, distance: f64, step: usize) -> usize {
        let distance = N::lit(distance);
        let expected = self.pairs(distance);
        let sample: Vec<_> = self.boxes().into_iter().step_by(step).collect();
        for number in [1, 2, 7, 64] {
            let made = tiles(&sample, number, distance).expect("good");
            let sent = Tiles::try_from_cuts(made.clearance(), made.cuts().to_vec());
            assert_eq!(sent.as_ref(), Ok(&made), "the same by its numbers");
            assert_eq!(made.bounds().len(), number as usize, "bounds of each");
            let objects = self.objects(&made);
            let mut found = vec![];
            for (tile, objects) in (0..).zip(&objects) {
                found.extend(self.pairs_of(&made, tile, objects));
            }
            found.sort_unstable();
            assert_eq!(found.len(), expected.len(), "{number} tiles, within {distance}");
            assert!(found == expected, "{number} tiles, within {distance}");
        }
        expected.len()
    }
}

/// The unit vector along the second axis, in any dimension.
trait YAxis<N, const D: usize> {
    fn y_axis_of() -> Unit<Vector<N, D>>;
}

impl<N: Real, const D: usize> YAxis<N, D> for Vector<N, D> {
    fn y_axis_of() -> Unit<Self> {
        Unit::new_unchecked(Self::from_fn(|axis, _| if axis == 1 { N::ONE } else { N::ZERO }))
    }
}

fn check<N: Space<D>, const D: usize>() {
    // The number of pairs grows with the square of the number of objects.
    let uneven = Heap::<N, D>::uneven(1500 / stride(4), true);
    for distance in [0.0, 0.5, 30.0] {
        let count = uneven.check(distance, 5);
        assert!(count > 100, "{count} pairs within {distance}");
    }
    // First the tiles are made from a sample of one box, far from most objects. Then the distance
    // is infinite, so that every two objects are a pair.
    assert!(uneven.check(0.25, 10_000) > 100, "one box");
    assert!(Heap::<N, D>::uneven(60, true).check(f64::INFINITY, 1) > 60 * 59 / 2, "all of them");
    let width = if uneven.shapes[0].local_aabb().mins().len() == 2 { 20_usize } else { 7 };
    let dim = u32::try_from(D).expect("few");
    let neighbours = D * (width - 1) * width.pow(dim - 1);
    assert_eq!(Heap::<N, D>::grid(width).check(0.5, 1), neighbours, "at exactly the clearance");
    assert_eq!(Heap::<N, D>::grid(width).check(0.4375, 1), 0, "a little less");
}

#[test]
fn tiles_have_the_pairs_of_one_call() {
    check::<f32, 2>();
    check::<f64, 2>();
    check::<f32, 3>();
    check::<f64, 3>();
}

fn fullest_is_at_most_twice_the_mean<N: Space<D>, const D: usize>() {
    // Fewer objects would be shared less evenly. By default the second case is left out.
    let heap = Heap::<N, D>::uneven(30_000, false);
    let boxes = heap.boxes();
    for (number, step) in [(64, 10), (64, 1), (7, 1)].into_iter().step_by(stride(2)) {
        let sample: Vec<_> = boxes.iter().copied().step_by(step).collect();
        let objects = heap.objects(&tiles(&sample, number, N::lit(0.1)).expect("good"));
        let counts: Vec<usize> = objects.iter().map(Vec::len).collect();
        let (fullest, all) = (counts.iter().max().expect("some"), counts.iter().sum::<usize>());
        assert!(fullest * counts.len() <= 2 * all, "{fullest} of {all} in one of {number}");
        assert!(all >= heap.ids.len() && all < 3 * heap.ids.len(), "{all} in {number}");
    }
}

#[test]
fn uneven_objects_are_evenly_shared() {
    fullest_is_at_most_twice_the_mean::<f32, 2>();
    fullest_is_at_most_twice_the_mean::<f64, 3>();
}

#[test]
fn objects_that_all_overlap_stay_together() {
    let mut heap = Heap::<f64, 3>::new();
    (0..200).for_each(|index| heap.add(2, Vector::<f64, 3>::repeat(0.1 * f64::from(index))));
    assert_eq!(heap.check(0.0, 1), 200 * 199 / 2, "each with each");
    let all: usize =
        heap.objects(&tiles(&heap.boxes(), 64, 0.0).expect("good")).iter().map(Vec::len).sum();
    assert_eq!(all, 200, "no cut helps: one tile has them all");
}

#[test]
fn few_and_no_objects() {
    let none = Heap::<f64, 2>::new();
    assert_eq!(none.check(1.0, 1), 0, "nothing");
    let mut few = Heap::<f32, 2>::new();
    few.add(0, Vector::<f32, 2>::zeros());
    few.add(0, Vector::<f32, 2>::new(f32::NAN, 0.0));
    assert_eq!(few.check(1.0, 1), 0, "one");
    few.add(3, Vector::<f32, 2>::zeros());
    few.add(4, Vector::<f32, 2>::zeros());
    assert_eq!(few.check(1.0, 1), 3, "two half-spaces, and a ball on both");
    few.poses.iter_mut().for_each(|pose| pose.translation[0] = f32::NAN);
    assert_eq!(few.check(f64::INFINITY, 1), 0, "all are nowhere");
    let smallest = f64::MIN_POSITIVE * f64::EPSILON;
    assert!(Heap::<f64, 2>::uneven(90, true).check(smallest, 3) > 30, "the half of it is zero");
}

#[test]
fn bounds_and_owners() {
    let cuts = [(0, 2.0), (1, -1.0), (1, 5.0)].map(|(axis, at)| TileCut { axis, at });
    let tiles = Tiles::<f64, 2>::try_from_cuts(0.5, cuts.to_vec()).expect("good");
    let (bounds, low) = (tiles.bounds(), f64::NEG_INFINITY);
    assert_eq!(
        bounds[1],
        Aabb::new(Point::<f64, 2>::new(low, -1.0), Point::<f64, 2>::new(2.0, f64::INFINITY))
    );
    let places = [([1.0, -1.5], 0), ([1.0, -1.0], 1), ([2.0, 4.0], 2), ([2.0, 5.0], 3)];
    for (place, tile) in places {
        assert_eq!(tiles.owner(&Point::from(place)), tile, "at {place:?}");
    }
    let at = |x, y| {
        Some(Aabb::new(Point::<f64, 2>::new(x, y), Point::<f64, 2>::new(x + 0.25, y + 0.25)))
    };
    let rows = tiles.meeting(&[at(1.0, 0.0), None, at(1.5, -1.25), at(2.75, 4.5)]);
    assert_eq!(rows.starts, [0, 1, 1, 4, 6], "none for none");
    assert_eq!(rows.tiles, [1, 0, 1, 2, 2, 3], "grown by a quarter");
}

#[test]
fn what_is_no_tile_is_refused() {
    let heap = Heap::<f64, 2>::grid(3);
    let made = tiles(&heap.boxes(), 3, 0.5).expect("good");
    let no = tiles(&heap.boxes(), 0, 0.5).expect_err("none");
    assert_eq!(no.to_string(), "there are to be 0 tiles, where 1 or more are needed", "none");
    let no = tiles(&heap.boxes(), 2, -0.5).expect_err("negative");
    assert_eq!(no, BatchError::Distance { value: -0.5 }, "by its value");
    let shapes = Shapes::Picked { shapes: &heap.shapes, picks: &heap.picks };
    let side = Side::try_new(shapes, &heap.poses).expect("as many");
    let ask = |ids, tile| pairs_in_tile(&side, ids, &made, tile, &Control::new());
    let no = ask(&heap.ids, 3).expect_err("three tiles");
    assert_eq!(no.to_string(), "there is no tile 3 of 3", "from 0 to 2");
    let no = ask(&heap.ids[1..], 0).expect_err("one less");
    assert_eq!(no, BatchError::Length { argument: "ids", given: 8, needed: 9 }, "an id for each");
    let cut = |axis, at| TileCut { axis, at };
    let good = cut(0, 1.0);
    let wrong = [vec![cut(2, 0.0)], vec![good, cut(1, f64::NAN)], vec![good, good, cut(0, 0.5)]];
    for (expected, cuts) in wrong.into_iter().enumerate() {
        let no = Tiles::<f64, 2>::try_from_cuts(0.0, cuts).expect_err("no cuts");
        assert!(matches!(no, BatchError::TileCut { index, .. } if index == expected), "{no}");
    }
    let no = Tiles::<f64, 2>::try_from_cuts(f64::NAN, vec![]).expect_err("no clearance");
    assert!(matches!(no, BatchError::Distance { .. }), "{no}");
}
