// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Scanned models: triangle meshes in OFF files, of which the tests take the vertices.
 */
#ifndef IPIATestScans_h
#define IPIATestScans_h

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataNormals.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace ipiatest
{
/// The next line of an OFF file that is not empty or a comment.
inline std::istringstream NextOffLine(std::istream& file)
{
  std::string line;
  while (std::getline(file, line))
  {
    const auto first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos && line[first] != '#')
    {
      break;
    }
  }
  return std::istringstream(line);
}

/// A triangle mesh; without points if the file cannot be read.
inline vtkSmartPointer<vtkPolyData> ReadOff(const std::string& name)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  std::ifstream file(name);
  std::string keyword;
  vtkIdType numberOfPoints = 0, numberOfFaces = 0;
  if (!(NextOffLine(file) >> keyword) || keyword != "OFF" ||
    !(NextOffLine(file) >> numberOfPoints >> numberOfFaces))
  {
    return mesh;
  }
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < numberOfPoints; ++i)
  {
    double x[3] = { 0, 0, 0 };
    NextOffLine(file) >> x[0] >> x[1] >> x[2];
    points->InsertNextPoint(x);
  }
  vtkNew<vtkCellArray> faces;
  for (vtkIdType i = 0; i < numberOfFaces; ++i)
  {
    vtkIdType size = 0, ids[3] = { 0, 0, 0 };
    NextOffLine(file) >> size >> ids[0] >> ids[1] >> ids[2];
    faces->InsertNextCell(3, ids);
  }
  mesh->SetPoints(points);
  mesh->SetPolys(faces);
  return mesh;
}

/// The vertices of a closed mesh with the normals of its faces, averaged.
inline vtkSmartPointer<vtkPolyData> ReadScan(const std::string& folder, const std::string& name)
{
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(ReadOff(folder + "/meshes/" + name + ".off"));
  normals->SplittingOff();
  normals->ConsistencyOff();
  normals->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  normals->Update();
  return normals->GetOutput();
}

/// The folder after --scans on the command line.
inline std::string ScanFolder(int argc, char* argv[])
{
  const auto found = std::find(argv, argv + argc, std::string("--scans"));
  return found < argv + argc - 1 ? found[1] : "";
}
}

#endif
