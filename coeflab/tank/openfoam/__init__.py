"""Cases of OpenFOAM for the tow tank: what meshes and runs share.

Templates stand in ``templates`` as the files that an OpenFOAM user knows, with values in ``{{ }}`` and lists in ``{% for %}``.
"""

from __future__ import annotations

import functools
import os
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from coeflab.core.text.bounded import own_text
from coeflab.tank.jobs import Step

if TYPE_CHECKING:
    from jinja2 import Environment

# Of the C library: fields stay with the process between iterations, on large pages. A serial run of 964,000 cells takes 2.7 s an
# iteration so, 3.9 s without.
KEEPS_MEMORY = (
    "GLIBC_TUNABLES=glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=2000000000:"
    "glibc.malloc.trim_threshold=4000000000:glibc.malloc.top_pad=268435456"
)
SHARE = "/usr/share/openfoam"  # where Debian's packages put what a sourced etc/bashrc points WM_PROJECT_DIR at


def rendered(template: str, **values: Any) -> bytes:
    """A file of a case, ending with a line feed.

    Parameters
    ----------
    template : str
        File in ``templates``.
    **values
        Numbers are written with all their digits by the filter ``n``: ``{{ size | n }}``; points by ``p``: ``{{ corner | p }}``.
    """
    return (_environment().get_template(template).render(values).rstrip("\n") + "\n").encode()


def step(name: str, *command: str, cores: int = 1, watched: bool = False) -> Step:
    """A command of OpenFOAM, in parallel with ``-parallel`` where it gets more than one core.

    Parameters
    ----------
    name : str
        Its log is ``log.NAME``.
    *command : str
        The tool and its arguments.
    cores : int
    watched : bool
    """
    environment = [] if os.environ.get("WM_PROJECT_DIR") else [f"WM_PROJECT_DIR={SHARE}"]
    environment += [] if os.environ.get("GLIBC_TUNABLES") else [KEEPS_MEMORY]
    launcher, parallel = [], []
    if cores > 1:
        environment += ["OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"]
        launcher = [
            "mpirun",
            "-np",
            str(cores),
            "--oversubscribe",
            "--bind-to",
            "none",
            "--mca",
            "mpi_yield_when_idle",
            "1",
        ]
        parallel = ["-parallel"]
    front = ["env", *environment] if environment else []
    return Step(name, (*front, *launcher, *command, *parallel), watched)


def number(value: float) -> str:
    """A number as dictionaries write it: twelve digits, no -0."""
    return f"{value + 0.0:.12g}"


@functools.cache
def _environment() -> Environment:
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    folder = files(__name__) / "templates"
    result = Environment(
        loader=FunctionLoader(lambda name: own_text(folder / name)),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=False,
    )
    result.filters["n"] = number
    result.filters["p"] = lambda point: f"({' '.join(number(float(x)) for x in point)})"
    return result
