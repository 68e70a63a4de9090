"""Docstrings against signatures: what is listed is what there is, and long signatures are explained."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

from tests.sources import PACKAGE, trees

FEW = 2  # parameters that a summary line can explain
EXPLAINED = (
    r"api/", r"core/", r"study/(run|estimated_vehicle)\.py", r"tables/importers/", r"bodies/(readers|simplify|added_mass)/", r"fits/\w+\.py", r"formats/\w+/(read|write)\.py",
    r"formats/model_files\.py", r"vehicle/comparison\.py", r"motion/(manoeuvres|simulators|trim)/", r"identify/identify\.py",
    r"motion/uncertainty/(uncertainty|batches)\.py", r"study/checks/", r"report/(formats|gallery)/",
)  # fmt: skip
SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?=\n\n[A-Z]\w*\n-+\n|\Z)", re.MULTILINE | re.DOTALL)
Function = tuple[Path, str, tuple[str, ...], str]


def functions(within: ast.AST, file: Path, owner: str = "") -> list[Function]:
    """Public functions and methods: file, name, parameters and docstring."""
    found: list[Function] = []
    for node in getattr(within, "body", []):
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            found += functions(node, file, f"{node.name}.")
        elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            a = node.args
            every = [*a.posonlyargs, *a.args, *a.kwonlyargs, *(x for x in (a.vararg, a.kwarg) if x)]
            names = tuple(x.arg for x in every if x.arg not in ("self", "cls"))
            found.append((file, owner + node.name, names, ast.get_docstring(node) or ""))
    return found


def listed(docstring: str) -> tuple[str, ...] | None:
    """Names of the section Parameters; None where there is none."""
    section = SECTION.search(docstring)
    if section is None:
        return None
    heads = [line.partition(" :")[0] for line in section.group(1).splitlines() if line and not line.startswith(" ")]
    return tuple(name.strip().lstrip("*") for head in heads for name in head.split(","))


@cache
def every() -> list[Function]:
    files = {p.relative_to(PACKAGE): tree for p, tree in trees().items()}
    public = {p: tree for p, tree in files.items() if not any(re.match("_[^_]", part) for part in p.parts)}
    return [f for p, tree in public.items() for f in functions(tree, p)]


def ports() -> list[Function]:
    """Functions of the protocols that plugins keep, wherever a registry is made of them."""
    found: list[Function] = []
    for p, tree in trees().items():
        if p.name == "__init__.py" or p == PACKAGE / "core" / "registry.py":
            kept = [
                n
                for n in tree.body
                if isinstance(n, ast.ClassDef) and any("Protocol" in ast.unparse(b) for b in n.bases)
            ]
            found += functions(ast.Module(kept, []), p.relative_to(PACKAGE))
    return found


def test_the_reader_of_docstrings_reads() -> None:
    text = "One.\n\nParameters\n----------\na, b : float\n    Two of them.\nc : (n,) array\n\nRaises\n------\nInputError\n    d : no."
    assert listed(text) == ("a", "b", "c")
    assert listed("One.\n\nRaises\n------\nInputError") is None


def test_a_list_of_parameters_is_the_signature() -> None:
    wrong = [
        f"{file}: {name} lists {listed(doc)}, takes {names}"
        for file, name, names, doc in every()
        if (found := listed(doc)) is not None and sorted(found) != sorted(names)
    ]
    assert not wrong, "\n".join(wrong)


def test_many_parameters_are_explained() -> None:
    """Of a plugin's own functions the port explains those that it asks for; validations reproduce papers for nobody to call."""
    of_ports = {name.partition(".")[2] for _, name, _, _ in ports()}
    within = re.compile("|".join(EXPLAINED))
    bare = [
        f"{file}: {name}{names}"
        for file, name, names, doc in every()
        if within.match(file.as_posix()) and len(names) > FEW and listed(doc) is None
        and name not in of_ports
    ]  # fmt: skip
    for where in EXPLAINED:
        assert any(re.match(where, file.as_posix()) for file, *_ in every()), where
    assert not bare, "\n".join(bare)


def test_ports_explain_every_parameter() -> None:
    assert ports()
    bare = [f"{name}{names}" for _, name, names, doc in ports() if names and listed(doc) is None]
    assert not bare
