"""The density of the water in words: "Süßwasser, 12 °C", "rho = 998.8 kg/m3", "sea water"."""

from __future__ import annotations

import re
from collections.abc import Sequence

from coeflab.tables.dialect import Marks, one_reading
from coeflab.tables.raw_table import Stated

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


def density_in_words(texts: Sequence[tuple[str, str]], marks: Marks) -> Stated | None:
    """The density that a number with a unit states, else that of the water that words name; open where they contradict."""
    degrees, water, places = None, "", dict[str, str]()
    numbers: list[tuple[float, str]] = []
    in_air = any(_IN_AIR.search(text) for _, text in texts)
    for place, text in texts:
        for m in _DENSITY.finditer(text):
            if (in_air or not m["other"]) and (size := _kg_m3(m["number"], m["unit"], marks)):
                numbers.append((size, f'{place}: "{with_words_before(text, m.start("number"), m.end())}"'))
        if degrees is None and (t := next((m for m in _TEMPERATURE.finditer(text) if not m["air"]), None)):
            degrees = float(t["t"].replace(",", "."))
            places.setdefault("degrees", f'{place}: "{with_words_before(text, t.start("t"), t.end())}"')
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


def states_density(text: str) -> bool:
    """Whether a text holds a number in a unit of density."""
    return bool(_DENSITY.search(text))


def _kg_m3(number: str, unit: str, marks: Marks) -> float:
    """A density in SI; of two readings of a number, 1.025 and 1025, that of water; zero where there is none."""
    size = 1000.0 if unit[0] in "gt" or re.search(r"/\s?(?:l|dm)", unit) else 1.0
    value = one_reading(number, marks)
    if value is None:
        both = [Marks(d, t).number(number.strip()) for d, t in ((".", ","), (",", "."))]
        fit = [v for v in both if v is not None and WATER[0] <= v * size <= WATER[1]]
        value = fit[0] if len(fit) == 1 else 0.0
    return value * size


def with_words_before(text: str, begin: int, end: int) -> str:
    """What was found with the three words before it."""
    return " ".join([*re.split(r"[,;]", text[:begin])[-1].split()[-3:], *text[begin:end].split()])
