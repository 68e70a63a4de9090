"""Joint fits over several campaigns from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run, flat

BARE = ("suboff_roddy_3", "suboff_cfd_barehull", "--fit", "manoeuvring_model")
PLANES = (
    "suboff_roddy_2",
    "suboff_roddy_1",
    "--fit",
    "manoeuvring_model",
    "--terms",
    "Yv Yv|v| Zw Zw|w| Nv Nv|v| Mw Mw|w|",
)


def test_two_campaigns_print_their_shares_and_that_they_disagree(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("fit", *BARE, "--terms", "Yv Yv|v| Yvvv Yr Yr|r|")
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    for text in (
        "Campaigns of the joint fit", "rejected, F(3, ", "Every third point left out", "The campaigns disagree",
        "warn poolability, suboff_roddy_3, suboff_cfd_barehull Y'",
    ):  # fmt: skip
        assert text in flat(done.stdout)
    assert not list(tmp_path.iterdir())


def test_equations_across_planes_are_kept_and_tested(coeflab: Run) -> None:
    done = coeflab("fit", *PLANES, "--constraint", "Mw = -Nv", "--constraint", "Zw=Yv", "--json")
    assert done.returncode == 0, done.stderr
    content = json.loads(done.stdout)
    found = {c["symbol"]: c["value"] for c in content["coefficients"]}
    assert found["Mw'"] == pytest.approx(-found["Nv'"], rel=1e-9)
    assert found["Zw'"] == pytest.approx(found["Yv'"], rel=1e-9)
    assert {c["campaign"] for c in content["coefficients"]} == {"suboff_roddy_2, suboff_roddy_1"}
    said = {m["response"]: " ".join(m["statements"]) for m in content["models"]}
    assert "The data reject Zw = Yv" in said["Z"]

    def valued(*campaigns: str) -> list[tuple[object, ...]]:
        found = json.loads(coeflab("fit", *campaigns, "--json").stdout)["coefficients"]
        return [(c["symbol"], c["campaign"], c["value"], c["u95"]) for c in found if c["value"] is not None]

    assert valued("suboff_roddy_2", "suboff_roddy_1") == [*valued("suboff_roddy_2"), *valued("suboff_roddy_1")]
