//! Asserts, for each instruction set of this machine, that batches of 8 pairs and batches of one
//! give equal manifolds. For kinds whose builder for one pair is bit-identical to the kernel, its
//! manifold must be equal, too.

use super::{
    BallBall, BallCuboid, BallSegment, Batch, Boxes2, Boxes3, ClosedForm, KeptPairs, Many,
    PairQuestion, Segments2, Segments3, Solid, Task,
};
use crate::collide::manifold::tests::scene::{Random, Scene};
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::math::simd::Level;
use crate::math::{Point, Pose, Real, Space, Vector};
use crate::samples::stride;
use crate::shape::{Ball, Capsule, Cuboid, Geometry, Segment};
use crate::tables::ByDimension;

/// A pair and its request.
#[derive(Clone)]
struct Case<N: Real, const D: usize> {
    poses: [Pose<N, D>; 2],
    solids: [Solid<N, D>; 2],
    request: ManifoldRequest<N>,
    /// Whether the pair is updated in this step.
    is_pending: bool,
}

impl<N: Real, const D: usize> Case<N, D> {
    fn question(&self) -> PairQuestion<'_, N, D> {
        let (poses, solids) = (self.poses.each_ref(), self.solids.each_ref());
        PairQuestion { poses, solids, request: &self.request }
    }
}

/// Pairs with their manifolds, for [`KeptPairs`], and counts of its calls. Only pairs without
/// points are counted as begun or fallen back.
struct Kept<'a, N: Real, const D: usize> {
    cases: &'a [Case<N, D>],
    /// Indices of the cases to update.
    pending: Vec<usize>,
    /// Manifolds of all cases.
    raws: &'a mut [RawManifold<N, D>],
    /// Numbers of pairs: begun without points, fallen back without points, and ended.
    counts: [usize; 3],
}

impl<N: Real, const D: usize> Kept<'_, N, D> {
    /// Returns whether the pair at `index` has no points.
    fn is_new(&self, index: usize) -> bool {
        self.raws[self.pending[index]].points.is_empty()
    }
}

impl<N: Real, const D: usize> KeptPairs<N, D> for Kept<'_, N, D> {
    fn len(&self) -> usize {
        self.pending.len()
    }

    fn begin(&mut self, index: usize) -> PairQuestion<'_, N, D> {
        self.counts[0] += usize::from(self.is_new(index));
        self.cases[self.pending[index]].question()
    }

    fn parts(&mut self, index: usize) -> (PairQuestion<'_, N, D>, &mut RawManifold<N, D>) {
        self.counts[1] += usize::from(self.is_new(index));
        let case_index = self.pending[index];
        (self.cases[case_index].question(), &mut self.raws[case_index])
    }

    fn raw(&mut self, index: usize) -> &mut RawManifold<N, D> {
        &mut self.raws[self.pending[index]]
    }

    fn end(&mut self, index: usize) {
        self.counts[2] += 1;
        assert!(index < self.len(), "a pair that began");
    }
}

/// Returns the bits of a value; all NaNs give one value.
fn bits<N: Real>(value: N) -> u64 {
    if value.partial_cmp(&value).is_some() { value.bits() } else { u64::MAX }
}

/// Lists positions, distances, ids, features and normal of a manifold as bits, to compare manifolds
/// with NaN; omits the codes of the points.
fn facts<N: Real, const D: usize>(raw: &RawManifold<N, D>) -> Vec<u64> {
    let mut facts: Vec<u64> = Vec::new();
    for point in &raw.points {
        facts.extend(point.point1.coords.iter().map(|&x| bits(x)));
        facts.extend([bits(point.distance), u64::from(point.id)]);
        for feature in [point.feature1, point.feature2] {
            facts.extend(format!("{feature:?}").bytes().map(u64::from));
        }
    }
    if !raw.points.is_empty() {
        facts.extend(raw.normal.iter().map(|&x| bits(x)));
    }
    facts
}

/// Returns whether two manifolds are equal by value, where zeros have no sign, or by bits, for NaN.
fn are_same<N: Real, const D: usize>(one: &RawManifold<N, D>, other: &RawManifold<N, D>) -> bool {
    one.normal == other.normal && one.points == other.points || facts(one) == facts(other)
}

