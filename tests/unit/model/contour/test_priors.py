from pathlib import Path

import numpy as np
import pytest

from fairyring.model.coco.document import document_of
from fairyring.model.contour.coco import ContourError
from fairyring.model.contour.estimate import estimate_priors
from fairyring.model.contour.priors import DEFAULT, PriorsError, read_priors, write_priors
from fairyring.model.geometry.raster import rle_of_mask
from fairyring.model.scene.clusters import Recipe, make_cluster

RECIPE = Recipe(width=640, height=480, count=24, stretch=0.06, wobble=(0.02, 0.012, 0.008), noise=0.4)


def labels(clusters: int) -> dict:
    images, annotations = [], []
    for seed in range(clusters):
        cluster = make_cluster(seed=100 + seed, recipe=RECIPE)
        images.append({"id": seed + 1, "file_name": f"{seed}.png", "width": 640, "height": 480})
        for cap in cluster.caps:
            mask = np.zeros((480, 640), np.uint8)
            mask[cap.top : cap.top + cap.mask.shape[0], cap.left : cap.left + cap.mask.shape[1]] = cap.mask
            whole = cap.whole
            annotations.append(
                {
                    "id": len(annotations) + 1,
                    "image_id": seed + 1,
                    "segmentation": rle_of_mask(mask),
                    "ellipse": [whole.cx, whole.cy, whole.a, whole.b, whole.theta_deg],
                }
            )
    return {"images": images, "annotations": annotations}


def test_priors_come_close_to_the_shapes_that_the_caps_were_made_with():
    priors = estimate_priors(document_of(labels(6)), source="clusters")
    assert priors.source == "clusters"
    assert priors.stretch == pytest.approx(0.06, rel=0.25)
    assert priors.wobble == pytest.approx(RECIPE.wobble, rel=0.4)
    assert 0.05 <= priors.size < 0.4


def wavering(deviation: float, *, seed: int) -> np.ndarray:
    """How far a rim of radius 40 lies outside its circle, at 1000 angles: smooth over 4.8 px, px."""
    rng = np.random.default_rng(seed)
    waves = np.arange(501)
    spectrum = np.exp(-0.5 * (waves * 4.8 / 40) ** 2)
    wavering = np.fft.irfft(spectrum * np.fft.rfft(rng.normal(size=1000)))
    return deviation * wavering / np.sqrt(2 * np.sum(spectrum[1:] ** 2) / 1000 + spectrum[0] ** 2 / 1000)


def noisy_discs(deviation: float) -> tuple[dict, np.ndarray]:
    """Labels of 3 × 24 discs that touch nobody, and their waverings (72, 1000)."""
    angles = np.arange(1000) * 2 * np.pi / 1000
    waverings = np.array([wavering(deviation, seed=seed) for seed in range(72)])
    annotations = []
    for number, away in enumerate(waverings):
        x, y = 55 + 104.3 * (number % 6), 60 + 118.7 * (number // 6 % 4)
        ring = np.column_stack([x + (40 + away) * np.cos(angles), y + (40 + away) * np.sin(angles)])
        annotations.append({"id": number, "image_id": number // 24, "segmentation": [ring.ravel().tolist()]})
    images = [{"id": i, "file_name": f"{i}.png", "width": 640, "height": 480} for i in range(3)]
    return {"images": images, "annotations": annotations}, waverings


@pytest.mark.parametrize("deviation", [0.6, 1.0])
def test_noise_is_what_is_left_of_the_known_wavering_by_outlines_of_five_harmonics(deviation: float):
    document, waverings = noisy_discs(deviation)
    priors = estimate_priors(document_of(document), source="discs")
    spectrum = np.fft.rfft(waverings)
    # An outline follows the waves up to the fifth; a rim point is the mean of a 48th of the rim.
    spectrum[:, :6] = 0
    left = np.fft.irfft(spectrum * np.sinc(np.arange(501) / 48), n=1000)
    assert priors.noise == pytest.approx(left.std(), rel=0.15)
    # Variance times the length per independent sample is that of the wavering: √(4π) · 4.8 px.
    power = priors.noise_length * (priors.noise**2 - 0.018)
    assert power == pytest.approx(deviation**2 * np.sqrt(4 * np.pi) * 4.8, rel=0.4)


def test_perfect_masks_are_hardly_noisy_and_leave_the_length_as_it_is():
    priors = estimate_priors(document_of(noisy_discs(0)[0]), source="discs")
    assert 0.05 <= priors.noise < 0.2
    assert priors.noise_length == DEFAULT.noise_length


def test_too_few_caps_are_refused():
    few = document_of(labels(1) | {"annotations": labels(1)["annotations"][:3]})
    with pytest.raises(ContourError, match="30 caps"):
        estimate_priors(few, source="three caps")


@pytest.mark.parametrize(
    ("keys", "reason"),
    [
        ({"segmentation": [[1, 1, 5, 5]]}, "annotation 1: A polygon needs at least three points"),
        ({"ellipse": [10, 10, 5]}, "annotation 1: Its ellipse is not 5 finite numbers"),
        ({"ellipse": [10, 10, 5, 0, 0]}, "annotation 1: A radius must be at least 0.25 px"),
        ({"ignore": "no"}, "annotation 1: “ignore” is neither true nor false"),
    ],
)
def test_a_label_that_is_wrong_is_named(keys: dict, reason: str):
    document = labels(1)
    document["annotations"][0] |= keys
    with pytest.raises(ContourError, match=reason):
        estimate_priors(document_of(document), source="x")


def test_what_is_no_coco_document_is_refused():
    with pytest.raises(ContourError, match="list of results"):
        estimate_priors(document_of([1, 2]), source="a list")


def test_written_priors_are_read_back(tmp_path: Path):
    write_priors(DEFAULT, tmp_path / "priors.json")
    assert read_priors(tmp_path / "priors.json") == DEFAULT


@pytest.mark.parametrize(
    "text", ["", "{}", '{"source": "x", "stretch": 0, "wobble": [0.1], "size": 0.1}', "[1]", "nonsense"]
)
def test_a_file_of_anything_else_is_refused_by_name(tmp_path: Path, text: str):
    (tmp_path / "odd.json").write_text(text)
    with pytest.raises(PriorsError, match=r"odd\.json"):
        read_priors(tmp_path / "odd.json")
