# SPDX-License-Identifier: BSD-3-Clause
"""Each filter by its proxy on a scan: as the package ipia on the installed VTK, and as its picture."""
import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

import plugin_testing as t

EXACT = 1e-12  # of f, in a box of side 0.5


def reference():
    return np.load(t.output("reference.npz"))


def array(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def largest_difference(a, b):
    assert a.shape == b.shape, (a.shape, b.shape)
    return np.abs(a - b).max()


def test_every_filter_is_there_with_its_category():
    names = ("IPIAImplicitFitter", "IPIASurfaceReconstruction", "IPIAOrientedPointCloud")
    manager = servermanager.ProxyManager()
    for name in names:
        assert hasattr(simple, name), name
        hints = manager.GetPrototypeProxy("filters", name).GetHints()
        menu = hints.FindNestedElementByName("ShowInMenu")
        assert menu.GetAttribute("category") == "IPIA", name
        assert menu.GetAttribute("icon"), name


def test_every_property_is_documented():
    manager = servermanager.ProxyManager()
    for name in ("IPIAImplicitFitter", "IPIASurfaceReconstruction", "IPIAOrientedPointCloud"):
        proxy = manager.GetPrototypeProxy("filters", name)
        assert proxy.GetDocumentation().GetDescription()
        assert proxy.GetDocumentation().GetShortHelp() and proxy.GetDocumentation().GetLongHelp()
        visible = 0
        iterator = proxy.NewPropertyIterator()
        while not iterator.IsAtEnd():
            prop, key = iterator.GetProperty(), iterator.GetKey()
            text = prop.GetDocumentation() and prop.GetDocumentation().GetDescription()
            assert text, f"{name}.{key} is not documented"
            inputs = key in ("Input", "ExtraRows")
            assert inputs or "Default:" in text, f"{name}.{key}: no default in '{text}'"
            boxed = key.startswith("ModelBounds")  # shown with Use Point Bounds off
            other = key in ("NormalX", "NormalY", "NormalZ", "NumberOfNeighbours")
            if prop.GetPanelVisibility() == "default" and not (inputs or boxed or other):
                visible += 1
            iterator.Next()
        assert visible <= 6, (name, visible)
        assert visible >= 4 or name == "IPIAOrientedPointCloud", (name, visible)


def test_fitter_equals_the_package():
    expected = reference()
    fitter = simple.IPIAImplicitFitter(Input=t.producer(t.polydata(*t.kitten())))
    fitter.OutputScalarType = "double"
    fitter.GenerateGradient = 1
    with t.Messages() as messages:
        fitter.UpdatePipeline()
    assert not messages.errors and not messages.warnings, (messages.errors, messages.warnings)
    source = fitter.GetClientSideObject()
    image, points, lattice = (source.GetOutputDataObject(port) for port in range(3))
    assert tuple(expected["dimensions"]) == image.GetDimensions()
    assert tuple(expected["origin"]) == image.GetOrigin()
    assert tuple(expected["spacing"]) == image.GetSpacing()
    for data, name, key in (
        (image, "f", "f"),
        (image, "Gradient", "gradient"),
        (points, "Distance", "distance"),
        (lattice, "Coefficient", "coefficient"),
    ):
        found = largest_difference(array(data, name), expected[key])
        print(f"{name}: {found:.3g}")
        assert found <= EXACT, (name, found)


def test_output_ports_have_names():
    fitter = simple.IPIAImplicitFitter(Input=t.producer(t.polydata(*t.sphere())))
    names = [fitter.SMProxy.GetOutputPortName(port) for port in range(3)]
    assert names == ["Function", "Fitted Points", "Control Lattice"], names


def test_reconstruction_equals_the_package():
    expected = reference()
    surface = simple.IPIASurfaceReconstruction(Input=t.producer(t.polydata(*t.kitten())))
    surface.OutputPointsPrecision = "Double"
    with t.Messages() as messages:
        surface.UpdatePipeline()
    assert not messages.errors and not messages.warnings, (messages.errors, messages.warnings)
    data = surface.GetClientSideObject().GetOutputDataObject(0)
    triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    assert np.array_equal(triangles, expected["triangles"])
    found = largest_difference(vtk_to_numpy(data.GetPoints().GetData()), expected["vertices"])
    print(f"vertices: {found:.3g}")
    assert found <= EXACT, found


def test_scan_opened_from_a_file_looks_right():
    scan = simple.OpenDataFile(t.write_ply("kitten.ply", *t.kitten()))
    surface = simple.IPIASurfaceReconstruction(Input=scan)
    t.assert_like_baseline(t.picture("PluginKitten.png", surface))


def test_contour_of_the_fitter_looks_like_the_reconstruction():
    scan = t.producer(t.polydata(*t.kitten()))
    fitter = simple.IPIAImplicitFitter(Input=scan)
    contour = simple.Contour(Input=fitter, ContourBy=["POINTS", "f"], Isosurfaces=[0.0])
    direct = simple.IPIASurfaceReconstruction(Input=scan)
    contour.UpdatePipeline()
    direct.UpdatePipeline()
    areas = []
    for source in (contour, direct):
        areas.append(t.area_and_volume(source.GetClientSideObject().GetOutputDataObject(0))[0])
    assert abs(areas[0] / areas[1] - 1) < 0.002, areas


def test_estimated_normals():
    points, normals = t.kitten()
    cloud = simple.IPIAOrientedPointCloud(Input=t.producer(t.polydata(points)))
    with t.Messages() as messages:
        cloud.UpdatePipeline()
    assert not messages.errors, messages.errors
    found = array(cloud.GetClientSideObject().GetOutputDataObject(0), "Normals")
    agreeing = np.sum(found * normals, axis=1) > 0.9
    print(f"normals within 26 degrees of the scan's: {agreeing.mean():.4f}")
    assert agreeing.mean() > 0.99, agreeing.mean()
    flipped = simple.IPIAOrientedPointCloud(Input=t.producer(t.polydata(points)), Flip=1)
    flipped.UpdatePipeline()
    turned = array(flipped.GetClientSideObject().GetOutputDataObject(0), "Normals")
    assert np.array_equal(turned, -found)
    surface = simple.IPIASurfaceReconstruction(Input=cloud)
    surface.UpdatePipeline()
    given = simple.IPIASurfaceReconstruction(Input=t.producer(t.polydata(points, normals)))
    given.UpdatePipeline()
    volumes = []
    for source in (surface, given):
        volumes.append(t.area_and_volume(source.GetClientSideObject().GetOutputDataObject(0))[1])
    assert abs(volumes[0] / volumes[1] - 1) < 0.01, volumes


def test_progress_moves():
    source = t.producer(t.polydata(*t.kitten()))
    for make in (simple.IPIAImplicitFitter, simple.IPIASurfaceReconstruction):
        proxy = make(Input=source)
        shares = []
        algorithm = proxy.GetClientSideObject()
        algorithm.AddObserver("ProgressEvent", lambda caller, _: shares.append(caller.GetProgress()))
        proxy.UpdatePipeline()
        inside = [share for share in shares if 0 < share < 1]
        assert len(inside) >= 5, shares
        assert shares == sorted(shares), shares


def test_other_samples_need_no_other_fit():
    fitter = simple.IPIAImplicitFitter(Input=t.producer(t.polydata(*t.kitten())))
    fitter.UpdatePipeline()
    shares = []
    algorithm = fitter.GetClientSideObject()
    algorithm.AddObserver("ProgressEvent", lambda caller, _: shares.append(caller.GetProgress()))
    fitter.SampleDimensions = [50, 50, 50]
    fitter.UpdatePipeline()
    assert algorithm.GetOutputDataObject(0).GetDimensions() == (50, 50, 50)
    assert not [share for share in shares if 0.05 < share < 0.8], shares
    fitter.FairingWeight = 1e-3
    fitter.UpdatePipeline()
    assert [share for share in shares if 0.05 < share < 0.8], shares


if __name__ == "__main__":
    t.run(globals())
