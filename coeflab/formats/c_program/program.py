"""C99 for the board: forces, accelerations and one step of a vehicle, no allocation, no library but libm.

Header, source, and a program that holds them against the file's own law. It compiles as C++17 too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files as resources

import numpy as np
from numpy.typing import NDArray

from coeflab.core.text.bounded import own_text
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import identifier
from coeflab.formats.c_program.source import law_of, numbers, remark, source
from coeflab.formats.flat_law import FlatLaw, flat_law, free_motions
from coeflab.formats.lacking_law import in_header
from coeflab.formats.loss import covered_grid, rare_states
from coeflab.law.rigid_body import axes_in_earth, rigid_body_force, weighed
from coeflab.law.symbols import CONTROLS
from coeflab.vehicle.expected_signs import control_signs
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.parameter_file import ParameterFile

# Words of C and C++, names of the files beside it, and unit.c of an FMU.
_WORDS = (
    "auto unit break case char const continue default do double else enum extern float for goto if inline int long "
    "register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while "
    "bool class new delete this true false and or not xor namespace template typename using public private protected "
    "virtual operator friend try catch throw main math check"
)
RESERVED = frozenset(_WORDS.split())
CHECKED = 24  # states of the check program
LONGEST_STEP = 40


def name_of(parameters: ParameterFile) -> str:
    """Prefix of functions and files."""
    return identifier(parameters.name, RESERVED, LONGEST_STEP)


def header(parameters: ParameterFile, law: FlatLaw, name: str) -> str:
    """The header."""
    upper, p = name.upper(), parameters
    point = ", ".join(f"{x:g}" for x in p.reference_point.point)
    moves = free_motions(law) or "nothing: the file states no inertia"
    lines = [
        f"/* {remark(p.name)}, body: {remark(p.body)}",
        f"   reference point ({point}) m from: {remark(p.reference_point.datum)}; x forward, y starboard, z down; SI, rad.",
        "   nu u v w p q r through the water; delta dr ds db; attitude: unit quaternion, scalar first, body to north-east-down.",
        *(f"   {remark(words)}" for words in (*control_signs(p), *in_header(p, tables=True), *water_inertia(p).statements)),
        f"   Moves {moves}.",
        "   Functions give 0; 1 where a table refuses to be read outside of its data, with NaN; 2 without an inertia. */",
        f"#ifndef {upper}_H",
        f"#define {upper}_H",
        "#ifdef __cplusplus",
        'extern "C" {',
        "#endif",
        "",
        f"#define {upper}_THRUSTERS {len(p.thrusters)}",
        f"#define {upper}_MOVES {len(law.free)}",
        *(f"/* thruster {k}: {remark(t.name)}, {remark(t.curve.command)} in {remark(t.curve.unit)} */" for k, t in enumerate(p.thrusters)),
        "",
        "/* Where it is, how it lies, how it moves, where its fins are. */",
        f"typedef struct {{ double position[3], attitude[4], nu[6], angles[3]; }} {name}_state;",
        "",
        "/* Added mass about the reference point, rows X Y Z K M N. */",
        f"extern const double {name}_added_mass[36];",
        "",
        "/* X Y Z K M N of the water, -C_A(nu) nu in it; angles beyond their limits are held at them. */",
        f"int {name}_force(const double nu[6], const double delta[3], double force[6]);",
        "/* X Y Z K M N of the thrusters at their commands, or what they do on the way there, and tilts; tilt may be null. */",
        f"void {name}_thrust(const double command[], const double tilt[], double force[6]);",
        "/* What thrusters do, on its way to their commands for dt (s) by their lag: that is what thrust takes. */",
        f"void {name}_spin(const double command[], double dt, double actual[]);",
        "/* Rates of u v w p q r under the water, weight and buoyancy, and external: thrusters and all else. */",
        f"int {name}_acceleration(const double nu[6], const double attitude[4], const double delta[3], const double external[6], double rates[6]);",
        "/* One step of dt (s) by Runge and Kutta's method of order 4; fins move to their order at their rate. */",
        f"int {name}_step({name}_state *state, const double order[3], const double external[6], double dt);",
        "",
        "#ifdef __cplusplus",
        "}",
        "#endif",
        "#endif",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def whole_source(parameters: ParameterFile, law: FlatLaw, name: str) -> str:
    """The source with the added mass."""
    text = source(parameters, law, name)
    added = ", ".join(repr(float(x) + 0.0) for x in water_inertia(parameters).matrix.ravel())
    place = text.index("/* The force law of")
    return f"{text[:place]}const double {name}_added_mass[36] = {{{added}}};\n\n{text[place:]}"


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """Header, source and check program.

    Raises
    ------
    InputError
        M + M_A is not positive definite, or a hull has too many corners.
    """
    law, name = flat_law(parameters), name_of(parameters)
    text = {
        f"{name}.h": header(parameters, law, name),
        f"{name}.c": whole_source(parameters, law, name),
        f"{name}_check.c": _check(parameters, law, name),
    }
    return {file: content.encode() for file, content in text.items()}


def check_states(parameters: ParameterFile) -> tuple[Array, Array, Array]:
    """Velocities, angles and attitudes of the check program: over the covered grid, astern, broadside and at rest."""
    grid, rare = covered_grid(parameters)[0], rare_states(parameters)
    chosen = [
        grid[np.linspace(0, len(grid) - 1, CHECKED // 2, dtype=int)],
        rare[np.linspace(0, len(rare) - 1, CHECKED // 2, dtype=int)],
    ]
    nu = np.vstack(chosen)
    angles = np.array([[0.1 * ((k + i) % 5 - 2) for i in range(3)] for k in range(len(nu))])
    attitudes = np.array([[1.0, 0.05 * (k % 3), -0.1 * (k % 2), 0.02 * k] for k in range(len(nu))])
    return nu, angles, attitudes / np.linalg.norm(attitudes, axis=1)[:, None]


def _check(parameters: ParameterFile, law: FlatLaw, name: str) -> str:
    nu, angles, attitudes = check_states(parameters)
    limits = np.array([next((s.limit for s in parameters.surfaces if s.control == c), np.inf) for c in CONTROLS])
    held = np.clip(angles, -limits, limits)
    strict = law.law.refused(nu, held, 1e-9)
    force = law.law.force(nu, held)
    rates = accelerations(parameters, law, force, nu, attitudes)
    rows = []
    for k in range(len(nu)):
        selected = [
            *nu[k],
            *angles[k],
            *attitudes[k],
            *([0.0] * 12 if strict[k] else [*force[k], *rates[k]]),
            float(strict[k]),
        ]
        rows.append("    {" + ", ".join(repr(float(x) + 0.0) for x in selected) + "}")
    scales = [float(np.abs(force[~strict][:, g]).max(initial=0.0)) or 1.0 for g in (slice(0, 3), slice(3, 6))]
    turns = [float(np.abs(rates[~strict][:, g]).max(initial=0.0)) or 1.0 for g in (slice(0, 3), slice(3, 6))]
    check = own_text(resources("coeflab.formats.c_program") / "check.c")
    facts = {
        "name": name,
        "count": str(len(nu)),
        "rows": ",\n".join(rows),
        "scales": ", ".join(map(repr, [*scales, *turns])),
    }
    for key, value in facts.items():
        check = check.replace(f"@{key}@", value)
    return check


def accelerations(parameters: ParameterFile, law: FlatLaw, force: Array, nu: Array, attitudes: Array) -> Array:
    """(n, 6) rates under forces of the water, weight and buoyancy."""
    mass = parameters.mass
    if mass is None:
        return np.zeros_like(nu)
    moments = law.rigid[3:, 3:]
    still = np.column_stack(weighed(law.excess, *law.lever, *axes_in_earth(*attitudes.T)[2::3]))
    total = force + still - rigid_body_force(mass.mass, mass.centre_of_gravity, moments, nu)
    return np.asarray(total @ law.inverse.T)


def _text(files: Mapping[str, bytes]) -> str:
    return next(
        content for name, content in files.items() if name.endswith(".c") and not name.endswith("_check.c")
    ).decode()


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """The law of the arrays in the source, no control deflected."""
    return law_of(_text(files)).force(nu)


def steered_force(
    files: Mapping[str, bytes], nu: NDArray[np.float64], controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same under control angles, held at their limits."""
    text = _text(files)
    limits = np.array(numbers(text)["LIMIT"][:3])
    return law_of(text).force(nu, np.clip(controls, -limits, limits))


def added_mass(files: Mapping[str, bytes]) -> NDArray[np.float64]:
    """The added mass in the source."""
    found = next(v for n, v in numbers(_text(files)).items() if n.endswith("_added_mass"))
    return np.array(found).reshape(6, 6)


def refuse_without_mass(parameters: ParameterFile, target: str) -> None:
    """Refuse a file whose motion nothing determines.

    Raises
    ------
    InputError
    """
    if parameters.mass is None:
        raise input_error("formats.no_mass", column="mass", target=target)


def lines(texts: Sequence[str]) -> bytes:
    """A text file."""
    return ("\n".join(texts) + "\n").encode()
