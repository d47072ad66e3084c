//! Faces that the solid cannot see, since it is on the other side of their neighbours.
//!
//! Each face of a surface with two sides is touched from the side that the solid's middle is on. Near
//! an edge that is wrong for one of two: a box that lies on a table near its rim is in front of the
//! top, but behind the plane of the side, whose inside it would seem to touch. Where two faces meet
//! there are three cases: each is behind the other, as on a ridge; each is in front of the other, as
//! in a valley; or the first is in front of the second, but the second behind the first. Then no solid
//! is in front of both, and what lies behind is hidden.

use smallvec::SmallVec;

use super::facts::{Finding, Standing};
use super::scene::Scene;
use crate::math::{Real, Space, Vector, max};

/// Faces whose normals' cosine is above this hide nothing from each other.
const ALIKE: f64 = 0.99;

/// Where a face lies to the plane of another.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Front,
    Back,
    Across,
}

/// Leaves out the contacts of a convex solid with faces that others hide.
///
/// Cost: quadratic in the number of the parts that are touched on faces of different directions.
pub(super) fn drop_hidden<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    findings: &mut [Finding<N, D>],
) {
    // Between two composites it is not one solid that is on one side.
    if !scene.first_is_convex() {
        return;
    }
    let (all, next) = (findings.iter(), findings.iter());
    let (all, next) = (all.filter_map(|one| one.face), next.filter_map(|one| one.face).skip(1));
    if all.zip(next).all(|(a, b)| are_alike(&a, &b)) {
        return;
    }
    let faces = findings.iter().enumerate();
    let faces: SmallVec<[(usize, Vector<N, D>); 8]> =
        faces.filter_map(|(index, finding)| Some((index, finding.face?))).collect();
    let mut hidden: SmallVec<[usize; 8]> = SmallVec::new();
    for &(back, normal) in &faces {
        let hides = |&(front, other): &(usize, Vector<N, D>)| {
            !are_alike(&normal, &other)
                && is_hidden(scene, (&findings[back], &normal), (&findings[front], &other))
        };
        if faces.iter().any(hides) {
            hidden.push(back);
        }
    }
    for index in hidden {
        findings[index].standing = Standing::Left;
    }
}

/// Faces with these normals hide nothing from each other.
pub(super) fn are_alike<N: Real, const D: usize>(a: &Vector<N, D>, b: &Vector<N, D>) -> bool {
    a.dot(b) > N::lit(ALIKE)
}

/// The part of `back` is behind that of `front`, which it hangs together with, but not the other way
/// round.
fn is_hidden<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    (back, back_normal): (&Finding<N, D>, &Vector<N, D>),
    (front, front_normal): (&Finding<N, D>, &Vector<N, D>),
) -> bool {
    let (part, other) = (back.parts()[1], front.parts()[1]);
    // What is farther hides nothing, so that the prediction never changes what overlaps.
    front.distance <= max(back.distance, N::ZERO)
        && scene.are_adjacent(part, other)
        && place(scene, (part, other, front_normal)) == Place::Back
        && place(scene, (other, part, back_normal)) == Place::Front
}

/// Where a part of the second shape lies to the plane of another, whose normal is given.
fn place<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    (part, plane, normal): (u32, u32, &Vector<N, D>),
) -> Place {
    let Some((low, high, room)) = scene.heights(part, plane, normal) else { return Place::Across };
    match (low < -room, high > room) {
        (true, false) => Place::Back,
        (false, true) => Place::Front,
        _ => Place::Across,
    }
}
