"""A folder with reports and parameter files, and the gallery that serves it."""

from __future__ import annotations

import http.client
from functools import cache
from threading import Thread

import pytest

from coeflab.report.document import Document, Section
from coeflab.report.formats import REPORTERS
from coeflab.report.gallery.server import GalleryServer
from tests.cli.test_compare import VALUES, changed, made


@cache
def report(title: str = "Tow of a boat", name: str = "boat") -> bytes:
    section = Section("verdict", "Verdict", ("Fine.",))
    return REPORTERS.load("html").render(Document(title, "", (section,), name, "0123456789abcdef"))["report.html"]


@pytest.fixture
def folder(tmp_path):
    """Two parameter files, a report, and around them what nobody may see."""
    inside = tmp_path / "shown"
    (inside / "boat").mkdir(parents=True)
    (inside / "boat" / "report.html").write_bytes(report())
    (inside / "boat" / "report.pdf").write_bytes(b"%PDF-1.7\n")
    (inside / "a.parameters.json").write_bytes(made(VALUES).to_json())
    b = made(changed(Yv=(-0.040, 0.002)), name="second")
    (inside / "b.parameters.json").write_bytes(b.to_json())
    (inside / ".hidden.json").write_text("secret")
    (inside / ".git").mkdir()
    (inside / ".git" / "report.html").write_bytes(report("secret"))
    (inside / "notes.txt").write_text("secret")
    (tmp_path / "outside.json").write_text("secret")
    (inside / "link.json").symlink_to(tmp_path / "outside.json")
    (inside / "loop.json").symlink_to("loop.json")
    (inside / "up").symlink_to(tmp_path)
    (inside / "alias.parameters.json").symlink_to("a.parameters.json")
    (inside / "disguise.json").symlink_to("notes.txt")
    return inside


@pytest.fixture
def server(folder):
    with GalleryServer(folder, 0) as listening:
        thread = Thread(target=listening.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True)
        thread.start()
        yield listening
        listening.shutdown()
        thread.join(5.0)


@pytest.fixture
def ask(server):
    """A request as it stands; answers with status, headers and body."""

    def asked(path: str, method: str = "GET", **headers: str):
        port = server.server_address[1]
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
        host = headers.pop("Host", f"127.0.0.1:{port}")
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        if host:
            connection.putheader("Host", host)
        for name, value in headers.items():
            connection.putheader(name, value)
        connection.endheaders()
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, answer.headers, body

    return asked
