"""Points of the body in words: of the moments, of the arm, the centre of gravity: "about x = 1.2 m aft of the nose", "at 0.45 L"."""

from __future__ import annotations

import re

from coeflab.core.text.patterns import atomic
from coeflab.core.units import quantity
from coeflab.tables.dialect import Marks, one_reading
from coeflab.tables.raw_table import Stated

POINT_OF = "axes.reference_point"
# No key of campaign.toml: x, its unit or L, and the point that the words count the moments' point from.
POINT_FROM = "axes.from"
POINT_FRAME = "axes.of_point"  # no key of campaign.toml: the frame that words give a point by its coordinates
UNSAID = "nose?"  # in its place where a share of the length has no point
ARM_FROM = "table.arm_from"  # no key of campaign.toml: where words place the point that R and U are measured to
OF_MOMENTS = "moments-datum"  # in its place where they count from the point of the moments
CENTRE_FROM = "inertia.from"  # no key of campaign.toml: where the words place the centre of gravity
_POINT = re.compile(
    r"(?i)\b(?:moments?\s+(?:are\s+)?(?:taken\s+)?(?:about|around|at|to|ref\w*(?:\s+to)?)|reference\s+point|moment\w*\s+(?:um|bezogen\s+auf)|"
    r"m\.?r\.?[pc]|(?:momenten)?bezugspunkt(?:\s+der\s+momente)?|point\s+de\s+r[ée]f[ée]rence|moments?\s+(?:au|par\s+rapport\s+[àa]u?))"
    + atomic(r"[=:\s]|(?:is|ist|est|the|la|le|den|das|dem|at|bei|am)(?![^\W_])", "between")
    + r"(?P<point>midships?|amidships?|nose|bow|cg|cb|c\.?o\.?g\.?|c\.?o\.?b\.?|"
    r"cent(?:re|er)\s+of\s+(?:gravity|buoyancy)|hauptspant|schwerpunkt|bug|nase|ma[îi]tre[- ]couple|centre\s+de\s+gravit[ée])\b"
)
_MOMENTS_AT = re.compile(
    r"(?i)(?<![^\W_])(?:moments?\s+(?:(?:are|is|were|being|taken|given|computed|referred|reduced|r[ée]duits|calcul[ée]s|pris|bezogen)\s+)*"
    r"(?:about|around|at|to|ref\w*(?:\s+to)?|auf|au|en|[àa]|par\s+rapport\s+[àa]u?)|moment\w*\s+(?:um|bezogen\s+auf)|moment[es]*(?=\W*\d)|x_?(?:ref|mrp|mrc|cofr)"
    r"|(?:moments?\s+)?ref(?:erence|\.)?\s+(?:point|cent(?:re|er))|m\.?r\.?[pc]\.?|cofr|(?:momenten)?bezugspunkt|(?:point|centre)\s+de\s+r[ée](?:f[ée]rence|duction))"
    + atomic(
        r"[\s=:,]|(?:x_?(?:ref|mrp|mrc|cofr)|is|ist|est|the|point|cent(?:re|er)|located|lies|liegt|at|of|for|moments?|der|den|dem|das|momente[ns]?|bei|le|la|un|du|des|situ[ée]|[aàx]"
        r"|an?|(?:force\s+)?balance|cent(?:re|er)|dynamometer|load\s+cell|gauge|sensor|(?:mess)?waage|waagenmitte|messpunkt)(?!/|[^\W_])",
        "between",
    )
)
_TRIPLE = re.compile(r"[(\[]\s*" + r"[\s,;]+".join([r"([-+]?(?:\d[\d.]*|\.\d+)(?:[eE][-+]?\d+)?)"] * 3) + r"\s*[)\]]")
# Unit and frame of coordinates, behind them: "(-2.0, 0.1, 0.3) m, in FRD", "(-2000, 100, 300) [mm]"; "in the CFD model" is no frame.
_TRIPLE_IN = re.compile(
    r"(?i)\s*(?:in\s+(?=[mcf]))?[\[(]?(?P<unit>mm|cm|m|ft|in(?!\s))?(?![^\W_])\]?"
    + atomic(r"[\s,;:(\[]|(?:in|of|im|en|the|body|axes|frame|coordinates)(?![^\W_])", "between")
    + r"(?P<frame>FRD|FLU|CFD(?!\s+(?!axes|frame|coord)\w))?(?![^\W_])"
)
_AT = re.compile(
    r"(?i)(?P<share>x\s*/\s*l\w{0,2}\s*[=:]?\s*)?(?P<number>[-+\u2212]?\d[\d.,]*)\s*[\[(]?(?P<unit>mm|cm|m|ft|in|%\s*(?:of\s+|von\s+|de\s+)?(?:the\s+|der\s+|la\s+)?l(?:ength|[äa]e?nge|ongueur|oa|pp|bp)?|l(?:oa|pp|bp)?)?"
    r"(?![^\W_])[\])]?"
    + atomic(r"[\s,]|(?:measured|gemessen|counted|en)(?![^\W_])", "before")
    + r"(?P<side>aft|behind|abaft|astern|after|hinter|achterlich|achtern|arri[èe]re|derri[èe]re|forward|fwd|ahead|before|in\s+front|vor|avant|devant|from|off|von|vom|ab|du|de|depuis)?"
    + atomic(r"\s|[ld]['’]|(?:of|from|the|dem|der|von|vom|le|la|du|de)(?![^\W_])", "after")
    + r"(?P<point>midships?|amidships?|nose|bow|stem|stern|tail|cg|cb|c\.?o\.?g\.?|c\.?o\.?b\.?|cent(?:re|er)\s+of\s+(?:gravity|buoyancy)|hauptspant|schwerpunkt|bug|nase"
    r"|heck|ma[îi]tre[- ]couple|centre\s+de\s+gravit[ée]|nez|[ée]trave|f\.?p\.?|a\.?p\.?|(?:forward|fore|aft|after)\s+perpendicular|v\.?l\.?|h\.?l\.?)?(?![^\W_])"
)
_HEIGHT = re.compile(
    r"(?i)(?<![^\W_])(?:below|above|under|over|unter\w*|[üu]e?ber|oberhalb|sous|dessus|dessous|[yz])(?![^\W_])"
)
# A name of the point before its place: "about LCB, 2.31 m aft of the nose", "about the CG (x/L = 0.45 from the nose)".
_APPOSED = re.compile(r"(?i)[^\d,(=:;]{1,30}[,(=:]\s*(?:x\s*=\s*)?")
_ABOUT = re.compile(r"(?i)\b(?:about|around|um)\b")
_AXIS = re.compile(r"(?i)[^.;]{0,30}\bax[ei]s\b|\s*(?:the\s+)?[xyz]\b")
# Points at an end of the body, and to which side of them it lies.
_ENDS = {"nose": -1.0, "FP": -1.0, "stern": 1.0, "AP": 1.0}
_POINTS = {"mids": "midship", "amid": "midship", "haup": "midship", "maît": "midship", "mait": "midship", "nose": "nose", "bow": "nose",
           "bug": "nose", "nase": "nose", "cb": "cb", "cob": "cb", "cg": "cg", "cog": "cg", "schw": "cg",
           "nez": "nose", "stem": "nose", "etra": "nose", "étra": "nose", "ster": "stern", "tail": "stern", "heck": "stern", "fp": "FP", "forw": "FP",
           "fore": "FP", "vl": "FP", "ap": "AP", "aft": "AP", "afte": "AP", "hl": "AP"}  # fmt: skip
