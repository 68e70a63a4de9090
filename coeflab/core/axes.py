"""Body axes in which tables come, and their rotation to FRD (x forward, y starboard, z down).

The point of a body that points are measured from: an id that is compared, and a note that never is.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.declarations import Declaration, Takes, Words, text_of
from coeflab.core.errors import AxesError, InputError, shown

DIRECTIONS = {
    "forward": (1.0, 0.0, 0.0),
    "aft": (-1.0, 0.0, 0.0),
    "starboard": (0.0, 1.0, 0.0),
    "port": (0.0, -1.0, 0.0),
    "down": (0.0, 0.0, 1.0),
    "up": (0.0, 0.0, -1.0),
}
FRAMES = {"FRD": ("forward", "starboard", "down"), "FLU": ("forward", "port", "up"), "CFD": ("aft", "starboard", "up")}
FLU = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])  # signs of X Y Z K M N, and of u v w p q r, from FRD to FLU and back
FRAME_WORDS = '"FRD", "FLU", "CFD" (x aft, y starboard, z up) or three directions like "forward, port, up"'
ANGLE_SIGNS = {
    "beta": {"v = +U sin(beta)": 1.0, "v = -U sin(beta)": -1.0},
    "alpha": {"w = +U sin(alpha)": 1.0, "w = -U sin(alpha)": -1.0},
}


@dataclass(frozen=True, slots=True)
class Axes:
    """Right-handed body axes.

    Attributes
    ----------
    directions : tuple of str
        Where x, y and z point.
    spelled : bool
        They were stated one by one; a frame by its name is a habit of its format and may be doubted.
    """

    directions: tuple[str, str, str]
    spelled: bool = field(default=False, compare=False)

    @property
    def rotation(self) -> NDArray[np.float64]:
        """(3, 3) matrix that turns components in these axes into FRD components."""
        return np.array([DIRECTIONS[d] for d in self.directions]).T

    @property
    def columns(self) -> dict[str, tuple[str, float]]:
        """For every FRD component the table's column and its sign; axes are at right angles, so each is one column."""
        at = np.argmax(np.abs(self.rotation), axis=1)
        return {g[i]: (g[j], float(self.rotation[i, j])) for g in ("XYZ", "KMN") for i, j in enumerate(at)}

    @property
    def name(self) -> str:
        """FRD, FLU or CFD, else the three directions."""
        named = {directions: name for name, directions in FRAMES.items()}
        return named.get(self.directions, ", ".join(f"{a} {d}" for a, d in zip("xyz", self.directions, strict=True)))

    @property
    def declared(self) -> str | list[str]:
        """What a file states: the name of a frame that was named, else the three directions."""
        named = {directions: name for name, directions in FRAMES.items()}
        return list(self.directions) if self.spelled or self.directions not in named else named[self.directions]

    @property
    def typed(self) -> str:
        """The three directions as an option takes them: ``forward,port,up``."""
        return ",".join(self.directions)


def axes_of(rotation: NDArray[np.float64]) -> Axes:
    """The axes whose rotation to FRD this is, one of the 24 right-handed ones.

    Examples
    --------
    >>> axes_of(parse_axes("port, up, forward").rotation).typed
    'port,up,forward'
    """
    names = {tuple(way): name for name, way in DIRECTIONS.items()}
    x, y, z = (names[tuple(float(v) for v in np.round(column) + 0.0)] for column in np.asarray(rotation).T)
    return Axes((x, y, z), spelled=True)


_WORDS = re.compile(r"[A-Za-z]+")


def _directions(declared: Any) -> tuple[str, ...]:
    """Directions in small letters of a list, or of a text: with commas, blanks, brackets, quotes, as ``x aft, y port, z down``."""
    if isinstance(declared, str):
        words = _WORDS.findall(declared.lower())
        if words[::2] == ["x", "y", "z"]:
            words = words[1::2]
    else:
        listed = isinstance(declared, (list, tuple)) and all(isinstance(d, str) for d in declared)
        words = [d.strip().lower() for d in declared] if listed else []
    return tuple(words) if len(words) == 3 and all(d in DIRECTIONS for d in words) else ()


def parse_axes(declared: Any, file: str | Path | None = None, key: str = "axes.frame") -> Axes:
    """Read an axes declaration: ``"FRD"``, ``"FLU"``, ``"CFD"`` or three directions, as a list or as a text.

    The one reader of axes, for options, TOML and imports.

    Parameters
    ----------
    declared : object
        As TOML gave it, or as it was typed.
    file : path, optional
    key : str
        Both for the error.

    Raises
    ------
    AxesError
        Unknown frame, directions that do not span space, or a left-handed triad.

    Examples
    --------
    >>> parse_axes("flu").directions
    ('forward', 'port', 'up')
    >>> parse_axes("port,up,forward") == parse_axes(["port", "up", "forward"])
    True
    """
    frame = FRAMES.get(declared.strip(" \"'").upper()) if isinstance(declared, str) else None
    directions = frame or _directions(declared)
    if not directions:
        found = "nothing" if declared is None or declared == "" else shown(declared)
        raise AxesError(found, FRAME_WORDS, file=file, column=key)
    axes = Axes((directions[0], directions[1], directions[2]), spelled=frame is None)
    determinant = round(float(np.linalg.det(axes.rotation)))
    if determinant == 0:
        raise AxesError(shown(declared), "three directions at right angles", file=file, column=key)
    if determinant < 0:
        likely = ", ".join(FRAMES["FLU"])
        raise AxesError(
            f"left-handed axes (x {directions[0]}, y {directions[1]}, z {directions[2]})",
            "a right-handed triad",
            file=file,
            column=key,
            advice=f"Papers that print this usually mean FLU ({likely}): check one force of known sign, then declare it.",
        )
    return axes


