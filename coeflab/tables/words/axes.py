"""Axes and signs in words: "x forward, z down", "body axes", "beta positive with the bow to port", "all turns to starboard"."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import permutations

from coeflab.core.axes import DIRECTIONS, FRAMES, parse_axes
from coeflab.core.errors import AxesError
from coeflab.core.text.patterns import atomic
from coeflab.tables.raw_table import Stated

TURN_OF_R = "columns.r"  # no key of campaign.toml: the side to which words say that a positive r turns
FORMULA = "formula.v"  # no key: v as a formula of beta in the file's own axes, whose y may point to port
BODY_AXES = "forces.axes"  # no key of campaign.toml: the words say that forces count along the body
_BODY = re.compile(
    r"(?i)\b(?:k(?:ö|oe|o)rper|schiffs|boots|modell)fest|\b(?:body|ship|hull|vessel)[- ]?(?:fixed|axes|axis|frame)\b"
    r"|\brep[èe]re\s+(?:li[ée]|du\s+(?:corps|navire))\b|\baxes\s+li[ée]s\b"
)
_DIRECTION = re.compile(
    r"(?i)(?<![\w'])(?P<axis>[xyz])"
    + atomic(
        r"[-\s=:>→+]|l['’]|(?:le|la|axis|achse|positive?|pos\.?|is|points?|nach|zeigt|zur?|to|vers)(?![^\W_])",
        "between",
    )
    + r"\b(?P<to>forwards?|fwd|ahead|bow|vorne?|voraus|bug|avant|aft|astern|backwards?|stern|hinten|achtern|heck|arri[èe]re|starboard|stbd|"
    r"sb|right|steuerbord|stb|tribord|port|left|backbord|bb|b[âa]bord|downwards?|down|unten|bas|upwards?|up|oben|haut)\b"
)
_TO = {
    "forward": "forward forwards fwd ahead bow vorn vorne voraus bug avant",
    "aft": "aft astern backward backwards stern hinten achtern heck arrière arriere",
    "starboard": "starboard stbd sb right steuerbord stb tribord",
    "port": "port left backbord bb bâbord babord",
    "down": "down downward downwards unten bas",
    "up": "up upward upwards oben haut",
}
_DIRECTIONS = {word: name for name, words in _TO.items() for word in words.split()}
_TURNS = re.compile(
    r"(?i)(?<![^\W_])(?:all|every|alle|tous)\b[^,;.=<>]{0,25}?(?:turns?|turning|circles?|kurven|drehkreise?|kreise?|fahrten|runs|girations?)\W+"
    r"(?:(?:are|were|made|to|the|nach|zu|zur|à|sur|gefahren|turning)\s+)*(?P<one>starboard|stbd|port|steuerbord|backbord|tribord|b[âa]bord|right|left)(?![^\W_])"
    r"|cent(?:re|er)\s+of\s+(?:the\s+|a\s+)?(?:circle|turn\w*|rotation)\s+(?:\w+\s+){0,2}?(?:to\s+)?(?P<two>starboard|port|right|left)(?![^\W_])"
)
_SIGNED = {
    "axes.beta": (r"(?:drift|sideslip|yaw[\s-]*angle|drift\w*winkel|schiebewinkel|gierwinkel|angle\s+de\s+d[ée]rive)\w*|beta|β", r"starboard|stbd?|right|steuerbord|tribord",
                  r"port|left|backbord|b[âa]bord", "v = {}U sin(beta)"),
    "axes.alpha": (r"(?:angle\s+of\s+(?:attack|incidence)|incidence|pitch(?:\s+angle)?|trim(?:\s+angle)?|anstellwinkel|trimmwinkel|nickwinkel|angle\s+d'attaque)|alpha|α",
                   r"down(?:wards?)?|lowered|unten|bas|tief", r"up(?:wards?)?|raised|oben|hoch|haut", "w = {}U sin(alpha)"),
}  # fmt: skip
_RATE = r"(?<!_)(?-i:r)'?|yaw(?:ing)?\s+rate|rate\s+of\s+turn|turn(?:ing)?\s+rate|drehrate|drehgeschwindigkeit|giergeschwindigkeit|gierrate|vitesse\s+de\s+lacet"
# v as a formula of the drift angle, or the angle as one of v.
_FORMULA = re.compile(
    r"(?i)(?<![^\W_])(?:v\W?\s*=\s*(?P<v>[-+\u2212]?)\s*(?:[^\W\d]\s*[*·]?\s*)?sin|(?P<a>beta|β)\s*=\s*(?P<b>[-+\u2212]?)\s*a\w{0,2}sin)\s*(?P<open>\()?\s*(?(a)v|(?:beta|β))(?![^\W_])(?(open)(?:(?:\s*/\s*U)?\s*\))?)"
)
_BOW = r"(?:bow|nose|bug|nase|proue|nez)"
_FLOW = r"(?:flow|water|stream|anstr(?:ö|oe)mung|[ée]coulement)(?:\s+(?:comes?|coming|kommt|vient|is))*\s+(?:from|von|de|du)"


def frame_in_words(texts: Iterable[tuple[str, str]]) -> Stated | None:
    """The frame that words give direction by direction; open where it is left-handed.

    Parameters
    ----------
    texts : iterable of (place, text)
    """
    axes, first = dict[str, str](), ""
    for place, text in texts:
        for m in _DIRECTION.finditer(text):
            axes.setdefault(m["axis"].casefold(), _DIRECTIONS[m["to"].casefold()])
            first = first or place
    named = ", ".join(f"{a} {d}" for a, d in sorted(axes.items()))
    if len(axes) >= 2 and (frame := _frame(axes)):
        return Stated(frame, f"{first}: {named}", offered=True)
    if len(axes) == 3 and len({d for _, d in _opposites(axes.values())}) == 3:
        return Stated("", f"{first}: {named}", offered=True, contradicted=f"{first} is left-handed: {named}")
    return None


def _frame(axes: Mapping[str, str]) -> str:
    """The frame of two or three directions, right-handed; empty where they span none."""
    for name, directions in (*FRAMES.items(), *((", ".join(d), d) for d in permutations(DIRECTIONS, 3))):
        if all(directions["xyz".index(a)] == d for a, d in axes.items()):
            try:
                parse_axes(list(directions))
            except AxesError:
                continue
            return name
    return ""


def _opposites(directions: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Directions with the axis of the body that each lies along."""
    along = {"aft": "forward", "port": "starboard", "up": "down"}
    return ((d, along.get(d, d)) for d in directions)


