"""One body's added mass by several methods, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.added_mass import ADDED_MASS
from coeflab.core.citations import work
from coeflab.core.errors import InputError
from coeflab.core.symbols import COMPONENTS
from coeflab.model.added_mass import AddedMass
from coeflab.model.body import Body
from coeflab.model.table import ABSENT, Table, coefficient, number

SHOWN = ("Xudot", "Yvdot", "Zwdot", "Kpdot", "Mqdot", "Nrdot", "Yrdot", "Zqdot")
DENSEST = 1e5


@dataclass(frozen=True, slots=True)
class Triangulation:
    """Added mass by every method that applies, and why the others do not."""

    body: Body
    density: float
    results: tuple[AddedMass, ...]
    refused: Mapping[str, str]
    citations: tuple[str, ...]

    def particulars(self) -> Table:
        """Volume, centre and wetted surface: of the shape, and as printed elsewhere."""
        rows = []
        for c in self.body.configurations:
            centre = ABSENT if c.centre_of_buoyancy is None else f"{c.centre_of_buoyancy[0]:.4f}"
            rows.append((c.name, number(c.volume, 6), centre, number(c.wetted_surface, 5), c.title))
        headers = ("particulars", "volume m^3", "xB m", "wetted surface m^2", "what")
        return Table(f"{self.body.name}: {self.body.title}", headers, tuple(rows), (), frozenset({0, 4}))

    def derivatives(self) -> Table:
        """Acceleration derivatives in SI, and over the displaced mass."""
        shape = self.body.require_shape()
        mass = self.density * shape.volume
        rows = []
        for symbol in SHOWN:
            values = [_settled(r, symbol) for r in self.results]
            cells = [number(v) for v in values]
            ratios = [number(-v / mass, 3) if mass and symbol[1] in "uvw" else ABSENT for v in values]
            rows.append((symbol, *(cell for pair in zip(cells, ratios) for cell in pair)))
        headers = ("SI", *(cell for r in self.results for cell in (r.method, "/m")))
        notes = [f"/m: added mass over the displaced mass, {mass:.5g} kg at {self.density:g} kg/m^3"]
        notes += [f"{r.method}: {'; '.join([r.verdict, *r.statements])}" for r in self.results]
        notes += [f"{name}: not used: {why}" for name, why in self.refused.items()]
        return Table("Acceleration derivatives", headers, tuple(rows), tuple(notes))

    def primes(self) -> Table:
        """Primed acceleration derivatives beside measured ones; no rows where the body names no length."""
        by = self.body.scaling
        if by is None:
            return Table("Primes", (), ())
        rows, notes = [], [f"primed by {by} and 1/2 rho"]
        measured = {m.symbol: m for m in self.body.measured}
        for symbol in dict.fromkeys((*SHOWN, *measured)):
            values = [r.primed(symbol, by, self.density) if _settled(r, symbol) else 0.0 for r in self.results]
            cells = [coefficient(v) if v else "0" for v in values]
            if measured:
                beside = measured.get(symbol)
                gaps = [ABSENT if beside is None else _gap(v, beside.bounds) for v in values]
                cells = [c for pair in zip(cells, gaps) for c in pair]
                cells.append(ABSENT if beside is None else beside.printed)
            rows.append((f"{symbol}'", *cells))
        headers: list[str] = ["prime"]
        for r in self.results:
            headers += [r.method, "gap"] if measured else [r.method]
        if measured:
            headers.append("measured")
            notes.append("gap: computed over measured, less one; potential theory is not tuned to the measurement")
            notes += dict.fromkeys(f"measured: {work(m.citation)} {m.place}" for m in measured.values())
            if any("?" in m.printed for m in measured.values()):
                notes.append("?: an illegible last digit; the gap is given for 0 and for 9 where that shows")
        return Table("Primes", tuple(headers), tuple(rows), tuple(notes))

    def matrix(self, result: AddedMass) -> Table:
        """One 6 x 6 matrix."""
        cut = _rounding(result)
        rows = [(a, *(number(v if abs(v) > cut else 0.0) for v in row)) for a, row in zip(COMPONENTS, result.matrix)]
        at = ", ".join(f"{x:g}" for x in result.reference_point)
        title = f"{result.method}: M_A, kg, kg m, kg m^2, FRD about ({at}) m from: {result.datum}"
        return Table(title, ("", "u", "v", "w", "p", "q", "r"), tuple(rows))


def _rounding(result: AddedMass) -> float:
    """Entries below this are rounding and shown as zero."""
    return 1e-12 * float(np.max(np.abs(result.matrix)))


def _settled(result: AddedMass, symbol: str) -> float:
    value = result.derivatives()[symbol]
    return value if abs(value) > _rounding(result) else 0.0


def _gap(value: float, bounds: tuple[float, float]) -> str:
    low, high = sorted(100.0 * (value / b - 1.0) for b in bounds)
    return f"{low:+.1f} %" if f"{low:.1f}" == f"{high:.1f}" else f"{low:+.1f} to {high:+.1f} %"


def methods() -> tuple[str, ...]:
    """Every method with its presets: ``strip`` and ``strip:lamb``."""
    out = []
    for name in ADDED_MASS.names():
        out += [name, *(f"{name}:{preset}" for preset in getattr(ADDED_MASS.load(name), "presets", {}))]
    return tuple(out)


def triangulate(body: Body, density: float, method: str = "all") -> Triangulation:
    """Run one method, or all that apply.

    Parameters
    ----------
    body : Body
    density : float
        kg/m^3.
    method : str
        ``all``, a plugin's name, or a name with a preset.

    Raises
    ------
    InputError
        Density not above zero, no shape, an unknown preset, or no method that applies.
    PluginError
        No plugin has that name.
    """
    if not 0.0 < density <= DENSEST:
        raise InputError(
            f"a density of {density:g} kg/m^3", f"a value above zero, at most {DENSEST:g}", column="density"
        )
    body.require_shape()
    results: list[AddedMass] = []
    refused: dict[str, str] = {}
    cited: dict[str, None] = {}
    for name in methods() if method == "all" else (method,):
        plugin_name, _, preset = name.partition(":")
        plugin: Any = ADDED_MASS.load(plugin_name)
        known = getattr(plugin, "presets", {})
        if preset and preset not in known:
            raise InputError(f'the unknown preset "{preset}" of {plugin_name}', f"one of {', '.join(known) or 'none'}")
        try:
            found = plugin.added_mass(body, density, known[preset]) if preset else plugin.added_mass(body, density)
        except InputError as why:
            if method != "all":
                raise
            if not preset:
                refused[name] = why.found
            continue
        results.append(found)
        cited |= dict.fromkeys(plugin.citations)
    if not results:
        raise InputError(f"no method that applies to {body.name}", f"a body for one of {', '.join(methods())}")
    return Triangulation(body, density, tuple(results), refused, tuple(cited))
