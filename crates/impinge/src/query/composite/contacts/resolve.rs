//! Which of the contacts of the parts are contacts of the whole.

use smallvec::SmallVec;

use super::facts::{Finding, Notes, Standing};
use super::scene::Scene;
use crate::math::{Real, Space, Vector, max};

/// Normals whose cosine is above this say the same.
const ALIKE: f64 = 0.99;

/// A way to part the two shapes as far as some of their parts know: a normal and a depth along it.
struct Way<N: Real, const D: usize> {
    normal: Vector<N, D>,
    depth: N,
}

type Ways<N, const D: usize> = SmallVec<[Way<N, D>; 16]>;

/// Leaves the contacts that hold for the whole.
///
/// Along the normal of a face the depth is that of the whole solid below the face, which for a face
/// that is met at its rim only may be the width of the solid: a box on the top of a cliff is not
/// deep in its wall. So of two explanations of an overlap the shallower holds: what is left out is a
/// contact with a face whose part comes free as well when the solids are parted along the normal of
/// another contact by that one's depth, where that is less.
///
/// If nothing else says how near the solids are, what the nearest two parts say on their own holds:
/// solids that overlap always have a contact.
pub(super) fn resolve<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    findings: &mut [Finding<N, D>],
    notes: &mut Notes<N, D>,
) {
    super::hidden::drop_hidden(scene, findings);
    let is_asked =
        |finding: &Finding<N, D>| matches!(finding.standing, Standing::Snapped | Standing::Beyond);
    if findings.iter().any(is_asked) {
        leave_explained(scene, findings, notes);
    }
    keep_one(findings, notes);
}

/// Leaves out contacts with faces that other contacts explain.
fn leave_explained<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    findings: &mut [Finding<N, D>],
    notes: &Notes<N, D>,
) {
    let mut ways = Ways::new();
    for finding in findings.iter().filter(|finding| finding.standing == Standing::Own) {
        note(&mut ways, finding);
    }
    for standing in [Standing::Snapped, Standing::Beyond] {
        for index in shallowest_first(findings, standing) {
            if is_explained(scene, &findings[index], &ways, notes) {
                findings[index].standing = Standing::Left;
            } else {
                note(&mut ways, &findings[index]);
            }
        }
    }
}

/// The findings of a standing.
fn shallowest_first<N: Real, const D: usize>(
    findings: &[Finding<N, D>],
    standing: Standing,
) -> SmallVec<[usize; 16]> {
    let mut order: SmallVec<[usize; 16]> = SmallVec::new();
    order.extend((0..findings.len()).filter(|&index| findings[index].standing == standing));
    order.sort_by(|&a, &b| {
        let lowest = |index: usize| findings[index].lowest.as_f64();
        lowest(b).total_cmp(&lowest(a)).then(findings[a].parts().cmp(&findings[b].parts()))
    });
    order
}

/// Takes note of a contact as a way to part the shapes; of those along one normal the farthest.
fn note<N: Real, const D: usize>(ways: &mut Ways<N, D>, finding: &Finding<N, D>) {
    let (normal, depth) = (finding.piece.normal, -finding.lowest);
    match ways.iter_mut().find(|way| way.normal == normal) {
        Some(way) => way.depth = max(way.depth, depth),
        None => ways.push(Way { normal, depth }),
    }
}

/// Another way parts the two parts too: one that is no longer, and of a contact with a face that
/// is not beyond a ridge one that leads elsewhere.
fn is_explained<N: Space<D>, const D: usize>(
    scene: &Scene<'_, N, D>,
    finding: &Finding<N, D>,
    ways: &[Way<N, D>],
    notes: &Notes<N, D>,
) -> bool {
    let (normal, depth) = (finding.piece.normal, -finding.lowest);
    if depth <= finding.tolerance {
        return false;
    }
    let is_beyond = finding.standing == Standing::Beyond;
    let is_asked = |way: &&Way<N, D>| {
        let is_other = is_beyond || way.normal.dot(&normal) < N::lit(ALIKE);
        is_other && way.depth > N::ZERO && way.depth <= depth
    };
    // The plane that is known to part the two best may do so well enough once they are moved.
    let rest = |way: &Way<N, D>| finding.distance + finding.normal.dot(&way.normal) * way.depth;
    let (mut asked, room): (SmallVec<[&Way<N, D>; 16]>, N) = (SmallVec::new(), -finding.tolerance);
    for way in ways.iter().filter(is_asked) {
        if rest(way) > room {
            return true;
        }
        asked.push(way);
    }
    !asked.is_empty() && {
        let points = &notes.points[finding.piece.points.clone()];
        let mut placed = None;
        asked.into_iter().any(|way| {
            let shift = way.normal * way.depth;
            // A point of the part that is still well within the solid says that they are not parted.
            let is_held = points.iter().any(|point| {
                let moved = point.point1 + normal * point.distance + shift;
                scene.is_within(&moved, N::TWO * finding.tolerance)
            });
            !is_held && {
                let placed = placed.get_or_insert_with(|| scene.pair(finding.parts()));
                placed.is_parted(&shift, finding.tolerance)
            }
        })
    }
}

/// If the contacts that hold are farther than the nearest two parts, adds that of these. What is
/// apart by rounding only, where parts touch, is made to touch.
fn keep_one<N: Real, const D: usize>(findings: &mut [Finding<N, D>], notes: &mut Notes<N, D>) {
    let nearest = least_of(findings, |finding| Some(finding.distance));
    let Some(nearest) = nearest else { return };
    let (least, tolerance) =
        (max(findings[nearest].distance, N::ZERO), findings[nearest].tolerance);
    let kept = least_of(findings, |finding| {
        (finding.standing != Standing::Left).then_some(finding.lowest)
    });
    match kept.map(|index| (index, findings[index].lowest)) {
        Some((_, lowest)) if lowest <= least => {}
        Some((index, lowest)) if lowest <= least + tolerance => {
            for point in &mut notes.points[findings[index].piece.points.clone()] {
                point.distance = max(point.distance - lowest, N::ZERO) + least;
            }
            findings[index].lowest = least;
        }
        _ => findings[nearest].standing = Standing::Own,
    }
}

/// The index of the least of what is said of the findings, the first of equals.
fn least_of<N: Real, const D: usize>(
    findings: &[Finding<N, D>],
    value: impl Fn(&Finding<N, D>) -> Option<N>,
) -> Option<usize> {
    let all = findings.iter().enumerate();
    let said = all.filter_map(|(index, finding)| Some((index, value(finding)?)));
    let least = said.reduce(|best, next| if next.1 < best.1 { next } else { best });
    least.map(|(index, _)| index)
}
