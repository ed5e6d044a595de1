"""COCO documents: read in one way and written in one way, whoever asks.

Our own keys of an annotation, beside COCO's:

``center`` [x, y], ``circle`` [cx, cy, r], ``ellipse`` [cx, cy, a, b, theta_deg]
    A person's mark, unless ``marked`` is false, or the annotation carries a ``score`` or a ``center_sd``:
    then a machine worked them out. Where both are given, the circle counts.
``mark``
    The polygon [x0, y0, …] a person marked; ``ellipse`` is then the one fitted to it.
``center_sd``, ``mark_sd`` [sx, sy]
    One standard deviation of the centre along x and y, in pixels: of one that a machine worked out, or of the
    one that a person's mark determines.
``segmentation_of``
    ``"mark"`` where the visible outline is unknown and the polygons were drawn from the mark.
``amodal_segmentation``
    The whole outline as a polygon, united with what is visible; one alone, without circle or ellipse, is
    taken as a marked polygon.
``quality``
    Beside a ``score``: the IoU that a prediction's outline is expected to have with the visible cap, 0 to 1.
``doubt``, ``ignored``, ``ignore``, ``order``, ``uid``
    Flags, overlap order, and the annotation's own number.
``refusal``
    Why a machine found no centre.

A key that is null is a key that is missing.
"""
