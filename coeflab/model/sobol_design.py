"""The rows that Sobol indices of a parameter file take, and which of them have to be run."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.sobol import design, exchanged
from coeflab.model.draws import CORRELATED, Uncertain

Array = NDArray[np.float64]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class SobolDesign:
    """Samples A and B, and A with each group of B.

    Attributes
    ----------
    groups : tuple of tuple of str
        Correlated among themselves, independent of each other.
    sources : tuple of str
        Campaigns or works behind each group.
    felt : tuple of int
        Groups that the motion feels; for the others A need not be run again.
    base : int
        Rows of a sample.
    samples : tuple of (base, k) array
        Deviations: A, B, and one for every group.
    left_out : float
        Largest correlation between groups.
    """

    groups: tuple[tuple[str, ...], ...]
    sources: tuple[str, ...]
    felt: tuple[int, ...]
    base: int
    samples: tuple[Array, ...]
    left_out: float

    @property
    def statement(self) -> str:
        """How it was made, in words."""
        return (
            f"Sobol indices: {self.base} rows of {len(self.felt) + 2} motions. Coefficients that are correlated by more than "
            f"{CORRELATED:g} are one group; the largest correlation between groups, {self.left_out:.2g}, is left out of the design. "
            "Shares of single coefficients keep every correlation"
        )

    @property
    def to_run(self) -> tuple[Array, ...]:
        """A, B and the exchanged samples of felt groups."""
        return (*self.samples[:2], *(self.samples[2 + k] for k in self.felt))

    def spread_out(self, results: Array) -> tuple[Array, ...]:
        """Results of `to_run`, (rows,) one after the other, as one array a sample; a group that is not felt has those of A."""
        a, b, *others = results.reshape(-1, self.base)
        known = dict(zip(self.felt, others, strict=True))
        return (a, b, *(known.get(k, a) for k in range(len(self.groups))))


def sobol_design(varied: Uncertain, members: int, seed: int, still: Collection[str]) -> SobolDesign:
    """As many rows as the largest power of two within ``members``; ``still`` are symbols that the motion does not feel."""
    places = varied.groups()
    groups = tuple(tuple(varied.symbols[i] for i in g) for g in places)
    base = 1 << (members.bit_length() - 1)
    a, b = design(base, len(varied.symbols), seed)
    return SobolDesign(
        groups, tuple(", ".join(dict.fromkeys(varied.sources[i] for i in g)) for g in places),
        tuple(k for k, g in enumerate(groups) if not set(g) <= set(still)), base,
        tuple(varied.designed(z) for z in (a, b, *exchanged(a, b, places))), varied.left_out(),
    )  # fmt: skip
