"""An attribute that a noun has not: what people call it elsewhere, and its name here; one that was a method."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from typing import Any, TypeVar

Noun = TypeVar("Noun")
# What is typed: what to type in its place, the first whose member the noun has; small letters, without plural and underscores.
ELSEWHERE = {
    "frame()": "df dataframe toframe todataframe topandas asframe asdataframe pandas data row column asdict todict items",
    "frame().to_csv(path)": "csv tocsv savecsv excel toexcel",
    "summary()": "describe info fitreport tostring print printsummary result overview tabulate",
    "figures": "figure",
    "figures(folder)": "savefigure savefig figuresto",
    "simulation.figures": "figure metric overshoot",
    "point": "solution equilibrium operatingpoint",
    "plot()": "curve draw show fig figure ax picture plotfit plottrack view sketch",
    "report(path)": "html tohtml write writereport save pdf topdf document",
    "save(path)": "write tojson json dump tofile store saveas topath savefile",
    "file.to_json()": "tojson json dumps asjson",
    "export(to, out)": "to toxdyn togazebo exportto simulator",
    "covariance": "cov covar covariancematrix covmatrix correlation correl corr",
    "['SYMBOL'].value": "value param parameter coefficient coef coeff bestvalue derivative estimate slope",
    "['SYMBOL'].u95": "stderr error uncertainty u95 sigma interval ci confidence confidenceinterval confint bse",
    "['NAME'].value": "value",
    "points('SYMBOL')": "residual resid point fitted fittedvalue predict",
    "laws": "law model polynomial surface",
    "laws['NAME'].evaluate(...)": "predict evaluate eval call",
    "evaluate(...)": "predict eval value call at",
    "samples(n)": "sample draw bootstrap random montecarlo mc",
    "checks": "check validate verify warning issue problem finding",
    "remarks": "note remark warning comment message",
    "notes": "note remark warning comment message",
    "statements": "note remark warning statement comment message",
    "tables": "table data",
    "motion": "velocity velocities state kinematic",
    "forces": "force load moment wrench",
    "varies": "variable sweep swept",
    "usable": "mask valid used",
    "speed": "velocity",
    "labels": "name index run",
    "reference_point": "origin point about moment_center momentcentre center centre",
    "matrix": "array numpy tonumpy asarray values value m ma addedmass tensor toarray",
    "matrix.diagonal()": "diagonal diag",
    "added_mass()": "addedmass ma addedmassmatrix computeaddedmass",
    "volume": "displacement vol",
    "displaced_mass()": "mass displacement weight",
    "lengths": "length dimension size particular bound extent",
    "shape": "mesh geometry surface vertice vertex face",
    "file.mass": "mass inertia",
    "file.added_mass": "addedmass ma massmatrix",
    "file.coefficients": "coefficient coef param parameter symbol keys derivative",
    "linear()": "linearize linearise linearmodel statespace ss linearization lti",
    "linear().A": "a matrix",
    "linear().B": "b",
    "simulate(manoeuvre)": "run manoeuvre maneuver manoeuvring simulation zigzag turningcircle",
    "trim()": "equilibrium steady steadystate",
    "compare(other)": "diff comparewith comparison difference",
    "trajectory": "path position time t state solution y track history",
    "commands": "command control input thrust",
    "eigenvalues": "eig eigenvalue pole eigval eigvals root",
    "modes": "mode damp damping",
    "A": "amatrix systemmatrix a",
    "B": "bmatrix inputmatrix b",
    "result": "coefficient fit coef fitted param value derivative",
    "vehicle()": "parameter file model parameterfile",
    "parameter_files": "file parameter",
    "rows": "row coefficient symbol difference diff ratio delta",
    "conditions": "case condition matrix runs",
    "files": "file path",
    "run(folder)": "start execute launch submit go",
    "figure_table()": "table",
}  # fmt: skip
VERBS = {
    "read_table": "load loadtable open opentable readcsv loadcsv readexcel readdata loaddata fromdataframe fromdict importtable import data forcetable",
    "read_body": "loadbody readmesh loadmesh readstl mesh hull shape",
    "read_body(...).added_mass()": "addedmass computeaddedmass massmatrix",
    "read_vehicle": "loadvehicle readparameters loadparameters parameters auv readparameterfile",
    "fit": "fittable regress regression curvefit slope derivative coefficient solve",
    "vehicle": "makevehicle createvehicle buildvehicle newvehicle merge",
    "simulate": "simulation sim manoeuvre maneuver zigzag turningcircle move",
    "export": "write save toxdyn dump",
    "compare": "diff comparison",
    "trim": "equilibrium operatingpoint steady steadystate",
    "read_vehicle(...).linear()": "linear linearize linearise statespace",
    "run": "study runplan plan runstudy report",
    "fit(...).plot()": "plot draw figure",
    "next_tests": "design plantests nexttest doe next",
    "shipped_names": "list names available examples datasets",
    "validation": "validate validations",
    "tow": "tank towtank cfd openfoam",
}  # fmt: skip


@cache
def _by_word(verbs: bool) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for here, elsewhere in (VERBS if verbs else ELSEWHERE).items():
        for word in elsewhere.split():
            found.setdefault(word, []).append(here)
    return found


def nearest(name: str, known: Iterable[str], verbs: bool = False) -> str:
    """What to type in the place of a name that there is not; empty where nothing is near.

    Parameters
    ----------
    name : str
    known : iterable of str
        Names that there are; ``[]`` where items are taken.
    verbs : bool
        Of the package, not of a noun.

    Examples
    --------
    >>> nearest("to_dataframe", ("frame", "plot")), nearest("plots", ("frame", "plot")), nearest("cov", ("frame",))
    ('frame()', 'plot', '')
    """
    from difflib import get_close_matches  # nobody misses a name in a run that ends well

    names = {n for n in known if not n.startswith("_")}
    folded = name.casefold().replace("_", "")
    for word in (folded, folded.removesuffix("s"), folded.removesuffix("es")):
        for here in _by_word(verbs).get(word, ()):
            if ("[]" if here[0] == "[" else re.split(r"\W", here)[0]) in names:
                return here
    near = get_close_matches(name, sorted(names), 1, 0.6)
    return near[0] if near else ""


def suggesting(cls: type[Noun]) -> type[Noun]:
    """Give a class errors for attributes that it has not, which name the one that is meant."""
    cls.__getattr__ = _missed  # type: ignore[attr-defined]
    return cls


def _missed(noun: object, name: str) -> Any:
    kind = type(noun)
    if name in dir(kind):
        return object.__getattribute__(noun, name)  # a property whose own error this is
    if name.startswith("_"):
        raise AttributeError(f"{kind.__name__!r} object has no attribute {name!r}")
    near = nearest(name, [*dir(kind), *(["[]"] if hasattr(kind, "__getitem__") else [])])
    meant = f" Did you mean {'' if near[:1] == '[' else '.'}{near}?" if near else ""
    every = ", ".join(n for n in dir(kind) if not n.startswith("_"))
    raise AttributeError(
        f"{kind.__name__!r} has no {name!r}.{meant}" if meant else f"{kind.__name__!r} has no {name!r}; it has {every}"
    )


class _Called:
    """A value that a method gave until 0.2: called, it warns and gives itself."""

    def __call__(self) -> Any:
        import warnings

        name = vars(self)["called"]
        warnings.warn(
            f"{name} is an attribute: .{name} without (); {name}() goes in 0.4", DeprecationWarning, stacklevel=2
        )
        return self


class _CalledTuple(_Called, tuple[Any, ...]):
    pass


class _CalledText(_Called, str):
    pass


class _CalledDict(_Called, dict[str, Any]):
    pass


def was_method(name: str, value: Noun) -> Noun:
    """The value of an attribute that was a method without arguments, which may go on being called.

    Parameters
    ----------
    name : str
        Of the attribute.
    value : tuple, str or dict
    """
    kinds: dict[type, Any] = {tuple: _CalledTuple, str: _CalledText, dict: _CalledDict}
    out = kinds[type(value)](value)
    out.called = name
    return out  # type: ignore[no-any-return]
