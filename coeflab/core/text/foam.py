"""Dictionaries of OpenFOAM cases: where every entry stands, includes and macros followed, values through foamlib.

foamlib 1.7 reads a file whole or not at all, and its time grows exponentially with the depth of open parentheses, and with the
letters of numbers in a list that holds something else, too. So the braces are walked here, which also gives the line of every
entry, and foamlib gets the one value that is asked for, but for such lists. Code that a case brings (``#calc``, ``#codeStream``, ``#eval``) is never run: its value stays unstated, with a note.
"""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import FOAM_BYTES, FOAM_DEEPEST, FOAM_FIELD_BYTES, FOAM_FILES, FOAM_VALUE, LARGEST_NUMBER
from coeflab.core.text.series import opened

_TOKEN = re.compile(
    r"""(?P<skip>//[^\n]*|/\*.*?(?:\*/|\Z))
    |(?P<text>"(?:[^"\\]|\\.)*(?:"|\Z))
    |(?P<code>\#\{.*?(?:\#\}|\Z))
    |(?P<mark>[{};()\[\]])
    |(?P<word>(?:\$\{[^{}\s]*\}|[^\s{};()\[\]"/]|/(?![/*]))+)""",
    re.DOTALL | re.VERBOSE,
)
_LISTS = re.compile(rb"nonuniform\s+List<\w+>\s*\d*\s*\(.*?\)\s*;|nonuniform\s+\d+\s*;", re.DOTALL)
_BINARY = re.compile(rb"nonuniform\s+List<(scalar|vector|symmTensor|tensor)>\s*(\d{1,9})\s*\(")
COMPONENTS = {b"scalar": 1, b"vector": 3, b"symmTensor": 6, b"tensor": 9}
_MACRO = re.compile(r"\$\{?([:!.\w/]+)\}?")
_EVALUATED = ("#calc", "#eval", "#codeStream", "#neg", "#{")
_UNIT = re.compile(r"\[\s*(rpm|rad/s|deg/s)\s*\]")
_NUMERIC = re.compile(r"[\s0-9.+\-einfatyEINFATY]*")  # what foamlib's pattern of a list of numbers runs over
_MOST_TRIED = 12  # of these letters: two to this power is as often as foamlib may try
ROOTS = {"$FOAM_CASE": "", "<case>": "", "<system>": "system", "<constant>": "constant"}


