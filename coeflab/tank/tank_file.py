"""Reading a tank.toml, and what a body is towed in without one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from importlib.resources import files
from pathlib import Path
from typing import Any, cast

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.orientation import require_orientation
from coeflab.bodies.readers import read_body
from coeflab.core import declarations as takes
from coeflab.core.axes import Datum
from coeflab.core.declarations import Declaration
from coeflab.core.errors import InputError, shown, together
from coeflab.core.registry import Registry
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import TomlFile, own_toml, quoted, read_toml, value
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.water import FRESH_WATER
from coeflab.tank import test_matrix
from coeflab.tank.runners import RUNNERS
from coeflab.tank.solvers import SOLVERS
from coeflab.tank.tank import Tank
from coeflab.tank.tank_keys import MatrixKeys, TankFile, folder_name
from coeflab.tank.test_matrix import Sweeps
from coeflab.tank.towed_body import TowedBody


def declared_body(path: Path) -> Path | None:
    """The body.toml that a tank.toml names, None where it names none.

    Raises
    ------
    InputError
        Everything that is wrong with the file.
    """
    found = takes.declared(TankFile, read_toml(path)).tank.body
    return None if found is None else _body_file(found)


def _body_file(path: Path) -> Path:
    return path / "body.toml" if path.is_dir() else path


def read_tank(
    path: Path, body: TowedBody | None = None, *, body_file: Path | None = None, solver: str = "", runner: str = ""
) -> Tank:
    """The tank of a tank.toml.

    Parameters
    ----------
    path : Path
        Paths inside resolve from its folder.
    body : TowedBody, optional
        Its mirrors and ends make the matrix; without one both sides of the whole body are towed.
    body_file : Path, optional
        The body.toml where the command line says it; required where the file does not.
    solver, runner : str, optional
        In the place of those that the file names.

    Raises
    ------
    InputError
        Everything that is wrong, by file, line and key.
    """
    return _tank(read_toml(path), body, body_file, solver, runner)


def default_tank(body_file: Path, body: TowedBody, *, solver: str = "", runner: str = "") -> Tank:
    """The tank of a body for which nobody wrote a tank.toml: that of `default_text`."""
    text = default_text(body)
    file = TomlFile(body_file.parent / "tank.toml", own_toml(text), text)
    return _tank(file, body, body_file, solver, runner)


def default_text(surface: TowedBody, at: Conditions = FRESH_WATER) -> str:
    """A commented tank.toml for a body: what applies unless somebody says otherwise.

    What is commented out are the values that apply, and examples that hold for this body.

    Parameters
    ----------
    surface : TowedBody
        Its mirrors, ends and controls say what is run.
    at : Conditions, optional
        Fresh water of 20 deg C and 2 m/s unless given.
    """
    body = surface.body
    scaling = _scaling(body) or Scaling(surface.length, "LOA")
    sweeps = test_matrix.default_sweeps(surface, scaling.length)
    conditions = test_matrix.conditions(sweeps, surface, at.speed, scaling.length)
    angles = {
        name: f"[{', '.join(quoted(f'{np.degrees(a):.4g} deg') for a in getattr(sweeps, name))}]"
        for name in ("drift", "attack")
    }
    yaw = f"[{', '.join(f'{r:g}' for r in sweeps.yaw)}]"
    drifts, arms = ([c.name for c in conditions if c.kind is kind and min(_sideways(c)) >= 0.0] for kind in _STUDIED)
    controls = ", ".join(
        f'{{ name = {quoted(name)}, angles = ["-10 deg", "-5 deg", "5 deg", "10 deg"] }}'
        for name in dict.fromkeys(c.name for c in body.controls)
    )
    return own_text(files("coeflab.tank") / "default_tank.toml.txt").format(
        body=body, at=at, scaling=scaling, angles=angles, yaw=yaw, half=sweeps.yaw[-1] / 2.0, controls=controls,
        name=quoted(folder_name(body.name)), length_name=quoted(scaling.length_name),
        point=value([float(v) for v in body.reference_point]), fourfold="; from drift by fourfold symmetry" * (not sweeps.attack),
        without="   # the body has no [[control]] that turns" * (not controls), of_drift=drifts[min(1, len(drifts) - 1)],
        of_arm=arms[min(1, len(arms) - 1)],
    )  # fmt: skip


_STUDIED = (test_matrix.Kind.DRIFT, test_matrix.Kind.ARM)


def _sideways(condition: test_matrix.TowCondition) -> tuple[float, float]:
    return float(condition.velocity[1]), float(condition.rates[2])


def _scaling(body: Body) -> Scaling | None:
    """The body's own length of primes, else its length over all."""
    if body.scaling is not None:
        return body.scaling
    return next(
        (Scaling(length, name) for name, length in body.lengths.items() if "overall" in name or name == "LOA"), None
    )


