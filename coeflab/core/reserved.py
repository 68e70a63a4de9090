"""Names that a file, a function or a class must not bear, because it would hide what bears them already."""

from __future__ import annotations

import builtins
import keyword
import sys
from functools import cache
from pathlib import Path

DEVICES = frozenset({"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))})


@cache
def matlab() -> frozenset[str]:
    """Keywords and functions of GNU Octave 7.3, some of MATLAB's and of MSS: ``matlab_names.txt``."""
    return frozenset(Path(__file__).with_name("matlab_names.txt").read_text(encoding="ascii").split())


def python() -> frozenset[str]:
    """Keywords, builtins, modules of the standard library, and numpy."""
    words = {*keyword.kwlist, *keyword.softkwlist, *dir(builtins), "np", "numpy", "self"}
    return frozenset(words | sys.stdlib_module_names)
