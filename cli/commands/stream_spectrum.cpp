#include "timbre/cli/commands/stream_spectrum.h"

#include <filesystem>
#include <system_error>

#include "timbre/analysis/core/column_file.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/spectrum/spectrum_stream.h"

namespace timbre::cli {
namespace {

std::string state_path(const std::string& output) { return output + ".state"; }

bool exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

void remove(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

// The end of a file name without its ending.
std::string beside(const std::string& output, const char* ending) {
  return output.substr(0, output.size() - 4) + ending;
}

std::string values_path(const std::string& output) { return beside(output, ".evals.npy"); }
std::string document_path(const std::string& output) { return beside(output, ".json"); }

void write_bands(const Context& context, SpectrumStream& stream, ColumnFile& file) {
  const std::string state = state_path(context.output);
  for (;;) {
    const SpectrumBand band = stream.next();
    if (band.values.size() == 0) return;
    file.write(band.first, band.vectors);
    if (band.first + band.values.size() < stream.count()) stream.save(state);
  }
}

}  // namespace

void require_stream_can_begin(const Context& context, const StreamOptions& options) {
  for (const std::string& path : {values_path(context.output), document_path(context.output)}) {
    require_writable(path, context.force || options.resume);
  }
  const std::string state = state_path(context.output);
  // Killed after the last step but one.
  if (!exists(ColumnFile::unfinished(context.output))) remove(state);
  if (options.resume && !exists(state)) {
    throw Error(ErrorKind::bad_request, context.output, "resume",
                "there is nothing to go on with: no " + state);
  }
  if (exists(state) && !options.resume && !context.force) {
    throw Error(ErrorKind::bad_request, context.output, "output",
                "is unfinished; --resume goes on with it, --force begins again");
  }
}

Spectrum stream_spectrum(const Context& context, const Operator& op,
                         const SpectrumOptions& spectrum, const StreamOptions& options,
                         const Describe& describe) {
  const std::string state = state_path(context.output);
  SpectrumStream stream(op, spectrum);
  if (options.resume) {
    const Eigen::Index done = stream.resume(state);
    context.note(context.output + ": going on after " + std::to_string(done) + " of " +
                 std::to_string(stream.count()) + " eigenpairs");
  } else {
    remove(state);
  }
  ColumnFile file(context.output, op.stiffness.rows(), stream.count(), options.type,
                  options.resume);
  try {
    write_bands(context, stream, file);
    Spectrum found = stream.finish();
    const bool overwrite = context.force || options.resume;  // those of a run that was killed
    write_file(values_path(context.output), to_npy(found.values), overwrite);
    write_file(document_path(context.output), describe(found).dump(2) + "\n", overwrite);
    file.commit(context.force);
    remove(state);
    return found;
  } catch (...) {
    if (exists(state)) {
      context.note(context.output + ": what was found is kept; --resume goes on with it");
    } else {
      remove(ColumnFile::unfinished(context.output));
    }
    throw;
  }
}

}  // namespace timbre::cli
