"""Reading XML that others wrote, and writing text into XML: no document types, no entities, bounded size."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import XML_BYTES, XML_DEEPEST, XML_ELEMENTS, bounded_number
from coeflab.core.text.toml import read_text

_DECLARED = re.compile(r"<!\s*(DOCTYPE|ENTITY|ELEMENT|ATTLIST|NOTATION)", re.IGNORECASE)
_UNBOUND = 27  # expat: unbound prefix
_PREFIXED = re.compile(r"[<\s/]([A-Za-z_][\w.-]{0,80}):[A-Za-z_]", re.ASCII)
_BOUND = re.compile(r"\sxmlns:([A-Za-z_][\w.-]{0,80})\s*=", re.ASCII)
_ROOT = re.compile(r"<[A-Za-z_][\w.:-]*", re.ASCII)
MOST_BEFORE_ROOT = 1000  # comments and instructions
_NO_XML = re.compile(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def parse_xml(text: str, file: Path | str | None = None) -> ElementTree.Element:
    """The root of a document.

    Raises
    ------
    InputError
        A document type or an entity (both can make a small file unfold to any size, or read other files), elements deeper
        than 200 or more than 100,000, or no well-formed XML, with its line.
    """
    declared = _DECLARED.search(text)
    if declared:
        raise InputError(
            f"<!{declared[1]}", "XML without document types and entities", file=file,
            line=text.count("\n", 0, declared.start()) + 1, advice="Remove it; a model file needs none.",
        )  # fmt: skip
    try:
        root = _parsed(text, file)
    except ElementTree.ParseError as why:
        if why.code == _UNBOUND and (declared_text := _prefixes_declared(text)) != text:
            return parse_xml(declared_text, file)
        line, column = why.position
        raise InputError(shown(why), "well-formed XML", file=file, line=line, column=f"character {column}") from None
    return root


def _parsed(text: str, file: Path | str | None) -> ElementTree.Element:
    parser = ElementTree.XMLParser(target=_Bounded(file))
    parser.feed(text)
    root: ElementTree.Element = parser.close()
    return root


def _prefixes_declared(text: str) -> str:
    """The text with every prefix that it uses and nowhere declares, such as ``gz:``, declared in its root element.

    SDFormat reads without namespaces, so that its files have prefixes that stand for nothing.
    """
    known = {"xml", "xmlns", *_BOUND.findall(text)}
    strange = sorted({p for p in _PREFIXED.findall(text) if p not in known})
    at = 0
    for _ in range(MOST_BEFORE_ROOT):
        at = len(text) - len(text[at:].lstrip())
        closing = "?>" if text.startswith("<?", at) else "-->" if text.startswith("<!--", at) else ""
        end = text.find(closing, at) if closing else -1
        if end < 0:
            break
        at = end + len(closing)
    root = _ROOT.match(text, at)
    if root is None or not strange:
        return text
    spaces = "".join(f' xmlns:{p}="undeclared:{p}"' for p in strange)
    return text[: root.end()] + spaces + text[root.end() :]


class _Bounded(ElementTree.TreeBuilder):
    """Builds a tree of limited depth."""

    def __init__(self, file: Path | str | None) -> None:
        super().__init__()
        self._file, self._depth, self._count = file, 0, 0

    def start(self, tag: str, attrs: dict[str, str], /) -> ElementTree.Element:
        self._depth += 1
        self._count += 1
        if self._depth > XML_DEEPEST:
            raise InputError(f"elements more than {XML_DEEPEST} deep", "a model file", file=self._file)
        if self._count > XML_ELEMENTS:
            raise InputError(f"more than {XML_ELEMENTS} elements", "a model file", file=self._file)
        return super().start(tag, attrs)

    def end(self, tag: str, /) -> ElementTree.Element:
        self._depth -= 1
        return super().end(tag)


def read_xml(path: Path) -> ElementTree.Element:
    """The root of a file in UTF-8 of at most 8 MiB.

    Raises
    ------
    InputError
    """
    return parse_xml(read_text(path, XML_BYTES), path)


def once(parent: ElementTree.Element | None, file: Path | str | None = None) -> None:
    """Refuse an element that holds two of the same name, of which a reader would take either.

    Raises
    ------
    InputError
    """
    tags = [e.tag for e in parent] if parent is not None else []
    for tag in dict.fromkeys(tags):
        if tags.count(tag) > 1:
            raise InputError(f"<{tag}> {tags.count(tag)} times", "once", file=file, column=f"<{parent.tag}>")  # type: ignore[union-attr]


def sayable(text: str) -> str:
    """A text without the characters that XML 1.0 has no way to write, each a question mark instead."""
    return _NO_XML.sub("?", text)


def serialised(root: ElementTree.Element, comment: tuple[str, ...]) -> bytes:
    """A document in UTF-8, two blanks of indent, a comment in front.

    Parameters
    ----------
    root : Element
    comment : tuple of str
        Lines; double hyphens, which end comments, are loosened.
    """
    ElementTree.indent(root)
    lines = [re.sub(r"-(?=-)", "- ", sayable(" ".join(c.split()))) for c in comment]
    head = "".join(f"  {line}\n" for line in lines)
    body = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<!--\n{head}-->\n{body}\n'.encode()


def numbers(text: str | None, count: tuple[int, ...], where: str, file: Path | str | None = None) -> tuple[float, ...]:
    """Numbers between blanks.

    Parameters
    ----------
    text : str or None
    count : tuple of int
        How many there may be.
    where : str
    file : path, optional
        Both for the error.

    Raises
    ------
    InputError
        Not one of the allowed counts, or one that is no finite number.
    """
    out = []
    for word in (text or "").split():
        try:
            value = float(word)
        except ValueError:
            raise InputError(shown(word), "a number", file=file, column=where) from None
        if value - value != 0.0:
            raise InputError(shown(word), "a finite number", file=file, column=where)
        if expected := bounded_number(value):
            raise InputError(shown(word), expected, file=file, column=where)
        out.append(value)
    if len(out) not in count:
        raise InputError(f"{len(out)} numbers", f"{' or '.join(map(str, count))}", file=file, column=where)
    return tuple(out)