_NAMED = (
    r"midships?|amidships?|nose|bow|stern|tail|c\.?o?\.?g\.?|c\.?o?\.?b\.?|cent(?:re|er)\s+of\s+(?:gravity|buoyancy)|hauptspant|schwerpunkt|bug|nase|heck"
    r"|ma[îi]tre[- ]couple|centre\s+de\s+gravit[ée]"
)
_ARM = re.compile(
    r"(?i)(?<![^\W_])(?:(?:(?:model|body|hull|vehicle|modell|k(?:ö|oe)rper|maquette)\b[^;.\d]{0,25})?(?<![^\W_])(?:held|mounted|attached|fixed|fastened|clamped|carried|"
    r"suspended|pivoted|befestigt|gehalten|eingespannt|aufgeh(?:ä|ae)ngt|fix[ée]e?|tenue?|attach[ée]e?)(?![^\W_]|\s+(?:ax[ei]s|frame|coord))[^;\d]{0,25}?(?<![^\W_])(?:at|in|by|bei|im|am|beim|[àa]u?|en)"
    r"|(?:path|arm|pivot|attachment|towing|tow|held)[\s-]*point(?:\s+of\s+the\s+arm)?|arm\s+(?:attached|fixed|attaches)(?:\s+(?:at|to))?|point\s+of\s+the\s+arm"
    r"|(?:R|U|radi(?:us|i)|speed)(?:\s+(?:and|und|et)\s+(?:R|U|radius|speed))?(?:\s+in\s+m)?,?\s+(?:(?:is|are|were|was)\s+)?(?:measured|taken|given|counted|those|that|gemessen|mesur[ée]e?s?)"
    r"(?:\s+(?:from\s+the\s+cent(?:re|er)(?:\s+of\s+the\s+\w+)?\s+)?(?:to|at|of|bis|zu|[àa]|jusqu'[àa]u?))?"
    r"|(?:bahn|drehkran|arm|anlenk|befestigungs|aufh(?:ä|ae)nge|f(?:ü|ue)hrungs|schlepp|dreh)punkt|point\s+(?:de\s+(?:fixation|remorquage)|d'attache)"
    r"|point\s+(?:which|that)\s+runs\s+on|(?:holds|carries|h(?:ä|ae)lt|tient)\s+(?:the\s+|das\s+|le\s+|la\s+)?(?:model|body|hull|vehicle|modell|maquette)(?:[^;\d]{0,15}?(?<![^\W_])(?:at|in|by|bei|im|am|[àa]u?|en))?"
    r"|towed\s+(?:at|in|by)|(?:tow(?:ing)?[\s-]*post|strut|sting|yaw\s+(?:axis|cent(?:re|er))|(?:model\s+)?pivots?)(?:,?\s+(?:which|is|attached|mounted|fixed|about|through|at|to))*"
    rf"|(?:R|U|radi(?:us|i)|speed|rayon|vitesse)\s+(?:of|at|to|du|au|bis|von|auf|mesur[ée]e?)(?=(?:\s+(?:the|path|circle|of|au|le|la|du|d[e']|den|dem|der))*\s+(?:{_NAMED}|(?:reference|moment)s?\s+point)(?![^\W_])))(?![^\W_])"
)
_OF_MOMENTS = re.compile(
    r"(?i)(?:the\s+|le\s+|dem\s+|der\s+)?(?:(?:moments?|momenten?|reference|balance)[\s-]*(?:reference[\s-]*)?(?:point|cent(?:re|er)|bezugspunkt)|bezugspunkt"
    r"|point\s+de\s+r[ée]f[ée]rence|m\.?r\.?[pc]\b\.?)(?:\s+of\s+the\s+moments)?"
)
_ARM_NAMED = re.compile(
    r"(?i)[\s=:,]*(?:(?:the|a|its|model'?s?|is|was|are|at|to|of|in|through|path|circle|der|dem|den|bahn|kreis|le|la|du|cercle)\s+)*(?P<point>moments?-datum|"
    + _NAMED
    + r")(?![^\W_])"
)
_CENTRE = re.compile(
    r"(?i)(?<![^\W_])(?:cent(?:re|er)\s+of\s+(?:gravity|mass)|c\.?o?\.?g\.?|[xl]_?c?g|schwerpunkt|centre\s+de\s+gravit[ée])(?![^\W_])"
    r"[^\d;+-]{0,25}(?P<number>[-+]?\d[\d.,]*)\s*(?P<unit>mm|cm|m|ft|in)(?![^\W_])"
    r"(?:\s*(?:en\s+)?(?P<side>aft|behind|abaft|astern|hinter|achterlich|derri[èe]re|arri[èe]re|forward|ahead|before|in\s+front|vor|devant|avant)(?:\s+(?:of|the|dem|der|von|le|la|du|de))*"
    r"\s+(?:l['’])?(?P<point>nose|bow|nez|[ée]trave|midships?|amidships?|hauptspant|bug|nase)(?![^\W_]))?"
)


