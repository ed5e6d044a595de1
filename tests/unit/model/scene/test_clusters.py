import numpy as np
import pytest

from fairyring.model.scene.clusters import Recipe, make_cluster


def test_the_same_seed_gives_the_same_cluster_and_another_one_another():
    first, again, other = (make_cluster(seed=seed) for seed in (3, 3, 4))
    assert [cap.mask.tobytes() for cap in first.caps] == [cap.mask.tobytes() for cap in again.caps]
    assert [cap.whole for cap in first.caps] != [cap.whole for cap in other.caps]


def test_the_recipe_hides_about_as_many_caps_as_it_says():
    seen = np.array([cap.visible_fraction for seed in range(6) for cap in make_cluster(seed=seed).caps])
    assert len(seen) == 6 * 55
    assert 0.3 < (seen < 0.97).mean() < 0.6
    assert 0.06 < (seen < 0.6).mean() < 0.25
    assert seen.min() >= 0.1


def test_a_cap_in_full_view_covers_its_outline():
    for cap in make_cluster(seed=1).caps:
        if cap.visible_fraction > 0.999:
            x, y = cap.outline.T
            area = abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
            assert cap.mask.sum() == pytest.approx(area, rel=0.02)


def test_noise_moves_outlines_by_as_much_as_asked():
    calm = make_cluster(seed=2)
    rough = make_cluster(seed=2, recipe=Recipe(noise=2.0))
    changed = 0.0
    rim = 0.0
    for before, after in zip(calm.caps, rough.caps, strict=True):
        image = np.zeros((2, 800, 1400), bool)
        for layer, cap in zip(image, (before, after), strict=True):
            layer[cap.top : cap.top + cap.mask.shape[0], cap.left : cap.left + cap.mask.shape[1]] = cap.mask
        changed += (image[0] ^ image[1]).sum()
        rim += 2 * np.pi * np.sqrt(before.mask.sum() / np.pi)
    # The mean absolute value of a normal deviate of standard deviation 2 is 1.6.
    assert changed / rim == pytest.approx(1.6, rel=0.25)
