"""Files that want to harm or that are broken: one clear error, exit code 2, soon and in little memory."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from coeflab.core.errors import CoeflabError
from coeflab.formats.model_files import read_model_file
from tests.cli.conftest import COEFLAB

DATA = Path(__file__).parents[1] / "formats" / "data"
LAUV = (DATA / "lauv.urdf.xacro").read_bytes()
GLIDER = (DATA / "tethys_like.sdf").read_bytes()
BLUEROV = (DATA / "bluerov2_heavy.yml").read_bytes()
BLUEROV_M = (DATA / "bluerov2_heavy.m").read_bytes()
SAMPLE = (Path(__file__).parents[1] / "data" / "parameters_1_2.json").read_bytes()
LAUGHS = b"".join(b'<!ENTITY a%d "%s">' % (i, b"&a%d;" % (i - 1) * 10) for i in range(1, 10))

HOSTILE = {
    "laughs.sdf": b'<?xml version="1.0"?><!DOCTYPE l [<!ENTITY a0 "lol">' + LAUGHS + b']><sdf version="1.9">&a9;</sdf>',
    "external.sdf": b'<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><sdf version="1.9"><model>&x;</model></sdf>',
    "entity.sdf": b'<sdf version="1.9">&x;</sdf>',
    "deep.sdf": b"<sdf>" + b"<a>" * 100_000,
    "wide.sdf": b"<sdf>" + b"<a/>" * 1_500_000 + b"</sdf>",
    "plugins.sdf": b"<x>" + b"<plugin " * 1_000_000,
    "twice.sdf": GLIDER.replace(b"<xDotU>-5</xDotU>", b"<xDotU>-5</xDotU><xDotU>-50</xDotU>"),
    "nan.sdf": GLIDER.replace(b">1025<", b">nan<"),
    "inf.xacro": LAUV.replace(b"-2.4 0 0 0 0 0", b"inf 0 0 0 0 0"),
    "huge.xacro": LAUV.replace(b"-2.4 0 0 0 0 0", b"1e400 0 0 0 0 0"),
    "truncated.xacro": LAUV[:1500],
    "utf16.xacro": LAUV.decode().encode("utf-16"),
    "utf16-without-mark.xacro": LAUV.decode().encode("utf-16-le"),
    "two-values.xacro": LAUV.replace(b"<xacro:property", b'<xacro:property name="mass" value="81"/><xacro:property', 1),
    "aliases.yml": b"dynamics: 1\na: &a [x,x]\nb: &b [*a,*a]\nc: [*b,*b]\n",
    "tag.yml": b'dynamics: !!python/object/apply:os.system ["touch harmed"]\n',
    "deep.yml": b"dynamics: " + b"[" * 100_000,
    "long.yml": b"dynamics: 1\n" + b"".join(b"k%d: 1\n" % i for i in range(90_000)),
    "twice.yml": BLUEROV + b"\nbodies: []\n",
    "nan.yml": BLUEROV.replace(b"rho: {value: 1000", b"rho: {value: .nan"),
    "huge.yml": BLUEROV.replace(b"[13.7,", b"[1e400,"),
    "blank.yml": b"x\n" + b"\n" * 1_000_000,
    "nan.m": BLUEROV_M.replace(b"rho = 1000", b"rho = NaN"),
    "huge.m": BLUEROV_M.replace(b"rho = 1000", b"rho = 1e400"),
    "twice.m": BLUEROV_M + b"\nXu = -99;\n",
    "long.m": b"rho = 1025;\n" + b"Yv = -1;\n" * 100_000,
    "zero.m": b"Yv = \x00\x01;",
    "brackets.m": b"rho = 1025; Yv = " + b"(" * 200_000,
    "twice.json": SAMPLE.replace(b'"name":', b'"name": "a", "name":', 1),
    "nan.json": SAMPLE.replace(b'"density": ', b'"density": NaN, "x": ', 1),
    "huge.json": SAMPLE.replace(b'"density": ', b'"density": 1e400, "x": ', 1),
    "truncated.json": SAMPLE[:2000],
    "deep.json": b'{"a":' * 100_000,
    "zeros.json": b'{"coefficients": [' + b"0," * 10_000_000 + b"0]}",
    "noise.sdf": random.Random(1).randbytes(5000),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_one_error_soon(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(HOSTILE[name])
    begun = time.process_time()
    with pytest.raises(CoeflabError) as caught:
        read_model_file(path)
    assert time.process_time() - begun < 2.0
    message = str(caught.value)
    lines = message.split("\n")  # a line for each of two faults, of which a line each is planted
    assert all(name in line and "expected" in line for line in lines)
    assert len(lines) <= 2
    assert len(message) < 500


# A process counts the memory of the one that it was forked from, so that a small one has to stand between.
SMALL = """
import resource, subprocess, sys
code = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL).returncode
print(code, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["laughs.sdf", "wide.sdf", "zeros.json", "long.yml"])
def test_memory_stays_bounded(name: str, tmp_path: Path) -> None:
    """The whole process, of which Python and its libraries take some 140 MB."""
    (tmp_path / name).write_bytes(HOSTILE[name])
    asked = [sys.executable, "-c", SMALL, str(COEFLAB), "params", "check", name]
    done = subprocess.run(asked, cwd=tmp_path, capture_output=True, text=True, check=False)
    code, kilobytes = map(int, done.stdout.split())
    assert code == 2
    assert "Traceback" not in done.stderr
    assert kilobytes < 400 << 10


def test_what_is_no_file(tmp_path: Path) -> None:
    sparse = tmp_path / "sparse.sdf"
    with sparse.open("wb") as stream:
        stream.write(b"<sdf>")
        stream.truncate(100 << 20)
    os.mkfifo(tmp_path / "pipe.sdf")
    (tmp_path / "loop.sdf").symlink_to("back.sdf")
    (tmp_path / "back.sdf").symlink_to("loop.sdf")
    for path, found in (
        (tmp_path, "a folder"), (sparse, "104857600 bytes"), (tmp_path / "pipe.sdf", "a device or pipe"),
        (Path("/dev/zero"), "a device or pipe"), (tmp_path / "loop.sdf", ".*no usable path"),
        (tmp_path / "nowhere.sdf", "no such file"),
    ):  # fmt: skip
        with pytest.raises(CoeflabError, match=f"found {found}"):
            read_model_file(path)


def test_the_name_does_not_matter(tmp_path: Path) -> None:
    shutil.copy(DATA / "lauv.urdf.xacro", tmp_path / "lauv.m")
    assert read_model_file(tmp_path / "lauv.m").format == "uuv_simulator"