def _named_point(words: str) -> str:
    """The point of the body that words name."""
    short = words.casefold().replace(".", "")
    return "cb" if "buoy" in short else _POINTS.get(short, _POINTS.get(short[:4], "cg"))


def datum_in_words(place: str, text: str) -> Stated | None:
    """The point of the body that a line takes moments about: "moments about midships"."""
    m = _POINT.search(text)
    return Stated(_named_point(m["point"]), f'{place}: "{" ".join(m[0].split())}"', offered=True) if m else None


def _forward(side: str) -> bool:
    """Whether a word for a side means forward of a point: "ahead of", "before", "vor", "devant"."""
    side = side.casefold()
    return side.startswith(("f", "ah", "be", "in", "vor", "av", "dev")) and side not in ("from", "behind")


def _sided(side: str) -> bool:
    """Whether a word says to which side of a point: "from", "off" and "von" do not."""
    return bool(side) and side.casefold() not in ("from", "off", "von", "vom", "ab", "du", "de", "depuis")


def _share(m: re.Match[str]) -> bool:
    """Whether a number counts in lengths of the body: "x/L = 0.45", "45 % of L"."""
    return bool(m["share"]) or (m["unit"] or "").casefold().startswith(("l", "%"))


def _place(m: re.Match[str], number: float, point: str) -> float:
    """Distance x forward of a point, in m or, of a share, in L: by the side that words give, else by the end that the point is."""
    percent = (m["unit"] or "").startswith("%")
    x = number / (100.0 if percent else 1.0) if _share(m) else quantity(f"{number!r} {m['unit']}", "length")
    if _sided(side := m["side"] or ""):
        return abs(x) if _forward(side) else -abs(x)
    return _ENDS[point] * abs(x) if point in _ENDS else x


