"""coeflab: hydrodynamic coefficients of underwater vehicles, with an uncertainty, for simulators.

>>> import coeflab as cf
>>> result = cf.fit("suboff_roddy_2")              # a shipped campaign: Roddy's towing tests of SUBOFF, 1990
>>> round(result["Yv'"].value, 4), round(result["Yv'"].u95, 4)
(-0.0262, 0.0027)

Data in: `read_table`, `read_tables`, `read_body`, `read_vehicle`. Coefficients: `fit`, `estimate`, `next_tests`. Vehicles: `vehicle`, `compare`, `export`.
Motions: `simulate`, `trim`. Towing: `tow`. Studies: `run`. What these return has ``frame()`` for a DataFrame and ``plot(ax=...)`` for a picture.
SI and radians; a text such as ``"20 deg"`` has its unit. Wrong input is an `InputError`; nothing is written but by what says so.

Names are imported on first use, so that ``import coeflab`` costs nothing.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from importlib import import_module
from types import ModuleType
from typing import Any

from coeflab.core.cards import drawn_by
from coeflab.core.version import VERSION

__version__ = VERSION
_RENAMED = {
    "read_parameter_file": ("vehicle.parameter_file", "read_vehicle", "0.4")
}  # home, new name, release that lacks it


def __getattr__(name: str) -> Any:
    if name in _RENAMED:
        home, new, gone = _RENAMED[name]
        import warnings

        warnings.warn(f"coeflab.{name} is coeflab.{new}; {name} goes in {gone}", DeprecationWarning, stacklevel=2)
        return getattr(import_module(f"coeflab.{home}"), name)
    if name == "__all__":
        return __dir__()
    if name in _homes():
        return getattr(import_module(_homes()[name]), name)
    near = "" if name.startswith("_") else import_module("coeflab.core.missed").nearest(name, __dir__(), verbs=True)
    meant = f". Did you mean coeflab.{near}?" if near else ""
    raise AttributeError(f"module 'coeflab' has no attribute {name!r}{meant}")


def __dir__() -> list[str]:
    return [*sorted(_homes()), "__version__"]


@cache
def _homes() -> dict[str, str]:
    """The module of every public name, of which ``__init__.pyi`` is the only list."""
    import ast
    from importlib.resources import files

    from coeflab.core.text.bounded import own_text

    body = ast.parse(own_text(files("coeflab") / "__init__.pyi")).body
    return {n.name: str(f.module) for f in body if isinstance(f, ast.ImportFrom) for n in f.names}


def _card(renderer: str) -> Callable[[object], str]:
    found: Callable[[object], str] = getattr(import_module("coeflab.report.notebook"), f"{renderer}_card")
    return found


drawn_by(_card)


class _FrontDoor(ModuleType):
    """The package, of which ``vehicle`` is the verb, although a folder has that name too, whose import would set it."""

    @property
    def vehicle(self) -> Any:
        return import_module("coeflab.api.vehicle").vehicle

    @vehicle.setter
    def vehicle(self, folder: ModuleType) -> None:
        pass


sys.modules[__name__].__class__ = _FrontDoor
