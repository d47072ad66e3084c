//! Builds the faces of a hull from its triangles: removes redundant vertices, and merges coplanar
//! triangles into polygons.

use super::lattice::area_vector;
use super::quickhull::{DOUBT, Facet, at};
use super::span::{Scaled, direction, distance_from_segment, precedes};
use crate::math::order::sort_keyed;
use crate::math::{Mapped, Point, Vector};

type P3 = Point<f64, 3>;

/// Returns whether the smaller of two neighboring triangles lies in the plane of the larger one,
/// within the tolerance.
fn is_flat(facet1: &Facet, facet2: &Facet, points: &Scaled<3>) -> bool {
    let is_first_larger = facet1.doubled_area >= facet2.doubled_area;
    let (large, small) = if is_first_larger { (facet1, facet2) } else { (facet2, facet1) };
    let mut far = small.corners.iter().filter(|&corner| !large.corners.contains(corner));
    far.all(|&corner| large.height(&points.points, corner).abs() <= points.flat())
}

/// Returns vertices whose removal changes the hull by at most `flat`; no two of them are adjacent.
/// Each lies on the segment between two neighbors or in the plane of all its neighbors.
pub(super) fn redundant(facets: &[Facet], scaled: &Scaled<3>) -> Vec<u32> {
    let points = &scaled.points;
    // For each vertex, one of its facets, and the number of its edges at which the surface bends.
    let mut around = vec![(0, 0_u32); points.len()];
    for (index, facet) in (0..).zip(facets) {
        for side in 0..3 {
            let [from, to] = [facet.corners[side], facet.corners[(side + 1) % 3]].mapped(at);
            let beyond = facet.neighbors[side];
            let turns = index < beyond && !is_flat(facet, &facets[at(beyond)], scaled);
            around[from].1 += u32::from(turns);
            around[to].1 += u32::from(turns);
            around[from].0 = index;
        }
    }
    // At a true corner the surface bends at three or more edges, unless slivers hide some of them.
    let candidates = (0..).zip(around).filter(|&(_, (_, turns))| turns <= 2);
    let (mut kept, mut redundant) = (Vec::new(), Vec::new());
    for (vertex, (facet, _)) in candidates {
        kept.resize(points.len(), false);
        if kept[at(vertex)] {
            continue;
        }
        let ring = ring_around(vertex, facet, facets);
        let neighbors = || ring.iter().map(|&neighbor| points[at(neighbor)]).collect::<Vec<P3>>();
        if ring.len() <= 64 && is_inside(&points[at(vertex)], &neighbors(), scaled.flat()) {
            redundant.push(vertex);
            ring.iter().for_each(|&neighbor| kept[at(neighbor)] = true);
        }
    }
    redundant
}

/// Returns the vertices adjacent to `vertex`, in ascending order of index. The walk around the
/// vertex starts at the facet `first`, which must have it as a corner.
fn ring_around(vertex: u32, first: u32, facets: &[Facet]) -> Vec<u32> {
    let (mut ring, mut facet) = (Vec::new(), first);
    loop {
        let Facet { corners, neighbors, .. } = &facets[at(facet)];
        let index = corners.iter().position(|&corner| corner == vertex);
        let index = index.expect("facets around a vertex have it as a corner");
        ring.push(corners[(index + 1) % 3]);
        facet = neighbors[(index + 2) % 3];
        if facet == first {
            break;
        }
    }
    ring.sort_unstable();
    ring
}

/// Returns whether a vertex lies, within `flat`, on the segment between two neighbors, or in one
/// plane with all its neighbors and surrounded by them.
fn is_inside(vertex: &P3, neighbors: &[P3], flat: f64) -> bool {
    let pairs =
        neighbors.iter().enumerate().flat_map(|(i, a)| neighbors[..i].iter().map(move |b| (a, b)));
    let is_amid = |normal: Vector<f64, 3>| {
        neighbors.iter().all(|p| normal.dot(&(p - vertex)).abs() <= flat)
            && is_surrounded(vertex, neighbors, &normal, flat)
    };
    pairs.clone().any(|(a, b)| distance_from_segment(vertex, a, b) <= flat)
        || widest_normal(vertex, pairs).is_some_and(is_amid)
}

/// Returns whether, projected along `normal`, every line through the vertex and a neighbor has
/// other neighbors on both sides, farther from the line than `flat`. False at the rim of a solid
/// that is almost as thin as rounding errors: all neighbors lie in one plane, but on one side of
/// the vertex.
fn is_surrounded(vertex: &P3, neighbors: &[P3], normal: &Vector<f64, 3>, flat: f64) -> bool {
    neighbors.iter().all(|to| {
        let across = normal.cross(&(to - vertex));
        let (side, least) = (|p: &P3| across.dot(&(p - vertex)), flat * across.norm());
        neighbors.iter().any(|p| side(p) < -least) && neighbors.iter().any(|p| side(p) > least)
    })
}

