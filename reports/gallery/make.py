"""Draw the picture of the README from the shipped SUBOFF study: ``python reports/gallery/make.py``."""

from __future__ import annotations

from pathlib import Path

from coeflab.presentation.estimator_figure import estimator_figure
from coeflab.presentation.sheet import plain
from coeflab.studies.validate import validation
from coeflab.workbench import run

HERE = Path(__file__).resolve().parent


def standalone(svg: str) -> str:
    """The drawing as a file of its own: white ground, colours in place of the page's variables."""
    head = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" style="background:#fff" '
    return plain(svg).replace("<svg ", head, 1) + "\n"


def main() -> None:
    """Write the picture."""
    study = run(validation("suboff"))
    judged = [c for c in study.comparisons if c.passed is not None]
    published = tuple(c for c in judged if (c.coefficient.symbol, c.coefficient.campaign) == ("Yv", "suboff_roddy_2"))
    figure = estimator_figure(study.fits[0].sweep("Yv"), published, "yv-estimators")
    (HERE / "suboff_yv_estimators.svg").write_text(standalone(figure.svg), encoding="utf-8")


if __name__ == "__main__":
    main()
