"""``coeflab new``: a commented study that runs as it stands."""

from __future__ import annotations

import shlex
from pathlib import Path

from coeflab.cli import options, show

EXAMPLE = "coeflab new my_study"


@options.worded
def command(*, folder: Path) -> None:
    """Write a commented study with synthetic numbers to start from."""
    from importlib.resources import files

    from coeflab.api.schemas import schema
    from coeflab.core.errors import OutputError
    from coeflab.core.files import names_in, typed, write_all
    from coeflab.core.text.bounded import own_bytes

    folder = typed(folder)
    if folder.exists() and (not folder.is_dir() or names_in(folder)):
        raise OutputError(f"{folder} exists and is not empty. Name a new folder.")
    template = files("coeflab.cli") / "template"
    names = ("plan.toml", "body.toml", "campaign/campaign.toml", "campaign/drift.csv", "campaign/rotating_arm.csv")
    contents = {name: own_bytes(template.joinpath(*name.split("/"))) for name in names}
    contents |= {f"schemas/{kind}.schema.json": schema(kind) for kind in ("plan", "campaign", "body")}
    write_all(folder, contents, new=True)
    for name in contents:
        show.path(folder / name)
    show.command_line("Run it", f"coeflab run {shlex.quote(str(folder / 'plan.toml'))}")
