//! The laws of the contract, tested on one scene.

use std::collections::BTreeSet;

use impinge::math::{AbstractRotation, Isometry, Point, Pose, Real, Space, max};
use impinge::query::{ContactId, TrackedContact, contact};
use impinge::shape::FeatureId;
use impinge_reference::precise::{Precise, Quad, Solid, separation_along, signed_distance};

use super::answers::{Lone, Points};
use super::forms::local;
use super::report::Report;
use super::scene::{SCENES, Scene, Stage};
use super::tolerances::{is_curved, is_of_revolution, is_promised, points_promised, promised};

/// A scene, and the report that collects its violations.
pub(crate) struct Judge<'a, N: Real, R, const D: usize> {
    pub(crate) stage: &'a Stage<N, R, D>,
    pub(crate) scene: &'a Scene<N, R, D>,
    pub(crate) names: [&'static str; 2],
    /// Index of the scene among the scenes of its pair of kinds.
    pub(crate) number: usize,
    pub(crate) report: &'a mut Report,
}

/// Returns the deepest point, the first among equals; `None` if there are no points.
fn deepest<N: Real, const D: usize>(points: &Points<N, D>) -> Option<&TrackedContact<N, D>> {
    points.iter().reduce(
        |best, point| {
            if point.contact.depth > best.contact.depth { point } else { best }
        },
    )
}

/// Returns `true` if both have equal contacts and kinematics; ids are ignored.
pub(crate) fn are_same<N: Real, const D: usize>(one: &Points<N, D>, two: &Points<N, D>) -> bool {
    one.len() == two.len()
        && one.iter().zip(two).all(|(a, b)| a.contact == b.contact && a.kinematic == b.kinematic)
}

/// Returns, for each point of `after`, the index of the point of `before` with the same id; `None`
/// if there is none.
pub(crate) fn kept<N: Real, const D: usize>(
    before: &Points<N, D>,
    after: &Points<N, D>,
) -> Vec<Option<usize>> {
    after.iter().map(|point| before.iter().position(|old| old.id == point.id)).collect()
}

