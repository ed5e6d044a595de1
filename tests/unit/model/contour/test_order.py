import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fairyring.model.contour.order import Meetings, overlap_order

CAPS = 7
PAIRS = [(i, j) for i in range(CAPS) for j in range(i + 1, CAPS)]


def meetings(pairs: list[tuple[int, int]], front: list[float]) -> Meetings:
    shares = np.array(front)
    return Meetings(
        np.array(pairs).reshape(-1, 2),
        np.column_stack([shares, 1 - shares]),
        shares,
        np.zeros((CAPS, 1), int),
    )


def test_the_cap_in_front_ranks_higher():
    rank, confidence = overlap_order(meetings([(0, 1), (1, 2)], [0.1, 0.2]), caps=4)
    assert rank.tolist() == [0, 1, 2, 0]
    assert confidence.tolist() == [0.9, 0.8, 0.8, 1.0]


def test_the_least_sure_decision_of_a_cycle_gives_way():
    # 0 in front of 1 in front of 2 in front of 0, the last hardly sure.
    rank, confidence = overlap_order(meetings([(0, 1), (1, 2), (0, 2)], [0.9, 0.9, 0.45]), caps=3)
    assert rank.tolist() == [2, 1, 0]
    assert confidence.tolist() == [0.5, 0.9, 0.5]


@given(st.lists(st.floats(0, 1), min_size=len(PAIRS), max_size=len(PAIRS)))
def test_any_decisions_give_an_order_without_cycles(front: list[float]):
    rank, confidence = overlap_order(meetings(PAIRS, front), caps=CAPS)
    # Everybody meets everybody: without cycles all ranks differ.
    assert sorted(rank.tolist()) == list(range(CAPS))
    assert ((confidence >= 0.5) & (confidence <= 1)).all()
