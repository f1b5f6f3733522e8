"""Which code made a result: the version, and a digest of everything that decides a run."""

from __future__ import annotations

from functools import cache
from hashlib import blake2b
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_ROOT = Path(__file__).parent.parent.parent
_DECISIVE = ("protocol", "world_server", "robot_agent")


@cache
def our_version() -> str:
    """For example "0.1.0+5f0c3a91": the version of odourswarm and 8 hex digits of its sources.

    A result may be gathered over days while the code changes: then its rows tell.
    """
    digest = blake2b(digest_size=4)
    for package in _DECISIVE:
        for file in sorted((_ROOT / package).rglob("*.py")):
            digest.update(file.relative_to(_ROOT).as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    try:
        number = version("odourswarm")
    except PackageNotFoundError:
        number = "0"
    return f"{number}+{digest.hexdigest()}"
