# SPDX-License-Identifier: BSD-3-Clause
"""Inputs as ParaView has them: composite, in time, tables, without normals; states of a session."""
import numpy as np
from paraview import servermanager, simple, smstate

import plugin_testing as t


def result(proxy):
    proxy.UpdatePipeline()
    return proxy.GetClientSideObject().GetOutputDataObject(0)


def halves():
    points, normals = t.sphere(3000)
    upper = points[:, 2] > 0
    return [
        t.producer(t.polydata(points[part], normals[part])) for part in (upper, ~upper)
    ]


def test_blocks_are_fitted_as_one():
    group = simple.GroupDatasets(Input=halves())
    group.UpdatePipeline()
    with t.Messages() as messages:
        t.assert_is_sphere(result(simple.IPIASurfaceReconstruction(Input=group)))
        fitter = simple.IPIAImplicitFitter(Input=group)
        contour = simple.Contour(Input=fitter, ContourBy=["POINTS", "f"], Isosurfaces=[0.0])
        area, _ = t.area_and_volume(result(contour))
        cloud = simple.IPIAOrientedPointCloud(Input=group)
        assert result(cloud).GetNumberOfPoints() == 3000
    assert abs(area / (16 * np.pi) - 1) < 0.005, area
    assert not messages.errors and not messages.warnings, (messages.errors, messages.warnings)


def test_point_arrays_are_chosen():
    points, normals = t.sphere(1500)
    source = t.producer(t.polydata(points, normals, height=points[:, 2], one=np.ones(len(points))))

    def arrays(proxy):
        data = result(proxy).GetPointData()
        return {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}

    for make, own in ((simple.IPIASurfaceReconstruction, {"Normals"}), (simple.IPIAImplicitFitter, {"f"})):
        proxy = make(Input=source)
        assert arrays(proxy) == own | {"height", "one"}, arrays(proxy)
        low, high = result(proxy).GetPointData().GetArray("height").GetRange()
        assert points[:, 2].min() <= low < -0.9 * t.RADIUS and 0.9 * t.RADIUS < high <= points[:, 2].max()
        proxy.PointArrays = ["one"]
        assert arrays(proxy) == own | {"one"}, arrays(proxy)
        proxy.PointArrays = []
        assert arrays(proxy) == own, arrays(proxy)


def series():
    """Two time steps: a sphere about the origin, another about (5, 0, 0)."""
    names = []
    for step, x in enumerate((0, 5)):
        names.append(t.write(f"series_{step}.vtp", t.polydata(*t.sphere(1500, (x, 0, 0)))))
    return simple.XMLPolyDataReader(FileName=names)


def test_each_time_step_is_fitted():
    reader = series()
    reader.UpdatePipeline()
    assert list(reader.TimestepValues) == [0, 1]
    surface = simple.IPIASurfaceReconstruction(Input=reader)
    fitter = simple.IPIAImplicitFitter(Input=reader)
    contour = simple.Contour(Input=fitter, ContourBy=["POINTS", "f"], Isosurfaces=[0.0])
    for time, x in ((0, 0), (1, 5), (0, 0)):
        for proxy in (surface, contour):
            proxy.UpdatePipeline(time)
            bounds = proxy.GetDataInformation().GetBounds()
            assert abs(0.5 * (bounds[0] + bounds[1]) - x) < 0.01, (time, bounds)
            assert abs(bounds[1] - bounds[0] - 2 * t.RADIUS) < 0.02, (time, bounds)


def test_a_view_at_another_time_shows_it():
    surface = simple.IPIASurfaceReconstruction(Input=series())
    view = simple.CreateRenderView()
    simple.Show(surface, view)
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    for time, x in ((1, 5), (0, 0)):
        scene.AnimationTime = time
        simple.Render(view)
        bounds = surface.GetDataInformation().GetBounds()
        assert abs(0.5 * (bounds[0] + bounds[1]) - x) < 0.01, (time, bounds)


def test_columns_of_a_table():
    points, normals = t.sphere(2000)
    path = t.output("sphere.csv")
    np.savetxt(path, np.hstack((points, normals)), delimiter=",", comments="",
               header="x,y,z,nx,ny,nz")
    table = simple.CSVReader(FileName=[path])
    cloud = simple.TableToPoints(Input=table, XColumn="x", YColumn="y", ZColumn="z")
    cloud.UpdatePipeline()
    oriented = simple.IPIAOrientedPointCloud(
        Input=cloud, NormalSource="Three arrays", NormalX=["POINTS", "nx"],
        NormalY=["POINTS", "ny"], NormalZ=["POINTS", "nz"])
    t.assert_is_sphere(result(simple.IPIASurfaceReconstruction(Input=oriented)))
    # Without them: as estimated.
    estimated = simple.IPIAOrientedPointCloud(Input=cloud)
    t.assert_is_sphere(result(simple.IPIASurfaceReconstruction(Input=estimated)))


