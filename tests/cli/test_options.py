"""Every option of every command, out of the application itself, with every kind of wrong value: exit code 2, soon, nothing written.

`options.txt` holds valid lines with all options; each wrong value takes the place of a right one in them, so that a command which writes before it
has looked at all options shows. COEFLAB_MATRIX=FILE writes the table of counts, seconds and megabytes.
"""

from __future__ import annotations

import os
import resource
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from coeflab import cli
from coeflab.core.files import shipped
from tests.fuzz.parsers import CORPUS, SAMPLES

LINES = [
    tuple(line.split(" | "))
    for line in Path(__file__).with_name("options.txt").read_text().splitlines()
    if line[0] != "#"
]
SET = [
    "axes.frame=FRD",
    "axes.reference_point=-2 from nose",
    "scaling.length=4 LOA",
    "conditions.density=1000",
    "conditions.speed=2",
]
SLOWEST = 3.0  # s of processor until a wrong value is refused
LONG = "n" * 5000
# Wrong values, by what stands behind an option in the help.
NUMBER = ("x", "nan", "-inf", "1e999", "0x10")
COUNT = ("x", "1.5", "-1", "1e3", "9" * 30)
MEASURE = ("x", "nan", "-inf", "1e999", "0x10", "3 nounit", "3 kg s")
TRIPLE = ("x", "1,2", "1,2,3,4", "nan,0,0", "1e999,0,0")
NAME = ("nope", "../../x", LONG, "<script>", "a\nb")
PAIR = ("x", "=1", "nope=x", LONG)
READ = ("nope/none.csv", "FIFO", "LOOP", "EMPTY", "BINARY", "FOLDER", LONG)
WRITTEN = ("TAKEN/below", "LOOP", LONG)
WRONG: dict[str, tuple[str, ...]] = {
    "FOLDER": WRITTEN, "FILE.csv": WRITTEN, "FILE": READ, "FRD|FLU": NAME, "DENSITY": NUMBER, "SECONDS": (*NUMBER, "-1"), "COUNT": COUNT, "NUMBER": COUNT[:2], "DEGREES": NUMBER,
    "TANK.toml": READ, "BODY": READ, "FILE.toml": READ, "LIST.csv": READ, "PARAMS": READ, "FILE.mplstyle": READ, "CAMPAIGN": NAME, "NAME": NAME, "IMPORTER": NAME,
    "UNIT": NAME, "AXES": NAME, "METHOD": NAME, "WALL": NAME, "FORMATS": NAME, "FORMAT": NAME, "TARGET": NAME, "PLANE": NAME, "convex": NAME,
    "measured|computed": NAME, "c|python|latex|octave": NAME, "u,v,r": NAME, "u": NAME, "Yv,Yr,...": NAME, "SYMBOL": NAME, "POINT": NAME,
    "KEY=VALUE": PAIR, "COLUMN=WHAT": PAIR, "NAME=VALUE": PAIR, "SYMBOL=VALUE": PAIR, "NAME=BOX": PAIR, "EQUATION": ("x", "Yv", "=", "Yv=Yv", LONG),
    "PATTERN": ("{", "b{beta}", "b{beta:parsec}", "{}"), "LENGTH": MEASURE, "SPEED": MEASURE, "MASS": MEASURE, "VOLUME": MEASURE, "TIME": MEASURE,
    "VALUE": MEASURE, "SHARE": MEASURE, "X,Y,Z": TRIPLE, "IX,IY,IZ": TRIPLE, "N,E,D": TRIPLE, "M,M,..": ("x", "nan", "-1", "1e999", "1,,2"),
    "ANGLE": MEASURE, "ANGLE,RATE": (*MEASURE, "30 deg, x", "30 deg, -1 deg/s", "1 m, 1 deg/s"), "RATE": (*NUMBER, "-1"), "FIGURE": NAME, "TABLE": NAME,
    "NAMES": ("x", "t [s]", "t [parsec], u [m/s]", "-,-,-,-,-", LONG),
    "ADDRESS": ("x", "tcp://", LONG), "port": ("x", "-1", "65536", "1.5"),
}  # fmt: skip
# An option whose metavar says less than it takes; `state` of an import and `figure` are files to be written.
BY_NAME: dict[tuple[str, str], tuple[str, ...]] = {
    ("import", "--state"): WRITTEN, ("fit", "--figure"): ("x", "x.nope", "TAKEN/below.svg"), ("vehicle", "--density"): MEASURE,
    ("next", "--to"): ("x", "x.nope", "TAKEN/below.csv"),
    ("params new", "--density"): MEASURE, ("serve", "--port"): WRONG["port"],
}  # fmt: skip
# Words of a person, which may be anything; they are set as they stand, escaped, and name no file but by their letters.
FREE = {
    ("fit", "--length-name"),
    ("params new", "--length-name"),
    ("params new", "--body"),
    ("merge", "--name"),
    ("params new", "--about"),
    ("params new", "--thruster"),
    ("params convert", "--name"),
}
Main = Callable[[list[str]], tuple[int, str]]


