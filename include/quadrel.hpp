// quadrel.hpp - the C interface of quadrel.h as C++17: owners, exceptions, callables. Header only.
//
//     quadrel::Domain disc;
//     disc.begin(quadrel::Loop::Outer, "wall");
//     disc.curve([](double t) { return quadrel::Point{std::cos(6.283185307179586 * t), std::sin(6.283185307179586 * t)}; });
//     disc.end();
//     quadrel::Mesh mesh = quadrel::generate(disc, quadrel::Options().order(4));
//     mesh.write(quadrel::Format::Vtu, "disc.vtu");
//
// What fails throws quadrel::Error. An exception that a caller's own callable throws passes through quadrel
// and leaves the call that ran it, unchanged. Views are borrowed: they live as long as their object. Meaning,
// units and shapes of everything are in quadrel.h.
#ifndef QUADREL_HPP
#define QUADREL_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "quadrel.h"

namespace quadrel {

using Point = std::array<double, 2>;
using Curve = std::function<Point(double)>;
// Stage and share of the run done; false stops the run.
using Progress = std::function<bool(quadrel_stage, double)>;
// The largest wanted element size at a point.
using Size = std::function<double(Point)>;
// Takes bytes of a file; false stops.
using Sink = std::function<bool(const void*, std::size_t)>;

enum class Loop : quadrel_loop_kind { Outer = QUADREL_LOOP_OUTER, Hole = QUADREL_LOOP_HOLE, Auto = QUADREL_LOOP_AUTO };
enum class Input : quadrel_input_format { Control = QUADREL_INPUT_CONTROL, Svg = QUADREL_INPUT_SVG };
enum class Norm : quadrel_norm { L2 = QUADREL_NORM_L2, H1 = QUADREL_NORM_H1, Max = QUADREL_NORM_MAX };
enum class Field : quadrel_field { Diffused = QUADREL_FIELD_DIFFUSED, Harmonic = QUADREL_FIELD_HARMONIC };
enum class Subdivision : quadrel_subdivision {
  EqualError = QUADREL_SUBDIVISION_EQUAL_ERROR,
  Halving = QUADREL_SUBDIVISION_HALVING
};
enum class Effort : quadrel_effort {
  Fast = QUADREL_EFFORT_FAST,
  Default = QUADREL_EFFORT_DEFAULT,
  Best = QUADREL_EFFORT_BEST
};
enum class Format : quadrel_format {
  Vtu = QUADREL_FORMAT_VTU,
  Msh = QUADREL_FORMAT_MSH,
  Ism = QUADREL_FORMAT_ISM,
  IsmV2 = QUADREL_FORMAT_ISM_V2,
  IsmMm = QUADREL_FORMAT_ISM_MM,
  Inp = QUADREL_FORMAT_INP,
  Mfem = QUADREL_FORMAT_MFEM,
  Svg = QUADREL_FORMAT_SVG
};

// What quadrel reports: the status, a sentence, and the place in the domain if there is one.
class Error : public std::runtime_error {
 public:
  explicit Error(quadrel_status status) : std::runtime_error(quadrel_last_error_message()), status_(status) {
    Point xy{};
    if (quadrel_last_error_location(xy.data()) != 0) place_ = xy;
  }
  quadrel_status status() const noexcept { return status_; }
  const char* name() const noexcept { return quadrel_status_name(status_); }
  const std::optional<Point>& place() const noexcept { return place_; }

