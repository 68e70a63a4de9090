"""A density that is one of air or in g/cm^3, and a point that is nearly nose, are asked back wherever they are read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.axes import datum_name
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.study.plan import read_plan
from coeflab.tables.campaign import read_campaign
from coeflab.tables.settings import read_settings
from coeflab.vehicle.own_numbers import typed_file


def table(density: Any = 1000, about: str = "nose") -> float:
    v = np.linspace(-0.3, 0.3, 9)
    return cf.read_table(
        {"v [m/s]": v, "Y [N]": -120.0 * v}, name="drift", frame="FRD", length=2.0, density=density, speed=2.0, about=about
    ).conditions.density  # fmt: skip


def campaign(density: Any, datum: str = "nose") -> float:
    """A shipped campaign.toml with another density."""
    place = Path("campaign.toml")
    text = (shipped("cfd_data") / "flyingfish_water_synthetic" / "campaign.toml").read_text()
    written = density if isinstance(density, float) else f'"{density}"'
    place.write_text(text.replace('"1000 kg/m^3"', str(written)).replace('datum = "cg"', f'datum = "{datum}"'))
    return read_campaign(place).conditions.density


def planned(density: Any, datum: str = "nose") -> float:
    """A plan.toml with conditions of its own."""
    place = Path("plan.toml")
    written = density if isinstance(density, float) else f'"{density}"'
    place.write_text(
        f'[study]\nname = "p"\nreference_point = [0.0, 0.0, 0.0]\ndatum = "{datum}"\n[conditions]\nspeed = "2 m/s"\n'
        f'density = {written}\n[[table]]\ncampaign = "suboff_roddy_2"\nfits = ["slope_at_origin"]\n'
    )
    conditions = read_plan(place).conditions
    return conditions.density


def typed(density: Any) -> float:
    """A setting of an import, as --set and the form take it."""
    found = read_settings("conditions.density", str(density))["conditions.density"]
    return 1000.0 * float(str(found).split()[0]) if "cm" in str(found) else float(str(found).split()[0])


def estimated(density: Any) -> float:
    return 1000.0 if cf.estimate("remus100", density=density) else 0.0


@pytest.mark.parametrize("read", [table, campaign, planned, typed, estimated])
def test_a_bare_density_about_one_is_asked_back(
    read: Callable[[Any], float], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for wrong in (1.0, 1.025, 0.9982):
        with pytest.raises(InputError, match="g/cm"):
            read(wrong)
    assert read("1 g/cm^3") == pytest.approx(1000.0)


def test_air_is_taken_with_its_unit() -> None:
    assert (table("1.0 kg/m^3"), table(1.2), table("1.2 kg/m^3")) == (1.0, 1.2, 1.2)


@pytest.mark.parametrize(
    "read",
    [
        lambda d: table(about=d),
        lambda d: table(about=f"{d}, 1.0 m aft"),
        lambda d: campaign("1000 kg/m^3", d),
        lambda d: planned("1000 kg/m^3", d),
        lambda d: read_settings("axes.datum", d),
        lambda d: typed_file("t", ["Yv'=-0.1"], length="2 m", length_name="LOA", speed="2", density="1000", about=d),
    ],
)
def test_a_near_miss_of_a_usual_point_is_asked_back(
    read: Callable[[str], Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for wrong in ("noze", "midshp", "sterm"):
        with pytest.raises(InputError, match="Did you mean"):
            read(wrong)
    read("midship")


@pytest.mark.parametrize(
    "own", ["tow_point", "balance", "root_quarter_chord", "tip", "middle", "NOSE", "CG", "strut", "sensor"]
)
def test_points_of_ones_own_are_taken(own: str) -> None:
    assert datum_name(own) == own
