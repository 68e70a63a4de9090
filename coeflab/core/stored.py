"""Nouns that a file stores as they are: what each field means there, its bounds, and how pydantic reads and writes them.

Nothing here imports pydantic: its models ask the annotations and the nouns themselves, so that a law stays light.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import MISSING, dataclass, fields
from functools import lru_cache
from types import UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from coeflab.core import declarations
from coeflab.core.limits import LARGEST_STORED, positive_number
from coeflab.core.types import locked
from coeflab.core.wording import Verbatim

FIRST_VERSION = "1.0"
Noun = TypeVar("Noun")


class RefusedError(ValueError):
    """Why no file may hold a noun: what stands there, and what should.

    Parameters
    ----------
    found, expected : str
    advice : str
        What to do about it.
    where : tuple
        Keys from the noun to the value at fault; empty for the noun itself.
    others : tuple of RefusedError
        What else is wrong with the same noun.
    """

    def __init__(
        self,
        found: str,
        expected: str,
        advice: str = "",
        where: tuple[str | int, ...] = (),
        others: tuple[RefusedError, ...] = (),
    ) -> None:
        self.found, self.expected, self.advice, self.where, self.others = found, expected, advice, where, others
        super().__init__(f"{found}; expected {expected}{f'. {advice}' if advice else ''}")


@dataclass(frozen=True, slots=True)
class Means:
    """What a field means, to stand in its ``Annotated``; the schema and its page show it.

    Attributes
    ----------
    meaning : str
    unit : str
        Empty for what has none or states it beside it; ``1`` for primes.
    since : str
        Version of the schema that brought it; empty for that of the table which holds it.
    """

    meaning: str
    unit: str = ""
    since: str = ""

    def __get_pydantic_json_schema__(self, schema: Any, handler: Callable[[Any], Any]) -> Any:
        out = {**handler(schema), "description": self.meaning}
        return {**out, **{k: v for k, v in (("unit", self.unit), ("since", self.since)) if v}}


@dataclass(frozen=True, slots=True)
class Bounds:
    """A finite number within what a file stores; ``of`` are bounds that pydantic knows, such as ``gt``."""

    of: tuple[tuple[str, float], ...] = ()

    def __get_pydantic_core_schema__(self, source: Any, handler: Callable[[Any], Any]) -> Any:
        check = _dividing if ("gt", 0.0) in self.of else _storable
        return _after({**handler(source), "allow_inf_nan": False, **dict(self.of)}, check)


def _storable(value: float) -> float:
    if abs(value) > LARGEST_STORED:
        raise _refusal("Input should be a number from {low} to {high}",
                       low=f"{-LARGEST_STORED:g}", high=f"{LARGEST_STORED:g}")  # fmt: skip
    return value


def _dividing(value: float) -> float:
    if expected := positive_number(value):
        raise _refusal("Input should be {expected}", expected=expected)
    return value


def _refusal(text: str, **context: str) -> Exception:
    from pydantic_core import PydanticCustomError

    return PydanticCustomError("bounds", text, context)


def _after(schema: Any, function: Callable[[Any], Any]) -> dict[str, Any]:
    return {"type": "function-after", "function": {"type": "no-info", "function": function}, "schema": schema}


def _through(
    schema: Any, into: Callable[[Any], Any], construct: Callable[[Any], Any], back: Callable[[Any], Any], **more: Any
) -> dict[str, Any]:
    """A schema of plain content, between a noun that is taken apart and one that is made."""
    inner = {"type": "function-before", "function": {"type": "no-info", "function": into}, "schema": schema}
    wrap = {"type": "function-wrap", "function": lambda value, handler: handler(back(value)), "schema": schema}
    return {**_after(inner, construct), "serialization": wrap, **more}


Finite = Annotated[float, Bounds()]
Positive = Annotated[float, Bounds((("gt", 0.0),))]
NotNegative = Annotated[float, Bounds((("ge", 0.0),))]


@dataclass(frozen=True, slots=True)
class Within:
    """A text of 1 to 200 letters, or within other bounds that pydantic knows; somebody's own words stay as they are written."""

    of: tuple[tuple[str, Any], ...] = (("min_length", 1), ("max_length", 200))
    verbatim: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: Callable[[Any], Any]) -> Any:
        schema = {**handler(source), **dict(self.of)}
        return _after(schema, Verbatim) if self.verbatim else schema


Count = Annotated[int, Within((("ge", 0),))]
Name = Annotated[str, Within()]
Words = Annotated[str, Within(verbatim=True)]


@dataclass(frozen=True, slots=True)
class Numbers:
    """A read-only array of finite numbers of one shape, stored as rows."""

    shape: tuple[int, ...]

    def __get_pydantic_core_schema__(self, _source: Any, handler: Any) -> Any:
        schema = handler.generate_schema(Finite)
        for n in reversed(self.shape):
            schema = {"type": "tuple", "items_schema": [schema] * n, "fail_fast": True}
        return _through(schema, _rows, locked, _rows)


def _rows(value: Any) -> Any:
    """An array as numbers in tuples."""
    if not isinstance(value, np.ndarray):
        return value
    return tuple(map(_rows, value)) if value.ndim > 1 else tuple(value.tolist())


Vector = Annotated[NDArray[np.float64], Numbers((3,))]
Square3 = Annotated[NDArray[np.float64], Numbers((3, 3))]
Square6 = Annotated[NDArray[np.float64], Numbers((6, 6))]


def fail_fast(schema: Any) -> None:
    """Let every list of a core schema stop at its first wrong item."""
    if isinstance(schema, dict):
        if schema.get("type") in ("tuple", "list"):
            schema["fail_fast"] = True
        for part in schema.values():
            fail_fast(part)
    elif isinstance(schema, list):
        for part in schema:
            fail_fast(part)


