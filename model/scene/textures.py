"""Tiles of noise that everything on a bed is textured with.

Every tile is float32 and repeats seamlessly, is made once a process from a fixed seed, and is looked up at a
random place, turned a random way, so that two caps never carry the same skin.
"""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

Tile = NDArray[Any]
"""float32 (side, side) or (side, side, channels); the last row and column repeat the first."""

SIZE = 1024
SPECK_CELL = 16
CLUMPS = 1000
"""Of crumbs on a tile."""


def look_up(tile: Tile, x: Tile, y: Tile) -> Tile:
    """The tile at float32 coordinates of any size, repeating; bilinear."""
    side = np.float32(len(tile) - 1)
    x = x - side * np.floor(x / side)
    y = y - side * np.floor(y / side)
    return cv2.remap(tile, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def look_up_each(tile: Tile, x: Tile, y: Tile) -> tuple[Tile, ...]:
    """The same, every channel a picture of its own."""
    return tuple(cv2.split(look_up(tile, x, y)))


@cache
def cloud() -> Tile:
    """Soft clouds of all sizes: mean 0, standard deviation 1."""
    return _noise(seed=1, slope=1.7, coarsest=300.0, finest=6.0)


@cache
def clods() -> Tile:
    """Lumps of soil with creases between: mean 0, standard deviation 1."""
    lumps = sum(
        size * np.abs(_noise(seed=10 + octave, slope=1.0, coarsest=2.0 * size, finest=0.6 * size))
        for octave, size in enumerate((70.0, 34.0, 16.0, 8.0))
    )
    grit = _noise(seed=14, slope=0.3, coarsest=6.0, finest=2.0)
    return _standardised(np.asarray(lumps) + 2.0 * grit).astype(np.float32)


@cache
def threads() -> Tile:
    """Strands: 1 on a strand, falling to 0 away from it, branching at several sizes."""
    strands = np.zeros((SIZE + 1, SIZE + 1), np.float32)
    for octave, size in enumerate((120.0, 60.0, 30.0)):
        wave = _noise(seed=20 + octave, slope=1.4, coarsest=2 * size, finest=6.0)
        strands = np.maximum(strands, np.exp(-((np.abs(wave) / 0.09) ** 1.2)) * (1.0 - 0.2 * octave))
    return strands.astype(np.float32)


@cache
def grain() -> Tile:
    """Fine, even noise: mean 0, standard deviation 1."""
    return _noise(seed=30, slope=0.5, coarsest=10.0, finest=1.6)


@cache
def skin() -> Tile:
    """Channels: blotches and pores, each mean 0, deviation 1; how dark a speck is, and a value a speck."""
    return np.dstack([cloud(), _noise(seed=41, slope=0.2, coarsest=7.0, finest=1.8), *_specks()])


@cache
def earth() -> Tile:
    """Channels: clods, regions, grit, strands, as the tiles of these names."""
    return np.dstack([clods(), cloud(), grain(), threads()])


@cache
def cover() -> Tile:
    """What lies on earth. Channels: fluff, mean 0, deviation 1; wisps as ``threads``, finer; height of
    crumbs, px, and a value a crumb."""
    fluff = _noise(seed=45, slope=1.5, coarsest=130.0, finest=3.0)
    wisps = np.zeros((SIZE + 1, SIZE + 1), np.float32)
    for octave, size in enumerate((50.0, 26.0, 14.0)):
        wave = _noise(seed=46 + octave, slope=1.3, coarsest=2 * size, finest=2.5)
        wisps = np.maximum(wisps, np.exp(-((np.abs(wave) / 0.13) ** 1.2)) * (1.0 - 0.15 * octave))
    return np.dstack([fluff, wisps, *_crumbs()]).astype(np.float32)


@lru_cache(maxsize=2)
def sensor(width: int) -> Tile:
    """Noise of a sensor, in brightness and colour, smeared as demosaicing does.

    (3, SIZE, SIZE + width), so that a picture of this width fits in anywhere.
    """
    rng = np.random.default_rng(80)
    grain = cv2.GaussianBlur(rng.standard_normal((SIZE, SIZE), np.float32), (0, 0), 0.7)
    blots = cv2.resize(rng.standard_normal((SIZE // 2, SIZE // 2, 3), np.float32), (SIZE, SIZE))
    noise = (2 * grain[..., None] + 0.6 * blots).transpose(2, 0, 1)
    return np.ascontiguousarray(np.pad(noise, ((0, 0), (0, 0), (0, width)), mode="wrap"), dtype=np.float32)


@cache
def plates() -> Tile:
    """Cells of about 24 px: channel 0 is the distance to the cell's border, px, channel 1 a value a cell."""
    rng = np.random.default_rng(50)
    count = (SIZE // 24) ** 2
    seeds = np.ones((SIZE, SIZE), np.uint8)
    seeds[tuple(rng.integers(0, SIZE, (2, count)))] = 0
    tiled = np.pad(seeds, 96, mode="wrap")
    _, labels = cv2.distanceTransformWithLabels(tiled, cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)
    owner = labels.astype(np.intp)
    border = (owner != np.roll(owner, 1, axis=0)) | (owner != np.roll(owner, 1, axis=1))
    distance = cv2.distanceTransform((~border).astype(np.uint8), cv2.DIST_L2, 5)
    value = rng.random(int(owner.max()) + 1)[owner]
    inner = slice(96, -96)
    return _closed(np.dstack([distance[inner, inner], value[inner, inner]]))


def _specks() -> list[Tile]:
    """Specks one to a cell of SPECK_CELL px: how dark, and a value a cell in [0, 1]."""
    rng = np.random.default_rng(70)
    cells = SIZE // SPECK_CELL
    value = np.kron(rng.random((cells, cells)), np.ones((SPECK_CELL, SPECK_CELL)))
    dark = np.zeros_like(value)
    offset = np.arange(SPECK_CELL) + 0.5 - SPECK_CELL / 2
    for row in range(cells):
        for column in range(cells):
            (x, y), angle = rng.uniform(-5.5, 5.5, 2), rng.uniform(0, np.pi)
            long, wide = rng.lognormal(0.2, 0.45), rng.lognormal(-0.25, 0.35)
            dx, dy = np.meshgrid(offset - x, offset - y)
            along, across = dx * np.cos(angle) + dy * np.sin(angle), dy * np.cos(angle) - dx * np.sin(angle)
            spot = np.clip(1.4 - np.hypot(along / long, across / wide), 0, 1) * rng.uniform(0.5, 1.0)
            dark[row * SPECK_CELL :, column * SPECK_CELL :][:SPECK_CELL, :SPECK_CELL] = spot
    return [_closed(dark), _closed(value)]


def _crumbs() -> list[Tile]:
    """Pinheads and white crumbs, grown together in clumps: their height over the soil, px, and a value in
    [0, 1] that is much the same throughout a clump."""
    rng = np.random.default_rng(60)
    height = np.zeros((SIZE, SIZE), np.float32)
    value = np.zeros((SIZE, SIZE), np.float32)
    for _ in range(CLUMPS):
        place, rank = rng.uniform(0, SIZE, 2), rng.random()
        heading = rng.uniform(0, 2 * np.pi)
        size = rng.lognormal(0.0, 0.3)
        for _ in range(int(rng.geometric(1 / 9))):
            # Clumps follow strands: they grow on in about the direction they came from.
            heading += rng.normal(0, 0.9)
            place = place + size * rng.uniform(1.0, 4.0) * np.array([np.cos(heading), np.sin(heading)])
            radius = float(np.clip(size * rng.lognormal(0.75, 0.45), 0.9, 6.0))
            own = float(np.clip(rank + 0.06 * rng.standard_normal(), 0.002, 1))
            _raise_crumb(height, value, *(place + rng.normal(0, 2.0, 2)), radius=radius, own=own, rng=rng)
    knobs = _noise(seed=61, slope=0.8, coarsest=14.0, finest=2.5)[:-1, :-1]
    height *= np.clip(1 + 0.28 * knobs, 0.1, 2)
    # Each value reaches a little beyond its crumb, lest it fade at the rim between pixels.
    beyond = cv2.dilate(value, np.ones((5, 5), np.uint8))
    return [_closed(height), _closed(np.where(height > 0, value, beyond))]


def _raise_crumb(
    height: Tile, value: Tile, x: float, y: float, *, radius: float, own: float, rng: np.random.Generator
) -> None:
    reach = int(radius * 1.5) + 2
    columns = np.arange(int(x) - reach, int(x) + reach + 1)
    rows = np.arange(int(y) - reach, int(y) + reach + 1)
    dx, dy = np.meshgrid(columns - x, rows - y)
    stretch, angle = rng.uniform(1.0, 1.6), rng.uniform(0, np.pi)
    along = (dx * np.cos(angle) + dy * np.sin(angle)) / stretch
    across = (dy * np.cos(angle) - dx * np.sin(angle)) * stretch
    dome = 1.3 * np.sqrt(np.maximum(radius**2 - along**2 - across**2, 0))
    where = np.ix_(rows % len(height), columns % len(height))
    higher = dome > height[where]
    height[where] = np.where(higher, dome, height[where])
    value[where] = np.where(higher, own, value[where])


def _noise(*, seed: int, slope: float, coarsest: float, finest: float) -> Tile:
    """Gaussian noise of amplitude ∝ frequency^-slope between two wavelengths in px."""
    frequency = np.hypot(np.fft.fftfreq(SIZE)[:, None], np.fft.rfftfreq(SIZE)[None])
    frequency[0, 0] = 1.0
    band = np.exp(-((frequency * finest / 2) ** 2)) * -np.expm1(-((frequency * coarsest) ** 4))
    band[0, 0] = 0.0
    white = np.fft.rfft2(np.random.default_rng(seed).standard_normal((SIZE, SIZE)))
    return _closed(_standardised(np.fft.irfft2(white * band * frequency**-slope, s=(SIZE, SIZE))))


def _standardised(values: NDArray[np.floating]) -> Tile:
    return (values - values.mean()) / values.std()


def _closed(values: NDArray[np.floating]) -> Tile:
    """Row and column 0 once more at the end, so that a look-up need never reach across."""
    edges = [(0, 1), (0, 1)] + [(0, 0)] * (values.ndim - 2)
    return np.ascontiguousarray(np.pad(values, edges, mode="wrap"), dtype=np.float32)
