"""The committed gallery is what the sources make, byte for byte."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GALLERY = ROOT / "reports" / "gallery"
LARGEST = 4_000_000


def maker():
    spec = importlib.util.spec_from_file_location("gallery_make", GALLERY / "make.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


MAKER = maker()


@pytest.mark.slow
@pytest.mark.parametrize("name", MAKER.STUDIES)
def test_a_rebuild_gives_the_committed_bytes(name, request, publication, monkeypatch):
    def studied(name):  # computed once for all tests
        return request.getfixturevalue("suboff") if name == "suboff" else publication(name)

    monkeypatch.setattr(MAKER, "studied", studied)
    made = MAKER.made(name)
    assert {f"{name}/summary.{form}" for form in ("html", "pdf", "png")} <= set(made)
    stale = [path for path, content in made.items() if (GALLERY / path).read_bytes() != content]
    assert stale == [], "run `make gallery`"
    committed = {p.relative_to(GALLERY).as_posix() for p in (GALLERY / name).iterdir()}
    assert committed <= set(made)


def test_it_is_small():
    assert sum(p.stat().st_size for p in GALLERY.rglob("*") if "__pycache__" not in p.parts) < LARGEST


def test_the_page_of_the_gallery_shows_every_study():
    shown = re.findall(r"reports/gallery/([\w./]+)", (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8"))
    assert {f"{name}/summary.png" for name in MAKER.STUDIES} <= set(shown)
    assert all((GALLERY / path).is_file() for path in shown)
