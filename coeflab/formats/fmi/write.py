"""FMI 2.0, model exchange and co-simulation: a unit in C about the source of `coeflab.formats.c_program`, sources in it.

Where a C compiler is found the unit holds its binary for this platform; elsewhere the importer compiles the sources. The machine
that runs it needs neither Python nor coeflab. Coefficients and the start of the motion are parameters; angles of fins, commands of thrusters
and external forces are inputs.
"""

from __future__ import annotations

import hashlib
import io
import platform
import shutil
import subprocess
import tempfile
import zipfile
from collections.abc import Mapping
from importlib.resources import files as resources
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np
from numpy.typing import NDArray

from coeflab.core.text.bounded import own_bytes
from coeflab.core.text.xml import sayable
from coeflab.core.types import remembered
from coeflab.core.wording import identifier, one_line
from coeflab.formats.c_program import program as c
from coeflab.formats.exported_law import not_written, number, propulsion, spelt, written_changes
from coeflab.formats.flat_law import FlatLaw, flat_law, free_motions
from coeflab.formats.lacking_law import in_header
from coeflab.formats.missing_parts import missing_water
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.parameter_file import ParameterFile

summary = (
    "FMI 2.0: an FMU in C for model exchange and co-simulation, tables, thrusters and fins in it; no Python on the host"
)
citations = ("sname1950", "fossen2011", "fmi2")
adds_coriolis = False
holds = frozenset({"hydrostatics", "thrusters", "surfaces", "rates", "lags", "tables"})
not_held = not_written

STEP = 0.01
LONGEST = 60.0  # s, of a compiler
POSITIONS, ANGLES = ("north", "east", "down"), ("roll", "pitch", "yaw")
_DATE = (1980, 1, 1, 0, 0, 0)
_GROUPS = {"prime": "coefficient", "rest": "rest"}
UNITS = {"m": {"m": 1}, "rad": {"rad": 1}, "m/s": {"m": 1, "s": -1}, "rad/s": {"rad": 1, "s": -1}, "m/s2": {"m": 1, "s": -2},
         "rad/s2": {"rad": 1, "s": -2}, "N": {"kg": 1, "m": 1, "s": -2}, "N.m": {"kg": 1, "m": 2, "s": -2}, "s": {"s": 1}}  # fmt: skip


class Variable(NamedTuple):
    """A variable of the unit; its place in the list is its reference."""

    name: str
    causality: str
    start: float | None
    unit: str
    says: str
    derivative_of: int = 0


def _variables(parameters: ParameterFile, law: FlatLaw) -> list[Variable]:
    start = {"u": parameters.conditions.speed}
    linear, turning = ("m", "m/s", "m/s2", "N"), ("rad", "rad/s", "rad/s2", "N.m")

    def unit(k: int, order: int) -> str:
        return (linear if k < 3 else turning)[order]

    out = [
        Variable(f"start.{n}", "parameter", 0.0, unit(k, 0), "at the start")
        for k, n in enumerate((*POSITIONS, *ANGLES))
    ]
    out += [
        Variable(f"start.{m}", "parameter", start.get(m, 0.0), unit(k, 1), "at the start")
        for k, m in enumerate(MOTIONS)
    ]
    out.append(Variable("step", "parameter", STEP, "s", "longest step of co-simulation"))
    for t in law.coefficients:
        says = "prime" if t.kind == "prime" else "SI"
        out.append(Variable(f"{_GROUPS[t.kind]}.{spelt(t.symbol)}", "parameter", t.written, "", f"{says}; {t.note}"))
    signs = {words[:2]: words for words in control_signs(parameters)}
    limits: dict[str, str] = {s.control: f"limit {s.limit:g} rad" for s in parameters.surfaces}
    for control in CONTROLS:
        words = ", ".join(x for x in (signs.get(control, ""), limits.get(control, "")) if x)
        out.append(Variable(f"control.{control}", "input", 0.0, "rad", words))
    out += [
        Variable(f"external.{x}", "input", 0.0, unit(k, 3), "at the reference point") for k, x in enumerate(COMPONENTS)
    ]
    names = _names(parameters)
    for name, thruster in zip(names, parameters.thrusters, strict=True):
        curve = thruster.curve
        says = f"{thruster.name}: {curve.command} in {curve.unit}, {curve.low:g} to {curve.high:g}"
        out.append(Variable(f"thruster.{name}", "input", 0.0, "", says))
    for name, thruster in zip(names, parameters.thrusters, strict=True):
        says = f"{thruster.name}: {thruster.tilt_low:g} to {thruster.tilt_high:g}"
        out.append(Variable(f"tilt.{name}", "input", 0.0, "rad", says))
    first = len(out) + 1
    states = [
        *((f"position.{n}", "output", "m", "m/s") for n in POSITIONS),
        *((f"quaternion.{n}", "local", "", "") for n in "wxyz"),
    ]
    states += [(f"velocity.{m}", "output", unit(k, 1), unit(k, 2)) for k, m in enumerate(MOTIONS)]
    states += [(f"angle.{n}", "output", "rad", "rad/s") for n in CONTROLS]
    states += [(f"actual.{n}", "output", "", "") for n in names if lagging(parameters)]
    out += [Variable(name, causality, None, u, "state") for name, causality, u, _ in states]
    out += [Variable(f"der({name})", "local", None, u, "", first + k) for k, (name, _, _, u) in enumerate(states)]
    out += [Variable(f"attitude.{n}", "output", None, "rad", "") for n in ANGLES]
    out += [
        Variable(f"hydrodynamic.{x}", "output", None, unit(k, 3), "of the water on the body")
        for k, x in enumerate(COMPONENTS)
    ]
    return out


