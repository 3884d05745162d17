"""What the tests share: a small state, a scene, folders that vanish."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import isostat

project = Path(__file__).resolve().parents[2]
program = os.environ["ISOSTAT_PROGRAM"]

scene = """
[packing]
disks = 30
seed = 3
[[programme]]
do = "up"
equilibria = 3
[[programme]]
do = "down"
equilibria = 2
[output]
pictures = false
states_every = 1
"""


def two_disks(stress=(1.0, 1.0), **options):
    """Radii 1 and 2: the first in the corner, the second on bottom, right and top."""
    x = 1 + 2 * np.sqrt(2)
    contacts = [(0, 1), (0, "left"), (0, "bottom"), (1, "bottom"), (1, "right"), (1, "top")]
    return isostat.State.from_arrays(
        [[1, 1], [x, 2]], [1, 2], [x + 2, 4], contacts, stress=stress, reference_length=[1, 1], **options
    )


class Folder(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_scene(self, text=scene, *options):
        """The folder of a run made by the program."""
        (self.folder / "scene.toml").write_text(text)
        out = self.folder / "out"
        command = [program, "run", self.folder / "scene.toml", "-o", out, "--quiet", *options]
        subprocess.run(command, check=True)
        return out

    def script(self, code, **options):
        """A Python process of its own that runs `code`."""
        return subprocess.Popen([sys.executable, "-c", code], cwd=self.folder, **options)
