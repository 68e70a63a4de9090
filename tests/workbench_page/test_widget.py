"""The same page in a notebook cell."""

from __future__ import annotations

import sys
from types import ModuleType, SimpleNamespace

import pytest

from coeflab.core.errors import InputError
from coeflab.report import widget
from coeflab.report.formats.workbench import data_json, numbers

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

CELL = """async ([module, content, numbers]) => {
  const url = URL.createObjectURL(new Blob([module], { type: "text/javascript" }));
  const { default: cell } = await import(url), given = { content, numbers };
  for (const id of ["one", "two"]) {
    const el = document.createElement("div");
    document.body.append(el);
    cell.render({ model: { get: name => given[name] }, el });
    el.querySelector(".columns").id = id;
  }
}"""


def test_two_cells_of_one_notebook(visit, bench, tmp_path):
    (tmp_path / "cell.html").write_text("<!doctype html><title>notebook</title><body>", encoding="utf-8")
    page = visit((tmp_path / "cell.html").as_uri())
    page.evaluate(CELL, [widget.module(), data_json(bench), numbers()])
    for name in ("one", "two"):
        page.wait_for_selector(f"#{name}[data-state=ready]")
    ids = page.evaluate("Array.from(document.querySelectorAll('[id]'), e => e.id)")
    assert len(ids) == len(set(ids))
    assert "0." in page.locator("#two .big").first.inner_text()
    assert page.heard == []


def test_without_anywidget_the_way_out_is_said(boat, monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    with pytest.raises(InputError, match="anywidget") as refused:
        widget.widget(boat)
    assert "--to workbench" in refused.value.advice


def test_the_widget_holds_script_style_and_data(boat, monkeypatch):
    made, traits = ModuleType("anywidget"), ModuleType("traitlets")
    made.AnyWidget = type("AnyWidget", (), {})
    traits.Unicode = lambda text: SimpleNamespace(tag=lambda sync: text)
    monkeypatch.setitem(sys.modules, "anywidget", made)
    monkeypatch.setitem(sys.modules, "traitlets", traits)
    cell = widget.widget(boat)
    assert "export default" in cell._esm
    assert ".bench" in cell._css
    assert '"choices"' in cell.content
