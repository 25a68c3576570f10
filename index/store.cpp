#include "timbre/index/store.h"

#include <algorithm>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/index/detail/records.h"
#include "timbre/index/detail/schema.h"
#include "timbre/index/detail/sqlite.h"
#include "timbre/index/detail/text.h"

namespace timbre {

using detail::Blob;
using detail::Database;
using detail::Roster;
using detail::Statement;
using detail::Transaction;

namespace {

constexpr char kShapeColumns[] =
    "SELECT id, name, label, content, vertices, faces, area, blobs, sha256 FROM shape ";

std::string in_quotes(const std::string& name) { return "'" + name + "'"; }

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Parameters to_parameters(const StoreParameters& parameters) {
  return {{"k", std::to_string(parameters.count)},
          {"mass", to_word(parameters.mass)},
          {"operator", to_word(parameters.operator_kind)}};
}

void require_storable_text(const std::string& text, const char* what) {
  const auto refuse = [&](const char* cause) {
    throw Error(ErrorKind::bad_input, "", what, in_quotes(text.substr(0, 80)) + " " + cause);
  };
  if (text.size() > 255) refuse("is longer than 255 bytes");
  if (!detail::is_utf8(text)) refuse("is not UTF-8");
  if (escape_control(text) != text) refuse("holds control characters");
}

// Member functions suppose that a transaction is open.
struct Store::Impl {
  Database database;
  StoreParameters parameters;
  std::string parameters_text;

  struct Row {
    ShapeInfo info;
    std::int64_t blobs = 0;
    Sha256Digest digest{};
  };

  [[nodiscard]] Error error(const std::string& place, const std::string& cause,
                            ErrorKind kind = ErrorKind::bad_input) const {
    return {kind, database.path(), place, cause};
  }

  [[nodiscard]] Row checked_row(const Statement& row) const {
    Row found;
    found.info.id = row.integer(0);
    found.info.name = row.text(1);
    found.info.label = row.text(2);
    const auto content = row.blob(3);
    std::transform(content.begin(), content.begin() + std::min(content.size(), std::size_t{32}),
                   found.info.content.begin(),
                   [](std::byte b) { return static_cast<std::uint8_t>(b); });
    found.info.vertices = row.integer(4);
    found.info.faces = row.integer(5);
    found.info.area = row.real(6);
    found.blobs = row.integer(7);
    found.digest = detail::digest_of_shape(found.info, found.blobs);
    if (content.size() != found.info.content.size() ||
        !detail::same_bytes(found.digest, row.blob(8))) {
      throw detail::damaged(database.path(), "shape " + in_quotes(found.info.name));
    }
    return found;
  }

  [[nodiscard]] std::vector<ShapeInfo> list() const {
    std::vector<ShapeInfo> shapes;
    Roster seen;
    Statement rows(database, std::string(kShapeColumns) + "ORDER BY id");
    while (rows.step()) {
      Row row = checked_row(rows);
      seen.put_in(row.digest);
      shapes.push_back(std::move(row.info));
    }
    if (seen != detail::read_roster(database)) {
      throw error("", "shapes are missing; run 'timbre db verify " + database.path() + "'");
    }
    return shapes;
  }

  [[nodiscard]] std::optional<Row> look_up(const std::string& name) const {
    Statement row(database, std::string(kShapeColumns) + "WHERE name = ?");
    row.bind(1, name);
    if (!row.step()) return std::nullopt;
    Row found = checked_row(row);
    if (found.info.name != name) {
      throw detail::damaged(database.path(), "shape " + in_quotes(name));
    }
    return found;
  }

  // A damaged search tree can hide a row. Before saying no, the whole list is checked.
  [[nodiscard]] std::optional<ShapeInfo> find(const std::string& name) const {
    if (auto row = look_up(name)) return std::move(row->info);
    for (ShapeInfo& shape : list()) {
      if (shape.name == name) return std::move(shape);
    }
    return std::nullopt;
  }

