"""Arrays that stay as they are: copied, read-only.

Nouns that show themselves in a line.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import partial, wraps
from hashlib import sha256
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray


def locked(values: ArrayLike, dtype: type = float) -> NDArray[Any]:
    """A read-only copy."""
    array: NDArray[Any] = np.array(values, dtype=dtype)
    array.flags.writeable = False
    return array


def locked_columns(columns: Mapping[str, ArrayLike], dtype: type = float) -> Mapping[str, NDArray[Any]]:
    """A read-only mapping of read-only copies."""
    return MappingProxyType({name: locked(values, dtype) for name, values in columns.items()})


Given = ParamSpec("Given")
Returned = TypeVar("Returned")


def remembered(many: int) -> Callable[[Callable[Given, Returned]], Callable[Given, Returned]]:
    """Keep the last results of a pure function of arrays, plain values and frozen dataclasses of such, by their content.

    Parameters
    ----------
    many : int
        How many results are kept.
    """

    def decorated(function: Callable[Given, Returned]) -> Callable[Given, Returned]:
        known: dict[Any, Returned] = {}

        @wraps(function)
        def called(*args: Given.args, **more: Given.kwargs) -> Returned:
            key = _content((*args, *more.values(), *more))
            if key not in known:
                while len(known) >= many:
                    del known[next(iter(known))]
                known[key] = function(*args, **more)
            return known[key]

        return called

    return decorated


def _content(value: Any) -> Any:
    """What tells a value from another one: arrays by a hash of their bytes, dataclasses by their fields, the rest by itself."""
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, sha256(value.tobytes()).digest()
    if isinstance(value, tuple):
        return tuple(map(_content, value))
    if isinstance(value, partial):
        return value.func, _content((*value.args, *value.keywords.values(), *value.keywords))
    if is_dataclass(value) and not isinstance(value, type):
        return type(value), *(_content(getattr(value, f.name)) for f in fields(value))
    return value


Noun = TypeVar("Noun")
LONGEST_LINE, LONGEST_TEXT, LONGEST_BRIEF, FEW = 380, 60, 160, 8


def locking(names: str) -> Callable[[type[Noun]], type[Noun]]:
    """Make arrays of a frozen dataclass read-only copies before anything else is seen to; right above its ``class``.

    Parameters
    ----------
    names : str
        Fields, blanks between: arrays, mappings of arrays, or None.
    """

    def decorated(cls: type[Noun]) -> type[Noun]:
        rest = vars(cls).get("__post_init__")

        def lock(self: Any) -> None:
            for name in names.split():
                value = getattr(self, name)
                if value is not None:
                    frozen = locked_columns(value) if isinstance(value, Mapping) else locked(value)
                    object.__setattr__(self, name, frozen)
            if rest is not None:
                rest(self)

        cls.__post_init__ = lock  # type: ignore[attr-defined]
        return cls

    return decorated


def brief(cls: type[Noun]) -> type[Noun]:
    """Give a dataclass or a pydantic model a ``repr`` of one line that never grows with what it holds.

    Texts and numbers are shown, nouns by their name, collections and arrays by their size; fields without content are
    left out, and what would not fit is counted.
    """
    cls.__repr__ = _in_a_line  # type: ignore[method-assign]
    return cls


if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass  # noqa: PLC0414
else:

    def dataclass(**look: bool) -> Callable[[type[Noun]], type[Noun]]:
        """Like the standard library's, and brief unless the class has a ``repr`` of its own."""

        def decorated(cls: type[Noun]) -> type[Noun]:
            own = "__repr__" in vars(cls)
            noun = dataclasses.dataclass(**look)(cls)
            return noun if own else brief(noun)

        return decorated


def in_angles(noun: object, text: str) -> str:
    """A ``repr`` that says what a noun holds, ``<Kind said>``, in one line and cut where it grows long."""
    line = " ".join(text.split())
    return f"<{type(noun).__name__} {line if len(line) <= LONGEST_BRIEF else f'{line[: LONGEST_BRIEF - 3]}...'}>"


def _in_a_line(noun: Any) -> str:
    shown, left = [], LONGEST_LINE
    names = getattr(type(noun), "model_fields", None) or [f.name for f in fields(noun) if f.repr]
    selected = [name for name in names if not _is_empty(getattr(noun, name))]
    for i, name in enumerate(selected):
        text = f"{name}={_in_short(getattr(noun, name))}"
        if len(text) > left:
            shown.append(f"and {len(selected) - i} more")
            break
        shown.append(text)
        left -= len(text) + 2
    return f"{type(noun).__name__}({', '.join(shown)})"


def _is_empty(value: Any) -> bool:
    return value is None or (isinstance(value, (str, tuple, list, Mapping, frozenset)) and not value)


def _in_short(value: Any) -> str:
    if isinstance(value, Enum):
        return str(value.name)
    if isinstance(value, (str, Path)):
        text = repr(str(value))
        return text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - 4]}...{text[-1]}"
    if isinstance(value, np.ndarray):
        return f"<array {' x '.join(map(str, value.shape))}>" if value.size else "<empty array>"
    if isinstance(value, (bool, int, float)):
        return f"{value!r:.24}"
    if isinstance(value, Mapping):
        names = ", ".join(map(str, value))
        return f"{{{names}}}" if len(names) <= LONGEST_TEXT else f"<{len(value)} entries>"
    if isinstance(value, (tuple, list, frozenset)):
        return _counted(value)
    name = getattr(value, "name", None)
    return f"<{type(value).__name__}{f' {_in_short(name)}' if isinstance(name, str) else ''}>"


def _counted(values: Collection[Any]) -> str:
    if all(isinstance(v, (str, bool, int, float)) for v in values) and len(values) <= FEW:
        shown = f"({', '.join(map(_in_short, values))})"
        if len(shown) <= 2 * LONGEST_TEXT:
            return shown
    kinds = list(dict.fromkeys(type(v).__name__ for v in values))
    return f"<{len(values)} {kinds[0] if len(kinds) == 1 else 'items'}>"


Array = NDArray[np.float64]


Faces = NDArray[np.int64]
