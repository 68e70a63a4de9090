"""Friction of a smooth surface over the Reynolds number: the line of the ITTC, 1957."""

from __future__ import annotations

import numpy as np

LOWEST_REYNOLDS = 1e3  # the line is not defined at 100
FRICTION_APART = 0.05  # of the friction line between two Reynolds numbers: more than drag is compared to


def friction_line(reynolds: float) -> float:
    """C_F of a smooth surface, ITTC 1957: 0.075 / (log10 Re - 2)^2."""
    return float(0.075 / (np.log10(max(reynolds, LOWEST_REYNOLDS)) - 2.0) ** 2)
