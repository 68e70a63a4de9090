"""``coeflab serve``: reports and parameter files of a folder, in the browser."""

from __future__ import annotations

from pathlib import Path

import typer

from coeflab.cli import options, show

EXAMPLE = "coeflab serve reports"


@options.worded
def command(*, folder: Path, port: int = 8765, open_: bool = False) -> None:
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
