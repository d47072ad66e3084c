//! What rays and moving shapes hit: the fields of `ray` and `cast`.

use core::fmt::Write as _;

use serde::Serialize;

use crate::number::{Number, tuple};
use crate::output::{CLEAR, FAINT, NAME, Outcome, Report, TOUCHES};
use crate::space::KindFields;

/// The objects that are hit, in order of time.
#[derive(Debug, Serialize)]
pub(crate) struct Hits<H> {
    pub(crate) file: String,
    #[serde(flatten)]
    pub(crate) kind: KindFields,
    pub(crate) hits: Vec<H>,
}

/// Where a ray meets an object.
#[derive(Debug, Serialize)]
pub(crate) struct RayHit {
    pub(crate) object: String,
    /// In units of the direction.
    pub(crate) time: Number,
    pub(crate) length: Number,
    pub(crate) point: Vec<Number>,
    /// Out of the object; zero if the ray starts inside.
    pub(crate) normal: Vec<Number>,
    pub(crate) part: u32,
}

/// Where a moving shape meets an object.
#[derive(Debug, Serialize)]
pub(crate) struct CastHit {
    pub(crate) object: String,
    /// 0 at the start and 1 at the end.
    pub(crate) time: Number,
    pub(crate) moved: Number,
    /// Of the moving shape, at that time.
    pub(crate) position: Vec<Number>,
    /// On the moving shape.
    pub(crate) point: Vec<Number>,
    /// From the moving shape to the object.
    pub(crate) normal: Vec<Number>,
    pub(crate) part: u32,
}

/// One hit as text.
pub(crate) trait Line {
    /// A line of text.
    fn line(&self, text: &mut String);
}

impl Line for RayHit {
    fn line(&self, text: &mut String) {
        let Self { object, time, length, .. } = self;
        let (point, normal) = (tuple(&self.point), tuple(&self.normal));
        let _ = writeln!(
            text,
            "{TOUCHES}hit{TOUCHES:#} {NAME}{object}{NAME:#} at {point} after {length} \
             {FAINT}(time {time}, normal {normal}){FAINT:#}"
        );
    }
}

impl Line for CastHit {
    fn line(&self, text: &mut String) {
        let Self { object, time, moved, .. } = self;
        let [at, point, normal] = [&self.position, &self.point, &self.normal].map(|x| tuple(x));
        let _ = writeln!(
            text,
            "{TOUCHES}hit{TOUCHES:#} {NAME}{object}{NAME:#} at {point} after {moved}, from {at} \
             {FAINT}(time {time}, normal {normal}){FAINT:#}"
        );
    }
}

impl<H: Line + Serialize> Report for Hits<H> {
    fn text(&self) -> String {
        let mut text = String::new();
        self.hits.iter().for_each(|hit| hit.line(&mut text));
        if self.hits.is_empty() {
            let _ = writeln!(text, "{CLEAR}nothing{CLEAR:#} is hit in {}", self.file);
        }
        text
    }

    fn outcome(&self) -> Outcome {
        (!self.hits.is_empty()).into()
    }
}
