#include "timbre/index/store.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "timbre/index/detail/store_impl.h"
#include "timbre/index/detail/text.h"

namespace timbre {

using detail::Blob;
using detail::Database;
using detail::Roster;
using detail::Statement;
using detail::Transaction;

Parameters to_parameters(const StoreParameters& parameters) {
  return {{"k", std::to_string(parameters.count)},
          {"mass", to_word(parameters.mass)},
          {"operator", to_word(parameters.operator_kind)}};
}

void require_storable_text(const std::string& text, const char* what) {
  const auto refuse = [&](const char* cause) {
    throw Error(ErrorKind::bad_input, "", what,
                detail::in_quotes(text.substr(0, 80)) + " " + cause);
  };
  if (text.size() > 255) refuse("is longer than 255 bytes");
  if (!detail::is_utf8(text)) refuse("is not UTF-8");
  if (escape_control(text) != text) refuse("holds control characters");
}

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

Store Store::create(const std::string& location, const StoreParameters& parameters) {
  detail::require_local(location);
  if (parameters.count < 2) {
    throw Error(
        ErrorKind::bad_request, location, "k",
        "asks for " + std::to_string(parameters.count) + " eigenvalues; at least 2 are needed");
  }
  detail::create_database(location, parameters);
  return open(location, StoreAccess::write);
}

bool is_store(const std::string& location) {
  constexpr std::string_view kMagic = "SQLite format 3";
  std::error_code failure;  // a pipe keeps what was never read from it
  if (!std::filesystem::is_regular_file(location, failure)) return false;
  std::ifstream file(location, std::ios::binary);
  std::string start(kMagic.size(), '\0');
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kMagic;
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
  ShapeInfo shape{0,
                  record.name,
                  record.label,
                  content_of(record.mesh),
                  record.mesh.vertices.rows(),
                  record.mesh.faces.rows(),
                  record.area};
  const std::vector<Blob> blobs = impl_->blobs_of(record);

  Transaction transaction(impl_->database, Transaction::Kind::write);
  Roster roster = detail::read_roster(impl_->database);
  const auto old = impl_->look_up(record.name);
  if (old) {
    const bool same = old->info.content == shape.content;
    if (same && (!replace || old->info.label == shape.label)) return AddOutcome::kept;
    if (!replace) {
      throw impl_->error(detail::in_quotes(record.name),
                         "is there with other content; --replace puts this in its place",
                         ErrorKind::bad_request);
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
    throw impl_->error("", "there is no shape " + detail::in_quotes(name), ErrorKind::bad_request);
  }
  Roster roster = detail::read_roster(impl_->database);
  impl_->erase(*row, roster);
  detail::write_roster(impl_->database, roster);
  transaction.commit();
}

TriangleMesh Store::mesh(const std::string& name) const {
  const Transaction snapshot(impl_->database, Transaction::Kind::read);
  const ShapeInfo shape = impl_->require(name);
  const Blob blob = impl_->read_blob(shape, detail::kMeshBlob);
  try {
    return detail::unpack_mesh(blob.bytes, shape.vertices, shape.faces);
  } catch (const Error& error) {
    throw error.in_file(impl_->database.path());
  }
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
