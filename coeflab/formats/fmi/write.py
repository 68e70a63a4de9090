"""FMI 2.0: a co-simulation unit (FMU) of a rigid body under the file's own law, for Simulink, Dymola, OpenModelica, FMPy.

Coefficients, masses and the start of the motion are parameters of the unit, control angles and external forces its inputs.
It runs by pythonfmu, whose libraries and modules are put into it; the machine that runs it needs a Python 3, not coeflab.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, distribution
from importlib.resources import files as resources
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.text.bounded import own_bytes
from coeflab.core.text.json import parse_json
from coeflab.core.text.xml import sayable
from coeflab.core.wording import identifier, one_line
from coeflab.formats.export import missing_mass, missing_water
from coeflab.formats.exported_law import (
    not_written,
    number,
    propulsion,
    spelt,
    written_accelerations,
    written_changes,
    written_terms,
)
from coeflab.formats.unspoken import in_header
from coeflab.law.force_law import AHEAD, ForceLaw, ForceTerm
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.law.terms import Factor, Term
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.inertia import centre_of_gravity
from coeflab.vehicle.parameter_file import ParameterFile

summary = "FMI 2.0: an FMU for co-simulation under the file's own law; the host that runs it needs Python 3"
citations = ("sname1950", "fossen2011", "fmi2", "pythonfmu")
adds_coriolis = False
holds = frozenset({"hydrostatics"})
not_held = not_written

STEP = 0.01
PYTHON = "the unit is a Python program (pythonfmu): the machine that runs it needs Python 3, not coeflab"
SLOWEST = 1e-9
_MOVING = (*MOTIONS, *CONTROLS)
_GROUPS = {"prime": "coefficient", "rest": "rest", "potential": "ideal"}
_PRODUCTS = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
_DATE = (1980, 1, 1, 0, 0, 0)
Variable = dict[str, Any]


def _variable(name: str, causality: str, start: float, description: str) -> Variable:
    return {"name": name, "causality": causality, "start": float(start), "description": description}


def _place(term: ForceTerm) -> str:
    return f"{_GROUPS[term.kind]}.{spelt(term.symbol)}"


def _mass(parameters: ParameterFile) -> list[Variable]:
    """Mass and moments about the reference point; zero is unknown, and the unit asks for it."""
    mass = parameters.mass
    matrix = np.zeros((3, 3))
    if mass is not None and mass.inertia_matrix is not None:
        matrix = np.array(mass.inertia_matrix)
    elif mass is not None and mass.inertia is not None:
        matrix[1, 1] = matrix[2, 2] = mass.inertia
    out = [_variable("mass.m", "parameter", 0.0 if mass is None else mass.mass, "kg")]
    centre = zip("xyz", centre_of_gravity(parameters), strict=True)
    out += [
        _variable(f"mass.{a}_g", "parameter", x, "centre of gravity from the reference point, m") for a, x in centre
    ]
    about = "about the reference point, kg m^2; products with their sign in the matrix"
    return out + [_variable(f"mass.I{n}", "parameter", matrix[at], about) for n, at in _PRODUCTS.items()]


def _hydrostatics(parameters: ParameterFile) -> list[Variable]:
    """Nothing where the file has none: weight and buoyancy are then equal and act at one point."""
    h = parameters.hydrostatics
    if h is None:
        return []
    centre = zip("xyz", h.centre_of_buoyancy, strict=True)
    return [
        _variable("hydrostatics.volume", "parameter", h.volume, "displaced, m^3"),
        *(
            _variable(f"hydrostatics.{a}_b", "parameter", x, "centre of buoyancy from the reference point, m")
            for a, x in centre
        ),
        _variable("hydrostatics.g", "parameter", h.gravity, "m/s^2"),
    ]


def _variables(parameters: ParameterFile, terms: tuple[ForceTerm, ...], dots: Mapping[str, float]) -> list[Variable]:
    out = [_variable("density", "parameter", parameters.conditions.density, "kg/m^3")]
    out += [*_mass(parameters), *_hydrostatics(parameters)]
    start = {"u": parameters.conditions.speed}
    for n in ("north", "east", "down", "roll", "pitch", "yaw", *MOTIONS):
        out.append(_variable(f"start.{n}", "parameter", start.get(n, 0.0), "m, rad, m/s, rad/s"))
    out.append(_variable("step", "parameter", STEP, "longest step of the integration, s"))
    out += [_variable(_place(t), "parameter", t.written, t.note) for t in terms]
    out += [_variable(f"acceleration.{n}", "parameter", v, "primed, less the added mass") for n, v in dots.items()]
    signs = {said[:2]: f"rad; {said}" for said in control_signs(parameters)}
    out += [_variable(f"control.{c}", "input", 0.0, signs.get(c, "rad")) for c in CONTROLS]
    out += [_variable(f"external.{c}", "input", 0.0, "at the reference point, N or N m") for c in COMPONENTS]
    for group, members, unit in (
        ("position", ("north", "east", "down"), "of the reference point, m"),
        ("attitude", ("roll", "pitch", "yaw"), "rad"),
        ("velocity", MOTIONS, "m/s, rad/s"),
        ("hydrodynamic", COMPONENTS, "of the water on the body, N, N m"),
    ):
        out += [_variable(f"{group}.{m}", "output", 0.0, unit) for m in members]
    return out


def _model(parameters: ParameterFile) -> dict[str, Any]:
    """What the unit reads: its variables in the order of their references, and which of them multiply what."""
    terms = written_terms(parameters)
    dots, source = written_accelerations(parameters)
    p = parameters
    return {
        "name": p.name,
        "body": p.body,
        "length": p.scaling.length,
        "length_name": p.scaling.length_name,
        "reference_point": [*p.reference_point.point, p.reference_point.datum],
        "added_mass": source,
        "read_me": list(in_header(p)),
        "terms": [
            {
                "value": _place(t),
                "force": COMPONENTS.index(t.component),
                "length_power": t.length_power,
                "speed_power": t.speed_power,
                **({"course": AHEAD.prime} if t.ahead else {}),
                "factors": [[_MOVING.index(v), n, absolute] for v, n, absolute in t.product.factors],
            }
            for t in terms
        ],
        "accelerations": [
            {
                "value": f"acceleration.{name}",
                "force": COMPONENTS.index(name[0]),
                "motion": MOTIONS.index(name[1:].removesuffix("dot")),
                "length_power": powers_of(name)[1],
            }
            for name in dots
        ],
        "variables": _variables(parameters, terms, dots),
    }


def _description(parameters: ParameterFile, variables: list[Variable], guid: str) -> bytes:
    """modelDescription.xml; references of variables are their numbers from 0, indices from 1."""
    name = identifier(parameters.name)
    said = sayable(one_line(f"{parameters.name}, body: {parameters.body}; {PYTHON}"))
    root = Element(
        "fmiModelDescription", fmiVersion="2.0", modelName=name, guid=guid, description=said, generationTool="coeflab",
        variableNamingConvention="structured",
    )  # fmt: skip
    SubElement(
        root, "CoSimulation", modelIdentifier=name, needsExecutionTool="true",
        canHandleVariableCommunicationStepSize="true", canNotUseMemoryManagementFunctions="true",
    )  # fmt: skip
    SubElement(root, "DefaultExperiment", startTime="0", stopTime="60", stepSize="0.1")
    listed, structure = SubElement(root, "ModelVariables"), SubElement(root, "ModelStructure")
    lists = [SubElement(structure, tag) for tag in ("Outputs", "InitialUnknowns")]
    for k, v in enumerate(variables):
        kind = "fixed" if v["causality"] == "parameter" else "continuous"
        scalar = SubElement(
            listed, "ScalarVariable", name=v["name"], valueReference=str(k), causality=v["causality"], variability=kind,
            description=sayable(one_line(v["description"])),
        )  # fmt: skip
        SubElement(scalar, "Real", {} if v["causality"] == "output" else {"start": number(v["start"])})
        if v["causality"] == "output":
            for each in lists:
                SubElement(each, "Unknown", index=str(k + 1))
    indent(root)
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode").encode() + b"\n"


def _lines(texts: list[str]) -> bytes:
    return ("\n".join(texts) + "\n").encode()


def _runtime(name: str) -> dict[str, bytes]:
    """Files of the installed pythonfmu, where the unit looks for them.

    Raises
    ------
    InputError
        pythonfmu is not installed.
    """
    try:
        listed = distribution("pythonfmu").files or ()
    except PackageNotFoundError:
        raise InputError(
            "no pythonfmu", "pythonfmu, whose libraries run the FMU",
            column="exporter.fmi", advice="pip install pythonfmu (the extra coeflab[fmi]).",
        ) from None  # fmt: skip
    out = {}
    for f in listed:
        if f.parent.as_posix() == "pythonfmu" and f.suffix == ".py":
            place = f"resources/{f.as_posix()}"
        elif f.match("pythonfmu/resources/binaries/*/*pythonfmu-export.*"):
            place = f"binaries/{f.parent.name}/{name}{f.suffix}"
        elif f.name.startswith("LICENSE"):
            place = "documentation/licenses/pythonfmu.txt"
        else:
            continue
        out[place] = f.read_binary()
    return out


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One FMU: a zip file, stored, its entries in order and dated alike, so that the same file gives the same bytes."""
    name, model = identifier(parameters.name), _model(parameters)
    content = (json.dumps(model, indent=1, ensure_ascii=True, allow_nan=False) + "\n").encode()
    unit = own_bytes(resources("coeflab.formats.fmi") / "unit.py")
    guid = hashlib.sha256(content + unit).hexdigest()[:32]
    entries = {
        "modelDescription.xml": _description(parameters, model["variables"], guid),
        "resources/model.json": content,
        "resources/coeflab_unit.py": unit,
        "resources/slavemodule.txt": b"coeflab_unit",
        **({"documentation/read_me.txt": _lines(model["read_me"])} if model["read_me"] else {}),
        **_runtime(name),
    }
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_STORED) as archive:
        for path in sorted(entries):
            info = zipfile.ZipInfo(path, _DATE)
            info.create_system, info.external_attr = 3, 0o644 << 16
            archive.writestr(info, entries[path])
    return {f"{name}.fmu": made.getvalue()}


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """What the unit's ``hydrodynamics`` (`coeflab/formats/fmi/unit.py`) computes from the model.json in the FMU, all
    velocities at once, with zero control angles.
    """
    return steered_force(files, nu, np.zeros((len(nu), 3)))


