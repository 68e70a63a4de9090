"""What every body.toml says before it comes to the shape: names, datum, source, lengths, measured values.

A ``[[configuration]]`` of a body.toml: what is printed of a body, with its mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body, Configuration, Measured, mass_from_primes
from coeflab.bodies.shape import Shape
from coeflab.core.axes import read_datum
from coeflab.core.errors import InputError, shown
from coeflab.core.provenance import InputFile, read_source, sha256_of
from coeflab.core.text.toml import Section, read_toml
from coeflab.core.types import brief
from coeflab.core.units import quantity
from coeflab.law.rigid_body import MassProperties, about_another, inertia_doubt
from coeflab.law.scaling import Scaling, read_scaling
from coeflab.law.symbols import symbol_at


def _inertia_matrix(section: Section) -> NDArray[np.float64] | None:
    """(3, 3) about the centre of gravity, kg m^2, if given."""
    if not section.has("inertia_matrix"):
        return None
    rows = section.raw("inertia_matrix")
    if not isinstance(rows, list) or [isinstance(r, list) and len(r) for r in rows] != [3, 3, 3]:
        raise section.fail("inertia_matrix", shown(rows), "three rows of three moments of inertia")
    key = section.key("inertia_matrix")
    return np.array([[quantity(v, "inertia", file=section.file, key=key) for v in row] for row in rows])


def _full_mass(section: Section, mass: float, reference: NDArray[np.float64]) -> MassProperties:
    """Mass properties from the place of the centre of gravity and the inertia about it."""
    for other in ("centre_of_gravity_forward", "inertia"):
        if section.has(other):
            raise section.fail(other, "both", f"centre_of_gravity and inertia_matrix, or {other}")
    centre = section.point("centre_of_gravity") - reference
    own = _inertia_matrix(section)
    if own is None:
        return MassProperties(mass, mass * float(centre[0]), None, centre)
    doubt = inertia_doubt(mass, np.zeros(3), own)
    if doubt:
        raise section.fail("inertia_matrix", doubt, "the inertia of a body about its centre of gravity")
    about = about_another(own, mass, np.zeros(3), centre)
    transverse = float(about[1, 1]) if np.isclose(about[1, 1], about[2, 2], rtol=1e-9) else None
    return MassProperties(mass, mass * float(centre[0]), transverse, centre, about)


def _mass(section: Section, prime: Section, reference: NDArray[np.float64]) -> MassProperties | None:
    if section.has("mass_prime"):
        by = read_scaling(prime)
        inertia = section.optional_positive("inertia_prime", "none")
        return mass_from_primes(
            section.positive("mass_prime", "none"),
            section.quantity("mass_moment_prime", "none"),
            inertia,
            by,
            prime.positive("density", "density"),
        )
    if not section.has("mass"):
        return None
    mass = section.positive("mass", "mass")
    if section.has("centre_of_gravity"):
        return _full_mass(section, mass, reference)
    forward = section.optional_quantity("centre_of_gravity_forward", "length") or 0.0
    return MassProperties(mass, mass * forward, section.optional_positive("inertia", "inertia"))


def read_configuration(section: Section, prime: Section, reference: NDArray[np.float64]) -> Configuration:
    """One configuration: volume, surface, centre of buoyancy and mass, each as far as it is given.

    Parameters
    ----------
    section : Section
    prime : Section
        What primed mass properties are divided by; empty where there are none.
    reference : (3,) array
        The body's reference point, m, FRD, from its datum.

    Raises
    ------
    InputError
        Anything missing, unknown or of the wrong unit, by file and key.
    """
    out = Configuration(
        name=section.text("name"),
        title=section.text("title", ""),
        volume=section.optional_positive("volume", "volume"),
        wetted_surface=section.optional_positive("wetted_surface", "area"),
        centre_of_buoyancy=section.point("centre_of_buoyancy") if section.has("centre_of_buoyancy") else None,
        mass=_mass(section, prime, reference),
    )
    section.finish()
    return out


@brief
@dataclass(frozen=True, slots=True)
class BodyFile:
    """An open body.toml; ``root`` holds the sections of the shape, which its reader takes from there."""

    path: Path
    root: Section
    head: Section

    def body(self, shape: Shape, computed: Configuration) -> Body:
        """Finish reading; printed configurations follow the one that was computed from the shape."""
        root, head = self.root, self.head
        source, lengths = root.section("source"), root.section("particulars", required=False)
        prime, reference = root.section("prime", required=False), head.point("reference_point")
        printed = tuple(read_configuration(s, prime, reference) for s in root.sections("configuration"))
        out = Body(
            name=head.text("name"),
            title=head.text("title", ""),
            datum=read_datum(head),
            reference_point=reference,
            lengths={k: lengths.positive(k, "length") for k in lengths.content},
            configurations=(computed, *printed),
            source=read_source(source),
            files=(InputFile(f"{head.text('name')}/{self.path.name}", sha256_of(self.path)),),
            shape=shape,
            scaling=_scaling(prime),
            measured=tuple(m for s in root.sections("measured") for m in _measured(s)),
        )
        for section in (head, source, prime, root):
            section.finish()
        if out.measured and out.scaling is None:
            raise root.fail("measured", "primed values without a length", "[prime] with length and length_name")
        return out


def open_body_file(path: Path, reader: str) -> BodyFile:
    """Open a body.toml for a reader.

    Raises
    ------
    InputError
        Unreadable, or made for another reader.
    """
    root = read_toml(path)
    head = root.section("body")
    found = head.text("reader")
    if found != reader:
        raise InputError(f'"{found}"', f'"{reader}"', file=path, column="body.reader")
    return BodyFile(path, root, head)


def _scaling(prime: Section) -> Scaling | None:
    return read_scaling(prime) if prime.content else None


def _measured(section: Section) -> list[Measured]:
    citation, place, values = section.text("citation"), section.text("place", ""), section.section("values")
    section.finish()
    out = []
    for symbol in values.content:
        name, printed = symbol_at(values, symbol, symbol), values.text(symbol)
        if not name.endswith("dot"):
            raise values.fail(symbol, f'"{symbol}"', "an acceleration derivative such as Yvdot")
        try:
            out.append(Measured(name, printed, citation, place))
        except InputError as why:
            raise values.fail(symbol, why.found, why.expected) from None
    return out
