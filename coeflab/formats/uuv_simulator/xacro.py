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
from coeflab.core.texts import input_error
from coeflab.formats.left_out import SILENT

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
            raise input_error("formats.deep_properties", self._file, xacro_deepest=XACRO_DEEPEST)
        self._depth += 1
        out, at = [], 0
        for piece in _PIECE.finditer(raw):
            out += [raw[at : piece.start()], self._value(piece[1], piece[2])]
            at = piece.end()
        self._depth -= 1
        joined = "".join([*out, raw[at:]])
        if len(joined) > XACRO_TEXT:
            raise input_error("formats.long_text", self._file, count=len(joined), xacro_text=XACRO_TEXT)
        self._letters += len(joined)
        if self._letters > XACRO_WHOLE:
            raise input_error("formats.unfolds_too_far", self._file, letters=self._letters, xacro_whole=XACRO_WHOLE)
        return joined

    def _value(self, expression: str | None, argument: str | None) -> str:
        if expression is None:
            return self._known(self._arguments, argument or "")
        name = expression.strip()
        if _NAME.fullmatch(name) and (name != "pi" or name in self._raw):
            return self._known(self._raw, name)
        try:
            return repr(float(evaluate(name.replace("**", "^"), self, _FUNCTIONS)))
        except (ArithmeticProblem, ValueError) as why:
            raise input_error("formats.no_arithmetic", self._file, text=shown(f"${{{name}}}"), why=why) from None

    def _known(self, among: Mapping[str, str], name: str) -> str:
        if name not in among:
            raise input_error("formats.undefined_property", self._file, name=shown(name))
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


OWN = ("property", "arg", "macro", "include", "if", "unless", "insert_block")


def unfolded(root: Element) -> tuple[str, ...]:
    """Calls of macros in a document, which nothing here unfolds: name, and how often; sensors and the like apart."""
    names = [
        e.tag.removeprefix(SPACE)
        for e in root.iter()
        if isinstance(e.tag, str) and e.tag.startswith(SPACE) and e.tag.removeprefix(SPACE) not in OWN
    ]
    counts = {n: names.count(n) for n in names if not any(s in n.lower() for s in SILENT)}
    return tuple(n if k == 1 else f"{k} {n}" for n, k in counts.items())
