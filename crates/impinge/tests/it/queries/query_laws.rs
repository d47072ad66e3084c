//! Tests laws that every pair of solids must satisfy, without expected results: for each pair of
//! kinds, in both orders, both dimensions and both scalars, from far apart to one inside the other.

use crate::support::query_support;
use crate::support::samples::samples;

use std::panic::{AssertUnwindSafe, catch_unwind};

use impinge::math::{AbstractRotation, Isometry, Pose, Real, Space, Vector, max};
use impinge::query::{
    ClosestPoints, Contact, Proximity, closest_points, contact, distance, proximity, time_of_impact,
};
use impinge::shape::ShapeKind;
use query_support::random::Random;
use query_support::samples::{PLANE, SPACE, Sample, sample2, sample3};
use query_support::{Placed, gap_along, signed};

/// Placement of the second solid.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Regime {
    /// At this signed distance from the first solid, in units of the size of the smaller solid.
    At(f64),
    /// With equal origins of both frames.
    Coincident,
}

const REGIMES: [Regime; 7] = [
    Regime::At(3.0),
    Regime::At(1e-2),
    Regime::At(1e-5),
    Regime::At(0.0),
    Regime::At(-1e-2),
    Regime::At(-0.5),
    Regime::Coincident,
];

/// Size of the second solid relative to the first.
const RATIOS: [f64; 8] = [1.0, 1.0, 0.1, 30.0, 1e-3, 1e3, 1e-6, 1e6];

/// Returns the number of seeds for each two kinds in each regime.
fn seeds() -> u64 {
    samples(2) as u64
}

/// Parameters of a pair.
#[derive(Clone, Copy, Debug)]
struct Setting {
    kinds: [ShapeKind; 2],
    regime: Regime,
    seed: u64,
    /// Size of the second solid relative to the first.
    ratio: f64,
    /// Scale of the random distance of the pair from the world's origin.
    offset: f64,
    /// Factor of all lengths.
    scale: f64,
    /// Whether half of the sizes and coordinates are zero.
    degenerate: bool,
}

/// Makes random solids and rotations of one dimension.
struct Maker<N: Real, R, const D: usize> {
    sample: Sample<N, D>,
    turn: fn(&mut Random) -> R,
}

impl<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize> Maker<N, R, D> {
    /// Makes the two solids of a setting. If two settings differ only in `scale`, their solids
    /// differ only by that factor.
    fn make(&self, setting: &Setting) -> [Placed<N, R, D>; 2] {
        let random = &mut Random(setting.seed, setting.degenerate);
        let scale = N::lit(setting.scale);
        let origin = random.vector::<N, D>() * N::lit(setting.offset) * scale;
        let shape1 = (self.sample)(setting.kinds[0], random, scale);
        let shape2 = (self.sample)(setting.kinds[1], random, scale * N::lit(setting.ratio));
        let pose1 = Isometry::from_parts(origin.into(), (self.turn)(random));
        let away = random.direction::<N, D>() * (scale * N::lit(4.0 * setting.ratio.max(1.0)));
        let pose2 = Isometry::from_parts((origin + away).into(), (self.turn)(random));
        let mut pair =
            [Placed { shape: shape1, pose: pose1 }, Placed { shape: shape2, pose: pose2 }];
        match setting.regime {
            Regime::Coincident => pair[1].pose = pair[0].pose.clone(),
            Regime::At(at) => bring_to(&mut pair, N::lit(at * setting.ratio.min(1.0)) * scale),
        }
        pair
    }
}

/// Returns the contact of a pair at any distance; `None` for two half-spaces that overlap without
/// bound.
fn contact_of<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    [solid1, solid2]: &[Placed<N, R, D>; 2],
) -> Option<Contact<N, D>> {
    contact(&solid1.pose, &*solid1.shape, &solid2.pose, &*solid2.shape, N::INFINITY)
}

/// Moves the second solid along the normal until the signed distance is about `target`. Does
/// nothing to a pair without a contact.
fn bring_to<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    pair: &mut [Placed<N, R, D>; 2],
    target: N,
) {
    if let Some(found) = contact_of(pair) {
        let step = found.normal.into_inner() * (found.depth + target);
        pair[1].pose.translation.vector += step;
    }
}

