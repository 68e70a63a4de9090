"""A law that somebody stated as a fitted table without points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Term = tuple[tuple[tuple[str, int, bool], ...], float]


def stated_table(
    response: str,
    variables: Mapping[str, tuple[str, float, float]],
    terms: Mapping[str, Term],
    per_unit: float,
    *,
    form: str,
    table: str,
    campaign: str,
    statements: tuple[str, ...],
    unit: str = "1",
) -> dict[str, Any]:
    """A law that somebody stated as a fitted table without points, for `ParameterFile.models`.

    Parameters
    ----------
    response : str
        For example ``C_D`` or ``N``.
    variables : mapping of str to (unit, low, high)
    terms : mapping of symbol to (factors, value)
        Factors are (variable, power, absolute); values in the unit of the source.
    per_unit : float
        What a value is divided by to be in ``unit``.
    form, table, campaign : str
        Words for where it comes from.
    statements : tuple of str
    unit : str
    """
    low, high = tuple(v[1] for v in variables.values()), tuple(v[2] for v in variables.values())
    count = len(variables)
    spaces = []
    for i in range(count):
        row = [0.0] * count
        row[i] = -1.0
        spaces.append((*row, low[i]))
        row[i] = 1.0
        spaces.append((*row, -high[i]))
    return {
        "response": response, "unit": unit, "form": form,
        "variables": tuple({"name": name, "unit": of} for name, (of, _, _) in variables.items()),
        "terms": tuple(
            {
                "symbol": symbol,
                "factors": tuple({"variable": v, "power": n, "absolute": a} for v, n, a in factors),
                "value": float(f"{value / per_unit:.12g}"),
                "half_width_95": None,
            }
            for symbol, (factors, value) in terms.items()
        ),
        "covariance": tuple((None,) * len(terms) for _ in terms),
        "domain": {"low": low, "high": high, "half_spaces": tuple(spaces), "extrapolation": "clamp"},
        "n_points": 0, "rms": 0.0, "press_rms": None, "table": table, "campaign": campaign, "statements": statements,
        "holds": (),
        "contains_potential": False,
    }  # fmt: skip
