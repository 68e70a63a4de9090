"""Options of the shell as keywords of Python: messages are written with ``--options``, and read so where a command runs alone."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

CALLED = {
    "as": "importer", "cb": "centre_of_buoyancy", "cg": "centre_of_gravity", "distance": "distances", "fit": "by", "for": "wanted", "for-review": "review",
    "map": "columns", "option": "options", "set": "settings",
}  # fmt: skip
_OPTIONS = {keyword: option for option, keyword in CALLED.items()}
FLAGS = frozenset({"accept", "accept-loss", "fill", "full", "repair", "sheets", "tables", "wide"})
LISTS = frozenset({"free", "hold"})  # of motions
_OF_READING = {"name": "names", "runs": "run_list"}  # options of the importer of runs, where a value stands behind them
_COMMAND = re.compile(r"coeflab [a-z][a-z-]*\b[^`;]*?(?=`|; |, or |[.:,](?:\s|$)|$)")
_PROSE = "(?:all|and|around|as|at|by|closes|for|if|is|lists|makes|nothing|of|on|one|or|says|shows|states|tells|that|the|to|uses|with)"
_VALUE = """'(?P<single>[^']*)'|"(?P<double>[^"]*)"|(?P<bare>[\\w*/?](?:[^\\s,;).]|[,.](?=\\S))*)"""
_OPTION = re.compile(rf"(?<![\w\"-])--(?P<option>[a-z][a-z-]*)(?![\w-])(?:[ ](?!{_PROSE}\b)(?:{_VALUE}))?")
_speaks = {"shell": False}


@contextmanager
def in_shell() -> Iterator[None]:
    """Within it messages name options."""
    before, _speaks["shell"] = _speaks["shell"], True
    try:
        yield
    finally:
        _speaks["shell"] = before


def spoken(text: str) -> str:
    """A message in the words of whoever reads it: options in a shell, else keywords; whole commands as they are.

    Parameters
    ----------
    text : str

    Examples
    --------
    >>> spoken("Hold the speed: --hold u. Or --accept-loss, --cg and --density 1025.")
    'Hold the speed: hold=["u"]. Or accept_loss=True, centre_of_gravity and density=1025.'
    >>> spoken("`coeflab fit TABLE --next 3`, or --map 'Fy=Y [kN]'")
    '`coeflab fit TABLE --next 3`, or columns={"Fy": "Y [kN]"}'
    """
    if _speaks["shell"] or "--" not in text:
        return text
    text = text.replace(", or by --words FILE.toml", "")  # of the shell alone
    out, end = [], 0
    for command in _COMMAND.finditer(text):
        out += [_OPTION.sub(_keyword, text[end : command.start()]), command[0]]
        end = command.end()
    return "".join((*out, _OPTION.sub(_keyword, text[end:])))


def all_spoken(texts: Iterable[str]) -> tuple[str, ...]:
    """Messages as `spoken`."""
    return tuple(map(spoken, texts))


def option(keyword: str) -> str:
    """A keyword as a shell types it: ``--accept-loss``; `spoken` leads back."""
    return f"--{_OPTIONS.get(keyword, keyword).replace('_', '-')}"


def _keyword(found: re.Match[str]) -> str:
    option = found["option"]
    value = found["single"] or found["double"] or found["bare"]
    name = CALLED.get(option, option.replace("-", "_"))
    if value is None:
        return f"{name}=True" if option in FLAGS else name
    if option in LISTS:
        motions = '", "'.join(value.split(","))
        return f'{name}=["{motions}"]'
    if option in _OF_READING and not value.isdigit():
        return f'options={{"{_OF_READING[option]}": "{value}"}}'
    if option == "set" and "=" in value:
        return value
    several = re.findall(r"([\w.]+)=(\S+)", value)
    pairs = several if len(several) > 1 else [tuple(value.split("=", 1))] if "=" in value else []
    held = ", ".join(f'"{key}": {_typed(rest)}' for key, rest in pairs)
    return f"{name}={{{held}}}" if pairs else f"{name}={_typed(value)}"


def _typed(value: str) -> str:
    return value if re.fullmatch(r"-?[\d.]+(?:e-?\d+)?", value) else f'"{value}"'
