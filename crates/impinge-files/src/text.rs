//! Texts of files: drops byte order marks, and formats texts for messages, which escapes control
//! characters and shortens long texts.

use core::fmt::{self, Write as _};
use std::borrow::Cow;

/// The maximum number of characters of a text in a message, before control characters are escaped.
const MAX_TEXT: usize = 160;

/// Returns the bytes of a text without a byte order mark at its start. Some editors write this mark,
/// U+FEFF, before UTF-8.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes)
}

/// Formats a text from a file for a terminal.
///
/// Control characters, line breaks, and the invisible characters that reorder text are written as
/// escape sequences, so that a file cannot move the cursor of a terminal, colour it, or forge a
/// line. The middle of a text of more than 160 characters is omitted.
///
/// ```
/// use impinge_files::Printable;
///
/// assert_eq!(Printable("a\u{1b}[31m b\nc").to_string(), r"a\u{1b}[31m b\nc");
/// assert!(Printable(&"x".repeat(1_000_000)).to_string().chars().count() < 170);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Printable<'a>(pub &'a str);

impl fmt::Display for Printable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = cut(self.0);
        if !text.chars().any(is_obeyed) {
            return f.pad(&text);
        }
        let mut escaped = String::new();
        for character in text.chars() {
            if is_obeyed(character) {
                write!(escaped, "{}", character.escape_default())?;
            } else {
                escaped.push(character);
            }
        }
        f.pad(&escaped)
    }
}

/// Formats a name from a file for a terminal, in quotation marks.
pub(crate) struct Quoted<'a>(pub(crate) &'a str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", Printable(self.0))
    }
}

/// Returns a message of a parser on one line, escaped and shortened. Such messages may quote the
/// file.
pub(crate) fn message(text: &str) -> String {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    // A long text is cut first, so that words in its middle are not processed.
    let text = match text.char_indices().nth(8 * MAX_TEXT) {
        Some((end, _)) => format!("{} {}", words(&text[..end]), words(tail(text, MAX_TEXT))),
        None => words(text),
    };
    Printable(&text).to_string()
}

/// Returns the text, without its middle if it has more than [`MAX_TEXT`] characters.
fn cut(text: &str) -> Cow<'_, str> {
    if text.len() <= MAX_TEXT || text.chars().nth(MAX_TEXT).is_none() {
        return Cow::Borrowed(text);
    }
    let head = text.char_indices().nth(2 * MAX_TEXT / 3).map_or(text, |(end, _)| &text[..end]);
    Cow::Owned(format!("{head}…{}", tail(text, MAX_TEXT / 3)))
}

/// Returns the last `count` characters of a text.
fn tail(text: &str, count: usize) -> &str {
    text.char_indices().rev().take(count).last().map_or("", |(start, _)| &text[start..])
}

/// Returns `true` for control characters, and for invisible characters, some of which reorder the
/// text.
fn is_obeyed(character: char) -> bool {
    character.is_control()
        || matches!(
            character,
            '\u{61c}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}'
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_escaped() {
        let text = "name\u{9b}2J\u{7}\r\n\t\u{202e}txt.exe";
        assert_eq!(
            Printable(text).to_string(),
            r"name\u{9b}2J\u{7}\r\n\t\u{202e}txt.exe",
            "C1 controls and directions too"
        );
        assert_eq!(Printable("Müller 日本 e\u{301}").to_string(), "Müller 日本 e\u{301}");
        assert_eq!(format!("{:6}|", Printable("ab")), "ab    |", "it is padded as a text is");
    }

    #[test]
    fn the_middle_of_a_long_text_is_left_out() {
        let long = format!("begin{}end", "ä".repeat(100_000));
        let shown = Printable(&long).to_string();
        assert!(shown.starts_with("beginä") && shown.ends_with("äend"), "{shown}");
        assert!(shown.chars().count() <= MAX_TEXT + 1, "{}", shown.len());
        let told = message(&format!("unknown `{}`,\n\texpected one", "x ".repeat(1_000_000)));
        assert!(told.starts_with("unknown `x x") && told.ends_with("expected one"), "{told}");
        assert!(told.chars().count() <= MAX_TEXT + 1, "{}", told.len());
    }
}
