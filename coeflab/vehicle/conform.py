"""Conformance vectors of the force law, and whether somebody's implementation gives them.

``conformance/NAME.json`` holds ``parameters``, a parameter file, and ``vectors``: states with their ``force``, X Y Z K M N of the
water, and ``acceleration``, the rates of u v w p q r; null where the law has none. docs/force_law.md is the law.
"""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.files import write_all
from coeflab.core.finding import Finding, Severity
from coeflab.core.text.bounded import own_bytes
from coeflab.core.text.json import parse_json
from coeflab.core.wording import one_line

FOLDER = Path(__file__).with_name("conformance")
TOLERANCE = 1e-12  # of the largest force, or moment, of a file; of the largest rate
LONGEST = 60.0  # s, of one file
ANSWERS = ("force", "acceleration")
WHERE = {"force": "XYZKMN", "acceleration": "uvwpqr"}


@dataclass(frozen=True, slots=True)
class VectorSet:
    """The vectors of one parameter file.

    Attributes
    ----------
    name, rules : str
        Of the file; what it is for.
    parameters : mapping
        The parameter file.
    vectors : tuple of mapping
    """

    name: str
    rules: str
    parameters: Mapping[str, Any]
    vectors: tuple[Mapping[str, Any], ...]

    @property
    def states(self) -> list[dict[str, Any]]:
        """The vectors without their answers."""
        return [{k: x for k, x in v.items() if k not in ANSWERS} for v in self.vectors]


def vector_sets() -> tuple[VectorSet, ...]:
    """Every set, by name.

    Examples
    --------
    >>> [s.name for s in vector_sets()][:2]
    ['accelerations', 'at_rest']
    """
    out = []
    for path in sorted(FOLDER.glob("*.json")):
        content = parse_json(own_bytes(path).decode())
        out.append(VectorSet(path.stem, content["rules"], content["parameters"], tuple(content["vectors"])))
    return tuple(out)


def compared(given: VectorSet, answers: Sequence[Any], tolerance: float = TOLERANCE) -> tuple[Finding, ...]:
    """One finding a set: passed, or the first vector that is missed and the furthest.

    Parameters
    ----------
    given : VectorSet
    answers : sequence
        Of every state an object with ``force`` and ``acceleration``; six numbers, or null.
    tolerance : float
        Of the largest force or moment, and of the largest rate of either kind, in the set.
    """
    if len(answers) != len(given.vectors):
        return (_fails(given, "conform.count", statistic=len(answers), threshold=len(given.vectors)),)
    missed: list[tuple[int, int, str, Any, Any, float]] = []  # vector, place, what, due, found, how far
    worst = 0.0
    for place, key in enumerate(ANSWERS):
        scale = [
            max((abs(v[key][i]) for v in given.vectors if v[key] is not None for i in group), default=0.0) or 1.0
            for group in ((0, 1, 2), (3, 4, 5))
        ]
        for n, (v, a) in enumerate(zip(given.vectors, answers, strict=True)):
            due = v[key]
            if not isinstance(a, Mapping) or key not in a or not (a[key] is None or _six(a[key])):
                found = a.get(key, f"no {key}") if isinstance(a, Mapping) else a
                return (_fails(given, "conform.shape", None, None, vector=n, key=key, found=shown(found)),)
            found = a[key]
            if due is None or found is None:
                if due is not found:
                    missed.append((n, place, key, due, found, math.inf))
                continue
            for i in range(6):
                away = abs(found[i] - due[i]) / scale[i // 3]
                worst = max(worst, away)
                if away > tolerance:
                    missed.append((n, place, f"{key} {WHERE[key][i]}", due[i], found[i], away))
    if not missed:
        return (
            Finding.of(
                "conform.met", given.name, Severity.PASS, statistic=worst, threshold=tolerance, vectors=len(given.vectors)
            ),
        )  # fmt: skip
    n, _, what, wanted, found, _ = min(missed, key=lambda m: m[:2])
    far = max(missed, key=lambda m: m[-1])
    state = ", ".join(f"{k} {json.dumps(x)}" for k, x in given.states[n].items())
    facts = {"vector": n, "what": what, "state": state, "count": len(missed)}
    if wanted is None or found is None:
        which = "none_due" if wanted is None else "none_found"
        return (_fails(given, "conform.none", None, tolerance, which=which, **facts),)
    return (
        _fails(
            given, "conform.missed", worst, tolerance, due=wanted, found=float(found), furthest=far[2], furthest_vector=far[0], **facts
        ),
    )  # fmt: skip


def _six(value: Any) -> bool:
    """Whether a value is six numbers."""
    return (
        isinstance(value, list)
        and len(value) == 6
        and all(isinstance(x, int | float) and not isinstance(x, bool) and math.isfinite(x) for x in value)
    )


def _fails(
    given: VectorSet, code: str, statistic: float | None = None, threshold: float | None = None, **facts: Any
) -> Finding:
    return Finding.of(
        code, given.name, Severity.FAIL, statistic=statistic, threshold=threshold, rules=given.rules, **facts
    )


def as_files() -> dict[str, bytes]:
    """Parameter file, states and answers due of every set, by the names of their files."""
    out: dict[str, bytes] = {}
    for s in vector_sets():
        due = [{k: v[k] for k in ANSWERS} for v in s.vectors]
        for name, content in (("parameters", s.parameters), ("states", s.states), ("answers", due)):
            out[f"{s.name}.{name}.json"] = json.dumps(content, indent=1).encode()
    return out


def conform(command: Sequence[str], tolerance: float = TOLERANCE, folder: Path | None = None) -> tuple[Finding, ...]:
    """Run a program on every set: ``COMMAND FILE.parameters.json``, states on its standard input, answers on its standard output.

    Parameters
    ----------
    command : sequence of str
        Program and arguments.
    tolerance : float
    folder : Path, optional
        Where files, states and answers go first.

    Raises
    ------
    InputError
        There is no such program.
    """
    if shutil.which(command[0]) is None:
        raise InputError(shown(command[0]), "a program that can be run", column="COMMAND")
    if folder is not None:
        write_all(folder, as_files())
    out: list[Finding] = []
    with tempfile.TemporaryDirectory() as apart:
        for s in vector_sets():
            path = Path(apart) / f"{s.name}.parameters.json"
            path.write_text(json.dumps(s.parameters), encoding="utf-8")
            try:
                done = subprocess.run(
                    [*command, str(path)], input=json.dumps(s.states), capture_output=True, text=True, timeout=LONGEST, check=False,
                )  # fmt: skip
                answers = parse_json(done.stdout) if done.returncode == 0 else None
            except subprocess.TimeoutExpired:
                out.append(_fails(s, "conform.not_run", why=f"it did not end within {LONGEST:g} s"))
                continue
            except (OSError, ValueError, InputError) as why:
                out.append(
                    _fails(
                        s, "conform.not_run", why=one_line(why.found if isinstance(why, InputError) else str(why))[:200]
                    )
                )
                continue
            if not isinstance(answers, list):
                last = (done.stderr.strip().splitlines() or [""])[-1][:200]
                short = shown(answers) if done.returncode == 0 else last or f"exit code {done.returncode}"
                out.append(_fails(s, "conform.not_run", why=short))
                continue
            out += compared(s, answers, tolerance)
    return tuple(out)
