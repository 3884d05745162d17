"""The notebooks of examples/python run from their first cell to their last, and draw what they say."""

import ast
import json
import os
import unittest

from common import Folder, project


def run_notebook(path, folder):
    """Runs the code cells in order, in `folder`; returns the names that they leave behind."""
    notebook = json.loads(path.read_text())
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    names = {"__name__": path.stem}
    before = os.getcwd()
    os.chdir(folder)
    try:
        for number, cell in enumerate(notebook["cells"]):
            if cell["cell_type"] == "code":
                code = ast.parse("".join(cell["source"]), f"{path.name}, cell {number}")
                exec(compile(code, f"{path.name}, cell {number}", "exec"), names)
    finally:
        os.chdir(before)
    return names


class Notebooks(Folder):
    def draws(self, name):
        names = run_notebook(project / "examples" / "python" / f"{name}.ipynb", self.folder)
        picture = self.folder / f"{name}.png"
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertLess(picture.stat().st_size, 100_000)
        if folder := os.environ.get("ISOSTAT_PICTURES"):  # to replace those of examples/python
            (project / folder / picture.name).write_bytes(picture.read_bytes())
        return names

    def test_staircase(self):
        names = self.draws("staircase")
        self.assertEqual(names["verification"].words, "ends proved, way looked at")
        self.assertGreater(len(names["records"].equilibria), 26)

    def test_isostatic(self):
        names = self.draws("isostatic")
        self.assertEqual(names["seen"].counting.h, 0)

    def test_experiment(self):
        names = self.draws("experiment")
        self.assertEqual(sum(names["outcomes"].values()), 1000)
        seen = names["counterexample"].inspect()
        self.assertGreaterEqual(seen.h, 1)
        self.assertGreater(seen.k, seen.rigid_motions)


if __name__ == "__main__":
    unittest.main()
