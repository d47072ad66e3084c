//! What is to be said of each pair of parts.

use super::judge::{Case, Verdict, faces, judge};
use super::scene::{PartPair, Scene};
use crate::convex::Separation;
use crate::math::{Point, Real, Space, Vector};
use crate::query::manifold_build::{Along, Patch, build_along, build_between, features_at_witness};
use crate::query::{ManifoldRequest, RawManifold};

/// How a contact of two parts stands as one of the two shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    /// It is one.
    Own,
    /// It is one with the face of a part, whose seams the parts alone would touch at.
    Snapped,
    /// It is none, as long as there is another.
    Left,
}

/// Two parts that are within reach of each other. All in the moved frame of the first shape.
#[derive(Clone, Debug)]
pub(super) struct Finding<N: Real, const D: usize> {
    pub(super) parts: [u32; 2],
    /// How far the two are apart, each taken alone.
    pub(super) distance: N,
    /// What they say of the contact of the shapes; empty if nothing.
    pub(super) patch: Patch<N, D>,
    pub(super) standing: Standing,
    /// Lengths below this are rounding errors.
    pub(super) tolerance: N,
}

impl<N: Real, const D: usize> Finding<N, D> {
    /// The least distance of its points.
    pub(super) fn lowest(&self) -> N {
        let distances = self.patch.points.iter().map(|point| point.raw.distance);
        distances.fold(N::INFINITY, crate::math::min)
    }
}

/// Where the solid that meets a surface comes from, where it is not just its middle.
pub(super) type Reference<N, const D: usize> = Option<Point<N, D>>;

/// What is to be said of two parts; `None` if they are beyond reach or cannot touch.
pub(super) fn finding<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    parts: [u32; 2],
    reference: &Reference<N, D>,
    request: &ManifoldRequest<N>,
) -> Option<Finding<N, D>> {
    let placed = scene.pair(parts);
    let has_surface = scene.first.surface.is_some() || scene.second.surface.is_some();
    match placed.centers() {
        [Some(center1), Some(center2)] if has_surface => {
            let centers = [center1, center2];
            of_surfaces(scene, &Meeting { placed, parts, centers, reference }, request)
        }
        // A half-space has the same normal everywhere: there are no seams to slide over.
        _ => plain(&placed, parts, request),
    }
}

/// Solids side by side: their contacts are those of the whole.
fn plain<N: Space<D>, const D: usize>(
    placed: &PartPair<'_, N, D>,
    parts: [u32; 2],
    request: &ManifoldRequest<N>,
) -> Option<Finding<N, D>> {
    let mut raw = RawManifold::default();
    (N::tables().contacts)(&placed.pair(), request, &mut raw);
    let patch = placed.patch(&raw, parts);
    let (standing, tolerance) = (Standing::Own, placed.tolerance());
    let mut finding = Finding { parts, distance: N::INFINITY, patch, standing, tolerance };
    finding.distance = finding.lowest();
    (!finding.patch.points.is_empty()).then_some(finding)
}

/// Two parts, of which one at least belongs to a surface.
struct Meeting<'a, N: Real, const D: usize> {
    placed: PartPair<'a, N, D>,
    parts: [u32; 2],
    /// In the moved frames of the two shapes.
    centers: [Point<N, D>; 2],
    /// In the frame of the second shape, of the first.
    reference: &'a Reference<N, D>,
}

