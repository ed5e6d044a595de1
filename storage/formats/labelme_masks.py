"""labelme's masks: a PNG, as text, of the box around a shape."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image

from fairyring.model.geometry.mask_tracing import outline_of_mask
from fairyring.model.geometry.shapes import Outline
from fairyring.model.json_values import ValueRefusedError
from fairyring.model.photo import MAX_PIXELS


def outline_of_png(text: Any, *, corner: Sequence[float]) -> Outline:
    """The outline of a mask whose first pixel is ``corner`` (x, y) in the photo.

    Raises ValueRefusedError where it is no PNG, and GeometryError where it cannot be traced.
    """
    try:
        with Image.open(io.BytesIO(base64.b64decode(text)), formats=("PNG",)) as image:
            if image.width * image.height > MAX_PIXELS:
                raise ValueRefusedError("Its mask is larger than any photo.")
            mask = (np.asarray(image.convert("L")) > 0).astype(np.uint8)
    # Decoders meet broken files with almost any exception.
    except (ValueError, TypeError, OSError, SyntaxError) as error:
        raise ValueRefusedError("Its mask is no PNG in base64, as labelme writes it.") from error
    if not mask.any():
        raise ValueRefusedError("Its mask is empty.")
    x, y = int(corner[0]), int(corner[1])
    return [
        [number + (y if nth % 2 else x) for nth, number in enumerate(part)] for part in outline_of_mask(mask)
    ]
