"""Writing of files."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os


def write(path: str | os.PathLike[str], contents: bytes) -> None:
    """Writes a file; what was there is replaced."""
    with open(path, "wb") as file:
        file.write(contents)
