"""The error tree.

::

    CoeflabError                 everything that coeflab raises on purpose
    ├── InputError               a file or value that a person wrote (file, line, column, found, expected)
    │   ├── UnitsError           a unit that is missing, unknown or of the wrong dimension
    │   └── AxesError            axes that are undeclared, unknown or left-handed
    ├── ScalingMismatchError     numbers made dimensionless in different ways were about to be mixed
    ├── PluginError              a plugin that is unknown or does not keep its contract
    └── OutputError              a place that cannot be written
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from coeflab.core.keywords import spoken

SHOWN, LONGEST, MOST_LISTED, MOST_LETTERS = 60, 400, 50, 1500


def shown(text: object, longest: int = SHOWN) -> str:
    """Quote a found value, on one line and cut to a readable length."""
    try:
        whole = str(text)
    except ValueError:  # Python writes no integer of more than 4,300 digits
        whole = "an integer of thousands of digits"
    flat = whole if whole.isprintable() else whole[: longest + 1].encode("unicode_escape").decode("ascii")
    return f'"{flat if len(flat) <= longest else flat[:longest] + "..."}"'


def clipped(text: object) -> str:
    """A path or the like as it stands, the middle of a very long one left out."""
    whole = str(text)
    return whole if len(whole) <= LONGEST else f"{whole[: LONGEST // 2]}...{whole[-LONGEST // 4 :]}"


def _bounded(text: str) -> str:
    """The text of a complaint, the middle of one left out that nobody reads to its end."""
    return text if len(text) <= MOST_LETTERS else f"{text[: MOST_LETTERS // 2]}...{text[-MOST_LETTERS // 4 :]}"


_LETTER = re.compile(r"character \d+")  # where on its line a text breaks


class CoeflabError(Exception):
    """Base of all errors raised on purpose; the command line turns it into exit code 2.

    Options of the shell that a message names are keywords unless a command runs (`coeflab.core.keywords`).
    """

    def __init__(self, *parts: str) -> None:
        super().__init__(*map(spoken, parts))

    @property
    def lines(self) -> tuple[str, ...]:
        """The text, a complaint a line."""
        return (str(self),)


class InputError(CoeflabError):
    """Input that cannot be used.

    Parameters
    ----------
    found, expected : str
        What stands there and what should; both are printed.
    file : path, optional
        The file at fault.
    line : int, optional
        Line number in that file, from 1.
    column : str, optional
        Column header, or TOML key without a line.
    key : str, optional
        TOML key, in place of the column.
    advice : str, optional
        What to do about it.

    Attributes
    ----------
    found, expected, file, line, column, advice
        As they were given; ``column`` has the key where there is one.
    others : tuple of InputError
        What else is wrong with the same file; the text lists all.
    example : str
        Lines to copy, printed as they are after the advice; empty for most errors.
    """

    def __init__(
        self,
        found: str,
        expected: str,
        *,
        file: str | Path | None = None,
        line: int | None = None,
        column: str | None = None,
        key: str | None = None,
        advice: str = "",
    ) -> None:
        self.found, self.expected = _bounded(spoken(found)), _bounded(spoken(expected))
        place = column if key is None else key
        self.file, self.line, self.column, self.advice = file, line, place and spoken(place), spoken(advice)
        self.keyed = key is not None
        self.others: tuple[InputError, ...] = ()
        self.example = ""
        super().__init__(str(self))

    def at(
        self,
        file: str | Path | None = None,
        line: int | None = None,
        column: str | None = None,
        *,
        key: str | None = None,
    ) -> InputError:
        """The same complaint with its place, to be raised by the caller.

        Parameters
        ----------
        file, line, column, key
            As of the class.
        """
        return type(self)(self.found, self.expected, file=file, line=line, column=column, key=key, advice=self.advice)

    @property
    def lines(self) -> tuple[str, ...]:
        """The complaints of a file, each with its place."""
        more = [f"{len(self.others) - MOST_LISTED} more"] if len(self.others) > MOST_LISTED else []
        copied = self.example.splitlines()
        return (self._alone(), *(other._alone() for other in self.others[:MOST_LISTED]), *more, *copied)

    def __str__(self) -> str:
        return "\n".join(self.lines)

    def _alone(self) -> str:
        place = [clipped(self.file)] if self.file is not None else []
        if self.line is not None:
            place.append(f"line {self.line}")
        if self.column is not None:
            if self.line and _LETTER.fullmatch(self.column):
                place.append(self.column)
            else:
                is_header = self.line and not self.keyed
                place.append(f"column {shown(self.column)}" if is_header else shown(self.column))
        head = ", ".join(place)
        text = f"found {self.found}; expected {self.expected}."
        return (f"{head}: " if head else "") + text + (f" {self.advice}" if self.advice else "")


def together(complaints: Sequence[InputError]) -> InputError:
    """Several complaints as one error: the first, which lists the others."""
    complaints[0].others = tuple(complaints[1:])
    return complaints[0]


class UnitsError(InputError):
    """A unit that is missing, unknown or of the wrong dimension."""


class AxesError(InputError):
    """Axes that are undeclared, unknown or left-handed, or an angle without a declared sign."""


class ScalingMismatchError(CoeflabError):
    """Coefficients of different lengths, reference points or bodies were about to be mixed."""


class PluginError(CoeflabError):
    """A plugin that is unknown or does not keep its contract."""


class OutputError(CoeflabError):
    """A place that cannot be written."""
