//! Finds the position of values in a JSON text by scanning its characters, without building a tree.

/// A position in a text that is valid JSON.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scanner<'a> {
    text: &'a str,
    at: usize,
}

/// A step of a path in a document: a member name, or an index in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step<'a> {
    Name(&'a str),
    Index(usize),
}

impl<'a> Scanner<'a> {
    /// Creates a scanner at the value of the whole document.
    pub(crate) fn new(text: &'a str) -> Self {
        let mut scanner = Self { text, at: 0 };
        scanner.blank();
        scanner
    }

    /// Moves to a member or element of the current value; `None` if it does not exist.
    pub(crate) fn entered(mut self, step: Step<'_>) -> Option<Self> {
        let (open, mut index) = match step {
            Step::Name(_) => (b'{', 0),
            Step::Index(index) => (b'[', index),
        };
        if self.peek() != Some(open) {
            return None;
        }
        // Terminates: each iteration consumes a member, and no comma follows the last member.
        loop {
            self.next();
            if matches!(self.peek(), Some(b']' | b'}') | None) {
                return None;
            }
            let is_it = match step {
                Step::Name(name) => self.key() == name,
                Step::Index(_) => index == 0,
            };
            if is_it {
                return Some(self);
            }
            index = index.saturating_sub(1);
            self.skip();
            self.blank();
            if self.peek() != Some(b',') {
                return None;
            }
        }
    }

    /// Returns the byte offset of the current value, and its text.
    pub(crate) fn value(mut self) -> (usize, &'a str) {
        let start = self.at;
        self.skip();
        (start, self.text.get(start..self.at).unwrap_or_default())
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// Skips a character and the white space after it.
    fn next(&mut self) {
        self.at += 1;
        self.blank();
    }

    fn blank(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    /// Returns the key of a member, and moves to its value.
    fn key(&mut self) -> String {
        let (_, key) = self.value();
        self.skip();
        self.blank();
        self.next();
        serde_json::from_str(key).unwrap_or_default()
    }

    /// Skips a value of any kind.
    fn skip(&mut self) {
        let mut depth = 0_usize;
        while let Some(byte) = self.peek() {
            match byte {
                b'"' => self.string(),
                b'[' | b'{' => depth += 1,
                b']' | b'}' if depth == 0 => return,
                b']' | b'}' => depth -= 1,
                _ if depth == 0 => return self.scalar(),
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                return;
            }
        }
    }

    /// Moves to the quotation mark that ends the current string.
    fn string(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek().filter(|byte| *byte != b'"') {
            self.at += if byte == b'\\' { 2 } else { 1 };
        }
    }

    /// Skips a number or a word, such as `true`.
    fn scalar(&mut self) {
        let ends = |byte: u8| byte.is_ascii_whitespace() || b",]}".contains(&byte);
        while self.peek().is_some_and(|byte| !ends(byte)) {
            self.at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        r#" {"a\"]": [1, [], {}, "x,\\", {"b": -2.5e3 , "c":null}], "d" : true, "e": []}"#;

    fn at(steps: &[Step<'_>]) -> Option<&'static str> {
        let scanner = steps.iter().try_fold(Scanner::new(TEXT), |at, step| at.entered(*step));
        scanner.map(|scanner| scanner.value().1)
    }

    #[test]
    fn values_by_hand() {
        let list = Step::Name("a\"]");
        assert_eq!(at(&[]), Some(TEXT.trim()));
        assert_eq!(at(&[list, Step::Index(0)]), Some("1"));
        assert_eq!(at(&[list, Step::Index(1)]), Some("[]"));
        assert_eq!(at(&[list, Step::Index(3)]), Some(r#""x,\\""#));
        assert_eq!(at(&[list, Step::Index(4), Step::Name("b")]), Some("-2.5e3"));
        assert_eq!(at(&[list, Step::Index(4), Step::Name("c")]), Some("null"));
        assert_eq!(at(&[Step::Name("d")]), Some("true"));
        for missing in [
            &[list, Step::Index(5)][..],
            &[list, Step::Name("b")],
            &[Step::Name("f")],
            &[Step::Name("e"), Step::Index(0)],
            &[Step::Name("d"), Step::Index(0)],
        ] {
            assert_eq!(at(missing), None, "{missing:?}");
        }
    }
}
