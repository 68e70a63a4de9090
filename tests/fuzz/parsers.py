"""Every parser of what others wrote, with its corpus: shipped files, samples of importers, `tests/fuzz/corpus` and texts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from coeflab.arm.arm_file import read_arm
from coeflab.bodies.mesh.file import load
from coeflab.bodies.readers import read_body
from coeflab.bodies.simplify.boxes import parse_box, read_boxes
from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.core.axes import angle_sign, parse_axes
from coeflab.core.errors import InputError
from coeflab.core.text.delimited import read_cells
from coeflab.core.text.foam import FoamCase
from coeflab.core.text.json import parse_json
from coeflab.core.text.patterns import PatternProblem, pattern
from coeflab.core.text.toml import read_toml
from coeflab.core.text.xml import parse_xml
from coeflab.core.text.yaml import parse_yaml
from coeflab.core.units import parse_header, quantity, typed
from coeflab.formats.model_files import read_model_file
from coeflab.glider.glider_file import read_glider
from coeflab.identify.series import read_series
from coeflab.identify.tuning_plan import read_tuning_plan
from coeflab.law.named_terms import read_equation, read_term
from coeflab.law.symbols import derivative
from coeflab.motion.vehicle import vehicle
from coeflab.study.plan import read_plan
from coeflab.tables.column_map import read_column_map
from coeflab.tables.conditions import name_pattern
from coeflab.tables.importers import IMPORTERS, PlannedTable
from coeflab.tables.reading import read_tables
from coeflab.tables.run_list import read_run_list
from coeflab.tables.settings import read_in, saved_mapping
from coeflab.tables.words.above import of_the_test
from coeflab.tank import folder as tow_folder
from coeflab.tank.jobs import read_job, read_progress
from coeflab.tank.tank_file import read_tank
from coeflab.vehicle.parameter_file import read_parameter_file
from coeflab.vehicle.published_values import read_references

ROOT = Path(__file__).parents[2]
CORPUS = Path(__file__).parent / "corpus"
SAMPLES = ROOT / "tests" / "tables" / "samples"
MODELS = ROOT / "tests" / "formats" / "data"
RECORD = "t [s], x [m], y [m], psi [deg], -dr [deg], -"
MOST_LINES, LONGEST_LINE = 60, 2000


@dataclass(frozen=True, slots=True)
class Parser:
    """A parser with what it is tried on.

    Attributes
    ----------
    samples : tuple of Path
        A file, or a folder whose files are spoilt one at a time.
    read : callable
        Takes the path of the sample, or a text where the parser has ``texts``.
    texts : tuple of str
    also : tuple of exception types
        Raised besides `InputError`: the caller knows the place and adds it.
    share : float
        Of the inputs; 1 for a parser of some milliseconds.
    beside : bool
        Whether a file needs those beside it.
    """

    samples: tuple[Path, ...]
    read: Callable[[Any], object]
    texts: tuple[str, ...] = ()
    also: tuple[type[Exception], ...] = ()
    share: float = 1.0
    beside: bool = False


def of_foreign_files() -> list[str]:
    """Importers that bring whole tables or runs."""
    return [n for n in IMPORTERS.names() if IMPORTERS.load(n).raw or IMPORTERS.load(n).run]


def with_samples() -> list[str]:
    """Those of them that have samples."""
    return [n for n in of_foreign_files() if (SAMPLES / n).is_dir() and any((SAMPLES / n).iterdir())]


def _touch(found: Any) -> None:
    """Use what was read, so that something broken inside shows."""
    table = getattr(found, "history", found)
    assert all(len(c.values) == len(table) for c in table.columns)
    assert all(not c.texts or len(c.texts) == len(table) for c in table.columns)
    assert len(table.lines) in (0, len(table))


def attempt(importer: Any, path: Path) -> bool:
    """Whether a spoilt input is read; False where it is refused by an InputError of bearable length."""
    importer.recognises(path)
    read = False
    for reader in filter(None, (importer.raw, importer.run)):
        try:
            _touch(reader(path, {}))
            read = True
        except InputError as why:
            require_short(why)
    return read


def require_short(why: Exception) -> None:
    """Refuse a message that nobody reads to its end."""
    lines = str(why).splitlines()
    if len(lines) > MOST_LINES or max(map(len, lines)) >= LONGEST_LINE:
        raise ValueError(f"a message of {len(lines)} lines, the longest of {max(map(len, lines))} letters") from why


def _imported(name: str) -> Parser:
    def read(path: Path) -> object:
        if not attempt(IMPORTERS.load(name), path):
            raise InputError("refused", "a table")
        return path

    return Parser(tuple(sorted((SAMPLES / name).iterdir())), read)


@cache
def _vehicle() -> Any:
    return vehicle(read_parameter_file(ROOT / "cfd_data" / "huuv" / "huuv.parameters.json"), free=("u",))


def _motion(path: Path) -> object:
    return read_series(path, _vehicle())


def _foam(path: Path) -> object:
    return FoamCase(path).read("system/controlDict")


def _shipped(pattern_: str) -> tuple[Path, ...]:
    return tuple(sorted(ROOT.glob(pattern_)))


def _corpus(*names: str) -> tuple[Path, ...]:
    return tuple(CORPUS / name for name in names)


def parsers() -> dict[str, Parser]:
    """All of them, by name."""
    words = (
        "Moments about midships, 2.1 m aft of nose. LBP = 4.26086 m, LOA 4.356 m",
        "Carriage speed 3.046 m/s, fresh water of 15 deg C, density 999.1 kg/m^3",
        "x aft, y starboard, z up; drift angle positive to port, beta = atan2(-v, u)",
        "Model scale 1:31.6, forces with inertia, ship speed in knots, mit Trägheitsanteil, λ = 25.0",
        "Forces made dimensionless by 0.5*rho*U^2*L^2, rotating arm of radius 15.2 m, primes of the wetted area 5.98 m2",
    )
    models = (*(p for p in sorted(MODELS.iterdir()) if p.name != "nps_auv2.m"), *_corpus("driven.urdf", "driven.scn"))
    files = {
        "campaign": Parser(_shipped("cfd_data/suboff_roddy_2") + _shipped("cfd_data/tank_spheroid"), lambda p: read_tables(PlannedTable(p, ())), share=0.3),
        "csv": Parser(_shipped("cfd_data/*/table.csv"), read_cells),
        "toml": Parser(_shipped("geometry/*/body.toml"), read_toml),
        "plan": Parser(_shipped("cfd_data/*/plan.toml"), read_plan),
        "body": Parser(tuple(p for p in _shipped("geometry/*/body.toml") if "mesh" not in p.parent.name), read_body),
        "mesh_body": Parser(_shipped("geometry/huuv_mesh"), lambda p: read_body(p / "body.toml"), share=0.1),
        "tank": Parser(_shipped("cfd_data/tank/*.toml"), lambda p: read_tank(p, body_file=ROOT / "geometry/tow_spheroid/body.toml")),
        "references": Parser(_shipped("cfd_data/*/published.toml"), read_references),
        "tune": Parser(_shipped("cfd_data/*/tune.toml"), read_tuning_plan, share=0.2, beside=True),
        "glider": Parser(_shipped("cfd_data/thauv/case_01.toml") + _shipped("cfd_data/slocum/*.toml"), read_glider),
        "arm": Parser(_shipped("geometry/urv_puma/body.toml"), read_arm, share=0.3),
        "parameters": Parser(_shipped("tests/data/parameters_1_*.json"), read_parameter_file, share=0.5),
        "models": Parser(models, read_model_file, share=0.3),
        "runs": Parser(_corpus("runs.csv", "runs.toml"), read_run_list),
        "mapping": Parser(_corpus("mapping.toml"), saved_mapping),
        "boxes": Parser(_corpus("boxes.toml"), read_boxes),
        "motion": Parser(_corpus("motion.csv"), _motion),
        "record": Parser(_corpus("record.txt"), lambda p: read_series(p, _vehicle(), RECORD), share=0.3),
        "foam": Parser(_shipped("tests/tables/samples/openfoam/arm_srf"), _foam),
        "mesh": Parser(_corpus("body.stl", "binary.stl", "body.obj", "body.ply", "binary.ply", "body.glb", "body.dae"), load),
        "job": Parser(_corpus("job.json"), lambda p: read_job(p.parent)),
        "state": Parser(_corpus("state.json"), lambda p: read_progress(p.parent)),
        "tow": Parser(_corpus("tow.json"), lambda p: tow_folder.read_plan(p.parent)),
    }  # fmt: skip
    texts = {
        "json": Parser((), parse_json, ('{"a": [1, 2.5e-3, null, true], "b": {"c": "d\\u00e9", "e": []}}', "[[[1], [2]], -0.0]")),
        "yaml": Parser((), parse_yaml, ("a: [1, 2]\nb: {c: d}\ne: &x\n  - f\n  - *x\n", "mass: {value: 1.5, unit: t}\n"), share=0.5),
        "xml": Parser((), parse_xml, ('<a b="1"><c>2</c><!-- d --><e/></a>', "<?xml version='1.0'?><robot><link name='x'/></robot>")),
        "pattern": Parser((), lambda t: pattern(t).matches("hull_port"), ("(hull|fin)_[a-z]+", "a{2,3}.*\\d?$", "[[:alpha:]_]*"), (PatternProblem,)),
        "arithmetic": Parser((), lambda t: evaluate(t, {"a": 2.0, "b.c": -1.0}), ("2*(a + b.c)^2/3 - -1e-3", "((a))*a^0.5"), (ArithmeticProblem,)),
        "header": Parser((), parse_header, ("Y [N]", "N' [-]", "beta (deg)", "Fx / (0.5 rho U^2 L^2) [1]")),
        "quantity": Parser((), lambda t: quantity(t, "length", key="k"), ("4.356 m", "13.8 ft", "-2e-3 mm")),
        "typed": Parser((), lambda t: typed(t, "speed", "--speed"), ("3 kn", "1.5 m/s", "2")),
        "axes": Parser((), parse_axes, ("FRD", "flu", "forward, port, up", "aft,starboard,up")),
        "sign": Parser((), lambda t: angle_sign("beta", t), ("v = -U sin(beta)", "v = +U sin(beta)")),
        "column": Parser((), read_column_map, ("Y [N]", "-N' ", "beta [deg]", "Y +- [N]", "label", "U [kn ship 31.6]", "X [N s^2/m^2]", "rps [1/s]", "J [-]")),
        "columns": Parser((), lambda t: read_series(CORPUS / "record.txt", _vehicle(), t), (RECORD, "t [s], u [m/s], v [m/s], r [rad/s], -, -"), share=0.3),
        "setting": Parser((), lambda t: read_in(*t.partition("=")[::2]), ("axes.reference_point=-2.1 from nose", "scaling.length=4.3 m LOA", "axes.frame=CFD", "drift/table.arm_point=midship", "conditions.speed=[1, 2]")),
        "names": Parser((), lambda t: name_pattern(t).conditions("b-3_r0.2_fine"), ("b{beta:deg}_r{r:rad/s}_{grid}", "{run}_{speed:m/s}")),
        "term": Parser((), lambda t: read_term(t, "k"), ("Yv|v|", "N|v|r'", "Zw", "X0", "Mqdot")),
        "symbol": Parser((), derivative, ("Yv'", "Nrdot", "Y|v|v", "Ydr")),
        "equation": Parser((), lambda t: read_equation(t, "k"), ("Mw = -Nv", "2 Yv + 0.5*Nv = 1e-3")),
        "box": Parser((), parse_box, ("mast=0.05:0.15,-0.05:0.05,-0.4:-0.07", "a=5 cm:1 m,0:1,0:1")),
        "words": Parser((), lambda t: of_the_test([("A1", t)]), words),
    }  # fmt: skip
    return {**{name: _imported(name) for name in with_samples()}, **files, **texts}
