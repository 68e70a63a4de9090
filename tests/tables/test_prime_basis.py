"""What a prime was divided by is read from words, is always a line to confirm, and is doubted where no body has such a slope."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.tables.campaign import read_campaign
from coeflab.tables.dialect import Marks
from coeflab.tables.interpretation import interpreted
from coeflab.tables.low_aspect import low_aspect_slope
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.settings import Setting
from coeflab.tables.words.above import words_above
from coeflab.tables.words.primes import BASIS, LEVER, area_of, length_of, prime_basis
from tests.cli.test_import import invoke, left_open, table_of, without_slopes

__all__ = ["without_slopes"]
LENGTH, YV, NV = 4.0, -0.02, -0.008  # primes by L^2 and L^3
BETA = np.array([-8.0, -4.0, 0.0, 4.0, 8.0])

FORMULAS = {
    "coefficients by 0.5 rho Lpp T U^2 (N by 0.5 rho Lpp^2 T U^2)": "L T",
    "Y' = Y/(½ρU²LT)": "L T",
    "Koeffizienten bezogen auf L·B": "L B",
    "rho/2 V^2 L d": "L D",
    "(1/2) rho Lpp T U^2": "L T",
    "forces divided by 0.5*rho*U^2*S_w": "wetted",
    "adimensionnés par la surface mouillée": "wetted",
    "1/2 rho U^2 A_F": "frontal",
    "½ρV²∇^(2/3)": "V^(2/3)",
    "1/2 rho U^2 L^2 (moments 1/2 rho U^2 L^3)": "L L",
    "Y' = 2 Y / (rho V^2 L D), N' = 2 N / (rho V^2 L^2 D)": "L D",
    "N' = 2 N / (rho V^2 L^3)": "",
    "with reference area nabla^{2/3}": "V^(2/3)",
    "Referenzfläche Volumen^(2/3), Verdrängung 0,27 m³": "V^(2/3)",
    "reference area: wetted surface": "wetted",
    "SNAME prime system II": "L T",
    "coefficients of the bis system": "mass",
    "moments by 0.5 rho U^2 L^3": "",
    "nondimensionalised by L and U": "",
    "speed 1.5 m/s, L = 4 m, T = 20 C": "",
}


@pytest.mark.parametrize(("text", "basis"), FORMULAS.items())
def test_formulas_and_sentences_of_three_languages(text: str, basis: str) -> None:
    found = prime_basis([("line 1", text)], Marks())
    assert (str(found[BASIS].value) if BASIS in found else "") == basis


@pytest.mark.parametrize(
    ("text", "lever", "length"),
    [("Z/(0.5 rho V^2 Vol^(2/3)), M/(0.5 rho V^2 Vol), volume 0.064 m^3", "V^(1/3)", 0.4),
     ("Y/(0.5 rho V^2 A), N/(0.5 rho V^2 A D)", "D", None), ("N by 0.5 rho U^2 L^2 T, Y by 0.5 rho U^2 L T", "L", 4.0),
     ("0.5 rho V^2 S_w and 0.5 rho V^2 S_w L", "L", 4.0), ("0.5 rho V^2 Vol^(2/3)", "", None), ("N/(0.5 rho V^2 L^3)", "", None)],
)  # fmt: skip
def test_the_length_beside_the_area_in_the_formula_of_moments(text: str, lever: str, length: float | None) -> None:
    """An area of V^(2/3) had moments by it and the length of the primes: Nv' came out 5.3 times too large of L = 5.3 V^(1/3)."""
    found = prime_basis([("line 1", text)], Marks())
    assert (str(found[LEVER].value) if LEVER in found else "") == lever
    known = {"L": 4.0} | ({"V": found["basis.volume"].value} if "basis.volume" in found else {})
    assert length_of(lever, known) == pytest.approx(length)


