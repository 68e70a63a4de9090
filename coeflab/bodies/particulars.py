"""Bodies given by their particulars: principal lengths, volume, centres and mass, as a report prints them."""

from __future__ import annotations

from pathlib import Path

from coeflab.core.provenance import InputFile, read_source, sha256_of
from coeflab.core.toml import Section, read_toml
from coeflab.model.body import Body, Configuration, MassProperties, mass_from_primes
from coeflab.model.scaling import read_scaling

summary = "principal dimensions, volume, centres and mass from a body.toml"
citations = ("sname1950",)


def _mass(section: Section, prime: Section) -> MassProperties | None:
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
    forward = section.optional_quantity("centre_of_gravity_forward", "length") or 0.0
    return MassProperties(mass, mass * forward, section.optional_positive("inertia", "inertia"))


def _configuration(section: Section, prime: Section) -> Configuration:
    out = Configuration(
        name=section.text("name"),
        title=section.text("title", ""),
        volume=section.optional_positive("volume", "volume"),
        wetted_surface=section.optional_positive("wetted_surface", "area"),
        centre_of_buoyancy=section.point("centre_of_buoyancy") if section.has("centre_of_buoyancy") else None,
        mass=_mass(section, prime),
    )
    section.finish()
    return out


def read(path: Path) -> Body:
    """Read a body.toml.

    Raises
    ------
    InputError
        Anything missing, unknown or of the wrong unit, by file and key.
    """
    root = read_toml(path)
    head, source, lengths = root.section("body"), root.section("source"), root.section("particulars", required=False)
    head.text("reader", "particulars")
    prime = root.section("prime", required=False)
    body = Body(
        name=head.text("name"),
        title=head.text("title", ""),
        datum=head.text("datum"),
        reference_point=head.point("reference_point"),
        lengths={k: lengths.positive(k, "length") for k in lengths.content},
        configurations=tuple(_configuration(s, prime) for s in root.sections("configuration")),
        source=read_source(source),
        files=(InputFile(f"{head.text('name')}/{path.name}", sha256_of(path)),),
    )
    for section in (head, source, prime, root):
        section.finish()
    return body
