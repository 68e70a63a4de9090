"""The mesh that a person names: a body of reader mesh, or a mesh file with its unit and axes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.file import FORMATS, SELF_DESCRIBED, load
from coeflab.bodies.mesh.gates import sound
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.particulars import computed, require_plausible
from coeflab.bodies.readers import read_body
from coeflab.core.axes import FRAME_WORDS, Axes, Datum, parse_axes
from coeflab.core.errors import AxesError, InputError, UnitsError
from coeflab.core.files import located, shipped
from coeflab.core.provenance import InputFile, Source, sha256_of
from coeflab.core.texts import input_error
from coeflab.core.units import factor

BODY, CAMPAIGN = "body.toml", "campaign.toml"
ROUNDING = 1e-9  # of the length: what lies on an axis but for its last digits
AXES_TYPED = "FLU (x forward, y port, z up), FRD (x forward, y starboard, z down), CFD (x aft, y starboard, z up) or three directions like forward,port,up"


def mesh_body(
    name: str, unit: str = "", axes: str = "", repair: bool = False, fill: bool = False, sheets: bool = False
) -> Body:
    """A body whose shape is a mesh.

    Parameters
    ----------
    name : str
        A body.toml, its folder, a shipped body, or a mesh file.
    unit, axes : str
        Of a mesh file, which says neither; of nothing else. A URDF or SDF is in m and, unless said, FLU; a STEP is in m as
        it is read.
    repair, fill, sheets : bool
        Mend a mesh file that is not sound; close its small holes; take its open surfaces as sheets.

    Raises
    ------
    InputError
        Nothing there, not sound, of no vehicle's size, or without unit and axes; unit and axes of a body.toml, which declares its own.
    """
    path = located(name, "geometry")
    path = path / BODY if path.is_dir() else path
    if path.suffix.lower() == ".toml":
        if unit or axes or repair or fill or sheets:
            raise input_error("bodies.unit_axes_repair", path)
        return read_body(path)
    own_unit, own_axes = SELF_DESCRIBED.get(path.suffix.lower().lstrip("."), ("", ""))
    unit, axes = unit or own_unit, axes or own_axes
    _require_stated(unit, axes, path)
    return _bare(path, _factor(unit, path), _axes(axes, path), repair, fill, sheets)


def subject(
    name: str, unit: str = "", axes: str = "", repair: bool = False, fill: bool = False, sheets: bool = False
) -> Body:
    """The body that a person names; of a bare mesh the reference point is its centre of buoyancy.

    Parameters
    ----------
    name : str
        A mesh file, a body.toml, its folder or a shipped body.
    unit, axes : str
        Of a mesh file.
    repair, fill, sheets : bool
        Mend a mesh file that is not sound; close its small holes; take its open surfaces as sheets.

    Raises
    ------
    InputError
        As of `mesh_body`.
    """
    body = mesh_body(name, unit, axes, repair, fill, sheets)
    middle = body.configurations[0].centre_of_buoyancy
    bare = body.datum.is_of_file and not body.lengths
    if not bare or middle is None:
        return body
    size = body.require_shape().length
    return replace(body, reference_point=np.where(np.abs(middle) > ROUNDING * size, middle, 0.0))


def names_body(name: str) -> bool:
    """Whether a mesh file, a body.toml, a folder of one or a shipped body is meant, and no campaign.

    A name that both a shipped campaign and a shipped body bear is the campaign's.
    """
    bodies = {found.parent.name for found in shipped("geometry").glob(f"*/{BODY}")}
    try:
        path = located(name, "cfd_data")
    except InputError:
        return name in bodies
    if path == shipped("cfd_data") / name and name in bodies:  # a vehicle may have its files there, and no campaign
        return not (path / CAMPAIGN).exists()
    if path.is_dir():
        return (path / BODY).is_file() and not (path / CAMPAIGN).exists()
    return path.name == BODY or path.suffix.lower().lstrip(".") in FORMATS


def _require_stated(unit: str, axes: str, path: Path) -> None:
    """Everything that is not stated in one message, so that nobody mends one thing to meet the next."""
    lacking = [
        (what, option)
        for what, option, words in (
            ("unit", "--unit mm, m, in or another unit of length", unit),
            ("axes", f"--axes {AXES_TYPED}", axes),
        )
        if not words
    ]
    if lacking:
        raise InputError(
            f"no {' and no '.join(what for what, _ in lacking)}",
            "; and ".join(option for _, option in lacking),
            file=path,
            advice=f"A mesh file does not say its {' and '.join(what for what, _ in lacking)}: coeflab inspect {path.name} proposes.",
        )


def _axes(axes: str, path: Path) -> Axes:
    try:
        return parse_axes(axes, file=path, key="--axes")
    except AxesError as why:
        if why.expected == FRAME_WORDS:  # as TOML writes them
            raise AxesError(why.found, AXES_TYPED, file=path, column="--axes") from None
        raise


def _factor(unit: str, path: Path) -> float:
    try:
        return factor(unit, "length")
    except UnitsError as why:
        raise why.at(path, column="--unit") from None


def _bare(path: Path, unit: float, axes: Axes, repair: bool, fill: bool, sheets: bool) -> Body:
    found = sound(*load(path), path, repair=repair, fill=fill, open_sheets=sheets)
    shape = TriangleMesh(unit * found.vertices @ axes.rotation.T, found.faces, sheets=found.sheets)

    def fail(found: str, expected: str, advice: str) -> InputError:
        return InputError(found, expected, file=path, column="--unit", advice=advice)

    require_plausible(shape, unit, fail)
    return Body(
        name=path.stem,
        title=path.name,
        datum=Datum.of_file(path.name),
        reference_point=np.zeros(3),
        lengths={},
        configurations=(computed(shape, found.statements),),
        source=Source(path.name),
        files=(InputFile(path.name, sha256_of(path)),),
        shape=shape,
        axes=axes,
    )
