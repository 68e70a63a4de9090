"""What differs between two folders of outputs: numbers to 1e-12 relative, and every changed text, SVG and name of a schema.

python benchmarks/compare_runs.py OLD NEW

Write both with the same commands before and after a change, for example ``coeflab validate suboff --out OLD/suboff`` and
``coeflab params schema --json > OLD/schema.json``. Numbers in changed files are compared one by one, in their order; where the
words between them differ too, the changed lines are listed. Of a JSON Schema the names in ``$defs`` are followed, so that a
definition that was only renamed is listed once. Exit code 1 where a number moved further than 1e-12, a file came or went, or a
schema differs beyond its names.
"""

from __future__ import annotations

import difflib
import json
import math
import re
import sys
from pathlib import Path
from typing import Any

RELATIVE = 1e-12
NUMBER = re.compile(r"(?<![A-Za-z_\d.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![A-Za-z_\d])")
SHOWN, WIDE = 12, 110
Name = tuple[str, str]


def files(folder: Path) -> dict[str, Path]:
    """Every file of a folder by its path in it."""
    return {p.relative_to(folder).as_posix(): p for p in sorted(folder.rglob("*")) if p.is_file()}


def apart(old: str, new: str) -> float:
    """Relative difference of two numbers as printed."""
    a, b = float(old), float(new)
    return 0.0 if a == b else abs(a - b) / max(abs(a), abs(b))


def moved(old: str, new: str) -> tuple[float, bool]:
    """Largest relative difference of the numbers of two texts, and whether their words are the same."""
    if NUMBER.sub("#", old) != NUMBER.sub("#", new):
        return math.nan, False
    pairs = zip(NUMBER.findall(old), NUMBER.findall(new), strict=True)
    return max((apart(a, b) for a, b in pairs), default=0.0), True


def lines(text: str) -> list[str]:
    """A text as lines; markup as one line a tag."""
    return re.sub(r"(?<=>)(?=[^\n])", "\n", text).splitlines()


def schema_differences(old: Any, new: Any) -> tuple[list[Name], list[str]]:
    """Definitions that were renamed, and places where two schemas differ beyond that; titles go with the names."""
    names: list[Name] = []
    found: list[str] = []

    def walk(a: Any, b: Any, place: str) -> None:
        if isinstance(a, dict) and isinstance(b, dict):
            found.extend(f"{place}/{k}" for k in sorted(set(a) ^ set(b)))
            for k in [k for k in a if k in b]:
                walk(a[k], b[k], f"{place}/{k}")
        elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
            for i, (x, y) in enumerate(zip(a, b, strict=True)):
                walk(x, y, f"{place}/{i}")
        elif isinstance(a, str) and isinstance(b, str) and a.startswith("#/$defs/") and b.startswith("#/$defs/"):
            name = a.removeprefix("#/$defs/"), b.removeprefix("#/$defs/")
            if name not in names:
                names.append(name)
                walk(*({**s["$defs"][n], "title": ""} for s, n in zip((old, new), name, strict=True)), f"{name[0]}")
        elif a != b:
            found.append(f"{place}: {a!r:.60} -> {b!r:.60}")

    walk(*({k: v for k, v in s.items() if k != "$defs"} for s in (old, new)), "")
    return [n for n in names if n[0] != n[1]], found


def is_schema(content: Any) -> bool:
    """Whether JSON content is a schema."""
    return isinstance(content, dict) and "$schema" in content and "$defs" in content


def compared(name: str, old: Path, new: Path) -> tuple[list[str], bool]:
    """Lines about one file that changed, and whether that is more than rounding, words and names."""
    try:
        a, b = old.read_text(encoding="utf-8"), new.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return [f"{name}: bytes differ, {old.stat().st_size} -> {new.stat().st_size}"], True
    if name.endswith(".json"):
        before, after = json.loads(a), json.loads(b)
        if is_schema(before) and is_schema(after):
            names, other = schema_differences(before, after)
            said = [f"{name}: $defs {x} is {y}" for x, y in names] + [f"{name}: {o}" for o in other]
            return said or [f"{name}: order of keys or blanks"], bool(other)
    largest, same_words = moved(a, b)
    if same_words:
        return [f"{name}: numbers within {largest:.1e} relative"], largest > RELATIVE
    out, further = [], False
    x, y = lines(a), lines(b)
    alike = [p == q for p, q in zip(x, y, strict=False)]
    head = alike.index(False) if False in alike else len(alike)
    tail = next(
        n for n in range(min(len(x), len(y)) - head + 1) if n == min(len(x), len(y)) - head or x[-n - 1] != y[-n - 1]
    )
    x, y = x[head : len(x) - tail], y[head : len(y) - tail]
    for kind, i, j, k, m in difflib.SequenceMatcher(None, x, y, autojunk=False).get_opcodes():
        if kind == "equal":
            continue
        pairs = zip(x[i:j], y[k:m], strict=False) if j - i == m - k else ()
        further |= any(moved(p, q)[0] > RELATIVE for p, q in pairs)
        out += [f"    - {t[:WIDE]}" for t in x[i:j]] + [f"    + {t[:WIDE]}" for t in y[k:m]]
    kept = out if len(out) <= SHOWN else [*out[:SHOWN], f"    and {len(out) - SHOWN} lines more"]
    what = "SVG" if name.endswith(".svg") else "text"
    return [f"{name}: {what} differs", *kept], further


def main(old: str, new: str) -> int:
    """Compare two folders, say what differs, and give the exit code."""
    ours, theirs = files(Path(old)), files(Path(new))
    said = [f"{n}: only in {old if n in ours else new}" for n in sorted(set(ours) ^ set(theirs))]
    wrong, same = bool(said), 0
    for name in [n for n in ours if n in theirs]:
        if ours[name].read_bytes() == theirs[name].read_bytes():
            same += 1
            continue
        found, further = compared(name, ours[name], theirs[name])
        said, wrong = said + found, wrong or further
    print("\n".join([*said, f"{same} files are the same, byte by byte"]))
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
