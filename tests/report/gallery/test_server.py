from __future__ import annotations

import json
import os
import re
import shutil
import socket
from concurrent.futures import ThreadPoolExecutor
from urllib.parse import quote
from xml.etree import ElementTree

import pytest

from coeflab.core.errors import InputError, OutputError
from coeflab.core.files import shipped
from coeflab.report.gallery.server import MOST_COMPARED, GalleryServer
from tests.cli.test_compare import VALUES, made
from tests.report.gallery.conftest import report
from tests.report.studies import ENDLESS, HOSTILE

PAIR = "/compare?file=a.parameters.json&file=b.parameters.json"


def test_the_index_lists_reports_and_parameter_files_and_nothing_secret(ask):
    status, _, body = ask("/")
    page = body.decode()
    assert status == 200
    for word in (
        "Tow of a boat",
        "0123456789abcdef",
        "/file/boat/report.html",
        "/file/boat/report.pdf",
        "second",
    ):
        assert word in page
    assert "Yr'" in re.sub(r"<[^>]*>", "", page)
    for word in ("secret", "outside", ".git", "notes.txt", "<script"):
        assert word not in page


def test_pictures_are_drawings_that_can_do_nothing(ask, folder):
    shutil.copy(shipped("cfd_data") / "huuv" / "huuv.parameters.json", folder)
    assert b'src="/picture/huuv.parameters.json"' in ask("/")[2]
    status, headers, body = ask("/picture/huuv.parameters.json")
    assert (status, headers["Content-Type"]) == (200, "image/svg+xml")
    assert headers["Content-Security-Policy"].startswith("sandbox; default-src 'none'")
    assert body.startswith(b"<svg")
    assert b"law of the file" in body
    assert b"prefers-color-scheme:dark" in body
    assert ElementTree.fromstring(body).tag.endswith("svg")
    for path in (
        "/picture/boat/report.pdf",
        "/picture/nowhere.json",
        "/picture/../outside.json",
        "/picture/link.json",
        "/picture/",
    ):
        assert ask(path)[0] == 404
    (folder / "bad.parameters.json").write_text("{}")
    assert ask("/picture/bad.parameters.json")[0] == 404


def test_a_search_for_a_symbol_shows_its_values(ask):
    page = re.sub(r"<[^>]*>", "", ask("/?q=yr")[2].decode())
    assert "Coefficients 3" in page
    assert "a.parameters.json" in page
    assert "Coefficients" not in re.sub(r"<[^>]*>", "", ask("/?q=boat")[2].decode()).replace("and coefficients", "")


def test_a_search_needs_no_script(ask):
    page = ask("/?q=second")[2].decode()
    assert "b.parameters.json" in page
    assert "a.parameters.json" not in page
    assert 'value="second"' in page
    assert "None that this search finds" in page


def test_files_come_as_they_are(ask, folder):
    for name, kind in (("boat/report.html", "text/html"), ("boat/report.pdf", "application/pdf"),
                       ("a.parameters.json", "application/json")):  # fmt: skip
        status, headers, body = ask(f"/file/{name}")
        assert (status, body) == (200, (folder / name).read_bytes())
        assert headers["Content-Type"].startswith(kind)
        assert int(headers["Content-Length"]) == len(body)


@pytest.mark.parametrize(
    "path", ["/", PAIR, "/file/boat/report.html", "/file/a.parameters.json", "/nowhere", "/file/.."]
)
def test_every_answer_is_closed_up(ask, path):
    for method in ("GET", "HEAD"):
        headers = ask(path, method)[1]
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["X-Frame-Options"] == "DENY"
        assert "default-src 'none'" in headers["Content-Security-Policy"]
        assert "Access-Control-Allow-Origin" not in headers
    if path.startswith("/file/boat"):
        assert headers["Content-Security-Policy"].startswith("sandbox")


@pytest.mark.parametrize("path", ["/", PAIR, "/file/boat/report.html"])
def test_head_is_the_head_of_get(ask, path):
    got, headed = ask(path), ask(path, "HEAD")
    assert headed[0] == got[0]
    assert headed[1]["Content-Length"] == got[1]["Content-Length"] == str(len(got[2]))


