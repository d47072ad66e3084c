//! Shows progress bars on standard error.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// The time after which a progress bar appears.
const DELAY: Duration = Duration::from_secs(1);

/// A progress bar that appears after [`DELAY`], on a terminal only, and disappears when it is
/// dropped.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    begun: Instant,
    is_shown: bool,
}

impl Progress {
    /// Creates a bar of `steps` steps. `work` is the text before the bar.
    pub(crate) fn new(steps: usize, work: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{msg} {wide_bar:.cyan} {pos}/{len} {eta}");
        let bar = if let Ok(style) = style { bar.with_style(style) } else { bar };
        bar.set_message(work);
        Self { bar, begun: Instant::now(), is_shown: false }
    }

    /// Counts a finished step.
    pub(crate) fn step(&mut self) {
        if !self.is_shown && self.begun.elapsed() > DELAY {
            self.is_shown = true;
            // Nothing is drawn if standard error is not a terminal.
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
