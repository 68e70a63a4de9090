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
    both = json.loads(coeflab("fit", *PLANES, "--constraints", "Mw = -Nv; Zw = Yv", "--json").stdout)
    assert both == content


def test_where_no_fit_joins_them_each_campaign_is_fitted_by_itself(coeflab: Run) -> None:
    def valued(*campaigns: str) -> list[tuple[object, ...]]:
        found = json.loads(coeflab("fit", *campaigns, "--json").stdout)["coefficients"]
        return [(c["symbol"], c["campaign"], c["value"], c["u95"]) for c in found if c["value"] is not None]

    assert valued("suboff_roddy_2", "suboff_roddy_1") == [*valued("suboff_roddy_2"), *valued("suboff_roddy_1")]


def test_json_holds_the_campaigns_and_the_test(coeflab: Run) -> None:
    content = json.loads(coeflab("fit", *BARE, "--terms", "Nv Nv|v| Nr Nr|r|", "--json").stdout)
    (n,) = content["poolings"]
    assert [c["campaign"] for c in n["campaigns"]] == ["suboff_roddy_3", "suboff_cfd_barehull"]
    assert n["one_law"]["rejected"] is True
    assert 0.0 < n["every_third_left_out_rms_of_range"] < 0.05
    assert all(0.0 < c["left_out_rms_of_range"] < 0.1 for c in n["campaigns"])


def test_one_campaign_has_no_campaign_to_leave_out(coeflab: Run) -> None:
    done = coeflab("fit", "suboff_cfd_barehull", "--fit", "manoeuvring_model", "--terms", "Yv Yv|v|")
    assert "Each campaign left out in turn: needs two campaigns." in flat(done.stdout)
    assert "Campaigns of the joint fit" not in flat(done.stdout)


def test_a_plan_with_a_joint_fit_writes_its_report_and_parameter_file(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "plan.toml").write_text(
        '[study]\nname = "hull"\nwanted = ["Yv"]\n[[joint]]\n'
        'campaigns = ["suboff_roddy_3", "suboff_cfd_barehull"]\n'
        'options = { terms = ["Yv", "Yv|v|", "Nv", "Nv|v|"] }\n',
        encoding="utf-8",
    )
    done = coeflab("run", "plan.toml")
    assert done.returncode == 1, done.stderr  # v|v| alone misses points: the check says so, everything is written
    assert "law at points" in flat(done.stdout)
    assert "Campaigns of the joint fit" in flat(done.stdout)
    report = (tmp_path / "reports" / "hull" / "report.html").read_text(encoding="utf-8")
    assert "Campaigns of the joint fit" in report
    assert "suboff_roddy_3, suboff_cfd_barehull" in report
    file = json.loads((tmp_path / "reports" / "hull" / "suboff_bare_hull.parameters.json").read_bytes())
    assert {i["name"].rpartition("/")[2] for i in file["provenance"]["inputs"]} >= {"table.csv", "drift.csv"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("suboff_roddy_3", "nowhere", "--fit", "manoeuvring_model"), 'no file or folder "nowhere"'),
        (("suboff_roddy_3", "suboff_roddy_3", "--fit", "manoeuvring_model", "--terms", "Yv"), "twice"),
        ((*BARE, "--terms", "Yv Yp"), "Yp zero on every row of suboff_roddy_3, suboff_cfd_barehull"),
        ((*BARE, "--terms", "Yv Nv", "--constraint", "Nv = Yv", "--constraint", "Nv = 1", "--constraint", "Yv = 2"),
         "contradict each other"),
        ((*BARE, "--terms", "Yv", "--constraint", "Yv"), "a linear equation such as"),
        ((*BARE, "--terms", "Yv", "Nv"), "--option VALUE"),
        (("suboff_roddy_3", "--constraint", "Mw = -Nv"), "unknown option"),
    ],
)  # fmt: skip
def test_wrong_input_is_one_message_and_exit_code_two(coeflab: Run, arguments: tuple[str, ...], message: str) -> None:
    done = coeflab("fit", *arguments)
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""
