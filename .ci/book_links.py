"""Checks the links and pictures of the guide's Markdown sources, or of the built book.

Usage: book_links.py GUIDE [BOOK]. GUIDE is the folder of the sources. With BOOK, the folder of the built book, only the
book is checked. Prints a line for each problem; the exit status is 1 if there is a problem, else 0.
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

INLINE = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
DEFINITION = re.compile(r"^\[([^\]]+)\]: (\S+)$", re.MULTILINE)
REFERENCE = re.compile(r"(!?)\[([^\]]+)\]\[([^\]]+)\]")
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
CODE = re.compile(r"`[^`\n]*`")
MAX_TOTAL = 600_000


def is_external(target):
    return re.match(r"[a-z]+:", target) is not None


def anchors(text):
    """Returns the ids that rustdoc and mdBook generate for the headings of a Markdown text."""
    kept = (re.sub(r"[^\w\- ]", "", heading.lower()) for heading in HEADING.findall(text))
    return {heading.strip().replace(" ", "-") for heading in kept}


def source_findings(guide):
    """Yields a message for each problem of the Markdown files.

    A problem is a link without a definition, a file or a heading, a picture with a description of less than 20
    characters, a page that is not in SUMMARY.md, an unused picture, or a total picture size above MAX_TOTAL bytes.
    """
    texts = {page.name: FENCE.sub("", page.read_text()) for page in sorted(guide.glob("*.md"))}
    used = set()
    for name, text in texts.items():
        prose = CODE.sub("", text)
        definitions = dict(DEFINITION.findall(text))
        references = REFERENCE.findall(prose)
        for _, _, reference in references:
            if reference not in definitions:
                yield f"{name}: [{reference}] has no definition"
        inline = INLINE.findall(prose)
        for bang, alt, _ in inline + references:
            if bang and len(alt) < 20:
                yield f"{name}: a picture without a description: {alt!r}"
        for target in [target for _, _, target in inline] + list(definitions.values()):
            path, _, anchor = target.partition("#")
            used.add(path)
            if is_external(target):
                continue
            if path and not (guide / path).is_file():
                yield f"{name}: no file {path}"
            elif anchor and anchor not in anchors(texts.get(path or name, "")):
                yield f"{name}: no heading {target}"
    for name in texts.keys() - {"SUMMARY.md"}:
        if f"({name})" not in texts["SUMMARY.md"]:
            yield f"SUMMARY.md: {name} is no chapter"
    pictures = [path for path in sorted(guide.glob("pictures/*")) if path.suffix != ".uri"]
    for picture in pictures:
        if f"pictures/{picture.name}" not in used:
            yield f"pictures/{picture.name}: in no chapter"
    total = sum(picture.stat().st_size for picture in pictures)
    if total > MAX_TOTAL:
        yield f"pictures: {total} bytes, more than {MAX_TOTAL}"


class Page(HTMLParser):
    """The ids of an HTML page, and the targets of its links and pictures."""

    def __init__(self, text):
        super().__init__()
        self.ids, self.targets = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.ids.add(value)
            if value and (name == "src" or (name == "href" and tag in ("a", "link"))):
                self.targets.append(value)


def book_findings(book):
    """Yields a message for each broken link and missing picture of the HTML pages."""
    pages = {page.resolve(): Page(page.read_text()) for page in sorted(book.glob("*.html"))}
    for path, page in pages.items():
        for target in page.targets:
            if is_external(target) or target.startswith("/"):
                continue
            file, _, anchor = unquote(target).partition("#")
            found = (path.parent / file).resolve() if file else path
            if not found.exists():
                yield f"{path.name}: no file {file}"
            elif anchor and found in pages and anchor not in pages[found].ids:
                yield f"{path.name}: no heading {target}"


def main(guide, book=None):
    findings = sorted(set(book_findings(Path(book)) if book else source_findings(Path(guide))))
    for finding in findings:
        print(finding, file=sys.stderr)
    what = "book" if book else "sources"
    print(f"the guide's {what}: {len(findings) or 'no'} broken links, missing or superfluous pictures")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
