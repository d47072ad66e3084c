//! Tests height fields: points and parts, searches against a scan of all parts, and edited fields
//! against new ones.

use crate::support::part_search;

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Real, Space, Vector};
use impinge::shape::{
    CompositeShape, Diagonal, Diagonals, HeightField, Shape, ShapeError, Triangle,
};
use impinge_reference::random::Random;
use part_search::{Boxes, coarse};

fn heights<N: Real>(random: &mut Random, count: usize) -> Vec<N> {
    (0..count).map(|_| N::lit(coarse(random))).collect()
}

fn scale3<N: Real>(x: f64, y: f64, z: f64) -> Vector<N, 3> {
    Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

fn scale2<N: Real>(x: f64, y: f64) -> Vector<N, 2> {
    Vector::<N, 2>::new(N::lit(x), N::lit(y))
}

fn corners<N: Space<D>, const D: usize>(
    field: &dyn CompositeShape<N, D>,
    part: u32,
) -> [Point<N, D>; 3] {
    let part = part as usize;
    let part = field.part(u32::try_from(part).expect("small"));
    *part.solid.as_shape().as_shape::<Triangle<N, D>>().expect("a triangle").corners()
}

#[test]
fn bad_numbers_are_refused_by_name() {
    type Field = HeightField<f64, 3>;
    let unit = scale3(1.0, 1.0, 1.0);
    let refused = |rows, columns, heights, scale| {
        Field::try_new(rows, columns, heights, scale).expect_err("they make no field")
    };
    let few = ShapeError::TooFewHeights { given: 1, needed: 2 };
    assert_eq!(refused(1, 5, vec![0.0; 5], unit), few, "one row");
    assert_eq!(refused(5, 1, vec![0.0; 5], unit), few, "one column");
    let count = ShapeError::WrongHeightCount { given: 5, needed: 6 };
    assert_eq!(refused(2, 3, vec![0.0; 5], unit), count, "a height is missing");
    let mut heights = vec![0.0; 6];
    heights[4] = f64::NAN;
    let bad = ShapeError::HeightNotFinite { row: 1, column: 1 };
    assert_eq!(refused(2, 3, heights.clone(), unit), bad, "NaN");
    heights[4] = 1e200;
    assert_eq!(refused(2, 3, heights, scale3(1.0, 1e200, 1.0)), bad, "not finite once scaled");
    let scale = refused(2, 3, vec![0.0; 6], scale3(1.0, f64::INFINITY, 1.0));
    assert!(matches!(scale, ShapeError::NotFinite { .. }), "{scale}");
    assert_eq!(bad.to_string(), "the height at row 1, column 1 is not finite", "in words");

    let line = HeightField::<f64, 2>::try_new(vec![0.0, 1.0, f64::INFINITY], scale2(1.0, 1.0));
    let bad = ShapeError::HeightNotFinite { row: 0, column: 2 };
    assert_eq!(line.expect_err("infinite"), bad, "in the plane");
    assert!(HeightField::<f64, 2>::try_new(vec![0.0], scale2(1.0, 1.0)).is_err(), "one height");

    let mut field = Field::new(2, 3, vec![0.0; 6], unit);
    assert!(field.set_height(1, 2, f64::NAN).is_err(), "an edit too");
    assert_eq!(field.height(1, 2), 0.0, "and nothing was changed");
    assert!(field.set_heights(vec![1.0; 5]).is_err(), "too few");
    assert_eq!(field.heights(), [0.0; 6], "and nothing was changed");
}

#[test]
fn points_lie_where_the_scale_puts_them() {
    let field =
        HeightField::<f32, 3>::new(2, 3, vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0], scale3(8.0, 2.0, 6.0));
    assert_eq!(field.point(0, 0), Point::<f32, 3>::new(-4.0, 0.0, -3.0), "the first");
    assert_eq!(field.point(0, 1), Point::<f32, 3>::new(0.0, 2.0, -3.0), "columns go along x");
    assert_eq!(field.point(1, 2), Point::<f32, 3>::new(4.0, 10.0, 3.0), "the last");
    assert_eq!(field.height_at(-2.0, -3.0), Some(1.0), "between two columns");
    assert_eq!(field.height_at(-4.0, 0.0), Some(3.0), "between two rows");
    assert_eq!(field.height_at(4.5, 0.0), None, "beside");
    assert_eq!(field.height_at(f32::NAN, 0.0), None, "nowhere");
    assert_eq!(field.local_aabb().maxs(), &Point::<f32, 3>::new(4.0, 10.0, 3.0), "the box");

    let line = HeightField::<f32, 2>::new(vec![1.0, 3.0, -1.0], scale2(4.0, 0.5));
    assert_eq!(line.point(2), Point::<f32, 2>::new(2.0, -0.5), "the last");
    assert_eq!(line.height_at(-1.0), Some(1.0), "half way");
    assert_eq!(line.local_aabb().mins(), &Point::<f32, 2>::new(-2.0, -0.5), "the box");
    // A line is symmetric to the last digit, even where 0.7 / 7 rounds.
    let thirds = HeightField::<f32, 2>::new(vec![0.0; 8], scale2(0.7, 1.0));
    for index in 0..8 {
        assert_eq!(thirds.point(index).x, -thirds.point(7 - index).x, "line {index}");
    }
}

