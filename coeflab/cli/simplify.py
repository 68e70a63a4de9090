"""``coeflab simplify``: a mesh as simple forms, and their added mass against the mesh's."""

from __future__ import annotations

import shlex
from pathlib import Path

import typer

from coeflab.cli import options, show

EXAMPLE = "coeflab simplify huuv_mesh"


@options.worded
def command(
    *,
    mesh: str,
    unit: str = "",
    axes: str = "",
    repair: bool = False,
    fill: bool = False,
    sheets: bool = False,
    box: list[str],
    boxes: Path | None = None,
    split: str = "",
    parts: int | None = None,
    panels: int = 6000,
    out: Path | None = None,
    force: bool = False,
    json: bool = False,
) -> None:
    """Write a mesh as simple forms, what fits none as a mesh, and compare their added mass with the mesh's.

    A body.toml of these parts, the mesh itself, and an overlay as SVG and GLB. Cuts off the boxes, then separates shells, appendages of a round hull, and
    bodies along their seams. Exit code 1 where a projected area is off by more than 20 %.
    """
    from coeflab.api.body import typed_body
    from coeflab.api.simplifying import MESH, parse_box, read_boxes, simplify
    from coeflab.api.simplifying import files as files_of
    from coeflab.core.errors import InputError, shown
    from coeflab.core.files import refuse_others, write_all

    if split not in ("", "convex"):
        raise InputError(shown(split), "convex, or no --split", column="--split")
    named = tuple(parse_box(text) for text in box) + (read_boxes(boxes) if boxes is not None else ())
    with show.narrated():
        given = typed_body(mesh, unit, axes, repair, fill, sheets)
        found = simplify(given, named, parts, convex=split == "convex", panels=panels)
    folder = out if out is not None else Path(found.body.name)
    files = files_of(found)
    if not force:
        refuse_others(folder, files)
    changed = write_all(folder, files)
    if json:
        from coeflab.report.as_json.shapes import simplification

        show.json_object(simplification(found))
        raise typer.Exit(1 if found.failures else 0)
    from coeflab.report.tables import simplification as tables

    show.text(found.advice)
    if found.failures:
        show.text(f"FAILED: areas off by more than 20 %: {'; '.join(found.failures)}.")
    for table in (tables.agreement_table, tables.part_table, tables.total_table):
        show.table(table(found))
    for file, new in changed.items():
        show.path(f"{folder / file}:", "written" if new else "unchanged")
    if found.shape.rough:
        show.text(
            f"Rough stand-ins: {'; '.join(found.shape.rough)}. added-mass computes the mesh, {MESH}, beside them."
        )
    show.text("Look at overlay.svg and correct body.toml.")
    show.command_line("Next", f"coeflab added-mass {shlex.quote(str(folder))}")
    if found.failures:
        raise typer.Exit(1)