@dataclass(frozen=True, slots=True)
class Entry:
    """One statement: its value as the file writes it, with file and line."""

    text: str
    file: Path
    line: int


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
        at: Entry | Foam | None = self
        for name in names:
            at = at.entries.get(name) if isinstance(at, Foam) else None
        return at if isinstance(at, Foam) else None

    def parts(self) -> Iterator[tuple[str, Foam]]:
        """The dictionaries directly below, by keyword."""
        return ((name, e) for name, e in self.entries.items() if isinstance(e, Foam))


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
    known : dict of str to Foam or None
        What was read, by name.
    """

    root: Path
    files: list[Path] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    known: dict[str, Foam | None] = field(default_factory=dict)

    def place(self, entry: Entry) -> str:
        """File, from the folder of the case, and line."""
        return f"{self.relative(entry.file)}:{entry.line}"

    def relative(self, file: Path) -> str:
        """A file's path from the folder of the case."""
        return file.relative_to(self.root).as_posix() if file.is_relative_to(self.root) else str(file)

    def note(self, text: str) -> None:
        """Keep a note, once."""
        if text not in self.notes:
            self.notes.append(text)

    def read(self, name: str) -> Foam | None:
        """A dictionary of the case, plain or compressed; None where there is none, or where it is no field that is read.

        Parameters
        ----------
        name : str
            From the folder of the case, such as ``system/controlDict``.

        Raises
        ------
        InputError
            Not to be read, too long, braces that do not match, includes without end.
        """
        if name not in self.known:
            self.known[name] = None
            for file in (self.root / name, self.root / f"{name}.gz"):
                content = self._content(file)
                if content is not None:
                    top = self.known[name] = Foam()
                    _Walk(self, file, content.decode("utf-8", "replace"), top, 0).whole()
                    break
        return self.known[name]

    def _content(self, file: Path) -> bytes | None:
        """The file without its long lists; None where it is no file."""
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
            self.note(f"{self.relative(file)} is longer than {FOAM_FIELD_BYTES >> 20} MiB and is not read")
            return None
        if re.search(rb"format\s+binary", content[:4096]):
            content = _without_binary(content)
        elif len(content) > FOAM_BYTES:
            # A list leaves its line ends, so that what follows keeps its place.
            content = _LISTS.sub(lambda m: b"nonuniform #list " + b"\n" * m[0].count(b"\n") + b";", content)
        if len(content) - content.count(b"\n") > FOAM_BYTES:
            found = f"more than {FOAM_BYTES >> 10} KiB besides lists of fields"
            raise InputError(found, "a dictionary of OpenFOAM", file=file)
        return content

    def value(self, within: Foam | None, *names: str) -> tuple[Any, str] | None:
        """A value and its place; None where it is not stated, or needs code to be run (with a note).

        Numbers are numbers, vectors lists, several words a tuple, as foamlib gives them; ``uniform`` and dimensions are
        taken off.

        Parameters
        ----------
        within : Foam or None
        names : str
            Keywords, outermost first.
        """
        part = within.part(*names[:-1]) if within is not None else None
        entry = part.entries.get(names[-1]) if part is not None else None
        if part is None or not isinstance(entry, Entry):
            return None
        text = self._expanded(entry.text, part, entry, 0)
        if text is None:
            return None
        value = _value(text)
        if value is None:
            self.note(f"{self.place(entry)}: {names[-1]} is not a value that is read: {shown(entry.text)}")
            return None
        return value, self.place(entry)

    def _expanded(self, text: str, part: Foam, entry: Entry, depth: int) -> str | None:
        """The text with its macros replaced by what they name."""
        if any(word in text for word in _EVALUATED):
            self.note(f"{self.place(entry)}: {shown(text)} is code, which is not run; its value is not taken")
            return None
        if "#list" in text or "#if" in text or len(text) > FOAM_VALUE:
            reason = "stands under #if" if "#if" in text else "is a list"
            self.note(f"{self.place(entry)}: what {reason} is not read")
            return None
        out, end = "", 0
        for macro in _MACRO.finditer(text):
            found = _named(part, macro[1])
            inner = (
                self._expanded(found[0].text, found[1], found[0], depth + 1)
                if found is not None and depth < FOAM_DEEPEST
                else None
            )
            if inner is None or len(out) + len(inner) > FOAM_VALUE:
                self.note(f"{self.place(entry)}: {macro[0]} is not known here; {shown(text)} is not read")
                return None
            out, end = out + text[end : macro.start()] + inner, macro.end()
        return out + text[end:]

    def include(self, file: Path, named: str, into: Foam, depth: int, *, needed: bool) -> None:
        """Read another file into a dictionary.

        Parameters
        ----------
        file : Path
            That includes it.
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
        if depth >= FOAM_DEEPEST or len(self.files) >= FOAM_FILES:
            raise InputError("includes without end", f"at most {FOAM_DEEPEST} deep, {FOAM_FILES} files", file=file)
        content = self._content(path)
        if content is None:
            if needed:
                self.note(f"{self.relative(file)}: {shown(named)} is included and not there")
            return
        _Walk(self, path, content.decode("utf-8", "replace"), into, depth + 1).whole()


def _without_binary(content: bytes) -> bytes:
    """A field without its binary lists."""
    width = 4 if b"scalar=32" in content[:4096] else 8
    out, end = [], 0
    while (match := _BINARY.search(content, end)) is not None:
        out += [content[end : match.start()], b"nonuniform #list "]
        end = match.end() + width * COMPONENTS[match[1]] * int(match[2])
        end += content[end : end + 1] == b")"
    return b"".join([*out, content[end:]])


def _named(part: Foam, name: str) -> tuple[Entry, Foam] | None:
    """The entry that a macro names, and where it stands: from here outwards, or from the top."""
    at: Foam | None = part
    if name[0] in ":!":
        while at is not None and at.parent is not None:
            at = at.parent
        name = name[1:]
    keys = [k for k in re.split(r"[./]", name) if k]
    while at is not None and keys:
        holder = at.part(*keys[:-1])
        entry = holder.entries.get(keys[-1]) if holder is not None else None
        if holder is not None and isinstance(entry, Entry):
            return entry, holder
        at = at.parent
    return None


@lru_cache(maxsize=1000)
def _value(text: str) -> Any:
    """A value through foamlib; None where it is none. Cases of one folder share most of theirs."""
    from foamlib import FoamFile

    depth = deepest = 0
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        deepest = max(depth, deepest)
    if deepest > FOAM_DEEPEST // 2 or depth or len(text) > FOAM_VALUE:
        return None
    if _backtracks(text):
        return _plain(_list_of_all_sorts(text))
    turns = _UNIT.search(text)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            value: Any = FoamFile.loads(f"x {_UNIT.sub('', text)};".encode())
            value = value.get("x") if hasattr(value, "get") else None
    except (ValueError, KeyError, TypeError, AssertionError, RecursionError, IndexError, OverflowError):
        return None
    value = _plain(value)
    if isinstance(value, tuple) and len(value) == 2 and value[0] in ("uniform", "constant"):
        value = value[1]
    if turns is not None:
        factors = {"rpm": math.pi / 30.0, "deg/s": math.pi / 180.0, "rad/s": 1.0}
        return value * factors[turns[1]] if isinstance(value, (int, float)) else None
    return value


def _backtracks(text: str) -> bool:
    """Whether a list begins with numbers and goes on otherwise: foamlib's pattern then cuts their letters in every way there is."""
    for group in re.finditer(r"\(", text):
        run = _NUMERIC.match(text, group.end())
        if run and not text.startswith(")", run.end()) and len("".join(run[0].split())) > _MOST_TRIED:
            return True
    return False


