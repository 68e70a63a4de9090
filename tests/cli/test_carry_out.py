from __future__ import annotations

import sys
import threading

import pytest
import typer

from coeflab.cli.run import carry_out
from coeflab.report import rendered
from coeflab.study.study import Plan
from coeflab.tables.importers import PlannedTable


def test_the_report_is_drawn_with_one_thread_on_a_terminal(write_campaign, tmp_path, monkeypatch, capsys):
    """Drawing is shared among cores only while no other thread, such as a progress display's, is there."""
    threads = []
    monkeypatch.setattr(rendered, "rendered", lambda study: threads.append(threading.active_count()) or {})
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    before = threading.active_count()
    plan = Plan(name="tow", title="Tow", tables=(PlannedTable(write_campaign(), ("slope_at_origin",), {}),))
    try:
        carry_out(plan, tmp_path / "out", as_json=False)
    except typer.Exit:
        pytest.fail("the study fails")
    assert threads == [before]
    assert "drawing the report" in capsys.readouterr().err
