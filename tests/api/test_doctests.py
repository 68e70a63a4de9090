"""The examples of the front door run."""

from __future__ import annotations

import doctest
import importlib
import inspect
from types import ModuleType

import matplotlib as mpl
import pytest

import coeflab as cf
from tests.api.names import HELD, VERBS, homes

mpl.use("agg")


@pytest.mark.slow
@pytest.mark.parametrize("module", [*homes(), "coeflab"])
def test_examples_run(module: str) -> None:
    import matplotlib.pyplot as plt

    loaded: ModuleType = importlib.import_module(module)
    found = doctest.testmod(loaded, optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    plt.close("all")
    assert found.failed == 0
    assert found.attempted > 0


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_says_what_it_takes_gives_and_refuses(name: str) -> None:
    text = inspect.getdoc(getattr(cf, name)) or ""
    assert all(f"\n{part}\n{'-' * len(part)}\n" in text for part in ("Parameters", "Returns", "Raises", "Examples"))


@pytest.mark.parametrize("name", HELD)
def test_every_noun_has_an_example(name: str) -> None:
    assert ">>>" in (inspect.getdoc(getattr(cf, name)) or "")


def test_dir_is_what_is_there() -> None:
    assert [n for n in dir(cf) if not hasattr(cf, n)] == []
