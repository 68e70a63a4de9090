"""Reports in a real browser: what every test here opens."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.report.content import document
from coeflab.report.document import Document, Section
from coeflab.report.formats import REPORTERS
from coeflab.report.sections.body import drawn_body
from coeflab.study.run import run
from coeflab.study.study import Plan
from coeflab.tables.importers import PlannedTable
from tests.report.studies import ENDLESS, FULL, HOSTILE, small_study

NAMES = {"plain": "tow", "hostile": HOSTILE, "endless": ENDLESS}


def _bodies() -> Document:
    """A page with a submarine and a vehicle with an arm."""
    study = SimpleNamespace(parameter_files={}, fits=())
    shown = [
        drawn_body(study, read_body(shipped("geometry") / name / "body.toml"), (), name.replace("_", "-"))
        for name in ("suboff_aff8", "urv_puma")
    ]
    return Document("Bodies", "Two of them", (Section("bodies", "Bodies", figures=tuple(shown)),))


def _study(kind: str):
    if kind == "models":
        planned = [("huuv_synthetic", "surface"), ("thauv_case_01_synthetic", "glide_polar"),
                   ("suboff_cfd_barehull", "manoeuvring_model")]  # fmt: skip
        tables = tuple(PlannedTable(shipped("cfd_data") / c, (f,), {}) for c, f in planned)
        return run(Plan(name="models", title="Fitted models", tables=tables))
    return small_study(FULL, named=NAMES[kind], published=True)


@pytest.fixture(
    scope="module", params=["plain", "hostile", "endless", "models", pytest.param("suboff", marks=pytest.mark.slow)]
)
def address(request, written):
    return written(request.param)


@pytest.fixture(scope="session")
def written(tmp_path_factory, request):
    """Address of the report of a kind of study, written once."""
    known = {}

    def page_of(kind: str) -> bytes:
        if kind == "suboff":
            return request.getfixturevalue("suboff_page")
        if kind == "bodies":
            return REPORTERS.load("html").render(_bodies())["report.html"]
        return REPORTERS.load("html").render(document(_study(kind)))["report.html"]

    def address_of(kind: str) -> str:
        if kind not in known:
            path = tmp_path_factory.mktemp("report") / "report.html"
            path.write_bytes(page_of(kind))
            known[kind] = path.as_uri()
        return known[kind]

    return address_of


@pytest.fixture
def opened(visit, address):
    return lambda width, scheme="light": visit(address, width, scheme)
