//! First hits of rays on a mesh in 3D, with a fast path for hits in the interior of a triangle.
//!
//! The results are bitwise equal to the first hits that
//! [`each_hit`](crate::query::composite::each_hit) finds. For speed, the normal is computed once,
//! at the end, the code is compiled in one piece, and rays are traced in groups.

use super::triangle3::{InnerHit, TriangleRay};
use super::{Answers, RayBatch, RayCast, RayIntersection, first_that};
use crate::bounding_volume::{Aabb, Ray};
use crate::bvh::{RAYS, RayVisitor, Slabs, TriangleAt, Walk};
use crate::collide::parts::bounds::{around_point, loosened};
use crate::math::{Point, Pose, Real, Space, Vector, filled, max, min};
use crate::query::composite::RayQuestion;
use crate::shape::{CompositeShape, TriMesh, Triangle, box_of_corners};

/// Returns the first hit of one ray; `None` if it hits nothing.
pub(crate) fn first_on_mesh<N: Space<3>>(
    mesh: &TriMesh<N, 3>,
    question: &RayQuestion<N, 3>,
) -> Option<RayIntersection<N, 3>> {
    let RayQuestion { ray, max_time, solid } = question;
    // Borrowed in place: a move would read the struct right after the stores that write it, which
    // stalls.
    let mut cast = MeshCast::new(mesh, ray, *max_time, *solid);
    let Some(cast) = &mut cast else {
        return first_that(mesh, question, |_| true);
    };
    let probe = mesh.ray_probe(ray, &cast.around);
    mesh.visit_triangles(&probe, probe.slabs.limit(cast.limit()), |index, corners| {
        cast.propose(index, corners);
        probe.slabs.limit(cast.limit())
    });
    cast.first()
}

/// Calls `answer` with the index and the first hit of each ray, in no particular order.
pub(crate) fn first_hits_on_mesh<N: Space<3>>(
    mesh: &TriMesh<N, 3>,
    batch: &RayBatch<'_, N, 3>,
    answer: Answers<'_, N, 3>,
) {
    let RayBatch { rays, max_time, solid } = *batch;
    let (mut casts, mut walks) = (Vec::with_capacity(RAYS), Vec::with_capacity(RAYS));
    let mut numbers = Vec::with_capacity(RAYS);
    for (number, ray) in rays.iter().enumerate() {
        if let Some(cast) = MeshCast::new(mesh, ray, max_time, solid) {
            let probe = mesh.ray_probe(ray, &cast.around);
            walks.push(Walk::new(probe, probe.slabs.limit(cast.limit())));
            casts.push(cast);
            numbers.push(number);
        } else {
            let question = RayQuestion { ray: *ray, max_time, solid };
            answer(number, first_that(mesh, &question, |_| true));
        }
        if casts.len() == RAYS || number + 1 == rays.len() {
            mesh.visit_triangles_of_many(&mut walks, &mut Casts { mesh, casts: &mut casts });
            casts.iter().zip(&numbers).for_each(|(cast, &number)| answer(number, cast.first()));
            casts.clear();
            walks.clear();
            numbers.clear();
        }
    }
}

/// Rays that are traced through a mesh together.
struct Casts<'a, 'b, N: Real> {
    mesh: &'b TriMesh<N, 3>,
    casts: &'b mut [MeshCast<'a, N>],
}

impl<N: Space<3>> RayVisitor for Casts<'_, '_, N> {
    #[inline(always)]
    fn touch(&self, id: u32) {
        self.mesh.touch_corners(id);
    }

    #[inline(always)]
    fn visit(&mut self, ray: usize, slabs: &Slabs<3>, at: TriangleAt<'_>) -> f32 {
        let cast = &mut self.casts[ray];
        cast.propose(at.id, &self.mesh.corners_in(&at));
        slabs.limit(cast.limit())
    }
}

/// A ray that is traced through a mesh.
struct MeshCast<'a, N: Real> {
    ray: &'a Ray<N, 3>,
    solid: bool,
    own: TriangleRay<N>,
    /// A box around the ray's origin that contains the rounding error of positions; `blur` is half
    /// of that error.
    around: Aabb<N, 3>,
    blur: N,
    /// The time of the first hit so far, or the latest time of a hit.
    latest: N,
    first: Option<Met<N>>,
}

/// The triangle with the first hit so far.
#[derive(Clone, Copy)]
struct Met<N: Real> {
    corners: [Point<N, 3>; 3],
    part: u32,
    /// The hit in the interior; `None` if the cast of the single triangle decides.
    inner: Option<InnerHit<N>>,
}

