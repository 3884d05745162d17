"""The notebooks of examples/python run from their first cell to their last, and draw what they say; their stored outputs are those.

ISOSTAT_PICTURES=examples/python stores pictures and outputs anew."""

import ast
import base64
import contextlib
import io
import json
import os

from matplotlib import pyplot

from common import Folder, project


def cell_outputs(nodes, names, where):
    """Runs the statements of a cell; what it printed, drew, and the value of its last line, as a notebook stores them."""
    outputs, printed, value = [], io.StringIO(), None
    last = nodes.body.pop() if nodes.body and isinstance(nodes.body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(printed):
        exec(compile(nodes, where, "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), where, "eval"), names)
    lines = printed.getvalue().splitlines(keepends=True)
    if lines:
        outputs.append({"name": "stdout", "output_type": "stream", "text": lines})
    for number in pyplot.get_fignums():
        picture = io.BytesIO()
        pyplot.figure(number).savefig(picture, dpi=72, metadata={"Software": None})
        pyplot.close(number)
        data = {"image/png": base64.b64encode(picture.getvalue()).decode(), "text/plain": ["a picture"]}
        outputs.append({"output_type": "display_data", "metadata": {}, "data": data})
    if value is not None:
        text = repr(value).splitlines(keepends=True)
        outputs.append({"output_type": "execute_result", "execution_count": None, "metadata": {}, "data": {"text/plain": text}})
    return outputs


def run_notebook(path, folder):
    """Runs the code cells in order, in `folder`; returns the notebook with its outputs, and the names that they leave behind."""
    notebook = json.loads(path.read_text())
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    names = {"__name__": path.stem}
    before, count = os.getcwd(), 0
    os.chdir(folder)
    try:
        for number, cell in enumerate(notebook["cells"]):
            if cell["cell_type"] == "code":
                count += 1
                code = ast.parse("".join(cell["source"]), f"{path.name}, cell {number}")
                cell["execution_count"] = count
                cell["outputs"] = cell_outputs(code, names, f"{path.name}, cell {number}")
                for output in cell["outputs"]:
                    if "execution_count" in output:
                        output["execution_count"] = count
    finally:
        os.chdir(before)
    return notebook, names


def texts(notebook):
    """What the cells print and say, and how many pictures they draw."""
    found = []
    for cell in notebook["cells"]:
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            found.append("picture" if "image/png" in data else "".join(data.get("text/plain", output.get("text", []))))
    return found


class Notebooks(Folder):
    def draws(self, name):
        pyplot.close("all")
        path = project / "examples" / "python" / f"{name}.ipynb"
        notebook, names = run_notebook(path, self.folder)
        stored = json.loads(path.read_text())
        picture = self.folder / f"{name}.png"
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertLess(picture.stat().st_size, 100_000)
        if folder := os.environ.get("ISOSTAT_PICTURES"):  # to replace those of examples/python
            (project / folder / picture.name).write_bytes(picture.read_bytes())
            path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n")  # with its outputs
        else:
            self.assertEqual(texts(stored), texts(notebook))  # what it stores is what it says
            self.assertIn("picture", texts(stored))
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
