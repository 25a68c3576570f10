#include "timbre/analysis/spectrum/spectrum_stream.h"

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "timbre/analysis/core/sha256.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/spectrum/detail/merged_pairs.h"
#include "timbre/analysis/spectrum/detail/state_file.h"

namespace timbre {
namespace {

using Eigen::Index;

template <typename T>
void add(Sha256& hash, const T* values, Index count) {
  hash.add_bytes(std::as_bytes(std::span(values, static_cast<std::size_t>(count))));
}

void add(Sha256& hash, const SparseMatrix& matrix) {
  add(hash, matrix.outerIndexPtr(), matrix.outerSize() + 1);
  add(hash, matrix.innerIndexPtr(), matrix.nonZeros());
  add(hash, matrix.valuePtr(), matrix.nonZeros());
}

// Of all that the pairs depend on.
Sha256Digest digest_of(const Operator& op, const SpectrumOptions& options) {
  Sha256 hash;
  add(hash, op.stiffness);
  add(hash, op.mass);
  add(hash, op.lumped_mass.data(), op.lumped_mass.size());
  add(hash, op.positions.data(), op.positions.size());
  add(hash, op.component.data(), std::ssize(op.component));
  add(hash, &options.count, 1);
  add(hash, &options.tolerance, 1);
  add(hash, &options.certify, 1);
  add(hash, &options.backend, 1);
  return hash.finish();
}

}  // namespace

struct SpectrumStream::Impl {
  Impl(const Operator& given, const SpectrumOptions& chosen)
      : op(given), options(chosen), merged(given, chosen, detail::MergedPairs::Vectors::forget) {}

  const Sha256Digest& owner() {
    if (!digest) digest = digest_of(op, options);
    return *digest;
  }

  const Operator& op;
  SpectrumOptions options;
  detail::MergedPairs merged;
  std::optional<Sha256Digest> digest;
};

SpectrumStream::SpectrumStream(const Operator& op, const SpectrumOptions& options)
    : impl_(std::make_unique<Impl>(op, options)) {}

SpectrumStream::~SpectrumStream() = default;
SpectrumStream::SpectrumStream(SpectrumStream&&) noexcept = default;
SpectrumStream& SpectrumStream::operator=(SpectrumStream&&) noexcept = default;

Index SpectrumStream::count() const { return impl_->merged.wanted(); }

SpectrumBand SpectrumStream::next() {
  const SingleThreadedBlas blas;
  const Index first = impl_->merged.handed_on();
  const std::vector<detail::MergedPair> pairs = impl_->merged.next();
  SpectrumBand band{first, Eigen::VectorXd(std::ssize(pairs)),
                    Eigen::MatrixXd(impl_->op.stiffness.rows(), std::ssize(pairs))};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto column = static_cast<Index>(i);
    band.values[column] = pairs[i].value;
    impl_->merged.write_vector(pairs[i], band.vectors.col(column).data());
  }
  return band;
}

Spectrum SpectrumStream::finish() {
  const SingleThreadedBlas blas;
  return impl_->merged.finish();
}

void SpectrumStream::save(const std::string& path) const {
  impl_->merged.forget_handed_on();
  detail::StateWriter file(path, impl_->owner());
  impl_->merged.exchange(file);
  file.finish();
}

Index SpectrumStream::resume(const std::string& path) {
  detail::StateReader file(path, impl_->owner());
  impl_->merged.exchange(file);
  file.finish();
  return impl_->merged.handed_on();
}

}  // namespace timbre
