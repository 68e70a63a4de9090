"""Symbols in plain text: where a sentence or a cell holds mathematics, and which."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

from coeflab.core.errors import InputError
from coeflab.core.symbols import CONTROLS, derivative
from coeflab.kernels.brief import brief

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "theta": "θ", "lambda": "λ", "nu": "ν", "rho": "ρ",
    "phi": "φ", "psi": "ψ", "omega": "ω", "zeta": "ζ",
}  # fmt: skip
THIN, MINUS = "\u202f", "\u2212"
DOT = "\u0307"
HIGH, LEVEL = "⁻⁰¹²³⁴⁵⁶⁷⁸⁹", f"{MINUS}0123456789"


@dataclass(frozen=True, slots=True)
class Factor:
    """One variable below a symbol: ``vdot`` is a dotted v, ``|v|`` an absolute one, ``dr`` a delta with index r."""

    letter: str
    index: str = ""
    dotted: bool = False
    absolute: bool = False


@brief
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

_ANGLES = "|".join(GREEK)
_VARIABLE = r"(?:d[rsb]|[uvwpqr](?:dot)?)"
_FACTORS = rf"(?:\|{_VARIABLE}\||{_VARIABLE})"
_POWER = rf"(?:{_ANGLES})(?:\^\d)?"
# Without a prime, only what is no word: no Mr, Nu, Kp, Yup.
_FIRST = r"(?:X[uvwqr]|Y[vwpr]|Z[vwqr]|K[vr]|M[wqv]|N(?:[vw]|r(?! ?\d)))"
_SECOND = r"[XYZKMN](?:[vwpqr]{2}|[uvwpqr]{2}(?=, [XYZKMN][uvwpqr]{2}\b)|(?<=[uvwpqr]{2}, [XYZKMN])[uvwpqr]{2})"
_EDGE = r"(?<![\w.?&$\\'-])(?<!\w\w/)"
_END = rf"(?!(?![{HIGH}])[\w$\\'])(?!\.\w)"
_TOKENS = re.compile(
    "|".join(
        (
            rf"(?P<primed>{_EDGE}-?[XYZKMN](?:0|{_FACTORS}{{1,5}})'{_END})",
            rf"(?P<dotted>{_EDGE}-?[XYZKMN](?=[uvwpqrdot|bs]*(?:dot|\|)){_FACTORS}{{1,5}}{_END})",
            rf"(?P<prime>{_EDGE}(?:[XYZKMNuvwpqrmk]|[xyz]G|d[rsb])'{_END})",
            rf"(?P<model>{_EDGE}-?(?:[CK]_[A-Za-z]|[XYZKMN]'?)_(?:0|{_POWER}(?: {_POWER})*){_END})",
            rf"(?P<bare>{_EDGE}(?:[XYZKMN]0|{_FIRST}|{_SECOND}){_END})",
            rf"(?P<known>{_EDGE}-?(?:[CGKMU]_[A-Za-z]{{1,5}}0?|[A-Za-z]_(?:dot|[A-Za-z]{{1,2}})|U95|[xyz][BG]|k[12]){_END})",
            rf"(?P<greek>{_EDGE}(?:delta_[rsb]|(?:alpha|beta)_deg|δ[rsb]|[{''.join(GREEK.values())}]|(?<!\d )psi|(?!psi)(?:{_ANGLES})){_END}(?![/_-])(?! (?:wing|version|release)\b))",
            rf"(?P<letter>{_EDGE}(?<![^^]\d )(?<!\A\d )(?!N m\b)(?:[XYZKMNULuvwpqrxyz]|V(?=\s*[=<>^)/])|(?<=\A)V(?=\Z))(?![\w.$\\'*-])(?!/(?:\w\w|\())(?!\]))",
            r"(?P<power>(?<=[\w'|)])\^(?:-?\d+|[knT])(?![\w$}]))",
            rf"(?P<high>[{HIGH}]+)",
            r"(?P<cubic>(?<=\dm|/m|cm)[23](?!\w)|(?<=\bR)2(?!\w))",
            r"(?P<scientific>(?<![\w.])[-+]?\d+(?:\.\d+)?e[-+]?\d+(?!\w))",
            r"(?P<degrees>(?<=\d) deg(?!\w)|(?<=\[)deg(?=[]/])|(?<=1/)deg(?=[]^])|(?<=\w )deg\Z)",
            r"(?P<times>(?<=\d) [x*] (?=[\d.]))",
            r"(?P<sign>(?<![\w.)\]'\"_/-])-(?=[\d.]*\d)|(?<=\b[A-Z]) - (?=[A-Z]\b)|(?<=[a-z]\d) - (?=[a-z]\d)|(?<=[\w)]) - (?=[A-Za-z]_[A-Za-z]|(?:cos|sin)\b)|(?<=\bn) - (?=p\b)|(?<= [a-z]) - (?=\d)|(?<=[\w'\)\]]) - (?=[A-Za-z]\w*'))",
            r"(?P<word>\+-(?!\w)|(?<= )\.\.(?= )|<=|>=|(?<=\w)\*(?=m\b)|sqrt (?=\d)|(?<![\w./-])1/2(?= (?:rho\b|\()))",
        )
    )
)
_WORDS = {"+-": "±", "..": "…", "<=": "≤", ">=": "≥", "*": "·", "sqrt ": "√", "1/2": "½"}
_UNITS = {"deg": "°", "deg/s": "°/s"}


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
    if text in _UNITS:
        return (_UNITS[text],)
    if text in CONTROLS:
        return (Symbol("δ", text, index=text[1:]),)
    if len(text) <= 16 and text[:1] in tuple("XYZKMN") and text.isprintable():
        try:
            return (_derivative(text),)
        except InputError:
            return runs(text)
    return runs(text)


def unit_runs(text: str) -> tuple[Run, ...]:
    """A unit in pieces: no letter of it is a symbol."""
    pieces: list[Run] = []
    for i, part in enumerate(re.split(r"\^(-?\d+)", _UNITS.get(text, text.replace("*", "·")))):
        pieces.append(Raised(part.replace("-", MINUS)) if i % 2 else part)
    return _joined(pieces)


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
    if kind in ("primed", "dotted", "model", "known") and text.startswith("-"):
        return (MINUS, _symbol(kind, text[1:]))
    if kind in ("primed", "dotted", "prime", "model", "bare", "known", "greek", "letter"):
        return (_symbol(kind, text),)
    if kind in ("power", "cubic"):
        return (Raised(text.removeprefix("^").replace("-", MINUS)),)
    if kind == "high":
        return (Raised(text.translate(str.maketrans(HIGH, LEVEL))),)
    if kind == "scientific":
        return _scientific(text)
    return ({"degrees": "°", "times": " × ", "sign": text.replace("-", MINUS)}.get(kind) or _WORDS[text],)


def _scientific(text: str) -> tuple[Run, ...]:
    number, _, power = text.partition("e")
    factor = number.replace("-", MINUS)
    if float(number) == 0.0 or int(power) == 0:
        return (factor,)
    return (f"{factor}{THIN}×{THIN}10", Raised(str(int(power)).replace("-", MINUS)))


def _symbol(kind: str, text: str) -> Symbol:
    if kind in ("primed", "dotted", "bare"):
        return _derivative(text)
    if kind == "prime":
        return Symbol("δ" if text[0] == "d" else text[0], text, index=text[1:-1], primed=True)
    if kind == "model":
        return _of_a_model(text)
    if kind == "known":
        index = text[1:].removeprefix("_")
        if index == "dot":
            return Symbol(unicodedata.normalize("NFC", text[0] + DOT), text)
        return Symbol(text[0], text, index=index)
    if kind == "greek":
        name, _, index = text.partition("_") if text[0].isascii() else (text[0], "", text[1:])
        return Symbol(GREEK.get(name, name), text, index=index)
    return Symbol(text, text)


def _of_a_model(text: str) -> Symbol:
    """The coefficient of a term: ``C_D_alpha^2 beta`` has the index D α²β."""
    head, _, term = text.rpartition("_")
    shown = re.sub(_ANGLES, lambda m: GREEK[m[0]], term).replace(" ", "")
    shown = re.sub(r"\^(\d)", lambda m: m[1].translate(str.maketrans(LEVEL, HIGH)), shown)
    return Symbol(head[0], text, index=head[1:].strip("_'") + shown, primed=head.endswith("'"))


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
