"""Symbols in plain text: where a sentence or a cell holds mathematics, and which; what users wrote holds none."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import fields, is_dataclass
from functools import wraps
from typing import ParamSpec, TypeVar

from coeflab.core.errors import InputError
from coeflab.core.text.patterns import one_of
from coeflab.core.types import dataclass
from coeflab.core.wording import Verbatim
from coeflab.law.symbols import CONTROLS, derivative

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


@dataclass(frozen=True, slots=True)
class Command:
    """A command to type, without the backticks that it was written between."""

    text: str


@dataclass(frozen=True, slots=True)
class VerbatimTexts:
    """Texts of users that are set as they stand wherever a sentence holds them; by their beginnings, as titles are cut."""

    texts: tuple[str, ...]
    beginnings: re.Pattern[str]


Run = str | Symbol | Raised | Command
Given = ParamSpec("Given")
Returned = TypeVar("Returned")
BEGINNING, SHORT = 20, 4
# Nouns that a program may make of plain texts as well, and their fields that are words of a user.
NAMED = (
    "Plan",
    "Campaign",
    "ForceTable",
    "FitResult",
    "Body",
    "Reference",
    "ParameterFile",
    "Vehicle",
    "Glider",
    "InputFile",
)
NAMES = ("name", "title", "campaign", "body", "datum")
COVER = "\u0436"
_VERBATIM: ContextVar[VerbatimTexts | None] = ContextVar("kept", default=None)

_ANGLES = "|".join(GREEK)
_VARIABLE = r"(?:d[rsb]|[uvwpqr](?:dot)?)"
_FACTORS = rf"(?:\|{_VARIABLE}\||{_VARIABLE})"
_POWER = rf"(?:{_ANGLES})(?:\^\d)?"
# Without a prime, only what is no word: no Mr, Nu, Kp, Yup.
_FIRST = r"(?:X[uvwqr]|Y[vwpr]|Z[vwqr]|K[vr]|M[wqv]|N(?:[vw]|r(?! ?\d)))"
_SECOND = r"[XYZKMN](?:[vwpqr]{2}|[uvwpqr]{2}(?=, [XYZKMN][uvwpqr]{2}\b)|(?<=[uvwpqr]{2}, [XYZKMN])[uvwpqr]{2})"
_EDGE = r"(?<![\w.?&$\\'-])(?<!\w\w/)"
_END = rf"(?!(?![{HIGH}])[\w$\\'])(?!\.\w)"
TOKENS = re.compile(
    "|".join(
        (
            r"(?P<command>`coeflab [^`]+`)",
            rf"(?P<primed>{_EDGE}-?[XYZKMN](?:0|{_FACTORS}{{1,5}})'{_END})",
            rf"(?P<dotted>{_EDGE}-?[XYZKMN](?=[uvwpqrdot|bs]*(?:dot|\|)){_FACTORS}{{1,5}}{_END})",
            rf"(?P<prime>{_EDGE}(?:[XYZKMNuvwpqrmk]|[xyz]G|d[rsb])'{_END})",
            rf"(?P<model>{_EDGE}-?(?:[CK]_[A-Za-z]|[XYZKMN]'?)_(?:0|{_POWER}(?: {_POWER})*){_END})",
            rf"(?P<bare>{_EDGE}(?:[XYZKMN]0|{_FIRST}|{_SECOND}){_END})",
            rf"(?P<known>{_EDGE}-?(?:[CGKMU]_[A-Za-z]{{1,5}}0?|[A-Za-z]_(?:dot|[A-Za-z]{{1,2}})|U95|[xyz][BG]|k[12]){_END})",
            rf"(?P<greek>{_EDGE}(?:delta_[rsb]|(?:theta|phi|psi|omega)_(?:\d|[xyz])|(?:alpha|beta)_deg|δ[rsb]|[{''.join(GREEK.values())}]|(?<!\d )psi|(?!psi)(?:{_ANGLES})){_END}(?![/_-])(?! (?:wing|version|release)\b))",
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


def users_texts(*nouns: object) -> tuple[str, ...]:
    """The texts in nouns that a user wrote, and names of files, so far as they could be taken for symbols; sorted."""
    found: set[str] = set()
    seen: dict[int, object] = {}
    waiting = list(nouns)
    while waiting:
        noun = waiting.pop()
        if isinstance(noun, Verbatim):
            found |= {str(noun), noun.replace("_", " ")}
        elif isinstance(noun, (str, int, float, complex, type(None), type)) or id(noun) in seen:
            continue
        elif isinstance(noun, Mapping):
            waiting += [*noun, *noun.values()]
        elif isinstance(noun, (tuple, list)):
            waiting += [v for v in noun if not isinstance(v, (int, float))]
        elif is_dataclass(noun) and not type(noun).__module__.startswith("coeflab.fits.statistics."):
            waiting += [getattr(noun, f.name) for f in fields(noun)]
        else:
            waiting += [getattr(noun, name) for name in getattr(type(noun), "model_fields", ())]
        if type(noun).__name__ in NAMED:
            waiting += [Verbatim(getattr(noun, name)) for name in NAMES if isinstance(getattr(noun, name, None), str)]
        seen[id(noun)] = noun
    return tuple(sorted({t for t in (" ".join(text.split()) for text in found) if _looks_like_symbols(t)}))


def _looks_like_symbols(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return any(map(str.isalpha, text)) and (TOKENS.search(text) is not None or cell_runs(text) != (text,))
    return False


@contextmanager
def keeping(texts: Iterable[str]) -> Iterator[None]:
    """Set these texts of users as they stand within the block, in sentences, cells and drawings."""
    flat = tuple(sorted({" ".join(t.split()) for t in texts} - {""}))
    before = _VERBATIM.set(VerbatimTexts(flat, _beginnings(flat)))
    try:
        yield
    finally:
        _VERBATIM.reset(before)


def as_users_wrote(make: Callable[Given, Returned]) -> Callable[Given, Returned]:
    """Let a maker of drawings set the users' texts in its arguments as they stand, unless a block says which."""

    @wraps(make)
    def wrapped(*given: Given.args, **more: Given.kwargs) -> Returned:
        if verbatim() is not None:
            return make(*given, **more)
        with keeping(users_texts(*given, *more.values())):
            return make(*given, **more)

    return wrapped