/// Asserts that the two triangles of a cell cover it once, are counter-clockwise seen from the
/// front, and share the diagonal, also if a scale is negative.
#[test]
fn triangles_cover_their_cell_under_every_scale() {
    let signs = [1.0, -1.0];
    for (x, y, z) in
        signs.iter().flat_map(|x| signs.iter().flat_map(move |y| signs.map(|z| (*x, *y, z))))
    {
        for diagonals in [Diagonals::Forward, Diagonals::Backward, Diagonals::Zigzag] {
            let heights = vec![0.5, 1.0, 0.25, 0.0, 2.0, 1.0, 0.75, 0.0, 1.0];
            let field = HeightField::<f64, 3>::new(3, 3, heights, scale3(2.0 * x, y, 4.0 * z));
            let field = field.with_diagonals(diagonals);
            for cell in 0..4_u32 {
                let mut area = 0.0;
                for part in [2 * cell, 2 * cell + 1] {
                    let [a, b, c] = corners(&field, part);
                    let normal = (b - a).cross(&(c - a));
                    assert!(normal.y * y > 0.0, "front of {part} under {x} {y} {z}");
                    area += normal.y.abs() / 2.0;
                }
                assert_eq!(area, 2.0, "cell {cell} under {x} {y} {z}");
                let (row, column) = (cell as usize / 2, cell as usize % 2);
                let ends = match field.diagonal(row, column) {
                    Diagonal::Forward => {
                        [field.point(row, column), field.point(row + 1, column + 1)]
                    }
                    Diagonal::Backward => {
                        [field.point(row, column + 1), field.point(row + 1, column)]
                    }
                };
                for part in [2 * cell, 2 * cell + 1] {
                    assert!(
                        ends.iter().all(|end| corners(&field, part).contains(end)),
                        "diagonal of {part}"
                    );
                }
                // The first triangle of a cell contains the side of the cell on the lower column.
                for row in [row, row + 1] {
                    assert!(
                        corners(&field, 2 * cell).contains(&field.point(row, column)),
                        "cell {cell}"
                    );
                }
            }
        }
    }
}

#[test]
fn zigzag_alternates_and_cells_may_differ() {
    let mut field = HeightField::<f32, 3>::new(3, 4, vec![0.0; 12], scale3(1.0, 1.0, 1.0))
        .with_diagonals(Diagonals::Zigzag);
    let of = |field: &HeightField<f32, 3>| {
        [0, 1].map(|row| [0, 1, 2].map(|column| field.diagonal(row, column) == Diagonal::Backward))
    };
    assert_eq!(of(&field), [[false, true, false], [true, false, true]], "a chessboard");
    field.set_diagonal(1, 1, Diagonal::Backward);
    field.set_diagonal(0, 0, Diagonal::Forward);
    assert_eq!(of(&field), [[false, true, false], [true, true, true]], "but for one");
    field.set_diagonal(1, 1, Diagonal::Forward);
    assert_eq!(of(&field), [[false, true, false], [true, false, true]], "and back");
}

fn field3<N: Real>(
    random: &mut Random,
    [rows, columns]: [usize; 2],
    scale: Vector<N, 3>,
) -> HeightField<N, 3> {
    let pattern = [Diagonals::Forward, Diagonals::Backward, Diagonals::Zigzag][random.below(3)];
    let heights = heights(random, rows * columns);
    HeightField::<N, 3>::new(rows, columns, heights, scale).with_diagonals(pattern)
}

fn check_in_space<N: Space<3>>() {
    let mut random = Random::new(71);
    let scales = [
        (4.0, 1.0, 4.0),
        (-40.0, 3.0, 0.5),
        (1e6, 10.0, -1e6),
        (1e-3, -1.0, 1e-3),
        (3.0, 0.0, 3.0),
    ];
    let (mut hits, mut misses) = (0, 0);
    for (x, y, z) in scales {
        for size in [[2, 2], [2, 9], [6, 3], [9, 9], [20, 31]] {
            let mut field = field3::<N>(&mut random, size, scale3(x, y, z));
            for part in 0..field.num_parts() {
                if random.below(4) == 0 {
                    field.set_part_hole(part, true);
                }
            }
            field.set_part_hole(0, false);
            let boxes = Boxes::new(&field, |part| !field.is_hole(part));
            let found = boxes.check(field.search(), &mut random, 40);
            hits += found.hits;
            misses += found.misses;
        }
    }
    assert!(hits > 200 && misses > 100, "{hits} hits, {misses} misses");
}

