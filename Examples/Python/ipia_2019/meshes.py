# SPDX-License-Identifier: BSD-3-Clause
"""The scanned models: meshes of Debian's package libcgal-demo, turned into points with normals."""

from pathlib import Path
import subprocess
import tarfile

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtkIdTypeArray, vtk_to_numpy

from .cloud import Cloud, points_polydata, unit

PACKAGE = "libcgal-demo"
ARCHIVE = Path("usr/share/doc/libcgal-dev/data.tar.gz")
MESH_FOLDER = Path("data/meshes")


class MeshError(Exception):
    """The meshes cannot be had; the message says what to do."""


def mesh_folder(given, work_folder):
    """The folder of the .off files: the given one, or the package, fetched and unpacked once."""
    if given is not None:
        return _existing(Path(given))
    target = Path(work_folder) / PACKAGE
    if not (target / MESH_FOLDER).is_dir():
        _fetch_package(target)
    return _existing(target / MESH_FOLDER)


def _existing(folder):
    for candidate in (folder, folder / "meshes", folder / MESH_FOLDER):
        if (candidate / "bunny00.off").is_file():
            return candidate
    raise MeshError(f"no bunny00.off below {folder}: unpack data.tar.gz of Debian's package "
                    f"{PACKAGE} there, or leave --data out")


def _fetch_package(target):
    target.mkdir(parents=True, exist_ok=True)
    try:
        subprocess.run(["apt-get", "download", PACKAGE], cwd=target, check=True,
                       stdout=subprocess.DEVNULL)
        archive = next(target.glob("*.deb"))
        subprocess.run(["dpkg-deb", "-x", archive.name, "."], cwd=target, check=True)
    except (OSError, subprocess.CalledProcessError, StopIteration) as error:
        raise MeshError(f"cannot fetch the Debian package {PACKAGE} ({error}): unpack it elsewhere "
                        "and name the folder with --data") from error
    with tarfile.open(target / ARCHIVE) as tar:
        tar.extractall(target)


def mesh_polydata(path):
    """The mesh of an OFF file, as it is there."""
    return _polydata(*_read_off(path))


def mesh_cloud(path, count, random):
    """
    count points of a mesh, normalised: of its vertices if there are enough, else all of them and
    the rest on its triangles, evenly by area. Normals are the vertex normals, interpolated.
    """
    vertices, triangles = _read_off(path)
    normals = _vertex_normals(vertices, triangles)
    cloud = Cloud(vertices, normals)
    if count <= len(cloud):
        return cloud.random_subset(count, random).normalised()
    extra = _on_triangles(cloud, triangles, count - len(cloud), random)
    return Cloud(np.vstack((cloud.points, extra.points)),
                 np.vstack((cloud.normals, extra.normals))).normalised()


def _read_off(path):
    """Vertices (n, 3) and triangles (m, 3) of an OFF file of triangles."""
    with open(path, encoding="ascii") as file:
        words = [word for line in file for word in line.split("#")[0].split()]
    if words[0] != "OFF":
        raise MeshError(f"{path} is not an OFF file")
    vertex_count, face_count = int(words[1]), int(words[2])
    begin, end = 4, 4 + 3 * vertex_count
    vertices = np.array(words[begin:end], dtype=float).reshape(-1, 3)
    faces = np.array(words[end:end + 4 * face_count], dtype=np.int64).reshape(-1, 4)
    if (faces[:, 0] != 3).any():
        raise MeshError(f"{path} has faces that are not triangles")
    used = np.unique(faces[:, 1:])
    new_index = np.zeros(vertex_count, dtype=np.int64)
    new_index[used] = np.arange(len(used))
    return vertices[used], new_index[faces[:, 1:]]


def _polydata(vertices, triangles):
    cells = vtk.vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 3 * len(triangles) + 1, 3), deep=True),
                  numpy_to_vtkIdTypeArray(triangles.ravel().copy(), deep=True))
    mesh = points_polydata(vertices)
    mesh.SetPolys(cells)
    return mesh


def _vertex_normals(vertices, triangles):
    """Outward vertex normals of an oriented mesh."""
    filter_ = vtk.vtkPolyDataNormals()
    filter_.SetInputData(_polydata(vertices, triangles))
    filter_.SplittingOff()
    filter_.ConsistencyOff()
    filter_.Update()
    return unit(vtk_to_numpy(filter_.GetOutput().GetPointData().GetNormals()).astype(float))


def _on_triangles(cloud, triangles, count, random):
    """count points at random places of triangles that are taken in equal steps of area."""
    corners = cloud.points[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                           axis=1)
    steps = (np.arange(count) + 0.5) / count * areas.sum()
    chosen = triangles[np.searchsorted(np.cumsum(areas), steps)]
    root, share = np.sqrt(random.random(count)), random.random(count)
    weights = np.column_stack((1 - root, root * (1 - share), root * share))
    return Cloud(np.einsum("ij,ijk->ik", weights, cloud.points[chosen]),
                 unit(np.einsum("ij,ijk->ik", weights, cloud.normals[chosen])))