  [[nodiscard]] ShapeInfo require(const std::string& name) const {
    if (auto shape = find(name)) return *std::move(shape);
    throw error("", "there is no shape " + in_quotes(name), ErrorKind::bad_request);
  }

  // Columns: version, parameters, bytes, sha256, from `first` on.
  [[nodiscard]] Blob checked_blob(const ShapeInfo& shape, const std::string& channel,
                                  const Statement& row, int first) const {
    Blob blob{channel, row.integer(first), row.text(first + 1), text_of(row.blob(first + 2))};
    if (!detail::same_bytes(detail::digest_of_blob(shape, blob), row.blob(first + 3))) {
      throw detail::damaged(database.path(), channel + " of " + in_quotes(shape.name));
    }
    return blob;
  }

  [[nodiscard]] Blob read_blob(const ShapeInfo& shape, const std::string& channel) const {
    Statement row(database,
                  "SELECT version, parameters, bytes, sha256 FROM blob"
                  " WHERE channel = ? AND shape = ?");
    row.bind(1, channel).bind(2, shape.id);
    if (!row.step()) throw missing_blob(shape, channel);
    return checked_blob(shape, channel, row, 0);
  }

  [[nodiscard]] Error missing_blob(const ShapeInfo& shape, const std::string& channel) const {
    return error(channel + " of " + in_quotes(shape.name),
                 "is not there; run 'timbre db verify " + database.path() + "'");
  }

  [[nodiscard]] std::string full_parameters(Parameters own) const {
    own.merge(to_parameters(parameters));
    return canonical_text(own);
  }

  void require_same_meaning(const Blob& blob, const Channel& channel) const {
    if (blob.version == channel.version &&
        blob.parameters == full_parameters(channel.parameters)) {
      return;
    }
    throw error("channel " + channel.name,
                "stored with version " + std::to_string(blob.version) + " (" + blob.parameters +
                    "), this timbre computes version " + std::to_string(channel.version) + " (" +
                    full_parameters(channel.parameters) + "); create a new database",
                ErrorKind::bad_request);
  }

