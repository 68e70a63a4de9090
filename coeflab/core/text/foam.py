"""Dictionaries of OpenFOAM cases, includes and macros followed. Nothing that a case brings is executed.

Plain arithmetic of ``#calc``, ``#eval`` and ``#neg`` is computed; any other code stays unstated, with a remark that names its
line. Every step takes time that grows with the length of the text: a case may be of anybody.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from coeflab.core.arithmetic import ArithmeticProblem
from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import FOAM_DEEPEST, FOAM_FIELD_BYTES, FOAM_FILES, FOAM_VALUE
from coeflab.core.text.foam_values import MACRO, TOKEN, computed, value_of, written
from coeflab.core.text.foam_walk import CONDITIONAL, LIST, Entry, Foam, Walk
from coeflab.core.text.series import opened
from coeflab.core.texts import remark

__all__ = ["Entry", "Foam", "FoamCase"]
ROOTS = {"$FOAM_CASE": "", "${FOAM_CASE}": "", "<case>": "", "<system>": "system", "<constant>": "constant"}
_NO_CODE = "plain arithmetic is computed"


@dataclass(slots=True)
class FoamCase:
    """Reads the dictionaries of one case and keeps account of it.

    Attributes
    ----------
    root : Path
        Folder of the case.
    files : list of Path
        What was read.
    notes : list of str
        What could not be followed or is not evaluated, one sentence each.
    findings : list of Finding
        The same as data, as far as the reader itself found it.
    known : dict of str to Foam or None
        What was read, by name.
    copied : int
        Entries that dictionaries took over from others.
    included : int
        How often a file was included.
    """

    root: Path
    files: list[Path] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    known: dict[str, Foam | None] = field(default_factory=dict)
    copied: int = 0
    included: int = 0

    def place(self, entry: Entry) -> str:
        """File, from the folder of the case, and line."""
        return f"{self.relative(entry.file)}:{entry.line}"

    def relative(self, file: Path) -> str:
        """A file's path from the folder of the case."""
        return file.relative_to(self.root).as_posix() if file.is_relative_to(self.root) else str(file)

    def note(self, found: str | Finding) -> None:
        """Keep a note, once."""
        if isinstance(found, Finding):
            if found in self.findings:
                return
            self.findings.append(found)
            found = remark(found)
        if found not in self.notes:
            self.notes.append(found)

    def read(self, name: str) -> Foam | None:
        """A dictionary of the case, plain or compressed, or its ``.orig``; None where there is none, or where it is too long.

        Parameters
        ----------
        name : str
            From the folder of the case, such as ``system/controlDict``.

        Raises
        ------
        InputError
            Not to be read, brackets that do not match, includes without end.
        """
        if name not in self.known:
            self.known[name] = None
            for suffix in ("", ".gz", ".orig", ".orig.gz"):
                file = self.root / f"{name}{suffix}"
                content = self._content(file)
                if content is not None:
                    top = self.known[name] = Foam()
                    Walk(self, file, content, top, 0).whole()
                    break
        return self.known[name]

    def _content(self, file: Path) -> bytes | None:
        """What a file holds; None where it is no file, or too long."""
        try:
            is_file = file.is_file()
        except OSError as why:
            raise InputError(str(why.strerror or why), "a readable file", file=file) from None
        if not is_file:
            return None
        with opened(file) as stream:
            content = stream.read(FOAM_FIELD_BYTES + 1)
        if file not in self.files:
            self.files.append(file)
        if len(content) > FOAM_FIELD_BYTES:
            self._found("too_long", self.relative(file), threshold=FOAM_FIELD_BYTES / 2**20)
            return None
        return content

    def _found(self, what: str, place: str, *, threshold: float | None = None, **facts: Any) -> None:
        subject = place.partition(":")[0]
        self.note(Finding.of(f"foam.{what}", subject, Severity.WARN, threshold=threshold, place=place, **facts))

    def value(self, within: Foam | None, *names: str) -> tuple[Any, str] | None:
        """A value and its place; None where it is not stated, or needs code to be run (with a note).

        Numbers are numbers in SI, vectors lists, several words a tuple; ``uniform`` and dimensions are taken off.

        Parameters
        ----------
        within : Foam or None
        names : str
            Keywords, outermost first.
        """
        entry = within.below(names) if within is not None and names else None
        if isinstance(entry, Foam) and self.word(entry, "type") in ("constant", "uniform"):
            entry = entry.entries.get("value", entry.entries.get("constant"))  # a function of time that is none
        if not isinstance(entry, Entry):
            return None
        text = self._expanded(entry, [FOAM_VALUE], 0)
        if text is None:
            return None
        value = value_of(text)
        if value is None:
            self._found("unread", self.place(entry), name=names[-1], text=shown(entry.text))
            return None
        return value, self.place(entry)

    def word(self, within: Foam | None, *names: str) -> str:
        """A value that is one word, without quotation marks; empty where it is none."""
        found = self.value(within, *names)
        return found[0].strip('"') if found is not None and isinstance(found[0], str) else ""

    def listed(self, within: Foam | None, *names: str) -> list[str]:
        """A value as words, whether it is one word, a number or a list; patterns keep their quotation marks."""
        found = self.value(within, *names)
        value = found[0] if found is not None else []
        items = (
            [i for v in value for i in (v if isinstance(v, list) else [v])]
            if isinstance(value, (list, tuple))
            else [value]
        )
        return [str(i) for i in items if not isinstance(i, list)]

    def where(self, within: Foam | None, *names: str) -> str:
        """The place of an entry, whether its value is read or not; of a dictionary, that of its first entry."""
        at = within.below(names) if within is not None else None
        while isinstance(at, Foam):
            at = next(iter(at.entries.values()), None)
        return self.place(at) if at is not None else ""

    def _expanded(self, entry: Entry, left: list[int], depth: int) -> str | None:
        """The text of an entry: its macros replaced by what they named where it stands, plain arithmetic computed."""
        place = self.place(entry)
        if CONDITIONAL in entry.text or LIST in entry.text or len(entry.text) > FOAM_VALUE:
            self._found("conditional" if CONDITIONAL in entry.text else "long", place)
            return None
        out: list[str] = []
        content, at, negative = entry.text.encode(), 0, False
        while (match := TOKEN.match(content, at)) is not None:
            at, kind = match.end(), match.lastgroup or ""
            token = match[kind].decode("utf-8", "replace")
            left[0] -= 1
            if kind == "word" and token == "#neg":
                negative = True
                continue
            if kind == "inline" or (kind == "word" and token[0] == "#"):
                expression, at = (token[3:-2], at) if kind == "inline" else _argument(content, at)
                piece = self._computed(entry, token, expression, left, depth)
            elif kind == "word" and "$" in token:
                piece = self._replaced(entry, token, left, depth)
            else:
                piece = token
            if piece is not None and negative:
                piece, negative = self._negated(entry, piece), False
            if piece is None or left[0] < len(piece):
                return None
            left[0] -= len(piece)
            out.append(piece)
        return " ".join(out)

    def _computed(self, entry: Entry, name: str, expression: str | None, left: list[int], depth: int) -> str | None:
        """A computed value as text; None, with its line, where it is more than plain arithmetic."""
        why = _NO_CODE
        if expression is not None and (name in ("#calc", "#eval") or name.startswith("$")):
            try:
                return written(
                    computed(expression, lambda n: self._number(entry, n, left, depth), whole_divides=name == "#calc")
                )
            except ArithmeticProblem as problem:
                why = f"{_NO_CODE}: {shown(problem)}"
        self._found("code", self.place(entry), text=shown(entry.text), why=why)
        return None

    def _number(self, entry: Entry, name: str, left: list[int], depth: int) -> Any:
        found = entry.named.get(f"${name}", entry.named.get(f"${{{name}}}"))
        text = self._expanded(found, left, depth + 1) if isinstance(found, Entry) and depth < FOAM_DEEPEST else None
        return value_of(text) if text is not None else None

    def _negated(self, entry: Entry, piece: str) -> str | None:
        value = value_of(piece)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return repr(-value)
        self._found("code", self.place(entry), text=shown(entry.text), why="#neg takes one number")
        return None

    def _replaced(self, entry: Entry, token: str, left: list[int], depth: int) -> str | None:
        """A word with its macros replaced."""
        out, end = "", 0
        for macro in MACRO.finditer(token):
            found = entry.named.get(macro[0])
            text = (
                self._expanded(found, left, depth + 1)
                if isinstance(found, Entry) and depth < FOAM_DEEPEST and left[0] > 0
                else None
            )
            if text is None:
                self._found("unknown", self.place(entry), macro=macro[0], text=shown(entry.text))
                return None
            out, end = out + token[end : macro.start()] + text, macro.end()
        return out + token[end:]

    def include(self, file: Path, line: int, named: str, into: Foam, depth: int, *, needed: bool) -> None:
        """Read another file of the case into a dictionary; one from outside of the case is not read.

        Parameters
        ----------
        file : Path
            That includes it.
        line : int
        named : str
            As it is named there.
        into : Foam
        depth : int
            How many files include one another by now.
        needed : bool
            Whether a missing one is noted.

        Raises
        ------
        InputError
            Includes without end, or as `read`.
        """
        prefix = next((p for p in ROOTS if named.startswith(p)), None)
        path = file.parent / named if prefix is None else self.root / ROOTS[prefix] / named[len(prefix) :].lstrip("/")
        self.included += 1
        if depth >= FOAM_DEEPEST or self.included > FOAM_FILES:
            raise InputError(
                "includes without end", f"at most {FOAM_DEEPEST} deep, {FOAM_FILES} of them", file=file, line=line
            )
        place = f"{self.relative(file)}:{line}"
        if "\0" in named or not self._is_inside(path, file):
            self._found("outside", place, named=shown(named))
            return
        content = self._content(path)
        if content is None:
            if needed:
                self._found("missing", place, named=shown(named))
            return
        Walk(self, path, content, into, depth + 1).whole()

    def include_function(self, file: Path, line: int, named: str, into: Foam, depth: int) -> None:
        """Read the case's own file of a function object; what OpenFOAM itself ships is not there.

        Parameters
        ----------
        file, line, named, into, depth
            As of `include`.
        """
        below = Foam(parent=into)
        self.include(file, line, f"<system>{named}", below, depth, needed=False)
        if below.entries:
            into.entries[named] = below.part(named) or below

    def _is_inside(self, path: Path, file: Path) -> bool:
        """Whether a path leads into the case, or to the folder of the file that includes it, links followed."""
        real = Path(os.path.realpath(path))
        return any(real.is_relative_to(os.path.realpath(folder)) for folder in (self.root, file.parent))


def _argument(content: bytes, at: int) -> tuple[str | None, int]:
    """The expression behind ``#calc`` or ``#eval``, and where it ends: a text, a block of code, or braces."""
    match = TOKEN.match(content, at)
    kind = match.lastgroup if match is not None else None
    if match is not None and kind in ("text", "code"):
        token = match[kind].decode("utf-8", "replace")
        return (token.strip('"') if kind == "text" else token.removeprefix("#{").removesuffix("#}")), match.end()
    if match is not None and kind == "mark" and match[kind] == b"{":
        end = content.find(b"}", at)
        return content[match.end() : end].decode("utf-8", "replace"), end + 1
    return None, at
