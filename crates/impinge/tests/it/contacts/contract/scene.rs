//! Pairs of placed solids, in each of the regimes in which contacts are tested.

use impinge::math::{AbstractRotation, Isometry, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::Shape;
use impinge_reference::geometry::vector::scale;
use impinge_reference::precise;
use impinge_reference::random::Random;

use super::forms::{Form, Sizes};
use super::turns::Turns;

/// Number of scenes per pair of kinds: every gap with every alignment.
pub(crate) const SCENES: usize = GAPS.len() * 4;

/// Signed distances as multiples of the smaller bounding radius, which counts as at least 0.01.
/// `None` keeps the drawn position, usually with the origins close to each other.
const GAPS: [Option<f64>; 5] = [Some(0.05), Some(0.0), Some(-1e-4), Some(-0.3), None];

/// Kind of rotation of the second solid relative to the first.
#[derive(Clone, Copy, Debug)]
enum Alignment {
    Any,
    /// A rotation that maps axes to axes.
    Aligned,
    /// A rotation that maps axes to axes except for a tilt of 1e-7 to 1e-2 radians.
    Nearly,
    /// A rotation that maps axes to axes except for a tilt of `EPSILON / 16` to `16 * EPSILON`
    /// radians.
    Hardly,
}

const ALIGNMENTS: [Alignment; 4] =
    [Alignment::Any, Alignment::Aligned, Alignment::Nearly, Alignment::Hardly];

/// A further property of a scene, drawn at random.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Setup {
    Plain,
    /// Half of the lengths are zero.
    Degenerate,
    /// Both solids are up to 10⁴ away from the world's origin.
    Far,
    /// Both are rotated together, so that no direction is along an axis of the world.
    Turned,
    /// The second solid is about thirty times smaller or larger than the first.
    Unlike,
}

const SETUPS: [Setup; 6] =
    [Setup::Plain, Setup::Plain, Setup::Degenerate, Setup::Far, Setup::Turned, Setup::Unlike];

/// The functions that depend on the dimension.
pub(crate) struct Stage<N: Real, R, const D: usize> {
    pub(crate) names: &'static [&'static str],
    pub(crate) form: fn(usize, Sizes, &mut Random) -> Form<N, D>,
    pub(crate) turns: Turns<R>,
    /// Converts a pose to the pose of the precise reference.
    pub(crate) precise: fn(&Isometry<N, R, D>) -> precise::Pose<D>,
}

/// Parameters from which a solid is drawn, at any scale.
#[derive(Clone, Copy, Debug)]
struct Recipe {
    kind: usize,
    sizes: Sizes,
    seed: u64,
}

/// Two placed solids, with the predictions for which their contacts are computed.
pub(crate) struct Scene<N: Real, R, const D: usize> {
    recipes: [Recipe; 2],
    pub(crate) forms: [Form<N, D>; 2],
    pub(crate) poses: [Isometry<N, R, D>; 2],
    /// Linear prediction.
    pub(crate) limit: N,
    /// Angular prediction.
    pub(crate) angle: N,
    /// A small translation of the second solid, for tests of persistent ids.
    pub(crate) step: Vector<N, D>,
    /// Whether one solid lies in the middle of a much larger one.
    pub(crate) is_swallowed: bool,
    /// Whether some lengths are zero.
    pub(crate) is_degenerate: bool,
    /// Description of the regime, for messages.
    regime: String,
}