/// Computes the manifold of a case twice: in `lone` as a batch of one, with its fallback, and in
/// `other` by the builder for one pair. That builder is bit-identical to the kernels except for
/// boxes and for segments in 2D; for these, `other` is computed as a batch of one in the frame of
/// the first solid.
fn compute_alone<N: Space<D>, const D: usize>(
    case: &Case<N, D>,
    [lone, other]: [&mut RawManifold<N, D>; 2],
) {
    let (question, request) = (case.question(), &case.request);
    let solids = case.solids.each_ref().map(|solid| Geometry(solid.kind()));
    let pair = Pair::new(solids, question.poses);
    if !<N::Algorithms>::update_pair(&question, lone) {
        question.fall_back(lone);
    }
    let has_ball = matches!(case.solids[0], Solid::Ball(_));
    if has_ball || D == 3 && !matches!(case.solids[0], Solid::Cuboid(_)) {
        <N::Algorithms>::contacts_of_separation(&pair, request, other);
    } else {
        <N::Algorithms>::contacts(&pair, request, other);
    }
}

/// Updates the same pairs in several steps, so that points inherit ids, in batches and alone, and
/// asserts that the manifolds are equal ([`are_same`]). Returns the number of points, then the
/// numbers of pairs without points that fell back and that began, all for one instruction set.
fn compare<F: Batch<N, D>, N: Space<D>, const D: usize>(
    steps: &[Vec<Case<N, D>>],
    what: &str,
) -> [usize; 3] {
    let mut sums = [0; 3];
    for level in Level::available() {
        let fresh = || vec![RawManifold::<N, D>::default(); steps[0].len()];
        let (mut lone, mut expected, mut found) = (fresh(), fresh(), fresh());
        sums = [0; 3];
        for (step, cases) in steps.iter().enumerate() {
            let alone = lone.iter_mut().zip(&mut expected);
            for (case, (one, other)) in cases.iter().zip(alone).filter(|(case, _)| case.is_pending)
            {
                compute_alone(case, [one, other]);
            }
            let [begun, declined] = in_lanes::<F, N, D>(level, cases, &mut found);
            for (index, (one, other)) in expected.iter().zip(&found).enumerate() {
                let case = &cases[index];
                assert!(
                    are_same(one, other) && are_same(&lone[index], other),
                    "{what}, {level:?}, {step}, {index}: {one:?} {other:?} {:?}",
                    (case.poses, case.solids, case.request)
                );
                sums[0] += one.points.len();
            }
            (sums[1], sums[2]) = (sums[1] + declined, sums[2] + begun);
        }
    }
    sums
}

/// Updates the pending cases. Returns the numbers of pairs without points that began and that fell
/// back.
fn in_lanes<F: Batch<N, D>, N: Space<D>, const D: usize>(
    level: Level,
    cases: &[Case<N, D>],
    raws: &mut [RawManifold<N, D>],
) -> [usize; 2] {
    let pending = (0..cases.len()).filter(|&index| cases[index].is_pending).collect();
    let mut kept = Kept { cases, pending, raws, counts: [0; 3] };
    Many { level, pairs: &mut kept }.run::<F>();
    let [begun, declined, ended] = kept.counts;
    assert_eq!(kept.pending.len(), ended, "all that began ended");
    [begun, declined]
}

/// Kind of a random solid.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sort {
    Ball,
    Segment,
    Capsule,
    Cuboid,
}

/// Two random solids near each other, in double precision.
#[derive(Clone)]
struct Draw<const D: usize> {
    sorts: [Sort; 2],
    radii: [f64; 2],
    /// Ends of a segment; for a box, the magnitudes of the last end's components are the half
    /// extents.
    ends: [[Vector<f64, D>; 2]; 2],
    positions: [Vector<f64, D>; 2],
    turns: [[f64; 3]; 2],
}

