"""Forms of a force curve near the origin, and their design matrices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array

TERMS: dict[str, Callable[[Array], Array]] = {
    "1": np.ones_like,
    "x": lambda x: x,
    "x2": lambda x: x**2,
    "x3": lambda x: x**3,
    "x4": lambda x: x**4,
    "x5": lambda x: x**5,
    "x6": lambda x: x**6,
    "x7": lambda x: x**7,
    "x|x|": lambda x: x * np.abs(x),
    "|x|3": lambda x: np.abs(x) ** 3,
}


@brief
@dataclass(frozen=True, slots=True)
class Family:
    """One form of the curve.

    Attributes
    ----------
    name : str
        As printed; ``{x}`` stands for the motion variable.
    terms : tuple of str
        Keys of `TERMS`.
    nuisance : tuple of str
        Terms of the other parity, dropped where the sweep is one-sided and cannot tell them apart.
    next_term : str
        The term whose significance ends the growth of the window.
    must_beat : str
        Name of the family that this one must beat by 2 in AICc, or empty.
    """

    name: str
    terms: tuple[str, ...]
    nuisance: tuple[str, ...]
    next_term: str
    must_beat: str = ""


ODD = (
    Family("line", ("1", "x"), ("x2",), "x3"),
    Family("{x} + {x}^3", ("1", "x", "x3"), ("x2",), "x5"),
    Family("{x} + {x}^3 + {x}^5", ("1", "x", "x3", "x5"), ("x2",), "x7"),
    Family("{x} + {x}|{x}|", ("1", "x", "x|x|"), ("x2",), "x3", must_beat="{x} + {x}^3"),
)
EVEN = (
    Family("{x}^2", ("1", "x2"), ("x",), "x4"),
    Family("{x}^2 + {x}^4", ("1", "x2", "x4"), ("x", "x3"), "x6"),
    Family("{x}^2 + |{x}|^3", ("1", "x2", "|x|3"), ("x",), "x4", must_beat="{x}^2 + {x}^4"),
)


def design(terms: tuple[str, ...], x: Array) -> Array:
    """Design matrix (n, p) of the named terms."""
    return np.column_stack([TERMS[t](x) for t in terms])
