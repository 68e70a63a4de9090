"""Published values: readings by two lengths, illegible digits, and files that cannot be."""

from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.law.scaling import Scaling
from coeflab.vehicle.published_values import Reference, Relation, read_references

LBP = Scaling(4.26086, "LBP")
SYNTHETIC = """[[reference]]
name = "r"
citation = "synthetic"
body = "b"
relation = "re-analysis"
campaigns = ["c"]
length = 2.0
length_name = "L"
values = { Yv = "-0.03" }
uncertainties = { default = 0.05 }
[reference.literature.rotary]
method = "PMM"
uncertainty = 0.1
values = { Yr = "0.005" }
"""


@pytest.fixture(scope="module")
def published() -> dict[str, Reference]:
    return {r.name: r for r in read_references(shipped("cfd_data") / "suboff" / "published.toml")}


def test_table_4_as_printed(published: dict[str, Reference]) -> None:
    printed = {
        "published CFD": (-0.0281, -0.0140, -0.0150, 0.0110, 0.0044, -0.0040),
        "PMM CFD 2012": (-0.0303, -0.0131, -0.0157, 0.0103, 0.0046, -0.0042),
        "experiment 1990": (-0.0278, -0.0136, -0.0139, 0.0103, 0.0052, -0.0044),
    }
    for name, numbers in printed.items():
        assert tuple(v.value for v in published[name].values) == numbers
        assert tuple(v.symbol for v in published[name].values) == ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")


def test_both_readings_of_the_paper(published: dict[str, Reference]) -> None:
    expected = {"Yv": -0.02937, "Nv": -0.01496, "Zw": -0.01568, "Mw": 0.01175, "Yr": 0.00470, "Nr": -0.00437}
    for symbol, loa in expected.items():
        readings = dict(published["published CFD"].readings(symbol, LBP))
        assert readings["LOA"] == pytest.approx(loa, abs=5.1e-6)
        printed = published["published CFD"].printed(symbol)
        assert readings["LBP"] == printed.value


def test_an_illegible_digit_has_no_value(published: dict[str, Reference]) -> None:
    literature = {v.symbol: v for kind in published["Roddy configuration 3"].literature for v in kind.values}
    assert (literature["Yvdot"].printed, literature["Yvdot"].value) == ("-0.01327?", None)
    assert literature["Nrdot"].value == -0.000676


def test_stated_uncertainties(published: dict[str, Reference]) -> None:
    roddy = published["Roddy configuration 2"]
    assert (roddy.stated("Yv"), roddy.stated("Ydr")) == (0.05, 0.10)
    assert published["published CFD"].stated("Yv") is None
    assert roddy.relation is Relation.RE_ANALYSIS


def test_printed_stability_indices_follow_from_the_printed_rows(published: dict[str, Reference]) -> None:
    """Table 4 by G = 1 - Nv' (Yr' - m') / [Yv' (Nr' - xG' m')] with Roddy's m' and xG' m' of Table 1."""
    for number, index, sign, m, moment, names in (
        (1, "G_v", -1.0, 0.018296, -0.127467e-4, ("Zw", "Mw", "Zq", "Mq")),
        (2, "G_h", 1.0, 0.018296, -0.127467e-4, ("Yv", "Nv", "Yr", "Nr")),
        (3, "G_h", 1.0, 0.018078, 0.388697e-4, ("Yv", "Nv", "Yr", "Nr")),
    ):
        r = published[f"Roddy configuration {number}"]
        values = {v.symbol: v.value for v in (*r.values, *(v for kind in r.literature for v in kind.values))}
        force, lever, force_rate, lever_rate = (values[n] or 0.0 for n in names)
        found = 1.0 - lever * (force_rate - sign * m) / (force * (lever_rate - moment))
        (printed,) = r.indices
        assert printed.symbol == index
        assert printed.value == pytest.approx(found, rel=5e-4)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('body = "b"', 'body = "b"\nindices = { G_x = "1.0" }', ['"reference[0].indices.G_x"', "G_h, G_v"]),
        ('body = "b"', 'body = "b"\nindices = { G_h = "much" }', ['"reference[0].indices.G_h"', 'found "much"']),
        ('"-0.03"', '"about 0.03"', ['"reference[0].values.Yv"', 'found "about 0.03"', 'ends in "?"']),
        ('"-0.03"', '"nan"', ['"reference[0].values.Yv"', 'found "nan"']),
        ('"-0.03"', "-0.03", ['"reference[0].values.Yv"', "a text"]),
        ("Yv =", "Qv =", ['"reference[0].values.Qv"', "SNAME derivative"]),
        ('"re-analysis"', '"same"', ['"reference[0].relation"', '"re-analysis" or "cross-body"']),
        ("length = 2.0", "length = -2.0", ['"reference[0].length"', "above zero"]),
        ("uncertainty = 0.1", "uncertainty = -0.1", ['"reference[0].literature.rotary.uncertainty"', "above zero"]),
        ("default = 0.05", 'default = "5 kg"', ['"reference[0].uncertainties.default"', "a pure number"]),
        ('method = "PMM"\n', "", ['"reference[0].literature.rotary.method"', "found nothing"]),
        ('body = "b"', 'body = "b"\ncolour = 1', ['"reference[0].colour"', "an unknown key"]),
    ],
)
def test_files_that_cannot_be(tmp_path: Path, old: str, new: str, said: list[str]) -> None:
    assert old in SYNTHETIC
    path = tmp_path / "published.toml"
    path.write_text(SYNTHETIC)
    assert read_references(path)[0].name == "r"
    path.write_text(SYNTHETIC.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_references(path)
    for text in ("published.toml", *said):
        assert text in str(caught.value)


def test_a_column_may_have_values_for_the_parameter_file_alone(tmp_path: Path) -> None:
    path = tmp_path / "published.toml"
    path.write_text(SYNTHETIC.replace('values = { Yv = "-0.03" }\n', ""))
    (column,) = read_references(path)
    assert column.values == ()
    assert [v.symbol for kind in column.literature for v in kind.values] == ["Yr"]


def test_a_re_analysis_names_its_campaigns(tmp_path: Path) -> None:
    """Before: the column was read, and the report said that there is no published evaluation."""
    path = tmp_path / "published.toml"
    path.write_text(SYNTHETIC.replace('campaigns = ["c"]\n', ""), encoding="utf-8")
    with pytest.raises(InputError, match="a re-analysis without campaigns") as caught:
        read_references(path)
    assert "campaigns" in caught.value.expected
    assert "published.toml" in str(caught.value)
    assert "line 1" in str(caught.value)
    path.write_text(SYNTHETIC.replace('campaigns = ["c"]\n', "").replace("re-analysis", "cross-body"), encoding="utf-8")
    assert read_references(path)[0].campaigns == ()


def test_what_the_paper_does_not_print_is_called_inferred(published: dict[str, Reference]) -> None:
    """The steady-CFD paper prints a length over all, .718 m^3 and six numbers a column: no configuration, no ring wing, no LBP."""
    for name in ("published CFD", "PMM CFD 2012"):
        assert set(published[name].inferred) == {"body", "length"}
        assert [f["key"] for f in published[name].assumed] == ["body", "length"]
    assert published["Roddy configuration 2"].assumed == ()


def test_only_what_a_source_may_leave_unsaid_is_inferred(tmp_path: Path) -> None:
    path = tmp_path / "published.toml"
    path.write_text(SYNTHETIC.replace("length = 2.0", 'length = 2.0\ninferred = { colour = "none" }'), encoding="utf-8")
    with pytest.raises(InputError, match="colour"):
        read_references(path)
