"""The commands of the pages run as they stand; the stub and the module have the same names."""

import ast
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import unittest

import isostat
from common import project
from isostat import _core


class Pages(unittest.TestCase):
    def test_the_two_commands_of_the_pages(self):
        for page in ("README.md", "src/python/README.md"):
            lines = (project / page).read_text().splitlines()
            commands = [line.strip() for line in lines if "build/release/python" in line and "print(" in line]
            self.assertEqual(len(commands), 1, page)
            # What is tested is this build, not the release that the page builds.
            command = commands[0].replace("build/release/python", os.environ["PYTHONPATH"])
            out = subprocess.run(command, shell=True, cwd=project, capture_output=True, text=True)
            self.assertEqual((out.returncode, out.stdout.strip()), (0, "20"), out.stderr)
            before = lines[[line.strip() for line in lines].index(commands[0]) - 1]
            self.assertEqual(before.strip(), "bash src/python/build", page)

    def test_the_ten_lines_of_the_readme_run(self):
        page = (project / "README.md").read_text()
        (code,) = re.findall(r"^  ```python\n(.*?)^  ```$", page, re.M | re.S)
        code = textwrap.dedent(code)
        self.assertLessEqual(len([line for line in code.splitlines() if line]), 10)
        with tempfile.TemporaryDirectory() as folder:
            out = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True)
            self.assertEqual(out.returncode, 0, out.stderr)
            self.assertEqual(len(out.stdout.splitlines()), 7)
            self.assertIn("proved", out.stdout.splitlines()[-1])
            self.assertIn("<svg", (pathlib.Path(folder) / "forces.svg").read_text())

    def test_the_manifest_of_the_readme_is_one(self):
        page = (project / "README.md").read_text()
        (manifest,) = re.findall(r"^  ```toml\n(.*?)^  ```$", page, re.M | re.S)
        self.assertEqual(len(textwrap.dedent(manifest).splitlines()), 7)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("disks.dump", "frames.csv"):
                shutil.copy(project / "tests/data/series" / name, folder)
            series = pathlib.Path(folder) / "series.toml"
            series.write_text(textwrap.dedent(manifest))
            self.assertGreater(len(isostat.compare(series).frames), 0)

    def test_the_page_names_what_there_is(self):
        page = (project / "src/python/README.md").read_text()
        for name, thing in vars(isostat).items():
            if callable(thing) and not isinstance(thing, type) and not name.startswith("_"):
                self.assertRegex(page, rf"[`.]{name}\b", name)
        for name in re.findall(r"isostat\.([A-Za-z_]+)", page):
            there = hasattr(isostat, name) or importlib.util.find_spec(f"isostat.{name}")
            self.assertTrue(there, name)
        for error in isostat.Error.__subclasses__() + isostat.Failure.__subclasses__():
            self.assertTrue(error is isostat.Failure or f"`{error.__name__}`" in page, error)

    def test_every_public_name_has_a_docstring(self):
        for name, thing in vars(isostat).items():
            if name.startswith("_") or not callable(thing):
                continue
            self.assertTrue(thing.__doc__, name)
            if isinstance(thing, type):
                for member, value in vars(thing).items():
                    if not member.startswith("_") and not isinstance(value, str):
                        self.assertTrue(getattr(value, "__doc__", None), f"{name}.{member}")

    def test_the_stub_says_more_of_every_type_than_that_it_is_an_object(self):
        text = pathlib.Path(_core.__file__).with_name("_core.pyi").read_text()
        ast.parse(text)
        for line in text.splitlines():
            self.assertNotRegex(line, r"::|numpy\.ndarray|: object\b|(-> |Final\[)(object|list|dict|tuple)(:|\])", line)

    def test_the_module_is_built_without_types_where_numpy_is_not(self):
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(folder) / "isostat"
            package.mkdir()
            for file in pathlib.Path(_core.__file__).parent.glob("*.*"):
                if file.name != "_core.pyi":
                    (package / file.name).symlink_to(file)
            stub = [sys.executable, "-S", "-B", project / "src" / "python" / "stub.py", package]  # -S: no packages
            out = subprocess.run(stub, capture_output=True, text=True)
            self.assertEqual(out.returncode, 0, out.stderr)
            self.assertIn("numpy", out.stdout)
            self.assertFalse((package / "_core.pyi").exists())
