"""The terms of reports and of docs/glossary.md: one place defines them, and a page links to them.

`linked_html` links the first mention of a term, `definitions_html` is the list that it leads to, `markdown` is docs/glossary.md.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib.resources import files

from coeflab.core.provenance import work
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import own_toml
from coeflab.report.markup import html, html_with


@dataclass(frozen=True, slots=True)
class Term:
    """A term and what it means.

    Attributes
    ----------
    name : str
    meaning : str
        One to three sentences, plain text.
    sources : tuple of str
        Keys of works of `coeflab.core.provenance`; empty for a word of coeflab alone.
    spellings : tuple of str
        How texts write it besides its name. One with a capital is found as it stands, others also at the start of a sentence.
    page : str
        Of docs/, where there is more; empty without one.
    by_name : bool
        Whether the name alone is a mention; not for a word of everyday English such as "form".
    """

    name: str
    meaning: str
    sources: tuple[str, ...] = ()
    spellings: tuple[str, ...] = ()
    page: str = ""
    by_name: bool = True

    @property
    def anchor(self) -> str:
        """Its id in a page: ``term-u95``."""
        return "term-" + re.sub(r"[^a-z0-9]+", "-", self.name.lower()).strip("-")


@cache
def terms() -> tuple[Term, ...]:
    """All of glossary.toml."""
    content = own_toml(own_text(files("coeflab.report") / "glossary.toml"))
    return tuple(
        Term(
            name, it["meaning"], tuple(it.get("sources", ())), tuple(it.get("spellings", ())), it.get("page", ""), it.get("by_name", True)
        )
        for name, it in content.items()
    )  # fmt: skip


def linked_html(text: str, seen: set[str], *, listed: bool = True) -> str:
    """A sentence as HTML with its symbols, as `notation.html`, and the first mention of every term linked to its definition.

    Parameters
    ----------
    text : str
    seen : set of str
        Anchors of the terms that are linked already, in this page or section; those linked here are added.
    listed : bool
        Whether the page ends with the definitions; else a term only shows its own.

    Returns
    -------
    str
        Links are ``<a class="term" href="#term-u95" title="...">U95</a>``. In texts of users nothing is linked.
    """
    found = []

    def marks(plain: str) -> Iterator[tuple[int, int, str, str]]:
        for start, end, term in mentions(plain):
            if term.anchor not in seen and term.anchor not in found:
                found.append(term.anchor)
                title = escape(term.meaning, quote=True)
                if listed:
                    yield start, end, f'<a class="term" href="#{term.anchor}" title="{title}">', "</a>"
                else:
                    yield start, end, f'<abbr class="term" tabindex="0" title="{title}">', "</abbr>"

    out = html_with(text, marks)
    seen.update(anchor for anchor in found if not listed or f'href="#{anchor}"' in out)
    return out


def definitions_html(anchors: Collection[str]) -> str:
    """The definitions of terms as one ``<dl class="terms">``, in the alphabet's order; docs/glossary.md has their sources.

    Parameters
    ----------
    anchors : collection of str
        As `linked_html` collects them.
    """
    rows = []
    for term in alphabetical():
        if term.anchor in anchors:
            rows.append(f'<dt id="{term.anchor}">{html(term.name)}</dt>\n<dd>{html(term.meaning)}</dd>')
    return '<dl class="terms">\n' + "\n".join(rows) + "\n</dl>" if rows else ""


def mentions(text: str) -> Iterator[tuple[int, int, Term]]:
    """Every mention of a term in a text: where it begins and ends, and which."""
    pattern, spelled = _spelled()
    for found in pattern.finditer(text):
        yield found.start(), found.end(), spelled[found[0]] if found[0] in spelled else spelled[_lowered(found[0])]


def alphabetical() -> tuple[Term, ...]:
    """The terms as a glossary lists them."""
    return tuple(sorted(terms(), key=lambda t: (t.name.lower(), t.name)))


HEAD = """# Glossary

Terms of coeflab's reports and files, each with its source. The HTML report links the first mention of a term to this text.
Generated from `coeflab/report/glossary.toml`, checked by `tests/report/test_glossary.py`.

"""


def markdown() -> str:
    """docs/glossary.md."""
    rows = []
    for term in alphabetical():
        more = f" [{term.page}]({term.page})" if term.page else ""
        sources = f" *{' '.join(work(key) for key in term.sources)}*" if term.sources else ""
        rows.append(f'<a id="{term.anchor}"></a>**{_escaped(term.name)}**: {_escaped(term.meaning)}{more}{sources}\n')
    return HEAD + "\n".join(rows)


def _escaped(text: str) -> str:
    return re.sub(r"([|*_\[\]<])", r"\\\1", text)


def _lowered(text: str) -> str:
    return text[:1].lower() + text[1:]


@cache
def _spelled() -> tuple[re.Pattern[str], dict[str, Term]]:
    spelled = {word: term for term in terms() for word in (*(term.name,) * term.by_name, *term.spellings)}
    words = []
    for word in sorted(spelled, key=len, reverse=True):
        first, rest = re.escape(word[0]), re.escape(word[1:])
        words.append(f"[{word[0].upper()}{word[0]}]{rest}" if word == word.lower() else first + rest)
    return re.compile(rf"(?<![\w'./|-])(?:{'|'.join(words)})(?![\w'|-])(?!\.\w)"), spelled
