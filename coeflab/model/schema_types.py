"""What the parts of the parameter file are made of: numbers within bounds, and models that refuse unknown keys."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError

from coeflab.core.limits import LARGEST_STORED, positive_number
from coeflab.core.wording import Verbatim
from coeflab.kernels.brief import brief


def _storable(value: float) -> float:
    if abs(value) > LARGEST_STORED:
        raise PydanticCustomError("bounds", "Input should be a number from {low} to {high}", {
            "low": f"{-LARGEST_STORED:g}", "high": f"{LARGEST_STORED:g}",
        })  # fmt: skip
    return value


def _dividing(value: float) -> float:
    if expected := positive_number(value):
        raise PydanticCustomError("bounds", "Input should be {expected}", {"expected": expected})
    return value


Finite = Annotated[float, Field(allow_inf_nan=False), AfterValidator(_storable)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False), AfterValidator(_dividing)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False), AfterValidator(_storable)]
Name = Annotated[str, Field(min_length=1, max_length=200)]
Words = Annotated[Name, AfterValidator(Verbatim)]


def _fail_fast(schema: Any) -> None:
    """Let every list of a core schema stop at its first wrong item."""
    if isinstance(schema, dict):
        if schema.get("type") in ("tuple", "list"):
            schema["fail_fast"] = True
        for part in schema.values():
            _fail_fast(part)
    elif isinstance(schema, list):
        for part in schema:
            _fail_fast(part)


@brief
class Strict(BaseModel):
    """A frozen model without unknown keys; of a list the first wrong item is reported, not a million of them."""

    model_config = ConfigDict(extra="forbid", frozen=True, protected_namespaces=())

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        schema = handler(source)
        _fail_fast(schema)
        return schema

    def __str__(self) -> str:
        return repr(self)


def told(meaning: str, unit: str = "", since: str = "") -> Any:
    """What a field means, to stand in its ``Annotated``; the schema and its page show it.

    Parameters
    ----------
    meaning : str
    unit : str
        Empty for what has none or states it beside it; ``1`` for primes.
    since : str
        Version of the schema that brought it; empty for that of the table which holds it.
    """
    extra: dict[str, Any] = {name: text for name, text in (("unit", unit), ("since", since)) if text}
    return Field(description=meaning, json_schema_extra=extra or None)
