//! Mass of convex solids in 3D, computed from support points alone.
//!
//! A linear map gives the solid the proportions of a ball; the mapped solid is then cut into slices
//! perpendicular to the z axis. Each slice is a convex solid in 2D. Its support point in a
//! direction follows from support points of the solid: the solid is projected to the plane of that
//! direction and the z axis, and an interval of the outline there is narrowed to the height of the
//! slice.

use super::integrals::{Integrals, LocalUnits};
use super::revolution::NODES;
use super::support2::Tracing;
use crate::math::eigen::symmetric_eigen;
use crate::math::{Matrix, Point, Real, Vector, max};
use crate::shape::{MassError, Moments, SupportMap, finite};

type V2 = Vector<f64, 2>;
type V3 = Vector<f64, 3>;
type M3 = Matrix<f64, 3>;

/// The number of times that the proportions are estimated; each estimate improves the directions of
/// the next.
const ROUNDS: usize = 3;

/// Axes shorter than this fraction of the longest axis, or than `THIN_EPSILON` epsilon of it, are
/// raised to that length.
const THIN: f64 = 1e-8;
const THIN_EPSILON: f64 = 64.0;

/// The maximum number of times that a group of slices is halved.
const HALVINGS: u32 = 6;

/// A group of slices is halved again if its mass plus the trace of its second moments differs by
/// more than this value from the same sum over its two halves. In the round frame the sum is about
/// 1.
const ENOUGH: f64 = 1e-5;

/// The maximum number of times that each quarter of a slice's outline is halved.
const DEPTH: u32 = 3;

/// The largest height of an arc over its chord at which the arc is treated as flat, in the round
/// frame: points of the solid's surface are about 1 from its centre.
const FLAT: f64 = 1e-5;

/// The maximum number of steps that narrow an interval of the outline; ten are usual.
const MAX_STEPS: usize = 40;

/// The volume in the round frame up to which a solid is treated as having no volume.
const NOTHING: f64 = 1e-6;

/// Returns the moments of a convex solid from its support points, accurate to about 1e-4.
///
/// # Errors
/// If a support point is not finite.
pub(super) fn by_support<N: Real>(map: &dyn SupportMap<N, 3>) -> Result<Moments<3>, MassError> {
    let mut points = Vec::new();
    let mut round = RoundFrame::at_origin(LocalUnits::about_origin(1.0));
    for _ in 0..ROUNDS {
        sow(map, &round, &mut points)?;
        round = RoundFrame::of_points(&points);
    }
    let solid = Sliced { map, round };
    Ok(solid.round.grown(&solid.integrals()))
}

/// Appends the support points in 98 directions: the surface points of a cubic grid in the frame in
/// which the solid is round.
///
/// # Errors
/// If a support point is not finite.
fn sow<N: Real>(
    map: &dyn SupportMap<N, 3>,
    round: &RoundFrame,
    points: &mut Vec<Point<N, 3>>,
) -> Result<(), MassError> {
    let steps = || [-2.0, -1.0, 0.0, 1.0, 2.0].into_iter();
    let all =
        steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| V3::new(x, y, z))));
    for direction in all.filter(|direction| direction.amax() == 2.0) {
        let point = map.support_point(&round.direction(&direction).map(N::lit));
        for coordinate in &point.coords {
            finite("a coordinate of a support point", coordinate.as_f64())?;
        }
        points.push(point);
    }
    Ok(())
}

/// The frame in which a solid has the proportions of a ball. `x = center + axes · (widths × y)`
/// maps a point y of this frame to a point x in the units.
#[derive(Clone, Copy, Debug)]
struct RoundFrame {
    units: LocalUnits<3>,
    center: V3,
    axes: M3,
    widths: V3,
}

impl RoundFrame {
    fn at_origin(units: LocalUnits<3>) -> Self {
        Self { units, center: V3::zeros(), axes: M3::identity(), widths: V3::repeat(1.0) }
    }

    /// Returns the frame of a solid with these points on its surface.
    fn of_points<N: Real>(points: &[Point<N, 3>]) -> Self {
        let units = LocalUnits::around(points, N::ZERO);
        let mut sum = Integrals::none();
        for point in points {
            sum.add(1.0, &units.point(point), &M3::zeros());
        }
        let center = sum.first / sum.mass;
        let (values, axes) =
            symmetric_eigen(&(sum.second / sum.mass - center * center.transpose()));
        let thin = max(N::lit(THIN), N::lit(THIN_EPSILON) * N::EPSILON).as_f64();
        let longest = values.amax().sqrt();
        let least = longest * thin;
        let width = |value: f64| if value > least * least { value.sqrt() } else { least };
        // Coinciding points have no proportions: the widths are 1.
        let widths = if longest > 0.0 { values.map(width) } else { V3::repeat(1.0) };
        Self { units, center, axes, widths }
    }

    /// Returns the unit direction in the solid's frame whose support point is also extreme in the
    /// direction `round` of the round frame; y for a zero direction.
    fn direction(&self, round: &V3) -> V3 {
        let direction = self.axes * round.component_div(&self.widths);
        direction.try_normalize(0.0).unwrap_or_else(V3::y)
    }

    /// Converts a point of the solid to the round frame.
    fn point<N: Real>(&self, point: &Point<N, 3>) -> V3 {
        self.axes.tr_mul(&(self.units.point(point) - self.center)).component_div(&self.widths)
    }

