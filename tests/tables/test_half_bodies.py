"""Half of a body: every place where a solver's files name a symmetry plane, and forces across the plane in any format."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.axes import parse_axes
from coeflab.tables.column_map import read_column_map
from coeflab.tables.evidence import across_planes
from coeflab.tables.half_bodies import half_in_words
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.mapping import assigned
from coeflab.tables.raw_table import HALF_MODEL, RawColumn, RawTable
from tests.cli.test_import_half import case

PATCH = "sym {{ type {}; faces ((0 1 5 4)); }}"
PLACES = {
    "0/p": "boundaryField\n{\n sym { type symmetryPlane; }\n}\n",
    "0.org/k": "boundaryField { sym { type symmetry; } }",
    "0.orig/U": 'boundaryField { "sym.*" { type symmetryPlane; } }',
    "constant/polyMesh/boundary": "1\n(\n sym { type symmetry; nFaces 3; startFace 1; }\n)\n",
    "constant/water/polyMesh/boundary": "1\n(\n sym { type symmetry; nFaces 3; startFace 1; }\n)\n",
    "processor0/constant/polyMesh/boundary": "1\n(\n sym { type symmetryPlane; nFaces 0; startFace 1; }\n)\n",
    "processors4/constant/polyMesh/boundary": "1\n(\n sym { type symmetryPlane; nFaces 0; startFace 1; }\n)\n",
    "2/polyMesh/boundary": "",
    "system/blockMeshDict": "boundary\n(\n sym { type symmetryPlane; faces ((0 1 5 4)); }\n);\n",
    "constant/polyMesh/blockMeshDict": "patches ( symmetryPlane sym ((0 1 5 4)) wall hull ((1 2 3 4)) );",
    "system/snappyHexMeshDict": "geometry { a.stl { type triSurfaceMesh; regions { r { name sym; } } } }\n"
    "castellatedMeshControls { refinementSurfaces { sym { level (0 0); patchInfo { type symmetryPlane; } } } }",
    "system/createPatchDict": "patches ( { name sym; patchInfo { type symmetryPlane; } constructFrom patches; patches (x); } );",
    "500/p": 'boundaryField { sym { type "symmetryPlane"; } }',
    "system/water/blockMeshDict": "boundary ( sym { type symmetry; faces ((0 1 5 4)); } );",
}  # fmt: skip


@pytest.mark.parametrize("place", [p for p, text in PLACES.items() if text])
def test_openfoam_names_its_symmetry_plane_wherever_it_stands(place: str, tmp_path: Path) -> None:
    case(tmp_path / "b0", 0.0, cut="")
    file = tmp_path / "b0" / place
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(("/* type symmetry; */\n" if not place.endswith("U") else "") + PLACES[place])
    if place == "0.orig/U":  # the field of the inflow counts first, and names none
        file.rename(file.with_name("Urel"))
    found = IMPORTERS.load("openfoam").run(tmp_path / "b0", {}).history.stated[HALF_MODEL]
    assert "sym" in found.contradicted
    assert found.offered


def test_a_comment_and_a_copy_of_all_constraint_types_are_no_symmetry_plane(tmp_path: Path) -> None:
    case(tmp_path / "b0", 0.0, cut="")
    system = tmp_path / "b0/system"
    (system / "blockMeshDict").write_text("boundary ( side { // type symmetry;\n type patch; faces ((0 1 5 4)); } );")
    (system / "setConstraintTypes").write_text("symmetry { type symmetry; }\nprocessor { type processor; }\n")
    assert HALF_MODEL not in IMPORTERS.load("openfoam").run(tmp_path / "b0", {}).history.stated


STAR = '"Iteration","Drag Monitor: Drag Monitor (N)"\n' + "\n".join(f"{i},1.{i % 3}" for i in range(1, 60)) + "\n"
CFX = '"ACCUMULATED TIMESTEP","USER POINT,fx"\n' + "\n".join(f"{i}.0,1.{i % 3}" for i in range(1, 60)) + "\n"
SU2 = '"Inner_Iter",    "CFx"\n' + "\n".join(f"{i}, 1.{i % 3}" for i in range(1, 60)) + "\n"
FLUENT = (
    '"drag-rfile"\n"Iteration" "drag"\n("Iteration" "drag")\n'
    + "\n".join(f"{i} 1.{i % 3}" for i in range(1, 60))
    + "\n"
)
SOLVERS = [
    ("su2", "history.csv", SU2, "run.cfg", "SOLVER= INC_RANS\nMARKER_SYM= ( mid )\n"),
    ("su2", "history.csv", SU2, "run.log", "|       Symmetry plane|        mid|\n"),
    ("cfx", "m.csv", CFX, "setup.ccl", "  BOUNDARY: mid\n    Boundary Type = SYMMETRY\n    Location = MID\n  END\n"),
    ("starccm", "m.csv", STAR, "setup.java", 'Boundary boundary_0 = region_0.getBoundaryManager().getBoundary("mid");\n boundary_0.setBoundaryType(SymmetryBoundary.class);\n'),
    ("fluent", "drag-rfile.out", FLUENT, "run.trn", "   4711 quadrilateral symmetry faces,  zone  7.\n"),
    ("fluent", "drag-rfile.out", FLUENT, "run.jou", "/define/boundary-conditions/zone-type mid symmetry\n"),
    ("fluent", "drag-rfile.out", FLUENT, "run.cas", "(45 (7 symmetry mid 1)())\n"),
    ("fluent", "drag-rfile.out", FLUENT, "run.jou", 'define boundary-conditions modify-zones zone-type (mid) "symmetry"\n'),
    ("fluent", "drag-rfile.out", FLUENT, "run.py", 'bc.set_zone_type(zone_list=["mid"], new_type="symmetry")\n'),
    ("fluent", "drag-rfile.out", FLUENT, "../all.jou", "/define/boundary-conditions/zone-type mid symmetry\n"),
    ("cfx", "m.csv", CFX, "run_001.out", " |   BOUNDARY: mid\n |     Boundary Type = SYMMETRY\n"),
    ("cfx", "m.csv", CFX, "run.ccl", "  BOUNDARY: mid\n    Boundary Type = \\\n  SYMMETRY\n"),
    ("cfx", "m.csv", CFX, "setup.pre", "> update\nBOUNDARY: mid\nBoundary Type = SYMMETRY\n"),
    ("cfx", "m.csv", CFX, "../all.ccl", "  BOUNDARY: mid\n    Boundary Type = SYMMETRY\n"),
    ("starccm", "m.csv", STAR, "summary.txt", "  | mid : Symmetry Plane\n"),
    ("su2", "history.csv", SU2, "../all.cfg", "MARKER_SYM= ( mid )\n"),
]  # fmt: skip


@pytest.mark.parametrize(("solver", "name", "text", "beside", "setup"), SOLVERS)
def test_other_solvers_name_it_in_their_own_files(
    solver: str, name: str, text: str, beside: str, setup: str, tmp_path: Path
) -> None:
    run = tmp_path / "a0"
    run.mkdir()
    (run / name).write_text(text)
    plain = IMPORTERS.load(solver).run(run, {}).history
    assert HALF_MODEL not in plain.stated
    file = (run / beside).resolve()
    file.write_text(setup)
    found = IMPORTERS.load(solver).run(run, {}).history
    assert file.name in found.stated[HALF_MODEL].contradicted
    assert file in found.files


HALF = """half model tests; Halbmodell M3; essais sur demi-modèle; one half of the hull; starboard half of the hull; only the port side was meshed
symmetry plane at y=0; on a reflection plate; half-body, not doubled; Kräfte der halben Geometrie; auf der Steuerbordhälfte; Rumpfhälfte; half_model
moitié de la carène; mezzo modello; mitad del modelo; forces of 1/2 hull; symmetric half; symmetry boundary condition; half of the AUV"""
WHOLE = """second half of the run; 1/2 rho U^2 L^2; U95 half-width; whole model; port side turn; at half depth; model 1/2; halbe Fahrt; half power"""


@pytest.mark.parametrize("text", re.split("; |\n", f"{HALF}\n{WHOLE}"))
def test_words_of_five_languages_speak_of_half_a_body(text: str) -> None:
    assert (half_in_words([("line 1", text)]) is not None) == (text in HALF)


ALPHA = np.array([-6.0, -3.0, 0.0, 3.0, 6.0])


def _asked(
    forces: dict[str, np.ndarray],
    angle: str = "alpha",
    frame: object = "FRD",
    symmetry: tuple[str, ...] = (),
    unit: str = "N",
) -> bool:
    of = {"N": {"X": "N", "Y": "N", "Z": "N", "K": "N*m", "M": "N*m", "N": "N*m"}, "kN": {}}["N"]
    columns = [RawColumn(angle, "deg", ALPHA)]
    said = {angle: read_column_map(f"{angle} [deg]")}
    for c, values in forces.items():
        columns.append(RawColumn(f"F{c}", "", values))
        said[f"F{c}"] = read_column_map(f"{c}' [-]" if unit == "-" else f"{c} [{of[c]}]")
    raw = RawTable(Path("t.csv"), tuple(columns))
    found = list(across_planes(assigned(raw, said, whole=False), parse_axes(frame), symmetry, 2.0))
    assert all(e.key == HALF_MODEL for e in found)
    return bool(found)


@pytest.mark.parametrize("unit", ["N", "-"])
def test_a_side_force_in_every_row_of_an_attack_sweep_asks(unit: str) -> None:
    z = -10.0 * ALPHA
    whole = {"X": -4.0 + 0.0 * ALPHA, "Z": z, "M": 3.0 * ALPHA}
    assert not _asked(whole, unit=unit)
    assert not _asked({**whole, "Y": 0.4 + 0.02 * ALPHA}, unit=unit)  # a bias below a twentieth
    assert not _asked({**whole, "Y": 2.0 * ALPHA}, unit=unit)  # a coupling: zero at zero angle
    assert _asked({**whole, "Y": 9.0 + 0.1 * ALPHA}, unit=unit)
    assert _asked({**whole, "N": -9.0 + 0.1 * ALPHA}, unit=unit)


def test_the_plane_follows_the_axes_of_the_file() -> None:
    up = ["aft", "up", "port"]  # y up, z to port: alpha moves Y of the file, and Z of it lies across
    assert _asked({"Y": 10.0 * ALPHA, "Z": 9.0 + 0.0 * ALPHA}, frame=up)
    assert not _asked({"Y": 9.0 + 10.0 * ALPHA, "Z": 0.01 * ALPHA}, frame=up)


def test_up_and_down_are_judged_only_where_they_are_declared_alike() -> None:
    drift = {"Y": -10.0 * ALPHA, "Z": 9.0 + 0.0 * ALPHA}
    assert not _asked(drift, angle="beta")
    assert _asked(drift, angle="beta", symmetry=("up-down",))


@pytest.mark.parametrize(
    "words",
    [
        "origin in the symmetry plane", "x in the symmetry plane, z down", "moments about the nose in the symmetry plane",
        "body symmetric about the symmetry plane y=0", "full model without symmetry plane", "no symmetry plane used, full domain",
        "Full domain, no symmetry condition", "double body with symmetry plane at the waterline", "top and side walls: symmetry boundary condition",
        "1/2 hull length", "half of hull length aft of the nose", "1/2 grid spacing", "half the mesh size", "scale 1/2 model of the AUV",
        "half of the models were tested", "drift angles on one side only", "tests on one side only", "left half of the tank",
        "upper half of the table", "half model length", "Ursprung in der Symmetrieebene", "no half model",
    ],
)  # fmt: skip
def test_what_ordinary_words_do_not_say(words: str) -> None:
    assert half_in_words([("line 1", words)]) is None


@pytest.mark.parametrize(
    "words",
    ["with a symmetry plane", "symmetry plane at y = 0", "forces of the half model", "one half of the hull", "port side only", "mesh on one side only",
     "left half of the hull", "upper half"],
)  # fmt: skip
def test_what_still_asks(words: str) -> None:
    assert half_in_words([("line 1", words)]) is not None
