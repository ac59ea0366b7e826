// Meshes the air around a NACA 0012 airfoil in a round far field and writes airfoil.vtu and, with what every
// stage made, airfoil.svg. Shows curves as callables, names, options, progress, and reading the mesh's arrays.
//
// c++ -std=c++17 airfoil.cpp $(pkg-config --cflags --libs quadrel) -o airfoil
#include <cmath>
#include <cstdio>
#include <iostream>

#include <quadrel.hpp>

// Half the thickness of the NACA 0012 at x in [0, 1], closed at the trailing edge.
static double half_thickness(double x) {
  return 0.6 * (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
}

int main() {
  const double two_pi = 6.283185307179586;
  quadrel::Domain air;
  air.begin(quadrel::Loop::Outer, "far").arc({0.5, 0.0}, 5.0, 0.0, two_pi).end();
  // From the trailing edge round the nose and back; x = s^2 makes the nose smooth in s.
  air.begin(quadrel::Loop::Hole, "airfoil");
  air.curve([](double t) {
    const double s = 1.0 - 2.0 * t, x = s * s;
    return quadrel::Point{x, s >= 0.0 ? half_thickness(x) : -half_thickness(x)};
  });
  air.end();

  quadrel::Stages stages;
  try {
    quadrel::Options options;
    options.order(5).relative_tolerance(1e-5);
    options.progress([](quadrel_stage, double done) {
      std::fprintf(stderr, "\r%3.0f %%", 100.0 * done);
      return true;
    });
    const quadrel::Mesh mesh = quadrel::generate(air, options, &stages);
    const quadrel::Range quality = mesh.quality_range(QUADREL_MEASURE_SCALED_JACOBIAN);
    std::cout << "\n" << mesh.element_count() << " elements, " << mesh.node_count() << " nodes, least scaled Jacobian "
              << quality.min << "\n";

    // Length of the airfoil's boundary by its corner vertices, to show the edges' arrays.
    double length = 0.0;
    for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
      const std::int32_t boundary = mesh.edge_boundaries()[e];
      if (boundary < 0 || mesh.boundary_name(boundary) != "airfoil") continue;
      const double* a = &mesh.vertices()[2 * static_cast<std::size_t>(mesh.edge_vertices()[2 * e])];
      const double* b = &mesh.vertices()[2 * static_cast<std::size_t>(mesh.edge_vertices()[2 * e + 1])];
      length += std::hypot(b[0] - a[0], b[1] - a[1]);
    }
    std::cout << "the airfoil's polygon is " << length << " long\n";
    mesh.write(quadrel::Format::Vtu, "airfoil.vtu");
  } catch (const quadrel::Error& error) {
    std::cerr << "\n" << error.name() << ": " << error.what() << "\n";
    stages.write_svg(QUADREL_PICTURE_ALL, "airfoil.svg");
    return 1;
  }
  stages.write_svg(QUADREL_PICTURE_ALL, "airfoil.svg");
  return 0;
}
