"""Every command on the shipped examples as a person sees it: in a terminal of a stated width."""

from __future__ import annotations

import fcntl
import os
import re
import struct
import subprocess
import sys
import tempfile
import termios
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from threading import Thread

from tests.cli.forked import Forks

ROOT = Path(__file__).parents[2]
HUUV = str(ROOT / "cfd_data" / "huuv" / "huuv.parameters.json")
FILE = "reports/suboff/suboff_fully_appended.parameters.json"  # after ``validate suboff``
_ESCAPE = re.compile(r"\x1b(?:\[[0-9;?]*[A-Za-z]|\][^\x07]*\x07)")
# What is text for machines is not among them: schema, table, --json. The widths of validations and of `added-mass suboff_bare_hull` are
# looked at where test_commands, test_bad_input and test_added_mass run them.
QUICK = (
    "new mine",
    "fit --fit surface --help-options",
    "inspect remus100",
    "formats",
    "formats fits",
    "formats surface",
    "table HUUV --alpha=-4:4:2 --beta=0",
    "compare HUUV HUUV",
    "compare SAMPLE HUUV",
    "added-mass remus100 --method strip",
    "params check HUUV",
    "params check SAMPLE",
    "export HUUV --to gazebo --accept-loss --out exported_gazebo",
    "simulate HUUV",
    "simulate HUUV --manoeuvre zigzag --commands left=30,right=60 --out moved",
    "simulate --help-options SAMPLE",
    "import nothing.csv --out imported",
    "inspect nothing",
    "mass myring_auv",
    "mass nothing",
)
SLOW = (
    "validate urv",
    "validate estimates",
    "vehicle suboff_bare_hull --out made",
    "merge made/suboff_bare_hull.parameters.json suboff_cfd_barehull --out merged",
    "run mine/plan.toml",
    "fit suboff_roddy_2 --symbol Yv --symbol Nv --diagnostics",
    "fit suboff_roddy_2 suboff_roddy_1",
    "fit suboff_cfd_barehull",
    "fit pmm_synthetic --diagnostics",
    "fit huuv_synthetic --fit surface --diagnostics",
    "fit thauv_case_01_synthetic --fit glide_polar",
    "fit flyingfish_water_synthetic --fit manoeuvring_model --diagnostics",
    "inspect suboff_cfd_barehull",
    "inspect pmm_synthetic",
    "inspect DRIFT",
    "inspect suboff_aff8",
    "compare FILE HUUV",
    "simplify huuv_mesh --out simple",
    "params check FILE",
    "export HUUV --to xdyn",
    "export FILE --to mss --accept-loss --out exported_mss",
    "simulate FILE --manoeuvre zigzag",
    "trim HUUV --commands left=60,right=40",
    "tune TUNE --out tuned",
    "uncertainty HUUV --members 40 --cores 1 --commands left=30,right=60",
    "glide thauv",
    "identify moved/zigzag.csv --params HUUV",
    "tow tow_spheroid --matrix TANK --dry-run",
    "tow tow_spheroid --matrix TANK --solver external --out runs/tank",
    "tow runs/tank --status",
    "tow runs/tank --collect",
    "import DRIFT --out imported",
    "import DRIFT --out imported --yes",
    "draw myring_auv --out drawn",
    "derive urv_puma --to latex --out derived",
    "tow suboff_bare_hull --dry-run",
)


@contextmanager
def terminal(columns: int, lines: int = 24) -> Iterator[tuple[str, list[bytes]]]:
    """The name of a pseudo-terminal, and what was written to it; complete once the block is left."""
    near, far = os.openpty()
    fcntl.ioctl(near, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
    heard: list[bytes] = []

    def listen() -> None:
        while True:
            try:
                heard.append(os.read(near, 65536))
            except OSError:  # the other end is closed, which Linux calls an error
                return

    thread = Thread(target=listen)
    thread.start()
    try:
        yield os.ttyname(far), heard
    finally:
        os.close(far)
        thread.join()
        os.close(near)


def colours(forks: Forks, arguments: Sequence[str], folder: Path) -> str:
    """What a command writes to a terminal, letter by letter."""
    with terminal(80) as (name, heard):
        forks.run(arguments, folder, terminal=name)
    return b"".join(heard).decode()


def seen(forks: Forks, arguments: Sequence[str], folder: Path, columns: int = 80) -> tuple[int, str]:
    """Exit code and text of a command in a terminal, colours taken out."""
    with terminal(columns) as (name, heard):
        code = forks.run(arguments, folder, terminal=name).returncode
    text = _ESCAPE.sub("", b"".join(heard).decode().replace("\r\n", "\n"))
    return code, "\n".join(
        line.rpartition("\r")[2] for line in text.split("\n")
    )  # a line that was drawn over is its last state


def too_long(text: str, columns: int = 80) -> list[str]:
    """Lines beyond the width; a path or URL that stands alone on its line is none."""
    return [line for line in text.split("\n") if len(line) > columns and len(line.split()) > 1]


def arguments_of(line: str) -> list[str]:
    """The words of a command, with the files that they stand for."""
    shipped = {"HUUV": HUUV, "TUNE": ROOT / "cfd_data/huuv/tune.toml", "TANK": ROOT / "cfd_data/tank/spheroid.toml",
               "SAMPLE": ROOT / "tests/data/parameters_1_3.json", "DRIFT": ROOT / "coeflab/cli/template/campaign/drift.csv"}  # fmt: skip
    meant = {"FILE": FILE} | {name: str(path) for name, path in shipped.items()}
    return [meant.get(word, word) for word in line.split()]


if __name__ == "__main__":
    import time

    forks = Forks()
    only = sys.argv[1:]
    folder = Path(tempfile.mkdtemp(prefix="survey"))
    print(f"Texts: {folder}")  # noqa: T201
    try:
        for line in (*QUICK, *SLOW):
            if line and all(word in line for word in only):
                start = time.monotonic()
                try:
                    code, text = seen(forks, arguments_of(line), folder)
                except subprocess.TimeoutExpired:
                    print("TIMEOUT", line)  # noqa: T201
                    continue
                lines = text.split("\n")
                (folder / (re.sub(r"\W+", "_", line)[:100] + ".txt")).write_text(text)
                wide = too_long(text)
                print(  # noqa: T201
                    f"{max(map(len, lines)):5d} {len(wide):4d} long of {len(lines):4d}  rc {code} {time.monotonic() - start:5.1f} s  {line}",
                    flush=True,
                )
    finally:
        forks.close()
