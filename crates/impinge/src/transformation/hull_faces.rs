//! From the triangles of a hull to its faces: which vertices add nothing, and which triangles are one
//! polygon.

use super::quickhull::Facet;
use super::span::{Scaled, direction, distance_from_segment, precedes};
use crate::math::{Point, Vector};

type P3 = Point<f64, 3>;

fn at(index: u32) -> usize {
    index as usize
}

/// The vertices next to each vertex: pairs (vertex, neighbor), sorted, and whether the surface turns
/// at the edge between them.
fn spokes(facets: &[Facet], points: &Scaled<3>) -> Vec<(u32, u32, bool)> {
    let mut spokes = Vec::with_capacity(3 * facets.len());
    for facet in facets {
        for side in 0..3 {
            let [from, to] = [facet.corners[side], facet.corners[(side + 1) % 3]];
            let beyond = &facets[at(facet.neighbors[side])];
            spokes.push((from, to, !is_flat(facet, beyond, points)));
        }
    }
    spokes.sort_unstable();
    spokes
}

/// The smaller of two neighbors lies in the plane of the larger.
fn is_flat(facet1: &Facet, facet2: &Facet, points: &Scaled<3>) -> bool {
    let is_first_larger = facet1.doubled_area() >= facet2.doubled_area();
    let (large, small) = if is_first_larger { (facet1, facet2) } else { (facet2, facet1) };
    let mut far = small.corners.iter().filter(|&corner| !large.corners.contains(corner));
    far.all(|&corner| large.height(&points.points, corner).abs() <= points.flat())
}

/// Vertices, no two next to each other, without which the hull stays the same within `flat`: they
/// lie on the segment between two neighbors or in the plane of all of them.
pub(super) fn redundant(facets: &[Facet], scaled: &Scaled<3>) -> Vec<u32> {
    let points = &scaled.points;
    let spokes = spokes(facets, scaled);
    let mut is_kept = vec![false; points.len()];
    let mut redundant = Vec::new();
    for ring in spokes.chunk_by(|a, b| a.0 == b.0) {
        let vertex = ring[0].0;
        // At a true corner three edges meet at least, or slivers hide some of them.
        let turns = ring.iter().filter(|spoke| spoke.2).count();
        let is_candidate = turns <= 2 && ring.len() <= 64 && !is_kept[at(vertex)];
        let neighbors = || ring.iter().map(|spoke| points[at(spoke.1)]).collect::<Vec<P3>>();
        if is_candidate && is_inside(&points[at(vertex)], &neighbors(), scaled.flat()) {
            redundant.push(vertex);
            ring.iter().for_each(|spoke| is_kept[at(spoke.1)] = true);
        }
    }
    redundant
}

fn is_inside(vertex: &P3, neighbors: &[P3], flat: f64) -> bool {
    let pairs =
        neighbors.iter().enumerate().flat_map(|(i, a)| neighbors[..i].iter().map(move |b| (a, b)));
    let is_amid = |normal: Vector<f64, 3>| {
        neighbors.iter().all(|p| normal.dot(&(p - vertex)).abs() <= flat)
            && is_surrounded(vertex, neighbors, &normal)
    };
    pairs.clone().any(|(a, b)| distance_from_segment(vertex, a, b) <= flat)
        || widest_normal(vertex, pairs).is_some_and(is_amid)
}

/// Seen along a normal, there are neighbors on both sides of each line from the vertex to one of them. At
/// the rim of something hardly thicker than rounding all of them lie in one plane, but on one side.
fn is_surrounded(vertex: &P3, neighbors: &[P3], normal: &Vector<f64, 3>) -> bool {
    neighbors.iter().all(|to| {
        let across = normal.cross(&(to - vertex));
        let side = |p: &P3| across.dot(&(p - vertex));
        neighbors.iter().any(|p| side(p) < 0.0) && neighbors.iter().any(|p| side(p) > 0.0)
    })
}

