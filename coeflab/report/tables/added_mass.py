"""Added mass by several methods, as tables to be shown.

Mass and inertia that indices, roots and manoeuvres are computed with.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.outlining import fins_along
from coeflab.core.provenance import work
from coeflab.core.table import ABSENT, Table, coefficient, number
from coeflab.core.wording import collected
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.report.texts import table_of, text_of
from coeflab.vehicle.inertia import water_inertia

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.outline import Outline
    from coeflab.bodies.triangulation import Triangulation
    from coeflab.law.added_mass import AddedMass
    from coeflab.study.study import Study
    from coeflab.vehicle.parameter_file import ParameterFile

SHOWN = ("Xudot", "Yvdot", "Zwdot", "Kpdot", "Mqdot", "Nrdot", "Yrdot", "Zqdot")
TRANSLATIONS, MARK, WIDEST, SMALLEST = "uvw", "*", 10.0, 1e-3


def particulars(body: Body) -> Table:
    """Volume, centre and wetted surface: of the shape, and as printed elsewhere."""
    rows = []
    for c in body.configurations:
        # Rounding of a centre in a plane of symmetry is no minus zero.
        at = None if c.centre_of_buoyancy is None else np.round(c.centre_of_buoyancy, 4) + 0.0
        centre = [ABSENT] * 3 if at is None else [f"{x:.4f}" for x in at]
        rows.append((c.name, number(c.volume, 6), *centre, number(c.wetted_surface, 5), c.title))
    return table_of("added_mass.particulars", rows, name=body.name, title=body.title, datum=body.datum)


def displaced(body: Body, density: float) -> Table:
    """Projected areas and the inertia of the displaced water, where they are known."""
    rows = []
    for c in body.configurations:
        inertia = c.displaced_inertia(density)
        if inertia is None or c.projected_areas is None:
            continue
        products = (-inertia[0, 1], -inertia[0, 2], -inertia[1, 2])
        cut = 1e-9 * float(np.trace(inertia))
        moments = (*np.diag(inertia), *(p if abs(p) > cut else 0.0 for p in products))
        rows.append((c.name, *(number(float(v)) for v in (*c.projected_areas, *moments))))
    headers = (
        "displaced water",
        *(f"A{a} m^2" for a in "xyz"),
        *(f"I{a} kg m^2" for a in ("x", "y", "z", "xy", "xz", "yz")),
    )
    notes = (
        "A: silhouette along the axis; what lies behind something else counts once",
        f"I: moments and products (integral of x y dm) of {density:g} kg/m^3 about the centre of buoyancy",
    )
    return Table(f"{body.name}: projected areas and inertia of the displaced water", headers, tuple(rows), notes)


def sound(mesh: TriangleMesh) -> str:
    """What the gates of a mesh let through, and its size."""
    size = " x ".join(f"{v:.5g}" for v in mesh.extents)
    return text_of("added_mass.sound", faces=len(mesh.faces), size=size)


def seen(body: Body) -> list[str]:
    """What was made sure of a mesh, and of fins along the hull, in words."""
    shape = body.shape
    out = [sound(shape)] if isinstance(shape, TriangleMesh) and shape.remade is None else []
    standing = fins_along(body.outline) if body.outline is not None else None
    return out if standing is None else [*out, standing.words]


def outline_table(outline: Outline) -> Table:
    """Hulls, foils, ring wings and bluff parts with their sizes and places.

    Parameters
    ----------
    outline : Outline
    """

    def row(part: Any, kind: str, area: Any, size: str, x: float, turned_by: str = "") -> tuple[str, ...]:
        return part.name, kind, number(float(area), 3), size, number(float(x), 4), turned_by

    rows = []
    for h in outline.hulls:
        size = f"length {h.length:.4g}, {float(h.breadth.max()):.3g} x {float(h.depth.max()):.3g}"
        rows.append(row(h, "hull", -np.trapezoid(h.girth, h.x), size, round(float(h.x[0]), 9)))
    for f in outline.foils:
        size = f"span {f.span:.3g}, chords {f.root_chord:.3g} to {f.tip_chord:.3g}, t/c {f.thickness:.2g}"
        rows.append(row(f, "foil", f.area, size, f.root[0], ", ".join(name for name, _ in f.turns)))
    for r in outline.rings:
        size = f"diameter {r.diameter:.3g}, chord {r.chord:.3g}, t/c {r.thickness:.2g}"
        rows.append(row(r, "ring", np.pi * r.diameter * r.chord, size, r.centre[0]))
    for s in outline.propellers:
        size = f"diameter {s.diameter:.3g}, P/D {s.pitch_ratio:.3g}, {s.blades} blades"
        rows.append(row(s, "propeller", np.pi / 4.0 * s.diameter**2 * s.area_ratio, size, s.centre[0]))
    for b in outline.bluff:
        size = "half sizes " + " x ".join(f"{v:.3g}" for v in b.half_extents)
        rows.append(row(b, f"bluff {b.kind}", b.areas.max(), size, b.centre[0]))
    notes = [
        "area: of a hull and a ring wetted, outside; of a foil one side; of a bluff part the largest it projects",
        "x: nose of a hull, quarter chord of a foil's root and of a ring, centre of a bluff part",
        *(("propeller: expanded area of its blades, centre of its disc",) if outline.propellers else ()),
        *(f"left out: {line}" for line in outline.left_out),
    ]
    return table_of("added_mass.outline_table", rows, notes)


def derivatives(found: Triangulation) -> Table:
    """Acceleration derivatives in SI, over the displaced mass, and their spread over the methods."""
    mass = found.density * found.shape.volume
    spread = found.spread
    rows = []
    for symbol in SHOWN:
        values = [_settled(r, symbol) for r in found.results]
        ratios = [number(-v / mass, 3) if mass and symbol[1] in TRANSLATIONS else ABSENT for v in values]
        i, j = COMPONENTS.index(symbol[0]), "uvwpqr".index(symbol[1])
        rows.append(
            (
                symbol,
                *(c for pair in zip([number(v) for v in values], ratios) for c in pair),
                _apart(spread[i, j], found.original is not None),
            )
        )
    headers = ("SI", *(cell for r in found.results for cell in (_marked(r, found), "/m")), "spread")
    note = text_of("added_mass.spread", mass=mass, density=found.density)
    return Table("Acceleration derivatives", headers, tuple(rows), (note, *remarks(found)))


def near_walls(found: tuple[AddedMass, ...]) -> Table:
    """Diagonal entries against the distance from a wall, with the numerical error, over those far from it."""
    far, *near = found
    rows = [("none", *(number(float(v)) for v in np.diag(far.matrix)), *[ABSENT] * 6)]
    for w, n in zip(far.walls, near, strict=True):
        own, free = np.diag(n.matrix), np.diag(far.matrix)
        ratios = [f"{a / b:.3f}" if b > 0.0 else ABSENT for a, b in zip(own, free, strict=True)]
        rows.append((f"{w.distance:g} m", *(number(float(v)) for v in own), *ratios))
    names = [f"{c}{m}dot" for c, m in zip(COMPONENTS, MOTIONS, strict=True)]
    notes = (
        "distance from the reference point to the wall; kg and kg m^2, signs of added mass; ratios: over the value far from walls",
        *(n.statements[0] for n in near),
        *(s for s in far.statements if "error estimate" in s),
    )
    headers = ("distance", *names, *(f"{n} ratio" for n in names))
    return Table(f"{far.body}: added mass near a wall", headers, tuple(rows), notes)


def near_walls_table(far: AddedMass) -> Table:
    """The table of a parameter file: diagonal entries at distances from a wall, over those far from it."""
    free = np.diag(far.matrix)
    rows = []
    for w in far.walls:
        ratios = (f"{a / b:.3f}" if b > 0.0 else ABSENT for a, b in zip(np.diag(w.matrix), free, strict=True))
        rows.append((w.wall, f"{w.distance:g}", *ratios))
    names = [f"{c}{m}dot" for c, m in zip(COMPONENTS, MOTIONS, strict=True)]
    note = f"over the value far from walls, by {far.method}; near ones by the panel method; from the reference point, m"
    return Table(f"{far.body}: added mass near a wall", ("wall", "m", *names), tuple(rows), (note,), frozenset({0}))


def remarks(found: Triangulation) -> tuple[str, ...]:
    """Which method is recommended and why, how far it can be trusted, and what each assumed."""
    by_rule = f"{found.recommended.method}, by the rule: {found.rule}"
    notes = [f"none recommended; first is {by_rule}" if found.none_recommended else f"{MARK} recommended: {by_rule}"]
    notes += [found.caution] if found.caution else []
    notes += _verdicts(found)
    notes += [f"{r.method}: {'; '.join(r.statements)}" for r in found.results if r.statements]
    notes += [f"{name}: not used: {why}" for name, why in found.refused.items()]
    return tuple(notes)


def _apart(spread: float, stood_in: bool) -> str:
    """A spread in per cent; over tenfold it says only that the methods have nothing in common there.

    Methods that compute stand-ins and a mesh never agree to nothing, whatever the last digit says.
    """
    if np.isnan(spread):
        return ABSENT
    if stood_in and spread < SMALLEST:
        return f"< {100.0 * SMALLEST:g} %"
    return f"{100.0 * spread:.1f} %" if spread <= WIDEST else f"> {100.0 * WIDEST:.0f} %"


def _marked(result: AddedMass, found: Triangulation) -> str:
    chosen = result.method == found.recommended.method and not found.none_recommended
    return f"{MARK} {result.method}" if chosen else result.method


def _verdicts(found: Triangulation) -> list[str]:
    """Each verdict once, and the methods that it is on unless it is on all."""
    by = collected((r.verdict, r.method) for r in found.results)
    return [f"{'every matrix' if len(by) == 1 else ', '.join(methods)}: {verdict}" for verdict, methods in by.items()]


def symmetry(found: Triangulation) -> Table:
    """Which entries the planes of symmetry make vanish, and how large they are all the same."""
    zero, left = found.vanishing()
    rows = tuple((m, f"{v:.1e}") for m, v in left.items()) if np.any(zero) else ()
    planes = ", ".join(found.mirror_planes) or "none"
    return table_of("added_mass.symmetry", rows, planes=planes, names=", ".join(found.vanishing_symbols()))


def primes(found: Triangulation) -> Table:
    """Primed acceleration derivatives beside measured ones; no rows where the body names no length."""
    by = found.body.scaling
    if by is None:
        return table_of("added_mass.primes_2", ())
    rows, notes = [], [f"primed by {by} and 1/2 rho" + ("" if found.none_recommended else f"; {MARK} recommended")]
    measured = {m.symbol: m for m in found.body.measured}
    for symbol in dict.fromkeys((*SHOWN, *measured)):
        values = [r.primed(symbol, by, found.density) if _settled(r, symbol) else 0.0 for r in found.results]
        cells = [coefficient(v) if v else "0" for v in values]
        if measured:
            measured_value = measured.get(symbol)
            gaps = [ABSENT if measured_value is None else _gap(v, measured_value.bounds) for v in values]
            cells = [c for pair in zip(cells, gaps) for c in pair]
            cells.append(ABSENT if measured_value is None else measured_value.printed)
        rows.append((f"{symbol}'", *cells))
    headers: list[str] = ["prime"]
    for r in found.results:
        headers += [_marked(r, found), "gap"] if measured else [_marked(r, found)]
    if measured:
        headers.append("measured")
        notes.append("gap: computed over measured, less one; potential theory is not tuned to the measurement")
        notes += dict.fromkeys(f"measured: {work(m.citation)} {m.place}" for m in measured.values())
        if any("?" in m.printed for m in measured.values()):
            notes.append("?: an illegible last digit; the gap is given for 0 and for 9 where that shows")
    return Table("Primes", tuple(headers), tuple(rows), tuple(notes))


def _settled(result: AddedMass, symbol: str) -> float:
    value = result.derivatives[symbol]
    return value if abs(value) > (1e-12 * float(np.max(np.abs(result.matrix)))) else 0.0


def _gap(value: float, bounds: tuple[float, float]) -> str:
    low, high = sorted(100.0 * (value / b - 1.0) for b in bounds)
    return f"{low:+.1f} %" if f"{low:.1f}" == f"{high:.1f}" else f"{low:+.1f} to {high:+.1f} %"


NOT_STATED, DIGITS = "not stated", 5
MASS = ("m", "m'")


def mass_table(study: Study) -> tuple[Table, ...]:
    """Value, unit, source and stated uncertainty of every parameter file that has a mass, those of one body together; none where none has."""
    names = collected((_rows(p, *_source(study, p)), p.name) for p in study.parameter_files.values())
    rows = [(", ".join(those), *row) for found, those in names.items() for row in found]
    if not rows:
        return ()
    return (table_of("added_mass.mass_table", rows, _added(study)),)


def _added(study: Study) -> tuple[str, ...]:
    """The added mass that goes with them, of each parameter file with a mass."""
    massive = [p for p in study.parameter_files.values() if p.mass is not None]
    words = [(p.name, *water_inertia(p).statements) for p in massive]
    return tuple(f"{name}: {'; '.join(each)}" for name, *each in words)


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
        values += [(f"I{axis}", float(mass.inertia_matrix[i, i]), "kg m^2") for i, axis in enumerate("xyz")]
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
