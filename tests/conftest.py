"""Campaign folders made to order, and no skipped test where CI forbids it."""

from __future__ import annotations

import copyreg
import fcntl
import gc
import io
import os
import pickle
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Generator, Iterator, Sequence
from functools import cache
from itertools import islice
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import settings

from coeflab.core.files import shipped
from coeflab.core.keywords import in_shell
from coeflab.core.types import locked
from tests.cli.forked import COEFLAB, Forks
from tests.consumers.one_node_slurm import OneNodeSlurm, one_node_slurm

if TYPE_CHECKING:  # a test of the core imports nothing above it by what stands here
    from coeflab.report.document import Document
    from coeflab.study.study import Study
    from coeflab.tables.force_table import ForceTable

# How long an example takes says how busy the machine is, not whether it is right. New seeds are tried by tests/fuzz.
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")

LONGEST = Path(__file__).with_name("longest.txt")

# Peak memory of a process itself in kB: ru_maxrss holds that of the process which it was forked from, too.
PEAK_KILOBYTES = "int(next(line for line in open('/proc/self/status') if line.startswith('VmHWM')).split()[1])"


def peak_kilobytes() -> int:
    """Of this process."""
    return int(eval(PEAK_KILOBYTES))


FLAGS = [
    "--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-sync",
    "--disable-component-update", "--no-first-run", "--disable-dev-shm-usage",
]  # fmt: skip
SECTIONS = {
    "campaign": 'title = "Synthetic"\nbody = "synthetic_body"',
    "axes": (
        'frame = "FRD"\nbeta = "v = -U sin(beta)"\nalpha = "w = +U sin(alpha)"\n'
        'datum = "nose"\nreference_point = [-2.0, 0.0, 0.0]'
    ),
    "scaling": 'length = 4.0\nlength_name = "LBP"',
    "conditions": "speed = 2.0\ndensity = 1000.0",
    "source": 'citation = "synthetic"\nkind = "synthetic"',
    "inertia": "",
}
DRIFT = "beta [deg],Y [N],N [N*m]\n-4,-20.5,-30.25\n0,0.5,0.25\n4,21.5,30.75\n"


@pytest.fixture
def write_campaign(tmp_path: Path) -> Callable[..., Path]:
    """Write campaign.toml and table.csv; keywords replace whole sections, ``table`` adds keys to [[table]]."""

    def write(csv: str | bytes = DRIFT, *, table: str = "", root: str = "", **sections: str) -> Path:
        folder = tmp_path / f"campaign_{len(list(tmp_path.iterdir()))}"
        folder.mkdir()
        merged = {**SECTIONS, **sections}
        text = root + "".join(f"[{name}]\n{content}\n\n" for name, content in merged.items() if content)
        text += f'[[table]]\nfile = "table.csv"\n{table}\n'
        (folder / "campaign.toml").write_text(text, encoding="utf-8")
        (folder / "table.csv").write_bytes(csv.encode() if isinstance(csv, str) else csv)
        return folder

    return write


@pytest.fixture
def read_table(write_campaign: Callable[..., Path]) -> Callable[..., ForceTable]:
    """Write a campaign and read its one table."""
    from coeflab.tables.importers import PlannedTable
    from coeflab.tables.reading import read_tables

    def read(csv: str | bytes = DRIFT, **pieces: Any) -> ForceTable:
        return read_tables(PlannedTable(write_campaign(csv, **pieces), ()))[0]

    return read


@pytest.fixture
def cluster(monkeypatch: pytest.MonkeyPatch) -> Iterator[OneNodeSlurm]:
    """A Slurm of one node, which sbatch and its like find."""
    folder = Path(tempfile.mkdtemp(prefix="slurm"))  # a socket's path is short
    with one_node_slurm(folder) as started:
        for name, value in started.environment.items():
            monkeypatch.setenv(name, value)
        yield started
    shutil.rmtree(folder)


gc.disable()  # while modules are imported, which make no garbage


def pytest_collection_finish() -> None:
    """What was imported is never garbage: a seventh of the processor time went into looking at it again and again."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(5_000, 20, 50)
    gc.enable()


def pytest_sessionfinish() -> None:
    """Compiled modules complain of what is not collected at the end."""
    gc.unfreeze()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Whatever opens a browser is slow."""
    for item in items:
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.slow)


Longest = Sequence[tuple[float, tuple[str, ...]]]


def longest() -> Longest:
    """Rows of the file: seconds, and how the names begin of tests that one worker runs after each other."""
    rows = (line.split() for line in LONGEST.read_text(encoding="utf-8").splitlines() if not line.startswith("#"))
    return [(float(seconds), tuple(begins)) for seconds, *begins in rows]


def dealt(names: Sequence[str], groups: Longest, workers: int) -> list[int]:
    """An order of tests in which the share of every worker begins with some of the longest.

    A worker gets the next of as many equal shares as there are workers without one; whoever is idle takes the end of another's.
    """
    first: list[list[int]] = [[] for _ in range(workers)]
    seconds = [0.0] * workers
    for long, begins in sorted(groups, key=lambda row: -row[0]):
        if found := [k for begin in begins for k, name in enumerate(names) if name.startswith(begin)]:
            least = seconds.index(min(seconds))
            first[least] += found
            seconds[least] += long
    chosen = {k for own in first for k in own}
    rest = iter([k for k in range(len(names)) if k not in chosen])
    order: list[int] = []
    for worker, own in enumerate(first):
        share = (len(names) - len(order)) // (workers - worker)
        order += own + list(islice(rest, max(0, share - len(own))))
    return order


