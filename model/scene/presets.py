"""Settings with a name, and what each of the paper's eight forms (Figure 3) changes in them."""

from __future__ import annotations

from collections.abc import Callable

from msgspec.structs import replace

from fairyring.model.light_and_form import LightSource
from fairyring.model.scene.settings import Camera, Flesh, Growth, SceneError, Settings, Skin, Soil

PRESETS: dict[str, Settings] = {
    "default": Settings(),
    "paper": Settings(growth=Growth(caps=(50, 65), diameters=(16, 32, 68, 118, 200), cluster=8.0)),
    "farm": Settings(
        forms=("",),
        lights=(LightSource.top,),
        growth=Growth(
            caps=(225, 265),
            diameters=(13, 25, 42, 66, 107),
            cluster=9.0,
            spread=0.85,
            height=1.0,
            height_spread=0.25,
            lean_deg=11.0,
            squeeze=0.2,
            irregularity=0.45,
            fused=(0.3, 0.8),
        ),
        skin=Skin(brown=(0.0, 0.03), specks=3.0, scales=0.0, spots=0.0, soil=0.004, damage=0.004),
        flesh=Flesh(translucency=(0.5, 2.8)),
        soil=Soil(
            brightness=(0.0, 0.4),
            relief=7.0,
            mycelium=(0.15, 0.5),
            pinheads=(0.45, 0.8),
            litter=8,
            edge=0.8,
        ),
        camera=Camera(
            pitch_deg=(0.0, 6.0),
            distance=1.3,
            vignette=(0.1, 0.3),
            defocus=4.0,
            sharpness=0.6,
            tint=0.03,
            exposure=1.04,
            black=(0.115, 0.13),
            crispness=(0.6, 1.0),
            jpeg=(85, 95),
        ),
    ),
    "mixed": Settings(
        forms=("", "d", "", "e", "", "", "f", "", "g", "", "b", "", "c", "", "h", "", "a", ""),
        lights=(*(LightSource.top,) * 9, LightSource.side, LightSource.dark),
        growth=Growth(
            caps=(190, 250),
            diameters=(13, 26, 44, 70, 120),
            zoom=(0.65, 1.25),
            cluster=9.0,
            spread=0.85,
            height_spread=0.25,
            lean_deg=11.0,
            squeeze=0.2,
            irregularity=0.45,
            tucked=0.12,
            fused=(0.0, 0.9),
        ),
        skin=Skin(brown=(0.0, 0.25), specks=3.0, scales=0.01, spots=0.01, soil=0.01, damage=0.01),
        flesh=Flesh(translucency=(0.3, 2.4)),
        soil=Soil(brightness=(0.0, 0.6), relief=9.0, mycelium=(0.05, 0.6), edge=0.3),
        camera=Camera(defocus=4.0, sharpness=0.6, tint=0.05, black=(0.05, 0.13), crispness=(0.5, 1.0)),
    ),
}
"""``default`` is a mixture, ``paper`` the data set of section 3, ``farm`` like real photos of a farm, and
``mixed``, to learn from, like ``farm`` at many scales, half of it of some form, a little in other lights."""


def preset(name: str) -> Settings:
    """Raises SceneError where there is no such preset."""
    if name not in PRESETS:
        raise SceneError(f"There is no preset {name!r}; choose one of {', '.join(PRESETS)}.")
    return PRESETS[name]


def with_form(settings: Settings, form: str) -> Settings:
    """The settings of one image with the paper's forms a–h applied, one after the other."""
    for letter in form:
        settings = _FORMS[letter](settings)
    return settings


def _scales(settings: Settings) -> Settings:
    return replace(settings, skin=replace(settings.skin, scales=0.85))


def _spots(settings: Settings) -> Settings:
    return replace(settings, skin=replace(settings.skin, spots=0.8))


def _soil(settings: Settings) -> Settings:
    return replace(settings, skin=replace(settings.skin, soil=0.75, specks=min(settings.skin.specks * 4, 40)))


def _clumped(settings: Settings) -> Settings:
    growth = settings.growth
    return replace(
        settings,
        growth=replace(growth, cluster=growth.cluster * 3, spread=growth.spread * 0.72, squeeze=0.7),
    )


def _uneven(settings: Settings) -> Settings:
    growth = settings.growth
    median, largest = growth.diameters[2], max(growth.diameters[4], 200.0)
    least, tenth, _, ninetieth, _ = (median * (d / median) ** 1.3 for d in growth.diameters)
    least, ninetieth = max(least, 10.0), min(ninetieth, 0.8 * largest)
    diameters = (least, max(tenth, least), median, ninetieth, largest)
    return replace(settings, growth=replace(growth, diameters=diameters, height_spread=0.8))


def _squeezed(settings: Settings) -> Settings:
    growth = settings.growth
    return replace(
        settings,
        growth=replace(
            growth,
            cluster=growth.cluster * 2,
            spread=growth.spread * 0.65,
            squeeze=1.0,
            height_spread=0.1,
            irregularity=0.9,
        ),
    )


def _tilted(settings: Settings) -> Settings:
    return replace(settings, growth=replace(settings.growth, lean_deg=34.0, height=1.6, cluster=4.0))


def _damaged(settings: Settings) -> Settings:
    return replace(settings, skin=replace(settings.skin, damage=0.7))


_FORMS: dict[str, Callable[[Settings], Settings]] = {
    "a": _scales,
    "b": _spots,
    "c": _soil,
    "d": _clumped,
    "e": _uneven,
    "f": _squeezed,
    "g": _tilted,
    "h": _damaged,
}
