"""Fifteen hostile names of file, body, thruster and datum, through the writers of C, the FMU, Gazebo and xdyn: inert, or refused."""

from __future__ import annotations

import re
import shutil
import subprocess
import zipfile
from io import BytesIO
from pathlib import Path
from xml.etree.ElementTree import (
    fromstring as parse_xml,
)  # any reader: ours refuses the letters of an entity even in a comment

import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.yaml import parse_yaml
from coeflab.formats.c import write as c
from coeflab.formats.fmi import write as fmi
from coeflab.formats.gazebo import write as gazebo
from coeflab.formats.gazebo_plugin import write as gazebo_plugin
from coeflab.formats.xdyn import write as xdyn
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats.of_a_vehicle import driven

NAMES = (
    "*/ int main(void){return system(\"x\");} /*", "??/\n#include \"/etc/passwd\"", "x\\\n#error", "#define TABLES 99", "%s%n%s",
    "\"; DROP TABLE", "</fmiModelDescription>", "<!ENTITY x SYSTEM \"file:///etc/passwd\">&x;", "--><model name='x'/><!--", "]]>",
    "../../../tmp/x", "\x00\x1b]0;x\x07", "\u202e\u2066gnp.exe", "!!python/object/apply:os.system ['x']", "a: [b, {c: &d e, *d ",
)  # fmt: skip
PLAIN = "Plain name"
GCC = shutil.which("gcc")


def of(name: str) -> ParameterFile:
    file = driven()
    thruster = file.thrusters[0].model_copy(update={"name": name})
    scaling = type(file.scaling)(file.scaling.length, name)
    return file.model_copy(update={"name": name, "body": name, "thrusters": (thruster,), "scaling": scaling})


def test_there_are_fifteen() -> None:
    assert len(set(NAMES)) == 15


def bare(text: str) -> str:
    """A source of C without comments and white space."""
    return re.sub(r"\s+", " ", re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL))


@pytest.mark.parametrize("name", NAMES)
def test_c(name: str, tmp_path: Path) -> None:
    files = {n: t.decode("ascii") for n, t in c.render(of(name)).items()}
    assert all(re.fullmatch(r"[A-Za-z]\w{0,62}\.[ch]", n, re.ASCII) for n in files)
    (stem,) = {n.partition(".")[0].removesuffix("_check") for n in files}
    for n, text in c.render(of(PLAIN)).items():
        own = bare(files[n.replace("Plain_name", stem)])
        assert own.upper().replace(stem.upper(), "PLAIN_NAME") == bare(text.decode()).upper()
    if GCC is None:
        return
    for n, text in files.items():
        (tmp_path / n).write_text(text)
    sources = [n for n in files if n.endswith(".c")]
    command = [GCC, "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-trigraphs", "-fsyntax-only", *sources]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", NAMES)
def test_fmi(name: str) -> None:
    """The same variables as of a plain name, but for those of the thruster."""
    try:
        ((written, content),) = fmi.render(of(name)).items()
    except InputError:
        return
    assert re.fullmatch(r"[A-Za-z]\w{0,62}\.fmu", written, re.ASCII)
    with zipfile.ZipFile(BytesIO(content)) as archive:
        assert all(not n.startswith(("/", "\\")) and ".." not in n for n in archive.namelist())
        root = parse_xml(archive.read("modelDescription.xml").decode())
    ((_, plain),) = fmi.render(of(PLAIN)).items()
    with zipfile.ZipFile(BytesIO(plain)) as archive:
        other = parse_xml(archive.read("modelDescription.xml").decode())
    mine, theirs = ([e.tag for e in r.iter()] for r in (root, other))
    assert mine == theirs
    names = [e.get("name") for e in root.iter("ScalarVariable")]
    assert len(set(names)) == len(names)
    assert {n for n in names if "thruster." not in n and "tilt." not in n} == {
        e.get("name")
        for e in other.iter("ScalarVariable")
        if "thruster." not in e.get("name") and "tilt." not in e.get("name")
    }


@pytest.mark.parametrize("target", [gazebo, gazebo_plugin], ids=["gazebo", "gazebo_plugin"])
@pytest.mark.parametrize("name", NAMES)
def test_gazebo(name: str, target: object) -> None:
    theirs = list(target.render(of(PLAIN)).values())  # type: ignore[attr-defined]
    for (written, text), plain in zip(target.render(of(name)).items(), theirs, strict=True):  # type: ignore[attr-defined]
        assert re.fullmatch(r"[A-Za-z]\w{0,70}\.sdf", written, re.ASCII)
        root, other = parse_xml(text.decode()), parse_xml(plain.decode())
        assert [e.tag for e in root.iter()] == [e.tag for e in other.iter()]
        safe = [e.get("name") for e in root.iter() if e.tag in ("model", "link", "joint", "world")]
        assert all(re.fullmatch(r"[A-Za-z]\w*", n or "", re.ASCII) for n in safe)
        assert [e.text for e in root.iter("topic") if not re.fullmatch(r"\w+", e.text or "", re.ASCII)] == []


@pytest.mark.parametrize("name", NAMES)
def test_xdyn(name: str) -> None:
    ((written, text),) = xdyn.render(of(name)).items()
    ((_, plain),) = xdyn.render(of(PLAIN)).items()
    assert re.fullmatch(r"[A-Za-z]\w{0,62}\.yml", written, re.ASCII)
    read, other = parse_yaml(text.decode()), parse_yaml(plain.decode())

    def shape(x: object) -> object:
        if isinstance(x, dict):
            return [shape(v) for v in x.values()]
        return [shape(v) for v in x] if isinstance(x, list) else isinstance(x, str)

    assert list(read) == list(other)
    assert shape(read) == shape(other)