def stored(names: str = "") -> Callable[[type[Noun]], type[Noun]]:
    """Make a frozen dataclass, or a named tuple, something that a field of a pydantic model can hold.

    A file holds it as an object of its fields and of no other keys; the schema has the first line of its docstring. A method
    ``refuse`` raises ValueError where a noun may be made and no file may hold it.

    Parameters
    ----------
    names : str
        Fields that a file holds, in its order, ``?`` behind those that it may leave out, ``??`` behind those that it does leave
        out where they have their default. Unless given: all fields as declared, those with a default optional.
    """

    def decorated(cls: type[Noun]) -> type[Noun]:
        cls.__stored__ = tuple(names.split())  # type: ignore[attr-defined]
        cls.__get_pydantic_core_schema__ = classmethod(_core_schema)  # type: ignore[attr-defined]
        cls.__get_pydantic_json_schema__ = classmethod(_json_schema)  # type: ignore[attr-defined]
        return cls

    return decorated


@dataclass(frozen=True, slots=True)
class StoredField:
    """A field of a noun as a file holds it."""

    name: str
    annotation: Any
    required: bool
    default: Any
    since: str
    silent: bool = False


@lru_cache
def stored_fields(cls: Hashable) -> tuple[StoredField, ...]:
    """The fields that a file holds of a noun or of a pydantic model; empty for anything else."""
    if (known := getattr(cls, "model_fields", None)) is not None:
        return tuple(
            StoredField(n, f.annotation, f.is_required(), f.get_default(call_default_factory=True), _since(f.metadata))
            for n, f in known.items()
        )
    if (names := getattr(cls, "__stored__", None)) is None:
        return ()
    hints, defaults = get_type_hints(cls, include_extras=True), _defaults(cls)
    names = names or tuple(n if v is MISSING else f"{n}?" for n, v in defaults.items())
    return tuple(
        StoredField(
            n, _in_si(hints[n]), not mark, defaults[n], _since(getattr(hints[n], "__metadata__", ())), mark == "??"
        )
        for n, mark in ((n.rstrip("?"), n[len(n.rstrip("?")) :]) for n in names)
    )


def _in_si(annotation: Any) -> Any:
    """What a file of ours holds where a field also says what people may write: SI numbers and texts as they are."""
    if get_origin(annotation) in (Union, UnionType):
        return Union[tuple(map(_in_si, get_args(annotation)))]  # noqa: UP007 - of a list that is made here
    if get_origin(annotation) is not Annotated:
        return annotation
    base, *more = get_args(annotation)
    selected = [m for m in more if not isinstance(m, (declarations.Takes, declarations.Within))]
    if len(selected) < len(more):
        number = Bounds((("gt", 0.0),) if declarations.ABOVE_ZERO in more else ())
        selected.insert(0, number if base is float else Within(verbatim=True))
    return Annotated[(_in_si(base), *selected)]


def _defaults(cls: Any) -> dict[str, Any]:
    if hasattr(cls, "_fields"):
        return {n: cls._field_defaults.get(n, MISSING) for n in cls._fields}
    return {f.name: f.default for f in fields(cls)}


def _since(metadata: Any) -> str:
    return next((m.since for m in metadata if isinstance(m, Means) and m.since), FIRST_VERSION)


def _core_schema(cls: Any, _source: Any, handler: Any) -> Any:
    known, content = stored_fields(cls), {}
    for f in known:
        schema = handler.generate_schema(f.annotation)
        fail_fast(schema)
        if not f.required:
            schema = {"type": "default", "schema": schema, "default": f.default}
        content[f.name] = {"type": "typed-dict-field", "schema": schema, "required": f.required}

    def apart(value: Any) -> Any:
        noun = cls(*value) if tuple in cls.__bases__ and isinstance(value, tuple) else value
        if not isinstance(noun, cls):
            return value
        held = {f.name: getattr(noun, f.name) for f in known}
        return {f.name: held[f.name] for f in known if not (f.silent and _is_default(held[f.name], f.default))}

    def construct(values: Any) -> Any:
        noun = cls(**values)
        if hasattr(noun, "refuse"):
            noun.refuse()
        return noun

    schema = {"type": "typed-dict", "fields": content, "extra_behavior": "forbid"}
    return _through(schema, apart, construct, apart, ref=f"{cls.__module__}.{cls.__qualname__}:{id(cls)}")


def _is_default(value: Any, default: Any) -> bool:
    """An array is never the default of a field, and does not compare to a single truth."""
    return value is default or (not isinstance(value, np.ndarray) and bool(value == default))


def _json_schema(cls: Any, schema: Any, handler: Any) -> Any:
    out = handler(schema)
    content = handler.resolve_ref_schema(out)
    content.update(title=cls.__name__, description=cls.__doc__.splitlines()[0])
    content["additionalProperties"] = False  # which pydantic before 2.11 does not say of a typed dict
    return out


@dataclass(frozen=True, slots=True)
class AsStored:
    """Stands in the ``Annotated`` of a noun that people declare too: a file of ours holds it as `stored` says.

    Attributes
    ----------
    kind : type
        Its ``__stored__`` names what the file holds.
    """

    kind: type

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return _core_schema(self.kind, source, handler)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:
        return _json_schema(self.kind, schema, handler)


@dataclass(frozen=True, slots=True)
class Choice:
    """One of some words, spelt out where the field stands; ``construct`` makes the noun's own value of it."""

    words: tuple[str, ...]
    construct: Callable[[Any], Any] = str

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        return _through({"type": "literal", "expected": list(self.words)}, str, self.construct, str)
