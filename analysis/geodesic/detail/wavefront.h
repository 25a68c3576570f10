#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "timbre/analysis/geodesic/detail/event_queue.h"
#include "timbre/analysis/geodesic/detail/window.h"
#include "timbre/analysis/geodesic/geodesic_mesh.h"

namespace timbre::detail {

/// Spreads windows over a mesh, nearest first. Each edge keeps a list of windows that do not
/// overlap, of which each is the nearest known on its stretch; a list goes when the front has
/// passed its edge. Lengths are those of the prepared mesh.
///
/// All distances it holds are lengths of paths: rounding can make them too long by a little,
/// never too short by more than that.
class Wavefront {
 public:
  explicit Wavefront(const GeodesicMesh& mesh);

  /// Spreads from `sources` to everything within `limit`; with targets, only where shortest
  /// paths to these may run. Costs as much as what the front passes.
  /// @param keep_going  asked now and then; may be empty
  /// @return  whether it came to its end
  bool run(std::span<const std::int32_t> sources, std::span<const std::int32_t> targets,
           double limit, const std::function<bool()>& keep_going);

  /// Of a vertex (with targets, of a target), after `run`; infinite beyond the limit.
  [[nodiscard]] double distance(std::int32_t vertex) const {
    const double found = vertices_[static_cast<std::size_t>(vertex)].distance;
    return found <= limit_ ? found : std::numeric_limits<double>::infinity();
  }
  /// The vertices that `run` came near, each once.
  [[nodiscard]] std::span<const std::int32_t> touched() const { return touched_vertices_; }

 private:
  static constexpr std::int32_t kNone = -1;
  // In units of the prepared mesh, whose size is near 1. A window must be worse by more than
  // this to be dropped for a path through a vertex, and better by more than this to take a
  // stretch from another: equal windows neither vanish both nor chase each other for ever.
  static constexpr double kTie = 1e-14;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  struct VertexState {
    double distance = kInfinity;
    double spread = kInfinity;   ///< the distance its neighbours were told; infinite: none yet
    double detour = -kInfinity;  ///< least of straight distance to a target minus what is known
    bool touched = false;
  };
  struct EdgeState {
    std::int32_t first = kNone;  ///< of its windows, in order
    std::int32_t last = kNone;
    std::int32_t queued = 0;    ///< windows of the edge in the queue, listed or not
    double closes = kInfinity;  ///< the front's distance from which nothing better comes
    bool touched = false;
  };
  struct alignas(64) Slot {  // one cache line
    Window window;
    std::int32_t previous = kNone;  ///< on the edge
    std::int32_t next = kNone;      ///< on the edge, or among free slots
    bool listed = false;
    bool queued = false;
  };
  enum class EventKind : std::uint8_t { window, vertex, edge };
  struct What {
    EventKind kind = EventKind::window;
    std::int32_t index = 0;
  };
  /// Where a window is being put into an edge's list.
  struct Place {
    std::int32_t edge = 0;
    std::int32_t previous = kNone;
    std::int32_t next = kNone;
    std::int32_t last_put = kNone;
  };

  void reset();
  void bound_targets(std::span<const std::int32_t> targets, double limit);
  [[nodiscard]] bool spread_all(const std::function<bool()>& keep_going);
  void spread_next();
  void handle(const What& what);
  bool push(double at, EventKind kind, std::int32_t index);
  void handle_window(std::int32_t index);
  void queue_window(std::int32_t index);

  void lower(std::int32_t vertex, double distance);
  void touch(std::int32_t vertex);
  void spread_vertex(std::int32_t vertex);
  void tell_neighbours(std::int32_t vertex);
  void send_from(std::int32_t vertex);
  void expect_closing(std::int32_t edge);

  void cross_edge(const Window& window);
  void cross_triangle(const Window& window, std::int32_t side);
  [[nodiscard]] bool can_matter(const Window& window) const;
  [[nodiscard]] bool leads_to_target(const Window& window);
  [[nodiscard]] double detour(std::int32_t vertex);
  void add(const Window& window);
  void insert(Window fresh, std::int32_t edge);
  [[nodiscard]] Place find_place(std::int32_t edge, double begin, double least);
  void settle_overlap(Window& fresh, Place& place, double least);
  void put(const Window& fresh, double begin, double end, Place& place);
  void give_up_stretch(double begin, double end, double least, Place& place);

  std::int32_t take_slot(const Window& window);
  void unlink_next(Place& place);
  void link(std::int32_t slot, Place& place);
  void close_edge(std::int32_t edge);

  Slot& slot(std::int32_t index) { return slots_[static_cast<std::size_t>(index)]; }
  EdgeState& edge_state(std::int32_t edge) { return edges_[static_cast<std::size_t>(edge)]; }

  const GeodesicMesh& mesh_;
  std::vector<VertexState> vertices_;
  std::vector<EdgeState> edges_;
  std::vector<std::int32_t> touched_vertices_;
  std::vector<std::int32_t> touched_edges_;
  std::vector<Slot> slots_;
  std::int32_t free_slot_ = kNone;
  EventQueue<What> events_;
  std::vector<std::int32_t> fresh_slots_;
  std::vector<std::int32_t> targets_;  ///< with a path to each
  std::vector<double> bounds_;         ///< length of that path
  double horizon_ = kInfinity;         ///< nothing farther is of interest
  double front_ = 0.0;                 ///< distance of the event at hand
  double limit_ = kInfinity;
  bool only_graph_ = false;  ///< spread from vertex to vertex, without windows
};

}  // namespace timbre::detail
