"""Pictures of a result, drawn offscreen by ParaView (5.11 or later).

    xvfb-run -a pvbatch docs/render.py RESULT.xdmf2 --output PREFIX [options]

(where ParaView stops with "bad X server connection", the server was caught restarting: add -s -noreset to xvfb-run)

writes PREFIX_0.png, PREFIX_1.png, ... one for each time, at most 100 kB each, and prints what it drew.

  --times T ...        simulated times; a number followed by % is a part of the last time; default 0 25 50 75 100 %
  --color FIELD        a point or cell field; of vectors the magnitude, of stress von Mises; without it, parts in grey
  --range MIN MAX      of the colours; default what occurs at the times drawn
  --camera X Y Z       direction from the scene to the eye; default 1 -2 0.7, z is up
  --zoom FACTOR        above 1 is closer
  --clip X Y Z         cut the scene open through its middle, normal to this direction
  --box X0 X1 Y0 Y1 Z0 Z1  what to frame; default all that occurs, debris too
  --hide-edges         surface without the edges of elements
  --thicken            beams as tubes and particles as spheres of their radius
  --size WIDTH HEIGHT  default 800 600
"""
import argparse
import os
import struct
import sys
import zlib

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkImagingColor import vtkImageQuantizeRGBToIndex

LARGEST_PICTURE = 100_000  # bytes


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result")
    parser.add_argument("--output", required=True)
    parser.add_argument("--times", nargs="+", default=["0%", "25%", "50%", "75%", "100%"])
    parser.add_argument("--color")
    parser.add_argument("--range", nargs=2, type=float)
    parser.add_argument("--camera", nargs=3, type=float, default=[1.0, -2.0, 0.7])
    parser.add_argument("--zoom", type=float, default=1.0)
    parser.add_argument("--clip", nargs=3, type=float)
    parser.add_argument("--box", nargs=6, type=float)
    parser.add_argument("--hide-edges", action="store_true")
    parser.add_argument("--thicken", action="store_true")
    parser.add_argument("--size", nargs=2, type=int, default=[800, 600])
    return parser.parse_args()


def chosen_times(words, available):
    """The dumps nearest to the times asked for."""
    wanted = [float(w[:-1]) / 100 * available[-1] if w.endswith("%") else float(w) for w in words]
    return [min(available, key=lambda t, w=w: abs(t - w)) for w in wanted]


def information(source, name):
    """('POINTS' or 'CELLS', number of components) of a field."""
    for place, arrays in (("POINTS", source.PointData), ("CELLS", source.CellData)):
        if name in arrays.keys():
            return place, arrays[name].GetNumberOfComponents()
    known = sorted(source.PointData.keys()) + sorted(source.CellData.keys())
    sys.exit(f"no field '{name}'; the result has {', '.join(known)}")


def von_mises(source):
    """Components as ParaView keeps them: XX YY ZZ XY YZ XZ."""
    s = [f"stress_{c}" for c in ("XX", "YY", "ZZ", "XY", "YZ", "XZ")]
    expression = (f"sqrt(0.5*(({s[0]}-{s[1]})^2+({s[1]}-{s[2]})^2+({s[2]}-{s[0]})^2)"
                  f"+3*({s[3]}^2+{s[4]}^2+{s[5]}^2))")
    return simple.Calculator(Input=source, AttributeType="Cell Data", ResultArrayName="von Mises stress",
                             Function=expression)


def colour_by(displays, place, name, components, limits, view):
    table = simple.GetColorTransferFunction(name)
    table.ApplyPreset("Viridis (matplotlib)", True)
    table.NanColor = [0.75, 0.75, 0.75]  # what does not have the field
    table.AutomaticRescaleRangeMode = "Never"
    for display in displays:
        own_place = "POINTS" if "Glyph" in str(display.Input.SMProxy.GetXMLName()) else place  # centres of cells
        simple.ColorBy(display, (own_place, name) if components == 1 else (own_place, name, "Magnitude"))
    table.RescaleTransferFunction(*limits)
    bar = simple.GetScalarBar(table, view)
    bar.Title = name.replace("_", " ")
    bar.ComponentTitle = "" if components == 1 else "magnitude"
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    bar.TitleFontSize, bar.LabelFontSize = 16, 14
    bar.ScalarBarLength = 0.45
    bar.WindowLocation = "Lower Right Corner"
    bar.Visibility = 1


def limits_over(source, times, place, name, components):
    """Smallest and largest value at the given times."""
    lower, upper = float("inf"), float("-inf")
    for time in times:
        source.UpdatePipeline(time)
        arrays = source.PointData if place == "POINTS" else source.CellData
        low, high = arrays[name].GetRange(-1 if components > 1 else 0)
        lower, upper = min(lower, low), max(upper, high)
    return (lower, upper) if upper > lower else (lower - 0.5, upper + 0.5)


def box_over(source, times):
    """The box that holds the scene at all times, so that the camera can stand still."""
    box = [float("inf"), float("-inf")] * 3
    for time in times:
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


