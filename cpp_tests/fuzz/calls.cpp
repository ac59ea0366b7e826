// libFuzzer through the C interface: bytes become calls in any order, on domains that bytes describe. Nothing
// may crash, leak, hang or end with QUADREL_ERROR_INTERNAL; every mesh that comes out is looked at.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "quadrel.h"

namespace {

// The bytes as a stream of numbers; after its end zeros.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), end_(data + size) {}
  bool empty() const { return data_ == end_; }
  std::uint8_t byte() { return empty() ? 0 : *data_++; }
  // Mostly on a small grid, so that ends meet; now and then something absurd.
  double number() {
    const std::uint8_t b = byte();
    switch (b) {
      case 255: return std::numeric_limits<double>::quiet_NaN();
      case 254: return std::numeric_limits<double>::infinity();
      case 253: return 1e300;
      case 252: return -1e-300;
      default: return (static_cast<int>(b % 32) - 16) / 4.0;
    }
  }
  void point(double* xy) {
    xy[0] = number();
    xy[1] = number();
  }
  std::string text(std::size_t most) {
    std::string result;
    const std::size_t length = byte() % (most + 1);
    while (result.size() < length) result.push_back(static_cast<char>(byte()));
    return result;
  }

 private:
  const std::uint8_t *data_, *end_;
};

void fail(const char* what) {
  std::fprintf(stderr, "%s: %s\n", what, quadrel_last_error_message());
  std::abort();
}

quadrel_status checked(quadrel_status status) {
  if (status == QUADREL_ERROR_INTERNAL) fail("an internal error");
  if (status != QUADREL_OK && quadrel_last_error_message()[0] == '\0') fail("an error without a message");
  return status;
}

// A curve callback that counts the times its user is destroyed.
struct Wave {
  double x, y, radius, height;
  int waves, fails_at, calls;
  int* destroyed;
};

int wave(void* user, double t, double* xy) {
  Wave& w = *static_cast<Wave*>(user);
  if (++w.calls == w.fails_at) return 1;
  const double angle = 6.283185307179586 * t, r = w.radius + w.height * std::cos(w.waves * angle);
  xy[0] = w.x + r * std::cos(angle);
  xy[1] = w.y + r * std::sin(angle);
  return 0;
}

void destroy_wave(void* user) {
  ++*static_cast<Wave*>(user)->destroyed;
  delete static_cast<Wave*>(user);
}

struct Reports {
  int left;
  double last;
};

int report(void* user, quadrel_stage stage, double done) {
  Reports& r = *static_cast<Reports*>(user);
  if (stage < QUADREL_STAGE_DOMAIN || stage > QUADREL_STAGE_MESH || !(done >= r.last && done <= 1)) fail("progress");
  r.last = done;
  return --r.left == 0;
}

int take(void* user, const void*, std::size_t count) {
  *static_cast<std::size_t*>(user) += count;
  return 0;
}

void look_at(const quadrel_mesh* mesh) {
  double least = 0;
  std::size_t bytes = 0;
  const std::size_t nodes = quadrel_mesh_node_count(mesh), row = static_cast<std::size_t>(quadrel_mesh_order(mesh)) + 1;
  checked(quadrel_mesh_quality_range(mesh, QUADREL_MEASURE_SCALED_JACOBIAN, &least, nullptr, nullptr));
  if (!(least > 0)) fail("an element that is not valid");
  for (std::size_t i = 0; i < row * row * quadrel_mesh_element_count(mesh); ++i) {
    if (static_cast<std::size_t>(quadrel_mesh_element_nodes(mesh)[i]) >= nodes) fail("a node number");
  }
  for (std::size_t i = 0; i < 2 * nodes; ++i) {
    if (!std::isfinite(quadrel_mesh_nodes(mesh)[i])) fail("a node that is not finite");
  }
  checked(quadrel_mesh_write_to(mesh, QUADREL_FORMAT_VTU, take, &bytes));
  if (bytes == 0) fail("an empty file");
}

