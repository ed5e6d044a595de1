"""A cap to commit."""

import pytest

from fairyring.storage.records import Cap


@pytest.fixture
def cap(square):
    return Cap(visible=square)
