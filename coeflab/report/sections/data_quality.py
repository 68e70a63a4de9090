"""Quality of the data on one page: settings, convergence, mirrored and repeated runs, readings at rest, what is left out."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure as Drawing

from coeflab.report.document import Figure, Section
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import tick_texts, ticks
from coeflab.report.figures.svg import POINTS, settings, svg_text
from coeflab.report.tables import data_quality as quality
from coeflab.report.texts import texts_of
from coeflab.study.study import Study
from coeflab.tables.force_table import ForceTable

WIDTH, LEFT, RIGHT, TOP, STRIP = 340.0, 84.0, 14.0, 6.0, 34.0


def quality_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the study has no tables.

    Parameters
    ----------
    study : Study
    """
    if not study.tables:
        return ()
    shown = (
        *quality.of_tables(study.tables),
        quality.at_rest(study.fits),
        quality.outliers(study.checks),
        quality.counts(study.tables),
        quality.not_used(study.tables),
    )
    text: tuple[str, ...] = texts_of("data_quality.section")
    if not any(t.exclusions for t in study.tables):
        text = (*text, "No row and no cell is rejected or doubtful.")
    figures = tuple(f for i, t in enumerate(study.tables) if (f := settings_figure(t, f"settings-{i}")) is not None)
    return (Section("data-quality", "Data quality", text, tuple(t for t in shown if t.rows), figures),)


def settings_figure(table: ForceTable, anchor: str) -> Figure | None:
    """Every row of a table at its settings, one line a variable; hollow where no force of the row is used.

    None for a table in which nothing varies.

    Parameters
    ----------
    table : ForceTable
    anchor : str
    """
    varied = quality.settings_of(table)
    if not varied:
        return None
    used = np.any(list(table.usable.values()), axis=0)
    title = f"{table.name}: settings of its rows"
    description = "; ".join(
        f"{name}: {len(np.unique(np.round(x, 6)))} levels from {x.min():.4g} to {x.max():.4g}"
        for name, x in varied.items()
    )
    with settings():
        height = TOP + STRIP * len(varied)
        figure = Drawing(figsize=(WIDTH / POINTS, height / POINTS))
        for k, (name, x) in enumerate(varied.items()):
            base = height - TOP - STRIP * (k + 1) + 16.0
            wide = WIDTH - LEFT - RIGHT
            axes = figure.add_axes((LEFT / WIDTH, base / height, wide / WIDTH, (STRIP - 18.0) / height))
            axes.set_axis_off()
            low, high = float(x.min()), float(x.max())
            room = 0.04 * (high - low) or 0.5
            across = (low - room, high + room)
            axes.set_xlim(*across)
            axes.set_ylim(-1.0, 1.0)
            axes.axhline(-1.0, color=COLOURS["rule"], linewidth=0.8)
            if low < 0.0 < high:
                axes.axvline(0.0, color=COLOURS["rule"], linewidth=0.8)
            for rows, face in ((used, COLOURS["a"]), (~used, "none")):
                levels = np.unique(np.round(x[rows], 6))
                axes.plot(
                    levels, np.zeros(len(levels)), "o", ms=3.6, mfc=face, mec=COLOURS["a"], mew=0.7, clip_on=False
                )
            figure.text((LEFT - 8.0) / WIDTH, (base + 4.0) / height, name, ha="right", va="baseline")
            at = ticks(across, 6)
            for value, text in zip(at, tick_texts(at), strict=True):
                place = LEFT + wide * (float(value) - across[0]) / (across[1] - across[0])
                figure.text(
                    place / WIDTH, (base - 10.0) / height, text, ha="center", va="baseline", color=COLOURS["muted"]
                )
        svg = svg_text(figure, anchor, title, description)
    caption = f"Settings of the {len(table)} rows of {table.name}; hollow: no force of the row is used."
    return Figure(anchor, svg, title, caption, description)
