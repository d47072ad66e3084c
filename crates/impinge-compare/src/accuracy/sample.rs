//! Random pairs of solids at an intended distance, with their exact results.

use impinge_reference::geometry::vector::{add, norm, scale};
use impinge_reference::precise::vector::rounded;
use impinge_reference::precise::{Pose, Precise, Solid, signed_distance};
use impinge_reference::random::Random;

use super::form::{Form, Kind, Placement, Sample, Scalar};

/// The intended distance between the solids of a sample. `R` is the sum of their bounding radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Regime {
    /// The solids are 1 to 8 R apart.
    Far,
    /// The solids are 1e-4 to 1e-1 R apart.
    Near,
    /// The distance is zero up to the rounding of the position.
    Touching,
    /// The solids overlap by 1e-4 to 1e-1 R.
    Shallow,
    /// The centres of the solids are near each other. With a half-space, the other solid overlaps
    /// it by 0.5 R.
    Deep,
}

impl Regime {
    pub const ALL: [Self; 5] = [Self::Far, Self::Near, Self::Touching, Self::Shallow, Self::Deep];

    pub fn name(self) -> &'static str {
        match self {
            Self::Far => "far",
            Self::Near => "near",
            Self::Touching => "touching",
            Self::Shallow => "shallow",
            Self::Deep => "deep",
        }
    }

    /// Returns `true` if the solids of this regime overlap by more than rounding.
    pub fn is_overlap(self) -> bool {
        matches!(self, Self::Shallow | Self::Deep)
    }

    /// Returns the intended signed distance, as a fraction of R.
    fn target(self, random: &mut Random) -> f64 {
        let mut part = || random.magnitude(1e-4, 10);
        match self {
            Self::Far => 1.0 + 70.0 * part(),
            Self::Near => part(),
            Self::Touching => 0.0,
            Self::Shallow => -part(),
            Self::Deep => -0.5,
        }
    }

    /// Returns `true` if the exact signed distance `truth` is in the regime. `size` is the size of
    /// the scene, `reach` is R.
    fn holds(self, truth: f64, size: f64, reach: f64, epsilon: f64) -> bool {
        match self {
            Self::Far => truth > 0.5 * reach,
            Self::Near => truth > 64.0 * epsilon * size && truth < 0.5 * reach,
            Self::Touching => truth.abs() < 16.0 * epsilon * size,
            Self::Shallow => truth < -1e-5 * size && truth > -0.2 * reach,
            Self::Deep => truth < -1e-3 * size,
        }
    }
}

/// The functions of the reference that differ by dimension.
#[derive(Clone, Copy)]
pub struct Dimension<const D: usize> {
    /// Converts the kinds that exist in this dimension only to a solid of the reference.
    pub particular: fn(&Form<D>) -> Solid<D>,
    /// Converts a placement to a pose of the reference.
    pub pose: fn(&Placement<D>) -> Pose<D>,
    /// Returns a rotation of the given kind whose components are numbers of the scalar, and whose
    /// length is 1 up to a hundredth of the rounding error.
    pub rotation: fn(&mut Random, Scalar, Turn) -> [f64; 4],
}

/// The kind of a random rotation.
#[derive(Clone, Copy, Debug)]
pub enum Turn {
    /// A rotation by any angle.
    Free,
    /// A rotation that maps coordinate axes to coordinate axes.
    Aligned,
    /// A rotation by a small angle: its magnitude varies from less than 1e-6 to about 1e-1 radians.
    Slight,
}

/// A sample with an exact result.
pub struct Known<const D: usize> {
    pub sample: Sample<D>,
    pub solids: [Solid<D>; 2],
    pub poses: [Pose<D>; 2],
    pub truth: Precise<D>,
}

/// The number of draws of solids and poses after which a regime is considered impossible for two
/// kinds.
const TRIES: usize = 12;

/// Draws a pair of these kinds in a regime. `None` if no draw is in the regime: for instance, two
/// segments in 3D never overlap by more than rounding.
pub fn draw<const D: usize>(
    dimension: Dimension<D>,
    kinds: [Kind; 2],
    regime: Regime,
    scalar: Scalar,
    random: &mut Random,
) -> Option<Known<D>> {
    (0..TRIES).find_map(|_| attempt(dimension, kinds, regime, scalar, random))
}

