"""A body in a report: its drawing, and where buoyancy, weight and the force of a drift act, or why such a point is not known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.shape import Parts
from coeflab.core.table import plus_minus
from coeflab.law.coefficient import CoefficientSet
from coeflab.report.document import Figure, Section
from coeflab.report.figures.body import body_figure
from coeflab.report.figures.hull_outline import hull_figure
from coeflab.report.figures.hull_scene import Mark, hull_scene
from coeflab.report.sections.campaign import filled
from coeflab.report.tables.added_mass import particulars
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import CENTRES, Derived, centre_of_pressure

PLANES = {"Nv'/Yv'": "sideslip", "-Mw'/Zw'": "angle of attack"}
SHORT = {"Nv'/Yv'": "CP sway", "-Mw'/Zw'": "CP heave"}


def hull_marks(study: Study, body: Body, files: tuple[str, ...]) -> tuple[tuple[Mark, ...], tuple[str, ...]]:
    """Marks of a body, and in words what has none.

    Parameters
    ----------
    study : Study
    body : Body
        With a shape.
    files : tuple of str
        Parameter files whose added mass is that of the body.
    """
    centre = np.asarray(body.require_shape().centre_of_volume)
    marks = [Mark("centre of buoyancy", "CB", centre, "a")]
    unknown: list[str] = []
    for name in files:
        parameters = study.parameter_files[name]
        point = parameters.reference_point
        if point.origin != body.datum:
            unknown.append(f"{name} counts from another datum ({point.datum}), so its points are not drawn.")
            continue
        of_file = f" of {name}" if len(files) > 1 else ""
        weight = _gravity(parameters, of_file)
        if weight is None:
            unknown.append(f"The centre of gravity{of_file} is not known.")
        else:
            marks.append(weight)
        found, missing = _pressures(study, parameters, of_file)
        several = f" {files.index(name) + 1}" if len(files) > 1 else ""
        marks += [replace(m, label=f"{m.label}{several}") for m in found]
        unknown += missing
    return _once(marks), tuple(dict.fromkeys(unknown))


def _once(marks: list[Mark]) -> tuple[Mark, ...]:
    """Marks without those that repeat another of the same kind at the same place."""
    out: list[Mark] = []
    for mark in marks:
        if not any(m.label == mark.label and np.allclose(m.place, mark.place, atol=1e-6) for m in out):
            out.append(mark)
    return tuple(out)


def _gravity(parameters: ParameterFile, of_file: str) -> Mark | None:
    mass, point = parameters.mass, np.array(parameters.reference_point.point)
    if mass is None:
        return None
    if mass.centre is not None:
        return Mark(f"centre of gravity{of_file}", "CG", point + np.array(mass.centre), "b")
    place = point + np.array([mass.mass_moment / mass.mass, 0.0, 0.0])
    return Mark(
        f"centre of gravity{of_file}",
        "CG",
        place,
        "b",
        "its height is not stated and drawn at that of the reference point",
    )


def _pressures(study: Study, parameters: ParameterFile, of_file: str) -> tuple[list[Mark], list[str]]:
    """Where the forces act by the slopes that the file holds, one mark a plane."""
    campaigns = {c.campaign for c in parameters.coefficients}
    sets = [f.coefficients for f in study.fits if f.body == parameters.body and f.campaign in campaigns]
    marks: list[Mark] = []
    unknown: list[str] = []
    for name, plane in PLANES.items():
        found = next(((d, s) for s in sets for d in centre_of_pressure(s, parameters.name) if d.name == name), None)
        full = f"centre of pressure for {plane}{of_file}"
        if found is None:
            moment, force, _ = CENTRES[name]
            unknown.append(f"The {full} has no value: {moment}' or {force}' is missing.")
        elif found[0].result is None:
            unknown.append(f"The {full} has no value: {found[0].statement}.")
        else:
            marks.append(_pressure(full, SHORT[name], *found))
    return marks, unknown


def _pressure(full: str, short: str, derived: Derived, among: CoefficientSet) -> Mark:
    length = among.scaling.length
    half = 0.0 if derived.result is None else derived.result.linear * length
    place = among.reference_point + np.array([derived.value * length, 0.0, 0.0])
    note = f"{plus_minus(derived.value * length, half, '±')} m forward of the reference point, from {derived.name}"
    return Mark(full, short, place, "d" if short == "CP sway" else "c", note)


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
    marks, unknown = hull_marks(study, body, files)
    if isinstance(shape, Parts):
        drawn = body_figure(body.name, shape, None, f"{anchor}-parts")
    else:
        gravity = [m.place for m in marks if m.label == "CG"]
        drawn = hull_figure(body, f"{anchor}-outline", gravity=gravity[0] if len(gravity) == 1 else None)
    return replace(drawn, scene=hull_scene(body.name, shape, marks, unknown, body.pieces))
