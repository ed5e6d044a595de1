from pathlib import Path

import numpy as np
import pytest

from model.contour.coco import ContourError
from model.contour.estimate import estimate_priors
from model.contour.priors import DEFAULT, PriorsError, read_priors, write_priors
from model.raster import rle_of_mask
from model.scene.clusters import Recipe, make_cluster

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
    priors = estimate_priors(labels(6), source="clusters")
    assert priors.source == "clusters"
    assert priors.stretch == pytest.approx(0.06, rel=0.25)
    assert priors.wobble == pytest.approx(RECIPE.wobble, rel=0.4)
    assert 0.05 <= priors.size < 0.4


def test_too_few_caps_are_refused():
    with pytest.raises(ContourError, match="30 caps"):
        estimate_priors(labels(1) | {"annotations": labels(1)["annotations"][:3]}, source="three caps")


def test_what_is_no_coco_document_is_refused():
    with pytest.raises(ContourError, match="not a COCO document"):
        estimate_priors([1, 2], source="a list")


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
