"""The parameter file field by field, as a page in Markdown; the JSON Schema is its only source."""

from __future__ import annotations

import json
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

from coeflab.core.stored import FIRST_VERSION
from coeflab.core.text.bounded import own_text
from coeflab.core.text.json import parse_json
from coeflab.vehicle.parameter_file import ParameterFile, schema
from coeflab.vehicle.schema_versions import SCHEMA_VERSION, VERSIONS, is_later

Json = dict[str, Any]
COLUMNS = "| Key | Type | Unit | Since | If absent | Meaning |\n| --- | --- | --- | --- | --- | --- |\n"


def schema_page() -> bytes:
    """The page, the same bytes for the same schema."""
    content = parse_json(schema().decode())
    head = own_text(files("coeflab.report.tables") / "parameter_file.md").replace("@VERSION@", SCHEMA_VERSION)
    out = [head, *(f"| {version} | {_cell(what)} |\n" for version, what in VERSIONS.items())]
    for place, name, table, since in _tables(content):
        out += [f"\n## {place}\n\n", f"{_plain(table.get('description', name))}\n\n", COLUMNS]
        required = table.get("required", ())
        for key, field in table["properties"].items():
            absent = "refused" if key in required else f"`{json.dumps(field['default'])}`"
            came = _later(field.get("since", since), since)
            cells: tuple[str, ...] = (
                f"`{key}`",
                _type(field),
                field.get("unit", ""),
                came,
                absent,
                _plain(field["description"]),
            )
            out.append(f"| {' | '.join(map(_cell, cells))} |\n")
    return "".join(out).encode()


def _tables(content: Json) -> Iterator[tuple[str, str, Json, str]]:
    """Every table of the schema: where it stands, its name, itself, and the version that brought it; the file first."""
    waiting = [("The file", ParameterFile.__name__, content, FIRST_VERSION)]
    seen = set()
    while waiting:
        place, name, table, since = waiting.pop(0)
        yield place, name, table, since
        inner = []
        for key, field in table["properties"].items():
            for kind, many in _named(field):
                if kind not in seen:
                    seen.add(kind)
                    path = (
                        f"{'' if name == ParameterFile.__name__ else place.strip('`') + '.'}{key}{'[]' if many else ''}"
                    )
                    inner.append((f"`{path}`", kind, content["$defs"][kind], _later(field.get("since", since), since)))
        waiting = inner + waiting


def _later(one: str, other: str) -> str:
    return one if is_later(one, other) else other


def _named(field: Json, many: bool = False) -> Iterator[tuple[str, bool]]:
    """Tables that a field holds, and whether it holds a list of them."""
    if "$ref" in field:
        yield field["$ref"].rpartition("/")[2], many
    for choice in field.get("anyOf", ()):
        yield from _named(choice, many)
    if isinstance(field.get("items"), dict):
        yield from _named(field["items"], True)


def _type(field: Json) -> str:
    if "$ref" in field:
        return "object"
    if "anyOf" in field:
        return " or ".join(_type(choice) for choice in field["anyOf"])
    if "const" in field or "enum" in field:
        return ", ".join(f"`{value}`" for value in field.get("enum", [field.get("const")]))
    if field["type"] == "array":
        if "prefixItems" in field:
            first = _type(field["prefixItems"][0])
            return f"{len(field['prefixItems'])} {'numbers' if first == 'number' else f'x {first}'}"
        each = _type(field["items"])
        return f"list of ({each})" if " or " in each else f"list of {each}"
    bounds = {"exclusiveMinimum": ">", "minimum": ">=", "maximum": "<="}
    limits = [f"{sign} {field[name]:g}" for name, sign in bounds.items() if name in field]
    limits += [f"of at most {field['maxLength']} characters"] if "maxLength" in field else []
    limits += [f"like `{field['pattern']}`"] if "pattern" in field else []
    kind = str(field["type"])
    words = {"string": "text", "boolean": "true or false", "integer": "whole number"}
    return " ".join([words.get(kind, kind), *limits])


def _plain(text: str) -> str:
    """One line, however the docstring is broken."""
    return " ".join(text.split()).rstrip(".")


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
