//! The seam rule of height fields: the normals admitted at a face, an edge or a vertex, computed
//! from the neighbouring heights.

use smallvec::SmallVec;

use super::HeightField;
use super::marks::Diagonal;
use super::triangles::GridPoint;
use crate::math::{Mapped, Point, Real, Vector, max, max_component, perp, unit, unit_or};
use crate::shape::composite::tri_mesh::{inward_of, normal_of};
use crate::shape::surface::bend::Bend;
use crate::shape::surface::own_surface::OwnSurface;
use crate::shape::surface::seam::{CornerEdges, Seam, is_across, slack};
use crate::shape::surface::sidedness::Joining;
use crate::shape::{FaceSeams, FeatureId, Sidedness, Surface};

impl<N: Real> Surface<N, 3> for HeightField<N, 3> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, 3>) -> bool {
        let own = FieldFace::of(self, self.corners(part));
        self.face_admits(&own, &mut Beside::unknown(), feature, normal)
    }

    fn snapped(&self, part: u32, normal: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        self.snapped_to(&self.front_of(&self.corners(part)), normal)
    }

    fn faces(&self, part: u32, center: &Point<N, 3>) -> bool {
        let is_behind = || {
            let corners = self.corners(part);
            let [row, column] = corners[0];
            self.front_of(&corners).dot(&(center - self.grid.point(row, column))) < N::ZERO
        };
        !(self.is_one_sided && is_behind())
    }
}

impl<N: Real> OwnSurface<N, 3> for HeightField<N, 3> {
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        [first, second]: [&Vector<N, 3>; 2],
    ) -> [bool; 2] {
        let (own, mut beside) = (FieldFace::of(self, self.corners(part)), Beside::unknown());
        let is_first = self.face_admits(&own, &mut beside, feature, first);
        [is_first, !is_first && self.face_admits(&own, &mut beside, feature, second)]
    }

    fn corner_admits_in_turn(
        &self,
        part: u32,
        corner: usize,
        known: &FaceSeams<N>,
        normals: [&Vector<N, 3>; 2],
    ) -> [bool; 2] {
        if self.keeps_internal_edges {
            return self.admits_in_turn(part, FeatureId::Vertex([0, 1, 2][corner]), normals);
        }
        let (at, mut star) = (self.corners(part)[corner], None);
        let own = (&known.front, known.is_bent_at(corner));
        let is_first = self.point_admits_from(at, &mut star, own, normals[0]);
        [is_first, !is_first && self.point_admits_from(at, &mut star, own, normals[1])]
    }

    fn face_seams(&self, part: u32) -> Option<FaceSeams<N>> {
        let own = FieldFace::of(self, self.corners(part));
        let has_seams = !self.keeps_internal_edges && own.front != Vector::<N, 3>::zeros();
        let bend = |side| Fold::at(self, &own, side).bend;
        // All front normals of a field point up, or all point down, so the fronts of neighbours
        // agree.
        has_seams.then(|| FaceSeams::new(own.front, self.is_one_sided, bend, |_| true))
    }

    /// Returns true if internal edges are not kept and grid points certainly do not coincide; see
    /// `Grid::has_extent`.
    fn has_regular_seams(&self) -> bool {
        !self.keeps_internal_edges && self.grid.has_extent()
    }

    /// Visits the triangles of the ghosts among the eight cells around the cell of the part.
    fn each_ghost_beside(&self, part: u32, visit: &mut dyn FnMut(u32)) {
        if !self.marks.has_ghosts() {
            return;
        }
        let ([row, column], ..) = self.locate(part);
        let [rows, columns] = self.pyramid.cells();
        let ends = |at: usize, count: usize| at.saturating_sub(1)..count.min(at + 2);
        let around = ends(row, rows)
            .flat_map(|row| ends(column, columns).map(move |column| row * columns + column));
        for cell in around.filter(|cell| self.marks.is_ghost(*cell)) {
            let first = u32::try_from(2 * cell).expect("32 bits number the triangles");
            visit(first);
            visit(first + 1);
        }
    }
}

/// A triangle at a corner of a cell: its index in the cell, then its two other corners, as indices
/// of the cell's corners.
type FanTriangle = (usize, usize, usize);

