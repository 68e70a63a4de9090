"""`uncertainty`: the intervals of a manoeuvre's quantities, from the covariance of a vehicle's coefficients.

>>> Question("zigzag", {"rudder": "20 deg"}, members=40).seed
1
"""

from __future__ import annotations

from coeflab.motion.uncertainty.uncertainty import Carried, Question, uncertainty

__all__ = ["Carried", "Question", "uncertainty"]
