"""The pages of the front door are those of its docstrings, and hold every public name once."""

from __future__ import annotations

import inspect
import pickle
import re
import runpy
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pytest

import coeflab as cf
from coeflab.core.version import VERSION
from tests.cli.forked import Forks

mpl.use("agg")
ROOT = Path(__file__).parents[2]
PAGES: dict[str, Any] = runpy.run_path(str(ROOT / "docs" / "api.py"))


def test_pages_are_those_of_the_docstrings() -> None:
    for name, text in PAGES["pages"]().items():
        assert (ROOT / "docs" / name).read_text(encoding="utf-8") == text, "python docs/api.py"


def test_every_public_name_has_one_page() -> None:
    named = [n for _, _, names in PAGES["PAGES"].values() for n in names]
    assert sorted(named) == sorted(n for n in cf.__all__ if n != "__version__")


def test_the_tour_imports_coeflab_and_nothing_below_it() -> None:
    text = (ROOT / "docs" / "tour.ipynb").read_text(encoding="utf-8")
    assert re.findall(r"(?:import|from) (coeflab[\w.]*)", text) == ["coeflab"]


def test_the_version_is_that_of_the_changelog() -> None:
    assert cf.__version__ == VERSION
    first = re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert first[1] == VERSION


def test_an_old_name_works_and_says_the_new_one() -> None:
    with pytest.warns(DeprecationWarning, match=r"read_vehicle.*0\.4"):
        old = cf.read_parameter_file
    assert old(Path("remus100")) == cf.read_vehicle("remus100").file
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "read_parameter_file" not in dir(cf)


ACTS = {
    "frame", "summary", "plot", "figure_table", "other_table", "to_json", "keys", "values", "items", "copy",
    "at_one_density", "on_one_grid", "without_studies", "with_uncertain_cells", "refuse", "check", "require_shape", "spoken",
}  # fmt: skip


@pytest.mark.parametrize(
    "name",
    [
        n
        for n in cf.__all__
        if inspect.isclass(getattr(cf, n)) and not issubclass(getattr(cf, n), Exception | cf.ParameterFile)
    ],
)
def test_what_a_noun_holds_is_an_attribute(name: str) -> None:
    noun = getattr(cf, name)
    methods = [(n, m) for n in dir(noun) if n[0] != "_" and inspect.isfunction(m := inspect.getattr_static(noun, n))]
    assert {n for n, m in methods if len(inspect.signature(m).parameters) == 1} - ACTS == set()


@pytest.mark.parametrize(
    ("noun", "name"),
    [
        (lambda: cf.fit("suboff_roddy_2"), "checks"),
        (lambda: cf.read_vehicle("remus100"), "checks"),
        (lambda: cf.read_body("remus100").added_mass("ellipsoid"), "derivatives"),
        (lambda: cf.next_tests("suboff_bare_hull", "Yr'", runs=5), "matrix"),
    ],
)
def test_what_was_a_method_may_be_called_until_0_4(noun: Callable[[], Any], name: str) -> None:
    found = getattr(noun(), name)
    assert len(found) > 0
    with pytest.warns(DeprecationWarning, match=rf"{name} is an attribute.*0\.4") as warned:
        assert found() == found
    assert warned[0].filename == __file__
    assert pickle.loads(pickle.dumps(found)) == found


@pytest.mark.slow
def test_the_lines_of_the_readme_run(tmp_path: Path, forks: Forks, monkeypatch: pytest.MonkeyPatch) -> None:
    import matplotlib.pyplot as plt

    block = re.search(
        r"```python\n(import coeflab as cf\n.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL
    )
    assert forks.run(["new", "my_study"], tmp_path).returncode == 0
    monkeypatch.chdir(tmp_path)
    exec(compile(block[1], "README.md", "exec"), {})
    assert (tmp_path / "auv.parameters.json").is_file()
    plt.close("all")
