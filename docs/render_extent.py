"""Of what is drawn: the extent of values and of space, and the camera that holds it.

Not in render.py: a programmable filter of ParaView redefines min, max and sum of the main module.
"""
import numpy as np


def limits_over(source, times, place, name, components):
    """Smallest and largest value at the given times."""
    lower, upper = float("inf"), float("-inf")
    for time in times:
        source.UpdatePipeline(time)
        arrays = source.PointData if place == "POINTS" else source.CellData
        low, high = arrays[name].GetRange(-1 if components > 1 else 0)
        lower, upper = min(lower, low), max(upper, high)
    return (lower, upper) if upper > lower else (lower - 0.5, upper + 0.5)


def box_over(sources, times):
    """The box that holds what is drawn at all times, so that the camera can stand still."""
    box = [float("inf"), float("-inf")] * 3
    for time in times:
        for source in sources:
            source.UpdatePipeline(time)
            bounds = source.GetDataInformation().GetBounds()
            box = [min(a, b) if i % 2 == 0 else max(a, b) for i, (a, b) in enumerate(zip(box, bounds))]
    return box


def place_camera(view, box, direction, zoom, aspect):
    """Parallel projection along `direction` that just holds the box."""
    lower, upper = np.array(box[0::2]), np.array(box[1::2])
    centre, half = (lower + upper) / 2, (upper - lower) / 2
    towards = np.array(direction) / np.linalg.norm(direction)
    up = np.array([0.0, 1.0, 0.0] if abs(towards[2]) > 0.99 else [0.0, 0.0, 1.0])
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    above = np.cross(towards, right)
    width, height = np.dot(np.abs(right), half), np.dot(np.abs(above), half)
    view.CameraParallelProjection = 1
    view.CameraParallelScale = float(1.08 * np.fmax(height, width / aspect) / zoom)
    view.CameraFocalPoint = list(centre)
    view.CameraPosition = list(centre + 5 * np.linalg.norm(half) * towards)
    view.CameraViewUp = list(up)
