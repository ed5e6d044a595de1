"""What a cap's and a stalk's surface look like before light falls on it: colour and relief.

Colours are linear reflectances, blue first, as OpenCV orders them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import cv2
import numpy as np

from fairyring.model.scene import textures
from fairyring.model.scene.caps import Cap, Surface
from fairyring.model.scene.pixels import Image, clipped, lay_over, mixed, planes, step, tinted
from fairyring.model.scene.settings import Skin

WHITE = np.array([0.85, 0.825, 0.81], np.float32)
BROWN = np.array([0.075, 0.165, 0.33], np.float32)
CREAM = np.array([0.80, 0.93, 1.0], np.float32)
"""What the underside and the flesh keep of white."""
TAN = np.array([0.16, 0.30, 0.46], np.float32)
BLOTCH = np.array([0.34, 0.53, 0.70], np.float32)
"""What a brown spot keeps of the skin under it."""
STALK = np.array([0.95, 0.985, 1.0], np.float32)
TONES = 0.05
"""Standard deviation of how bright caps are."""
DIRT = np.array([0.012, 0.018, 0.026], np.float32)
BRUISE = np.array([0.12, 0.20, 0.30], np.float32)


class Dress(NamedTuple):
    """Colour (3, rows, columns) and relief over the smooth surface, px (rows, columns)."""

    colour: Image
    relief: Image


def dress_cap(cap: Cap, surface: Surface, skin: Skin, *, brown: float, rng: np.random.Generator) -> Dress:
    """``brown`` is this cap's own. The same number of draws is made whatever the settings."""
    x, y = _turned(surface, rng)
    chances = rng.random(4)
    tone, rough, dry = rng.standard_normal(3).tolist()
    seed = rng.integers(2**32)
    blotch, pores, dark, value = textures.look_up_each(textures.skin(), x, y)

    grey = (1 + TONES * tone) + 0.025 * math.exp(0.6 * dry) * blotch
    grey += (0.016 + 0.05 * brown) * pores
    top = clipped(surface.rise * np.float32(1 / cap.dome), 0, 1)
    brownness = clipped(brown * (0.7 + 0.3 * top + 0.10 * blotch + 0.05 * pores), 0, 1)
    colour = grey * (planes(WHITE) + brownness * planes(BROWN - WHITE))
    underside = 0.8 * step(0.10, -0.15, surface.rise)
    colour *= 1 - underside * planes(1 - CREAM)
    # The larger a cap, the wider its dents and folds, and the deeper.
    dress = Dress(colour, 0.05 * pores + 0.45 * math.exp(0.5 * rough) * blotch)

    marks = np.random.default_rng(seed)
    for chance, share, carry in zip(
        chances,
        (skin.scales, skin.spots, skin.soil, skin.damage),
        (_scales, _spots, _dirt, _damage),
        strict=True,
    ):
        if chance < share:
            dress = carry(dress, cap, surface, marks)
    density = skin.specks * marks.exponential() / 20
    lay_over(dress.colour, planes(DIRT * 2), dark * (value < density * (1 + 0.6 * blotch)))
    return dress


def dress_stalk(surface: Surface, *, brown: float, rng: np.random.Generator) -> Dress:
    """White to cream, streaked lengthwise, soiled at the foot."""
    ox, oy, soiling = rng.uniform(0, 1, 3)
    x = 0.25 * surface.skin_x + np.float32(textures.SIZE * ox)
    y = surface.skin_y + np.float32(textures.SIZE * oy)
    streak = textures.look_up(textures.cloud(), x, 2.5 * y)
    colour = (1 - 0.25 * brown) * (0.97 + 0.03 * streak) * planes(WHITE * STALK)
    lay_over(colour, planes(1.3 * DIRT), 0.5 * soiling * step(0.14, 0.02, surface.rise + 0.03 * streak))
    return Dress(colour, 0.25 * streak)