 private:
  quadrel_status status_;
  std::optional<Point> place_;
};

namespace detail {

// An exception of a caller's callable waits here while the C frames return, then goes on its way.
inline std::exception_ptr& pending() {
  static thread_local std::exception_ptr exception;
  return exception;
}

inline void check(quadrel_status status) {
  if (std::exception_ptr exception = std::exchange(pending(), nullptr)) std::rethrow_exception(exception);
  if (status != QUADREL_OK) throw Error(status);
}

// Runs `work` where nothing may be thrown: 0, or 1 with the exception pending.
template <class Work>
int shield(Work&& work) noexcept {
  try {
    return work() ? 0 : 1;
  } catch (...) {
    pending() = std::current_exception();
    return 1;
  }
}

template <class T>
void destroy(void* user) {
  delete static_cast<T*>(user);
}

template <class T, void (*Free)(T*)>
struct Freer {
  void operator()(T* object) const noexcept { Free(object); }
};

template <class T, void (*Free)(T*)>
using Owner = std::unique_ptr<T, Freer<T, Free>>;

inline int curve(void* user, double t, double* xy) {
  return shield([&] {
    const Point point = (*static_cast<Curve*>(user))(t);
    xy[0] = point[0];
    xy[1] = point[1];
    return true;
  });
}

struct CurveWithDerivative {
  Curve point, derivative;
};

inline int point_of(void* user, double t, double* xy) {
  return curve(&static_cast<CurveWithDerivative*>(user)->point, t, xy);
}

inline int derivative_of(void* user, double t, double* xy) {
  return curve(&static_cast<CurveWithDerivative*>(user)->derivative, t, xy);
}

inline int progress(void* user, quadrel_stage stage, double fraction) {
  return shield([&] { return (*static_cast<Progress*>(user))(stage, fraction); });
}

inline int size(void* user, const double* xy, double* size) {
  return shield([&] {
    *size = (*static_cast<Size*>(user))(Point{xy[0], xy[1]});
    return true;
  });
}

inline int sink(void* user, const void* bytes, std::size_t count) {
  return shield([&] { return (*static_cast<const Sink*>(user))(bytes, count); });
}

}  // namespace detail

// A borrowed, read-only array; it lives as long as the object it came from.
template <class T>
class View {
 public:
  View(const T* data, std::size_t size) : data_(data), size_(data ? size : 0) {}
  const T* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  const T& operator[](std::size_t i) const noexcept { return data_[i]; }
  const T* begin() const noexcept { return data_; }
  const T* end() const noexcept { return data_ + size_; }

 private:
  const T* data_;
  std::size_t size_;
};

class Domain {
 public:
  Domain() : Domain(quadrel_domain_new()) {}

  // Reads a .control or .svg file; `component` chooses one of several.
  static Domain read(const std::string& path, std::int32_t component = -1) {
    quadrel_domain* domain = nullptr;
    detail::check(quadrel_domain_read(path.c_str(), component, &domain));
    return Domain(domain);
  }
  // Reads the text of such a file.
  static Domain parse(const std::string& content, Input format, const char* folder = nullptr, std::int32_t component = -1) {
    quadrel_domain* domain = nullptr;
    const auto number = static_cast<quadrel_input_format>(format);
    detail::check(quadrel_domain_read_string(content.c_str(), number, folder, component, &domain));
    return Domain(domain);
  }
  // What the file asks for; nothing if it does not, or if the domain is from no file.
  std::optional<int> file_order() const {
    const int order = quadrel_domain_file_order(get());
    return order > 0 ? std::optional<int>(order) : std::nullopt;
  }
  std::optional<double> file_tolerance() const {
    const double tolerance = quadrel_domain_file_tolerance(get());
    return tolerance > 0 ? std::optional<double>(tolerance) : std::nullopt;
  }

  Domain& begin(Loop kind, const char* name = nullptr) {
    return done(quadrel_domain_begin_loop(get(), static_cast<quadrel_loop_kind>(kind), name));
  }
  Domain& begin(Loop kind, const std::string& name) { return begin(kind, name.c_str()); }
  Domain& end() { return done(quadrel_domain_end_loop(get())); }

