// Eight threads at once: different objects each, then readers of one mesh; errors stay with their thread.
#include <cmath>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "../support/check.h"
#include "../support/shapes.h"
#include "quadrel.hpp"

namespace {

constexpr int THREADS = 8;

std::string file_of(const quadrel::Mesh& mesh) {
  std::string text;
  mesh.write(quadrel::Format::Vtu, [&](const void* bytes, std::size_t count) {
    text.append(static_cast<const char*>(bytes), count);
    return true;
  });
  return text;
}

// The same bits on every thread.
void different_objects() {
  std::vector<std::string> files(THREADS), messages(THREADS);
  std::vector<std::thread> threads;
  for (int k = 0; k < THREADS; ++k) {
    threads.emplace_back([&, k] {
      quadrel::Domain plate;
      plate.begin(quadrel::Loop::Outer).line({-2, -2}, {2, -2}).line({2, -2}, {2, 2}).line({2, 2}, {-2, 2}).line({-2, 2}, {-2, -2}).end();
      plate.begin(quadrel::Loop::Hole).curve([](double t) {
        return quadrel::Point{std::cos(2 * TEST_PI * t), std::sin(2 * TEST_PI * t)};
      });
      plate.end();
      files[k] = file_of(quadrel::generate(plate, quadrel::Options().order(4)));
      try {
        quadrel::Options().order(100 + k);
      } catch (const quadrel::Error& e) {
        messages[k] = e.what();
      }
    });
  }
  for (auto& thread : threads) thread.join();
  for (int k = 0; k < THREADS; ++k) {
    CHECK(!files[k].empty() && files[k] == files[0]);
    CHECK(messages[k].find(std::to_string(100 + k)) != std::string::npos);
  }
}

// One domain, one set of options and one mesh, read by all.
void readers() {
  quadrel_domain* plate = new_plate();
  quadrel_options* options = quadrel_options_new();
  quadrel_mesh* shared = nullptr;
  OK(quadrel_generate(plate, options, nullptr, &shared));
  const std::size_t count = quadrel_mesh_element_count(shared);
  std::vector<std::vector<double>> quality(THREADS, std::vector<double>(count));
  std::vector<int> same(THREADS, 0);
  std::vector<std::thread> threads;
  for (int k = 0; k < THREADS; ++k) {
    threads.emplace_back([&, k] {
      quadrel_mesh* own = nullptr;
      if (quadrel_generate(plate, options, nullptr, &own) != QUADREL_OK) return;
      const std::size_t size = 2 * quadrel_mesh_node_count(shared) * sizeof(double);
      same[k] = quadrel_mesh_node_count(own) == quadrel_mesh_node_count(shared) &&
                std::memcmp(quadrel_mesh_nodes(own), quadrel_mesh_nodes(shared), size) == 0 &&
                quadrel_mesh_quality(shared, QUADREL_MEASURE_CONDITION, quality[k].data(), count) == QUADREL_OK;
      quadrel_mesh_free(own);
    });
  }
  for (auto& thread : threads) thread.join();
  for (int k = 0; k < THREADS; ++k) CHECK(same[k] && quality[k] == quality[0]);
  quadrel_mesh_free(shared);
  quadrel_options_free(options);
  quadrel_domain_free(plate);
}

}  // namespace

int main() {
  different_objects();
  readers();
  return failures != 0;
}