/// The unit normal of the largest triangle of a vertex and two of its neighbors.
fn widest_normal<'a>(
    vertex: &P3,
    pairs: impl Iterator<Item = (&'a P3, &'a P3)>,
) -> Option<Vector<f64, 3>> {
    let normals = pairs.map(|(a, b)| (a - vertex).cross(&(b - vertex)));
    let widest =
        normals.reduce(|best, n| if n.norm_squared() > best.norm_squared() { n } else { best })?;
    direction(&widest).map(|(normal, _)| normal)
}

/// A face of the hull.
#[derive(Clone, Debug)]
pub(super) struct HullFace {
    /// The outward unit normal of the largest triangle in it: the hull has no point in front of that,
    /// however much smaller triangles are bent within the tolerance.
    pub(super) normal: Vector<f64, 3>,
    /// The vertices, counter-clockwise from outside, from the first in order of coordinates.
    pub(super) ring: Vec<u32>,
}

/// The faces: triangles within the tolerance of one plane are one face.
///
/// Should the merging ever fail to close the surface, the triangles are the faces: they do close it.
pub(super) fn faces(facets: &[Facet], scaled: &Scaled<3>) -> Vec<HullFace> {
    let points = &scaled.points;
    let mut faces = Merger::new(facets, scaled).merged();
    if !(straighten(&mut faces, scaled) && is_closed(&faces)) {
        let triangle =
            |facet: &Facet| HullFace { normal: facet.normal(points), ring: facet.corners.to_vec() };
        faces = facets.iter().map(triangle).collect();
    }
    for HullFace { ring, .. } in &mut faces {
        let first = (1..ring.len()).fold(0, |first, candidate| {
            let is_before = precedes(&points[at(ring[candidate])], &points[at(ring[first])]);
            if is_before { candidate } else { first }
        });
        ring.rotate_left(first);
    }
    faces
}

/// A corner of a face that grows, and the facet beyond the side to the next corner.
#[derive(Clone, Copy)]
struct HullCorner {
    vertex: u32,
    beyond: u32,
}

struct Merger<'a> {
    facets: &'a [Facet],
    points: &'a [P3],
    flat: f64,
    /// Which facets are part of a face.
    is_taken: Vec<bool>,
    /// For each vertex, one more than the last seed in whose face it is.
    in_face_of: Vec<u32>,
}

impl<'a> Merger<'a> {
    fn new(facets: &'a [Facet], scaled: &'a Scaled<3>) -> Self {
        Self {
            facets,
            points: &scaled.points,
            flat: scaled.flat(),
            is_taken: vec![false; facets.len()],
            in_face_of: vec![0; scaled.points.len()],
        }
    }

    /// Grows a face from each facet that is in none yet, the largest first.
    fn merged(mut self) -> Vec<HullFace> {
        let mut seeds: Vec<u32> = (0..).take(self.facets.len()).collect();
        let area = |facet: u32| self.facets[at(facet)].doubled_area();
        seeds.sort_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
        let mut faces = Vec::new();
        for seed in seeds {
            if !self.is_taken[at(seed)] {
                let normal = self.facets[at(seed)].normal(self.points);
                faces.push(HullFace { normal, ring: self.grow(seed) });
            }
        }
        faces
    }

    fn grow(&mut self, seed: u32) -> Vec<u32> {
        let facet = &self.facets[at(seed)];
        self.is_taken[at(seed)] = true;
        let mut ring = Vec::with_capacity(4);
        for side in 0..3 {
            self.in_face_of[at(facet.corners[side])] = seed + 1;
            ring.push(HullCorner { vertex: facet.corners[side], beyond: facet.neighbors[side] });
        }
        // Each success takes one facet more; after a whole turn without any the face is done.
        let (mut position, mut failures) = (0, 0);
        while failures < ring.len() {
            position %= ring.len();
            if self.take_beyond(seed, &mut ring, position) {
                failures = 0;
            } else {
                failures += 1;
                position += 1;
            }
        }
        ring.iter().map(|corner| corner.vertex).collect()
    }

