//! Which normals a height field has at a face, an edge or a vertex: found from the heights around.

use super::HeightField;
use super::sheet::GridPoint;
use crate::math::{Point, Real, Vector, max, max_component, perp, unit, unit_or};
use crate::shape::bend::Bend;
use crate::shape::seam::{Seam, is_across, leads_up_clearly, slack};
use crate::shape::tri_mesh::{inward_of, normal_of};
use crate::shape::{FeatureId, Surface};

impl<N: Real> Surface<N, 3> for HeightField<N, 3> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, 3>) -> bool {
        let front = self.front_of(&self.corners(part));
        if self.keeps_internal_edges {
            return !self.is_one_sided || front.dot(normal) >= -slack::<N>();
        }
        let own = self.snapped(part, normal);
        own.is_some_and(|own| max_component(&(own - normal)) <= slack())
            || match feature {
                FeatureId::Face(_) => own.is_none(),
                FeatureId::Edge(side) => self.edge_admits(part, side as usize, normal),
                FeatureId::Vertex(corner) => self.vertex_admits(part, corner as usize, normal),
            }
    }

    fn snapped(&self, part: u32, normal: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let front = self.front_of(&self.corners(part));
        let is_front = self.is_one_sided || front.dot(normal) >= N::ZERO;
        let own = if is_front { front } else { -front };
        (front != Vector::<N, 3>::zeros()).then_some(own)
    }

    fn faces(&self, part: u32, center: &Point<N, 3>) -> bool {
        let corners = self.corners(part);
        let [row, column] = corners[0];
        let is_behind =
            || self.front_of(&corners).dot(&(center - self.grid.point(row, column))) < N::ZERO;
        !(self.is_one_sided && is_behind())
    }
}

impl<N: Real> HeightField<N, 3> {
    fn points_of(&self, corners: &[GridPoint; 3]) -> [Point<N, 3>; 3] {
        corners.map(|[row, column]| self.grid.point(row, column))
    }

    /// The unit normal on the front of a triangle; zero without area.
    fn front_of(&self, corners: &[GridPoint; 3]) -> Vector<N, 3> {
        normal_of(&self.points_of(corners))
    }

    /// The corners of the triangles around a point of the grid: eight at most, without the holes.
    fn around_point(&self, [row, column]: GridPoint) -> impl Iterator<Item = [GridPoint; 3]> + '_ {
        let [rows, columns] = self.pyramid.cells();
        // One cell before and one after, of those that there are.
        let cells = [(1, 1), (1, 0), (0, 1), (0, 0)].into_iter().filter_map(move |(up, left)| {
            let cell = (row.checked_sub(up)?, column.checked_sub(left)?);
            Some(cell).filter(|&(row, column)| row < rows && column < columns)
        });
        let parts = cells.flat_map(|(row, column)| [(row, column, 0), (row, column, 1)]);
        let rest = parts.filter(|&(row, column, k)| !self.is_hole_in(row, column, k));
        let corners = rest.map(|(row, column, k)| self.corners_in(row, column, k));
        corners.filter(move |corners| corners.contains(&[row, column]))
    }

    fn edge_admits(&self, part: u32, side: usize, normal: &Vector<N, 3>) -> bool {
        let own = self.corners(part);
        let (a, b, c) = (own[side % 3], own[(side + 1) % 3], own[(side + 2) % 3]);
        let [start, end] = [a, b].map(|[row, column]| self.grid.point(row, column));
        let others = || self.around_point(a).filter(|other| other.contains(&b) && *other != own);
        if let (Some(other), None) = (others().next(), others().nth(1)) {
            let points = [own, other].map(|corners| self.points_of(&corners));
            let bend = Bend::new(points.each_ref(), points.each_ref().map(normal_of));
            if let Some(answer) = bend.and_then(|bend| bend.admits(normal, self.is_one_sided)) {
                return answer;
            }
        }
        let mut seam = Seam::of_faces(self.front_of(&own), normal);
        let mut add = |corners: &[GridPoint; 3], [row, column]: GridPoint| {
            if let Some(inward) = inward_of(&[start, end, self.grid.point(row, column)]) {
                seam.add_face(inward.dot(normal), &self.front_of(corners));
            }
        };
        add(&own, c);
        for other in others() {
            if let Some(&opposite) = other.iter().find(|corner| **corner != a && **corner != b) {
                add(&other, opposite);
            }
        }
        is_across(&(end - start), normal) && seam.admits(self.is_one_sided)
    }

    fn vertex_admits(&self, part: u32, corner: usize, normal: &Vector<N, 3>) -> bool {
        let own = self.corners(part);
        let at = own[corner % 3];
        let point = |[row, column]: GridPoint| self.grid.point(row, column);
        let rises = |other: &GridPoint| leads_up_clearly(&(point(*other) - point(at)), normal);
        if self.around_point(at).any(|corners| corners.iter().any(rises)) {
            return false;
        }
        let mut seam = Seam::of_faces(self.front_of(&own), normal);
        for corners in self.around_point(at) {
            seam.add_face(self.rise_from(at, &corners, normal), &self.front_of(&corners));
        }
        seam.admits(self.is_one_sided)
    }

    /// How much the steeper of the two sides of a triangle that leave a corner rises along a unit
    /// vector.
    fn rise_from(&self, at: GridPoint, corners: &[GridPoint; 3], normal: &Vector<N, 3>) -> N {
        let point = |[row, column]: GridPoint| self.grid.point(row, column);
        let others = corners.iter().filter(|&&corner| corner != at);
        let rises = others.map(|&other| unit_or(&(point(other) - point(at)), -normal).dot(normal));
        rises.fold(-N::ONE, max)
    }
}

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

impl<N: Real> HeightField<N, 2> {
    /// Unit, along a segment; `None` without length.
    fn along(&self, part: u32) -> Option<Vector<N, 2>> {
        let index = part as usize;
        unit(&(self.point(index + 1) - self.point(index))).map(|(along, _)| along)
    }

    /// The unit normal on the front of a segment; `None` without length.
    fn front(&self, part: u32) -> Option<Vector<N, 2>> {
        let left = perp(&self.along(part)?);
        Some(if self.is_mirrored() { -left } else { left })
    }

    /// How far a vector leads in front of a segment; zero where there is no front and back.
    fn height_over(&self, part: u32, vector: &Vector<N, 2>) -> N {
        let front = self.front(part).filter(|_| self.is_one_sided);
        front.map_or(N::ZERO, |front| front.dot(vector))
    }

    /// No segment that leaves the point rises along the normal, and they are not straight.
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