  Domain& curve(Curve point, const char* name = nullptr) {
    auto* user = new Curve(std::move(point));
    return done(quadrel_domain_add_curve(get(), detail::curve, nullptr, user, detail::destroy<Curve>, name));
  }
  Domain& curve(Curve point, Curve derivative, const char* name = nullptr) {
    using Both = detail::CurveWithDerivative;
    auto* user = new Both{std::move(point), std::move(derivative)};
    return done(quadrel_domain_add_curve(get(), detail::point_of, detail::derivative_of, user, detail::destroy<Both>, name));
  }
  Domain& line(Point from, Point to, const char* name = nullptr) {
    return done(quadrel_domain_add_line(get(), from.data(), to.data(), name));
  }
  Domain& arc(Point center, double radius, double start, double end, const char* name = nullptr) {
    return done(quadrel_domain_add_arc(get(), center.data(), radius, start, end, name));
  }
  Domain& elliptic_arc(Point center, Point radii, double rotation, double start, double end, const char* name = nullptr) {
    return done(quadrel_domain_add_elliptic_arc(get(), center.data(), radii.data(), rotation, start, end, name));
  }
  Domain& bezier(const std::vector<Point>& control, const char* name = nullptr) {
    return done(quadrel_domain_add_bezier(get(), flat(control), control.size(), name));
  }
  Domain& spline(const std::vector<Point>& points, const char* name = nullptr) {
    return done(quadrel_domain_add_spline(get(), flat(points), points.size(), name));
  }
  Domain& expression(const std::string& x, const std::string& y, const char* name = nullptr) {
    return done(quadrel_domain_add_expression(get(), x.c_str(), y.c_str(), name));
  }
  Domain& join_tolerance(double gap) { return done(quadrel_domain_set_join_tolerance(get(), gap)); }
  void check() const { detail::check(quadrel_domain_check(get())); }

  quadrel_domain* get() const noexcept { return owner_.get(); }

 private:
  explicit Domain(quadrel_domain* domain) : owner_(domain) {}
  Domain& done(quadrel_status status) {
    detail::check(status);
    return *this;
  }
  static const double* flat(const std::vector<Point>& points) {
    static_assert(sizeof(Point) == 2 * sizeof(double), "points lie one after the other");
    return points.empty() ? nullptr : points.front().data();
  }
  detail::Owner<quadrel_domain, quadrel_domain_free> owner_;
};

class Options {
 public:
  Options() : owner_(quadrel_options_new()) {}
  Options& order(int n) { return done(quadrel_options_set_order(get(), n)); }
  Options& tolerance(double e, Norm norm = Norm::L2) {
    return done(quadrel_options_set_tolerance(get(), e, static_cast<quadrel_norm>(norm)));
  }
  Options& relative_tolerance(double e, Norm norm = Norm::L2) {
    return done(quadrel_options_set_relative_tolerance(get(), e, static_cast<quadrel_norm>(norm)));
  }
  Options& field(Field f) { return done(quadrel_options_set_field(get(), static_cast<quadrel_field>(f))); }
  Options& subdivision(Subdivision s) {
    return done(quadrel_options_set_subdivision(get(), static_cast<quadrel_subdivision>(s)));
  }
  Options& symmetry(bool kept) {
    return done(quadrel_options_set_symmetry(get(), kept ? QUADREL_SYMMETRY_KEPT : QUADREL_SYMMETRY_IGNORED));
  }
  Options& effort(Effort e) { return done(quadrel_options_set_effort(get(), static_cast<quadrel_effort>(e))); }
  Options& max_element_size(double h) { return done(quadrel_options_set_max_element_size(get(), h)); }
  Options& size(Size at) {
    auto* user = new Size(std::move(at));
    return done(quadrel_options_set_size_function(get(), detail::size, user, detail::destroy<Size>));
  }
  Options& base_mesh_size(double h) { return done(quadrel_options_set_base_mesh_size(get(), h)); }
  // Points [n], counter-clockwise triangles [n][3], border vertices [n][3] (vertex, loop, segment) and the
  // parameter t of each there; all empty: quadrel makes its own base mesh.
  Options& base_triangulation(const std::vector<Point>& points, const std::vector<std::array<std::int32_t, 3>>& triangles,
                              const std::vector<std::array<std::int32_t, 3>>& boundary, const std::vector<double>& parameters) {
    if (boundary.size() != parameters.size()) throw std::invalid_argument("as many parameters as boundary vertices");
    return done(quadrel_options_set_base_triangulation(
        get(), points.empty() ? nullptr : points[0].data(), points.size(), triangles.empty() ? nullptr : triangles[0].data(),
        triangles.size(), boundary.empty() ? nullptr : boundary[0].data(), parameters.data(), boundary.size()));
  }
  Options& quality_floor(double q) { return done(quadrel_options_set_quality_floor(get(), q)); }
  Options& max_elements(std::size_t limit) { return done(quadrel_options_set_max_elements(get(), limit)); }
  Options& progress(Progress report) {
    auto* user = new Progress(std::move(report));
    return done(quadrel_options_set_progress(get(), detail::progress, user, detail::destroy<Progress>));
  }
  quadrel_options* get() const noexcept { return owner_.get(); }

