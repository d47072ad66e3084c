//! Computes the marks of the time line: the steps of a recording with events, queries or changes
//! other than moves.

use impinge_record::Mark;

use crate::answer::StepMark;

/// The maximum number of marks that are sent to the page.
pub(crate) const MAX_MARKS: usize = 10_000;

/// Returns a mark for each step with events, queries or changes other than moves. If there are more
/// than [`MAX_MARKS`] such steps, consecutive marks are combined: the result has the sums of their
/// counts, at the step of the first of them.
pub(crate) fn marks(of_updates: &[Mark]) -> Vec<StepMark> {
    let marks = (1..).zip(of_updates).map(|(step, mark)| step_mark(step, mark));
    let marks: Vec<_> =
        marks.filter(|mark| *mark != StepMark { step: mark.step, ..StepMark::default() }).collect();
    let together = marks.len().div_ceil(MAX_MARKS).max(1);
    marks.chunks(together).filter_map(|some| some.iter().copied().reduce(sum)).collect()
}

fn step_mark(step: usize, mark: &Mark) -> StepMark {
    let events = mark.events.unwrap_or_default();
    StepMark {
        step,
        started: events.started,
        stopped: events.stopped,
        proximities: events.proximities,
        added: mark.added,
        removed: mark.removed,
        changed: mark.changed,
        queries: mark.queries,
    }
}

/// Returns a mark with the sums of the counts of two marks, at the step of the first mark.
const fn sum(first: StepMark, other: StepMark) -> StepMark {
    StepMark {
        step: first.step,
        started: first.started.saturating_add(other.started),
        stopped: first.stopped.saturating_add(other.stopped),
        proximities: first.proximities.saturating_add(other.proximities),
        added: first.added.saturating_add(other.added),
        removed: first.removed.saturating_add(other.removed),
        changed: first.changed.saturating_add(other.changed),
        queries: first.queries.saturating_add(other.queries),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_steps_at_which_something_happened_have_a_mark() {
        let quiet = Mark { moved: 5, ..Mark::default() };
        let busy = Mark { added: 2, queries: 1, ..Mark::default() };
        let expected = StepMark { step: 2, added: 2, queries: 1, ..StepMark::default() };
        assert_eq!(marks(&[quiet, busy, quiet]), [expected]);
    }

    #[test]
    fn many_marks_are_added_up() {
        let busy = Mark { removed: 1, ..Mark::default() };
        let many = marks(&vec![busy; 2 * MAX_MARKS + 1]);
        assert!(many.len() <= MAX_MARKS, "{}", many.len());
        assert_eq!(many.iter().map(|mark| mark.removed as usize).sum::<usize>(), 2 * MAX_MARKS + 1);
        assert!(many.windows(2).all(|two| two[0].step < two[1].step), "in order");
    }
}
