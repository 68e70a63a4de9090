"""Equations in closed form: generated code beside the numeric route, the paper's expressions, sympy's own Kane's method."""

from __future__ import annotations

import ctypes
import importlib.util
import re
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from coeflab.arm import kane
from coeflab.arm.chain import Base, Chain, Joint, Link
from coeflab.arm.closed_form import derive, link_motion
from coeflab.arm.languages import Origin, written
from coeflab.arm.tape import ClosedForm
from coeflab.core.errors import InputError
from coeflab.core.types import Array
from tests.arm.chains import drawn
from tests.arm.chains import puma as puma_chain

ORIGIN = Origin("body.toml", "0" * 64, ('Two */ lines """ of \\n text',))
ALIGNED = re.compile(r"\\begin\{align\*\}\n(.*?)\\end\{align\*\}", re.S)
MATRIX = re.compile(r"\\begin\{pmatrix\}(.*?)\\end\{pmatrix\}")
TOLERANCE = 1e-12
Code = Callable[..., dict[str, Array]]


def arguments(chain: Chain, many: int = 1) -> dict[str, Array]:
    """Arguments, a column each."""
    rng = np.random.default_rng(7)
    sizes = {"q": chain.count, "s": chain.size, "down": 3, "current": 3, "acceleration": 3}
    return {key: rng.normal(size=(size, many)) for key, size in sizes.items()}


def numeric(chain: Chain, at: dict[str, Array]) -> dict[str, Array]:
    """All quantities by `kane`, at one column."""
    q, s, down, current, acceleration = at.values()
    out = {
        "mass_matrix": kane.mass_matrix(chain, q),
        "bias": kane.bias(chain, q, s, current, acceleration),
        "weight": kane.weight(chain, q, down),
        "buoyancy": kane.buoyancy(chain, q, down),
        "fluid_acceleration": kane.fluid_acceleration(chain, q, acceleration),
        "drag": kane.drag(chain, q, s, current),
        "end_effector": kane.pose(chain, q).end,
    }
    forces = out["weight"] + out["buoyancy"] + out["fluid_acceleration"] + out["drag"] - out["bias"]
    return {**out, "equations M": out["mass_matrix"], "equations f": forces}


def differing(found: dict[str, Array], expected: dict[str, Array]) -> list[str]:
    """What is off by more than the tolerance of its largest entry."""
    assert set(found) == set(expected)
    return [k for k, e in expected.items() if np.max(np.abs(found[k] - e)) > TOLERANCE * max(np.max(np.abs(e)), 1e-3)]


def compiled(form: ClosedForm, folder: Path) -> Code:
    """The C of a form, built as a user may: no warning passes."""
    files = written(form, "c", ORIGIN)
    for name, content in files.items():
        (folder / name).write_bytes(content)
    (source,) = folder.glob("*.c")
    build = ["cc", "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O0", "-shared", "-fPIC"]
    subprocess.run([*build, "-o", folder / "form.so", source, "-lm"], check=True)
    library = ctypes.CDLL(str(folder / "form.so"))

    def run(at: dict[str, Array], parameters: Array | None = None) -> dict[str, Array]:
        out = {}
        for f in form.functions:
            made = [np.full((m.rows, m.cols), np.nan) for m, _ in f.outputs.values()]
            given = [np.ascontiguousarray(at[a]) for a in f.arguments]
            if form.parameters:
                own = [p.value for p in form.parameters] if parameters is None else parameters
                given.insert(0, np.array(own))
            pointers = [a.ctypes.data_as(ctypes.c_void_p) for a in (*given, *made)]
            getattr(library, f"{source.stem}_{f.name}")(*pointers)
            for key, m in zip(f.outputs, made, strict=True):
                out[f"{f.name} {key}" if len(made) > 1 else f.name] = m if m.shape[1] > 1 else m[:, 0]
        return out

    return run


@pytest.fixture(scope="module")
def puma() -> tuple[Chain, ClosedForm]:
    return puma_chain(), derive(puma_chain())


