"""A plugin of every kind, written into a folder of its own: it is listed, chosen and used, and nothing else is edited."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from coeflab.core.registry import registries
from tests.motion.vehicles import made

WORK = "A. Planter, Plugins made on the spot, J. Tests 1, 2026."
HEAD = f"summary = 'a planted plugin'\ncitations = ({WORK!r},)\n"
PLANTED = {
    "importers": "from coeflab.tables.importers.csv import recognises, read\n",
    "bodies": "from coeflab.bodies.readers.particulars import read\n",
    "added_mass": "from coeflab.bodies.added_mass.ellipsoid import added_mass\npresets = {'twice': {}}\n",
    "estimates": "from dataclasses import replace\nfrom coeflab.estimates import friction\n"
    "def contributions(outline, water):\n"
    "    return tuple(replace(c, method='planted') for c in friction.contributions(outline, water))\n",
    "fits": "from coeflab.fits.slope_at_origin import Options, fit\n",
    "exporters": "def render(parameters):\n    return {'planted.txt': parameters.name.encode()}\n",
    "parameter_importers": "reads = 'planted models'\n"
    "from coeflab.vehicle.parameter_file import read_parameter_file\n"
    "def recognises(path):\n    return path.suffix == '.planted'\n"
    "def read(path, density=None):\n    return read_parameter_file(path.parent / path.read_text().strip())\n",
    "manoeuvres": "from coeflab.motion.manoeuvres.straight_run import Options, figures, plan, plane\n",
    "simulators": "from coeflab.motion.simulators.rigid_body import Options, simulate\n",
    "checks": "from coeflab.core.table import Check, Severity\n"
    "def check(study):\n    return [Check('planted', 'subject', Severity.WARN, 'looked', 'look', '')]\n",
    "tow_solvers": "from coeflab.tank.solvers.external import installed, jobs, options, table\n",
    "tow_runners": "from coeflab.core.declarations import Declaration\nfrom dataclasses import dataclass\n"
    "@dataclass(frozen=True)\nclass options(Declaration):\n    pass\n"
    "def carry_out(jobs, folder, options, look):\n    look()\n",
    "reporting": "def render(document):\n    return {'report.planted': document.title.encode()}\n",
}
PLAN = """
[study]
name = "planted"
[[table]]
campaign = "{campaign}"
fits = ["planted"]
[[parameter_file]]
name = "synthetic_body"
body = "synthetic_body"
campaigns = ["{campaign}"]
[[export]]
to = "planted"
"""
BODY = """
[body]
name = "planted_body"
reader = "planted"
datum = "nose"
reference_point = [-2.0, 0.0, 0.0]
[source]
citation = "synthetic"
[particulars]
LOA = "4 m"
"""
RUN = """
import json, sys
from coeflab.cli import app
for line in json.loads(sys.argv[1]):
    print("==", *line)
    app(line, standalone_mode=False)
"""


def test_every_kind_has_one() -> None:
    assert sorted(PLANTED) == [r.package.removeprefix("coeflab.") for r in registries()]


@pytest.mark.slow
def test_new_plugins_need_no_edit_elsewhere(tmp_path: Path, write_campaign: Callable[..., Path]) -> None:
    site = tmp_path / "site"
    info = site / "planted-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: planted\nVersion: 1.0\n")
    points = [f"[coeflab.{kind}]\nplanted = planted_{kind}\n" for kind in PLANTED]
    (info / "entry_points.txt").write_text("\n".join(points))
    for kind, text in PLANTED.items():
        (site / f"planted_{kind}.py").write_text(HEAD + text)
    rows = "".join(f"{b},{5.0 * b + 0.02 * b * abs(b)},{7.5 * b}\n" for b in range(-12, 13, 2))
    head = 'title = "Planted"\nbody = "synthetic_body"\nimporter = "planted"'
    campaign = write_campaign(f"beta [deg],Y [N],N [N*m]\n{rows}", campaign=head)
    plan, out = tmp_path / "plan.toml", tmp_path / "out"
    plan.write_text(PLAN.format(campaign=campaign.name))
    body = tmp_path / "body.toml"
    body.write_text(BODY)
    vehicle = tmp_path / "torpedo.parameters.json"
    vehicle.write_bytes(made().to_json())
    model = tmp_path / "torpedo.planted"
    model.write_text(vehicle.name)
    lines = [
        ["formats", "planted"],
        ["inspect", str(campaign)],
        ["run", str(plan), "--out", str(out)],
        ["report", str(plan), "--to", "planted,html", "--full", "--out", str(out)],
        ["inspect", str(body)],
        ["added-mass", "suboff_bare_hull", "--method", "planted:twice"],
        ["params", "check", str(model)],
        ["vehicle", "remus100", "--json", "--out", str(tmp_path / "remus100")],
        ["simulate", str(vehicle), "--manoeuvre", "planted", "--simulator", "planted", "--free", "u,v,r"],
    ]
    done = subprocess.run(
        [sys.executable, "-c", RUN, json.dumps(lines)], env={**os.environ, "PYTHONPATH": str(site)}, text=True,
        capture_output=True, check=False, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr + done.stdout
    assert "broken" not in done.stdout
    assert (out / "report.planted").exists()
    assert [f.read_bytes() for f in out.rglob("planted.txt")] == [b"synthetic_body"]
    assert WORK in (out / "report.html").read_text()
    assert "looked" in done.stdout
    said = dict(zip((" ".join(line[:2]) for line in lines), done.stdout.split("== ")[1:], strict=True))
    for command, words in {
        f"inspect {body}": "next:", "added-mass suboff_bare_hull": "ellipsoid", "params check": "torpedo",
        "vehicle remus100": '"planted"',
        f"simulate {vehicle}": "constant thrust of 18 N",
    }.items():  # fmt: skip
        (text,) = [t for c, t in said.items() if c.startswith(command)]
        assert words in text
