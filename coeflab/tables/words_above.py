"""What words over a table say of its tests: "v = 1,5 m/s", "rho: 998.8 kg/m3", cells "L", "4.3", "m". Offered, never taken."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise, permutations

from coeflab.core.axes import DIRECTIONS, FRAMES, parse_axes
from coeflab.core.errors import AxesError, InputError
from coeflab.core.units import quantity
from coeflab.tables.column_map import folded
from coeflab.tables.dialect import Marks, Row
from coeflab.tables.raw_table import Stated

_NAMES = {
    "conditions.speed": "v u vm vs speed velocity towingspeed carriagespeed modelspeed uinf vinf geschwindigkeit vitesse "
    "schleppgeschwindigkeit modellgeschwindigkeit",
    "conditions.density": "rho ρ density waterdensity dichte wasserdichte densite massevolumique",
    "scaling.length": "l lpp lbp loa lwl los lua luea length modellength lange laenge modelllange modelllaenge longueur",
    "coefficients.area": "a s aref sref referencearea area flache flaeche bezugsflache bezugsflaeche surface",
    "coefficients.length": "lref cref referencelength referencechord chord bezugslange bezugslaenge",
    "inertia.mass": "m mass masse modelmass modellmasse",
    "conditions.viscosity": "nu ν viscosity kinematicviscosity viskositat viskositaet kinematischeviskositat viscosite",
}
_KEYS = {word: key for key, words in _NAMES.items() for word in words.split()}
_DIMENSIONS = {
    "conditions.speed": "speed", "conditions.density": "density", "scaling.length": "length", "coefficients.area": "area",
    "coefficients.length": "length", "inertia.mass": "mass",
    "conditions.viscosity": "viscosity",
}  # fmt: skip
_LENGTHS = ("lpp", "lbp", "loa", "lwl", "los")
_SAID = re.compile(
    r"(?P<name>[^\W\d_][^=:;,()\[\]]{0,40}?)\s*(?:[\[(](?P<before>[^\[\]()]{1,12})[\])])?\s*(?:=|:)\s*"
    r"(?P<number>[-+]?\d[\d.,' ]*(?:[eE][-+]?\d+)?)\s*[\[(]?(?P<unit>(?:[^\W\d]|[°µ])[^\s,;=\[\])]*)?"
)
_BROAD = r"diam(?:eter|[èe]tre)?|durchmesser|chord|profiltiefe|corde|breadth|beam|breite|largeur|width"
_SYMBOL = r"(?:\s*(?:\([^()]{1,20}\)|\b[A-Za-z]\w{0,4}\b))?\s*(?:=|:|\bof\b|\bis\b|\bvon\b|\bist\b|\bde\b)?\s*"
_SIZES = {
    key: re.compile(
        rf"(?i)(?<![^\W_])(?P<name>{words}){_SYMBOL}(?P<number>\d[\d.,]*)\s*[\[(]?(?P<unit>{unit})(?![^\W_])(?:[\])]?\s*\([^()]{{1,30}}\)"
        rf"|,?\s*(?:(?:the|its|hull|body|model|max\w*|der|le)\s+){{0,3}}(?:{_BROAD})(?![^\W_]|\s*(?:[=:(\d]|\w{{1,3}}\s*=)))?"
    )
    for key, words, unit in (
        ("coefficients.length", r"(?:reference|ref\.?)[\s-]*(?:length|chord)|(?:mean\s+(?:aerodynamic\s+)?)?chord(?:\s+length)?|[lc]_?ref"
         r"|bezugsl(?:ä|ae)nge|profiltiefe|longueur\s+de\s+r[ée]f[ée]rence|corde", "mm|cm|m|ft|in"),
        ("scaling.length", r"overall\s+length|length\s+over\s*all|l_?(?:oa|pp|bp|wl)|l(?:ä|ae)nge\s+(?:ü|ue)ber\s+alles|gesamtl(?:ä|ae)nge"
         r"|longueur\s+hors\s+tout|(?:model|hull|body)\s+length|(?:modell|rumpf)l(?:ä|ae)nge", "mm|cm|m|ft|in"),
        ("conditions.speed", r"(?:(?:carriage|towing|tow|model|test|ship|vehicle|water)\s+)?speed(?!\s+(?:above|below|over|under|up|range|from))"
         r"|(?:schlepp|modell|wagen|fahr)geschwindigkeit|vitesse\s+de\s+(?:remorquage|traction)", "m/s|kn|km/h"),
        ("inertia.mass", r"(?:model\s+)?mass(?:e?\s+of\s+the\s+model)?|(?:modell)?masse(?:\s+du\s+mod[èe]le)?", "kg|t"),
    )
}  # fmt: skip
_ANOTHER_SPEED = re.compile(r"(?i)(?:wind|shaft|sound|propeller|rotor|tip|angular|rotation\w*|air|turn\w*)\s+$")
_SEVERAL = re.compile(r"(?i)\s*(?:,|/|and|und|et|to|bis|or|oder)\s*\d[\d.,]*\s*(?:m/s|kn|km/h)?")
_BY_VOLUME = re.compile(
    r"(?i)(?<![^\W_])(?:V|∇|vol(?:umen?|ume)?|displacement|verdr(?:ä|ae)ngung)\s*(?:\^|\*\*|hoch)?\s*[({]?\s*[12]\s*/\s*3|∇\s*⅔|V⅔"
)
_OVERALL = re.compile(r"(?i)over\s*all|über\s+alles|ueber\s+alles|gesamt|hors|l_?oa")
_ACROSS = re.compile(rf"(?i)(?<![^\W_])(?:{_BROAD})(?![^\W_])|\bc_?ref")
_INERTIA = re.compile(
    r"(?i)(?<!moment of )(?<!moments of )(?<![^\W_])(?:inertia\w*|(?:model\s+)?mass(?:e|es)?|mass\s+forces?|(?:massen)?tr(?:ä|ae)gheit\w*"
    r"|massenkr(?:ä|ae)ft\w*|modellmasse|inertie\w*)(?![^\W_])"
)
_TAKEN_OR_HELD = re.compile(
    r"(?i)(?<![^\W_])(?P<un>un|non-?|in)?(?:(?P<taken>correct(?:ed|ions?)|subtracted|removed|deducted|compensated|korrigiert|korrektur|abgezogen"
    r"|bereinigt|corrig[ée]e?s?|corrections?|soustrait\w*|d[ée]duit\w*)|(?P<held>inclu(?:ded?|des|ding)|contain(?:s|ed|ing)?|enth(?:alten|ält)|inklusive"
    r"|inclus\w*|comprise?s?|contien\w+))(?![^\W_])"
)
_NOT = re.compile(r"(?i)(?<![^\W_])(?:not|no|never|without|nicht|keine?\w*|ohne|sans|pas|non|aucune?)(?![^\W_])|n't\b")
_FREE_OF = re.compile(
    rf"(?i)(?<![^\W_])(?:without|free\s+of|ohne|sans)\s+(?:the\s+|model\W?s?\s+|own\s+|l')*{_INERTIA.pattern[4:]}(?!\s*korrekt|\s+correct)"
)
_CENTRE = re.compile(
    r"(?i)(?<![^\W_])(?:cent(?:re|er)\s+of\s+(?:gravity|mass)|c\.?o?\.?g\.?|[xl]_?c?g|schwerpunkt|centre\s+de\s+gravit[ée])(?![^\W_])"
    r"[^\d;+-]{0,25}(?P<number>[-+]?\d[\d.,]*)\s*(?P<unit>mm|cm|m|ft|in)(?![^\W_])"
    r"(?:\s*(?P<side>aft|behind|abaft|astern|hinter|achterlich|derri[èe]re|forward|ahead|before|in\s+front|vor|devant)(?:\s+(?:of|the|dem|der|von|le|la|du|de))*"
    r"\s+(?P<point>nose|bow|midships?|amidships?|hauptspant|bug|nase)(?![^\W_]))?"
)
_TURNS = re.compile(
    r"(?i)(?<![^\W_])(?:all|every|alle|tous)\b[^,;.=<>]{0,25}?(?:turns?|turning|circles?|kurven|drehkreise?|kreise?|fahrten|runs|girations?)\W+"
    r"(?:(?:are|were|made|to|the|nach|zu|zur|à|sur|gefahren|turning)\s+)*(?P<one>starboard|stbd|port|steuerbord|backbord|tribord|b[âa]bord|right|left)(?![^\W_])"
    r"|cent(?:re|er)\s+of\s+(?:the\s+|a\s+)?(?:circle|turn\w*|rotation)\s+(?:\w+\s+){0,2}?(?:to\s+)?(?P<two>starboard|port|right|left)(?![^\W_])"
)
_ARM = re.compile(
    r"(?i)(?<![^\W_])(?:(?:(?:model|body|hull|vehicle|modell|k(?:ö|oe)rper|maquette)\b[^;.\d]{0,25})?(?<![^\W_])(?:held|mounted|attached|fixed|fastened|clamped|carried|"
    r"suspended|pivoted|befestigt|gehalten|eingespannt|aufgeh(?:ä|ae)ngt|fix[ée]e?|tenue?|attach[ée]e?)(?![^\W_]|\s+(?:ax[ei]s|frame|coord))[^;\d]{0,25}?(?<![^\W_])(?:at|in|by|bei|im|am|beim|[àa]u?|en)"
    r"|(?:arm|pivot|attachment|towing|tow|held)[\s-]*point(?:\s+of\s+the\s+arm)?|arm\s+(?:attached|fixed|attaches)(?:\s+(?:at|to))?|point\s+of\s+the\s+arm"
    r"|(?:R|U|radi(?:us|i)|speed)(?:\s+(?:and|und|et)\s+(?:R|U|radius|speed))?(?:\s+in\s+m)?,?\s+(?:(?:is|are|were|was)\s+)?(?:measured|taken|given|counted|those|that|gemessen|mesur[ée]e?s?)"
    r"(?:\s+(?:from\s+the\s+cent(?:re|er)(?:\s+of\s+the\s+\w+)?\s+)?(?:to|at|of|bis|zu|[àa]|jusqu'[àa]u?))?"
    r"|(?:drehkran|arm|anlenk|befestigungs|aufh(?:ä|ae)nge)punkt|point\s+(?:de\s+fixation|d'attache)|point\s+(?:which|that)\s+runs\s+on)(?![^\W_])"
)
_SIGNED = {
    "axes.beta": (r"(?:drift|sideslip|yaw[\s-]*angle|drift\w*winkel|schiebewinkel|gierwinkel|angle\s+de\s+d[ée]rive)\w*|beta|β", r"starboard|stbd?|right|steuerbord|tribord",
                  r"port|left|backbord|b[âa]bord", "v = {}U sin(beta)"),
    "axes.alpha": (r"(?:angle\s+of\s+(?:attack|incidence)|incidence|pitch(?:\s+angle)?|trim(?:\s+angle)?|anstellwinkel|trimmwinkel|nickwinkel|angle\s+d'attaque)|alpha|α",
                   r"down(?:wards?)?|lowered|unten|bas|tief", r"up(?:wards?)?|raised|oben|hoch|haut", "w = {}U sin(alpha)"),
}  # fmt: skip
_RATE = r"(?-i:r)'?|yaw(?:ing)?\s+rate|rate\s+of\s+turn|turn(?:ing)?\s+rate|drehrate|drehgeschwindigkeit|giergeschwindigkeit|gierrate|vitesse\s+de\s+lacet"
_BOW = r"(?:bow|nose|bug|nase|proue|nez)"
_FLOW = r"(?:flow|water|stream|anstr(?:ö|oe)mung|[ée]coulement)(?:\s+(?:comes?|coming|kommt|vient|is))*\s+(?:from|von|de|du)"
_OF_MOMENTS = re.compile(
    r"(?i)(?:the\s+|le\s+|dem\s+|der\s+)?(?:(?:moments?|momenten?|reference|balance)[\s-]*(?:reference[\s-]*)?(?:point|cent(?:re|er)|bezugspunkt)|bezugspunkt"
    r"|point\s+de\s+r[ée]f[ée]rence|m\.?r\.?[pc]\b\.?)(?:\s+of\s+the\s+moments)?"
)
_ARM_NAMED = re.compile(
    r"(?i)[\s=:,]*(?:(?:the|a|its|model'?s?|is|was|are|at|to|of|in|der|dem|den|le|la|du)\s+)*(?P<point>moments?-datum|midships?|amidships?|nose|bow|stern|tail|c\.?o?\.?g\.?|c\.?o?\.?b\.?"
    r"|cent(?:re|er)\s+of\s+(?:gravity|buoyancy)|hauptspant|schwerpunkt|bug|nase|heck)(?![^\W_])"
)
POINT_OF = "axes.reference_point"
ARM_FROM = "table.arm_from"  # no key of campaign.toml: where words place the point that R and U are measured to
OF_MOMENTS = "moments-datum"  # in its place where they count from the point of the moments
CENTRE_FROM = "inertia.from"  # no key of campaign.toml: where the words place the centre of gravity
LONGEST = 500
POINTED = Marks()
TURN_OF_R = "columns.r"  # no key of campaign.toml: the side to which words say that a positive r turns
BODY_AXES = "forces.axes"  # no key of campaign.toml: the words say that forces count along the body
_BODY = re.compile(
    r"(?i)\b(?:k(?:ö|oe|o)rper|schiffs|boots|modell)fest|\b(?:body|ship|hull|vessel)[- ]?(?:fixed|axes|axis|frame)\b"
    r"|\brep[èe]re\s+(?:li[ée]|du\s+(?:corps|navire))\b|\baxes\s+li[ée]s\b"
)

_TEMPERATURE = re.compile(
    r"(?i)(?P<air>\b(?:air|luft\w*|room|hall\w*|ambient|raum\w*)\b[^,;.]{0,20}|±\s*|\+/-\s*)?"
    r"(?<![\d.,±-])(?P<t>\d{1,2}(?:[.,]\d+)?)\s*(?:°\s*|º\s*|deg\.?\s*|degrees?\s+|grad\s+)C(?:elsius)?\b"
)
_IN_AIR = re.compile(r"(?i)\b(?:wind[- ]?(?:tunnel|kanal)|in\s+air|soufflerie)\b")
_DENSITY = re.compile(
    r"(?i)(?P<other>\b(?:air|luft|foam|hull|model|modell|body|steel|schaum)\w*\b[^,;\d]{0,20})?"
    r"(?<![\w.,])(?P<number>\d[\d.,' ]*?)\s*[\[(]?(?P<unit>(?:kg|g|t)\s?/\s?(?:c?m\^?3|c?m³|l|ml|dm\^?3|dm³)|kg[ *]m(?:\^?-3|⁻³))(?![\w^])"
)
APART = 0.03  # beyond which a density and the water of the words contradict each other
WATER = (900.0, 1100.0)
_SALT = re.compile(
    r"(?i)\b(?:sea\s?-?water|salt\s?-?water|salzwasser|seewasser|meerwasser|eau\s+(?:de\s+mer|sal[ée]e))\b"
)
_FRESH = re.compile(
    r"(?i)\b(?:fresh\s?-?water|tap\s?-?water|s(?:ü|ue)(?:ß|ss)wasser|frischwasser|leitungswasser|eau\s+douce)\b"
    r"|(?P<tank>\btow(?:ing)?[- ]tank\b|schlepp(?:tank|kanal|rinne|versuch)|bassin\s+(?:de\s+)?(?:traction|car[èe]nes?))"
)
_KINDS = {
    "cfd": r"cfd|rans\w*|open\s?foam|star-?ccm\+?|fluent|cfx|su2|simulation|k-?omega|k-?epsilon|sst",
    "experiment": r"tow(?:ing)?[- ]tank|basin|tank|rotating[- ]arm|experiment\w*|measure[dm]\w*|wind[- ]?tunnel|schlepp\w*|versuch\w*|"
    r"messung\w*|drehkran\w*|rundlauf\w*|bassin|essais?|mesur\w*",
    "synthetic": r"synthetic|synthetisch|synth[ée]tique|invented",
}
_POINT = re.compile(
    r"(?i)\b(?:moments?\s+(?:are\s+)?(?:taken\s+)?(?:about|around|at|to|ref\w*(?:\s+to)?)|reference\s+point|moment\w*\s+(?:um|bezogen\s+auf)|"
    r"m\.?r\.?[pc]|(?:momenten)?bezugspunkt(?:\s+der\s+momente)?|point\s+de\s+r[ée]f[ée]rence|moments?\s+(?:au|par\s+rapport\s+[àa]u?))"
    r"(?:[=:\s]|(?:is|ist|est|the|la|le|den|das|dem|at|bei|am)(?![^\W_]))*+(?P<point>midships?|amidships?|nose|bow|cg|cb|c\.?o\.?g\.?|c\.?o\.?b\.?|"
    r"cent(?:re|er)\s+of\s+(?:gravity|buoyancy)|hauptspant|schwerpunkt|bug|nase|ma[îi]tre[- ]couple|centre\s+de\s+gravit[ée])\b"
)
_MOMENTS_AT = re.compile(
    r"(?i)(?<![^\W_])(?:moments?\s+(?:(?:are|is|were|being|taken|given|computed|referred|reduced|r[ée]duits|calcul[ée]s|pris|bezogen)\s+)*"
    r"(?:about|around|at|to|ref\w*(?:\s+to)?|auf|au|en|[àa]|par\s+rapport\s+[àa]u?)|moment\w*\s+(?:um|bezogen\s+auf)|moment[es]*(?=\W*\d)|x_?(?:ref|mrp|mrc|cofr)"
    r"|(?:moments?\s+)?ref(?:erence|\.)?\s+(?:point|cent(?:re|er))|m\.?r\.?[pc]\.?|cofr|(?:momenten)?bezugspunkt|(?:point|centre)\s+de\s+r[ée](?:f[ée]rence|duction))"
    r"(?:[\s=:,]|(?:x_?(?:ref|mrp|mrc|cofr)|is|ist|est|the|point|cent(?:re|er)|located|lies|liegt|at|of|for|moments?|der|den|dem|das|momente[ns]?|bei|le|la|un|du|des|situ[ée]|[aàx])(?!/|[^\W_]))*+"
)
_TRIPLE = re.compile(r"[(\[]\s*" + r"[\s,;]+".join([r"([-+]?(?:\d[\d.]*|\.\d+)(?:[eE][-+]?\d+)?)"] * 3) + r"\s*[)\]]")
_AT = re.compile(
    r"(?i)(?P<share>x\s*/\s*l\w{0,2}\s*[=:]?\s*)?(?P<number>[-+\u2212]?\d[\d.,]*)\s*[\[(]?(?P<unit>mm|cm|m|ft|in|%\s*(?:of\s+|von\s+|de\s+)?(?:the\s+|der\s+|la\s+)?l(?:ength|[äa]e?nge|ongueur|oa|pp|bp)?|l(?:oa|pp|bp)?)?"
    r"(?![^\W_])[\])]?(?:[\s,]|(?:measured|gemessen|counted|en)(?![^\W_]))*+"
    r"(?P<side>aft|behind|abaft|astern|after|hinter|achterlich|achtern|arri[èe]re|derri[èe]re|forward|fwd|ahead|before|in\s+front|vor|avant|devant|from|off|von|vom|ab|du|de|depuis)?"
    r"(?:\s|(?:of|from|the|dem|der|von|vom|le|la|du|de|l')(?![^\W_]))*+"
    r"(?P<point>midships?|amidships?|nose|bow|stem|stern|tail|cg|cb|c\.?o\.?g\.?|c\.?o\.?b\.?|cent(?:re|er)\s+of\s+(?:gravity|buoyancy)|hauptspant|schwerpunkt|bug|nase"
    r"|heck|ma[îi]tre[- ]couple|centre\s+de\s+gravit[ée]|nez|[ée]trave|f\.?p\.?|a\.?p\.?|(?:forward|fore|aft|after)\s+perpendicular|v\.?l\.?|h\.?l\.?)?(?![^\W_])"
)
_HEIGHT = re.compile(
    r"(?i)(?<![^\W_])(?:below|above|under|over|unter\w*|[üu]e?ber|oberhalb|sous|dessus|dessous|[yz])(?![^\W_])"
)
_ENDS = {
    "nose": -1.0,
    "FP": -1.0,
    "stern": 1.0,
    "AP": 1.0,
}  # points at an end of the body, and to which side of them it lies
POINT_FROM = (
    "axes.from"  # no key of campaign.toml: x, its unit or L, and the point that the words count the moments' point from
)
UNSAID = "nose?"  # in its place where a share of the length has no point
_POINTS = {"mids": "midship", "amid": "midship", "haup": "midship", "maît": "midship", "mait": "midship", "nose": "nose", "bow": "nose",
           "bug": "nose", "nase": "nose", "cb": "cb", "cob": "cb", "cg": "cg", "cog": "cg", "schw": "cg",
           "nez": "nose", "stem": "nose", "etra": "nose", "étra": "nose", "ster": "stern", "tail": "stern", "heck": "stern", "fp": "FP", "forw": "FP",
           "fore": "FP", "vl": "FP", "ap": "AP", "aft": "AP", "afte": "AP", "hl": "AP"}  # fmt: skip
_DIRECTION = re.compile(
    r"(?i)(?<![\w'])(?P<axis>[xyz])"
    r"(?:[-\s=:>→+]|(?:axis|achse|positive?|pos\.?|is|points?|nach|zeigt|zur?|to|vers)(?![^\W_]))*+"
    r"\b(?P<to>forwards?|fwd|ahead|bow|vorne?|voraus|bug|avant|aft|astern|backwards?|stern|hinten|achtern|heck|arri[èe]re|starboard|stbd|"
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


def water_density(celsius: float, salinity: float = 0.0) -> float:
    """Density of water at atmospheric pressure, kg/m^3: Kell (1975) of fresh water, UNESCO (1981) with salt, g/kg.

    Parameters
    ----------
    celsius : float
    salinity : float
    """
    t, s = celsius, salinity
    fresh = (
        ((((-280.54253e-12 * t + 105.56302e-9) * t - 46.170461e-6) * t - 7.9870401e-3) * t + 16.945176) * t + 999.83952
    ) / (1.0 + 16.879850e-3 * t)
    first = (((5.3875e-9 * t - 8.2467e-7) * t + 7.6438e-5) * t - 4.0899e-3) * t + 8.24493e-1
    second = (-1.6546e-6 * t + 1.0227e-4) * t - 5.72466e-3
    return float(fresh + first * s + second * s**1.5 + 4.8314e-4 * s * s)


def of_the_test(texts: Iterable[tuple[str, str]], marks: Marks = POINTED) -> dict[str, Stated]:
    """What words say of the water, the kind of the source, the axes and the point of the moments; offered.

    Parameters
    ----------
    texts : iterable of (place, text)
        Such as lines over a table with their numbers, or a file's name.
    marks : Marks
        Of the numbers.
    """
    found: dict[str, Stated] = {}
    axes, first = dict[str, str](), ""
    texts = list(texts)

    def note(key: str, value: object, place: str, said: str) -> None:
        found.setdefault(key, Stated(value, f'{place}: "{" ".join(said.split())}"', offered=True))  # type: ignore[arg-type]

    for place, text in texts:
        for kind, words in _KINDS.items():
            if m := re.search(rf"(?i)(?<![^\W_])(?:{words})(?![^\W_])", text):
                note("source.kind", kind, place, m[0])
        if where := _moments_at(place, text, marks):
            if "axes.datum" not in found:
                found |= {key: one for key, one in where.items() if key not in found}
            if (one := found.get(POINT_FROM)) and (other := where.get(POINT_FROM, one)).value != one.value:
                found[POINT_FROM] = replace(one, contradicted=f"{one.place}, but {other.place}")
        elif m := _POINT.search(text):
            note("axes.datum", _named_point(m["point"]), place, m[0])
        for key, said in _of_the_turn(place, text, marks):
            one = found.setdefault(key, said)
            if one.value != said.value and not one.contradicted:
                found[key] = replace(one, contradicted=f"{one.place}, but {said.place}")
        for m in _DIRECTION.finditer(text):
            axes.setdefault(m["axis"].casefold(), _DIRECTIONS[m["to"].casefold()])
            first = first or place
    if density := _density(texts, marks):
        found["conditions.density"] = density
    named = ", ".join(f"{a} {d}" for a, d in sorted(axes.items()))
    if len(axes) >= 2 and (frame := _frame(axes)):
        found["axes.frame"] = Stated(frame, f"{first}: {named}", offered=True)
    elif len(axes) == 3 and len({d for _, d in _opposites(axes.values())}) == 3:
        found["axes.frame"] = Stated(
            "", f"{first}: {named}", offered=True, contradicted=f"{first} is left-handed: {named}"
        )
    return found


def _named_point(words: str) -> str:
    """The point of the body that words name."""
    short = words.casefold().replace(".", "")
    return "cb" if "buoy" in short else _POINTS.get(short, _POINTS.get(short[:4], "cg"))


def _moments_at(place: str, text: str, marks: Marks) -> dict[str, Stated]:
    """What a line says of the point of the moments by a number: "about x = 1.2 m aft of the nose", "CofR (2 0 0)", "0.45 L"."""
    begun = _MOMENTS_AT.search(text)
    if begun is None:
        return {}
    if triple := _TRIPLE.match(text, begun.end()):
        words = f'{place}: "{" ".join(text[begun.start() : triple.end()].split())}"'
        return {POINT_OF: Stated(tuple(map(float, triple.groups())), words, offered=True)}
    m = _AT.match(text, begun.end())
    number = None if m is None else _number(m["number"].replace("\u2212", "-"), marks)
    bare = re.fullmatch(r"(?i)moment[es]*\W*", begun[0]) is not None
    if m is None or number is None or not (m["unit"] or m["share"]) or (bare and not m["point"]):
        return {}
    words = f'{place}: "{" ".join(text[begun.start() : m.end()].split())}"'
    unit = (m["unit"] or "").casefold()
    share = bool(m["share"]) or unit.startswith(("l", "%"))
    if not share:
        x, counted = quantity(f"{number!r} {m['unit']}", "length"), "m"
    else:
        x, counted = number / (100.0 if unit.startswith("%") else 1.0), "L"
    point = _named_point(m["point"]) if m["point"] else ""
    side = (m["side"] or "").casefold()
    ahead = side.startswith(("f", "ah", "be", "in", "vor", "av", "dev")) and side not in ("from", "behind")
    if side and side not in ("from", "off", "von", "vom", "ab", "du", "de", "depuis"):
        x, open_ = (abs(x) if ahead else -abs(x)), "" if point else "from which point?"
    elif point in _ENDS:
        x, open_ = _ENDS[point] * abs(x), ""
    elif point:
        open_ = "" if m["number"][0] in "+-\u2212" or not x else f"to which side of {point}?"
    else:
        x, open_ = (-abs(x), "") if share else (x, "from which point?")
    if _HEIGHT.search(re.split(r"[;]|\.\s", text[m.end() :])[0]):
        open_ = "and its height: say x, y, z"
    against = f"{words}, {open_}" if open_ else ""
    said = Stated(f"{x:.12g} {counted} {point or UNSAID}", words, offered=True, contradicted=against)
    return {POINT_FROM: said} | ({"axes.datum": Stated(point, words, offered=True)} if point else {})


def _density(texts: Sequence[tuple[str, str]], marks: Marks) -> Stated | None:
    """The density that a number with a unit states, else that of the water that words name; open where they contradict."""
    degrees, water, places = None, "", dict[str, str]()
    numbers: list[tuple[float, str]] = []
    in_air = any(_IN_AIR.search(text) for _, text in texts)
    for place, text in texts:
        for m in _DENSITY.finditer(text):
            if (in_air or not m["other"]) and (size := _kg_m3(m["number"], m["unit"], marks)):
                numbers.append((size, f'{place}: "{_near(text, m.start("number"), m.end())}"'))
        if degrees is None and (t := next((m for m in _TEMPERATURE.finditer(text) if not m["air"]), None)):
            degrees = float(t["t"].replace(",", "."))
            places.setdefault("degrees", f'{place}: "{_near(text, t.start("t"), t.end())}"')
        if salt := _SALT.search(text):
            water = "sea"
            places["water"] = f'{place}: "{salt[0]}"'
        elif (fresh := _FRESH.search(text)) and not water:
            water = "fresh"
            places["water"] = f'{place}: "{fresh[0]}"' + ", fresh water" * bool(fresh["tank"])
    if in_air and not water:
        degrees = None
    by_words, how = 0.0, ""
    if water or degrees is not None:
        at = {"sea": 15.0}.get(water, 20.0) if degrees is None else degrees
        by_words = round(water_density(at, 35.0 if water == "sea" else 0.0), 1)
        how = f"{water or 'fresh'} water of {at:g} °C" + ", 35 g/kg of salt" * (water == "sea")
        how += "; " + "; ".join(dict.fromkeys(places.values()))
    if not numbers:
        return Stated(by_words, how, offered=True) if how else None
    size, place = numbers[0]
    other = next((p for s, p in numbers if abs(s / size - 1.0) > 1e-3), "")
    if not other and by_words and abs(size / by_words - 1.0) > APART:
        other = f"{by_words:g} by {how}"
    return Stated(size, place, offered=True, contradicted=f"{place}, but {other}" if other else "")


def _kg_m3(number: str, unit: str, marks: Marks) -> float:
    """A density in SI; of two readings of a number, 1.025 and 1025, that of water; zero where there is none."""
    size = 1000.0 if unit[0] in "gt" or re.search(r"/\s?(?:l|dm)", unit) else 1.0
    value = _number(number, marks)
    if value is None:
        both = [Marks(d, t).number(number.strip()) for d, t in ((".", ","), (",", "."))]
        fit = [v for v in both if v is not None and WATER[0] <= v * size <= WATER[1]]
        value = fit[0] if len(fit) == 1 else 0.0
    return value * size


def _near(text: str, begin: int, end: int) -> str:
    """What was found with the three words before it."""
    return " ".join([*re.split(r"[,;]", text[:begin])[-1].split()[-3:], *text[begin:end].split()])


def _opposites(directions: Iterable[str]) -> Iterator[tuple[str, str]]:
    """Directions with the axis of the body that each lies along."""
    along = {"aft": "forward", "port": "starboard", "up": "down"}
    return ((d, along.get(d, d)) for d in directions)


def _of_the_turn(place: str, text: str, marks: Marks) -> Iterator[tuple[str, Stated]]:
    """What a line says of a rotating test: whether forces hold inertia, where its mass lies, to which side it turns."""
    for clause in re.split(r"[;:]|,\s|\.\s", text):
        said = set(_holds_inertia(clause))
        if said:
            where = f'{place}: "{" ".join(clause.split())}"'
            yield "table.contains_inertia", Stated(True in said, where, True, f"{where} says both" * (len(said) == 2))
    yield from _signs(place, text)
    if (begun := _ARM.search(text)) and (arm := _arm_at(place, text, begun, marks)):
        yield ARM_FROM, arm
    if m := _TURNS.search(text):
        side = _DIRECTIONS[(m["one"] or m["two"]).casefold()]
        yield "table.centre", Stated(side, f'{place}: "{" ".join(m[0].split())}"', offered=True)
    if (m := _CENTRE.search(text)) and (size := _number(m["number"], marks)) is not None:
        ahead = 1.0 if (m["side"] or "").casefold().startswith(("f", "ah", "be", "in", "v", "dev")) else -1.0
        ahead = -1.0 if (m["side"] or "").casefold() == "behind" else ahead
        x = ahead * quantity(f"{size!r} {m['unit']}", "length")
        point = _POINTS[m["point"].casefold()[:4]] if m["point"] else ""
        yield (
            CENTRE_FROM,
            Stated(f"{x:.12g} {point}" if point else "", f'{place}: "{" ".join(m[0].split())}"', offered=True),
        )


def _signs(place: str, text: str) -> Iterator[tuple[str, Stated]]:
    """What a line says of the sign of an angle or of r: "positive with the bow to port", "r positiv nach Backbord drehend"."""
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


def _arm_at(place: str, text: str, begun: re.Match[str], marks: Marks) -> Stated | None:
    """Where a line puts the point of the arm, as x, m or L, and the point it counts from; open where a part lacks."""
    line = f'{place}: "{" ".join(text.split())[:160]}"'
    rest = re.split(r"[;]|\.\s", _OF_MOMENTS.sub(OF_MOMENTS, text[begun.end() :]))[0]
    own = OF_MOMENTS in rest
    plain = rest.replace(OF_MOMENTS, "midship")
    m = next((m for m in _AT.finditer(plain) if (m["point"] or m["side"]) and (m["unit"] or m["share"])), None)
    if m is None:
        if named := _ARM_NAMED.match(rest):
            point = OF_MOMENTS if named["point"] == OF_MOMENTS else _named_point(named["point"])
            return Stated(f"0 m {point}", line, offered=True)
        worded = re.search(r"(?i)\bpoint\b|punkt", begun[0] + " " + rest) or re.match(r"(?i)r\b|radi|arm", begun[0])
        return Stated("", line, offered=True, contradicted=line) if worded else None
    number, unit, side = (
        _number(m["number"].replace("\u2212", "-"), marks),
        (m["unit"] or "").casefold(),
        m["side"] or "",
    )
    point = OF_MOMENTS if own and m["point"] == "midship" else _named_point(m["point"]) if m["point"] else ""
    ahead = side.casefold().startswith(("f", "ah", "be", "in", "vor", "av", "dev")) and side.casefold() not in (
        "from",
        "behind",
    )
    sided = bool(side) and side.casefold() not in ("from", "off", "von", "vom", "ab", "du", "de", "depuis")
    signed = m["number"][0] in "+-\u2212" or point in _ENDS
    if number is None or not point or not (sided or signed) or _HEIGHT.search(plain[m.end() :]):
        return Stated("", line, offered=True, contradicted=line)
    share = bool(m["share"]) or unit.startswith(("l", "%"))
    x = number / (100.0 if unit.startswith("%") else 1.0) if share else quantity(f"{number!r} {m['unit']}", "length")
    x = (abs(x) if ahead else -abs(x)) if sided else _ENDS[point] * abs(x) if point in _ENDS else x
    return Stated(f"{x:.12g} {'L' if share else 'm'} {point}", line, offered=True)


def _holds_inertia(clause: str) -> Iterator[bool]:
    """Whether a clause says that forces hold the model's inertia: "not subtracted", "included"; nothing where it says neither."""
    if not _INERTIA.search(clause):
        return
    verbs = list(_TAKEN_OR_HELD.finditer(clause))
    if not verbs and _FREE_OF.search(clause):
        yield False
    begin = 0
    for m in verbs:
        negated = bool(m["un"]) or bool(_NOT.search(clause, begin, m.start()))
        begin = m.end()
        yield bool(m["held"]) != negated


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


