# SPDX-License-Identifier: BSD-3-Clause
"""The programs that are compared, with the settings that they get."""
import dataclasses
import pathlib


@dataclasses.dataclass(frozen=True)
class Job:
    """program before points and surface arguments in the command line, options after them."""

    name: str
    program: str
    method: tuple = ()
    options: tuple = ()

    def command(self, folders, points, surface):
        """None if the program was not built."""
        for folder in folders:
            program = pathlib.Path(folder) / self.program
            if program.exists():
                return [str(program), *self.method, str(points), str(surface), *self.options]
        return None


#: This project's; the first is what others are compared with.
OURS = ("vtkIPIAImplicitFitter, vtkFlyingEdges3D", "vtkIPIASurfaceReconstruction")

JOBS = (
    Job(OURS[0], "ReconstructIPIA", ("contour",)),
    Job(OURS[1], "ReconstructIPIA", ("reconstruction",)),
    Job("vtkSignedDistance, 128", "ReconstructVTK", ("signed-distance",), ("128",)),
    Job("vtkSignedDistance, 256", "ReconstructVTK", ("signed-distance",), ("256",)),
    Job("vtkSurfaceReconstructionFilter, 128", "ReconstructVTK", ("surface-reconstruction",), ("128",)),
    Job("Open3D Poisson, depth 7", "ReconstructOpen3D", (), ("7",)),
    Job("Open3D Poisson, depth 8", "ReconstructOpen3D", (), ("8",)),
    Job("PCL Poisson, depth 8", "ReconstructPCL", (), ("8",)),
    Job("PCL Poisson, depth 8, unscreened", "ReconstructPCL", (), ("8", "0")),
    Job("CGAL Poisson", "ReconstructCGAL"),
    Job("CGAL Poisson, 128", "ReconstructCGAL", (), ("128",)),
)

#: Whose versions are told.
PACKAGES = ("libvtk9.1", "libopen3d-dev", "libpcl-dev", "libcgal-dev")
