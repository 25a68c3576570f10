#include "timbre/index/detail/store_impl.h"

#include <cstring>
#include <utility>

#include "timbre/index/detail/text.h"

namespace timbre {

using detail::Blob;
using detail::Roster;
using detail::Statement;

namespace {

constexpr char kShapeColumns[] =
    "SELECT id, name, label, content, vertices, faces, area, blobs, sha256 FROM shape ";

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Error Store::Impl::error(const std::string& place, const std::string& cause, ErrorKind kind) const {
  return {kind, database.path(), place, cause};
}

Store::Impl::Row Store::Impl::checked_row(const Statement& row) const {
  Row found;
  found.info.id = row.integer(0);
  found.info.name = row.text(1);
  found.info.label = row.text(2);
  const auto content = row.blob(3);
  const bool whole = content.size() == found.info.content.size();
  if (whole) std::memcpy(found.info.content.data(), content.data(), content.size());
  found.info.vertices = row.integer(4);
  found.info.faces = row.integer(5);
  found.info.area = row.real(6);
  found.blobs = row.integer(7);
  found.digest = detail::digest_of_shape(found.info, found.blobs);
  if (!whole || !detail::same_bytes(found.digest, row.blob(8))) {
    throw detail::damaged(database.path(), "shape " + detail::in_quotes(found.info.name));
  }
  return found;
}

void Store::Impl::for_each_row(const std::function<void(const Statement&)>& visit) const {
  Statement rows(database, std::string(kShapeColumns) + "ORDER BY id");
  while (rows.step()) visit(rows);
}

std::vector<ShapeInfo> Store::Impl::list() const {
  std::vector<ShapeInfo> shapes;
  Roster seen;
  for_each_row([&](const Statement& row) {
    Row checked = checked_row(row);
    seen.put_in(checked.digest);
    shapes.push_back(std::move(checked.info));
  });
  if (seen != detail::read_roster(database)) {
    throw error("", "shapes are missing; run 'timbre db verify " + database.path() + "'");
  }
  return shapes;
}

std::optional<Store::Impl::Row> Store::Impl::look_up(const std::string& name) const {
  Statement row(database, std::string(kShapeColumns) + "WHERE name = ?");
  row.bind(1, name);
  if (!row.step()) return std::nullopt;
  Row found = checked_row(row);
  if (found.info.name != name) {
    throw detail::damaged(database.path(), "shape " + detail::in_quotes(name));
  }
  return found;
}

std::optional<ShapeInfo> Store::Impl::find(const std::string& name) const {
  if (auto row = look_up(name)) return std::move(row->info);
  for (ShapeInfo& shape : list()) {
    if (shape.name == name) return std::move(shape);
  }
  return std::nullopt;
}

ShapeInfo Store::Impl::require(const std::string& name) const {
  if (auto shape = find(name)) return *std::move(shape);
  throw error("", "there is no shape " + detail::in_quotes(name), ErrorKind::bad_request);
}

Blob Store::Impl::checked_blob(const ShapeInfo& shape, const std::string& channel,
                               const Statement& row, int first) const {
  Blob blob{channel, row.integer(first), row.text(first + 1), text_of(row.blob(first + 2))};
  if (!detail::same_bytes(detail::digest_of_blob(shape, blob), row.blob(first + 3))) {
    throw detail::damaged(database.path(), channel + " of " + detail::in_quotes(shape.name));
  }
  return blob;
}

Blob Store::Impl::read_blob(const ShapeInfo& shape, const std::string& channel) const {
  Statement row(database,
                "SELECT version, parameters, bytes, sha256 FROM blob"
                " WHERE channel = ? AND shape = ?");
  row.bind(1, channel).bind(2, shape.id);
  if (!row.step()) throw missing_blob(shape, channel);
  return checked_blob(shape, channel, row, 0);
}

Error Store::Impl::missing_blob(const ShapeInfo& shape, const std::string& channel) const {
  return error(channel + " of " + detail::in_quotes(shape.name),
               "is not there; run 'timbre db verify " + database.path() + "'");
}

std::string Store::Impl::full_parameters(Parameters own) const {
  own.merge(to_parameters(parameters));
  return canonical_text(own);
}

void Store::Impl::require_same_meaning(const Blob& blob, const Channel& channel) const {
  if (blob.version == channel.version && blob.parameters == full_parameters(channel.parameters)) {
    return;
  }
  throw error("channel " + channel.name,
              "stored with version " + std::to_string(blob.version) + " (" + blob.parameters +
                  "), this timbre computes version " + std::to_string(channel.version) + " (" +
                  full_parameters(channel.parameters) + "); create a new database",
              ErrorKind::bad_request);
}

void Store::Impl::write_blob(const ShapeInfo& shape, const Blob& blob) const {
  Statement(database,
            "INSERT INTO blob(channel, shape, version, parameters, bytes, sha256)"
            " VALUES(?, ?, ?, ?, ?, ?)")
      .bind(1, blob.channel)
      .bind(2, shape.id)
      .bind(3, blob.version)
      .bind(4, blob.parameters)
      .bind(5, detail::as_blob(blob.bytes))
      .bind(6, detail::as_blob(detail::digest_of_blob(shape, blob)))
      .run();
}

std::vector<Blob> Store::Impl::blobs_of(const ShapeRecord& record) const {
  std::vector<Blob> blobs;
  blobs.push_back({detail::kMeshBlob, 1, "", detail::pack_mesh(record.mesh)});
  blobs.push_back(
      {detail::kSpectrumBlob, 1, parameters_text, detail::pack_numbers(record.eigenvalues)});
  for (const Descriptor& descriptor : record.descriptors) {
    blobs.push_back({descriptor.channel, descriptor.version, full_parameters(descriptor.parameters),
                     detail::pack_numbers(descriptor.values)});
  }
  return blobs;
}

void Store::Impl::insert(ShapeInfo shape, const std::vector<Blob>& blobs, Roster& roster) const {
  if (shape.id == 0) {
    Statement last(database, "SELECT ifnull(max(id), 0) FROM shape");
    last.step();
    shape.id = last.integer(0) + 1;
  }
  const auto count = static_cast<std::int64_t>(blobs.size());
  const Sha256Digest digest = detail::digest_of_shape(shape, count);
  Statement(database,
            "INSERT INTO shape(id, name, label, content, vertices, faces, area, blobs, sha256)"
            " VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(1, shape.id)
      .bind(2, shape.name)
      .bind(3, shape.label)
      .bind(4, detail::as_blob(shape.content))
      .bind(5, shape.vertices)
      .bind(6, shape.faces)
      .bind(7, shape.area)
      .bind(8, count)
      .bind(9, detail::as_blob(digest))
      .run();
  for (const Blob& blob : blobs) write_blob(shape, blob);
  roster.put_in(digest);
}

void Store::Impl::erase(const Row& row, Roster& roster) const {
  for (const std::string& channel : stored_channels()) {
    Statement(database, "DELETE FROM blob WHERE channel = ? AND shape = ?")
        .bind(1, channel)
        .bind(2, row.info.id)
        .run();
  }
  Statement(database, "DELETE FROM shape WHERE id = ?").bind(1, row.info.id).run();
  roster.take_out(row.digest);
}

std::vector<std::string> Store::Impl::stored_channels() const {
  std::vector<std::string> names;
  std::string last;
  for (;;) {
    Statement next(database, "SELECT channel FROM blob WHERE channel > ? LIMIT 1");
    next.bind(1, last);
    if (!next.step()) return names;
    last = next.text(0);
    names.push_back(last);
  }
}

}  // namespace timbre