impl<N, R, const D: usize> Judge<'_, N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    fn law(&self, law: &str) -> String {
        format!("{law}, {} and {}", self.names[0], self.names[1])
    }

    pub(crate) fn holds(&mut self, law: &str, holds: bool, what: impl FnOnce() -> String) {
        let scene = self.scene;
        self.report.holds(self.law(law), holds, || format!("{}; {scene}", what()));
    }

    fn within(&mut self, law: &str, error: f64, allowed: f64, what: impl FnOnce() -> String) {
        let scene = self.scene;
        self.report.within(self.law(law), error, allowed, || format!("{}; {scene}", what()));
    }

    fn lone(&self, poses: &[Isometry<N, R, D>; 2], limit: N) -> Points<N, D> {
        Lone::new().ask(poses.each_ref(), self.scene.shapes(), limit, self.scene.angle)
    }

    /// Returns the points of one pair alone.
    pub(crate) fn points(&self) -> Points<N, D> {
        self.lone(&self.scene.poses, self.scene.limit)
    }

    /// Tests all laws of one pair alone, and returns its points.
    pub(crate) fn alone(&mut self) -> Points<N, D> {
        let found = self.points();
        self.depth(&found);
        self.on_both(&found);
        self.at_most(&found);
        self.flips(&found);
        self.scales(&found);
        self.agrees(&found);
        found
    }

    fn solids(&self) -> [&Solid<D>; 2] {
        let solids = self.scene.forms.each_ref();
        solids.map(|form| form.precise.as_ref().expect("the reference knows all convex kinds"))
    }

    /// Returns the separation along a normal by the precise reference; `None` for two half-spaces.
    fn along(&self, normal: &[f64; D]) -> Option<Quad> {
        let ([one, two], poses) =
            (self.solids(), self.scene.poses.each_ref().map(self.stage.precise));
        separation_along(one, &poses[0], two, &poses[1], normal)
    }

    /// Returns the signed distance by the precise reference, for all pairs in 2D and all pairs
    /// without curved faces. For other pairs the reference has to search, so only some scenes have
    /// a result. `None` also if the reference has not converged to 1e-17 of the size.
    fn truth(&self) -> Option<Precise<D>> {
        let is_quick = D == 2 || !self.names.iter().any(|name| is_curved(name));
        let is_sampled = [3, 9].contains(&(self.number % (SCENES / 2)));
        if !is_quick && !is_sampled {
            return None;
        }
        let ([one, two], poses) =
            (self.solids(), self.scene.poses.each_ref().map(self.stage.precise));
        let truth = signed_distance(one, &poses[0], two, &poses[1]);
        truth.is_settled(1e-17).then_some(truth)
    }

    /// Returns the sum of both bounding radii and of the distance between the origins of the
    /// solids. Errors of depths are measured in units of epsilon times this length.
    fn size(&self) -> f64 {
        let at = self.scene.poses.each_ref().map(|pose| pose.translation.vector.map(N::as_f64));
        self.scene.forms[0].reach + self.scene.forms[1].reach + (at[1] - at[0]).norm()
    }

    /// Law 1: the depth is minus the separation. The separation along the contact normal equals
    /// minus the depth, so the depth is not too small. The positions of the points prove that it is
    /// not too large if the solids are apart; otherwise the reference does.
    fn depth(&mut self, found: &Points<N, D>) {
        let unit = N::EPSILON.as_f64() * self.size();
        let (allowed, scene) = (promised::<N, D>(self.names), self.scene);
        let units = |length: f64| if length == 0.0 { 0.0 } else { length / unit };
        let Some(deepest) = deepest(found) else {
            let [shape1, shape2] = scene.shapes();
            let [pose1, pose2] = &scene.poses;
            let nearest = contact(pose1, shape1, pose2, shape2, N::INFINITY);
            let normal = nearest.map(|found| found.normal.map(N::as_f64).into());
            let own = normal.and_then(|normal| self.along(&normal)).expect("a normal");
            let missed = scene.limit.as_f64() - own.to_f64();
            let what = || format!("no contact, but {own:?} along {normal:?}");
            return self.within("1 missed", units(missed), allowed, what);
        };
        let distance = -Quad::new(deepest.contact.depth.as_f64());
        let normal = deepest.contact.normal.map(N::as_f64).into();
        let own = self.along(&normal).expect("a unit normal");
        let what = |truth: Quad| move || format!("{distance:?}, not {truth:?}: {deepest:?}");
        self.within("1 normal", units((own - distance).abs().to_f64()), allowed, what(own));
        let is_promised = is_promised(self.names, scene.is_swallowed);
        if let Some(truth) = self.truth().filter(|_| is_promised) {
            let error = (truth.distance - distance).abs().to_f64();
            self.within("1 depth", units(error), allowed, what(truth.distance));
        }
    }

    /// Law 2: each point lies on both surfaces, and its two positions are opposite each other along
    /// the one unit normal of the manifold.
    fn on_both(&mut self, found: &Points<N, D>) {
        let allowed = points_promised::<N, D>(self.names, self.scene.is_degenerate);
        // Several points may be equally deep up to rounding, so one of them must satisfy the strict
        // bound.
        let slack = N::lit(promised::<N, D>(self.names) * self.size()) * N::EPSILON;
        let least = deepest(found).map_or(N::ZERO, |point| point.contact.depth - slack);
        let mut off_deepest = f64::INFINITY;
        for point in found {
            let [strict, error] = [0.0, 1.0].map(|share| self.off(point, share, found.len()));
            self.within("2 points", error, allowed, || format!("{point:?} of {found:?}"));
            if point.contact.depth >= least {
                off_deepest = off_deepest.min(strict);
            }
            let excess = (point.contact.normal.norm() - N::ONE).abs() / N::EPSILON;
            let is_one = point.contact.normal == found[0].contact.normal;
            self.within("2 unit normal", excess.as_f64(), 32.0, || format!("{point:?}"));
            self.holds("2 one normal", is_one, || format!("{found:?}"));
        }
        if !found.is_empty() {
            self.within("2 deepest point", off_deepest, allowed, || format!("{found:?}"));
        }
    }

    /// Returns the error of a point in units: the distance of its positions from the surfaces, or
    /// the mismatch between their offset and the depth along the normal. At points other than the
    /// deepest, a tilted face of a rounded solid is treated as flat; the fraction `forgiven` of
    /// that allowance is subtracted. If the angular prediction makes two edges parallel, their
    /// points lie halfway between the edges.
    fn off(&self, point: &TrackedContact<N, D>, forgiven: f64, count: usize) -> f64 {
        let (scene, contact) = (self.scene, &point.contact);
        let is_halfway = D == 3 && count <= 2;
        let halfway = if is_halfway { 0.5 * scene.angle.as_f64() * self.size() } else { 0.0 };
        let off = |index: usize, at| {
            let (form, pose) = (&scene.forms[index], Pose::from_isometry(&scene.poses[index]));
            (form.off(&local(&pose, at)) - forgiven * form.beside - halfway).max(0.0)
        };
        let across = contact.world2 - contact.world1 + contact.normal.into_inner() * contact.depth;
        let errors = [off(0, &contact.world1), off(1, &contact.world2), across.norm().as_f64()];
        let most = errors.into_iter().fold(0.0, f64::max);
        if most == 0.0 { 0.0 } else { most / scene.unit() }
    }

    /// Law 3: a manifold has at most two points in 2D and four in 3D, or `max_points` if that is
    /// fewer. Whatever the limit, it contains a deepest point.
    fn at_most(&mut self, found: &Points<N, D>) {
        self.holds("3 at most", found.len() <= 1 << (D - 1), || format!("{found:?}"));
        let (scene, unit) = (self.scene, N::EPSILON.as_f64() * self.size());
        for max_points in [1, 8] {
            let mut lone = Lone::with_max_points(max_points);
            let few = lone.ask(scene.poses.each_ref(), scene.shapes(), scene.limit, scene.angle);
            let is_fine = few.len() <= max_points && few.is_empty() == found.is_empty();
            self.holds("3 at most", is_fine, || format!("{few:?} of {max_points}, not {found:?}"));
            if let (Some(one), Some(other)) = (deepest(&few), deepest(found)) {
                let error = (one.contact.depth - other.contact.depth).abs().as_f64();
                let error = if error == 0.0 { 0.0 } else { error / unit };
                let what = || format!("{few:?} of {max_points}, not {found:?}");
                self.within("3 deepest", error, promised::<N, D>(self.names), what);
            }
        }
    }

    /// Law 5: exchanging the solids flips each contact and its features. Two equal solids at the
    /// same position have no defined order and are skipped.
    fn flips(&mut self, found: &Points<N, D>) {
        if self.scene.is_twin() {
            return;
        }
        let ([pose1, pose2], [shape1, shape2]) = (&self.scene.poses, self.scene.shapes());
        let (limit, angle) = (self.scene.limit, self.scene.angle);
        let flipped = Lone::new().ask([pose2, pose1], [shape2, shape1], limit, angle);
        let is_flip = |(one, other): (&TrackedContact<N, D>, &TrackedContact<N, D>)| {
            let [one_k, other_k] = [&one.kinematic, &other.kinematic];
            one.contact == other.contact.flipped()
                && one_k.feature1() == other_k.feature2()
                && one_k.feature2() == other_k.feature1()
        };
        let are_flips = flipped.len() == found.len() && found.iter().zip(&flipped).all(is_flip);
        self.holds("5 flipped manifold", are_flips, || format!("{found:?}, flipped {flipped:?}"));
        let one = contact(pose1, shape1, pose2, shape2, limit);
        let other = contact(pose2, shape2, pose1, shape1, limit).map(|found| found.flipped());
        self.holds("5 flipped query", one == other, || format!("{one:?}, flipped {other:?}"));
    }

    /// Law 5: scaling all lengths of a scene by a power of two scales the points and depths of its
    /// contacts exactly, except where numbers underflow, and changes nothing else.
    fn scales(&mut self, found: &Points<N, D>) {
        for scale in [1.0 / 1_048_576.0, 1_048_576.0] {
            let scene = self.stage.scaled(self.scene, scale);
            let factor = N::lit(scale);
            let (poses, shapes) = (scene.poses.each_ref(), scene.shapes());
            let scaled = Lone::new().ask(poses, shapes, scene.limit, scene.angle);
            let is_scaled = |(one, other): (&TrackedContact<N, D>, &TrackedContact<N, D>)| {
                let [a, b] = [&one.contact, &other.contact];
                let [one_k, other_k] = [&one.kinematic, &other.kinematic];
                let alike = |x: N, y: N| x == y || max(x.abs(), y.abs()) <= N::MIN_POSITIVE;
                let far = |x: &Point<N, D>, y: &Point<N, D>| {
                    x.iter().zip(y.iter()).all(|(x, y)| alike(*x * factor, *y))
                };
                far(&a.world1, &b.world1)
                    && far(&a.world2, &b.world2)
                    && alike(a.depth * factor, b.depth)
                    && a.normal == b.normal
                    && one_k.feature1() == other_k.feature1()
                    && one_k.feature2() == other_k.feature2()
            };
            let are_scaled =
                scaled.len() == found.len() && found.iter().zip(&scaled).all(is_scaled);
            self.holds("5 scaled", are_scaled, || format!("{found:?}, {scale} times {scaled:?}"));
        }
    }

    /// Law 6: `contact` returns a contact if and only if the manifold has points, and its depth is
    /// the depth of the deepest point. If the prediction is not zero and equals the distance up to
    /// rounding, one of the two may have no contact.
    fn agrees(&mut self, found: &Points<N, D>) {
        let ([pose1, pose2], [shape1, shape2]) = (&self.scene.poses, self.scene.shapes());
        let unit = N::EPSILON.as_f64() * self.size();
        let allowed = promised::<N, D>(self.names);
        let single = contact(pose1, shape1, pose2, shape2, self.scene.limit);
        if let (Some(single), Some(deepest)) = (single, deepest(found)) {
            let error = (single.depth - deepest.contact.depth).abs().as_f64();
            let error = if error == 0.0 { 0.0 } else { error / unit };
            let what = || format!("{single:?}, not {deepest:?}");
            self.within("6 depth", error, allowed, what);
        }
        let nearest = contact(pose1, shape1, pose2, shape2, N::INFINITY);
        let distance = nearest.map_or(N::ZERO, |found| -found.depth);
        let slack = N::lit(allowed * unit);
        for limit in [N::ZERO, distance - slack, distance + slack, self.scene.limit] {
            let is_near = (limit - distance).abs() < slack;
            if limit < N::ZERO || is_near && limit > N::ZERO {
                continue;
            }
            let points = self.lone(&self.scene.poses, limit);
            let expected = distance <= limit;
            let single = contact(pose1, shape1, pose2, shape2, limit).is_some();
            self.holds("6 touching", [single, !points.is_empty()] == [expected; 2], || {
                format!("within {limit:?}: {single} and {points:?}, not {expected}")
            });
        }
    }

    /// Law 4: a point keeps its id if it is the only one with its pair of features before and
    /// after. A new id has never been used before.
    pub(crate) fn names(
        &mut self,
        before: &Points<N, D>,
        after: &Points<N, D>,
        given: &mut BTreeSet<ContactId>,
    ) {
        let features =
            |point: &TrackedContact<N, D>| [point.kinematic.feature1(), point.kinematic.feature2()];
        let only = |points: &Points<N, D>, wanted| {
            let mut on = points.iter().filter(|point| features(point) == wanted);
            on.next().filter(|_| on.next().is_none()).copied()
        };
        // Ids may also change if the normal rotates by more than 41 degrees, and where edges cross
        // in scenes with sizes of zero.
        let is_edge = |id: &FeatureId| matches!(id, FeatureId::Edge(_));
        let may_begin = |old: &TrackedContact<N, D>, new: &TrackedContact<N, D>| {
            old.contact.normal.dot(&new.contact.normal) < N::lit(0.75)
                || self.scene.is_degenerate && features(new).iter().all(is_edge)
        };
        // All points of a circular rim lie on one feature, so features do not identify them.
        let is_named = !self.names.iter().any(|name| is_of_revolution(name));
        let mut ids: Vec<ContactId> = Vec::new();
        for point in after {
            let wanted = features(point);
            if let (Some(old), Some(new)) = (only(before, wanted), only(after, wanted)) {
                let is_kept = old.id == new.id || may_begin(&old, &new);
                self.holds("4 ids stay", is_kept || !is_named, || {
                    format!("{before:?} becomes {after:?}")
                });
            }
            let is_old = before.iter().any(|old| old.id == point.id);
            let is_fresh = !ids.contains(&point.id) && (is_old || !given.contains(&point.id));
            self.holds("4 ids once", is_fresh, || format!("{before:?} becomes {after:?}"));
            ids.push(point.id);
        }
        given.extend(ids);
    }
}