def commands() -> Iterator[tuple[str, Any]]:
    """Every command that can be given, by its words."""

    def within(command: Any, words: str) -> Iterator[tuple[str, Any]]:
        below = getattr(command, "commands", None)
        for name, one in (below or {}).items():
            yield from within(one, f"{words} {name}")
        if not below:
            yield words, command

    root: Any = typer.main.get_command(cli.app)
    for name in cli.ORDER:
        yield from within(root.get_command(None, name), name)


def options(command: Any) -> Iterator[Any]:
    """Those that take a value."""
    yield from (o for o in command.params if o.opts[0].startswith("--") and not o.is_flag and not o.hidden)


COMMANDS = dict(commands())


def lines_of(name: str) -> list[tuple[str, list[str]]]:
    lines = [(code, _words(line)) for code, line in LINES]
    return [(code, words) for code, words in lines if words[: len(name.split())] == name.split()]


def _words(line: str) -> list[str]:
    return [
        w for word in line.split() for w in ([w for one in SET for w in ("--set", one)] if word == "SET" else [word])
    ]


def with_files(folder: Path, words: list[str]) -> list[str]:
    """The words of a line, with what its capitals stand for."""
    made = {
        "TABLE": folder / "t.csv", "SHEET": folder / "own.csv", "WORDS": folder / "words.toml", "MAPPING": folder / "mapping.toml", "RUNS": folder / "runs", "LIST": folder / "list.csv", "OUT": folder / "out",
        "MESH": folder / "body.stl", "BOXES": folder / "boxes.toml", "TANK": shipped("cfd_data") / "tank" / "spheroid.toml",
        "STUDY": folder / "study" / "plan.toml", "STYLE": folder / "a.mplstyle", "HUUV": shipped("cfd_data") / "huuv" / "huuv.parameters.json",
        "MOTION": CORPUS / "motion.csv", "CAMPAIGN": "suboff_roddy_2", "FOLDER": folder / "empty", "FIFO": folder / "pipe", "LOOP": folder / "loop",
        "EMPTY": folder / "nothing", "BINARY": folder / "bytes", "TAKEN": folder / "taken", "BENCH": shipped("cfd_data") / "flyingfish_bench_synthetic" / "air.csv",
    }  # fmt: skip
    out: list[str] = []
    for word in words:
        option, equals, value = word.partition("=") if word.startswith("--") else ("", "", word)
        head, slash, rest = value.partition("/")
        out.append(f"{option}{equals}{made.get(head, head)}{slash}{rest}")
    return out


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A folder with every file that a line names."""
    folder = tmp_path / "files"
    folder.mkdir()
    (folder / "t.csv").write_text("beta [deg],Y [N],N [N*m]\n-6,33,11\n-3,16,6\n0,0,0\n3,-16,-6\n6,-33,-11\n")
    (folder / "own.csv").write_text("symbol,value,unit\nYv,-0.03,1\nNv,-0.01,1\n")
    (folder / "mapping.toml").write_text('[columns]\n"Y [N]" = "Y [N]"\n')
    (folder / "words.toml").write_text("")
    (folder / "a.mplstyle").write_text("lines.linewidth: 2\n")
    for name in ("taken", "nothing"):
        (folder / name).write_text("taken"[: 5 * (name == "taken")])
    (folder / "bytes").write_bytes(bytes(range(256)) * 40)
    (folder / "empty").mkdir()
    shutil.copyfile(CORPUS / "body.stl", folder / "body.stl")
    shutil.copytree(Path(cli.__file__).parent / "template", folder / "study")
    for angle in (0, 3, 6):
        shutil.copytree(SAMPLES / "fluent" / "steady", folder / "runs" / f"b{angle}")
    (folder / "boxes.toml").write_text('[[box]]\nname = "mast"\nx = [0.0, 0.5]\ny = [-1.0, 0.0]\nz = [-1.0, 0.0]\n')
    (folder / "list.csv").write_text("run,beta [deg]\nb0,0\nb3,3\nb6,6\n")
    os.mkfifo(folder / "pipe")
    (folder / "loop").symlink_to(folder / "loop")
    return folder


@pytest.fixture
def main(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Main:
    """The command line in this process, in an empty folder: exit code and message."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")

    def run(words: list[str]) -> tuple[int, str]:
        monkeypatch.setattr(sys, "argv", ["coeflab", *words])
        try:
            cli.main()
        except SystemExit as ended:
            return int(ended.code or 0), capsys.readouterr().err
        return 0, capsys.readouterr().err

    return run