/// Returns the error allowed for a pair of kinds, relative to their size.
///
/// Next to a solid a million times smaller, the faces of the larger one have directions known only
/// up to a rounding error a million times as large.
fn precision<N: Real, const D: usize>(setting: &Setting) -> N {
    let ratio = setting.ratio.max(1.0 / setting.ratio);
    max(of_alike::<N, D>(setting), N::EPSILON * N::lit(ratio))
}

/// Returns the error allowed for solids of similar sizes.
fn of_alike<N: Real, const D: usize>(setting: &Setting) -> N {
    let kinds = setting.kinds;
    let curved = |kind| matches!(kind, ShapeKind::Cylinder | ShapeKind::Cone);
    let ball = kinds.contains(&ShapeKind::Ball) || kinds.contains(&ShapeKind::Plane);
    if kinds.into_iter().any(curved) && !ball {
        // In a curved solid around a much smaller solid, all directions are nearly equally good,
        // and the general algorithm reaches its limit of iterations.
        let swallowed = setting.regime == Regime::Coincident && (setting.ratio - 1.0).abs() > 0.99;
        let relative = if swallowed { 1e-6 } else { 1e-9 };
        // In `f32` this is about 1e-4.
        return max(N::EPSILON * N::lit(1024.0), N::lit(relative));
    }
    // The generating line of a tapered capsule and the edge of a flat solid are kinks, at which the
    // general algorithm stops a little earlier.
    if kinds.contains(&ShapeKind::TaperedCapsule) && D == 3 && !ball {
        return max(N::EPSILON * N::lit(128.0), N::lit(2e-11));
    }
    let closed = |kind| matches!(kind, ShapeKind::Segment | ShapeKind::Capsule);
    if D == 2 || ball || kinds.into_iter().all(closed) {
        return N::EPSILON * N::lit(128.0);
    }
    max(N::EPSILON * N::lit(128.0), N::lit(1e-12))
}

/// Asserts that all distance queries of a pair agree, in both orders, and that limits are
/// inclusive.
fn check<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    setting: &Setting,
    pair: &[Placed<N, R, D>; 2],
) {
    let [(m1, g1), (m2, g2)] = [&pair[0], &pair[1]].map(|solid| (&solid.pose, &*solid.shape));
    let Some(found) = contact_of(pair) else {
        assert_eq!(setting.kinds, [ShapeKind::Plane; 2], "only planes have no contact {setting:?}");
        assert_eq!(distance(m1, g1, m2, g2), N::ZERO, "planes that overlap {setting:?}");
        assert_eq!(proximity(m1, g1, m2, g2, N::ZERO), Proximity::Intersecting, "{setting:?}");
        return;
    };
    let signed = -found.depth;
    let swapped = contact(m2, g2, m1, g1, N::INFINITY).map(|swapped| swapped.flipped());
    // For equal solids at the same pose both orders are the same query and give one result; the
    // rotations of balls make no difference.
    let are_balls = setting.kinds == [ShapeKind::Ball; 2];
    let at_one_place = setting.regime == Regime::Coincident
        || (are_balls && m1.translation.vector == m2.translation.vector);
    let same = at_one_place && format!("{g1:?}") == format!("{g2:?}");
    if !same {
        assert_eq!(swapped, Some(found), "swapped {setting:?}");
    }
    let apart = distance(m1, g1, m2, g2);
    assert_eq!(apart, max(signed, N::ZERO), "distance {setting:?}");
    assert_eq!(distance(m2, g2, m1, g1), apart, "distance swapped {setting:?}");
    assert_eq!(contact(m1, g1, m2, g2, signed), Some(found), "at the limit {setting:?}");
    let closer = signed - signed.abs() * N::EPSILON - N::MIN_POSITIVE;
    assert_eq!(contact(m1, g1, m2, g2, closer), None, "below the limit {setting:?}");
    let touching = signed <= N::ZERO;
    let (near, nearest) = if touching {
        (Proximity::Intersecting, ClosestPoints::Intersecting)
    } else {
        (Proximity::WithinMargin, ClosestPoints::WithinMargin(found.world1, found.world2))
    };
    assert_eq!(proximity(m1, g1, m2, g2, apart), near, "{setting:?}");
    assert_eq!(closest_points(m1, g1, m2, g2, apart), nearest, "{setting:?}");
    let flipped = closest_points(m2, g2, m1, g1, apart).flipped();
    assert_eq!(flipped, nearest, "swapped {setting:?}");
    if !touching {
        assert_eq!(proximity(m1, g1, m2, g2, closer), Proximity::Disjoint, "{setting:?}");
        assert_eq!(closest_points(m1, g1, m2, g2, closer), ClosestPoints::Disjoint, "{setting:?}");
    }
    check_geometry(setting, pair, &found);
}

