"""Nouns together: a tuple and a mapping that show themselves in a line and as a card, and are asked by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, SupportsIndex, TypeVar, overload

from coeflab.core.cards import html_by
from coeflab.core.errors import shown
from coeflab.core.types import in_angles

Item_co = TypeVar("Item_co", covariant=True)
Value_co = TypeVar("Value_co", covariant=True)
LABELS = ("symbol", "name", "campaign", "table", "fit", "subject", "body")  # what a noun goes by, the first first
MOST = 12  # names that a line lists


def labels(noun: object) -> tuple[str, ...]:
    """What a noun goes by, without primes: its symbol or name first.

    Parameters
    ----------
    noun : object
        Of a pair, as a comparison is, its first noun counts.
    """
    held = getattr(noun, "coefficient", noun)
    found = [getattr(held, label, None) for label in LABELS]
    return tuple(text.removesuffix("'") for text in found if isinstance(text, str) and text)


class Several(tuple[Item_co, ...]):
    """A tuple of nouns of one kind, asked by place or by name.

    ``study.coefficients["Yv"]`` is the one of that symbol, ``study.coefficients.of("Yv")`` all of them; so are tables and
    findings by their name, fits and budgets by their campaign.
    """

    __slots__ = ()

    @overload
    def __getitem__(self, key: SupportsIndex, /) -> Item_co: ...
    @overload
    def __getitem__(self, key: slice, /) -> Several[Item_co]: ...
    @overload
    def __getitem__(self, key: str, /) -> Item_co: ...
    def __getitem__(self, key: SupportsIndex | slice | str, /) -> Any:
        if isinstance(key, str):
            return self._one(key)
        return Several(super().__getitem__(key)) if isinstance(key, slice) else super().__getitem__(key)

    def __contains__(self, key: object, /) -> bool:
        return bool(self.of(key)) if isinstance(key, str) else super().__contains__(key)

    def of(self, name: str) -> Several[Item_co]:
        """All that go by a name: a symbol with or without prime, else a campaign, a table, a fit, a subject or a body.

        Parameters
        ----------
        name : str
        """
        wanted = name.removesuffix("'")
        named = [(labels(item), item) for item in self]
        for place in range(len(LABELS)):
            found = [item for known, item in named if known[place : place + 1] == (wanted,)]
            if found:
                return Several(found)
        return Several()

    def _one(self, name: str) -> Item_co:
        found = self.of(name)
        if len(found) == 1:
            return next(iter(found))
        if found:
            raise KeyError(f"{len(found)} go by {shown(name)}: .of({shown(name)}) has them all")
        known = dict.fromkeys(known[0] for item in self if (known := labels(item)))
        raise KeyError(f"no {shown(name)} among {_listed(list(known))}")

    def __repr__(self) -> str:
        if not self:
            return "()"
        kinds = list(dict.fromkeys(type(item).__name__ for item in self))
        known = list(dict.fromkeys(label[0] if (label := labels(item)) else "" for item in self))
        names = _listed([name for name in known if name])
        return in_angles(self, f"{len(self)} {kinds[0] if len(kinds) == 1 else 'nouns'}{f': {names}' if names else ''}")

    def _repr_html_(self) -> str:
        """All of them in a table, for notebooks."""
        return html_by("several", self)


class ByName(Mapping[str, Value_co]):
    """A mapping of nouns by name that cannot be changed.

    Parameters
    ----------
    nouns : mapping of str
        Copied, in its order.
    """

    __slots__ = ("_nouns",)

    def __init__(self, nouns: Mapping[str, Value_co]) -> None:
        self._nouns = MappingProxyType(dict(nouns))

    def __getitem__(self, name: str) -> Value_co:
        try:
            return self._nouns[name]
        except KeyError:
            raise KeyError(f"no {shown(str(name))} among {_listed(list(self._nouns))}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._nouns)

    def __len__(self) -> int:
        return len(self._nouns)

    def __repr__(self) -> str:
        kinds = list(dict.fromkeys(type(noun).__name__ for noun in self._nouns.values()))
        if not kinds:
            return "{}"
        return in_angles(self, f"{len(self)} {kinds[0] if len(kinds) == 1 else 'nouns'}: {_listed(list(self._nouns))}")

    def _repr_html_(self) -> str:
        """All of them in a table, for notebooks."""
        return html_by("several", Several(self._nouns.values()))


def _listed(names: list[str]) -> str:
    """The first names, and how many more."""
    more = len(names) - MOST
    return ", ".join([*names[:MOST], *([f"{more} more"] if more > 0 else [])]) or "none"
