"""Shells with their thickness, beams as tubes, particles as spheres: a macro of ParaView (5.11 or later).

Macros > Import New Macro, choose this file; then select a result in the pipeline browser and press the button `thicken`. The
shapes stand in the pipeline under their names, coloured as the result is. `render.py --thicken` draws the same.
"""
from paraview import simple


def is_there(shape, time):
    """ParaView cannot show what is empty."""
    shape.UpdatePipeline(time)
    return shape.GetDataInformation().GetNumberOfPoints() > 0


def one_grid(source):
    """What the reader shows as a block a part."""
    if not source.GetDataInformation().IsCompositeDataSet():
        return source
    return simple.MergeBlocks(Input=source, MergePoints=0)


def place_of(field, shape):
    """Where a shape has a field: spheres have at their points what cells had."""
    return "CELLS" if field in shape.CellData.keys() else "POINTS"


def cells_with(source, size):
    chosen = simple.Threshold(Input=source, Scalars=["CELLS", size])
    chosen.ThresholdMethod, chosen.UpperThreshold = "Above Upper Threshold", 1e-30  # NaN where there is none
    return chosen


def beams_and_particles(source, time):
    """Tubes, and spheres of their radius at all nodes: particles, and joints that leave no gap where beams meet."""
    with_radius = cells_with(source, "radius")
    if not is_there(with_radius, time):
        return {}
    on_points = simple.CellDatatoPointData(Input=with_radius, PassCellData=1)
    surface = simple.ExtractSurface(Input=on_points)
    tubes = simple.Tube(Input=surface, Scalars=["POINTS", "radius"], VaryRadius="By Absolute Scalar", NumberofSides=12)
    apart = simple.Shrink(Input=with_radius, ShrinkFactor=1.0)  # each cell with nodes of its own, which have its values
    ends = simple.CellDatatoPointData(Input=apart)
    spheres = simple.Glyph(Input=ends, GlyphType="Sphere", ScaleArray=["POINTS", "radius"], ScaleFactor=2.0,
                           GlyphMode="All Points")
    spheres.GlyphType.ThetaResolution = spheres.GlyphType.PhiResolution = 12
    shapes = {"beams": tubes} if is_there(tubes, time) else {}
    return shapes | {"nodes of beams, particles": spheres}


def shells(source, time):
    """Both surfaces, half the thickness from the middle."""
    with_thickness = cells_with(source, "thickness")
    if not is_there(with_thickness, time):
        return {}
    on_points = simple.CellDatatoPointData(Input=with_thickness, PassCellData=1)
    surface = simple.GenerateSurfaceNormals(Input=simple.ExtractSurface(Input=on_points), Splitting=0)
    return {f"shells, {side}": simple.WarpByScalar(Input=surface, Scalars=["POINTS", "thickness"], ScaleFactor=factor)
            for side, factor in (("top", 0.5), ("bottom", -0.5))}


def thick_shapes(source, time):
    """Shapes by name; `source` is one grid."""
    fields = source.CellData.keys()
    shapes = shells(source, time) if "thickness" in fields else {}
    return shapes | (beams_and_particles(source, time) if "radius" in fields else {})


def show_in_active_view():
    result, view = simple.GetActiveSource(), simple.GetActiveViewOrCreate("RenderView")
    if result is None:
        raise RuntimeError("select a result in the pipeline browser first")
    field = simple.GetDisplayProperties(result, view).ColorArrayName[1]
    for name, shape in thick_shapes(one_grid(result), view.ViewTime).items():
        simple.RenameSource(name, shape)
        shown = simple.Show(shape, view)
        if field:
            simple.ColorBy(shown, (place_of(field, shape), field))
    simple.Render(view)


if __name__ == "__main__":
    show_in_active_view()
