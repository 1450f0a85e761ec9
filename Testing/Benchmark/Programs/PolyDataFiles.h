// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * Clouds and surfaces as binary PLY files, in single precision.
 */
#ifndef PolyDataFiles_h
#define PolyDataFiles_h

#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPLYReader.h"
#include "vtkPLYWriter.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <fstream>
#include <stdexcept>
#include <string>

namespace benchmarks
{
/// Points with normals, or a surface.
inline vtkSmartPointer<vtkPolyData> ReadPolyData(const std::string& name)
{
  vtkNew<vtkPLYReader> reader;
  reader->SetFileName(name.c_str());
  reader->Update();
  if (reader->GetOutput()->GetNumberOfPoints() == 0)
  {
    throw std::runtime_error(name + " has no points");
  }
  return reader->GetOutput();
}

inline void WriteSurface(vtkPolyData* surface, const std::string& name)
{
  if (surface->GetNumberOfPolys() == 0)
  {
    throw std::runtime_error("the surface is empty");
  }
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(surface);
  writer->SetFileName(name.c_str());
  if (!writer->Write())
  {
    throw std::runtime_error(name + " cannot be written");
  }
}

/// vtkPLYWriter cannot write normals.
inline void WriteCloud(vtkPolyData* cloud, const std::string& name)
{
  std::ofstream file(name, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << cloud->GetNumberOfPoints();
  for (const char* property : { "x", "y", "z", "nx", "ny", "nz" })
  {
    file << "\nproperty float " << property;
  }
  file << "\nend_header\n";
  vtkDataArray* normals = cloud->GetPointData()->GetNormals();
  for (vtkIdType i = 0; i < cloud->GetNumberOfPoints(); ++i)
  {
    double position[3], normal[3];
    cloud->GetPoint(i, position);
    normals->GetTuple(i, normal);
    std::array<float, 6> record{};
    for (std::size_t a = 0; a < 3; ++a)
    {
      record[a] = static_cast<float>(position[a]);
      record[3 + a] = static_cast<float>(normal[a]);
    }
    file.write(reinterpret_cast<const char*>(record.data()), sizeof(record));
  }
  if (!file.flush())
  {
    throw std::runtime_error(name + " cannot be written");
  }
}
}

#endif
