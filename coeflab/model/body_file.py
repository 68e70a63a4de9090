"""What every body.toml says before it comes to the shape: names, datum, source, lengths, measured values."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from coeflab.core.datums import read_datum
from coeflab.core.errors import InputError
from coeflab.core.provenance import InputFile, read_source, sha256_of
from coeflab.core.toml import Section, read_toml
from coeflab.kernels.brief import brief
from coeflab.model.body import Body, Configuration, Measured
from coeflab.model.configuration_file import read_configuration
from coeflab.model.scaling import Scaling, read_scaling
from coeflab.model.shape import Shape


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
        name, printed = values.symbol(symbol, symbol), values.text(symbol)
        if not name.endswith("dot"):
            raise values.fail(symbol, f'"{symbol}"', "an acceleration derivative such as Yvdot")
        try:
            out.append(Measured(name, printed, citation, place))
        except InputError as why:
            raise values.fail(symbol, why.found, why.expected) from None
    return out
