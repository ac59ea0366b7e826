// A program of another project, in C++.
#include <cmath>
#include <iostream>

#include <quadrel.hpp>

int main() {
  quadrel::Domain disc;
  disc.begin(quadrel::Loop::Outer, "wall");
  disc.curve([](double t) { return quadrel::Point{std::cos(6.283185307179586 * t), std::sin(6.283185307179586 * t)}; });
  disc.end();
  const quadrel::Mesh mesh = quadrel::generate(disc, quadrel::Options().order(4).relative_tolerance(1e-4));
  double x = 0.0;
  for (std::size_t node = 0; node < mesh.node_count(); ++node) x += mesh.nodes()[2 * node];
  std::cout << mesh.element_count() << " elements, mean x of the nodes " << x / static_cast<double>(mesh.node_count()) << "\n";
  return mesh.element_count() > 0 ? 0 : 1;
}
