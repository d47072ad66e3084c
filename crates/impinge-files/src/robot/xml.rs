//! Reads XML files with the lines of their elements.

use std::path::{Path, PathBuf};

use roxmltree::{Document, Node};

use crate::files::Files;
use crate::text::Quoted;
use crate::{FileError, Problem};

/// The maximum depth of nested elements. The parsers that read the text afterwards are recursive.
const MAX_DEPTH: usize = 32;

/// The maximum number of attributes of an element. Parsers compare each attribute with all earlier
/// attributes.
const MAX_ATTRIBUTES: usize = 256;

/// The texts after `<` and the ends of comments, character data and processing instructions, which
/// have no attributes. A `<` in their content begins no element.
const OPAQUE: [(&str, &str); 3] = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>")];

/// The text of an XML file that is well-formed, with bounded depth and bounded numbers of
/// attributes.
#[derive(Debug)]
pub(super) struct XmlFile {
    path: PathBuf,
    pub(super) text: String,
}

impl XmlFile {
    /// Reads a file, and checks its syntax and bounds.
    pub(super) fn read(path: &Path, files: &mut Files) -> Result<Self, FileError> {
        let text = String::from_utf8_lossy(&files.read_named(path)?).into_owned();
        let file = Self { path: path.to_owned(), text };
        let most = attributes(&file.text);
        if most > MAX_ATTRIBUTES {
            let (what, given, limit) = ("attributes of an element", most, MAX_ATTRIBUTES);
            return Err(file.whole(Problem::TooMany { what, given, limit }));
        }
        let document = file.parse()?;
        // At most `MAX_DEPTH + 1` ancestors are counted, so the check takes time linear in the
        // text.
        let depth = |node: &Node<'_, '_>| node.ancestors().take(MAX_DEPTH + 1).count();
        let too_deep = document.descendants().find(|node| depth(node) > MAX_DEPTH);
        if let Some(node) = too_deep {
            let (what, given, limit) = ("nested elements", MAX_DEPTH + 1, MAX_DEPTH);
            return Err(file.at(&document, node, Problem::TooMany { what, given, limit }));
        }
        Ok(file)
    }

    /// Returns the text with `visual` and `material` elements replaced by spaces. Collisions do not
    /// need these elements, and errors in them must not matter. All lines keep their numbers.
    pub(super) fn without_visuals(&self) -> Result<String, FileError> {
        let document = self.parse()?;
        let is_visual =
            |node: &Node<'_, '_>| ["material", "visual"].iter().any(|tag| node.has_tag_name(*tag));
        let mut bytes = self.text.clone().into_bytes();
        for node in document.descendants().filter(is_visual) {
            bytes[node.range()]
                .iter_mut()
                .filter(|byte| **byte != b'\n')
                .for_each(|byte| *byte = b' ');
        }
        // Only whole elements were replaced, so the text is still UTF-8.
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Parses the text. The error contains the position at which the parser stops.
    fn parse(&self) -> Result<Document<'_>, FileError> {
        Document::parse(&self.text).map_err(|error| {
            let place = error.pos();
            let error = self.whole(Problem::syntax(&error));
            let (line, column) = (Some(place.row as usize), Some(place.col as usize));
            FileError { line, column, ..error }
        })
    }

    /// Returns an error of the whole file.
    pub(super) fn whole(&self, problem: Problem) -> FileError {
        FileError::whole(&self.path, problem)
    }

    /// Returns an error at the first element with this tag and name; without a line if there is
    /// none.
    pub(super) fn error(&self, tag: &str, name: &str, problem: Problem) -> FileError {
        let path = format!("{tag} {}", Quoted(name));
        let Ok(document) = self.parse() else { return self.whole(problem) };
        let is_it =
            |node: &Node<'_, '_>| node.has_tag_name(tag) && node.attribute("name") == Some(name);
        let error = match document.descendants().find(is_it) {
            Some(node) => self.at(&document, node, problem),
            None => self.whole(problem),
        };
        FileError { path, ..error }
    }

    /// Returns an error at the start tag of an element.
    fn at(&self, document: &Document<'_>, node: Node<'_, '_>, problem: Problem) -> FileError {
        let place = document.text_pos_at(node.range().start);
        let (line, column) = (Some(place.row as usize), Some(place.col as usize));
        FileError { line, column, ..self.whole(problem) }
    }

    /// Calls `take` with the values of two attributes of each element with this tag. The first
    /// error ends the loop and gets the line of the element.
    pub(super) fn each(
        &self,
        tag: &str,
        names: [&str; 2],
        mut take: impl FnMut([&str; 2]) -> Result<(), Problem>,
    ) -> Result<(), FileError> {
        let document = self.parse()?;
        for node in document.descendants().filter(|node| node.has_tag_name(tag)) {
            let values = names.map(|name| node.attribute(name).unwrap_or_default());
            // The line is computed only for an error, since it takes a pass over the text before
            // the element.
            take(values).map_err(|problem| self.at(&document, node, problem))?;
        }
        Ok(())
    }
}

/// Returns an upper bound of the number of attributes of any element: the maximum number of `=` in
/// a tag and outside of quotes. O(n) in the bytes of the text.
fn attributes(text: &str) -> usize {
    let (mut rest, mut most) = (text, 0);
    // Ends, since each pass goes beyond a `<`.
    while let Some((_, markup)) = rest.split_once('<') {
        let opaque =
            OPAQUE.iter().find_map(|(start, end)| Some((markup.strip_prefix(start)?, end)));
        rest = match opaque {
            Some((content, end)) => content.split_once(end).map_or("", |(_, after)| after),
            None => {
                most = most.max(equals_signs(markup));
                markup
            }
        };
    }
    most
}

/// Returns the number of `=` outside of quotes in a tag, which ends at a `>` outside of quotes. In
/// well-formed text no tag contains a `<`, so the tag ends there as well.
fn equals_signs(tag: &str) -> usize {
    let (mut count, mut quote) = (0, None);
    for byte in tag.bytes().take_while(|byte| *byte != b'<') {
        match (byte, quote) {
            (_, Some(open)) if byte == open => quote = None,
            (_, Some(_)) => {}
            (b'>', None) => break,
            (b'"' | b'\'', None) => quote = Some(byte),
            (b'=', None) => count += 1,
            _ => {}
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::attributes;

    #[test]
    fn attributes_by_hand() {
        assert_eq!(attributes("<a b='=\">=' c = \"1\"/> d=e=f=g <h i='1'>"), 2);
        assert_eq!(attributes("it's = <a b='1' c='2' d='3'"), 3, "it may end anywhere");
        assert_eq!(attributes("<!-- === --><a b='1'/>"), 1, "a comment has none");
        assert_eq!(attributes("<a><![CDATA[<===]]></a>"), 0, "character data have none");
        assert_eq!(attributes("<?x <!-- === ?><a b='1' c='2'/>"), 2, "no comment begins in it");
        assert_eq!(attributes("<a b='1'/><!-- === ->"), 1, "a comment without an end");
    }
}