impl<'a, N: Space<3>> MeshCast<'a, N> {
    /// Starts the cast of a ray: tests only the triangles whose boxes are unbounded. `None` if
    /// [`first_that`] must compute the result: if the query is solid and the mesh has bodies, if
    /// the mesh has no bounds, if the ray has no direction or is not finite, and if `max_time` is
    /// negative or NaN.
    #[inline(always)]
    fn new(mesh: &TriMesh<N, 3>, ray: &'a Ray<N, 3>, max_time: N, solid: bool) -> Option<Self> {
        let is_finite = filled(|axis| ray.dir[axis].is_finite_number()) == [true; 3];
        let is_valid = is_finite && max_time >= N::ZERO;
        if !is_valid || (solid && mesh.has_bodies()) {
            return None;
        }
        let own = TriangleRay::new(ray)?;
        let around = around_point(&ray.origin, mesh.tree().bounds()?)?;
        let blur = (around.maxs()[0] - around.mins()[0]) * N::lit(0.25);
        let mut cast = Self { ray, solid, own, around, blur, latest: max_time, first: None };
        for &index in mesh.tree().unbounded() {
            cast.propose(index, &mesh.corners(index));
        }
        Some(cast)
    }

    /// Returns the latest time at which boxes are searched: `latest`, loosened by rounding.
    #[inline(always)]
    fn limit(&self) -> N {
        loosened(self.latest)
    }

    /// Tests a triangle. Keeps it if its hit is the earliest so far, or as early as the earliest
    /// and on a part with a lower index.
    #[inline(always)]
    fn propose(&mut self, part: u32, corners: &[Point<N, 3>; 3]) {
        let Some(inner) = self.own.inner_hit(corners) else {
            return self.propose_rim(part, corners);
        };
        let is_met = inner.toi <= self.latest
            && (self.is_surely_within(corners, inner.toi) || self.enters_box(corners));
        if is_met {
            self.put(inner.toi, Met { corners: *corners, part, inner: Some(inner) });
        }
    }

    /// Tests a triangle that is not clearly hit in its interior, which is rare.
    #[cold]
    fn propose_rim(&mut self, part: u32, corners: &[Point<N, 3>; 3]) {
        let hit = self.enters_box(corners).then(|| self.cast_alone(corners)).flatten();
        if let Some(hit) = hit.filter(|hit| hit.toi <= self.latest) {
            self.put(hit.toi, Met { corners: *corners, part, inner: None });
        }
    }

    #[inline(always)]
    fn put(&mut self, toi: N, met: Met<N>) {
        let is_first = self.first.is_none_or(|first| toi < self.latest || met.part < first.part);
        if is_first {
            (self.first, self.latest) = (Some(met), toi);
        }
    }

    /// Returns whether the ray enters the box of the triangle in time. Only then a hit counts:
    /// where the areas of the interior test underflow, their signs are meaningless. For speed, this
    /// is tested last.
    fn enters_box(&self, corners: &[Point<N, 3>; 3]) -> bool {
        let enter = box_of_corners(corners).sweep_interval(&self.around, &self.ray.dir);
        enter.is_some_and(|(enter, _)| enter <= self.limit())
    }

    /// Returns whether [`Self::enters_box`] is certainly true, by a test without a division: at the
    /// time of the hit the ray is inside the box, or outside by less than half of the margin in
    /// `around`. Half of the margin is 8 epsilon of the coordinates; the position has an error of
    /// at most 3 epsilon, and the times in [`Self::enters_box`] of 2 epsilon.
    #[inline(always)]
    fn is_surely_within(&self, corners: &[Point<N, 3>; 3], toi: N) -> bool {
        let (ray, [a, b, c]) = (self.ray, corners);
        let mut is_within =
            (self.blur > N::MIN_POSITIVE) & (toi > N::MIN_POSITIVE / N::EPSILON * N::TWO);
        for axis in 0..3 {
            let at = ray.origin[axis] + ray.dir[axis] * toi;
            let low = min(min(a[axis], b[axis]), c[axis]) - self.blur;
            let high = max(max(a[axis], b[axis]), c[axis]) + self.blur;
            is_within &= (low <= at) & (at <= high);
        }
        is_within
    }

    /// Returns the first hit, after all triangles that may be hit were tested; `None` if there is
    /// none.
    fn first(&self) -> Option<RayIntersection<N, 3>> {
        let Met { corners, part, inner } = self.first?;
        let Some(inner) = inner else {
            return Some(RayIntersection { part, ..self.cast_alone(&corners)? });
        };
        let surface = self.own.surface(&corners, &inner);
        let (normal, feature) = (as_part(&surface.normal), surface.feature);
        Some(RayIntersection { toi: inner.toi, normal, feature, part })
    }

