"""What CDR is and what to hold it against, in the words that panel, report, commands and guide share."""

from __future__ import annotations

CDR = (
    "CDR is how far the predicted centre of a cap lies from the marked one: |Δx| over the image's width plus "
    "|Δy| over its height, in percent (Eq. 10 of the paper). The same error is a smaller CDR on a larger "
    "image, so look at pixels and at shares of the cap's diameter, too. Caps that were missed or are extra "
    "are in no mean."
)
FLOOR = (
    "Hold CDR against its floor, the CDR that people's marks have by themselves, as no hand places a point "
    "exactly: predictions near it cannot be told to be wrong."
)
ABOUT = f"{CDR} {FLOOR}"
