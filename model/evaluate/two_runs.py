"""Two runs on the same caps: which of them is nearer, cap by cap.

Only caps that both have found are compared; how many just one of them has found is counted beside that, since
a run could gain by leaving out what is hard.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from msgspec import to_builtins

from fairyring.model.evaluate.bootstrap import mean_interval
from fairyring.model.evaluate.cap_rows import Measured
from fairyring.model.evaluate.centre_figures import MEASURES, Evaluated, Measure, grouped
from fairyring.model.evaluate.centres import CentreError

Errors = dict[tuple[int, int], CentreError]
"""By place of the image and index of the true cap in it."""


def difference_of(first: Evaluated, second: Evaluated) -> dict[str, Any]:
    """How much further off the second run is than the first, both held against one truth.

    Means are of second minus first over the caps that both have found, with a bootstrap interval of these
    differences; below 0 the second is nearer.
    """
    errors = _errors(first), _errors(second)
    return _difference(first.caps, *errors) | {
        "groups": {
            kind: {value: _difference(caps, *errors) for value, caps in groups.items()}
            for kind, groups in grouped(first.caps, first.pages).items()
        }
    }


def _errors(run: Evaluated) -> Errors:
    return {(cap.page, cap.truth): cap.error for cap in run.caps if cap.truth is not None and cap.error}


def _difference(caps: Sequence[Measured], first: Errors, second: Errors) -> dict[str, Any]:
    """The same of some true caps."""
    keys = [(cap.page, cap.truth) for cap in caps if cap.truth is not None]
    both = [key for key in keys if key in first and key in second]
    nearer = np.array([second[key].px - first[key].px for key in both])
    return {
        **{measure: _interval(measure, both, first, second) for measure in MEASURES},
        "both": len(both),
        "only_first": sum(key in first and key not in second for key in keys),
        "only_second": sum(key in second and key not in first for key in keys),
        "neither": sum(key not in first and key not in second for key in keys),
        "second_nearer": int((nearer < 0).sum()),
        "first_nearer": int((nearer > 0).sum()),
    }


def _interval(measure: Measure, keys: Sequence[tuple[int, int]], first: Errors, second: Errors) -> Any:
    pairs = [(getattr(second[key], measure), getattr(first[key], measure), key[0]) for key in keys]
    known = [(theirs - ours, image) for theirs, ours, image in pairs if theirs is not None]
    figures = np.array([difference for difference, _ in known], np.float64)
    return to_builtins(mean_interval(figures, np.array([image for _, image in known], np.int64)))
