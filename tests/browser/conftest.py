"""Reports in a real browser: what every test here opens."""

from __future__ import annotations

import os
import shutil

import pytest

from coeflab.core.files import shipped
from coeflab.report.content import document
from coeflab.report.formats import REPORTERS
from coeflab.study.study import Plan
from coeflab.tables.importers import PlannedTable
from coeflab.workbench import run
from tests.report.studies import ENDLESS, FULL, HOSTILE, small_study

FLAGS = [
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-sync",
    "--disable-component-update", "--no-first-run", "--disable-dev-shm-usage",
]  # fmt: skip
NAMES = {"plain": "tow", "hostile": HOSTILE, "endless": ENDLESS}


def _missing(why: str) -> None:
    if os.environ.get("COEFLAB_FORBID_SKIPS"):
        pytest.fail(why)
    pytest.skip(why)


@pytest.fixture(scope="session")
def browser():
    path = shutil.which("chromium")
    if path is None:
        _missing("chromium is not installed")
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        _missing("playwright is not installed")
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=path, args=FLAGS)
        yield opened
        opened.close()


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
        return REPORTERS.load("html").render(document(_study(kind)))["report.html"]

    def address_of(kind: str) -> str:
        if kind not in known:
            path = tmp_path_factory.mktemp("report") / "report.html"
            path.write_bytes(page_of(kind))
            known[kind] = path.as_uri()
        return known[kind]

    return address_of


@pytest.fixture
def visit(browser):
    """Opens an address; the page remembers what it said and fetched."""
    pages = []

    def open_page(address: str, width: int = 1440, scheme: str = "light", **more):
        page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme, **more)
        page.heard, page.fetched = [], []
        page.on("console", lambda message: page.heard.append(message.text))
        page.on("pageerror", lambda error: page.heard.append(str(error)))
        page.on("request", lambda request: page.fetched.append(request.url))
        page.goto(address)
        pages.append(page)
        return page

    yield open_page
    for page in pages:
        page.close()


@pytest.fixture
def opened(visit, address):
    return lambda width, scheme="light": visit(address, width, scheme)