def _number(text: str, marks: Marks) -> float | None:
    """The one reading of a number; None where it has two, 1,025 with a decimal comma and with thousands."""
    plain = text.strip().rstrip(",.")
    for decimal in (marks.decimal, *({".", ","} - {marks.decimal})):
        value = Marks(decimal).number(plain)
        if value is not None:
            certain = decimal == marks.decimal or not re.fullmatch(r"[-+]?[1-9]\d{0,2}[.,]\d{3}", plain)
            return value if certain else None
    return None


def _sentence(cells: Sequence[str]) -> str:
    """Cells as the sentence that the delimiter split, with a comma between words and none beside a number of its own cell."""
    out = ""
    for before, cell in pairwise(["", *(c for c in cells if c)]):
        worded = all(any(map(str.isalpha, c)) for c in (before, cell))
        out += (", " if worded else " " if out else "") + cell
    return out


def _pairs(cells: Sequence[str]) -> Iterable[str]:
    """The texts of a row of cells that may say something: with its own sign, or a name, a number and a unit side by side."""
    yield " ".join(c for c in cells if c)
    for i, (name, number) in enumerate(pairwise(cells)):
        if name and name[0].isalpha() and number[:1].strip("+-").isdigit() | number[1:2].isdigit():
            unit = cells[i + 2] if i + 2 < len(cells) else ""
            yield f"{name.rstrip(' =:')} = {number} {unit}"


