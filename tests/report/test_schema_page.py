"""The page of the parameter file: the shipped one is that of the code, and it leaves no field without its meaning."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from coeflab.report.tables.schema_page import schema_page
from coeflab.vehicle.parameter_file import schema
from coeflab.vehicle.schema_versions import VERSIONS

SHIPPED = Path(__file__).parents[2] / "docs" / "parameter_file.md"


def fields() -> Iterator[tuple[str, str, dict]]:
    content = json.loads(schema())
    for name, table in {"ParameterFile": content, **content["$defs"]}.items():
        for key, field in table["properties"].items():
            yield name, key, field


def is_number(field: dict) -> bool:
    inner = [*field.get("anyOf", ()), *field.get("prefixItems", ())]
    inner += [field["items"]] if isinstance(field.get("items"), dict) else []
    return field.get("type") == "number" or any(is_number(f) for f in inner)


def test_the_shipped_page_is_that_of_the_code() -> None:
    """Regenerate it: coeflab params schema > docs/parameter_file.md."""
    assert SHIPPED.read_bytes() == schema_page()


def test_every_field_stands_on_it_once() -> None:
    page = schema_page().decode()
    sections = page.split("\n## ")[3:]  # behind one's own numbers and the versions
    rows = [line.split(" | ")[0].strip("| `") for s in sections for line in s.splitlines() if line.startswith("| `")]
    assert sorted(rows) == sorted(key for _, key, _ in fields())
    assert len(sections) == 1 + len(json.loads(schema())["$defs"])


def test_every_field_has_a_meaning_and_every_number_a_unit() -> None:
    for name, key, field in fields():
        assert field.get("description"), f"{name}.{key}"
        assert field.get("since", "1.0") in VERSIONS, f"{name}.{key}"
        if is_number(field) and key != "half_spaces":
            assert field.get("unit"), f"{name}.{key}"


def test_what_came_later_says_so_and_so_does_all_in_it() -> None:
    lines = schema_page().decode().splitlines()
    came = {line.split(" | ")[0].strip("| `"): line.split(" | ")[3] for line in lines if line.startswith("| `")}
    assert (came["scaling"], came["response"], came["potential"], came["others"]) == ("1.0", "1.1", "1.2", "1.2")
