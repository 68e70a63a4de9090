"""Small files and options that ask for hours or terabytes: refused by name and reason, in two seconds and 300 MB."""

from __future__ import annotations

import json
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.mesh.declared_faces import glb_faces, obj_faces, stl_faces
from coeflab.core import limits
from coeflab.core.errors import InputError
from coeflab.core.text.delimited import read_cells
from coeflab.core.text.json import parse_json
from coeflab.core.text.toml import read_toml
from coeflab.core.text.xml import parse_xml
from coeflab.core.text.yaml import parse_yaml
from coeflab.formats.uuv_simulator.xacro import Xacro
from coeflab.motion.uncertainty.sobol import drawn_counts
from coeflab.vehicle.parameter_file import read_parameter_file
from tests.cli.conftest import COEFLAB, Run

SAMPLE = json.loads((Path(__file__).parents[1] / "data" / "parameters_1_3.json").read_text())
# Reading in a process of its own, which measures itself; the memory of Python and the libraries (70 to 130 MB) is in it.
MEASURED = """
import resource, sys, time
from pathlib import Path
from coeflab.core.errors import CoeflabError
{imports}
resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
begun = time.process_time()
try:
    {call}
except CoeflabError as why:
    print(why)
print(time.process_time() - begun, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""
# A process counts the memory of the one that it was forked from, so that a small one has to stand between.
SMALL = "import subprocess, sys; sys.exit(subprocess.run(sys.argv[1:]).returncode)"


def measured(imports: str, call: str, path: Path) -> str:
    """What was said of a file, within the bounds on time and memory."""
    script = MEASURED.format(imports=imports, call=call)
    command = [sys.executable, "-c", SMALL, sys.executable, "-c", script, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=100)
    assert done.returncode == 0, done.stderr
    *said, last = done.stdout.splitlines()
    seconds, kilobytes = map(float, last.split())
    assert seconds < 2.0
    assert kilobytes < 300 << 10
    return "\n".join(said)


def with_many(key: str, item: object, count: int) -> bytes:
    return json.dumps({**SAMPLE, key: [item] * count}, separators=(",", ":")).encode()


def scene(nodes: list[dict[str, object]]) -> bytes:
    """A GLB of one triangle that stands at every node that names it."""
    held = struct.pack("<9f3Hxx", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2)
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}]
    described = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "bufferViews": views,
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "buffers": [{"byteLength": len(held)}],
    }  # fmt: skip
    text = json.dumps(described).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(held), b"BIN\0") + held
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


PARAMETERS = "from coeflab.vehicle.parameter_file import read_parameter_file", "read_parameter_file(Path(sys.argv[1]))"
TOML = "from coeflab.core.text.toml import read_toml", "read_toml(Path(sys.argv[1]))"
MESH = "from coeflab.bodies.mesh.file import load", "load(Path(sys.argv[1]))"
BOMBS = {
    "coefficients.json": (PARAMETERS, lambda: with_many("coefficients", {}, 500_000), "500,0.. objects"),
    "covered.json": (PARAMETERS, lambda: with_many("covered", {}, 49_000), "covered.0.variable"),
    "lists.json": (PARAMETERS, lambda: with_many("models", [], 4_000_000), "values"),
    "dotted.toml": (TOML, lambda: b".".join([b"a"] * 50_000) + b" = 1\n", "line 1: found a dotted key"),
    "header.toml": (TOML, lambda: b"x = 1\n[" + b".".join([b"'a'"] * 50_000) + b"]\n", "line 2: found a dotted key"),
    "tables.toml": (TOML, lambda: b"[[a]]\n" * 170_000, "169,999 tables"),
    "nested.glb": (
        MESH, lambda: scene([*({"children": [k + 1], "mesh": 0} for k in range(3000)), {"mesh": 0}]), "40 deep",
    ),
    "blank.obj": (MESH, lambda: b"\n" * 300_000, "no vertices"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_is_refused_in_two_seconds_and_300_megabytes(name: str, tmp_path: Path) -> None:
    """Before: 32 s and 5.3 GB; 11 s and 3.1 GB; 5 s and 1.2 GB; over 27 s and 5.8 GB; 3 s; 2 s; over 100 s; over 100 s."""
    import re

    (imports, call), content, said = BOMBS[name]
    path = tmp_path / name
    path.write_bytes(content())
    message = measured(imports, call, path)
    assert name in message
    assert re.search(said, message), message


@pytest.mark.slow
def test_the_21_kilobyte_key_as_a_command(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "plan.toml").write_bytes(b".".join([b"a"] * 10_500) + b" = 1\n")
    done = coeflab("run", "plan.toml")
    assert done.returncode == 2
    assert "plan.toml, line 1: found a dotted key of many names" in done.stderr


def refused(said: str, *, what: object) -> None:
    with pytest.raises(InputError, match=said):
        what()  # type: ignore[operator]


def test_what_is_counted_before_it_is_parsed(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_text(".".join("a" * (limits.TOML_NAMES_IN_A_KEY + 1)) + " = 1")
    refused("dotted key", what=lambda: read_toml(path))
    path.write_text(".".join("a" * limits.TOML_NAMES_IN_A_KEY) + " = 1")
    assert "a" in read_toml(path).content
    path.write_text("a = [" + ", ".join(["1.5"] * 10_000) + "]")
    assert len(read_toml(path).content["a"]) == 10_000
    refused("JSON, at most 150 levels", what=lambda: parse_json("[" * 151 + "]" * 151))
    assert parse_json('["' + "[" * 200 + '"]') == ["[" * 200]
    refused("2001 keys in one object", what=lambda: parse_json(json.dumps(dict.fromkeys(map(str, range(2001)), 0))))
    refused("integer of 4,301 digits", what=lambda: parse_json("9" * 4301))
    refused("number of 20000 letters", what=lambda: parse_yaml("a: " + "1:" * 9999 + "11"))
    many = "".join(
        f'<property xmlns="http://www.ros.org/wiki/xacro" name="p{k}" value="{"x" * 60_000}"/>' for k in range(1)
    )
    unfolding = Xacro(parse_xml(f"<robot>{many}</robot>"))
    refused("unfold to", what=lambda: [unfolding.text(f"${{p0}}{k}") for k in range(200)])


def test_a_file_of_blank_lines_is_read_line_by_line(tmp_path: Path) -> None:
    """Patterns that skip blanks at the start of a line looked at every later line from each of them: minutes for 300 kB."""
    for name, faces in (("x.obj", obj_faces), ("x.stl", stl_faces)):
        (tmp_path / name).write_bytes(b"solid x\nfacet\n" * (name == "x.stl") + b"\n" * 300_000)
        with pytest.raises(InputError):
            faces(tmp_path / name)


def test_scenes_of_usual_depth_are_read(tmp_path: Path) -> None:
    path = tmp_path / "x.glb"
    path.write_bytes(scene([*({"children": [k + 1]} for k in range(limits.GLB_DEEPEST - 1)), {"mesh": 0}]))
    assert glb_faces(path) == 1


@pytest.mark.parametrize(
    ("option", "said"),
    [
        (("--record", "1e-9"), '"record": found 6e+10 rows of a motion; expected at most 1,000,000'),
        (("--record", "1e-320"), "rows of a motion"),
        (("--integrator", "rk4", "--record", "1e-9"), "rows of a motion"),
        (("--integrator", "rk4", "--step", "1e-9"), "steps of 1e-09 s"),
        (("--integrator", "rk4", "--step", "1e-320"), "steps of"),
        (("--duration", "1e6", "--record", "0.1"), "1e+07 rows of a motion"),
    ],
)
def test_motions_of_too_many_rows(coeflab: Run, option: tuple[str, ...], said: str) -> None:
    """Before: MemoryError at 4.4 TiB, OverflowError."""
    sample = Path(__file__).parents[1] / "data" / "parameters_1_3.json"
    done = coeflab("simulate", sample, "--manoeuvre", "straight_run", "--hold", "u", *option)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert said in done.stderr


def test_an_option_has_a_bound_that_the_plan_is_named_for(coeflab: Run, tmp_path: Path) -> None:
    coeflab("new", "s")
    plan = tmp_path / "s" / "plan.toml"
    plan.write_text(
        plan.read_text()
        .replace("# largest_angle = 12.0", "largest_angle = 1000000")
        .replace("# [table.options.slope", "[table.options.slope")
    )
    done = coeflab("run", plan)
    assert done.returncode == 2
    for text in ("plan.toml", "largest_angle", '"1000000"', "1 to 90"):
        assert text in done.stderr, done.stderr


def test_pieces_draw_what_the_whole_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    (whole,) = drawn_counts(13, 1050, 3)
    monkeypatch.setattr("coeflab.motion.uncertainty.sobol.TOGETHER", 13 * 100)
    found = list(drawn_counts(13, 1050, 3))
    assert [len(c) for c in found] == [100] * 10 + [50]
    assert np.array_equal(np.vstack(found), whole)


@pytest.mark.slow
def test_a_hundred_thousand_rows_are_read(tmp_path: Path) -> None:
    rows = "".join(f"{k % 24 - 12},{k % 7},{k % 11}.5,{k % 13}\n" for k in range(100_000))
    (tmp_path / "t.csv").write_text("beta [deg],X [N],Y [N],N [N*m]\n" + rows)
    cells = read_cells(tmp_path / "t.csv")
    assert cells.numbers("Y").shape == (100_000,)
    box, point = [[1, 0, -1], [-1, 0, 0], [0, 1, -1], [0, -1, 0]], [0.1, 0.2, -1.0]
    table = {
        "response": "Y'", "unit": "1", "form": "line", "variables": [{"name": "v", "unit": "1"}, {"name": "r", "unit": "1"}],
        "terms": [{"symbol": "Yv", "factors": [{"variable": "v", "power": 1}], "value": 1.0, "half_width_95": 0.1}],
        "covariance": [[0.0025]], "domain": {"low": [0, 0], "high": [1, 1], "half_spaces": box + [point] * (100_000 - len(box)),
        "extrapolation": "refuse"}, "n_points": 9, "rms": 0.1, "press_rms": None, "table": "t", "campaign": "c",
    }  # fmt: skip
    (tmp_path / "p.json").write_text(json.dumps({**SAMPLE, "models": [table]}))
    assert len(read_parameter_file(tmp_path / "p.json").models[0].domain.half_spaces) == 100_000
    assert COEFLAB.exists()
