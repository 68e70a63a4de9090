"""What a text looks like that is a simulator's model, for errors of readers of other files."""

from __future__ import annotations

import re
from pathlib import Path

from coeflab.core.text.bounded import stream_of

_KINDS = (
    ("an SDF", re.compile(r"\s*<(.*<)?sdf\b", re.DOTALL)),
    ("a Stonefish scenario", re.compile(r"\s*<(.*<)?scenario\b", re.DOTALL)),
    ("a URDF", re.compile(r"\s*<(.*<)?robot\b", re.DOTALL)),
    ("an xdyn YAML", re.compile(r"(?:.*\n)?rotations convention\s*:", re.DOTALL)),
    ("a MATLAB file", re.compile(r"(?:\s*%[^\n]*\n)*\s*function\b")),
)
_FIRST = 20_000  # letters that are looked at


def model_kind(text: str) -> str:
    """``an SDF`` and the like; empty where a text looks like none."""
    first = text[:_FIRST]
    return next((name for name, looks in _KINDS if looks.match(first)), "")


def model_kind_of(path: Path) -> str:
    """The same of a file; empty where it cannot be read."""
    try:
        with stream_of(path) as stream:
            return model_kind(stream.read(_FIRST).decode("utf-8", "ignore"))
    except OSError:
        return ""