#[test]
fn searches_in_space_find_what_looking_at_all_parts_finds() {
    check_in_space::<f32>();
    check_in_space::<f64>();
}

fn check_in_plane<N: Space<2>>() {
    let mut random = Random::new(72);
    let (mut hits, mut misses) = (0, 0);
    for (x, y) in [(4.0, 1.0), (-40.0, 3.0), (1e6, -10.0), (1e-3, 1e3), (3.0, 0.0)] {
        for count in [2, 3, 8, 33, 300] {
            let heights = heights(&mut random, count);
            let mut field = HeightField::<N, 2>::new(heights, scale2(x, y));
            for cell in 1..field.num_cells() {
                if random.below(4) == 0 {
                    field.set_hole(cell, true);
                }
            }
            let boxes = Boxes::new(&field, |part| !field.is_hole(part));
            let found = boxes.check(field.search(), &mut random, 40);
            hits += found.hits;
            misses += found.misses;
        }
    }
    assert!(hits > 200 && misses > 100, "{hits} hits, {misses} misses");
}

#[test]
fn searches_in_the_plane_find_what_looking_at_all_parts_finds() {
    check_in_plane::<f32>();
    check_in_plane::<f64>();
}

/// Asserts that searches with boxes that have infinite faces, such as those of half-spaces, find
/// parts, and that boxes without a finite point find none.
#[test]
fn unbounded_probes_meet_and_infinite_ones_do_not() {
    let field = HeightField::<f32, 3>::new(2, 2, vec![0.0, 0.0, 0.0, 1.0], scale3(2.0, 1.0, 2.0));
    let (infinity, p) = (f32::INFINITY, Point::<f32, 3>::new);
    let below = Aabb::new(p(-infinity, -infinity, -infinity), p(infinity, -0.5, infinity));
    assert_eq!(part_search::overlapping(field.search(), &below), [0_u32; 0], "half a unit below");
    let mut bounds = Vec::new();
    field.nearest_bounds(&below, &mut bounds);
    assert!(
        bounds.iter().all(|bound| *bound <= 0.5 && *bound > 0.4999) && bounds.len() == 2,
        "{bounds:?}"
    );
    let everything = Aabb::<f32, 3>::unbounded();
    assert_eq!(part_search::overlapping(field.search(), &everything), [0, 1], "all");

    let nowhere = Aabb::new(p(infinity, 0.0, 0.0), p(infinity, 0.0, 0.0));
    field.search().nearest(&nowhere, infinity, &mut |part, _| panic!("near part {part}"));
    let origin = Aabb::new(p(0.0, 0.0, 0.0), p(0.0, 0.0, 0.0));
    for speed in [f32::NAN, infinity] {
        let velocity = Vector::<f32, 3>::new(speed, 0.0, 0.0);
        field.search().cast(&origin, &velocity, infinity, &mut |part, _| panic!("met part {part}"));
    }
    // A negative or NaN limit ends the search.
    for limit in [-1.0, f32::NAN] {
        let mut count = 0;
        field.search().nearest(&everything, infinity, &mut |_, _| {
            count += 1;
            limit
        });
        assert_eq!(count, 1, "after {limit}");
    }
}

trait NearestBounds {
    fn nearest_bounds(&self, aabb: &Aabb<f32, 3>, out: &mut Vec<f32>);
}

impl NearestBounds for HeightField<f32, 3> {
    fn nearest_bounds(&self, aabb: &Aabb<f32, 3>, out: &mut Vec<f32>) {
        self.search().nearest(aabb, f32::INFINITY, &mut |_, bound| {
            out.push(bound);
            f32::INFINITY
        });
    }
}

