"""The conformance vectors: the library, and the reader of the documentation, give them; no rule of the page can be dropped unseen."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from coeflab.core.errors import InputError
from coeflab.core.finding import Severity, worst
from coeflab.core.texts import words
from coeflab.vehicle.conform import VectorSet, compared, conform, vector_sets
from coeflab.vehicle.parameter_file import ParameterFile
from tests.vehicle.make_conformance import cases, evaluated

ROOT = Path(__file__).parents[2]
READER = ROOT / "docs" / "reference" / "reader.py"
SETS = {s.name: s for s in vector_sets()}

# By rule: what the reader has, and what it would have without the rule.
DROPPED = {
    1: ('k = 2 + (symbol[0] in "KMN") + sum(', "k = 2 + sum("),
    2: ('if c["value"] is None:', "c = {**c, 'value': c['value'] or -0.01}\n            if False:"),
    3: ('if c.get("law") == "rest"', 'if c.get("law") == "never"'),
    4: ("course = max(-1.0, min(1.0, 10.0 * u / slow)) if", "course = 1.0 if"),
    5: ("slow = max(speed, SLOW)", "slow = speed + 1e-3"),
    6: ("max(-limits.get(c, x), min(limits.get(c, x), x)) if c in limits else x for", "x for"),
    7: ("self.terms = [t for t in self.terms if t not in rivals]", "pass"),
    8: ("if rivals and set()", "if False and set()"),
    9: ("self.tables.remove(a if va < vb else b)", "pass"),
    10: ("and need <= moved(", "and set() <= moved("),
    11: ("math.asin(max(-1.0, min(1.0, v / speed)))", "math.atan2(v, u)"),
    12: ("out += [] if body else [i]", "out += [i]"),
    13: ('"D": (-ca * cb, -sb,', '"D": (-ca * cb, 0.0,'),
    14: ("self.open.discard((BODY.index(c), *pair))", "pass"),
    15: ("self.open -= {(i, j, k) for i in on", "self.open -= {(i, j, k) for i in []"),
    16: ('if m.get("contains_potential", True)', "if True"),
    17: ("(1.0 if n in \"uvw\" else self.length) / slow", "(1.0 if n in \"uvw\" else 1.0) / slow"),
    18: ("* (self.length if place in", "* (1.0 if place in"),
    19: ("for k in range(len(x)) for c", "for k in range(1) for c"),
    20: ("size = [b - a if b > a else 1.0 for a, b in zip(low, high)]", "size = [1.0] * len(low)"),
    21: ('== "refuse" and (speed', '== "never" and (speed'),
    22: ('if domain["extrapolation"] == "taper" else 0.0, False', "* 0.0, False"),
    23: ('ratio = self.rho / hull["density"] if hull', "ratio = 1.0 if hull"),
    24: ('= -c["value"] * unit', '= c["value"] * unit'),
    25: ("(x + stated.get((j, i), x)) / 2.0", "x"),
    26: ('[mass["mass_moment"] / m, 0.0, 0.0]', "[0.0, 0.0, 0.0]"),
    27: ("if not fits(added)", "if False"),
    28: ('h, m = self.f.get("hydrostatics")', 'h, m = self.f.get("nothing")'),
    29: ('x = min(max(x, parts[0]["low"]), parts[-1]["high"])', "pass"),
    30: ("c, s, on = math.cos(angle), math.sin(angle)", "c, s, on = math.cos(angle), -math.sin(angle)"),
    31: ('if t.get("lag") and "since" in state', "if False"),
}  # fmt: skip
ALSO = {
    "(12) what is over nothing speaks of no incidence": ("moved(n for n, _, _ in t[3]) == made for", "moved(n for n, _, _ in t[3]) <= made for"),
    "(12) of the product that the turn makes": ("set(TURNS[place + c])", "set()"),
    "(12) and of no other over v and w": ("moved(n for n, _, _ in t[3]) == made for", 'moved(n for n, _, _ in t[3]) <= {"v", "w"} for'),
    "(12) tables along the body too": ("body = body or any(self.place(o) == c", "body = body or any(False"),
    "(12) with what the table needs": ("made = self.over(m)[0] | set(", "made = set() | set("),
    "(4) by U^2 alone, no control in it": ('c == "X" and not factors', 'c == "X" and all(n in CONTROLS for n, _, _ in factors)'),
    "(5) of a floor at rest": ("slow = max(speed, SLOW)", "slow = max(speed, 1e-12)"),
    "(8) without a rival nothing is left out": ("if rivals and set()", "if set()"),
    "(11) whatever U": ("if speed > 0.0 else 0.0", "if speed > SLOW else 0.0"),
    "(11) zeros below zero": ("math.atan2(w + 0.0, u + 0.0)", "math.atan2(w, u)"),
    "(14) n of damping at rest is none": ("if plain and len(names) + power == 2", "power = 2 - len(names)\n            if plain"),
    "(14) controls close none": ("any(a or n in CONTROLS for n, _, a in factors)", "any(a for n, _, a in factors)"),
    "(15) products without what it needs": ("for j in at for k in at}", "for j in at for k in at if need <= moved((MOTION[j], MOTION[k]))}"),
    "(15) in every component": ("for i in on for j", "for i in on[:1] for j"),
    "(15) in none that it does not act in": ("for i in on for j", "for i in (on if on[0] > 2 else range(3)) for j"),
    "(15) with u": ("at = [0] + [", "at = ["),
    "(16) an increment closes none": (" and not need & set(CONTROLS):", ":"),
    "(19) 1e-9 to spare": ("<= 1e-9 * max(1.0, abs(s[-1])) for", "<= 0.0 for"),
    "(19) of b": ("1e-9 * max(1.0, abs(s[-1]))", "1e-9"),
    "(21) where no term is determined": ("for m, on in zip(self.tables, self.on):\n            names", 'for m, on in zip(self.tables, self.on):\n            if all(t["value"] is None for t in m["terms"]):\n                continue\n            names'),
    "(22) off a variable of no width": ("any(v != w and a == b for", "any(False for"),
    "(24) an acceleration of zero": ('= -c["value"] * unit', '= -c["value"] * unit or 1.0'),
    "(27) nothing accelerates": ("or not self.moves or", "or"),
    "(27) unknown inertia": ("and definite(whole, range(6), 1e-9)", ""),
    "(28) standard gravity": ('h.get("gravity", 9.80665)', 'h.get("gravity", 9.81)'),
    "(29) the first of two segments": ('if s["low"] <= x <= s["high"]][:1]', 'if s["low"] <= x <= s["high"]][-1:]'),
    "product of an added mass by U or u, closed": ("pair = sorted([0] * power + [", "pair = sorted([1] * power + ["),
    "free continuation in the taper": ("unit * (sums[0] + free", "unit * (sums[1] + 0.0 * free"),
    "no table refuses at rest": (" and (speed > SLOW or m[\"unit\"] != \"1\")", ""),
    "torque by handedness": ('torque = t.get("handedness", 1) *', "torque = 1.0 *"),
    "dead zone": ('if s["low"] <= x <= s["high"]][:1]', "][:1]"),
    "tilt limits": ('max(commands.get(t["name"] + ".tilt", 0.0), t.get("tilt_low", 0.0)), t.get("tilt_high", 0.0)',
                    'commands.get(t["name"] + ".tilt", 0.0), 9.0'),
    "no ideal fluid without an added mass": ('if self.f.get("added_mass") else set()', ""),
    "rigid body's own momentum": ("zip(force, wrench, rest, pushed(self.rigid, nu))", "zip(force, wrench, rest)"),
    "an undetermined term is none": ('if t["value"] is not None)', 'if t.update(value=t["value"] or 1.0) is None)'),
}  # fmt: skip


def read(text: str, given: VectorSet) -> list[dict[str, Any]]:
    space: dict[str, Any] = {"__name__": "reader"}
    exec(compile(text, str(READER), "exec"), space)
    vehicle = space["Vehicle"](json.loads(json.dumps(given.parameters)))
    return [vehicle.answer(state) for state in given.states]


def misses(text: str) -> int:
    """In how many sets a reader misses."""
    out = 0
    for s in SETS.values():
        try:
            out += worst(compared(s, read(text, s))) is Severity.FAIL
        except (ValueError, ZeroDivisionError, KeyError, TypeError):
            out += 1
    return out


@pytest.mark.parametrize("name", SETS)
def test_the_library_gives_the_vectors(name: str) -> None:
    given = SETS[name]
    file = ParameterFile.model_validate_json(json.dumps(given.parameters))
    (found,) = compared(given, [evaluated(file, s) for s in given.states])
    assert found.severity is Severity.PASS, words(found)


def test_the_vectors_are_those_of_their_cases() -> None:
    made = cases()
    assert set(made) == set(SETS)
    assert all(json.loads(json.dumps(given)) == SETS[name].states for name, (_, _, given) in made.items())


def test_states_ahead_astern_broadside_at_rest_and_outside() -> None:
    for s in SETS.values():
        nu = [v["nu"] for v in s.vectors]
        assert any(n[0] > 0.0 for n in nu)
        assert any(n[0] < 0.0 for n in nu)
        assert any(n[0] == 0.0 and n[1] for n in nu)
        assert any(not any(n) for n in nu)
    assert any(v["force"] is None for v in SETS["refusals"].vectors)


@pytest.mark.parametrize("rule", DROPPED)
def test_no_rule_is_dropped_unseen(rule: int) -> None:
    text, (old, new) = READER.read_text(encoding="utf-8"), DROPPED[rule]
    assert text.count(old) == 1
    assert f"({rule})" in text
    assert misses(text.replace(old, new)) > 0


@pytest.mark.parametrize("rule", ALSO)
def test_no_part_of_a_rule_is_dropped_unseen(rule: str) -> None:
    text, (old, new) = READER.read_text(encoding="utf-8"), ALSO[rule]
    assert text.count(old) == 1
    assert misses(text.replace(old, new)) > 0


def test_the_reader_alone_passes_as_a_program() -> None:
    found = conform([sys.executable, "-I", "-S", str(READER)])
    assert len(found) == len(SETS) >= 10
    assert worst(found) is Severity.PASS
    assert "coeflab" not in READER.read_text(encoding="utf-8").split('"""')[2]


