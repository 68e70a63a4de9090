"""Tables as code: Octave and the vehicle class, run, give the law of the file, inside and outside of the data."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from coeflab.formats.export import export
from coeflab.formats.mss import write as mss
from coeflab.formats.python_vehicle_simulator import write as pvs
from coeflab.vehicle.conform import vector_sets
from coeflab.vehicle.parameter_file import ParameterFile

NAMES = (
    "huuv_5dof",
    "domains",
    "overlaps",
    "refusals",
    "refusal_at_rest",
    "turned",
    "along_the_body",
    "along_a_table",
    "edges",
)
SETS = {s.name: s for s in vector_sets() if s.name in NAMES}
OCTAVE = shutil.which("octave-cli")


def of(name: str) -> tuple[ParameterFile, np.ndarray, np.ndarray, np.ndarray]:
    s = SETS[name]
    file = ParameterFile.model_validate_json(json.dumps(s.parameters)).model_copy(update={"name": f"v_{name}"})
    nu = np.array([v["nu"] for v in s.vectors], dtype=float)
    delta = np.array([v.get("delta", [0.0] * 3) for v in s.vectors])
    due = np.array([v["force"] if v["force"] is not None else [np.nan] * 6 for v in s.vectors])
    return file, nu, delta, due


def same(found: np.ndarray, due: np.ndarray) -> None:
    scale = np.repeat([np.nanmax(np.abs(due[:, :3])), np.nanmax(np.abs(due[:, 3:]))], 3)
    np.testing.assert_array_equal(np.isnan(found), np.isnan(due))
    assert np.nanmax(np.abs(found - due) / np.where(scale > 0.0, scale, 1.0)) < 1e-10  # U is never below 1e-9 m/s there


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("target", ["mss", "python_vehicle_simulator"])
def test_tables_are_held(target: str, name: str) -> None:
    loss = export(of(name)[0], target).loss
    assert not any("C_D" in x.what for x in loss.lost)
    assert loss.forces.furthest[1] < 1e-9
    assert loss.rare.furthest[1] < 1e-9


@pytest.mark.skipif(OCTAVE is None, reason="no Octave")
def test_octave_gives_the_law(tmp_path: Path) -> None:
    script = ["1;"]
    for name in NAMES:
        file, nu, delta, _ = of(name)
        for written, content in mss.render(file).items():
            (tmp_path / written).write_bytes(content)
        rows = np.column_stack([nu, delta]).tolist()
        script += [f"rows = [{'; '.join(' '.join(map(repr, r)) for r in rows)}];", "for k = 1:size(rows,1)"]
        script += [f"printf('%.17g ', v_{name}(rows(k,1:6)', rows(k,7:9)')); printf('\\n');", "end"]
    (tmp_path / "run.m").write_text("\n".join(script), encoding="utf-8")
    done = subprocess.run(
        [str(OCTAVE), "--norc", "--quiet", "run.m"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    lines = iter(done.stdout.splitlines())
    for name in NAMES:
        due = of(name)[3]
        same(np.array([[float(x) for x in next(lines).split()] for _ in due]), due)


@pytest.mark.parametrize("name", NAMES)
def test_the_class_gives_the_law(tmp_path: Path, name: str) -> None:
    file, nu, delta, due = of(name)
    ((written, content),) = pvs.render(file).items()
    assert b"float64" not in content
    (tmp_path / written).write_bytes(content)
    code = (
        f"import json, sys; sys.path.insert(0, {str(tmp_path)!r}); import v_{name} as m; v = m.v_{name}()\n"
        "nu, delta = json.load(sys.stdin)\nprint(json.dumps([v.hydrodynamics(n, d).tolist() for n, d in zip(nu, delta)]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], input=json.dumps([nu.tolist(), delta.tolist()]), capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    same(np.array(json.loads(done.stdout)), due)