/// Asserts that the points, the normal and the depth of a contact are consistent.
fn check_geometry<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    setting: &Setting,
    pair: &[Placed<N, R, D>; 2],
    found: &Contact<N, D>,
) {
    let normal = found.normal.into_inner();
    let noise = precision::<N, D>(setting) * (pair[0].extent() + pair[1].extent());
    assert!((normal.norm() - N::ONE).abs() < N::EPSILON * N::lit(32.0), "unit {setting:?}");
    let off = (found.world1 - normal * found.depth - found.world2).norm();
    assert!(off <= noise, "the points are off by {off} {setting:?}");
    if setting.kinds.contains(&ShapeKind::Plane) {
        return;
    }
    let certified = gap_along(&pair[0], &pair[1], &normal);
    assert!(certified >= -found.depth - noise, "{certified} of {} {setting:?}", -found.depth);
    let random = &mut Random(setting.seed ^ 0x5eed, false);
    for _ in 0..40 {
        let other = gap_along(&pair[0], &pair[1], &random.direction());
        assert!(other <= -found.depth + noise, "{other} above {} {setting:?}", -found.depth);
    }
}

/// Asserts that the solids touch after a motion along the normal by slightly less than the depth,
/// and are apart after slightly more.
fn check_toggle<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    setting: &Setting,
    pair: &[Placed<N, R, D>; 2],
) {
    let Some(found) = contact_of(pair) else { return };
    let noise = precision::<N, D>(setting) * (pair[0].extent() + pair[1].extent());
    // A solid with sharp tips may miss the other by rounding, so two such solids are not tested.
    let sharpness = |kind: &ShapeKind| match kind {
        ShapeKind::Segment | ShapeKind::Triangle | ShapeKind::Cone => 2,
        ShapeKind::Polytope => 1,
        _ => 0,
    };
    // A solid no larger than the rounding error of the other may miss it too.
    let is_lost = N::lit(setting.ratio.min(1.0)) < N::lit(16.0) * noise;
    let sharp = setting.kinds.iter().map(sharpness).sum::<i32>() + if is_lost { 3 } else { 0 };
    let slack = if sharp > 0 { noise } else { noise / N::lit(4.0) };
    let moved = |side: N| {
        let mut pose = pair[1].pose.clone();
        pose.translation.vector += found.normal.into_inner() * (found.depth + side * noise);
        distance(&pair[0].pose, &*pair[0].shape, &pose, &*pair[1].shape)
    };
    assert!(moved(N::TWO) > N::ZERO, "apart {setting:?}");
    let together = moved(-N::TWO);
    assert!(sharp > 2 || together <= slack, "{together} not together {setting:?}");
}

/// Asserts that scaling all lengths by a power of two scales the results exactly.
fn check_scaled<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
    setting: &Setting,
    pair: &[Placed<N, R, D>; 2],
) {
    let found = contact_of(pair);
    for power in [20, -20] {
        let scale = 2.0_f64.powi(power);
        let mut scaled = maker.make(&Setting { scale: setting.scale * scale, ..*setting });
        let by = N::lit(scale);
        for (small, large) in pair.iter().zip(&mut scaled) {
            large.pose.translation.vector = small.pose.translation.vector * by;
        }
        let expected = found.map(|found| Contact {
            world1: found.world1 * by,
            world2: found.world2 * by,
            normal: found.normal,
            depth: found.depth * by,
        });
        assert_eq!(contact_of(&scaled), expected, "2^{power} {setting:?}");
        let v = [Random(setting.seed, false).vector::<N, D>(), Random(1, false).vector::<N, D>()];
        assert_eq!(impact(&scaled, &v.map(|v| v * by)), impact(pair, &v), "2^{power} {setting:?}");
    }
}

