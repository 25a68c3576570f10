// NumPy arrays: a matrix, which survives writing and reading, or one line.
#include "timbre/analysis/core/array_file.h"
#include "timbre/tests/fuzz/memory_watch.h"
#include "timbre/tests/fuzz/target.h"

namespace timbre::fuzz {
namespace {

bool same(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(),
                                       static_cast<std::size_t>(a.size()) * sizeof(double)) == 0);
}

}  // namespace

void examine(std::string_view input) {
  try {
    const MemoryWatch watch;
    const Eigen::MatrixXd matrix = from_npy(input);
    require(watch.peak() <= 8 * input.size() + 4096, "an array takes memory for what is there");
    require(static_cast<std::size_t>(matrix.size()) * 4 <= input.size(), "no number is made up");
    require(same(from_npy(to_npy(matrix)), matrix), "what is written is read back");
  } catch (const Error& error) {
    require_plain(error, ErrorKind::bad_input);
  }
}

}  // namespace timbre::fuzz
