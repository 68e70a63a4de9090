"""`vehicle`, `read_vehicle` and `Vehicle`: a parameter file, and what is done with it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from coeflab.api.body import Body, read_body
from coeflab.api.comparing import Comparison
from coeflab.api.comparing import compare as compared
from coeflab.api.exporting import export as exported
from coeflab.api.motion import Motion
from coeflab.api.motion import simulate as simulated
from coeflab.api.parameters import parameters_of
from coeflab.api.questions import above_zero, si, three
from coeflab.api.result import Result
from coeflab.api.trimming import LinearModel, LinearSchedule, Trim, linear_model, trim
from coeflab.bodies import body as plain
from coeflab.core.axes import ANYWHERE
from coeflab.core.errors import InputError, shown
from coeflab.core.files import stem, write_atomically
from coeflab.core.keywords import all_spoken
from coeflab.core.machine import one_thread
from coeflab.core.missed import suggesting, was_method
from coeflab.core.table import Check
from coeflab.core.types import in_angles
from coeflab.fits.joint.moving import fits_about
from coeflab.formats.export import Export
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import primed
from coeflab.law.water import conditions_of
from coeflab.study.estimated_vehicle import estimated
from coeflab.study.study import Plan
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.from_shape import Stated
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.merge import merged
from coeflab.vehicle.own_numbers import OwnNumber, as_file, own_numbers, typed_surfaces, typed_thrusters
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.plausibility import plausibility
from coeflab.vehicle.stability import DRAWS, INDICES, missing_for_stability, sense, stability

if TYPE_CHECKING:
    import pandas as pd


@suggesting
@dataclass(frozen=True, slots=True, eq=False)
class Vehicle:
    """What a simulator needs of a vehicle: coefficients with covariance, mass, added mass, thrusters, controls.

    Attributes
    ----------
    file : ParameterFile
        All of it, as its JSON has it.

    Examples
    --------
    >>> import coeflab as cf
    >>> auv = cf.read_vehicle("remus100")
    >>> auv.name, round(auv["Nuv'"].value, 4)
    ('remus100', -0.0198)
    """

    file: ParameterFile

    def __repr__(self) -> str:
        valued = sum(c.value is not None for c in self.file.coefficients)
        return in_angles(self, f"{self.name}: {valued} coefficients")

    def _repr_html_(self) -> str:
        return self.file._repr_html_()

    def __getitem__(self, symbol: str) -> Coefficient:
        """A coefficient by its symbol, with or without prime.

        Raises
        ------
        KeyError
            The file has none of that symbol.
        """
        found = self.file.coefficient(primed(symbol.removesuffix("'")))
        if found is None and symbol in INDICES:
            raise KeyError(f"{symbol} is no coefficient: it is a row of .stability()")
        if found is None:
            raise KeyError(f"no {symbol} among {', '.join(c.symbol for c in self.file.coefficients)}")
        return found

    def __contains__(self, symbol: object) -> bool:
        return isinstance(symbol, str) and self.file.coefficient(primed(symbol.removesuffix("'"))) is not None

    @property
    def name(self) -> str:
        """Of the file."""
        return self.file.name

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a reader has to know, in words; where the law holds, if that is less than the data span."""
        return all_spoken((*self.file.remarks, *self.file.narrowed))

    def frame(self) -> pd.DataFrame:
        """A row a coefficient: value and u95 primed, value_si with its unit, status, origin.

        Examples
        --------
        >>> import coeflab as cf
        >>> bool(cf.read_vehicle("remus100").frame().loc["Nur'", "value"] < 0)
        True
        """
        import pandas as pd

        rows = [
            {
                "value": np.nan if c.value is None else c.value, "u95": np.nan if c.u95 is None else c.u95,
                "value_si": np.nan if c.value_si is None else c.value_si, "unit_si": c.unit_si, "status": str(c.status),
                "origin": c.origin,
            }
            for c in self.file.coefficients
        ]  # fmt: skip
        return pd.DataFrame(rows, index=pd.Index([c.symbol for c in self.file.coefficients], name="symbol"))

    def stability(self, draws: int = DRAWS) -> pd.DataFrame:
        """G_h and G_v, the indices of straight-line stability: a row each that mass and derivatives give.

        Parameters
        ----------
        draws : int
            Of the Monte Carlo limits beside the linear half-width.

        Returns
        -------
        DataFrame
            value; u95, NaN where it is unknown or stands for no interval; low, high of 95 %; says: stable, unstable, sign open.

        Raises
        ------
        InputError
            Neither plane has mass and four derivatives.

        Examples
        --------
        >>> import coeflab as cf
        >>> list(cf.vehicle("suboff_bare_hull", mass=700).stability().index)
        ['G_h', 'G_v']
        """
        import pandas as pd

        indices = stability(self.file, draws)
        if not indices:
            lacks = ", ".join(missing_for_stability(self.file))
            raise InputError(f"{self.name} without {lacks}", "mass and four derivatives of a plane", column="stability")
        rows = [
            {
                "value": found.value, "u95": np.nan if found.half_width is None else found.half_width,
                "low": np.nan if found.interval is None else found.interval[0],
                "high": np.nan if found.interval is None else found.interval[1], "says": sense(found),
            }
            for found in indices
        ]  # fmt: skip
        columns = ["value", "u95", "low", "high", "says"]
        return pd.DataFrame(rows, columns=columns, index=pd.Index([i.name for i in indices], name="index"))

    def save(self, path: str | Path | None = None) -> Path:
        """Write the parameter file.

        Parameters
        ----------
        path : str or Path, optional
            A file that ends in .json, whose folders are made, or a folder that is there; by default NAME.parameters.json here.

        Returns
        -------
        Path
            Of the file.

        Raises
        ------
        InputError
            Another ending: a parameter file is JSON.

        Examples
        --------
        >>> import tempfile, coeflab as cf
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     cf.read_vehicle("remus100").save(folder).name
        'remus100.parameters.json'
        """
        file = Path(path) if path is not None else Path()
        file = file / f"{self.name}.parameters.json" if file.is_dir() else file
        if file.suffix.lower() != ".json":
            raise InputError(shown(str(file)), "a folder that is there, or a name that ends in .json", column="path")
        write_atomically(file, self.file.to_json())
        return file

    @overload
    def linear(self, speed: float | str | None = None, **options: Any) -> LinearModel: ...
    @overload
    def linear(self, speed: list[Any] | tuple[Any, ...], **options: Any) -> LinearSchedule: ...
    def linear(
        self,
        speed: float | str | list[Any] | tuple[Any, ...] | None = None,
        *,
        also: Sequence[str] = (),
        lags: Mapping[str, float] | None = None,
        commands: Mapping[str, float | str] | None = None,
        plane: str = "",
        free: Sequence[str] = (),
        tables: bool = False,
        accelerations: str = "measured",
        **motion: float | str,
    ) -> LinearModel | LinearSchedule:
        """Small motions about a steady one: x_dot = A x + B d, y = C x + D d; SI, rad, FRD.

        Parameters
        ----------
        speed : float or str, or a list of them, optional
            u, m/s.
        also : sequence of str
            Of depth and heading: further states.
        lags : mapping of str to float, optional
            Time constant of a thruster or a control, s: a state NAME_lagged follows the command.
        commands : mapping of str to float, optional
            Held: thrusters in their units, controls and tilts in rad.
        plane : {"", "horizontal", "vertical"}
        free : sequence of str
            Motions that may change, of u v w p q r.
        tables : bool
            Fitted tables come before derivatives.
        accelerations : {"measured", "computed"}
        **motion
            sway, heave (m/s), yaw_rate (rad/s), roll, pitch (rad, or "2 deg").

        Returns
        -------
        LinearModel, or LinearSchedule of several speeds
            ``A``, ``B``, ``states``, ``commands``, ``modes``; ``save`` as .mat, .npz, .json.

        Raises
        ------
        InputError
            No steady motion, a motion that the file does not know, a state that nothing moves.

        Examples
        --------
        >>> import coeflab as cf
        >>> model = cf.read_vehicle("remus100").linear(speed=1.5)
        >>> model.A.shape == (len(model.states),) * 2
        True
        """
        if isinstance(speed, list | tuple):
            speeds = [si(v, "speed", "speed") for v in speed]
            if not speeds:
                raise InputError("no speed", "one or more", column="speed")
            more: dict[str, Any] = {
                "also": also, "lags": lags, "commands": commands, "plane": plane, "free": free, "tables": tables,
                "accelerations": accelerations, **motion,
            }  # fmt: skip
            return LinearSchedule(tuple(speeds), tuple(self.linear(v, **more) for v in speeds))
        asked: dict[str, Any] = dict(motion) if speed is None else {"speed": speed, **motion}
        steady = trim(
            self, commands=commands, plane=plane, free=free, tables=tables, accelerations=accelerations, **asked
        )
        return linear_model(steady, also, lags)

    def equipped(
        self, *, rudder: str = "", stern_planes: str = "", bow_planes: str = "", thrusters: str | Sequence[str] = ()
    ) -> Vehicle:
        """The vehicle with other limits and rates of its controls, or other thrusters; its coefficients stay.

        Parameters
        ----------
        rudder, stern_planes, bow_planes : str
            Limit and rate, ``"25 deg, 40 deg/s"``, or the limit alone.
        thrusters : str or sequence of str
            As of `coeflab.vehicle`; they take the place of all that it has.

        Raises
        ------
        InputError
            What is no angle, rate or thruster.

        Examples
        --------
        >>> import coeflab as cf
        >>> auv = cf.read_vehicle("remus100").equipped(rudder="12 deg, 30 deg/s")
        >>> [(s.control, round(s.limit, 4)) for s in auv.file.surfaces]
        [('dr', 0.2094)]
        """
        driven = typed_thrusters([thrusters] if isinstance(thrusters, str) else thrusters, self.file.conditions)
        fins = typed_surfaces(rudder, stern_planes, bow_planes)
        if not driven and not fins:
            return self
        held = tuple(s for s in self.file.surfaces if s.control not in {f.control for f in fins})
        update = {"thrusters": driven or self.file.thrusters, "surfaces": (*held, *fins)}
        return Vehicle(self.file.model_copy(update=update))

    def trim(self, **asked: Any) -> Trim:
        """A steady motion; see `coeflab.trim`."""
        return trim(self, **asked)

    @property
    def checks(self) -> tuple[Check, ...]:
        """What ``coeflab params check`` finds: signs, sizes, what stands twice.

        Examples
        --------
        >>> import coeflab as cf
        >>> {str(c.severity) for c in cf.read_vehicle("remus100").checks} <= {"pass", "note", "warn", "fail"}
        True
        """
        return was_method("checks", tuple(c.spoken() for c in plausibility(self.file)))

    def simulate(self, manoeuvre: str, **options: Any) -> Motion:
        """A manoeuvre; see `coeflab.simulate`."""
        return simulated(self, manoeuvre, **options)

    def export(self, to: str, out: str | Path, **options: Any) -> Export:
        """Files for a simulator; see `coeflab.export`.

        Parameters
        ----------
        to : str
            Target.
        out : str or Path
            Folder to write into.
        **options
            accept_loss, accelerations.
        """
        return exported(self, to, out, **options)

    def compare(self, other: Vehicle | ParameterFile | str | Path) -> Comparison:
        """Against another vehicle; see `coeflab.compare`."""
        return compared(self, other)