fn impact<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    [solid1, solid2]: &[Placed<N, R, D>; 2],
    [v1, v2]: &[Vector<N, D>; 2],
) -> Option<N> {
    time_of_impact(&solid1.pose, v1, &*solid1.shape, &solid2.pose, v2, &*solid2.shape)
}

/// Asserts that a common rotation and translation of both solids changes the signed distance by
/// rounding only.
fn check_moved<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
    setting: &Setting,
    mut pair: [Placed<N, R, D>; 2],
) {
    let before = signed(&pair[0], &pair[1]);
    let random = &mut Random(setting.seed, setting.degenerate);
    let turn = (maker.turn)(random);
    let shift = random.vector::<N, D>() * N::lit(setting.scale);
    for solid in &mut pair {
        let moved = turn.transform_vector(&solid.pose.translation.vector) + shift;
        solid.pose.translation.vector = moved;
        solid.pose.rotation = turn.clone() * solid.pose.rotation.clone();
    }
    let after = signed(&pair[0], &pair[1]);
    let noise = precision::<N, D>(setting) * (pair[0].extent() + pair[1].extent());
    let same = before == after || (before - after).abs() <= noise;
    assert!(same, "{before} becomes {after} {setting:?}");
}

/// Asserts that a moving pair does not touch before the time of impact and touches at it. Returns
/// `true` if there is an impact.
fn check_impact<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    setting: &Setting,
    pair: &[Placed<N, R, D>; 2],
) -> bool {
    let random = &mut Random(setting.seed ^ 7, false);
    let mut v = [random.vector::<N, D>(), random.vector::<N, D>()];
    // In half of the cases the first solid moves towards the second.
    if setting.seed.is_multiple_of(2) {
        v[0] = (pair[1].pose.translation.vector - pair[0].pose.translation.vector) + v[0];
    }
    let found = impact(pair, &v);
    let swapped = time_of_impact(
        &pair[1].pose,
        &v[1],
        &*pair[1].shape,
        &pair[0].pose,
        &v[0],
        &*pair[0].shape,
    );
    assert_eq!(found, swapped, "swapped {setting:?}");
    if signed(&pair[0], &pair[1]) <= N::ZERO {
        // A pair in contact at the start has an impact, at time zero, for some velocities only;
        // `queries/impact.rs` tests which.
        assert!(found.is_none_or(|time| time == N::ZERO), "touching at the start {setting:?}");
        return found.is_some();
    }
    let at = |time: N| {
        let placed = |index: usize| {
            let mut pose = pair[index].pose.clone();
            pose.translation.vector += v[index] * time;
            pose
        };
        let (pose1, pose2) = (placed(0), placed(1));
        let found = contact(&pose1, &*pair[0].shape, &pose2, &*pair[1].shape, N::INFINITY);
        found.map_or(-N::INFINITY, |found| -found.depth)
    };
    let speed = (v[0] - v[1]).norm();
    let end = found.unwrap_or_else(|| N::lit(8.0 * setting.ratio.max(1.0)) / speed);
    let noise = precision::<N, D>(setting) * (pair[0].extent() + pair[1].extent() + speed * end);
    for step in 0..20 {
        let time = end * N::lit(f64::from(step) / 20.0);
        let before = at(time);
        // For two solids that graze each other the distance is a better measure than the time.
        let is_early = before > -noise || (end - time) * speed < noise;
        assert!(is_early, "{before} before the end {setting:?}");
    }
    assert!(found.is_none() || at(end) <= noise, "{} at the end {setting:?}", at(end));
    found.is_some()
}