def test_moments_by_a_volume_are_not_by_the_length_of_the_primes(tmp_path: Path) -> None:
    volume, words = 0.064, "LOA = 4 m, volume 0.064 m^3; Y/(0.5 rho V^2 Vol^(2/3))"
    area = volume ** (2.0 / 3.0)
    file = drift(tmp_path, words, area)
    plain = file.read_text().replace("Y'", "CY").replace("N'", "CN")
    file.write_text(plain)
    known = (*KNOWN, "--set", "scaling.length=4 LOA")
    assert left_open(invoke("import", file, "--out", tmp_path / "out", *known, "--accept")) == ["coefficients.length"]
    file.write_text(plain.replace("; Y/", "; N/(0.5 rho V^2 Vol), Y/"))
    done = invoke("import", file, "--out", tmp_path / "out", *known, "--accept")
    assert done.exit_code == 0, done.output
    assert read_campaign(tmp_path / "out" / "campaign.toml").tables[0].assumed == ()
    by_hand = invoke(
        "import", file, "--out", tmp_path / "said", *known, "--set", "coefficients.length=0.4 m", "--accept"
    )
    assert by_hand.exit_code == 0, by_hand.output
    assert np.allclose(table_of(tmp_path / "out").forces["N"], table_of(tmp_path / "said").forces["N"], rtol=1e-12)


@pytest.mark.parametrize(
    "line",
    ["CY by 0.5 rho U^2 L D; CK by 0.5 rho U^2 L D^2; CN by 0.5 rho U^2 L^2 D", "Y/(0.5 rho U^2 A_f), K/(0.5 rho U^2 A_f B), N/(0.5 rho U^2 A_f L)"],
)  # fmt: skip
def test_two_lengths_of_moments_in_one_line_are_open(line: str) -> None:
    """That of the roll moment was taken for the yaw moment: Nv' was 8 times too small of L = 8 D."""
    stated = words_above([(1, [line])], Marks())
    assert "but line 1" in stated[LEVER].contradicted
    column = RawColumn("CN", "-", np.ones(3))
    raw = RawTable(Path("t.csv"), (column,), lines=np.arange(3), stated=stated)
    known = {"scaling.length": Setting(4.0, "confirmed"), "coefficients.area": Setting(2.0, "confirmed")}
    one = {q.key: q for q in interpreted(raw, {}, known, accept=True).questions}["coefficients.length"]
    assert one.open
    assert "column by column" in one.choices


def test_two_formulas_that_differ_are_open() -> None:
    found = prime_basis([("line 1", "X by 0.5 rho L T U^2, Y by 0.5 rho U^2 L^2")], Marks())
    assert "U^2 L^2" in found[BASIS].contradicted
    found = prime_basis([("line 1", "by 0.5 rho L T U^2"), ("line 2", "by 0.5 rho U^2 L^2")], Marks())
    assert "line 2" in found[BASIS].contradicted


def test_sizes_in_any_unit_give_the_area() -> None:
    found = prime_basis([("l", "draught 250 mm, beam 0.5 m, volume 0.064 m^3, wetted surface 3,2 m²")], Marks(","))
    sizes = {"L": 4.0, "T": 0.25, "B": 0.5, "V": 0.064}
    for name, key in (("T", "basis.draught"), ("B", "basis.breadth"), ("V", "basis.volume")):
        assert found[key].value == pytest.approx(sizes[name])
    assert found["basis.wetted_area"].value == pytest.approx(3.2)
    assert [area_of(b, sizes) for b in ("L T", "L B", "V^(2/3)", "L D")] == pytest.approx([1.0, 2.0, 0.16, None])


def drift(folder: Path, head: str, area: float) -> Path:
    """Primes of a planted Yv', Nv' by another area, with words over them."""
    v = np.sin(np.radians(BETA))
    rows = [
        f"{b:g},{-(LENGTH**2) / area * YV * x:.9g},{-(LENGTH**2) / area * NV * x:.9g}"
        for b, x in zip(BETA, v, strict=True)
    ]
    file = folder / "drift.csv"
    file.write_text("\n".join([f'"{head}"', "beta [deg],Y',N'", *rows]) + "\n", encoding="utf-8")
    return file


