"""The docstrings: their examples are run, and those of the stub are those at run time."""

from __future__ import annotations

import ast
import doctest
import inspect
from pathlib import Path
from types import ModuleType

import linkwright as lw
import linkwright.sweep
from linkwright import _linkwright


def documented() -> list[tuple[str, str]]:
    """Returns the names and the docstrings of everything public."""
    found = [("linkwright", lw.__doc__ or ""), ("linkwright.sweep", lw.sweep.__doc__ or "")]
    for module in (lw, lw.sweep):
        for name in module.__all__:
            thing = getattr(module, name)
            if isinstance(thing, (str, ModuleType)):
                continue
            found.append((name, inspect.getdoc(thing) or ""))
            if isinstance(thing, type):
                members = [m for m in vars(thing) if not m.startswith("_")]
                found.extend((f"{name}.{m}", inspect.getdoc(getattr(thing, m)) or "") for m in members)
    return found


#: Attributes whose meaning stands in a comment of the class.
SLOTS = {"data", "result", "which", "text", "csv", "svg", "html", "markdown", "mismatches", "held_to_limits"} | {
    "leaves", "not_checked", "folder", "rows", "accepted", "bugs", "shards", "before", "loads",
}  # fmt: skip


def test_everything_public_has_a_docstring() -> None:
    bare = [name for name, doc in documented() if not doc and name.rsplit(".", 1)[-1] not in SLOTS]
    assert not bare


def test_the_examples_are_true() -> None:
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    tried = 0
    for name, doc in documented():
        test = parser.get_doctest(doc, {}, name, None, 0)
        tried += bool(test.examples)
        runner.run(test)
    assert tried >= 8
    assert runner.failures == 0


def test_the_docstrings_of_the_stub_are_those_at_run_time() -> None:
    stub = ast.parse(Path(_linkwright.__file__).with_name("_linkwright.pyi").read_text())
    compared = 0
    for node in stub.body:
        members: list[ast.stmt] = [node]
        if isinstance(node, ast.ClassDef):
            members.extend(node.body)
        for member in members:
            if not isinstance(member, (ast.ClassDef, ast.FunctionDef)):
                continue
            said = ast.get_docstring(member)
            if said is None:
                continue
            thing = getattr(_linkwright, node.name)  # type: ignore[attr-defined]
            if member is not node:
                thing = getattr(thing, member.name)
            assert inspect.getdoc(thing) == said, (node, member.name)
            compared += 1
    assert compared > 40
