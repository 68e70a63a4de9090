"""Conformance vectors of the force law, and whether somebody's implementation gives them.

``conformance/NAME.json`` holds ``parameters``, a parameter file, and ``vectors``: states with their ``force``, X Y Z K M N of the
water, and ``acceleration``, the rates of u v w p q r; null where the law has none. docs/force_law.md is the law.
"""

from __future__ import annotations

import json
import math
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.text.bounded import own_bytes
from coeflab.core.text.json import parse_json

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


def compared(
    given: VectorSet, answers: Sequence[Mapping[str, Any]], tolerance: float = TOLERANCE
) -> tuple[Finding, ...]:
    """One finding a set: passed, or the first vector that is missed and the worst difference.

    Parameters
    ----------
    given : VectorSet
    answers : sequence of mapping
        ``force`` and ``acceleration`` of every state; six numbers, or null.
    tolerance : float
        Of the largest force or moment, and of the largest rate, in the set.
    """
    if len(answers) != len(given.vectors):
        return (_fails(given, "conform.count", statistic=len(answers), threshold=len(given.vectors)),)
    worst = 0.0
    missed: list[tuple[int, str, float, float]] = []
    for key in ANSWERS:
        scale = [
            max((abs(v[key][i]) for v in given.vectors if v[key] is not None for i in group), default=0.0) or 1.0
            for group in ((0, 1, 2), (3, 4, 5))
        ]
        for n, (v, a) in enumerate(zip(given.vectors, answers, strict=True)):
            due, found = v[key], _six(a.get(key) if isinstance(a, Mapping) else None)
            if due is None or found is None:
                if (due is None) != (found is None):
                    missed.append((n, key, math.nan, math.nan))
                    worst = math.inf
                continue
            for i in range(6):
                away = abs(found[i] - due[i]) / scale[i // 3]
                away = math.inf if math.isnan(away) else away
                worst = max(worst, away)
                if away > tolerance:
                    missed.append((n, f"{key} {WHERE[key][i]}", due[i], found[i]))
    if missed:
        n, what, wanted, given_number = missed[0]
        number = worst if math.isfinite(worst) else None
        if math.isnan(wanted):
            return (_fails(given, "conform.none", number, tolerance, vector=n, what=what, count=len(missed)),)
        return (
            _fails(
                given,
                "conform.missed",
                number,
                tolerance,
                vector=n,
                what=what,
                due=wanted,
                found=given_number,
                count=len(missed),
            ),
        )
    return (
        Finding.of(
            "conform.met", given.name, Severity.PASS, statistic=worst, threshold=tolerance, vectors=len(given.vectors)
        ),
    )


def _six(value: Any) -> list[float] | None:
    """Six numbers; None for anything else."""
    if (
        not isinstance(value, list)
        or len(value) != 6
        or any(isinstance(x, bool) or not isinstance(x, int | float) for x in value)
    ):
        return None
    return [float(x) for x in value]


def _fails(
    given: VectorSet, code: str, statistic: float | None = None, threshold: float | None = None, **facts: Any
) -> Finding:
    return Finding.of(
        code, given.name, Severity.FAIL, statistic=statistic, threshold=threshold, rules=given.rules, **facts
    )


def conform(command: Sequence[str], tolerance: float = TOLERANCE) -> tuple[Finding, ...]:
    """Run a program on every set: ``COMMAND FILE.parameters.json``, states on its standard input, answers on its standard output.

    Parameters
    ----------
    command : sequence of str
        Program and arguments.
    tolerance : float
    """
    out: list[Finding] = []
    with tempfile.TemporaryDirectory() as folder:
        for s in vector_sets():
            path = Path(folder) / f"{s.name}.parameters.json"
            path.write_text(json.dumps(s.parameters), encoding="utf-8")
            try:
                done = subprocess.run(
                    [*command, str(path)], input=json.dumps(s.states), capture_output=True, text=True, timeout=LONGEST, check=False,
                )  # fmt: skip
                answers = parse_json(done.stdout) if done.returncode == 0 else None
            except (OSError, ValueError, InputError, subprocess.TimeoutExpired) as why:
                out.append(_fails(s, "conform.not_run", why=type(why).__name__))
                continue
            if not isinstance(answers, list):
                last = (done.stderr.strip().splitlines() or [""])[-1][:200]
                out.append(_fails(s, "conform.not_run", why=last or f"exit code {done.returncode}"))
                continue
            out += compared(s, answers, tolerance)
    return tuple(out)
