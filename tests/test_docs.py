"""The documentation site: it builds without a warning or a network, and its pages show what their commands print."""

from __future__ import annotations

import re
import runpy
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import click
import pytest
import typer

from coeflab.cli import app
from tests.cli.forked import Forks

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES: dict[str, Any] = runpy.run_path(str(DOCS / "pages.py"))
SHOWN = [p.name for p in sorted(DOCS.glob("*.md")) if next(PAGES["commands"](p.read_text(encoding="utf-8")), None)]
FENCE = re.compile(r"^```\w*[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)


def typed() -> Iterator[tuple[str, list[str]]]:
    """Every command of every page and of the README, with or without what it prints."""
    for page in (ROOT / "README.md", *sorted(DOCS.glob("*.md"))):
        for block in FENCE.findall(page.read_text(encoding="utf-8")):
            for line in block.replace("\\\n> ", "").replace("\\\n", "").splitlines():
                said = re.sub(r"^\$ |\s{2,}\S.*$|\s+#.*$", "", line)
                said = re.sub(r"^python3 start\.py (?!test|gallery)", "coeflab ", said)
                if re.match(r"coeflab( [\w-]+|$)", said):
                    yield page.name, shlex.split(said)


@pytest.mark.parametrize("page", sorted({name for name, _ in typed()}))
def test_every_command_of_a_page_exists_with_its_options(page: str) -> None:
    root: Any = typer.main.get_command(app)
    for name, words in typed():
        if name != page or len(words) == 1 or words[1].startswith("-") or words[1].isupper():
            continue
        command, rest = root, words[1:]
        with click.Context(root, info_name="coeflab") as ctx:
            while hasattr(command, "get_command") and rest and not rest[0].startswith("-"):
                found = command.get_command(ctx, rest[0])
                assert found, words
                command, rest = found, rest[1:]
            known = {o for p in command.get_params(ctx) for o in (*p.opts, *p.secondary_opts)}
            if not command.context_settings.get("ignore_unknown_options"):
                asked = {w.partition("=")[0] for w in rest if re.match(r"--[a-z]", w)}
                assert asked <= known, (words, asked - known)


def test_the_command_reference_is_that_of_the_command_line() -> None:
    reference = PAGES["reference"]()
    assert (DOCS / "commands.md").read_text(encoding="utf-8") == reference, "python docs/pages.py"
    commands = re.split(r"\n(?=##+ )", reference)[1:]
    assert len(commands) > 30
    without_example = [c.partition("\n")[0] for c in commands if "```sh\ncoeflab" not in c]
    assert without_example == ["## coeflab params"]  # its verbs have theirs


@pytest.mark.slow
@pytest.mark.parametrize("page", SHOWN)
def test_a_page_shows_what_its_commands_print(
    page: str, tmp_path: Path, forks: Forks, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in PAGES["WIDTH"].items():
        monkeypatch.setenv(name, value)

    def run(words: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
        return forks.run(words[1:], folder) if words[0] == "coeflab" else PAGES["process"](words, folder)

    text = (DOCS / page).read_text(encoding="utf-8")
    assert PAGES["written"](text, tmp_path, run, anew=False) == text, f"python docs/pages.py {page}"
    for name, content in PAGES["pictures"](text, tmp_path):
        assert (DOCS / "pictures" / name).read_bytes() == content, f"python docs/pages.py {page}"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site. Strict: a page, link or anchor that is not there is a warning, and a warning ends the build."""
    site = tmp_path_factory.mktemp("built") / "site"
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(site)]
    done = subprocess.run(build, cwd=ROOT, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return site


@pytest.mark.slow
def test_the_site_builds_strictly_and_loads_nothing_from_elsewhere(built: Path) -> None:
    html = sorted(built.rglob("*.html"))
    assert {p.stem for p in html} >= {p.stem for p in DOCS.glob("*.md")}
    elsewhere = re.compile(
        r'<(?:script|img|iframe|source)[^>]+src="?(?:https?:)?//[^>]*|<link[^>]+href="?(?:https?:)?//[^>]*'
    )
    assert not [found for p in html for found in elsewhere.findall(p.read_text(encoding="utf-8"))]
    for style in built.rglob("*.css"):
        assert not re.search(r"url\(\s*['\"]?(?:https?:)?//|@import", style.read_text(encoding="utf-8")), style
    assert not [p.name for p in html if "formula0set" in p.read_text(encoding="utf-8")]


@pytest.mark.slow
def test_axe_finds_nothing_on_pages_of_the_site(built: Path, visit: Callable[..., Any]) -> None:
    from axe_playwright_python.sync_playwright import Axe

    for name, scheme in (("index", "light"), ("tutorial_cfd", "dark")):
        page = visit((built / f"{name}.html").as_uri(), scheme=scheme)
        assert page.evaluate("document.body.dataset.mdColorScheme") == {"light": "default", "dark": "slate"}[scheme]
        found = Axe().run(page).response["violations"]
        assert [(name, v["id"], v["nodes"][0]["html"][:200]) for v in found] == []