fn attempt<const D: usize>(
    dimension: Dimension<D>,
    kinds: [Kind; 2],
    regime: Regime,
    scalar: Scalar,
    random: &mut Random,
) -> Option<Known<D>> {
    let forms = kinds.map(|kind| kind.draw::<D>(random, scalar));
    let solids = [0, 1]
        .map(|i: usize| forms[i].solid().unwrap_or_else(|| (dimension.particular)(&forms[i])));
    let radii = [0, 1].map(|i: usize| {
        let radius = solids[i].bounding_radius();
        if radius.is_finite() { radius } else { 0.0 }
    });
    let reach = radii[0] + radii[1];
    let turns = turns(random);
    let rotations = turns.map(|turn| (dimension.rotation)(random, scalar, turn));
    let at1 = scalar.vector(&random.vector(1.0));
    let is_deep =
        regime == Regime::Deep && kinds[0] != Kind::HalfSpace && kinds[1] != Kind::HalfSpace;
    // Deep: the centre of solid 2 is near that of solid 1. Otherwise the bounding spheres touch,
    // and a second placement corrects the distance.
    let away = if is_deep { random.range(0.0, 0.3) * radii[0].min(radii[1]) } else { reach };
    let at2 = scalar.vector(&add(&at1, &scale(&random.unit_vector(), away)));
    let placed = |at2: [f64; D]| -> Known<D> {
        let placements = [
            Placement { translation: at1, rotation: rotations[0] },
            Placement { translation: at2, rotation: rotations[1] },
        ];
        let poses = placements.map(|placement| (dimension.pose)(&placement));
        let truth = signed_distance(&solids[0], &poses[0], &solids[1], &poses[1]);
        let sample = Sample { forms: forms.clone(), placements };
        Known { sample, solids: solids.clone(), poses, truth }
    };
    let mut known = placed(at2);
    if !is_deep {
        let way = regime.target(random) * reach - known.truth.distance.to_f64();
        let normal = rounded(&known.truth.normal);
        known = placed(scalar.vector(&add(&at2, &scale(&normal, way))));
    }
    let truth = known.truth.distance.to_f64();
    regime.holds(truth, known.truth.size, reach, scalar.epsilon()).then_some(known)
}

/// Returns the kinds of the two rotations. In two of ten pairs the coordinate axes of the solids
/// are parallel, exactly or nearly.
fn turns(random: &mut Random) -> [Turn; 2] {
    match random.below(10) {
        0 => [Turn::Aligned, Turn::Aligned],
        1 => [Turn::Aligned, Turn::Slight],
        _ => [Turn::Free, Turn::Free],
    }
}

/// The functions for 2D.
pub const PLANE: Dimension<2> = Dimension {
    particular: |form| unreachable!("{form:?} is of space"),
    pose: |placement| {
        let [cosine, sine, ..] = placement.rotation;
        Pose::from_complex(placement.translation, [cosine, sine])
    },
    rotation: |random, scalar, turn| {
        let [cosine, sine] = match turn {
            Turn::Free => scalar.unit(|| random.unit_vector::<2>()),
            Turn::Aligned => *random.pick(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]),
            Turn::Slight => {
                let limit = random.magnitude(1e-6, 17);
                scalar.unit(|| slight([random.range(-limit, limit)]))
            }
        };
        [cosine, sine, 0.0, 0.0]
    },
};

/// The functions for 3D.
pub const SPACE: Dimension<3> = Dimension {
    particular: |form| match form {
        Form::Cylinder { half_height, radius } => Solid::cylinder(*half_height, *radius),
        Form::Cone { half_height, radius } => Solid::cone(*half_height, *radius),
        other => unreachable!("{other:?} is of every dimension"),
    },
    pose: |placement| Pose::from_quaternion(placement.translation, placement.rotation),
    rotation: |random, scalar, turn| match turn {
        Turn::Free => scalar.unit(|| random.quaternion()),
        // Half of the aligned rotations have all components ±0.5, the others a single component 1:
        // both have exactly unit length.
        Turn::Aligned if random.chance(0.5) => {
            std::array::from_fn(|_| if random.chance(0.5) { 0.5 } else { -0.5 })
        }
        Turn::Aligned => {
            let axis = random.below(4);
            std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 })
        }
        Turn::Slight => {
            let limit = random.magnitude(1e-6, 17);
            scalar.unit(|| {
                let [w, x, y, z] = slight(random.vector::<3>(limit));
                [x, y, z, w]
            })
        }
    },
};

/// Returns the unit vector that ends with these small components; the first component completes its
/// length to 1.
fn slight<const FEW: usize, const MANY: usize>(small: [f64; FEW]) -> [f64; MANY] {
    let length = norm(&small);
    let first = (1.0 - length * length).sqrt();
    std::array::from_fn(|i| if i == 0 { first } else { small[i - 1] })
}