    /// Takes in the facet beyond a side, if it is coplanar with the seed and the face stays
    /// convex.
    fn take_beyond(&mut self, seed: u32, ring: &mut Vec<HullCorner>, position: usize) -> bool {
        let (from, beyond) = (ring[position].vertex, ring[position].beyond);
        let facet = &self.facets[at(beyond)];
        let Some(shared) = facet.corners.iter().position(|&corner| corner == from) else {
            return false;
        };
        // Seen from there the side runs backwards, to `from`; then come the far corner and back.
        let far = facet.corners[(shared + 1) % 3];
        let is_free = !self.is_taken[at(beyond)] && self.in_face_of[at(far)] != seed + 1;
        let is_level = || self.facets[at(seed)].height(self.points, far).abs() <= self.flat;
        if !(is_free && is_level() && self.stays_convex(seed, ring, position, far)) {
            return false;
        }
        self.is_taken[at(beyond)] = true;
        self.in_face_of[at(far)] = seed + 1;
        ring[position].beyond = facet.neighbors[shared];
        ring.insert(
            position + 1,
            HullCorner { vertex: far, beyond: facet.neighbors[(shared + 1) % 3] },
        );
        true
    }

    fn stays_convex(&self, seed: u32, ring: &[HullCorner], position: usize, far: u32) -> bool {
        let count = ring.len();
        let vertex = |step: usize| ring[(position + step) % count].vertex;
        let (before, from, to, after) = (vertex(count - 1), vertex(0), vertex(1), vertex(2));
        let normal = self.facets[at(seed)].normal(self.points);
        let turns_left = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.points[at(corner)]);
            // How far b lies outside the line from a to c, times its length.
            (b - a).cross(&(c - b)).dot(&normal) >= -self.flat * (c - a).norm()
        };
        turns_left([before, from, far])
            && turns_left([from, far, to])
            && turns_left([far, to, after])
    }
}

/// Drops the vertices that only two faces share: in each of them the sides there form one line. Answers
/// false if there is one where they do not, as where two faces that hardly lean against each other meet all
/// around: a vertex of two sides is none.
fn straighten(faces: &mut [HullFace], scaled: &Scaled<3>) -> bool {
    let mut uses = vec![(0_u32, [0_usize; 2]); scaled.points.len()];
    for (index, face) in faces.iter().enumerate() {
        for &vertex in &face.ring {
            let (count, users) = &mut uses[at(vertex)];
            if let Some(user) = users.get_mut(at(*count)) {
                *user = index;
            }
            *count += 1;
        }
    }
    (0_u32..).zip(uses).filter(|(_, (count, _))| *count == 2).all(|(vertex, (_, users))| {
        let can_do_without = |user: &usize| {
            let ring = &faces[*user].ring;
            ring.len() > 3 && is_straight(ring, vertex, scaled)
        };
        let is_needless = users.iter().all(can_do_without);
        if is_needless {
            users.iter().for_each(|&user| faces[user].ring.retain(|&corner| corner != vertex));
        }
        is_needless
    })
}

/// A vertex of a ring lies on the segment between those before and after it.
fn is_straight(ring: &[u32], vertex: u32, scaled: &Scaled<3>) -> bool {
    let Some(place) = ring.iter().position(|&corner| corner == vertex) else { return false };
    let corner = |step: usize| &scaled.points[at(ring[(place + step) % ring.len()])];
    distance_from_segment(corner(0), corner(ring.len() - 1), corner(1)) <= scaled.flat()
}

/// Each side of a face is, backwards, the side of one other face.
fn is_closed(faces: &[HullFace]) -> bool {
    let sides = |HullFace { ring, .. }: &HullFace| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().copied().zip(next.copied()).collect::<Vec<_>>()
    };
    let mut forward: Vec<(u32, u32)> = faces.iter().flat_map(sides).collect();
    let mut backward: Vec<(u32, u32)> = forward.iter().map(|&(from, to)| (to, from)).collect();
    forward.sort_unstable();
    backward.sort_unstable();
    forward == backward && forward.windows(2).all(|pair| pair[0] != pair[1])
}