impl<const D: usize> Draw<D> {
    /// Draws two solids; if `snapped`, with sizes and positions on a grid of step 1/2 and no
    /// rotation.
    fn new(random: &mut Random, sorts: [Sort; 2], snapped: bool) -> Self {
        let snap = |x: f64| if snapped { (x * 2.0).round() / 2.0 } else { x };
        let mut vector = |by: f64| Vector::<f64, D>::from_fn(|_, _| snap(random.between(-by, by)));
        let position = vector(9.0);
        let (ends, aside) = ([[vector(1.0), vector(1.0)], [vector(1.0), vector(1.0)]], vector(1.2));
        let radii = [snap(random.between(0.1, 0.8)), snap(random.between(0.1, 0.8))];
        let mut turn = || [0.0; 3].map(|_: f64| random.between(-3.0, 3.0));
        let turns = if snapped { [[0.0; 3]; 2] } else { [turn(), turn()] };
        Self { sorts, radii, ends, positions: [position, position + aside], turns }
    }

    /// Returns a copy with positions and rotation angles changed by up to `by`.
    fn shaken(&self, random: &mut Random, by: f64) -> Self {
        let mut shaken = self.clone();
        for which in 0..2 {
            shaken.positions[which] += Vector::<f64, D>::from_fn(|_, _| random.between(-by, by));
            shaken.turns[which] = shaken.turns[which].map(|x| x + random.between(-by, by));
        }
        shaken
    }

    /// Converts the drawn solids to a case, with all lengths multiplied by `unit`.
    fn case<N: Scene<D>>(&self, unit: f64, request: ManifoldRequest<N>) -> Case<N, D> {
        let vector = |v: &Vector<f64, D>| v.map(|x| N::lit(x * unit));
        let poses = [0, 1].map(|at| N::pose(vector(&self.positions[at]), self.turns[at]));
        let solids = [0, 1].map(|at| {
            let radius = N::lit(self.radii[at] * unit);
            let ends = self.ends[at].map(|end| Point::from(vector(&end)));
            match self.sorts[at] {
                Sort::Ball => Solid::Ball(Ball::new(radius)),
                Sort::Segment => Solid::Segment(Segment::new(ends[0], ends[1])),
                Sort::Capsule => Solid::Capsule(
                    Capsule::try_from_ends(ends[0], ends[1], radius).expect("finite"),
                ),
                Sort::Cuboid => Solid::Cuboid(Cuboid::new(ends[1].coords.abs())),
            }
        });
        Case { poses, solids, request, is_pending: true }
    }
}

/// Draws 203 pairs of the given kinds, with lengths multiplied by `unit`, in four steps: the solids
/// move a little before the second and third step, and by up to 0.4 units before the fourth. Every
/// third pair starts on a grid, and one pair in eleven is not updated in a step.
fn drawn<N: Scene<D>, const D: usize>(
    (seed, unit): (u64, f64),
    sorts: [Sort; 2],
    request: &ManifoldRequest<N>,
) -> Vec<Vec<Case<N, D>>> {
    let mut random = Random(seed);
    let snaps = (0..203).map(|index| index % 3 == 0);
    let mut draws: Vec<_> = snaps.map(|snap| Draw::new(&mut random, sorts, snap)).collect();
    let mut steps = Vec::new();
    for (step, by) in [0.002, 0.002, 0.4, 0.0].into_iter().enumerate() {
        let scaled = ManifoldRequest { prediction: request.prediction * N::lit(unit), ..*request };
        let mut cases: Vec<_> = draws.iter().map(|draw| draw.case(unit, scaled)).collect();
        let rests = |index: usize| (index * 7 + step) % 11 == 3;
        cases.iter_mut().enumerate().for_each(|(index, case)| case.is_pending = !rests(index));
        steps.push(cases);
        draws = draws.iter().map(|draw| draw.shaken(&mut random, by)).collect();
    }
    steps
}

fn request<N: Real>(prediction: f64, sine: f64) -> ManifoldRequest<N> {
    ManifoldRequest { prediction: N::lit(prediction), sine: N::lit(sine), max_points: 4 }
}

