"""What every campaign adds to a joint fit, and whether one law serves them all."""

from __future__ import annotations

from math import isinf, isnan

from coeflab.core.table import plus_minus
from coeflab.core.types import dataclass
from coeflab.fits.results.lack_of_fit import UNLIKELY, chance
from coeflab.fits.results.out_of_sample import OutOfSample
from coeflab.fits.statistics.groups import Poolability
from coeflab.law.symbols import primed

DOUBTFUL = 0.1  # not rejected, but one in ten: worth a sentence


@dataclass(frozen=True, slots=True)
class CampaignShare:
    """One campaign in the fit of one component.

    Attributes
    ----------
    campaign : str
    n_points : int
    intercept, half_width : float or None
        Its own force at rest, primed, with the 95 % half-width; None where it has none of its own or it is left open.
    noise : float
        Primed standard deviation that its rows are weighed by (root mean square).
    rms, rms_alone : float
        Residuals about the joint law and about the same terms fitted to this campaign alone.
    left_out : OutOfSample
        Its rows predicted from the other campaigns, but for one constant of its own; as a share of its own range.
    """

    campaign: str
    n_points: int
    intercept: float | None
    half_width: float | None
    noise: float
    rms: float
    rms_alone: float
    left_out: OutOfSample


@dataclass(frozen=True, slots=True)
class Pooling:
    """One component of a joint fit by campaign.

    Attributes
    ----------
    response : str
    shares : tuple of CampaignShare
    every_third : OutOfSample
        Prediction of every third point of all campaigns.
    test : Poolability
        Of one law against a law for each campaign.
    alone : tuple of (symbol, tuple of (campaign, value, half-width))
        Coefficients that several campaigns determine alone.
    """

    response: str
    shares: tuple[CampaignShare, ...]
    every_third: OutOfSample
    test: Poolability
    alone: tuple[tuple[str, tuple[tuple[str, float, float], ...]], ...] = ()

    @property
    def rejected(self) -> bool | None:
        """Whether the campaigns disagree at 1 %; None where the rows cannot tell."""
        p = self.test.probability
        return None if isnan(p) else p < UNLIKELY

    @property
    def doubtful(self) -> bool:
        """Whether the test comes near to rejecting, between 1 and 10 %: with few rows it has little power."""
        return self.rejected is False and self.test.probability < DOUBTFUL

    @property
    def statistic(self) -> str:
        """The test as a number."""
        t = self.test
        if self.rejected is None:
            return f"{t.restrictions} coefficients in common, no test" if t.restrictions else "no coefficient in common"
        if isinf(t.freedom):
            return "rows without scatter"
        return f"F({t.restrictions}, {t.freedom:.3g}) = {t.statistic:.3g}, {chance(t.probability)}"

    @property
    def values_alone(self) -> str:
        """What each campaign gives by itself, in words."""
        each = [
            f"{primed(symbol)} " + ", ".join(f"{plus_minus(v, h)} ({c})" for c, v, h in values)
            for symbol, values in self.alone
        ]
        return f"Alone they give {'; '.join(each)}." if each else ""

    @property
    def sentences(self) -> tuple[str, ...]:
        """Campaigns, intercepts, weights, prediction and test in words."""
        out = []
        own = [s for s in self.shares if s.intercept is not None and s.half_width is not None]
        if own:
            listed = ", ".join(f"{plus_minus(s.intercept, s.half_width)} ({s.campaign})" for s in own)
            out.append(f"Every campaign has its own {self.response}0', subtracted from its rows: {listed}.")
        predicted = [str(s.left_out) for s in self.shares if s.left_out.predicted or len(self.shares) > 1]
        if len(self.shares) == 1:
            alone = f"Only {self.shares[0].campaign} has rows of {self.response}: one law for several campaigns is not tested"
            return (
                *out,
                *predicted,
                f"{alone}." if predicted else f"{alone}, and leaving a campaign out is not available.",
            )
        quiet, loud = min(self.shares, key=lambda s: s.noise), max(self.shares, key=lambda s: s.noise)
        listed = ", ".join(f"{s.noise:.2g} ({s.campaign})" for s in self.shares)
        text = f"Weights are 1 / scatter^2 of each campaign about its own law: {listed}"
        if quiet is not loud:
            text += f"; a row of {quiet.campaign} counts as {(loud.noise / quiet.noise) ** 2:.3g} of {loud.campaign}"
        out.append(f"{text}.")
        out += predicted
        verdict = {
            None: "Whether one law fits all campaigns cannot be tested",
            False: "One law is neither contradicted nor shown"
            if self.doubtful
            else "The campaigns do not contradict one law",
            True: "The campaigns disagree: one law does not fit them all",
        }[self.rejected]
        out.append(f"{verdict} ({self.statistic}; Wald test by campaign, HC2, approximate Hotelling T^2).")
        if self.rejected:
            out.append(f"{self.values_alone} U95 does not include their difference.".lstrip())
        return tuple(out)
