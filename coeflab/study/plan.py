"""Reading a plan.toml."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from coeflab.core.axes import read_datum
from coeflab.core.errors import InputError, shown
from coeflab.core.files import located
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.toml import Section, read_toml
from coeflab.formats.export import PlannedExport
from coeflab.law.scaling import read_conditions, read_scaling
from coeflab.law.symbols import symbol_at
from coeflab.motion.manoeuvre import PlannedManoeuvre
from coeflab.study.study import Plan, PlannedJoint
from coeflab.tables.importers import PlannedTable
from coeflab.vehicle.assemble import PlannedParameterFile
from coeflab.vehicle.inertia import ACCELERATIONS, MEASURED

JOINT = "manoeuvring_model"
DEFAULT_FITS = ("slope_at_origin", "tied_law")
_NAME = re.compile(r"^[\w][\w .+-]{0,79}$")


def safe_name(section: Section, key: str, default: str | None = None) -> str:
    """A name that is also a file name."""
    name = section.text(key, default)
    if not _NAME.fullmatch(name) or name.strip(". ") != name:
        raise section.fail(key, shown(name), "letters, digits, blank, . + - _ (it names files), at most 80")
    return name


def _path(section: Section, key: str, kind: str) -> Path:
    return _located(section, key, section.text(key), kind)


def _located(section: Section, key: str, name: str, kind: str) -> Path:
    try:
        return located(name, kind, section.file.parent)
    except InputError as why:
        raise section.fail(key, why.found, why.expected) from None


def table_at(
    path: Path, fits: tuple[str, ...] = (), options: Mapping[str, Mapping[str, Any]] | None = None
) -> PlannedTable:
    """A campaign folder, its campaign.toml, or one CSV of it."""
    only = path.name if path.is_file() and path.suffix != ".toml" else None
    return PlannedTable(path, fits, options or {}, only)


def _tables(root: Section) -> tuple[PlannedTable, ...]:
    out = []
    for s in root.sections("table"):
        path = _path(s, "campaign", "cfd_data")
        fits = s.texts("fits") or DEFAULT_FITS
        options = s.section("options", required=False)
        chosen = {name: dict(options.section(name).content) for name in options.content}
        idle = next((name for name in chosen if name not in fits), None)
        if idle is not None:
            raise s.fail(
                "options", f"options of {shown(idle)}, which is not among the fits", f"options of {', '.join(fits)}"
            )
        out.append(table_at(path, fits, chosen))
        s.finish()
    if not out and not root.has("joint"):
        raise root.fail("table", "no [[table]]", "at least one", 'Add [[table]] with campaign = "path/to/campaign".')
    return tuple(out)


def _joint(root: Section) -> tuple[PlannedJoint, ...]:
    out = []
    for s in root.sections("joint"):
        names = s.texts("campaigns")
        if len(names) < 2:
            raise s.fail("campaigns", shown(list(names)), "the paths of two or more campaigns")
        tables = tuple(table_at(_located(s, "campaigns", name, "cfd_data")) for name in names)
        options = s.section("options", required=False)
        out.append(PlannedJoint(tables, s.text("fit", JOINT), dict(options.content)))
        s.finish()
    return tuple(out)


def _manoeuvres(root: Section, path: Path) -> tuple[PlannedManoeuvre, ...]:
    out = []
    for s in root.sections("manoeuvre"):
        options = s.section("options", required=False)
        accelerations = s.text("accelerations", MEASURED, ACCELERATIONS)
        out.append(
            PlannedManoeuvre(
                s.text("parameter_file"), s.text("name"), dict(options.content), accelerations, path, s.name
            )
        )
        s.finish()
    return tuple(out)


def read_plan(path: Path) -> Plan:
    """Read a plan.

    Parameters
    ----------
    path : Path
        Paths inside resolve from its folder.

    Raises
    ------
    InputError
        By file and key.
    """
    root = read_toml(path)
    study = root.section("study")
    scaling, conditions, body = (root.section(k, required=False) for k in ("scaling", "conditions", "body"))
    added_mass = root.section("added_mass", required=False)
    wanted = study.texts("wanted") or ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")
    for symbol in wanted:
        symbol_at(study, "wanted", symbol)
    files = []
    for s in root.sections("parameter_file"):
        name, group = safe_name(s, "name"), s.texts("campaigns")
        hull = _path(s, "added_mass", "geometry") if s.has("added_mass") else None
        method = s.text("added_mass_method", "all")
        files.append(PlannedParameterFile(name, s.text("body"), group, s.texts("literature"), hull, method))
        if name.casefold() in {f.name.casefold() for f in files[:-1]}:
            raise s.fail("name", f"the parameter file {shown(name)} twice", "a name of its own for each")
        s.finish()
    references = []
    for s in root.sections("references"):
        references.append(_path(s, "path", "cfd_data"))
        s.finish()
    exports: list[PlannedExport] = []
    for s in root.sections("export"):
        planned = PlannedExport(
            s.text("to"), s.flag("accept_loss", False), s.flag("strict", False),
            s.text("accelerations", MEASURED, ACCELERATIONS), path, s.name,
        )  # fmt: skip
        if planned.to in {e.to for e in exports}:
            raise s.fail("to", f"the target {shown(planned.to)} twice", "every target once")
        exports.append(planned)
        s.finish()
    plan = Plan(
        name=safe_name(study, "name"),
        title=study.text("title", study.text("name")),
        tables=_tables(root),
        joint=_joint(root),
        reference_point=study.point("reference_point") if study.has("reference_point") else None,
        datum=read_datum(study) if study.has("datum") else None,
        scaling=read_scaling(scaling) if scaling.content else None,
        conditions=read_conditions(conditions) if conditions.content else None,
        body=_path(body, "path", "geometry") if body.content else None,
        references=tuple(references),
        parameter_files=tuple(files),
        exports=tuple(exports),
        manoeuvres=_manoeuvres(root, path),
        wanted=tuple(w.removesuffix("'") for w in wanted),
        include_uncertain=study.flag("include_uncertain", False),
        file=InputFile(path.name, sha256_of(path)),
        hull=_path(added_mass, "body", "geometry") if added_mass.content else None,
        method=added_mass.text("method", "all"),
    )
    for section in (study, scaling, conditions, body, added_mass, root):
        section.finish()
    return plan
