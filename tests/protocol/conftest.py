"""Tests of the bus over Zenoh share `zenoh_wires`."""

import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

sys.path.insert(0, str(Path(__file__).parent))

if TYPE_CHECKING:
    from zenoh_wires import Wires


@pytest.fixture
def wires() -> Iterator["Wires"]:
    """Members of one run; after the test they are closed, and their processes have ended."""
    from zenoh_wires import Wires

    # Not tmp_path: a unix socket's path has room for about 100 bytes.
    with tempfile.TemporaryDirectory(prefix="odour-") as folder, ExitStack() as stack:
        yield Wires(Path(folder), stack)
