"""The last printed digit of a column: read in place, or written by an import and read again, it is the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.tables.columns import UNIFORM
from coeflab.tables.force_table import ForceTable
from tests.cli.test_import import invoke

BETA = np.arange(-12.0, 12.1, 3.0)
V = np.sin(np.radians(BETA))
SLOPE, LENGTH, SPEED, AREA = -0.028, 2.0, 2.0, 1.3
CURVE = SLOPE * V - 0.06 * V * np.abs(V)
PRIME = 0.5 * 1000.0 * SPEED**2 * LENGTH**2
PRIMES = CURVE * LENGTH**2 / AREA  # coefficients by the area
KEYS = {"frame": "FRD", "length": LENGTH, "density": 1000.0, "speed": SPEED, "about": "nose, 1.0 m aft", "beta": "+"}
SETS = ("axes.frame=FRD", "axes.beta=+", f"scaling.length={LENGTH} m LOA", "conditions.density=1000", f"conditions.speed={SPEED} m/s",
        "axes.reference_point=-1.0 from nose")  # fmt: skip


def printed(file: Path, unit: str, numbers: np.ndarray, form: str = ".3f", **also: np.ndarray) -> Path:
    """A table of a force F over the drift angle, with so many digits."""
    heads = ["beta [deg]", f"F [{unit}]", *(f"{name} [m/s]" for name in also)]
    rows = zip(BETA, numbers, *also.values(), strict=True)
    lines = [",".join((f"{b:g}", f"{y + 0.0:{form}}", *(f"{x:g}" for x in more))) for b, y, *more in rows]
    file.write_text("\n".join([",".join(heads), *lines, ""]))
    return file


def both_ways(source: Path, columns: dict[str, str], *options: str) -> tuple[ForceTable, ForceTable]:
    """In place, and as `coeflab import` writes it."""
    out = source.parent / f"{source.stem}_imported"
    sets = [w for text in SETS for w in ("--set", text)] + [
        w for pair in columns.items() for w in ("--map", "=".join(pair))
    ]
    done = invoke("import", source, *sets, *options, "--accept", "--out", out)
    assert done.exit_code == 0, done.output + str(done.exception)
    pairs = dict(text.split("=") for text in options[1::2])
    return cf.read_table(source, columns=columns, options=pairs, accept=True, **KEYS), cf.read_table(out)


RISING = np.linspace(1.0, 3.0, len(BETA))


@pytest.mark.parametrize(
    ("meaning", "unit", "numbers", "also", "digit", "stated"),
    [
        ("Y [N]", "N", CURVE * PRIME, {}, 1e-3, False),
        ("Y [lbf]", "lbf", CURVE * PRIME / 4.4482216152605, {}, 4.4482216152605e-3, False),
        ("Y'", "-", CURVE, {}, 1e-3 * PRIME, False),
        ("-Y'", "-", -CURVE, {}, 1e-3 * PRIME, False),
        ("Y' [1e-3]", "1e-3", CURVE * 1e3, {}, 1e-6 * PRIME, False),
        (f"Y [coefficient A={AREA} m^2]", "-", PRIMES, {}, 1e-3 * PRIME * AREA / LENGTH**2, True),
        (f"-Y [coefficient A={AREA} m^2]", "-", -PRIMES, {}, 1e-3 * PRIME * AREA / LENGTH**2, True),
        (f"N [coefficient A={AREA} m^2 L=3 m]", "-", -PRIMES, {}, 1e-3 * 2000.0 * AREA * 3.0, True),
        ("Y [N s^2/m^2]", "N s^2/m^2", CURVE * PRIME / SPEED**2, {"U": RISING}, 1e-3 * RISING**2, True),
    ],
)  # fmt: skip
def test_an_imported_table_is_the_one_that_was_read(
    tmp_path: Path, meaning: str, unit: str, numbers: np.ndarray, also: dict[str, np.ndarray], digit: float | np.ndarray, stated: bool
) -> None:  # fmt: skip
    read, imported = both_ways(printed(tmp_path / "drift.csv", unit, numbers, **also), {"F": meaning})
    (c,) = read.forces
    assert list(imported.forces) == [c]
    assert imported.forces[c] == pytest.approx(read.forces[c], rel=1e-12, abs=1e-12)
    assert imported.digits[c] == pytest.approx(read.digits[c], rel=1e-5)
    assert read.digits[c] * UNIFORM == pytest.approx(digit, rel=1e-9)
    assert ("digit_" in (tmp_path / "drift_imported" / "table.csv").read_text()) is stated
    again, twice = both_ways_of_house(tmp_path / "drift_imported" / "table.csv")
    assert twice == again


def both_ways_of_house(written: Path) -> tuple[list[str], list[str]]:
    """The lines of a written table, and of that imported once more."""
    out = written.parent / "again"
    sets = [w for text in SETS for w in ("--set", text)]
    done = invoke("import", written, *sets, "--accept", "--out", out)
    assert done.exit_code == 0, done.output + str(done.exception)
    return (written.read_text().splitlines()[1:], (out / "table.csv").read_text().splitlines()[1:])


def test_a_planted_slope_is_within_u95_of_an_imported_coefficient(tmp_path: Path) -> None:
    """Two decimals of CY: without the digit Yv' was told to a tenth of its error."""
    read, imported = both_ways(
        printed(tmp_path / "drift.csv", "-", PRIMES, ".2f"), {"F": f"Y [coefficient A={AREA} m^2]"}
    )
    own, other = cf.fit(read)["Yv'"], cf.fit(imported)["Yv'"]
    assert other.value == pytest.approx(own.value, rel=1e-9)
    assert other.u95 == pytest.approx(own.u95, rel=1e-4)
    assert abs(other.value - SLOPE) < other.u95