@pytest.fixture(scope="module")
def random() -> tuple[Chain, ClosedForm]:
    """Two links, one of which slides; numbers kept as symbols."""
    chain = replace(drawn(1, 2), tool=np.array([0.1, 0.2, 0.3]))
    assert [joint.kind for joint in chain.joints] == ["revolute", "prismatic"]
    return chain, derive(chain, symbols=True)


@pytest.fixture(scope="module")
def random_code(random: tuple[Chain, ClosedForm], tmp_path_factory: pytest.TempPathFactory) -> Code:
    return compiled(random[1], tmp_path_factory.mktemp("random"))


def one(columns: dict[str, Array], k: int = 0) -> dict[str, Array]:
    return {key: a[:, k] for key, a in columns.items()}


def test_c_equals_the_numeric_route_on_the_puma(puma: tuple[Chain, ClosedForm], tmp_path: Path) -> None:
    chain, form = puma
    at = one(arguments(chain))
    assert differing(compiled(form, tmp_path)(at), numeric(chain, at)) == []


def test_c_equals_the_numeric_route_on_a_random_chain(random: tuple[Chain, ClosedForm], random_code: Code) -> None:
    chain, _ = random
    at = one(arguments(chain))
    assert differing(random_code(at), numeric(chain, at)) == []


def test_other_numbers_go_into_the_same_code(random: tuple[Chain, ClosedForm], random_code: Code) -> None:
    """A heavier first link that is longer, in denser water."""
    chain, form = random
    first = chain.links[0]
    link = replace(first, mass=2 * first.mass, joint=replace(first.joint, a=first.joint.a + 0.3))
    other = replace(chain, links=(link, *chain.links[1:]), density=1025.0)
    values = {p.symbol.name: p.value for p in form.parameters}
    values |= {"m_1": link.mass, "a_1": link.joint.a, "rho": 1025.0}
    at = one(arguments(chain))
    assert differing(random_code(at, np.array(list(values.values()))), numeric(other, at)) == []


def test_python_equals_the_numeric_route_column_by_column(random: tuple[Chain, ClosedForm], tmp_path: Path) -> None:
    chain, form = random
    ((name, content),) = written(form, "python", ORIGIN).items()
    (tmp_path / name).write_bytes(content)
    spec = importlib.util.spec_from_file_location("form", tmp_path / name)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)

    def run(at: dict[str, Array]) -> dict[str, Array]:
        out = {}
        for f in form.functions:
            made = getattr(module, f.name)(*(at[a] for a in f.arguments))
            for key, m in zip(f.outputs, made if len(f.outputs) > 1 else [made], strict=True):
                out[f"{f.name} {key}" if len(f.outputs) > 1 else f.name] = m
        return out

    columns = arguments(chain, 3)
    together = run(columns)
    for k in range(3):
        at = one(columns, k)
        expected = numeric(chain, at)
        assert differing({key: a[..., k] for key, a in together.items()}, expected) == []
        assert differing(run(at), expected) == []


@pytest.mark.slow
def test_octave_equals_the_numeric_route(random: tuple[Chain, ClosedForm], tmp_path: Path) -> None:
    chain, form = random
    files = written(form, "octave", ORIGIN)
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    at = one(arguments(chain))
    lines = [f"{key} = [{' '.join(repr(float(v)) for v in a)}];" for key, a in at.items()]
    lines += ["of = drawn_parameters();"]
    for f in form.functions:
        lines.append(f"[{', '.join(f.outputs)}] = drawn_{f.name}({', '.join(('of', *f.arguments))});")
        for key in f.outputs:
            lines.append(f"printf('{f.name} {key}'); printf(' %.17g', {key}.'); printf('\\n');")
    (tmp_path / "all.m").write_text("\n".join(lines))
    done = subprocess.run(["octave-cli", "--norc", "all.m"], cwd=tmp_path, capture_output=True, text=True, check=True)
    found = {}
    expected = numeric(chain, at)
    for line in done.stdout.splitlines():
        name, key, *numbers = line.split()
        full = f"{name} {key}" if name == "equations" else name
        found[full] = np.array(numbers, float).reshape(expected[full].shape)
    assert differing(found, expected) == []