impl<N, R, const D: usize> Stage<N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    /// Makes scene `number` of two kinds.
    pub(crate) fn scene(&self, kinds: [usize; 2], number: usize, seed: u64) -> Scene<N, R, D> {
        let random = &mut Random::new(seed);
        let (gap, alignment) = (GAPS[number % GAPS.len()], ALIGNMENTS[number / GAPS.len() % 4]);
        let setup = *random.pick(&SETUPS);
        let ratio = if setup == Setup::Unlike { *random.pick(&[0.03, 30.0]) } else { 1.0 };
        let recipe = |index: usize, seed: u64| {
            let sizes =
                Sizes { least: [0.1, 0.1 * ratio][index], zeros: setup == Setup::Degenerate };
            Recipe { kind: kinds[index], sizes, seed }
        };
        let recipes = [recipe(0, random.bits()), recipe(1, random.bits())];
        let forms = recipes.map(|recipe| self.draw(&recipe));
        // The length in which offsets of the scene are measured. Two points have a bounding radius
        // of zero, hence the minimum.
        let length = (forms[0].reach + forms[1].reach).max(0.1);
        let mut poses = self.places(length, gap, alignment, random);
        if let Some(gap) = gap {
            let smaller = forms[0].reach.min(forms[1].reach).max(0.01);
            bring(&forms, &mut poses, N::lit(gap * smaller));
        }
        self.set_up(setup, &mut poses, random);
        poses.iter_mut().for_each(|pose| drop_dust(pose, N::lit(length)));
        let limit = limit(&forms, &poses, N::lit(0.1 * length), random);
        let step = random.vector::<D>(1e-4 * length).map(N::lit).into();
        Scene {
            recipes,
            forms,
            poses,
            limit,
            angle: N::lit(*random.pick(&[0.0, 0.05])),
            step,
            is_degenerate: setup == Setup::Degenerate,
            is_swallowed: setup == Setup::Unlike && gap.is_none(),
            regime: format!("gap {gap:?}, {alignment:?}, {setup:?}, scene {number} of seed {seed}"),
        }
    }

    fn draw(&self, recipe: &Recipe) -> Form<N, D> {
        (self.form)(recipe.kind, recipe.sizes, &mut Random::new(recipe.seed))
    }

    /// Returns poses with the first solid at the origin. The second one is 1.5 times `length` above
    /// or below it; if `gap` is `None`, at most 0.01 times `length` above it.
    fn places(
        &self,
        length: f64,
        gap: Option<f64>,
        alignment: Alignment,
        random: &mut Random,
    ) -> [Isometry<N, R, D>; 2] {
        let lean = match alignment {
            Alignment::Any | Alignment::Aligned => 0.0,
            Alignment::Nearly => 10.0_f64.powf(-random.range(2.0, 7.0)),
            Alignment::Hardly => N::EPSILON.as_f64() * 2.0_f64.powf(random.range(-4.0, 4.0)),
        };
        let turn = match alignment {
            Alignment::Any => (self.turns.any)(random),
            Alignment::Aligned => (self.turns.straight)(random),
            Alignment::Nearly | Alignment::Hardly => {
                (self.turns.straight)(random) * (self.turns.tilt)(lean, random)
            }
        };
        // The second solid is above or below the first: exactly, with an offset of 1e-7, or with
        // any offset up to `length` along each axis.
        let beside = *random.pick(&[0.0, 0.0, 1e-7, 1.0]);
        let mut away = scale(&random.vector::<D>(1.0), beside * length);
        away[1] = length * *random.pick(if gap.is_some() { &[1.5, -1.5] } else { &[0.0, 0.01] });
        let away = Vector::<N, D>::from(away.map(N::lit));
        let at = [Vector::<N, D>::zeros(), away];
        let mut poses = at.map(|at| Isometry::from_parts(at.into(), R::identity()));
        poses[1].rotation = turn;
        poses
    }

    fn set_up(&self, setup: Setup, poses: &mut [Isometry<N, R, D>; 2], random: &mut Random) {
        match setup {
            Setup::Plain | Setup::Degenerate | Setup::Unlike => {}
            Setup::Far => {
                let far = Vector::<N, D>::from(random.vector::<D>(1e4).map(N::lit));
                poses.iter_mut().for_each(|pose| pose.translation.vector += far);
            }
            Setup::Turned => {
                let turn = (self.turns.any)(random);
                for pose in poses {
                    pose.translation.vector = turn.transform_vector(&pose.translation.vector);
                    pose.rotation = turn.clone() * pose.rotation.clone();
                }
            }
        }
    }

    /// Returns the scene scaled by a power of two.
    pub(crate) fn scaled(&self, scene: &Scene<N, R, D>, scale: f64) -> Scene<N, R, D> {
        let recipes = scene.recipes.map(|recipe| {
            let sizes = Sizes { least: recipe.sizes.least * scale, ..recipe.sizes };
            Recipe { sizes, ..recipe }
        });
        let factor = N::lit(scale);
        let mut poses = scene.poses.clone();
        poses.iter_mut().for_each(|pose| pose.translation.vector *= factor);
        Scene {
            recipes,
            forms: recipes.map(|recipe| self.draw(&recipe)),
            poses,
            limit: scene.limit * factor,
            step: scene.step * factor,
            regime: format!("{} times as large, {}", scale, scene.regime),
            ..*scene
        }
    }
}

