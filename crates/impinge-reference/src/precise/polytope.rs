//! Signed distance of two polytopes by testing every candidate direction.
//!
//! The candidates are those of `geometry/polytope.rs`: face normals, perpendiculars of two edges,
//! and, unless the polytopes overlap deeply, lines from corners to corners and edges. Each
//! direction is computed with all digits, and its height first in `f64`. Directions within the
//! `f64` error of the best are then compared with all digits.

use super::number::Quad;
use super::solid::{Placed, height};
use super::topology::Topology;
use super::vector::{Vector, exact, negate, perpendicular, reject, rounded, sub, unit, zero};
use crate::geometry::vector as plain;

/// A generous bound of the error of a height in `f64`, relative to the size of the pair.
const DOUBT: f64 = 1e-13;

/// A placed polytope.
pub(super) struct Polytope<'a, const D: usize> {
    pub(super) parts: &'a [Placed<D>],
    pub(super) topology: &'a Topology<D>,
}

impl<const D: usize> Polytope<'_, D> {
    fn corner(&self, index: usize) -> &Vector<D> {
        &self.parts[index].center
    }

    fn edges(&self) -> impl Iterator<Item = (&Vector<D>, Vector<D>)> {
        let along = |[i, j]: [usize; 2]| sub(self.corner(j), self.corner(i));
        self.topology.edges.iter().map(move |&ends| (self.corner(ends[0]), along(ends)))
    }

    /// Returns the face normals, of any length. If there are no faces: for points on a line, some
    /// directions perpendicular to the line; for a single point, all axes.
    fn normals(&self) -> Vec<Vector<D>> {
        let axes = (0..D).map(|i| exact(&plain::axis::<D>(i)));
        if !self.topology.faces.is_empty() {
            let span = |face: &[usize; D]| -> Vec<Vector<D>> {
                face[1..].iter().map(|&k| sub(self.corner(k), self.corner(face[0]))).collect()
            };
            return self.topology.faces.iter().map(|face| perpendicular(&span(face))).collect();
        }
        match self.edges().next() {
            Some((_, along)) => axes.map(|axis| perpendicular(&[along, axis])).collect(),
            None => axes.collect(),
        }
    }
}

/// The candidate directions that may be the best, with their heights in `f64`.
struct Trial<const D: usize> {
    corners1: Vec<[f64; D]>,
    corners2: Vec<[f64; D]>,
    doubt: f64,
    best: f64,
    kept: Vec<(f64, Vector<D>)>,
}

impl<const D: usize> Trial<D> {
    /// Tests a direction of any length and its opposite; ignores the zero vector.
    fn line(&mut self, direction: &Vector<D>) {
        let Some(normal) = plain::unit(&rounded(direction)) else { return };
        let (least1, greatest1) = interval(&self.corners1, &normal);
        let (least2, greatest2) = interval(&self.corners2, &normal);
        self.offer(least2 - greatest1, direction);
        self.offer(least1 - greatest2, &negate(direction));
    }

    fn offer(&mut self, height: f64, direction: &Vector<D>) {
        if height >= self.best - self.doubt {
            self.best = self.best.max(height);
            self.kept.push((height, *direction));
        }
    }
}

fn interval<const D: usize>(corners: &[[f64; D]], normal: &[f64; D]) -> (f64, f64) {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for corner in corners {
        let height = plain::dot(corner, normal);
        range = (range.0.min(height), range.1.max(height));
    }
    range
}

/// Returns the signed distance of two polytopes and its unit normal.
pub(super) fn distance<const D: usize>(
    one: &Polytope<'_, D>,
    two: &Polytope<'_, D>,
    size: f64,
) -> (Quad, Vector<D>) {
    let corners = |polytope: &Polytope<'_, D>| {
        polytope.parts.iter().map(|part| rounded(&part.center)).collect::<Vec<_>>()
    };
    let mut trial = Trial {
        corners1: corners(one),
        corners2: corners(two),
        doubt: DOUBT * size,
        best: f64::NEG_INFINITY,
        kept: Vec::new(),
    };
    try_face_directions(&mut trial, one, two);
    // If the origin is well inside all faces of the difference, directions from corners cannot be
    // the best.
    if trial.best >= -1e-12 * size {
        try_corner_directions(&mut trial, one, two);
    }
    best_of(&trial, one, two)
}

fn best_of<const D: usize>(
    trial: &Trial<D>,
    one: &Polytope<'_, D>,
    two: &Polytope<'_, D>,
) -> (Quad, Vector<D>) {
    let mut best: Option<(Quad, Vector<D>)> = None;
    for (rough, direction) in &trial.kept {
        if *rough < trial.best - trial.doubt {
            continue;
        }
        let Some(normal) = unit(direction) else { continue };
        let found = height(one.parts, two.parts, &normal);
        if best.is_none_or(|(most, _)| found > most) {
            best = Some((found, normal));
        }
    }
    best.unwrap_or((Quad::ZERO, zero()))
}

/// Tests the normals of the faces of the Minkowski difference.
fn try_face_directions<const D: usize>(
    trial: &mut Trial<D>,
    one: &Polytope<'_, D>,
    two: &Polytope<'_, D>,
) {
    one.normals().iter().chain(&two.normals()).for_each(|normal| trial.line(normal));
    for (_, edge1) in one.edges() {
        for (_, edge2) in two.edges() {
            trial.line(&perpendicular(&[edge1, edge2]));
        }
    }
}

/// Tests the lines from the corners of one polytope to the corners and edges of the other.
fn try_corner_directions<const D: usize>(
    trial: &mut Trial<D>,
    one: &Polytope<'_, D>,
    two: &Polytope<'_, D>,
) {
    for part1 in one.parts {
        for part2 in two.parts {
            trial.line(&sub(&part2.center, &part1.center));
        }
    }
    for (corners, other) in [(one.parts, two), (two.parts, one)] {
        for part in corners {
            for (start, along) in other.edges() {
                let aside = reject(&sub(&part.center, start), &along);
                // Rejected twice: the first result still has a component along the edge, as large
                // as the rounding error of the offset.
                trial.line(&reject(&aside, &along));
            }
        }
    }
}