/// Returns the unit normal of the largest triangle of a vertex and two of its neighbors; `None` if
/// none has an area.
fn widest_normal<'a>(
    vertex: &P3,
    pairs: impl Iterator<Item = (&'a P3, &'a P3)>,
) -> Option<Vector<f64, 3>> {
    let normals = pairs.map(|(a, b)| (a - vertex).cross(&(b - vertex)));
    let widest =
        normals.reduce(|best, n| if n.norm_squared() > best.norm_squared() { n } else { best })?;
    direction(&widest).map(|(normal, _)| normal)
}

/// The faces of a hull. The vertices of all faces are in one list.
#[derive(Default)]
pub(super) struct FaceRings {
    /// For each face, the outward unit normal of its largest triangle. The hull has no point in
    /// front of that triangle; smaller triangles of the face may deviate from its plane within the
    /// tolerance.
    pub(super) normals: Vec<Vector<f64, 3>>,
    /// The vertices of each face, counter-clockwise from outside, starting at the lowest vertex in
    /// order of coordinates.
    pub(super) corners: Vec<u32>,
    /// For each face, the end index of its vertices in `corners`.
    ends: Vec<usize>,
}

impl FaceRings {
    fn with_capacity(faces: usize) -> Self {
        let (normals, ends) = (Vec::with_capacity(faces), Vec::with_capacity(faces));
        Self { normals, corners: Vec::with_capacity(3 * faces), ends }
    }

    /// Appends a face with the normal of a facet. The normal is recomputed exactly, unless the
    /// points were `f32`, whose rounding is far coarser than the error of the facet's normal.
    fn push(&mut self, scaled: &Scaled<3>, seed: &Facet, ring: &[u32]) {
        let points = &scaled.points;
        let exact = || area_vector(seed.corners.mapped(|corner| &points[at(corner)]));
        let is_coarse = scaled.unit > DOUBT;
        // Adding zero replaces −0 by 0.
        let normal = if is_coarse { seed.normal.add_scalar(0.0) } else { exact().normalize() };
        self.normals.push(normal);
        let first = (1..ring.len()).fold(0, |first, candidate| {
            let is_before = precedes(&points[at(ring[candidate])], &points[at(ring[first])]);
            if is_before { candidate } else { first }
        });
        self.corners.extend_from_slice(&ring[first..]);
        self.corners.extend_from_slice(&ring[..first]);
        self.ends.push(self.corners.len());
    }

    /// Returns the vertices of each face.
    pub(super) fn rings(&self) -> impl Iterator<Item = &[u32]> {
        let starts = core::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.corners[start..end])
    }

    /// Removes each vertex that exactly two faces share, since a vertex of a solid needs three.
    /// Returns `false`, with the faces unusable, if such a vertex does not lie on the segment
    /// between its neighbors in both faces, if one of its faces is a triangle, or if the remaining
    /// faces do not close. This failure occurs where two nearly coplanar faces meet along a closed
    /// loop.
    fn straighten(&mut self, scaled: &Scaled<3>) -> bool {
        let mut uses = vec![(0_u32, [0; 2]); scaled.points.len()];
        for (face, ring) in self.rings().enumerate() {
            for &vertex in ring {
                let (count, users) = &mut uses[at(vertex)];
                if let Some(user) = users.get_mut(at(*count)) {
                    *user = face;
                }
                *count += 1;
            }
        }
        if uses.iter().all(|&(count, _)| count != 2) {
            return true;
        }
        let mut rings: Vec<Vec<u32>> = self.rings().map(<[u32]>::to_vec).collect();
        for (vertex, (_, users)) in (0_u32..).zip(uses).filter(|(_, (count, _))| *count == 2) {
            let can_do_without =
                |&user: &usize| rings[user].len() > 3 && is_straight(&rings[user], vertex, scaled);
            if !users.iter().all(can_do_without) {
                return false;
            }
            users.iter().for_each(|&user| rings[user].retain(|&corner| corner != vertex));
        }
        self.corners = rings.concat();
        self.ends.clear();
        self.ends.extend(rings.iter().scan(0, |end, ring| {
            *end += ring.len();
            Some(*end)
        }));
        self.is_closed()
    }

    /// Returns whether each side of a face occurs, reversed, in exactly one other face.
    fn is_closed(&self) -> bool {
        let sides = self.rings().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let mut forward: Vec<(u32, u32)> = sides.map(|(&from, &to)| (from, to)).collect();
        let mut backward: Vec<(u32, u32)> = forward.iter().map(|&(from, to)| (to, from)).collect();
        forward.sort_unstable();
        backward.sort_unstable();
        forward == backward && forward.windows(2).all(|pair| pair[0] != pair[1])
    }
}

/// Returns whether a vertex of a ring lies on the segment between the vertices before and after it.
fn is_straight(ring: &[u32], vertex: u32, scaled: &Scaled<3>) -> bool {
    let Some(index) = ring.iter().position(|&corner| corner == vertex) else { return false };
    let corner = |step: usize| &scaled.points[at(ring[(index + step) % ring.len()])];
    distance_from_segment(corner(0), corner(ring.len() - 1), corner(1)) <= scaled.flat()
}