@pytest.mark.parametrize("path", ["/", "/file/a.parameters.json", "/nowhere"])
def test_nothing_follows_the_head(server, path):
    port = server.server_address[1]
    with socket.create_connection(("127.0.0.1", port), timeout=10) as line:
        line.sendall(f"HEAD {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        assert line.makefile("rb").read().endswith(b"\r\n\r\n")


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "PROPFIND", "get"])
def test_other_methods_are_refused(ask, method, folder):
    before = sorted(folder.rglob("*"))
    status, headers, _ = ask("/file/a.parameters.json", method)
    assert status == 405
    assert headers["Allow"] == "GET, HEAD"
    assert sorted(folder.rglob("*")) == before


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "127.0.0.1.evil.example:{port}",
             "localhost.evil:{port}", "0.0.0.0:{port}", "[::1]:{port}"]
)  # fmt: skip
def test_other_hosts_are_refused(ask, server, host):
    for path in ("/", "/file/a.parameters.json"):
        status, _, body = ask(path, Host=host.format(port=server.server_address[1]))
        assert status == 403
        assert b"Yv" not in body
        assert b"boat" not in body


def test_localhost_is_this_host(ask, server):
    assert ask("/", Host=f"LOCALHOST:{server.server_address[1]}")[0] == 200


def first_line(server, text: bytes) -> bytes:
    port = server.server_address[1]
    with socket.create_connection(("127.0.0.1", port), timeout=10) as line:
        line.sendall(text.replace(b"{own}", b"127.0.0.1:%d" % port))
        return line.makefile("rb").readline()


# The library that reads headers passes over lines that it cannot read; what stands in them is refused all the same.
@pytest.mark.parametrize("fields", [
    b"Host: {own}\r\nHost: {own}", b"Host: {own}\r\nHost: evil", b"Host: evil\r\nHost: {own}", b"Host: {own}\r\nhost: evil",
    b"Host: {own}\nHost: evil", b"Host: {own}\r\nnonsense\r\nHost: evil", b" Host: evil\r\nHost: {own}",
    b"Host : evil\r\nHost: {own}", b"Host: {own}\r\n evil", b"Host: {own}\rHost: evil", b"X: a\rHost: {own}", b"Host: {own}\0",
    b"Accept: */*",
])  # fmt: skip
@pytest.mark.parametrize("version", [b"1.0", b"1.1"])
def test_a_request_without_one_clear_host_is_a_bad_request(server, fields, version):
    assert b" 400 " in first_line(server, b"GET / HTTP/%s\r\n%s\r\n\r\n" % (version, fields))
    assert b" 200 " in first_line(server, b"GET / HTTP/%s\r\nHost: {own}\r\nAccept:\r\n\r\n" % version)


@pytest.mark.parametrize(
    ("text", "code"),
    [(b"GET /", b"400"), (b"GET http://{own}/ HTTP/1.1\r\nHost: {own}", b"400"), (b"GET http://[ HTTP/1.1\r\nHost: {own}", b"400"),
     (b"GET * HTTP/1.1\r\nHost: {own}", b"400"), (b"GET / HTTP/2.0\r\nHost: {own}", b"505"), (b"\x16\x03\x01 / HTTP/1.1 x", b"400"),
     (b"GET //evil/ HTTP/1.1\r\nHost: {own}", b"404"), (b"GET /file/%5c%2f..%2f HTTP/1.1\r\nHost: {own}", b"404"),
     (b"GET /file/" + b"a/" * 30_000 + b" HTTP/1.1\r\nHost: {own}", b"404"),
     (b"GET /" + b"a" * 70_000 + b" HTTP/1.1\r\nHost: {own}", b"414")],
)  # fmt: skip
def test_odd_requests_get_a_head_and_a_code(server, text, code, capsys):
    assert first_line(server, text + b"\r\n\r\n").split()[:2] == [b"HTTP/1.0", code]
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("text", [b"\r\n\r\n", b"rubbish\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"GET " + b"/" * 70000 + b" HTTP/1.1\r\n\r\n",
                                  b"GET http://evil.example/ HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n"])  # fmt: skip
def test_rubbish_does_no_harm(server, ask, text, capsys):
    port = server.server_address[1]
    with socket.create_connection(("127.0.0.1", port), timeout=10) as line:
        line.sendall(text % port if b"%d" in text else text)
        assert b" 200 " not in line.makefile("rb").readline()
    assert ask("/")[0] == 200
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("path", ["/file/../outside.json", "/file/%2e%2e/outside.json", "/file/..%2Foutside.json", "/file/link.json",
                                  "/file/up/outside.json", "/file/.hidden.json", "/file/.git/report.html", "/file/notes.txt",
                                  "/file//etc/passwd", "/file/a.parameters.json%00", "/../outside.json", "/favicon.ico"])  # fmt: skip
