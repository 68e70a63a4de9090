"""Floor 5: the command line. Heavy imports wait until a command runs."""

from __future__ import annotations

import gc
import os
import re
import sys
from importlib import import_module
from inspect import cleandoc
from keyword import iskeyword
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from coeflab.core.applications import declared

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
GROUPS = {
    "Data": ["new", "import", "inspect"],
    "Fit and report": ["fit", "next", "run", "validate", "report", "serve"],
    "Body": ["added-mass", "simplify", "draw", "mass"],
    "Vehicle": ["vehicle", "params", "merge", "compare", "table"],
    "Motion": ["simulate", "trim", "uncertainty"],
    "Files": ["export", "formats", "schema"],
}
OF_APPLICATIONS = {name: home for home, theirs in declared("COMMANDS").items() for name in theirs}
for _theirs in declared("COMMANDS").values():
    for _name, _group in _theirs.items():
        GROUPS[_group].append(_name)
ORDER = [name for names in GROUPS.values() for name in names]
MOST = 10**9  # of anything that is counted
WITHOUT_TABLES = {
    "new",
    "report",
    "schema",
    "serve",
    "table",
}  # what is printed is text for machines, or nothing to fold
_SUMMARY = re.compile(
    r'^def command\(.*?-> None:\s*"""(.*?)"""|^app = typer\.Typer\(help="(.*?)"', re.MULTILINE | re.DOTALL
)


class Command(TyperCommand):
    """A command that refuses an option given twice where only the last value would count."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the command line, first for what stands twice.

        Raises
        ------
        InputError
            A single-valued option, or both sides of a switch, more than once.
        """
        if not ctx.resilient_parsing:
            *_, order = self.make_parser(ctx).parse_args(args=list(args))
            for option in self.params:
                if order.count(option) > 1 and _last_counts(option):
                    from coeflab.core.errors import InputError

                    name = option.opts[-1]
                    raise InputError(f"{name} given twice", "it once, for only the last would count", column=name)
        return list(super().parse_args(ctx, args))


def _last_counts(option: Any) -> bool:
    """Whether a second use of an option undoes the first: one value, or a switch with two sides."""
    if option.param_type_name != "option" or option.multiple or option.count:
        return False
    return not option.is_flag or bool(option.secondary_opts)


class WithPlugin(Command):
    """A command that hands further options to a plugin: a shell is offered those of the plugin that is named."""

    registry, parameter = "", ""

    def shell_complete(self, ctx: Any, incomplete: str) -> list[Any]:
        """The command's own options, then the plugin's."""
        found = super().shell_complete(ctx, incomplete)
        if not incomplete.startswith("--") or not self.registry:
            return found
        from coeflab.cli.complete import options_of

        own = {item.value for item in found}
        named = str(ctx.params.get(self.parameter) or "")
        click = TyperCommand.__mro__[1].__module__.rpartition(".")[0]  # typer brings its own, older ones the library
        kind = import_module(f"{click}.shell_completion").CompletionItem
        more = options_of(self.registry, named, incomplete)
        return [*found, *(kind(option, help=meaning) for option, meaning in more if option not in own)]


class Commands(TyperGroup):
    """The commands, each imported when it is asked for; their list shows the first line of what each file says of itself."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands = {name: TyperCommand(name) for name in ORDER}

    def main(self, *args: Any, **settings: Any) -> Any:
        """Run a command line, whose messages name options."""
        from coeflab.core.keywords import in_shell

        with in_shell():
            return super().main(*args, **settings)

    def parse_args(self, ctx: Any, args: list[str]) -> Any:
        """Refuse a blank value of any option or argument: it is no way to leave one out."""
        from coeflab.core.errors import InputError

        for before, text in zip(["", *args], args, strict=False):
            flag, sign, value = text.partition("=") if text.startswith("--") else (before, "=", text)
            if sign and not value.strip() and not ctx.resilient_parsing:
                name = flag if flag.startswith("-") else "an argument"
                raise InputError("a blank value", "a value, or the option left out", column=name)
        return super().parse_args(ctx, args)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of a name, with its options; None where there is none."""
        found = super().get_command(ctx, cmd_name)
        return found if found is None or found.help else _built(cmd_name)

    def format_commands(self, ctx: Any, formatter: Any) -> None:  # noqa: ARG002 - click's own
        """Write the commands in groups without importing them."""
        widest = max(map(len, ORDER))
        for title, names in GROUPS.items():
            with formatter.section(title):
                formatter.write_dl([(f"{name:<{widest}}", _sentence(_summary(name))) for name in names])


def _module(name: str) -> str:
    """The dotted name of a command; words of Python have an underscore behind."""
    home = f"coeflab.{OF_APPLICATIONS[name]}.commands" if name in OF_APPLICATIONS else __name__
    return f"{home}.{name}_" if iskeyword(name) else f"{home}.{name.replace('-', '_')}"


