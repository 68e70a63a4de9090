"""What a model is worth on rows that it has not seen, as a share of the response's range."""

from __future__ import annotations

from math import isnan

import numpy as np

from coeflab.core.texts import text_of
from coeflab.core.types import Array, dataclass
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.statistics.cross_validation import predict_left_out, thirds
from coeflab.law.terms import design

RANGE = "the response's range"


@dataclass(frozen=True, slots=True)
class OutOfSample:
    """Prediction errors of left-out rows.

    Attributes
    ----------
    how : str
        Which rows are left out.
    rms, largest : float
        Share of the response's range; NaN if no row could be predicted.
    predicted, rows : int
        Rows that the others determine, and all rows.
    of : str
        What the errors are shares of.
    """

    how: str
    rms: float
    largest: float
    predicted: int
    rows: int
    of: str = RANGE

    @property
    def is_known(self) -> bool:
        """Whether the others determine at least half of the rows, so that an error can be given."""
        return 2 * self.predicted >= max(self.rows, 1) and not isnan(self.rms)

    def __str__(self) -> str:
        if not self.predicted:
            return f"{self.how}: the remaining rows do not determine the model, so nothing can be predicted."
        if isnan(self.rms):
            return f"{self.how}: the left-out rows do not vary, so no error is given as a share of their range."
        missing = self.rows - self.predicted
        if not self.is_known:
            return text_of("fits.too_few_rows_left", how=self.how, predicted=self.predicted, rows=self.rows)
        rest = f"; {missing} of {self.rows} rows are not determined by the others" if missing else ""
        return (
            f"{self.how}: the left-out rows are predicted to {100 * self.rms:.2f} % rms, {100 * self.largest:.2f} % at "
            f"most, of {self.of}{rest}."
        )


def errors_of(how: str, response: Array, predicted: Array, *, constant: bool = False) -> OutOfSample:
    """Compare predictions, NaN where there is none, with what was measured; of a constant as shares of its mean."""
    known = np.isfinite(predicted)
    size = abs(float(np.mean(response))) if constant else float(np.ptp(response))
    size = size or float("nan")
    error = np.abs(predicted[known] - response[known]) / size
    rms = float(np.sqrt(np.mean(error**2))) if error.size else float("nan")
    of = "the mean" if constant else RANGE
    largest = float(error.max()) if error.size else float("nan")
    return OutOfSample(how, rms, largest, int(known.sum()), len(response), of)


def every_third_point(model: FittedModel) -> OutOfSample:
    """Leave every third point out, each point once: rows sorted by the motion variables, ends included."""
    fold = thirds(list(model.x.values()))
    predicted = predict_left_out(design(model.terms, model.x), model.y, fold)
    return errors_of("Every third point left out", model.y, predicted, constant=model.is_constant)