// A base triangulation out of nothing good.
void triangulate(Bytes& in, quadrel_options* options) {
  std::vector<double> vertices(2 * (in.byte() % 12u)), parameters(in.byte() % 8u);
  std::vector<std::int32_t> triangles(3 * (in.byte() % 12u)), boundary(3 * parameters.size());
  for (double& x : vertices) x = in.number();
  for (std::int32_t& v : triangles) v = in.byte() % 13 - 1;
  for (std::int32_t& v : boundary) v = in.byte() % 13 - 1;
  for (double& t : parameters) t = in.byte() / 250.0;
  checked(quadrel_options_set_base_triangulation(options, vertices.data(), vertices.size() / 2, triangles.data(),
                                                 triangles.size() / 3, boundary.data(), parameters.data(), parameters.size()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  int made = 0, destroyed = 0, runs = 0;
  double a[2], b[2];
  Reports reports{0, 0};
  quadrel_domain* domain = quadrel_domain_new();
  quadrel_options* options = quadrel_options_new();
  quadrel_stages* stages = quadrel_stages_new();
  // Coarse, so that a run takes milliseconds.
  checked(quadrel_options_set_order(options, 2));
  checked(quadrel_options_set_relative_tolerance(options, 1e-2, QUADREL_NORM_L2));
  while (!in.empty() && runs < 2) {
    switch (in.byte() % 20) {
      case 0: checked(quadrel_domain_begin_loop(domain, in.byte() % 5 - 1, "loop")); break;
      case 1: checked(quadrel_domain_end_loop(domain)); break;
      case 2:
      case 3: {
        // A loop of lines, closed by itself.
        const std::size_t corners = 3 + in.byte() % 6u;
        std::vector<double> p(2 * corners);
        for (double& x : p) x = in.number();
        checked(quadrel_domain_begin_loop(domain, QUADREL_LOOP_AUTO, nullptr));
        for (std::size_t k = 0; k < corners; ++k) {
          checked(quadrel_domain_add_line(domain, &p[2 * k], &p[2 * ((k + 1) % corners)], nullptr));
        }
        checked(quadrel_domain_end_loop(domain));
        break;
      }
      case 4:
        in.point(a);
        in.point(b);
        checked(quadrel_domain_add_line(domain, a, b, nullptr));
        break;
      case 5:
        in.point(a);
        checked(quadrel_domain_add_arc(domain, a, in.number(), in.number(), in.number(), nullptr));
        break;
      case 6: {
        in.point(a);
        in.point(b);
        const double turn = in.number(), start = in.number();
        checked(quadrel_domain_add_elliptic_arc(domain, a, b, turn, start, start + 6.283185307179586, nullptr));
        break;
      }
      case 7:
      case 8: {
        std::vector<double> p(2 * (in.byte() % 10u));
        for (double& x : p) x = in.number();
        if (in.byte() % 2 == 0) checked(quadrel_domain_add_bezier(domain, p.data(), p.size() / 2, nullptr));
        else checked(quadrel_domain_add_spline(domain, p.data(), p.size() / 2, nullptr));
        break;
      }
      case 9: {
        const std::string x = in.text(20), y = in.text(20);
        checked(quadrel_domain_add_expression(domain, x.c_str(), y.c_str(), nullptr));
        break;
      }
      case 10: {
        in.point(a);
        const double radius = in.number(), height = in.number() / 8;
        auto* user = new Wave{a[0], a[1], radius, height, in.byte() % 5, in.byte() * 8, 0, &destroyed};
        ++made;
        checked(quadrel_domain_add_curve(domain, wave, nullptr, user, destroy_wave, nullptr));
        break;
      }
      case 11: checked(quadrel_domain_set_join_tolerance(domain, in.number() / 16)); break;
      case 12: {
        const std::string path = "<svg><path d='" + in.text(60) + "'/></svg>";
        quadrel_domain* read = nullptr;
        if (checked(quadrel_domain_read_string(path.c_str(), QUADREL_INPUT_SVG, nullptr, in.byte() % 3 - 1, &read)) == QUADREL_OK) {
          quadrel_domain_free(domain);
          domain = read;
        }
        break;
      }
      case 13: {
        const std::string text = in.text(200);
        quadrel_domain* read = nullptr;
        checked(quadrel_domain_read_string(text.c_str(), in.byte() % 3, nullptr, -1, &read));
        quadrel_domain_free(read);
        break;
      }
      case 14:
        checked(quadrel_options_set_order(options, in.byte() % 6));
        checked(quadrel_options_set_field(options, in.byte() % 3));
        checked(quadrel_options_set_subdivision(options, in.byte() % 3));
        checked(quadrel_options_set_symmetry(options, in.byte() % 3));
        // Not the best of several meshes: it runs the same code for four times as long.
        checked(quadrel_options_set_effort(options, in.byte() % 8 == 7 ? 3 : in.byte() % 2));
        break;
      case 15:
        checked(quadrel_options_set_relative_tolerance(options, in.byte() / 1000.0, in.byte() % 4));
        checked(quadrel_options_set_quality_floor(options, in.byte() / 200.0));
        break;
      case 16: triangulate(in, options); break;
      case 17:
        reports = Reports{in.byte(), 0};
        checked(quadrel_options_set_progress(options, report, &reports, nullptr));
        break;
      case 18: checked(quadrel_domain_check(domain)); break;
      default: {
        quadrel_mesh* mesh = nullptr;
        ++runs;
        reports.last = 0;
        const quadrel_status status = checked(quadrel_generate(domain, options, stages, &mesh));
        if ((status == QUADREL_OK) != (mesh != nullptr)) fail("a mesh with an error, or none without");
        if (mesh != nullptr) look_at(mesh);
        quadrel_mesh_free(mesh);
      }
    }
  }
  quadrel_stages_free(stages);
  quadrel_options_free(options);
  quadrel_domain_free(domain);
  if (made != destroyed) fail("a callback that was not destroyed once");
  return 0;
}
