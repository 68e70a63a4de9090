"""What a plan names, read: tables about one reference point, bodies."""

from __future__ import annotations

from pathlib import Path

from coeflab.bodies import BODIES
from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.toml import read_toml
from coeflab.importers import IMPORTERS
from coeflab.model.body import Body
from coeflab.model.campaign import FILE, read_campaign
from coeflab.model.declared import declared
from coeflab.model.force_table import ForceTable
from coeflab.model.study import Plan, PlannedJoint, PlannedTable


def read_tables(planned: PlannedTable) -> tuple[ForceTable, ...]:
    """The tables of a planned campaign: a folder, its campaign.toml, or one CSV beside it."""
    path = planned.campaign
    declaration = path / FILE if path.is_dir() else path if path.suffix == ".toml" else path.parent / FILE
    if not declaration.exists():
        raise InputError(
            f"no {FILE} in {declaration.parent}",
            f"a {FILE} that declares axes, angle sign, reference point and scaling",
            file=path,
            advice="`coeflab new DIR` writes a commented one.",
        )
    campaign = read_campaign(declaration)
    with IMPORTERS.guarded(campaign.importer):
        read = IMPORTERS.load(campaign.importer).read(campaign, planned.only)
    return declared(read, campaign)


def read_body(path: Path) -> Body:
    """A body, by the reader that its body.toml names."""
    head = read_toml(path).section("body")
    reader = head.text("reader", "particulars")
    with BODIES.guarded(reader):
        return BODIES.load(reader).read(path)


def settled(table: ForceTable, plan: Plan) -> ForceTable:
    """The table about the plan's reference point."""
    if plan.include_uncertain:
        table = table.with_uncertain_cells()
    if plan.reference_point is None:
        return table
    if plan.datum and plan.datum != table.datum:
        raise ScalingMismatchError(
            f"the plan measures points from {shown(plan.datum.id)}, {table.campaign} from {shown(table.datum.id)}; "
            "state the reference point from one datum."
        )
    return table.about(plan.reference_point)


def together(joint: PlannedJoint, plan: Plan) -> list[ForceTable]:
    """All tables of a joint fit, each once."""
    read = [settled(t, plan) for planned in joint.tables for t in read_tables(planned)]
    names = [t.name for t in read]
    twice = next((n for n in names if names.count(n) > 1), None)
    if twice is not None:
        raise InputError(f"the table {shown(twice)} twice", "every table once, and campaigns of different names",
                         column="campaigns", advice="A row that counts twice makes every interval too narrow.")  # fmt: skip
    return read