/// Makes a case degenerate or invalid. The remainder of `number` by 7 selects one of these changes:
/// an entry of a translation becomes NaN, infinite, extreme or zero; an entry of a rotation becomes
/// NaN or infinite; a length of a solid becomes extreme or zero; the second pose becomes equal to
/// the first; or prediction and sine of the request change.
fn spoiled<N: Real, const D: usize>(case: &mut Case<N, D>, number: usize) {
    let strange = [N::lit(f64::NAN), N::INFINITY, -N::INFINITY, N::MAX, N::ZERO, N::MIN_POSITIVE];
    let value = strange[number / 7 % strange.len()];
    let (which, axis) = (number % 2, number / 2 % D);
    match number % 7 {
        0 => case.poses[which].translation[axis] = value,
        // A finite matrix that is no rotation may give another feature, so only NaN and infinity
        // are used.
        1 | 2 => {
            let strange = if value.is_finite_number() { N::lit(f64::NAN) } else { value };
            case.poses[which].rotation[(axis, number / 6 % D)] = strange;
        }
        3 => case.solids[which] = with_length(&case.solids[which], value),
        4 => case.solids[which] = with_length(&case.solids[which], N::ZERO),
        5 => case.poses[1] = case.poses[0],
        _ => {
            case.request.prediction = [N::ZERO, N::INFINITY, N::MAX][number / 7 % 3];
            case.request.sine = if number.is_multiple_of(4) { N::HALF } else { N::ZERO };
        }
    }
}

/// Returns a copy of a solid with another size: the radius of a ball, both lengths of a capsule, or
/// the second half extent of a box is `length`. A segment then ends on the second axis at that
/// height. A `length` that is negative or not finite counts as zero.
fn with_length<N: Real, const D: usize>(solid: &Solid<N, D>, length: N) -> Solid<N, D> {
    let is_length = length.is_finite_number() && length >= N::ZERO;
    let length = if is_length { length } else { N::ZERO };
    let mut end = Point::<N, D>::origin();
    end[1] = length;
    match solid {
        Solid::Ball(_) => Solid::Ball(Ball::new(length)),
        Solid::Segment(segment) => Solid::Segment(Segment::new(*segment.a(), end)),
        Solid::Capsule(_) => Solid::Capsule(Capsule::new(length, length)),
        Solid::Cuboid(cuboid) => {
            let mut half = *cuboid.half_extents();
            half[1] = length;
            Solid::Cuboid(Cuboid::new(half))
        }
    }
}

/// Compares batches with single pairs for one algorithm: random pairs for several angles of the
/// request, lengths in seven units, degenerate or invalid pairs, and batches of 0 to 19 pairs.
/// Asserts that there are contact points, that fewer than half of the random pairs fall back, and
/// that some degenerate pairs do (unless both solids are boxes).
fn check<F: Batch<N, D>, N: Scene<D> + Space<D>, const D: usize>(sorts: [Sort; 2]) {
    for (seed, sine) in [(1, 0.0), (2, 0.0), (3, 0.01), (4, 0.3)] {
        let steps = drawn::<N, D>((seed, 1.0), sorts, &request(0.3, sine));
        let [points, declined, begun] = compare::<F, N, D>(&steps, "drawn");
        assert!(points > 40, "{points} points, {sorts:?}");
        assert!(declined * 2 < begun, "{declined} of {begun} declined, {sorts:?}, {sine}");
    }
    for unit in [1e-30, 1e-15, 1e-4, 1e4, 1e12, 1e18, 1e30] {
        compare::<F, N, D>(&drawn((5, unit), sorts, &request(0.1, 0.0)), "in another unit");
    }
    for seed in 11..15 {
        let mut steps = drawn::<N, D>((seed, 1.0), sorts, &request(0.1, 0.0));
        for (number, case) in steps.iter_mut().flatten().enumerate() {
            spoiled(case, number + usize::try_from(seed).expect("small"));
        }
        let [_, declined, begun] = compare::<F, N, D>(&steps, "spoiled");
        let are_boxes = sorts == [Sort::Cuboid, Sort::Cuboid];
        assert!(are_boxes || declined * 20 > begun, "{declined} of {begun} declined, {sorts:?}");
    }
    let steps = drawn::<N, D>((21, 1.0), sorts, &request(0.1, 0.0));
    for count in (0..20).step_by(stride(3)) {
        let some: Vec<_> = steps.iter().map(|cases| cases[..count].to_vec()).collect();
        compare::<F, N, D>(&some, "some");
    }
}