/// For each corner of a cell, the triangles at that corner. The corners a, b, c, d have the indices
/// 0 to 3. The first table is for a forward diagonal, the second for a backward diagonal; see
/// `corners_in`.
const FANS: [[&[FanTriangle]; 4]; 2] = [
    [&[(0, 1, 2), (1, 2, 3)], &[(0, 2, 0)], &[(0, 0, 1), (1, 3, 0)], &[(1, 0, 2)]],
    [&[(0, 1, 3)], &[(0, 3, 0), (1, 2, 3)], &[(1, 3, 1)], &[(0, 0, 1), (1, 1, 2)]],
];

/// A triangle of a field, with its grid points and positions.
struct FieldFace<N: Real> {
    corners: [GridPoint; 3],
    points: [Point<N, 3>; 3],
    /// The unit normal on the front; zero for a triangle without area.
    front: Vector<N, 3>,
}

impl<N: Real> FieldFace<N> {
    fn of(field: &HeightField<N, 3>, corners: [GridPoint; 3]) -> Self {
        let points = field.points_of(&corners);
        Self { corners, points, front: normal_of(&points) }
    }

    /// Returns the corner opposite the side with the ends `ends`. The ends must be corners of the
    /// triangle; otherwise the result is the first corner that is not an end.
    fn beyond(&self, ends: &[GridPoint; 2]) -> Option<Point<N, 3>> {
        let at = self.corners.iter().position(|corner| !ends.contains(corner))?;
        Some(self.points[at])
    }
}

/// The neighbours of one feature of a triangle: the triangle across a side, or the triangles around
/// a corner. Each is computed on first use.
struct Beside<N: Real> {
    fold: Option<Fold<N>>,
    star: Option<Star<N>>,
}

impl<N: Real> Beside<N> {
    const fn unknown() -> Self {
        Self { fold: None, star: None }
    }
}

/// A side of a triangle, with the triangle across it.
struct Fold<N: Real> {
    ends: [GridPoint; 2],
    /// The triangle across, and the edge angle between the two triangles if it is certain.
    other: Option<FieldFace<N>>,
    bend: Option<Bend<N>>,
}

impl<N: Real> Fold<N> {
    fn at(field: &HeightField<N, 3>, own: &FieldFace<N>, side: usize) -> Self {
        let ends = [own.corners[side % 3], own.corners[(side + 1) % 3]];
        let other = field.across(&own.corners, ends).map(|corners| FieldFace::of(field, corners));
        let bend = other
            .as_ref()
            .and_then(|other| Bend::new([&own.points, &other.points], [own.front, other.front]));
        Self { ends, other, bend }
    }
}

impl<N: Real> HeightField<N, 3> {
    fn points_of(&self, corners: &[GridPoint; 3]) -> [Point<N, 3>; 3] {
        let point = |[row, column]: GridPoint| self.grid.point(row, column);
        [point(corners[0]), point(corners[1]), point(corners[2])]
    }

    /// Returns the unit normal on the front of a triangle; zero for a triangle without area.
    fn front_of(&self, corners: &[GridPoint; 3]) -> Vector<N, 3> {
        normal_of(&self.points_of(corners))
    }

    fn snapped_to(&self, front: &Vector<N, 3>, normal: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let is_front = self.is_one_sided || front.dot(normal) >= N::ZERO;
        let own = if is_front { *front } else { -front };
        (*front != Vector::<N, 3>::zeros()).then_some(own)
    }

    /// Returns the triangles, including ghosts but not holes, of the cells in `cells`. A cell is
    /// given by its row plus one and its column plus one; 0 is outside the field.
    fn in_cells(
        &self,
        cells: impl Iterator<Item = GridPoint>,
    ) -> impl Iterator<Item = [GridPoint; 3]> {
        let [rows, columns] = self.pyramid.cells();
        let cells = cells.filter_map(move |[row, column]| {
            let cell = (row.checked_sub(1)?, column.checked_sub(1)?);
            Some(cell).filter(|&(row, column)| row < rows && column < columns)
        });
        let parts = cells.flat_map(|(row, column)| [(row, column, 0), (row, column, 1)]);
        let rest = parts.filter(|&(row, column, k)| !self.is_hole_in(row, column, k));
        rest.map(|(row, column, k)| self.corners_in(row, column, k))
    }