def test_arrays_are_those_that_fit():
    points, normals = t.sphere()
    ones = np.ones(len(points))
    data = t.polydata(points, normals, Other=2 * normals, Quality=ones, Pair=normals[:, :2])
    data.GetPointData().SetActiveScalars("Quality")  # no weights for that
    source = t.producer(data)
    proxy = simple.IPIASurfaceReconstruction(Input=source)
    available = {}
    for name in ("Normals", "PointWeights", "LocalFairing"):
        domain = proxy.SMProxy.GetProperty(name).FindDomain("vtkSMArrayListDomain")
        available[name] = [domain.GetString(i) for i in range(domain.GetNumberOfStrings())]
    assert sorted(available["Normals"]) == ["Normals", "Other"], available
    assert sorted(available["PointWeights"]) == ["None", "Quality"], available
    assert sorted(available["LocalFairing"]) == ["None", "Quality"], available
    assert proxy.Normals[1] == "Normals"
    assert proxy.PointWeights[1] == "None" and proxy.LocalFairing[1] == "None"
    proxy.PointWeights = ["POINTS", "Quality"]
    proxy.Normals = ["POINTS", "Other"]
    t.assert_is_sphere(result(proxy))


def test_weights_count():
    """Points of weight 0 do not: a dent in the sphere is not seen."""
    points, normals = t.sphere()
    dented = points[:, 2] > 1.7
    points[dented] *= 0.8
    source = t.producer(t.polydata(points, normals, Weight=np.where(dented, 0.0, 1.0)))
    # What fills the gap reaches the top of the domain, and would be trimmed.
    proxy = simple.IPIASurfaceReconstruction(
        Input=source, FairingWeight=1e-4, TrimUnsupported=0)
    assert result(proxy).GetBounds()[5] < 1.8
    proxy.PointWeights = ["POINTS", "Weight"]
    assert result(proxy).GetBounds()[5] > 1.95


def test_extra_rows():
    """Points with values of f where a hole leaves open how far the surface bulges."""
    points, normals = t.sphere()
    kept = points[:, 2] < 1
    extra = np.array([[x, y, 1.1] for x in (-0.5, 0, 0.5) for y in (-0.5, 0, 0.5)])
    proxy = simple.IPIAImplicitFitter(
        Input=t.producer(t.polydata(points[kept], normals[kept])), UsePointBounds=0,
        ModelBoundsOrigin=[-3] * 3, ModelBoundsLength=[6] * 3)

    def at_the_extra_point():
        image = result(proxy)
        return image.GetPointData().GetArray("f").GetValue(image.FindPoint(0, 0, 1.1))

    assert at_the_extra_point() < -0.05, at_the_extra_point()
    proxy.ExtraRows = t.producer(t.polydata(extra, Value=np.full(len(extra), 0.2)))
    proxy.ExtraValues = "Value"
    assert abs(at_the_extra_point() - 0.2) < 0.05, at_the_extra_point()


def can_take(name, source):
    """Whether ParaView's menu offers the filter for a source."""
    prototype = servermanager.ProxyManager().GetPrototypeProxy("filters", name)
    prop = prototype.GetProperty("Input")
    prop.RemoveAllUncheckedProxies()
    prop.AddUncheckedInputConnection(source.SMProxy, 0)
    found = prop.IsInDomains()
    prop.RemoveAllUncheckedProxies()
    return bool(found)


def test_a_cloud_without_normals_is_not_offered_a_reconstruction():
    points, normals = t.sphere()
    bare, full = t.producer(t.polydata(points)), t.producer(t.polydata(points, normals))
    for name in ("IPIASurfaceReconstruction", "IPIAImplicitFitter"):
        assert can_take(name, full) and not can_take(name, bare), name
    assert can_take("IPIAOrientedPointCloud", bare)
    image = simple.Wavelet()
    image.UpdatePipeline()
    assert not can_take("IPIASurfaceReconstruction", image)


def test_a_script_without_normals_gets_the_reason():
    points, _ = t.sphere()
    for make in (simple.IPIASurfaceReconstruction, simple.IPIAImplicitFitter):
        proxy = make(Input=t.producer(t.polydata(points)))
        with t.Messages() as messages:
            assert result(proxy).GetNumberOfPoints() == 0
        assert len(messages.errors) == 1, messages.errors
        assert "no point normals" in messages.errors[0], messages.errors


def test_warnings_reach_the_messages():
    points, normals = t.sphere()
    points[:7] = np.nan
    normals[7:10] = 0
    proxy = simple.IPIASurfaceReconstruction(Input=t.producer(t.polydata(points, normals)))
    with t.Messages() as messages:
        t.assert_is_sphere(result(proxy))
    assert not messages.errors, messages.errors
    assert len(messages.warnings) == 1, messages.warnings
    assert "7 non-finite point(s)" in messages.warnings[0], messages.warnings
    assert "3 zero or non-finite normal(s)" in messages.warnings[0], messages.warnings


