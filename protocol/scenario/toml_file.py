"""Reading a TOML file for a person: whatever is wrong with it is one sentence that starts with its name."""

from __future__ import annotations

import tomllib
from pathlib import Path

from protocol.errors import ScenarioError


def read_text(file: Path, kind: str) -> str:
    """Text of `file`; `kind` says what it ought to be ("a scenario file").

    Raises: ScenarioError when it cannot be read or is not UTF-8.
    """
    try:
        return file.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise ScenarioError(f"{file}: there is no such file; give the path of {kind}.") from None
    except IsADirectoryError:
        raise ScenarioError(f"{file}: this is a directory; give the path of {kind}.") from None
    except UnicodeDecodeError as error:
        raise ScenarioError(f"{file}: byte {error.start} is not UTF-8 text; {kind} must be UTF-8.") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ScenarioError(f"{file}: it cannot be read ({reason.lower()}); give the path of {kind}.") from None


def read_toml(file: Path, kind: str = "a scenario file") -> dict[str, object]:
    """The tables of a TOML file.

    Raises: ScenarioError when it cannot be read or is not TOML.
    """
    text = read_text(file, kind)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        reason = " ".join(str(error).split())
    except (ValueError, RecursionError) as error:
        reason = "nested too deeply" if isinstance(error, RecursionError) else "a number with too many digits"
    raise ScenarioError(f"{file}: this is not valid TOML, {reason[:1].lower()}{reason[1:]}; write NAME = VALUE lines.")
