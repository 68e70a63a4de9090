"""``coeflab serve``: reports and parameter files of a folder, in the browser."""

from __future__ import annotations

from pathlib import Path

import typer

from coeflab.cli import complete, show

EXAMPLE = "coeflab serve reports"


def command(
    folder: Path = typer.Argument(
        ..., autocompletion=complete.folders, help="Folder of reports and parameter files; those below it count too."
    ),
    port: int = typer.Option(8765, min=0, max=65535, help="Port on 127.0.0.1; 0 takes any that is free."),
    open_: bool = typer.Option(False, "--open", help="Show the gallery in the browser."),
) -> None:
    """Show the reports and parameter files below a folder on this machine, with search and comparison side by side.

    Nothing can be changed through it, nobody else can reach it, and links out of the folder are not followed. Ctrl-C
    ends it.
    """
    import signal
    from threading import Thread

    from coeflab.report.gallery.server import GalleryServer

    # A shell that starts a command in the background has it ignore Ctrl-C.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    with GalleryServer(folder, port) as server:
        try:
            show.text(f"Gallery on {server.address}; Ctrl-C ends it.")
            if open_:
                Thread(target=show.in_browser, args=(server.address,), daemon=True).start()
            server.serve_forever()
        except KeyboardInterrupt:
            typer.echo()
