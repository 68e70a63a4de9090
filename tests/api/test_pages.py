"""The pages of the front door are those of its docstrings, and hold every public name once."""

from __future__ import annotations

import re
import runpy
import warnings
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
