"""Files of a tow folder that are not what coeflab wrote: every key of every file spoilt in every way is one InputError with its place."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from coeflab.core.errors import InputError
from coeflab.core.limits import RECORD_BYTES
from coeflab.tank.folder import KIND, PLAN, read_plan
from coeflab.tank.jobs import (
    JOB,
    STATE,
    Job,
    JobState,
    Progressed,
    Step,
    read_job,
    read_progress,
    write_job,
    write_progress,
)

WRONG: tuple[Any, ...] = (None, True, -1.5, "../../x", "a\0b", [], {"a": {}}, 10**400)


def of_tow(folder: Path) -> Path:
    condition = {
        "name": "b3", "kind": "drift", "half": "", "grid": "medium", "variant": {}, "velocity": [1, 0, 0], "rates": [0, 0, 0],
        "controls": {"dr": 0.1}, "units": [1.0, 2.0],
    }  # fmt: skip
    content = {
        "kind": KIND, "coeflab": "1", "name": "n", "title": "t", "body": "b", "body_file": "b", "body_sha256": "0",
        "surface_sha256": "0", "solver": "external", "version": "", "runner": "local", "jobs": {"b3": "k"}, "conditions": [condition],
    }  # fmt: skip
    (folder / PLAN).write_text(json.dumps(content))
    return folder / PLAN


def of_job(folder: Path) -> Path:
    write_job(Job("b3", folder, "openfoam", (Step("solve", ("true",), watched=True),), ("mesh/medium",), key="k"))
    return folder / JOB


def of_state(folder: Path) -> Path:
    write_progress(
        folder, Progressed(JobState.FINISHED, "k", "solve", 3.0, means={"Y": 1.0}, errors={"Y": 0.1}, remarks=("r",))
    )
    return folder / STATE


FILES: dict[str, tuple[Callable[[Path], Path], Callable[[Path], object]]] = {
    "tow": (of_tow, read_plan), "job": (of_job, read_job), "state": (of_state, read_progress),
}  # fmt: skip


def spoilt(value: Any) -> Iterator[Any]:
    """The content with one place after the other missing or holding something else."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield {k: v for k, v in value.items() if k != key}
            yield from ({**value, key: one} for one in (*WRONG, *spoilt(item)))
            yield {("../" + k if k == key else k): v for k, v in value.items()}
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from ([*value[:i], one, *value[i + 1 :]] for one in (*WRONG, *spoilt(item)))


def complaint(read: Callable[[Path], object], folder: Path) -> str:
    """What an `InputError` says; empty where the file is read."""
    try:
        read(folder)
    except InputError as why:
        return str(why)
    return ""


@pytest.mark.parametrize("name", FILES)
def test_every_key_spoilt_in_every_way(tmp_path: Path, name: str) -> None:
    write, read = FILES[name]
    path = write(tmp_path)
    sound = json.loads(path.read_text())
    read(tmp_path)
    tried = refused = 0
    for content in spoilt(sound):
        path.write_text(json.dumps(content))
        tried += 1
        said = complaint(read, tmp_path)
        refused += bool(said)
        assert not said or str(path) in said
    assert tried > 100
    assert refused > 0.5 * tried  # the others are texts in place of texts


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", "[" * 200_000, '{"a": NaN}', "\udcff", "{}" + " " * RECORD_BYTES]
)
def test_what_is_no_record(tmp_path: Path, name: str, text: str) -> None:
    write, read = FILES[name]
    path = write(tmp_path)
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(InputError, match=path.name.replace(".", r"\.")):
        read(tmp_path)


@pytest.mark.parametrize("name", FILES)
def test_pipes_and_loops_in_place_of_files(tmp_path: Path, name: str) -> None:
    write, read = FILES[name]
    path = write(tmp_path)
    for make in (os.mkfifo, lambda p: p.symlink_to(p.name)):
        path.unlink()
        make(path)
        with pytest.raises(InputError):
            read(tmp_path)
