"""ParaView reads a result through its .xdmf2 companion, as a whole and by parts: every array at every time, in random
order.

    xvfb-run -a pvbatch tests/io/paraview/paraview_reads_results.py WRITE_SCENE

WRITE_SCENE is the program that writes the scene and the values that must be found in it.
"""
import json
import os
import random
import subprocess
import sys
import tempfile

import numpy as np
from paraview import servermanager, simple
from vtk import vtkCompositeDataSet
from vtk.util.numpy_support import vtk_to_numpy


# XDMF knows lines and vertices as polygons of lines and groups of vertices.
TYPE_IN_XDMF = {1: 2, 3: 4, 9: 9, 12: 12}


def compare(name, found, expected):
    """The values must be the same, and as many."""
    found = np.asarray(found).reshape(-1)
    expected = np.asarray(expected).reshape(-1)
    if found.shape != expected.shape or not np.array_equal(found, expected):
        raise SystemExit(f"{name}: ParaView has {found[:12]} ({found.size}), "
                         f"written were {expected[:12]} ({expected.size})")


def compare_fields(where, data, expected):
    names = {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
    if not set(expected) <= names:
        raise SystemExit(f"{where}: ParaView has {sorted(names)}, written were {sorted(expected)}")
    for name, field in expected.items():
        array = data.GetArray(name)
        if array.GetNumberOfComponents() != field["components"]:
            raise SystemExit(f"{where} {name}: {array.GetNumberOfComponents()} components")
        compare(f"{where} {name}", vtk_to_numpy(array), field["values"])
    return len(expected)


def compare_dump(grid, dump):
    time = dump["time"]
    compare(f"points at {time}", vtk_to_numpy(grid.GetPoints().GetData()), dump["points"])
    compare(f"types at {time}", vtk_to_numpy(grid.GetCellTypesArray()),
            [TYPE_IN_XDMF[kind] for kind in dump["types"]])
    compare(f"connectivity at {time}", vtk_to_numpy(grid.GetCells().GetConnectivityArray()), dump["connectivity"])
    compare(f"offsets at {time}", vtk_to_numpy(grid.GetCells().GetOffsetsArray()), dump["offset"])
    return (4 + compare_fields(f"point field at {time}", grid.GetPointData(), dump["point_fields"])
            + compare_fields(f"cell field at {time}", grid.GetCellData(), dump["cell_fields"])
            + compare_fields(f"global field at {time}", grid.GetFieldData(), dump["global_fields"]))


def rows(field, first, count):
    wide = field["components"]
    return {"components": wide, "values": field["values"][wide * first:wide * (first + count)]}


def of_part(dump, part):
    """What a dump says of one part: its points are counted from its first."""
    (cell, cells), (point, points) = part["cells"], part["points"]
    begin, end = dump["offset"][cell], dump["offset"][cell + cells]
    return {"time": dump["time"], "points": dump["points"][3 * point:3 * (point + points)],
            "types": dump["types"][cell:cell + cells],
            "connectivity": [p - point for p in dump["connectivity"][begin:end]],
            "offset": [o - begin for o in dump["offset"][cell:cell + cells + 1]],
            "point_fields": {n: rows(f, point, points) for n, f in dump["point_fields"].items()},
            "cell_fields": {n: rows(f, cell, cells) for n, f in dump["cell_fields"].items()},
            "global_fields": dump["global_fields"]}


def compare_parts(blocks, dump):
    names = [blocks.GetMetaData(i).Get(vtkCompositeDataSet.NAME()) for i in range(blocks.GetNumberOfBlocks())]
    if names != [part["name"] for part in dump["parts"]]:
        raise SystemExit(f"blocks at {dump['time']}: {names}")
    compared = 1
    for i, part in enumerate(dump["parts"]):
        grid = blocks.GetBlock(i)
        if part["cells"][1] > 0:
            compared += compare_dump(grid, of_part(dump, part))
        elif grid is not None and grid.GetNumberOfCells() > 0:
            raise SystemExit(f"{part['name']} has {grid.GetNumberOfCells()} cells at {dump['time']}, written were none")
    return compared


def compare_result(path, dumps, order, compare_one):
    """Returns the number of arrays compared, and the reader."""
    reader = simple.OpenDataFile(path)
    compare("times", reader.TimestepValues, [dump["time"] for dump in dumps])
    compared = 0
    for i in order:
        reader.UpdatePipeline(dumps[i]["time"])
        compared += compare_one(servermanager.Fetch(reader), dumps[i])
    return compared, reader


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], folder], check=True)
        with open(os.path.join(folder, "expected.json"), encoding="utf-8") as file:
            dumps = json.load(file)
        order = 3 * list(range(len(dumps)))
        random.Random(1).shuffle(order)
        compared, reader = compare_result(os.path.join(folder, "scene.xdmf2"), dumps, order, compare_dump)
        compared += compare_result(os.path.join(folder, "by_parts/scene.xdmf2"), dumps, order, compare_parts)[0]
        labels = [reader.CellData["stress"].GetComponentName(c) for c in range(6)]
        compare("labels of stress", labels, ["XX", "YY", "ZZ", "XY", "YZ", "XZ"])
        print(f"{compared} arrays over {len(order)} visits of {len(dumps)} dumps are as written")


main()
