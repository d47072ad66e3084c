//! Signed distance of two polytopes by trying every direction that can be the answer.
//!
//! The directions are those of the `f64` reference: normals of faces, perpendiculars of two edges,
//! and, unless the polytopes overlap, lines from corners to corners and edges. Each is made with all
//! digits and judged in `f64` first; whatever comes within rounding of the best is judged again with
//! all digits.

use super::number::Quad;
use super::solid::{Placed, height};
use super::topology::Topology;
use super::vector::{Vector, exact, negate, perpendicular, reject, rounded, sub, unit, zero};
use crate::geometry::vector as plain;

/// What `f64` may be wrong by in judging a direction, in parts of the size: generous.
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

    /// Normals of the faces; where there are none, some directions across the line or point.
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

/// The directions that may be the best.
struct Trial<const D: usize> {
    corners1: Vec<[f64; D]>,
    corners2: Vec<[f64; D]>,
    doubt: f64,
    best: f64,
    kept: Vec<(f64, Vector<D>)>,
}

impl<const D: usize> Trial<D> {
    /// Tries a direction and its opposite, at any length; skips the zero vector.
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

/// The signed distance of two polytopes and its unit normal.
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
    // Where the origin is well inside all faces of the difference, corners cannot matter.
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

/// The normals of the faces of the Minkowski difference.
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

/// The lines from the corners of one polytope to the corners and edges of the other.
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
                // Twice, as the first time leaves a rest of the size of the rounding of the offset.
                trial.line(&reject(&aside, &along));
            }
        }
    }
}
