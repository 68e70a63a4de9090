"""Floor 5: the command line. Heavy imports wait until a command runs."""

from __future__ import annotations

import os
import sys

import typer

from coeflab.cli import (
    added_mass,
    compare,
    export,
    fit,
    formats,
    glide,
    identify,
    inspect,
    new,
    params,
    report,
    run,
    serve,
    simplify,
    simulate,
    table,
    trim,
    tune,
    uncertainty,
    validate,
)

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
app = typer.Typer(
    name="coeflab",
    help="Hydrodynamic coefficients from force tables: slopes at the origin with honest uncertainty, parameter files "
    "and reports.",
    epilog="Example: coeflab validate suboff",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
for module in (
    validate,
    run,
    report,
    serve,
    fit,
    inspect,
    new,
    formats,
    table,
    compare,
    added_mass,
    simplify,
    export,
    simulate,
    trim,
    tune,
    identify,
    uncertainty,
    glide,
):
    app.command(
        name=module.__name__.rpartition(".")[2].replace("_", "-"),
        epilog=f"Example: {module.EXAMPLE}",
        context_settings=getattr(module, "CONTEXT", None),
    )(module.command)
app.add_typer(params.app, name="params")


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
        setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115, PTH123 - it stays open to the end
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
    from coeflab.core.errors import CoeflabError
    from coeflab.report.printable import visible

    _ready_to_print()
    try:
        app()
    except SystemExit as ended:
        if not isinstance(ended.__context__, BrokenPipeError):  # typer makes exit code 1 of it
            raise
        _discard_output()
        sys.exit(0)
    except CoeflabError as why:
        typer.echo("error: " + "\n".join(map(visible, why.lines)), err=True)
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