KNOWN = ("--set", "axes.frame=FRD", "--set", "axes.reference_point=midship")


@pytest.mark.parametrize(
    ("head", "area"),
    [
        ("Lpp 4.0 m, draught 0.25 m; coefficients by 0.5 rho Lpp T U^2", 1.0),
        ("Lpp = 4 m, Breite 0.5 m; Beiwerte bezogen auf L*B", 2.0),
        ("LOA = 4 m, hull diameter 0.4 m; primes: 1/2 rho U^2 L D", 1.6),
        ("LOA = 4 m, frontal area 0.2 m^2, forces divided by the frontal area", 0.2),
        ("LOA = 4 m; 1/2 rho U^2 L^2", 16.0),
        ("LOA = 4 m; reference area 0.5 m^2 of the fin", 0.5),
        ("LOA = 4 m; rudder reference area 0.05 m^2; primes by L^2", 16.0),
    ],
)
def test_a_basis_in_words_gives_the_planted_slope(head: str, area: float, tmp_path: Path) -> None:
    file = drift(tmp_path, head, area)
    shown = invoke("import", file, "--out", tmp_path / "out", *KNOWN)
    assert "coefficients.area" in shown.output
    assert not (tmp_path / "out").exists()  # nothing is taken before somebody accepts the line
    done = invoke("import", file, "--out", tmp_path / "out", *KNOWN, "--accept")
    assert done.exit_code == 0, done.output
    table = table_of(tmp_path / "out")
    v = table.primed_motion("v", LENGTH)
    assert np.polyfit(v, table.primed_force("Y", LENGTH), 1)[0] == pytest.approx(YV, rel=1e-6)
    assert np.polyfit(v, table.primed_force("N", LENGTH), 1)[0] == pytest.approx(NV, rel=1e-6)
    assert "coefficients.area" not in read_campaign(tmp_path / "out" / "campaign.toml").tables[0].assumed


def test_a_prime_by_its_name_alone_is_accepted_as_an_assumption(tmp_path: Path) -> None:
    file = drift(tmp_path, "LOA = 4 m", 16.0)
    assert invoke("import", file, "--out", tmp_path / "out", *KNOWN).exit_code == 2
    assert invoke("import", file, "--out", tmp_path / "out", *KNOWN, "--accept").exit_code == 0
    assert read_campaign(tmp_path / "out" / "campaign.toml").tables[0].assumed == ("coefficients.area",)
    assert (
        invoke(
            "import", file, "--out", tmp_path / "said", *KNOWN, "--set", "coefficients.area=prime", "--accept"
        ).exit_code
        == 0
    )
    assert read_campaign(tmp_path / "said" / "campaign.toml").tables[0].assumed == ()


def test_the_length_of_moment_coefficients_is_accepted_as_an_assumption(tmp_path: Path) -> None:
    """It was the campaign's length without a question and without a mark: by a chord N' would be another number."""
    file = drift(tmp_path, "LOA = 4 m", 0.2)
    file.write_text(file.read_text().replace("Y'", "CY").replace("N'", "CN"))
    known = (*KNOWN, "--set", "coefficients.area=0.2 m^2")
    assert invoke("import", file, "--out", tmp_path / "out", *known).exit_code == 2
    done = invoke("import", file, "--out", tmp_path / "out", *known, "--accept")
    assert done.exit_code == 0, done.output
    assert read_campaign(tmp_path / "out" / "campaign.toml").tables[0].assumed == ("coefficients.length",)
    (found,) = (f for f in table_of(tmp_path / "out").findings if dict(f.facts).get("key") == "coefficients.length")
    assert dict(found.facts)["value"] == "4"
    assert dict(found.facts)["components"] == ("K", "M", "N")
    said = (*known, "--set", "coefficients.length=2 m", "--accept")
    assert invoke("import", file, "--out", tmp_path / "said", *said).exit_code == 0
    assert read_campaign(tmp_path / "said" / "campaign.toml").tables[0].assumed == ()
    assert np.allclose(table_of(tmp_path / "said").forces["N"] * 2.0, table_of(tmp_path / "out").forces["N"])


