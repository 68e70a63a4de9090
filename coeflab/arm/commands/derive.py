"""``coeflab derive``: the equations of a vehicle with an arm in closed form, as code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from coeflab.cli import complete, options, show
from coeflab.core.texts import input_error

if TYPE_CHECKING:
    from coeflab.arm.tape import ClosedForm
    from coeflab.core.table import Table

EXAMPLE = "coeflab derive urv_puma --to c"
LANGUAGES = ("c", "python", "latex", "octave")


def languages(incomplete: str) -> list[str]:
    """Languages of derived equations."""
    return complete.names(LANGUAGES, incomplete)


def arms(incomplete: str) -> list[str]:
    """Shipped vehicles with an arm, and paths."""
    from coeflab.arm.arm_file import is_arm
    from coeflab.core.files import shipped

    names = complete.shipped_with("geometry", "body.toml")
    return complete.or_paths([name for name in names if is_arm(shipped("geometry") / name)], incomplete)


@options.worded
def command(*, body: str, to: str, out: Path | None = None, symbols: bool | None = None, json: bool = False) -> None:
    """Write the equations of motion of a vehicle with an arm as code.

    In closed form, by Kane's method: inertia, bias, weight, buoyancy, drag. Needs the package sympy: coeflab[derive].
    """
    from coeflab.arm.arm_file import BODY, read_chain
    from coeflab.core.errors import InputError, shown
    from coeflab.core.files import located, write_all
    from coeflab.core.provenance import sha256_of
    from coeflab.core.wording import identifier

    if to not in LANGUAGES:
        raise InputError(shown(to), ", ".join(LANGUAGES), column="--to")
    place = located(body, "geometry")
    file = place / BODY if place.is_dir() else place
    if file.suffix != ".toml":
        raise input_error("arm.vehicle_arm_name", file, found=shown(file.name))
    chain = read_chain(file)
    try:
        from coeflab.arm.closed_form import derive
        from coeflab.arm.languages import Origin, written
    except ModuleNotFoundError as why:
        if why.name is None or why.name.partition(".")[0] not in ("sympy", "mpmath"):
            raise
        raise InputError("derive without the package sympy", "sympy", advice='Install "coeflab[derive]".') from None
    with show.progress(json) as say:
        form = derive(chain, symbols=to == "latex" if symbols is None else symbols, say=say)
        files = written(form, to, Origin(file.name, sha256_of(file), chain.statements), say)
    folder = Path(f"{identifier(chain.name)}.{to}") if out is None else out
    changed = write_all(folder, files)
    if json:
        sizes = {f.name: {"lines": len(f.lines), "operations": f.operations} for f in form.functions}
        show.json_object({"files": [str(folder / name) for name in files], "functions": sizes})
        return
    show.table(_functions(form))
    for name, new in changed.items():
        show.path(f"{folder / name}:", "written" if new else "unchanged")


def _functions(form: ClosedForm) -> Table:
    """What was derived, and how long it is."""
    from coeflab.core.table import Table

    count = len(form.links)
    rows = tuple((f.name, ", ".join(f.arguments), ", ".join(f.outputs), str(f.operations)) for f in form.functions)
    notes = ["Operations: additions, products, functions; a strip counts as one."]
    if form.parameters:
        notes.append(f"{len(form.parameters)} numbers of the file stay arguments; zeros and right angles do not.")
    return Table(
        f"{form.name}: {count} link{'s' * (count > 1)}, {form.size} generalised speeds",
        ("function", "of", "gives", "operations"), rows, tuple(notes), frozenset({0, 1, 2}),
    )  # fmt: skip