Frame = Annotated[
    Axes,
    Takes(
        FRAME_WORDS,
        lambda v, _: parse_axes(v),
        {"anyOf": [
            {"enum": list(FRAMES)},
            {"type": "string", "pattern": f"^({'|'.join(DIRECTIONS)})( *, *({'|'.join(DIRECTIONS)})){{2}}$"},
            {"type": "array", "items": {"enum": list(DIRECTIONS)}, "minItems": 3, "maxItems": 3},
        ]},
    ),
]  # fmt: skip


def angle_sign(name: str, declared: Any, file: str | Path | None = None) -> float:
    """Sign of v (starboard) for beta, of w (down) for alpha, from the declaration in words.

    Parameters
    ----------
    name : {"alpha", "beta"}
    declared : object
        As TOML gave it.
    file : path, optional
        For the error.

    Raises
    ------
    AxesError
        Nothing or something else than one of the two formulas was declared.
    """
    allowed = ANGLE_SIGNS[name]
    text = " ".join(str(declared).split()) if declared is not None else None
    if text not in allowed:
        raise AxesError(
            "no declared sign" if declared is None else shown(declared),
            " or ".join(f'"{formula}"' for formula in allowed),
            file=file,
            column=f"axes.{name}",
            advice=f"{name} has two signs in the literature; say which one this table uses "
            "(v to starboard, w down, whatever the table's own axes are).",
        )
    return allowed[text]


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
    "anywhere": ("anywhere", "forces alone, without rotation: the same about every point"),
}


_ORIGIN = "origin of "


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
        known, words = SHIPPED.get(text, (text.casefold() if _ID.fullmatch(text) else text, ""))
        return cls(known, note or words)

    @classmethod
    def of_file(cls, name: str) -> Datum:
        """The origin of the axes of a mesh file, of which no file says where on the body it is."""
        return cls(f"{_ORIGIN}{name}")

    @property
    def is_of_file(self) -> bool:
        """Whether it is the origin of a file's axes."""
        return self.id.startswith(_ORIGIN)

    def __str__(self) -> str:
        return f"{self.id}, {self.note}" if self.note else self.id


ANYWHERE = Datum.named("anywhere")


def point_in_words(point: Sequence[float] | NDArray[np.float64], datum: Datum) -> str:
    """A point as sentences name it: ``nose (0, 0, 0)``, ``x = -2.01 m from nose``.

    Parameters
    ----------
    point : (3,) array
        m, FRD, from the datum.
    datum : Datum
    """
    x, y, z = (float(f"{c:.5g}") + 0.0 for c in point)
    if y or z:
        return f"({x:g}, {y:g}, {z:g}) m from {datum.id}"
    return f"x = {x:g} m from {datum.id}" if x else f"{datum.id} (0, 0, 0)"


POINTS = (
    "nose", "bow", "stem", "stern", "tail", "fp", "ap", "cb", "cob", "cg", "cog", "midship", "midships", "amidships", "mid-length",
    "midlength", "centre", "center", "origin",
)  # fmt: skip


def datum_name(text: str) -> str:
    """The id of a datum as it was typed, refused where it is nearly that of a usual point.

    Raises
    ------
    InputError
        ``noze``, which is nearly nose, would be a point of its own, from which nothing else counts.

    Examples
    --------
    >>> datum_name("CB"), datum_name("tow_point")
    ('CB', 'tow_point')
    """
    word = text.strip().casefold()
    near = get_close_matches(word, POINTS, 1, 0.74) if re.fullmatch(r"[a-z-]{3,}", word) and word not in POINTS else []
    if near:
        raise InputError(
            shown(text),
            f"{near[0]}, or a name that is not nearly one of a usual point",
            advice=f"Did you mean {near[0]}?",
        )
    return text


DatumName = Annotated[
    str, Takes("a text", lambda v, file: datum_name(text_of(v, file)), {"type": "string", "pattern": r"\S"})
]


@dataclass(frozen=True, slots=True, kw_only=True)
class DatumKeys(Declaration):
    """Where points count from.

    Attributes
    ----------
    datum : str
        Id of the point of the body that points are measured from, such as nose, cg or midship.
    datum_note : str
        Where it is, in free words.
    """

    datum: DatumName
    datum_note: Words = ""

    @property
    def origin(self) -> Datum:
        """The datum."""
        return Datum.named(self.datum, self.datum_note)