def _sizes(text: str, marks: Marks) -> Iterator[tuple[str, str, float, str]]:
    """Key, name, number in SI and words of what a text states with a sign, and of lengths that it states without one."""
    lengths = [(key, m) for key, words in _SIZES.items() for m in words.finditer(text)]
    for key, m in lengths:
        if key == "conditions.speed" and (_ANOTHER_SPEED.search(text[: m.start()]) or _SEVERAL.match(text[m.end() :])):
            continue
        if size := _in_si(m["number"], m["unit"], key, marks):
            short = folded(m["name"])
            overall = key == "scaling.length" and _OVERALL.search(m["name"])
            name = short if short in _LENGTHS else "loa" if overall else ""
            yield key, name, size, m[0]
    spans = [m.span() for _, m in lengths]
    for m in _SAID.finditer(text):
        words = m["name"].split()
        name = next((f for w in (m["name"], words[-1], words[0]) if (f := folded(w)) in _KEYS), "")
        unit = (m["before"] or m["unit"] or "").strip(" .;")
        begun = any(begin < m.end("number") <= end for begin, end in spans)
        if not name or begun or (not unit and len(name) == 1):
            continue
        if size := _in_si(m["number"], unit, _KEYS[name], marks):
            yield _KEYS[name], "loa" if name in ("lua", "luea") else name, size, m[0]