def test_latex_has_every_entry_and_closes_what_it_opens(puma: tuple[Chain, ClosedForm]) -> None:
    form = puma[1]
    ((name, content),) = written(form, "latex", ORIGIN).items()
    text = content.decode()
    assert name == "urv_puma.tex"
    stripped = re.sub(r"\\[{}]", "", text)
    assert stripped.count("{") == stripped.count("}")
    for word in ("align*", "document"):
        assert text.count(rf"\begin{{{word}}}") == text.count(rf"\end{{{word}}}") > 0
    body = text.partition(r"\section*{Mass matrix}")[2].partition(r"\section*{Bias}")[0]
    nonzero = [(i, j) for i in range(9) for j in range(i, 9) if form.function("mass_matrix").outputs["M"][0][i, j] != 0]
    assert re.findall(r"^M_\{(\d),(\d)\} &=", body, re.M) == [(str(i + 1), str(j + 1)) for i, j in nonzero]
    assert r"\int_0^1 |\mathbf{u}_{1}(t)|" in text


def test_latex_is_set_by_a_parser_of_its_own(puma: tuple[Chain, ClosedForm]) -> None:
    """matplotlib's mathtext, which knows no matrices: their entries one by one. One line of each set of commands."""
    from matplotlib.mathtext import MathTextParser

    (content,) = written(puma[1], "latex", ORIGIN).values()
    lines = [line for block in ALIGNED.findall(content.decode()) for line in block.strip().splitlines()]
    assert all(line.endswith(r" \\") for line in lines)
    kinds = {}
    for line in lines:
        head, matrices = line.removesuffix(r" \\").replace("&", ""), MATRIX.findall(line)
        assert [one.count(r"\\") for one in matrices] == [2] * len(matrices)
        for part in (MATRIX.sub("m", head), *(entry for one in matrices for entry in one.split(r"\\"))):
            kinds.setdefault(frozenset(re.findall(r"\\\w+", part)), part.strip())
    assert len(kinds) > 10
    parser = MathTextParser("path")
    for part in kinds.values():
        parser.parse(f"${part}$")


def test_what_a_name_holds_cannot_leave_its_comment(puma: tuple[Chain, ClosedForm]) -> None:
    for language, ends in (("c", "*/ lines"), ("python", '"""' + " of")):
        for content in written(puma[1], language, ORIGIN).values():
            lines = [
                line for line in content.decode().splitlines() if "lines" in line and "of" in line and "Two" in line
            ]
            assert lines
            assert all(ends not in line if language == "c" else line.startswith("#") for line in lines)


@pytest.mark.parametrize(
    ("language", "where"),
    [
        ("c", "as urv_of_file holds them: the first argument"),
        ("octave", "Numbers of the file: the first argument"),
        ("python", "as its last argument, of"),
    ],
)
def test_where_parameters_go_and_what_does_not_follow_the_density(
    puma: tuple[Chain, ClosedForm], random: tuple[Chain, ClosedForm], language: str, where: str
) -> None:
    stays = "where the density rho is changed, added masses and volumes stay as given"

    def said(form: ClosedForm) -> str:
        texts = [content.decode() for content in written(form, language, ORIGIN).values()]
        return " ".join(re.sub(r"^ *[%#]", "", " ".join(texts), flags=re.MULTILINE).split())

    symbols = said(random[1])
    assert where.replace("urv", random[1].name) in symbols
    assert stays in symbols
    assert stays not in said(puma[1])


def test_every_quantity_is_named_before_it_is_derived() -> None:
    steps: list[str] = []
    form = derive(drawn(3, 1), say=steps.append)
    assert steps == [f.name.replace("_", " ") for f in form.functions]
    assert steps[0] == "mass matrix"
    assert {"bias", "drag", "equations", "end effector"} < set(steps)


def test_a_vehicle_without_an_arm_has_nothing_to_derive() -> None:
    with pytest.raises(InputError, match="a vehicle without links; expected one link or more"):
        derive(replace(drawn(1, 1), links=()))


