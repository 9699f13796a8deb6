"""Builds docs/tutorial.ipynb from docs/tutorial.py and runs it.

python .ci/notebook.py            compares the notebook with its source, and runs it
python .ci/notebook.py --write    writes the notebook, without outputs
"""

from __future__ import annotations

import pathlib
import sys
import tempfile

import jupytext
import nbclient

ROOT = pathlib.Path(__file__).resolve().parents[1]
SOURCE, NOTEBOOK = ROOT / "docs" / "tutorial.py", ROOT / "docs" / "tutorial.ipynb"


def built() -> str:
    """Returns the text of the notebook, the same each time."""
    notebook = jupytext.read(SOURCE)
    for i, cell in enumerate(notebook.cells):
        cell["id"] = f"cell-{i}"
    # What jupytext says of itself changes with its version.
    notebook.metadata.pop("jupytext", None)
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    return jupytext.writes(notebook, "ipynb")


def main() -> int:
    text = built()
    if "--write" in sys.argv:
        NOTEBOOK.write_text(text)
        return 0
    if NOTEBOOK.read_text() != text:
        print("docs/tutorial.ipynb is not that of docs/tutorial.py: python .ci/notebook.py --write", file=sys.stderr)
        return 1
    with tempfile.TemporaryDirectory() as folder:
        notebook = jupytext.reads(text, "ipynb")
        nbclient.NotebookClient(notebook, timeout=1200, resources={"metadata": {"path": folder}}).execute()
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    shown = [output for cell in cells for output in cell.outputs]
    pictures = sum("image/png" in output.get("data", {}) or "text/html" in output.get("data", {}) for output in shown)
    print(f"docs/tutorial.py: {len(cells)} cells were run, {pictures} pictures and tables")
    return 0 if pictures >= 7 else 1


if __name__ == "__main__":
    sys.exit(main())
