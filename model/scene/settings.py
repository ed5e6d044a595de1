"""What a bed can look like: plain settings, each with a range it must lie in.

Lengths on the bed are in pixels of the image, as the camera sees the soil in the middle of the picture.
A pair ``(low, high)`` is a range one value is drawn from for every image.
"""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
from msgspec import Meta, Struct, field

from fairyring.model.errors import FairyringError
from fairyring.model.light_and_form import FORMS, LIGHTS, LightSource

Share = Annotated[float, Meta(ge=0, le=1)]
ShareRange = tuple[Share, Share]
Positive = Annotated[float, Meta(gt=0)]
MOST_CAPS = 600
Count = Annotated[int, Meta(ge=1, le=MOST_CAPS)]
Zoom = Annotated[float, Meta(ge=0.2, le=5)]
Creep = tuple[Annotated[float, Meta(ge=0, le=10)], Annotated[float, Meta(ge=0, le=10)]]
Form = Annotated[str, Meta(pattern="^[a-h]*$")]
"""Letters of the paper's Figure 3, applied together; none for a plain bed."""


class SceneError(FairyringError):
    """Settings no bed can be made of, or a folder that cannot be written; the sentence says which."""


class Growth(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How caps come up."""

    caps: tuple[Count, Count] = (68, 104)
    """How many with at least one pixel in sight."""
    diameters: tuple[Positive, Positive, Positive, Positive, Positive] = (13, 27, 56, 104, 200)
    """The 0, 10, 50, 90 and 100 % quantiles."""
    zoom: tuple[Zoom, Zoom] = (1.0, 1.0)
    """How much larger caps are than ``diameters`` says, and, by its square, how many fewer."""
    cluster: Annotated[float, Meta(ge=1)] = 5.0
    """Mean number of caps that come up together."""
    spread: Annotated[float, Meta(ge=0.2, le=2)] = 0.88
    """Distance of a cap from the one it came up beside, in sums of their radii."""
    height: Annotated[float, Meta(ge=0.4, le=4)] = 1.0
    """Mean height of a cap's middle over the soil, in its own radii."""
    height_spread: Annotated[float, Meta(ge=0, le=1.5)] = 0.14
    """Standard deviation of that height."""
    lean_deg: Annotated[float, Meta(ge=0, le=60)] = 8.0
    """Standard deviation of a stalk's lean, to either side."""
    squeeze: Share = 0.45
    """How far caps that meet give way in shape rather than in place."""
    irregularity: Share = 0.35
    """How far outlines wander from round without any neighbour's doing."""
    tucked: Share = 0.0
    """Share of caps that come up late, under an earlier one, and look out from behind it."""
    fused: ShareRange = (0.0, 0.6)
    """How far the flesh that feet are fused in fills the gaps between them."""


class Skin(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What caps carry; shares are of the caps that have it."""

    brown: ShareRange = (0.0, 0.35)
    """0: white Agaricus bisporus, 1: chestnut brown."""
    specks: Annotated[float, Meta(ge=0, le=40)] = 3.0
    """Mean number of specks of soil on a cap of 80 px."""
    scales: Share = 0.03
    spots: Share = 0.03
    soil: Share = 0.03
    damage: Share = 0.03


class Flesh(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What caps and stalks do with light."""

    interreflection: ShareRange = (0.85, 1.0)
    """Share of the light they throw on each other that arrives; 0: none, as in black velvet."""
    translucency: Creep = (0.3, 2.5)
    """How far light creeps in them before it comes out again: standard deviation, px."""


class Soil(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The casing between the caps."""

    brightness: ShareRange = (0.25, 1.0)
    """0: black peat, 1: brown loam."""
    relief: Annotated[float, Meta(ge=0, le=40)] = 12.0
    """Standard deviation of the surface's height, px."""
    mycelium: ShareRange = (0.15, 0.6)
    """How much of it white strands cover."""
    pinheads: ShareRange = (0.25, 0.85)
    """How densely pinheads and white crumbs stand; below 9 px and not part of the truth."""
    litter: Annotated[int, Meta(ge=0, le=200)] = 14
    """Mean number of straws and roots."""
    edge: Share = 0.1
    """Share of images in which the bed ends inside the picture."""


class Camera(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where the camera hangs and what its lens and sensor do."""

    pitch_deg: tuple[Annotated[float, Meta(ge=0, le=45)], Annotated[float, Meta(ge=0, le=45)]] = (0.0, 12.0)
    """Tilt from straight down towards the top of the picture."""
    distance: Annotated[float, Meta(ge=0.9, le=20)] = 1.35
    """From the soil in the middle of the picture, in image widths."""
    defocus: Annotated[float, Meta(ge=0, le=10)] = 3.0
    """Blur of what lies 150 px below the focus: standard deviation, px."""
    focus: ShareRange = (0.6, 1.0)
    """Where the focus lies, from the soil (0) to the highest caps (1)."""
    sharpness: Annotated[float, Meta(ge=0.3, le=3)] = 0.75
    """Blur of what is in focus: standard deviation, px, give or take a fifth."""
    vignette: ShareRange = (0.05, 0.35)
    """Light lost in the corners."""
    noise: Annotated[float, Meta(ge=0, le=10)] = 1.0
    """Sensor noise; 1 is a good camera in good light. Dark light adds to it."""
    tint: Annotated[float, Meta(ge=0, le=0.5)] = 0.03
    """Standard deviation of the white balance's error."""
    exposure: Annotated[float, Meta(ge=0.2, le=3)] = 1.0
    black: ShareRange = (0.0, 0.12)
    """Share of the picture that it takes for black."""
    crispness: ShareRange = (0.0, 0.6)
    """How much it sharpens."""
    jpeg: tuple[Annotated[int, Meta(ge=30, le=100)], Annotated[int, Meta(ge=30, le=100)]] = (84, 95)


class Settings(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Everything about a set of beds but its seed."""

    width: Annotated[int, Meta(ge=160, le=4096)] = 1280
    height: Annotated[int, Meta(ge=160, le=4096)] = 720
    forms: Annotated[tuple[Form, ...], Meta(min_length=1)] = FORMS
    """Image i gets the i-th, over and over."""
    lights: Annotated[tuple[LightSource, ...], Meta(min_length=1)] = LIGHTS
    """Changes each time the forms have gone round."""
    growth: Growth = field(default_factory=Growth)
    skin: Skin = field(default_factory=Skin)
    flesh: Flesh = field(default_factory=Flesh)
    soil: Soil = field(default_factory=Soil)
    camera: Camera = field(default_factory=Camera)

    def __post_init__(self) -> None:
        """Refuses ranges that run backwards, which the types alone let through."""
        ranges = {
            "growth.caps": self.growth.caps,
            "growth.diameters": self.growth.diameters,
            "growth.zoom": self.growth.zoom,
            "growth.fused": self.growth.fused,
            "skin.brown": self.skin.brown,
            "flesh.interreflection": self.flesh.interreflection,
            "flesh.translucency": self.flesh.translucency,
            "soil.brightness": self.soil.brightness,
            "soil.mycelium": self.soil.mycelium,
            "soil.pinheads": self.soil.pinheads,
            "camera.pitch_deg": self.camera.pitch_deg,
            "camera.focus": self.camera.focus,
            "camera.vignette": self.camera.vignette,
            "camera.black": self.camera.black,
            "camera.crispness": self.camera.crispness,
            "camera.jpeg": self.camera.jpeg,
        }
        for name, values in ranges.items():
            if list(values) != sorted(values):
                raise ValueError(f"{name} must run from the least to the greatest")


def changed(settings: Settings, changes: dict[str, Any]) -> Settings:
    """The settings with some of them replaced, as a TOML file's tables hold them.

    Raises SceneError naming the setting that is unknown or out of its range.
    """
    try:
        return msgspec.convert(_merged(msgspec.to_builtins(settings), changes), Settings)
    except msgspec.ValidationError as error:
        raise SceneError(f"These settings make no bed: {error}.") from error


def _merged(base: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    merged = dict(base)
    for key, value in changes.items():
        below = base.get(key)
        merged[key] = _merged(below, value) if isinstance(below, dict) and isinstance(value, dict) else value
    return merged