def read_vehicle(source: str | Path | ParameterFile | Vehicle) -> Vehicle:
    """A vehicle from its parameter file.

    Parameters
    ----------
    source : str, Path, ParameterFile or Vehicle
        A file, or the name of a shipped one.

    Returns
    -------
    Vehicle

    Raises
    ------
    InputError
        Nothing there; all that breaks the schema, by line.

    Examples
    --------
    >>> import coeflab as cf
    >>> cf.read_vehicle("remus100").name
    'remus100'
    """
    return Vehicle(parameters_of(source))


@one_thread()
def vehicle(
    body: str | Path | plain.Body,
    *,
    mass: float | str | None = None,
    centre_of_gravity: Sequence[float] | None = None,
    inertia: Sequence[float] | None = None,
    coefficients: Result | ParameterFile | Vehicle | str | Path | None = None,
    density: float | str | None = None,
    speed: float | str | None = None,
    numbers: Mapping[str, str | float] | None = None,
    thrusters: str | Sequence[str] = (),
    rudder: str = "",
    stern_planes: str = "",
    bow_planes: str = "",
    method: str = "all",
    name: str | None = None,
) -> Vehicle:
    """A vehicle of a shape and a mass: added mass and estimates, of which fitted coefficients replace those that they give.

    Parameters
    ----------
    body : Body, str or Path
        With a shape.
    mass : float or str, optional
        kg; that of its file, else neutrally buoyant, which the remarks say.
    centre_of_gravity : (3,) sequence of float, optional
        m, FRD, from the body's datum.
    inertia : (3,) sequence of float, optional
        Ix, Iy, Iz about the centre of gravity, kg m^2.
    coefficients : Result, Vehicle, str or Path, optional
        From `coeflab.fit`, or of another parameter file.
    density, speed : float or str, optional
        Of the water and of reference; fresh water and 2 m/s unless given.
    numbers : mapping, optional
        Coefficients of your own, which replace all others: ``{"Ydr'": 0.01, "Nr": "-9 +- 2 N m/(rad/s)"}``; a number alone is a prime.
    thrusters : str or sequence of str
        ``"main; bollard = 60 N; rate = 720; place = -0.8, 0, 0"``: keys of [[thruster]] of a body.toml; in place of the body's.
    rudder, stern_planes, bow_planes : str
        Limit and rate, ``"25 deg, 40 deg/s"``, in place of the body's. Their forces are coefficients with dr, ds, db.
    method : str
        Of added mass.
    name : str, optional
        The body's unless given.

    Returns
    -------
    Vehicle

    Raises
    ------
    InputError
        A body without a shape or volume, a mass that no body has.
    ScalingMismatchError
        Coefficients of another datum.

    Examples
    --------
    >>> import coeflab as cf
    >>> auv = cf.vehicle("remus100", mass=30.5)
    >>> auv["Nr'"].value < 0, str(auv["Nr'"].status)
    (True, 'estimate')
    >>> own = {"Ydr'": 0.008, "Ndr'": -0.004}
    >>> steered = cf.vehicle("spheroid_example", mass=390, numbers=own, rudder="25 deg", thrusters="main; bollard = 60 N; rate = 720")
    >>> [t.name for t in steered.file.thrusters], steered["Ndr'"].value
    (['main'], -0.004)
    """
    hull = read_body(body)
    if isinstance(coefficients, Result) and coefficients.fits:
        hull = _of_datum(hull, coefficients)
    conditions, unstated = conditions_of(
        None if density is None else above_zero(density, "density", "density"),
        None if speed is None else above_zero(speed, "speed", "speed"),
    )
    stated = Stated(
        None if mass is None else above_zero(mass, "mass", "mass"),
        None if centre_of_gravity is None else three(centre_of_gravity, "length", "centre_of_gravity"),
        None if inertia is None else np.diag(three(inertia, "inertia", "inertia")),
        unstated,
    )
    called = stem(name or hull.name)
    result = estimated(Plan(called, hull.title or called, (), conditions=conditions, method=method), hull, stated)
    base = next(iter(result.parameter_files.values())).model_copy(update={"name": called})
    if coefficients is not None:
        other = (
            _fitted_file(coefficients, base, hull) if isinstance(coefficients, Result) else parameters_of(coefficients)
        )
        own = coefficients.tables[0].scaling if isinstance(coefficients, Result) and coefficients.tables else None
        base = merged(base, other, called, own).parameters
    if numbers:
        base = merged(base, as_file(base, _read(numbers)), called, base.scaling).parameters
    return Vehicle(base).equipped(rudder=rudder, stern_planes=stern_planes, bow_planes=bow_planes, thrusters=thrusters)