def bend_normals(normal: Image, relief: Image) -> Image:
    """The normals (3, rows, columns) of a surface with the slope of a relief added."""
    bent, relief = normal.copy(), np.asarray(relief, np.float32)
    bent[0] -= cv2.Sobel(relief, cv2.CV_32F, 1, 0, ksize=1, scale=0.5)
    bent[1] -= cv2.Sobel(relief, cv2.CV_32F, 0, 1, ksize=1, scale=0.5)
    return bent


def _scales(dress: Dress, cap: Cap, surface: Surface, rng: np.random.Generator) -> Dress:
    """(a) The skin torn into brownish flakes that lift at one edge, more in some places than in others."""
    x, y = _turned(surface, rng, zoom=26 / (0.13 * cap.radius + 5))
    bend = textures.look_up(textures.cloud(), 2 * x, 2 * y)
    edge, value = textures.look_up_each(textures.plates(), x + 9 * bend, y - 9 * bend)
    flake = step(0.2, 4.5, edge + 1.1 * textures.look_up(textures.grain(), 2 * x, 2 * y))
    where = step(
        -0.6, 1.2, textures.look_up(textures.cloud(), 0.25 * x, 0.25 * y) + 0.5 * rng.standard_normal()
    )
    strength = flake * where * step(0.15, 0.9, value) * rng.uniform(0.5, 0.95)
    tip = strength * step(3.5, 0.5, edge)
    colour = mixed(dress.colour, dress.colour * planes(TAN * 1.6), 0.8 * strength)
    return Dress(mixed(colour, dress.colour * planes(TAN * 0.8), 0.6 * tip), dress.relief + 1.6 * strength)


def _spots(dress: Dress, cap: Cap, surface: Surface, rng: np.random.Generator) -> Dress:
    """(b) Brown blotches with soft edges, as bacteria leave them."""
    x, y = _turned(surface, rng, zoom=110 / cap.radius)
    patches = textures.look_up(textures.cloud(), x, y) + 0.25 * textures.look_up(
        textures.grain(), 0.2 * x, 0.2 * y
    )
    least = rng.uniform(-0.1, 0.9)
    strength = step(least, least + rng.uniform(1.3, 3.0), patches) * rng.uniform(0.5, 1.0)
    return dress._replace(colour=mixed(dress.colour, dress.colour * planes(BLOTCH), strength))


def _dirt(dress: Dress, cap: Cap, surface: Surface, rng: np.random.Generator) -> Dress:
    """(c) Crumbs of casing soil carried up on the cap, heaped on one side, with a smear around them."""
    x, y = _turned(surface, rng, zoom=rng.uniform(1.2, 2.4))
    lumps = textures.look_up(textures.clods(), x, y) + 0.6 * textures.look_up(textures.grain(), x, y)
    angle, out = rng.uniform(0, 2 * np.pi), cap.radius * rng.uniform(0.2, 1.0)
    off = np.hypot(surface.skin_x - out * math.cos(angle), surface.skin_y - out * math.sin(angle))
    heap = np.clip(1.4 - off / (cap.radius * rng.uniform(0.15, 0.55)), -1.2, 1.2)
    strength = step(1.5, 2.1, lumps + heap)
    colour = tinted(1.8 + 0.9 * np.clip(lumps, -1.5, 2.5), DIRT)
    smear = 0.45 * step(0.6, 2.0, 0.5 * lumps + heap)
    under = mixed(dress.colour, dress.colour * planes(CREAM * 0.35), smear)
    return Dress(mixed(under, colour, strength), dress.relief + strength * (2.0 + lumps))


def _damage(dress: Dress, cap: Cap, surface: Surface, rng: np.random.Generator) -> Dress:
    """(h) What tools and hands leave: cuts, scraped-off skin and bruises."""
    for _ in range(int(rng.integers(1, 4))):
        dress = (_cut, _scrape, _bruise)[int(rng.integers(3))](dress, cap, surface, rng)
    return dress


