"""From files to points: every input with its sha256, what of it was used, what was left out and why, and what was converted."""

from __future__ import annotations

import numpy as np

from coeflab.core.axes import point_in_words
from coeflab.core.table import ABSENT, Table
from coeflab.core.wording import listed
from coeflab.law.symbols import primed
from coeflab.report.tables.force_tables import unused_rows
from coeflab.report.texts import table_of
from coeflab.study.study import Study
from coeflab.tables.force_table import ForceTable


def traceability(study: Study) -> Table:
    """From files to points: a row a file with its sha256; beside a table's data the rows used, those left out and why, and what was converted."""
    rows: list[tuple[str, ...]] = []
    for t in study.tables:
        used = np.any(list(t.usable.values()), axis=0) if t.usable else np.zeros(len(t), dtype=bool)
        why = unused_rows(t) + _of_fits(study, t)
        own = (t.name, f"{int(used.sum())} of {len(t)}", "; ".join(why) or "none", "; ".join(_converted(t)) or "none")
        for k, file in enumerate(sorted(t.files, key=lambda f: f.name.endswith(".toml"))):
            first = own if k == 0 else ("", "", "", "")
            rows.append((first[0], file.name, file.sha256, *first[1:]))
        rows += [] if t.files else [(own[0], ABSENT, ABSENT, *own[1:])]
    named = {row[2] for row in rows}
    rows += [(ABSENT, f.name, f.sha256, "", "", "") for f in study.inputs if f.sha256 not in named]
    return table_of("traceability.traceability", rows)


def _of_fits(study: Study, table: ForceTable) -> list[str]:
    """Points that a fit of the table leaves aside of itself."""
    out = []
    for sweep in (s for f in study.fits for s in f.sweeps if s.table == table.name):
        if len(sweep.wrong):
            points = listed([sweep.labels[i] for i in sweep.wrong])
            out.append(f"{points} of {primed(sweep.symbol)}: does not fit the other points")
    return out


def _converted(t: ForceTable) -> list[str]:
    d = t.declared
    if d is None:
        return list(t.notes)
    out = [] if d.frame == "FRD" else [f"axes {d.frame} to FRD"]
    out += [f"{angle}: {words}" for angle, words in d.signs]
    point = f"primes by {t.scaling.length_name} = {t.scaling.length:.8g} m, moments about {point_in_words(d.reference_point, t.datum)}"
    return [*out, point, *t.notes]
