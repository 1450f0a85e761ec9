// SPDX-License-Identifier: BSD-3-Clause
// A cloud in, a surface out, by the classes of this project; the time of each stage on standard
// output.
//
//   ReconstructIPIA contour|reconstruction points.ply surface.ply [cells]
//
// contour: vtkIPIAImplicitFitter, vtkFlyingEdges3D. reconstruction: vtkIPIASurfaceReconstruction.
// Nothing is set but, where it is given, the number of knot cells along the longest side.
#include "Job.h"
#include "PolyDataFiles.h"
#include "StageClock.h"

#include "vtkIPIAImplicitFitter.h"
#include "vtkIPIAImplicitFunction.h"
#include "vtkIPIASurfaceReconstruction.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkFlyingEdges3D.h"
#include "vtkImageData.h"

#include <algorithm>
#include <stdexcept>

namespace
{
using benchmarks::StageClock;

/// The stages of a fitter's update: its function is replaced when the fit is done.
class FitterStages
{
public:
  /// @param samples  whether the fitter also makes an image
  FitterStages(vtkIPIAImplicitFitter* fitter, bool samples, StageClock& clock)
    : Clock(clock)
  {
    this->Observer->SetClientData(this);
    this->Observer->SetCallback(
      [](vtkObject* caller, unsigned long, void* self, void*)
      {
        auto& stages = *static_cast<FitterStages*>(self);
        auto* function = vtkIPIAImplicitFunction::SafeDownCast(caller);
        if (!function)
        {
          stages.Clock.Finish("sample");
        }
        else if (stages.Fitted)
        {
          stages.Clock.Finish("fit");
        }
        stages.Fitted = true;
      });
    // Once to drop the old function, once for the new one.
    fitter->GetImplicitFunction()->AddObserver(vtkCommand::ModifiedEvent, this->Observer);
    if (samples)
    {
      fitter->AddObserver(vtkCommand::EndEvent, this->Observer);
    }
  }

private:
  StageClock& Clock;
  bool Fitted = false;
  vtkNew<vtkCallbackCommand> Observer;
};

void setCells(vtkIPIAImplicitFitter* fitter, vtkPolyData* cloud, int cells)
{
  double bounds[6];
  cloud->GetBounds(bounds);
  const double sides[3] = { bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] };
  int size[3] = { 0, 0, 0 };
  size[std::max_element(sides, sides + 3) - sides] = cells + 3;
  fitter->SetGridSize(size);
}

void reconstruct(const std::vector<std::string>& arguments)
{
  StageClock clock;
  const bool contouring = arguments[0] == "contour";
  if (!contouring && arguments[0] != "reconstruction")
  {
    throw std::runtime_error(arguments[0] + " is neither contour nor reconstruction");
  }
  auto cloud = benchmarks::ReadPolyData(arguments[1]);
  clock.Finish("read");

  vtkNew<vtkIPIASurfaceReconstruction> reconstruction;
  vtkNew<vtkIPIAImplicitFitter> fitter;
  vtkNew<vtkFlyingEdges3D> contour;
  vtkIPIAImplicitFitter* used = contouring ? fitter.Get() : reconstruction->GetFitter();
  vtkPolyDataAlgorithm* last = contour;
  if (contouring)
  {
    fitter->SetInputData(cloud);
    contour->SetInputConnection(fitter->GetOutputPort());
    contour->SetValue(0, 0.0);
  }
  else
  {
    reconstruction->SetInputData(cloud);
    last = reconstruction;
  }
  if (arguments.size() > 3)
  {
    setCells(used, cloud, std::stoi(arguments[3]));
  }
  const FitterStages stages(used, contouring, clock);
  std::string refusal;
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&refusal);
  observer->SetCallback([](vtkObject*, unsigned long, void* text, void* message)
    { *static_cast<std::string*>(text) += static_cast<const char*>(message); });
  used->AddObserver(vtkCommand::ErrorEvent, observer);
  last->Update();
  clock.Finish("contour");
  if (!refusal.empty())
  {
    // After the name of the class and its address.
    throw std::runtime_error(refusal.substr(refusal.find("): ") + 3));
  }

  benchmarks::WriteSurface(last->GetOutput(), arguments[2]);
  clock.Finish("write");
  clock.Print();
  const int* size = used->GetGridSizeUsed();
  std::cout << "{\"points\": " << cloud->GetNumberOfPoints() << ", \"grid\": [" << size[0] << ", "
            << size[1] << ", " << size[2] << "], \"levels\": " << used->GetNumberOfLevelsUsed()
            << ", \"triangles\": " << last->GetOutput()->GetNumberOfPolys() << "}" << std::endl;
}
}

int main(int argc, char* argv[])
{
  return benchmarks::RunJob(
    argc, argv, 3, "contour|reconstruction points.ply surface.ply [cells]", reconstruct);
}
