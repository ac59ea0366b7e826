"""The reader for ParaView in VTK's own Python: reader.py PLUGIN_FOLDER DOMAINS PICTURE.png

Reads a control file and an SVG file with several orders and tolerances, draws a mesh, and counts what is painted.
Needs an X server (xvfb-run) and the environment variable QUADREL_LIBRARY.
"""

import os
import sys

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, what draws
from vtkmodules.vtkCommonCore import vtkFileOutputWindow, vtkLookupTable, vtkOutputWindow
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter

SIZE = 800
LAGRANGE_QUADRILATERAL = 70


def read(reader_class, path, order=0, tolerance=0.0):
    reader = reader_class()
    reader.SetFileName(path)
    reader.SetOrder(order)
    reader.SetRelativeTolerance(tolerance)
    reader.Update()
    return reader.GetOutputDataObject(0)


def nodes(grid):
    return {grid.GetCell(c).GetNumberOfPoints() for c in range(grid.GetNumberOfCells())}


def surface(grid):
    """Curved cells as triangles, fine enough for a picture."""
    tessellated = vtkDataSetSurfaceFilter()
    tessellated.SetInputData(grid)
    tessellated.SetNonlinearSubdivisionLevel(4)
    tessellated.Update()
    return tessellated.GetOutput()


def area(triangles):
    total = 0.0
    for k in range(triangles.GetNumberOfCells()):
        points = triangles.GetCell(k).GetPoints()
        corners = [points.GetPoint(i) for i in range(points.GetNumberOfPoints())]
        following = corners[1:] + corners[:1]
        total += 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, following))
    return total


def painted(triangles, path):
    """Draws them, writes the picture, and gives the area that is painted."""
    colors = vtkLookupTable()
    colors.SetHueRange(0.0, 0.6)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(triangles)
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("scaled_jacobian")
    mapper.SetScalarRange(0.0, 1.0)
    mapper.SetLookupTable(colors)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    low_x, high_x, low_y, high_y, _, _ = triangles.GetBounds()
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(0.5 * (low_x + high_x), 0.5 * (low_y + high_y), 0)
    camera.SetPosition(0.5 * (low_x + high_x), 0.5 * (low_y + high_y), 1)
    half = 0.55 * max(high_x - low_x, high_y - low_y)
    camera.SetParallelScale(half)
    renderer.ResetCameraClippingRange()
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()
    colors = image.GetOutput().GetPointData().GetScalars()
    count = sum(colors.GetTuple3(k) != (255.0, 255.0, 255.0) for k in range(colors.GetNumberOfTuples()))
    return count * (2 * half / SIZE) ** 2


def main():
    folder, domains, picture = sys.argv[1:]
    sys.path.insert(0, folder)
    from quadrel_paraview import QuadrelReader

    man = os.path.join(domains, "hohq/GingerbreadMan.control")
    letter = os.path.join(domains, "glyphs/DejaVuSans/u0038.svg")
    grid = read(QuadrelReader, man, tolerance=1e-3)
    assert grid.GetNumberOfCells() > 10 and grid.GetCellType(0) == LAGRANGE_QUADRILATERAL
    assert grid.GetCellData().GetAbstractArray("boundary_name") and grid.GetCellData().GetArray("scaled_jacobian")
    coarse, fine = (read(QuadrelReader, letter, 3, tolerance) for tolerance in (1e-3, 1e-6))
    assert nodes(coarse) == {16} and nodes(fine) == {16} and nodes(read(QuadrelReader, letter, 7)) == {64}
    assert coarse.GetNumberOfCells() < fine.GetNumberOfCells()
    # No order given: the file's, or 5.
    assert nodes(read(QuadrelReader, letter)) == {36}

    triangles = surface(grid)
    true, found = area(triangles), painted(triangles, picture)
    assert abs(found / true - 1) < 0.01, f"painted {found:.4g} for {true:.4g}"

    log = picture + ".log"
    window = vtkFileOutputWindow()
    window.SetFileName(log)
    vtkOutputWindow.SetInstance(window)
    for path, order, said in ((letter + ".no", 0, "u0038.svg.no"), (letter, 99, "order")):
        empty = read(QuadrelReader, path, order)
        assert empty.GetNumberOfCells() == 0
    window.FlushOn()
    del window
    vtkOutputWindow.SetInstance(None)
    with open(log, encoding="utf-8") as file:
        text = file.read()
    assert "u0038.svg.no" in text and "order" in text, text
    os.remove(log)
    print(f"{grid.GetNumberOfCells()} cells; painted {found:.5g} of area {true:.5g}; {picture}")


main()
