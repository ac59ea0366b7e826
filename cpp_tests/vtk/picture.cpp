// Pictures of three meshes, drawn by VTK from quadrel_vtk.hpp's grids without a file between: PNG files in the
// working folder. What is painted is counted: it has the area of the mesh. Needs an X server (xvfb-run).
// picture FOLDER: tests/domains.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCell.h>
#include <vtkDataSetMapper.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkImageData.h>
#include <vtkLookupTable.h>
#include <vtkPNGWriter.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkWindowToImageFilter.h>

#include "../support/check.h"
#include "quadrel_vtk.hpp"

namespace {

constexpr int SIZE = 900;

// The elements' sides as VTK's own curves, 24 chords each.
vtkSmartPointer<vtkPolyData> sides(vtkUnstructuredGrid* grid) {
  const int chords = 24;
  auto lines = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  double weights[64];
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    for (int s = 0; s < 4; ++s) {
      vtkCell* const side = grid->GetCell(c)->GetEdge(s);
      cells->InsertNextCell(chords + 1);
      for (int k = 0; k <= chords; ++k) {
        const double parametric[3] = {static_cast<double>(k) / chords, 0.0, 0.0};
        double x[3];
        int part = 0;
        side->EvaluateLocation(part, parametric, x, weights);
        cells->InsertCellPoint(points->InsertNextPoint(x));
      }
    }
  }
  lines->SetPoints(points);
  lines->SetLines(cells);
  return lines;
}

void draw(const std::string& file, const std::string& picture) {
  const quadrel::Mesh mesh = quadrel::generate(quadrel::Domain::read(file));
  const auto grid = quadrel::vtk_grid(mesh);
  double box[6];
  grid->GetBounds(box);

  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(grid);
  // Without it curved sides are drawn straight.
  surface->SetNonlinearSubdivisionLevel(4);
  vtkNew<vtkLookupTable> colours;
  colours->SetTableRange(0, 1);
  colours->SetHueRange(0.0, 0.6);
  colours->SetSaturationRange(0.6, 0.6);
  colours->Build();
  vtkNew<vtkPolyDataMapper> surface_mapper;
  surface_mapper->SetInputConnection(surface->GetOutputPort());
  surface_mapper->SetScalarModeToUseCellData();
  surface_mapper->SetLookupTable(colours);
  surface_mapper->SetScalarRange(0, 1);
  vtkNew<vtkActor> elements;
  elements->SetMapper(surface_mapper);
  elements->GetProperty()->LightingOff();

  vtkNew<vtkPolyDataMapper> side_mapper;
  side_mapper->SetInputData(sides(grid));
  vtkNew<vtkActor> lines;
  lines->SetMapper(side_mapper);
  lines->GetProperty()->SetColor(0.1, 0.1, 0.1);
  lines->GetProperty()->LightingOff();

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  renderer->AddActor(elements);
  renderer->AddActor(lines);
  vtkCamera* const camera = renderer->GetActiveCamera();
  const double center[2] = {0.5 * (box[0] + box[1]), 0.5 * (box[2] + box[3])};
  const double half = 0.53 * std::max(box[1] - box[0], box[3] - box[2]);
  camera->ParallelProjectionOn();
  camera->SetParallelScale(half);
  camera->SetFocalPoint(center[0], center[1], 0);
  camera->SetPosition(center[0], center[1], 10 * half);
  camera->SetViewUp(0, 1, 0);
  renderer->ResetCameraClippingRange();
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(SIZE, SIZE);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window);
  image->ReadFrontBufferOff();
  image->Update();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(picture.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  CHECK(writer->GetErrorCode() == 0);

  int extent[3];
  image->GetOutput()->GetDimensions(extent);
  CHECK(extent[0] == SIZE && extent[1] == SIZE);
  if (extent[0] != SIZE || extent[1] != SIZE) return;
  std::size_t painted = 0;
  for (int y = 0; y < SIZE; ++y) {
    for (int x = 0; x < SIZE; ++x) {
      const auto* const pixel = static_cast<const unsigned char*>(image->GetOutput()->GetScalarPointer(x, y, 0));
      painted += pixel[0] < 250 || pixel[1] < 250 || pixel[2] < 250;
    }
  }
  const double pixel = 2 * half / SIZE;
  const double area = mesh.quality_range(QUADREL_MEASURE_AREA).mean * static_cast<double>(mesh.element_count());
  // Lines on the border are half a pixel too wide.
  double border = 0;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    if (mesh.edge_loops()[e] < 0) continue;
    const auto a = static_cast<std::size_t>(mesh.edge_vertices()[2 * e]), b = static_cast<std::size_t>(mesh.edge_vertices()[2 * e + 1]);
    border += 1.2 * std::hypot(mesh.vertices()[2 * a] - mesh.vertices()[2 * b], mesh.vertices()[2 * a + 1] - mesh.vertices()[2 * b + 1]);
  }
  const double found = static_cast<double>(painted) * pixel * pixel;
  std::printf("%s: area %.6g, painted %.6g, border %.6g of %.3g wide pixels\n", picture.c_str(), area, found, border, pixel);
  CHECK(std::abs(found - area) < 0.002 * area + border * pixel);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: picture FOLDER\n"), 2;
  const std::string folder = argv[1];
  try {
    draw(folder + "/hohq/GingerbreadMan.control", "gingerbread.png");
    draw(folder + "/hohq/EllipseAndFourCircles.control", "ellipse.png");
    draw(folder + "/glyphs/DejaVuSans/u0038.svg", "eight.png");
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    ++failures;
  }
  return failures != 0;
}