    /// Calls `visit` for each triangle at a grid point, at most 8, until a call returns true; skips
    /// holes. Passes the other two corners of the triangle, counter-clockwise seen from the front.
    fn each_around(&self, at: GridPoint, mut visit: impl FnMut([GridPoint; 2]) -> bool) {
        let [rows, columns] = self.pyramid.cells();
        // The four cells around the point, and the index of the point among the corners of each
        // cell.
        for (row, column, own) in [(1, 1, 2), (1, 0, 1), (0, 1, 3), (0, 0, 0)] {
            let cell = (at[0].wrapping_sub(row), at[1].wrapping_sub(column));
            if cell.0 >= rows || cell.1 >= columns {
                continue;
            }
            let corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
            let corner = |number: usize| {
                let [row, column] = corners[number];
                [cell.0 + row, cell.1 + column]
            };
            let forward = self.marks.diagonal([cell.0, cell.1], columns) == Diagonal::Forward;
            for &(k, next, last) in FANS[usize::from(!forward)][own] {
                let others = [corner(next), corner(last)];
                let others = if self.is_mirrored() { [others[1], others[0]] } else { others };
                if !self.is_hole_in(cell.0, cell.1, k) && visit(others) {
                    return;
                }
            }
        }
    }

    /// Returns the triangle across the side between `a` and `b`; `None` at the border or beside a
    /// hole.
    fn across(&self, own: &[GridPoint; 3], [a, b]: [GridPoint; 2]) -> Option<[GridPoint; 3]> {
        let (row, column) = (a[0].min(b[0]), a[1].min(b[1]));
        // The triangle across a side along a row or column lies in the cell before or after; across
        // a diagonal it lies in the same cell.
        let before = [row + usize::from(a[0] != b[0]), column + usize::from(a[1] != b[1])];
        let after = [row + 1, column + 1];
        let [first, second, third] = own;
        let least = |at: usize| first[at].min(second[at]).min(third[at]) + 1;
        let beyond = if before == [least(0), least(1)] { after } else { before };
        self.in_cells([beyond].into_iter())
            .find(|other| other.contains(&a) && other.contains(&b) && other != own)
    }

    /// Returns whether the field admits `normal` at a feature of a triangle. `beside` keeps the
    /// neighbourhood of the feature between calls.
    fn face_admits(
        &self,
        own: &FieldFace<N>,
        beside: &mut Beside<N>,
        feature: FeatureId,
        normal: &Vector<N, 3>,
    ) -> bool {
        if self.keeps_internal_edges {
            return !self.is_one_sided || own.front.dot(normal) >= -slack::<N>();
        }
        let snapped = self.snapped_to(&own.front, normal);
        snapped.is_some_and(|snapped| max_component(&(snapped - normal)) <= slack())
            || match feature {
                FeatureId::Face(_) => snapped.is_none(),
                FeatureId::Edge(side) => {
                    let fold =
                        beside.fold.get_or_insert_with(|| Fold::at(self, own, side as usize));
                    self.edge_admits(own, fold, side as usize, normal)
                }
                FeatureId::Vertex(corner) => {
                    self.vertex_admits(own, &mut beside.star, corner as usize, normal)
                }
            }
    }

    /// Returns whether the field admits `normal` at a side of a triangle; uses the cached edge
    /// angle if it is certain.
    fn edge_admits(
        &self,
        own: &FieldFace<N>,
        fold: &Fold<N>,
        side: usize,
        normal: &Vector<N, 3>,
    ) -> bool {
        let Fold { ends, other, bend } = fold;
        if let Some(answer) = bend.and_then(|bend| bend.admits(normal, self.is_one_sided)) {
            return answer;
        }
        let [start, end] = [own.points[side % 3], own.points[(side + 1) % 3]];
        let mut seam = Seam::of_faces(own.front, normal).along(&(end - start));
        for face in [Some(own), other.as_ref()].into_iter().flatten() {
            let inward = face.beyond(ends).and_then(|tip| inward_of(&[start, end, tip]));
            if let Some(inward) = inward {
                seam.add_face(|direction| inward.dot(direction), &face.front);
            }
        }
        is_across(&(end - start), normal) && seam.admits(self.is_one_sided)
    }

