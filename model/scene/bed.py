"""Renders one bed: grows it, hangs the camera, lights it, takes the photo and tells the truth about it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from fairyring.model.light_and_form import LightSource
from fairyring.model.scene.caps import Cap, shape_caps
from fairyring.model.scene.focus import blur_of
from fairyring.model.scene.growth import Rectangle, Stand, grow, zoomed
from fairyring.model.scene.interreflection import throw
from fairyring.model.scene.layers import (
    Layer,
    Owners,
    Seen,
    look_at,
    own_pixels,
    stack_layers,
    window,
)
from fairyring.model.scene.lens import Shot, draw_shot, expose
from fairyring.model.scene.light import Light, draw_light
from fairyring.model.scene.pixels import Image, lay_over
from fairyring.model.scene.presets import with_form
from fairyring.model.scene.settings import Camera, Settings
from fairyring.model.scene.shade import cast_shade
from fairyring.model.scene.shine import shine
from fairyring.model.scene.skin import bend_normals, dress_cap, dress_stalk
from fairyring.model.scene.soil import Bare, Sowing, draw_sowing, lay_soil
from fairyring.model.scene.stalks import Stalk, shape_stalks
from fairyring.model.scene.tissue import raise_tissue
from fairyring.model.scene.translucency import creep
from fairyring.model.scene.truth import BedCap, tell_truth
from fairyring.model.scene.view import View, bounds_of_ground, hang_camera, see_ground


class Bed(NamedTuple):
    """A photo and the truth about it."""

    image: NDArray[np.uint8]
    """(height, width, 3), blue first."""
    caps: tuple[BedCap, ...]
    """From the lowest to the highest."""
    owners: Owners
    light: LightSource
    form: str
    jpeg: int
    """Quality to write it at."""


class _Body(NamedTuple):
    """What was drawn for the flesh of one image, as in ``settings.Flesh`` and ``settings.Growth``."""

    interreflection: float
    translucency: float
    fused: float


class _Planted(NamedTuple):
    """The mushrooms of a bed in the view, and whose each pixel is."""

    stand: Stand
    caps: list[Cap]
    seen: list[Seen]
    owners: Owners
    stalks: list[Stalk]
    """Of the caps in the picture."""


def render_bed(settings: Settings, *, seed: int, index: int = 0) -> Bed:
    """Bed number ``index`` of a set: the same numbers give the same bytes, whatever else is rendered."""
    form, source = kind_of(settings, index)
    settings = with_form(settings, form)
    rng = np.random.default_rng([seed, index])
    zoom = float(np.exp(rng.uniform(*np.log(settings.growth.zoom))))
    settings = replace(settings, growth=zoomed(settings.growth, zoom))
    shot = draw_shot(settings.camera, rng)
    light = draw_light(source, rng)
    body = _draw_body(settings, rng)
    sowing = draw_sowing(settings.soil, width=settings.width, rng=rng)
    view = hang_camera(
        width=settings.width,
        height=settings.height,
        pitch_deg=shot.pitch_deg,
        distance=settings.camera.distance,
    )
    ground = see_ground(view)
    planted = _plant(settings, view, bounds_of_ground(ground), sowing, rng)
    scene = lay_soil(settings.soil, sowing, ground=ground, view=view, feet=planted.stand.foot, rng=rng)
    tissue = raise_tissue(scene, planted.stalks, amount=body.fused, rng=rng)
    _clothe(planted, scene, settings, rng)
    flesh = np.where(planted.owners != 0, np.float32(1), tissue)
    lit = _lit(scene, flesh, body, light)
    blur = _blur(scene.z, view, settings.camera, shot)
    image = expose(lit, blur, camera=settings.camera, shot=shot, dimness=light.dimness, rng=rng)
    told = tell_truth(planted.caps, planted.seen, planted.owners)
    return Bed(image, told, planted.owners, source, form, shot.jpeg)


def _draw_body(settings: Settings, rng: np.random.Generator) -> _Body:
    flesh = settings.flesh
    return _Body(
        rng.uniform(*flesh.interreflection),
        rng.uniform(*flesh.translucency),
        rng.uniform(*settings.growth.fused),
    )


def kind_of(settings: Settings, index: int) -> tuple[str, LightSource]:
    """Form and light of image ``index``: every pair of them in turn, equally often."""
    forms, lights = len(settings.forms), len(settings.lights)
    # Where the two cycles fall into step, the lights move on by one, so that no pair is left out.
    round_ = index // math.lcm(forms, lights)
    return settings.forms[index % forms], settings.lights[(index + round_) % lights]


def _fertile(sight: Rectangle, sowing: Sowing, *, margin: float) -> Rectangle:
    """The soil in sight and a margin around it, up to the bed's edge."""
    left, top, right, bottom = sight
    around = (left - margin, top - margin, right + margin, bottom + margin)
    if sowing.edge is None:
        return around
    where, side = sowing.edge
    return (where + 25, *around[1:]) if side < 0 else (*around[:2], where - 25, around[3])


