import math
from dataclasses import replace

import numpy as np
import pytest

from fairyring.model.contour.fitted_image import fitted_image
from fairyring.model.contour.reconstruct import reconstruct, reconstruct_silhouettes
from fairyring.model.contour.result import Reconstruction
from fairyring.model.contour.silhouette import Silhouette, silhouette_of_outline
from fairyring.model.geometry.shapes import Circle, Ellipse, Outline, part_of_points, polygon_of_shape
from fairyring.model.scene.clusters import Cluster, ClusterCap, Recipe, make_cluster

WIDTH, HEIGHT = 640, 480
RECIPE = Recipe(width=WIDTH, height=HEIGHT, count=22, noise=1.0)


@pytest.fixture(scope="module")
def cluster() -> Cluster:
    return make_cluster(seed=5, recipe=replace(RECIPE, noise=0.0, margin=1.3))


def silhouettes(cluster: Cluster) -> list[Silhouette]:
    return [Silhouette(cap.mask, cap.left, cap.top) for cap in cluster.caps]


def whole_image(cap: ClusterCap) -> np.ndarray:
    image = np.zeros((HEIGHT, WIDTH), np.uint8)
    rows, columns = cap.mask.shape
    image[cap.top : cap.top + rows, cap.left : cap.left + columns] = cap.mask
    return image


def found_in(images: list[np.ndarray]) -> np.ndarray:
    height, width = images[0].shape
    caps = [Silhouette(np.ascontiguousarray(image), 0, 0) for image in images]
    return centres(reconstruct_silhouettes(caps, width=width, height=height))


def centres(found: list[Reconstruction]) -> np.ndarray:
    return np.array([each.fit.centre for each in found])


@pytest.fixture(scope="module")
def upright(cluster: Cluster) -> np.ndarray:
    return found_in([whole_image(cap) for cap in cluster.caps])


def test_a_cropped_mask_is_as_good_as_a_whole_image(cluster: Cluster, upright: np.ndarray):
    cropped = reconstruct_silhouettes(silhouettes(cluster), width=WIDTH, height=HEIGHT)
    assert centres(cropped) == pytest.approx(upright, abs=1e-6)


def test_a_shift_of_the_image_shifts_the_centres(cluster: Cluster, upright: np.ndarray):
    padded = [np.pad(whole_image(cap), ((9, 3), (17, 5))) for cap in cluster.caps]
    moved = found_in(padded)
    assert moved == pytest.approx(upright + np.array([17, 9]), abs=1e-6)


@pytest.mark.parametrize(
    ("turn", "back"),
    [
        (np.fliplr, lambda c: np.column_stack([WIDTH - c[:, 0], c[:, 1]])),
        (np.flipud, lambda c: np.column_stack([c[:, 0], HEIGHT - c[:, 1]])),
        (lambda image: np.rot90(image, 2), lambda c: (WIDTH, HEIGHT) - c),
        (np.transpose, lambda c: c[:, ::-1]),
        (np.rot90, lambda c: np.column_stack([WIDTH - c[:, 1], c[:, 0]])),
    ],
    ids=["mirrored", "upside down", "turned by 180°", "transposed", "turned by 90°"],
)
def test_a_turned_or_mirrored_image_gives_the_same_centres_turned(cluster, upright, turn, back):
    turned = back(found_in([turn(whole_image(cap)) for cap in cluster.caps]))
    assert turned == pytest.approx(upright, abs=1e-4)


def test_twice_the_size_gives_twice_the_coordinates():
    caps = [Circle(cx=150, cy=150, r=40), Circle(cx=190, cy=165, r=36)]
    once = reconstruct([[polygon_of_shape(cap)] for cap in caps[:1]], width=400, height=300)
    twice = reconstruct(
        [[[2 * value for value in polygon_of_shape(cap)]] for cap in caps[:1]], width=800, height=600
    )
    assert centres(twice) == pytest.approx(2 * centres(once), abs=0.1)


def visible(hidden: Circle, front: Circle) -> list[Outline]:
    """A cap's outline with the one in front cut out, and that one's."""
    angles = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    rim = np.column_stack([np.cos(angles), np.sin(angles)])
    back, cover = rim * hidden.r + (hidden.cx, hidden.cy), rim * front.r + (front.cx, front.cy)
    own = np.hypot(*(back - (front.cx, front.cy)).T) >= front.r
    start = int(np.flatnonzero(own & ~np.roll(own, 1))[0])
    own_arc = np.roll(back, -start, axis=0)[: own.sum()]
    edge = cover[np.hypot(*(cover - (hidden.cx, hidden.cy)).T) <= hidden.r]
    edge = edge[np.argsort(np.hypot(*(edge - own_arc[-1]).T))]
    return [[part_of_points(np.concatenate([own_arc, edge]))], [part_of_points(cover)]]


