"""The gallery's server: this machine only, read only, one folder; reports and parameter files as cards.

A page of some other site could make a browser ask this server for files under a name of its own (DNS rebinding), so the
Host header has to be this machine's. Reports are shown sandboxed: whatever a file contains, it can fetch nothing.

The gallery's own pages: the index with its search, and files side by side. They carry no script.
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import shutil
from collections.abc import Sequence
from functools import cache, lru_cache
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler
from importlib.resources import files
from io import BufferedIOBase
from pathlib import Path
from socketserver import ThreadingTCPServer
from threading import Lock
from typing import Any, BinaryIO, cast
from urllib.parse import parse_qs, urlsplit

from coeflab.core.errors import CoeflabError, InputError, OutputError, shown
from coeflab.core.files import typed
from coeflab.core.table import Table
from coeflab.core.text.bounded import own_text, stream_of
from coeflab.report.formats import page_environment
from coeflab.report.gallery.listing import SERVED, Listing, ParameterEntry, Shelf, fault, place_of
from coeflab.report.markup import cell_html, html
from coeflab.report.notation import keeping, users_texts
from coeflab.report.printable import shortened, visible
from coeflab.report.tables import compared_files
from coeflab.vehicle.comparison import compare
from coeflab.vehicle.parameter_file import ParameterFile

SHOWN, SYMBOLS = 200, 12
DRAWING = Lock()  # of Matplotlib, whose settings are those of the process
EMPTY = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1" role="img"></svg>'
LONGEST, COLUMN = 120, 48


def index(folder: str, whole: Listing, query: str) -> bytes:
    """Reports and parameter files that a query finds.

    Parameters
    ----------
    folder : str
        What the page calls the folder.
    whole : Listing
    query : str
        Empty for everything.
    """
    found, named_ones = whole.having(query), whole.coefficients(query)
    return _page(
        "index",
        coefficients=named_ones[:SHOWN],
        n_coefficients=len(named_ones),
        beside={r.path: whole.files_of(r) for r in found.reports[:SHOWN]},
        title=f"Gallery of {shortened(folder, LONGEST)}",
        query=query,
        reports=found.reports[:SHOWN],
        parameters=found.parameters[:SHOWN],
        n_reports=len(found.reports),
        n_parameters=len(found.parameters),
        more=whole.more,
        empty=not whole.reports and not whole.parameters,
    )


def comparison(tables: Sequence[Table], statements: Sequence[tuple[str, Sequence[str]]], names: Sequence[str]) -> bytes:
    """Tables of files side by side, and what is to be said of each pair.

    Parameters
    ----------
    tables : sequence of Table
    statements : sequence of (str, sequence of str)
        Heading and sentences.
    names : sequence of str
        What is compared.
    """
    several = len(names) > 1
    title = f"Side by side: {', '.join(names)}" if several else names[0]
    return _page("comparison", title=title, tables=tables, statements=statements, alone=not several)


def refusal(code: int, phrase: str, why: str) -> bytes:
    """A page that says why there is nothing.

    Parameters
    ----------
    code, phrase : int, str
        Of HTTP.
    why : str
    """
    return _page("refusal", title=f"{code} {phrase}", why=why)


def policy() -> str:
    """Content-Security-Policy of these pages: their own style, no script, nothing from anywhere."""
    digest = base64.b64encode(hashlib.sha256(_style().encode()).digest()).decode()
    return (
        f"default-src 'none'; img-src 'self' data:; style-src 'sha256-{digest}'; form-action 'self'; base-uri 'none'; "
        "frame-ancestors 'none'"
    )


def picture_of(shelf: Shelf, key: str) -> str:
    """The drawing of a key, an SVG file light and dark: a report's first one, or a parameter file's law with its points.

    Parameters
    ----------
    shelf : Shelf
    key : str
        As it came.

    Returns
    -------
    str
        Empty where the key means nothing that has a drawing.
    """
    svg = shelf.drawing(key)
    if not svg:
        parameters = shelf.parameters(key)
        svg = "" if parameters is None else _law(parameters.to_json())
    head, closing, rest = svg.partition(">")
    return f"{head}{closing}<style>{_colours()}</style>{rest}" if svg else ""


@lru_cache(SHOWN)
def _law(content: bytes) -> str:
    """By the bytes of the file: equal files are drawn once."""
    from coeflab.report.figures.nouns import law_figure

    parameters = ParameterFile.model_validate_json(content)
    with DRAWING, keeping(users_texts(parameters)):
        figure = law_figure(parameters, "law")
    return EMPTY if figure is None else figure.svg


@cache
def _colours() -> str:
    """What the report's style says of the colours of figures, on light and on dark."""
    found = re.findall(r"--fig-(\w+): (#[0-9a-f]{6})", _style())
    names = [name for name, _ in found].index(found[0][0], 1)
    light, dark = (
        "".join(f"--fig-{name}:{colour};" for name, colour in part)
        for part in (found[:names], found[names : 2 * names])
    )
    return f"svg{{{light}}}@media(prefers-color-scheme:dark){{svg{{{dark}}}}}"


