// The part of Wavefront that keeps the list of windows of each edge.
#include <algorithm>
#include <utility>

#include "timbre/analysis/geodesic/detail/wavefront.h"

namespace timbre::detail {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

// Narrower windows, in edge lengths, are left to their neighbours.
constexpr double kThinnest = 1e-12;

}  // namespace

// Before the first window that reaches beyond `begin`. A front that crosses an edge does so
// from its nearest point outwards, so that the place is mostly near one of the ends.
Wavefront::Place Wavefront::find_place(std::int32_t edge, double begin, double least) {
  const EdgeState& state = edge_state(edge);
  Place place{edge, kNone, state.first, kNone};
  if (state.first == kNone) return place;
  const double middle = 0.5 * (slot(state.first).window.begin + slot(state.last).window.end);
  if (begin < middle) {
    while (place.next != kNone && slot(place.next).window.end - begin <= least) {
      place.previous = place.next;
      place.next = slot(place.next).next;
    }
    return place;
  }
  place.previous = state.last;
  place.next = kNone;
  while (place.previous != kNone && slot(place.previous).window.end - begin > least) {
    place.next = place.previous;
    place.previous = slot(place.previous).previous;
  }
  return place;
}

void Wavefront::insert(Window fresh, std::int32_t edge) {
  const double least = kThinnest * mesh_.edges[at(edge)].length;
  Place place = find_place(edge, fresh.begin, least);
  fresh_slots_.clear();
  // Neighbours share their ends to rounding only.
  if (place.previous != kNone) {
    fresh.begin = std::max(fresh.begin, slot(place.previous).window.end);
  }
  while (fresh.end - fresh.begin > least) {
    double next_begin = kInfinity;
    if (place.next != kNone) next_begin = slot(place.next).window.begin;
    if (fresh.end - next_begin <= least) {
      put(fresh, fresh.begin, std::min(fresh.end, next_begin), place);
      break;
    }
    if (fresh.begin < next_begin) {
      if (next_begin - fresh.begin > least) put(fresh, fresh.begin, next_begin, place);
      fresh.begin = next_begin;
    }
    settle_overlap(fresh, place, least);
  }
  for (const std::int32_t index : fresh_slots_) queue_window(index);
}

// The next window covers the beginning of the fresh one: each stretch goes to the nearer.
void Wavefront::settle_overlap(Window& fresh, Place& place, double least) {
  const Window old = slot(place.next).window;
  const double end = std::min(fresh.end, old.end);
  const Contest parts = contest(fresh, old, fresh.begin, end, least, kTie);
  const std::int32_t contested = place.next;
  for (int i = 0; i < parts.parts; ++i) {
    const auto part = static_cast<std::size_t>(i);
    if (!parts.first[part]) continue;
    give_up_stretch(parts.cut[part], parts.cut[part + 1], least, place);
    put(fresh, parts.cut[part], parts.cut[part + 1], place);
  }
  fresh.begin = end;
  if (place.next == contested && end == old.end) {
    place.previous = place.next;
    place.next = slot(place.next).next;
  }
}

// Cuts [begin, end] out of the next window, and leaves the place in the gap.
void Wavefront::give_up_stretch(double begin, double end, double least, Place& place) {
  const Window old = slot(place.next).window;
  const bool keeps_left = begin - old.begin > least;
  const bool keeps_right = old.end - end > least;
  if (!keeps_left && !keeps_right) {
    unlink_next(place);
    return;
  }
  if (!keeps_left) {
    slot(place.next).window.begin = end;
    return;
  }
  const std::int32_t left = place.next;
  slot(left).window.end = begin;
  place.previous = left;
  place.next = slot(left).next;
  if (!keeps_right) return;
  const bool queued = slot(left).queued;
  Window rest = old;
  rest.begin = end;
  const std::int32_t right = take_slot(rest);
  link(right, place);
  place.previous = left;
  place.next = right;
  if (queued) queue_window(right);
}

// Puts a stretch of a window between the neighbours of the place.
void Wavefront::put(const Window& fresh, double begin, double end, Place& place) {
  if (place.last_put != kNone && place.last_put == place.previous &&
      slot(place.last_put).window.end == begin) {
    slot(place.last_put).window.end = end;
    return;
  }
  Window part = fresh;
  part.begin = begin;
  part.end = end;
  const std::int32_t index = take_slot(part);
  link(index, place);
  place.last_put = index;
  fresh_slots_.push_back(index);
}

std::int32_t Wavefront::take_slot(const Window& window) {
  std::int32_t index = free_slot_;
  if (index == kNone) {
    index = static_cast<std::int32_t>(slots_.size());
    slots_.emplace_back();
  } else {
    free_slot_ = slot(index).next;
  }
  slot(index) = {window, kNone, kNone, false, false};
  return index;
}

void Wavefront::link(std::int32_t index, Place& place) {
  EdgeState& state = edge_state(place.edge);
  slot(index).listed = true;
  slot(index).previous = place.previous;
  slot(index).next = place.next;
  (place.previous == kNone ? state.first : slot(place.previous).next) = index;
  (place.next == kNone ? state.last : slot(place.next).previous) = index;
  place.previous = index;
}

void Wavefront::unlink_next(Place& place) {
  EdgeState& state = edge_state(place.edge);
  const std::int32_t index = place.next;
  place.next = slot(index).next;
  (place.previous == kNone ? state.first : slot(place.previous).next) = place.next;
  (place.next == kNone ? state.last : slot(place.next).previous) = place.previous;
  slot(index).listed = false;
  if (!slot(index).queued) slot(index).next = std::exchange(free_slot_, index);
}

void Wavefront::close_edge(std::int32_t edge) {
  EdgeState& state = edge_state(edge);
  if (state.first == kNone) return;
  if (state.queued == 0) {
    // All at once, without looking at each.
    slot(state.last).next = std::exchange(free_slot_, state.first);
    state.first = state.last = kNone;
    return;
  }
  Place place{edge, kNone, state.first, kNone};
  while (place.next != kNone) unlink_next(place);
}

}  // namespace timbre::detail
