"""Runs of ``coeflab`` in processes of their own, forked from an interpreter that has imported it once.

A fresh interpreter spends a second and a half on imports, a forked one none; arguments, folder, output, exit code and the
way out are those of the console script. `test_forked` runs every command both ways.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from select import select

COEFLAB = Path(sys.executable).with_name("coeflab")
PATIENCE = 120.0
AT_IMPORT = ("PYTHON", "NUMBA", "MPL")  # variables that are read when an interpreter starts or a library is imported
SERVER = """
import atexit, gc, importlib, json, os, pkgutil, resource, sys, threading
import coeflab.cli
os.environ.update(dict.fromkeys(coeflab.cli.THREADS, "1"))
for module in pkgutil.walk_packages(coeflab.__path__, "coeflab."):
    try:
        importlib.import_module(module.name)
    except ImportError:
        pass  # of a library that is not installed; the command that needs it says so
import manifold3d, rich.console, scipy.interpolate, scipy.spatial, scipy.stats, trimesh  # which commands import late
from coeflab.report.content import document
from coeflab.report.formats import REPORTERS
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from pathlib import Path
# Checkers of files, fonts and the like are made when they are needed first: here once, not in every command.
REPORTERS.load("html").render(document(run(read_plan(Path(coeflab.cli.__file__).parent / "template" / "plan.toml")), full=False))
answers = os.dup(1)
gc.collect()
gc.freeze()
for line in sys.stdin:
    sys.argv, folder, environment, largest, *files = json.loads(line)
    child = os.fork()
    if not child:
        break
    os.write(answers, b"%d\\n" % child)
    os.write(answers, b"%d\\n" % os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
else:
    sys.exit()
os.close(answers)
for number, file in enumerate((os.devnull, *files)):
    opened = os.open(file, os.O_RDWR)
    os.dup2(opened, number)
    os.close(opened)
if largest >= 0:
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
os.chdir(folder)
os.environ.clear()
os.environ.update(environment)
sys.path[0] = os.path.dirname(sys.argv[0])
sys.stdin = open(0)
if os.isatty(1):  # the streams of the interpreter that waits were opened on something else
    sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False)
try:
    sys.exit(coeflab.cli.main())
except SystemExit as ended:
    if not isinstance(ended.code, int | None):
        raise
    threading._shutdown()
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(ended.code or 0)  # without taking all modules apart, which copies the whole memory
"""


class Forks:
    """Starts processes of ``coeflab``; one at a time."""

    def __init__(self) -> None:
        self._server: subprocess.Popen[bytes] | None = None
        self._at_import = _at_import()

    def run(
        self,
        arguments: Sequence[str | Path],
        folder: Path,
        terminal: str = "",
        *,
        kill: tuple[float, int] = (0.0, 0),
        largest: int = -1,
    ) -> subprocess.CompletedProcess[str]:
        """A process with these arguments in a folder; a fresh interpreter where the environment asks for one.

        With the name of a ``terminal`` it writes there; then the streams of what comes back are empty. ``kill`` is a signal and the seconds after
        which it is sent; no file may grow beyond ``largest`` bytes, as on a full disk.

        Raises
        ------
        subprocess.TimeoutExpired
            After two minutes.
        """
        command = [str(COEFLAB), *map(str, arguments)]
        if _at_import() != self._at_import:
            return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=PATIENCE)
        if self._server is None:
            self._server = subprocess.Popen(
                [sys.executable, "-c", SERVER],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0,
            )  # fmt: skip
        with tempfile.NamedTemporaryFile() as out, tempfile.NamedTemporaryFile() as err:
            self._say(
                json.dumps(
                    [command, str(folder), dict(os.environ), largest, terminal or out.name, terminal or err.name]
                )
            )
            child = int(self._heard())
            try:
                code = int(self._heard(kill[0] or PATIENCE))
            except TimeoutError:
                if kill[1]:
                    os.kill(child, kill[1])
                    return subprocess.CompletedProcess(command, int(self._heard()), "", "")
                os.kill(child, 9)
                self._heard()
                raise subprocess.TimeoutExpired(command, PATIENCE) from None
            return subprocess.CompletedProcess(command, code, _text(out.name), _text(err.name))

    def close(self) -> None:
        """End the interpreter that waits."""
        if self._server is not None:
            self._server.communicate(timeout=10)

    def _say(self, line: str) -> None:
        assert self._server
        assert self._server.stdin
        self._server.stdin.write(f"{line}\n".encode())

    def _heard(self, patience: float | None = None) -> bytes:
        assert self._server
        assert self._server.stdout
        if not select([self._server.stdout], [], [], patience)[0]:
            raise TimeoutError
        return self._server.stdout.readline()


def _at_import() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name.startswith(AT_IMPORT)}


def _text(file: str) -> str:
    """As a pipe that is read as text gives it."""
    return Path(file).read_text()
