"""Make the gallery from the shipped studies: ``make gallery``, or ``python3 start.py gallery``.

One page on each study as HTML, PDF and picture, and its main drawing. Equal sources give equal bytes, whatever the processor;
a test holds the committed files to that. Parameter files, whose last digits depend on it, are no part.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

from coeflab.api.documents import report_of, studied, written
from coeflab.bodies.simplify.source import subject
from coeflab.core.files import shipped, write_atomically
from coeflab.fits import BY_DEFAULT
from coeflab.report.acceptance import Acceptance
from coeflab.report.document import Figure
from coeflab.report.figures.estimator import estimator_figure
from coeflab.report.figures.svg_file import plain
from coeflab.report.formats.pdf import page_pictures
from coeflab.report.sections import acceptance as acceptance_document
from coeflab.study.checking import checked
from coeflab.study.estimated_vehicle import asked, from_shape
from coeflab.study.plan import table_at
from coeflab.study.run import run
from coeflab.study.study import Plan, PlannedTow, Study
from coeflab.tank.campaign import SIX

HERE = Path(__file__).resolve().parent
VEHICLE, TOW = "myring_auv", "suboff_tow_bare_hull"
STUDIES = ("suboff", "huuv", "flyingfish", "thauv", "urv", VEHICLE, TOW)
PIXELS_AN_INCH = 84.0


def standalone(figure: Figure) -> bytes:
    """The drawing as a file of its own: white ground, colours in place of the page's variables."""
    head = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" style="background:#fff" '
    return (plain(figure.svg).replace("<svg ", head, 1) + "\n").encode()


def of_suboff(study: Study) -> dict[str, bytes]:
    """The picture that the README opens with."""
    judged = [c for c in study.comparisons if c.passed is not None]
    published = tuple(c for c in judged if (c.coefficient.symbol, c.coefficient.campaign) == ("Yv", "suboff_roddy_2"))
    figure = estimator_figure(study.fits[0].sweep("Yv"), published, "yv-estimators")
    return {"suboff_yv_estimators.svg": standalone(figure)}


def of_publication(found: Acceptance) -> dict[str, bytes]:
    """Its first drawing, where it has one."""
    return {f"{found.name}.svg": standalone(f) for f in acceptance_document.figures(found)[:1]}


def of_shape() -> Study:
    """A vehicle estimated from its shape, as ``coeflab vehicle myring_auv`` does."""
    body = subject(VEHICLE)
    return checked(from_shape(asked(body)[0], body))


def of_tow() -> Study:
    """What the virtual tow tank measured on the bare hull, as the report of ``coeflab tow suboff_bare_hull`` has it."""
    title, campaign = "DARPA SUBOFF bare hull, towed by OpenFOAM", shipped("cfd_data") / TOW
    body = shipped("geometry") / "suboff_bare_hull" / "body.toml"
    tows = (PlannedTow(title, body.parent.name, TOW, added=campaign),)
    return run(Plan(TOW, title, (table_at(campaign, BY_DEFAULT),), body=body, wanted=SIX, tows=tows))


def made(name: str) -> Mapping[str, bytes]:
    """The files of one study by their paths below the gallery."""
    drawn = {VEHICLE: of_shape, TOW: of_tow}
    found = drawn[name]() if name in drawn else studied(name)
    document = report_of(found, short=True).document
    pages = {f"{name}/{k.replace('report', 'summary')}": v for k, v in written(document, ["html", "pdf"]).items()}
    (page,) = page_pictures(document, PIXELS_AN_INCH)
    more = {} if name in drawn else of_suboff(found) if isinstance(found, Study) else of_publication(found)
    return pages | {f"{name}/summary.png": page} | more


def main() -> None:
    """Write the gallery."""
    for name in STUDIES:
        for path, content in made(name).items():
            if write_atomically(HERE / path, content):
                sys.stdout.write(f"{path}  {len(content) / 1e3:.0f} kB\n")


if __name__ == "__main__":
    main()
