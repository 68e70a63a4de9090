"""``coeflab draw``: a body in three views with its dimensions and particulars."""

from __future__ import annotations

from pathlib import Path

from coeflab.cli import options, show

EXAMPLE = "coeflab draw myring_auv"


@options.worded
def command(
    *,
    body: str,
    unit: str = "",
    axes: str = "",
    repair: bool = False,
    fill: bool = False,
    sheets: bool = False,
    out: Path | None = None,
    force: bool = False,
) -> None:
    """Draw a body in three views, and list its parts as estimates see them.

    NAME.svg and NAME.png with dimensions, datum, reference point, centres, hinges and thrusters; particulars, hulls, foils, ring wings and bluff parts, and what of the body no estimate sees.
    """
    from coeflab.api.body import typed_body
    from coeflab.core.files import refuse_others, write_all
    from coeflab.report.figures.three_views import three_views
    from coeflab.report.tables.added_mass import outline_table, particulars

    found = typed_body(body, unit, axes, repair, fill, sheets)
    folder = Path() if out is None else out
    stem = "".join(c if c.isalnum() or c in "-_" else "_" for c in found.name)
    files = {f"{stem}.{ending}": content for ending, content in three_views(found).items()}
    if not force:
        refuse_others(folder, files)
    outline = found.outline
    show.table(particulars(found))
    if outline is not None:
        show.table(outline_table(outline))
    for file, new in write_all(folder, files).items():
        show.path(folder / file, "written" if new else "unchanged")
