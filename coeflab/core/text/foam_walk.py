"""Walks the braces of an OpenFOAM dictionary: where every entry stands, what its macros named at that line."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import FOAM_BYTES, FOAM_DEEPEST, FOAM_ENTRIES, FOAM_VALUE
from coeflab.core.text.foam_values import IN_EXPRESSION, MACRO, TOKEN

EVALUATED = ("#calc", "#eval", "#codeStream", "#neg")
CONDITIONAL, LIST = "#if", "#list"  # in place of values that are not read
_BINARY = re.compile(rb"\s*+List<(scalar|vector|symmTensor|tensor)>\s*+(\d{1,9})\s*+\(")
_LISTED = re.compile(rb"\s++(?:List<\w+>|\d)")
COMPONENTS = {b"scalar": 1, b"vector": 3, b"symmTensor": 6, b"tensor": 9}
_CLOSES = {"(": ")", "[": "]", "{": "}"}
_INTO = re.compile(r"(?:\.\./)*")


@dataclass(frozen=True, slots=True)
class Entry:
    """One statement: its value as the file writes it, with file, line and what its macros named there."""

    text: str
    file: Path
    line: int
    named: Mapping[str, Entry | Foam | None] = field(default_factory=dict, repr=False)


@dataclass(slots=True, eq=False)
class Foam:
    """A dictionary, or a part of one.

    Attributes
    ----------
    entries : dict of str to Entry or Foam
        By keyword; patterns keep their quotation marks.
    parent : Foam or None
    """

    entries: dict[str, Entry | Foam] = field(default_factory=dict)
    parent: Foam | None = None

    def part(self, *names: str) -> Foam | None:
        """The dictionary below these keywords, or None."""
        at = self.below(names)
        return at if isinstance(at, Foam) else None

    def below(self, names: Sequence[str]) -> Entry | Foam | None:
        """What stands below these keywords, or None."""
        at: Entry | Foam | None = self
        for name in names:
            at = at.entries.get(name) if isinstance(at, Foam) else None
        return at

    def parts(self) -> Iterator[tuple[str, Foam]]:
        """The dictionaries directly below, by keyword."""
        return ((name, e) for name, e in self.entries.items() if isinstance(e, Foam))

    def named(self, macro: str) -> Entry | Foam | None:
        """What a macro names: ``x`` here or further out, ``.x`` here, ``..x`` or ``../x`` one part out, ``:x`` or ``!x`` at the top."""
        at: Foam | None = self
        outwards = macro[0] not in ":!."
        if macro[0] in ":!":
            while at is not None and at.parent is not None:
                at = at.parent
            macro = macro[1:]
        elif macro.startswith("../"):
            steps = len(_INTO.match(macro)[0]) // 3  # type: ignore[index]
            at, macro = self._outwards(steps), macro[3 * steps :]
        elif not outwards:
            name = macro.lstrip(".")
            at, macro = self._outwards(len(macro) - len(name) - 1), name
        while at is not None and macro:
            found = at.entries.get(macro) or at.below([k for k in re.split(r"[./]", macro) if k])
            if found is not None and found is not at:
                return found
            at = at.parent if outwards else None
        return None

    def _outwards(self, steps: int) -> Foam | None:
        at: Foam | None = self
        for _ in range(steps):
            at = at.parent if at is not None else None
        return at


class Reader(Protocol):
    """What a walk asks of the case."""

    copied: int

    def relative(self, file: Path) -> str:
        """A file's path from the folder of the case."""

    def note(self, found: str | Finding) -> None:
        """Keep what was found."""

    def include(self, file: Path, line: int, named: str, into: Foam, depth: int, *, needed: bool) -> None:
        """Read another file into a dictionary.

        Parameters
        ----------
        file, line : Path, int
            Where it is included.
        named : str
        into : Foam
        depth : int
            How many files include one another by now.
        needed : bool
            Whether a missing one is noted.
        """

    def include_function(self, file: Path, line: int, named: str, into: Foam, depth: int) -> None:
        """Read a file of ``system`` that holds a function object.

        Parameters
        ----------
        file, line, named, into, depth
            As of `include`.
        """