#[test]
fn edits_give_the_field_that_would_be_made_anew() {
    let mut random = Random::new(73);
    let (rows, columns) = (7, 10);
    let mut field = field3::<f64>(&mut random, [rows, columns], scale3(9.0, 1.0, 6.0));
    let mut holes = vec![false; 2 * (rows - 1) * (columns - 1)];
    for round in 0..200 {
        let (row, column) = (random.below(rows), random.below(columns));
        field.set_height(row, column, 4.0 * coarse(&mut random)).expect("finite");
        let part = random.below(holes.len());
        holes[part] = round < 150 && !holes[part];
        field.set_part_hole(u32::try_from(part).expect("few"), holes[part]);
        let way = if random.below(2) == 0 { Diagonal::Forward } else { Diagonal::Backward };
        field.set_diagonal(random.below(rows - 1), random.below(columns - 1), way);
        if round % 20 == 0 {
            let boxes = Boxes::new(&field, |part| !holes[part as usize]);
            let around = field.local_aabb();
            assert_eq!(
                (around.mins().y, around.maxs().y),
                (boxes.around.mins().y, boxes.around.maxs().y),
                "round {round}"
            );
            boxes.check(field.search(), &mut random, 20);
        }
    }
    let mut line = HeightField::<f32, 2>::new(heights(&mut random, 21), scale2(9.0, 1.0));
    for round in 0..100 {
        line.set_height(random.below(21), 4.0 * f32::lit(coarse(&mut random))).expect("finite");
        line.set_hole(1 + random.below(19), round % 3 == 0);
        if round % 20 == 0 {
            let boxes = Boxes::new(&line, |part| !line.is_hole(part));
            boxes.check(line.search(), &mut random, 20);
        }
    }
}

#[test]
fn a_field_of_holes_is_empty() {
    let field = HeightField::<f32, 3>::new(3, 3, vec![5.0; 9], scale3(2.0, 1.0, 2.0))
        .with_holes(|_, _| true);
    assert_eq!(part_search::overlapping(field.search(), &Aabb::unbounded()), [0_u32; 0], "no part");
    assert_eq!(field.local_aabb().half_extents(), Vector::<f32, 3>::zeros(), "a point");
    assert_eq!(field.num_parts(), 8, "numbers stay");
    let [a, _, _] = corners(&field, 3);
    assert_eq!(a.y, 5.0, "and so does what would be there");
    let back = field.with_holes(|row, column| row == column);
    assert_eq!(
        part_search::overlapping(back.search(), &Aabb::unbounded()),
        [2, 3, 4, 5],
        "two cells"
    );
    let line = HeightField::<f32, 2>::new(vec![1.0, 2.0], scale2(1.0, 1.0)).with_holes(|_| true);
    assert_eq!(
        part_search::overlapping(line.search(), &Aabb::unbounded()),
        [0_u32; 0],
        "in the plane"
    );
    assert_eq!(line.segment(0), None, "no segment");
}

#[test]
fn neighbours_share_a_point_of_the_grid() {
    let mut random = Random::new(74);
    let field = field3::<f64>(&mut random, [4, 5], scale3(4.0, 1.0, 3.0));
    for (part1, part2) in (0..24).flat_map(|a| (0..24).map(move |b| (a, b))) {
        let (own, other) = (corners(&field, part1), corners(&field, part2));
        let share = own.iter().any(|corner| other.contains(corner));
        assert_eq!(field.are_adjacent(part1, part2), share, "{part1} and {part2}");
    }
    let line = HeightField::<f64, 2>::new(vec![0.0; 5], scale2(1.0, 1.0));
    assert!(
        line.are_adjacent(1, 2) && line.are_adjacent(2, 1) && !line.are_adjacent(0, 2),
        "in a row"
    );
}

#[test]
fn a_large_field_is_made_and_searched_at_once() {
    let count = 1000;
    let wave =
        |index: usize| f32::from(u8::try_from((index * 31 + index / 999) % 200).expect("small"));
    let heights: Vec<f32> = (0..count * count).map(wave).collect();
    let start = std::time::Instant::now();
    let field = HeightField::<f32, 3>::new(count, count, heights, scale3(1000.0, 0.01, 1000.0));
    let made = start.elapsed();
    // A search with a box over ten by ten cells, which have 200 triangles, visits at most 100
    // others.
    let aabb =
        Aabb::new(Point::<f32, 3>::new(20.0, -1.0, 20.0), Point::<f32, 3>::new(30.0, 3.0, 30.0));
    let found = part_search::overlapping(field.search(), &aabb);
    assert!((200..=300).contains(&found.len()), "{} parts", found.len());
    // A vertical ray visits one cell, or the cells around a point.
    let ray = Aabb::new(Point::<f32, 3>::new(0.3, 50.0, 0.3), Point::<f32, 3>::new(0.3, 50.0, 0.3));
    let mut met = 0;
    field.search().cast(
        &ray,
        &Vector::<f32, 3>::new(0.0, -1.0, 0.0),
        f32::INFINITY,
        &mut |_, _| {
            met += 1;
            f32::INFINITY
        },
    );
    assert!((1..=8).contains(&met), "{met} parts");
    // This limit is many times the usual time, yet far below the time of an algorithm quadratic in
    // the cells.
    assert!(made.as_secs() < 5, "{made:?}");
}