def test_what_is_outside_or_hidden_is_not_there(ask, path):
    status, _, body = ask(path)
    assert status == 404
    assert b"secret" not in body


def test_files_side_by_side(ask):
    page = ask(PAIR)[2].decode()
    assert ">−0.0280<" in page
    assert ">−0.0400<" in page
    assert ">4.24<" in page  # 0.012 / hypot(0.002, 0.002)
    assert page.count("<bdi>apart</bdi>") == 1
    assert page.count("<bdi>within</bdi>") == 3


def test_other_lengths_and_points_are_converted_and_other_datums_refused(ask, folder):
    longer = made(VALUES, name="longer", scaling={"length": 5.0, "length_name": "LOA"})
    other = made(VALUES, name="other", reference_point={"point": [-2.0, 0.0, 0.0], "datum": "stern"})
    (folder / "c.parameters.json").write_bytes(longer.to_json())
    (folder / "d.parameters.json").write_bytes(other.to_json())
    page = ask(f"{PAIR}&file=c.parameters.json&file=d.parameters.json")[2].decode()
    assert "longer converted from" in page
    assert "reference points are measured from other datums" in page
    assert "Nv', Yr', Nr': the reference points" in re.sub(r"<[^>]*>", "", page)


def test_one_file_shows_its_values(ask):
    status, _, body = ask("/compare?file=a.parameters.json")
    assert status == 200
    assert b"choose two or more" in body


@pytest.mark.parametrize(
    ("query", "status"),
    [("", 400), ("&".join(["file=x"] * 200), 400), ("&".join(f"file={i}" for i in range(MOST_COMPARED + 1)), 400),
     ("file=a.parameters.json&file=nowhere.json", 404), ("file=../outside.json", 404), ("file=link.json", 404),
     ("file=boat/report.html", 404), ("file=bad.parameters.json", 422)],
)  # fmt: skip
def test_what_cannot_be_compared_says_why(ask, folder, query, status):
    (folder / "bad.parameters.json").write_text("{}")
    got, _, body = ask(f"/compare?{query}")
    assert got == status
    assert b"secret" not in body
    assert str(folder).encode() not in body


@pytest.mark.parametrize("name", [HOSTILE, ENDLESS[:4000]])
def test_names_of_users_are_text(ask, folder, name):
    (folder / "boat" / "report.html").write_bytes(report(name, name))
    content = json.loads(made(VALUES).to_json()) | {"name": name[:200], "body": name[:200]}
    (folder / "c.parameters.json").write_text(json.dumps(content))
    odd = "<script>alert(1)<" + "\u202e" + ".parameters.json"
    (folder / odd).write_bytes(made(VALUES).to_json())
    for path in ("/", "/?q=" + quote(name[:200]), "/compare?file=c.parameters.json&file=a.parameters.json",
                 "/compare?file=" + quote(quote(odd))):  # fmt: skip
        status, _, body = ask(path)
        assert status == 200
        assert b"<script" not in body
        assert len(body) < 60_000


def test_names_that_are_no_text_are_shown_and_found(ask, folder):
    path = os.fsencode(folder) + b"/\xff\xfe.parameters.json"
    with open(path, "wb") as stream:  # noqa: PTH123
        stream.write(made(VALUES).to_json())
    assert b"/file/%FF%FE.parameters.json" in ask("/")[2]
    assert ask("/file/%FF%FE.parameters.json")[0] == 200


def test_many_at_once_get_the_same(ask):
    with ThreadPoolExecutor(8) as pool:
        pages = list(pool.map(lambda _: ask("/")[2], range(24)))
    assert len(set(pages)) == 1


def test_only_this_machine_can_reach_it(server):
    assert server.server_address[0] == "127.0.0.1"


@pytest.mark.usefixtures("in_a_shell")
def test_a_port_in_use_and_a_folder_that_is_none_say_so(folder, server):
    with pytest.raises(OutputError, match=r"port \d+ of 127\.0\.0\.1 cannot be used.*--port"):
        GalleryServer(folder, server.server_address[1])
    with pytest.raises(InputError, match="no folder"):
        GalleryServer(folder / "a.parameters.json", 0)