@pytest.mark.slow
def test_six_links(tmp_path: Path) -> None:
    """Every number drawn, two joints slide: the longest equations."""
    chain = drawn(0)
    said: list[str] = []
    form = derive(chain, say=said.append)
    assert len(said) == len(form.functions)
    at = one(arguments(chain))
    assert differing(compiled(form, tmp_path)(at), numeric(chain, at)) == []


# Section 4.2 of the URV paper, in its own symbols: c and k stand for .3088 and .0389.
W = "Matrix([wx, wy, wz + dq])"
P = "Matrix([cx - k*sin(q), k*cos(q), -c + cz])"
VX = "vx + (-c + cz)*wy - k*cos(q)*wz - k*cos(q)*dq"
VY = "vy - (-c + cz)*wx + (cx - k*sin(q))*wz - k*sin(q)*dq"
VZ = "vz + k*cos(q)*wx - (cx - k*sin(q))*wy"
ALPHA = "Matrix([-(wy*wz) + wy*(wz + dq) + dwx, wx*wz - wx*(wz + dq) + dwy, dwz + ddq])"
# The brackets of vx, vy and vz close too early or not at all in print: repaired, and as they stand.
AX = f"wy*({VZ}) + k*sin(q)*wz*dq + k*sin(q)*dq**2 - wz*({VY}) + dvx + (-c + cz)*dwy - k*cos(q)*dwz - k*cos(q)*ddq"
AY = f"-(wx*({VZ})) - k*cos(q)*wz*dq - k*cos(q)*dq**2 + wz*({VX}) + dvy - (-c + cz)*dwx + (cx - k*sin(q))*dwz - k*sin(q)*ddq"
AZ = f"-k*sin(q)*wx*dq + k*cos(q)*wy*dq - wy*({VX}) + wx*({VY}) + dvz + k*cos(q)*dwx - (cx - k*sin(q))*dwy"
PRINTED_AX = (
    f"wy*({VZ}) + k*sin(q)*wz*dq + k*sin(q)*dq**2 - wz*(vy - (-c + cz)*wx) + (cx - k*sin(q))*wz - k*sin(q)*dq + dvx"
    " + (-c + cz)*dwy - k*cos(q)*dwz - k*cos(q)*ddq"
)


@pytest.fixture(scope="module")
def link_1() -> dict[str, sp.Matrix]:
    """Our expressions of link 1 in the paper's frame and symbols."""
    turn = sp.diag(1, -1, -1)
    house = {}
    for prefix, names in (("s", "vx vy vz wx wy wz dq"), ("sdot", "dvx dvy dvz dwx dwy dwz ddq")):
        own = sp.symbols(names)
        flat = [*(turn * sp.Matrix(own[:3])), *(turn * sp.Matrix(own[3:6])), own[6]]
        house |= {sp.Symbol(f"{prefix}{i}"): e for i, e in enumerate(flat, 1)}
    cx, cz, c, k, q = sp.symbols("cx cz c k q")
    names = {"c_0x": cx, "c_0z": -cz, "c_1y": c, "c_1z": k, "q1": q}
    house |= {sp.Symbol(name): e for name, e in names.items()}
    return {key: turn * m.subs(house, simultaneous=True) for key, m in link_motion(puma_chain(), 1).items()}


def same(ours: sp.Matrix, printed: str) -> bool:
    """Equal for every q: sine and cosine as fractions of the tangent of half of it."""
    q, t = sp.symbols("q t")
    half = {sp.sin(q): 2 * t / (1 + t**2), sp.cos(q): (1 - t**2) / (1 + t**2)}
    return all(sp.cancel(e.subs(half)) == 0 for e in ours - sp.sympify(printed))


@pytest.mark.parametrize(
    ("quantity", "printed"),
    [("p", P), ("w", W), ("v", f"Matrix([{VX}, {VY}, {VZ}])"), ("alpha", ALPHA), ("a", f"Matrix([{AX}, {AY}, {AZ}])")],
)
def test_the_published_expressions_of_link_1_hold(link_1: dict[str, sp.Matrix], quantity: str, printed: str) -> None:
    assert same(link_1[quantity], printed)


