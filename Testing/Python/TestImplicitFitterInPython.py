# SPDX-License-Identifier: BSD-3-Clause
"""The package ipia: refusals, the chain to the surface, NumPy in and out, the function."""
import numpy as np
from vtkmodules.numpy_interface import dataset_adapter as dsa
from vtkmodules.test import Testing
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkConnectivityFilter, vtkFlyingEdges3D

from ipia import (vtkIPIAImplicitFitter, vtkIPIAImplicitFunction, vtkIPIAScanRegistration,
                  vtkIPIASurfaceReconstruction)
from python_testing import classic_fitter, cloud


def sphere(count=600):
    """Even points on the unit sphere, which are their own normals."""
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    angle = np.pi * (1 + 5**0.5) * i
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


class TestImplicitFitterInPython(Testing.vtkTest):
    def test_refusal(self):
        messages = []
        fitter = vtkIPIAImplicitFitter()
        fitter.AddObserver("ErrorEvent", lambda caller, event: messages.append(event))
        fitter.SetInputData(vtkPolyData())
        fitter.Update()
        self.assertEqual(messages, ["ErrorEvent"])
        self.assertEqual(fitter.GetOutput().GetNumberOfPoints(), 0)

    def test_chain_with_nothing_set(self):
        fitter = vtkIPIAImplicitFitter()
        fitter.SetInputData(cloud(sphere(), sphere()))
        surface = vtkFlyingEdges3D()
        surface.SetInputConnection(fitter.GetOutputPort())
        surface.SetValue(0, 0.0)
        parts = vtkConnectivityFilter()
        parts.SetInputConnection(surface.GetOutputPort())
        parts.SetExtractionModeToAllRegions()
        parts.Update()
        self.assertEqual(parts.GetNumberOfExtractedRegions(), 1)
        vertices = vtk_to_numpy(surface.GetOutput().GetPoints().GetData())
        self.assertLess(np.abs(np.linalg.norm(vertices, axis=1) - 1).max(), 0.01)

    def test_reconstruction_with_nothing_set(self):
        reconstruction = vtkIPIASurfaceReconstruction()
        reconstruction.SetInputData(cloud(sphere(), sphere()))
        reconstruction.Update()
        surface = dsa.WrapDataObject(reconstruction.GetOutput())
        self.assertLess(np.abs(np.linalg.norm(surface.Points, axis=1) - 1).max(), 0.01)
        self.assertGreater((surface.Points * surface.PointData["Normals"]).sum(axis=1).min(), 0.99)
        self.assertIsInstance(reconstruction.GetFitter(), vtkIPIAImplicitFitter)
        self.assertGreater(reconstruction.GetFitter().GetNumberOfLevelsUsed(), 0)

    def test_scans_are_moved_together(self):
        scans = vtkMultiBlockDataSet()
        for k, shift in enumerate((-0.01, 0.01)):
            scans.SetBlock(k, cloud(sphere(2000 + k) + (shift, 0, 0), sphere(2000 + k)))
        registration = vtkIPIAScanRegistration()
        registration.SetInputDataObject(scans)
        registration.Update()
        self.assertLess(registration.GetMisfitAfter(), 0.1 * registration.GetMisfitBefore())
        for k, shift in enumerate((-0.01, 0.01)):
            field = dsa.WrapDataObject(registration.GetOutputDataObject(0).GetBlock(k)).FieldData
            matrix = np.array(field["RegistrationMatrix"]).reshape(4, 4)
            self.assertLess(np.abs(matrix[:3, 3] - (-shift, 0, 0)).max(), 5e-4)

    def test_rational_spline(self):
        fitter = classic_fitter(cloud(sphere(), sphere()))
        fitter.SetSolverToProgressiveIteration()
        fitter.SetBasisType(vtkIPIAImplicitFitter.UniformRational)
        fitter.SetWeightStepSize(5)
        fitter.SetOscillationWeight(1e-3)
        fitter.SetOscillationStep(vtkIPIAImplicitFitter.AsPrinted)
        fitter.Update()
        lattice = dsa.WrapDataObject(fitter.GetOutputDataObject(2))
        weights, coefficients = lattice.PointData["Weight"], lattice.PointData["Coefficient"]
        self.assertEqual(weights.shape, coefficients.shape)
        self.assertGreaterEqual(weights.min(), 0)
        self.assertGreater(np.ptp(weights), 1e-3)
        self.assertLessEqual(fitter.GetWeightStepSizeUsed(), 5)
        # The function is the quotient: with all weights doubled it is the same.
        doubled = lattice.VTKObject.NewInstance()
        doubled.DeepCopy(lattice.VTKObject)
        vtk_to_numpy(doubled.GetPointData().GetArray("Weight"))[:] *= 2
        function = vtkIPIAImplicitFunction()
        function.SetControlLattice(doubled)
        for x in sphere(20) * 1.02:
            self.assertAlmostEqual(function.EvaluateFunction(x),
                                   fitter.GetImplicitFunction().EvaluateFunction(x), places=12)

    def test_oscillation_weight_is_refused_with_levels(self):
        messages = []
        fitter = vtkIPIAImplicitFitter()
        fitter.AddObserver("ErrorEvent", lambda caller, event: messages.append(event))
        fitter.SetInputData(cloud(sphere(), sphere()))
        fitter.SetOscillationWeight(0.1)
        fitter.Update()
        self.assertEqual(messages, ["ErrorEvent"])
        self.assertEqual(fitter.GetOutput().GetNumberOfPoints(), 0)

    def test_image_as_array(self):
        fitter = classic_fitter(cloud(sphere(), sphere()))
        fitter.SetSampleDimensions(20, 30, 40)
        fitter.SetOutputScalarTypeToDouble()
        fitter.GenerateGradientOn()
        fitter.Update()
        image = dsa.WrapDataObject(fitter.GetOutput())
        self.assertEqual(image.PointData["f"].shape, (20 * 30 * 40,))
        self.assertEqual(image.PointData["f"].dtype, np.float64)
        self.assertEqual(image.PointData["Gradient"].shape, (20 * 30 * 40, 3))
        self.assertTrue(np.isfinite(image.PointData["f"]).all())
        f = image.PointData["f"].reshape(40, 30, 20)  # x fastest
        self.assertLess(f[20, 15, 10], 0)
        self.assertGreater(f[0, 0, 0], 0)

    def test_results(self):
        fitter = classic_fitter(cloud(sphere(), sphere()))
        fitter.Update()
        self.assertEqual(fitter.GetNumberOfIterationsUsed(), 15)
        history = dsa.WrapDataObject(fitter.GetOutput()).FieldData["ResidualHistory"]
        self.assertEqual(len(history), 16)
        residual = dsa.WrapDataObject(fitter.GetOutputDataObject(1)).PointData["Residual"]
        self.assertAlmostEqual(np.abs(residual).max(), fitter.GetMaximumError(), 12)
        self.assertAlmostEqual((residual**2).mean(), fitter.GetAverageError(), 12)

    def test_types_of_input(self):
        double = classic_fitter(cloud(sphere(), sphere()))
        single = classic_fitter(cloud(sphere().astype(np.float32), sphere()))
        for fitter in (double, single):
            fitter.Update()
        f = [dsa.WrapDataObject(x.GetOutput()).PointData["f"] for x in (double, single)]
        self.assertLess(np.abs(f[0] - f[1]).max(), 1e-4)

    def test_function(self):
        fitter = classic_fitter(cloud(sphere(), sphere()))
        fitter.Update()
        function = fitter.GetImplicitFunction()
        self.assertIsInstance(function, vtkIPIAImplicitFunction)
        self.assertAlmostEqual(function.EvaluateFunction((1, 0, 0)), 0, 2)
        self.assertLess(function.EvaluateFunction((0, 0, 0)), 0)
        self.assertGreater(function.EvaluateFunction((3, 0, 0)), 0)
        gradient = [0.0, 0.0, 0.0]
        function.EvaluateGradient((0, 1, 0), gradient)
        direction = np.array(gradient) / np.linalg.norm(gradient)
        self.assertLess(np.abs(direction - (0, 1, 0)).max(), 0.05)

        copy = vtkIPIAImplicitFunction()
        self.assertFalse(copy.HasControlLattice())
        copy.SetControlLattice(fitter.GetOutputDataObject(2))
        self.assertTrue(copy.HasControlLattice())
        for x in ((1, 0, 0), (0.1, 0.9, 0.3), (3, -2, 1)):
            self.assertEqual(copy.EvaluateFunction(x), function.EvaluateFunction(x))


if __name__ == "__main__":
    Testing.main([(TestImplicitFitterInPython, "test")])
