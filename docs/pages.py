"""Write what the pages of the documentation show: outputs of their commands, their pictures, and docs/commands.md.

python docs/pages.py [PAGE.md ...]       then: mkdocs build --strict

A page is run from its first line to its last in an empty folder: a block with a title is a file, a `console` block holds
commands behind `$ ` and what they print. A comment before the block says which part is shown:
`<!-- 6 lines from "Side by side" -->`, `<!-- 5 lines -->`, `<!-- nothing -->`, and the exit code where it is not zero, `<!-- exit code 1 -->`.
A command that stands twice is run once; a file of the checkout that a command names is there. `<!-- varies -->` says that the output depends on the machine: it is not compared.
A picture in pictures/ that a command of the page writes is copied from there. mkdocs takes the hooks at the end of this file.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
Runner = Callable[[Sequence[str], Path], "subprocess.CompletedProcess[str]"]
BLOCK = re.compile(
    r'(?P<said><!-- (?P<part>[^\n]*) -->\n)?^```(?P<kind>\w+)(?: title="(?P<title>[^"]+)")?\n(?P<body>.*?)^```$',
    re.M | re.S,
)
PICTURE = re.compile(r"\]\(pictures/([\w.-]+)\)")
MATH = re.compile(r"^\$\$\n(?P<shown>.*?)\n\$\$$|\$`(?P<inline>.+?)`\$", re.M | re.S)
OUTSIDE = re.compile(r"(?<=\]\()\.\./([\w./-]+)(?=\))")
WIDTH = {"COLUMNS": "80", "TERM": "dumb"}


def process(arguments: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """A command as a user types it."""
    command = [
        sys.executable if arguments[0] == "python" else Path(sys.executable).with_name(arguments[0]),
        *arguments[1:],
    ]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def commands(text: str) -> Iterator[list[str]]:
    """The words of every command of a page."""
    for block in BLOCK.finditer(text):
        if block["kind"] == "console":
            for line in _joined(block["body"]):
                if line.startswith("$ "):
                    yield shlex.split(line[2:])


def written(text: str, folder: Path, run: Runner = process, *, anew: bool = True) -> str:
    """The page with what its commands print when they are run one after the other in a folder.

    What varies with the machine is left as it is unless it is written anew.

    Raises
    ------
    RuntimeError
        A command ends with another exit code than the page says, or prints no line that the page wants shown.
    """
    known: dict[str, subprocess.CompletedProcess[str]] = {}

    def block(found: re.Match[str]) -> str:
        if found["title"]:
            file = folder / found["title"]
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(found["body"], encoding="utf-8")
        if found["kind"] != "console":
            return found[0]
        part = found["part"] or ""
        typed = [line for line in found["body"].splitlines() if line.startswith(("$ ", "> "))]
        out = list(typed)
        wanted = int(code[1]) if (code := re.search(r"exit code (\d+)", part)) else 0
        printed: list[str] = []
        for line in _joined("\n".join(typed)):
            if line not in known:
                words = shlex.split(line[2:])
                for word in words[1:]:
                    if (HERE.parent / word).is_file() and not (folder / word).exists():
                        (folder / word).parent.mkdir(parents=True, exist_ok=True)
                        (folder / word).write_bytes((HERE.parent / word).read_bytes())
                known[line] = run(words, folder)
            done = known[line]
            if done.returncode != wanted:
                raise RuntimeError(f"{line}: exit code {done.returncode}, not {wanted}\n{done.stdout}{done.stderr}")
            printed += (done.stdout + done.stderr).replace(f"{folder}/", "").rstrip().splitlines()
        if "varies" in part and not anew:
            return found[0]
        out += _shown(printed, part, typed[-1])
        return f"{found['said'] or ''}```console\n" + "\n".join(line.rstrip() for line in out) + "\n```"

    return BLOCK.sub(block, text)


def _joined(body: str) -> list[str]:
    """Commands whose lines end in a backslash, each as one."""
    return [line for line in body.replace("\\\n> ", "").splitlines() if line.startswith("$ ")]


def _shown(printed: list[str], part: str, command: str) -> list[str]:
    if part.startswith("nothing"):
        return []
    first, count = 0, len(printed)
    if sought := re.search(r'from "(.*?)"', part):
        first = next((i for i, line in enumerate(printed) if sought[1] in line), -1)
        if first < 0:
            raise RuntimeError(f"{command}: no line has {sought[1]!r}:\n" + "\n".join(printed))
    if lines := re.search(r"(\d+) lines?", part):
        count = int(lines[1])
    kept = printed[first : first + count]
    return ["..."] * (first > 0) + kept + ["..."] * (first + len(kept) < len(printed))


def pictures(text: str, folder: Path) -> Iterator[tuple[str, bytes]]:
    """Name and content of those pictures of a page that its commands have written, of one name the first."""
    for name in PICTURE.findall(text):
        written = sorted(folder.rglob(name), key=lambda file: file.stat().st_mtime_ns)
        yield from ((name, file.read_bytes()) for file in written[:1])


def reference() -> str:
    """Every command with its arguments and options, from the command line itself."""
    import click
    import typer

    from coeflab.cli import ORDER, app

    root: Any = typer.main.get_command(app)
    out = [
        "# Commands\n\nGenerated by `python docs/pages.py` from the command line itself. `coeflab COMMAND --help` prints the same.\n\n"
        "Exit codes: 0 fine, 1 a check or comparison failed, 2 wrong input. `--json` prints one JSON object.\n"
    ]

    def one(command: Any, parent: Any, level: str) -> None:
        with click.Context(command, info_name=command.name, parent=parent) as ctx:
            paragraphs = (command.help or "").replace("\b\n", "").strip().split("\n\n")
            told = "\n\n".join(" ".join(p.split()) for p in paragraphs)
            out.append(f"\n{level} {ctx.command_path}\n\n{_escaped(told)}\n")
            example = re.search(r"Example: (.*)", command.epilog or "", re.S)
            if example:
                out.append(f"\n```sh\n{' '.join(example[1].split())}\n```\n")
            records = [
                r for p in command.get_params(ctx) if (r := p.get_help_record(ctx)) and "--help" not in r[0].split(", ")
            ]
            if records:
                out.append("\n| Argument or option | Meaning |\n| --- | --- |\n")
                out.extend(
                    f"| `{a.replace('|', chr(92) + '|')}` | {_escaped(b).replace('|', '&#124;')} |\n"
                    for a, b in records
                )
            for name in getattr(command, "commands", {}):
                one(command.get_command(ctx, name), ctx, level + "#")

    with click.Context(root, info_name="coeflab") as top:
        for name in ORDER:
            one(root.get_command(top, name), top, "##")
    return "".join(out)


def _escaped(text: str) -> str:
    return " ".join(re.sub(r"([*_<\[])", r"\\\1", line) for line in text.split(" "))


def main(names: Sequence[str]) -> None:
    """Write the pages of these names, or all."""
    (HERE / "commands.md").write_text(reference(), encoding="utf-8")
    (HERE / "pictures").mkdir(exist_ok=True)
    for page in [HERE / name for name in names] or sorted(HERE.glob("*.md")):
        text = page.read_text(encoding="utf-8")
        if next(commands(text), None) is None:
            continue
        with tempfile.TemporaryDirectory() as folder:
            page.write_text(written(text, Path(folder).resolve()), encoding="utf-8")
            for name, content in pictures(text, Path(folder)):
                (HERE / "pictures" / name).write_bytes(content)
        sys.stderr.write(f"{page.name}\n")


_formulas: list[str] = []


def on_config(config: Any) -> Any:
    """A page that the navigation of mkdocs.yml does not name stands at the end of its reference."""
    listed = set(re.findall(r"[\w-]+\.md", repr(config.nav)))
    reference = next(part["Reference"] for part in config.nav if "Reference" in part)
    reference.extend(page.name for page in sorted(HERE.glob("*.md")) if page.name not in listed)
    return config


def on_files(files: Any, config: Any) -> Any:
    """Take in the files outside of docs that a page shows or links to."""
    from mkdocs.structure.files import File

    for page in sorted(HERE.glob("*.md")):
        for place in sorted(set(OUTSIDE.findall(page.read_text(encoding="utf-8")))):
            if (HERE.parent / place).is_file() and files.get_file_from_path(f"outside/{place}") is None:
                files.append(File.generated(config, f"outside/{place}", abs_src_path=str(HERE.parent / place)))
    return files


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Turn links out of docs to the copies, and set formulas aside."""
    from latex2mathml.converter import convert

    def formula(found: re.Match[str]) -> str:
        text = (found["shown"] or found["inline"]).replace(
            "'", "\u2032"
        )  # a letter: as a superscript it is raised twice
        _formulas.append(convert(text, display="block" if found["shown"] else "inline"))
        return f"formula{len(_formulas) - 1}set"

    return MATH.sub(formula, OUTSIDE.sub(r"outside/\1", markdown))


def on_page_content(html: str, **_: Any) -> str:
    """Put the formulas in as MathML, which browsers set without a script."""
    return re.sub(r"formula(\d+)set", lambda found: _formulas[int(found[1])], html)


def on_post_page(output: str, **_: Any) -> str:
    """Name each landmark once: the theme writes the contents of a page twice, for wide and for narrow screens."""
    seen: set[str] = set()

    def named(found: re.Match[str]) -> str:
        first = found[2] not in seen
        seen.add(found[2])
        return found[0] if first else f'{found[1]}{found[2]} (beside the text)"'

    return re.sub(r'(<nav\b[^>]*\baria-label=")([^"]*)"', named, output)


if __name__ == "__main__":
    import os

    os.environ.update(WIDTH)
    main(sys.argv[1:])
