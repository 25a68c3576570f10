#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "timbre/analysis/mesh/detail/formats.h"
#include "timbre/analysis/mesh/detail/ply_header.h"

namespace timbre::detail {
namespace {

// Calls `visit` with a value of the type.
template <typename Visit>
auto with_type(PlyType type, Visit visit) {
  switch (type) {
    case PlyType::int8:
      return visit(std::int8_t{});
    case PlyType::uint8:
      return visit(std::uint8_t{});
    case PlyType::int16:
      return visit(std::int16_t{});
    case PlyType::uint16:
      return visit(std::uint16_t{});
    case PlyType::int32:
      return visit(std::int32_t{});
    case PlyType::uint32:
      return visit(std::uint32_t{});
    case PlyType::float32:
      return visit(float{});
    default:
      return visit(double{});
  }
}

double binary_number(Cursor& cursor, PlyType type, std::endian order) {
  return with_type(type, [&](auto as) -> double { return cursor.value<decltype(as)>(order); });
}

// All integer types of PLY fit into a double exactly.
std::int64_t binary_integer(Cursor& cursor, PlyType type, std::endian order) {
  return static_cast<std::int64_t>(binary_number(cursor, type, order));
}

// What one property means to timbre.
enum class Role : std::uint8_t { skipped, x, y, z, indices };

std::vector<Role> roles_of(const PlyElement& element) {
  std::vector<Role> roles(element.properties.size(), Role::skipped);
  const auto assign = [&](const char* name, Role role) {
    const std::ptrdiff_t place = element.find(name);
    if (place >= 0) roles[static_cast<std::size_t>(place)] = role;
    return place >= 0;
  };
  if (element.name == "vertex") {
    assign("x", Role::x);
    assign("y", Role::y);
    assign("z", Role::z);
  } else if (element.name == "face") {
    if (!assign("vertex_indices", Role::indices)) assign("vertex_index", Role::indices);
  }
  return roles;
}

class PlyReader {
 public:
  PlyReader(const Cursor& cursor, PlyHeader header)
      : cursor_(cursor),
        header_(std::move(header)),
        order_(header_.binary.value_or(std::endian::little)) {}

  PolygonMesh read() {
    if (header_.binary) {
      cursor_.expect_binary();
    } else {
      cursor_.refuse_nul();
    }
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") vertices_ = element.count;
    }
    for (const PlyElement& element : header_.elements) read_element(element);
    cursor_.leave();
    const bool more =
        header_.binary ? cursor_.rest().find_first_not_of(" \t\r\n\v\f") != std::string_view::npos
                       : cursor_.seek_word();
    if (more) mesh_.findings.add_count(Finding::trailing_data);
    return std::move(mesh_);
  }

 private:
  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex";
    const bool is_face = element.name == "face";
    if (!is_vertex && !is_face) mesh_.findings.add(Finding::ignored_data, element.name);
    if (is_vertex) mesh_.coordinates.reserve_rows(static_cast<std::size_t>(element.count));
    if (is_face) mesh_.corners.reserve_rows(static_cast<std::size_t>(element.count));
    const std::vector<Role> roles = roles_of(element);
    std::int64_t row = 0;
    if (header_.binary && is_vertex) row = read_plain_vertices(element, roles);
    if (header_.binary && is_face) row = read_plain_faces(element);
    for (; row < element.count; ++row) {
      cursor_.enter(is_vertex ? "vertex" : is_face ? "face" : "row", row);
      if (header_.binary) {
        read_binary_row(element, roles);
      } else {
        read_text_row(element, roles);
      }
      if (is_vertex) mesh_.add_vertex(xyz_[0], xyz_[1], xyz_[2]);
      if (is_face) mesh_.end_polygon();
    }
  }

