"""Beams with the rectangular and I sections of a deck, as prisms, for render.py.

Axes of a section as when the run begins (docs/deck.md, beam2): z is the orientation across the beam, y stands on both; a
beam that turns about itself is drawn as if it did not.
"""
from paraview import simple


def polygons_of(section):
    """Convex polygons (y, z) of a section, counterclockwise seen against the beam; none of round ones."""
    kind, lengths = next(iter(section.items()))
    if kind not in ("rectangle", "i_section"):
        return []
    half_width, half_height = lengths["width"] / 2, lengths["height"] / 2
    if kind == "rectangle":
        return [rectangle(-half_width, half_width, -half_height, half_height)]
    web, flange = lengths["web_thickness"] / 2, half_height - lengths["flange_thickness"]
    return [rectangle(-half_width, half_width, -half_height, -flange), rectangle(-web, web, -flange, flange),
            rectangle(-half_width, half_width, flange, half_height)]


def rectangle(y0, y1, z0, z1):
    return [(y0, z0), (y1, z0), (y1, z1), (y0, z1)]


def profiled_parts(parts):
    """{number of a part: (polygons, orientation)}. \\param parts of the deck, by name"""
    profiled = {}
    for number, part in enumerate(parts.values()):
        element = part.get("element")
        section = element.get("section") if isinstance(element, dict) else None
        polygons = polygons_of(section) if section else []
        if polygons:
            profiled[number] = (polygons, element.get("orientation", [0, 0, 1]))
    return profiled


def prisms(source, profiled):
    """\\param source one grid, of beams of the profiled parts"""
    return simple.ProgrammableFilter(Input=source, OutputDataSetType="vtkPolyData",
                                     Script=f"profiled = {profiled!r}\n" + SCRIPT)


# In ParaView's own Python: six rectangles a polygon, which keep the values of their beam and its nodes.
SCRIPT = """
import numpy as np
from vtkmodules.util import numpy_support as convert
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray

grid = self.GetInputDataObject(0, 0)
result = self.GetOutputDataObject(0)
place = convert.vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
line = convert.vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 2)
part = convert.vtk_to_numpy(grid.GetCellData().GetArray("part"))

start, along = place[line[:, 0]], place[line[:, 1]] - place[line[:, 0]]
along_unit = along / np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
points, cells, beam_of_cell, node_of_point = [], [], [], []


def add(chosen, polygon, orientation):
    x = along_unit[chosen]
    wanted = np.broadcast_to(np.array(orientation, float), x.shape)
    y = np.cross(wanted, x)
    y /= np.maximum(np.linalg.norm(y, axis=1), 1e-300)[:, None]
    z = np.cross(x, y)
    first = len(np.concatenate(points)) if points else 0  # `sum` is numpy's here
    corners = [start[chosen] + end * along[chosen] + a * y + b * z for end in (0, 1) for a, b in polygon]
    points.append(np.stack(corners, axis=1).reshape(-1, 3))
    node_of_point.append(np.repeat(line[chosen], 4, axis=1).ravel())
    sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)] + [(3, 2, 1, 0), (4, 5, 6, 7)]
    number = np.arange(len(chosen))
    for side in sides:
        cells.append(first + 8 * number[:, None] + np.array(side))
        beam_of_cell.append(chosen)


for number, (polygons, orientation) in profiled.items():
    chosen = np.flatnonzero(part == number)
    for polygon in polygons:
        add(chosen, polygon, orientation)

made = vtkPoints()
made.SetData(convert.numpy_to_vtk(np.concatenate(points), deep=True))
result.SetPoints(made)
quads = np.concatenate(cells)
polys = vtkCellArray()
polys.SetData(4, convert.numpy_to_vtkIdTypeArray(np.ascontiguousarray(quads.ravel()), deep=True))
result.SetPolys(polys)


def keep_values(of_all, of_result, chosen):
    for k in range(of_all.GetNumberOfArrays()):
        array = of_all.GetArray(k)
        if array is None:
            continue
        values = convert.numpy_to_vtk(convert.vtk_to_numpy(array)[chosen], deep=True)
        values.SetName(array.GetName())
        of_result.AddArray(values)


keep_values(grid.GetCellData(), result.GetCellData(), np.concatenate(beam_of_cell))
keep_values(grid.GetPointData(), result.GetPointData(), np.concatenate(node_of_point))
"""
