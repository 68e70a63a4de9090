"""What columns and units may be called: words/vocabulary.toml, and a file of a person's own beside it."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown, together
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import own_toml, read_toml
from coeflab.law.symbols import COMPONENTS, CONTROL_COLUMNS, CONTROLS, MOTIONS

# Of columns of a table: what is measured, and at what.
NAMES = frozenset(
    {*COMPONENTS, *MOTIONS, *CONTROL_COLUMNS, *CONTROLS, "alpha", "beta", "U", "R", "density", "rps", "J", "thrust"}
)
SECTIONS = ("columns", "flow", "coefficients", "several", "symbols", "units")
Words = Mapping[str, str]


def folded(name: str) -> str:
    """Letters and digits of a name, small, without accents."""
    plain = unicodedata.normalize("NFKD", name.casefold())
    return "".join(c for c in plain if c.isalnum())


_RECORDED = re.compile(r"(?i)\b(?:monitor|report|plot|rfile)\b(?:\s*\d+)?|-op$")
_SHORTEST_WORD = 4  # letters: cd and cl are words of other things too


def recorded(name: str) -> str:
    """A name without what a solver calls its recording: Lift of "Lift Monitor", drag of "drag-report"."""
    return _RECORDED.sub("", name).strip(" -_")


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """Meanings by folded names.

    Attributes
    ----------
    columns, flow, coefficients : mapping of str to str
        The one meaning of a name: of any column, of a force along or across the flow, of a pure number.
    several : mapping of str to str
        Meanings with blanks between, of which the unit or a person chooses.
    symbols : mapping of str to str
        Symbols, with blanks between, by what they mean.
    units : mapping of str to str
        Spelling of the units library by a unit as written, in small letters.
    turns : mapping of str to str
        Units of a rate of a propeller, likewise; of other rates 1/s is rad/s.
    short : mapping of str to str
        Words of a name in full; empty for those that say nothing.
    lists : mapping of str to frozenset of str
        Folded words for a speed of the ship, an index; units of nothing that a fit uses, units of a time.
    own : frozenset of str
        Names that a person's own file gives a meaning.
    """

    columns: Words
    flow: Words
    coefficients: Words
    several: Words
    symbols: Words
    units: Words
    turns: Words
    short: Words
    lists: Mapping[str, frozenset[str]]
    own: frozenset[str] = frozenset()

    def of_flow(self, name: str) -> str:
        """Drag, lift or side, where the name is that or one of its words is; empty where none is, or two differ."""
        if whole := self.flow.get(folded(name)) or self.flow.get(folded(recorded(name))):
            return whole
        words = [w for part in re.split(r"[^\w]+|_", name) if len(w := folded(part)) >= _SHORTEST_WORD]
        found = {self.flow[w] for w in words if w in self.flow}
        return found.pop() if len(found) == 1 else ""


def _inverted(section: Mapping[str, Any]) -> dict[str, str]:
    return {
        folded(w): name for name, words in section.items() for w in (words.split() if isinstance(words, str) else words)
    }


def _read(content: Mapping[str, Any]) -> dict[str, dict[str, str]]:
    out = {section: _inverted(content.get(section, {})) for section in SECTIONS[:3]}
    out["several"] = {folded(word): meanings for word, meanings in content.get("several", {}).items()}
    out["symbols"] = dict(content.get("symbols", {}))
    out["units"] = {" ".join(unit.split()).casefold(): spelt for unit, spelt in content.get("units", {}).items()}
    return out


@cache
def _shipped() -> Vocabulary:
    content = own_toml(own_text(files("coeflab.tables.words") / "vocabulary.toml"))
    lists = {name: frozenset(map(folded, words.split())) | {*words.split()} for name, words in content["lists"].items()}
    sections: dict[str, Any] = _read(content)
    return Vocabulary(**sections, turns=content["turns"], short=content["short"], lists=lists)


_OWN: ContextVar[Vocabulary | None] = ContextVar("vocabulary", default=None)


def vocabulary() -> Vocabulary:
    """The words that count now: those shipped, or within `words_of` a person's own before them."""
    return _OWN.get() or _shipped()


def one_name(name: str) -> str:
    """``dr`` for a column that is called dr, delta_r or rudder, so of every control; other names as they are.

    Words for forces do not count here: which way a normal force points is a question.

    Examples
    --------
    >>> one_name("rudder"), one_name("delta_r"), one_name("dr"), one_name("N"), one_name("normal")
    ('dr', 'dr', 'dr', 'N', 'normal')
    """
    meant = CONTROL_COLUMNS.get(name, name)
    word = vocabulary().columns.get(folded(name), "")
    return word if meant not in NAMES and word in CONTROLS else meant


def did_you_mean(name: str) -> str:
    """``Did you mean dr?`` of ``ruder angle``; empty where no name or word is near.

    Examples
    --------
    >>> did_you_mean("rudder_angel"), did_you_mean("Fx"), did_you_mean("qwertz")
    ('Did you mean dr?', 'Did you mean X?', '')
    """
    found = {folded(n): n for n in sorted(NAMES)} | {w: m for w, m in vocabulary().columns.items() if m in NAMES}
    near = get_close_matches(folded(name), found, n=3, cutoff=0.8)
    return f"Did you mean {' or '.join(dict.fromkeys(found[n] for n in near))}?" if near else ""


@contextmanager
def words_of(path: Path | None) -> Iterator[None]:
    """Words of a person's own file count within, before those shipped; without a file nothing changes.

    Raises
    ------
    InputError
        A table, meaning or text that is none, each with its line.
    """
    token = _OWN.set(_joined(path) if path is not None else _OWN.get())
    try:
        yield
    finally:
        _OWN.reset(token)


def _joined(path: Path) -> Vocabulary:
    file = read_toml(path)
    known = {
        name for words in (_shipped().columns, _shipped().flow, _shipped().coefficients) for name in words.values()
    }
    known |= {"label", "uncertain"}
    complaints: list[InputError] = []
    for section, entries in file.content.items():
        if section not in SECTIONS or not isinstance(entries, dict):
            complaints.append(file.fail(section, shown(section), f"a table of {', '.join(SECTIONS)}"))
            continue
        for key, value in entries.items():
            place = f"{section}.{key}"
            texts = value if isinstance(value, list) else [value]
            if not texts or not all(isinstance(text, str) and text.strip() for text in texts):
                complaints.append(file.fail(place, shown(value), 'words, such as "kraft_x fx_tot" or ["Kraft in x"]'))
            elif section in SECTIONS[:3] and key not in known:
                complaints.append(file.fail(place, shown(key), f"one of {', '.join(sorted(known))}"))
            elif section in SECTIONS[3:] and isinstance(value, list):
                complaints.append(file.fail(place, "a list", "one text"))
            elif section == "several" and (strange := [m for m in value.split() if m not in known]):
                complaints.append(file.fail(place, shown(strange[0]), f"some of {', '.join(sorted(known))}"))
    if complaints:
        raise together(complaints)
    own, base = _read(file.content), _shipped()
    every = frozenset(w for section in SECTIONS[:4] for w in own[section])
    # A word of one's own has no other meaning left.
    selected = {s: {w: m for w, m in getattr(base, s).items() if w not in every} for s in SECTIONS[:4]}
    return Vocabulary(
        **{s: {**selected[s], **own[s]} for s in SECTIONS[:4]},
        symbols={**base.symbols, **own["symbols"]}, units={**base.units, **own["units"]}, turns=base.turns, short=base.short, lists=base.lists, own=every,
    )  # fmt: skip
