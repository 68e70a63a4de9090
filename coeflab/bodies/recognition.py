"""The outline of any shape; of a mesh by its sections."""

from __future__ import annotations

from functools import lru_cache

from coeflab.bodies.outline import Outline
from coeflab.bodies.outlining import of_parts, of_revolution
from coeflab.bodies.pieces import Control
from coeflab.bodies.shape import Parts, Revolution, Shape

KEPT = 8


@lru_cache(KEPT)
def outline_of(shape: Shape, controls: tuple[Control, ...] = ()) -> Outline | None:
    """What semi-empirical methods see of a shape.

    Parameters
    ----------
    shape : Shape
    controls : tuple of Control
        What turns of it.
    """
    if isinstance(shape, Revolution):
        return of_revolution(shape)
    if isinstance(shape, Parts):
        return of_parts(shape, controls)
    return None
