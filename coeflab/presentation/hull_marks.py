"""Where buoyancy, weight and the force of a drift act on a body, and why such a point is not known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.model.body import Body
from coeflab.model.coefficient import CoefficientSet
from coeflab.model.derived import CENTRES, Derived, centre_of_pressure
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.study import Study
from coeflab.presentation.hull_scene import Mark

Array = NDArray[np.float64]
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
        marks += found
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
            unknown.append(f"The {full} is not determined: {moment}' or {force}' is missing.")
        elif found[0].result is None:
            unknown.append(f"The {full} is not determined: {found[0].statement}.")
        else:
            marks.append(_pressure(full, SHORT[name], *found))
    return marks, unknown


def _pressure(full: str, short: str, derived: Derived, among: CoefficientSet) -> Mark:
    length = among.scaling.length
    half = 0.0 if derived.result is None else derived.result.linear * length
    place = among.reference_point + np.array([derived.value * length, 0.0, 0.0])
    note = f"{derived.value * length:.3g} ± {half:.2g} m forward of the reference point, from {derived.name}"
    return Mark(full, short, place, "d" if short == "CP sway" else "c", note)
