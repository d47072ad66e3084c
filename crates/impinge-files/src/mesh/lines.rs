//! Text that is read line by line, so that the line of a parser's error is known.

use core::cell::Cell;
use std::io::{self, Read};

/// A reader that gives at most one line at a time: a buffered parser that stops has read no line beyond the one it
/// stopped at.
pub(super) struct LineReader<'a> {
    rest: &'a [u8],
    line: &'a Cell<usize>,
    /// The last byte given ended a line.
    is_at_start: bool,
}

impl<'a> LineReader<'a> {
    /// Reads the text; `line` becomes the number of the line that was given last, counted from 1.
    pub(super) const fn new(text: &'a [u8], line: &'a Cell<usize>) -> Self {
        Self { rest: text, line, is_at_start: true }
    }
}

impl Read for LineReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let newline = self.rest.iter().position(|byte| *byte == b'\n');
        let line = newline.map_or(self.rest.len(), |end| end + 1);
        let count = line.min(buffer.len());
        let (given, rest) = self.rest.split_at(count);
        buffer[..count].copy_from_slice(given);
        if count > 0 && self.is_at_start {
            self.line.set(self.line.get() + 1);
        }
        self.is_at_start = given.last().is_none_or(|byte| *byte == b'\n');
        self.rest = rest;
        Ok(count)
    }
}