  void write_blob(const ShapeInfo& shape, const Blob& blob) const {
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

  [[nodiscard]] std::vector<Blob> blobs_of(const ShapeRecord& record) const {
    std::vector<Blob> blobs;
    blobs.push_back({detail::kMeshBlob, 1, "", detail::pack_mesh(record.mesh)});
    blobs.push_back({detail::kSpectrumBlob, 1, parameters_text,
                     detail::pack_numbers(record.eigenvalues)});
    for (const Descriptor& descriptor : record.descriptors) {
      blobs.push_back({descriptor.channel, descriptor.version,
                       full_parameters(descriptor.parameters),
                       detail::pack_numbers(descriptor.values)});
    }
    return blobs;
  }

  void insert(ShapeInfo shape, const std::vector<Blob>& blobs, Roster& roster) const {
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

  void erase(const Row& row, Roster& roster) const {
    for (const std::string& channel : stored_channels()) {
      Statement(database, "DELETE FROM blob WHERE channel = ? AND shape = ?")
          .bind(1, channel)
          .bind(2, row.info.id)
          .run();
    }
    Statement(database, "DELETE FROM shape WHERE id = ?").bind(1, row.info.id).run();
    roster.take_out(row.digest);
  }

  // From one to the next through the key, without reading what lies between.
  [[nodiscard]] std::vector<std::string> stored_channels() const {
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
};

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

Store Store::create(const std::string& location, const StoreParameters& parameters) {
  detail::require_local(location);
  if (parameters.count < 2) {
    throw Error(ErrorKind::bad_request, location, "k",
                "asks for " + std::to_string(parameters.count) +
                    " eigenvalues; at least 2 are needed");
  }
  detail::create_database(location, parameters);
  return open(location, StoreAccess::write);
}

Store Store::open(const std::string& location, StoreAccess access) {
  detail::require_local(location);
  Database database = detail::open_database(location, access);
  const StoreParameters parameters = detail::read_parameters(database);
  return Store(std::make_unique<Impl>(
      Impl{std::move(database), parameters, canonical_text(to_parameters(parameters))}));
}

const std::string& Store::location() const { return impl_->database.path(); }
const StoreParameters& Store::parameters() const { return impl_->parameters; }

std::vector<ShapeInfo> Store::list() const {
  const Transaction snapshot(impl_->database, Transaction::Kind::read);
  return impl_->list();
}

std::optional<ShapeInfo> Store::find(const std::string& name) const {
  const Transaction snapshot(impl_->database, Transaction::Kind::read);
  return impl_->find(name);
}

AddOutcome Store::add(const ShapeRecord& record, bool replace) {
  if (record.name.empty()) throw Error(ErrorKind::bad_input, "", "name", "is empty");
  require_storable_text(record.name, "name");
  require_storable_text(record.label, "label");
  ShapeInfo shape{0, record.name, record.label, content_of(record.mesh), record.mesh.vertices.rows(),
                  record.mesh.faces.rows(), record.area};
  const std::vector<Blob> blobs = impl_->blobs_of(record);

  Transaction transaction(impl_->database, Transaction::Kind::write);
  Roster roster = detail::read_roster(impl_->database);
  const auto old = impl_->look_up(record.name);
  if (old) {
    const bool same = old->info.content == shape.content;
    if (same && (!replace || old->info.label == shape.label)) return AddOutcome::kept;
    if (!replace) {
      throw impl_->error(in_quotes(record.name),
                         "is there with other content; --replace puts this in its place");
    }
    impl_->erase(*old, roster);
    shape.id = old->info.id;
  }
  impl_->insert(std::move(shape), blobs, roster);
  detail::write_roster(impl_->database, roster);
  transaction.commit();
  return old ? AddOutcome::replaced : AddOutcome::added;
}

void Store::remove(const std::string& name) {
  Transaction transaction(impl_->database, Transaction::Kind::write);
  const auto row = impl_->look_up(name);
  if (!row) {
    throw impl_->error("", "there is no shape " + in_quotes(name), ErrorKind::bad_request);
  }
  Roster roster = detail::read_roster(impl_->database);
  impl_->erase(*row, roster);
  detail::write_roster(impl_->database, roster);
  transaction.commit();
}

TriangleMesh Store::mesh(const std::string& name) const {
  const Transaction snapshot(impl_->database, Transaction::Kind::read);
  const ShapeInfo shape = impl_->require(name);
  return detail::unpack_mesh(impl_->read_blob(shape, detail::kMeshBlob).bytes, shape.vertices,
                             shape.faces);
}

Eigen::VectorXd Store::eigenvalues(const std::string& name) const {
  const Transaction snapshot(impl_->database, Transaction::Kind::read);
  return detail::unpack_numbers(
      impl_->read_blob(impl_->require(name), detail::kSpectrumBlob).bytes);
}

Eigen::VectorXd Store::descriptor(const std::string& name, const Channel& channel) const {
  const Transaction snapshot(impl_->database, Transaction::Kind::read);
  const Blob blob = impl_->read_blob(impl_->require(name), channel.name);
  impl_->require_same_meaning(blob, channel);
  return detail::unpack_numbers(blob.bytes);
}

void Store::for_each_descriptor(
    const Channel& channel,
    const std::function<void(const ShapeInfo&, const Eigen::VectorXd&)>& visit) const {
  const Transaction snapshot(impl_->database, Transaction::Kind::read);
  Statement rows(impl_->database,
                 "SELECT shape, version, parameters, bytes, sha256 FROM blob"
                 " WHERE channel = ? ORDER BY shape");
  rows.bind(1, channel.name);
  for (const ShapeInfo& shape : impl_->list()) {
    if (!rows.step() || rows.integer(0) != shape.id) {
      throw impl_->missing_blob(shape, channel.name);
    }
    const Blob blob = impl_->checked_blob(shape, channel.name, rows, 1);
    impl_->require_same_meaning(blob, channel);
    visit(shape, detail::unpack_numbers(blob.bytes));
  }
}

}  // namespace timbre