def test_primes_counted_in_thousandths_are_by_the_area_that_is_said(tmp_path: Path) -> None:
    """They stayed primes by L^2."""
    file = drift(tmp_path, "LOA = 4 m; 1/2 rho U^2 L T, draught 0.25 m", 1.0)
    plain = file.read_text()
    assert invoke("import", file, "--out", tmp_path / "plain", *KNOWN, "--accept").exit_code == 0
    file.write_text(plain.replace("Y'", "1000 Y'").replace("N'", "N' x1000"))
    assert invoke("import", file, "--out", tmp_path / "counted", *KNOWN, "--accept").exit_code == 0
    for force in "YN":
        assert np.allclose(
            table_of(tmp_path / "counted").forces[force] * 1e3, table_of(tmp_path / "plain").forces[force]
        )


def test_an_area_without_its_size_is_open(tmp_path: Path) -> None:
    file = drift(tmp_path, "LOA = 4 m; coefficients by 0.5 rho L T U^2", 1.0)
    assert left_open(invoke("import", file, "--out", tmp_path / "out", *KNOWN, "--accept")) == ["coefficients.area"]
    mentioned = drift(tmp_path, "LOA = 4 m, wetted surface 3.2 m^2", 3.2)
    assert left_open(invoke("import", mentioned, "--out", tmp_path / "out", *KNOWN, "--accept")) == [
        "coefficients.area"
    ]


def test_a_slope_of_three_times_low_aspect_ratio_warns(tmp_path: Path) -> None:
    """Jones 1946: 1/2 rho U^2 (pi/2) b^2 of a span b; a draught and its image are a span of 2 T, of which half is wet."""
    assert low_aspect_slope("D", 0.4, 4.0) == pytest.approx(0.5 * np.pi * 0.01)
    assert low_aspect_slope("T", 0.25, 4.0) == pytest.approx(0.5 * (np.pi / 2.0) * (2.0 * 0.25) ** 2 / 16.0)
    file = drift(tmp_path, "LOA = 4 m, draught 0.25 m", 1.0)  # by L T, which no word says: 16 times too large
    done = invoke("import", file, "--out", tmp_path / "out", *KNOWN, "--accept")
    assert "three times" in " ".join(done.output.split())
    right = drift(tmp_path, "LOA = 4 m, draught 0.25 m; 1/2 rho U^2 L^2", 16.0)
    done = invoke("import", right, "--out", tmp_path / "right", *KNOWN, "--accept")
    assert "three times" not in " ".join(done.output.split())


def test_only_tables_of_coefficients_hang_on_what_a_prime_was_divided_by(tmp_path: Path) -> None:
    """Of two files of one campaign one has primes by their name alone, the other newtons: the second assumes no area."""
    (tmp_path / "in").mkdir()
    drift(tmp_path / "in", "LOA = 4 m", 16.0)
    w = np.sin(np.radians(BETA))
    rows = [f"{a:g},1.5,{-300.0 * x:.6g},{200.0 * x:.6g}" for a, x in zip(BETA, w, strict=True)]
    (tmp_path / "in" / "pitch.csv").write_text("\n".join(["alpha [deg],U [m/s],Z [N],M [Nm]", *rows]) + "\n")
    known = (*KNOWN, "--set", "conditions.density=1000")
    done = invoke("import", tmp_path / "in", "--out", tmp_path / "out", *known, "--accept")
    assert done.exit_code == 0, done.output
    found = {t.file: t.assumed for t in read_campaign(tmp_path / "out" / "campaign.toml").tables}
    assert found == {"drift.csv": ("coefficients.area",), "pitch.csv": ()}
