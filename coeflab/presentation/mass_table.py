"""Mass and inertia that indices, roots and manoeuvres are computed with."""

from __future__ import annotations

from coeflab.model.inertia import water_inertia
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.study import Study
from coeflab.model.table import Table, number

NOT_STATED, DIGITS = "not stated", 5
MASS = ("m", "m'")


def mass_table(study: Study) -> tuple[Table, ...]:
    """Value, unit, source and stated uncertainty of every parameter file that has a mass, those of one body together; none where none has."""
    names: dict[tuple[tuple[str, ...], ...], list[str]] = {}
    for p in study.parameter_files.values():
        names.setdefault(_rows(p, *_source(study, p)), []).append(p.name)
    rows = [(", ".join(those), *row) for found, those in names.items() for row in found]
    if not rows:
        return ()
    headers = ("parameter file", "quantity", "value", "unit", "source", "stated uncertainty")
    notes = (
        "m' = m / (1/2 rho L^3); xG' = x_G / L, from the reference point, forward; Iy = Iz about the reference point",
        "No uncertainty of mass and inertia is in U95 of indices, roots or manoeuvres: it is not assessed.",
        *_added(study),
    )
    return (Table("Mass and inertia used", headers, tuple(rows), notes, frozenset({0, 1, 3, 4, 5})),)


def _added(study: Study) -> tuple[str, ...]:
    """The added mass that goes with them, of each parameter file with a mass."""
    massive = [p for p in study.parameter_files.values() if p.mass is not None]
    said = [(p.name, *water_inertia(p).statements) for p in massive]
    return tuple(f"{name}: {'; '.join(each)}" for name, *each in said)


def _rows(parameters: ParameterFile, source: str, stated: str) -> tuple[tuple[str, ...], ...]:
    mass = parameters.mass
    if mass is None:
        return ()
    values = [
        ("m", mass.mass, "kg"),
        ("m'", mass.mass_prime, ""),
        ("xG'", mass.mass_moment_prime / mass.mass_prime, ""),
        ("xG' m'", mass.mass_moment_prime, ""),
    ]
    if mass.inertia_matrix is not None:
        values += [(f"I{axis}", mass.inertia_matrix[i][i], "kg m^2") for i, axis in enumerate("xyz")]
    elif mass.inertia is not None:
        values.append(("Iy = Iz", mass.inertia, "kg m^2"))
    return tuple(
        (name, number(v, DIGITS), unit, source, stated if name in MASS else NOT_STATED) for name, v, unit in values
    )


def _source(study: Study, parameters: ParameterFile) -> tuple[str, str]:
    """Where the body's file has them from, whether they were moved, and what that source says of the uncertainty of mass."""
    configuration = study.body.configuration(parameters.body) if study.body else None
    if study.body is None or configuration is None or configuration.mass is None:
        return NOT_STATED, NOT_STATED
    moved = any(note.startswith("mass properties moved") for note in parameters.provenance.notes)
    given = study.body.source
    source = f"{given.citation}, {given.place}{', moved to the reference point' if moved else ''}"
    return source, given.stated_uncertainty if "mass" in given.stated_uncertainty else NOT_STATED