@pytest.hookimpl(specname="pytest_collection_modifyitems", trylast=True)
def longest_first(items: list[pytest.Item]) -> None:
    """Else one of a minute and a half is begun when nothing else is left, and all workers but one wait."""
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    if workers > 1:
        items[:] = [items[k] for k in dealt([item.nodeid for item in items], longest(), workers)]


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """With COEFLAB_FORBID_SKIPS a skipped test is a failed one; an expected failure is none."""
    report = yield
    if os.environ.get("COEFLAB_FORBID_SKIPS") and report.skipped and not hasattr(report, "wasxfail"):
        report.outcome, report.longrepr = "failed", f"skipped where skips are forbidden: {report.longrepr}"
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """The same for a module that skips itself while it is collected."""
    report = yield
    if os.environ.get("COEFLAB_FORBID_SKIPS") and report.skipped:
        report.outcome, report.longrepr = "failed", f"skipped where skips are forbidden: {report.longrepr}"
    return report


@pytest.fixture(scope="session")
def forks() -> Iterator[Forks]:
    """Processes of ``coeflab`` that need not import it again."""
    forks = Forks()
    yield forks
    forks.close()


@pytest.fixture
def fresh(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run ``coeflab`` as a user does: an interpreter of its own, which imports what the command imports and no more."""

    def run(*arguments: str | Path, cwd: Path = tmp_path) -> subprocess.CompletedProcess[str]:
        command = [str(COEFLAB), *map(str, arguments)]
        return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False, timeout=120)

    return run


@pytest.fixture
def coeflab(tmp_path: Path, forks: Forks) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run ``coeflab`` in an empty folder."""

    def run(*arguments: str | Path, cwd: Path = tmp_path) -> subprocess.CompletedProcess[str]:
        return forks.run(arguments, cwd)

    return run


def _read_only(found: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(found)


def _cached(found: Any) -> Any:
    """A cached function of a module by its name, one of an object by what it caches."""
    return getattr(found, "__qualname__", None) or (cache, (found.__wrapped__,))


copyreg.pickle(MappingProxyType, lambda found: (_read_only, (dict(found),)))
copyreg.pickle(type(cache(dict)), _cached)


class _Pickler(pickle.Pickler):
    """What is read-only stays so: arrays of a study are."""

    def reducer_override(self, found: Any) -> Any:
        if type(found) is np.ndarray and not found.flags.writeable and not found.dtype.hasobject:
            return locked, (found.copy(), found.dtype)
        return NotImplemented


def _pickled(found: Any) -> bytes:
    out = io.BytesIO()
    _Pickler(out).dump(found)
    return out.getvalue()


def once(factory: pytest.TempPathFactory, name: str, make: Callable[[], Any]) -> Any:
    """What the first worker of a run makes; the others load it."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        return make()
    file = factory.getbasetemp().parent / f"{name}.pickle"
    with file.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not file.exists():
            made = make()
            file.write_bytes(_pickled(made))
            return made
    return pickle.loads(file.read_bytes())


@pytest.fixture(scope="session")
def suboff(tmp_path_factory: pytest.TempPathFactory) -> Study:
    """The SUBOFF study, run once for all workers."""
    from coeflab.study.plan import read_plan
    from coeflab.study.run import run

    plan = shipped("cfd_data") / "suboff" / "plan.toml"
    found: Study = once(tmp_path_factory, "suboff", lambda: run(read_plan(plan)))
    return found


@pytest.fixture(scope="session")
def suboff_document(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Document:
    """Its report, whole, drawn once for all workers; those that only look at it need no study."""
    from coeflab.report.content import document

    found: Document = once(tmp_path_factory, "suboff_document", lambda: document(request.getfixturevalue("suboff")))
    return found


@pytest.fixture(scope="session")
def suboff_page(suboff_document: Document) -> bytes:
    """Its report as a page."""
    from coeflab.report.formats import REPORTERS

    return REPORTERS.load("html").render(suboff_document)["report.html"]


@pytest.fixture(scope="session")
def publication(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Any]:
    """A publication as it comes out, by the name of its validation, computed once for all workers."""
    from coeflab.api.validations import validation

    return cache(lambda name: once(tmp_path_factory, f"publication_{name}", lambda: validation(name)))


def _missing(why: str) -> None:
    if os.environ.get("COEFLAB_FORBID_SKIPS"):
        pytest.fail(why)
    pytest.skip(why)


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """One browser for all tests of a process, which has room for one loop of playwright only."""
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


@pytest.fixture
def visit(browser: Any) -> Iterator[Callable[..., Any]]:
    """Opens an address; the page remembers what it said and fetched."""
    pages: list[Any] = []

    def open_page(address: str, width: int = 1440, scheme: str = "light", **more: Any) -> Any:
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
def in_a_shell() -> Iterator[None]:
    """Messages name options, as where a command runs."""
    with in_shell():
        yield