def lagging(parameters: ParameterFile) -> bool:
    """Whether a thruster follows its command with a lag."""
    return any(t.lag is not None for t in parameters.thrusters)


def _names(parameters: ParameterFile) -> list[str]:
    """Thrusters as identifiers, none twice."""
    out: list[str] = []
    for thruster in parameters.thrusters:
        name = identifier(thruster.name)
        out.append(name if name not in out else f"{name}_{len(out) + 1}")
    return out


def _description(parameters: ParameterFile, variables: list[Variable], name: str, guid: str) -> bytes:
    """modelDescription.xml; references of variables are their numbers from 0, indices from 1."""
    words = sayable(one_line(f"{parameters.name}, body: {parameters.body}"))
    root = Element(
        "fmiModelDescription", fmiVersion="2.0", modelName=name, guid=guid, description=words, generationTool="coeflab",
        variableNamingConvention="structured", numberOfEventIndicators="0",
    )  # fmt: skip
    shared = {"modelIdentifier": name, "canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true"}
    kinds: tuple[tuple[str, dict[str, str]], ...] = (
        ("ModelExchange", {}),
        ("CoSimulation", {"canHandleVariableCommunicationStepSize": "true"}),
    )
    for kind, more in kinds:
        sources = SubElement(SubElement(root, kind, {**shared, **more}), "SourceFiles")
        SubElement(sources, "File", name="unit.c")
    definitions = SubElement(root, "UnitDefinitions")
    for unit, powers in UNITS.items():
        SubElement(SubElement(definitions, "Unit", name=unit), "BaseUnit", {k: str(n) for k, n in powers.items()})
    SubElement(root, "DefaultExperiment", startTime="0", stopTime="60", stepSize="0.1")
    listed, structure = SubElement(root, "ModelVariables"), SubElement(root, "ModelStructure")
    lists = {tag: SubElement(structure, tag) for tag in ("Outputs", "Derivatives", "InitialUnknowns")}
    for k, v in enumerate(variables):
        selected = {
            "name": v.name,
            "valueReference": str(k),
            "causality": v.causality,
            "variability": "fixed" if v.causality == "parameter" else "continuous",
        }
        if v.start is None:
            selected["initial"] = "calculated"
        scalar = SubElement(listed, "ScalarVariable", {**selected, "description": sayable(one_line(v.says))})
        real = {} if v.start is None else {"start": number(v.start)}
        real |= {"unit": v.unit} if v.unit else {}
        real |= {"derivative": str(v.derivative_of)} if v.derivative_of else {}
        SubElement(scalar, "Real", real)
        if v.causality == "output":
            SubElement(lists["Outputs"], "Unknown", index=str(k + 1))
        if v.derivative_of:
            SubElement(lists["Derivatives"], "Unknown", index=str(k + 1))
        if v.start is None:
            SubElement(lists["InitialUnknowns"], "Unknown", index=str(k + 1))
    indent(root)
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode").encode() + b"\n"


def _row(values: list[float]) -> str:
    return ", ".join(number(x) for x in values)


def _sources(
    parameters: ParameterFile, law: FlatLaw, variables: list[Variable], name: str
) -> tuple[dict[str, bytes], str]:
    """The C files by name, and the unit's guid, which is of their content."""
    starts = [v.start or 0.0 for v in variables if v.name.startswith("start.") or v.name == "step"]
    units = [1.0 if t.kind == "rest" else t.per_prime for t in law.coefficients]
    given = [t.written for t in law.coefficients]
    text = own_bytes(resources("coeflab.formats.fmi") / "unit.c").decode()
    text = text.replace("@SPINS@", "THRUSTERS" if lagging(parameters) else "0")
    text = text.replace("@NAME@", name).replace("@START@", _row(starts))
    text = text.replace("@UNIT@", _row([*units, 0.0])).replace("@GIVEN@", _row([*given, 0.0]))
    files = {
        f"{name}.h": c.header(parameters, law, name),
        f"{name}.c": c.whole_source(parameters, law, name),
        "unit.c": text,
    }
    guid = hashlib.sha256("".join(files.values()).encode()).hexdigest()[:32]
    return {file: content.replace("@GUID@", guid).encode() for file, content in files.items()}, guid