/// Asserts that no law is violated for any pair of kinds in any regime.
fn laws<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    kinds: &[ShapeKind],
    maker: &Maker<N, R, D>,
) {
    let (mut hits, mut shots) = (0, 0);
    let (mut settings, mut broken) = (0, 0);
    let pairs = kinds.iter().flat_map(|k1| kinds.iter().map(move |k2| (*k1, *k2)));
    for (first, (kind1, kind2)) in (0..).zip(pairs) {
        // There are few seeds, but each pair of kinds begins at a different seed, so that all pairs
        // together cover all ratios.
        let own = first..first + seeds();
        let all = REGIMES.iter().flat_map(|r| own.clone().map(move |seed| (*r, seed)));
        for (regime, seed) in all {
            let ratio = RATIOS[usize::try_from(seed % 8).expect("small")];
            let base = Setting {
                kinds: [kind1, kind2],
                regime,
                seed,
                ratio,
                offset: 0.0,
                scale: 1.0,
                degenerate: false,
            };
            let mut all = || {
                let pair = maker.make(&base);
                check(&base, &pair);
                check_toggle(&base, &pair);
                check_scaled(maker, &base, &pair);
                if !base.kinds.contains(&ShapeKind::Plane) && regime == Regime::At(1e-2) {
                    shots += 1;
                    hits += u32::from(check_impact(&base, &pair));
                }
                check_moved(maker, &base, pair);
                let far = Setting { offset: 1e6, ..base };
                check(&far, &maker.make(&far));
                let flat = Setting { degenerate: true, ..base };
                let pair = maker.make(&flat);
                check(&flat, &pair);
                check_scaled(maker, &flat, &pair);
                check_moved(maker, &flat, pair);
            };
            broken += u32::from(catch_unwind(AssertUnwindSafe(&mut all)).is_err());
            settings += 1;
        }
    }
    assert_eq!(broken, 0, "of {settings} settings");
    assert!(hits * 10 > shots * 3 && hits * 10 < shots * 7, "{hits} of {shots} shots hit");
}

#[test]
fn plane_f32() {
    laws::<f32, _, 2>(&PLANE, &Maker { sample: sample2, turn: Random::turn2 });
}

#[test]
fn plane_f64() {
    laws::<f64, _, 2>(&PLANE, &Maker { sample: sample2, turn: Random::turn2 });
}

#[test]
fn space_f32() {
    laws::<f32, _, 3>(&SPACE, &Maker { sample: sample3, turn: Random::turn3 });
}

#[test]
fn space_f64() {
    laws::<f64, _, 3>(&SPACE, &Maker { sample: sample3, turn: Random::turn3 });
}

#[test]
fn poses_that_are_not_finite_touch_nothing() {
    let maker = Maker::<f32, _, 3> { sample: sample3, turn: Random::turn3 };
    for (kind1, kind2) in SPACE.iter().flat_map(|k1| SPACE.iter().map(move |k2| (*k1, *k2))) {
        let kinds = [kind1, kind2];
        let setting = Setting {
            kinds,
            regime: Regime::At(0.0),
            seed: 3,
            ratio: 1.0,
            offset: 0.0,
            scale: 1.0,
            degenerate: false,
        };
        let mut pair = maker.make(&setting);
        pair[0].pose.translation.vector.x = f32::NAN;
        assert!(!Pose::from_isometry(&pair[0].pose).is_finite(), "not a place");
        let [(m1, g1), (m2, g2)] = [&pair[0], &pair[1]].map(|solid| (&solid.pose, &*solid.shape));
        let v = Vector::<f32, 3>::x();
        assert_eq!(contact(m1, g1, m2, g2, 1.0), None, "{kinds:?}");
        assert_eq!(distance(m1, g1, m2, g2), f32::INFINITY, "{kinds:?}");
        assert_eq!(proximity(m1, g1, m2, g2, 1.0), Proximity::Disjoint, "{kinds:?}");
        assert_eq!(closest_points(m1, g1, m2, g2, 1.0), ClosestPoints::Disjoint, "{kinds:?}");
        assert_eq!(time_of_impact(m1, &v, g1, m2, &-v, g2), None, "{kinds:?}");
    }
}