fn balls<N: Scene<D> + Space<D>, const D: usize>() {
    check::<ClosedForm<BallBall>, N, D>([Sort::Ball, Sort::Ball]);
    check::<ClosedForm<BallCuboid>, N, D>([Sort::Ball, Sort::Cuboid]);
    check::<ClosedForm<BallSegment>, N, D>([Sort::Ball, Sort::Segment]);
    check::<ClosedForm<BallSegment>, N, D>([Sort::Ball, Sort::Capsule]);
}

#[test]
fn eight_pairs_with_balls_are_as_one() {
    balls::<f32, 2>();
    balls::<f32, 3>();
    {
        balls::<f64, 2>();
        balls::<f64, 3>();
    }
}

fn segments<F: Batch<N, D>, N: Scene<D> + Space<D>, const D: usize>() {
    check::<F, N, D>([Sort::Segment, Sort::Segment]);
    check::<F, N, D>([Sort::Segment, Sort::Capsule]);
    check::<F, N, D>([Sort::Capsule, Sort::Capsule]);
}

#[test]
fn eight_pairs_of_segments_are_as_one() {
    segments::<ClosedForm<Segments2>, f32, 2>();
    segments::<ClosedForm<Segments3>, f32, 3>();
    {
        segments::<ClosedForm<Segments2>, f64, 2>();
        segments::<ClosedForm<Segments3>, f64, 3>();
    }
}

fn boxes<F: Batch<N, D>, N: Scene<D> + Space<D>, const D: usize>() {
    for (seed, sine) in [(1, 0.0), (2, 0.01), (3, 0.3)] {
        for tilt in [0.005, 0.1, 3.0] {
            let steps = faced::<N, D>(seed, tilt, &request(0.1, sine));
            let [points, declined, begun] = compare::<F, N, D>(&steps, "faced");
            assert!(points > 200, "{points} points, tilt {tilt}");
            assert!(declined * 2 < begun, "{declined} of {begun} declined, tilt {tilt}");
        }
    }
    check::<F, N, D>([Sort::Cuboid, Sort::Cuboid]);
}

/// Draws 203 pairs of boxes with facing faces, at most 0.1 deep and 0.2 apart before rotation, in
/// three steps. The components of the rotation vector of each box are at most `tilt` radians in the
/// first step.
fn faced<N: Scene<D>, const D: usize>(
    seed: u64,
    tilt: f64,
    request: &ManifoldRequest<N>,
) -> Vec<Vec<Case<N, D>>> {
    let mut random = Random(seed);
    let mut draw = || {
        let mut draw = Draw::<D>::new(&mut random, [Sort::Cuboid, Sort::Cuboid], false);
        draw.turns = draw.turns.map(|turn| turn.map(|angle| angle * tilt / 3.0));
        let [half1, half2] = draw.ends.map(|ends| ends[1].abs());
        let gap = random.between(-0.1, 0.2);
        draw.positions[1] = draw.positions[0] + half1 * random.between(-0.5, 0.5);
        draw.positions[1][0] = draw.positions[0][0] + half1[0] + half2[0] + gap;
        draw
    };
    let mut draws: Vec<Draw<D>> = (0..203).map(|_| draw()).collect();
    let mut steps = Vec::new();
    for _ in 0..3 {
        steps.push(draws.iter().map(|draw| draw.case(1.0, *request)).collect());
        draws = draws.iter().map(|draw| draw.shaken(&mut random, 0.002)).collect();
    }
    steps
}

#[test]
fn eight_pairs_of_boxes_are_as_one() {
    boxes::<Boxes2, f32, 2>();
    boxes::<Boxes3, f32, 3>();
    {
        boxes::<Boxes2, f64, 2>();
        boxes::<Boxes3, f64, 3>();
    }
}
