"""ParaView reads a result through its .xdmf2 companion: every array at every time, in random order.

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
from vtk.util.numpy_support import vtk_to_numpy


# XDMF's mixed list knows lines and vertices as polygons of lines and groups of vertices.
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


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], folder], check=True)
        with open(os.path.join(folder, "expected.json"), encoding="utf-8") as file:
            dumps = json.load(file)
        reader = simple.OpenDataFile(os.path.join(folder, "scene.xdmf2"))
        compare("times", reader.TimestepValues, [dump["time"] for dump in dumps])
        order = 3 * list(range(len(dumps)))
        random.Random(1).shuffle(order)
        compared = 0
        for i in order:
            reader.UpdatePipeline(dumps[i]["time"])
            compared += compare_dump(servermanager.Fetch(reader), dumps[i])
        labels = [reader.CellData["stress"].GetComponentName(c) for c in range(6)]
        compare("labels of stress", labels, ["XX", "YY", "ZZ", "XY", "YZ", "XZ"])
        print(f"{compared} arrays over {len(order)} visits of {len(dumps)} dumps are as written")


main()
