"""Every place that reads a file or a text of somebody else is a reader with a budget, listed here with its reason."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "coeflab"
READS = {"open", "read_text", "read_bytes"}
PARSES = {
    "json.loads", "json.load", "tomllib.loads", "tomllib.load", "yaml.load", "yaml.safe_load", "pickle.load", "pickle.loads", "np.load",
    "np.loadtxt", "np.genfromtxt", "ElementTree.parse", "ElementTree.fromstring", "minidom.parse",
}  # fmt: skip
PATTERNS = {f"re.{n}" for n in ("compile", "match", "fullmatch", "search", "sub", "findall", "finditer", "split")}

MAY_READ = re.compile(
    r"open\(|read_(?:text|bytes)\(|loads?\(|loadtxt|genfromtxt|parse\(|fromstring|safe_load|re\.\w+\([a-z]"
)

# The readers: they bound bytes, depth and counts, and raise `InputError`.
READERS = (
    "core/text/", "core/files.py", "tables/text_dialect.py", "tables/dialect.py", "tables/monitors.py", "tables/monitor_files.py",
    "tables/reading.py", "tables/importers/", "tables/openfoam_case.py", "tables/openfoam_forces.py", "bodies/mesh/",
)  # fmt: skip
# Elsewhere, each with what it reads: files of the package itself, what this process wrote, or bytes that are only compared.
ELSEWHERE = {
    "cli/__init__.py": 2, "cli/draw.py": 1, "cli/new.py": 1, "cli/simplify.py": 1,  # ours; compared with what would be written
    "report/figures/arm.py": 1, "report/formats/html.py": 4, "report/formats/pdf.py": 1, "report/formats/workbench.py": 1,
    "report/notebook.py": 1, "report/gallery/server.py": 3, "report/gallery/listing.py": 4, "report/tables/formats.py": 1,
    "published/thauv/acceptance.py": 1, "formats/holoocean/write.py": 1, "formats/c/source.py": 1,
    "formats/fmi/write.py": 2, "vehicle/conform.py": 2,  # of the package; what a compiler made
    "tank/openfoam/__init__.py": 1, "tank/openfoam/case.py": 2, "tank/processes.py": 2, "tank/solvers/openfoam.py": 1,
    "tank/solvers/external.py": 1, "tank/jobs.py": 1, "tables/runs.py": 4, "tables/settings.py": 1, "workbench/tow.py": 1,
    "workbench/vehicle.py": 1, "core/provenance.py": 1, "core/texts/__init__.py": 2, "core/wording.py": 1, "formats/xdyn/read.py": 1,
    "motion/uncertainty/batches.py": 2, "report/notation.py": 1, "tank/job.py": 2, "tank/runners/local.py": 2,
    "tank/tank_file.py": 1, "vehicle/parameter_file.py": 2, "vehicle/parameter_refusals.py": 2, "tank/openfoam/mesh_made.py": 4,
}  # fmt: skip


def called(node: ast.Call) -> str:
    what = node.func
    if isinstance(what, ast.Attribute):
        owner = what.value.id if isinstance(what.value, ast.Name) else ""
        return f"{owner}.{what.attr}"
    return what.id if isinstance(what, ast.Name) else ""


def foreign(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and name of calls that read a file, parse a text, or make a pattern of something that is no constant of the module."""
    constants = {
        t.id
        for n in ast.walk(tree)
        if isinstance(n, ast.Assign)
        for t in n.targets
        if isinstance(t, ast.Name) and t.id.isupper()
    }
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        name = called(node)
        if (
            name.rpartition(".")[2] in READS and name not in ("os.open", "webbrowser.open", "read_text")
        ) or name in PARSES:  # bare, the bounded one
            yield node.lineno, name
        elif (
            name in PATTERNS
            and node.args
            and isinstance(node.args[0], (ast.Name, ast.Attribute, ast.Subscript, ast.Call))
        ):
            inside = {n.id for n in ast.walk(node.args[0]) if isinstance(n, ast.Name)}
            if not all(n.isupper() or n.startswith("_") or n in constants for n in inside):
                yield node.lineno, name


def found(package: Path) -> dict[str, list[str]]:
    out: dict[str, list[str]] = {}
    for file in sorted(package.rglob("*.py")):
        name = file.relative_to(package).as_posix()
        if not name.startswith(READERS):
            text = file.read_text()
            calls = [f"{at}: {call}" for at, call in foreign(ast.parse(text))] if MAY_READ.search(text) else []
            if calls:
                out[name] = calls
    return out


def test_foreign_files_are_read_by_the_readers_alone() -> None:
    calls = found(PACKAGE)
    counted = Counter({name: len(of) for name, of in calls.items()})
    more = {n: calls[n] for n, many in counted.items() if many > ELSEWHERE.get(n, 0)}
    assert not more, "read it by core/text (read_text, read_toml, parse_json, read_record, read_cells, pattern)"
    assert {n: counted[n] for n in ELSEWHERE} == ELSEWHERE, "an entry that lets more in than stands there"


@pytest.mark.parametrize(
    "line",
    ["json.loads(text)", "Path(name).read_text()", "open(name)", "p.open()", "re.compile(text)", "yaml.load(text)"],
)
def test_a_reader_in_a_command_is_found(tmp_path: Path, line: str) -> None:
    (tmp_path / "cli").mkdir()
    (tmp_path / "cli" / "fit.py").write_text(f"import json\ndef command(text, name, p):\n    return {line}\n")
    assert list(found(tmp_path)) == ["cli/fit.py"]