    /// Returns whether the field admits `normal` at a corner of a triangle; `normal` is not the
    /// normal of that triangle.
    fn vertex_admits(
        &self,
        own: &FieldFace<N>,
        star: &mut Option<Star<N>>,
        corner: usize,
        normal: &Vector<N, 3>,
    ) -> bool {
        self.point_admits_from(own.corners[corner % 3], star, (&own.front, false), normal)
    }

    /// Returns whether the field admits `normal` at a grid point; `normal` is not the normal of the
    /// queried triangle. `own` has the front normal of that triangle, and whether another triangle
    /// at the point is known not to be coplanar with it.
    fn point_admits_from(
        &self,
        at: GridPoint,
        star: &mut Option<Star<N>>,
        own: (&Vector<N, 3>, bool),
        normal: &Vector<N, 3>,
    ) -> bool {
        let known = self.edges_around(at, normal).admit(own, self.is_one_sided);
        known.unwrap_or_else(|| {
            let star = star.get_or_insert_with(|| self.star_of(at));
            let mut seam = Seam::of_faces(*own.0, normal);
            for StarFace { edges, front } in star {
                seam.add_face(|along| max(rise(&edges[0], along), rise(&edges[1], along)), front);
            }
            seam.admits(self.is_one_sided)
        })
    }

    /// Collects the sides that leave a grid point; stops when they reject `normal`.
    fn edges_around<'n>(&self, at: GridPoint, normal: &'n Vector<N, 3>) -> CornerEdges<'n, N, 3> {
        let (mut edges, [row, column]) = (CornerEdges::new(normal), at);
        let point = self.grid.point(row, column);
        self.each_around(at, |others| {
            for [row, column] in others {
                edges.add(&(self.grid.point(row, column) - point));
            }
            edges.is_refused()
        });
        edges
    }

    /// Returns the triangles around a grid point.
    fn star_of(&self, at: GridPoint) -> Star<N> {
        let (mut star, [row, column]) = (Star::new(), at);
        let point = self.grid.point(row, column);
        self.each_around(at, |others| {
            let [next, last] = others.mapped(|[row, column]| self.grid.point(row, column));
            let unit_edge =
                |other: &Point<N, 3>| unit_or(&(other - point), Vector::<N, 3>::zeros());
            let edges = [unit_edge(&next), unit_edge(&last)];
            star.push(StarFace { edges, front: normal_of(&[point, next, last]) });
            false
        });
        star
    }
}

/// A triangle at a grid point: the unit vectors along its two sides that leave the point (zero for
/// a side without length), and its front normal.
struct StarFace<N: Real> {
    edges: [Vector<N, 3>; 2],
    front: Vector<N, 3>,
}

/// Returns the component of the unit vector `edge` along the unit vector `along`. Returns −1, the
/// least possible component, if `edge` is zero.
fn rise<N: Real>(edge: &Vector<N, 3>, along: &Vector<N, 3>) -> N {
    if *edge == Vector::<N, 3>::zeros() { -N::ONE } else { edge.dot(along) }
}

/// The triangles around a grid point.
type Star<N> = SmallVec<[StarFace<N>; 8]>;

impl<N: Real> Surface<N, 2> for HeightField<N, 2> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, 2>) -> bool {
        if self.keeps_internal_edges {
            return self.height_over(part, normal) >= -slack::<N>();
        }
        let own = self.along(part).map(|along| along.dot(normal).abs() <= slack());
        let is_own = own.is_none_or(|own| own) && self.height_over(part, normal) >= N::ZERO;
        match feature {
            FeatureId::Vertex(end) if own != Some(true) => {
                self.point_admits(part, part as usize + end as usize, normal)
            }
            _ => is_own,
        }
    }

    fn snapped(&self, part: u32, normal: &Vector<N, 2>) -> Option<Vector<N, 2>> {
        let front = self.front(part)?;
        let is_front = self.is_one_sided || front.dot(normal) >= N::ZERO;
        Some(if is_front { front } else { -front })
    }

    fn faces(&self, part: u32, center: &Point<N, 2>) -> bool {
        self.height_over(part, &(center - self.point(part as usize))) >= N::ZERO
    }
}