def test_two_caps_one_on_the_other_are_told_apart_and_both_found():
    back, front = Circle(cx=180, cy=150, r=45), Circle(cx=228, cy=160, r=40)
    caps = [silhouette_of_outline(outline, width=400, height=300) for outline in visible(back, front)]
    behind, before = reconstruct_silhouettes(caps, width=400, height=300)
    assert behind.fit.centre == pytest.approx((180, 150), abs=0.8)
    assert before.fit.centre == pytest.approx((228, 160), abs=0.4)
    order = fitted_image(caps, width=400, height=300).overlap_order()
    assert [order[cap][0] for cap in caps] == [0, 1]
    assert {arc.kind for arc in before.arcs} == {"visible"}
    assert [(arc.kind, arc.neighbour) for arc in behind.arcs if arc.kind == "hidden"] == [("hidden", caps[1])]
    assert sum(len(arc.points) for arc in behind.arcs) == 48
    assert behind.coverage_deg == pytest.approx(hidden_complement(back, front), abs=15)
    assert behind.fit.centre_sd is not None
    assert before.fit.centre_sd is not None
    assert behind.fit.centre_sd[0] > before.fit.centre_sd[0]
    assert behind.why.startswith("irregular: ")
    assert before.shape == "regular"


def hidden_complement(back: Circle, front: Circle) -> float:
    """Degrees of the rim of ``back`` outside ``front``, by the law of cosines."""
    away = math.dist((back.cx, back.cy), (front.cx, front.cy))
    half = math.acos((back.r**2 + away**2 - front.r**2) / (2 * back.r * away))
    return 360 - 2 * math.degrees(half)


def test_a_cap_cut_by_the_border_is_known_to_go_on_beyond_it():
    (found,) = reconstruct([[polygon_of_shape(Circle(cx=12, cy=150, r=40))]], width=400, height=300)
    assert found.fit.centre == pytest.approx((12, 150), abs=1.0)
    assert "border" in {arc.kind for arc in found.arcs}
    assert found.proposal == "ellipse"


def test_a_hollow_that_no_neighbour_explains_is_tagged_and_ignored():
    outline = visible(Circle(cx=180, cy=150, r=45), Circle(cx=228, cy=160, r=40))[0]
    (found,) = reconstruct([outline], width=400, height=300)
    assert "concave" in {arc.kind for arc in found.arcs}
    assert found.fit.centre == pytest.approx((180, 150), abs=1.5)


def test_with_little_rim_in_sight_a_circle_is_proposed():
    behind, _ = reconstruct(
        visible(Circle(cx=180, cy=150, r=40), Circle(cx=200, cy=150, r=42)), width=400, height=300
    )
    assert behind.proposal == "circle"


def cdr(found: list[Reconstruction], cluster: Cluster) -> np.ndarray:
    off = np.abs(centres(found) - [(cap.whole.cx, cap.whole.cy) for cap in cluster.caps])
    return 100 * (off / (cluster.width, cluster.height)).sum(axis=1)


def test_on_clusters_it_is_better_than_the_paper_and_says_how_far_it_may_be_off():
    clusters = [make_cluster(seed=seed, recipe=RECIPE) for seed in range(40, 46)]
    by = {}
    for method in ("map", "paper", "ellipse"):
        found = [
            reconstruct_silhouettes(silhouettes(c), width=WIDTH, height=HEIGHT, method=method)
            for c in clusters
        ]
        by[method] = np.mean(np.concatenate([cdr(f, c) for f, c in zip(found, clusters, strict=True)]))
        if method == "map":
            scores = [
                (getattr(cap.whole, axis) - each.fit.centre[k]) / each.fit.centre_sd[k]
                for f, c in zip(found, clusters, strict=True)
                for each, cap in zip(f, c.caps, strict=True)
                for k, axis in enumerate(("cx", "cy"))
            ]
    assert by["map"] < 0.6 * by["paper"] < 0.6 * by["ellipse"]
    assert 0.7 < np.sqrt(np.mean(np.clip(scores, -5, 5) ** 2)) < 1.4


def test_crumbs_of_a_mask_do_not_matter():
    whole = polygon_of_shape(Ellipse(cx=150, cy=150, a=50, b=44, theta_deg=20))
    crumb = [10.0, 10.0, 12.0, 10.0, 12.0, 12.0, 10.0, 12.0]
    clean, crumbed = (
        reconstruct([outline], width=400, height=300)[0] for outline in ([whole], [whole, crumb])
    )
    assert crumbed.fit.centre == pytest.approx(clean.fit.centre, abs=1e-9)
