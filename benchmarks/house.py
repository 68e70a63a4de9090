"""Size and shape of the package: files, lines of code, imports, circles, modules with a single importer.

python benchmarks/house.py [--list]     --list names the circles, the long files and the modules with a single importer
python benchmarks/house.py --lines      writes `lines_of_code.toml` where a subject fell; the ratchet of CI is `tests/core/test_lines_of_code.py`
python benchmarks/house.py --texts      texts outside of templates by file, the most first
python benchmarks/house.py --lines --because "REASON"      also where one rose

Lines of code leave out blank lines, comments and docstrings. Texts are literals of five words or more that are no docstring: words
that reach a reader belong into templates (`coeflab/core/texts`). Imports count wherever they stand, in functions and under
TYPE_CHECKING too. A circle is a set of modules that import each other, at any time. Plugins are the modules that a registry of
plugins loads; numerics are modules that import nothing of the package but other numerics and ``core.types``. Of the modules with a
single importer the last figure counts those that could move into it: of one subject, at most 600 lines together, and not held
apart by the contract "Numerics know arrays only".
"""

from __future__ import annotations

import ast
import io
import json
import re
import sys
import tokenize
import tomllib
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "coeflab"
PLUGINS = (
    "coeflab.tables.importers.", "coeflab.bodies.readers.", "coeflab.bodies.added_mass.", "coeflab.motion.manoeuvres.",
    "coeflab.motion.simulators.", "coeflab.study.checks.", "coeflab.report.formats.",
)  # fmt: skip
PURE = {"coeflab.core.types"}
LONGEST = 600
WORDS = 5  # of a literal: from here on it is a text
COUNTS = ("lines", "texts")
LINES = Path(__file__).with_name("lines_of_code.toml")


