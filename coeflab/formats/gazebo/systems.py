"""Hydrodynamics systems of Gazebo that are known, told by file and class name, and how each reads its tags.

Sources, all in the link frame and applied as minus the sum of the terms: gz-sim's head of 2026 (commit 42d1720),
HydrodynamicsUtils.hh lines 43-70; ign-gazebo 6, src/systems/hydrodynamics/Hydrodynamics.cc, PreUpdate; github.com/osrf/lrauv,
lrauv_gazebo_plugins/src/HydrodynamicsPlugin.cc, commit 158e0d5, Configure and PreUpdate. The latter two write the entries of v r
in X and of w u in N otherwise than the first.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from coeflab.core.errors import shown
from coeflab.core.texts import input_error
from coeflab.core.types import brief

Entry = tuple[int, int, int, int]
# Row, column, sign, and index of diagonal entry and velocity, of every entry of a Coriolis matrix.
_COMMON: tuple[Entry, ...] = (
    (0, 4, -1, 2), (1, 3, 1, 2), (1, 5, -1, 0), (2, 3, -1, 1), (2, 4, 1, 0), (3, 1, -1, 2), (3, 2, 1, 1), (3, 4, -1, 5),
    (3, 5, 1, 4), (4, 0, 1, 2), (4, 2, -1, 0), (4, 3, 1, 5), (4, 5, -1, 3), (5, 1, 1, 0), (5, 3, -1, 4), (5, 4, 1, 3),
)  # fmt: skip
CORIOLIS = (*_COMMON, (0, 5, 1, 1), (5, 0, -1, 1))
EARLIER = (*_COMMON, (0, 5, -1, 1), (5, 0, 1, 2))


@brief
@dataclass(frozen=True, slots=True)
class System:
    """A plugin's law.

    Attributes
    ----------
    name, source : str
        In words.
    files, classes : re.Pattern
        What a plugin's ``filename``, without folder, and ``name`` must be; an empty name is that of the file's one class.
    coriolis : tuple of Entry
        Of the diagonal of <xDotU> ...
    switch : (str, bool)
        Tag of Coriolis, and whether true switches it on.
    defaults : mapping of tag to float, or None
        Diagonal tags that it reads and what it takes where one is missing; squares are |v| v. None: every tag, zero where missing.
    faces_aft : bool
        Whether the models that come with it face -x.
    """

    name: str
    source: str
    files: re.Pattern[str]
    classes: re.Pattern[str]
    coriolis: tuple[Entry, ...]
    switch: tuple[str, bool] = ("disable_coriolis", False)
    defaults: Mapping[str, float] | None = None
    faces_aft: bool = False


def _library(stem: str) -> re.Pattern[str]:
    return re.compile(rf"(lib)?({stem})(\.so|\.dylib|\.dll)?", re.IGNORECASE)


_OWN_FILES = _library(r"(gz-sim|ignition-gazebo)\d*-hydrodynamics-system")
_LRAUV = {"xDotU": 5.0, "yDotV": 5.0, "zDotW": 0.1, "kDotP": 0.1, "mDotQ": 0.1, "nDotR": 1.0,
          "xU": 20.0, "yV": 20.0, "zW": 20.0, "kP": 20.0, "mQ": 20.0, "nR": 20.0,
          "xUU": 0.0, "yVV": 0.0, "zWW": 0.0, "kPP": 0.0, "mQQ": 0.0, "nRR": 0.0}  # fmt: skip
GZ_SIM = System(
    "gz-sim",
    "src/systems/hydrodynamics, commit 42d1720",
    _OWN_FILES,
    re.compile(r"(gz::sim::systems::Hydrodynamics)?"),
    CORIOLIS,
)
IGNITION = System(
    "Ignition Gazebo 6", "src/systems/hydrodynamics of ign-gazebo6", _OWN_FILES,
    re.compile(r"ignition::gazebo::systems::Hydrodynamics"), EARLIER,
)  # fmt: skip
LRAUV = System(
    "lrauv", "lrauv_gazebo_plugins/src/HydrodynamicsPlugin.cc, commit 158e0d5", _library("HydrodynamicsPlugin"),
    re.compile(r"tethys::HydrodynamicsPlugin"), EARLIER, ("enable_coriolis", True), _LRAUV, True,
)  # fmt: skip
SYSTEMS = (GZ_SIM, IGNITION, LRAUV)


def system_of(filename: str, name: str, file: Any = None) -> System:
    """The law of a plugin by its file and class name.

    Raises
    ------
    InputError
        Neither of these: other plugins give other meanings to the same tags.
    """
    library = filename.strip().replace("\\", "/").rpartition("/")[2]
    found = [s for s in SYSTEMS if s.files.fullmatch(library) and s.classes.fullmatch(name.strip())]
    if found:
        return found[0]
    raise input_error(
        "formats.unknown_plugin", file, column="<plugin>", filename=shown(filename), name=shown(name),
        systems=", ".join(s.name for s in SYSTEMS[:-1]), other=SYSTEMS[-1].name,
    )  # fmt: skip
