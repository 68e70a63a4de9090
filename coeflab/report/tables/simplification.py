"""Parts of a simplified mesh beside the mesh: sizes, errors and added mass, as tables to be shown."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.shape import Faceted, Turned
from coeflab.bodies.simplify.part_file import form_keys
from coeflab.bodies.simplify.simplification import RULES, Simplification
from coeflab.core.table import ABSENT, Table, number
from coeflab.law.symbols import COMPONENTS, MOTIONS

UNITS = ("kg",) * 3 + ("kg m^2",) * 3
POOR_VOLUME = 0.02  # of the mesh's volume


def agreement_table(found: Simplification) -> Table:
    """Added mass of the parts beside the mesh's in six motions; no rows where nothing was compared."""
    if found.compared is None:
        return Table("Parts against mesh", (), ())
    parts, mesh = (np.diag(found.matrix) for found in found.compared)
    error = np.nan_to_num(np.diag(found.compared[1].error)) if found.compared[1].error is not None else np.zeros(6)
    unknown = found.compared[1].error is None  # too few panels for a family
    entries = (None,) * 6 if found.shape.agreement is None else found.shape.agreement.entries
    rows = [
        (f"{c}{m}dot", unit, number(-a, 4), number(-b, 4), ABSENT if unknown or b <= e else f"{e / b:.1%}", ABSENT if d is None else _percent(d))
        for c, m, unit, a, b, e, d in zip(COMPONENTS, MOTIONS, UNITS, parts, mesh, error, entries, strict=True)
    ]  # fmt: skip
    headers = ("", "unit", "parts", "mesh", "error of mesh", "parts over mesh, less one")
    return Table("Parts against mesh", headers, tuple(rows), (found.advice, *found.compared[1].statements[:1]))


def part_table(found: Simplification) -> Table:
    """Sizes and errors part by part."""
    rows = []
    for p in found.parts:
        kind, sizes = form_keys(p.part.form)
        size = ", ".join(f"{key.replace('_', ' ')} {value:g}" for key, value in sizes.items())
        if isinstance(p.part.form, Turned):
            size = f"length {p.part.form.length:g}, radius {max(p.part.form.radii):g}"
        if isinstance(p.part.form, Faceted):
            size = f"{len(p.part.form.mesh.faces)} faces"
        errors = [_percent(e) for e in (p.volume_error, *p.projected_errors, p.length_error)]
        rows.append((p.part.name, kind, size, number(p.volume, 5), number(p.part.form.volume, 5), *errors))
    notes = [
        "errors: form over mesh, less one; A: projected areas along the part's own axes; length: the largest extent, of a plate in span"
    ]
    notes += [f"{p.part.name}: {remark}" for p in found.parts for remark in p.remarks]
    notes += [f"LOOK AT {p.part.name}: {', '.join(p.poor)}" for p in found.parts if p.poor]
    headers = ("part", "form", "m", "mesh m^3", "form m^3", "V", "A x", "A y", "A z", "length")
    return Table("Parts", headers, tuple(rows), (*notes, *found.statements), frozenset({0, 1, 2}))


def total_table(found: Simplification) -> Table:
    """The whole mesh beside the sum of the parts."""
    pieces = sum(p.volume for p in found.parts)
    plates = sum(p.volume for p in found.parts if not p.part.form.volume)
    whole = pieces + found.unassigned
    centre = found.shape.centre_of_volume
    rows = [
        ("volume m^3", number(whole, 6), number(found.shape.volume, 6), _percent(found.shape.volume / whole - 1.0)),
        ("of it plates m^3", number(plates, 4), "0", ABSENT),
        (
            "unassigned m^3",
            number(abs(found.unassigned), 3),
            ABSENT,
            f"{abs(100.0 * found.unassigned / whole):.4f} %",
        ),
    ]
    for axis, a, b in zip("xyz", *(np.round(c, 5) + 0.0 for c in (found.mesh.centre_of_volume, centre)), strict=True):
        rows.append((f"centre of volume {axis} m", f"{a:.5f}", f"{b:.5f}", f"{b - a:+.5f} m"))
    for axis, a, b in zip("xyz", found.mesh.integrals.projected, found.projected, strict=True):
        rows.append((f"projected area along {axis} m^2", number(a, 5), number(b, 5), _percent(b / a - 1.0)))
    notes: tuple[str, ...] = ("projected areas: sums over the parts, what hides what is not looked at", *RULES)
    if abs(found.shape.volume / whole - 1.0) > POOR_VOLUME:
        notes = (
            f"LOOK: the parts displace {found.shape.volume / whole - 1.0:+.1%} of the mesh's volume, and the centre moves "
            "with it; plates displace nothing",
            *notes,
        )
    return Table("Whole body", ("", "mesh", "parts", "error"), tuple(rows), notes)


def _percent(share: float) -> str:
    text = f"{100.0 * share:+.1f} %"
    return "0.0 %" if text in ("+0.0 %", "-0.0 %") else text