def wrong_of(name: str, option: Any) -> tuple[str, ...]:
    key = (name, option.opts[0])
    return () if key in FREE else BY_NAME.get(key) or WRONG[option.metavar]


def test_every_option_has_a_valid_line_and_wrong_values() -> None:
    for name, command in COMMANDS.items():
        for option in options(command):
            assert any(option.opts[0] in words for _, words in lines_of(name)), (
                f"no line of options.txt has {name} {option.opts[0]}"
            )
            assert (name, option.opts[0]) in FREE or wrong_of(name, option), (
                f"what is wrong behind {name} {option.opts[0]}?"
            )


def wrong_lines(name: str, command: Any) -> Iterator[list[str]]:
    """A valid line with one value wrong, or with none."""
    for option in options(command):
        flag = option.opts[0]
        line = next(words for _, words in lines_of(name) if flag in words)
        at = line.index(flag)
        for value in (*wrong_of(name, option), "", " "):
            yield [*line[:at], f"{flag}={value}", *line[at + 2 :]]
        yield [*line[:at], *line[at + 2 :], flag]


@pytest.mark.parametrize("name", [n for n, c in COMMANDS.items() if any(True for _ in options(c))])
def test_wrong_values(name: str, main: Main, place: Path) -> None:
    before = sorted(p.name for p in place.iterdir())
    count, slowest, worst = 0, 0.0, ""
    for words in wrong_lines(name, COMMANDS[name]):
        start = time.process_time()
        code, said = main(with_files(place, words))
        seconds = time.process_time() - start
        shown = " ".join(w[:60] for w in words)
        assert code == 2, (shown, said)
        assert "Traceback" not in said, shown
        assert max(map(len, said.splitlines())) < 2500, shown
        assert list(Path().iterdir()) == [], shown
        assert sorted(p.name for p in place.iterdir()) == before, shown
        count, slowest, worst = count + 1, *max((slowest, worst), (seconds, shown))
    if table := os.environ.get("COEFLAB_MATRIX"):
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> 10
        with Path(table).open("a") as stream:
            stream.write(f"{name} | {count} | {slowest:.2f} | {peak} | {worst}\n")
    assert slowest < SLOWEST, worst


@pytest.mark.slow
@pytest.mark.parametrize(
    "line", [line for line in LINES if line[0] != "-"], ids=lambda line: line[1].partition(" OUT")[0][:60]
)
def test_valid_lines(line: tuple[str, str], main: Main, place: Path) -> None:
    """They are right, so that what is wrong about the lines above is the wrong value alone."""
    words = _words(line[1])
    code, said = main(with_files(place, words))
    assert code == int(line[0]), said
