"""Plain assignments of a MATLAB or Octave file: read as text, never run."""

from __future__ import annotations

import re
from dataclasses import dataclass

_ASSIGNMENT = re.compile(r"([A-Za-z]\w*(?:\.[A-Za-z]\w*)*)\s*=(?!=)\s*(.*\S)", re.ASCII | re.DOTALL)
_QUOTED = re.compile(r"'((?:[^']|'')*)'")
_DOUBLE_QUOTED = re.compile(r'"(?:[^"\\]|\\.|"")*"')
NAMED = re.compile(r"[A-Za-z]\w*(?:\.[A-Za-z]\w*)*", re.ASCII)
OPENING, CLOSING = "([{", ")]}"
TABLED, DRIVEN = (
    "\nfunction F = tabled(",
    "\nfunction F = driven(",
)  # where an export writes tables and thrusters as code


def own_part(text: str) -> str:
    """A function file without the functions of tables and thrusters that an export writes behind it."""
    return text.partition(TABLED)[0].partition(DRIVEN)[0]


@dataclass(frozen=True, slots=True)
class Assignment:
    """``target = expression``, with the line that it begins on; ``target`` may have dots."""

    line: int
    target: str
    expression: str

    @property
    def quoted(self) -> str | None:
        """The text of a quoted right-hand side; None for anything else."""
        match = _QUOTED.fullmatch(self.expression)
        return match[1].replace("''", "'") if match else None


def assignments(text: str) -> tuple[Assignment, ...]:
    """The plain assignments of a file, in order; whatever else it does is passed over.

    Comments (``%``, ``#``, blocks of ``%{``) are dropped and lines that end in ``...`` joined.
    """
    out = []
    for line, statement in statements(text):
        match = _ASSIGNMENT.fullmatch(statement)
        if match:
            out.append(Assignment(line, match[1], match[2]))
    return tuple(out)


def statements(text: str) -> list[tuple[int, str]]:
    """Statements with their lines, comments and continuations taken out."""
    out: list[tuple[int, str]] = []
    held, begun, depth, block = "", 0, 0, 0
    for number, raw in enumerate(text.splitlines(), 1):
        if raw.strip() in ("%{", "#{"):
            block += 1
        elif block:
            block -= raw.strip() in ("%}", "#}")
        else:
            pieces, depth, more = _pieces(raw, depth)
            for i, piece in enumerate(pieces):
                if i:
                    out.append((begun, held.strip()))
                    held = ""
                begun = begun if held.strip() else number
                held += piece
            if more or depth:
                held += " "
            else:
                out.append((begun, held.strip()))
                held = ""
    out.append((begun, held.strip()))
    return [(line, s) for line, s in out if s]


def _pieces(line: str, depth: int) -> tuple[list[str], int, bool]:
    """A line cut at ``;`` and ``,`` outside brackets and quotes; the depth of brackets; whether it goes on."""
    pieces: list[str] = []
    begun, at = 0, 0
    while at < len(line):
        c = line[at]
        if c in "%#":
            return [*pieces, line[begun:at]], depth, False
        if line.startswith("...", at):
            return [*pieces, line[begun:at]], depth, True
        opens = c == '"' or (c == "'" and (at == 0 or not (line[at - 1].isalnum() or line[at - 1] in "_)]}'.")))
        if opens:
            match = (_QUOTED if c == "'" else _DOUBLE_QUOTED).match(line, at)
            at = match.end() if match else len(line)
            continue
        depth = max(0, depth + (c in OPENING) - (c in CLOSING))
        if c in ";," and not depth:
            pieces.append(line[begun:at])
            begun = at + 1
        at += 1
    return [*pieces, line[begun:]], depth, False