 private:
  Options& done(quadrel_status status) {
    detail::check(status);
    return *this;
  }
  detail::Owner<quadrel_options, quadrel_options_free> owner_;
};

// Lines one after the other: line k has the points from offsets[k] to offsets[k + 1].
struct Lines {
  View<std::size_t> offsets;
  View<double> points;
  std::size_t size() const noexcept { return offsets.empty() ? 0 : offsets.size() - 1; }
};

class Stages {
 public:
  Stages() : owner_(quadrel_stages_new()) {}
  quadrel_stage reached() const { return quadrel_stages_reached(get()); }
  double seconds(quadrel_stage stage) const { return quadrel_stages_seconds(get(), stage); }
  std::string statistics_json() const {
    const char* text = quadrel_stages_statistics_json(get());
    return text ? text : "";
  }
  View<double> base_vertices() const { return {quadrel_stages_base_vertices(get()), 2 * quadrel_stages_base_vertex_count(get())}; }
  View<std::int32_t> base_triangles() const {
    return {quadrel_stages_base_triangles(get()), 3 * quadrel_stages_base_triangle_count(get())};
  }
  View<double> cross_field() const { return {quadrel_stages_cross_field(get()), 2 * quadrel_stages_base_vertex_count(get())}; }
  View<double> singularity_points() const {
    return {quadrel_stages_singularity_points(get()), 2 * quadrel_stages_singularity_count(get())};
  }
  View<std::int32_t> singularity_valences() const {
    return {quadrel_stages_singularity_valences(get()), quadrel_stages_singularity_count(get())};
  }
  View<double> corner_points() const { return {quadrel_stages_corner_points(get()), 2 * quadrel_stages_corner_count(get())}; }
  View<double> corner_angles() const { return {quadrel_stages_corner_angles(get()), quadrel_stages_corner_count(get())}; }
  View<std::int32_t> corner_quads() const { return {quadrel_stages_corner_quads(get()), quadrel_stages_corner_count(get())}; }
  Lines separatrices() const {
    return lines(quadrel_stages_separatrix_offsets(get()), quadrel_stages_separatrix_points(get()), quadrel_stages_separatrix_count(get()));
  }
  Lines blocks() const {
    return lines(quadrel_stages_block_offsets(get()), quadrel_stages_block_points(get()), quadrel_stages_block_count(get()));
  }
  View<std::int32_t> block_sides() const { return {quadrel_stages_block_sides(get()), quadrel_stages_block_count(get())}; }
  void write_svg(quadrel_picture picture, const std::string& path) const {
    detail::check(quadrel_stages_write_svg(get(), picture, path.c_str()));
  }
  quadrel_stages* get() const noexcept { return owner_.get(); }

 private:
  static Lines lines(const std::size_t* offsets, const double* points, std::size_t count) {
    return {{offsets, count + 1}, {points, offsets ? 2 * offsets[count] : 0}};
  }
  detail::Owner<quadrel_stages, quadrel_stages_free> owner_;
};

struct Range {
  double min, max, mean;
};

class Mesh {
 public:
  // Takes the mesh over.
  explicit Mesh(quadrel_mesh* mesh) : owner_(mesh) {}
  int order() const { return quadrel_mesh_order(get()); }
  std::size_t vertex_count() const { return quadrel_mesh_vertex_count(get()); }
  std::size_t element_count() const { return quadrel_mesh_element_count(get()); }
  std::size_t edge_count() const { return quadrel_mesh_edge_count(get()); }
  std::size_t node_count() const { return quadrel_mesh_node_count(get()); }
  std::size_t boundary_count() const { return quadrel_mesh_boundary_count(get()); }