def _cut(dress: Dress, cap: Cap, surface: Surface, rng: np.random.Generator) -> Dress:
    along, across = _place_on(cap, surface, rng)
    waver = textures.look_up(textures.cloud(), along * 3, np.full_like(along, rng.uniform(0, 1000)))
    half = cap.radius * rng.uniform(0.25, 0.7)
    wide = np.maximum(rng.uniform(0.02, 0.06) * cap.radius, 0.8) * np.sqrt(
        np.clip(1 - (along / half) ** 2, 0, 1)
    )
    off = np.abs(across + 0.04 * cap.radius * waver)
    gash = step(wide + 0.6, wide - 0.6, off)
    lip = step(2.6 * wide + 1.5, wide, off) * (wide > 0.3)
    colour = mixed(mixed(dress.colour, dress.colour * planes(BLOTCH), 0.5 * lip), planes(BRUISE * 0.5), gash)
    return Dress(colour, dress.relief + 1.5 * lip - 3.0 * gash)


def _scrape(dress: Dress, cap: Cap, surface: Surface, rng: np.random.Generator) -> Dress:
    along, across = _place_on(cap, surface, rng)
    ragged = 0.22 * textures.look_up(textures.cloud(), 5 * along, 5 * across)
    size = cap.radius * rng.uniform(0.12, 0.32)
    off = np.hypot(along / (size * rng.uniform(1.0, 2.2)), across / size) + ragged
    bare, rim = step(1.05, 0.9, off), step(1.2, 1.0, off) * step(0.75, 1.0, off)
    fibres = 0.9 + 0.08 * textures.look_up(textures.grain(), 0.4 * along, 1.5 * across)
    flesh = mixed(dress.colour, tinted(fibres * rng.uniform(0.5, 0.85), WHITE * CREAM * CREAM), bare)
    return Dress(mixed(flesh, planes(BRUISE), 0.35 * rim), dress.relief - 0.06 * cap.radius * bare)


def _bruise(dress: Dress, cap: Cap, surface: Surface, rng: np.random.Generator) -> Dress:
    along, across = _place_on(cap, surface, rng)
    cloudy = 0.25 * textures.look_up(textures.cloud(), 3 * along, 3 * across)
    size = cap.radius * rng.uniform(0.2, 0.5)
    off = np.hypot(along / (size * rng.uniform(1.0, 1.8)), across / size) + cloudy
    return Dress(
        mixed(dress.colour, dress.colour * planes(BLOTCH), rng.uniform(0.5, 1.0) * step(1.1, 0.4, off)),
        dress.relief - 0.03 * cap.radius * step(1.0, 0.0, off),
    )


def _place_on(cap: Cap, surface: Surface, rng: np.random.Generator) -> tuple[Image, Image]:
    """Coordinates (px) around a random place on the cap, turned a random way."""
    angle, turn = rng.uniform(0, 2 * np.pi, 2)
    out = cap.radius * 0.85 * np.sqrt(rng.random())
    x, y = surface.skin_x - out * np.cos(angle), surface.skin_y - out * np.sin(angle)
    along = x * np.cos(turn) + y * np.sin(turn)
    return along.astype(np.float32), (y * np.cos(turn) - x * np.sin(turn)).astype(np.float32)


def _turned(surface: Surface, rng: np.random.Generator, *, zoom: float = 1.0) -> tuple[Image, Image]:
    """Where to look a tile up: the skin's coordinates, turned and moved at random."""
    angle = rng.uniform(0, 2 * np.pi)
    ox, oy = rng.uniform(0, textures.SIZE, 2)
    cosine, sine = zoom * np.cos(angle), zoom * np.sin(angle)
    x = surface.skin_x * cosine - surface.skin_y * sine + ox
    y = surface.skin_x * sine + surface.skin_y * cosine + oy
    return x.astype(np.float32), y.astype(np.float32)