def side_of_turns(place: str, text: str) -> Stated | None:
    """To which side a line says that all its tests turn."""
    m = _TURNS.search(text)
    if m is None:
        return None
    side = _DIRECTIONS[(m["one"] or m["two"]).casefold()]
    return Stated(side, f'{place}: "{" ".join(m[0].split())}"', offered=True)


def along_body(line: str, text: str) -> Stated | None:
    """Where the words say that forces count along the body."""
    m = _BODY.search(text)
    return Stated("body", f'{line}: "{_around(text, m)}"', offered=True) if m else None


def _around(text: str, found: re.Match[str]) -> str:
    """The part between commas that holds what was found."""
    begin = max(text.rfind(mark, 0, found.start()) for mark in ",;:") + 1
    ends = [at for mark in ",;:" if (at := text.find(mark, found.end())) >= 0]
    return " ".join(text[begin : min(ends, default=len(text))].split())


def signs(place: str, text: str) -> Iterator[tuple[str, Stated]]:
    """What a line says of the sign of an angle or of r: "positive with the bow to port", "r positiv nach Backbord drehend"."""
    for m in _FORMULA.finditer(text):
        minus = (m["v"] or m["b"] or "+") in "-\u2212"
        formula = _SIGNED["axes.beta"][3].format("-" if minus else "+")
        yield FORMULA, Stated(formula, f'{place}: "{" ".join(m[0].split())}"', offered=True)
    for clause in re.split(r";|,\s|\.\s", text):
        signs = {m[1].casefold() for m in re.finditer(r"(?i)(?<![^\W_])(positi|negati)[vf]", clause)}
        if len(signs) != 1:
            continue
        where, turned = f'{place}: "{" ".join(clause.split())}"', "negati" in signs
        for key, (names, one, other, formula) in _SIGNED.items():
            if not re.search(rf"(?i)(?<![^\W_])(?:{names})(?![^\W_])", clause):
                continue
            side = re.search(
                rf"(?i)(?<![^\W_])(?:{_BOW}|(?P<flow>{_FLOW}))(?![^\W_])\W*(?:\w+\s+){{0,3}}?(?:(?P<one>{one})|(?P<other>{other}))(?![^\W_])",
                clause,
            )
            if side:
                # With the bow to starboard of the course the body moves to its port side, and the flow comes from there.
                minus = (bool(side["one"]) != turned) != bool(side["flow"])
                yield key, Stated(formula.format("-" if minus else "+"), where, offered=True)
        sides = {
            bool(m["one"])
            for m in re.finditer(
                rf"(?i)(?<![^\W_])(?:(?P<one>{_SIGNED['axes.beta'][1]})|{_SIGNED['axes.beta'][2]})(?![^\W_])", clause
            )
        }
        rate = re.search(rf"(?i)(?<![^\W_])(?:{_RATE})(?![^\W_'])", clause)
        if (
            rate
            and len(sides) == 1
            and not re.search(rf"(?i)cent(?:re|er)|mittelpunkt|kreis|{_SIGNED['axes.beta'][0]}", clause)
        ):
            yield TURN_OF_R, Stated("starboard" if sides.pop() != turned else "port", where, offered=True)