def test_orientation_leaves_out_what_is_not_finite():
    points, _ = t.sphere()
    points[:7] = np.nan
    points[9, 1] = np.inf
    cloud = simple.IPIAOrientedPointCloud(
        Input=t.producer(t.polydata(points, Id=np.arange(len(points)))))
    with t.Messages() as messages:
        found = result(cloud)
        t.assert_is_sphere(result(simple.IPIASurfaceReconstruction(Input=cloud)))
    assert not messages.errors, messages.errors
    assert len(messages.warnings) == 1, messages.warnings
    assert "Left out: 8 non-finite point(s)" in messages.warnings[0], messages.warnings
    ids = found.GetPointData().GetArray("Id")
    assert [ids.GetValue(i) for i in range(3)] == [7, 8, 10]
    for count, reason in ((0, "no points"), (3, "at least 4")):
        few = simple.IPIAOrientedPointCloud(Input=t.producer(t.polydata(points[20:20 + count])))
        with t.Messages() as messages:
            assert result(few).GetNumberOfPoints() == 0
        assert len(messages.errors) == 1 and reason in messages.errors[0], messages.errors


def test_bounds_as_a_box():
    points, normals = t.sphere()
    source = t.producer(t.polydata(points, normals))
    proxy = simple.IPIAImplicitFitter(Input=source)
    # Their defaults are those of the points.
    assert np.allclose(proxy.ModelBoundsOrigin, points.min(axis=0), atol=1e-6)
    assert np.allclose(proxy.ModelBoundsLength, np.ptp(points, axis=0), atol=1e-6)
    proxy.UsePointBounds = 0
    proxy.ModelBoundsOrigin = [-3, -3, -1]
    proxy.ModelBoundsLength = [6, 6, 4]
    with t.Messages() as messages:
        image = result(proxy)
    outside = int((points[:, 2] < -1).sum())
    assert f"{outside} point(s) outside ModelBounds" in messages.warnings[0], messages.warnings
    assert np.allclose(image.GetBounds(), (-3, 3, -3, 3, -1, 3))
    proxy.UsePointBounds = 1
    assert result(proxy).GetBounds()[4] < -2


def test_a_curve_in_its_plane():
    angle = 2 * np.pi * np.arange(400) / 400
    normals = np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)
    source = t.producer(t.polydata(t.RADIUS * normals, normals))
    proxy = simple.IPIASurfaceReconstruction(Input=source)
    curve = result(proxy)
    assert curve.GetNumberOfLines() == 1 and curve.GetNumberOfPolys() == 0
    assert np.allclose(curve.GetBounds(), (-2, 2, -2, 2, 0, 0), atol=0.01)
    proxy.UsePointBounds = 0
    proxy.ModelBoundsOrigin = [-3, -3, 0]
    proxy.ModelBoundsLength = [6, 6, 0]
    assert np.allclose(result(proxy).GetBounds(), (-2, 2, -2, 2, 0, 0), atol=0.01)


def show_all():
    scan = simple.OpenDataFile(t.write_ply("state.ply", *t.kitten()))
    surface = simple.IPIASurfaceReconstruction(
        registrationName="Surface", Input=scan, GridSize=[48, 0, 0], FairingWeight=1e-3)
    surface.ComponentFilter = 0
    fitter = simple.IPIAImplicitFitter(
        registrationName="Fitter", Input=scan, UsePointBounds=0, ModelBoundsOrigin=[-0.3] * 3,
        ModelBoundsLength=[0.6] * 3, NormalConstraint="Two-sided offset", NumberOfLevels=1)
    slice_ = simple.Slice(registrationName="Slice", Input=fitter)
    slice_.SliceType.Normal = [0, 0, 1]
    view = simple.CreateRenderView(ViewSize=[400, 400])
    simple.Show(surface, view)
    simple.Show(slice_, view)
    simple.Show(simple.OutputPort(fitter, 1), view)
    simple.ResetCamera(view)


def check_state(save, load):
    show_all()
    before = t.picture("state_before.png")
    save()
    simple.ResetSession()
    load()
    after = t.picture("state_after.png")
    assert t.difference(before, after) == 0
    surface, fitter = simple.FindSource("Surface"), simple.FindSource("Fitter")
    assert list(surface.GridSize) == [48, 0, 0] and surface.FairingWeight == 1e-3
    assert surface.ComponentFilter == 0
    assert fitter.UsePointBounds == 0 and list(fitter.ModelBoundsLength) == [0.6] * 3
    assert fitter.NormalConstraint == "Two-sided offset" and fitter.NumberOfLevels == 1
    # Not an empty picture.
    fresh = simple.ResetSession()
    simple.CreateRenderView(ViewSize=[400, 400])
    assert t.difference(before, t.picture("empty.png")) > 100, fresh


def test_state_file():
    path = t.output("state.pvsm")
    check_state(lambda: simple.SaveState(path), lambda: simple.LoadState(path))


def test_state_as_a_script():
    path = t.output("state.py")

    def load():
        with open(path, encoding="utf-8") as file:
            exec(compile(file.read(), path, "exec"), {"__name__": "state"})

    def save():
        with open(path, "w", encoding="utf-8") as file:
            file.write(smstate.get_state())

    check_state(save, load)


if __name__ == "__main__":
    t.run(globals())
