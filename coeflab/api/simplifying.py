"""`simplify`: a mesh as simple forms, their added mass against the mesh's, and the files of both."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.bodies.added_masses import against_mesh
from coeflab.bodies.body import Body
from coeflab.bodies.simplify import simplify as parting
from coeflab.bodies.simplify.boxes import NamedBox, parse_box, read_boxes
from coeflab.bodies.simplify.simplification import MESH, Simplification
from coeflab.core.wording import Verbatim

__all__ = ["MESH", "NamedBox", "Simplification", "files", "parse_box", "read_boxes", "simplify"]


def simplify(
    body: Body, boxes: Sequence[NamedBox] = (), parts: int | None = None, *, convex: bool = False, panels: int = 6_000
) -> Simplification:
    """Parts of a mesh as cylinders, plates, ellipsoids, boxes; what is like none stays a mesh.

    Parameters
    ----------
    body : Body
        Whose shape is a mesh.
    boxes : sequence of NamedBox
        What is inside is that part.
    parts : int, optional
        How many there must be.
    convex : bool
        Cut what is like no form into nearly convex pieces.
    panels : int
        Of the panel method on the mesh; 0: added mass is not compared.

    Raises
    ------
    InputError
        No mesh, a box with nothing in it, another number of parts.

    Examples
    --------
    >>> import coeflab as cf
    >>> found = simplify(cf.read_body("huuv_mesh"), panels=0)
    >>> found.failures
    ()
    """
    return against_mesh(parting.simplify(body, tuple(boxes), parts, convex), panels=panels)


def files(found: Simplification) -> dict[str, bytes]:
    """A body.toml of the parts, the mesh, what stayed a mesh, and both drawn over each other, by name.

    Parameters
    ----------
    found : Simplification
    """
    from coeflab.report.figures.body import body_figure
    from coeflab.report.figures.body_scene import body_scene

    name = found.body.name
    return {
        "body.toml": found.part_file(),
        MESH: found.mesh_file(),
        **found.mesh_parts(),
        "overlay.svg": body_figure(Verbatim(name), found.shape, found.mesh, "overlay").svg.encode(),
        "overlay.glb": body_scene(name, found.shape, found.mesh),
    }
