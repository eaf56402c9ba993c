#!/usr/bin/env python3
"""Writes a cube of N^3 hexahedra as an Exodus file, for bench_mesh.

    apps/bench/write_exodus.py N FILE [--hdf5]

Classic netCDF with 64-bit offsets, or netCDF on HDF5.
"""
import sys

import numpy as np


def cube(n):
    k, j, i = np.meshgrid(*3 * [np.arange(n + 1)], indexing="ij")
    number = 1 + i + (n + 1) * (j + (n + 1) * k)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    table = np.stack([number[c:n + c, b:n + b, a:n + a].ravel() for a, b, c in corners], axis=1)
    return [axis.ravel() / 3.0 for axis in (i, j, k)], table.astype("i4")


def variables(n):
    coordinates, table = cube(n)
    dimensions = {"num_dim": 3, "num_nodes": table.max(), "num_elem": len(table), "num_el_blk": 1,
                  "num_el_in_blk1": len(table), "num_nod_per_el1": 8}
    arrays = {"coord" + axis: (values, ("num_nodes",)) for axis, values in zip("xyz", coordinates)}
    arrays["eb_prop1"] = np.array([1], "i4"), ("num_el_blk",)
    arrays["connect1"] = table, ("num_el_in_blk1", "num_nod_per_el1")
    return dimensions, arrays


def write_classic(n, path):
    from scipy.io import netcdf_file

    dimensions, arrays = variables(n)
    with netcdf_file(path, "w", version=2) as file:
        for name, length in dimensions.items():
            file.createDimension(name, int(length))
        for name, (values, along) in arrays.items():
            file.createVariable(name, values.dtype, along)[:] = values
        file.variables["connect1"].elem_type = "HEX8"


def write_hdf5(n, path):
    import h5py

    dimensions, arrays = variables(n)
    with h5py.File(path, "w", track_order=True) as file:
        for name, length in dimensions.items():
            scale = file.create_dataset(name, (int(length),), "f4")
            scale.make_scale(f"This is a netCDF dimension but not a netCDF variable.{int(length):10d}")
        for name, (values, along) in arrays.items():
            table = file.create_dataset(name, data=values)
            for place, dimension in enumerate(along):
                table.dims[place].attach_scale(file[dimension])
        file["connect1"].attrs["elem_type"] = np.bytes_("HEX8")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    (write_hdf5 if "--hdf5" in sys.argv else write_classic)(int(sys.argv[1]), sys.argv[2])
