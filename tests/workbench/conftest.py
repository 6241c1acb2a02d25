"""What the tests of the server share: one process from which workers are forked, and a workbench that runs."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.helpers.sessions import Desk
from tests.helpers.workbench_server import Served, served


@pytest.fixture(scope="session")
def whole_desk() -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.close()


@pytest.fixture
def desk(whole_desk: Desk) -> Iterator[Desk]:
    yield whole_desk
    whole_desk.close_sessions()


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("served") / "models") as running:
        yield running
