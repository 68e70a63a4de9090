"""A datum is an id and a note; points about two ids never mix."""

from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core.axes import SHIPPED, Datum, DatumKeys
from coeflab.core.declarations import declared_key
from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.text.toml import read_toml
from coeflab.study.plan import read_plan
from coeflab.study.run import run

PROSE = "nose, 2 m aft"


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("nose", "nose, on the hull's axis", True),
        ("nose", "Nose", True),
        ("cg", "centre of gravity", True),
        ("nose", PROSE, False),
        ("nose, on the hull's axis", PROSE, False),
        (PROSE, "nose 2 m aft", False),
        (PROSE, "nose, 2 m  aft", False),
        ("nose, -2 m", "nose, 2 m", False),
        ("the nose", "nose", False),
        ("cb", "cg", False),
    ],
)
def test_ids_are_compared_and_prose_is_an_id_of_its_own(one: str, other: str, same: bool) -> None:
    first, second = Datum.named(one), Datum.named(other)
    assert (first == second) is same
    assert (hash(first) == hash(second)) is same
    assert Datum.named(first.id) == first


def test_notes_are_shown_and_never_compared(tmp_path: Path) -> None:
    file = tmp_path / "a.toml"
    file.write_text('[axes]\ndatum = "nose"\ndatum_note = "tip of the sonar dome"\n')
    found = declared_key(read_toml(file), "axes", DatumKeys).origin
    assert str(found) == "nose, tip of the sonar dome"
    assert found == Datum("nose", "somewhere else")
    assert str(Datum.named("nose, on the hull's axis")) == "nose, on the hull's axis"
    assert all(str(Datum.named(phrase)).endswith(note) for phrase, (_, note) in SHIPPED.items())


def test_a_datum_that_is_no_text_is_one_error(tmp_path: Path) -> None:
    file = tmp_path / "a.toml"
    file.write_text('[axes]\ndatum = ["nose"]\n')
    with pytest.raises(InputError, match=r"axes\.datum"):
        declared_key(read_toml(file), "axes", DatumKeys)


def campaign(folder: Path, symbol: str, datum: str) -> None:
    angle, force, moment = ("beta", "Y", "N") if symbol == "Nv" else ("alpha", "Z", "M")
    folder.mkdir()
    (folder / "campaign.toml").write_text(
        f'[campaign]\nname = "{folder.name}"\ntitle = "t"\nbody = "b"\n[axes]\nframe = "FRD"\n'
        f'{angle} = "{"v" if angle == "beta" else "w"} = +U sin({angle})"\n'
        f'datum = "{datum}"\nreference_point = [-2.0, 0, 0]\n[scaling]\nlength = 4.0\nlength_name = "LOA"\n'
        '[conditions]\nspeed = 2.0\ndensity = 1000.0\n[source]\ncitation = "synthetic"\nkind = "synthetic"\n'
        'how_obtained = "invented"\n[[table]]\nfile = "table.csv"\ncontains_inertia = false\n'
    )
    rows = "".join(
        f"{a},{-9.0 * a - 0.01 * a**3 + a % 4},{7.0 * a + 0.002 * a**3 - a % 4}\n" for a in range(-12, 13, 2)
    )
    (folder / "table.csv").write_text(f"{angle} [deg],{force} [N],{moment} [N*m]\n{rows}")


def plan(folder: Path, *datums: str) -> Path:
    campaign(folder / "yaw", "Nv", datums[0])
    campaign(folder / "pitch", "Mw", datums[1])
    path = folder / "plan.toml"
    path.write_text(
        '[study]\nname = "s"\nwanted = ["Nv", "Mw"]\n'
        + "".join(f'[[table]]\ncampaign = "{c}"\nfits = ["slope_at_origin"]\n' for c in ("yaw", "pitch"))
        + '[[parameter_file]]\nname = "p"\nbody = "b"\ncampaigns = ["yaw", "pitch"]\n'
    )
    return path


def test_moments_about_two_datums_never_end_in_one_file(tmp_path: Path) -> None:
    with pytest.raises(CoeflabError, match='yaw measures points from "nose", pitch from "nose, 2 m aft"'):
        run(read_plan(plan(tmp_path, "nose", PROSE)))


@pytest.mark.parametrize("datums", [(PROSE, PROSE), ("nose", "nose, on the hull's axis")])
def test_campaigns_of_one_datum_still_do(tmp_path: Path, datums: tuple[str, str]) -> None:
    file = run(read_plan(plan(tmp_path, *datums))).parameter_files["p"]
    assert all((c := file.coefficient(s)) is not None and c.value is not None for s in ("Nv", "Mw"))
    assert file.reference_point.datum == Datum.named(datums[0]).id