def symbols(entry: ParameterEntry) -> Any:
    """The first symbols of a file, and how many more there are."""
    left = len(entry.symbols) - SYMBOLS
    shown = " ".join(cell_html(s) for s in entry.symbols[:SYMBOLS])
    return _safe(shown + (f" and {left} more" if left > 0 else ""))


def named(path: str) -> str:
    """A path to be shown: cut, and without bytes that are no text."""
    return cut(path.encode("utf-8", "replace").decode(), LONGEST)


def cut(text: str, longest: int) -> str:
    """The beginning of a text, with every character seen."""
    return visible(shortened(text, longest))


def spelled(text: str, longest: int) -> Any:
    """The beginning of a text with its symbols, safe to stand in a page."""
    return _safe(html(shortened(text, longest)))


def spelled_cell(text: str, longest: int) -> Any:
    """The same of a table's cell."""
    return _safe(cell_html(shortened(text, longest)))


def _safe(text: str) -> Any:
    from markupsafe import Markup

    return Markup(text)


@cache
def _style() -> str:
    """The report's style and what the gallery adds."""
    report = files("coeflab.report.formats") / "_html"
    sheets = (report / "style.css", report / "symbols.css", files("coeflab.report") / "gallery" / "gallery.css")
    return "\n" + "".join(own_text(sheet) for sheet in sheets)


@cache
def _templates() -> Any:
    folder = files("coeflab.report") / "gallery"
    names = ("frame", "index", "comparison", "refusal")
    result = page_environment({name: own_text(folder / f"{name}.html.j2") for name in names})
    result.filters |= {
        "symbols": symbols, "named": named, "shortened": cut, "spelled": spelled, "spelled_cell": spelled_cell
    }  # fmt: skip
    return result


def _page(template: str, **content: Any) -> bytes:
    text = _templates().get_template(template).render(style=_style(), **content)
    return text.encode("utf-8", "replace")  # type: ignore[no-any-return]


ADDRESS = "127.0.0.1"
MOST_COMPARED, LONGEST_QUERY = 8, 200
SECONDS = 30
FIELD = re.compile(rb"[!#$%&'*+.^_`|~0-9A-Za-z-]+:[^\r\n\0]*\r?\n")
ALWAYS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-cache",
}
POLICIES = {
    ".html": "sandbox allow-scripts allow-downloads; default-src 'none'; img-src data:; "
    "style-src 'unsafe-inline'; script-src 'unsafe-inline' blob:; worker-src blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ".pdf": "default-src 'none'; object-src 'self'; style-src 'unsafe-inline'; frame-ancestors 'none'",
    ".json": "sandbox; default-src 'none'; frame-ancestors 'none'",
    ".svg": "sandbox; default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'",
}