def _list_of_all_sorts(text: str) -> Any:
    """Lists in lists of numbers and words, as foamlib gives them; None where something else is in them."""
    stack: list[list[Any]] = [[]]
    for match in _TOKEN.finditer(text):
        kind, token = match.lastgroup, match[0]
        if token == "(":
            if stack[-1] and isinstance(stack[-1][-1], int) and text[match.start() - 1].isdigit():
                stack[-1].pop()  # the count of the list
            stack.append([])
        elif token == ")":
            done = stack.pop()
            stack[-1].append(done)
        elif kind in ("word", "text"):
            stack[-1].append(_number_or_word(token))
        elif kind != "skip":
            return None
    return stack[0][0] if len(stack[0]) == 1 else tuple(stack[0])


def _number_or_word(token: str) -> Any:
    for number in (int, float) if _NUMERIC.fullmatch(token) else ():
        try:
            return number(token)
        except ValueError:
            continue
    return token


def _plain(value: Any) -> Any:
    """Arrays as lists and dimensions taken off, all the way down."""
    import numpy as np
    from foamlib import Dimensioned

    if isinstance(value, Dimensioned):
        return _plain(value.value)
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, int) and abs(value) > LARGEST_NUMBER:
        return math.inf if value > 0 else -math.inf
    # A DimensionSet is a tuple too, of its own making.
    return type(value)(map(_plain, value)) if type(value) in (list, tuple) else value


