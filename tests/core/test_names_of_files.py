"""Names that lead out of a folder, or that no file bears, in every kind of file that names what is written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import names_in, shipped, typed, write_all
from coeflab.core.text.json import parse_json
from coeflab.core.text.toml import read_toml
from coeflab.formats.export import parameter_files_rendered
from coeflab.vehicle.parameter_file import read_parameter_file

HUUV = shipped("cfd_data") / "huuv" / "huuv.parameters.json"


@pytest.mark.parametrize("text", ['{"a": "x\\u0000"}', '{"a\\u0000": 1}', '{"a": "\\\\\\u0000"}'])
def test_a_nul_in_json_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="a NUL in a text"):
        parse_json(text)


def test_what_only_looks_like_a_nul_is_read() -> None:
    assert parse_json('{"a": "\\\\u0000"}') == {"a": "\\u0000"}


def test_a_nul_in_toml_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text('a = 1\nb = "x\\u0000"\n')
    with pytest.raises(InputError, match="line 2: found a NUL"):
        read_toml(tmp_path / "a.toml")


@pytest.mark.parametrize("name", ["../evil", "/tmp/evil", "a/b", "a\\b", "a\nb", "n" * 190, "..", "con", "\x1b[31m"])
def test_a_parameter_file_is_written_into_its_folder_whatever_its_name(tmp_path: Path, name: str) -> None:
    content = json.loads(HUUV.read_text())
    content["name"] = name
    (tmp_path / "in.json").write_text(json.dumps(content))
    files = parameter_files_rendered([read_parameter_file(tmp_path / "in.json")])
    assert all(Path(f).name == f and "\\" not in f and f.isprintable() and len(f) < 120 for f in files)
    out = tmp_path / "below" / "out"
    write_all(out, files)
    assert {p.name for p in tmp_path.iterdir()} == {"in.json", "below"}
    assert names_in(out) == sorted(files)


def test_a_link_that_leads_to_itself_is_no_path(tmp_path: Path) -> None:
    (tmp_path / "l").symlink_to("l")
    for name in (tmp_path / "l", tmp_path / "l" / "x"):
        with pytest.raises(InputError, match="no usable path"):
            typed(name)
