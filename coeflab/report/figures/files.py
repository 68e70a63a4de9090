"""Drawings as files: SVG that needs no page, PDF and PNG of the same drawing, and its numbers as CSV; in a style of one's own."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

from coeflab.core.errors import OutputError
from coeflab.core.files import typed
from coeflab.core.limits import TOML_BYTES
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.text.toml import read_text
from coeflab.core.texts import input_error
from coeflab.report.document import Figure
from coeflab.report.figures import svg, svg_file
from coeflab.report.printable import CLOCK

PAGE = b'#set page(width: auto, height: auto, margin: 0pt)\n#image(bytes(sys.inputs.svg), format: "svg")\n'
DENSITY = 300.0  # pixels an inch
FAMILY = 'font-family="Helvetica, Arial, sans-serif"'
KINDS = ("svg", "pdf", "png")


@contextmanager
def styled(file: str | Path | None) -> Iterator[None]:
    """Draw in a style of Matplotlib: its fonts, sizes and cycle of colours in the place of the report's.

    Parameters
    ----------
    file : str, Path or None
        A style sheet, or the name of a style that Matplotlib has; None leaves the report's.

    Raises
    ------
    InputError
        No such style, or none that can be read.
    """
    if file is None:
        yield
        return
    import matplotlib as mpl
    from matplotlib import style

    try:
        with mpl.rc_context():
            mpl.rcdefaults()
            plain = dict(mpl.rcParams)
            if str(file) not in style.library:  # Matplotlib would wait at a pipe, and fetch an address
                read_text(typed(file), TOML_BYTES)
            style.use(str(file))
            own = {k: v for k, v in mpl.rcParams.items() if plain.get(k) != v}
            cycle = [one.get("color") for one in mpl.rcParams["axes.prop_cycle"] if one.get("color")]
            ink = mpl.rcParams["text.color"]
    except (OSError, ValueError, KeyError) as why:
        raise input_error(
            "report.style_sheet_matplotlib_or", column="--style", found=str(why).splitlines()[0]
        ) from None
    from matplotlib.colors import to_hex

    colours = {name: to_hex(cycle[i % len(cycle)]) for i, name in enumerate("abcd")} if "axes.prop_cycle" in own else {}
    colours |= {"ink": to_hex(ink)} if "text.color" in own else {}
    with svg.overridden({k: v for k, v in own.items() if not k.startswith(("svg.", "axes.prop_cycle"))}, colours):
        yield


def drawing(figure: Figure) -> bytes:
    """The drawing of a figure as an SVG file of its own, its colours as they stand."""
    across, up = svg_file.size_of(figure.svg)
    text = svg_file.plain(figure.svg)
    return text.replace("<svg ", f'<svg width="{across:g}pt" height="{up:g}pt" style="background:#fff" ', 1).encode()


def printed(picture: bytes, kind: Literal["pdf", "png"]) -> bytes:
    """An SVG file as PDF or PNG, with fonts that are there everywhere; equal drawings give equal bytes.

    Raises
    ------
    OutputError
        The typesetter refuses the drawing.
    """
    import typst
    from matplotlib import get_data_path

    text = picture.decode().replace(FAMILY, 'font-family="DejaVu Sans"')
    try:
        result = typst.compile(
            PAGE, format=kind, ppi=DENSITY, sys_inputs={"svg": text}, timestamp=CLOCK, ignore_system_fonts=True,
            font_paths=typst.Fonts(include_system_fonts=False, font_paths=[f"{get_data_path()}/fonts/ttf"]),
        )  # fmt: skip
    except typst.TypstError as why:
        raise OutputError(f"a figure could not be written as {kind}: {why}") from None
    return bytes(result[0] if isinstance(result, list) else result)


def as_kind(picture: bytes, kind: str) -> bytes:
    """An SVG file as one of `KINDS`."""
    return picture if kind == "svg" else printed(picture, kind)  # type: ignore[arg-type]


def numbers(figure: Figure) -> bytes:
    """The numbers behind a drawing as CSV, a row a point: panel, series, x, y, note; empty without any."""
    rows: list[tuple[Any, ...]] = []
    for i, panel in enumerate(figure.panels, start=1):
        for series in panel.series:
            notes = series.notes or ("",) * len(series.x)
            rows += [(i, series.name, repr(x), repr(y), n) for x, y, n in zip(series.x, series.y, notes, strict=True)]
    if not rows:
        return b""
    return csv_text([("panel", "series", "x", "y", "note"), *rows]).encode()


def files_of(figure: Figure, folder: str = "figures") -> Mapping[str, bytes]:
    """A figure as SVG, PDF, PNG and CSV by name.

    Parameters
    ----------
    figure : Figure
    folder : str
        Before the names.
    """
    picture = drawing(figure)
    stem = f"{folder}/{re.sub(r'[^A-Za-z0-9._-]+', '_', figure.anchor)}"
    table = numbers(figure)
    return {f"{stem}.{kind}": as_kind(picture, kind) for kind in KINDS} | ({f"{stem}.csv": table} if table else {})
