"""Builds the extension with CMake, in build/wheel, or in the build folder that ISOSTAT_BUILD names."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

project = Path(__file__).resolve().parents[2]
version = re.search(r"project\(isostat VERSION ([\d.]+)", (project / "CMakeLists.txt").read_text())[
    1
]
scratch = project / "build" / "python-wheel"
scratch.mkdir(parents=True, exist_ok=True)


class BuildWithCMake(build_ext):
    """The compiled part is a target of the project's own build."""

    def build_extension(self, extension):
        build = project / os.environ.get("ISOSTAT_BUILD", "build/wheel")
        if not (build / "CMakeCache.txt").exists():
            wanted = {
                "WITH_PYTHON": "ON",
                "BUILD_TESTS": "OFF",
                "BUILD_EXAMPLES": "OFF",
                "PYTHON": sys.executable,
            }
            options = [f"-DISOSTAT_{key}={value}" for key, value in wanted.items()]
            subprocess.run(
                ["cmake", "-S", project, "-B", build, "-G", "Ninja", *options], check=True
            )
        subprocess.run(["cmake", "--build", build, "--target", "isostat_python"], check=True)
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        (built,) = (build / "python" / "isostat").glob("_core.*.so")
        shutil.copy(built, target)
        if (types := built.with_name("_core.pyi")).exists():
            shutil.copy(types, target.parent)


setup(
    version=version,
    packages=["isostat"],
    package_data={"isostat": ["py.typed"]},
    ext_modules=[Extension("isostat._core", [])],
    cmdclass={"build_ext": BuildWithCMake},
    options={"build": {"build_base": str(scratch)}, "egg_info": {"egg_base": str(scratch)}},
)
