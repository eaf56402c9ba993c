"""ParaView hides parts by name: a deck with parts of every kind of cell is run, of which one is deleted whole, and
each part in turn is left out of what ParaView shows. What remains are the cells of the others, at every time.

    xvfb-run -a pvbatch tests/system/hide_parts.py BRIO
"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np
from paraview import servermanager, simple
from vtk import vtkCompositeDataSet
from vtk.util.numpy_support import vtk_to_numpy

DECK = """
materials:
  steel: {model: elastic_plastic, density: 7800, youngs_modulus: 2e11, poissons_ratio: 0.3, yield_stress: 2e8,
          hardening_modulus: 1e9}
parts:
  fuse: {mesh: {box: {size: [0.1, 0.1, 0.1], elements: [1, 2, 2]}}, element: hex8, material: steel,
         deletion: {plastic_strain: 0.01}}
  plate: {mesh: {plate: {size: [0.3, 0.2], elements: [3, 2]}}, placement: {translate: [1, 0, 0]},
          element: {type: shell4, thickness: 0.01}, material: steel}
  rope-1: {mesh: {line: {start: [2, 0, 0], end: [3, 0, 0], elements: 5}},
           element: {type: beam2, section: {circle: {radius: 0.01}}}, material: steel}
  bird: {mesh: {particles: {box: {size: [0.2, 0.2, 0.2], spacing: 0.1}}}, placement: {translate: [4, 0, 0]},
         element: particle, material: steel}
  joined: {mesh: {box: {size: [0.1, 0.1, 0.1], elements: [2, 2, 2]}}, placement: {translate: [0, 0, 1]}, element: hex8,
           material: steel}
  joined_too: {mesh: {box: {size: [0.1, 0.1, 0.1], elements: [2, 2, 2]}}, placement: {translate: [0, 0, 1.1]},
               element: hex8, material: steel}
  hammer: {mesh: {box: {size: [0.1, 0.1, 0.1], elements: [1, 1, 1]}}, placement: {translate: [0, 0, 5]}, element: rigid,
           material: steel}
connections: [{merge: [joined, joined_too], tolerance: 1e-6}]
boundary_conditions:
  - {set: fuse.xmin, fix: [x, y, z]}
  - {set: fuse.xmax, velocity: {x: 100}}
time: {end: 4e-5}
output: {fields: {every: 4e-6}}
"""


class Written:
    """What stands in the result file, dump by dump."""

    def __init__(self, path):
        self.file = h5py.File(path)
        self.group = self.file["VTKHDF"]
        self.times = list(self.group["Steps/Values"][()])

    def dump(self, i):
        """Part of each cell, its corners and their positions."""
        group, steps = self.group, self.group["Steps"]
        topology = steps["PartOffsets"][i]
        cells, points = group["NumberOfCells"][topology], group["NumberOfPoints"][topology]
        first = steps["CellOffsets"][i, 0]
        offsets = group["Offsets"][first + topology:first + topology + cells + 1]
        begin = steps["ConnectivityIdOffsets"][i, 0]
        connectivity = group["Connectivity"][begin:begin + offsets[-1]]
        row, point = steps["CellDataOffsets/part"][i], steps["PointOffsets"][i]
        part = group["CellData/part"][row:row + cells].reshape(-1)
        return part, np.split(connectivity, offsets[1:-1]), group["Points"][point:point + points]


def require(condition, what):
    if not condition:
        raise SystemExit(what)


def compare_blocks(blocks, names, dump, time):
    """Each block has the name of its part, and its cells where they were written."""
    part, cells, points = dump
    found = [blocks.GetMetaData(i).Get(vtkCompositeDataSet.NAME()) for i in range(blocks.GetNumberOfBlocks())]
    require(found == names, f"blocks at {time} are {found}")
    for i, name in enumerate(names):
        grid = blocks.GetBlock(i)
        own = np.flatnonzero(part == i)
        shown = grid.GetNumberOfCells() if grid else 0
        require(shown == len(own), f"{name} at {time} has {shown} cells, written were {len(own)}")
        if shown == 0:
            continue
        corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
        require(np.array_equal(vtk_to_numpy(grid.GetPoints().GetData())[corners],
                               points[np.concatenate([cells[c] for c in own])]), f"{name} is elsewhere at {time}")


def hide_each(reader, names, part, time):
    """The cells that remain are those of the others."""
    for i, hidden in enumerate(names):
        shown = simple.ExtractBlock(Input=reader, Selectors=[f"//*[@label='{name}']" for name in names if name != hidden])
        shown.UpdatePipeline(time)
        remain, expected = shown.GetDataInformation().GetNumberOfCells(), np.count_nonzero(part != i)
        require(remain == expected, f"without {hidden} {remain} cells remain at {time} in place of {expected}")
        simple.Delete(shown)


def main():
    with tempfile.TemporaryDirectory() as folder:
        deck = os.path.join(folder, "parts.yaml")
        with open(deck, "w", encoding="utf-8") as file:
            file.write(DECK)
        subprocess.run([sys.argv[1], "run", deck, "--quiet", "--output", folder], check=True)
        written = Written(os.path.join(folder, "parts.vtkhdf"))
        names = ["fuse", "plate", "rope-1", "bird", "joined", "joined_too", "hammer"]
        fuse = [np.count_nonzero(written.dump(i)[0] == 0) for i in range(len(written.times))]
        require(fuse[0] == 4 and fuse[-1] == 0, f"the fuse has {fuse} elements: it is to be deleted whole")
        reader = simple.OpenDataFile(os.path.join(folder, "parts.xdmf2"))
        require(list(reader.TimestepValues) == written.times, f"times are {list(reader.TimestepValues)}")
        order = list(range(len(written.times)))
        for i in order + order[::-3]:
            dump, time = written.dump(i), written.times[i]
            reader.UpdatePipeline(time)
            compare_blocks(servermanager.Fetch(reader), names, dump, time)
            hide_each(reader, names, dump[0], time)
        print(f"{len(names)} parts are hidden by name at {len(order)} times; elements of the fuse: {fuse}")


main()
