"""Names that people bring from lmfit, xarray, pandas and statsmodels: each is there, or the error says what is."""

from __future__ import annotations

import re
from typing import Any

import pytest

import coeflab as cf
from coeflab.core.missed import nearest, suggesting

GUESSES = {
    "Result": "params coefficients coef values bestfit_values stderr errors uncertainties covar cov covariance fit_report to_dataframe residuals "
    "residual plot_fit plots predict sample draw conf_int intervals",
    "Table": "data df to_dataframe to_pandas columns rows force moments velocities speeds draw describe origin note",
    "Body": "mesh vertices length dimensions added_masses mass_matrix displacement masses volumes plots view geometry draw",
    "AddedMass": "array to_numpy values value M to_dataframe df draw show diag tensor derivative",
    "Vehicle": "params coefficients derivatives coefs mass to_json write to_file linearize state_space run exports diff equilibrium to_dataframe warnings",
    "Motion": "time position states path history metrics figures overshoot to_dataframe df draw report describe note warnings",
    "Study": "coefficients fit results files save_figures savefig html to_html write vehicles warnings figure tests_ plots",
    "Comparison": "diff ratios table to_dataframe df report describe draw plots differences note",
    "Trim": "controls inputs state to_dataframe df equilibrium table warnings",
    "LinearModel": "eig poles eigs pole mode damping a_matrix b_matrix write to_file",
    "FittedLaw": "predict eval at to_dataframe df draw curve value",
}


def known(kind: type) -> list[str]:
    return [n for n in dir(kind) if not n.startswith("_")] + ["[]"] * hasattr(kind, "__getitem__")


@pytest.mark.parametrize("name", GUESSES)
def test_what_is_missed_is_named(name: str) -> None:
    """Every suggestion begins with a member that there is; nine of ten guesses have one or are there."""
    kind = getattr(cf, name)
    there, lost = known(kind), []
    for guess in GUESSES[name].split():
        near = nearest(guess, there)
        if guess not in there and not near:
            lost.append(guess)
        assert not near or ("[]" if near[0] == "[" else re.split(r"\W", near)[0]) in there
    assert len(lost) <= len(GUESSES[name].split()) / 10, lost


@pytest.mark.parametrize("name", GUESSES)
def test_the_error_of_a_noun_says_it(name: str) -> None:
    kind: Any = getattr(cf, name)
    noun = object.__new__(kind)
    with pytest.raises(
        AttributeError, match=r"Did you mean \.(frame|plot|matrix|save|report|figures|volume|eigenvalues|evaluate)"
    ):
        getattr(noun, {"Body": "volumes", "LinearModel": "poles", "Study": "html"}.get(name, "to_dataframe"))
    with pytest.raises(AttributeError):
        _ = noun.__array_interface__


def test_an_error_within_a_property_stays_its_own() -> None:
    @suggesting
    class Noun:
        @property
        def value(self) -> float:
            return [].nothing  # type: ignore[attr-defined,no-any-return]

    with pytest.raises(AttributeError, match="'list' object has no attribute 'nothing'"):
        _ = Noun().value


@pytest.mark.parametrize(
    ("guess", "meant"),
    [("read_csv", "read_table"), ("load_mesh", "read_body"), ("load_vehicle", "read_vehicle"), ("linearize", "read_vehicle(...).linear()"),
     ("zigzag", "simulate"), ("added_mass", "read_body(...).added_mass()"), ("simulat", "simulate"), ("datasets", "shipped_names")],
)  # fmt: skip
def test_the_package_says_which_verb_is_meant(guess: str, meant: str) -> None:
    with pytest.raises(AttributeError, match=re.escape(f"Did you mean coeflab.{meant}?")):
        getattr(cf, guess)
