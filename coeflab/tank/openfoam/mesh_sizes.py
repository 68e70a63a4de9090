"""How fine a mesh is where: domain, cells, boxes and layers, from the body and a few numbers of the user."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Annotated, Any

from coeflab.core.declarations import ABOVE_ZERO, TABLE, Declaration, Pure, one_of

Wall = Annotated[str, one_of("functions", "resolved", "none")]
Positive = Annotated[Pure, ABOVE_ZERO]


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshKeys(Declaration):
    """How the meshes of a tow are made; sizes are those of the grid ``medium``.

    Attributes
    ----------
    wall : {"functions", "resolved", "none"}
        Layers for wall functions, down to the wall, or no layers.
    y_plus : float
        Of the middle of the first cell; 50 for wall functions and 0.8 for a resolved wall, unless given.
    cells_per_length : float
        Along the hull.
    cells_per_chord : float
        Along the mean chord of an appendage.
    cells : table
        Along the chord of a patch, by its name, where it is not ``cells_per_chord``.
    ahead, behind, beside : float
        Distance from the body to the end of the domain, over the length of the body.
    coverage : float
        Share of each patch that layers have to cover; below it the mesh gets a remark.
    most_cells : float
        A mesh that is expected to have more is not begun.
    """

    wall: Wall = "functions"
    y_plus: Positive | None = None
    cells_per_length: Positive = 280.0
    cells_per_chord: Positive = 90.0
    cells: Annotated[Mapping[str, Any], TABLE] = field(default_factory=lambda: MappingProxyType({}))
    ahead: Positive = 1.4
    behind: Positive = 2.0
    beside: Positive = 1.4
    coverage: Positive = 0.9
    most_cells: Positive = 6e6
