"""Declarations: what the files that people write may say, and one message of all that is wrong with a file.

A declaration is a frozen dataclass. Its fields say what a key takes (`Length`, `Text`, ...), its docstring what the key means.
Reading, JSON Schema and the list of keys in the documentation come from it. pydantic does the work; it is imported on first use.
"""

from __future__ import annotations

import dataclasses
import difflib
import functools
import inspect
import json
import keyword
import re
import textwrap
import types
import typing
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, Union, cast

import numpy as np

from coeflab.core.errors import InputError, shown, together
from coeflab.core.files import located
from coeflab.core.limits import positive_number
from coeflab.core.text.toml import TomlFile, dotted
from coeflab.core.types import Array
from coeflab.core.units import SI, quantity, with_unit
from coeflab.core.wording import Verbatim

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core import CoreSchema, ErrorDetails


Kind = TypeVar("Kind")
Loc = tuple[str | int, ...]
Expected = Callable[[Any], str]
UNIT_BEHIND = r"\s*[^\s\d.]"
NUMBER_WITH_UNIT = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?"


class RefusedError(ValueError):
    """An `InputError` on its way through pydantic, which collects them."""

    def __init__(self, why: InputError) -> None:
        super().__init__(str(why))
        self.why = why


@dataclasses.dataclass(frozen=True, slots=True, eq=False)
class Takes:
    """What a key takes: stands in the ``Annotated`` of its field.

    Attributes
    ----------
    words : str
        What is expected, in messages.
    read : callable
        From the value as TOML gives it, and the file, to ours; raises `InputError`.
    schema : dict
        The same as JSON Schema.
    absent : str
        Advice where a required key is missing; to add it, unless given.
    """

    words: str
    read: Callable[[Any, Path], Any]
    schema: dict[str, Any]
    absent: str = ""

    def __get_pydantic_core_schema__(self, _source: Any, _handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        def read(value: Any, info: core_schema.ValidationInfo) -> Any:
            try:
                return self.read(value, cast(Any, info.context)["file"])
            except InputError as why:
                raise RefusedError(type(why)(why.found, why.expected, advice=why.advice)) from why

        return core_schema.with_info_plain_validator_function(read)

    def __get_pydantic_json_schema__(self, _core: CoreSchema, _handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return dict(self.schema)


@dataclasses.dataclass(frozen=True, slots=True, eq=False)
class Within:
    """A condition on a value that was read.

    Attributes
    ----------
    expected : callable
        What is expected of a value that does not fit, in words; empty of one that does.
    advice : str
    schema : mapping
        The same as JSON Schema, as far as that can say it.
    """

    expected: Expected
    advice: str = ""
    schema: Mapping[str, Any] = dataclasses.field(default_factory=dict)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        def fitting(value: Any) -> Any:
            if expected := self.expected(value):
                raise RefusedError(InputError("", expected, advice=self.advice))
            return value

        return core_schema.no_info_after_validator_function(fitting, handler(source))

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return handler(core) | dict(self.schema)


class OrEmpty:
    """An empty table says what an absent one says."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_before_validator_function(lambda v: None if v == {} else v, handler(source))


class Declaration:
    """Base of declarations: only known keys, and values that agree with each other."""

    __slots__ = ()
    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012 - pydantic's own name

    def check(self) -> None:
        """Called on what a file declares, once every value of it has been read.

        Raises
        ------
        InputError
            Values that do not agree; ``column`` is the key, from this table.
        """

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        def construct(value: Any, inner: core_schema.ValidatorFunctionWrapHandler) -> Any:
            value = {_attribute(k): v for k, v in value.items()} if isinstance(value, dict) else value
            try:
                out = inner(value)
                out.check()
            except InputError as why:
                raise RefusedError(why) from why
            return out

        bare: Any = dict(handler.resolve_ref_schema(handler(source)))
        name = bare.pop("ref")  # a second use of the class refers to what has the name: it has to be checked as well
        return core_schema.no_info_wrap_validator_function(construct, bare, ref=name)

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        reference = handler(core)
        content = handler.resolve_ref_schema(reference)
        words = meanings(cls)
        content["description"] = " ".join((inspect.getdoc(cls) or "").partition("\n\n")[0].replace("``", "").split())
        content["properties"] = {key_of(name): field for name, field in content["properties"].items()}
        content["required"] = [key_of(name) for name in content.get("required", ())]
        for name, field in content["properties"].items():
            for default in ("title", *(["default"] if field.get("default", "") is None else [])):
                field.pop(default, None)
            given = [kind for kind in field.get("anyOf", ()) if kind != {"type": "null"}]  # TOML has no null
            if len(given) == 1:
                field.pop("anyOf")
                field.update(given[0])
            elif given:
                field["anyOf"] = given
            field["description"] = words.get(name, "")
        return reference


def _attribute(key: str) -> str:
    """The field of a key: words of Python, such as class, have an underscore behind."""
    return f"{key}_" if keyword.iskeyword(key.rstrip("_")) else key


def key_of(attribute: str) -> str:
    """The key of a field: words of Python, such as class, without the underscore behind."""
    return attribute[:-1] if attribute.endswith("_") and keyword.iskeyword(attribute.rstrip("_")) else attribute


def meanings(kind: type) -> dict[str, str]:
    """Meaning of every attribute of a numpydoc docstring, inherited ones too; names that share an entry share its text."""
    out: dict[str, str] = {}
    for cls in reversed(kind.__mro__):
        body = inspect.cleandoc(cls.__doc__ or "").partition("Attributes\n----------\n")[2]
        for head, words in re.findall(r"^(\S[^\n]*)\n?((?:[ ]+[^\n]*\n?|\n)*)", body, re.MULTILINE):
            flat = " ".join(textwrap.dedent(words).split()).replace("``", "")
            out |= dict.fromkeys((n.strip() for n in head.partition(" : ")[0].split(",")), flat)
    return out


def taken(kind: type) -> dict[str, Takes]:
    """What every key of a declaration takes, given that it is there."""
    hints = {f.name: _hints(cast(Any, kind))[f.name] for f in dataclasses.fields(cast(Any, kind))}
    optional = {n: next((a for a in typing.get_args(h) if hasattr(a, "__metadata__")), h) for n, h in hints.items()}
    return {n: _takes(h if hasattr(h, "__metadata__") else optional[n]) for n, h in hints.items()}


def number_in(dimension: str) -> Takes:
    """A number in SI or a text with its unit; ``dimension`` is a key of `coeflab.core.units.SI`. A bare angle is 0."""
    pattern = NUMBER_WITH_UNIT if dimension == "none" else NUMBER_WITH_UNIT + UNIT_BEHIND
    schema: dict[str, Any] = {"type": ["number", "string"], "pattern": pattern, "unit": SI[dimension] or "1"}
    if dimension == "angle":
        schema |= {"minimum": 0, "maximum": 0}
    words = "a number" if dimension == "none" else f"an {dimension}" if dimension[0] in "aei" else f"a {dimension}"
    if dimension == "density":  # JSON is written by programs, in SI, and may be of air
        return Takes(words, lambda v, file: (quantity if file.suffix == ".json" else with_unit)(v, dimension), schema)
    return Takes(words, lambda v, _: with_unit(v, dimension), schema)


def _blank(value: Any, _file: Path) -> str:
    if not isinstance(value, str):
        raise InputError(shown(value), "a text")
    return Verbatim(value)


def text_of(value: Any, file: Path) -> str:
    """A text that is not blank."""
    if not _blank(value, file).strip():
        raise InputError(shown(value), "a text")
    return Verbatim(value)


def _flag(value: Any, _file: Path) -> bool:
    if not isinstance(value, bool):
        raise InputError(shown(value), "true or false")
    return value


def _texts(value: Any, _file: Path) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
        raise InputError(shown(value), "a list of texts")
    return tuple(map(Verbatim, value))


def _table(value: Any, _file: Path) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise InputError(shown(value), "a table")
    return value


def numbers(count: int, dimension: str, words: str) -> Takes:
    """A list of so many numbers in SI or texts with units.

    Parameters
    ----------
    count : int
    dimension : str
        Key of `coeflab.core.units.SI`.
    words : str
        What they are, for messages.
    """

    def read(value: Any, _file: Path) -> tuple[float, ...]:
        if not isinstance(value, list) or len(value) != count:
            raise InputError(shown(value), words)
        return tuple(with_unit(v, dimension) for v in value)

    one = dict(number_in(dimension).schema)
    return Takes(words, read, {"type": "array", "items": one, "minItems": count, "maxItems": count})


def one_of(*words: str) -> Takes:
    """One of some words."""

    def read(value: Any, _file: Path) -> str:
        if not isinstance(value, str):
            raise InputError(shown(value), "a text")
        if value not in words:
            raise InputError(shown(value), " or ".join(f'"{w}"' for w in words))
        return value

    return Takes("a text", read, {"type": "string", "enum": list(words)})


def located_in(kind: str) -> Takes:
    """A path from the folder of the file, or a shipped name; it has to exist.

    Parameters
    ----------
    kind : {"cfd_data", "geometry"}
    """
    return Takes(
        "a text", lambda v, file: located(text_of(v, file), kind, file.parent), {"type": "string", "minLength": 1}
    )


TEXTS = Takes("a list of texts", _texts, {"type": "array", "items": {"type": "string"}})
TABLE = Takes("a table", _table, {"type": "object"})
POINT_WORDS = "a point [x, y, z] in metres, FRD, from the datum"
POINT = numbers(3, "length", POINT_WORDS)
ABOVE_ZERO = Within(positive_number, schema={"exclusiveMinimum": 0})
ZERO_OR_MORE = Within(lambda v: "zero or more" if v < 0.0 else "", schema={"minimum": 0})

Text = Annotated[str, Takes("a text", text_of, {"type": "string", "pattern": r"\S"})]
Words = Annotated[str, Takes("a text", _blank, {"type": "string"})]
Texts = Annotated[tuple[str, ...], TEXTS]
Flag = Annotated[bool, Takes("true or false", _flag, {"type": "boolean"})]
Anything = Annotated[Any, Takes("anything", lambda v, _: v, {})]
Point = Annotated[Array, Takes(POINT.words, lambda v, f: np.array(POINT.read(v, f)), POINT.schema)]
Pure = Annotated[float, number_in("none")]
Length = Annotated[float, number_in("length")]
Area = Annotated[float, number_in("area")]
Volume = Annotated[float, number_in("volume")]
Angle = Annotated[float, number_in("angle")]
Time = Annotated[float, number_in("time")]
Speed = Annotated[float, number_in("speed")]
Rate = Annotated[float, number_in("rate")]
Acceleration = Annotated[float, number_in("acceleration")]
Density = Annotated[float, number_in("density")]
Viscosity = Annotated[float, number_in("viscosity")]
Mass = Annotated[float, number_in("mass")]
MassRate = Annotated[float, number_in("mass rate")]
Inertia = Annotated[float, number_in("inertia")]
Moment = Annotated[float, number_in("moment")]
Force = Annotated[float, number_in("force")]


@functools.cache
def _adapter(kind: Any) -> Any:
    from pydantic import TypeAdapter

    return TypeAdapter(kind)


HEADS = {  # of kinds of files that people take for each other, and where they go
    "tank": ("a tow", "coeflab tow"),
    "study": ("a plan", "coeflab run"), "campaign": ("a campaign", "coeflab fit"), "matrix": ("a matrix of runs", "coeflab tow BODY --matrix"),
    "configuration": ("a body", "coeflab vehicle"),
}  # fmt: skip


def declared(kind: type[Kind], file: TomlFile) -> Kind:
    """What a file declares.

    Parameters
    ----------
    kind : type
        The declaration.
    file : TomlFile

    Raises
    ------
    InputError
        A file of another kind; else one message with everything that is wrong, by line and key.
    """
    known = {f.name: f for f in dataclasses.fields(cast(Any, kind))}
    for head, (what, command) in HEADS.items():
        if head in file.content and head not in known:
            raise InputError(
                f"{what}, with [{head}]", f"a file with [{next(iter(known))}]", file=file.path, line=file.line((head,)),
                advice=f"It goes to {command}.",
            )  # fmt: skip
    return validated(kind, file.content, file.path, file.line)


def validated(
    kind: type[Kind],
    content: Any,
    file: Path | None = None,
    line: Callable[[Loc], int | None] = lambda _: None,
    at: Loc = (),
) -> Kind:
    """Content of any origin as a declaration.

    Parameters
    ----------
    kind : type
    content : object
        Mostly a mapping.
    file : path, optional
        For messages; paths in it resolve from its folder.
    line : callable, optional
        Line of a place.
    at : tuple, optional
        Place of the content in the file.

    Raises
    ------
    InputError
        One message with everything that is wrong.
    """
    from pydantic import ValidationError

    try:
        out: Kind = _adapter(cast(Any, kind)).validate_python(content, context={"file": file or Path()})
    except ValidationError as why:
        found = [_complaint(kind, error, file, line, at) for error in why.errors(include_url=False)]
    else:
        return out
    raise together(sorted(found, key=lambda complaint: complaint.line or 0))


def declared_key(file: TomlFile, key: str, kind: Any) -> Any:
    """One value of a file that is not declared as a whole.

    Parameters
    ----------
    file : TomlFile
    key : str
        Dotted.
    kind : type
        `Length`, `Texts` ...

    Raises
    ------
    InputError
        Nothing there, or not of the kind.
    """
    value: Any = file.content
    for part in dotted(key):
        if not (isinstance(part, int) or (isinstance(value, dict) and part in value)):
            raise file.fail(key, "nothing", _takes(kind).words, f"Add {key}.")
        value = value[part]
    return validated(kind, value, file.path, file.line, dotted(key))


def _complaint(
    kind: Any, error: ErrorDetails, file: Path | None, line: Callable[[Loc], int | None], above: Loc
) -> InputError:
    """One of pydantic's errors in our words."""
    loc, sort = error["loc"], error["type"]
    at: Loc = (*above, *(part if isinstance(part, int) else key_of(part) for part in loc))
    advice, cls = "", InputError
    if sort == "value_error":
        why = error["ctx"]["error"].why
        cls, found, expected, advice = type(why), why.found or shown(error["input"]), why.expected, why.advice
        at = (*at, *dotted(why.column)) if why.column else at
    elif sort == "missing":
        takes = _takes(_field(kind, loc))
        found, expected, advice = "nothing", takes.words, takes.absent or f"Add {name_of(at)}."
    elif sort == "unexpected_keyword_argument":
        known = sorted(key_of(f.name) for f in dataclasses.fields(_field(kind, loc[:-1])))
        near = difflib.get_close_matches(str(at[-1]), known, n=1)
        found, expected = "an unknown key", "one of " + ", ".join(known)
        advice = f"Did you mean {name_of((*at[:-1], near[0]))}?" if near else ""
    else:
        tables = "tables [[{}]]" if sort in ("tuple_type", "list_type") else "a table [{}]"
        found, expected = shown(error["input"]), tables.format(name_of(at))
    place = at[:-1] if sort == "missing" else at
    return cls(found, expected, file=file, line=line(place), key=name_of(at), advice=advice)


def name_of(place: Loc) -> str:
    """A place as messages write it: ``table[0].campaign``."""
    out = ""
    for part in place:
        out += f"[{part}]" if isinstance(part, int) else f".{part}" if out else part
    return out


@functools.cache
def _hints(kind: Any) -> dict[str, Any]:
    return typing.get_type_hints(kind, include_extras=True)


def _field(kind: Any, place: Loc) -> Any:
    """The annotation of a place, without what an optional one may lack."""
    for part in place:
        kind = _bare(kind)
        inner = [a for a in typing.get_args(kind) if a is not Ellipsis]
        kind = _hints(cast(Any, kind))[str(part)] if dataclasses.is_dataclass(kind) else inner[-1]
    return kind if _takes(kind) is not TABLE else _bare(kind)


def _bare(kind: Any) -> Any:
    while typing.get_origin(kind) in (Annotated, Union, types.UnionType):
        kind = typing.get_args(kind)[0]
    return kind


def _takes(kind: Any) -> Takes:
    """What a field takes."""
    return next((m for m in getattr(kind, "__metadata__", ()) if isinstance(m, Takes)), TABLE)


def json_schema(kind: Any, name: str) -> bytes:
    """The JSON Schema of a kind of file.

    Parameters
    ----------
    kind : type
    name : str
        Of the kind of file.
    """
    content = _adapter(kind).json_schema()
    content["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    content["title"] = f"coeflab {name} file"
    return (json.dumps(content, indent=2, ensure_ascii=False) + "\n").encode()
