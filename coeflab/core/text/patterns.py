"""Regular expressions that others wrote, matched in time that grows with text times pattern: all states at once, no backtracking.

Ken Thompson (1968): Regular expression search algorithm. Communications of the ACM 11(6), 419-422.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from coeflab.core.limits import PATTERN_DEEPEST, PATTERN_STATES

Letters = Callable[[str], bool]
# A state goes on by a letter, or for nothing to one or two others.
_CLASSES: dict[str, Letters] = {
    "d": lambda c: c in "0123456789", "w": lambda c: c.isalnum() or c == "_", "s": str.isspace,
}  # fmt: skip
_NAMED: dict[str, Letters] = {
    "alpha": str.isalpha, "digit": _CLASSES["d"], "alnum": str.isalnum, "space": str.isspace,
    "upper": str.isupper, "lower": str.islower,
}  # fmt: skip


class PatternProblem(ValueError):  # noqa: N818 - reported as an InputError by whoever knows the line
    """No pattern of the kind that is matched here."""


@dataclass(slots=True, eq=False)
class _State:
    takes: Letters | None = None
    to: list[_State] = field(default_factory=list)


@dataclass(frozen=True, slots=True, eq=False)
class Pattern:
    """A pattern that was read; `matches` tries it on a whole text."""

    text: str
    first: _State
    last: _State

    def matches(self, text: str) -> bool:
        """Whether the pattern takes the whole text.

        Parameters
        ----------
        text : str

        Examples
        --------
        >>> [pattern(p).matches("hull_port") for p in ("hull.*", "(hull|fin)", "(l|ll)+", "[a-z]+_(port|starboard)")]
        [True, False, False, True]
        """
        now = _reached([self.first])
        for letter in text:
            now = _reached(n for s in now if s.takes is not None and s.takes(letter) for n in s.to)
            if not now:
                return False
        return self.last in now


def _reached(states: Iterable[_State]) -> set[_State]:
    out: set[_State] = set()
    waiting = list(states)
    while waiting:
        state = waiting.pop()
        if state not in out:
            out.add(state)
            if state.takes is None:
                waiting += state.to
    return out


def pattern(text: str) -> Pattern:
    """Read a pattern: letters, ``.``, ``[a-z]``, ``( | )``, ``* + ? {2,3}``, ``^ $`` at the ends, and backslashes before them.

    Parameters
    ----------
    text : str

    Raises
    ------
    PatternProblem
        Anything else, such as references to groups and looks ahead; too deep or too long.
    """
    reading = _Reading(text.removeprefix("^"))
    first, last = reading.either(0)
    if reading.at < len(reading.text):
        raise PatternProblem(f"{reading.text[reading.at]} without its opening")
    return Pattern(text, first, last)


Piece = tuple[_State, _State]


class _Reading:
    def __init__(self, text: str) -> None:
        self.text, self.at, self.states = text, 0, 0

    def _state(self, takes: Letters | None = None, to: Iterable[_State] = ()) -> _State:
        self.states += 1
        if self.states > PATTERN_STATES:
            raise PatternProblem(f"a pattern of more than {PATTERN_STATES} steps")
        return _State(takes, list(to))

    def _next(self) -> str:
        if self.at >= len(self.text):
            raise PatternProblem("the end of the pattern")
        self.at += 1
        return self.text[self.at - 1]

    def either(self, depth: int) -> Piece:
        if depth > PATTERN_DEEPEST:
            raise PatternProblem("brackets that nest too deep")
        first, last = self._state(), self._state()
        while True:
            begin, end = self._sequence(depth)
            first.to.append(begin)
            end.to.append(last)
            if self.text[self.at : self.at + 1] != "|":
                return first, last
            self.at += 1

    def _sequence(self, depth: int) -> Piece:
        first = last = self._state()
        while self.at < len(self.text) and self.text[self.at] not in "|)":
            start = self.at
            begin, end = self._atom(depth)
            begin, end = self._repeated(start, (begin, end), depth)
            last.to.append(begin)
            last = end
        return first, last

    def _atom(self, depth: int) -> Piece:
        letter = self._next()
        if letter == "(":
            if self.text[self.at : self.at + 1] == "?":
                if self.text[self.at : self.at + 2] != "?:":
                    raise PatternProblem("(? is not matched here")
                self.at += 2
            piece = self.either(depth + 1)
            if self._next() != ")":
                raise PatternProblem("a bracket that is not closed")
            return piece
        if letter == "$" and self.at == len(self.text):
            state = self._state()
            return state, state
        if letter in "*+?{^$":
            raise PatternProblem(f"{letter} with nothing before it")
        if letter == ".":
            takes: Letters = lambda _: True  # noqa: E731
        elif letter == "[":
            takes = self._set()
        elif letter == "\\":
            takes = self._escaped()
        else:
            takes = letter.__eq__
        last = self._state()
        return self._state(takes, [last]), last

    def _escaped(self) -> Letters:
        letter = self._next()
        if letter.lower() in _CLASSES:
            inside = _CLASSES[letter.lower()]
            return inside if letter.islower() else lambda c: not inside(c)
        if letter.isalnum():
            raise PatternProblem(f"\\{letter} is not matched here")
        return letter.__eq__

    def _set(self) -> Letters:
        without = self.text[self.at : self.at + 1] == "^"
        self.at += without
        singles: set[str] = set()
        ranges: list[tuple[str, str]] = []
        classes: list[Letters] = []
        begin = self.at
        while (letter := self._next()) != "]" or self.at == begin + 1:
            if letter == "[" and self.text[self.at : self.at + 1] == ":":
                end = self.text.find(":]", self.at)
                known = _NAMED.get(self.text[self.at + 1 : end]) if end > 0 else None
                if known is None:
                    raise PatternProblem("a class of letters that is not known here")
                classes.append(known)
                self.at = end + 2
            elif letter == "\\":
                classes.append(self._escaped())
            elif self.text[self.at : self.at + 1] == "-" and self.text[self.at + 1 : self.at + 2] not in ("]", ""):
                self.at += 1
                ranges.append((letter, self._next()))
            else:
                singles.add(letter)

        def takes(c: str) -> bool:
            return (c in singles or any(a <= c <= b for a, b in ranges) or any(f(c) for f in classes)) != without

        return takes

    def _repeated(self, start: int, piece: Piece, depth: int) -> Piece:
        """The piece, as often as the marks behind it say."""
        stop = self.at
        while (mark := self.text[self.at : self.at + 1]) and mark in "*+?{":
            self.at += 1
            least, most = {"*": (0, -1), "+": (1, -1), "?": (0, 1)}.get(mark) or self._counts()
            behind = self.at
            pieces = [piece]
            for _ in range(max(least, most, 1) - 1):  # copies: the same letters read again
                self.at = start
                copy = self._atom(depth)
                if self.at != stop:
                    raise PatternProblem("counts of counts")
                pieces.append(copy)
            self.at = behind
            piece = self._chain(pieces, least, most)
            if self.text[self.at : self.at + 1] == "?":  # as few as possible: the same of a whole text
                self.at += 1
            stop = -1 if most not in (-1, 1) or least > 1 else stop
        return piece

    def _chain(self, pieces: list[Piece], least: int, most: int) -> Piece:
        first, last = self._state(), self._state()
        at = first
        for i, (begin, end) in enumerate(pieces):
            at.to.append(begin)
            if i >= least:
                at.to.append(last)
            at = end
        if most < 0:
            at.to.append(pieces[-1][0])
        at.to.append(last)
        return first, last

    def _counts(self) -> tuple[int, int]:
        end = self.text.find("}", self.at)
        low, comma, high = self.text[self.at : end].partition(",")
        if end < 0 or not low.isascii() or not low.isdigit() or (high and not high.isdigit()) or len(low + high) > 6:
            raise PatternProblem("{ without numbers")
        self.at = end + 1
        most = int(high) if high else (-1 if comma else int(low))
        if 0 <= most < int(low) or most == 0:
            raise PatternProblem("counts that are no range")
        if max(int(low), most) > PATTERN_STATES:
            raise PatternProblem(f"a pattern of more than {PATTERN_STATES} steps")
        return int(low), most


def one_of(escaped: Iterable[str]) -> re.Pattern[str]:
    """A search for any of several texts, each escaped by `re.escape`: no pattern of anybody's is among them."""
    return re.compile("|".join(escaped))


def atomic(body: str, name: str) -> str:
    """Any number of repeats that are not given back, as ``(?:body)*+``, which CPython 3.11.2 misreads where the last one ends in a lookahead.

    Parameters
    ----------
    body : str
        Of a pattern, without groups of its own.
    name : str
        Of a group that no other part of the pattern has.

    Examples
    --------
    >>> re.match(atomic("a(?!b)", "run"), "aab")[0]
    'a'
    """
    return f"(?=(?P<{name}>(?:{body})*))(?P={name})"
