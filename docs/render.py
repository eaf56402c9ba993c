"""Pictures and animations of a result, drawn offscreen by ParaView (5.11 or later).

    xvfb-run -a pvbatch docs/render.py RESULT.xdmf2 --output PREFIX [options]

(where ParaView stops with "bad X server connection", the server was caught restarting: add -s -noreset to xvfb-run)

writes PREFIX_0.png, PREFIX_1.png, ... one for each time, and prints what it drew; with --animation one GIF.

  --times T ...        simulated times; a number followed by % is a part of the last time; default 0 25 50 75 100 %
  --animation FILE.gif all dumps, in a loop of --seconds S (default 5); --output is not needed
  --color FIELD        a point or cell field; of vectors the magnitude, of stress von Mises; `part`: each part by its
                       name; without it, in grey
  --range MIN MAX      of the colours; default what occurs at the times drawn
  --hide PART ...      do not draw these parts; brick_* stands for all that begin so
  --fade PART ...      draw these parts see-through
  --camera X Y Z       direction from the scene to the eye; default 1 -2 0.7, z is up
  --zoom FACTOR        above 1 is closer
  --clip X Y Z         cut the scene open through its middle, normal to this direction
  --box X0 X1 Y0 Y1 Z0 Z1  what to frame; default all that occurs and is drawn, debris too
  --hide-edges         surface without the edges of elements
  --thicken            shells with their thickness, beams with their sections, particles as spheres
  --size WIDTH HEIGHT  default 800 600
  --largest BYTES      fewer colours, then fewer pixels, until a picture has no more
"""
import argparse
import os
import sys

from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
from beam_sections import prisms  # noqa: E402
from render_deck import Deck, ranges  # noqa: E402
from render_extent import box_over, limits_over, place_camera  # noqa: E402
from render_files import drawn, save_animation, save_picture  # noqa: E402
from thicken import one_grid, place_of, thick_shapes  # noqa: E402

PART_COLOURS = [(0.55, 0.63, 0.80), (0.99, 0.70, 0.38), (0.55, 0.80, 0.60), (0.90, 0.54, 0.76), (0.80, 0.75, 0.45),
                (0.60, 0.85, 0.88), (0.77, 0.60, 0.52), (0.70, 0.70, 0.70)]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result")
    parser.add_argument("--output")
    parser.add_argument("--times", nargs="+", default=["0%", "25%", "50%", "75%", "100%"])
    parser.add_argument("--animation")
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--color")
    parser.add_argument("--range", nargs=2, type=float)
    parser.add_argument("--hide", nargs="+", default=[])
    parser.add_argument("--fade", nargs="+", default=[])
    parser.add_argument("--camera", nargs=3, type=float, default=[1.0, -2.0, 0.7])
    parser.add_argument("--zoom", type=float, default=1.0)
    parser.add_argument("--clip", nargs=3, type=float)
    parser.add_argument("--box", nargs=6, type=float)
    parser.add_argument("--hide-edges", action="store_true")
    parser.add_argument("--thicken", action="store_true")
    parser.add_argument("--size", nargs=2, type=int, default=[800, 600])
    parser.add_argument("--largest", type=int)
    options = parser.parse_args()
    if not options.output and not options.animation:
        parser.error("one of --output and --animation is required")
    if options.animation and not options.animation.endswith(".gif"):
        parser.error("--animation writes a .gif")
    return options


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


def only_parts(source, numbers):
    """The cells of some parts."""
    found = []
    for first, last in ranges(numbers):
        part = simple.Threshold(Input=source, Scalars=["CELLS", "part"], ThresholdMethod="Between")
        part.LowerThreshold, part.UpperThreshold = first - 0.5, last + 0.5
        found.append(part)
    return found[0] if len(found) == 1 else simple.AppendDatasets(Input=found)


def colour_by(displays, name, components, limits, unit, view):
    table = simple.GetColorTransferFunction(name)
    table.ApplyPreset("Viridis (matplotlib)", True)
    table.NanColor = [0.75, 0.75, 0.75]  # what does not have the field
    table.AutomaticRescaleRangeMode = "Never"
    for display in displays:
        own_place = place_of(name, display.Input)
        simple.ColorBy(display, (own_place, name) if components == 1 else (own_place, name, "Magnitude"))
    table.RescaleTransferFunction(*limits)
    bar = simple.GetScalarBar(table, view)
    bar.Title = name.replace("_", " ") + (f" ({unit})" if unit else "")
    bar.ComponentTitle = "" if components == 1 else "magnitude"
    style_bar(bar)


def style_bar(bar):
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
    bar.TitleFontSize, bar.LabelFontSize = 16, 14
    bar.ScalarBarLength = 0.45
    bar.WindowLocation = "Lower Right Corner"
    bar.Visibility = 1


def colour_by_part(displays, deck, shown, view):
    table = simple.GetColorTransferFunction("part")
    table.InterpretValuesAsCategories = 1
    table.AnnotationsInitialized = 1
    table.Annotations = [text for i, part in enumerate(deck.parts) for text in (str(i), part)]
    table.IndexedColors = [c for i in range(len(deck.parts)) for c in PART_COLOURS[i % len(PART_COLOURS)]]
    for display in displays:
        simple.ColorBy(display, (place_of("part", display.Input), "part"))
    if len(shown) > 12:
        return
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = "part", ""
    style_bar(bar)


