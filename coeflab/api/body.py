"""`read_body` and `Body`: a shape, its added mass and its outline."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.api.questions import above_zero, si
from coeflab.bodies import body as plain
from coeflab.bodies.added_masses import added_masses, finer, methods, near_walls
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.particulars import computed
from coeflab.bodies.simplify.source import mesh_body, subject
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, shown
from coeflab.core.files import located
from coeflab.core.keywords import all_spoken
from coeflab.core.missed import suggesting
from coeflab.core.texts import input_error
from coeflab.law import added_mass as law
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.law.water import FRESH_DENSITY
from coeflab.vehicle.from_shape import displaced_mass

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from coeflab.bodies.simplify.simplification import Simplification

__all__ = ["AddedMass", "Body", "added_masses", "body_of", "finer", "near_walls", "read_body", "typed_body"]
NOSE = "nose"
MIDDLE = ("midship", "midships", "amidships", "mid-length", "midlength")


@suggesting
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AddedMass(law.AddedMass):
    """The added-mass matrix of a body; see `Body.added_mass`.

    Attributes
    ----------
    matrix : (6, 6) array
        Symmetric, kg, kg m, kg m^2: what the water adds in surge, sway, heave, roll, pitch, yaw; Xudot = -matrix[0, 0].
    reference_point : (3,) array
        That it is about, m, FRD, from the body's datum.
    method, body : str
    density : float
        kg/m^3.
    error : (6, 6) array or None
        What the method says of itself.

    Examples
    --------
    >>> import coeflab as cf
    >>> added = cf.read_body("remus100").added_mass("ellipsoid")
    >>> bool(added.matrix[1, 1] > 10 * added.matrix[0, 0])
    True
    """

    def frame(self) -> pd.DataFrame:
        """The matrix, a row a force, a column an acceleration; kg, kg m, kg m^2.

        Examples
        --------
        >>> import coeflab as cf
        >>> bool(cf.read_body("remus100").added_mass("ellipsoid").frame().loc["Y", "v_dot"] > 0)
        True
        """
        import pandas as pd

        return pd.DataFrame(np.array(self.matrix), list(COMPONENTS), [f"{m}_dot" for m in MOTIONS])

    def plot(self, ax: Axes | None = None) -> Axes:
        """The matrix, each entry the darker the larger it is beside its two diagonal ones.

        Parameters
        ----------
        ax : Axes, optional
            To draw into; by default that of a new figure.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.read_body("remus100").added_mass("ellipsoid").plot().get_title()
        'remus100 by ellipsoid'
        """
        from coeflab.report.plots import plot_added_mass

        return plot_added_mass(self, ax)


@suggesting
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Body(plain.Body):
    """A body: shape, particulars, configurations; see `coeflab.read_body`.

    Attributes
    ----------
    name, title : str
    reference_point : (3,) array
        m, FRD, from `datum`.
    shape : Shape or None
        What it looks like; ``shape.length``, ``shape.volume`` in m and m^3.
    configurations : tuple
        Volume, wetted surface, centres and mass with each state of appendages.
    pieces : tuple
        Hull, sail and fins as closed pieces where the reader knows them: of shapes that a body.toml states; none of a bare mesh,
        whose pieces `simplify` finds.
    outline : Outline or None
        Hulls, foils and rings that estimates see, of a mesh by recognition.
    place : Path or None
        File that it was read from.

    Examples
    --------
    >>> import coeflab as cf
    >>> body = cf.read_body("remus100")
    >>> body.name, round(body.scaling.length, 3)
    ('remus100', 1.33)
    """

    place: Path | None = None

    @property
    def volume(self) -> float:
        """Of the water that it displaces, m^3; that of the state that has the mass, where its file states several.

        Examples
        --------
        >>> import coeflab as cf
        >>> round(cf.read_body("remus100").volume, 4)
        0.0317
        """
        return displaced_mass(self, 1.0)

    def displaced_mass(self, density: float | str = FRESH_DENSITY) -> float:
        """Of the water that it displaces, kg: what weighs as much floats without effort.

        Parameters
        ----------
        density : float or str
            kg/m^3; fresh water.

        Examples
        --------
        >>> import coeflab as cf
        >>> round(cf.read_body("remus100").displaced_mass("1.025 g/cm^3"), 1)
        32.4
        """
        return displaced_mass(self, above_zero(density, "density", "density"))

    def added_mass(self, method: str = "all", density: float | str = FRESH_DENSITY, **options: Any) -> AddedMass:
        """The 6 x 6 added-mass matrix about the reference point, FRD, SI.

        Parameters
        ----------
        method : str
            ``all`` takes the recommended one of those that apply; else ellipsoid, primitives, strip, panel ...
        density : float or str
            Of the water, kg/m^3.
        **options
            Of the method.

        Returns
        -------
        AddedMass
            ``matrix``: (6, 6), kg, kg m, kg m^2.

        Raises
        ------
        InputError
            No shape, no such method, a shape that it does not take.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.read_body("remus100").added_mass("ellipsoid").matrix.shape
        (6, 6)
        """
        if method != "all" and method not in methods():
            raise InputError(f"the method {shown(method)}", f"all, or one of {', '.join(methods())}", column="method")
        rho = si(density, "density", "density")
        found = added_masses(self, rho, method, options or None).recommended
        found = replace(found, density=rho, statements=all_spoken(found.statements))
        return AddedMass(**{f.name: getattr(found, f.name) for f in fields(law.AddedMass)})

    def simplify(self, parts: int | None = None, *, panels: int = 6_000) -> Simplification:
        """The mesh as cylinders, plates, ellipsoids and boxes, held against it.

        Parameters
        ----------
        parts : int, optional
            How many there must be.
        panels : int
            Of the panel method on the mesh; 0: added mass is not compared.

        Returns
        -------
        Simplification
            ``body`` of the parts, ``shape.parts``, ``statements``.

        Raises
        ------
        InputError
            No mesh, another number of parts.

        Examples
        --------
        >>> import coeflab as cf
        >>> len(cf.read_body("huuv_mesh").simplify(panels=0).shape.parts) > 1
        True
        """
        from coeflab.api.simplifying import simplify

        return simplify(self, parts=parts, panels=panels)

    def plot(self, view: str = "side", ax: Axes | None = None) -> Axes:
        """The outline, m, FRD, from the datum.

        Parameters
        ----------
        view : {"side", "top", "front"}
        ax : Axes, optional
            To draw into; by default that of a new figure.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.read_body("remus100").plot().get_xlabel()
        'x [m]'
        """
        from coeflab.report.plots import plot_body

        return plot_body(self, view, ax)

    def counted_from(self, datum: str) -> Body:
        """The body of a bare mesh with its places from its nose: the foremost point of the mesh, on the x axis of its file.

        Parameters
        ----------
        datum : {"nose"}

        Raises
        ------
        InputError
            Another point, or a body whose file names its own.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.read_body("remus100").counted_from("nose").datum.id
        'nose'
        """
        if self.datum.id == datum:
            return self
        if not isinstance(self.shape, TriangleMesh) or not self.datum.is_of_file or datum != NOSE:
            bare = isinstance(self.shape, TriangleMesh) and self.datum.is_of_file
            aft = f"{self.shape.length / 2.0:.4g} m" if bare and self.shape and datum in MIDDLE else "X m"
            raise input_error(
                "front_door.whose_places_count", column="datum", name=self.name, id=shown(self.datum.id),
                expected=f"places from the nose: a mesh names no {datum}" if bare else f"{datum} as datum under [body] of its body.toml",
                advice=f'about="nose, {aft} aft" of the tables; read_body(...).counted_from("nose") of the body.' if bare else '',
            )  # fmt: skip
        fore = np.array([float(self.shape.vertices[:, 0].max()), 0.0, 0.0])
        shape = replace(self.shape, vertices=self.shape.vertices - fore)
        return replace(
            self, datum=Datum(NOSE, f"foremost point of {self.title}, at x = {fore[0]:.6g} m of its axes"), shape=shape,
            reference_point=self.reference_point - fore, configurations=(computed(shape, ()),),
        )  # fmt: skip


def read_body(
    source: str | Path | plain.Body,
    *,
    unit: str = "",
    axes: str = "",
    repair: bool = False,
    fill: bool = False,
    sheets: bool = False,
    units: str = "",
    frame: str = "",
) -> Body:
    """A body from its body.toml, its folder, a shipped name or a mesh file.

    Parameters
    ----------
    source : str, Path or Body
        ``remus100``, ``hull/body.toml``, ``hull.stl``.
    unit : str
        Of a mesh file's numbers: mm, m, in ...
    axes : str
        Of a mesh file: FLU, FRD, CFD or three directions with commas.
    repair, fill, sheets : bool
        Mend a mesh that is not sound; close its small holes; take its open surfaces as walls.
    units, frame : str
        The same as `unit` and `axes`, as `coeflab.read_table` calls them.

    Returns
    -------
    Body
        Of a mesh about its centre of buoyancy.

    Raises
    ------
    InputError
        Nothing there; a mesh without unit or axes, or not sound; what its body.toml says wrong, by line.

    Examples
    --------
    >>> import coeflab as cf
    >>> cf.read_body("suboff_bare_hull").name
    'suboff_bare_hull'
    """
    if isinstance(source, plain.Body):
        return source if isinstance(source, Body) else body_of(source)
    if not isinstance(source, str | Path):
        raise InputError(f"a {type(source).__name__}", "a path, or the name of a shipped body", column="source")
    return typed_body(str(source), unit or units, axes or frame, repair, fill, sheets, centred=True)


def typed_body(
    name: str, unit: str = "", axes: str = "", repair: bool = False, fill: bool = False, sheets: bool = False, *, centred: bool = False,
) -> Body:  # fmt: skip
    """A body as a shell names it: complaints are about its options, such as ``--unit``.

    Parameters
    ----------
    name, unit, axes, repair, fill, sheets
        As of `read_body`.
    centred : bool
        Of a bare mesh about its centre of buoyancy, else about the origin of its file.
    """
    found = (subject if centred else mesh_body)(name, unit, axes, repair, fill, sheets)
    return body_of(found, located(name, "geometry"))


def body_of(found: plain.Body, place: Path | None = None) -> Body:
    """A body with the front door's methods."""
    return Body(**{f.name: getattr(found, f.name) for f in fields(plain.Body)}, place=place)
