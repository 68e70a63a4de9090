"""Names of the front door by what they are."""

from __future__ import annotations

from pathlib import Path

import coeflab as cf

VERBS = (
    "read_table",
    "read_body",
    "read_vehicle",
    "fit",
    "estimate",
    "vehicle",
    "simulate",
    "export",
    "trim",
    "compare",
    "tow",
    "run",
)
HELD = ("AddedMass", "Table", "Result", "Body", "Vehicle", "Motion", "Comparison", "Study", "Tow")


def homes() -> list[str]:
    """Modules that the front door is made of."""
    folder = Path(str(cf.__file__)).parent / "api"
    return [f"coeflab.api.{p.stem}" for p in sorted(folder.glob("*.py")) if p.stem != "__init__"]