/// Moves the second solid along the normal until the signed distance is about `gap`.
fn bring<N, R, const D: usize>(forms: &[Form<N, D>; 2], poses: &mut [Isometry<N, R, D>; 2], gap: N)
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D>,
{
    let [shape1, shape2] = forms.each_ref().map(|form| &*form.shape);
    if let Some(found) = contact(&poses[0], shape1, &poses[1], shape2, N::INFINITY) {
        poses[1].translation.vector += found.normal.into_inner() * (found.depth + gap);
    }
}

/// Sets coordinates of the position to zero if they are less than 1/1024 of the rounding error of
/// `length`, so that no product of a few coordinates underflows.
fn drop_dust<N, R, const D: usize>(pose: &mut Isometry<N, R, D>, length: N)
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D>,
{
    let least = length * N::EPSILON * N::lit(1.0 / 1024.0);
    for x in pose.translation.vector.iter_mut().filter(|x| x.abs() < least) {
        *x = N::ZERO;
    }
}

/// Returns a prediction: mostly `wide`; else zero, exactly the distance, or slightly less than it.
fn limit<N, R, const D: usize>(
    forms: &[Form<N, D>; 2],
    poses: &[Isometry<N, R, D>; 2],
    wide: N,
    random: &mut Random,
) -> N
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D>,
{
    let [shape1, shape2] = forms.each_ref().map(|form| &*form.shape);
    let found = contact(&poses[0], shape1, &poses[1], shape2, N::INFINITY);
    let distance = found.map_or(N::ZERO, |found| -found.depth);
    let is_apart = distance > N::ZERO;
    match random.below(8) {
        0 => N::ZERO,
        1 if is_apart => distance,
        2 if is_apart => distance - distance * N::EPSILON,
        _ => wide,
    }
}

impl<N, R, const D: usize> Scene<N, R, D>
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Clone + std::fmt::Debug,
{
    pub(crate) fn shapes(&self) -> [&dyn Shape<N, D>; 2] {
        self.forms.each_ref().map(|form| &*form.shape)
    }

    /// Returns the poses after a small step of the second solid.
    pub(crate) fn moved(&self) -> [Isometry<N, R, D>; 2] {
        let mut poses = self.poses.clone();
        poses[1].translation.vector += self.step;
        poses
    }

    /// Returns the unit of errors of points: `EPSILON` times the size of the scene. That size is
    /// the sum of both bounding radii, the distance between the origins of the solids, and the
    /// distance of the first from the world's origin, since points are in world coordinates.
    pub(crate) fn unit(&self) -> f64 {
        let at = self.poses.each_ref().map(|pose| pose.translation.vector.map(N::as_f64));
        let size = self.forms[0].reach + self.forms[1].reach;
        N::EPSILON.as_f64() * (size + (at[1] - at[0]).norm() + at[0].norm())
    }

    /// Returns `true` if the solids are equal and at the same position, so that their order is
    /// undefined.
    pub(crate) fn is_twin(&self) -> bool {
        let [shape1, shape2] = self.shapes().map(|shape| format!("{shape:?}"));
        let [pose1, pose2] = &self.poses;
        shape1 == shape2 && pose1.translation == pose2.translation
    }
}

impl<N: Real, R: std::fmt::Debug, const D: usize> std::fmt::Display for Scene<N, R, D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [text1, text2] = self.forms.each_ref().map(|form| &form.text);
        let [pose1, pose2] = &self.poses;
        let (limit, angle) = (self.limit, self.angle);
        write!(f, "{text1} at {pose1:?} and {text2} at {pose2:?}; ")?;
        write!(f, "predictions {limit:?} and {angle:?}; {}", self.regime)
    }
}