def modules() -> dict[str, Path]:
    """Every module of the package by its dotted name."""
    out = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        out[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return out


def code_lines(text: str) -> set[int]:
    """Lines that hold code: no blank lines, no comments, no docstrings."""
    skipped: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            first = node.body[0] if node.body else None
            if (
                isinstance(first, ast.Expr)
                and isinstance(first.value, ast.Constant)
                and isinstance(first.value.value, str)
            ):
                skipped |= set(range(first.lineno, (first.end_lineno or first.lineno) + 1))
    found: set[int] = set()
    quiet = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in quiet:
            found |= set(range(token.start[0], token.end[0] + 1))
    return found - skipped


def texts(source: str) -> int:
    """Literals of five words or more: no docstrings; an f-string is one literal, whatever stands in its braces."""
    quiet: set[int] = set()
    found = 0
    for node in ast.walk(ast.parse(source)):  # breadth first: a docstring and an f-string come before their parts
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            quiet |= {id(s.value) for s in node.body[:1] if isinstance(s, ast.Expr)}
        parts = [node]
        if isinstance(node, ast.JoinedStr):
            parts = list(node.values)
            quiet |= set(map(id, parts))
        elif not isinstance(node, ast.Constant) or id(node) in quiet:
            continue
        text = " 0 ".join(p.value for p in parts if isinstance(p, ast.Constant) and isinstance(p.value, str))
        found += len(re.findall(r"[A-Za-z][A-Za-z'-]+", text)) >= WORDS
    return found


def imports(name: str, text: str, known: dict[str, Path]) -> tuple[set[str], set[int]]:
    """Modules of the package that a module imports, and the lines of all its imports."""
    targets: set[str] = set()
    lines: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            lines |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                targets.add(inner if inner in known else node.module)
        elif isinstance(node, ast.Import):
            targets |= {alias.name for alias in node.names}
    return {t for t in targets if t in known and t != name}, lines


def circles(graph: dict[str, set[str]]) -> list[list[str]]:
    """Strongly connected sets of more than one module (Tarjan 1972)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    out: list[list[str]] = []

    def visit(v: str) -> None:
        index[v] = low[v] = len(index)
        stack.append(v)
        for w in sorted(graph[v]):
            if w not in index:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in stack:
                low[v] = min(low[v], index[w])
        if low[v] == index[v]:
            cut = stack.index(v)
            members = stack[cut:]
            del stack[cut:]
            if len(members) > 1:
                out.append(sorted(members))

    for v in sorted(graph):
        if v not in index:
            visit(v)
    return out


def is_plugin(name: str) -> bool:
    """Whether a registry loads the module."""
    parts = name.split(".")
    return (
        name.startswith(PLUGINS)
        or (len(parts) == 3 and parts[1] == "fits")
        or (len(parts) == 4 and parts[1] == "formats" and parts[3] in ("write", "read"))
        or (len(parts) == 3 and parts[1] in ("cli", "published"))
    )


def contracted() -> tuple[str, ...]:
    """Folders and modules that import-linter holds to be numerics."""
    linted = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]["contracts"]
    return tuple(next(c["source_modules"] for c in linted if c["name"] == "Numerics know arrays only"))


def apart(name: str, importer: str, lines: int) -> str:
    """Why a module does not stand in the only file that imports it; empty where it could."""
    if name.startswith(contracted()):
        return "numerics by contract"
    if name.split(".")[1:2] != importer.split(".")[1:2]:
        return "another subject"
    return f"{lines} lines together" if lines > LONGEST else ""


def by_subject() -> dict[str, dict[str, int]]:
    """Lines of code and texts of every folder and file right below the package."""
    out: dict[str, dict[str, int]] = defaultdict(lambda: dict.fromkeys(COUNTS, 0))
    for name, path in modules().items():
        source = path.read_text(encoding="utf-8")
        row = out[[*name.split("."), "__init__"][1]]
        row["lines"] += len(code_lines(source))
        row["texts"] += texts(source)
    return dict(sorted(out.items()))


def grown(
    found: dict[str, dict[str, int]], table: dict[str, dict[str, int | str]]
) -> dict[str, dict[str, tuple[int, int]]]:
    """Subjects with a number above that of the table, each with both."""
    pairs = {s: {c: (n[c], int(table.get(s, {}).get(c, 0))) for c in COUNTS if c in n} for s, n in found.items()}
    return {s: over for s, both in pairs.items() if (over := {c: p for c, p in both.items() if p[0] > p[1]})}


def written(found: dict[str, dict[str, int]], table: dict[str, dict[str, int | str]], because: str) -> str:
    """The table of lines of code and texts with the numbers that fell, and with those that rose where a reason is given."""
    rose = grown(found, table)
    if rose and not because:
        raise SystemExit(f"More lines of code or texts in {', '.join(sorted(rose))}; --because states why.")
    out = [
        "# Lines of code, and texts outside of templates, a subject may have: they only fall. What rises states its reason "
        "(house.py --lines).\n"
    ]
    for name, n in found.items():
        reason = because if name in rose else str(table.get(name, {}).get("reason", ""))
        out.append(
            f"[{name}]\n"
            + "".join(f"{c} = {v}\n" for c, v in n.items())
            + f"reason = {json.dumps(reason)}\n" * bool(reason)
        )
    return "\n".join(out)


def main() -> None:
    """Print the figures."""
    if "--lines" in sys.argv:
        because = sys.argv[sys.argv.index("--because") + 1] if "--because" in sys.argv else ""
        table = tomllib.loads(LINES.read_text(encoding="utf-8")) if LINES.exists() else {}
        LINES.write_text(written(by_subject(), table, because), encoding="utf-8")
        return
    if "--texts" in sys.argv:
        counts = {name: texts(path.read_text(encoding="utf-8")) for name, path in modules().items()}
        for name, n in sorted(counts.items(), key=lambda item: -item[1]):
            sys.stdout.write(f"{n:5d} {name}\n" * bool(n))
        return
    known = modules()
    sources = {name: path.read_text(encoding="utf-8") for name, path in known.items()}
    found = {name: imports(name, text, known) for name, text in sources.items()}
    graph = {name: targets for name, (targets, _) in found.items()}
    code = {name: code_lines(text) for name, text in sources.items()}
    total = sum(map(len, code.values()))
    importing = sum(len(code[name] & lines) for name, (_, lines) in found.items())
    importers = defaultdict(set)
    for name, targets in graph.items():
        for target in targets:
            importers[target].add(name)
    pure = set(PURE)
    for _ in known:
        more = {n for n, t in graph.items() if (t and t <= pure) or (not t and "numpy" in sources[n])} | pure
        if more == pure:
            break
        pure = more
    single = [
        n for n in known
        if len(importers[n]) == 1 and known[n].name != "__init__.py" and not is_plugin(n) and n not in pure
    ]  # fmt: skip
    longest = sorted(((text.count("\n"), name) for name, text in sources.items()), reverse=True)
    round_trips = circles(graph)
    size = {name: n for n, name in longest}
    beside = {n: next(iter(importers[n])) for n in single}
    why = {n: apart(n, other, size[n] + size[other]) for n, other in beside.items()}
    sys.stdout.write(
        f"files                                   {len(known)}\n"
        f"lines                                   {sum(n for n, _ in longest)}\n"
        f"lines of code                           {total}\n"
        f"texts outside of templates              {sum(map(texts, sources.values()))}\n"
        f"imports, share of these                 {importing / total:.1%}\n"
        f"longest file                            {longest[0][0]} {longest[0][1]}\n"
        f"circles, modules in them                {len(round_trips)}, {sum(map(len, round_trips))}\n"
        f"modules with a single importer          {len(single)} (neither plugin nor numerics)\n"
        f"of these, that could stand in it         {list(why.values()).count('')}\n"
    )
    if "--list" in sys.argv:
        for circle in round_trips:
            sys.stdout.write(f"circle  {' '.join(circle)}\n")
        for n, name in longest[:12]:
            sys.stdout.write(f"long    {n} {name}\n")
        for name in single:
            sys.stdout.write(f"single  {name} <- {beside[name]}{f' ({why[name]})' if why[name] else ''}\n")


if __name__ == "__main__":
    main()
