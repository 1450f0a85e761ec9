# SPDX-License-Identifier: BSD-3-Clause
"""Examples/ParaView as users run it: the script, and the state file for the same scan.

TestPluginExample.py <Examples/ParaView> <folder of bunny.obj>
"""
import os
import subprocess
import sys

from paraview import simple

import plugin_testing as t

examples, scans = sys.argv[1:]
script = os.path.join(examples, "reconstruct.py")
program = os.path.join(os.environ["IPIA_PARAVIEW_BIN"], "pvpython")
folder = t.output("example")


def run_script(*arguments):
    return subprocess.run([program, script, *arguments], capture_output=True, text=True, check=False)


done = run_script(os.path.join(scans, "bunny.obj"), "--output", folder)
assert done.returncode == 0, done.stderr
assert "points    34,835" in done.stdout, done.stdout

simple.LoadState(os.path.join(examples, "reconstruct.pvsm"), data_directory=scans,
                 restrict_to_data_directory=True)
surface = simple.FindSource("surface")
surface.UpdatePipeline()
triangles = surface.GetDataInformation().GetNumberOfCells()
assert f"surface   {triangles:,} triangles" in done.stdout, (triangles, done.stdout)
simple._DisableFirstRenderCameraReset()  # the cameras are in the state
shot = os.path.join(folder, "state.png")
simple.SaveScreenshot(shot, simple.GetLayout(), ImageResolution=[1600, 800])
found = t.difference(shot, os.path.join(folder, "picture.png"))
print(f"the picture of the state file differs by {found}")
assert found < 100, found  # of 1600 x 800 pixels

# Points without normals and faces; mistakes.
bare = t.write("bare.vtp", t.polydata(t.kitten()[0]))
done = run_script(bare, "--output", folder)
assert done.returncode == 0 and "points    5,210" in done.stdout, done.stderr
done = run_script(t.output("missing.ply"))
assert done.returncode == 1 and "there is no such file" in done.stderr, done.stderr
