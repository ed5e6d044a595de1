"""A project to choose from."""

import pytest

from fairyring.model.geometry.shapes import Circle, fit_of_shape
from fairyring.storage.predictions import NewPrediction, add_predictions, add_run
from fairyring.storage.records import Cap
from fairyring.storage.statuses import set_status
from tests.support.exported import SQUARE, TRIANGLE, store


@pytest.fixture
def mixed(beds):
    """Image 1 annotated, image 2 approved and empty, image 3 predicted by the latest run alone."""

    def predict(connection, name, images):
        run = add_run(connection, name=name, kind="simulated")
        for image in images:
            fit = fit_of_shape(Circle(50, 46, 9))
            new = [NewPrediction(visible=[TRIANGLE], score=0.5, quality=0.875, fit=fit)]
            add_predictions(connection, run_id=run.id, image_id=image, predictions=new)

    store(beds, Cap(visible=[SQUARE]))
    beds.write(lambda c: predict(c, "early", [1, 2]))
    beds.write(lambda c: predict(c, "late", [3]))
    beds.write(lambda c: set_status(c, 2, "approved", user="ann"))
    return beds
