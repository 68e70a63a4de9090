"""The point of a body that points are measured from: an id that is compared, and a note that never is."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from coeflab.core.toml import Section

_ID = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,39}")
# What coeflab's own files said up to schema 1.3, when a datum was a phrase.
SHIPPED = {
    "nose, on the hull's axis": ("nose", "on the hull's axis"),
    "centre of buoyancy": ("cb", "centre of buoyancy"),
    "centre of gravity": ("cg", "centre of gravity"),
    "middle of the hull's axis": ("midship", "middle of the hull's axis"),
    "centre of the spheroid": ("centre", "of the spheroid"),
    "origin of the paper's body axes": ("paper_axes", "origin of the paper's body axes"),
    "the elevator's axis of rotation": ("elevator_axis", "the elevator's axis of rotation"),
}


@dataclass(frozen=True, slots=True)
class Datum:
    """A point of the body by its id; two are equal where their ids are, whatever their notes say.

    Attributes
    ----------
    id : str
        Short, such as ``nose``, ``cg`` or ``midship``.
    note : str
        Where it is, in free words.
    """

    id: str
    note: str = field(default="", compare=False)

    @classmethod
    def named(cls, text: str, note: str = "") -> Datum:
        """The datum that a file names.

        A short word is an id, in small letters. The phrases of `SHIPPED` stand for their ids. Any other phrase is an id of
        its own, letter by letter: "nose, 2 m aft" is neither "nose" nor "nose 2 m aft".

        Parameters
        ----------
        text : str
        note : str, optional
            Free words; those of `SHIPPED` unless given.
        """
        text = text.strip()
        known, said = SHIPPED.get(text, (text.casefold() if _ID.fullmatch(text) else text, ""))
        return cls(known, note or said)

    def __str__(self) -> str:
        return f"{self.id}, {self.note}" if self.note else self.id


def read_datum(section: Section) -> Datum:
    """``datum`` and ``datum_note`` of a section.

    Raises
    ------
    InputError
        No datum, or one that is not a text.
    """
    return Datum.named(section.text("datum"), section.text("datum_note", ""))