def test_the_printed_acceleration_holds_only_with_its_brackets_repaired(link_1: dict[str, sp.Matrix]) -> None:
    assert not same(link_1["a"], f"Matrix([{PRINTED_AX}, {AY}, {AZ}])")


def test_sympys_own_kanes_method_gives_the_same_numbers() -> None:
    """A vehicle that moves in its plane, with one link, put together by sympy.physics.mechanics alone."""
    x, z, th, q = dynamicsymbols("x z th q")
    u, w, r, dq = dynamicsymbols("u w r dq")
    m0, m1, i0, i1, reach, lever, g = 9.0, 2.0, 3.0, 0.7, 0.4, 0.6, 9.81
    earth, hull, arm = ReferenceFrame("E"), ReferenceFrame("H"), ReferenceFrame("L")
    hull.orient_axis(earth, earth.y, th)
    hull.set_ang_vel(earth, r * earth.y)
    arm.orient_axis(hull, hull.y, q)
    arm.set_ang_vel(hull, dq * hull.y)
    origin, centre = Point("O"), Point("C")
    origin.set_vel(earth, 0)
    centre.set_vel(earth, u * hull.x + w * hull.z)
    shoulder = centre.locatenew("S", reach * hull.x)
    shoulder.v2pt_theory(centre, earth, hull)
    tip = shoulder.locatenew("T", lever * arm.x)
    tip.v2pt_theory(shoulder, earth, arm)
    bodies = [
        RigidBody("hull", centre, hull, m0, (inertia(hull, 1, i0, 1), centre)),
        RigidBody("arm", tip, arm, m1, (inertia(arm, 1, i1, 1), tip)),
    ]
    forces = [(centre, m0 * g * earth.z), (tip, m1 * g * earth.z)]
    rates = [
        x.diff() - u * sp.cos(th) - w * sp.sin(th),
        z.diff() + u * sp.sin(th) - w * sp.cos(th),
        th.diff() - r,
        q.diff() - dq,
    ]
    kane_of_sympy = KanesMethod(earth, [x, z, th, q], [u, w, r, dq], rates)
    kane_of_sympy.kanes_equations(bodies, forces)
    numbers = dict(zip((x, z, th, q, u, w, r, dq), (0.0, 0.0, 0.3, 0.8, 0.5, -0.2, 0.4, -0.9), strict=True))
    mass = np.array(kane_of_sympy.mass_matrix.subs(numbers).evalf(), float)
    forcing = np.array(kane_of_sympy.forcing.subs(numbers).evalf(), float)[:, 0]

    # The same by the house: a joint about y, frame 0 with z along y, link 1 with x along the arm.
    mount = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    base = Base("hull", m0, np.diag([i0, i0, i0]))
    link = Link(
        "arm", Joint("q", "revolute", 0.0, 0.0, 0.0, 0.0), m1, np.array([lever, 0.0, 0.0]), np.diag([i1, i1, i1])
    )
    chain = Chain("plane", base, (link,), np.array([reach, 0.0, 0.0]), mount, gravity=g)
    form = derive(chain)
    values = {"q": [0.8], "s": [0.5, 0, -0.2, 0, 0.4, 0, -0.9], "down": [-np.sin(0.3), 0, np.cos(0.3)]}
    known = {sp.Symbol(f"{key}{k}"): v for key, many in values.items() for k, v in enumerate(many, 1)}
    known |= {sp.Symbol(f"{key}{k}"): 0 for key in ("current", "acceleration") for k in (1, 2, 3)}
    keep = [0, 2, 4, 6]
    equations = form.function("equations")
    ours = np.array(equations.expanded("M").subs(known).evalf(), float)[np.ix_(keep, keep)]
    f = np.array(equations.expanded("f").subs(known).evalf(), float)[keep, 0]
    assert ours == pytest.approx(mass, abs=1e-12)
    assert f == pytest.approx(forcing, abs=1e-12)