def chunk(kind, data):
    """A chunk of a PNG file."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def drawn(path, view, pixels):
    """The view as height x width x 3 bytes. Drawn twice as large: edges come out half a pixel wide."""
    simple.SaveScreenshot(path, view, ImageResolution=[2 * n for n in pixels])
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    colours = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    width, height = pixels
    return colours.reshape(height, 2, width, 2, -1)[..., :3].mean(axis=(1, 3)).astype(np.uint8)


def write_with_palette(path, colours, number):
    """A PNG file of so many different colours: a third of the size of one with all, no difference to see."""
    height, width, _ = colours.shape
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(colours.reshape(-1, 3), deep=True))
    quantized = vtkImageQuantizeRGBToIndex()
    quantized.SetInputData(image)
    quantized.SetNumberOfColors(number)
    quantized.Update()
    index = vtk_to_numpy(quantized.GetOutput().GetPointData().GetScalars())
    rows = index.astype(np.uint8).reshape(height, width)[::-1]
    rows = np.hstack([np.zeros((height, 1), np.uint8), rows])  # every row begins with its filter: none
    table = quantized.GetLookupTable()
    palette = b"".join(bytes(round(255 * c) for c in table.GetTableValue(i)[:3])
                       for i in range(table.GetNumberOfTableValues()))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0))
                   + chunk(b"PLTE", palette) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b""))


def save(path, view, size):
    """Fewer colours, then fewer pixels, until the picture is small enough."""
    for scale, number in ((1.0, 256), (1.0, 64), (1.0, 32), (0.85, 64), (0.7, 64), (0.5, 64)):
        pixels = [int(scale * n) for n in size]
        write_with_palette(path, drawn(path, view, pixels), number)
        if os.path.getsize(path) <= LARGEST_PICTURE:
            break
    return pixels


def shown_shapes(source, options, time):
    """What to draw: the scene itself, and tubes and spheres if they are asked for. A sphere of its radius in the
    middle of a beam is inside its tube, so that beams and particles need not be told apart."""
    shapes = [source]
    if options.thicken and "radius" in source.CellData.keys():
        with_radius = simple.Threshold(Input=source, Scalars=["CELLS", "radius"])
        with_radius.ThresholdMethod, with_radius.UpperThreshold = "Above Upper Threshold", 1e-30
        on_points = simple.CellDatatoPointData(Input=with_radius, PassCellData=1)
        surface = simple.ExtractSurface(Input=on_points)
        tubes = simple.Tube(Input=surface, Scalars=["POINTS", "radius"], VaryRadius="By Absolute Scalar",
                            NumberofSides=12)
        tubes.UpdatePipeline(time)
        if tubes.GetDataInformation().GetNumberOfPoints() > 0:  # ParaView cannot show what is empty
            shapes.append(tubes)
        centres = simple.CellCenters(Input=with_radius, VertexCells=1)
        shapes.append(simple.Glyph(Input=centres, GlyphType="Sphere", ScaleArray=["POINTS", "radius"],
                                   ScaleFactor=2.0, GlyphMode="All Points"))
    return shapes


def main():
    options = arguments()
    reader = simple.OpenDataFile(options.result)
    if reader is None:
        sys.exit(f"ParaView cannot open {options.result}")
    available = list(reader.TimestepValues)
    times = chosen_times(options.times, available)
    reader.UpdatePipeline(times[0])

    source = reader
    if options.color == "stress":
        information(source, "stress")
        source, options.color = von_mises(source), "von Mises stress"
        source.UpdatePipeline(times[0])
    colour = (*information(source, options.color),) if options.color else None
    box = options.box or box_over(source, times)
    limits = options.range or (limits_over(source, times, colour[0], options.color, colour[1]) if colour else None)
    if options.clip:
        source = simple.Clip(Input=source, ClipType="Plane", Crinkleclip=1)
        source.ClipType.Origin = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2]
        source.ClipType.Normal = options.clip

    view = simple.CreateRenderView(ViewSize=options.size)
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 1
    view.OrientationAxesLabelColor = [0.1, 0.1, 0.1]
    displays = []
    for shape in shown_shapes(source, options, times[0]):
        display = simple.Show(shape, view)
        display.Representation = "Surface" if options.hide_edges or displays else "Surface With Edges"
        display.EdgeColor = [0.15, 0.15, 0.15]
        display.LineWidth = 1.0
        display.DiffuseColor = [0.75, 0.78, 0.82]
        simple.ColorBy(display, None)
        displays.append(display)
    if colour:
        colour_by(displays, colour[0], options.color, colour[1], limits, view)
    simple.Render(view)  # the first picture places a camera of its own
    place_camera(view, box, options.camera, options.zoom, options.size[0] / options.size[1])

    label = simple.Text()
    label_display = simple.Show(label, view)
    label_display.Color = [0.1, 0.1, 0.1]
    label_display.FontSize = 16
    label_display.WindowLocation = "Upper Left Corner"
    for number, time in enumerate(times):
        view.ViewTime = time
        label.Text = f"t = {time:.4g}"
        simple.Render(view)
        path = f"{options.output}_{number}.png"
        pixels = save(path, view, options.size)
        reader.UpdatePipeline(time)
        cells = reader.GetDataInformation().GetNumberOfCells()
        what = f", {options.color} from {limits[0]:.6g} to {limits[1]:.6g}" if colour else ""
        print(f"{path}: time {time:.6g}, {cells} cells{what}, {pixels[0]} x {pixels[1]}, {os.path.getsize(path)} bytes")


main()