def _plant(
    settings: Settings, view: View, sight: Rectangle, sowing: Sowing, rng: np.random.Generator
) -> _Planted:
    """Grows more than is wanted, then picks mushrooms until the count in sight is right."""
    growth = settings.growth
    wanted = int(rng.integers(growth.caps[0], growth.caps[1] + 1))
    fertile = _fertile(sight, sowing, margin=min(growth.diameters[4], 2 * growth.diameters[3]) / 2)
    surplus = _area(fertile) / _area(_fertile(sight, sowing, margin=0))
    count = math.ceil(1.25 * wanted * surplus)
    while True:
        stand = grow(growth, count=count, ground=fertile, rng=rng)
        caps, stalks = shape_caps(stand, view, growth, rng), shape_stalks(stand, view, rng)
        layers = stack_layers(caps, stalks, width=view.width, height=view.height)
        owners = own_pixels(layers, width=view.width, height=view.height)
        shares = {layer.mushroom: _in_sight(layer, owners) for layer in layers if layer.is_cap}
        in_sight = np.array([cap for cap, share in shares.items() if share > 0])
        if len(in_sight) >= wanted:
            break
        count = math.ceil(1.2 * count)
    # What has been overgrown comes to nothing more often than what stands free.
    vigour = [shares[cap] for cap in in_sight.tolist()] + rng.random(len(in_sight))
    kept = set(in_sight[np.argsort(-vigour)[:wanted]].tolist())
    left_over = [layer for layer in layers if layer.mushroom in kept]
    owners = own_pixels(left_over, width=view.width, height=view.height)
    standing = [stalks[cap] for cap in sorted(kept)]
    return _Planted(stand, caps, look_at(left_over, owners, caps, stalks), owners, standing)


def _in_sight(layer: Layer, owners: Owners) -> float:
    return np.count_nonzero(owners[window(layer.box)] == layer.owner) / layer.area


def _area(ground: Rectangle) -> float:
    left, top, right, bottom = ground
    return (right - left) * (bottom - top)


def _clothe(planted: _Planted, bare: Bare, settings: Settings, rng: np.random.Generator) -> None:
    """Lays every cap and stalk over what lies under it; edges are mixed, surfaces as well as colours."""
    brown = rng.uniform(*settings.skin.brown)
    for part in planted.seen:
        own = float(np.clip(brown * rng.normal(1, 0.12), 0, 1))
        surface = part.surface
        if part.layer.is_cap:
            dress = dress_cap(planted.caps[part.layer.mushroom], surface, settings.skin, brown=own, rng=rng)
        else:
            dress = dress_stalk(surface, brown=own, rng=rng)
        here = window(part.box)
        lay_over(bare.colour[:, *here], dress.colour, surface.cover)
        # What turns away from the light at a rim must not be lit like the ground behind it.
        turned = (2 * surface.cover).clip(0, 1)
        lay_over(bare.normal[:, *here], bend_normals(surface.normal, dress.relief), turned)
        lay_over(bare.z[here], surface.z, turned)


def _lit(scene: Bare, flesh: Image, body: _Body, light: Light) -> Image:
    """Linear light that surfaces send to the camera, (3, rows, columns)."""
    fallen = shine(scene.normal, scene.z, light=light, shade=cast_shade(scene.z, light))
    throw(fallen, scene.colour, amount=body.interreflection)
    creep(fallen.light, flesh, reach=body.translucency)
    return fallen.light * scene.colour


def _blur(z: Image, view: View, camera: Camera, shot: Shot) -> Image:
    """By depth, the focus lying between the soil and the highest caps."""
    low, high = np.percentile(z[::8, ::8], (2, 99)).tolist()
    focus = low + shot.focus * (high - low)
    return blur_of(z, focus=focus, distance=view.distance, defocus=camera.defocus)