  // The vertices before the first that is odd in any way: most often all of them. The general
  // reader goes on there, and knows what to say. Without lists all rows are of one size.
  std::int64_t read_plain_vertices(const PlyElement& element, const std::vector<Role>& roles) {
    std::array<std::size_t, 3> place{};
    std::array<PlyType, 3> type{};
    std::size_t row_size = 0;
    for (std::size_t p = 0; p < roles.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.length) return 0;
      if (roles[p] != Role::skipped) {
        place[axis(roles[p])] = row_size;
        type[axis(roles[p])] = property.type;
      }
      row_size += size_of(property.type);
    }
    constexpr std::size_t kBlock = 1024;  // rows, so that they are still at hand for y and z
    const auto count = static_cast<std::size_t>(element.count);
    std::size_t done = 0;
    while (done < count) {
      const std::size_t rows = std::min({kBlock, count - done, cursor_.left() / row_size});
      if (rows == 0) break;
      double* const xyz = mesh_.coordinates.extend(3 * rows);
      for (std::size_t k = 0; k < 3; ++k) {
        with_type(type[k], [&](auto as) {
          const std::string_view column = cursor_.rest().substr(place[k]);
          for (std::size_t i = 0; i < rows; ++i) {
            xyz[3 * i + k] = value_of<decltype(as)>(column.substr(i * row_size), order_);
          }
        });
      }
      if (!std::all_of(xyz, xyz + 3 * rows, [](double x) { return std::isfinite(x); })) {
        mesh_.coordinates.shrink(3 * rows);
        break;
      }
      cursor_.take(rows * row_size);
      done += rows;
    }
    return static_cast<std::int64_t>(done);
  }

  // The same for faces that are a list of 32-bit indices and nothing else.
  std::int64_t read_plain_faces(const PlyElement& element) {
    const PlyProperty& list = element.properties[0];
    const bool is_plain = element.properties.size() == 1 && list.length == PlyType::uint8 &&
                          (list.type == PlyType::int32 || list.type == PlyType::uint32);
    if (!is_plain) return 0;
    std::string_view bytes = cursor_.rest();
    std::int64_t row = 0;
    for (; row < element.count && !bytes.empty(); ++row) {
      const std::size_t length = value_of<std::uint8_t>(bytes, order_);
      if (bytes.size() - 1 < 4 * length) break;
      std::int32_t* const corners = mesh_.corners.extend(length);
      bool are_in_range = true;
      for (std::size_t c = 0; c < length; ++c) {
        const auto index = value_of<std::uint32_t>(bytes.substr(1 + 4 * c), order_);
        are_in_range = are_in_range && index < vertices_;
        corners[c] = static_cast<std::int32_t>(index);
      }
      if (!are_in_range) {
        mesh_.corners.shrink(length);
        break;
      }
      mesh_.end_polygon();
      bytes.remove_prefix(1 + 4 * length);
    }
    cursor_.take(cursor_.left() - bytes.size());
    return row;
  }

  void read_binary_row(const PlyElement& element, const std::vector<Role>& roles) {
    for (std::size_t p = 0; p < roles.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.length) {
        const std::int64_t length = cursor_.checked_count(
            binary_integer(cursor_, *property.length, order_), size_of(property.type), "values");
        if (roles[p] == Role::indices) {
          for (std::int64_t i = 0; i < length; ++i) {
            mesh_.corners.push_back(
                cursor_.checked_index(binary_integer(cursor_, property.type, order_), vertices_));
          }
        } else {
          cursor_.take(static_cast<std::uint64_t>(length) * size_of(property.type));
        }
      } else if (roles[p] == Role::skipped) {
        cursor_.take(size_of(property.type));
      } else {
        const double value = binary_number(cursor_, property.type, order_);
        if (!std::isfinite(value)) throw cursor_.error("coordinate is not finite");
        coordinate(roles[p]) = value;
      }
    }
  }

  void read_text_row(const PlyElement& element, const std::vector<Role>& roles) {
    if (!cursor_.seek_word()) throw cursor_.truncated();
    for (std::size_t p = 0; p < roles.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (property.length) {
        read_text_list(property, roles[p]);
      } else if (roles[p] == Role::skipped) {
        skip_word();
      } else {
        coordinate(roles[p]) = cursor_.number();
      }
    }
    if (const auto word = cursor_.word(); !word.empty()) {
      throw cursor_.error(in_quotes(word) + " is one value more than the header declares");
    }
    cursor_.skip_line();
  }

  void read_text_list(const PlyProperty& property, Role role) {
    const std::int64_t length = cursor_.integer();
    if (length < 0 || length > largest(*property.length)) {
      throw cursor_.error("a list of " + std::to_string(length) + " values; its type holds 0 to " +
                          std::to_string(largest(*property.length)));
    }
    for (std::int64_t i = 0; i < length; ++i) {
      if (role == Role::indices) {
        mesh_.corners.push_back(cursor_.vertex_index(vertices_));
      } else {
        skip_word();
      }
    }
  }

  void skip_word() {
    if (cursor_.word().empty()) throw cursor_.error("fewer values than the header declares");
  }

  static std::size_t axis(Role role) {
    return static_cast<std::size_t>(role) - static_cast<std::size_t>(Role::x);
  }
  double& coordinate(Role role) { return xyz_[axis(role)]; }

  Cursor cursor_;
  PlyHeader header_;
  std::endian order_;
  std::int64_t vertices_ = 0;
  std::array<double, 3> xyz_{};
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh read_ply(Cursor cursor) {
  PlyHeader header = read_ply_header(cursor);
  return PlyReader(cursor, std::move(header)).read();
}

}  // namespace timbre::detail