def verbatim() -> VerbatimTexts | None:
    """The texts of users that are set as they stand just now."""
    return _VERBATIM.get()


def _beginnings(texts: tuple[str, ...]) -> re.Pattern[str]:
    """Where a text may begin. A short one must be a word of its own, and part of no symbol."""
    long = sorted({re.escape(t[:BEGINNING]) for t in texts if len(t) >= SHORT}, key=len, reverse=True)
    short = [rf"(?<![\w|'^]){re.escape(t)}(?![\w|'^])" for t in texts if len(t) < SHORT]
    return one_of([*long, *short])


def masked(text: str, verbatim: VerbatimTexts | None) -> str:
    """The text, of equal length, with a neutral letter for every one of a user's."""
    if verbatim is None or not verbatim.texts:
        return text
    places = [i for i, ch in enumerate(text) if not (ch.isspace() and i and text[i - 1].isspace())]
    flat = "".join(" " if text[i].isspace() else text[i] for i in places)
    spans = [
        (m.start(), m.start() + _longest(m[0], flat[m.start() :], verbatim)) for m in verbatim.beginnings.finditer(flat)
    ]
    if flat.endswith("…"):
        spans.append((len(flat) - 1 - _last_cut(flat[:-1], verbatim), len(flat) - 1))
    out = list(text)
    for start, end in spans:
        for i in range(places[start], places[end - 1] + 1) if start < end else ():
            out[i] = COVER
    return "".join(out)


def _longest(beginning: str, rest: str, verbatim: VerbatimTexts) -> int:
    """How many characters of the rest are a user's text that begins so."""
    return max(_agreement(t, rest) for t in verbatim.texts if t.startswith(beginning))


def _last_cut(text: str, verbatim: VerbatimTexts) -> int:
    """How many characters at the end of a text that was cut are the beginning of a user's, too short to be found."""
    return max(
        (k for k in range(1, BEGINNING) for t in verbatim.texts if len(t) > k and text.endswith(t[:k].rstrip())),
        default=0,
    )


def _agreement(a: str, b: str) -> int:
    """How many characters two texts have in common from their beginnings on."""
    return next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))


def runs(text: str, verbatim: VerbatimTexts | None = None) -> tuple[Run, ...]:
    """A sentence in pieces: plain text with proper minus signs, symbols, exponents.

    Parameters
    ----------
    text : str
        For example ``Yv' = -0.0273 at beta = 2 deg``.
    verbatim : Kept, optional
        Texts of users, in which nothing is a symbol.

    Returns
    -------
    tuple
        Never two plain pieces in a row. A text with ``$`` or a backslash is somebody's markup: one plain piece.
    """
    covered = masked(text, verbatim)
    if "$" in covered or "\\" in covered:
        return (text,)
    out: list[Run] = []
    at = 0
    for found in TOKENS.finditer(covered):
        out += [text[at : found.start()], *symbol_pieces(found)]
        at = found.end()
    return joined([*out, text[at:]])


def cell_runs(text: str, verbatim: VerbatimTexts | None = None) -> tuple[Run, ...]:
    """A table's cell in pieces: as `runs`, and a cell that is nothing but a derivative is one without its prime too."""
    if masked(text, verbatim) != text:
        return runs(text, verbatim)
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
    return joined(pieces)


def joined(pieces: list[Run]) -> tuple[Run, ...]:
    """Runs without empty ones, never two plain pieces in a row."""
    out: list[Run] = []
    for piece in pieces:
        if isinstance(piece, str) and out and isinstance(out[-1], str):
            out[-1] += piece
        elif piece != "":
            out.append(piece)
    return tuple(out)


def symbol_pieces(found: re.Match[str]) -> tuple[Run, ...]:
    """The runs of one match of `TOKENS`."""
    kind, text = str(found.lastgroup), found[0]
    if kind == "command":
        return (Command(text.strip("`")),)
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
