"""A model file as tables: what it holds, and what is left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, coefficient, number, with_u95
from coeflab.core.texts import known, remark
from coeflab.formats.loss_tables import at_points
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative, primed
from coeflab.report.texts import table_of
from coeflab.vehicle.force_law import points_of
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.schema_versions import SCHEMA_VERSION, is_later
from coeflab.vehicle.second_order import ROUNDING, products_once
from coeflab.vehicle.stability import stability

if TYPE_CHECKING:
    from coeflab.study.study import Study


def contents(parameters: ParameterFile, kind: str) -> Table:
    """Every coefficient, primed and in SI; findings of the file are printed with the checks."""
    p = parameters
    noted = tuple(remark(f) for f in p.findings if not known(f))
    remarks = tuple(dict.fromkeys((*p.provenance.notes, *noted)))
    rows = tuple(
        (c.symbol, with_u95(c.value, c.u95)[0], number(c.value_si), c.unit_si, with_u95(c.value, c.u95)[1], c.status.replace("_", " "),
         c.origin, c.estimator or ABSENT)
        for c in p.coefficients
    )  # fmt: skip
    point = ", ".join(f"{x:g}" for x in p.reference_point.point)
    return table_of(
        "model_file.contents",
        rows,
        (
            f"schema {p.schema_version}, written by coeflab {p.provenance.coeflab_version}; valid"
            if kind == "coeflab"
            else f"read as {kind}",
            *(
                (
                    f"schema {p.schema_version} is later than {SCHEMA_VERSION}, which this release writes; empty keys passed over",
                )
                if is_later(p.schema_version, SCHEMA_VERSION)
                else ()
            ),
            *remarks,
            *(
                ("values are totals: -C_A(nu) nu of the added mass is in them",)
                if p.added_mass is not None and kind != "coeflab"
                else ("accelerations and products by the added mass of the file are listed with --wide",)
                if p.added_mass is not None
                else ()
            ),
        ),
        name=p.name,
        body=p.body,
        p=_length(p),
        speed=p.conditions.speed,
        density=p.conditions.density,
        point=point,
        datum=p.reference_point.datum,
    )


def left_out(names: Mapping[str, Sequence[str]], whose: str) -> Table:
    """What a model states and its parameter file does not hold."""
    rows = tuple((kind, ", ".join(held)) for kind, held in names.items())
    return table_of("model_file.left_out", rows or (("nothing", ""),), whose=whose)


def by_added_mass(parameters: ParameterFile) -> Table:
    """Acceleration derivatives and products of velocities that follow from the added mass and are no coefficients of the file.

    Without rows where the file has no added mass; without products where its fitted tables may speak of them.
    """
    p, hull = parameters, parameters.added_mass
    headers, title = ("", "value", "SI", "unit"), "By the added mass, besides these coefficients"
    if hull is None:
        return Table(title, headers, ())
    own = {_product(c.symbol) for c in p.coefficients}
    products = products_once(ideal_quadratics(hull.matrix))
    accelerations = [(f"{COMPONENTS[i]}{MOTIONS[j]}dot", -hull.matrix[i, j]) for i, j in np.ndindex(6, 6)]
    others = [
        (f"{c}{MOTIONS[j]}{MOTIONS[k]}", products[i, j, k])
        for i, c in enumerate(COMPONENTS) for j, k in np.ndindex(6, 6)
        if abs(products[i, j, k]) > ROUNDING * np.max(np.abs(products[i]))
    ]  # fmt: skip
    every = accelerations if p.models else [*accelerations, *others]
    left = [(s, v) for s, v in every if v and _product(s) not in own]
    rows = tuple(
        (primed(s), coefficient(float(v / p.scaling.unit(s, p.conditions.density))), number(float(v)), derivative(s).unit)
        for s, v in left
    )  # fmt: skip
    notes = (f"added mass of {hull.body}, {hull.method}" + "; products as in -C_A(nu) nu" * (every != accelerations),)
    return Table(title, headers, rows, notes, frozenset({0, 3}))


def _product(symbol: str) -> tuple[str, tuple[str, ...]]:
    """Component and factors in no order; the speed along x of a first-order derivative is one of them."""
    d = derivative(symbol)
    factors = ("u", *d.factors) if len(d.factors) == 1 and d.factors[0] in MOTIONS else d.factors
    return d.component, ("u", "u") if not factors else tuple(sorted(factors)) + ("|",) * ("|" in d.text)


def _length(p: ParameterFile) -> str:
    size = f"{p.scaling.length:.6g} m"
    return size if p.scaling.length_name == size else f"{p.scaling.length_name} {size}"


def laws(study: Study) -> list[Table]:
    """The force law of every parameter file of a study at its points."""
    return [at_points(points_of(p), f"Force law of {name}") for name, p in study.parameter_files.items()]


def decided(study: Study) -> list[str]:
    """What the stability indices of its files decide, in words."""
    settled = {f"{p.name} {d.name}": p.name for p in study.parameter_files.values() for d in stability(p) if d.decided}
    own = [c for c in study.checks if c.name == "stability" and c.subject in settled]
    return [f"{settled[c.subject]}: {c.statistic}. {c.comment}" for c in own]
