//! What is clear of a pair, and where its solids were then.

use super::guide::{Guide, Known, ROOM};
use super::pool::{Aim, Asked, Few, Pools};
use super::solid::Flat;
use super::{Verdict, noise};
use crate::convex::Units;
use crate::math::{Pose, Real, Vector, max};

/// Which faces and edges of two flat solids may decide while they move no farther than a little.
///
/// Kept with a pair that is asked again and again. An answer that goes by it has the bits of one from
/// nothing: all that is left out is certain not to decide. While the solids move fast nothing is noted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Certificate<N: Real, const D: usize> {
    /// The pose of the second solid in the frame of the first, its rotation in steps of 2⁻¹⁵.
    translation: Vector<N, D>,
    rotation: [[i16; D]; D],
    /// One over the unit of the pair at that time.
    shrink: N,
    reach: N,
    edges: [Few; 2],
    /// For each solid the number of a face or a code, and of another one that may be better, or that is the
    /// best of those that are lower; where a face parts the two, its solid and its number.
    faces: [[u8; 2]; 2],
    stage: Stage,
    /// How often it served.
    uses: u8,
}

/// What there is on a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Nothing,
    /// Where the solids were.
    Pose,
    /// The same, and that the edges known were too few for what was asked, and within what reach.
    Crossing,
    Nearest,
    Faces,
    /// Edges too, for what they are asked about.
    Edges(Aim),
    Parting,
}

/// Codes where a face is expected. Solids treated here have 64 faces at most.
const ANY: u8 = 255;
const LOWER: u8 = 254;

/// The steps in which rotations are kept, and how far off that may be in all.
const STEPS: f64 = 32768.0;
const OFF: f64 = 1.0 / 8192.0;

/// Uses after which it is worth while to make a certificate anew at once.
const WORTH: u8 = 2;

impl<N: Real, const D: usize> Default for Certificate<N, D> {
    fn default() -> Self {
        Self {
            translation: Vector::<N, D>::zeros(),
            rotation: [[0; D]; D],
            shrink: N::ZERO,
            reach: N::ZERO,
            edges: [Few::default(); 2],
            faces: [[ANY; 2]; 2],
            stage: Stage::Nothing,
            uses: 0,
        }
    }
}

impl<N: Real, const D: usize> Certificate<N, D> {
    /// The pair is another one now, or stands the other way round.
    pub(crate) const fn forget(&mut self) {
        self.stage = Stage::Nothing;
    }
}

