//! An order of many rays in which those that go near each other follow each other.

use crate::bounding_volume::{Aabb, Ray};
use crate::math::{Point, Real, Vector, max_component};

/// The bits of a place on the curve; the index of the ray stands below them.
const PLACE: u32 = 32;
/// Those of them that are for where a ray starts; the others are for where it leads.
const START: u32 = 21;

/// The indices of the rays along a curve of space (Morton, "A computer oriented geodetic data base", 1966)
/// through where they start, and of those that start near each other through where they lead: those of a
/// camera, which start at one point, by the latter alone.
///
/// There are fewer than 2^32.
pub(super) fn order_in_space<N: Real, const D: usize>(
    rays: &[Ray<N, D>],
) -> impl Iterator<Item = usize> {
    let starts = Grid::around(rays.iter().map(|ray| ray.origin));
    let (of_starts, of_leads) = if starts.is_point() { (0, PLACE) } else { (START, PLACE - START) };
    let leads = Grid { low: [-1.0; D], scale: [0.5; D] };
    let place = |ray: &Ray<N, D>| {
        let lead = ray.dir / max_component(&ray.dir);
        starts.place(&ray.origin.coords, of_starts) << of_leads | leads.place(&lead, of_leads)
    };
    let mut order: Vec<u64> =
        (0..).zip(rays).map(|(index, ray)| place(ray) << (u64::BITS - PLACE) | index).collect();
    order.sort_unstable();
    order.into_iter().filter_map(|key| usize::try_from(key & u64::from(u32::MAX)).ok())
}

/// Cells along each axis between two corners.
struct Grid<const D: usize> {
    low: [f64; D],
    /// One over the size on each axis; zero where that is nothing or not finite.
    scale: [f64; D],
}

impl<const D: usize> Grid<D> {
    fn around<N: Real>(points: impl Iterator<Item = Point<N, D>>) -> Self {
        let around = Aabb::around_all(points);
        let (mut low, mut scale) = ([0.0; D], [0.0; D]);
        for axis in 0..D {
            let Some(aabb) = &around else { break };
            let (first, last) = (aabb.mins()[axis].as_f64(), aabb.maxs()[axis].as_f64());
            let size = 1.0 / (last - first);
            (low[axis], scale[axis]) = (first, if size.is_finite() { size } else { 0.0 });
        }
        Self { low, scale }
    }

    /// All points are one.
    fn is_point(&self) -> bool {
        self.scale.iter().all(|&scale| scale == 0.0)
    }

    /// The place of a point on the curve, of so many bits or less; any place for one that is not finite.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between zero and the number of cells, to which casts saturate"
    )]
    fn place<N: Real>(&self, point: &Vector<N, D>, bits: u32) -> u64 {
        let each = bits / D as u32;
        let cells = f64::from(1_u32 << each);
        let mut cell = [0_u32; D];
        for axis in 0..D {
            let share = (point[axis].as_f64() - self.low[axis]) * self.scale[axis];
            cell[axis] = ((share * cells) as u32).min((1 << each) - 1);
        }
        let mut place = 0;
        for bit in (0..each).rev() {
            for &number in &cell {
                place = place << 1 | u64::from(number >> bit & 1);
            }
        }
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type P = Point<f64, 2>;
    type V = Vector<f64, 2>;

    #[test]
    fn each_ray_once_and_neighbours_together() {
        let starts = [0.0, 100.0, 1.0, 99.0, f64::NAN, f64::INFINITY];
        let rays: Vec<_> = starts.iter().map(|&x| Ray::new(P::new(x, x), V::x())).collect();
        let mut order: Vec<usize> = order_in_space(&rays).collect();
        assert_eq!(order.len(), rays.len(), "each once");
        order.sort_unstable();
        assert!(order.into_iter().eq(0..rays.len()), "whatever they are");

        let order: Vec<usize> = order_in_space(&rays[..4]).collect();
        assert!(
            [[0, 2, 3, 1], [0, 2, 1, 3], [2, 0, 3, 1], [2, 0, 1, 3]]
                .contains(&[order[0], order[1], order[2], order[3]])
        );
    }

    #[test]
    fn rays_of_a_camera_go_by_where_they_lead() {
        let leads = [V::new(1.0, 0.1), V::new(-1.0, 0.1), V::new(2.0, 0.3), V::new(-3.0, 0.2)];
        let rays: Vec<_> = leads.iter().map(|&dir| Ray::new(P::origin(), dir)).collect();
        let order: Vec<usize> = order_in_space(&rays).collect();
        let sides: Vec<bool> = order.iter().map(|&index| leads[index].x > 0.0).collect();
        assert!(sides == [true, true, false, false] || sides == [false, false, true, true]);
    }
}
