"""What commands take: their parameters by ``options.toml`` beside them, which has flags and words; defaults stand in the code."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.resources import files
from inspect import Parameter, signature
from typing import Any, TypeVar

import typer
from typer.models import ParameterInfo

from coeflab.cli import complete, show
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import own_toml

Run = TypeVar("Run", bound=Callable[..., None])


@cache
def _words(folder: str) -> dict[str, Any]:
    """What stands in the file of a folder of commands."""
    return own_toml(own_text(files(folder) / "options.toml"))


def worded(run: Run) -> Run:
    """Let a command take what ``options.toml`` says of its parameters, under the name of its file, and of its function where that has several.

    Parameters
    ----------
    run : callable
        All parameters by keyword. One without a default is required, a list is empty unless its words say ``required``.
    """
    folder, _, name = run.__module__.rpartition(".")
    mine = _words(folder).get(name.rstrip("_"), {})
    mine = mine if run.__name__ == "command" else mine.get(run.__name__, {})
    shared = _words("coeflab.cli")["shared"]

    def taken(p: Parameter) -> Parameter:
        if isinstance(p.default, ParameterInfo) or "Context" in str(p.annotation):
            return p
        own = mine.get(p.name, shared.get(p.name))
        own = dict(shared[own["like"]] if "like" in own else own)
        default = ... if p.default is Parameter.empty else p.default
        if str(p.annotation).startswith("list") and not own.pop("required", False):
            default = []
        if "complete" in own:
            name_of = own.pop("complete")
            own["autocompletion"] = run.__globals__.get(name_of) or getattr(complete, name_of)
        if own.pop("argument", False):
            return p.replace(default=typer.Argument(default, **own))
        flags = own.pop("flags", [f"--{p.name.strip('_').replace('_', '-')}"])
        return p.replace(default=typer.Option(default, *flags, **own))

    whole = signature(run)
    run.__signature__ = whole.replace(parameters=list(map(taken, whole.parameters.values())))  # type: ignore[attr-defined]
    return run


def wide() -> Any:
    """``--wide``, which every command has that prints tables."""
    one = typer.Typer(add_completion=False)

    @one.command()
    def _take(
        wide: bool = typer.Option(
            False, "--wide", callback=show.widen, expose_value=False, **_words("coeflab.cli")["shared"]["wide"]
        ),
    ) -> None:
        pass  # fmt: skip

    return typer.main.get_command(one).params[0]
