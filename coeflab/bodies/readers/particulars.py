"""Bodies given by their particulars: principal lengths, volume, centres and mass, as a report prints them."""

from __future__ import annotations

from pathlib import Path

from coeflab.bodies.body import Body
from coeflab.bodies.body_file import read_configuration
from coeflab.core.axes import read_datum
from coeflab.core.provenance import InputFile, read_source, sha256_of
from coeflab.core.text.toml import read_toml

summary = "principal dimensions, volume, centres and mass from a body.toml"
citations = ("sname1950",)


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
    prime, reference = root.section("prime", required=False), head.point("reference_point")
    body = Body(
        name=head.text("name"),
        title=head.text("title", ""),
        datum=read_datum(head),
        reference_point=reference,
        lengths={k: lengths.positive(k, "length") for k in lengths.content},
        configurations=tuple(read_configuration(s, prime, reference) for s in root.sections("configuration")),
        source=read_source(source),
        files=(InputFile(f"{head.text('name')}/{path.name}", sha256_of(path)),),
    )
    for section in (head, source, prime, root):
        section.finish()
    return body
