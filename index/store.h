#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/core/progress.h"
#include "timbre/analysis/core/sha256.h"
#include "timbre/analysis/mesh/triangle_mesh.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/index/channel.h"

namespace timbre {

/// What all spectra of one database were computed with; never mixed.
struct StoreParameters {
  OperatorKind operator_kind = OperatorKind::robust;
  MassKind mass = MassKind::lumped;
  int count = 200;  ///< eigenvalues kept of each shape; fewer on small meshes

  bool operator==(const StoreParameters&) const = default;
};

/// `k=200 mass=lumped operator=robust`, as a map; part of what every stored blob means.
[[nodiscard]] Parameters to_parameters(const StoreParameters& parameters);

/// A stored shape without its data.
struct ShapeInfo {
  std::int64_t id = 0;     ///< ascending in the order of adding; kept by a replacement
  std::string name;        ///< UTF-8, 1 to 255 bytes, no control characters; unique
  std::string label;       ///< its class; empty: none
  Sha256Digest content{};  ///< of vertices and faces
  std::int64_t vertices = 0;
  std::int64_t faces = 0;
  double area = 0.0;  ///< length^2
};

struct Descriptor {
  std::string channel;
  int version = 1;
  Parameters parameters;
  Eigen::VectorXd values;
};

/// A shape with all its data, as it is handed to `Store::add`.
struct ShapeRecord {
  std::string name;
  std::string label;
  TriangleMesh mesh;
  double area = 0.0;
  Eigen::VectorXd eigenvalues;  ///< at unit total area, from lambda_0 on
  std::vector<Descriptor> descriptors;
};

/// SHA-256 over the exact bits of vertices and faces, and their numbers.
[[nodiscard]] Sha256Digest content_of(const TriangleMesh& mesh);

/// @throws Error  bad_input unless `text` is well-formed UTF-8 of at most 255 bytes without control
///                characters; `what` is its place in the message
void require_storable_text(const std::string& text, const char* what);

/// Whether a file begins as a database does, and no mesh file.
[[nodiscard]] bool is_store(const std::string& location);

enum class AddOutcome : std::uint8_t {
  added,
  kept,      ///< the same name and content are there already
  replaced,  ///< other content or label was there
};

enum class StoreAccess : std::uint8_t { read, write };

struct Damage {
  std::string name;  ///< of the shape; empty where it is the file as a whole
  std::string cause;
};

struct VerifyReport {
  std::int64_t checked = 0;  ///< shapes looked at
  std::vector<Damage> damaged;
};

/// A database of shapes: one SQLite file that holds everything needed to answer, explain
/// and match without the original mesh files.
///
/// Every change is one transaction, durable once the call returns. Every piece read is
/// checked against a SHA-256 that covers its shape's name and content, its channel,
/// version, parameters and bytes; the list of shapes as a whole is checked too. So damage
/// gives an Error, not a wrong answer. A checksum is not authentication: it finds
/// accidents, not forgery.
///
/// Several processes may read and write one database; each object serves one thread.
/// Content does not depend on the clock nor on chance.
class Store {
 public:
  /// Makes a new database at a path. Whole or not at all.
  /// @throws Error  bad_request if something is there already; io
  [[nodiscard]] static Store create(const std::string& location,
                                    const StoreParameters& parameters = {});
  /// Opens a database. Reading works in folders that may not be written, unless a
  /// writer's log was left behind there.
  /// @throws Error  bad_input for a file that is no database of ours, is damaged, or
  ///                comes from a newer timbre; io
  [[nodiscard]] static Store open(const std::string& location,
                                  StoreAccess access = StoreAccess::read);
  ~Store();
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;

  [[nodiscard]] const std::string& location() const;
  [[nodiscard]] const StoreParameters& parameters() const;

  /// All shapes in the order of adding.
  [[nodiscard]] std::vector<ShapeInfo> list() const;
  [[nodiscard]] std::optional<ShapeInfo> find(const std::string& name) const;

  /// @throws Error  bad_request if the name holds other content and `replace` is false;
  ///                bad_input if name or label cannot be stored; io
  AddOutcome add(const ShapeRecord& record, bool replace = false);
  /// @throws Error  bad_request if there is no such shape
  void remove(const std::string& name);

  /// The mesh as it was added, bit for bit.
  /// @throws Error  here and below: bad_request for an unknown name; bad_input for damage
  [[nodiscard]] TriangleMesh mesh(const std::string& name) const;
  /// The lowest eigenvalues at unit total area, from lambda_0 on; divided by the shape's
  /// area they are those of its own scale.
  [[nodiscard]] Eigen::VectorXd eigenvalues(const std::string& name) const;
  /// @throws Error  also bad_request if the channel was stored with another version or
  ///                other parameters than `channel` has
  [[nodiscard]] Eigen::VectorXd descriptor(const std::string& name, const Channel& channel) const;

  /// Calls `visit` for all shapes in the order of adding, of one state of the database.
  void for_each_descriptor(
      const Channel& channel,
      const std::function<void(const ShapeInfo&, const Eigen::VectorXd&)>& visit) const;

  /// Reads and checks everything there is; damage is reported, not thrown.
  [[nodiscard]] VerifyReport verify(const Progress& progress = {}) const;

 private:
  struct Impl;
  explicit Store(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace timbre
