"""Reading a plan.toml."""

from __future__ import annotations

import re
from pathlib import Path

from coeflab.core.errors import InputError, shown
from coeflab.core.files import located
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.toml import Section, read_toml
from coeflab.model.scaling import read_conditions, read_scaling
from coeflab.model.study import Plan, PlannedParameterFile, PlannedTable

_NAME = re.compile(r"^[\w][\w .+-]{0,79}$")


def safe_name(section: Section, key: str, default: str | None = None) -> str:
    """A name that is also a file name."""
    name = section.text(key, default)
    if not _NAME.fullmatch(name) or name.strip(". ") != name:
        raise section.fail(key, shown(name), "letters, digits, blank, . + - _ (it names files), at most 80")
    return name


def _path(section: Section, key: str, kind: str) -> Path:
    try:
        return located(section.text(key), kind, section.file.parent)
    except InputError as why:
        raise section.fail(key, why.found, why.expected) from None


def _tables(root: Section) -> tuple[PlannedTable, ...]:
    out = []
    for s in root.sections("table"):
        path = _path(s, "campaign", "cfd_data")
        fits = s.texts("fits") or ("slope_at_origin",)
        options = s.section("options", required=False)
        chosen = {name: dict(options.section(name).content) for name in options.content}
        only = path.name if path.is_file() and path.suffix != ".toml" else None
        out.append(PlannedTable(path, fits, chosen, only))
        s.finish()
    if not out:
        raise root.fail("table", "no [[table]]", "at least one", 'Add [[table]] with campaign = "path/to/campaign".')
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
    wanted = study.texts("wanted") or ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")
    for symbol in wanted:
        study.symbol("wanted", symbol)
    files = []
    for s in root.sections("parameter_file"):
        name, group = safe_name(s, "name"), s.texts("campaigns")
        files.append(PlannedParameterFile(name, s.text("body"), group, s.texts("literature")))
        if name.casefold() in {f.name.casefold() for f in files[:-1]}:
            raise s.fail("name", f"the parameter file {shown(name)} twice", "a name of its own for each")
        s.finish()
    references = []
    for s in root.sections("references"):
        references.append(_path(s, "path", "cfd_data"))
        s.finish()
    exports = []
    for s in root.sections("export"):
        exports.append(s.text("to"))
        s.finish()
    plan = Plan(
        name=safe_name(study, "name"),
        title=study.text("title", study.text("name")),
        tables=_tables(root),
        reference_point=study.point("reference_point") if study.has("reference_point") else None,
        datum=study.text("datum", ""),
        scaling=read_scaling(scaling) if scaling.content else None,
        conditions=read_conditions(conditions) if conditions.content else None,
        body=_path(body, "path", "geometry") if body.content else None,
        references=tuple(references),
        parameter_files=tuple(files),
        exports=tuple(exports),
        wanted=tuple(w.removesuffix("'") for w in wanted),
        include_uncertain=study.flag("include_uncertain", False),
        file=InputFile(path.name, sha256_of(path)),
    )
    for section in (study, scaling, conditions, body, root):
        section.finish()
    return plan