def test_joined_files_hold_the_digits_of_each_and_a_short_one_the_coarsest(tmp_path: Path) -> None:
    folder = tmp_path / "runs"
    folder.mkdir()
    for name, form, rows in (("a1", ".2f", slice(0, 4)), ("a2", ".4f", slice(4, 7)), ("a3", ".5f", slice(7, 9))):
        lines = [f"{b:g},{y:{form}}" for b, y in zip(BETA[rows], CURVE[rows] * PRIME + 0.0071, strict=True)]
        (folder / f"{name}.csv").write_text("\n".join(["beta [deg],Y [N]", *lines, ""]))
    read, imported = both_ways(folder, {}, "--option", "joined=yes")
    for table in (read, imported):
        assert table.digits["Y"] * UNIFORM == pytest.approx([1e-2] * 4 + [1e-4] * 3 + [1e-2] * 2, rel=1e-5)


@pytest.mark.parametrize(
    ("head", "cell", "found"),
    [
        ("digit_Y' [-]", "-0.001", 'column "digit_Y'), ("digit_Y' [-]", "", "a blank cell"), ("digit_N' [-]", "0.001", "digit_N without N"),
        ("digit_beta [deg]", "1", "the unknown column"), ("digit_Y'", "0.001", "a header without unit"),
    ],
)  # fmt: skip
def test_a_digit_that_cannot_be_is_refused(tmp_path: Path, head: str, cell: str, found: str) -> None:
    own = Path(__file__).parents[2] / "cfd_data" / "suboff_roddy_2" / "campaign.toml"
    (tmp_path / "campaign.toml").write_text(
        own.read_text().partition("[[table]]")[0] + '[[table]]\nfile = "table.csv"\n'
    )
    (tmp_path / "table.csv").write_text(f"beta [deg],Y' [-],{head}\n0,0.001,{cell}\n4,0.002,{cell}\n")
    with pytest.raises(InputError) as why:
        cf.read_table(tmp_path)
    assert found in str(why.value)