class GalleryServer(ThreadingTCPServer):
    """Listens on 127.0.0.1; ``serve_forever`` answers.

    Parameters
    ----------
    folder : Path
        What is shown.
    port : int
        0 takes any that is free.

    Raises
    ------
    InputError
        There is no such folder.
    OutputError
        The port cannot be had.
    """

    daemon_threads = True
    allow_reuse_address = os.name != "nt"
    request_queue_size = 64

    def __init__(self, folder: Path, port: int) -> None:
        folder = typed(folder)
        if not folder.is_dir():
            raise InputError(f"no folder {shown(folder, 300)}", "the folder of the gallery")
        self.shelf = Shelf(folder.resolve())
        try:
            super().__init__((ADDRESS, port), _Request)
        except OSError as why:
            raise OutputError(
                f"port {port} of {ADDRESS} cannot be used: {why.strerror or why}. "
                "Name another with --port, or take any free one with --port 0."
            ) from None

    @property
    def address(self) -> str:
        """What to type into a browser."""
        return f"http://{ADDRESS}:{self.server_address[1]}/"

    @property
    def hosts(self) -> frozenset[str]:
        """Host headers that mean this server."""
        port = self.server_address[1]
        return frozenset(f"{name}:{port}" for name in (ADDRESS, "localhost")) | (
            frozenset((ADDRESS, "localhost")) if port == 80 else frozenset()
        )

    def handle_error(self, request: object, client_address: object) -> None:
        """A browser that goes away is no news; anything else is."""
        import sys

        if not isinstance(sys.exception(), ConnectionError | TimeoutError):
            super().handle_error(request, client_address)  # type: ignore[arg-type]


class _Heard:
    """A stream that keeps the lines read from it: readers of headers skip what they do not understand."""

    def __init__(self, stream: BinaryIO) -> None:
        self.stream = stream
        self.lines: list[bytes] = []

    def readline(self, most: int = -1) -> bytes:
        self.lines.append(self.stream.readline(most))
        return self.lines[-1]

    @property
    def fields(self) -> list[bytes]:
        """The lines before the empty one."""
        return self.lines[:-1]


