"""What is printed: names from files neither steer a terminal nor are read as markup."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from inspect import signature

import pytest

from coeflab.cli import show, vehicle
from coeflab.core.finding import Severity
from coeflab.core.table import Check, Table
from coeflab.law.water import FRESH_WATER
from tests.cli.conftest import COEFLAB, flat
from tests.cli.test_compare import VALUES, made

ACTING = "a\x1b[31mred\x1b[0m\u202eleft\u2066\x07\x9b2J\x7f\r\n\u2028end"
SHOWN = "aU+001B[31mredU+001B[0mU+202EleftU+2066U+0007U+009B2JU+007F   end"
HEBREW = "\u05e9\u05dc\u05d5\u05dd"


def acting(text: str) -> set[str]:
    return {ch for ch in text if not ch.isprintable() and ch != "\n"}


def test_lines_and_errors_show_what_would_act(capsys) -> None:
    show.text(ACTING)
    show.error(ACTING)
    show.text(HEBREW)
    seen = capsys.readouterr()
    assert (flat(seen.out), seen.err) == (flat(f"{SHOWN} {HEBREW}"), f"{SHOWN}\n")


def test_many_lines_stay_lines(capsys) -> None:
    show.lines("one\ntwo\x1b")
    assert capsys.readouterr().out == "one\ntwoU+001B\n"


@pytest.mark.parametrize("terminal", [False, True])
def test_tables_show_what_would_act(capsys, monkeypatch, terminal: bool) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: terminal)
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.setenv("NO_COLOR", "1")
    name = f"[bold]x[/nothing] {ACTING}"
    show.table(Table(name, (ACTING, "n"), ((ACTING, "1"),), (name,)))
    out = capsys.readouterr().out
    assert acting(out) <= ({"\x1b"} if terminal else set())
    assert flat(out).count(flat(SHOWN)) == 4
    assert out.count("[bold]x[/nothing]") == 2
    assert "\x1b[31m" not in out


def test_json_keeps_the_text_and_escapes_what_would_act(capsys) -> None:
    show.json_object({"name": ACTING + HEBREW + "\U000e0041"})
    out = capsys.readouterr().out
    assert acting(out) == set()
    assert HEBREW in out
    assert json.loads(out) == {"name": ACTING + HEBREW + "\U000e0041"}


def test_a_real_command_lets_no_name_act(coeflab, tmp_path) -> None:
    content = json.loads(made(VALUES).to_json()) | {"name": ACTING.replace("\n", ""), "body": ACTING}
    (tmp_path / "a.json").write_text(json.dumps(content), encoding="utf-8")
    (tmp_path / "b.json").write_bytes(made(VALUES).to_json())
    for more in ((), ("--json",)):
        done = coeflab("compare", "a.json", "b.json", *more)
        assert acting(done.stdout + done.stderr) == set()
    missing = coeflab("compare", "a\x1b[31m\u202e.json", "b.json")
    assert missing.returncode == 2
    assert acting(missing.stderr) == set()


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminal there")
def test_a_terminal_gets_no_escape_from_a_name(tmp_path) -> None:
    import pty

    content = json.loads(made(VALUES).to_json()) | {"name": "x\x1b]0;owned\x07[/red]"}
    (tmp_path / "a.json").write_text(json.dumps(content), encoding="utf-8")
    (tmp_path / "b.json").write_bytes(made(VALUES).to_json())  # of another name: files of one are called by their paths
    near, far = pty.openpty()
    command = [str(COEFLAB), "compare", str(tmp_path / "a.json"), str(tmp_path / "b.json")]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=far, stderr=far):
        os.close(far)
        heard = b"".join(iter(lambda: _read(near), b""))
    os.close(near)
    assert b"owned" in heard
    assert b"\x1b]0;" not in heard


def _read(line: int) -> bytes:
    """What came; nothing once the other end is closed, which Linux calls an error."""
    try:
        return os.read(line, 65536)
    except OSError:
        return b""


def test_a_bar_is_drawn_on_a_terminal_and_stays_letters_in_a_pipe(capsys, monkeypatch) -> None:
    table = Table("T", ("", "share"), (("Yv'", "+0.60 #####"), ("Nv'", "+1.60 ########!")), (), frozenset({0, 1}))
    show.table(table)
    assert "+0.60 #####\n" in capsys.readouterr().out
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "80")
    show.table(table)
    assert "\u2588" * 8 + "!" in capsys.readouterr().out


def test_one_default_density_of_water() -> None:
    assert FRESH_WATER.density == show.FRESH_WATER
    assert f"{show.FRESH_WATER:g} kg/m^3" in (signature(vehicle.command).parameters["density"].default.help or "")


def test_many_warnings_are_a_line_a_check(capsys: pytest.CaptureFixture[str]) -> None:
    """Nine of one check are one line with the number of the others; eight stand whole, and so does a failure among them."""
    found = [Check("signs", f"tow_{i}", Severity.WARN, f"Yv' = 0.{i}", "below zero", "Turn it.") for i in range(9)]
    show.findings(found)
    assert capsys.readouterr().out.splitlines()[0] == "warn  signs, tow_0 and 8 more: Turn it."
    show.findings(found[:8])
    whole = capsys.readouterr().out
    assert all(f"Yv' = 0.{i}" in whole for i in range(8))
    show.findings([*found, Check("signs", "out", Severity.FAIL, "Yv' = 0.03", "below zero", "Turn it.")])
    assert "Yv' = 0.03" in capsys.readouterr().out


@pytest.mark.parametrize("blanks", range(1, 60, 7))
def test_a_command_that_goes_on_is_the_same_to_a_shell(blanks: int, capsys: pytest.CaptureFixture[str]) -> None:
    """Columns with blanks, quotes and umlauts, wherever the line ends."""
    words = [
        "coeflab",
        "import",
        "x" * blanks,
        "--map",
        "Lift Monitor=lift [lbf]",
        "--map",
        "Kraft in Längs'richtung=X [N]",
        "--set",
        'a="b  c"=?',
    ]
    show.command_line("Next", shlex.join(words))
    lines = capsys.readouterr().out
    assert shlex.split(lines.removeprefix("Next: ").replace("\\\n", "")) == words
    assert "\\\n" in lines
