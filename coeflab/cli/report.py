"""``coeflab report``: a study's report in one or more formats."""

from __future__ import annotations

import shlex
from pathlib import Path

import typer

from coeflab.cli import options, show

EXAMPLE = "coeflab report suboff --to html,pdf"


@options.worded
def command(
    *,
    study: str,
    to: str = "html,pdf",
    out: Path | None = None,
    section: list[str],
    full: bool = False,
    summary: bool = False,
    for_review: bool = False,
    style: str = "",
    open_: bool = False,
    json: bool = False,
) -> None:
    """Compute a study and write its report: the core, the same in every format; --full adds the appendix.

    Nothing is written unless everything could be rendered. Equal inputs give equal files, byte for byte.
    """
    from coeflab.api.documents import studied
    from coeflab.api.studies import report_files, require_formats
    from coeflab.cli.run import REPORTS
    from coeflab.core.errors import InputError
    from coeflab.core.files import write_all

    formats = [name.strip() for name in to.split(",") if name.strip()]
    if summary and section:
        raise InputError("--summary with --section", "one of them: a summary has one page")
    if summary and full:
        raise InputError("--summary with --full", "one of them: a summary has one page")
    if for_review and (summary or full):
        raise InputError(f"--for-review with {'--summary' if summary else '--full'}", "one of them")
    require_formats(formats)
    with show.progress(json) as say:
        found = studied(study, say)
    # Outside of the progress display, whose thread would keep the drawing on one core.
    show.step("drawing the figures", json)
    document, files, failed = report_files(
        found, formats, full=full, short=summary, review=for_review, sections=section, style=style or None
    )
    folder = out if out is not None else Path(REPORTS) / document.name
    write_all(folder, files)
    paths = [folder / name for name in files]
    if json:
        show.json_object(
            {
                "study": document.name, "title": document.title, "digest": document.digest, "failed": failed,
                "sections": [{"anchor": s.anchor, "title": s.title} for s in document.sections],
                "files": [str(p) for p in paths],
            }
        )  # fmt: skip
    else:
        show.text(document.title)
        for path, content in zip(paths, files.values(), strict=True):
            show.text(f"  {path}  {len(content) / 1e6:.2f} MB")
        if not (full or summary or for_review or section):
            show.command_line("Appendix", f"coeflab report {shlex.quote(study)} --full")
    if open_:
        show.in_browser(paths[0].resolve().as_uri())
    if failed:
        raise typer.Exit(1)