def _tank(file: TomlFile, body: TowedBody | None, body_file: Path | None, solver: str, runner: str) -> Tank:
    given = takes.declared(TankFile, file)
    where = _where(file, given.tank.body, body_file)
    own = read_body(where) if body is None else body.body
    require_orientation(own)
    scaling = given.scaling or _scaling(own)
    if scaling is None and body is not None:
        scaling = Scaling(body.length, "LOA")
    if scaling is None:
        raise file.fail("scaling.length", "nothing", "a length", "Add [scaling] with length and length_name.")
    towed = (
        body if body is None or given.tank.symmetry else replace(body, mirrors=(False, False, False), fourfold=False)
    )
    speed = given.conditions.speed
    sweeps = _sweeps(given.matrix, towed, scaling.length)
    try:
        if sweeps == Sweeps():
            raise InputError(  # noqa: TRY301
                "no condition", "an angle, a rate or a speed", column="matrix",
                advice='drift = ["2 deg", "4 deg"], or speeds = ["1 m/s"] for the resistance alone; a list left out gives its default.',
            )  # fmt: skip
        matrix = test_matrix.conditions(sweeps, towed, speed, scaling.length)
        matrix = test_matrix.with_studies(matrix, [study.built for study in given.study])
    except InputError as why:
        raise file.fail(why.column or "matrix", why.found, why.expected, why.advice) from None
    chosen, carried_by = solver or given.tank.solver, runner or given.tank.runner
    options = _options(file, "solver", SOLVERS, given.solver, chosen, "tank.solver" if not solver else "")
    carrying = _options(file, "runner", RUNNERS, given.runner, carried_by, "tank.runner" if not runner else "")
    point = own.reference_point if given.tank.reference_point is None else given.tank.reference_point
    return Tank(
        name=given.tank.name or folder_name(own.name),
        title=own.title or own.name if given.tank.title is None else given.tank.title,
        body=where,
        datum=Datum.named(own.datum.id, own.datum.note),
        reference_point=point,
        scaling=scaling,
        conditions=Conditions(given.conditions.density, speed, given.conditions.viscosity),
        matrix=matrix,
        grids=given.grids,
        solver=chosen,
        options=options,
        cores=given.tank.cores,
        by_symmetry=test_matrix.stated(towed, sweeps),
        symmetry=test_matrix.symmetries(towed),
        runner=carried_by,
        runner_options=carrying,
    )


def _where(file: TomlFile, named: Path | None, given: Path | None) -> Path:
    """The body.toml, which the file and the command line may both name."""
    if named is None and given is None:
        raise file.fail("tank.body", "nothing", "the path of a body.toml, or a shipped name", "Add tank.body.")
    if named is None or given is None:
        return _body_file(cast("Path", given if named is None else named)).resolve()
    one, other = _body_file(named).resolve(), _body_file(given).resolve()
    if one != other:
        raise file.fail("tank.body", shown(named), f"{shown(given)}, the body that is to be towed, or no key at all")
    return one


def _sweeps(keys: MatrixKeys, body: TowedBody | None, length: float) -> Sweeps:
    default = test_matrix.default_sweeps(body, length)
    controls: dict[str, tuple[float, ...]] = {}
    for one in keys.control:
        controls[one.symbol] = (*controls.get(one.symbol, ()), *one.angles)
    return Sweeps(
        drift=default.drift if keys.drift is None else keys.drift,
        attack=default.attack if keys.attack is None else keys.attack,
        yaw=default.yaw if keys.yaw is None else keys.yaw,
        pitch=keys.pitch,
        combined=tuple((c.drift, c.attack, c.yaw, c.pitch) for c in keys.combined),
        controls=controls,
        speeds=keys.speeds,
        pairs=keys.pairs,
    )


def _options(
    file: TomlFile, section: str, plugins: Registry[Any], given: Mapping[str, Any], chosen: str, key: str
) -> dict[str, Any]:
    """What the declaration of the chosen plugin reads from ``[solver.NAME]``; tables of others are checked as well.

    Raises
    ------
    InputError
        A table of no plugin, or wrong keys in one.
    PluginError
        No such plugin.
    """
    known = plugins.names()
    if chosen not in known and key:
        raise file.fail(key, shown(chosen), f"one of {', '.join(known)}")
    complaints, out = [], {}
    for name in dict.fromkeys((*given, chosen)):
        if name not in known and name != chosen:
            complaints.append(file.fail(f"{section}.{name}", shown(name), f"one of {', '.join(known)}"))
            continue
        declaration: type[Declaration] = plugins.load(name).options
        try:
            read = takes.validated(declaration, given.get(name, {}), file.path, file.line, (section, name))
        except InputError as why:
            complaints += [why, *why.others]
            continue
        if name == chosen:
            out = {f.name: getattr(read, f.name) for f in fields(cast("Any", read))}
    if complaints:
        raise together(complaints)
    return out
