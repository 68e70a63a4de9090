"""Arrays that stay as they are: copied, read-only."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def locked(values: ArrayLike, dtype: type = float) -> NDArray[Any]:
    """A read-only copy."""
    array: NDArray[Any] = np.array(values, dtype=dtype)
    array.flags.writeable = False
    return array


def locked_columns(columns: Mapping[str, ArrayLike], dtype: type = float) -> Mapping[str, NDArray[Any]]:
    """A read-only mapping of read-only copies."""
    return MappingProxyType({name: locked(values, dtype) for name, values in columns.items()})