class Walk:
    """Walks one file into a dictionary, in time that grows with its length."""

    def __init__(self, case: Reader, file: Path, content: bytes, into: Foam, depth: int) -> None:
        self.case, self.file, self.content, self.depth = case, file, content, depth
        self.is_binary = re.search(rb"format\s++binary", content[:4096]) is not None
        self.stack, self.closes, self.opened = [into], [""], [1]
        self.words: list[str] = []
        self.length = 0
        self.line = self.first = 1
        self.nested: list[str] = []
        self.conditions = 0

    def whole(self) -> None:
        """Walk the whole text."""
        seen = position = spent = 0
        while (match := TOKEN.match(self.content, position)) is not None:
            kind = match.lastgroup or ""
            start = match.start(kind)
            self.line += self.content.count(b"\n", seen, start)
            seen, position = start, match.end()
            spent += position - start
            if spent > FOAM_BYTES:
                found = f"more than {FOAM_BYTES >> 10} KiB besides lists of fields"
                raise InputError(found, "a dictionary of OpenFOAM", file=self.file, line=self.line)
            if kind == "skip":
                if match["open"] is not None:
                    raise self._wrong("a comment without its end", "*/")
                continue
            token = match[kind].decode("utf-8", "replace")
            if not self.words and token[0] == "#" and kind == "word":
                end = self.content.find(b"\n", position)
                end = len(self.content) if end < 0 else end
                self._directive(token, self.content[position:end].decode("utf-8", "replace").strip())
                spent, position = spent + end - position, end
                continue
            if kind == "mark" and self._mark(token):
                continue
            if not self.words:
                self.first, self.length = self.line, 0
            if self.length <= FOAM_VALUE:
                self.words.append(token)
                self.length += len(token) + 1
            if token == "nonuniform" and (past := self._past_list(position)):
                self.words.append(LIST)
                position = past
        self._closed()

    def _past_list(self, at: int) -> int:
        """Where the list of a field ends, unread; 0 where none begins here."""
        if self.is_binary and (binary := _BINARY.match(self.content, at)) is not None:
            width = 4 if b"scalar=32" in self.content[:4096] else 8
            at = binary.end() + width * COMPONENTS[binary[1]] * int(binary[2])
        elif _LISTED.match(self.content, at) is None:
            return 0
        end = self.content.find(b";", at)
        if end < 0:
            raise self._wrong("the end of the file", "; after a list")
        return end

    def _closed(self) -> None:
        if self.nested:
            raise self._wrong(f"the end of the file without {self.nested[-1]}", "a whole dictionary")
        self._end()
        for close, line in zip(self.closes[1:], self.opened[1:], strict=True):
            self._found("unclosed", line, mark="{" if close == "}" else "(")

    def _found(self, what: str, line: int, **facts: Any) -> None:
        place = f"{self.case.relative(self.file)}:{line}"
        self.case.note(Finding.of(f"foam.{what}", self.file.name, Severity.WARN, place=place, **facts))

    def _mark(self, mark: str) -> bool:
        """Whether a brace, bracket or semicolon is dealt with here; it is part of a value otherwise."""
        if self.nested:
            if mark == self.nested[-1]:
                self.nested.pop()
            elif mark in _CLOSES:
                self._open(_CLOSES[mark])
            elif mark != ";":
                raise self._wrong(shown(mark), self.nested[-1])
            return False
        if mark == ";":
            self._end()
            return True
        is_list = mark == "(" and len(self.words) == 1 and (self.words[0] == "functions" or self.words[0].isdigit())
        if mark == "{" and self.words and (self.words[-1] in EVALUATED or self.words[-1] == "$"):
            self._open("}")
            return False
        if mark == "{" or is_list:
            if len(self.stack) > FOAM_DEEPEST:
                raise self._wrong("braces that nest too deep", f"at most {FOAM_DEEPEST}")
            self._down("}" if mark == "{" else ")")
            return True
        if mark == self.closes[-1]:
            self._end()
            self.stack.pop()
            self.closes.pop()
            self.opened.pop()
            return True
        if mark in _CLOSES:
            self._open(_CLOSES[mark])
            return False
        self._end()
        self._found("stray", self.line, mark=mark)
        return True

    def _open(self, close: str) -> None:
        if len(self.nested) > FOAM_DEEPEST:
            raise self._wrong("brackets that nest too deep", f"at most {FOAM_DEEPEST}")
        self.nested.append(close)

    def _wrong(self, found: str, expected: str) -> InputError:
        return InputError(found, expected, file=self.file, line=self.line)

    def _down(self, close: str) -> None:
        """Open the dictionary of the words read so far."""
        name = " ".join(self.words)
        here = self.stack[-1]
        if name.isdigit() and len(self.stack) == 1 and close == ")":
            below = here
        else:
            known = here.entries.get(name)
            below = known if isinstance(known, Foam) else Foam(parent=here)
            here.entries[name] = below
        self.stack.append(below)
        self.closes.append(close)
        self.opened.append(self.line)
        self.words = []

    def _end(self) -> None:
        """Keep a statement."""
        if not self.words:
            return
        name, *words = self.words
        self.words = []
        here = self.stack[-1]
        if name.startswith("$") and not words:
            self._merge(name, here)
            return
        text = CONDITIONAL if self.conditions else " ".join(words)
        named = {
            m[0]: here.named(m[1] or m[2]) for p in (MACRO, IN_EXPRESSION) for m in p.finditer(text[: FOAM_VALUE + 1])
        } if "$" in text else {}  # fmt: skip
        of = named.get(words[0]) if len(words) == 1 else None
        if isinstance(of, Foam) and not self.conditions:
            here.entries[name] = below = Foam(parent=here)
            self._copy(of, below)
        else:
            here.entries[name] = Entry(text, self.file, self.first, named)

    def _merge(self, macro: str, here: Foam) -> None:
        """Take over the entries of the dictionary that a macro names."""
        match = MACRO.fullmatch(macro)
        found = here.named(match[1] or match[2]) if match is not None else None
        if not isinstance(found, Foam):
            self._found("dictionary", self.first, macro=shown(macro))
        elif not self.conditions:
            self._copy(found, here)

    def _copy(self, source: Foam, into: Foam) -> None:
        """The entries of one dictionary in another, all the way down."""
        at: Foam | None = into
        while at is not None:
            if at is source:
                return  # itself, or what it stands in
            at = at.parent
        for name, entry in list(source.entries.items()):
            self.case.copied += 1
            if self.case.copied > FOAM_ENTRIES:
                raise self._wrong("dictionaries that copy one another", f"at most {FOAM_ENTRIES:,} entries")
            if isinstance(entry, Foam):
                known = into.entries.get(name)
                below = known if isinstance(known, Foam) else Foam(parent=into)
                into.entries[name] = below
                self._copy(entry, below)
            else:
                into.entries[name] = entry

    def _directive(self, name: str, rest: str) -> None:
        match = re.match(r'"([^"]*)"|([^\s;]+)', rest)
        named = (match[1] or match[2] or "") if match else ""
        here = self.stack[-1]
        if name in ("#include", "#includeIfPresent", "#sinclude") and named:
            self.case.include(self.file, self.line, named, here, self.depth, needed=name == "#include")
        elif name in ("#includeFunc", "#func"):
            if re.fullmatch(r"[\w.-]+", named):
                self.case.include_function(self.file, self.line, named, here, self.depth)
        elif name.startswith("#if"):
            self.conditions += 1
        elif name == "#endif":
            self.conditions = max(self.conditions - 1, 0)
        elif name == "#remove" and named in here.entries and not self.conditions:
            del here.entries[named]
        elif name not in ("#else", "#message", "#word"):
            self._found("directive", self.line, text=shown(f"{name} {rest}".strip()))
