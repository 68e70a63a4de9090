"""The report of SUBOFF after its fits, HTML and PDF, against as many plain matplotlib figures saved as SVG and as PDF.

The peer draws what most of the report's figures show (points, four curves with a legend, residuals below) by
`plt.subplots` and two `savefig`, one after the other: no tables, no text, no numbers behind the drawings.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import io
import resource
import time
from collections.abc import Callable, Iterable
from typing import TypeVar

import matplotlib as mpl
import numpy as np

from coeflab.api.documents import report_of, studied, written
from coeflab.report.document import Section

mpl.use("Agg")
ROUNDS = 5
Made = TypeVar("Made")


def used() -> float:
    """Processor seconds of this process and of its copies."""
    who = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return sum(u.ru_utime + u.ru_stime for u in map(resource.getrusage, who))


def timed(job: Callable[[], Made]) -> tuple[Made, float, float]:
    start, before = time.perf_counter(), used()
    made = job()
    return made, time.perf_counter() - start, used() - before


def count(sections: Iterable[Section]) -> int:
    return sum(len(s.figures) + count(s.subsections) for s in sections)


def plain(figures: int) -> None:
    import matplotlib.pyplot as plt

    x = np.linspace(-1.0, 1.0, 25)
    fine = np.linspace(-1.0, 1.0, 121)
    for n in range(figures):
        figure, (upper, lower) = plt.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        upper.plot(x, x + 0.1 * np.sin(9.0 * x + n), "o", label="points")
        for k in range(1, 5):
            upper.plot(fine, fine + 0.02 * k * fine**3, label=f"form {k}")
            lower.plot(x, 0.1 * np.sin(9.0 * x + n) - 0.02 * k * x**3, "s")
        upper.set(ylabel="Y' x 1000")
        lower.set(xlabel="angle [deg]", ylabel="residual")
        upper.legend()
        for form in ("svg", "pdf"):
            figure.savefig(io.BytesIO(), format=form)
        plt.close(figure)


def main() -> None:
    study = studied("suboff")
    best: dict[str, tuple[float, float]] = {}

    def keep(name: str, wall: float, cpu: float) -> None:
        before = best.get(name, (wall, cpu))
        best[name] = min(before[0], wall), min(before[1], cpu)

    figures = 0
    for _ in range(ROUNDS):
        report, *drawing = timed(lambda: report_of(study))
        _, *html = timed(lambda: written(report.document, ["html"]))  # noqa: B023
        _, *pdf = timed(lambda: written(report.document, ["pdf"]))  # noqa: B023
        figures = count(report.document.sections)
        _, *peer = timed(lambda: plain(figures))  # noqa: B023
        for name, cost in (("document", drawing), ("html", html), ("pdf", pdf), (f"{figures} plain figures", peer)):
            keep(name, *cost)
        keep("report", *(sum(c) for c in zip(drawing, html, pdf, strict=True)))
    print(f"{'least of ' + str(ROUNDS):<20}   wall s   cpu s")
    for name, (wall, cpu) in best.items():
        print(f"{name:<20} {wall:8.2f} {cpu:7.2f}")
    ours, theirs = best["report"], best[f"{figures} plain figures"]
    print(
        f"ratio to the plain figures: wall {ours[0] / theirs[0]:.2f} (target: at most 1), cpu {ours[1] / theirs[1]:.2f}"
    )


if __name__ == "__main__":
    main()
