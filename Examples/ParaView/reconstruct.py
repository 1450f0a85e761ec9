# SPDX-License-Identifier: BSD-3-Clause
"""Points of a scan and the surface through them, in ParaView: the picture of README.md.

    pvpython reconstruct.py FILE [--output FOLDER]

FILE is whatever ParaView opens as points, such as .ply, .vtp, .obj. Points without normals get those of
the file's faces, else estimated ones. Writes the surface (surface.vtp), the picture (picture.png) and
the session (reconstruct.pvsm, which File > Load State opens in ParaView, also for another FILE).

The plugin is to be known to ParaView (Documentation/ParaView.md): by the environment variable
PV_PLUGIN_CONFIG_FILE, or pvpython --plugin-search-paths FOLDER --plugins IPIA reconstruct.py FILE.
"""
import argparse
import os
import sys

from paraview import simple

SIZE = (1600, 800)  # pixels
BLUE, SAND = (0.16, 0.36, 0.56), (0.90, 0.76, 0.55)


def open_points(path):
    """A source of points with normals; the file itself first."""
    file = simple.OpenDataFile(path)
    if file is None:
        sys.exit(f"error: {path}: ParaView has no reader for it")
    simple.RenameSource("scan", file)
    file.UpdatePipeline()
    information = file.GetDataInformation()
    if information.GetNumberOfPoints() == 0:
        sys.exit(f"error: {path}: no points in it")
    arrays = [information.GetPointDataInformation().GetArrayInformation(i)
              for i in range(information.GetPointDataInformation().GetNumberOfArrays())]
    if any(array.GetName().lower() == "normals" for array in arrays):
        return file, file
    if information.GetNumberOfCells() > 0 and information.GetNumberOfCells() != information.GetNumberOfPoints():
        faces = simple.GenerateSurfaceNormals(registrationName="normals", Input=file, Splitting=0)
        return file, faces
    return file, simple.IPIAOrientedPointCloud(registrationName="normals", Input=file)


def new_view(camera_of=None):
    view = simple.CreateView("RenderView")
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Gradient"
    view.Background, view.Background2 = (1, 1, 1), (0.86, 0.89, 0.93)
    view.OrientationAxesVisibility = 0
    if camera_of is not None:
        simple.AddCameraLink(camera_of, view, "cameras")
    return view


def caption(text, view):
    label = simple.Text(registrationName=text, Text=text)
    display = simple.Show(label, view)
    display.WindowLocation = "Lower Left Corner"
    display.Color, display.FontSize = (0.25, 0.27, 0.3), 20


def show(points, surface):
    layout = simple.CreateLayout("points and surface")
    left = new_view()
    simple.AssignViewToLayout(left, layout)
    cell = layout.SplitHorizontal(layout.GetViewLocation(left), 0.5)
    right = new_view(left)
    simple.AssignViewToLayout(right, layout, cell)
    layout.SetSize(*SIZE)

    dots = simple.Show(points, left)
    dots.SetRepresentationType("Point Gaussian")
    dots.ColorArrayName = [None, ""]
    dots.DiffuseColor = BLUE
    low, high = points.GetDataInformation().GetBounds()[::2], points.GetDataInformation().GetBounds()[1::2]
    dots.GaussianRadius = 0.002 * max(b - a for a, b in zip(low, high))
    faces = simple.Show(surface, right)
    faces.SetRepresentationType("Surface")
    faces.ColorArrayName = [None, ""]
    faces.DiffuseColor, faces.Specular, faces.SpecularPower = SAND, 0.15, 20
    caption("points", left)
    caption("fitted surface", right)
    simple.ResetCamera(left)
    position, focus = left.CameraPosition, left.CameraFocalPoint
    left.CameraPosition = [f + (p - f) / 1.2 for p, f in zip(position, focus)]  # a little nearer
    simple.RenderAllViews()
    return layout


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("--output", default=".")
    options = parser.parse_args()
    if not os.path.isfile(options.file):
        sys.exit(f"error: {options.file}: there is no such file")
    if not hasattr(simple, "IPIASurfaceReconstruction"):
        sys.exit("error: ParaView has not loaded the plugin IPIA, see Documentation/ParaView.md")
    os.makedirs(options.output, exist_ok=True)

    file, points = open_points(options.file)
    surface = simple.IPIASurfaceReconstruction(registrationName="surface", Input=points)
    surface.UpdatePipeline()
    information = surface.GetDataInformation()
    if information.GetNumberOfPoints() == 0:
        sys.exit("error: no surface; the message above says why")
    layout = show(file, surface)
    written = [os.path.join(options.output, name)
               for name in ("surface.vtp", "picture.png", "reconstruct.pvsm")]
    simple.SaveData(written[0], surface)
    simple.SaveScreenshot(written[1], layout, ImageResolution=SIZE)
    simple.SaveState(written[2])
    print(f"points    {file.GetDataInformation().GetNumberOfPoints():,}")
    print(f"surface   {information.GetNumberOfCells():,} triangles")
    print("written   " + " ".join(written))


main()