def _read(numbers: Mapping[str, str | float]) -> tuple[OwnNumber, ...]:
    try:
        return own_numbers([f"{symbol}={value}" for symbol, value in numbers.items()])
    except InputError as why:
        for one in (why, *why.others):
            one.column = "numbers"
            one.args = (str(one),)
        raise


def _of_datum(hull: Body, result: Result) -> Body:
    """The body by the datum of the fits, where it is a bare mesh and they count from its nose."""
    datum = next((f.coefficients.datum.id for f in result.fits if f.coefficients.datum != ANYWHERE), hull.datum.id)
    bare = hull.datum.is_of_file and hull.datum.id != datum
    return hull.counted_from(datum) if bare else hull


def _fitted_file(result: Result, base: ParameterFile, hull: Body) -> ParameterFile:
    """The parameter file of fits alone, primed and about the point of the vehicle, to which each helps the others."""
    point = np.array(base.reference_point.point)
    at = (hull.datum, point)
    fits = [
        replace(f, coefficients=replace(f.coefficients, body=hull.name).counted_from(*at), body=hull.name)
        for f in result.fits
    ]
    fits = list(fits_about(fits, point, base.scaling))
    tables = [replace(t, body=hull.name).counted_from(*at).about(point) for t in result.tables]
    inputs = tuple(dict.fromkeys(f for t in result.tables for f in t.files))
    group = PlannedParameterFile(stem(hull.name), hull.name, tuple(f.campaign for f in fits), ())
    return assemble(group, base.name, fits, tables, [], (), None, base.conditions, inputs)