/// Merges triangles within the tolerance of one plane into faces.
///
/// Each side of a face is, reversed, a side of the triangle beyond, and so of the face that
/// contains that triangle. Only [`FaceRings::straighten`] can break this; if it fails, each
/// triangle becomes a face of its own.
pub(super) fn faces(facets: &[Facet], scaled: &Scaled<3>) -> FaceRings {
    let mut faces = Merger::new(facets, scaled).merged();
    if !faces.straighten(scaled) {
        faces = FaceRings::with_capacity(facets.len());
        for facet in facets {
            faces.push(scaled, facet, &facet.corners);
        }
    }
    faces
}

struct Merger<'a> {
    facets: &'a [Facet],
    scaled: &'a Scaled<3>,
    /// For each facet, whether a face already contains it.
    is_taken: Vec<bool>,
    /// For each vertex, one more than the index of the seed facet of the last face that contains
    /// it; 0 for none.
    in_face_of: Vec<u32>,
    /// The vertices of the face under construction.
    ring: Vec<u32>,
    /// For each vertex in `ring`, the facet beyond the side to the next vertex.
    beyond: Vec<u32>,
}

impl<'a> Merger<'a> {
    fn new(facets: &'a [Facet], scaled: &'a Scaled<3>) -> Self {
        Self {
            facets,
            scaled,
            is_taken: vec![false; facets.len()],
            in_face_of: vec![0; scaled.points.len()],
            ring: Vec::new(),
            beyond: Vec::new(),
        }
    }

    /// Grows a face from each facet that is not in a face yet, the largest first.
    fn merged(mut self) -> FaceRings {
        // The bits of nonnegative floats, taken as integers, have the order of the floats.
        // Inverting them gives descending order.
        let area = |facet: &Facet| !facet.doubled_area.to_bits();
        let mut seeds: Vec<(u64, u32)> = self.facets.iter().map(area).zip(0..).collect();
        sort_keyed(&mut seeds);
        let mut faces = FaceRings::with_capacity(self.facets.len());
        for (_, seed) in seeds {
            if !self.is_taken[at(seed)] {
                self.grow(seed);
                faces.push(self.scaled, &self.facets[at(seed)], &self.ring);
            }
        }
        faces
    }

    /// Grows a face from the facet `seed`: writes its loop to `ring` and the facets beyond to
    /// `beyond`.
    fn grow(&mut self, seed: u32) {
        let facet = &self.facets[at(seed)];
        self.is_taken[at(seed)] = true;
        self.ring.clear();
        self.ring.extend(facet.corners);
        self.beyond.clear();
        self.beyond.extend(facet.neighbors);
        facet.corners.iter().for_each(|&corner| self.in_face_of[at(corner)] = seed + 1);
        // Each success adds one facet; after a whole turn without success the face is complete.
        let (mut position, mut failures) = (0, 0);
        while failures < self.ring.len() {
            position %= self.ring.len();
            if self.take_beyond(seed, position) {
                failures = 0;
            } else {
                failures += 1;
                position += 1;
            }
        }
    }

    /// Adds the facet beyond a side, if it is coplanar with the seed and the face stays convex.
    /// Returns whether it was added.
    fn take_beyond(&mut self, seed: u32, position: usize) -> bool {
        let (from, beyond) = (self.ring[position], self.beyond[position]);
        let facet = &self.facets[at(beyond)];
        if self.is_taken[at(beyond)] {
            return false;
        }
        let Some(shared) = facet.corners.iter().position(|&corner| corner == from) else {
            return false;
        };
        // In the facet beyond, the side runs backwards and ends at `from`. The far corner follows
        // `from`, and the remaining side leads back.
        let far = facet.corners[(shared + 1) % 3];
        let Scaled { points, .. } = self.scaled;
        let is_coplanar = || self.facets[at(seed)].height(points, far).abs() <= self.scaled.flat();
        let is_free = self.in_face_of[at(far)] != seed + 1;
        if !(is_free && is_coplanar() && self.stays_convex(seed, position, far)) {
            return false;
        }
        self.is_taken[at(beyond)] = true;
        self.in_face_of[at(far)] = seed + 1;
        self.beyond[position] = facet.neighbors[shared];
        self.beyond.insert(position + 1, facet.neighbors[(shared + 1) % 3]);
        self.ring.insert(position + 1, far);
        true
    }

    /// Returns whether the loop stays convex, within the tolerance, when `far` is inserted after
    /// `position`.
    fn stays_convex(&self, seed: u32, position: usize, far: u32) -> bool {
        let count = self.ring.len();
        let vertex = |step: usize| self.ring[(position + step) % count];
        let (before, from, to, after) = (vertex(count - 1), vertex(0), vertex(1), vertex(2));
        let normal = &self.facets[at(seed)].normal;
        let turns_left = |corners: [u32; 3]| {
            let [a, b, c] = corners.mapped(|corner| self.scaled.points[at(corner)]);
            // The distance of b outside the line from a to c, times the length of that line.
            (b - a).cross(&(c - b)).dot(normal) >= -self.scaled.flat() * (c - a).norm()
        };
        turns_left([before, from, far])
            && turns_left([from, far, to])
            && turns_left([far, to, after])
    }
}