class Scene:
    """What is drawn of a result."""

    def __init__(self, options):
        self.options = options
        self.reader = simple.OpenDataFile(options.result)
        if self.reader is None:
            sys.exit(f"ParaView cannot open {options.result}")
        self.deck = Deck(options.result)
        available = list(self.reader.TimestepValues)
        self.times = available if options.animation else chosen_times(options.times, available)
        self.reader.UpdatePipeline(self.times[0])
        source = one_grid(self.reader)
        source.UpdatePipeline(self.times[0])
        if options.color == "stress":
            information(source, "stress")
            source, options.color = von_mises(source), "von Mises stress"
            source.UpdatePipeline(self.times[0])
        self.colour = information(source, options.color) if options.color else None
        hidden, faded = self.deck.numbers(options.hide), self.deck.numbers(options.fade)
        self.shown = set(range(len(self.deck.parts))) - hidden - faded
        if not self.shown:
            sys.exit("all parts are hidden or faded")
        self.solid = source if not hidden and not faded else only_parts(source, self.shown)
        self.faded = [only_parts(source, faded - hidden)] if faded - hidden else []
        drawn_shapes = [self.solid] + self.faded + (self.thick(self.solid) if options.thicken else [])
        self.box = options.box or box_over(drawn_shapes, self.times)
        self.limits = options.range
        if self.colour and options.color != "part" and not self.limits:
            self.limits = limits_over(self.solid, self.times, self.colour[0], options.color, self.colour[1])

    def clipped(self, source):
        if not self.options.clip:
            return source
        clip = simple.Clip(Input=source, ClipType="Plane", Crinkleclip=1)
        clip.ClipType.Origin = [(self.box[0] + self.box[1]) / 2, (self.box[2] + self.box[3]) / 2,
                                (self.box[4] + self.box[5]) / 2]
        clip.ClipType.Normal = self.options.clip
        return clip

    def thick(self, source):
        profiled = {part: section for part, section in self.deck.profiled.items() if part in self.shown}
        if not profiled:
            return list(thick_shapes(source, self.times[0]).values())
        others = self.shown - set(profiled)
        shapes = list(thick_shapes(only_parts(source, others), self.times[0]).values()) if others else []
        return shapes + [prisms(only_parts(source, set(profiled)), profiled)]

    def show(self, view):
        displays = []
        solid = self.clipped(self.solid)
        solid.UpdatePipeline(self.times[0])
        thick = self.thick(solid) if self.options.thicken else []
        for shape in [solid] + thick + [self.clipped(faded) for faded in self.faded]:
            display = simple.Show(shape, view)
            is_faded = len(displays) > len(thick)
            with_edges = not (self.options.hide_edges or displays)
            display.Representation = "Surface With Edges" if with_edges else "Surface"
            display.EdgeColor = [0.15, 0.15, 0.15]
            display.LineWidth = 1.0
            display.DiffuseColor = [0.75, 0.78, 0.82]
            display.Opacity = 0.2 if is_faded else 1.0
            if display.ColorArrayName[1]:
                simple.ColorBy(display, None)
            displays.append(display)
        solid_displays = displays[:1 + len(thick)]
        name = self.options.color
        if name == "part":
            colour_by_part(solid_displays, self.deck, self.shown, view)
        elif self.colour:
            colour_by(solid_displays, name, self.colour[1], self.limits, self.deck.unit(name), view)

    def cells_at(self, time):
        self.reader.UpdatePipeline(time)
        return self.reader.GetDataInformation().GetNumberOfCells()


def white_view(size):
    view = simple.CreateRenderView(ViewSize=size)
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 1
    view.OrientationAxesLabelColor = [0.1, 0.1, 0.1]
    return view


def time_label(view):
    label = simple.Text()
    display = simple.Show(label, view)
    display.Color = [0.1, 0.1, 0.1]
    display.FontSize = 16
    display.WindowLocation = "Upper Left Corner"
    return label


def main():
    options = arguments()
    scene = Scene(options)
    view = white_view(options.size)
    scene.show(view)
    simple.Render(view)  # the first picture places a camera of its own
    place_camera(view, scene.box, options.camera, options.zoom, options.size[0] / options.size[1])
    label, unit = time_label(view), scene.deck.units.get("time", "")
    frames = []
    for number, time in enumerate(scene.times):
        view.ViewTime = time
        label.Text = f"t = {time:.4g} {unit}".strip()
        simple.Render(view)
        if options.animation:
            frames.append(drawn(options.animation + ".png", view, options.size))
            continue
        path = f"{options.output}_{number}.png"
        pixels = save_picture(path, view, options.size, options.largest)
        what = f", {options.color} from {scene.limits[0]:.6g} to {scene.limits[1]:.6g}" if scene.limits else ""
        print(f"{path}: time {time:.6g}, {scene.cells_at(time)} cells{what}, {pixels[0]} x {pixels[1]}, "
              f"{os.path.getsize(path)} bytes")
    if options.animation:
        os.remove(options.animation + ".png")
        save_animation(options.animation, frames, options.seconds)
        print(f"{options.animation}: {len(frames)} frames, {os.path.getsize(options.animation)} bytes")


main()
