"""``coeflab glider``: a glider file of a polar and a body."""

from __future__ import annotations

from pathlib import Path

from coeflab.cli import options, show

EXAMPLE = "coeflab glider polar --body body.toml --engine 0.5 --net-mass 0.3 --out mine"


@options.worded
def command(
    *,
    campaign: str,
    body: str,
    engine: str,
    net_mass: str,
    engine_at: str = "",
    sliding: str = "",
    travel: str = "0",
    shift: str = "0",
    lasts: str = "600",
    depth: str = "",
    pitch_damping: str = "",
    method: str = "all",
    munk: bool = False,
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Make a glider file of a polar and a body, for coeflab glide.

    Masses, moments and inertia come from the [[mass]] parts of the body and its added mass; lift, drag and moment from the table.
    """
    import math

    import coeflab as cf
    from coeflab.core.errors import InputError, shown
    from coeflab.core.files import stem, write_all
    from coeflab.core.texts import remark
    from coeflab.core.units import quantity
    from coeflab.glider import tables as glide_tables
    from coeflab.glider.from_body import Ordered, glider_of
    from coeflab.glider.glide import steady_glides

    def value(text: str, dimension: str, option: str) -> float:
        try:
            number = float(text)
        except ValueError:
            return quantity(text, dimension, key=option)
        if not math.isfinite(number):
            raise InputError(shown(text), "a finite number", column=option)
        return number

    numbers = {
        option: value(text, dimension, option)
        for option, text, dimension in (
            ("--engine", engine, "mass"), ("--net-mass", net_mass, "mass"), ("--travel", travel, "length"), ("--shift", shift, "length"),
            ("--lasts", lasts, "time"), ("--engine-at", engine_at or "0", "length"), ("--pitch-damping", pitch_damping or "0", "none"),
            ("--depth", depth or "0", "length"),
        )
    }  # fmt: skip
    hull = cf.read_body(body)
    density = hull.mass_model.density if hull.mass_model is not None else show.FRESH_WATER
    ordered = Ordered(
        numbers["--engine"], numbers["--engine-at"] if engine_at else None, sliding, numbers["--travel"], numbers["--net-mass"],
        numbers["--shift"], numbers["--lasts"], numbers["--pitch-damping"] if pitch_damping else _estimated(hull, density), not munk,
        not pitch_damping, numbers["--depth"] if depth else None,
    )  # fmt: skip
    result = glider_of(stem(hull.name), cf.read_table(campaign), hull, hull.added_mass(method, density), ordered)
    written = {} if out is None else write_all(out, {f"{result.name}.glider.toml": result.file()})
    paths = [str((out or Path()) / name) for name in written]
    if json:
        from coeflab.report.as_json.findings import finding_as_data

        show.json_object(
            {
                "name": result.name,
                "mass": {k: getattr(result.mass, k) for k in result.mass.__slots__},
                "files": paths,
                "findings": [finding_as_data(f) for f in result.findings],
            }
        )
        return
    show.table(glide_tables.steady(result, tuple(s for p in result.phases for s in steady_glides(result, p))))
    show.table(glide_tables.basis(result))
    for found in result.findings:
        show.marked(str(found.severity), remark(found))
    for path in paths:
        show.path(path)
    if paths:
        show.command_line("Fly it", f"coeflab glide {paths[0]}")


def _estimated(hull: object, density: float) -> float:
    """Pitch damping by the estimate of Mq', zero where there is none."""
    from typing import cast

    import coeflab as cf

    found = cf.vehicle(cast("cf.Body", hull), density=density)
    if "Mq'" not in found:
        return 0.0
    return max(-float(found["Mq'"].value or 0.0) * found.file.scaling.unit("Mq", density, 1.0), 0.0)
