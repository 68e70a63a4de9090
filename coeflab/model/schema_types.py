"""What the parts of the parameter file are made of: numbers within bounds, and models that refuse unknown keys."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from coeflab.core.wording import Verbatim
from coeflab.kernels.brief import brief

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=200)]
Words = Annotated[Name, AfterValidator(Verbatim)]


@brief
class Strict(BaseModel):
    """A frozen model without unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)

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