    /// Returns the hit of the ray on a single triangle, as the algorithm for separate triangles
    /// computes it; `None` if the ray misses the triangle.
    fn cast_alone(&self, corners: &[Point<N, 3>; 3]) -> Option<RayIntersection<N, 3>> {
        let ray = self.ray.inverse_transformed_by(&Pose::identity());
        let hit = Triangle::of_finite(*corners).cast_local_ray(&ray, self.solid)?;
        Some(RayIntersection { normal: as_part(&hit.normal), ..hit })
    }
}

/// Rotates a normal by the identity, as `each_hit` does for a part without a pose. The sums in this
/// rotation determine the sign of zeros, which must be equal in both results.
fn as_part<N: Real>(normal: &Vector<N, 3>) -> Vector<N, 3> {
    Pose::<N, 3>::identity().vector(normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::samples;

    fn number(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        let any = (*state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0;
        // Half of the numbers are multiples of a quarter, so that rays meet corners, sides and
        // faces edge-on.
        if *state >> 20 & 1 == 0 { (any * 4.0).round() / 4.0 } else { any }
    }

    fn numbers<N: Real>(state: &mut u64, scale: f64) -> [N; 3] {
        [(); 3].map(|()| N::lit(number(state) * scale))
    }

    /// Returns a mesh of random triangles in a strip: each shares two corners with the next.
    fn soup<N: Space<3>>(state: &mut u64, count: u32, scale: f64) -> TriMesh<N, 3> {
        let vertices = (0..count + 2).map(|_| Point::from(numbers(state, scale))).collect();
        TriMesh::new(vertices, (0..count).map(|index| [index, index + 1, index + 2]).collect())
    }

    fn bits<N: Real>(hit: Option<&RayIntersection<N, 3>>) -> Option<(u64, [u64; 3], u32, String)> {
        hit.map(|hit| {
            let normal = [0, 1, 2].map(|axis| hit.normal[axis].bits());
            (hit.toi.bits(), normal, hit.part, format!("{:?}", hit.feature))
        })
    }

    /// Checks that the results for single rays and for batches are bitwise equal to the results of
    /// casts against each part.
    fn agrees<N: Space<3>>(scale: f64, speed: f64) {
        let (state, mut hits) = (&mut 5, 0);
        for count in [1, 12, 300, 5000] {
            let mesh = soup::<N>(state, count, scale);
            let mut rays: Vec<_> = (0..samples(20))
                .map(|_| {
                    let away = if number(state) > 0.0 { 1.0 } else { 40.0 };
                    let origin = Point::from(numbers::<N>(state, scale * away));
                    let end = mesh.vertices()[0] + Vector::<N, 3>::from(numbers(state, scale));
                    let towards = (end - origin) * N::lit(speed);
                    let random = Vector::from(numbers(state, speed));
                    Ray::new(origin, if number(state) > 0.0 { towards } else { random })
                })
                .collect();
            rays.push(Ray::new(mesh.vertices()[1], Vector::<N, 3>::zeros()));
            rays.push(Ray::new(Point::origin(), Vector::<N, 3>::repeat(N::INFINITY)));
            for (solid, max_time) in [(true, N::INFINITY), (false, N::lit(1.5)), (true, -N::ONE)] {
                let batch = RayBatch { rays: &rays, max_time, solid };
                let mut many = vec![None; rays.len()];
                first_hits_on_mesh(&mesh, &batch, &mut |ray, hit| many[ray] = hit);
                for (ray, hit) in rays.iter().zip(&many) {
                    let question = RayQuestion { ray: *ray, max_time, solid };
                    let parts = first_that(&mesh, &question, |_| true);
                    assert_eq!(bits(hit.as_ref()), bits(parts.as_ref()), "{ray:?}, many");
                    let one = first_on_mesh(&mesh, &question);
                    assert_eq!(bits(one.as_ref()), bits(parts.as_ref()), "{ray:?}, one");
                    hits += usize::from(parts.is_some());
                }
            }
        }
        assert!(hits > samples(10) || scale != 1.0, "{hits} hits");
    }

    #[test]
    fn all_paths_have_the_same_bits() {
        for (scale, speed) in [(1.0, 1.0), (1e18, 1.0), (1e-18, 1e6), (1.0, 1e-30), (1e12, 1e12)] {
            agrees::<f32>(scale, speed);
            agrees::<f64>(scale, speed);
        }
        agrees::<f32>(1e-36, 1.0);
        agrees::<f32>(1e-20, 1e-20);
        agrees::<f64>(1e-160, 1e-150);
        agrees::<f64>(1e150, 1e150);
    }
}