def moments_point(place: str, text: str, marks: Marks) -> dict[str, Stated]:
    """What a line says of the point of the moments by a number: "about x = 1.2 m aft of the nose", "CofR (2 0 0)", "0.45 L"."""
    begun = _MOMENTS_AT.search(text)
    if begun is None:
        return {}
    if triple := _TRIPLE.match(text, begun.end()):
        behind = _TRIPLE_IN.match(text, triple.end())
        unit, frame = (behind["unit"], behind["frame"]) if behind else (None, None)
        end = behind.end() if behind and (unit or frame) else triple.end()
        words = f'{place}: "{" ".join(text[begun.start() : end].split())}"'
        by = quantity(f"1 {unit or 'm'}", "length")
        found = {POINT_OF: Stated(tuple(float(f"{float(x) * by:.12g}") for x in triple.groups()), words, offered=True)}
        return found | ({POINT_FRAME: Stated(frame.upper(), words, offered=True)} if frame else {})
    m = _AT.match(text, begun.end())
    if m is None and (named := _APPOSED.match(text, begun.end())):
        m = _AT.match(text, named.end())
        m = m if m and m["point"] else None
    number = None if m is None else one_reading(m["number"].replace("\u2212", "-"), marks)
    bare = re.fullmatch(r"(?i)moment[es]*\W*", begun[0]) is not None
    if m is None or number is None or not (m["unit"] or m["share"]) or (bare and not m["point"]):
        if not _ABOUT.search(begun[0]) or _AXIS.match(text, begun.end()) or datum_in_words(place, text):
            return {}
        words = f'{place}: "{" ".join(text[begun.start() :].split())[:60]}"'
        return {POINT_FROM: Stated(f"0 m {UNSAID}", words, offered=True, contradicted=words)}
    words = f'{place}: "{" ".join(text[begun.start() : m.end()].split())}"'
    point = _named_point(m["point"]) if m["point"] else ""
    x, share, open_ = _place(m, number, point), _share(m), ""
    if _sided(m["side"] or ""):
        open_ = "" if point else "from which point?"
    elif point and point not in _ENDS:
        open_ = "" if m["number"][0] in "+-\u2212" or not x else f"to which side of {point}?"
    elif not point:
        x, open_ = (-abs(x), "") if share else (x, "from which point?")
    if _HEIGHT.search(re.split(r"[;]|\.\s", text[m.end() :])[0]):
        open_ = "and its height: say x, y, z"
    against = f"{words}, {open_}" if open_ else ""
    phrases = Stated(f"{x:.12g} {'L' if share else 'm'} {point or UNSAID}", words, offered=True, contradicted=against)
    return {POINT_FROM: phrases} | ({"axes.datum": Stated(point, words, offered=True)} if point else {})


def arm_point(place: str, text: str, marks: Marks) -> Stated | None:
    """Where a line puts the point of the arm, as x, m or L, and the point it counts from; open where a part lacks."""
    begun = _ARM.search(text)
    if begun is None:
        return None
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
    number = one_reading(m["number"].replace("\u2212", "-"), marks)
    point = OF_MOMENTS if own and m["point"] == "midship" else _named_point(m["point"]) if m["point"] else ""
    signed = m["number"][0] in "+-\u2212" or point in _ENDS
    if number is None or not point or not (_sided(m["side"] or "") or signed) or _HEIGHT.search(plain[m.end() :]):
        return Stated("", line, offered=True, contradicted=line)
    return Stated(f"{_place(m, number, point):.12g} {'L' if _share(m) else 'm'} {point}", line, offered=True)


def centre_of_gravity(place: str, text: str, marks: Marks) -> Stated | None:
    """Where a line puts the centre of gravity of the model, x in m and the point that it counts from, if it names one."""
    m = _CENTRE.search(text)
    size = one_reading(m["number"], marks) if m else None
    if m is None or size is None:
        return None
    x = (1.0 if _forward(m["side"] or "") else -1.0) * quantity(f"{size!r} {m['unit']}", "length")
    point = _POINTS[m["point"].casefold()[:4]] if m["point"] else ""
    return Stated(f"{x:.12g} {point}" if point else "", f'{place}: "{" ".join(m[0].split())}"', offered=True)
