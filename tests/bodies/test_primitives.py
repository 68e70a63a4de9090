"""Bodies of parts: forms, poses, volumes, and files that cannot be."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.bodies.readers.primitives import rotation
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Part, Parts, Plate, Revolution, StandIn, as_revolution
from coeflab.core.errors import InputError
from coeflab.core.files import shipped

HEAD = """[body]
name = "b"
reader = "primitives"
datum = "middle"
reference_point = [0.0, 0.0, 0.0]
[source]
citation = "synthetic"
"""
HULL = """[[part]]
name = "hull"
form = "cylinder"
radius = "10 cm"
length = 2.0
centre = [1.0, 0.0, 0.0]
"""


def read(folder: Path, text: str) -> Parts:
    (folder / "body.toml").write_text(HEAD + text)
    shape = read_body(folder / "body.toml").require_shape()
    assert isinstance(shape, Parts)
    return shape


def part(size: str, folder: Path) -> Part:
    return read(folder, f'[[part]]\nname = "p"\ncentre = [0, 0, 0]\n{size}').parts[0]


@pytest.mark.parametrize(
    ("size", "form", "volume"),
    [
        ('form = "cylinder"\nradius = 0.1\nlength = 2', Cylinder(0.1, 2.0), 0.02 * np.pi),
        ('form = "plate"\nchord = "12 cm"\nspan = 0.3', Plate(0.12, 0.3), 0.0),
        ('form = "spheroid"\nlength = 4\ndiameter = 2', Ellipsoid(2.0, 1.0, 1.0), 8.0 / 3.0 * np.pi),
        ('form = "ellipsoid"\nsemi_axis_x = 3\nsemi_axis_y = 2\nsemi_axis_z = 1', Ellipsoid(3, 2, 1), 8.0 * np.pi),
        ('form = "sphere"\nradius = 2', Ellipsoid(2, 2, 2), 32.0 / 3.0 * np.pi),
        ('form = "box"\nlength = 3\nwidth = 2\nheight = 1', Box(3, 2, 1), 6.0),
    ],
)
def test_forms(tmp_path: Path, size: str, form: object, volume: float) -> None:
    found = part(size, tmp_path)
    assert found.form == form
    assert found.form.volume == pytest.approx(volume, rel=1e-14)


def test_poses() -> None:
    """Pitched up by 90 deg, x points up (-z); yawed by 90 deg, x points to starboard; rolled, y points down."""
    assert rotation(0.0, np.pi / 2, 0.0)[:, 0] == pytest.approx([0, 0, -1], abs=1e-15)
    assert rotation(0.0, 0.0, np.pi / 2)[:, 0] == pytest.approx([0, 1, 0], abs=1e-15)
    assert rotation(np.pi / 2, 0.0, 0.0)[:, 1] == pytest.approx([0, 0, 1], abs=1e-15)
    turn = rotation(0.3, -0.7, 1.9)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_length_and_spread_in_any_pose() -> None:
    """Against points drawn over each form, turned."""
    rng = np.random.default_rng(7)
    ball = rng.normal(size=(200_000, 3))
    ball *= (rng.random(len(ball)) ** (1 / 3) / np.linalg.norm(ball, axis=1))[:, None]
    cube = rng.random((200_000, 3)) - 0.5
    angle, share = 2 * np.pi * rng.random(200_000), np.sqrt(rng.random(200_000))
    rod = np.column_stack([2.0 * cube[:, 0], 0.9 * share * np.cos(angle), 0.9 * share * np.sin(angle)])
    turn = rotation(0.3, -0.7, 1.1)
    for form, points in (
        (Ellipsoid(3, 2, 1), ball * [3, 2, 1]),
        (Box(3, 2, 1), cube * [3, 2, 1]),
        (Cylinder(0.9, 2), rod),
    ):
        shape = Parts((Part("p", form, np.array([5.0, 1.0, -2.0]), turn),))
        outer = points @ turn.T
        assert shape.length == pytest.approx(np.ptp(outer[:, 0]), rel=0.06)
        assert shape.length >= np.ptp(outer[:, 0]) - 1e-12
        assert form.spread == pytest.approx(np.var(points, axis=0), rel=0.01)
        ratio = np.std(outer[:, 1]) / np.std(outer[:, 2])
        assert shape.breadth_over_depth == pytest.approx(ratio, rel=0.005)


def test_sums_over_parts() -> None:
    hull = Part("hull", Box(2, 1, 1), np.array([1.0, 0, 0]), np.eye(3))
    fin = Part("fin", Plate(9, 9), np.array([-7.0, 0, 0]), np.eye(3))
    pod = Part("pod", Box(1, 1, 1), np.array([3.0, 0, 3.0]), np.eye(3))
    shape = Parts((hull, fin, pod))
    assert shape.volume == pytest.approx(3.0)
    assert shape.centre_of_volume == pytest.approx([5.0 / 3.0, 0.0, 1.0])
    assert shape.length == pytest.approx(3.5)
    assert Parts((fin,)).length == 0.0
    assert Parts((fin,)).centre_of_volume == pytest.approx([-7.0, 0.0, 0.0])


def test_what_is_a_body_of_revolution() -> None:
    origin, tilted = np.zeros(3), rotation(0.0, 0.1, 0.0)
    along = as_revolution(Parts((Part("p", Cylinder(0.1, 2.0), np.array([1.0, 0.2, 0.3]), np.eye(3)),)))
    assert isinstance(along, Revolution)
    assert along.volume == pytest.approx(0.02 * np.pi, rel=1e-13)
    assert along.centre_of_volume == pytest.approx([1.0, 0.2, 0.3])
    assert as_revolution(along) is along
    for form, turn in ((Cylinder(0.1, 2.0), tilted), (Ellipsoid(2, 1, 0.9), np.eye(3)), (Box(1, 1, 1), np.eye(3))):
        assert as_revolution(Parts((Part("p", form, origin, turn),))) is None
    two = tuple(Part(n, Cylinder(0.1, 2.0), origin, np.eye(3)) for n in "ab")
    assert as_revolution(Parts(two)) is None


def test_shipped_bodies() -> None:
    huuv = read_body(shipped("geometry") / "huuv" / "body.toml")
    assert "synthetic" in huuv.title
    assert huuv.source.kind == "synthetic"
    assert isinstance(huuv.shape, Parts)
    mast = huuv.shape.parts[1]
    assert mast.centre[2] + 0.15 == pytest.approx(-0.07)
    assert read_body(shipped("geometry") / "spheroid_example" / "body.toml").source.kind == "synthetic"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("length = 2.0", "length = -2.0", ['"part[0].length"', "above zero"]),
        ("length = 2.0", "length = 0", ['"part[0].length"', "above zero"]),
        ("length = 2.0", "length = 4356000", ['"part[0].form"', "Is the unit right?"]),
        ("length = 2.0", "length = inf", ['"part[0].length"', "finite"]),
        ("length = 2.0", 'length = "2 kg"', ['"part[0].length"', "a unit of length"]),
        ("length = 2.0\n", "", ['"part[0].length"', "found nothing"]),
        ('"cylinder"', '"cilinder"', ['"part[0].form"', '"cylinder" or "plate"']),
        ("radius =", "raduis =", ['"part[0].raduis"', "Did you mean part[0].radius?"]),
        ("length = 2.0", "length = 2.0\nspan = 1", ["part[0].span", "an unknown key"]),
        ("centre = [1.0, 0.0, 0.0]", "centre = [1.0]", ['"part[0].centre"', "a point"]),
        ("centre =", 'rotation = ["1 m", 0, 0]\ncentre =', ['"part[0].rotation"', "a unit of angle"]),
        ("centre =", "rotation = [0, 90, 0]\ncentre =", ['"part[0].rotation"', "an angle without a unit", '"90 deg"']),
        ("centre =", 'rotation = ["-361 deg", 0, 0]\ncentre =', ['"part[0].rotation"', "at most 360 deg"]),
        (HULL, HULL + HULL, ['"part"', 'two parts called "hull"']),
        (HULL, "", ['"part"', "no [[part]]"]),
    ],
)
def test_files_that_cannot_be(tmp_path: Path, old: str, new: str, said: list[str]) -> None:
    assert old in HULL
    with pytest.raises(InputError) as caught:
        read(tmp_path, HULL.replace(old, new))
    for words in ("body.toml", *said):
        assert words in str(caught.value)


@pytest.mark.parametrize("form", [Cylinder, Plate])
@pytest.mark.parametrize("size", [-1.0, 0.0, np.nan, np.inf])
def test_dimensions_that_cannot_be(form: type, size: float) -> None:
    with pytest.raises(InputError, match="a length above zero"):
        form(1.0, size)


def test_a_mirror_is_no_pose() -> None:
    with pytest.raises(InputError, match='the pose of part "p"'):
        Part("p", Box(1, 1, 1), np.zeros(3), np.diag([1.0, 1.0, -1.0]))


FIT = '{class = "cylinder", misfit = 0.02, shared = 0.95, volume = 0.001, length = -0.01, areas = [-0.12, 0.0, 0.01]}'


def test_a_fit_is_data(tmp_path: Path) -> None:
    """How well a part stands for a piece of a mesh: read, kept, and judged."""
    fit = read(tmp_path, f"{HULL}fit = {FIT}\n").parts[0].fit
    assert fit == StandIn("cylinder", 0.95, 0.001, (-0.12, 0.0, 0.01), -0.01, 0.02)
    assert fit.poor == ("A x -12.0 %",)
    assert fit.worst == "A x -12 %"
    other = read(tmp_path, f"{HULL}fit = {FIT.replace('cylinder', 'other').replace('-0.12', '0.0')}\n").parts[0].fit
    assert other.poor == ("class other (misfit 0.02, shares 95% of the volume)",)
    assert read(tmp_path, HULL).parts[0].fit is None


def test_a_thick_plate_is_rough_and_a_thin_one_is_not() -> None:
    thin = StandIn("plate", 0.99, -1.0, (-1.0, -1.0, 0.0), -0.2, thickness=0.04)
    assert (thin.poor, thin.rough) == ((), ())
    thick = StandIn("plate", 0.99, -1.0, (-1.0, -1.0, 0.0), -0.2, thickness=0.08)
    assert thick.poor == ()
    assert thick.rough == ("a plate without thickness for a piece of mean thickness 0.08 of the shorter side",)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            ('"cylinder"', '"box"'),
            r'part\[0\].fit": found the fit of a box for part "hull", a cylinder.*Delete the fit',
        ),
        (
            ('"cylinder"', '"good"'),
            r'fit.class": found "good"; expected one of cylinder, plate, ellipsoid, box, bar, tube',
        ),
        (("shared = 0.95", "shared = 1.2"), r'fit.shared": found 1.2; expected a share from 0 to 1'),
        (("misfit = 0.02", "misfit = -1"), r'fit.misfit": found -1; expected a number of at least zero'),
        (("misfit = 0.02, ", ""), r'fit.misfit": found neither misfit nor thickness'),
        (("misfit", "thickness = 0.1, misfit"), r'fit.misfit": found both misfit and thickness'),
        (("volume = 0.001", "volume = -1.1"), r'fit.volume": found -1.1; expected an error of form over piece'),
        (("areas = [-0.12, 0.0, 0.01]", "areas = [-0.12, 0.0]"), r'fit.areas": found .*; expected three errors'),
        (("areas = [-0.12, 0.0, 0.01]", "areas = [-3, 0.0, nan]"), r'fit.areas"'),
        (("length = -0.01", 'length = "1 m"'), r'fit.length"'),
        (("length = -0.01", "length = -0.01, colour = 3"), r'fit.colour": found an unknown key'),
    ],
)
def test_fits_that_cannot_be(tmp_path: Path, change: tuple[str, str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        read(tmp_path, f"{HULL}fit = {FIT.replace(*change)}\n")


def test_the_mesh_that_parts_stand_for_must_be_there(tmp_path: Path) -> None:
    table = '[mesh]\npath = "mesh.ply"\nunit = "m"\naxes = "FRD"\n'
    with pytest.raises(InputError, match=r'"mesh.path": found no file "mesh.ply".*delete \[mesh\]'):
        read(tmp_path, table + HULL)
    (tmp_path / "mesh.ply").write_bytes(b"not looked into before it is needed")
    assert len(read(tmp_path, table + HULL).parts) == 1
    body = read_body(tmp_path / "body.toml")
    assert [f.name for f in body.files] == ["b/body.toml", "b/mesh.ply"]
    with pytest.raises(InputError, match=r"mesh\.unit"):
        read(tmp_path, table.replace('"m"', '"kg"') + HULL)
