"""Properties and arguments of xacro, as far as numbers need them: ``${mass * 9.81}`` and ``$(arg scale)``, nothing run."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree.ElementTree import Element

from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.core.errors import InputError, shown
from coeflab.core.limits import XACRO_DEEPEST, XACRO_TEXT, XACRO_WHOLE

SPACE = "{http://www.ros.org/wiki/xacro}"
_PIECE = re.compile(r"\$\{([^{}]*)\}|\$\(arg\s+(\w+)\s*\)")
_NAME = re.compile(r"[A-Za-z_]\w*")
_FUNCTIONS = {"sin": math.sin, "cos": math.cos, "sqrt": math.sqrt, "radians": math.radians}


class Xacro(Mapping[str, float]):
    """The properties of a document; as a mapping, those that are numbers.

    Parameters
    ----------
    root : Element
    file : path, optional
        For messages.
    """

    def __init__(self, root: Element, file: Path | str | None = None) -> None:
        self._file = file
        properties = [(e.get("name", ""), e.get("value", "")) for e in root.iter(f"{SPACE}property")]
        self._raw = dict(properties)
        self._twice = {name for name, value in properties if self._raw[name] != value}
        self._arguments = {e.get("name", ""): e.get("default", "") for e in root.iter(f"{SPACE}arg")}
        self._done: dict[tuple[int, str], str] = {}
        self._depth = self._letters = 0

    def text(self, raw: str) -> str:
        """A text with every expression replaced by its value.

        Raises
        ------
        InputError
            A name that the document does not define or defines twice, an expression that is no arithmetic, properties that need each other,
            or more than 64 KiB of text.
        """
        if self._depth > XACRO_DEEPEST:
            raise InputError(
                f"properties in properties, more than {XACRO_DEEPEST} deep", "plain properties", file=self._file
            )
        self._depth += 1
        out, at = [], 0
        for piece in _PIECE.finditer(raw):
            out += [raw[at : piece.start()], self._value(piece[1], piece[2])]
            at = piece.end()
        self._depth -= 1
        joined = "".join([*out, raw[at:]])
        if len(joined) > XACRO_TEXT:
            raise InputError(f"{len(joined)} characters", f"at most {XACRO_TEXT} in one text", file=self._file)
        self._letters += len(joined)
        if self._letters > XACRO_WHOLE:
            raise InputError(
                f"properties that unfold to {self._letters} characters", f"at most {XACRO_WHOLE}", file=self._file
            )
        return joined

    def _value(self, expression: str | None, argument: str | None) -> str:
        if expression is None:
            return self._known(self._arguments, argument or "")
        name = expression.strip()
        if _NAME.fullmatch(name):
            return self._known(self._raw, name)
        try:
            return repr(float(evaluate(name.replace("**", "^"), self, _FUNCTIONS)))
        except (ArithmeticProblem, ValueError) as why:
            raise InputError(
                f"{shown(f'${{{name}}}')}: {why}", "arithmetic of numbers and properties", file=self._file
            ) from None

    def _known(self, among: Mapping[str, str], name: str) -> str:
        if name not in among:
            raise InputError(
                f"{shown(name)}, which this file does not define", "every property and argument in the file", file=self._file,
                advice="Run xacro first and check the URDF that it prints.",
            )  # fmt: skip
        if among is self._raw and name in self._twice:
            raise InputError(f"{shown(name)} with two values", "every property once", file=self._file)
        key = (id(among), name)
        if key not in self._done:
            self._done[key] = self.text(among[name])
        return self._done[key]

    def __getitem__(self, name: str) -> float:
        return math.pi if name == "pi" else float(self._known(self._raw, name))

    def __contains__(self, name: object) -> bool:
        return name == "pi" or name in self._raw

    def __iter__(self) -> Iterator[str]:
        return iter(self._raw)

    def __len__(self) -> int:
        return len(self._raw)
