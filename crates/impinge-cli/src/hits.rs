//! The hits of rays and moving shapes: the fields of the reports of `ray` and `cast`.

use core::fmt;

use impinge_files::Printable;
use serde::Serialize;

use crate::number::{Number, tuple};
use crate::output::{CLEAR, FAINT, NAME, Outcome, Report, Subject, TOUCHES};

/// The hits of a query, sorted by time.
#[derive(Debug, Serialize)]
pub(crate) struct Hits<H> {
    #[serde(flatten)]
    pub(crate) subject: Subject,
    pub(crate) hits: Vec<H>,
}

/// The hit of a ray.
#[derive(Debug, Serialize)]
pub(crate) struct RayHit {
    pub(crate) object: String,
    /// The time of the hit, in units of the length of the direction.
    pub(crate) time: Number,
    /// The distance from the start of the ray to the point, in units of the world.
    pub(crate) length: Number,
    pub(crate) point: Vec<Number>,
    /// The outward normal; zero if the ray starts inside the object and objects are not hollow.
    pub(crate) normal: Vec<Number>,
    /// The index of the part that is hit; 0 for a convex shape.
    pub(crate) part: u32,
}

/// The hit of a moving shape.
#[derive(Debug, Serialize)]
pub(crate) struct CastHit {
    pub(crate) object: String,
    /// The time of the hit: 0 at the start and 1 at the end of the path.
    pub(crate) time: Number,
    /// The distance from the start of the path, in units of the world.
    pub(crate) moved: Number,
    /// The position of the moving shape at that time.
    pub(crate) position: Vec<Number>,
    /// The contact point on the moving shape, in the world frame.
    pub(crate) point: Vec<Number>,
    /// The unit normal from the moving shape to the object.
    pub(crate) normal: Vec<Number>,
    /// The index of the part that is hit; 0 for a convex shape.
    pub(crate) part: u32,
}

impl fmt::Display for RayHit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, length, .. } = self;
        let object = Printable(&self.object);
        let [point, normal] = [&self.point, &self.normal].map(|numbers| tuple(numbers));
        writeln!(
            f,
            "{TOUCHES}hit{TOUCHES:#} {NAME}{object}{NAME:#} at {point} after {length} \
             {FAINT}(time {time}, normal {normal}){FAINT:#}"
        )
    }
}

impl fmt::Display for CastHit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, moved, .. } = self;
        let object = Printable(&self.object);
        let vectors = [&self.position, &self.point, &self.normal];
        let [position, point, normal] = vectors.map(|numbers| tuple(numbers));
        writeln!(
            f,
            "{TOUCHES}hit{TOUCHES:#} {NAME}{object}{NAME:#} at {point} after {moved}, from {position} \
             {FAINT}(time {time}, normal {normal}){FAINT:#}"
        )
    }
}

impl<H: fmt::Display> fmt::Display for Hits<H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.hits.is_empty() {
            return writeln!(
                f,
                "{CLEAR}nothing{CLEAR:#} is hit in {}",
                Printable(&self.subject.file)
            );
        }
        self.hits.iter().try_for_each(|hit| hit.fmt(f))
    }
}

impl<H: fmt::Display + Serialize> Report for Hits<H> {
    fn outcome(&self) -> Outcome {
        (!self.hits.is_empty()).into()
    }
}