class _Walk:
    """Walks the braces of one file into a dictionary."""

    def __init__(self, case: FoamCase, file: Path, text: str, into: Foam, depth: int) -> None:
        self.case, self.file, self.text, self.depth = case, file, text, depth
        self.stack = [into]
        self.closes = [""]
        self.words: list[str] = []
        self.line = self.first = 1
        self.nested: list[str] = []
        self.conditions = 0

    def whole(self) -> None:
        """Walk the whole text."""
        seen = position = 0
        while (match := _TOKEN.search(self.text, position)) is not None:
            self.line += self.text.count("\n", seen, match.start())
            seen, position = match.start(), match.end()
            kind, token = match.lastgroup, match[0]
            if kind == "skip":
                continue
            if not self.words and token[0] == "#" and kind == "word":
                end = self.text.find("\n", position)
                end = len(self.text) if end < 0 else end
                self._directive(token, self.text[position:end].strip())
                position = end
                continue
            if kind == "mark" and self._mark(token):
                continue
            if not self.words:
                self.first = self.line
            if len(self.words) <= FOAM_VALUE:
                self.words.append(token)
        if len(self.stack) > 1 or self.nested:
            expected = self.nested[-1] if self.nested else self.closes[-1]
            raise InputError(
                f"the end of the file without {expected}", "a whole dictionary", file=self.file, line=self.line
            )

    def _mark(self, mark: str) -> bool:
        """Whether a brace, bracket or semicolon is dealt with here; it is part of a value otherwise."""
        if self.nested:
            if mark == self.nested[-1]:
                self.nested.pop()
            elif mark in "([{":
                self._open({"(": ")", "[": "]", "{": "}"}[mark])
            elif mark != ";":
                raise self._wrong(mark, self.nested[-1])
            return False
        if mark == ";":
            self._end()
            return True
        is_list = mark == "(" and len(self.words) == 1 and (self.words[0] == "functions" or self.words[0].isdigit())
        if mark == "{" and self.words and self.words[-1] in _EVALUATED:
            self._open("}")
            return False
        if mark == "{" or is_list:
            if len(self.stack) > FOAM_DEEPEST:
                raise InputError("braces that nest too deep", f"at most {FOAM_DEEPEST}", file=self.file, line=self.line)
            self._down("}" if mark == "{" else ")")
            return True
        if mark == self.closes[-1]:
            self._end()
            self.stack.pop()
            self.closes.pop()
            return True
        if mark in "([":
            self._open({"(": ")", "[": "]"}[mark])
            return False
        raise self._wrong(mark, self.closes[-1] or "a keyword")

    def _open(self, close: str) -> None:
        if len(self.nested) > FOAM_DEEPEST:
            raise InputError("brackets that nest too deep", f"at most {FOAM_DEEPEST}", file=self.file, line=self.line)
        self.nested.append(close)

    def _wrong(self, mark: str, expected: str) -> InputError:
        return InputError(shown(mark), expected, file=self.file, line=self.line)

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
        self.words = []

    def _end(self) -> None:
        """Keep a statement."""
        if not self.words:
            return
        name, *words = self.words
        text = "#if" if self.conditions else " ".join(words)
        here = self.stack[-1]
        if name.startswith("$") and not words:
            self._merge(name)
        else:
            here.entries[name] = Entry(text, self.file, self.first)
        self.words = []

    def _merge(self, macro: str) -> None:
        """Take over the entries of the dictionary that a macro names."""
        name = macro.strip("${}").lstrip(":!.")
        at: Foam | None = self.stack[-1]
        while at is not None:
            found = at.entries.get(name)
            if isinstance(found, Foam):
                if found is not self.stack[-1]:
                    self.stack[-1].entries.update({k: e for k, e in found.entries.items() if isinstance(e, Entry)})
                return
            at = at.parent
        self.case.note(f"{self.case.relative(self.file)}:{self.first}: the dictionary {macro} is not known here")

    def _directive(self, name: str, rest: str) -> None:
        match = re.match(r'"([^"]*)"|([^\s;]+)', rest)
        named = (match[1] or match[2] or "") if match else ""
        if name in ("#include", "#includeIfPresent", "#sinclude") and named:
            self.case.include(self.file, named, self.stack[-1], self.depth, needed=name == "#include")
        elif name in ("#includeFunc", "#func") and re.fullmatch(r"[\w.-]+", named):
            # The case's own file of that name; what OpenFOAM itself ships is not there.
            below = Foam(parent=self.stack[-1])
            self.case.include(self.case.root / "system" / "x", named, below, self.depth, needed=False)
            if below.entries:
                self.stack[-1].entries[named] = below.part(named) or below
        elif name.startswith("#if"):
            self.conditions += 1
        elif name == "#endif":
            self.conditions = max(self.conditions - 1, 0)
