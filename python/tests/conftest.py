"""What the tests share: the repository's problems, and a small problem that takes milliseconds."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import linkwright as lw

ROOT = Path(__file__).resolve().parents[2]
#: Four points that any four-bar can pass.
ARC = [[0.0, 0.0], [1.0, 1.0], [2.0, 1.5], [3.0, 1.0]]


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def literature() -> Path:
    return ROOT / "problems" / "literature"


@pytest.fixture(scope="session")
def k18(literature: Path) -> lw.Result:
    """The result of the eighteen-point problem."""
    return lw.synth(literature / "k18.toml")


@pytest.fixture(scope="session")
def arc() -> lw.Result:
    return lw.synth(lw.path(ARC, name="arc", unit="mm"))


@pytest.fixture(scope="session")
def program() -> list[str]:
    """The command: LINKWRIGHT names a program that was built by itself, else it is that of the package."""
    named = os.environ.get("LINKWRIGHT")
    return [named] if named else [sys.executable, "-m", "linkwright"]


def call(words: list[str], **options: object) -> subprocess.CompletedProcess[str]:
    """Runs a command and returns what it wrote."""
    return subprocess.run(words, capture_output=True, text=True, timeout=600, **options)  # type: ignore[call-overload, no-any-return]


def python(code: str, **options: object) -> subprocess.CompletedProcess[str]:
    """Runs code in an interpreter of its own."""
    return call([sys.executable, "-c", code], **options)
