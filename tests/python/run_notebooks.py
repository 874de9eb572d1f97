"""Runs notebooks from the first cell to the last; fails where a cell does."""

import sys
from pathlib import Path

import nbclient
import nbformat

for file in map(Path, sys.argv[1:]):
    notebook = nbformat.read(file, as_version=4)
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    outputs = sum(len(cell.get("outputs", [])) for cell in notebook.cells)
    print(f"{file.name}: {len(notebook.cells)} cells, {outputs} outputs")
    if outputs == 0:
        sys.exit(f"{file}: shows nothing")