def _summary(name: str) -> str:
    from coeflab.core.text.bounded import own_text

    text = own_text(Path(__file__).parents[2] / f"{_module(name).replace('.', '/')}.py")
    found = _SUMMARY.search(text)
    return cleandoc(found[1] or found[2]) if found else ""


def _sentence(text: str) -> str:
    """The first sentence, whole: what click makes by itself ends in the middle."""
    return " ".join(text.partition("\n\n")[0].split()).removesuffix(".")


def _built(name: str) -> Any:
    module = import_module(_module(name))
    one = getattr(module, "app", None)
    if one is None:
        one = typer.Typer(rich_markup_mode=None, pretty_exceptions_enable=False, add_completion=False)
        settings = getattr(module, "CONTEXT", None)
        kind = type("WithPlugin", (WithPlugin,), getattr(module, "PLUGIN", {}))
        one.command(name=name, cls=kind, epilog=f"Example: {module.EXAMPLE}", context_settings=settings)(module.command)
    out = typer.main.get_command(one)
    out.name = name
    for command in getattr(out, "commands", {"": out}).values():
        for option in command.params:
            option.callback = _finite(option.callback)
    if name not in WITHOUT_TABLES:
        from coeflab.cli.options import wide

        for command in getattr(out, "commands", {"": out}).values():
            command.params.append(wide())
    return out


def _finite(before: Any) -> Any:
    """What an option does with its value, after a number that is none, or a place where nothing can be written, was refused."""

    def checked(ctx: Any, param: Any, value: Any) -> Any:
        if isinstance(value, float) and not abs(value) < float("inf"):
            from coeflab.core.errors import InputError

            raise InputError(str(value), "a finite number", column=param.opts[0])
        if isinstance(value, int) and abs(value) > MOST:
            from coeflab.core.errors import InputError

            raise InputError(str(value)[:60], f"at most {MOST:,}", column=param.opts[0])
        if isinstance(value, Path) and param.opts[0] == "--out":
            from coeflab.core.files import placeable

            placeable(value)
        return value if before is None else before(ctx, param, value)

    return checked


app = typer.Typer(
    name="coeflab",
    cls=Commands,
    help="Hydrodynamic coefficients from force tables: slopes at the origin with a 95 % interval, parameter files "
    "and reports.",
    epilog="Example: coeflab validate suboff",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 80},
)


def _version(value: bool) -> None:
    if value:
        from coeflab.core.version import VERSION

        typer.echo(f"coeflab {VERSION}")
        raise typer.Exit


@app.callback()
def _root(
    version: bool = typer.Option(False, "--version", callback=_version, is_eager=True, help="Print the version."),
) -> None:
    pass


def _ready_to_print() -> None:
    """See to standard streams that are closed, or that cannot write every letter.

    A closed stream is opened on nothing, so that no file of ours takes its number; without a standard output there is nowhere
    to print, which is said. A letter that the console's encoding lacks is written as its code.
    """
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        stream = getattr(sys, name)
        if stream is not None:
            if mode == "w" and hasattr(stream, "reconfigure"):
                stream.reconfigure(errors="backslashreplace")
            continue
        try:
            os.fstat(number)
        except OSError:
            while os.open(os.devnull, os.O_RDWR) < number:
                pass
        nothing = os.open(os.devnull, os.O_RDWR)
        setattr(sys, name, os.fdopen(nothing, mode, encoding="utf-8"))  # it stays open to the end
        if name == "stdout":
            typer.echo(
                "error: found a closed standard output; expected one to print to (>/dev/null discards).", err=True
            )
            sys.exit(2)


def main() -> None:
    """Run the command line: exit code 0 fine, 1 a check failed, 2 wrong input.

    A reader that has seen enough and closes the pipe, such as ``head``, is no failure: exit code 0 without a message.
    Linear algebra keeps to one thread whatever the environment says: several threads sum in another order, so that bytes
    would depend on them, and on small matrices they are slower by orders of magnitude. The commands import numpy later,
    so the setting comes in time.
    """
    os.environ.update(dict.fromkeys(THREADS, "1"))
    gc.set_threshold(50_000, 20, 50)  # of half a million imported objects none is garbage: 3 % of `validate suboff`
    from coeflab.core.errors import CoeflabError

    _ready_to_print()
    try:
        app()
    except SystemExit as ended:
        if not isinstance(ended.__context__, BrokenPipeError):  # typer makes exit code 1 of it
            raise
        _discard_output()
        sys.exit(0)
    except CoeflabError as why:
        from coeflab.cli import show

        first, *others = why.lines
        for line in (f"error: {first}", *others):
            show.error(line)
        sys.exit(2)
    except BrokenPipeError:
        _discard_output()
        sys.exit(0)
    except OSError as why:
        _discard_output()
        typer.echo(f"error: cannot write the output: {why.strerror or why}", err=True)
        sys.exit(2)


def _discard_output() -> None:
    """Send what is still in the buffer of standard output nowhere, so that leaving does not try to write it again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
