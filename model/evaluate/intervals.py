"""How sure a share is that was counted on a few."""

from __future__ import annotations

from math import sqrt
from statistics import NormalDist


def wilson_interval(found: int, of: int, *, confidence: float = 0.95) -> tuple[float, float]:
    """Wilson's interval of the share ``found / of``; 0 to 1 where nothing was counted.

    Source: E. B. Wilson, Journal of the American Statistical Association 22 (1927), 209-212.
    """
    if of == 0:
        return 0.0, 1.0
    z = NormalDist().inv_cdf(0.5 + confidence / 2)
    share, weight = found / of, z * z / of
    middle = (share + weight / 2) / (1 + weight)
    reach = z / (1 + weight) * sqrt(share * (1 - share) / of + weight / (4 * of))
    return max(middle - reach, 0.0), min(middle + reach, 1.0)
