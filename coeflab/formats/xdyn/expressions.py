"""Expressions of xdyn's ``maneuvering`` model: which of them xdyn reads to their end, and their values.

xdyn's grammar (code/force_models/inc/maneuvering_grammar.hpp in github.com/sirehna/xdyn) has no sign before a name or a
bracket, and what follows such a sign is passed over without a word; these expressions are refused here.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.core.limits import ARITHMETIC_DEEPEST

_STRAY = re.compile(
    r"(?P<sign>(?:^|[-+*/^(])\s*[-+](?![\d.])"
    r"|(?:^|[-+*/(])\s*[-+][\d.]+(?:[eE][-+]?\d+)?\s*\^)"
    r"|(?P<letter>[^\sA-Za-z0-9_.+\-*/^()]|\.[*/^]|(?<![\w.])[\d.]+[dD])",
    re.ASCII,
)
_USED = re.compile(r"(?<![\w.])[A-Za-z]\w*(?!\w|\s*\()", re.ASCII)


def settled(
    expressions: Mapping[str, str],
    given: Mapping[str, Any],
    functions: Mapping[str, Callable[..., Any]],
    finish: Callable[[str, Any], Any] | None = None,
) -> dict[str, Any]:
    """Values of all expressions that X Y Z K M N need, each after those that it uses.

    Parameters
    ----------
    expressions : mapping of name to text
    given : mapping of name to value
        Constants and commands.
    functions : mapping of name to callable
        States such as ``u(t)``, and ``abs`` or ``sqrt``.
    finish : callable, optional
        Name and value -> the value to go on with.

    Raises
    ------
    ArithmeticProblem
        No arithmetic, a name without a value, a name that needs itself, or what xdyn does not read to its end.
    """
    known = dict(given)

    def settle(name: str, above: tuple[str, ...]) -> None:
        if name in known:
            return
        if name in above or len(above) > ARITHMETIC_DEEPEST:
            raise ArithmeticProblem(f"{name}, which needs itself or more than {ARITHMETIC_DEEPEST} others in a row")
        text = expressions[name]
        stray = _STRAY.search(text)
        if stray is not None:
            raise ArithmeticProblem(f"{stray[0].strip()} in {name}, where xdyn stops reading")
        for used in _USED.findall(text):
            if used in expressions:
                settle(used, (*above, name))
        value = evaluate(text, known, functions)
        known[name] = value if finish is None else finish(name, value)

    for component in ("X", "Y", "Z", "K", "M", "N"):
        settle(component, ())
    return known
