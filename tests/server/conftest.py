"""What the tests of the server share: one process from which workers are forked."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.helpers.sessions import Desk


@pytest.fixture(scope="session")
def whole_desk() -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.close()


@pytest.fixture
def desk(whole_desk: Desk) -> Iterator[Desk]:
    yield whole_desk
    whole_desk.close_sessions()