def test_what_is_no_answer_is_said() -> None:
    assert {f.code for f in conform([sys.executable, "-c", "print(1)"])} == {"conform.not_run"}
    with pytest.raises(InputError, match="no-such-program-there"):
        conform(["no-such-program-there"])
    given = SETS["torpedo"]
    assert compared(given, [])[0].code == "conform.count"
    right = [{k: v[k] for k in ("force", "acceleration")} for v in given.vectors]
    assert compared(given, right)[0].code == "conform.met"
    force = [x * (1.0 + 1e-9) for x in right[3]["force"]]
    (found,) = compared(given, [*right[:3], {**right[3], "force": force}, *right[4:]])
    assert (found.code, found["vector"], found["furthest_vector"]) == ("conform.missed", 3, 3)
    assert "nu" in found["state"]
    further = {**right[5], "acceleration": [x + 1.0 for x in right[5]["acceleration"]]}
    (found,) = compared(given, [*right[:3], {**right[3], "force": force}, right[4], further, *right[6:]])
    assert (found["vector"], found["furthest_vector"]) == (3, 5)
    (found,) = compared(given, [{**right[0], "force": None}, *right[1:]])
    assert (found.code, found["which"]) == ("conform.none", "none_found")
    for odd in (
        {"forces": force, "acceleration": None},
        {**right[0], "force": force[:5]},
        {**right[0], "force": ["1"] * 6},
        7,
        None,
    ):
        (found,) = compared(given, [odd, *right[1:]])
        assert (found.code, found["vector"]) == ("conform.shape", 0)


def test_every_rule_stands_on_the_page() -> None:
    page = (ROOT / "docs" / "force_law.md").read_text(encoding="utf-8")
    assert all(f"({rule})" in page for rule in DROPPED)
