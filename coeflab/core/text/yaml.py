"""Reading YAML that others wrote: plain data only, no tags, no aliases, bounded size and depth."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import YAML_BYTES, YAML_DEEPEST, YAML_NODES, YAML_NUMBER_LETTERS
from coeflab.core.text.toml import read_text

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)


def parse_yaml(text: str, file: Path | str | None = None) -> dict[str, Any]:
    """The mapping that a document holds.

    Raises
    ------
    InputError
        A tag, an alias (a small file of aliases unfolds to any size), a key that stands twice, more than 60 levels or
        20,000 keys and values, more than one document, no mapping, or no YAML; with its line.
    """
    import yaml

    try:
        try:
            content = _content(
                text, file, getattr(yaml, "CSafeLoader", yaml.SafeLoader)
            )  # libyaml, where PyYAML has it
        except yaml.YAMLError:
            content = _content(text, file, yaml.SafeLoader)  # whose words and lines are the same everywhere
    except yaml.YAMLError as why:
        mark = getattr(why, "problem_mark", None)
        what = str(getattr(why, "problem", None) or getattr(why, "reason", None) or "no YAML")
        raise InputError(shown(what), "YAML", file=file, line=None if mark is None else mark.line + 1) from None
    except (ValueError, RecursionError) as why:
        raise InputError(shown(why), "YAML", file=file) from None
    if not isinstance(content, dict):
        raise InputError("no mapping at the top", "keys and values", file=file)
    return content


def _content(text: str, file: Path | str | None, loader: Any) -> Any:
    import yaml

    stack: list[list[Any]] = []  # of every open collection: its keys so far, None for a list; whether a key comes next
    for count, event in enumerate(yaml.parse(text, Loader=loader)):
        line = event.start_mark.line + 1
        if count > YAML_NODES:
            raise InputError(f"more than {YAML_NODES} keys and values", "a model file", file=file, line=line)
        if isinstance(event, yaml.AliasEvent):
            raise InputError("an alias", "YAML without aliases", file=file, line=line)
        if getattr(event, "tag", None) is not None:
            raise InputError(f"the tag {shown(event.tag)}", "YAML without tags", file=file, line=line)
        if isinstance(event, yaml.ScalarEvent) and event.implicit[0] and _is_long_number(event.value):
            found = f"a number of {len(event.value)} letters"
            raise InputError(found, f"at most {YAML_NUMBER_LETTERS}", file=file, line=line)
        if isinstance(event, yaml.CollectionEndEvent):
            stack.pop()
            continue
        if isinstance(event, yaml.NodeEvent) and stack and stack[-1][0] is not None:
            _count_key(stack[-1], event, file, line)
        if isinstance(event, yaml.CollectionStartEvent):
            if len(stack) == YAML_DEEPEST:
                raise InputError("deep nesting", f"at most {YAML_DEEPEST} levels", file=file, line=line)
            stack.append([set() if isinstance(event, yaml.MappingStartEvent) else None, True])
    return yaml.load(text, Loader=loader)


def _is_long_number(text: str) -> bool:
    return len(text) > YAML_NUMBER_LETTERS and text[0] in "+-.0123456789"


def _count_key(keys: list[Any], event: Any, file: Path | str | None, line: int) -> None:
    """Take one node of a mapping; keys and values follow each other."""
    if keys[1]:
        name = getattr(event, "value", None)
        if name is None:
            raise InputError("a key that is a collection", "a text", file=file, line=line)
        if name in keys[0]:
            raise InputError(f"{shown(name)} a second time", "every key once", file=file, line=line)
        keys[0].add(name)
    keys[1] = not keys[1]


def read_yaml(path: Path) -> dict[str, Any]:
    """The mapping in a file of at most 1 MiB.

    Raises
    ------
    InputError
        As `parse_yaml` and `coeflab.core.text.toml.read_text`.
    """
    return parse_yaml(read_text(path, YAML_BYTES), path)


def number(value: Any) -> float | None:
    """A finite number; None for anything else.

    YAML 1.1 takes ``1e-3`` for a text; it is read as the number that its writer meant. ``yes`` is none.
    """
    if isinstance(value, (bool, list, dict)) or value is None:
        return None
    if isinstance(value, str) and not _NUMBER.fullmatch(value.strip()):
        return None
    try:
        out = float(value)
    except (TypeError, ValueError, OverflowError):
        return None
    return out if abs(out) < float("inf") else None
