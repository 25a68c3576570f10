#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/operators/operator.h"
#include "timbre/analysis/spectrum/spectrum.h"
#include "timbre/cli/command.h"

namespace timbre::cli {

struct StreamOptions {
  ElementType type = ElementType::float64;  ///< of the eigenfunctions
  bool resume = false;                      ///< go on with an unfinished file
};

/// The document that goes into F.json.
using Describe = std::function<nlohmann::json(const Spectrum&)>;

/// To be called before any work: refuses what `stream_spectrum` could not begin.
void require_stream_can_begin(const Context& context, const StreamOptions& options);

/// Computes eigenpairs and writes the eigenfunctions to `context.output`, F.npy, as they are
/// found. Until all are there they are in F.npy.unfinished, and what is needed to go on after an
/// interrupt or a crash in F.npy.state. Beside it come eigenvalues in F.evals.npy and, with the
/// certificate, F.json. The result is as of SpectrumStream::finish.
[[nodiscard]] Spectrum stream_spectrum(const Context& context, const Operator& op,
                                       const SpectrumOptions& spectrum,
                                       const StreamOptions& options, const Describe& describe);

}  // namespace timbre::cli
