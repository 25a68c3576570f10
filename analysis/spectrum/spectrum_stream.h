#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"

namespace timbre {

/// Some eigenpairs in ascending order, following those of the band before.
struct SpectrumBand {
  Eigen::Index first = 0;   ///< number of the first pair
  Eigen::VectorXd values;   ///< 1/length^2
  Eigen::MatrixXd vectors;  ///< N x values, M-orthonormal, also to all other bands
};

/// The lowest eigenpairs of a Laplacian, handed out band by band in ascending order: memory does
/// not grow with their number. The same pairs as of `compute_spectrum`.
///
///     SpectrumStream stream(op, {.count = 5000});
///     for (SpectrumBand band = stream.next(); band.values.size() > 0; band = stream.next()) {
///       use(band);
///     }
///     const Spectrum checked = stream.finish();
class SpectrumStream {
 public:
  /// @param op  must outlive this
  /// @throws Error  bad_request as `compute_spectrum`
  explicit SpectrumStream(const Operator& op, const SpectrumOptions& options = {});
  ~SpectrumStream();
  SpectrumStream(SpectrumStream&&) noexcept;
  SpectrumStream& operator=(SpectrumStream&&) noexcept;

  [[nodiscard]] Eigen::Index count() const;  ///< pairs in all: those wanted, capped at n

  /// The next band; empty when all pairs have been handed out.
  /// @throws Error  not_converged, cancelled
  [[nodiscard]] SpectrumBand next();

  /// After the last band: all of the Spectrum but its vectors, checked as by `compute_spectrum`.
  /// @throws Error  not_converged
  [[nodiscard]] Spectrum finish();

  /// Writes all that `next` depends on to a file, in place of what it held before: another
  /// stream of the same operator and options goes on from there, with the same bytes.
  /// @throws Error  io
  void save(const std::string& path) const;

  /// Goes on from where the stream that wrote the file was. After an error this one is of no use.
  /// @return  pairs handed out by then
  /// @throws Error  io; bad_input if the file is damaged, or belongs to other matrices, options or
  ///                another version
  Eigen::Index resume(const std::string& path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace timbre