impl<N: Real> Certificate<N, 3> {
    /// Asks by what is known, or anew, and notes what is clear then.
    pub(super) fn asked(
        &mut self,
        solids: [&Flat<'_, N>; 2],
        pose12: &Pose<N, 3>,
        ask: impl FnOnce(&mut Guide<N>) -> Verdict<N>,
    ) -> Verdict<N> {
        let reaches = solids.map(|solid| solid.reach);
        let Units { shrink, .. } = Units::of(reaches[0], reaches[1], &pose12.translation);
        let (moved, room) = (self.moved(reaches, pose12, shrink), N::lit(ROOM));
        if self.is_made() && moved <= room {
            let mut guide = self.guide();
            let verdict = ask(&mut guide);
            self.uses = self.uses.saturating_add(1);
            if guide.has_missed {
                self.set_pose(pose12, shrink);
                self.expect(guide.asked);
            }
            return verdict;
        }
        let is_worth = moved <= room || self.is_made() && self.uses >= WORTH;
        let mut guide = if is_worth { Guide::drafting(self.expected()) } else { Guide::default() };
        let verdict = ask(&mut guide);
        self.set_pose(pose12, shrink);
        if is_worth {
            self.note(&guide, &verdict);
        }
        verdict
    }

    /// There is something to go by.
    pub(super) fn is_made(&self) -> bool {
        matches!(self.stage, Stage::Faces | Stage::Edges(_) | Stage::Parting)
    }

    /// This was asked about edges in vain.
    fn expect(&mut self, asked: Asked<N>) {
        self.reach = asked.reach;
        self.stage = match asked.aim {
            Aim::Crossing => Stage::Crossing,
            Aim::Nearest => Stage::Nearest,
            Aim::Nothing | Aim::Both => Stage::Pose,
        };
    }

    /// What is likely to be asked about edges again.
    fn expected(&self) -> Asked<N> {
        match self.stage {
            Stage::Crossing => Asked::crossing(self.reach),
            Stage::Nearest => Asked::nearest(self.reach),
            _ => Asked::default(),
        }
    }

    /// The edges that may decide are known too.
    #[cfg(test)]
    pub(super) fn knows_edges(&self) -> bool {
        matches!(self.stage, Stage::Edges(_))
    }

    /// How far any point of either solid has moved at most in the frame of the other, and edges have turned,
    /// in units of the pair.
    fn moved(&self, [reach1, reach2]: [N; 2], pose12: &Pose<N, 3>, shrink: N) -> N {
        if self.stage == Stage::Nothing || shrink != self.shrink {
            return N::INFINITY;
        }
        // Of small lengths the squares are no numbers of the type: in units of the pair they are.
        let shift = ((pose12.translation - self.translation) * shrink).norm();
        let mut squared = N::ZERO;
        for (column, kept) in self.rotation.iter().enumerate() {
            for (row, &kept) in kept.iter().enumerate() {
                let kept = N::lit(f64::from(kept)) * N::lit(1.0 / STEPS);
                let change = pose12.rotation[(row, column)] - kept;
                squared += change * change;
            }
        }
        let away = reach1 * shrink + (pose12.translation * shrink).norm();
        let arm = max(max(away, reach2 * shrink), N::ONE);
        shift + (squared.sqrt() + N::lit(OFF)) * arm + noise()
    }

    fn set_pose(&mut self, pose12: &Pose<N, 3>, shrink: N) {
        self.translation = pose12.translation;
        for (column, kept) in self.rotation.iter_mut().enumerate() {
            for (row, kept) in kept.iter_mut().enumerate() {
                *kept = in_steps(pose12.rotation[(row, column)]);
            }
        }
        (self.shrink, self.stage, self.uses) = (shrink, Stage::Pose, 0);
    }

    /// What is known.
    fn guide(&self) -> Guide<N> {
        if self.stage == Stage::Parting {
            let [which, face] = self.faces[0].map(usize::from);
            return Guide::parting(which, face);
        }
        let known = self.faces.map(|faces| match faces {
            [ANY, _] => Known::Any,
            [LOWER, face] => Known::Lower(usize::from(face)),
            [face, ANY] => Known::Is(usize::from(face)),
            [face, other] => Known::Either(usize::from(face), usize::from(other)),
        });
        let pool = match self.stage {
            Stage::Edges(aim) => {
                Some(Pools { edges: self.edges, asked: Asked { aim, reach: self.reach } })
            }
            _ => None,
        };
        Guide::knowing(known, pool)
    }

    /// Notes what was found out.
    fn note(&mut self, guide: &Guide<N>, verdict: &Verdict<N>) {
        match verdict {
            Verdict::Beyond => {
                let which = usize::from(guide.best[1].height > guide.best[0].height);
                self.faces[0] = [which, guide.best[which].face].map(code);
                self.stage = Stage::Parting;
            }
            // Where nothing is proved, that costs less the next time.
            Verdict::Found(_) | Verdict::Undecided => {
                self.faces = guide.faces().map(|known| match known {
                    Known::Any => [ANY; 2],
                    Known::Lower(face) => [LOWER, code(face)],
                    Known::Is(face) => [code(face), ANY],
                    Known::Either(face, other) => [face, other].map(code),
                });
                self.stage = Stage::Faces;
                if let Some(Pools { edges, asked }) = guide.noted() {
                    (self.edges, self.reach) = (edges, asked.reach);
                    self.stage = Stage::Edges(asked.aim);
                }
            }
        }
    }
}

/// The number of a face.
fn code(face: usize) -> u8 {
    u8::try_from(face).expect("there is room for 64 faces")
}

#[expect(clippy::cast_possible_truncation, reason = "what is too large becomes the largest")]
fn in_steps<N: Real>(value: N) -> i16 {
    (value.as_f64() * STEPS) as i16
}