def platform_folder() -> tuple[str, str]:
    """Folder of this platform in an FMU, and the ending of its libraries."""
    bits = "64" if platform.architecture()[0] == "64bit" else "32"
    system = {"Windows": ("win", ".dll"), "Darwin": ("darwin", ".dylib")}.get(platform.system(), ("linux", ".so"))
    return system[0] + bits, system[1]


@remembered(4)
def compiled(sources: tuple[tuple[str, bytes], ...]) -> bytes | None:
    """The library of these sources; None where no compiler is found or it fails."""
    compiler = next((found for found in map(shutil.which, ("cc", "gcc", "clang")) if found), None)
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        for file, content in sources:
            (Path(folder) / file).write_bytes(content)
        command = [
            compiler,
            *["-std=c99", "-O2", "-shared", "-fPIC", "-fvisibility=hidden", "unit.c", "-o", "unit.lib", "-lm"],
        ]
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST, check=False)
        except (OSError, subprocess.TimeoutExpired):
            return None
        return own_bytes(Path(folder) / "unit.lib") if done.returncode == 0 else None


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One FMU: a zip file, stored, its entries in order and dated alike.

    Raises
    ------
    InputError
        No mass, or M + M_A that is not positive definite.
    """
    c.refuse_without_mass(parameters, "an FMU")
    law, name = flat_law(parameters), c.name_of(parameters)
    variables = _variables(parameters, law)
    sources, guid = _sources(parameters, law, variables, name)
    entries = {
        "modelDescription.xml": _description(parameters, variables, name, guid),
        **{f"sources/{file}": content for file, content in sources.items()},
    }
    if words := in_header(parameters, tables=True):
        entries["documentation/read_me.txt"] = c.lines(words)
    return {f"{name}.fmu": _zipped(entries)}


def built(files: Mapping[str, bytes]) -> Mapping[str, bytes]:
    """With the binary for this platform, where a compiler is found; the sources alone do elsewhere.

    Parameters
    ----------
    files : mapping of str to bytes
        What `render` made.
    """
    out = {}
    for file, content in files.items():
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = {name: archive.read(name) for name in archive.namelist()}
        sources = sorted((n.removeprefix("sources/"), x) for n, x in entries.items() if n.startswith("sources/"))
        if (library := compiled(tuple(sources))) is not None:
            folder, ending = platform_folder()
            entries[f"binaries/{folder}/{file.removesuffix('.fmu')}{ending}"] = library
        out[file] = _zipped(entries)
    return out


def _zipped(entries: Mapping[str, bytes]) -> bytes:
    result = io.BytesIO()
    with zipfile.ZipFile(result, "w", zipfile.ZIP_STORED) as archive:
        for path in sorted(entries):
            info = zipfile.ZipInfo(path, _DATE)
            info.create_system, info.external_attr = 3, 0o644 << 16
            archive.writestr(info, entries[path])
    return result.getvalue()


def _in_c(files: Mapping[str, bytes]) -> dict[str, bytes]:
    """The C source in the unit."""
    (content,) = (x for name, x in files.items() if name.endswith(".fmu"))
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {
            n.removeprefix("sources/"): archive.read(n)
            for n in archive.namelist()
            if n.endswith(".c") and not n.endswith("/unit.c")
        }


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """The law of the source in the unit, no control deflected."""
    return c.force(_in_c(files), nu)


def steered_force(
    files: Mapping[str, bytes], nu: NDArray[np.float64], controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same under control angles, held at their limits."""
    return c.steered_force(_in_c(files), nu, controls)


def added_mass(files: Mapping[str, bytes]) -> NDArray[np.float64]:
    """The added mass in the source."""
    return c.added_mass(_in_c(files))


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Moments of inertia and added mass, where the file has none."""
    free = free_motions(flat_law(parameters))
    held = [m for m in MOTIONS if m not in free]
    words = (f"moments of inertia: {', '.join(held)} held, the file does not state them",) if held else ()
    return (*words, *missing_water(parameters))


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the law is written, in words."""
    return (
        *written_changes(parameters, "the unit", "terms of the source", "the source's added mass"),
        "the unit is C, sources in it; its binary is for the platform of the export",
        "positions are north, east, down; the water is at rest",
        "a fin with a rate moves at it in co-simulation, and to within 0.005 s of its order in model exchange",
        "without hydrostatics there is neither weight nor buoyancy; a righting moment goes to the inputs external.*"
        if parameters.hydrostatics is None
        else "weight and buoyancy act; the outputs hydrodynamic.* do not contain them",
        propulsion(parameters)
        if not parameters.thrusters
        else "thrusters by their commands; other forces go to the inputs external.*",
    )
