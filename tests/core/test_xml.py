"""XML of others: bombs, entities and depth are refused; our own is escaped."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element

import pytest

from coeflab.core.errors import InputError
from coeflab.core.text import xml
from coeflab.core.text.xml import numbers, parse_xml, read_xml, serialised
from coeflab.formats.uuv_simulator.xacro import Xacro

BOMB = '<!DOCTYPE a [<!ENTITY b "ha"><!ENTITY c "&b;&b;&b;">]><a>&c;</a>'


@pytest.mark.parametrize(
    "text",
    [
        BOMB,
        '<?xml version="1.0"?>\n<!doctype a SYSTEM "file:///etc/passwd">\n<a/>',
        "<a><! ENTITY b></a>",
        "<" + "a><" * 300 + "a/>",
        "<a>" * 1000,
        "<a>&b;</a>",
        "no xml",
    ],
    ids=range(7),
)
def test_dangerous_or_broken_documents_are_refused(text: str) -> None:
    with pytest.raises(InputError):
        parse_xml(text, "m.sdf")


def test_the_line_is_named() -> None:
    with pytest.raises(InputError, match=r"m\.sdf, line 3"):
        parse_xml("<a>\n<b>\n</a>", "m.sdf")
    with pytest.raises(InputError, match="line 2"):
        parse_xml('<?xml version="1.0"?>\n<!DOCTYPE a>\n<a/>', "m.sdf")


def test_size_and_encoding_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "m.sdf"
    path.write_bytes('<?xml version="1.0" encoding="utf-16"?><!DOCTYPE a><a/>'.encode("utf-16"))
    with pytest.raises(InputError, match="UTF-8"):
        read_xml(path)
    path.write_text("<a>" + "x" * 200 + "</a>", encoding="utf-8")
    monkeypatch.setattr(xml, "XML_BYTES", 100)
    with pytest.raises(InputError, match="at most 100 bytes"):
        read_xml(path)


@pytest.mark.parametrize("text", ["-->", "a -- b", "---", "]]>", "\x00\x1b<&>", "é\U0001f6a2", "two\nlines"])
def test_what_is_written_can_be_read(text: str) -> None:
    root = Element("a", name="b")
    root.text = xml.sayable(text)
    back = parse_xml(serialised(root, (text, "-")).decode())
    assert (back.text or "").strip() == xml.sayable(text).strip()


def test_numbers() -> None:
    assert numbers(" 1\n-2.5e0 ", (2,), "a") == (1.0, -2.5)
    for bad in ("1", "1 2 3", "1 x", "1 nan", None):
        with pytest.raises(InputError):
            numbers(bad, (2,), "a")


def xacro(*properties: tuple[str, str], arguments: str = "") -> Xacro:
    inside = "".join(f'<x:property name="{n}" value="{v}"/>' for n, v in properties)
    return Xacro(parse_xml(f'<robot xmlns:x="http://www.ros.org/wiki/xacro">{inside}{arguments}</robot>'))


def test_properties_are_arithmetic() -> None:
    x = xacro(("m", "18"), ("d", "${m / 9}"), ("at", "0 0 ${d}"), arguments='<x:arg name="n" default="hull"/>')
    assert x.text("${m}kg") == "18kg"
    assert x.text("${at}") == "0 0 2.0"
    assert float(x.text("${-d**2 + sqrt(16) * pi}")) == pytest.approx(-4.0 + 4.0 * 3.141592653589793)
    assert x.text("$(arg n)/link") == "hull/link"


def test_properties_cannot_run_or_grow() -> None:
    for text in ("${open('x')}", "${m.__class__}", "${nothing}", "$(arg nothing)", "${1/0}", "${sqrt(-1)}"):
        with pytest.raises(InputError):
            xacro(("m", "18")).text(text)
    with pytest.raises(InputError):
        xacro(("a", "${b}"), ("b", "${a}")).text("${a}")
    grown = [("p0", "0123456789" * 10), *((f"p{i}", f"${{p{i - 1}}}${{p{i - 1}}}") for i in range(1, 25))]
    with pytest.raises(InputError, match="characters"):
        xacro(*grown).text("${p24}")