impl<N: Space<D>, const D: usize> Meeting<'_, N, D> {
    /// From where the other solid comes to the part of the first shape and to that of the second, in
    /// the frames of the shapes.
    fn origins(&self, scene: &Scene<'_, N, D>) -> [Point<N, D>; 2] {
        let to_second = self.reference.unwrap_or_else(|| scene.in_second(&self.centers[0]));
        [scene.in_first(&self.centers[1]), to_second]
    }

    /// What the two surfaces say of a separation of the two parts.
    fn verdicts(
        &self,
        scene: &Scene<'_, N, D>,
        found: &Separation<N, D>,
        request: &ManifoldRequest<N>,
    ) -> [Verdict<N, D>; 2] {
        let origins = self.origins(scene);
        let [origin1, origin2] = &origins;
        let can_touch = faces(&scene.first, self.parts[0], origin1)
            && faces(&scene.second, self.parts[1], origin2);
        if !can_touch {
            return [Verdict::Nothing; 2];
        }
        let features = features_at_witness(&self.placed.pair(), found, request);
        let [feature1, feature2] = self.placed.turned(features);
        let normal = self.placed.outward(&found.normal);
        let case1 = Case {
            part: self.parts[0],
            feature: feature1,
            outward: normal,
            toward: origin1 - (self.centers[0] + scene.first.origin),
        };
        let case2 = Case {
            part: self.parts[1],
            feature: feature2,
            outward: -scene.pose12.inverse_vector(&normal),
            toward: origin2 - (self.centers[1] + scene.second.origin),
        };
        [judge(&scene.first, &case1), judge(&scene.second, &case2)]
    }
}

fn of_surfaces<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    meeting: &Meeting<'_, N, D>,
    request: &ManifoldRequest<N>,
) -> Option<Finding<N, D>> {
    let (placed, parts) = (&meeting.placed, meeting.parts);
    let pair = placed.pair();
    let found = (N::tables().separation)(&pair, request.prediction)?;
    if !found.distance.is_finite_number() {
        return None;
    }
    let verdicts = meeting.verdicts(scene, &found, request);
    let normal = placed.outward(&found.normal);
    let mut raw = RawManifold::default();
    let standing = match settled(scene, &verdicts, &normal) {
        Settled::Nothing => return None,
        Settled::Refused => Standing::Left,
        Settled::Found(normal) => {
            let witness = Separation { normal: placed.inward(&normal), ..found };
            build_between(&pair, &witness, request, &mut raw);
            Standing::Own
        }
        Settled::Forced(normal) => {
            let least = if found.distance > N::ZERO { found.distance } else { -N::INFINITY };
            let along = Along { normal: placed.inward(&normal), least };
            build_along(&pair, &along, request, &mut raw);
            if raw.points.is_empty() { Standing::Left } else { Standing::Snapped }
        }
    };
    if standing == Standing::Left {
        build_between(&pair, &found, request, &mut raw);
    }
    let (patch, tolerance) = (placed.patch(&raw, parts), placed.tolerance());
    Some(Finding { parts, distance: found.distance, patch, standing, tolerance })
}

/// What both surfaces together say.
enum Settled<N: Real, const D: usize> {
    Nothing,
    Refused,
    /// A contact with this normal at the witness.
    Found(Vector<N, D>),
    /// Contacts with a face along this normal, where there are some.
    Forced(Vector<N, D>),
}

/// Takes the verdicts together; `normal` is the one that both are about. All in the moved frame of
/// the first shape.
fn settled<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    verdicts: &[Verdict<N, D>; 2],
    normal: &Vector<N, D>,
) -> Settled<N, D> {
    use Verdict::{Admitted, Face, Nothing, Refused, Snapped};
    let of_second = |face: &Vector<N, D>| -scene.pose12.vector(face);
    match verdicts {
        [Nothing, _] | [_, Nothing] => Settled::Nothing,
        [Snapped(face1), Snapped(face2)] => {
            let face2 = of_second(face2);
            let is_first_nearer = face1.dot(normal) > face2.dot(normal);
            Settled::Forced(if is_first_nearer { *face1 } else { face2 })
        }
        [_, Snapped(face)] => Settled::Forced(of_second(face)),
        [Snapped(face), _] => Settled::Forced(*face),
        [Refused, _] | [_, Refused] => Settled::Refused,
        [_, Face(face)] => Settled::Found(of_second(face)),
        [Face(face), _] => Settled::Found(*face),
        [Admitted, Admitted] => Settled::Found(*normal),
    }
}
