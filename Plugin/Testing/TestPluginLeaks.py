# SPDX-License-Identifier: BSD-3-Clause
"""Load, run and exit under valgrind: nothing of ours is lost, or read or written where it is not.

TestPluginLeaks.py <valgrind> <pvpython>; without arguments, the session that valgrind watches.
"""
import os
import re
import subprocess
import sys

# Frames of this project; all else is ParaView, Python, Qt and the graphics driver.
OURS = re.compile(r"ipia::|vtkIPIA|vtkPIPIA|libvtkFiltersIPIA|/IPIA\.so")
# Blocks that a library keeps on purpose until the end are "still reachable" and not of this kind.
KINDS = ("definitely lost", "Invalid read", "Invalid write", "uninitialised", "Mismatched free",
         "Invalid free")


def session():
    from paraview import simple

    import plugin_testing as t

    points, normals = t.sphere(300)
    source = t.producer(t.polydata(points, normals))
    fitter = simple.IPIAImplicitFitter(Input=source)
    fitter.UpdatePipeline()
    fitter.SampleDimensions = [9, 9, 9]
    fitter.UpdatePipeline()
    classic = simple.IPIAImplicitFitter(
        Input=source, NumberOfLevels=1, NormalConstraint="Two-sided offset")
    classic.UpdatePipeline()
    surface = simple.IPIASurfaceReconstruction(Input=simple.IPIAOrientedPointCloud(Input=source))
    surface.UpdatePipeline()
    assert surface.GetDataInformation().GetNumberOfPoints() > 0
    surface.GridSize = [2, 0, 0]
    surface.UpdatePipeline()
    assert surface.GetDataInformation().GetNumberOfPoints() == 0
    simple.Delete(surface)


def watch(valgrind, pvpython):
    log = os.path.join(os.environ["IPIA_TEST_OUTPUT"], "valgrind.log")
    # One thread: OpenMP's others keep their stacks to the end. Python's own allocator hides blocks.
    environment = dict(os.environ, OMP_NUM_THREADS="1", PYTHONMALLOC="malloc")
    done = subprocess.run(
        # Libraries that were unloaded keep their names: others may lie at their addresses later.
        [valgrind, "--leak-check=full", "--keep-debuginfo=yes", "--num-callers=40",
         f"--log-file={log}", "--error-limit=no", pvpython, os.path.abspath(__file__)], env=environment, check=False)
    assert done.returncode == 0, done.returncode
    with open(log, encoding="utf-8", errors="replace") as file:
        text = re.sub(r"^==\d+== ?", "", file.read(), flags=re.MULTILINE)
    assert "LEAK SUMMARY" in text, text[-2000:]
    records = [record for record in text.split("\n\n")
               if any(kind in record for kind in KINDS) and OURS.search(record)]
    print(text[text.index("LEAK SUMMARY"):])
    assert not records, "\n\n".join(records)


if len(sys.argv) > 1:
    watch(*sys.argv[1:])
else:
    session()