    /// Converts the integrals to the moments in the solid's own frame.
    fn grown(&self, round: &Integrals<3>) -> Moments<3> {
        let has_volume = round.mass > NOTHING;
        let map = self.axes * M3::from_diagonal(&self.widths);
        let mass = if has_volume { round.mass * self.widths.product() } else { 0.0 };
        let middle = if has_volume { round.first / round.mass } else { V3::zeros() };
        let center = self.center + map * middle;
        let second = (round.second / round.mass - middle * middle.transpose()) * mass;
        let body = if has_volume {
            Moments::of_seconds(mass, center, &(map * second * map.transpose()))
        } else {
            Moments::massless(center)
        };
        self.units.grown(&body)
    }
}

/// A solid that is cut into slices in its round frame.
struct Sliced<'m, N: Real> {
    map: &'m dyn SupportMap<N, 3>,
    round: RoundFrame,
}

impl<N: Real> Sliced<'_, N> {
    fn support(&self, direction: &V3) -> V3 {
        let toward = self.round.direction(direction);
        self.round.point(&self.map.support_point(&toward.map(N::lit)))
    }

    /// Returns the integrals over the solid in its round frame.
    fn integrals(&self) -> Integrals<3> {
        let [bottom, top] = [-V3::z(), V3::z()].map(|direction| self.support(&direction));
        let quarter = core::f64::consts::FRAC_PI_2;
        let whole = self.group([bottom, top], [-quarter, quarter]);
        let mut sum = Integrals::none();
        self.halve([bottom, top], [-quarter, quarter], &whole, HALVINGS, &mut sum);
        sum
    }

    /// Adds the slices between two angles, halving the interval until the sum is accurate enough.
    /// `whole` is the sum with the slices of the interval as one group.
    fn halve(
        &self,
        ends: [V3; 2],
        [from, to]: [f64; 2],
        whole: &Integrals<3>,
        depth: u32,
        sum: &mut Integrals<3>,
    ) {
        let middle = (from + to) * 0.5;
        let spans = [[from, middle], [middle, to]];
        let halves = spans.map(|span| self.group(ends, span));
        let size = |group: &Integrals<3>| group.mass + group.second.trace();
        let off = size(&halves[0]) + size(&halves[1]) - size(whole);
        for (span, half) in spans.into_iter().zip(&halves) {
            if depth > 0 && off.abs() > ENOUGH {
                self.halve(ends, span, half, depth - 1, sum);
            } else {
                sum.add_about(&V3::zeros(), half);
            }
        }
    }

    /// Sums slices at Gauss-Legendre nodes between two angles. The angle of a slice is its
    /// latitude: a slice at the height z of a ball of radius r has the angle asin(z / r). The area
    /// of a slice is a smooth function of this angle, even at the ends of a solid that is round
    /// there.
    fn group(&self, ends: [V3; 2], [from, to]: [f64; 2]) -> Integrals<3> {
        let (center, half) = ((ends[0].z + ends[1].z) * 0.5, (ends[1].z - ends[0].z) * 0.5);
        let (middle, step, mut sum) = ((from + to) * 0.5, (to - from) * 0.5, Integrals::none());
        for [node, weight] in NODES.into_iter().flat_map(|[x, weight]| [[-x, weight], [x, weight]])
        {
            let (sine, cosine) = libm::sincos(middle + node * step);
            self.add_slice(ends, center + half * sine, weight * step * half * cosine, &mut sum);
        }
        sum
    }

    /// Adds the slice at the height `z`, with a weight.
    fn add_slice(&self, ends: [V3; 2], z: f64, weight: f64, sum: &mut Integrals<3>) {
        let support = |direction: &V2| self.slice_support(ends, z, direction);
        let mut tracing = Tracing::new(&support, FLAT);
        tracing.trace(DEPTH);
        let Integrals { mass, first, second } = tracing.sum;
        sum.mass += mass * weight;
        sum.first += V3::new(first.x, first.y, mass * z) * weight;
        let (xz, yz) = (first.x * z, first.y * z);
        sum.second += M3::new(
            second[(0, 0)],
            second[(0, 1)],
            xz,
            second[(1, 0)],
            second[(1, 1)],
            yz,
            xz,
            yz,
            mass * z * z,
        ) * weight;
    }

    /// Returns the support point of the slice at the height `z`. It is on the outline of the solid
    /// in the plane of the direction and the z axis, between `below` and `above`. The remaining
    /// region between their chord and the outline is approximated by a parabola.
    fn slice_support(&self, [mut below, mut above]: [V3; 2], z: f64, direction: &V2) -> V2 {
        let outward = V3::new(direction.x, direction.y, 0.0);
        for _ in 0..MAX_STEPS {
            let chord = above - below;
            // The normal of the chord, pointing out of the solid.
            let across = outward * chord.z - V3::z() * chord.dot(&outward);
            let length = across.norm();
            if chord.z <= 0.0 || length <= 0.0 {
                break;
            }
            let top = self.support(&across);
            // The height of the outline over the chord, measured within the slice.
            let height = (top - below).dot(&across) / chord.z;
            if height <= FLAT {
                let share = (z - below.z) / chord.z;
                let bulge = if height > 0.0 { height * 4.0 * share * (1.0 - share) } else { 0.0 };
                return (below + chord * share).xy() + direction * bulge;
            }
            if top.z > z { above = top } else { below = top }
        }
        below.xy()
    }
}
