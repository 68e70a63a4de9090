"""Where tables come from and what their campaigns declare, as tables and sentences."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.axes import point_in_words
from coeflab.core.provenance import work
from coeflab.core.table import Table
from coeflab.core.wording import collected, listed
from coeflab.report.texts import table_of

if TYPE_CHECKING:
    from coeflab.study.study import Study
    from coeflab.tables.force_table import ForceTable


def declared(tables: Sequence[ForceTable]) -> Table:
    """What the campaign.toml of some tables says of their columns, a row a matter; without rows where no file does."""
    rows: dict[tuple[str, str], list[str]] = {}
    for t in tables:
        if t.declared is None:
            continue
        d, at, sign = t.declared, t.conditions, {"alpha": "angle of attack", "beta": "drift angle"}
        each = [
            ("frame", d.frame),
            *(
                (f"sign of the {sign.get(angle, angle)}", words + ", assumed" * (angle in t.assumed))
                for angle, words in d.signs
            ),
            ("moments about", point_in_words(d.reference_point, t.datum)),
            ("datum", str(t.datum)),
            ("length of the primes", f"{t.scaling.length_name} = {t.scaling.length:.8g} m"),
            ("density", f"{at.density:.6g} kg/m^3" if t.density is None else "of each row"),
            ("speed", f"{at.speed:.6g} m/s"),
            ("symmetry", ", ".join(t.symmetry) or "none declared"),
            ("made from a file of sha256", d.source_sha256),
        ]
        for matter, words in each:
            if words:
                rows.setdefault((matter, words), []).append(t.name)
    several = len(tables) > 1
    result = tuple(
        (matter, words, *((", ".join(names) if len(names) < len(tables) else "all",) if several else ()))
        for (matter, words), names in rows.items()
    )
    notes = tuple(
        dict.fromkeys(f"Notes: {' '.join(t.declared.notes.split())}" for t in tables if t.declared and t.declared.notes)
    )
    return Table(
        "As campaign.toml declares it",
        ("", "declared", *(("tables",) if several else ())),
        result,
        notes,
        frozenset(range(2 + several)),
    )


def inputs_table(study: Study) -> Table:
    """The files that tables were made from, as their campaigns state them; they are no inputs of the study."""
    rows = tuple(
        (t.name, t.source.citation, t.declared.source_sha256)
        for t in study.tables
        if t.declared is not None and t.declared.source_sha256
    )
    return table_of("sources.made_from", rows)


def sources(study: Study) -> tuple[str, ...]:
    """Where the measured and computed tables and the published values come from, a sentence a work with the places in it."""
    tables, references = [t.source for t in study.tables], study.references
    places = collected([*((s.citation, s.place) for s in tables), *((r.citation, r.place) for r in references)])
    return tuple(
        f"Source: {work(key)} {'; '.join(filter(None, dict.fromkeys(where)))}".strip() for key, where in places.items()
    )


def halves(study: Study) -> tuple[str, ...]:
    """Tables that hold forces of half of a body, and what of them is doubled; a sentence a kind."""
    by = collected((t.halved, t.name) for t in study.tables if t.halved)
    return tuple(f"{listed(names)}: {note}." for note, names in by.items())