class _Request(BaseHTTPRequestHandler):
    server_version, sys_version = "coeflab", ""
    default_request_version = "HTTP/1.0"
    timeout = SECONDS

    def parse_request(self) -> bool:
        """Turn away what is not a look at this machine from this machine."""
        stream, heard = self.rfile, _Heard(cast(BinaryIO, self.rfile))
        self.rfile = cast(BufferedIOBase, heard)
        try:
            if not super().parse_request():
                return False
        finally:
            self.rfile = stream
        hosts = self.headers.get_all("Host", [])
        if len(hosts) != 1 or not all(FIELD.fullmatch(line) for line in heard.fields):
            self._refuse(
                HTTPStatus.BAD_REQUEST, "A request needs one Host, and one name and value on every header line."
            )
            return False
        if hosts[0].strip().lower() not in cast(GalleryServer, self.server).hosts:
            self._refuse(HTTPStatus.FORBIDDEN, "This gallery answers to 127.0.0.1 and localhost only.")
            return False
        if self.command not in ("GET", "HEAD"):
            self._refuse(HTTPStatus.METHOD_NOT_ALLOWED, "This gallery is read only.", {"Allow": "GET, HEAD"})
            return False
        return True

    def do_GET(self) -> None:
        """Answer with the index, files side by side, or a file."""
        if not self.path.startswith("/"):
            self._refuse(HTTPStatus.BAD_REQUEST, "This gallery is no proxy.")
            return
        where = urlsplit(self.path)
        asked = parse_qs(where.query, max_num_fields=100) if where.query.count("&") < 100 else {}
        shelf = cast(GalleryServer, self.server).shelf
        if where.path == "/":
            query = asked.get("q", [""])[0][:LONGEST_QUERY].strip()
            self._page(HTTPStatus.OK, index(shelf.folder.name or str(shelf.folder), shelf.listing(), query))
        elif where.path == "/compare":
            self._compare(shelf, list(dict.fromkeys(asked.get("file", []))))
        elif where.path.startswith("/picture/"):
            self._picture(shelf, where.path.removeprefix("/picture/"))
        elif where.path.startswith("/file/"):
            self._file(place_of(shelf.folder, where.path.removeprefix("/file/")))
        else:
            self._refuse(HTTPStatus.NOT_FOUND, "There is no such page.")

    def do_HEAD(self) -> None:
        """The head of what GET answers."""
        self.do_GET()

    def _compare(self, shelf: Shelf, keys: list[str]) -> None:
        if not 1 <= len(keys) <= MOST_COMPARED:
            why = f"{len(keys) or 'No'} files are chosen; choose two to {MOST_COMPARED} parameter files to compare."
            self._refuse(HTTPStatus.BAD_REQUEST, why)
            return
        read = []
        for key in keys:
            try:
                read.append(shelf.parameters(key))
            except CoeflabError as why:
                path = place_of(shelf.folder, key)
                self._refuse(HTTPStatus.UNPROCESSABLE_ENTITY, fault(why, path) if path else "It cannot be read.")
                return
        found = [p for p in read if p is not None]
        if len(found) < len(keys):
            self._refuse(HTTPStatus.NOT_FOUND, "There is no such parameter file here.")
            return
        names = _apart([shortened(p.name, COLUMN) for p in found])
        pairs = [compare(found[0], other) for other in found[1:]]
        tables = [compared_files.side_by_side(found[0], pairs, names)]
        words = [
            (f"{name} against {names[0]}", (*p.statements, *compared_files.reasons(p)))
            for name, p in zip(names[1:], pairs, strict=True)
        ]
        tables += [compared_files.models(p, with_statements=False) for p in pairs]
        with keeping(users_texts(*found)):
            self._page(HTTPStatus.OK, comparison(tables, [s for s in words if s[1]], names))

    def _picture(self, shelf: Shelf, key: str) -> None:
        try:
            content = picture_of(shelf, key).encode("utf-8", "replace")
        except (CoeflabError, OSError):
            content = b""
        if not content:
            self._refuse(HTTPStatus.NOT_FOUND, "There is no such picture here.")
            return
        self._head(HTTPStatus.OK, "image/svg+xml", len(content), POLICIES[".svg"])
        if self.command == "GET":
            self.wfile.write(content)

    def _file(self, path: Path | None) -> None:
        if path is None:
            self._refuse(HTTPStatus.NOT_FOUND, "There is no such file here.")
            return
        try:
            with stream_of(path) as stream:
                size = os.fstat(stream.fileno()).st_size
                kind = path.suffix.lower()
                self._head(HTTPStatus.OK, SERVED[kind], size, POLICIES[kind])
                if self.command == "GET":
                    shutil.copyfileobj(stream, self.wfile)
        except PermissionError:
            self._refuse(HTTPStatus.FORBIDDEN, "This file cannot be read.")

    def _page(self, status: HTTPStatus, content: bytes, more: dict[str, str] | None = None) -> None:
        self._head(status, "text/html; charset=utf-8", len(content), policy(), more)
        if self.command != "HEAD":
            self.wfile.write(content)

    def _head(self, status: HTTPStatus, kind: str, size: int, policy: str, more: dict[str, str] | None = None) -> None:
        self.send_response(status)
        words = {"Content-Type": kind, "Content-Length": str(size), "Content-Security-Policy": policy}
        for name, value in (words | ALWAYS | (more or {})).items():
            self.send_header(name, value)
        self.end_headers()

    def _refuse(self, status: HTTPStatus, why: str, more: dict[str, str] | None = None) -> None:
        self.close_connection = True
        self._page(status, refusal(status.value, status.phrase, why), more)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """What the standard library finds wrong with a request, on a page of ours."""
        self._refuse(HTTPStatus(code), explain or message or "This request cannot be read.")

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Nothing: a terminal that shows a gallery is no log."""


def _apart(names: list[str]) -> list[str]:
    """Names of files, numbered where two are alike."""
    return [f"{n} ({i + 1})" if names.count(n) > 1 else n for i, n in enumerate(names)]
