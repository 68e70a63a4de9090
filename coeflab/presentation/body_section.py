"""A body in a report: its outlines and itself in space, with the points that forces act at."""

from __future__ import annotations

from dataclasses import replace

from coeflab.model.body import Body
from coeflab.model.shape import Parts
from coeflab.model.study import Study
from coeflab.presentation.added_mass_tables import particulars
from coeflab.presentation.body_figure import body_figure
from coeflab.presentation.campaign_sections import filled
from coeflab.presentation.document import Figure, Section
from coeflab.presentation.hull_figure import hull_figure
from coeflab.presentation.hull_marks import hull_marks
from coeflab.presentation.hull_scene import hull_scene


def body_sections(study: Study) -> tuple[Section, ...]:
    """The body of the plan, unless the section on added mass shows it, or others that do have a shape."""
    body = study.body
    if body is None or body.name in {h.body.name for h in study.hulls.values()}:
        return ()
    if body.shape is None and study.hulls:
        return ()
    text = ["The body of the plan. No parameter file asks for its added mass, so none is computed."]
    if body.shape is None:
        text.append("It is known by particulars alone: without a shape it has neither outlines nor a view in space.")
    files = tuple(name for name in study.parameter_files if name not in study.hulls)
    figures = () if body.shape is None else (drawn_body(study, body, files, "body"),)
    return (Section("body", "Body", tuple(text), filled(particulars(body)), figures),)


def drawn_body(study: Study, body: Body, files: tuple[str, ...], anchor: str) -> Figure:
    """The drawing of a body, with the body in space.

    Parameters
    ----------
    study : Study
    body : Body
        With a shape.
    files : tuple of str
        Parameter files that are about it; their points are marked.
    anchor : str
        Unique in the document.
    """
    shape = body.require_shape()
    if isinstance(shape, Parts):
        drawn = body_figure(body.name, shape, None, f"{anchor}-parts")
    else:
        drawn = hull_figure(body, f"{anchor}-outline")
    return replace(drawn, scene=hull_scene(body.name, shape, *hull_marks(study, body, files)))