  View<double> vertices() const { return {quadrel_mesh_vertices(get()), 2 * vertex_count()}; }
  View<std::int32_t> elements() const { return {quadrel_mesh_elements(get()), 4 * element_count()}; }
  View<std::int32_t> element_neighbors() const { return {quadrel_mesh_element_neighbors(get()), 4 * element_count()}; }
  View<std::int32_t> element_edges() const { return {quadrel_mesh_element_edges(get()), 4 * element_count()}; }
  View<std::int32_t> element_boundaries() const { return {quadrel_mesh_element_boundaries(get()), 4 * element_count()}; }
  View<std::int32_t> element_blocks() const { return {quadrel_mesh_element_blocks(get()), element_count()}; }
  View<std::int32_t> edge_vertices() const { return {quadrel_mesh_edge_vertices(get()), 2 * edge_count()}; }
  View<std::int32_t> edge_elements() const { return {quadrel_mesh_edge_elements(get()), 2 * edge_count()}; }
  View<std::int32_t> edge_sides() const { return {quadrel_mesh_edge_sides(get()), 2 * edge_count()}; }
  View<std::int32_t> edge_boundaries() const { return {quadrel_mesh_edge_boundaries(get()), edge_count()}; }
  View<std::int32_t> edge_loops() const { return {quadrel_mesh_edge_loops(get()), edge_count()}; }
  View<std::int32_t> edge_segments() const { return {quadrel_mesh_edge_segments(get()), 2 * edge_count()}; }
  View<double> edge_parameters() const { return {quadrel_mesh_edge_parameters(get()), 2 * edge_count()}; }
  View<double> nodes() const { return {quadrel_mesh_nodes(get()), 2 * node_count()}; }
  View<std::int32_t> element_nodes() const { return {quadrel_mesh_element_nodes(get()), row() * row() * element_count()}; }
  View<double> reference_nodes() const { return {quadrel_mesh_reference_nodes(get()), row()}; }
  std::string boundary_name(std::int32_t boundary) const {
    const char* name = quadrel_mesh_boundary_name(get(), boundary);
    return name ? name : "";
  }

  std::vector<double> quality(quadrel_measure measure) const {
    std::vector<double> values(element_count());
    detail::check(quadrel_mesh_quality(get(), measure, values.data(), values.size()));
    return values;
  }
  Range quality_range(quadrel_measure measure) const {
    Range range{};
    detail::check(quadrel_mesh_quality_range(get(), measure, &range.min, &range.max, &range.mean));
    return range;
  }
  std::string statistics_json() const {
    const char* text = quadrel_mesh_statistics_json(get());
    return text ? text : "";
  }
  void write(Format format, const std::string& path) const {
    detail::check(quadrel_mesh_write(get(), static_cast<quadrel_format>(format), path.c_str()));
  }
  void write(Format format, const Sink& sink) const {
    void* user = const_cast<Sink*>(&sink);
    detail::check(quadrel_mesh_write_to(get(), static_cast<quadrel_format>(format), detail::sink, user));
  }
  quadrel_mesh* get() const noexcept { return owner_.get(); }

 private:
  std::size_t row() const { return static_cast<std::size_t>(order()) + 1; }
  detail::Owner<quadrel_mesh, quadrel_mesh_free> owner_;
};

inline Mesh generate(const Domain& domain, const Options& options, Stages* stages = nullptr) {
  quadrel_mesh* mesh = nullptr;
  detail::check(quadrel_generate(domain.get(), options.get(), stages ? stages->get() : nullptr, &mesh));
  return Mesh(mesh);
}

inline Mesh generate(const Domain& domain, Stages* stages = nullptr) {
  quadrel_mesh* mesh = nullptr;
  detail::check(quadrel_generate(domain.get(), nullptr, stages ? stages->get() : nullptr, &mesh));
  return Mesh(mesh);
}

}  // namespace quadrel

#endif  // QUADREL_HPP