def steered_force(
    files: Mapping[str, bytes], nu: NDArray[np.float64], controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same under control angles."""
    model, values = _read(files)
    terms = []
    for t in model["terms"]:
        k = t["length_power"]
        value = values[t["value"]] * (0.5 * values["density"] * model["length"] ** k if k else 1.0)
        term = Term(tuple(Factor(_MOVING[index], power, absolute) for index, power, absolute in t["factors"]))
        made = ForceTerm(t["value"], COMPONENTS[t["force"]], term, value, t["speed_power"], 1.0)
        if "course" in t:
            reading = AHEAD._replace(prime=t["course"])
            made = replace(made, term=Term((Factor("u", 1),)), readings=(("u", reading),))
        terms.append(made)
    return ForceLaw(tuple(terms), np.zeros((6, 6, 6))).force(nu, controls)


def added_mass(files: Mapping[str, bytes]) -> NDArray[np.float64]:
    """What the unit's ``exit_initialization_mode`` adds to the rigid body, from the model.json in the FMU."""
    model, values = _read(files)
    out = np.zeros((6, 6))
    for a in model["accelerations"]:
        scale = 0.5 * values["density"] * model["length"] ** a["length_power"]
        out[a["force"], a["motion"]] -= scale * values[a["value"]]
    return out


def _read(files: Mapping[str, bytes]) -> tuple[dict[str, Any], dict[str, float]]:
    """The model of the unit, and the values of its variables."""
    (content,) = (c for name, c in files.items() if name.endswith(".fmu"))
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        model = parse_json(archive.read("resources/model.json").decode())
    return model, {v["name"]: v["start"] for v in model["variables"]}


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass, moments of inertia and added mass, where the file has none."""
    unset = "the unit does not start before you set them"
    return (*missing_mass(parameters, unset, f"mass.Ixx is open, {unset}"), *missing_water(parameters))


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the law is written, in words."""
    return (
        *written_changes(parameters, "the unit", "the parameters ideal.*", "the parameters acceleration.*"),
        PYTHON,
        "positions are north, east, down",
        "the water is at rest",
        "weight and buoyancy are equal and act at one point: the file states no buoyancy; a righting moment goes to the inputs external.*"
        if parameters.hydrostatics is None
        else "weight and buoyancy by the parameters mass.* and hydrostatics.*; the outputs hydrodynamic.* do not contain them",
        f"{propulsion(parameters)}; thrust goes to the input external.X",
    )
