#include "timbre/analysis/geodesic/detail/wavefront.h"

#include <algorithm>
#include <utility>

namespace timbre::detail {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

constexpr std::uint32_t kEventsBetweenQuestions = 1U << 14U;  // a few milliseconds
// With more targets, looking where each lies costs more than it saves.
constexpr std::size_t kMostTargets = 64;

// Straight distances to targets are rounded otherwise than paths.
constexpr double kTargetSlack = 1e-12;

double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

Wavefront::Wavefront(const GeodesicMesh& mesh)
    : mesh_(mesh),
      vertices_(at(static_cast<std::int32_t>(mesh.size()))),
      edges_(mesh.edges.size()) {}

void Wavefront::reset() {
  for (const std::int32_t v : touched_vertices_) vertices_[at(v)] = {};
  for (const std::int32_t e : touched_edges_) edges_[at(e)] = {};
  touched_vertices_.clear();
  touched_edges_.clear();
  targets_.clear();
  bounds_.clear();
  slots_.clear();
  events_.clear();
  free_slot_ = kNone;
}

bool Wavefront::run(std::span<const std::int32_t> sources, std::span<const std::int32_t> targets,
                    double limit, const std::function<bool()>& keep_going) {
  reset();
  limit_ = limit;
  horizon_ = limit;
  if (!targets.empty() && targets.size() <= kMostTargets) {
    // Twice: paths of the graph are a few per cent longer than the shortest.
    horizon_ = 2.0 * limit;
    only_graph_ = true;
    for (const std::int32_t source : sources) lower(source, 0.0);
    bound_targets(targets, limit);
    only_graph_ = false;
    if (targets_.empty()) return true;
    for (const std::int32_t v : touched_vertices_) {
      vertices_[at(v)].spread = kInfinity;
      push(vertices_[at(v)].distance, EventKind::vertex, v);
    }
  } else {
    for (const std::int32_t source : sources) lower(source, 0.0);
  }
  return spread_all(keep_going);
}

// Paths of the graph to all targets. Once there are such, only shorter ones are of interest.
void Wavefront::bound_targets(std::span<const std::int32_t> targets, double limit) {
  std::vector<std::int32_t> left(targets.begin(), targets.end());
  const auto is_final = [this](std::int32_t v) { return vertices_[at(v)].spread != kInfinity; };
  while (!events_.empty() && !left.empty()) {
    spread_next();
    if (is_final(left.back())) std::erase_if(left, is_final);
  }
  events_.clear();
  horizon_ = 0.0;
  for (const std::int32_t v : targets) {
    const double bound = std::min(vertices_[at(v)].distance, limit);
    if (bound == kInfinity) continue;  // on another component
    targets_.push_back(v);
    bounds_.push_back(bound);
    horizon_ = std::max(horizon_, bound);
  }
}

bool Wavefront::spread_all(const std::function<bool()>& keep_going) {
  for (std::uint32_t count = 1; !events_.empty(); ++count) {
    if (count % kEventsBetweenQuestions == 0 && keep_going && !keep_going()) return false;
    spread_next();
  }
  return true;
}

void Wavefront::spread_next() {
  const auto event = events_.pop();
  front_ = event.at;
  handle(event.payload);
}

void Wavefront::handle(const What& what) {
  if (what.kind == EventKind::vertex) {
    spread_vertex(what.index);
  } else if (what.kind == EventKind::edge) {
    close_edge(what.index);
  } else {
    handle_window(what.index);
  }
}

void Wavefront::handle_window(std::int32_t index) {
  Slot& s = slot(index);
  s.queued = false;
  --edge_state(mesh_.sides[at(s.window.side)].edge).queued;
  if (s.listed) {
    const Window window = s.window;
    cross_edge(window);
  } else {
    s.next = std::exchange(free_slot_, index);
  }
}

// Whether it is near enough to be of interest.
bool Wavefront::push(double at_distance, EventKind kind, std::int32_t index) {
  if (at_distance > horizon_) return false;
  events_.push(at_distance, {kind, index});
  return true;
}

void Wavefront::queue_window(std::int32_t index) {
  Slot& s = slot(index);
  s.queued = push(s.window.nearest(), EventKind::window, index);
  if (s.queued) ++edge_state(mesh_.sides[at(s.window.side)].edge).queued;
}

void Wavefront::touch(std::int32_t vertex) {
  VertexState& state = vertices_[at(vertex)];
  if (state.touched) return;
  state.touched = true;
  touched_vertices_.push_back(vertex);
}

void Wavefront::lower(std::int32_t vertex, double distance) {
  VertexState& state = vertices_[at(vertex)];
  if (!(distance < state.distance)) return;
  touch(vertex);
  state.distance = distance;
  // What its neighbours were told stays true to rounding.
  if (distance < state.spread - kTie) push(distance, EventKind::vertex, vertex);
}

void Wavefront::spread_vertex(std::int32_t vertex) {
  VertexState& state = vertices_[at(vertex)];
  if (!(state.distance < state.spread - kTie)) return;  // told already
  state.spread = state.distance;
  tell_neighbours(vertex);
  if (only_graph_) return;
  for (std::int32_t c = mesh_.corner_start[at(vertex)]; c < mesh_.corner_start[at(vertex) + 1];
       ++c) {
    const GeodesicMesh::Side& side = mesh_.sides[at(mesh_.corner_sides[at(c)])];
    expect_closing(mesh_.sides[at(side.low_side)].edge);
    expect_closing(mesh_.sides[at(side.high_side)].edge);
  }
  if (state.distance == 0.0 || mesh_.bends[at(vertex)] != 0) send_from(vertex);
}

void Wavefront::tell_neighbours(std::int32_t vertex) {
  const GeodesicGraph& graph = mesh_.graph;
  const double distance = vertices_[at(vertex)].distance;
  for (auto e = static_cast<std::size_t>(graph.start[at(vertex)]);
       e < static_cast<std::size_t>(graph.start[at(vertex) + 1]); ++e) {
    lower(graph.neighbour[e], distance + graph.length[e]);
  }
}

// When both ends are known, no point of the edge is farther than half way round through them.
void Wavefront::expect_closing(std::int32_t edge) {
  const GeodesicMesh::Edge& e = mesh_.edges[at(edge)];
  EdgeState& state = edge_state(edge);
  if (state.closes != kInfinity) return;
  const VertexState& low = vertices_[at(e.low)];
  const VertexState& high = vertices_[at(e.high)];
  if (low.spread == kInfinity || high.spread == kInfinity) return;
  if (!state.touched) touched_edges_.push_back(edge);
  state.touched = true;
  state.closes = 0.5 * (low.distance + high.distance + e.length) + 2.0 * kTie;
  push(state.closes, EventKind::edge, edge);
}

void Wavefront::send_from(std::int32_t vertex) {
  const double base = vertices_[at(vertex)].distance;
  for (std::int32_t c = mesh_.corner_start[at(vertex)]; c < mesh_.corner_start[at(vertex) + 1];
       ++c) {
    const std::int32_t s = mesh_.corner_sides[at(c)];
    const GeodesicMesh::Side& side = mesh_.sides[at(s)];
    add({0.0, mesh_.edges[at(side.edge)].length, side.x, side.y, base, s});
  }
}

void Wavefront::cross_edge(const Window& window) {
  const GeodesicMesh::Edge& edge = mesh_.edges[at(mesh_.sides[at(window.side)].edge)];
  for (std::int32_t s = edge.first_side; s < edge.end_side; ++s) {
    if (s != window.side) cross_triangle(window, s);
  }
}

void Wavefront::cross_triangle(const Window& window, std::int32_t s) {
  const GeodesicMesh::Side& side = mesh_.sides[at(s)];
  const GeodesicMesh::Edge& edge = mesh_.edges[at(side.edge)];
  const double height = window.y + side.y;
  const bool flat = !(height > 0.0);  // the source and all corners are in one line
  const double split = flat ? side.x : (window.x * side.y + side.x * window.y) / height;
  if (!(window.y > 0.0) && (window.x < window.begin || window.x > window.end)) return;
  // Straight to the apex where the window shows it; else the path is bent at the window's end,
  // and an upper bound: an apex that is missed by rounding loses nothing by that.
  const double enters = std::clamp(split, window.begin, window.end);
  const double to_apex = enters == split && !flat ? length_of(window.x - side.x, height)
                                                  : length_of(window.x - enters, window.y) +
                                                        length_of(side.x - enters, side.y);
  lower(side.apex, window.base + to_apex);

  const auto show = [&](const Crossing& crossing, std::int32_t corner, std::int32_t seen) {
    const GeodesicMesh::Edge& met = mesh_.edges[at(mesh_.sides[at(seen)].edge)];
    if (!(met.length > 0.0)) return;
    Window shown = window;
    shown.side = seen;
    if (flat) {
      shown.begin = 0.0;
      shown.end = met.length;
      shown.x = crossing.x;
    } else {
      see_through(crossing, met.length, shown);
    }
    if (met.low != corner) {
      const double begin = met.length - shown.end;
      shown.end = met.length - shown.begin;
      shown.begin = begin;
      shown.x = met.length - shown.x;
    }
    add(shown);
  };
  if (window.begin < split) {
    show({window.x, window.y, side.x, side.y, split, window.begin, window.end}, edge.low,
         side.low_side);
  }
  if (window.end > split) {
    const double l = edge.length;
    show({l - window.x, window.y, l - side.x, side.y, l - split, l - window.end, l - window.begin},
         edge.high, side.high_side);
  }
}

// Each point of a window is also reached along the edge from either end; if that is shorter at
// the window's far end, it is so everywhere in it (Xin and Wang 2009).
bool Wavefront::can_matter(const Window& window) const {
  const GeodesicMesh::Edge& edge = mesh_.edges[at(mesh_.sides[at(window.side)].edge)];
  // Squares, to save the roots.
  const auto beaten = [&window](double position, double through_vertex) {
    const double along = position - window.x;
    const double room = through_vertex + kTie - window.base;
    return room < 0.0 || along * along + window.y * window.y > room * room;
  };
  return !beaten(window.end, vertices_[at(edge.low)].distance + window.end) &&
         !beaten(window.begin, vertices_[at(edge.high)].distance + (edge.length - window.begin));
}

// Whether a path through the window, straight on in space, could be the shortest to a target.
bool Wavefront::leads_to_target(const Window& window) {
  if (targets_.empty()) return true;
  const GeodesicMesh::Edge& edge = mesh_.edges[at(mesh_.sides[at(window.side)].edge)];
  const double from_low = detour(edge.low) - window.end;
  const double from_high = detour(edge.high) - (edge.length - window.begin);
  return window.nearest() + std::max(from_low, from_high) <= kTargetSlack;
}

double Wavefront::detour(std::int32_t vertex) {
  VertexState& state = vertices_[at(vertex)];
  if (state.detour != -kInfinity) return state.detour;
  touch(vertex);
  state.detour = kInfinity;
  const Eigen::RowVector3d here = mesh_.vertices.row(vertex);
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    const double straight = (mesh_.vertices.row(targets_[t]) - here).norm();
    state.detour = std::min(state.detour, straight - bounds_[t]);
  }
  return state.detour;
}

void Wavefront::add(const Window& window) {
  const std::int32_t edge = mesh_.sides[at(window.side)].edge;
  EdgeState& state = edge_state(edge);
  if (front_ >= state.closes) return;
  // A source in the line of the edge shows something beyond it only from between its ends.
  if (!(window.y > 0.0) && !(window.begin < window.x && window.x < window.end)) return;
  if (!can_matter(window) || !leads_to_target(window)) return;
  if (!state.touched) touched_edges_.push_back(edge);
  state.touched = true;
  insert(window, edge);
}

}  // namespace timbre::detail
