from __future__ import annotations

import os
from urllib.parse import quote

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from coeflab.report.gallery.listing import SERVED, key_of, place_of

pieces = st.sampled_from(
    ["..", ".", "", "a.parameters.json", "boat", "report.html", "up", "link.json", "outside.json", ".git", ".hidden.json",
     "shown", "%2e%2e", "\\", "..\\", "C:", "\0", "loop.json", "notes.txt", "etc", "passwd", "~"]
)  # fmt: skip


@pytest.mark.parametrize("name", ["a.parameters.json", "boat/report.html", "boat/report.pdf", "alias.parameters.json"])
def test_what_lies_in_the_folder_is_found(folder, name):
    assert place_of(folder, key_of(name)) == (folder / name).resolve()


@pytest.mark.parametrize(
    "key",
    ["../outside.json", "%2e%2e/outside.json", "..%2foutside.json", "%2E%2E%2Foutside.json", "boat/../../outside.json",
     "up/outside.json", "link.json", "loop.json", "disguise.json", "notes.txt", ".hidden.json", ".git/report.html",
     "/etc/passwd.json", "//outside.json", "boat", "", "a.parameters.json%00", "a.parameters.json%00.json", "up",
     "a.parameters.json/", "./a.parameters.json", "%252e%252e/outside.json", "x" * 5000 + ".json", "boat/report.html/x.json"],
)  # fmt: skip
def test_nothing_else_is(folder, key):
    assert place_of(folder, key) is None


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=300, deadline=None)
@given(st.lists(pieces, max_size=6), st.integers(0, 2))
def test_no_path_leads_out_or_to_what_is_hidden(folder, parts, times):
    key = "/".join(parts)
    for _ in range(times):
        key = quote(key, safe="")
    found = place_of(folder, key)
    if found is not None:
        inside = found.relative_to(folder)
        assert found.suffix in SERVED
        assert not any(p.startswith(".") for p in inside.parts)
        assert b"secret" not in found.read_bytes()


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.binary(min_size=1, max_size=40).filter(lambda b: b"/" not in b and b"\0" not in b and not b.startswith(b".")))
def test_every_name_that_a_disk_takes_has_a_key(tmp_path, name):
    path = os.fsencode(tmp_path) + b"/" + name + b".json"
    with open(path, "wb") as stream:  # noqa: PTH123
        stream.write(b"{}")
    assert place_of(tmp_path, key_of(os.fsdecode(name + b".json"))) == tmp_path / os.fsdecode(name + b".json")
