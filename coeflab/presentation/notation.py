"""Symbols in plain text: where a sentence or a cell holds mathematics, and which."""

from __future__ import annotations

import re
from dataclasses import dataclass

from coeflab.core.errors import InputError
from coeflab.core.symbols import derivative

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "theta": "θ", "lambda": "λ", "nu": "ν", "rho": "ρ",
    "phi": "φ", "psi": "ψ", "omega": "ω", "zeta": "ζ",
}  # fmt: skip
THIN, MINUS = "\u202f", "\u2212"


@dataclass(frozen=True, slots=True)
class Factor:
    """One variable below a symbol: ``vdot`` is a dotted v, ``|v|`` an absolute one, ``dr`` a delta with index r."""

    letter: str
    index: str = ""
    dotted: bool = False
    absolute: bool = False


@dataclass(frozen=True, slots=True)
class Symbol:
    """A letter with what stands below and above it.

    Attributes
    ----------
    letter : str
        Set in italics.
    text : str
        As it was written, for readers who hear the page.
    factors : tuple of Factor
    index : str
        Below, upright, instead of factors.
    primed : bool
    """

    letter: str
    text: str
    factors: tuple[Factor, ...] = ()
    index: str = ""
    primed: bool = False


@dataclass(frozen=True, slots=True)
class Raised:
    """An exponent."""

    text: str


Run = str | Symbol | Raised

_VARIABLE = r"(?:d[rsb]|[uvwpqr](?:dot)?)"
_FACTORS = rf"(?:\|{_VARIABLE}\||{_VARIABLE})"
_EDGE = r"(?<![\w.?&$\\'-])(?<!\w\w/)"
_END = r"(?![\w$\\'])(?!\.\w)"
_TOKENS = re.compile(
    "|".join(
        (
            rf"(?P<primed>{_EDGE}-?[XYZKMN](?:0|{_FACTORS}{{1,5}})'{_END})",
            rf"(?P<dotted>{_EDGE}-?[XYZKMN](?=[uvwpqrdot|bs]*(?:dot|\|)){_FACTORS}{{1,5}}{_END})",
            rf"(?P<prime>{_EDGE}(?:[XYZKMNuvwpqr]|d[rsb])'{_END})",
            rf"(?P<known>{_EDGE}-?(?:[CGMU]_[A-Za-z]{{1,5}}|m_[xyz]r?|U95|[xyz][BG]){_END})",
            rf"(?P<greek>{_EDGE}(?:delta_[rsb]|{'|'.join(GREEK)}){_END}(?![/_-]))",
            rf"(?P<letter>{_EDGE}(?<![^^]\d )(?<!\A\d )[XYZKMNULuvwpqrxyz](?![\w.$\\'*-])(?!/(?:\w\w|\())(?!\]))",
            r"(?P<power>(?<=[\w'|)])\^-?\d+(?![\w$}]))",
            r"(?P<cubic>(?<=\dm|/m|cm)[23](?!\w))",
            r"(?P<scientific>(?<![\w.])[-+]?\d+(?:\.\d+)?e[-+]?\d+(?!\w))",
            r"(?P<degrees>(?<=\d) deg(?!\w))",
            r"(?P<times>(?<=\d) x (?=[\d.]))",
            r"(?P<sign>(?<![\w.)\]'\"_/-])-(?=[\d.]*\d)|(?<=\b[A-Z]) - (?=[A-Z]\b)|(?<=[a-z]\d) - (?=[a-z]\d)|(?<=_[xyz]) - (?=\w_)|(?<=\w) - (?=[A-Z]\w*'))",
            r"(?P<word>\+-(?!\w)|(?<= )\.\.(?= )|<=|>=|(?<=\w)\*(?=m\b)|sqrt (?=\d))",
        )
    )
)
_WORDS = {"+-": "±", "..": "…", "<=": "≤", ">=": "≥", "*": "·", "sqrt ": "√"}


def runs(text: str) -> tuple[Run, ...]:
    """A sentence in pieces: plain text with proper minus signs, symbols, exponents.

    Parameters
    ----------
    text : str
        For example ``Yv' = -0.0273 at beta = 2 deg``.

    Returns
    -------
    tuple
        Never two plain pieces in a row. A text with ``$`` or a backslash is somebody's markup: one plain piece.
    """
    if "$" in text or "\\" in text:
        return (text,)
    out: list[Run] = []
    at = 0
    for found in _TOKENS.finditer(text):
        out += [text[at : found.start()], *_pieces(found)]
        at = found.end()
    return _joined([*out, text[at:]])


def cell_runs(text: str) -> tuple[Run, ...]:
    """A table's cell in pieces: as `runs`, and a cell that is nothing but a derivative is one without its prime too."""
    if text == "-":
        return ("\u2013",)
    if len(text) <= 16 and text[:1] in tuple("XYZKMN") and text.isprintable():
        try:
            return (_derivative(text),)
        except InputError:
            return runs(text)
    return runs(text)


def _joined(pieces: list[Run]) -> tuple[Run, ...]:
    out: list[Run] = []
    for piece in pieces:
        if isinstance(piece, str) and out and isinstance(out[-1], str):
            out[-1] += piece
        elif piece != "":
            out.append(piece)
    return tuple(out)


def _pieces(found: re.Match[str]) -> tuple[Run, ...]:
    kind, text = str(found.lastgroup), found[0]
    if kind in ("primed", "dotted", "known") and text.startswith("-"):
        return (MINUS, _symbol(kind, text[1:]))
    if kind in ("primed", "dotted", "prime", "known", "greek", "letter"):
        return (_symbol(kind, text),)
    if kind in ("power", "cubic"):
        return (Raised(text.removeprefix("^").replace("-", MINUS)),)
    if kind == "scientific":
        number, _, power = text.partition("e")
        factor = f"{number.replace('-', MINUS)}{THIN}×{THIN}10"
        return (factor, Raised(str(int(power)).replace("-", MINUS)))
    return ({"degrees": "°", "times": " × ", "sign": text.replace("-", MINUS)}.get(kind) or _WORDS[text],)


def _symbol(kind: str, text: str) -> Symbol:
    if kind in ("primed", "dotted"):
        return _derivative(text)
    if kind == "prime":
        factors = (Factor(text[1]),) if text.startswith("d") else ()
        return Symbol("δ" if factors else text[0], text, factors, primed=True)
    if kind == "known":
        return Symbol(text[0], text, index=text[1:].removeprefix("_"))
    if kind == "greek":
        name, _, index = text.partition("_")
        return Symbol(GREEK[name], text, (Factor(index),) if index else ())
    return Symbol(text, text)


def _derivative(text: str) -> Symbol:
    """A derivative's letters; raises where the text is none."""
    derivative(text)
    bare = text.removesuffix("'")
    primed = bare != text
    if bare[1:] == "0":
        return Symbol(bare[0], text, index="0", primed=primed)
    factors = []
    for found in re.finditer(_FACTORS, bare[1:]):
        name = found[0].strip("|")
        absolute = name != found[0]
        if name.startswith("d"):
            factors.append(Factor("δ", name[1:], absolute=absolute))
        else:
            factors.append(Factor(name[0], dotted=name.endswith("dot"), absolute=absolute))
    return Symbol(bare[0], text, tuple(factors), primed=primed)
