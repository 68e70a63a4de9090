"""``coeflab compare`` on fitted tables: a grid inside both domains, conversions, verdicts, what cannot be compared."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.vehicle.compared_models import MOST, ComparedModel, compare_models
from coeflab.vehicle.comparison import compare
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.shared_tables import Verdict
from tests.cli.conftest import Run, flat

PARAMS = Path(__file__).parents[1] / "data" / "parameters_1_1.json"
Change = Callable[[dict[str, Any]], object]


def changed(change: Change) -> ParameterFile:
    """The sample (synthetic data) with a change."""
    content = json.loads(PARAMS.read_text())
    change(content)
    return ParameterFile.model_validate(content)


def against(change: Change, first: Change = lambda _: None) -> dict[str, ComparedModel]:
    return {m.response: m for m in compare_models(changed(first), changed(change))}


def add_to_drag(shift: float) -> Change:
    def change(content: dict[str, Any]) -> None:
        content["models"][0]["terms"][0]["value"] += shift

    return change


def test_a_constant_shift_is_found_everywhere() -> None:
    found = against(add_to_drag(0.01))
    drag = found["C_D"]
    assert drag.rms == pytest.approx(0.01)
    assert drag.largest == pytest.approx(0.01)
    assert drag.verdict is Verdict.APART
    assert drag.share == 0.0
    assert 1000 < drag.n_points <= MOST
    assert found["C_n"].rms == 0.0
    assert found["C_n"].verdict is found["Y'"].verdict is Verdict.WITHIN


def test_the_combined_half_width_and_the_share_are_those_of_the_points() -> None:
    model = read_parameter_file(PARAMS).models[2]
    shift = 2e-4

    def change(content: dict[str, Any]) -> None:
        content["models"][2]["terms"][0]["value"] += shift

    found = against(change)["Y'"]
    v = np.linspace(model.domain.low[0], model.domain.high[0], MOST)
    half = np.sqrt(2.0) * model.evaluate({"v": v})[1]
    assert found.n_points == MOST
    assert found.combined == pytest.approx(np.sqrt(np.mean(half**2)), rel=1e-9)
    assert found.share == pytest.approx(np.mean(half >= shift))


def test_a_slope_is_largest_at_the_end_of_the_common_domain() -> None:
    def change(content: dict[str, Any]) -> None:
        y = content["models"][2]
        y["domain"].update(high=[0.2], half_spaces=[[1.0, -0.2], [-1.0, 0.0]])
        next(t for t in y["terms"] if t["symbol"] == "Yv'")["value"] += 0.5

    found = against(change)["Y'"]
    assert found.largest == pytest.approx(0.1)
    assert found.at == {"v": pytest.approx(0.2)}
    assert found.rms == pytest.approx(0.1 / np.sqrt(3.0), rel=1e-3)


def test_the_grid_stays_inside_both_hulls_whatever_the_order_of_variables() -> None:
    limit = np.radians(25.0)

    def change(content: dict[str, Any]) -> None:
        for m in content["models"][:2]:
            m["variables"].reverse()
            low, high = m["domain"]["low"], m["domain"]["high"]
            low.reverse()
            high.reverse()
            m["domain"]["half_spaces"] = [[1.0, 1.0, -limit], [1.0, -1.0, -limit], [-1.0, 0.0, 0.0]]

    whole, half = against(lambda _: None), against(change)
    assert half["C_D"].rms == pytest.approx(0.0, abs=1e-15)
    assert 0.4 < half["C_D"].n_points / whole["C_D"].n_points < 0.6


def test_another_area_and_length_are_converted() -> None:
    def change(content: dict[str, Any]) -> None:
        twice_as_long(content)
        for m, factor in zip(content["models"][:2], (0.5, 0.25), strict=True):
            m["area"]["value"] *= 2.0
            for t in m["terms"]:
                t["value"] *= factor

    found = against(change)
    assert found["C_D"].rms == pytest.approx(0.0, abs=1e-15)
    assert found["C_n"].rms == pytest.approx(0.0, abs=1e-15)
    assert "converted" in found["C_D"].reason


def twice_as_long(content: dict[str, Any]) -> None:
    content["scaling"]["length"] *= 2.0
    content.update(coefficients=[], covariance={"symbols": [], "matrix": []}, mass=None)


def only(response: str, **new: Any) -> Change:
    def change(content: dict[str, Any]) -> None:
        next(m for m in content["models"] if m["response"] == response).update(new)

    return change


def moved(content: dict[str, Any]) -> None:
    content["reference_point"]["point"] = [0.3, 0.0, 0.0]


def longer_without_area(content: dict[str, Any]) -> None:
    twice_as_long(content)
    content["models"][0]["area"] = None


def elsewhere(content: dict[str, Any]) -> None:
    content["models"][0]["domain"].update(
        low=[1.0, 0.0],
        high=[2.0, 1.0],
        half_spaces=[[-1.0, 0.0, 1.0], [1.0, 0.0, -2.0], [0.0, -1.0, 0.0], [0.0, 1.0, -1.0]],
    )


def without_value(content: dict[str, Any]) -> None:
    m = content["models"][0]
    m["terms"][0].update(value=None, half_width_95=None)
    for k in range(len(m["terms"])):
        m["covariance"][0][k] = m["covariance"][k][0] = None


def without_interval(content: dict[str, Any]) -> None:
    kept = content["models"][0]["terms"][0]["value"]
    without_value(content)
    content["models"][0]["terms"][0]["value"] = kept


@pytest.mark.parametrize(
    ("change", "response", "said"),
    [
        (lambda c: c["models"].pop(0), "C_D", "not in the second file"),
        (only("C_D", unit="N"), "C_D", "other units"),
        (only("C_D", area=None), "C_D", "only one states its area"),
        (moved, "C_n", "other reference points"),
        (lambda c: c["reference_point"].update(datum="nose"), "C_n", "other datums"),
        (elsewhere, "C_D", "no point of the grid in common"),
        (without_value, "C_D", "no common point"),
        (without_interval, "C_D", "no interval on one side"),
    ],
)
def test_what_cannot_be_compared_says_why(change: Change, response: str, said: str) -> None:
    found = against(change)
    assert found[response].verdict is Verdict.NOT_COMPARABLE
    assert said in found[response].reason
    assert found["Y'"].verdict is Verdict.WITHIN


def test_a_force_does_not_feel_the_reference_point() -> None:
    assert against(moved)["C_D"].verdict is Verdict.WITHIN


def test_without_areas_only_equal_lengths_are_compared() -> None:
    bare = only("C_D", area=None)
    assert against(bare, bare)["C_D"].verdict is Verdict.WITHIN
    assert "other lengths" in against(longer_without_area, bare)["C_D"].reason


def test_a_table_of_the_second_file_only_is_listed() -> None:
    found = against(lambda _: None, lambda c: c["models"].pop(1))
    assert found["C_n"].reason == "not in the first file"
    assert found["C_n"].rms is None


def test_terms_chosen_on_the_data_and_shared_data_are_mentioned() -> None:
    found = against(only("C_D", post_selection=True))["C_D"]
    assert "terms of the second chosen on its data" in found.reason
    assert found.shared == ("huuv_synthetic/table.csv",)
    whole = compare(changed(lambda _: None), changed(lambda c: c["models"].pop(2)))
    assert "C_D over alpha, beta" in whole.statements[-1]
    assert "Y' over v" not in whole.statements[-1]


def test_data_on_an_oblique_line_that_meets_no_grid_are_compared_along_it() -> None:
    def change(content: dict[str, Any]) -> None:
        limits = {"low": [-0.001, -0.001], "high": [0.401, 0.401]}
        line = [[0.6, -0.8, -0.001], [-0.6, 0.8, 0.001], [0.8, 0.6, -0.5], [-0.8, -0.6, 0.0]]
        content["models"][0]["domain"].update(**limits, half_spaces=line)

    found = against(change, change)["C_D"]
    assert found.n_points > 100
    assert found.verdict is Verdict.WITHIN


def test_the_command_shows_the_tables(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "b.json").write_bytes(changed(add_to_drag(0.01)).to_json())
    done = coeflab("compare", PARAMS, "b.json")
    assert (done.returncode, done.stderr) == (1, "")
    assert "Fitted tables" in flat(done.stdout)
    assert "C_D over alpha, beta" in flat(done.stdout)
    assert "Tables: 2 within, 1 apart, 0 not comparable." in flat(done.stdout)
    content = json.loads(coeflab("compare", PARAMS, "b.json", "--json").stdout)
    drag = content["models"][0]
    assert (drag["response"], drag["verdict"], drag["share_within"]) == ("C_D", "apart", 0.0)
    assert drag["rms_difference"] == pytest.approx(0.01)
    assert set(drag["largest_at"]) == {"alpha", "beta"}