def _in_si(number: str, unit: str, key: str, marks: Marks) -> float:
    """A number above zero in SI; zero where it has none, or two readings."""
    value = _number(number, marks)
    try:
        size = 0.0 if value is None else quantity(f"{value!r} {unit}" if unit else value, _DIMENSIONS[key])
    except InputError:
        return 0.0
    return max(size, 0.0)


def _around(text: str, found: re.Match[str]) -> str:
    """The part between commas that holds what was found."""
    begin = max(text.rfind(mark, 0, found.start()) for mark in ",;:") + 1
    ends = [at for mark in ",;:" if (at := text.find(mark, found.end())) >= 0]
    return " ".join(text[begin : min(ends, default=len(text))].split())


def words_above(rows: Iterable[Row], marks: Marks) -> dict[str, Stated]:
    """What rows over the names of a table say of keys of campaign.toml.

    Parameters
    ----------
    rows : iterable of (line, cells)
        A line of text is one cell.
    marks : Marks
        Of the numbers below.

    Returns
    -------
    dict of str to Stated
        Offered: somebody has to confirm them. In SI. A key that two lines say differently is `contradicted`. A single
        letter without a unit that fits is left out. `BODY_AXES` where the words say that forces count along the body.
    """
    rows = list(rows)
    found, volume = dict[str, Stated](), ""
    for line, cells in rows:
        if (whole := " ".join(c for c in cells if c)[:LONGEST]) and (body := _BODY.search(whole)):
            found.setdefault(BODY_AXES, Stated("body", f'line {line}: "{_around(whole, body)}"', offered=True))
        if m := _BY_VOLUME.search(whole):
            volume = f'line {line}: "{_near(whole, *m.span())}"'
        for key, name, size, part in (
            one for t in dict.fromkeys(t[:LONGEST] for t in _pairs(cells)) for one in _sizes(t, marks)
        ):
            place = f'line {line}: "{" ".join(part.split())}"'
            if key in found and abs(float(str(found[key].value)) / size - 1.0) > 1e-9:
                against = found[key].contradicted or f"{found[key].place}, but {place}"
                found[key] = replace(found[key], contradicted=against)
            found.setdefault(key, Stated(size, place, offered=True))
            if name in _LENGTHS:
                found.setdefault("scaling.length_name", Stated(name.upper(), place, offered=True))
    if "scaling.length" not in found and (by := found.get("coefficients.length")) and (m := _ACROSS.search(by.place)):
        against = f"{by.place} is a {m[0]}, perhaps not the body's length"
        found["scaling.length"] = replace(by, contradicted=against)
    if volume:
        against = f"{volume} speaks of primes by the volume V: for these the length is V^(1/3)"
        length = found.get("scaling.length", Stated("", volume, offered=True))
        found["scaling.length"] = replace(length, contradicted=against)
    told = of_the_test(((f"line {line}", _sentence(cells)[:LONGEST]) for line, cells in rows), marks)
    water = told.get("conditions.density")
    own = found.pop("conditions.density", None)
    if own and not (water and _DENSITY.search(water.place)):  # a number without a unit, or in another one
        far = water is not None and abs(float(str(own.value)) / float(str(water.value)) - 1.0) > APART
        against = f"{own.place}, but {water.value} by {water.place}" if water and far else ""
        told["conditions.density"] = replace(own, contradicted=against)
    return told | found
