#include "timbre/analysis/geodesic/exact.h"

#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/geodesic/detail/wavefront.h"

namespace timbre {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void require_vertices(const GeodesicMesh& mesh, std::span<const std::int32_t> list,
                      const char* place) {
  for (const std::int32_t v : list) {
    if (v >= 0 && v < mesh.size()) continue;
    throw Error(ErrorKind::bad_request, "", place,
                "vertex " + std::to_string(v) + " does not exist; the mesh has " +
                    std::to_string(mesh.size()));
  }
}

}  // namespace

struct ExactGeodesics::Impl {
  explicit Impl(const GeodesicMesh& prepared) : mesh(prepared), front(prepared) {}

  void run(std::span<const std::int32_t> sources, std::span<const std::int32_t> targets,
           double limit, const std::function<bool()>& keep_going) {
    require_vertices(mesh, sources, "sources");
    require_vertices(mesh, targets, "targets");
    if (!(limit >= 0.0)) {
      throw Error(ErrorKind::bad_request, "", "limit", "is a distance, at least 0");
    }
    if (!front.run(sources, targets, limit / mesh.unit, keep_going)) {
      throw Error(ErrorKind::cancelled, "", "distances", "stopped");
    }
  }

  const GeodesicMesh& mesh;
  detail::Wavefront front;
};

ExactGeodesics::ExactGeodesics(const GeodesicMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
ExactGeodesics::~ExactGeodesics() = default;
ExactGeodesics::ExactGeodesics(ExactGeodesics&&) noexcept = default;
ExactGeodesics& ExactGeodesics::operator=(ExactGeodesics&&) noexcept = default;

Eigen::VectorXd ExactGeodesics::distances(std::span<const std::int32_t> sources,
                                          const ExactOptions& options) {
  impl_->run(sources, options.targets, options.limit, options.keep_going);
  Eigen::VectorXd result = Eigen::VectorXd::Constant(impl_->mesh.size(), kInfinity);
  const std::span<const std::int32_t> wanted =
      options.targets.empty() ? impl_->front.touched() : options.targets;
  for (const std::int32_t v : wanted) {
    result[v] = impl_->front.distance(v) * impl_->mesh.unit;
  }
  return result;
}

std::vector<double> ExactGeodesics::distances_to(std::span<const std::int32_t> sources,
                                                 std::span<const std::int32_t> targets,
                                                 double limit) {
  std::vector<double> result;
  if (targets.empty()) return result;
  impl_->run(sources, targets, limit, {});
  result.reserve(targets.size());
  for (const std::int32_t v : targets) {
    result.push_back(impl_->front.distance(v) * impl_->mesh.unit);
  }
  return result;
}

Eigen::VectorXd exact_distances(const GeodesicMesh& mesh, const std::vector<std::int32_t>& sources,
                                const ExactOptions& options) {
  return ExactGeodesics(mesh).distances(sources, options);
}

}  // namespace timbre
