"""Named arrays and names as .npz and .mat files, always the same bytes."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence

import numpy as np

from coeflab.core.types import Array

HEADER = 116  # bytes of text at the head of a MAT-file of version 5; scipy writes the time of day there
TEXT = b"MATLAB 5.0 MAT-file, coeflab"
ENDINGS = (".mat", ".npz", ".json", ".csv")


def npz(arrays: Mapping[str, Array], names: Mapping[str, Sequence[str]]) -> bytes:
    """For `numpy.load`; names as arrays of texts."""
    out = io.BytesIO()
    np.savez(out, **arrays, **{k: np.array(v, dtype=str) for k, v in names.items()})  # type: ignore[arg-type]
    return out.getvalue()


def mat(arrays: Mapping[str, Array], names: Mapping[str, Sequence[str]]) -> bytes:
    """For `load` of MATLAB and Octave; names as cells."""
    import scipy.io

    out = io.BytesIO()
    cells = {k: np.array(v, dtype=object) for k, v in names.items()}
    scipy.io.savemat(out, {**arrays, **cells}, oned_as="column")
    return TEXT.ljust(HEADER) + out.getvalue()[HEADER:]