impl<N: Real> OwnSurface<N, 2> for HeightField<N, 2> {
    fn sidedness(&self) -> Option<Sidedness> {
        let (is_one_sided, keeps_internal_edges) = (self.is_one_sided, self.keeps_internal_edges);
        let (is_left, follows_front) = (!self.is_mirrored(), true);
        // The cached segments of a pair do not include ghosts, so the field itself is queried.
        let joining = if self.marks.has_ghosts() { Joining::Unknown } else { Joining::InRow };
        Some(Sidedness { is_left, is_one_sided, follows_front, keeps_internal_edges, joining })
    }

    fn each_ghost_beside(&self, part: u32, visit: &mut dyn FnMut(u32)) {
        if self.marks.has_ghosts() {
            let beside = part.saturating_sub(1)..=part + 1;
            let is_ghost = |cell: &u32| {
                (*cell as usize) < self.num_cells() && self.marks.is_ghost(*cell as usize)
            };
            beside.filter(is_ghost).for_each(visit);
        }
    }
}

impl<N: Real> HeightField<N, 2> {
    /// Returns the unit vector along a segment; `None` if the segment has no length.
    fn along(&self, part: u32) -> Option<Vector<N, 2>> {
        let index = part as usize;
        unit(&(self.point(index + 1) - self.point(index))).map(|(along, _)| along)
    }

    /// Returns the unit normal on the front of a segment; `None` if the segment has no length.
    fn front(&self, part: u32) -> Option<Vector<N, 2>> {
        let left = perp(&self.along(part)?);
        Some(if self.is_mirrored() { -left } else { left })
    }

    /// Returns the component of `vector` along the front normal of a segment. 0 if the field has
    /// two sides or the segment has no length.
    fn height_over(&self, part: u32, vector: &Vector<N, 2>) -> N {
        let front = self.front(part).filter(|_| self.is_one_sided);
        front.map_or(N::ZERO, |front| front.dot(vector))
    }

    /// Returns whether the grid point `index` admits `normal` ([`Seam::admits`]): the directions of
    /// both segments away from the point have components of at most zero along `normal`, the two
    /// segments are not collinear, and in a one-sided field the segment with the larger component
    /// has its front towards `normal`.
    fn point_admits(&self, part: u32, index: usize, normal: &Vector<N, 2>) -> bool {
        let own = self.along(part).unwrap_or_else(Vector::<N, 2>::zeros);
        let mut seam = Seam::of_segments(own, normal);
        let before = index.checked_sub(1).map(|cell| (cell, -N::ONE));
        for (cell, sign) in before.into_iter().chain([(index, N::ONE)]) {
            let is_there = cell < self.num_cells() && !self.marks.is_hole(cell, 0);
            let part = u32::try_from(cell).expect("32 bits number the segments");
            let Some(along) = is_there.then(|| self.along(part)).flatten() else { continue };
            seam.add_segment(&(along * sign), self.height_over(part, normal));
        }
        seam.admits(self.is_one_sided)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_normals_in_turn_are_as_each_alone() {
        let pseudo_random = |at: u32| f64::from((at * at * 31 + at * 7) % 97) / 97.0 - 0.5;
        let heights = (0..36).map(|at| 0.8 * pseudo_random(at)).collect();
        let field = HeightField::<f64, 3>::new(6, 6, heights, Vector::<f64, 3>::new(5.0, 1.0, 5.0));
        let mut counts = [0; 3];
        for (field, part) in [field.clone(), field.one_sided()]
            .iter()
            .flat_map(|field| (0..50_u32).map(move |part| (field, part)))
        {
            let front = field.front_of(&field.corners(part));
            for at in 0..60_u32 {
                let aside = Vector::<f64, 3>::new(
                    pseudo_random(at),
                    pseudo_random(at + 60),
                    pseudo_random(at + 120),
                );
                let far = (front + aside).normalize();
                let near = (front + aside * 0.03).normalize();
                let feature = [FeatureId::Edge(at / 3 % 3), FeatureId::Vertex(at % 3)];
                let feature = feature[at as usize % 2];
                let [first, second] = [far, near].map(|n| field.admits(part, feature, &n));
                let both = field.admits_in_turn(part, feature, [&far, &near]);
                assert_eq!(both, [first, !first && second], "part {part}, {feature:?}");
                counts[if first { 0 } else { 1 + usize::from(second) }] += 1;
            }
        }
        assert!(counts.iter().all(|&count| count > 100), "all cases occur: {counts:?}");
    }
}
