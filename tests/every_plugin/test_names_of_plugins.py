"""No caller keeps a list of plugins, nor a branch on the name of one: a member of the port says what differs."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from coeflab.bodies.added_mass import ADDED_MASS
from coeflab.core.registry import Registry, registries
from coeflab.fits import BY_DEFAULT, FITS, JOINT, USUAL
from coeflab.tables.importers import Importer

ROOT = Path(__file__).resolve().parents[2] / "coeflab"
NAMES = {room.kind: (frozenset(room.names()), room) for room in registries()}
KINDS = {  # words by which code holds the name of a plugin: of an attribute, a variable, a call that gets it
    "fit": "fit", "by": "fit", "method": "added-mass method", "importer": "importer", "solver": "tow solver", "runner": "runner",
    "simulator": "simulator", "exporter": "exporter", "manoeuvre": "manoeuvre", "reader": "body reader",
}  # fmt: skip
LISTS = {
    ("bodies/forms.py", "body reader"): "kinds of form in a file",
    ("bodies/readers/primitives.py", "body reader"): "kinds of form in a file",
    ("bodies/readers/finned.py", "body reader"): "kinds of hull in a file",
    ("report/as_json/shapes.py", "check"): "keys of JSON",
    ("report/as_json/studies.py", "check"): "keys of JSON",
    ("published/huuv/model.py", "check"): "keys of a parameter file",
    ("vehicle/merge.py", "check"): "keys of a parameter file",
    ("vehicle/other_water.py", "check"): "keys of a parameter file",
    ("report/figures/part_pictures.py", "body reader"): "kinds of form",
    ("report/figures/outline_overlay.py", "method of estimates"): "kinds of part in a drawing",
}
BRANCHES = {
    ("cli/added_mass.py", "method", "panel"): "walls are options of that one method",
    ("report/sections/estimates.py", "manoeuvre", "stop"): "words of a headline that the option alone does not give",
    ("vehicle/parameter_file.py", "reader", "arm"): "a body.toml of an application that the vehicle may not import",
    ("api/motion.py", "simulator", "rigid_body"): "draws are marched together, which that simulator alone can",
}


def words(node: ast.expr) -> list[str]:
    """Texts of a collection or of a single constant."""
    items = node.elts if isinstance(node, ast.List | ast.Tuple | ast.Set) else [node]
    return [i.value for i in items if isinstance(i, ast.Constant) and isinstance(i.value, str)]


def homes(room: Registry) -> tuple[str, ...]:  # type: ignore[type-arg]
    """Where the plugins of a kind stand."""
    return tuple(room.home(n).rpartition(".")[0].removeprefix("coeflab.").replace(".", "/") for n in room.names())


def lists(tree: ast.AST) -> Iterator[tuple[str, list[str]]]:
    """Kind and names, of every collection that holds two names of plugins or more."""
    for node in ast.walk(tree):
        found = []
        if isinstance(node, ast.List | ast.Tuple | ast.Set):
            found = [words(node)]
        elif isinstance(node, ast.Dict):
            found = [
                [w for k in node.keys if k is not None for w in words(k)],
                [w for v in node.values for w in words(v)],
            ]
        for texts in found:
            for kind, (names, _) in NAMES.items():
                if len(names.intersection(texts)) > 1:
                    yield kind, sorted(names.intersection(texts))


def asked(node: ast.expr) -> str:
    """The word by which an expression holds the name of a plugin; empty where it holds none."""
    if isinstance(node, ast.Attribute):
        return asked(node.value) if node.attr == "name" else node.attr
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Subscript):
        return next(iter(words(node.slice)), "")
    return next((w for a in node.args for w in words(a)), "") if isinstance(node, ast.Call) else ""


def branches(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Word and name, of every comparison of what holds a plugin's name with such a name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            for word in {asked(s) for s in sides} & set(KINDS):
                for name in {w for s in sides for w in words(s)} & NAMES[KINDS[word]][0]:
                    yield word, name


def places() -> Iterator[tuple[str, ast.AST]]:
    for path in sorted(ROOT.rglob("*.py")):
        yield path.relative_to(ROOT).as_posix(), ast.parse(path.read_text(encoding="utf-8"))


def test_no_list_of_plugins_is_kept_by_hand() -> None:
    found = {(place, kind): names for place, tree in places() for kind, names in lists(tree)}
    assert {at: names for at, names in found.items() if at not in LISTS} == {}
    assert set(LISTS) <= set(found)


def test_no_branch_on_the_name_of_a_plugin() -> None:
    found = {(place, *b) for place, tree in places() for b in branches(tree)}
    own = {b for b in found if b[0].startswith(homes(NAMES[KINDS[b[1]]][1]))}
    assert found - own == set(BRANCHES)


@pytest.mark.parametrize(
    "code", ['if found.method != "panel": pass', 'x = r.fit == "glide_polar"', 'y = f.get("fit") in ("surface", z)']
)
def test_a_branch_is_seen(code: str) -> None:
    assert list(branches(ast.parse(code)))


@pytest.mark.parametrize(
    "code", ['A = ("dask", "slurm")', 'B = {".html": "html", ".pdf": "pdf"}', '{"dask": 1, "slurm": 2}']
)
def test_a_list_is_seen(code: str) -> None:
    assert list(lists(ast.parse(code)))


def test_fits_without_a_name() -> None:
    """What is fitted where nobody names a fit: slopes and what completes them; several campaigns by a fit that joins them."""
    assert Importer.fit == USUAL == BY_DEFAULT[0]
    assert [FITS.load(n).completes for n in BY_DEFAULT[1:]] == [USUAL]  # type: ignore[attr-defined]
    assert FITS.load(JOINT).joins_campaigns
    assert not FITS.load(USUAL).joins_campaigns


def test_half_widths_of_rough_guides_by_method() -> None:
    """The shares of bodies/rough_guide, whose calibration is a slow test."""
    assert {n: ADDED_MASS.load(n).rough_share for n in ("strip", "ellipsoid", "primitives")} == {
        "strip": 0.8, "ellipsoid": 1.3, "primitives": 1.3,
    }  # fmt: skip
