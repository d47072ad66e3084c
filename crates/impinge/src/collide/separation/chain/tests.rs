//! Asserts that the kernels for 8 segments return the same separations, to the bit, as the
//! algorithms for one pair, on every instruction set.

use super::*;
use crate::collide::Pair;
use crate::collide::separation::hulls::tests::Random;
use crate::collide::separation::polygons::polygon_polygon::tests::solid_of;
use crate::collide::separation::separation_2d;
use crate::shape::{Ball, Segment};

/// Returns one to sixteen random segments around `origin`, relative to it, and packets of these
/// segments in the frame of the chain.
fn segments_of<N: Real>(
    random: &mut Random,
    origin: &Vector<N, 2>,
) -> (Vec<Segment<N, 2>>, Vec<PartPacket<N, 2>>) {
    let count = 1 + random.pick(16);
    let mut corners = Vec::new();
    for _ in 0..count {
        let [a, b] = [(); 2].map(|()| Point::from(random.vector::<N>().xy() * N::TWO + origin));
        corners.push([a, b, b]);
    }
    let mut tiles = Vec::new();
    for some in corners.chunks(LANES) {
        let mut tile = PartPacket::blank();
        (0..LANES).for_each(|lane| tile.put(lane, &some[lane.min(some.len() - 1)]));
        tiles.push(tile);
    }
    (corners.iter().map(|[a, b, _]| Segment::new(a - origin, b - origin)).collect(), tiles)
}

fn compare<N: Real>(seed: u64) {
    let random = &mut Random(seed);
    let (mut found, mut decided, mut count) = (0, 0, 0);
    for round in 0..1500 {
        let kind = random.pick(6);
        let solid = solid_of::<N>(random, kind);
        let kind = solid.geometry().0;
        let comes_first = matches!(kind, Kind::Ball(_) | Kind::Segment(_));
        let turn = random.turn::<N>().rotation;
        let across = Vector::<N, 2>::new(turn.m11, turn.m21).normalize();
        let rotation = crate::math::Matrix::<N, 2>::new(across.x, -across.y, across.y, across.x);
        let pose12 = Pose { rotation, translation: Vector::<N, 2>::zeros() };
        let origin = random.vector::<N>().xy() * N::lit([0.0, 3.0, 300.0][round % 3]);
        let (segments, tiles) = segments_of(random, &origin);
        let limit = N::lit([0.0, 0.1, 1.0][round / 3 % 3]);
        let center = Point::from(origin);
        let count_of = segments.len();
        let question = ChainQuestion {
            tiles: &tiles,
            count: count_of,
            origin,
            solid: kind,
            pose12,
            center,
            limit,
        };
        let mut expected = Vec::new();
        for (index, segment) in segments.iter().enumerate() {
            let segment = Kind::Segment(segment);
            let (first, second) = if comes_first { (kind, segment) } else { (segment, kind) };
            let answer = separation_2d(&Pair { first, second, pose12 }, limit);
            expected.extend(answer.map(|answer| (index, answer)));
        }
        for level in Level::available() {
            let mut links = Links::new(N::INFINITY);
            count += 1;
            if links_at(level, &question, &mut links).is_some() {
                assert_eq!(links.found.as_slice(), expected, "{solid:?} in round {round}");
                assert!(links.from_middle < N::lit(4.0), "{}", links.from_middle);
                (decided, found) = (decided + 1, found + expected.len());
            }
        }
    }
    assert!(decided * 10 > count * 9, "{decided} of {count} are decided");
    assert!(found > decided, "{found} segments are found by {decided}");
}

#[test]
fn eight_segments_at_once_are_the_same() {
    compare::<f32>(3);
    compare::<f64>(4);
}

#[test]
fn segments_without_length_are_left_to_others() {
    let ball = Ball::new(1.0);
    let mut tile = PartPacket::<f32, 2>::blank();
    (1..LANES)
        .for_each(|lane| tile.put(lane, &[0.0, 1.0, 1.0].map(|x| Point::<f32, 2>::new(x, 2.0))));
    let mut question = ChainQuestion {
        tiles: &[tile.clone()],
        count: 8,
        origin: Vector::<f32, 2>::zeros(),
        solid: Kind::Ball(&ball),
        pose12: Pose::identity(),
        center: Point::origin(),
        limit: 2.0,
    };
    assert!(links(&question, &mut Links::new(9.0)).is_none(), "a point");
    tile.put(0, &[3.0, 4.0, 4.0].map(|x| Point::<f32, 2>::new(x, 0.5)));
    let (tiles, mut near) = ([tile], Links::new(9.0));
    question.tiles = &tiles;
    assert!(links(&question, &mut near).is_some(), "all have lengths");
    assert_eq!((near.from_middle, near.found.len()), (2.0, 7), "seven lie two above");
    let mut none = Links::new(9.0);
    question.pose12.translation.x = f32::NAN;
    assert!(links(&question, &mut none).is_none(), "no finite position");
}
