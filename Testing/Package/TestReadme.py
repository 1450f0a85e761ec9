# SPDX-License-Identifier: BSD-3-Clause
"""The code of README.md, run as it stands there.

TestReadme.py python <README.md>
TestReadme.py cxx <README.md> <folder of IPIA> <folder of VTK> <cmake>
"""
import os
import re
import subprocess
import sys
import tempfile

import numpy as np
from vtkmodules.vtkFiltersCore import vtkMassProperties
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

COUNT = 5000
VOLUME = 4 / 3 * np.pi


def write_scan():
    """scan.ply: points spread over the unit sphere, with outward normals."""
    z = 1 - (2 * np.arange(COUNT) + 1) / COUNT
    angle = np.pi * (1 + 5**0.5) * np.arange(COUNT)
    across = np.sqrt(1 - z * z)
    sphere = np.stack((across * np.cos(angle), across * np.sin(angle), z), axis=1)
    with open("scan.ply", "w", encoding="ascii") as file:  # vtkPLYWriter would leave out normals
        print(f"ply\nformat ascii 1.0\nelement vertex {COUNT}", file=file)
        for name in ("x", "y", "z", "nx", "ny", "nz"):
            print(f"property float {name}", file=file)
        print("end_header", file=file)
        np.savetxt(file, np.hstack((sphere, sphere)), fmt="%.7f")


def blocks(readme, language):
    with open(readme, encoding="utf-8") as file:
        found = re.findall(rf"^```{language}\n(.*?)^```$", file.read(), re.MULTILINE | re.DOTALL)
    assert found, f"no {language} in {readme}"
    return found


def assert_is_sphere(surface):
    size = vtkMassProperties()
    size.SetInputData(surface)
    size.Update()
    assert abs(size.GetVolume() / VOLUME - 1) < 0.001, size.GetVolume()


def run_python(readme):
    names = {}
    for block in blocks(readme, "python"):
        exec(compile(block, readme, "exec"), names)
    assert_is_sphere(names["surface"])
    assert_is_sphere(names["outward"].GetOutput())
    assert abs(names["f"].EvaluateFunction(0, 0, 1.01) - 0.01) < 0.001


def run_cxx(readme, ipia, vtk, cmake):
    for name, language in (("reconstruct.cxx", "cpp"), ("CMakeLists.txt", "cmake")):
        (text,) = blocks(readme, language)
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    subprocess.run([cmake, "-S", ".", "-B", "build", f"-DCMAKE_PREFIX_PATH={ipia}",
                    f"-DVTK_DIR={vtk}"], check=True)
    subprocess.run([cmake, "--build", "build"], check=True)
    subprocess.run(["build/reconstruct"], check=True)
    reader = vtkXMLPolyDataReader()
    reader.SetFileName("surface.vtp")
    reader.Update()
    assert_is_sphere(reader.GetOutput())


if __name__ == "__main__":
    language, readme = sys.argv[1], os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write_scan()
        {"python": run_python, "cxx": run_cxx}[language](readme, *sys.argv[3:])
        os.chdir("/")
