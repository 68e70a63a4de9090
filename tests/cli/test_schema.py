"""Published schemas: they take every shipped file, explain every key, and are found by editors without a network."""

from __future__ import annotations

import json
import runpy
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from coeflab.api.schemas import KINDS, schema
from coeflab.core.declarations import number_in
from coeflab.core.errors import InputError
from coeflab.core.files import shipped

DATA, GEOMETRY = shipped("cfd_data"), shipped("geometry")
ROOT = Path(__file__).parents[2]
SHIPPED = {
    "plan": sorted(DATA.glob("*/plan.toml")),
    "campaign": sorted(DATA.glob("*/campaign.toml")),
    "body": sorted(GEOMETRY.glob("*/body.toml")),
    "glider": [*sorted(DATA.glob("thauv/*.toml")), *sorted(DATA.glob("slocum/*.toml"))],
    "tuning": sorted(DATA.glob("*/tune.toml")),
    "published": sorted(DATA.glob("*/published.toml")),
}
SCHEMAS: dict[str, Any] = {kind: json.loads(schema(kind)) for kind in KINDS}


def inside(content: Any) -> Iterator[dict[str, Any]]:
    if isinstance(content, dict):
        yield content
    for part in content.values() if isinstance(content, dict) else content if isinstance(content, list) else ():
        yield from inside(part)


@pytest.mark.parametrize("kind", SHIPPED)
def test_shipped_files_keep_their_schema(kind: str) -> None:
    validator = jsonschema.Draft202012Validator(SCHEMAS[kind])
    assert SHIPPED[kind]
    for path in SHIPPED[kind]:
        assert not [e.message for e in validator.iter_errors(tomllib.loads(path.read_text()))], path


@pytest.mark.parametrize(
    ("kind", "old", "new"),
    [
        ("plan", "[study]", "[stuudy]"),
        ("campaign", "density = ", "densty = "),
        ("campaign", "frame = ", "frame = 3 #"),
        ("body", "[body]", "[body]\ncolour = 1"),
        ("glider", "contains_munk = false", 'contains_munk = "no"'),
        ("glider", 'surge = "70 kg"', "surge = -70"),
        ("tuning", 'name = "huuv_pool"', ""),
        ("published", 'relation = "quoted"', 'relation = "quote"'),
        ("published", "reference_point = ", "referencepoint = "),
    ],
)
def test_a_schema_refuses_what_reading_refuses(kind: str, old: str, new: str) -> None:
    texts = [t for t in (p.read_text() for p in SHIPPED[kind]) if old in t]
    spoiled = tomllib.loads(texts[0].replace(old, new, 1))
    assert not jsonschema.Draft202012Validator(SCHEMAS[kind]).is_valid(spoiled)


@pytest.mark.parametrize(
    ("value", "fits"),
    [(0, True), (0.0, True), (0.3, False), (20, False), ("20", False), ("20 deg", True), (" .3rad", True)],
)
def test_an_angle_has_its_unit_in_schema_and_reader_alike(value: object, fits: bool) -> None:
    angle = number_in("angle")
    assert jsonschema.Draft202012Validator(dict(angle.schema)).is_valid(value) == fits
    if fits:
        angle.read(value, Path())
    else:
        with pytest.raises(InputError):
            angle.read(value, Path())


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_is_described_and_every_number_has_its_unit(kind: str) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMAS[kind])
    tables = [part for part in inside(SCHEMAS[kind]) if isinstance(part.get("properties"), dict)]
    for table in tables:
        for key, field in table["properties"].items():
            assert field.get("description") or "const" in field, f"{key} of {table.get('description')}"
    if kind != "parameters":
        assert all("unit" in part for part in inside(SCHEMAS[kind]) if part.get("type") == ["number", "string"])
    assert str(ROOT) not in json.dumps(SCHEMAS[kind])


def test_parameters_are_those_of_params_schema() -> None:
    assert schema("parameters") == (ROOT / "coeflab" / "vehicle" / "parameter_file.schema.json").read_bytes()


def test_no_such_kind() -> None:
    with pytest.raises(InputError, match='found "plans"; expected one of plan, campaign'):
        schema("plans")


def test_the_page_is_the_one_in_docs() -> None:
    page = runpy.run_path(str(ROOT / "docs" / "files.py"))["page"]
    assert (ROOT / "docs" / "files.md").read_bytes() == page(), "write it anew: python docs/files.py"


def test_new_files_name_schemas_that_stand_beside_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from coeflab.cli.new import command

    monkeypatch.chdir(tmp_path)
    command(folder=Path("s"))
    found = {}
    for path in sorted((tmp_path / "s").rglob("*.toml")):
        text = path.read_text()
        hint, _, place = text.splitlines()[0].partition(" ")
        assert hint == "#:schema"
        content = json.loads((path.parent / place).read_text())
        assert jsonschema.Draft202012Validator(content).is_valid(tomllib.loads(text))
        found[path.name] = content["title"]
    assert found == {
        "plan.toml": "coeflab plan file", "body.toml": "coeflab body file", "campaign.toml": "coeflab campaign file",
    }  # fmt: skip
