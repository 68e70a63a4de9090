"""The tour of docs runs from its first to its last cell in a kernel of its own, and every noun in it shows a card."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

TOUR = Path(__file__).resolve().parents[2] / "docs" / "tour.ipynb"
CARDS = ("table", "study", "coefficient", "fit", "file", "body", "added-mass", "motion", "trajectory")
WITHOUT_DRAWING = {"added-mass"}


@pytest.fixture(scope="module")
def tour():
    """The notebook as written, and as it comes out."""
    written = nbformat.read(TOUR, as_version=4)
    run = nbformat.from_dict(written)
    NotebookClient(run, timeout=300, kernel_name="python3").execute(cwd=str(TOUR.parent))
    return written, run


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_every_cell_runs_and_every_noun_shows_a_card(tour):
    _, run = tour
    cells = {c["id"]: c for c in run["cells"] if c["cell_type"] == "code"}
    assert {i for i, c in cells.items() if c["outputs"]} == set(CARDS)
    for name in CARDS:
        (output,) = cells[name]["outputs"]
        assert output["output_type"] == "execute_result"
        card, line = output["data"]["text/html"], output["data"]["text/plain"]
        assert card.startswith('<div class="coeflab">')
        assert ("<svg" in card) is (name not in WITHOUT_DRAWING), name
        assert "\n" not in line
        assert len(line) < 240


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_the_tour_shows_the_values_of_the_towing_tests(tour):
    _, run = tour
    lines = {c["id"]: c["outputs"][0]["data"]["text/plain"] for c in run["cells"] if c.get("outputs")}
    assert lines["coefficient"].startswith("<Coefficient Yv' = -0.0262 +- 0.0027")
    assert "no figure determined" not in lines["motion"]


def test_the_notebook_is_valid_and_carries_no_outputs():
    """Outputs would go stale, and a diff of them cannot be read."""
    written = nbformat.read(TOUR, as_version=4)
    nbformat.validate(written)
    assert [c["id"] for c in written["cells"] if c.get("outputs") or c.get("execution_count")] == []
