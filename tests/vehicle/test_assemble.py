"""Which of several values a parameter file takes, and what cannot be put into one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, ScalingMismatchError
from coeflab.fits.results.fit_result import FitResult
from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
from coeflab.law.scaling import Conditions, Scaling
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.published_values import Literature, PublishedValue, Reference, Relation

SCALING = Scaling(2.0, "L")


def fitted(campaign: str, values: dict[str, float | None], scaling: Scaling = SCALING, body: str = "b") -> FitResult:
    u95 = 0.002
    variances = [np.nan if v is None else (u95 / 2.0) ** 2 for v in values.values()]
    coefficients = CoefficientSet(
        tuple(
            Coefficient(
                s, v, None if v is None else u95, Status.TOO_FEW_POINTS if v is None else Status.OK, body,
                origin="none" if v is None else "fit", campaign=campaign,
            )
            for s, v in values.items()
        ),
        np.diag(variances), scaling, np.zeros(3), Datum("nose"), body,
    )  # fmt: skip
    return FitResult("f", campaign, body, coefficients, (), (), {})


def reference(values: dict[str, float | None], scaling: Scaling = SCALING) -> Reference:
    printed = tuple(PublishedValue(s, str(v) if v is not None else "0.1?", v) for s, v in values.items())
    return Reference(
        "lit", "synthetic", "p. 1", "b", Relation.QUOTED, (), scaling, None, "", (),
        (Literature("rotary", "PMM", 0.1, printed),), {}, np.zeros(3),
    )  # fmt: skip


def made(
    fits: list[FitResult], literature: Reference | None = None, campaigns: tuple[str, ...] = ("a", "c")
) -> ParameterFile:
    group = PlannedParameterFile("file", "b", campaigns, ("lit",) if literature else ())
    references = [literature] if literature else []
    return assemble(group, "study", fits, [], [], references, None, Conditions(1000.0, 2.0), [])


def value(file: ParameterFile, symbol: str) -> float | None:
    found = file.coefficient(symbol)
    return found.value


def test_the_earlier_campaign_counts() -> None:
    file = made([fitted("a", {"Yv": -0.03}), fitted("c", {"Yv": -0.04, "Nv": -0.01})])
    assert value(file, "Yv") == -0.03
    assert value(file, "Nv") == -0.01
    assert file.provenance.notes == ("Yv' from a; c gives -0.04",)


def test_a_value_comes_before_none() -> None:
    file = made([fitted("a", {"Yv": None, "Nv": None}), fitted("c", {"Yv": -0.04, "Nv": None})])
    assert value(file, "Yv") == -0.04
    assert value(file, "Nv") is None
    assert "Yv' from c; a gives no value" in file.provenance.notes


def test_a_fit_comes_before_literature_and_literature_before_nothing() -> None:
    literature = reference({"Yv": -9.0, "Yr": 0.005, "Nr": -0.004, "Nv": None})
    file = made([fitted("a", {"Yv": -0.03, "Yr": None, "Nv": None})], literature, ("a",))
    assert value(file, "Yv") == -0.03
    assert (value(file, "Yr"), value(file, "Nr")) == (0.005, -0.004)
    yr, nv = file.coefficient("Yr"), file.coefficient("Nv")
    assert (yr.origin, yr.status, yr.u95) == ("literature", "stated", pytest.approx(0.0005))
    assert (nv.value, nv.status) == (None, "too_few_points")


def test_literature_is_rescaled() -> None:
    file = made([fitted("a", {"Yv": -0.03})], reference({"Yr": 0.005}, Scaling(4.0, "LOA")), ("a",))
    assert value(file, "Yr") == pytest.approx(0.005 * 2.0**3)


def test_covariance_follows_its_campaign() -> None:
    a = fitted("a", {"Yv": -0.03, "Nv": -0.01})
    correlated = replace(a.coefficients, covariance=np.array([[1e-6, 5e-7], [5e-7, 1e-6]]))
    file = made([replace(a, coefficients=correlated), fitted("c", {"Zw": -0.02})])
    i, j, k = (file.covariance.symbols.index(s) for s in ("Yv'", "Nv'", "Zw'"))
    assert file.covariance.matrix[i][j] == 5e-7
    assert file.covariance.matrix[i][k] == 0.0


def test_what_does_not_mix() -> None:
    one = fitted("a", {"Yv": -0.03})
    with pytest.raises(ScalingMismatchError, match="do not mix"):
        made([one, fitted("c", {"Nv": -0.01}, Scaling(2.0, "other"))])
    with pytest.raises(ScalingMismatchError, match="is about x"):
        made([one, fitted("c", {"Nv": -0.01}, body="x")])
    moved = fitted("c", {"Nv": -0.01, "Yv": 0.1})
    moved = replace(moved, coefficients=moved.coefficients.about(np.array([1.0, 0.0, 0.0])))
    with pytest.raises(ScalingMismatchError, match="other reference points"):
        made([one, moved])
    with pytest.raises(InputError, match=r"parameter_file\.file\.campaigns.*no campaign"):
        made([one], campaigns=())
    elsewhere = replace(reference({"Yr": 0.1}), reference_point=np.ones(3))
    with pytest.raises(ScalingMismatchError, match="only about their own point"):
        made([one], elsewhere, ("a",))
    with pytest.raises(InputError, match='"lit" without reference_point'):
        made([one], replace(elsewhere, reference_point=None), ("a",))
