"""The desk: what becomes of what a person holds when a run says something new of the image."""

from __future__ import annotations

SQUARE = [[0, 0, 100, 0, 100, 100, 0, 100]]


def prediction(number: int) -> dict:
    return {
        "id": number,
        "visible": SQUARE,
        "category": "mushroom",
        "whole": None,
        "centre": None,
        "score": 0.9,
    }


DESK = """
  const committed = [];
  const desk = new m.Desk((changes) => committed.push(...changes));
  desk.open({ image: { id: 1, width: 200, height: 200 }, annotations: [], predictions: a.before });
"""


def test_a_later_run_takes_the_place_of_an_earlier_one_and_of_its_selection(call) -> None:
    body = f"""{DESK}
      desk.select(["prediction:1"]);
      desk.predict(a.after);
      return [desk.items.map(({{ uid }}) => uid), [...desk.selected]];
    """
    items, selected = call(
        "state/desk", body, {"before": [prediction(1)], "after": [prediction(7), prediction(8)]}
    )
    assert items == ["prediction:7", "prediction:8"]
    assert selected == []


def test_a_prediction_that_is_being_dragged_stays_until_it_is_let_go(call) -> None:
    body = f"""{DESK}
      const shape = desk.item("prediction:1");
      desk.select([shape.uid]);
      desk.propose([{{ ...shape, cap: {{ ...shape.cap, visible: [[0, 0, 90, 0, 100, 100, 0, 100]] }} }}]);
      desk.predict(a.after);
      desk.settle();
      return committed.map(({{ after }}) => [after.cap.prediction, after.cap.visible[0][2]]);
    """
    found = call("state/desk", body, {"before": [prediction(1), prediction(2)], "after": [prediction(7)]})
    assert found == [[1, 90]]
